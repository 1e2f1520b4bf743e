//! What the user sees while the work goes on.
//!
//! In: steps ("cut flanks", 84 of them) and their advance, from any thread. Out: [`Event`]s. On standard error they are
//! a bar with the time left on a terminal, a plain line every few seconds elsewhere, one JSON object per line for other
//! programs, or nothing; a program that has gearcut as a library watches the events themselves.
//!
//! The rule: results go to files and standard output, messages go to standard error; and a time left is named only
//! after two seconds, because before that it is a guess.
//!
//! A command that knows its steps beforehand gives a plan: their names with expected seconds, right in proportion. The
//! time left of the whole command is then what is expected of the rest, at the pace of what is done. Without a plan, a
//! step speaks for itself alone.
//!
//! Road not taken: percentages over the whole run. They would count expected seconds as if they were measured; a time
//! left is known to be an estimate.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use web_time::Instant;

use crate::wrap::{fitted, printable};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// Earliest moment at which a time left is shown: shorter steps are over before it is read.
const TIME_LEFT_AFTER: Duration = Duration::from_secs(2);
/// Between two plain lines: often enough to see that it lives, seldom enough for a log file.
const LINE_EVERY: Duration = Duration::from_secs(5);
/// Characters in a line of a terminal.
const WIDTH: usize = 80;
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

/// What happens in a run. As JSON: one object with the key `event`.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Event {
    /// A step begins.
    StepStarted {
        /// Its name, such as "cut".
        step: String,
        /// How many units it has.
        total: u64,
        /// What they are, such as "flanks".
        unit: String,
    },
    /// Units of a step are done.
    Progress {
        /// Its name.
        step: String,
        /// Units done.
        done: u64,
        /// How many it has.
        total: u64,
        /// What they are.
        unit: String,
        /// Time since the step began, s.
        elapsed_s: f64,
        /// Time left of the step at its pace so far, s; none in its first two seconds.
        remaining_s: Option<f64>,
        /// Time left of the whole run, s; none without a plan and in its first two seconds.
        whole_remaining_s: Option<f64>,
    },
    /// A step has ended.
    StepFinished {
        /// Its name.
        step: String,
        /// Units done.
        done: u64,
        /// How many it has.
        total: u64,
        /// What they are.
        unit: String,
        /// Time that it took, s.
        elapsed_s: f64,
    },
    /// A remark between the steps: a choice that was made, a warning.
    Note {
        /// The remark.
        text: String,
    },
}

/// Takes events; it is called from any thread.
type Watcher = Box<dyn Fn(&Event) + Send + Sync>;

/// Place where steps and notes are reported.
pub struct Progress {
    mode: ProgressMode,
    /// Takes the events instead of the lines of a mode.
    watcher: Option<Watcher>,
    out: Mutex<Box<dyn Write + Send>>,
    whole: Arc<Mutex<Whole>>,
}

/// The steps of a command: what was expected of them, and what those that are done took.
struct Whole {
    started: Instant,
    /// Steps to come and the one under way, with expected seconds.
    ahead: Vec<(String, f64)>,
    /// Expected seconds of the steps that are done.
    done_s: f64,
    /// Steps that are done, with the seconds they took, in order.
    taken: Vec<(String, f64)>,
}

impl Whole {
    /// Time left of the whole command, s, when `share` of `step` is done; none without a plan, in the first two
    /// seconds, or before a twentieth of what is expected is done.
    fn left_s(&self, step: &str, share: f64) -> Option<f64> {
        let under_way_s: f64 = self.ahead.iter().filter(|(name, _)| name == step).map(|(_, s)| s * share).sum();
        let done_s = self.done_s + under_way_s;
        let ahead_s = self.ahead.iter().map(|(_, s)| s).sum::<f64>() - under_way_s;
        let elapsed = self.started.elapsed();
        (elapsed >= TIME_LEFT_AFTER && done_s > 0.05 * (done_s + ahead_s))
            .then(|| elapsed.as_secs_f64() * ahead_s / done_s)
    }

    fn finish(&mut self, step: &str, took_s: f64) {
        self.taken.push((step.to_owned(), took_s));
        if let Some(place) = self.ahead.iter().position(|(name, _)| name == step) {
            self.done_s += self.ahead.remove(place).1;
        }
    }
}

impl Progress {
    /// Reports on standard error.
    pub fn new(mode: ProgressMode) -> Self {
        Self::to_writer(mode, Box::new(io::stderr()))
    }

    /// Reports to `out`; bars still draw on standard error, since they need a terminal.
    pub fn to_writer(mode: ProgressMode, out: Box<dyn Write + Send>) -> Self {
        let whole = Whole { started: Instant::now(), ahead: Vec::new(), done_s: 0.0, taken: Vec::new() };
        Self { mode, watcher: None, out: Mutex::new(out), whole: Arc::new(Mutex::new(whole)) }
    }

    /// Hands every event to `watcher`, twice a second at most while a step advances; it is called from any thread.
    pub fn watched(watcher: impl Fn(&Event) + Send + Sync + 'static) -> Self {
        let watcher: Option<Watcher> = Some(Box::new(watcher));
        Self { watcher, ..Self::to_writer(ProgressMode::Json, Box::new(io::sink())) }
    }

    /// The steps that follow, with expected seconds: their proportions are what counts. A step that comes without being
    /// among them takes its time from nobody.
    pub fn plan(&self, steps: Vec<(&'static str, f64)>) {
        locked(&self.whole).ahead = steps.into_iter().map(|(name, expected_s)| (name.to_owned(), expected_s)).collect();
    }

    /// Time since the first thing that is reported could be.
    pub fn elapsed(&self) -> Duration {
        locked(&self.whole).started.elapsed()
    }

    /// Steps that are finished, with the seconds they took, in order.
    pub fn stages(&self) -> Vec<(String, f64)> {
        locked(&self.whole).taken.clone()
    }

    /// Begins a step of `total` units, such as "cut" with 84 "flanks".
    pub fn step(&self, name: &str, total: u64, unit: &str) -> ProgressStep<'_> {
        let bar = if self.mode == ProgressMode::Bar {
            visible_bar(name, total, unit, Arc::clone(&self.whole))
        } else {
            ProgressBar::hidden()
        };
        let started = Instant::now();
        let step = ProgressStep {
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
            self.event(&Event::StepStarted { step: name.to_owned(), total, unit: unit.to_owned() });
        }
        step
    }

    /// A remark that stands between the steps: a choice made, a warning.
    pub fn note(&self, text: &str) {
        match self.mode {
            ProgressMode::Quiet => {}
            ProgressMode::Bar => self.line(&fitted(&printable(text), WIDTH)),
            ProgressMode::Lines => self.line(&printable(text)),
            ProgressMode::Json => self.event(&Event::Note { text: text.to_owned() }),
        }
    }

    fn event(&self, event: &Event) {
        match &self.watcher {
            Some(watcher) => watcher(event),
            None => self.line(&serde_json::json!(event).to_string()),
        }
    }

    /// Writes one line; a reader that has gone away must not stop the work, so its error is dropped.
    fn line(&self, text: &str) {
        let mut out = self.out.lock().unwrap_or_else(PoisonError::into_inner);
        let _reader_gone = writeln!(out, "{text}").and_then(|()| out.flush());
    }
}

/// A step under way; it may be advanced from several threads.
pub struct ProgressStep<'a> {
    progress: &'a Progress,
    name: String,
    unit: String,
    total: u64,
    done: AtomicU64,
    started: Instant,
    last_report: Mutex<Instant>,
    bar: ProgressBar,
}

impl ProgressStep<'_> {
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
        locked(&self.progress.whole).finish(&self.name, elapsed_s);
        let (name, unit) = (&self.name, &self.unit);
        match self.progress.mode {
            ProgressMode::Quiet => {}
            ProgressMode::Bar | ProgressMode::Lines => {
                self.bar.finish_and_clear();
                self.progress.line(&format!("{name}: {done} {unit} in {}", duration_text(elapsed_s)));
            }
            ProgressMode::Json => {
                let (step, unit, total) = (name.clone(), unit.clone(), self.total);
                self.progress.event(&Event::StepFinished { step, done, total, unit, elapsed_s });
            }
        }
    }

    fn report(&self, done: u64) {
        let (name, unit, total) = (&self.name, &self.unit, self.total);
        let elapsed = self.started.elapsed();
        let left_s = time_left_s(elapsed, done, total);
        let whole_left_s = locked(&self.progress.whole).left_s(name, share(done, total));
        if self.progress.mode == ProgressMode::Json {
            self.progress.event(&Event::Progress {
                step: name.clone(),
                done,
                total,
                unit: unit.clone(),
                elapsed_s: elapsed.as_secs_f64(),
                remaining_s: left_s,
                whole_remaining_s: whole_left_s,
            });
        } else {
            self.progress.line(&format!("{name}: {done} of {total} {unit}{}", left_words(left_s, whole_left_s)));
        }
    }
}

impl Drop for ProgressStep<'_> {
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

/// Share of a step that is done.
fn share(done: u64, total: u64) -> f64 {
    (done as f64 / total.max(1) as f64).min(1.0)
}

/// ", 12 s left, 40 s in all"; the whole command alone where the step has no estimate of its own.
fn left_words(step_s: Option<f64>, whole_s: Option<f64>) -> String {
    let step = step_s.map(|s| format!(", {} left", duration_text(s)));
    // Two estimates: the whole command takes no less than the step.
    let whole = whole_s.map(|s| format!(", {} left in all", duration_text(s.max(step_s.unwrap_or(0.0)))));
    format!("{}{}", step.unwrap_or_default(), whole.unwrap_or_default())
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
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

fn visible_bar(name: &str, total: u64, unit: &str, whole: Arc<Mutex<Whole>>) -> ProgressBar {
    let step = name.to_owned();
    let time_left = move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let (done, total) = (state.pos(), state.len().unwrap_or(0));
        // A terminal line has room for one time: that of the whole command where it is known.
        let whole_left_s = locked(&whole).left_s(&step, share(done, total));
        let words = match whole_left_s {
            Some(left_s) => format!("{} left in all", duration_text(left_s)),
            None => time_left_s(state.elapsed(), done, total)
                .map_or_else(String::new, |left_s| format!("{} left", duration_text(left_s))),
        };
        let _bar_only = out.write_str(&words);
    };
    // Long names take room from the bar: the line fits the terminal with the longest time left as well.
    let most = format!("{name} [] {total} of {total} {unit}  59 min 59 s left in all").chars().count();
    let width = WIDTH.saturating_sub(most).clamp(4, 30);
    let template = format!("{{prefix}} [{{bar:{width}}}] {{pos}} of {{len}} {{msg}}  {{time_left}}");
    // The template is ours; should the crate ever refuse it, its plain bar still shows the count.
    let style = ProgressStyle::with_template(&template)
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
    fn the_time_left_of_a_command_is_what_is_expected_of_the_rest_at_the_pace_so_far() {
        let whole = |seconds: u64| Whole {
            started: Instant::now().checked_sub(Duration::from_secs(seconds)).expect("the machine is up that long"),
            ahead: vec![("cut".to_owned(), 6.0), ("draw".to_owned(), 3.0)],
            done_s: 1.0,
            taken: Vec::new(),
        };
        // Half of the cut: 4 of 10 expected seconds are done, in 8 s. The rest takes 6 at that pace, 12 s.
        let left_s = whole(8).left_s("cut", 0.5).expect("an estimate");
        assert!((left_s - 12.0).abs() < 0.1, "{left_s}");
        assert_eq!(whole(1).left_s("cut", 0.5), None, "no guess in the first two seconds");
        let mut without_plan = Whole { ahead: Vec::new(), done_s: 0.0, ..whole(8) };
        assert_eq!(without_plan.left_s("cut", 0.5), None);
        let mut nearly = whole(9);
        nearly.finish("cut", 7.5);
        assert!(nearly.left_s("draw", 1.0).expect("an estimate") < 1e-9);
        nearly.finish("draw", 1.5);
        without_plan.finish("note", 0.1);
        assert_eq!(nearly.taken, [("cut".to_owned(), 7.5), ("draw".to_owned(), 1.5)]);
        assert_eq!(left_words(Some(3.0), Some(9.6)), ", 3.0 s left, 10 s left in all");
    }

    #[test]
    fn notes_fit_a_terminal_and_are_whole_in_a_log() {
        struct Shared(Arc<Mutex<Vec<u8>>>);
        impl Write for Shared {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                locked(&self.0).write(bytes)
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let note = "mesh/gear.* and pictures of the whole gear are left out: what the linkage as printed leaves has no \
                    flanks to join";
        let told = |mode| {
            let out = Arc::new(Mutex::new(Vec::new()));
            Progress::to_writer(mode, Box::new(Shared(Arc::clone(&out)))).note(note);
            String::from_utf8(locked(&out).clone()).expect("UTF-8")
        };
        let lines = told(ProgressMode::Bar);
        assert!(lines.lines().count() == 2 && lines.lines().all(|line| line.chars().count() <= WIDTH), "{lines}");
        assert_eq!(told(ProgressMode::Lines), format!("{note}\n"));
    }

    #[test]
    fn durations_read_like_speech() {
        let texts = [0.44, 9.6, 59.4, 200.0, 7500.0].map(duration_text);
        assert_eq!(texts, ["0.4 s", "10 s", "59 s", "3 min 20 s", "2 h 5 min"]);
    }
}
