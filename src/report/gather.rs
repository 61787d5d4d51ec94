//! From the files of a run directory to what a report shows.

use super::{Exponent, Limit, Quantity, ReportData, ShapeCoating, TabletRow, ThicknessMap, vtp};
use serde::Deserialize;
use serde_json::Value;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Why a report cannot be made of a run directory.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file could not be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The record is not JSON.
    #[error("{path} is not a run record: {source}")]
    Record {
        /// The file.
        path: PathBuf,
        /// Where it fails.
        source: serde_json::Error,
    },
    /// A table does not have the columns it should have.
    #[error("{path}: {source}")]
    Table {
        /// The file.
        path: PathBuf,
        /// Row and column.
        source: csv::Error,
    },
    /// The coated surface cannot be read.
    #[error("{path}: {source}")]
    Surface {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: vtp::VtpError,
    },
}

/// What the record's sections are called and how a report uses them. All numbers in a section are shown; the name and unit of
/// each come from its key (`angle_of_repose_deg`), the error from the same key of the section's `standard_errors`.
const NUMERICS: [&str; 2] = ["derived", "guards"];
/// Results that charts and verdict show, so that they are not listed with the bed.
const SHOWN_ELSEWHERE: &str = "cov_";

impl ReportData {
    /// Gathers what the run directory `dir` holds: `run.json` always; `series.csv`, `coating.vtp` with `panels.csv` and `tablets.csv`,
    /// `scene.ron` and `bed.png` where the run wrote them.
    ///
    /// # Errors
    /// [`ReportError`] names the file that is missing or broken.
    pub fn read(dir: &Path) -> Result<Self, ReportError> {
        let record = record(dir)?;
        let text = |name: &str| Ok(read(&dir.join(name))?.map(|t| String::from_utf8_lossy(&t).into_owned()));

        let results = &record["results"];
        let bed: Vec<Quantity> = quantities(results)
            .into_iter()
            .filter(|(key, _)| !key.starts_with(SHOWN_ELSEWHERE))
            .map(|(_, q)| q)
            .collect();
        let phases = entries(&record["performance"]["phases"])
            .filter_map(|(k, v)| Some((words(k), v.as_f64()?)))
            .collect();
        let strings = |v: &Value| {
            v.as_array().into_iter().flatten().filter_map(|w| w.as_str().map(String::from)).collect()
        };
        Ok(Self {
            title: record["title"].as_str().map_or_else(|| dir.display().to_string(), String::from),
            series: table(&dir.join("series.csv"))?,
            shapes: shapes(dir, results)?,
            bed,
            picture: read(&dir.join("bed.png"))?,
            numerics: NUMERICS.iter().flat_map(|s| quantities(&record[*s])).map(|(_, q)| q).collect(),
            phases,
            identity_residual: results["cov_identity_residual"].as_f64(),
            warnings: strings(&record["warnings"]),
            provenance: provenance(&record),
            scene_text: text("scene.ron")?.unwrap_or_default(),
        })
    }
}

/// The record of a run folder as it is written.
pub(super) fn record(dir: &Path) -> Result<Value, ReportError> {
    let path = dir.join("run.json");
    let text = read(&path)?
        .ok_or_else(|| ReportError::Read { path: path.clone(), source: ErrorKind::NotFound.into() })?;
    serde_json::from_slice(&text).map_err(|source| ReportError::Record { path, source })
}

fn shapes(dir: &Path, results: &Value) -> Result<Vec<ShapeCoating>, ReportError> {
    #[derive(Deserialize)]
    struct Panel {
        shape: String,
    }
    let path = dir.join("coating.vtp");
    let Some(text) = read(&path)? else { return Ok(Vec::new()) };
    let maps =
        vtp::read(&String::from_utf8_lossy(&text)).map_err(|source| ReportError::Surface { path, source })?;
    let mut names: Vec<String> =
        table::<Panel>(&dir.join("panels.csv"))?.into_iter().map(|p| p.shape).collect();
    names.dedup();
    let tablets: Vec<TabletRow> = table(&dir.join("tablets.csv"))?;
    let coating = |(number, map): (usize, ThicknessMap)| {
        // The record's limit is that of the first shape; a run of several shapes keeps one under each shape's name.
        let name = names.get(number).cloned().unwrap_or_else(|| format!("shape {number}"));
        let own = if number == 0 { results } else { &results["shapes"][&name] };
        ShapeCoating {
            limit: limit(&own["cov_intra_asymptote"]),
            orientation_only: own["cov_intra_orientation_only"].as_f64(),
            orientation_monte_carlo: own["cov_intra_orientation_monte_carlo"].as_f64(),
            order_tensor: own["cov_intra_order_tensor"].as_f64(),
            inter_exponent: exponent(&own["cov_inter_exponent"]),
            spread_exponent: exponent(&own["sd_cov_intra_exponent"]),
            residence_cov: own["cov_residence_time"].as_f64(),
            tablets: tablets.iter().filter(|t| t.shape == name).cloned().collect(),
            map: Some(map),
            name,
        }
    };
    Ok(maps.into_iter().enumerate().map(coating).collect())
}

fn exponent(value: &Value) -> Option<Exponent> {
    Exponent::deserialize(value).ok()
}

fn limit(value: &Value) -> Option<Limit> {
    Some(Limit {
        value: value["value"].as_f64()?,
        low: value["low"].as_f64()?,
        high: value["high"].as_f64()?,
        noise_time_s: value["noise_time_s"].as_f64(),
    })
}

/// Every string and number of the record outside its results, one level of sections deep.
fn provenance(record: &Value) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    for (key, value) in entries(record).filter(|(key, _)| key.as_str() != "title") {
        rows.extend(plain(value).map(|text| (words(key), text)));
        if !["results", "performance"].contains(&key.as_str()) && !NUMERICS.contains(&key.as_str()) {
            rows.extend(
                entries(value).filter_map(|(k, v)| {
                    Some((format!("{}: {}", words(key), k.replace('_', " ")), plain(v)?))
                }),
            );
        }
    }
    rows
}

fn plain(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// The numbers of a section with their keys.
fn quantities(section: &Value) -> Vec<(String, Quantity)> {
    let quantity = |(key, value): (&String, &Value)| {
        let number = value.as_f64()?;
        let (name, unit) = UNITS
            .iter()
            .find_map(|(suffix, unit)| Some((key.strip_suffix(suffix)?, *unit)))
            .unwrap_or((key.as_str(), ""));
        let error = section["standard_errors"][key].as_f64();
        Some((key.clone(), Quantity { name: words(name), value: number, error, unit: unit.into() }))
    };
    entries(section).filter_map(quantity).collect()
}

/// Endings of keys and the units they stand for; longer endings first.
const UNITS: [(&str, &str); 14] = [
    ("_m_per_s", "m/s"),
    ("_per_min", "1/min"),
    ("_deg", "°"),
    ("_percent", "%"),
    ("_N_m", "N m"),
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_kg", "kg"),
    ("_Pa", "Pa"),
    ("_J", "J"),
    ("_m3", "m³"),
    ("_m", "m"),
    ("_s", "s"),
    ("_N", "N"),
];

/// `angle_of_repose` as "Angle of repose".
fn words(key: &str) -> String {
    let mut text = key.replace('_', " ");
    if let Some(first) = text.get_mut(0..1) {
        first.make_ascii_uppercase();
    }
    text
}

fn entries(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

/// The bytes of a file; `None` when there is none.
fn read(path: &Path) -> Result<Option<Vec<u8>>, ReportError> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Read { path: path.into(), source }),
    }
}

/// The rows of a CSV file; none when there is no file.
fn table<Row: for<'de> Deserialize<'de>>(path: &Path) -> Result<Vec<Row>, ReportError> {
    let Some(text) = read(path)? else { return Ok(Vec::new()) };
    let rows = csv::Reader::from_reader(&text[..]).deserialize().collect::<Result<Vec<Row>, _>>();
    rows.map_err(|source| ReportError::Table { path: path.into(), source })
}
