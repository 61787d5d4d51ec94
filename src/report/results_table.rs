//! The results of several runs as one table.

use super::ReportError;
use super::gather::record;
use serde_json::Value;
use std::path::Path;

/// A CSV table with a row for each run folder: its name, and every number under `results` and `performance` of its record,
/// with names inside names joined by a dot (`cov_intra_asymptote.value`). Runs without a number have an empty cell.
///
/// # Errors
/// [`ReportError`] names the record that is missing or broken.
pub fn results_table<P: AsRef<Path>>(folders: &[P]) -> Result<String, ReportError> {
    let mut columns: Vec<String> = Vec::new();
    let mut runs = Vec::new();
    for folder in folders {
        let folder = folder.as_ref();
        let record = record(folder)?;
        let mut numbers = Vec::new();
        for section in ["results", "performance"] {
            collect("", &record[section], &mut numbers);
        }
        for (name, _) in &numbers {
            if !columns.contains(name) {
                columns.push(name.clone());
            }
        }
        let name = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        runs.push((name, numbers));
    }
    let mut text =
        std::iter::once("run").chain(columns.iter().map(String::as_str)).collect::<Vec<_>>().join(",");
    for (run, numbers) in &runs {
        text += "\n";
        text += &run.replace(',', " ");
        for column in &columns {
            let number = numbers.iter().find(|(name, _)| name == column);
            text += ",";
            text += &number.map_or_else(String::new, |(_, value)| value.to_string());
        }
    }
    Ok(text + "\n")
}

/// Numbers of a value by the way to them.
fn collect(way: &str, value: &Value, numbers: &mut Vec<(String, f64)>) {
    if let Some(number) = value.as_f64() {
        numbers.push((way.to_owned(), number));
    }
    for (name, inner) in value.as_object().into_iter().flatten() {
        let way = if way.is_empty() { name.clone() } else { format!("{way}.{name}") };
        collect(&way, inner, numbers);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_the_columns_of_all() {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let runs =
            [("a", r#"{"results": {"x": 1.5, "limit": {"low": 0.1}}}"#), ("b", r#"{"results": {"y": 2}}"#)];
        for (name, text) in runs {
            std::fs::create_dir(folder.path().join(name)).expect("made");
            std::fs::write(folder.path().join(name).join("run.json"), text).expect("written");
        }
        let table = results_table(&["a", "b"].map(|name| folder.path().join(name))).expect("are there");
        assert_eq!(table, "run,x,limit.low,y\na,1.5,0.1,\nb,,,2\n");
        assert!(results_table(&[folder.path().join("c")]).is_err());
    }
}
