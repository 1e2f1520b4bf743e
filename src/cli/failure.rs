//! What is printed when a command fails, and with which code it ends.

use super::print::to_stderr;
use gearcut::findings::{Severity, Warning};
use gearcut::output::atomic::file_error;
use std::path::Path;

use gearcut::interrupt::INTERRUPTED_EXIT_CODE;
use gearcut::scene::{LoadedScene, SceneErrors};
use gearcut::{Error, Refusal};

/// Why a command did not do what it was asked.
#[derive(Debug)]
pub struct Failure {
    text: String,
    code: u8,
}

/// Refused or failed.
const FAILED: u8 = 1;
/// Done and written, but what was found is bad.
const BAD_VERDICT: u8 = 3;

impl Failure {
    /// A failure of work on a scene: what geometry refuses is shown at its place in the scene file; an option of the
    /// command line has no place there.
    pub fn of_scene(scene: &LoadedScene, error: Error) -> Self {
        match error {
            Error::Refused(refusal) if !refusal.key.starts_with("--") => scene.explain(&refusal).into(),
            other => other.into(),
        }
    }

    /// A refusal of something that no file says.
    pub fn without_place(what: &str, refusal: &Refusal) -> Self {
        let text = format!("error: {what}: {}\n  way out: {}", refusal.problem, refusal.way_out);
        Self { text, code: FAILED }
    }

    /// What the system refuses, with the way out.
    pub fn of_system(reason: &str) -> Self {
        Self { text: format!("error: {reason}"), code: FAILED }
    }

    /// A run that Ctrl-C ended early: its results are in `partial`, beside what is at `out`.
    pub fn ended_early(partial: &Path, out: &Path) -> Self {
        let finished = format!("stopped by Ctrl-C: what is finished is in {}", partial.display());
        let text = if out.exists() {
            format!("{finished}; the earlier results in {} are untouched", out.display())
        } else {
            finished
        };
        Self { text, code: INTERRUPTED_EXIT_CODE }
    }

    /// A run that Ctrl-C ended early and that goes on where it ended.
    pub fn to_go_on(out: &Path, done: usize, all: usize) -> Self {
        let text =
            format!("stopped by Ctrl-C: {done} of {all} gears are in {}; the same command goes on", out.display());
        Self { text, code: INTERRUPTED_EXIT_CODE }
    }

    /// The verdict on work that is done: a fault is told once more, and by the exit code.
    pub fn verdict(warnings: &[Warning]) -> Result<(), Self> {
        let mut faults = warnings.iter().filter(|warning| warning.severity == Severity::Fault);
        let Some(first) = faults.next() else { return Ok(()) };
        let more = match faults.count() {
            0 => String::new(),
            1 => "; and 1 more fault".to_owned(),
            count => format!("; and {count} more faults"),
        };
        Err(Self::bad_verdict(&format!("{}{more}", first.text)))
    }

    /// Work that is done and written, with a finding that nobody should miss.
    pub fn bad_verdict(what: &str) -> Self {
        Self { text: format!("verdict: {what}"), code: BAD_VERDICT }
    }

    /// Prints the reason on standard error; gives the exit code.
    pub fn report(&self) -> u8 {
        to_stderr(self.text.trim_end());
        self.code
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let code = if matches!(error, Error::Interrupted) { INTERRUPTED_EXIT_CODE } else { FAILED };
        let text = match error {
            Error::Scene(errors) => errors.to_string(), // every problem says "error:" itself
            other => format!("error: {other}"),
        };
        Self { text, code }
    }
}

impl From<gearcut_texture::Error> for Failure {
    fn from(error: gearcut_texture::Error) -> Self {
        file_error(error).into()
    }
}

impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Self {
        Error::Scene(Box::new(errors)).into()
    }
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Self {
        Error::Refused(refusal).into()
    }
}
