//! When a turning bed has become stationary.

/// Watches means over windows of mean speed, kinetic energy and centre-of-mass angle.
///
/// A window lasts one baffle passage (half a second without baffles), so that the beat of the baffles does not show.
/// The bed counts as settled when the last two windows agree within [`SPEED`] and [`ANGLE`].
#[derive(Debug, Clone, Default)]
pub(super) struct SettlingWatch {
    sums: [f64; 2],
    samples: u32,
    windows: Vec<[f64; 2]>,
}

/// Largest relative change of mean speed between two windows of a settled bed.
const SPEED: f64 = 0.03;
/// Largest change of the angle of the centre of mass, rad.
const ANGLE: f64 = 0.02;

impl SettlingWatch {
    /// Notes the mean speed, m/s, and the angle of the centre of mass from straight down, rad.
    pub(super) fn note(&mut self, speed: f64, angle: f64) {
        self.sums[0] += speed;
        self.sums[1] += angle;
        self.samples += 1;
    }

    /// Ends a window; true if the bed is settled.
    pub(super) fn close_window(&mut self) -> bool {
        let n = f64::from(self.samples.max(1));
        self.windows.push(self.sums.map(|s| s / n));
        self.sums = [0.0; 2];
        self.samples = 0;
        let [.., a, b] = self.windows[..] else { return false };
        (a[0] - b[0]).abs() <= SPEED * a[0].max(b[0]) && (a[1] - b[1]).abs() <= ANGLE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_equal_windows_settle_and_a_drift_does_not() {
        let mut watch = SettlingWatch::default();
        for (speed, settled) in [(0.1, false), (0.2, false), (0.19, false), (0.191, true)] {
            watch.note(speed, 0.7);
            assert_eq!(watch.close_window(), settled);
        }
    }
}
