//! What threads do in a step: pieces of fixed size, so that results do not depend on the number of threads.
//!
//! Each piece is compiled for the widest vector instructions of the machine, which is why what it calls is inlined.

use super::batch::{Batch, Exchange, Rule};
use super::energy::Press;
use super::law::PairLaw;
use super::memory::Memory;
use super::pairs::{BodyPair, PairWatch, Scratch, Setting};
use super::side::Side;
use super::walls::{Boundary, WallList, WallWatch};
use crate::scene::DampingMass;
use crate::world::World;
use nalgebra::Vector3;

/// Contacts that are worked out together at least: what they need stays in the nearest memory.
const BATCH: usize = 64;

/// What one task works in, and what it found in the last step.
#[derive(Debug, Clone, Default)]
pub(super) struct Desk {
    pub scratch: Scratch,
    batch: Batch,
    /// Of the contacts between bodies.
    pub memory: Memory,
    pub touching: Vec<Exchange>,
    /// Contact by contact, when asked for.
    pub presses: Vec<Press>,
}

/// The pairs that one task looks at.
pub(super) struct PairTask<'a> {
    pub watches: &'a mut [PairWatch],
    pub lists: &'a mut [Box<BodyPair>],
    pub desk: &'a mut Desk,
    pub setting: &'a Setting<'a>,
    pub laws: &'a [PairLaw],
    pub damping: DampingMass,
    pub keep_contacts: bool,
}

impl pulp::NullaryFnOnce for PairTask<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { watches, lists, setting, .. } = self;
        let Desk { scratch, batch, memory, touching, presses } = self.desk;
        touching.clear();
        presses.clear();
        memory.turn_over();
        let rule = Rule { damping: self.damping, inside: 0.5, dt: setting.dt };
        // Alone, so that the lists are fetched from memory side by side.
        let mut alert = std::mem::take(&mut scratch.alert);
        alert.clear();
        alert.extend(
            watches
                .iter()
                .zip(lists.iter())
                .enumerate()
                .filter(|(_, (watch, _))| watch.alert(setting.odometers))
                .map(|(k, (watch, list))| (k as u32, list.worn(watch, setting.odometers))),
        );
        for (at, &(k, worn)) in alert.iter().enumerate() {
            let k = k as usize;
            lists[k].look(&mut watches[k], worn, setting, scratch, memory, batch);
            if batch.len() >= BATCH || at + 1 == alert.len() {
                let sides = |a: u32, b: u32| (setting.side(a as usize), setting.side(b as usize));
                batch.work_out(self.laws, &rule, sides, |exchange, _, springs| {
                    touching.push(exchange);
                    memory.keep(springs);
                });
                if self.keep_contacts {
                    presses.extend(batch.presses(self.laws, setting.dt));
                }
                batch.clear();
            }
        }
        scratch.alert = alert;
    }
}

/// The walls that one task looks at.
pub(super) struct WallTask<'a> {
    pub watches: &'a mut [WallWatch],
    pub lists: &'a mut [WallList],
    pub desk: &'a mut Desk,
    pub setting: &'a Setting<'a>,
    pub laws: &'a [PairLaw],
    pub damping: DampingMass,
    pub keep_contacts: bool,
    pub boundaries: &'a [Boundary],
    pub world: &'a World,
}

impl pulp::NullaryFnOnce for WallTask<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { watches, lists, setting, boundaries, world, .. } = self;
        let Desk { scratch, batch, touching, presses, .. } = self.desk;
        touching.clear();
        presses.clear();
        let rule = Rule { damping: self.damping, inside: 0.0, dt: setting.dt };
        let facets = |surface: &Boundary, min: &Vector3<f64>, max: &Vector3<f64>, out: &mut Vec<u32>| {
            world.facets_near(surface.mesh, min, max, out);
        };
        let sides = |body: u32, surface: u32| {
            (setting.side(body as usize), Side::surface(&boundaries[surface as usize].motion))
        };
        for (k, watch) in watches.iter_mut().enumerate().filter(|(_, w)| w.alert(setting.odometers)) {
            let boundary = &boundaries[watch.surface as usize];
            lists[k].refresh(watch, setting, boundary, facets, &mut scratch.facets);
            lists[k].look(watch, k, setting, boundary, scratch, batch);
        }
        batch.work_out(self.laws, &rule, sides, |exchange, list, springs| {
            touching.push(exchange);
            lists[list].keep(springs);
        });
        if self.keep_contacts {
            presses.extend(batch.presses(self.laws, setting.dt));
        }
        batch.clear();
    }
}
