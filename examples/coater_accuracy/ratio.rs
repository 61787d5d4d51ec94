//! The ratio estimator: a panel's exact projected area within the zone times the share of its own pixels that is seen.

use super::clipper::seen_areas;
use super::study::{Bed, Outcome, Row, cpu_seconds, difference};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use pancoat::observers::{Observer, StoredFrame};
use pancoat::stepping::BodyState;

/// Errors and times of single frames at several rasters. The time is that of counting, of drawing each tablet seen once
/// more by itself, and of clipping its panels, the latter also left out; clearing the screen for each tablet is always left
/// out, as one pass would do without.
pub(crate) fn rows(bed: &Bed) -> Outcome<Vec<Row>> {
    let tablet = bed.tablet(1700)?;
    let panels = tablet.panels.as_ref().ok_or("the tablet has panels")?.len();
    let zone = &bed.zone;
    let half = zone.extent.map(|extent| extent / 2.0);
    let zone_area = zone.extent[0] * zone.extent[1];
    // The clipper looks along −y, with z to the right and x upwards.
    let axes = Matrix3::from_rows(&[
        -zone.streamwise.transpose(),
        zone.normal.transpose(),
        zone.spanwise.transpose(),
    ]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let references: Vec<_> =
        bed.single_frames().map(|frame| bed.reference(&tablet, frame)).collect::<Result<_, _>>()?;
    let mut rows = Vec::new();
    for pixels in [[64, 32], [128, 64], [256, 128], [512, 256]] {
        let (mut error, mut cpu, mut clipping) = (0.0, 0.0, 0.0);
        for (frame, reference) in bed.single_frames().zip(&references) {
            let bodies = frame.bodies.len();
            let mut all = bed.coater(&tablet, pixels, bodies)?;
            let mut single = bed.coater(&tablet, pixels, 1)?;
            let nothing = single.ledger().clone();
            let mut found = vec![0.0; bodies * panels];
            let start = cpu_seconds()?;
            all.observe(&frame.as_frame());
            cpu += cpu_seconds()? - start;
            let far =
                BodyState { position: zone.center - zone.normal.cross(&zone.spanwise), ..frame.bodies[0] };
            let alone = |body: BodyState| StoredFrame { bodies: vec![body], ..frame.clone() };
            let empty = alone(far);
            let mut clearing = f64::INFINITY;
            for _ in 0..20 {
                let start = cpu_seconds()?;
                single.observe(&empty.as_frame());
                clearing = clearing.min(cpu_seconds()? - start);
            }
            for seen in all.exposed() {
                let body = frame.bodies[seen.body];
                single.resume(nothing.clone())?;
                let start = cpu_seconds()?;
                single.observe(&alone(body).as_frame());
                cpu += cpu_seconds()? - start - clearing;
                let moved = BodyState {
                    position: turn * (body.position - zone.center),
                    orientation: turn * body.orientation,
                    ..body
                };
                let start = cpu_seconds()?;
                let areas = seen_areas(&tablet, &moved, None, half);
                clipping += cpu_seconds()? - start;
                let counts = all.counts(seen.body).iter().zip(single.counts(0)).zip(&areas);
                for (panel, ((&visible, &own), area)) in counts.enumerate() {
                    if own > 0 {
                        found[seen.body * panels + panel] =
                            area / zone_area * (visible as f64 / own as f64).min(1.0);
                    }
                }
            }
            error += difference(&found, reference) / references.len() as f64;
        }
        for (study, cpu) in [("ratio", cpu + clipping), ("ratio, free clipping", cpu)] {
            let per_frame = cpu / references.len() as f64;
            rows.push(Row {
                study,
                columns: pixels[0],
                rows: pixels[1],
                interval_ms: 20.0,
                panels,
                frame_error: Some(error),
                run_error: None,
                cov_intra: None,
                cov_average_tablet: None,
                cov_inter: None,
                bias_intra: None,
                bias_average_tablet: None,
                cpu_ms_per_frame: 1e3 * per_frame,
                cpu_ms_per_coated_s: 1e3 * per_frame / 0.02,
            });
        }
    }
    Ok(rows)
}
