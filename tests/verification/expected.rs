//! The expected values of `scenes/verification/expected.csv`, which anyone can compare with `bodies.csv` after
//! `pancoat run scenes/verification/NAME.ron`. Every scene of single bodies has at least one; tolerances are absolute, in the column's unit.

use super::support::{folder, run};
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Debug, Deserialize)]
struct Row {
    scene: String,
    body: usize,
    column: String,
    expected: f64,
    tolerance: f64,
}

#[test]
fn scenes_end_as_expected() {
    let mut reader = csv::Reader::from_path(folder().join("expected.csv")).expect("is a table");
    let rows: Vec<Row> = reader.deserialize().collect::<Result<_, _>>().expect("has these columns");
    let mut ends = BTreeMap::new();
    for row in &rows {
        let bodies = ends.entry(&row.scene).or_insert_with(|| run(&row.scene, &[]));
        let state = &bodies[row.body];
        let part = |v: &nalgebra::Vector3<f64>, axis: &str| v["xyz".find(axis).expect("is an axis")];
        let found = match row.column.split_at(row.column.len() - 1) {
            ("", axis) => part(&state.position, axis),
            ("v", axis) => part(&state.velocity, axis),
            ("w", axis) => part(&state.spin, axis),
            _ => panic!("no column {}", row.column),
        };
        let error = (found - row.expected).abs();
        assert!(
            error <= row.tolerance,
            "{} body {} {}: {found} for {}",
            row.scene,
            row.body,
            row.column,
            row.expected
        );
    }
    let files = std::fs::read_dir(folder()).expect("is there").map(|f| f.expect("can be listed").path());
    for file in files.filter(|f| f.extension().is_some_and(|e| e == "ron")) {
        let name = file.file_stem().expect("has a name").to_string_lossy().into_owned();
        // Their tests look at sums over bodies and at fingerprints.
        let sums = ["elastic_gas", "off_centre_pair", "small_bed", "two_compressed"];
        assert!(ends.contains_key(&name) != sums.contains(&name.as_str()), "{name} has no expected value");
    }
}
