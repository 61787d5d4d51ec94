//! Exact visible areas of convex bodies seen along −y: what the raster must come to on average.

use nalgebra::Vector2;
use pancoat::shapes::TabletShape;
use pancoat::stepping::BodyState;

type Polygon = Vec<Vector2<f64>>;

/// Areas (m²) of the panels of `body` that are seen from above within the rectangle |z| < `half[0]`, |x| < `half[1]`,
/// past the convex body `before`, if any.
pub(crate) fn seen_areas(
    shape: &TabletShape,
    body: &BodyState,
    before: Option<(&TabletShape, &BodyState)>,
    half: [f64; 2],
) -> Vec<f64> {
    let zone = vec![
        Vector2::new(-half[0], -half[1]),
        Vector2::new(half[0], -half[1]),
        Vector2::new(half[0], half[1]),
        Vector2::new(-half[0], half[1]),
    ];
    let outline = before.map(|(shape, body)| hull(projected(shape, body)));
    let vertices = projected(shape, body);
    let triangles = &shape.panels.as_ref().expect("the shape has panels").triangles;
    triangles
        .iter()
        .map(|triangle| {
            let panel: Polygon = triangle.map(|v| vertices[v as usize]).to_vec();
            if area(&panel) <= 0.0 {
                return 0.0;
            }
            let panel = common(&panel, &zone);
            area(&panel) - outline.as_ref().map_or(0.0, |outline| area(&common(&panel, outline)))
        })
        .collect()
}

/// Vertices seen from above: z to the right, x up, so that what faces up keeps its sense of turning.
fn projected(shape: &TabletShape, body: &BodyState) -> Polygon {
    let vertices = &shape.panels.as_ref().expect("the shape has panels").vertices;
    vertices.iter().map(|v| body.orientation * v + body.position).map(|v| Vector2::new(v.z, v.x)).collect()
}

/// Area of a polygon, positive when it turns counter-clockwise.
fn area(polygon: &[Vector2<f64>]) -> f64 {
    (2..polygon.len()).map(|k| (polygon[k - 1] - polygon[0]).perp(&(polygon[k] - polygon[0])) / 2.0).sum()
}

/// The part of a polygon inside a convex one (Sutherland and Hodgman 1974), both counter-clockwise.
fn common(polygon: &[Vector2<f64>], convex: &[Vector2<f64>]) -> Polygon {
    let mut rest = polygon.to_vec();
    for (k, from) in convex.iter().enumerate() {
        let along = convex[(k + 1) % convex.len()] - from;
        let inside = |point: &Vector2<f64>| along.perp(&(point - from));
        let corners = std::mem::take(&mut rest);
        for (k, b) in corners.iter().enumerate() {
            let a = corners[(k + corners.len() - 1) % corners.len()];
            let (da, db) = (inside(&a), inside(b));
            if (da < 0.0) != (db < 0.0) {
                rest.push(a + (b - a) * (da / (da - db)));
            }
            if db >= 0.0 {
                rest.push(*b);
            }
        }
    }
    rest
}

/// Convex hull, counter-clockwise (Andrew 1979).
fn hull(mut points: Polygon) -> Polygon {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = Vector2<f64>>| {
        let mut chain: Polygon = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp(&(point - b)) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}
