//! What threads do in a step: pieces of fixed size, so that results do not depend on the number of threads.
//!
//! Each piece is compiled for the widest vector instructions of the machine, which is why what it calls is inlined.

use super::batch::{Batch, Exchange, Rule};
use super::energy::Press;
use super::groups::Group;
use super::law::PairLaw;
use super::lease::Lease;
use super::links::{Cursor, LinkDesk};
use super::pairs::{Pair, Scratch, Setting};
use super::side::Side;
use super::sieve::Pose;
use super::walls::{Boundary, WallList, WallWatch};
use crate::scene::DampingMass;
use std::cell::RefCell;

/// What a thread works in: used by one task after another, so that it stays in the nearest memory.
#[derive(Debug, Default)]
pub(super) struct Desk {
    scratch: Scratch,
    batch: Batch,
    touching: LinkDesk,
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
    /// Of all bodies; none where all are single spheres.
    pub poses: Option<&'a [Pose]>,
    pub laws: &'a [PairLaw],
    pub damping: DampingMass,
    pub keep_contacts: bool,
}

impl pulp::NullaryFnOnce for PairTask<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { setting, .. } = self;
        let Desk { scratch, batch, touching } = self.desk;
        let Group { pairs, links, findings } = self.group;
        findings.clear();
        let mut alert = std::mem::take(&mut scratch.alert);
        let spent = find(&mut alert, pairs, setting.odometers);
        let worn = worn(&mut alert[..spent], pairs, &mut scratch.leases, setting);
        let mut cursor = Cursor::default();
        for &k in &alert[..worn] {
            pairs[k as usize].renew(setting, scratch, (links, &mut cursor));
        }
        findings.rebuilt = worn as u32;
        scratch.alert = alert;
        links.touch(touching, setting, self.poses, batch);
        let rule = Rule { damping: self.damping, inside: 0.5, dt: setting.dt };
        let mut first = 0;
        while let Some((places, (a, b))) = touching.meeting(first, batch.len()) {
            first = places.end;
            let sides = (&setting.side(a as usize), &setting.side(b as usize));
            let law = setting.law_of(a as usize, b as usize);
            let springs = touching.former(places.clone());
            batch.meet((a, b), 0, (places, springs), law, sides);
        }
        batch.work_out(self.laws, &rule, |a, b| (setting.side(a as usize), setting.side(b as usize)));
        for meeting in batch.meetings() {
            findings.touching.push(batch.exchange(meeting, self.laws));
        }
        links.keep(batch.springs());
        if self.keep_contacts {
            findings.presses.extend(batch.presses(self.laws, setting.dt));
        }
        batch.clear();
    }
}

/// Puts the numbers of the pairs whose lists may lack something first in `found` and returns how many there are, without
/// a branch for each: none could be foreseen.
#[inline(always)]
fn find(found: &mut Vec<u32>, pairs: &[Pair], odometers: &[f64]) -> usize {
    if found.len() < pairs.len() {
        found.resize(pairs.len(), 0);
    }
    let mut count = 0;
    for (k, pair) in pairs.iter().enumerate() {
        found[count] = k as u32;
        count += usize::from(pair.spent(odometers));
    }
    count
}

/// Puts those of the numbers first whose lists are to be made anew, and returns how many there are. Leases are fetched before
/// any is looked at: they come from memory side by side then.
#[inline(always)]
fn worn(numbers: &mut [u32], pairs: &mut [Pair], leases: &mut Vec<Lease>, setting: &Setting<'_>) -> usize {
    if leases.len() < numbers.len() {
        leases.resize(numbers.len(), Lease::NONE);
    }
    for (at, &k) in numbers.iter().enumerate() {
        leases[at] = pairs[k as usize].lease();
    }
    let mut count = 0;
    for at in 0..numbers.len() {
        let k = numbers[at];
        numbers[count] = k;
        let pair = &mut pairs[k as usize];
        let pose = pair.pose(setting.motions);
        count += usize::from(!pair.holds(&leases[at], &pose, setting.odometers));
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
    pub laws: &'a [PairLaw],
    pub damping: DampingMass,
    pub keep_contacts: bool,
    pub boundaries: &'a [Boundary],
}

impl pulp::NullaryFnOnce for WallTask<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { watches, lists, setting, boundaries, .. } = self;
        let Desk { scratch, batch, .. } = self.desk;
        let findings = self.findings;
        findings.clear();
        let rule = Rule { damping: self.damping, inside: 0.0, dt: setting.dt };
        let sides = |body: u32, surface: u32| {
            (setting.side(body as usize), Side::surface(&boundaries[surface as usize].motion))
        };
        for (k, watch) in watches.iter_mut().enumerate().filter(|(_, w)| w.alert(setting.odometers)) {
            let boundary = &boundaries[watch.surface as usize];
            lists[k].refresh(watch, setting, boundary, scratch);
            lists[k].look(watch, k, setting, boundary, scratch, batch);
        }
        batch.work_out(self.laws, &rule, sides);
        for meeting in batch.meetings() {
            findings.touching.push(batch.exchange(meeting, self.laws));
            let (list, springs) = batch.springs_of(meeting);
            lists[list].keep(springs);
        }
        if self.keep_contacts {
            findings.presses.extend(batch.presses(self.laws, setting.dt));
        }
        batch.clear();
    }
}
