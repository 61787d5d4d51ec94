//! Shows how a run gets on, and when it is to stop.

use crate::report::Estimate;
use crate::stepping::{Progress, Stage};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time between lines when stderr is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// Looks at the progress of a run.
pub(super) struct Watch {
    stop: Arc<AtomicBool>,
    start: Instant,
    deadline: Option<Duration>,
    display: Display,
    stage: Option<Stage>,
    stage_start: Instant,
    last_line: Instant,
    /// What frames are handed out for, and for how long, s.
    purpose: (&'static str, f64),
    /// CoV_intra at the last output time.
    pub(super) cov_intra: Option<f64>,
    /// Its limit as far as known.
    pub(super) limit: Option<Estimate>,
}

enum Display {
    Bar(ProgressBar),
    Lines,
    Nothing,
}

impl Watch {
    /// Watches a run that is to stop on Ctrl-C, on a termination signal, and after `max_wall`.
    ///
    /// # Errors
    /// The system does not let it watch for signals.
    pub(super) fn new(max_wall: Option<Duration>, quiet: bool) -> Result<Self, ctrlc::Error> {
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed))?;
        let display = match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Display::Nothing,
            (false, true) => Display::Bar(bar()),
            (false, false) => Display::Lines,
        };
        let now = Instant::now();
        Ok(Self {
            stop,
            start: now,
            deadline: max_wall,
            display,
            stage: None,
            stage_start: now,
            last_line: now,
            purpose: ("running", 0.0),
            cov_intra: None,
            limit: None,
        })
    }

    /// Frames are now handed out for another `purpose`, for `duration` s.
    pub(super) fn begin(&mut self, purpose: &'static str, duration: f64) {
        self.purpose = (purpose, duration);
        self.stage = None;
    }

    /// Takes note of where the run stands; false when it is to stop.
    pub(super) fn note(&mut self, progress: &Progress) -> bool {
        let now = Instant::now();
        let fresh = self.stage != Some(progress.stage);
        if fresh {
            (self.stage, self.stage_start) = (Some(progress.stage), now);
        }
        let (purpose, duration) = self.purpose;
        let status = Status {
            progress: *progress,
            purpose,
            of: if progress.stage == Stage::Running { duration } else { progress.of },
            wall: (now - self.stage_start).as_secs_f64(),
            cov_intra: self.cov_intra,
            limit: self.limit,
        };
        match &self.display {
            Display::Bar(bar) => {
                bar.set_length((1e3 * status.of) as u64);
                bar.set_position((1e3 * progress.time) as u64);
                bar.set_message(status.in_words());
            }
            Display::Lines if fresh || now - self.last_line >= LINE_EVERY => {
                eprintln!("{}", status.in_words());
                self.last_line = now;
            }
            Display::Lines | Display::Nothing => {}
        }
        let late = self.deadline.is_some_and(|deadline| now - self.start >= deadline);
        !(late || self.stop.load(Ordering::Relaxed))
    }

    /// Wall time since the start, s.
    pub(super) fn wall_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Shows a line of its own.
    pub(super) fn say(&self, line: &str) {
        match &self.display {
            Display::Bar(bar) => bar.suspend(|| eprintln!("{line}")),
            Display::Lines => eprintln!("{line}"),
            Display::Nothing => {}
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {msg}").expect("the template is valid");
    ProgressBar::new(1).with_style(style)
}

struct Status {
    progress: Progress,
    purpose: &'static str,
    of: f64,
    wall: f64,
    cov_intra: Option<f64>,
    limit: Option<Estimate>,
}

impl Status {
    fn in_words(&self) -> String {
        let Progress { stage, time, bodies, .. } = self.progress;
        let pace = self.wall / time.max(1e-9);
        let of = self.of;
        match stage {
            Stage::Filling => format!("filling: {bodies} tablets after {time:.2} s"),
            Stage::Settling => format!("settling: {time:.2} s of at most {of} s, {pace:.1} s of work each"),
            Stage::Running => {
                let cov = self.cov_intra.map_or(String::new(), |cov| format!(", CoV_intra {cov:.3}"));
                let limit = self.limit.map_or(String::new(), |l| {
                    format!(", limit {:.3} ({:.3} to {:.3})", l.value, l.low, l.high)
                });
                let left = clock(pace * (of - time));
                let purpose = self.purpose;
                format!("{purpose}: {time:.2} s of {of} s, {pace:.1} s of work each, {left} left{cov}{limit}")
            }
        }
    }
}

/// Seconds as `m:ss` or `h:mm:ss`.
pub(super) fn clock(seconds: f64) -> String {
    let s = seconds.max(0.0).round() as u64;
    match s / 3600 {
        0 => format!("{}:{:02}", s / 60, s % 60),
        hours => format!("{hours}:{:02}:{:02}", s / 60 % 60, s % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_in_words() {
        let progress = Progress { stage: Stage::Running, time: 5.0, of: 0.02, bodies: 7 };
        let limit = Some(Estimate { value: 0.1, low: 0.05, high: 0.15, noise_time_s: 3.0 });
        let cov_intra = Some(1.234_56);
        let status = Status { progress, purpose: "spraying", of: 20.0, wall: 250.0, cov_intra, limit };
        assert_eq!(
            status.in_words(),
            "spraying: 5.00 s of 20 s, 50.0 s of work each, 12:30 left, CoV_intra 1.235, limit 0.100 (0.050 to 0.150)"
        );
        assert_eq!(clock(3725.0), "1:02:05");
    }
}
