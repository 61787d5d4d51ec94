//! Where the energy of a contact is, and what its forces take out of the motion.
//!
//! With ξ the tangential displacement and S(δ) the tangential stiffness, the spring of [`TangentialLaw::Total`] holds
//! E = ½ S ξ². Its force S ξ does the work S ξ·ξ̇, but dE/dt = S ξ·ξ̇ + ½ Ṡ ξ²: what a changing overlap adds to E or takes
//! from it comes from no force. The incremental laws carry the force f and hold E = f²/2S; there dE/dt = f·ξ̇ − ½ Ṡ f²/S².
//! No choice of E closes the sum, because these laws have no potential; so the difference between the work done on the
//! springs and the growth of E has an account of its own, which is negative where a law creates energy.
//!
//! In a step the spring takes up the work ½ (f₀ + f)·u on the slip u, with its force f₀ before and f after. Friction cuts the
//! spring back by the plastic slip p, which slides ½ (f₀ + f) p away. What of the work is neither slid away nor in the
//! springs afterwards is the change of stiffness. On the bodies f acts over half the slip before and half the slip after:
//! the halves outside a contact, before it begins and after it ends, stretch nothing and are slid away.

use super::field::{ContactField, Partner};
use super::groups::Group;
use super::law::{PairLaw, Spring};
use crate::scene::TangentialLaw;
use nalgebra::Vector3;

/// A contact of the last step. Forces are those on the partner.
#[derive(Debug, Clone, Copy)]
pub struct ContactState<'a> {
    /// Index of the body.
    pub body: usize,
    /// What it touches.
    pub partner: Partner,
    /// Sphere of the body, and sphere of the other body or smooth patch of the surface.
    pub parts: (u32, u32),
    /// What happens there.
    pub press: &'a Press,
    /// Its law.
    pub law: &'a PairLaw,
}

/// Place, deformation and forces of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// Index of the law.
    pub(super) law: usize,
    /// Unit normal from the body to its partner.
    pub normal: Vector3<f64>,
    /// Overlap δ, m.
    pub overlap: f64,
    /// From the body's centre of mass to the common contact point, m.
    pub arm: Vector3<f64>,
    /// Slip of the step that led here, m.
    pub slip: Vector3<f64>,
    /// The spring at the end of the step.
    pub spring: Spring,
    /// Force of the spring, N.
    pub spring_force: Vector3<f64>,
    /// Forces of the dashpots, along the normal and in the tangent plane, N.
    pub dashpot_forces: [Vector3<f64>; 2],
    /// Whole force, N.
    pub force: Vector3<f64>,
}

impl ContactField {
    /// Keeps the contacts of every step from now on, one by one; it costs memory and time.
    pub fn keep_contacts(&mut self) {
        self.keep_contacts = true;
    }

    /// The contacts of the last step in a fixed order, if they are kept: between bodies by (body, partner, parts), then at
    /// surfaces likewise.
    pub fn contacts<'a>(&'a self) -> impl Iterator<Item = ContactState<'a>> {
        let state = |press: &'a Press, body: u32, partner, parts| ContactState {
            body: body as usize,
            partner,
            parts,
            press,
            law: &self.laws[press.law],
        };
        let touching = |group: &'a Group| group.links.touching().zip(&group.findings.presses);
        let pairs = self.groups.all.iter().flat_map(touching).map(move |(grasp, press)| {
            let (a, b) = grasp.bodies;
            state(press, a, Partner::Body(b as usize), self.spheres(&grasp))
        });
        let grips = self.wall_watches.iter().zip(&self.walls).flat_map(|(watch, list)| {
            list.grips.iter().filter(|grip| grip.touching).map(move |grip| (watch, grip))
        });
        let presses = self.found_at_walls.iter().flat_map(|found| &found.presses);
        pairs.chain(grips.zip(presses).map(move |((watch, grip), press)| {
            let partner = Partner::Surface(watch.surface as usize);
            state(press, watch.body, partner, (u32::from(grip.sphere), grip.patch))
        }))
    }
}

impl PairLaw {
    /// Energy of the normal deformation, J: ∫ 4/3 E* √R* δ^1.5 dδ = 8/15 E* √R* δ^2.5 = 4/15 S_n δ².
    ///
    /// `contact_radius` is √(R* δ), m.
    pub fn normal_energy(&self, contact_radius: f64, overlap: f64) -> f64 {
        4.0 / 15.0 * self.normal_stiffness(contact_radius) * overlap * overlap
    }

    /// Energy of a spring whose force is `force`, N, in J: ½ f²/S, for all laws.
    pub fn spring_energy(&self, force: &Vector3<f64>, contact_radius: f64) -> f64 {
        0.5 * force.norm_squared() / self.stiffness(contact_radius)
    }

    /// The tangential stiffness, never 0.
    fn stiffness(&self, contact_radius: f64) -> f64 {
        self.tangential_stiffness(contact_radius).max(f64::MIN_POSITIVE)
    }
}

impl ContactState<'_> {
    /// Energy of the normal deformation, J.
    pub fn normal_energy(&self) -> f64 {
        self.law.normal_energy(self.press.spring.radius, self.press.overlap)
    }

    /// Energy of the tangential spring, J.
    pub fn spring_energy(&self) -> f64 {
        self.law.spring_energy(&self.press.spring_force, self.press.spring.radius)
    }

    /// What stretched the spring in the step, m: a contact that is new began half a step ago.
    fn way(&self, before: Option<&Spring>) -> Vector3<f64> {
        self.press.slip * if before.is_some() { 1.0 } else { 0.5 }
    }

    /// Work of the step on the spring, J; `before` is the spring after the step before, if it touched then.
    pub fn work(&self, before: Option<&Spring>) -> f64 {
        let old = before.map_or_else(Vector3::zeros, |spring| self.law.spring_force(spring));
        -0.5 * (self.press.spring_force + old).dot(&self.way(before))
    }

    /// Work that the force of a contact's first step does outside of it, J: over the half step before it began, as over the
    /// other half.
    pub fn outside_before(&self, before: Option<&Spring>) -> f64 {
        if before.is_some() { 0.0 } else { self.work(None) }
    }

    /// Work that the force would do outside the contact if this were its last step of `dt`, s, in J; `velocity` is that of
    /// the partner against the body there after the kick, m/s.
    pub fn outside_after(&self, velocity: &Vector3<f64>, dt: f64) -> f64 {
        -self.press.spring_force.dot(&(velocity * dt - self.press.slip * 0.5))
    }

    /// What of the work was slid away, J.
    pub fn slid(&self, before: Option<&Spring>) -> f64 {
        let Press { normal, spring, spring_force, force, .. } = self.press;
        let held = spring_force.norm();
        if held < self.law.friction * force.dot(normal).abs() * (1.0 - 1e-9) {
            return 0.0;
        }
        let stiffness = self.law.stiffness(spring.radius);
        let way = self.way(before);
        let old = before.map_or(0.0, |spring| self.law.spring_force(spring).norm());
        let (before, old_radius) = before.map_or((Vector3::zeros(), 0.0), |b| (b.stretch, b.radius));
        // Units of the spring per displacement, and what unloading left of it.
        let (unit, kept) = match self.law.tangential {
            TangentialLaw::Total => (1.0, 1.0),
            TangentialLaw::Rescaled if spring.radius < old_radius => (stiffness, spring.radius / old_radius),
            TangentialLaw::Incremental | TangentialLaw::Rescaled => (stiffness, 1.0),
        };
        let flat = before - normal * before.dot(normal);
        let trial = flat * kept + way * unit;
        0.5 * (old + held) * (trial.norm() / unit - held / stiffness)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::{Dashpots, Touch};
    use super::*;
    use crate::scene::{ContactSettings, Material, PairProperties};

    fn law(tangential: TangentialLaw) -> PairLaw {
        let material = Material { name: "m".into(), shear_modulus: 1e6, poisson: 0.25 };
        let pair = PairProperties { friction: 0.5, restitution: 1.0 };
        PairLaw::new(&material, &material, pair, ContactSettings { tangential, ..ContactSettings::default() })
    }

    #[test]
    fn the_normal_energy_is_the_work_of_the_normal_force() {
        let law = law(TangentialLaw::Total);
        let (radius, deepest, steps) = (3e-3_f64, 1e-4, 10_000);
        let work: f64 = (0..steps)
            .map(|k| deepest * (f64::from(k) + 0.5) / f64::from(steps))
            .map(|d| 2.0 / 3.0 * law.normal_stiffness((radius * d).sqrt()) * d * deepest / f64::from(steps))
            .sum();
        let energy = law.normal_energy((radius * deepest).sqrt(), deepest);
        assert!((work / energy - 1.0).abs() < 1e-7, "{work} for {energy}");
    }

    /// A contact slid to and fro: the work of its force is in the spring or slid away; while it sticks, nothing is slid
    /// away; drawn along at the friction limit it is the friction force times the way.
    #[test]
    fn work_on_a_spring_is_stored_or_slid() {
        for tangential in [TangentialLaw::Total, TangentialLaw::Incremental, TangentialLaw::Rescaled] {
            let law = law(tangential);
            let (overlap, dt, normal) = (1e-4, 1e-5, Vector3::y());
            let radius = (3e-3_f64 * overlap).sqrt();
            let limit = 0.5 * 2.0 / 3.0 * law.normal_stiffness(radius) * overlap;
            let (mut spring, mut work, mut slid, mut way) = (Spring::default(), 0.0, 0.0, 0.0);
            for k in 0..4000 {
                let velocity = Vector3::x() * 0.05 * (f64::from(k) * 2e-3).cos();
                let before = spring;
                let touch = Touch { normal, overlap, velocity, twirl: 0.0 };
                let dashpots = Dashpots { normal: 0.0, tangential: 0.0 };
                let force = law.force(&touch, radius, dashpots, dt, &mut spring);
                let press = Press {
                    law: 0,
                    normal,
                    overlap,
                    arm: Vector3::zeros(),
                    slip: velocity * dt,
                    spring,
                    spring_force: force.tangential,
                    dashpot_forces: [Vector3::zeros(); 2],
                    force: force.tangential + normal * force.normal,
                };
                assert!((law.spring_force(&spring) - force.tangential).norm() < 1e-12 * limit);
                let state = ContactState {
                    body: 0,
                    partner: Partner::Body(1),
                    parts: (0, 0),
                    press: &press,
                    law: &law,
                };
                let lost = state.slid(Some(&before));
                if force.sliding {
                    way += press.slip.norm();
                } else {
                    assert_eq!(lost, 0.0);
                }
                (work, slid) = (work + state.work(Some(&before)), slid + lost);
            }
            let stored = work - slid;
            let energy = 0.5 * spring_force_squared(&law, &spring, radius) / law.tangential_stiffness(radius);
            assert!((stored / energy - 1.0).abs() < 2e-2, "{tangential:?}: {stored} for {energy}");
            assert!((slid / (limit * way) - 1.0).abs() < 1e-3, "{slid} for {}", limit * way);
        }
    }

    fn spring_force_squared(law: &PairLaw, spring: &Spring, radius: f64) -> f64 {
        let unit =
            if law.tangential == TangentialLaw::Total { law.tangential_stiffness(radius) } else { 1.0 };
        (spring.stretch * unit).norm_squared()
    }

    /// At a fixed spring an overlap that grows by a factor 4 doubles the stiffness: the spring of the total law gains its
    /// energy once more from nothing, that of the incremental laws loses half of it. Neither is work or sliding.
    #[test]
    fn a_changing_stiffness_has_its_own_account() {
        let normal = Vector3::y();
        for (tangential, change) in [(TangentialLaw::Total, 1.0), (TangentialLaw::Incremental, -0.5)] {
            let law = law(tangential);
            let press = |overlap: f64, force: f64| Press {
                law: 0,
                normal,
                overlap,
                arm: Vector3::zeros(),
                slip: Vector3::zeros(),
                spring: Spring { stretch: Vector3::zeros(), radius: (3e-3 * overlap).sqrt() },
                spring_force: Vector3::x() * force,
                dashpot_forces: [Vector3::zeros(); 2],
                force: normal * 10.0,
            };
            let grown = if tangential == TangentialLaw::Total { 2.0 } else { 1.0 };
            let (old, new) = (press(1e-5, 0.1), press(4e-5, 0.1 * grown));
            let state =
                |press| ContactState { body: 0, partner: Partner::Body(1), parts: (0, 0), press, law: &law };
            assert_eq!(
                (state(&new).work(Some(&old.spring)), state(&new).slid(Some(&old.spring))),
                (0.0, 0.0)
            );
            let before = state(&old).spring_energy();
            assert!(((state(&new).spring_energy() - before) / before - change).abs() < 1e-12);
        }
    }
}
