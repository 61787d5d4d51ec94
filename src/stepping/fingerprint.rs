//! The state of a run in one number.

use super::simulation::Simulation;

impl Simulation {
    /// Fingerprint of positions, orientations, velocities, momenta and springs, bit by bit and as they are numbered.
    pub fn state_hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        let mut put = |x: f64| {
            hasher.update(&x.to_bits().to_le_bytes());
        };
        for (body, motion) in self.bodies.iter().zip(&self.motions) {
            motion.position.iter().for_each(|x| put(*x));
            body.orientation.coords.iter().for_each(|x| put(*x));
            body.velocity.iter().chain(&body.momentum).for_each(|x| put(*x));
        }
        for (a, b, i, j, stretch) in self.field.springs() {
            [a, b, i, j].map(f64::from).into_iter().chain(stretch.iter().copied()).for_each(&mut put);
        }
        hasher.finalize().to_hex().to_string()
    }
}
