//! What a tablet is: solids by the dimensions people have.

use std::path::PathBuf;

/// A solid. Lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub enum Recipe {
    /// A sphere.
    Sphere {
        /// Diameter, m.
        diameter: f64,
    },
    /// Circular band with two equal caps.
    Round {
        /// Diameter of the band, m.
        diameter: f64,
        /// Height of the band, m.
        band: f64,
        /// The cap on each side.
        cap: Cap,
    },
    /// Band of any outline with two equal caps.
    Pressed {
        /// What the tablet looks like from above.
        outline: Outline,
        /// Height of the band, m.
        band: f64,
        /// The cap on each side.
        cap: Cap,
    },
    /// A closed triangle mesh; the tablet's axis is z of the file.
    Mesh {
        /// STL, OBJ or PLY file, as resolved from the scene file's folder.
        path: PathBuf,
        /// Metres per unit of the file: 0.001 for mm.
        scale: f64,
    },
    /// A clump given sphere by sphere (`x y z r` in m, body frame at the centre of mass), with its own inertia.
    Clump {
        /// File of `x y z r` rows, as resolved from the scene file's folder.
        path: PathBuf,
        /// Principal moments of inertia per unit mass, m².
        inertia_per_mass: [f64; 3],
    },
}

/// The outline of a tablet seen along its axis, length along x, width along y. Lengths in m.
///
/// Almond, oval and triangular outlines are given by their support function p(t), the distance from the middle of the
/// tangent whose outward normal is at angle t to the length: p = p₀ + c₂ cos 2t + c₄ cos 4t + c₃ cos 3t (almond) or
/// c₃ sin 3t (triangular), with p₀ = (L + W)/4 − c₄ and c₂ = (L − W)/4, so that length and width are exact. The
/// outline is convex where p + p'', its radius of curvature, is positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    /// Blunt at both ends.
    Oval {
        /// Length L, m.
        length: f64,
        /// Width W, m.
        width: f64,
        /// c₄, m: 0 is the plain oval, negative values fill it towards a rectangle.
        fourth_harmonic: f64,
    },
    /// One end more pointed than the other: the one at +x for a positive c₃.
    Almond {
        /// Length L, m.
        length: f64,
        /// Width W, m.
        width: f64,
        /// c₄, m.
        fourth_harmonic: f64,
        /// c₃, m.
        third_harmonic: f64,
    },
    /// One long side flatter than the other.
    Triangular {
        /// Length L, m.
        length: f64,
        /// Width W, m.
        width: f64,
        /// c₄, m.
        fourth_harmonic: f64,
        /// c₃, m.
        third_harmonic: f64,
    },
    /// Two half circles and two straight sides (caplet); a circle when both are equal.
    Capsule {
        /// Length, m, at least the width.
        length: f64,
        /// Width, m.
        width: f64,
    },
    /// A half circle at one end, square at the other.
    Bullet {
        /// Length, m, more than half the width.
        length: f64,
        /// Width, m.
        width: f64,
    },
    /// Part of a circle cut off by a straight side.
    HalfMoon {
        /// Length of the straight side, m.
        length: f64,
        /// Largest distance from the straight side, m, at most half the length.
        width: f64,
    },
    /// A straight edge, and two arcs that leave it at right angles and meet in a point.
    Shield {
        /// From the straight edge to the point, m, at least half the width.
        length: f64,
        /// Length of the straight edge, m.
        width: f64,
    },
}

/// The cap of a tablet: z(s) above the band, s = 0 at the axis, 1 at the band. On an outline that is not a circle, s
/// is the factor by which the outline is shrunk towards its middle, and "radius" means (length + width)/4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cap {
    /// Part of a sphere; flat when the height is 0.
    Spherical {
        /// Height above the band, m, at most the radius.
        height: f64,
    },
    /// z = height (1 − s^exponent): larger exponents are fuller cups.
    Compound {
        /// Height above the band, m.
        height: f64,
        /// Exponent, dimensionless, above 1.
        exponent: f64,
    },
    /// A flat face with a bevelled edge.
    Bevelled {
        /// Height above the band, m.
        height: f64,
        /// Width of the bevel seen along the axis, m, below the radius.
        width: f64,
    },
}

impl Recipe {
    /// What makes the recipe impossible, in words for the person who wrote it; `None` when it can be built.
    ///
    /// ```
    /// use pancoat::scene::{Cap, Recipe};
    /// let round = |diameter| Recipe::Round { diameter, band: 3e-3, cap: Cap::Spherical { height: 1e-3 } };
    /// assert_eq!(round(10e-3).fault(), None);
    /// assert!(round(1e-3).fault().unwrap().starts_with("the cap is 1 mm high"));
    /// ```
    pub fn fault(&self) -> Option<String> {
        match self {
            Self::Sphere { diameter } => positive("diameter", *diameter),
            Self::Round { diameter, band, cap } => positive("diameter", *diameter)
                .or_else(|| not_negative("band", *band))
                .or_else(|| cap.fault(diameter / 2.0))
                .or_else(|| flat(*band, *cap)),
            Self::Pressed { outline, band, cap } => outline
                .fault()
                .or_else(|| not_negative("band", *band))
                .or_else(|| cap.fault(outline.mean_radius()))
                .or_else(|| flat(*band, *cap)),
            Self::Mesh { scale, .. } => positive("scale", *scale),
            Self::Clump { inertia_per_mass: [a, b, c], .. } => {
                [a, b, c].into_iter().find_map(|&moment| positive("inertia_per_mass", moment)).or_else(|| {
                    let impossible = a + b < *c || b + c < *a || c + a < *b;
                    impossible
                        .then(|| "one moment of inertia is larger than the other two together".to_owned())
                })
            }
        }
    }
}

impl Outline {
    /// Length and width, m.
    pub fn size(&self) -> (f64, f64) {
        match *self {
            Self::Oval { length, width, .. }
            | Self::Almond { length, width, .. }
            | Self::Triangular { length, width, .. }
            | Self::Capsule { length, width }
            | Self::Bullet { length, width }
            | Self::HalfMoon { length, width }
            | Self::Shield { length, width } => (length, width),
        }
    }

    /// (length + width)/4, m: the radius that caps refer to.
    pub fn mean_radius(&self) -> f64 {
        let (length, width) = self.size();
        (length + width) / 4.0
    }

    /// p₀, c₂, c₄, c₃ (m) of an outline given by its support function.
    pub fn harmonics(&self) -> Option<[f64; 4]> {
        let (fourth, third) = match *self {
            Self::Oval { fourth_harmonic, .. } => (fourth_harmonic, 0.0),
            Self::Almond { fourth_harmonic, third_harmonic, .. }
            | Self::Triangular { fourth_harmonic, third_harmonic, .. } => (fourth_harmonic, third_harmonic),
            _ => return None,
        };
        let (length, width) = self.size();
        Some([self.mean_radius() - fourth, (length - width) / 4.0, fourth, third])
    }

    fn fault(&self) -> Option<String> {
        let (length, width) = self.size();
        positive("length", length).or_else(|| positive("width", width)).or_else(|| {
            let limit = match self {
                Self::Oval { .. } | Self::Almond { .. } | Self::Triangular { .. } => return self.hollow(),
                Self::Capsule { .. } if length < width => "a capsule is at least as long as it is wide",
                Self::Bullet { .. } if length <= width / 2.0 => "a bullet is longer than half its width",
                Self::HalfMoon { .. } if width > length / 2.0 => {
                    "a half moon is at most half as wide as it is long"
                }
                Self::Shield { .. } if length < width / 2.0 => {
                    "a shield is at least half as long as it is wide"
                }
                _ => return None,
            };
            Some(format!("{limit}; here length {}, width {}", mm(length), mm(width)))
        })
    }

    /// Looks along the outline for a radius of curvature p + p'' = p₀ − 3 c₂ cos 2t − 15 c₄ cos 4t − 8 c₃ cos 3t that
    /// is not positive. Triangular outlines have sin 3t for cos 3t.
    fn hollow(&self) -> Option<String> {
        let [mean, second, fourth, third] = self.harmonics()?;
        let steps = 720;
        (0..steps).map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(steps)).find_map(|t| {
            let odd = if matches!(self, Self::Triangular { .. }) { (3.0 * t).sin() } else { (3.0 * t).cos() };
            let radius =
                mean - 3.0 * second * (2.0 * t).cos() - 15.0 * fourth * (4.0 * t).cos() - 8.0 * third * odd;
            let at = t.to_degrees();
            let convex = radius > 0.0;
            (!convex).then(|| {
                format!(
                    "the outline is not convex where its normal is at {at:.0} degrees: use smaller harmonics"
                )
            })
        })
    }
}

impl Cap {
    fn fault(&self, radius: f64) -> Option<String> {
        match *self {
            Self::Spherical { height } => not_negative("height", height).or_else(|| {
                (height > radius)
                    .then(|| format!("the cap is {} high on a radius of {}", mm(height), mm(radius)))
            }),
            Self::Compound { height, exponent } => not_negative("height", height).or_else(|| {
                let good = exponent > 1.0 && exponent.is_finite();
                (!good).then(|| format!("the cap's exponent is {exponent}; expected more than 1"))
            }),
            Self::Bevelled { height, width } => {
                not_negative("height", height).or_else(|| positive("width", width)).or_else(|| {
                    (width >= radius)
                        .then(|| format!("the bevel is {} wide on a radius of {}", mm(width), mm(radius)))
                })
            }
        }
    }

    /// Height above the band in the middle, m.
    pub fn height(&self) -> f64 {
        match *self {
            Self::Spherical { height } | Self::Compound { height, .. } | Self::Bevelled { height, .. } => {
                height
            }
        }
    }
}

fn flat(band: f64, cap: Cap) -> Option<String> {
    (band + cap.height() <= 0.0).then(|| "the tablet has no thickness: band and caps are 0".to_owned())
}

fn positive(name: &str, value: f64) -> Option<String> {
    let good = value > 0.0 && value.is_finite();
    (!good).then(|| format!("{name} is {value}; expected a positive number"))
}

fn not_negative(name: &str, value: f64) -> Option<String> {
    let good = value >= 0.0 && value.is_finite();
    (!good).then(|| format!("{name} is {value}; expected a number that is not negative"))
}

fn mm(length: f64) -> String {
    format!("{} mm", (length * 1e9).round() / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAP: Cap = Cap::Spherical { height: 1e-3 };

    fn fault(outline: Outline) -> Option<String> {
        Recipe::Pressed { outline, band: 3e-3, cap: CAP }.fault()
    }

    #[test]
    fn outlines_are_held_to_their_limits() {
        let (length, width) = (10e-3, 12e-3);
        assert_eq!(
            fault(Outline::Capsule { length, width }).as_deref(),
            Some("a capsule is at least as long as it is wide; here length 10 mm, width 12 mm")
        );
        assert_eq!(fault(Outline::Bullet { length, width }), None);
        assert!(fault(Outline::HalfMoon { length, width }).is_some());
        assert_eq!(fault(Outline::Shield { length, width }), None);
    }

    #[test]
    fn hollow_outlines_are_found() {
        let oval = |fourth_harmonic| Outline::Oval { length: 19.2e-3, width: 10.8e-3, fourth_harmonic };
        assert_eq!(fault(oval(-0.2211e-3)), None);
        assert!(fault(oval(1e-3)).expect("too much").starts_with("the outline is not convex"));
        assert!(fault(oval(f64::NAN)).is_some());
    }

    #[test]
    fn caps_and_bands_are_held_to_their_limits() {
        let round = |band, cap| Recipe::Round { diameter: 10e-3, band, cap }.fault();
        assert_eq!(round(0.0, CAP), None);
        assert!(round(0.0, Cap::Spherical { height: 0.0 }).is_some());
        assert!(round(1e-3, Cap::Compound { height: 1e-3, exponent: 1.0 }).is_some());
        assert!(round(1e-3, Cap::Bevelled { height: 1e-3, width: 5e-3 }).is_some());
        assert!(round(f64::NAN, CAP).is_some());
    }

    #[test]
    fn moments_of_a_clump_obey_the_triangle_inequality() {
        let clump = |inertia_per_mass| Recipe::Clump { path: "c".into(), inertia_per_mass }.fault();
        assert_eq!(clump([1.0, 1.0, 1.9]), None);
        assert!(clump([1.0, 1.0, 2.1]).is_some());
    }
}
