//! A box tree over triangles: the nearest point of a surface, and the triangles near a box.

use nalgebra::Vector3;

/// Triangles in a leaf at most. Any small number does.
const LEAF: usize = 4;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: Vector3<f64>,
    high: Vector3<f64>,
}

impl Bounds {
    /// The smallest box that holds the points.
    pub(super) fn of<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> Self {
        let empty = Self { low: Vector3::repeat(f64::INFINITY), high: Vector3::repeat(f64::NEG_INFINITY) };
        points.into_iter().fold(empty, |b, p| Self { low: b.low.inf(p), high: b.high.sup(p) })
    }

    /// Lengths of the edges, m.
    pub(super) fn extents(&self) -> Vector3<f64> {
        self.high - self.low
    }

    fn square_distance(&self, p: &Vector3<f64>) -> f64 {
        (self.low - p).sup(&(p - self.high)).sup(&Vector3::zeros()).norm_squared()
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }
}

/// The tree; nodes are in depth-first order, a node's first child follows it.
#[derive(Debug, Clone)]
pub(super) struct TriangleTree {
    triangles: Vec<[Vector3<f64>; 3]>,
    /// Triangle numbers in the order of the leaves.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    content: Content,
}

#[derive(Debug, Clone, Copy)]
enum Content {
    /// Range of `order`.
    Leaf { first: usize, end: usize },
    /// Number of the second child.
    Branch { second: usize },
}

/// A point of the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The point, m.
    pub(super) point: Vector3<f64>,
    /// Distance from the point asked for, m.
    pub(super) distance: f64,
}

impl TriangleTree {
    /// Over at least one triangle.
    pub(super) fn new(triangles: Vec<[Vector3<f64>; 3]>) -> Self {
        let order = (0..triangles.len() as u32).collect();
        let mut tree = Self { triangles, order, nodes: Vec::new() };
        tree.build(0, tree.order.len());
        tree
    }

    /// Halves a range of `order` at the median along the longest edge of its box.
    fn build(&mut self, first: usize, end: usize) {
        let triangles = &self.triangles;
        let of = |t: u32| &triangles[t as usize];
        let bounds = Bounds::of(self.order[first..end].iter().flat_map(|&t| of(t)));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, content: Content::Leaf { first, end } });
        if end - first > LEAF {
            let axis = bounds.extents().imax();
            let key = |t: u32| of(t).iter().map(|p| p[axis]).sum::<f64>();
            let half = (end - first) / 2;
            self.order[first..end]
                .select_nth_unstable_by(half, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            self.build(first, first + half);
            self.nodes[node].content = Content::Branch { second: self.nodes.len() };
            self.build(first + half, end);
        }
    }

    /// The point of the surface nearest to `p`.
    pub(super) fn nearest(&self, p: &Vector3<f64>) -> Foot {
        let mut best = Foot { point: *p, distance: f64::INFINITY };
        let mut square = f64::INFINITY;
        let mut stack = vec![(0, self.nodes[0].bounds.square_distance(p))];
        while let Some((node, distance)) = stack.pop() {
            if distance > square {
                continue;
            }
            match self.nodes[node].content {
                Content::Leaf { first, end } => {
                    for &t in &self.order[first..end] {
                        let point = closest_point(&self.triangles[t as usize], p);
                        let to_point = (point - p).norm_squared();
                        if to_point < square {
                            square = to_point;
                            best = Foot { point, distance: to_point.sqrt() };
                        }
                    }
                }
                Content::Branch { second } => {
                    let mut children =
                        [node + 1, second].map(|n| (n, self.nodes[n].bounds.square_distance(p)));
                    children.sort_by(|a, b| b.1.total_cmp(&a.1));
                    stack.extend(children);
                }
            }
        }
        best
    }

    /// Numbers of the triangles whose boxes overlap that of triangle `t`, itself among them, in no useful order.
    pub(super) fn near(&self, t: usize) -> Vec<usize> {
        let bounds = Bounds::of(&self.triangles[t]);
        let mut found = Vec::new();
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            if self.nodes[node].bounds.overlaps(&bounds) {
                match self.nodes[node].content {
                    Content::Leaf { first, end } => {
                        found.extend(self.order[first..end].iter().map(|&t| t as usize));
                    }
                    Content::Branch { second } => stack.extend([node + 1, second]),
                }
            }
        }
        found.retain(|&other| Bounds::of(&self.triangles[other]).overlaps(&bounds));
        found
    }
}

/// The point of a triangle nearest to `p` (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
fn closest_point(corners: &[Vector3<f64>; 3], p: &Vector3<f64>) -> Vector3<f64> {
    let [a, b, c] = *corners;
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(&(p - a)), ac.dot(&(p - a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(&(p - b)), ac.dot(&(p - b)));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(&(p - c)), ac.dot(&(p - c)));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let share = 1.0 / (va + vb + vc);
    a + ab * (vb * share) + ac * (vc * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::sphere::sphere_panels;
    use proptest::prelude::*;

    fn corners() -> Vec<[Vector3<f64>; 3]> {
        let panels = sphere_panels(1.0, 320);
        panels.triangles.iter().map(|t| t.map(|v| panels.vertices[v as usize])).collect()
    }

    proptest! {
        #[test]
        fn tree_and_brute_force_agree(x in -2.0..2.0, y in -2.0..2.0, z in -2.0..2.0) {
            let p = Vector3::new(x, y, z);
            let brute = corners().iter().map(|t| (closest_point(t, &p) - p).norm()).fold(f64::INFINITY, f64::min);
            let foot = TriangleTree::new(corners()).nearest(&p);
            prop_assert!((foot.distance - brute).abs() < 1e-14);
            prop_assert!(((foot.point - p).norm() - brute).abs() < 1e-14);
        }

        #[test]
        fn closest_point_is_never_beaten_by_a_point_of_the_triangle(
            p in prop::array::uniform3(-2.0..2.0), u in 0.0..1.0, v in 0.0..1.0,
        ) {
            let triangle = [[0., 0., 0.], [1., 0.2, 0.], [0.3, 0.9, 0.5]].map(Vector3::from);
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let other: Vector3<f64> = triangle[0] + (triangle[1] - triangle[0]) * u + (triangle[2] - triangle[0]) * v;
            let p = Vector3::from(p);
            prop_assert!((closest_point(&triangle, &p) - p).norm() <= (other - p).norm() + 1e-12);
        }
    }

    #[test]
    fn neighbours_of_a_triangle_are_near() {
        let triangles = corners();
        let near = TriangleTree::new(triangles.clone()).near(7);
        let shares = |t: usize| triangles[t].iter().any(|p| triangles[7].contains(p));
        assert!((0..triangles.len()).filter(|&t| shares(t)).all(|t| near.contains(&t)));
        assert!(near.len() < 60);
    }
}
