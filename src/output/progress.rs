//! What the user sees while the work goes on.
//!
//! In: steps ("cut flanks", 84 of them) and their advance, from any thread. Out, on standard error: a bar with the
//! time left on a terminal, a plain line every few seconds elsewhere, one JSON object per line for programs, or nothing.
//!
//! The rule: results go to files and standard output, talk goes to standard error; and a time left is named only after
//! two seconds, because before that it is a guess.
//!
//! Road not taken: percentages over the whole run. Steps differ in kind, and a weight between them would be invented;
//! counted units of a named step are true.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use serde_json::json;

/// Earliest moment at which a time left is shown: shorter steps are over before it is read.
const TIME_LEFT_AFTER: Duration = Duration::from_secs(2);
/// Between two plain lines: often enough to see that it lives, seldom enough for a log file.
const LINE_EVERY: Duration = Duration::from_secs(5);
/// Between two JSON events: smooth for a program that draws its own bar.
const EVENT_EVERY: Duration = Duration::from_millis(500);

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProgressMode {
    /// Nothing at all.
    Quiet,
    /// A bar that redraws itself, for terminals.
    Bar,
    /// Plain lines, for logs and pipes.
    Lines,
    /// One JSON object per event and line, for programs.
    Json,
}

impl ProgressMode {
    /// The mode for the command line's `--quiet` and `--json`; without them, a bar if standard error is a terminal.
    pub fn choose(quiet: bool, json: bool) -> Self {
        if json {
            Self::Json
        } else if quiet {
            Self::Quiet
        } else if io::stderr().is_terminal() {
            Self::Bar
        } else {
            Self::Lines
        }
    }
}

/// Place where steps and notes are reported.
pub struct Progress {
    mode: ProgressMode,
    out: Mutex<Box<dyn Write + Send>>,
}

impl Progress {
    /// Reports on standard error.
    pub fn new(mode: ProgressMode) -> Self {
        Self::to_writer(mode, Box::new(io::stderr()))
    }

    /// Reports to `out`; bars still draw on standard error, since they need a terminal.
    pub fn to_writer(mode: ProgressMode, out: Box<dyn Write + Send>) -> Self {
        Self { mode, out: Mutex::new(out) }
    }

    /// Begins a step of `total` units, such as "cut" with 84 "flanks".
    pub fn step(&self, name: &str, total: u64, unit: &str) -> Step<'_> {
        let bar = if self.mode == ProgressMode::Bar { visible_bar(name, total, unit) } else { ProgressBar::hidden() };
        let started = Instant::now();
        let step = Step {
            progress: self,
            name: name.to_owned(),
            unit: unit.to_owned(),
            total,
            done: AtomicU64::new(0),
            started,
            last_report: Mutex::new(started),
            bar,
        };
        if self.mode == ProgressMode::Json {
            self.line(&json!({"event": "step_started", "step": name, "total": total, "unit": unit}).to_string());
        }
        step
    }

    /// A remark that stands between the steps: a choice made, a warning.
    pub fn note(&self, text: &str) {
        match self.mode {
            ProgressMode::Quiet => {}
            ProgressMode::Bar | ProgressMode::Lines => self.line(text),
            ProgressMode::Json => self.line(&json!({"event": "note", "text": text}).to_string()),
        }
    }

    /// Writes one line; a reader that has gone away must not stop the work, so its error is dropped.
    fn line(&self, text: &str) {
        let mut out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        let _reader_gone = writeln!(out, "{text}").and_then(|()| out.flush());
    }
}

/// A step under way; it may be advanced from several threads.
pub struct Step<'a> {
    progress: &'a Progress,
    name: String,
    unit: String,
    total: u64,
    done: AtomicU64,
    started: Instant,
    last_report: Mutex<Instant>,
    bar: ProgressBar,
}

impl Step<'_> {
    /// Counts `units` more as done.
    pub fn advance(&self, units: u64) {
        let done = self.done.fetch_add(units, Ordering::Relaxed) + units;
        let interval = match self.progress.mode {
            ProgressMode::Quiet => return,
            ProgressMode::Bar => return self.bar.inc(units),
            ProgressMode::Lines => LINE_EVERY,
            ProgressMode::Json => EVENT_EVERY,
        };
        {
            let mut last_report = self.last_report.lock().unwrap_or_else(PoisonError::into_inner);
            if last_report.elapsed() < interval {
                return;
            }
            *last_report = Instant::now();
        }
        self.report(done);
    }

    /// Ends the step and tells how long it took; `units` that were never counted stay uncounted.
    pub fn finish(self) {
        let (done, elapsed_s) = (self.done.load(Ordering::Relaxed), self.started.elapsed().as_secs_f64());
        let (name, unit) = (&self.name, &self.unit);
        match self.progress.mode {
            ProgressMode::Quiet => {}
            ProgressMode::Bar | ProgressMode::Lines => {
                self.bar.finish_and_clear();
                self.progress.line(&format!("{name}: {done} {unit} in {}", duration_text(elapsed_s)));
            }
            ProgressMode::Json => self.progress.line(
                &json!({"event": "step_finished", "step": name, "done": done, "total": self.total, "unit": unit,
                        "elapsed_s": elapsed_s})
                .to_string(),
            ),
        }
    }

    fn report(&self, done: u64) {
        let (name, unit, total) = (&self.name, &self.unit, self.total);
        let elapsed = self.started.elapsed();
        let left_s = time_left_s(elapsed, done, total);
        let text = if self.progress.mode == ProgressMode::Json {
            json!({"event": "progress", "step": name, "done": done, "total": total, "unit": unit,
                   "elapsed_s": elapsed.as_secs_f64(), "remaining_s": left_s})
            .to_string()
        } else {
            let left = left_s.map_or_else(String::new, |left_s| format!(", {} left", duration_text(left_s)));
            format!("{name}: {done} of {total} {unit}{left}")
        };
        self.progress.line(&text);
    }
}

impl Drop for Step<'_> {
    /// A step that ends early takes its bar away, so that the error message stands alone.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Time left at the pace so far, s; none in the first two seconds or before anything is done.
fn time_left_s(elapsed: Duration, done: u64, total: u64) -> Option<f64> {
    (elapsed >= TIME_LEFT_AFTER && done > 0)
        .then(|| elapsed.as_secs_f64() * total.saturating_sub(done) as f64 / done as f64)
}

/// A duration as people say it: "0.4 s", "12 s", "3 min 20 s", "2 h 5 min".
pub fn duration_text(seconds: f64) -> String {
    let whole_s = seconds.round() as u64;
    match whole_s {
        0..10 => format!("{seconds:.1} s"),
        10..60 => format!("{whole_s} s"),
        60..3600 => format!("{} min {} s", whole_s / 60, whole_s % 60),
        _ => format!("{} h {} min", whole_s / 3600, whole_s % 3600 / 60),
    }
}

fn visible_bar(name: &str, total: u64, unit: &str) -> ProgressBar {
    let time_left = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        if let Some(left_s) = time_left_s(state.elapsed(), state.pos(), state.len().unwrap_or(0)) {
            let _bar_only = write!(out, "{} left", duration_text(left_s));
        }
    };
    // The template is ours; should the crate ever refuse it, its plain bar still shows the count.
    let style = ProgressStyle::with_template("{prefix} [{bar:30}] {pos} of {len} {msg}  {time_left}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("time_left", time_left)
        .progress_chars("=> ");
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr()).with_style(style);
    bar.set_prefix(name.to_owned());
    bar.set_message(unit.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_is_the_pace_so_far_and_never_a_guess() {
        assert_eq!(time_left_s(Duration::from_secs(1), 10, 20), None);
        assert_eq!(time_left_s(Duration::from_secs(10), 0, 20), None);
        assert_eq!(time_left_s(Duration::from_secs(10), 5, 20), Some(30.0));
        assert_eq!(time_left_s(Duration::from_secs(10), 21, 20), Some(0.0));
    }

    #[test]
    fn durations_read_like_speech() {
        let texts = [0.44, 9.6, 59.4, 200.0, 7500.0].map(duration_text);
        assert_eq!(texts, ["0.4 s", "10 s", "59 s", "3 min 20 s", "2 h 5 min"]);
    }
}
