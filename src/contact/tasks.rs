//! What threads do in a step: pieces of fixed size, so that results do not depend on the number of threads.
//!
//! Each piece is compiled for the widest vector instructions of the machine, which is why what it calls is inlined.

use super::batch::{Batch, Exchange, Rule};
use super::energy::Press;
use super::frames::Frame;
use super::groups::Group;
use super::links::Links;
use super::pairs::{Scratch, Setting};
use super::side::Side;
use super::walls::{Boundary, Hold, WallList, WallWatch};
use crate::world::World;
use nalgebra::Vector3;
use pulp::{Simd, WithSimd};
use std::cell::RefCell;

/// What a thread works in: used by one task after another, so that it stays in the nearest memory.
#[derive(Debug, Default)]
pub(super) struct Desk {
    scratch: Scratch,
    batch: Batch,
    links: Links,
    /// Grips of a body that hold, and where.
    grips: Vec<(usize, Hold)>,
    /// List and number of the grips in the batch.
    held: Vec<(usize, usize)>,
}

thread_local! {
    /// The desk of this thread.
    pub(super) static DESK: RefCell<Desk> = RefCell::default();
}

/// What one task found in the last step.
#[derive(Debug, Clone, Default)]
pub(super) struct Findings {
    pub touching: Vec<Exchange>,
    /// Contact by contact, when asked for.
    pub presses: Vec<Press>,
    /// Lists built anew.
    pub rebuilt: u32,
}

impl Findings {
    fn clear(&mut self) {
        self.touching.clear();
        self.presses.clear();
        self.rebuilt = 0;
    }
}

/// The pairs that one task looks at.
pub(super) struct PairTask<'a> {
    pub group: &'a mut Group,
    pub desk: &'a mut Desk,
    pub setting: &'a Setting<'a>,
    pub rule: Rule<'a>,
}

impl WithSimd for PairTask<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { setting, rule, .. } = self;
        let Desk { scratch, batch, links, .. } = self.desk;
        let Group { wakes, pairs, lists, links: kept, findings } = self.group;
        findings.clear();
        std::mem::swap(&mut links.all, kept);
        let mut alert = std::mem::take(&mut scratch.alert);
        let count = find(&mut alert, wakes, setting.pace);
        for &k in &alert[..count] {
            let k = k as usize;
            let mut left = pairs[k].left(setting.odometers);
            if left <= 0.0 {
                let anew;
                (left, anew) = lists[k].renew(&mut pairs[k], setting, scratch, links);
                findings.rebuilt += u32::from(anew);
            }
            wakes[k] = setting.pace + 0.5 * left;
        }
        scratch.alert = alert;
        links.replaced();
        links.touch(setting);
        let frames = |(a, b): (u32, u32)| (&setting.frames[a as usize], &setting.frames[b as usize]);
        let sides = |(a, b): (u32, u32)| (setting.side(a as usize), setting.side(b as usize));
        batch.clear();
        for k in 0..links.touching() {
            let bodies = links.bodies(k);
            let law = setting.law_of(bodies);
            if batch.is_full(bodies, law) {
                work_out(simd, batch, &rule, frames, sides, findings);
                links.keep(batch.springs());
                batch.clear();
            }
            batch.take(bodies, law, &links.place(k, setting), frames(bodies));
        }
        work_out(simd, batch, &rule, frames, sides, findings);
        links.keep(batch.springs());
        std::mem::swap(&mut links.all, kept);
    }
}

/// Works out the contacts of a batch and adds them to the findings.
#[inline(always)]
fn work_out<'a, S: Simd>(
    simd: S,
    batch: &mut Batch,
    rule: &Rule<'_>,
    frames: impl Fn((u32, u32)) -> (&'a Frame, &'a Frame),
    sides: impl Fn((u32, u32)) -> (Side<'a>, Side<'a>),
    findings: &mut Findings,
) {
    batch.work_out(simd, rule, sides);
    let offset = |bodies| {
        let (a, b) = frames(bodies);
        a.offset(b)
    };
    findings.touching.extend(batch.exchanges(offset));
    if rule.keep_contacts {
        findings.presses.extend(batch.presses(simd, rule));
    }
}

/// Puts the numbers of the `wakes` before `pace` first in `found` and returns how many there are, without a branch for
/// each: none could be foreseen.
#[inline(always)]
fn find(found: &mut Vec<u32>, wakes: &[f64], pace: f64) -> usize {
    if found.len() < wakes.len() {
        found.resize(wakes.len(), 0);
    }
    let mut count = 0;
    for (k, wake) in wakes.iter().enumerate() {
        found[count] = k as u32;
        count += usize::from(*wake < pace);
    }
    count
}

/// The walls that one task looks at.
pub(super) struct WallTask<'a> {
    pub watches: &'a mut [WallWatch],
    pub lists: &'a mut [WallList],
    pub desk: &'a mut Desk,
    pub findings: &'a mut Findings,
    pub setting: &'a Setting<'a>,
    pub rule: Rule<'a>,
    pub boundaries: &'a [Boundary],
    pub world: &'a World,
}

impl WithSimd for WallTask<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { watches, lists, setting, rule, boundaries, world, .. } = self;
        let Desk { scratch, batch, grips, held, .. } = self.desk;
        let findings = self.findings;
        findings.clear();
        let facets = |surface: &Boundary, min: &Vector3<f64>, max: &Vector3<f64>, out: &mut Vec<u32>| {
            world.facets_near(surface.mesh, min, max, out);
        };
        let frames = |(body, surface): (u32, u32)| {
            (&setting.frames[body as usize], &boundaries[surface as usize].frame)
        };
        let sides = |(body, surface): (u32, u32)| {
            (setting.side(body as usize), Side::surface(&boundaries[surface as usize].motion))
        };
        batch.clear();
        held.clear();
        for (k, watch) in watches.iter_mut().enumerate().filter(|(_, w)| w.alert(setting.odometers)) {
            let bodies = (watch.body, watch.surface);
            let boundary = &boundaries[watch.surface as usize];
            lists[k].refresh(watch, setting, boundary, facets, &mut scratch.facets);
            lists[k].look(watch, setting, boundary, grips);
            let law = setting.law(setting.bodies[watch.body as usize].material, boundary.material);
            if batch.is_full(bodies, law) {
                work_out(simd, batch, &rule, frames, sides, findings);
                keep(lists, held, batch);
                batch.clear();
            }
            for (grip, hold) in grips.drain(..) {
                batch.take(bodies, law, &hold.place(), frames(bodies));
                held.push((k, grip));
            }
        }
        work_out(simd, batch, &rule, frames, sides, findings);
        keep(lists, held, batch);
    }
}

/// Gives the springs of a batch back to the grips that `held` them: list and number.
fn keep(lists: &mut [WallList], held: &mut Vec<(usize, usize)>, batch: &Batch) {
    for ((list, grip), spring) in held.drain(..).zip(batch.springs()) {
        lists[list].grips[grip].spring = spring;
    }
}
