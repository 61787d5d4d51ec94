//! Ranges of numbers, in SI.

use crate::units::Quantity;

/// A range with ends that belong to it or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Allowed {
    low: f64,
    low_belongs: bool,
    high: f64,
    high_belongs: bool,
}

impl Allowed {
    /// `low` and more.
    pub(super) const fn from(low: f64) -> Self {
        Self { low, low_belongs: true, high: f64::INFINITY, high_belongs: false }
    }

    /// More than `low`.
    pub(super) const fn above(low: f64) -> Self {
        Self { low, low_belongs: false, high: f64::INFINITY, high_belongs: false }
    }

    /// At most `high`.
    pub(super) const fn to(self, high: f64) -> Self {
        Self { high, high_belongs: true, ..self }
    }

    /// Less than `high`.
    pub(super) const fn below(self, high: f64) -> Self {
        Self { high, high_belongs: false, ..self }
    }

    /// Whether `value` is in the range.
    pub(super) fn holds(self, value: f64) -> bool {
        let low = if self.low_belongs { value >= self.low } else { value > self.low };
        let high = if self.high_belongs { value <= self.high } else { value < self.high };
        low && high
    }

    /// In words, in the unit that `written`, a value of a scene, has: `above Mm(0) to Mm(30)`.
    pub(super) fn in_words<Q: Quantity>(self, written: &str) -> String {
        let unit = Q::UNITS.iter().find(|unit| {
            let content = written.trim_start().strip_prefix(unit.name);
            content.is_some_and(|rest| rest.trim_start().starts_with('('))
        });
        let number = |si: f64| match unit.or(Q::UNITS.first()) {
            Some(unit) => format!("{}({})", unit.name, digits(unit.of_si(si))),
            None => digits(si),
        };
        if self.low == self.high {
            return number(self.low);
        }
        let low = format!("{} {}", if self.low_belongs { "from" } else { "above" }, number(self.low));
        if self.high.is_infinite() {
            return low;
        }
        format!("{low} {} {}", if self.high_belongs { "to" } else { "and below" }, number(self.high))
    }
}

/// A bound in six digits, enough to stay on its right side by.
fn digits(value: f64) -> String {
    let plain = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    if plain { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{Angle, Length, Number};
    use std::f64::consts::PI;

    #[test]
    fn ends_belong_or_not() {
        let share = Allowed::above(0.0).to(1.0);
        assert!(!share.holds(0.0) && share.holds(1e-300) && share.holds(1.0) && !share.holds(1.1));
        assert!(!share.holds(f64::NAN));
        assert_eq!(share.in_words::<Number>("0"), "above 0 to 1");
        assert_eq!(
            Allowed::from(1e-6).below(2.0).in_words::<Length>("Cm(3)"),
            "from Cm(1e-4) and below Cm(200)"
        );
        assert_eq!(Allowed::from(-PI / 3.0).in_words::<Angle>("Deg (1)"), "from Deg(-60)");
        assert_eq!(Allowed::from(1.0).to(1.0).in_words::<Number>("2"), "1");
    }
}
