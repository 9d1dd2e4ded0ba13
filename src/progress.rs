//! Progress on standard error: a spinner on a terminal, plain lines elsewhere.

use std::io::IsTerminal;
use std::sync::LazyLock;
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use scenarios::Iteration;

use crate::console;
use crate::jobs::Job;

/// The spinners of all jobs that run.
static SPINNERS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Hides the spinners while something is printed.
pub fn suspended<T>(print: impl FnOnce() -> T) -> T {
    SPINNERS.suspend(print)
}

/// Progress of one job.
pub struct Progress {
    display: Display,
    iterations: usize,
    duration_s: f64,
}

enum Display {
    Nothing,
    Lines { prefix: String },
    Bar(ProgressBar),
}

impl Progress {
    /// Progress of job `number` (from 1) of `total`.
    pub fn new(job: &Job, number: usize, total: usize, is_quiet: bool) -> Self {
        let prefix = format!("[{number}/{total}] {} · {}", job.scenario.name, job.plan_source.name());
        let display = if is_quiet {
            Display::Nothing
        } else if std::io::stderr().is_terminal() {
            Display::Bar(bar(prefix))
        } else {
            Display::Lines { prefix }
        };
        Self { display, iterations: 0, duration_s: 0.0 }
    }

    /// Planning begins.
    pub fn planning(&mut self) {
        self.begin("planning".into());
    }

    /// The planner has finished another iteration.
    pub fn planned(&mut self, iteration: &Iteration) {
        self.iterations += 1;
        self.update(|this| format!("planning: iteration {}, objective {:.3}", this.iterations, iteration.objective));
    }

    /// Simulation of a flight of this duration begins, s.
    pub fn flying(&mut self, duration_s: f64) {
        self.duration_s = duration_s;
        self.begin(format!("flying {duration_s:.1} s"));
    }

    /// The simulation has reached this time, s.
    pub fn flown(&mut self, t_s: f64) {
        self.update(|this| format!("flying: {t_s:.0} s of {:.1} s", this.duration_s));
    }

    /// Judging begins.
    pub fn judging(&mut self) {
        self.begin("judging".into());
    }

    /// Writing of a recording begins.
    pub fn recording(&mut self, file_name: &str) {
        self.begin(format!("recording {file_name}"));
    }

    /// `done` of `total` flights of a sweep are finished. Without a terminal only every tenth part is printed.
    pub fn swept(&mut self, done: usize, total: usize) {
        self.counted(done, total, format!("{done} of {total} flights"));
    }

    /// `done` of at most `total` pairs of a comparison are finished. Without a terminal only every tenth part is printed.
    pub fn compared(&mut self, done: usize, total: usize) {
        self.counted(done, total, format!("{done} of at most {total} pairs"));
    }

    /// `done` of at most `total` flights of a search for rare events are finished; it has come to this probability. Without a
    /// terminal only every tenth part is printed.
    pub fn reached(&mut self, done: usize, total: usize, probability: f64) {
        self.counted(done, total, format!("{done} of at most {total} flights; reached probability {probability:.1e}"));
    }

    fn counted(&self, done: usize, total: usize, message: String) {
        match &self.display {
            Display::Lines { .. } if done * 10 / total > (done - 1) * 10 / total => self.begin(message),
            Display::Lines { .. } => {}
            Display::Nothing | Display::Bar(_) => self.update(|_| message),
        }
    }

    /// The job is finished: removes the spinner, so that the result can be printed.
    pub fn finish(self) {
        if let Display::Bar(bar) = self.display {
            bar.finish_and_clear();
            SPINNERS.remove(&bar);
        }
    }

    /// Shows a new stage, on a terminal and elsewhere.
    fn begin(&self, message: String) {
        match &self.display {
            Display::Nothing => {}
            Display::Lines { prefix } => console::eprint(&format!("{prefix}: {message}")),
            Display::Bar(bar) => bar.set_message(message),
        }
    }

    /// Shows a step within a stage, on a terminal only, where it replaces the last one.
    fn update(&self, message: impl FnOnce(&Self) -> String) {
        if let Display::Bar(bar) = &self.display {
            bar.set_message(message(self));
        }
    }
}

fn bar(prefix: String) -> ProgressBar {
    let style =
        ProgressStyle::with_template("{spinner} {prefix}: {wide_msg} {elapsed}").expect("the template is valid");
    let bar = SPINNERS.add(ProgressBar::new_spinner()).with_style(style).with_prefix(prefix);
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}
