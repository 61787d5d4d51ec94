//! The report page, opened in a real browser.

#[path = "support/browser.rs"]
mod browser;

use pancoat::models::{Asymptote, SeriesRow};
use pancoat::report::{
    Exponent, Limit, Quantity, ReportData, RunDir, ShapeCoating, TabletRow, ThicknessMap, page, vtp,
};

/// An ellipsoid of panels in rings, thicker on its caps.
fn ellipsoid(rings: u32, around: u32) -> ThicknessMap {
    let mut map = ThicknessMap::default();
    let point = |ring: u32, step: u32| {
        let (polar, turn) = (
            f64::from(ring) / f64::from(rings) * std::f64::consts::PI,
            f64::from(step) / f64::from(around) * std::f64::consts::TAU,
        );
        [8.0 * polar.sin() * turn.cos(), 8.0 * polar.sin() * turn.sin(), 3.3 * polar.cos()]
    };
    for ring in 0..=rings {
        map.vertices_mm.extend((0..around).map(|step| point(ring, step)));
    }
    for ring in 0..rings {
        for step in 0..around {
            let (a, b) = (ring * around + step, ring * around + (step + 1) % around);
            for triangle in [[a, a + around, b], [b, a + around, b + around]] {
                let corners = triangle.map(|v| nalgebra::Vector3::from(map.vertices_mm[v as usize]));
                let cross = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
                if cross.norm() > 1e-9 {
                    let upright = cross.normalize().z.abs();
                    map.triangles.push(triangle);
                    map.areas_mm2.push(cross.norm() / 2.0);
                    map.on_cap.push(upright > 0.7);
                    map.average_um.push(40.0 + 25.0 * upright * (1.2 - upright * 0.4));
                }
            }
        }
    }
    let scaled = |by: f64, wave: f64| {
        let own = |(j, h): (usize, &f64)| 50.0 + by * (h - 50.0) + wave * (j as f64 * 0.05).sin();
        map.average_um.iter().enumerate().map(own).collect::<Vec<_>>()
    };
    let others = [("without_shadows", scaled(1.6, 0.0)), ("most_uniform", scaled(0.9, 3.0))];
    let single = [
        ("median", scaled(1.0, 6.0)),
        ("least_uniform", scaled(1.2, 12.0)),
        ("sd", vec![6.0; map.areas_mm2.len()]),
    ];
    map.others = others.into_iter().chain(single).map(|(name, um)| (name.to_string(), um)).collect();
    map
}

/// Tablets whose CoV is normally distributed, by quantiles.
fn tablets() -> Vec<TabletRow> {
    let row = |k: u32| {
        let spread: f64 = (0..12).map(|j| f64::from((k * 7919 + j * 104_729) % 1009) / 1009.0 - 0.5).sum();
        TabletRow {
            tablet: k as usize,
            shape: "round".into(),
            mass_mg: 1300.0,
            coat_mass_mg: 5.0,
            mean_thickness_um: 7.65 + spread,
            cov_intra: Some(0.28 + 0.02 * spread),
            cap_to_band: Some(1.2),
        }
    };
    (0..770).map(row).collect()
}

fn sample() -> ReportData {
    let limit = Asymptote { cov_squared: 0.0361, noise_time: 9.0 };
    let row = |k: i32| {
        let time = 0.5 * 1.25_f64.powi(k);
        let (intra, inter) = (limit.after(time), 2.2 / (time + 1.0).sqrt());
        SeriesRow {
            time_s: time,
            cov_intra: intra,
            cov_intra_each: (time > 8.0).then_some(intra * 0.99),
            cov_intra_average_tablet: (0.0361 + 0.02 / time).sqrt(),
            cov_total: intra.hypot(inter),
            cov_inter: inter,
            sd_cov_intra: (time > 8.0).then(|| 0.8 * time.powf(-0.57)),
            mean_thickness_um: 0.037 * time,
        }
    };
    let quantity = |name: &str, value: f64, error: Option<f64>, unit: &str| Quantity {
        name: name.into(),
        value,
        error,
        unit: unit.into(),
    };
    let mut picture = Vec::new();
    {
        let mut encoder = png::Encoder::new(&mut picture, 320, 200);
        encoder.set_color(png::ColorType::Grayscale);
        let pixels: Vec<u8> = (0..320_u32 * 200).map(|p| ((p % 320) ^ (p / 320)) as u8).collect();
        let mut writer = encoder.write_header().expect("a picture in memory");
        writer.write_image_data(&pixels).expect("a picture in memory");
    }
    ReportData {
        title: "Round tablets, 22 rpm <test & check>".into(),
        series: (0..28).map(row).collect(),
        shapes: vec![ShapeCoating {
            name: "round".into(),
            limit: Some(Limit { value: 0.19, low: 0.178, high: 0.201, noise_time_s: Some(9.0) }),
            orientation_only: Some(0.27),
            orientation_monte_carlo: Some(0.275),
            order_tensor: Some(0.26),
            inter_exponent: Some(Exponent { value: -0.51, low: -0.54, high: -0.47 }),
            spread_exponent: Some(Exponent { value: -0.57, low: -0.6, high: -0.52 }),
            residence_cov: Some(0.142),
            tablets: tablets(),
            map: Some(ellipsoid(22, 40)),
        }],
        bed: vec![
            quantity("Dynamic angle of repose", 44.9, Some(0.35), "°"),
            quantity("Mean speed", 0.1997, Some(0.0007), "m/s"),
            quantity("Kinetic energy", 0.02716, Some(0.0002), "J"),
            quantity("Drum torque", 0.182, None, "N m"),
        ],
        picture: Some(picture),
        numerics: vec![
            quantity("Time step", 5e-5, None, "s"),
            quantity("Steps per contact", 45.0, None, ""),
            quantity("Largest overlap over tablet thickness", 1.9, None, "%"),
        ],
        phases: vec![
            ("near pairs".into(), 41.0),
            ("forces".into(), 160.0),
            ("coating".into(), 22.0),
            ("rest".into(), 4.0),
        ],
        identity_residual: Some(3.1e-15),
        warnings: vec!["Largest overlap is 6 % of the sphere radius: lower the time step.".into()],
        provenance: vec![
            ("Version".into(), "0.1.0".into()),
            ("Seed".into(), "1".into()),
            ("Scene hash".into(), "3f9c1a".repeat(10)),
        ],
        scene_text: "Scene(\n    title: \"Round tablets, 22 rpm <test & check>\",\n    seed: 1,\n)\n".into(),
    }
}

#[test]
fn a_browser_draws_every_chart_without_a_fault() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("report.html");
    std::fs::write(&file, page(&sample())).unwrap();
    let Some(dom) = browser::dump_dom(&file) else { return };
    let head = &dom[..300];
    assert!(head.contains("data-charts=\"11\""), "{head}");
    assert!(!head.contains("data-fault"), "{head}");
    assert!(dom.matches("class=\"js-line\"").count() >= 18, "the curves of the line charts");
    assert!(dom.contains("<canvas"), "the map");
}

#[test]
fn the_page_is_one_file_that_loads_nothing() {
    let page = page(&sample());
    let own: String = page.split("<script").filter(|part| part.len() < 3_000_000).collect();
    for attribute in ["src=\"", "href=\""] {
        for value in own.split(attribute).skip(1) {
            assert!(value.starts_with("data:"), "{}", &value[..40.min(value.len())]);
        }
    }
    assert!(!own.contains("@import") && !own.contains("url("));
    assert!(page.len() < 8_000_000, "{} bytes", page.len());
    assert!(page.contains("Round tablets, 22 rpm &lt;test &amp; check&gt;"));
}

#[test]
fn a_run_directory_holds_what_the_page_shows() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path();
    let sample = sample();
    let map = sample.shapes[0].map.as_ref().unwrap();
    let run = RunDir::create(dir, &sample.scene_text).unwrap();
    run.write_table("tablets.csv", &sample.shapes[0].tablets).unwrap();
    std::fs::write(dir.join("coating.vtp"), vtp::write(std::slice::from_ref(map))).unwrap();
    let mut series = run.series().unwrap();
    sample.series.iter().for_each(|row| series.add(row).unwrap());
    std::fs::write(dir.join("panels.csv"), "panel,shape,region\n0,round,cap\n1,round,band\n").unwrap();
    std::fs::write(dir.join("bed.png"), sample.picture.as_ref().unwrap()).unwrap();
    let record = serde_json::json!({
        "title": sample.title,
        "seed": 1,
        "machine": { "cores": 2, "system": "linux" },
        "derived": { "time_step_s": 5e-5, "steps_per_contact": 45.0 },
        "guards": { "largest_overlap_percent": 1.9 },
        "warnings": sample.warnings,
        "results": {
            "cov_intra": 0.28,
            "cov_intra_asymptote": { "value": 0.19, "low": 0.178, "high": 0.201, "noise_time_s": 9.0 },
            "cov_intra_orientation_only": 0.27,
            "cov_intra_orientation_monte_carlo": 0.275,
            "cov_intra_order_tensor": 0.26,
            "cov_inter_exponent": { "value": -0.51, "low": -0.54, "high": -0.47 },
            "sd_cov_intra_exponent": { "value": -0.57, "low": -0.6, "high": -0.52 },
            "cov_residence_time": 0.142,
            "cov_identity_residual": 3.1e-15,
            "angle_of_repose_deg": 44.9,
            "mean_speed_m_per_s": 0.1997,
            "standard_errors": { "angle_of_repose_deg": 0.35 },
        },
        "performance": { "wall_s": 227.0, "phases": { "near_pairs": 41.0, "forces": 160.0 } },
    });
    std::fs::write(dir.join("run.json"), record.to_string()).unwrap();

    let read = ReportData::read(dir).unwrap();
    assert_eq!(
        (&read.series, &read.shapes, &read.picture),
        (&sample.series, &sample.shapes, &sample.picture)
    );
    assert_eq!(
        (&read.title, &read.warnings, &read.scene_text),
        (&sample.title, &sample.warnings, &sample.scene_text)
    );
    assert_eq!(read.identity_residual, sample.identity_residual);
    assert_eq!(
        read.bed[0],
        Quantity { name: "Angle of repose".into(), value: 44.9, error: Some(0.35), unit: "°".into() }
    );
    assert_eq!((read.bed[1].unit.as_str(), read.bed.len()), ("m/s", 2));
    assert_eq!(read.numerics.iter().map(|q| q.unit.as_str()).collect::<Vec<_>>(), ["s", "", "%"]);
    assert_eq!(read.phases, [("Near pairs".to_string(), 41.0), ("Forces".to_string(), 160.0)]);
    assert!(read.provenance.contains(&("Machine: cores".to_string(), "2".to_string())));

    std::fs::write(dir.join("series.csv"), "time_s,cov_intra\n1.0,x\n").unwrap();
    let fault = ReportData::read(dir).unwrap_err().to_string();
    assert!(fault.contains("series.csv"), "{fault}");
}

#[test]
fn an_empty_run_still_makes_a_page() {
    let page = page(&ReportData { title: "free fall".into(), ..ReportData::default() });
    assert!(page.contains("Nothing was coated") && !page.contains("data-chart=\""));
}

/// As after short runs: nothing else in the chart could be told apart beside it.
#[test]
fn an_interval_that_reaches_zero_does_not_stretch_the_chart() {
    let mut data = sample();
    data.shapes[0].limit.as_mut().unwrap().low = 0.0;
    let page = page(&data);
    let range = page.split("\"range\":[").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    let (low, high) = range.split_once(',').unwrap();
    let inter = data.series.last().unwrap().cov_inter;
    assert!(inter < 0.19, "the least that is drawn");
    assert!((low.parse::<f64>().unwrap() - inter.log10()).abs() < 0.3, "{range}");
    assert!(high.parse::<f64>().unwrap() > data.series[0].cov_intra.log10(), "{range}");
}

#[test]
#[ignore = "writes the sample page into the folder PAGE_DIR, to look at"]
fn write_the_sample_page() {
    let folder = std::env::var_os("PAGE_DIR").unwrap();
    std::fs::write(std::path::Path::new(&folder).join("report.html"), page(&sample())).unwrap();
}
