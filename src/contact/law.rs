//! Hertz-Mindlin (no slip) between two spheres or a sphere and a wall: pure functions.
//!
//! Normal direction n points from body a to body b; u is the velocity of b against a at the contact point; δ > 0 is
//! the overlap. All forces returned act on b.
//!
//! - elastic normal force  F_n = 4/3 E* √R* δ^1.5
//! - normal stiffness      S_n = 2 E* √(R* δ), tangential stiffness S_t = 8 G* √(R* δ)
//! - dashpots              2 √(5/6) β √(S m*) u, with β = −ln e / √(ln² e + π²)
//! - Coulomb               |F_t| ≤ μ |F_n|, F_n with its dashpot; the tangential dashpot acts only while sticking
//!
//! Sources: Hertz 1881; Mindlin & Deresiewicz 1953; Tsuji, Tanaka & Ishida 1992, Powder Technol. 71, 239, for the
//! dashpot; Altair EDEM documentation, "The Hertz-Mindlin (no slip) model", for the set of formulas. Departures: β is
//! taken positive here (EDEM prints ln e / √..., which is negative).

use crate::scene::{ContactSettings, Material, PairProperties, TangentialLaw};
use nalgebra::Vector3;

/// 2 √(5/6), dimensionless: the factor of both dashpots.
const DASHPOT: f64 = 1.825_741_858_350_553_8;

/// Constants of one pair of materials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairLaw {
    /// Effective Young's modulus E*, Pa: 1/E* = (1 − ν_a²)/E_a + (1 − ν_b²)/E_b with E = 2 G (1 + ν).
    pub effective_modulus: f64,
    /// Effective shear modulus G*, Pa: 1/G* = (2 − ν_a)/G_a + (2 − ν_b)/G_b.
    pub effective_shear: f64,
    /// Damping ratio β, dimensionless, 0 (e = 1) to 1 (e = 0).
    pub damping: f64,
    /// Coefficient of sliding friction μ, dimensionless.
    pub friction: f64,
    /// Cut the normal force at zero.
    pub no_tension: bool,
    /// How the tangential spring follows the overlap.
    pub tangential: TangentialLaw,
    /// 2 √(5/6) β √(2 E*) and 2 √(5/6) β √(8 G*), Pa^½: dashpots per √(contact radius × mass).
    pub(super) dashpots: Dashpots,
}

/// Tangential memory of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spring {
    /// Tangential displacement ξ, m, for [`TangentialLaw::Total`]; elastic tangential force over −1, N, for the others.
    pub stretch: Vector3<f64>,
    /// √(R* δ) of the last step, m: the contact radius, used by [`TangentialLaw::Rescaled`].
    pub radius: f64,
}

/// One contact at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// Unit normal from a to b.
    pub normal: Vector3<f64>,
    /// Overlap δ, m.
    pub overlap: f64,
    /// Velocity of b against a at the contact point, mean of the step that led here, m/s.
    pub velocity: Vector3<f64>,
    /// Mean angular velocity of the two bodies about n in that step, rad/s: the spring turns with it.
    pub twirl: f64,
}

/// Dashpot coefficients of a contact, N s/m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dashpots {
    /// Along the normal.
    pub normal: f64,
    /// In the tangent plane.
    pub tangential: f64,
}

/// Force of one contact on body b, N, and whether it slides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Normal part along n, N: elastic plus dashpot, positive pushing apart.
    pub normal: f64,
    /// Tangential part, N: spring plus dashpot.
    pub tangential: Vector3<f64>,
    /// Whether the Coulomb limit is reached.
    pub sliding: bool,
}

impl PairLaw {
    /// The constants of materials `a` and `b`.
    ///
    /// ```
    /// use pancoat::contact::PairLaw;
    /// use pancoat::scene::{ContactSettings, Material, PairProperties};
    /// let tablet = Material { name: "tablet".into(), shear_modulus: 1e6, poisson: 0.25 };
    /// let steel = Material { name: "steel".into(), shear_modulus: 3e6, poisson: 0.3 };
    /// let pair = PairProperties { friction: 0.5, restitution: 0.5 };
    /// let law = PairLaw::new(&tablet, &steel, pair, ContactSettings::default());
    /// assert!((law.effective_modulus - 2.033898305e6).abs() < 1.0);
    /// assert!((law.damping - 0.215454).abs() < 1e-6);
    /// ```
    pub fn new(a: &Material, b: &Material, pair: PairProperties, settings: ContactSettings) -> Self {
        let compliance = |m: &Material| (1.0 - m.poisson) / (2.0 * m.shear_modulus);
        let shear = |m: &Material| (2.0 - m.poisson) / m.shear_modulus;
        let (effective_modulus, effective_shear) =
            (1.0 / (compliance(a) + compliance(b)), 1.0 / (shear(a) + shear(b)));
        let damping = damping_ratio(pair.restitution);
        Self {
            effective_modulus,
            effective_shear,
            damping,
            dashpots: Dashpots {
                normal: DASHPOT * damping * (2.0 * effective_modulus).sqrt(),
                tangential: DASHPOT * damping * (8.0 * effective_shear).sqrt(),
            },
            friction: pair.friction,
            no_tension: settings.no_tension,
            tangential: settings.tangential,
        }
    }

    /// Normal stiffness S_n, N/m, at contact radius √(R* δ), m.
    #[inline]
    pub fn normal_stiffness(&self, contact_radius: f64) -> f64 {
        2.0 * self.effective_modulus * contact_radius
    }

    /// Tangential stiffness S_t, N/m, at contact radius √(R* δ), m.
    #[inline]
    pub fn tangential_stiffness(&self, contact_radius: f64) -> f64 {
        8.0 * self.effective_shear * contact_radius
    }

    /// Dashpots for the reduced mass `mass`, kg.
    #[inline(always)]
    pub fn dashpots(&self, contact_radius: f64, mass: f64) -> Dashpots {
        let root = (contact_radius * mass).sqrt();
        Dashpots { normal: root * self.dashpots.normal, tangential: root * self.dashpots.tangential }
    }

    /// The dashpots that do in steps of `dt` s, on the mean velocity of the step before, what [`PairLaw::dashpots`] do at all
    /// instants; `inverse_mass` in 1/kg.
    #[inline(always)]
    pub(super) fn dashpots_in_steps(&self, contact_radius: f64, inverse_mass: f64, dt: f64) -> Dashpots {
        let Dashpots { normal, tangential } = self.dashpots(contact_radius, 1.0 / inverse_mass);
        let (late, swing) = (dt * inverse_mass, dt * dt * inverse_mass);
        Dashpots {
            normal: normal * stepped(normal * late, self.normal_stiffness(contact_radius) * swing),
            tangential: tangential
                * stepped(RIM * tangential * late, RIM * self.tangential_stiffness(contact_radius) * swing),
        }
    }

    /// Dashpots proportional to the stiffnesses so that a motion of angular frequency `omega`, rad/s, is damped by β.
    ///
    /// Derived here: a single contact has ω² = S_n/m*, for which c = 2 √(5/6) β √(S_n m*) = (2 √(5/6) β/ω) S_n. `dt` is the
    /// step of the velocities they meet, s, for which they are changed as [`stepped`] says, with c/m* = 2 √(5/6) β ω.
    #[inline]
    pub fn dashpots_at(&self, contact_radius: f64, omega: f64, dt: f64) -> Dashpots {
        let (sn, st) = (self.normal_stiffness(contact_radius), self.tangential_stiffness(contact_radius));
        let damped = DASHPOT * self.damping;
        let factor = damped / omega * stepped(damped * omega * dt, (omega * dt).powi(2));
        Dashpots { normal: factor * sn, tangential: factor * (sn * st).sqrt() }
    }

    /// Force on b; `spring` is carried from step to step of `dt` seconds and is updated.
    #[inline(always)]
    pub fn force(
        &self,
        touch: &Touch,
        contact_radius: f64,
        dashpots: Dashpots,
        dt: f64,
        spring: &mut Spring,
    ) -> ContactForce {
        let n = touch.normal;
        let approach = touch.velocity.dot(&n);
        let elastic = 2.0 / 3.0 * self.normal_stiffness(contact_radius) * touch.overlap;
        let mut normal = elastic - dashpots.normal * approach;
        if self.no_tension {
            normal = normal.max(0.0);
        }
        let slip = touch.velocity - n * approach;
        let stiffness = self.tangential_stiffness(contact_radius);
        // The spring follows the places of the bodies. What touches for the first time began to, on average, half a step ago.
        let since = if spring.radius > 0.0 { dt } else { 0.5 * dt };
        let moved = slip * since;
        let mut stretch = carried(&spring.stretch, &n, touch.twirl * dt);
        let (scale, moved) = match self.tangential {
            TangentialLaw::Total => (stiffness, moved),
            TangentialLaw::Incremental => (1.0, moved * stiffness),
            TangentialLaw::Rescaled => {
                stretch *= if contact_radius < spring.radius { contact_radius / spring.radius } else { 1.0 };
                (1.0, moved * stiffness)
            }
        };
        stretch += moved;
        let limit = self.friction * normal.abs();
        let held = scale * stretch.norm();
        let sliding = held > limit;
        stretch *= if sliding { limit / held } else { 1.0 };
        *spring = Spring { stretch, radius: contact_radius };
        let dashpot = if sliding { 0.0 } else { dashpots.tangential };
        ContactForce { normal, tangential: -(stretch * scale) - slip * dashpot, sliding }
    }
}

impl PairLaw {
    /// Force on b of a spring, N.
    pub(super) fn spring_force(&self, spring: &Spring) -> Vector3<f64> {
        match self.tangential {
            TangentialLaw::Total => -spring.stretch * self.tangential_stiffness(spring.radius),
            TangentialLaw::Incremental | TangentialLaw::Rescaled => -spring.stretch,
        }
    }
}

/// (3/2)^{5/4}/(5/4).
const SINGLE: f64 = 1.328_018_303_640_386;

/// Factor on the dashpots of a contact that began less than two steps ago, or ends in less: its `overlap` δ is below twice its
/// `way` w along the normal in a step, m. Else 1.
///
/// Derived here: a force, given for one instant, acts from half a step before it to half a step after. At constant speed dashpots are
/// c ∝ x^¼ with x = δ/w, the time since the contact began over the step. The first two instants of a contact, x and x + 1, are to
/// give ∫₀^{x+3/2} s^¼ ds = (x + 3/2)^{5/4}/(5/4) together, which is [`SINGLE`] where there is but one, at x = 1. As x is not known
/// exactly, the factor has no jumps: it grows from 0 to there and falls to 1, so that what it misses is below 3.4 %. The end is the
/// same backwards. Without it restitution at 12 steps depends eight times as much on where in a step contacts begin and end.
#[inline(always)]
pub(super) fn brevity(overlap: f64, way: f64) -> f64 {
    // Up to x = 1, and what changes from there on.
    let x = (overlap / way).min(2.0);
    let (x, left) = (x.min(1.0), 2.0 - x.max(1.0));
    SINGLE * x * (1.55 - 0.55 * x) + (SINGLE - 1.0) * (left * left - 1.0)
}

/// A sphere answers a force on its rim 1 + m r²/I = 7/2 times as much as one through its centre.
const RIM: f64 = 3.5;

/// Factor on dashpots that meet mean velocities of the step before, so that they damp as much as they are to: q = c dt/m of the
/// step, `swing` = (ω dt)².
///
/// Derived here, from the eigenvalues of xₙ₊₁ − (2 − q' − ω² dt²) xₙ + (1 − q') xₙ₋₁ = 0. On a late velocity v − a dt/2 a dashpot c'
/// acts as c' on v, with the mass lowered from m to m − c' dt/2: the damping ratio stays that of c if c'² = c² (1 − c' dt/2m), or
/// c'/c = √(1 + q²/16) − q/4, which is 1 − q/4 + q²/32 but for q⁴/2048. Steps swing faster by (ω dt)²/24 than time does, so that the
/// motion has to decay faster by as much.
#[inline(always)]
fn stepped(q: f64, swing: f64) -> f64 {
    (1.0 - q * (0.25 - q / 32.0)) * (1.0 + swing / 24.0)
}

/// β = −ln e / √(ln² e + π²); e = 0 gives the limit 1.
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution <= 0.0 {
        return 1.0;
    }
    if restitution >= 1.0 {
        return 0.0;
    }
    let l = restitution.ln();
    -l / l.hypot(std::f64::consts::PI)
}

/// The spring turned with the contact: about n by `angle` (rad), then into the new tangent plane, keeping its length.
///
/// Source: Luding 2008, Granular Matter 10, 235, section 3.2, with the twirl about n added.
#[inline(always)]
fn carried(stretch: &Vector3<f64>, n: &Vector3<f64>, angle: f64) -> Vector3<f64> {
    let turned = stretch + n.cross(stretch) * angle;
    let flat = turned - n * turned.dot(n);
    let flat2 = flat.norm_squared();
    flat * if flat2 > 0.0 { (stretch.norm_squared() / flat2).sqrt() } else { 1.0 }
}
