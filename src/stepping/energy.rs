//! Where the energy of a run is and where it went.
//!
//! Kicks change velocities by F Δt/m, half before and half after the velocity v of a step is known, so that the kinetic
//! energy of bodies changes by F·v Δt in each step, exactly, but for what the first and last half step leave. What a
//! force does is therefore booked as F·v Δt with the velocities after the kick: dashpots and walls. Elastic energies are
//! functions of state; springs and sliding are booked as `contact::energy` derives.

use super::body::Body;
use super::simulation::Simulation;
use crate::contact::{ContactState, Partner, Spring};
use crate::world::Motion;
use nalgebra::Vector3;

/// Energies of a run at one instant, J, and what has gone where since the audit began.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy of translation and rotation.
    pub kinetic: f64,
    /// Potential energy in gravity, zero at the origin.
    pub potential: f64,
    /// Elastic energy of overlaps.
    pub elastic_normal: f64,
    /// Elastic energy of tangential springs.
    pub elastic_tangential: f64,
    /// Dissipated by dashpots along the normal.
    pub normal_dashpots: f64,
    /// Dissipated by tangential dashpots.
    pub tangential_dashpots: f64,
    /// Dissipated by sliding.
    pub sliding: f64,
    /// Lost from tangential springs because the overlap, and with it their stiffness, changed; negative where the law
    /// creates energy.
    pub stiffness_change: f64,
    /// Work of the walls on the bodies.
    pub wall_work: f64,
    /// What all these sum up to when the audit begins.
    initial: f64,
}

impl Energy {
    /// All that dashpots and sliding took, J.
    pub fn dissipated(&self) -> f64 {
        self.normal_dashpots + self.tangential_dashpots + self.sliding
    }

    /// What is there and has gone less what was there and came in, J: zero but for the error of the motion.
    pub fn residual(&self) -> f64 {
        self.total() - self.initial
    }

    fn total(&self) -> f64 {
        let there = self.kinetic + self.potential + self.elastic_normal + self.elastic_tangential;
        there + self.dissipated() + self.stiffness_change - self.wall_work
    }
}

impl Simulation {
    /// Begins to book where energy goes.
    pub fn audit_energy(&mut self) {
        self.field.keep_contacts();
        self.audit = Some(EnergyAudit::default());
    }

    /// Energies at the last step, if they are audited.
    pub fn energy(&self) -> Option<Energy> {
        self.audit.as_ref().map(EnergyAudit::energy)
    }
}

/// A contact's name: body, partner (surfaces after bodies), parts.
type Key = (usize, bool, usize, (u32, u32));

/// A contact after a step.
#[derive(Debug, Clone, Copy)]
struct Held {
    key: Key,
    spring: Spring,
    /// What its force has still done if it is the last, J.
    last: f64,
}

/// Books energy from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct EnergyAudit {
    energy: Energy,
    begun: bool,
    /// Contacts after the last step, sorted.
    held: Vec<Held>,
}

impl EnergyAudit {
    pub(super) fn energy(&self) -> Energy {
        self.energy
    }

    /// Takes note of a step of `dt`, s, that has ended with these bodies, at these poses, in these contacts.
    pub(super) fn note<'a>(
        &mut self,
        dt: f64,
        gravity: &Vector3<f64>,
        (bodies, motions): (&[Body], &[Motion]),
        surfaces: &[Motion],
        contacts: impl Iterator<Item = ContactState<'a>>,
    ) {
        let (mut kinetic, mut potential) = (0.0, 0.0);
        let mut ended = motions.to_vec();
        for (body, motion) in bodies.iter().zip(&mut ended) {
            (motion.velocity, motion.spin) = (body.velocity, body.spin(&motion.rotation));
            kinetic += 0.5 * (body.mass * motion.velocity.norm_squared() + body.momentum.dot(&motion.spin));
            potential -= body.mass * gravity.dot(&motion.position);
        }
        let Energy { elastic_tangential, .. } = self.energy;
        let mut now =
            Energy { kinetic, potential, elastic_normal: 0.0, elastic_tangential: 0.0, ..self.energy };
        let mut held = Vec::with_capacity(self.held.len());
        let mut stretching = 0.0;
        now.sliding += self.held.iter().map(|held| held.last).sum::<f64>();
        for contact in contacts {
            let (a, press) = (&ended[contact.body], contact.press);
            let (b, surface, partner) = match contact.partner {
                Partner::Body(k) => (&ended[k], false, k),
                Partner::Surface(k) => (&surfaces[k], true, k),
            };
            let there = b.velocity_at(&(a.position + press.arm - b.position));
            let velocity = there - a.velocity_at(&press.arm);
            let [normal, tangential] = press.dashpot_forces;
            now.normal_dashpots -= normal.dot(&velocity) * dt;
            now.tangential_dashpots -= tangential.dot(&velocity) * dt;
            if surface {
                now.wall_work -= press.force.dot(&there) * dt;
            }
            let key = (contact.body, surface, partner, contact.parts);
            let known = self.held.binary_search_by_key(&key, |held| held.key).ok().map(|k| &self.held[k]);
            let before = known.map(|held| &held.spring);
            let slid = contact.slid(before);
            stretching += contact.work(before) - slid;
            // It was not the last.
            let last = known.map_or(0.0, |held| held.last);
            now.sliding += slid + contact.outside_before(before) - last;
            now.elastic_normal += contact.normal_energy();
            now.elastic_tangential += contact.spring_energy();
            held.push(Held { key, spring: press.spring, last: contact.outside_after(&velocity, dt) });
        }
        now.stiffness_change += stretching - (now.elastic_tangential - elastic_tangential);
        held.sort_unstable_by_key(|held| held.key);
        self.held = held;
        if !std::mem::replace(&mut self.begun, true) {
            let Energy { kinetic, potential, elastic_normal, elastic_tangential, .. } = now;
            now = Energy { kinetic, potential, elastic_normal, elastic_tangential, ..Energy::default() };
            now.initial = now.total();
        }
        self.energy = now;
    }
}
