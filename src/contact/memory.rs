//! What contacts remember from step to step.

use super::law::Spring;

/// Which spheres of which bodies touch: (a, b, i, j).
pub(super) type Key = (u32, u32, u16, u16);

/// A contact with its memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Contact {
    pub key: Key,
    pub spring: Spring,
}

/// The contacts of one step and of the one before, each in the order of its keys, so that both are read through once.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory {
    before: Vec<Contact>,
    /// Those before this one have been passed.
    next: usize,
    pub now: Vec<Contact>,
    /// How many of `now` have their new spring.
    sprung: usize,
}

impl Memory {
    /// The memory of a step with these contacts.
    pub(super) fn of(contacts: Vec<Contact>) -> Self {
        Self { now: contacts, ..Self::default() }
    }

    /// Begins a step.
    pub(super) fn turn_over(&mut self) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.clear();
        (self.next, self.sprung) = (0, 0);
    }

    /// Notes that `key` touches; keys must come in order. Returns its spring.
    #[inline]
    pub(super) fn recall(&mut self, key: Key) -> Spring {
        while self.before.get(self.next).is_some_and(|c| c.key < key) {
            self.next += 1;
        }
        let known = self.before.get(self.next).filter(|c| c.key == key);
        let spring = known.map_or_else(Spring::default, |c| c.spring);
        self.now.push(Contact { key, spring });
        spring
    }

    /// Takes the new springs of the next contacts.
    #[inline]
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Spring>) {
        for spring in springs {
            self.now[self.sprung].spring = spring;
            self.sprung += 1;
        }
    }
}
