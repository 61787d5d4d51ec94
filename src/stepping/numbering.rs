//! Numbers of bodies: in the scene they are in its order, within a large bed by place, so that what near bodies read of
//! each other lies near in memory.

use super::simulation::Simulation;
use crate::contact::Partner;
use crate::world::reorder;

/// Fewer bodies than this, of some 3 kB each, are in reach in any order.
const MANY: usize = 2000;
/// Steps between two numberings: much less than it takes a bed to mix, much more than making all lists anew costs.
const EVERY: u64 = 2000;

impl Simulation {
    /// Numbers the bodies of a large bed by place when `steps` have been made and it is time again.
    pub(super) fn number_by_place(&mut self, steps: u64) {
        let is_time = self.step / EVERY != (self.step - steps) / EVERY;
        if is_time && self.bodies.len() >= MANY && self.impulses.is_none() && self.audit.is_none() {
            self.renumber(&self.world.by_place());
        }
    }

    /// Numbers the bodies anew, those whose numbers were `order` from 0 on.
    fn renumber(&mut self, order: &[u32]) {
        self.world.renumber(order);
        self.field.renumber(order);
        reorder(&mut self.bodies, order);
        reorder(&mut self.motions, order);
        reorder(&mut self.wrenches, order);
        reorder(&mut self.odometers, order);
        reorder(&mut self.numbers, order);
    }

    /// What is `of` each body, in the order of the scene.
    pub(super) fn in_order<T>(&self, of: impl Fn(usize) -> T) -> Vec<T> {
        let mut bodies: Vec<usize> = (0..self.numbers.len()).collect();
        bodies.sort_unstable_by_key(|body| self.numbers[*body]);
        bodies.into_iter().map(of).collect()
    }

    /// The body's number in the scene.
    pub(super) fn number(&self, body: usize) -> usize {
        self.numbers[body] as usize
    }

    /// The deepest contact of the last step, by numbers in the scene: its body, and the other body or the surface.
    pub(super) fn deepest_contact(&self) -> Option<(usize, Partner)> {
        self.field.deepest().map(|(body, partner)| match partner {
            Partner::Body(other) => (self.number(body), Partner::Body(self.number(other))),
            Partner::Surface(_) => (self.number(body), partner),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::small_bed::small_bed;
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    #[test]
    fn other_numbers_change_nothing_but_rounding() {
        let mut simulation = small_bed(40, 10);
        let mut renumbered = simulation.clone();
        let n = simulation.bodies.len() as u32;
        let order: Vec<u32> = (0..n).map(|k| (7 * k + 3) % n).collect();
        renumbered.renumber(&order);
        assert_eq!(simulation.states(), renumbered.states());
        for frames in [1, 4] {
            let contacts = [&mut simulation, &mut renumbered].map(|simulation| {
                simulation.run(0, frames, &mut [], &mut |_| true).expect("runs");
                (simulation.tally.sphere_contacts, simulation.tally.wall_contacts)
            });
            assert_eq!(contacts[0], contacts[1]);
            for (one, other) in simulation.states().iter().zip(&renumbered.states()) {
                assert!((one.position - other.position).norm() < 1e-10);
                assert!((one.spin - other.spin).norm() < 1e-6);
            }
        }
        assert!(simulation.tally.sphere_contacts > 20 && simulation.tally.wall_contacts > 20);
    }

    /// Balls that fall on a floor side by side: what is read of a large bed is in the order of its scene, whatever the
    /// numbers of the bodies.
    #[test]
    fn bodies_keep_their_place_in_the_scene() {
        let text = r#"(
            format: 1,
            title: "balls on a floor",
            materials: {"tablet": (shear_modulus: MPa(1), poisson: 0.25)},
            pairs: [(between: ("tablet", "tablet"), friction: 0.5, restitution: 0.5)],
            shapes: {"ball": (recipe: Sphere(diameter: Mm(8)))},
            bodies: [(shape: "ball", material: "tablet", mass: Mg(300), position: Mm(0, 5, 0))],
            boundaries: [(surface: Plane(point: Mm(0, 0, 0), normal: (0, 1, 0)), material: "tablet")],
            time: (duration: S(1), frame_interval: Ms(20), step: Fixed(Us(200))),
        )"#;
        let mut scene = Scene::parse(text, "balls.ron", Path::new(""), &[]).expect("is valid");
        let place = |k: usize| (9e-3 * (k * 29 % 53) as f64, 9e-3 * (k / 53) as f64);
        let ball = scene.bodies[0].clone();
        scene.bodies = (0..MANY + 120)
            .map(|k| {
                let mut ball = ball.clone();
                (ball.position.x, ball.position.z) = place(k);
                ball.mass = 1e-6 * (300 + k) as f64;
                ball
            })
            .collect();
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("is built");
            pool.install(|| {
                let mut simulation = Simulation::new(&scene).expect("is built");
                simulation.run(0, EVERY / 100 + 1, &mut [], &mut |_| true).expect("runs");
                simulation
            })
        };
        let simulation = run(1);
        assert_eq!(simulation.state_hash(), run(3).state_hash());
        assert!(!simulation.numbers.is_sorted(), "the bodies have other numbers than in the scene");
        for (k, (state, mass)) in simulation.states().iter().zip(simulation.masses()).enumerate() {
            assert_eq!(((state.position.x, state.position.z), mass), (place(k), scene.bodies[k].mass));
            assert!((3.5e-3..4e-3).contains(&state.position.y), "ball {k} lies at {} m", state.position.y);
        }
    }
}
