//! `pancoat compare`: runs side by side, or a run against measured thickness.

use super::args::CompareArgs;
use super::failure::Failure;
use super::print_line;
use crate::models::thz::{SimulatedMap, ThzComparison, ThzMap, ThzScan};
use crate::models::{Spearman, TabletSurface};
use crate::report::{
    ComparedShape, MEASURES, ReportData, ThicknessMap, ThzSide, comparison_page, results_table, thz_page,
};
use crate::scene::ShortLines;
use std::fs;
use std::path::Path;

pub(super) fn compare(args: &CompareArgs) -> Result<(), Failure> {
    if let Some(file) = &args.csv {
        fs::write(file, results_table(&args.directories)?).map_err(Failure::Output)?;
    }
    let page = if args.thz.is_empty() { runs(args)? } else { scans(args)? };
    fs::write(&args.out, page).map_err(Failure::Output)?;
    print_line(&args.out.display().to_string())
}

/// Every shape of every run.
fn runs(args: &CompareArgs) -> Result<String, Failure> {
    let mut shapes = Vec::new();
    for directory in &args.directories {
        shapes.extend(ComparedShape::of(&ReportData::read(directory)?));
    }
    if shapes.is_empty() {
        return Err(Failure::NothingCoated(args.directories[0].clone()));
    }
    print_line(&row([
        "shape",
        "spray_s",
        "CoV_intra",
        "CoV_inter",
        "limit",
        "low",
        "high",
        "no_shadows",
        "cap/band",
    ]))?;
    for shape in &shapes {
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.4}"));
        print_line(&row([
            &shape.shape,
            &format!("{:.1}", shape.time_s),
            &number(shape.covs.map(|covs| covs.0)),
            &number(shape.covs.map(|covs| covs.1)),
            &number(shape.limit.map(|limit| limit.value)),
            &number(shape.limit.map(|limit| limit.low)),
            &number(shape.limit.map(|limit| limit.high)),
            &number(shape.orientation_only),
            &number(shape.cap_to_band),
        ]))?;
    }
    for (measure, correlation) in MEASURES.iter().zip(ComparedShape::correlations(&shapes)) {
        if let Some(Spearman { rho, p_value }) = correlation {
            print_line(&format!("limit against {measure}: rank correlation {rho:.2}, p = {p_value:.2}"))?;
        }
    }
    Ok(comparison_page(&shapes))
}

fn row(cells: [&str; 9]) -> String {
    let [shape, rest @ ..] = cells;
    format!("{shape:<16}{}", rest.map(|cell| format!("{cell:>11}")).concat())
}

/// The average tablet of a run against scans of real ones.
fn scans(args: &CompareArgs) -> Result<String, Failure> {
    let directory = &args.directories[0];
    let data = ReportData::read(directory)?;
    let wanted = |name: &str| args.shape.as_deref().is_none_or(|shape| shape == name);
    let shape = data.shapes.iter().find(|shape| wanted(&shape.name));
    let nothing = || Failure::NothingCoated(directory.clone());
    let shape = shape.ok_or_else(nothing)?;
    let map = shape.map.as_ref().ok_or_else(nothing)?;
    let (centroids, normals, areas) = map.geometry();
    let surface = TabletSurface::new(&centroids, &normals, &areas, &map.on_cap)?;
    let metres = |um: &[f64]| um.iter().map(|h| h * 1e-6).collect::<Vec<_>>();
    let (average, sd) =
        (metres(&map.average_um), metres(map.others.get(ThicknessMap::SD).ok_or_else(nothing)?));
    let measured = args.thz.iter().map(|path| scan(path, args.cut, &surface));
    let measured = measured.collect::<Result<Vec<_>, _>>()?;
    let simulated = SimulatedMap { average: &average, panel_sd: &sd, tablets: shape.tablets.len() };
    let comparison = ThzComparison::new(&measured, &simulated, &surface)?;
    let tablets: Vec<f64> = shape.tablets.iter().filter_map(|tablet| tablet.cap_to_band).collect();
    let side =
        ThzSide { title: &data.title, map, scans: &measured, comparison: &comparison, tablets: &tablets };
    for (name, text) in side.figures() {
        print_line(&format!("{name:<34}{text}"))?;
    }
    Ok(thz_page(&side)?)
}

fn scan(path: &Path, cut: f64, surface: &TabletSurface<'_>) -> Result<ThzMap, Failure> {
    let fault = |source| Failure::Scan { path: path.to_owned(), source };
    let file = ShortLines::open(path).map_err(|e| fault(csv::Error::from(e).into()))?;
    Ok(ThzMap::new(&ThzScan::read(file, cut).map_err(fault)?, surface))
}
