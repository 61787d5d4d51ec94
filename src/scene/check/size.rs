//! How large a solid is, from its dimensions alone.

use super::super::recipe::{Cap, Outline, Recipe};
use std::f64::consts::PI;

/// Volume, m³, and largest extent along its own axes, m, of the solid; `None` if that takes reading a file.
pub(super) fn volume_and_extent(recipe: &Recipe) -> Option<(f64, f64)> {
    let (area, size, radius, band, cap) = match *recipe {
        Recipe::Sphere { diameter } => return Some((PI / 6.0 * diameter.powi(3), diameter)),
        Recipe::Round { diameter, band, cap } => {
            (PI / 4.0 * diameter * diameter, diameter, diameter / 2.0, band, cap)
        }
        Recipe::Pressed { outline, band, cap } => {
            let (length, width) = outline.size();
            (area(&outline), length.max(width), outline.mean_radius(), band, cap)
        }
        Recipe::Mesh { .. } | Recipe::Clump { .. } => return None,
    };
    let volume = area * (band + 2.0 * mean_height(cap, radius));
    Some((volume, size.max(band + 2.0 * cap.height())))
}

/// Volume of a cap over the area of the band, m: ∫₀¹ z(s) 2s ds (derived here).
///
/// h(3R² + h²)/6R² for part of a sphere, h m/(m + 2) for a compound cap with exponent m, and h(1 + s₀ + s₀²)/3 for a
/// bevel that begins at s₀ = 1 − width/R.
fn mean_height(cap: Cap, radius: f64) -> f64 {
    match cap {
        Cap::Spherical { height } => height * (3.0 + (height / radius).powi(2)) / 6.0,
        Cap::Compound { height, exponent } => height * exponent / (exponent + 2.0),
        Cap::Bevelled { height, width } => {
            let start = 1.0 - width / radius;
            height * (1.0 + start + start * start) / 3.0
        }
    }
}

/// Area within an outline, m² (derived here).
///
/// Within a support function p = p₀ + Σ cₙ cos nt it is ½∮(p² − p'²) dt = π(p₀² − ½ Σ (n² − 1) cₙ²).
fn area(outline: &Outline) -> f64 {
    if let Some([mean, second, fourth, third]) = outline.harmonics() {
        return PI * (mean * mean - 1.5 * second * second - 7.5 * fourth * fourth - 4.0 * third * third);
    }
    let (length, width) = outline.size();
    match outline {
        Outline::Bullet { .. } => (length - width / 2.0) * width + PI / 8.0 * width * width,
        Outline::HalfMoon { .. } => segment(length, width),
        // Its halves on both sides of the middle are the halves of one segment.
        Outline::Shield { .. } => segment(2.0 * length, width / 2.0),
        _ => (length - width) * width + PI / 4.0 * width * width,
    }
}

/// Area, m², of the part of a circle that a chord cuts off.
fn segment(chord: f64, height: f64) -> f64 {
    let radius = (chord * chord / 4.0 + height * height) / (2.0 * height);
    let to_chord = radius - height;
    radius * radius * (to_chord / radius).acos() - to_chord * chord / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn size(recipe: &Recipe) -> (f64, f64) {
        volume_and_extent(recipe).expect("is a solid")
    }

    /// The paper's round tablet has 1042 mm³; a ball is a band of no height with two hemispheres.
    #[test]
    fn volumes_of_round_tablets() {
        let cap = Cap::Compound { height: 1.6973e-3, exponent: 2.8823 };
        let (volume, extent) = size(&Recipe::Round { diameter: 15.9e-3, band: 3.2452e-3, cap });
        assert_relative_eq!(volume, 1042e-9, max_relative = 1e-3);
        assert_eq!(extent, 15.9e-3);
        let halves = Recipe::Round { diameter: 2.0, band: 0.0, cap: Cap::Spherical { height: 1.0 } };
        let ball = Recipe::Sphere { diameter: 2.0 };
        assert_relative_eq!(size(&halves).0, size(&ball).0, max_relative = 1e-15);
        // A cone: the bevel takes nearly all of the face.
        let cap = Cap::Bevelled { height: 1.0, width: 1.0 - 1e-9 };
        let cones = Recipe::Round { diameter: 2.0, band: 0.0, cap };
        assert_relative_eq!(size(&cones).0, 2.0 * PI / 3.0, max_relative = 1e-8);
    }

    #[test]
    fn areas_within_outlines() {
        let (length, width) = (2.0, 2.0);
        assert_relative_eq!(area(&Outline::Capsule { length, width }), PI, max_relative = 1e-15);
        let circle = Outline::Oval { length, width, fourth_harmonic: 0.0 };
        assert_relative_eq!(area(&circle), PI, max_relative = 1e-15);
        let half = Outline::HalfMoon { length: 2.0, width: 1.0 };
        assert_relative_eq!(area(&half), PI / 2.0, max_relative = 1e-15);
        assert_relative_eq!(area(&Outline::Bullet { length, width }), 2.0 + PI / 2.0, max_relative = 1e-15);
        let half = Outline::Shield { length: 1.0, width: 2.0 };
        assert_relative_eq!(area(&half), PI / 2.0, max_relative = 1e-15);
    }

    /// The polygon along the outline, x = p cos t − p' sin t, y = p sin t + p' cos t, has the same area.
    #[test]
    fn area_of_the_almond() {
        let almond =
            Outline::Almond { length: 20.6, width: 12.1, fourth_harmonic: -0.0403, third_harmonic: 0.1807 };
        let [mean, second, fourth, third] = almond.harmonics().expect("is given by them");
        let point = |k: u32| {
            let t = f64::from(k) * PI / 2000.0;
            let p = mean + second * (2.0 * t).cos() + fourth * (4.0 * t).cos() + third * (3.0 * t).cos();
            let slope = -2.0 * second * (2.0 * t).sin()
                - 4.0 * fourth * (4.0 * t).sin()
                - 3.0 * third * (3.0 * t).sin();
            (p * t.cos() - slope * t.sin(), p * t.sin() + slope * t.cos())
        };
        let triangles = (0..4000).map(|k| (point(k), point(k + 1)));
        let polygon: f64 = triangles.map(|((x, y), (u, v))| (x * v - u * y) / 2.0).sum();
        assert_relative_eq!(area(&almond), polygon, max_relative = 1e-5);
    }
}
