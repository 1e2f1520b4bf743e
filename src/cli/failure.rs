//! What is printed when a command fails, and with which code it ends.

use super::print::to_stderr;
use crate::findings::{Notice, Severity};
use crate::notices::NoticeRules;
use crate::output::atomic::file_error;
use std::collections::BTreeSet;
use std::path::Path;

use crate::interrupt::INTERRUPTED_EXIT_CODE;
use crate::scene::{LoadedScene, SceneErrors};
use gearcut_core::{Error, Refusal};

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
    pub fn to_go_on(out: &Path, [done, all]: [u64; 2], what: &str) -> Self {
        let text =
            format!("stopped by Ctrl-C: {done} of {all} {what} are in {}; the same command goes on", out.display());
        Self { text, code: INTERRUPTED_EXIT_CODE }
    }

    /// The verdict on work that is done: a fault, and a notice that the command line denies, is told once more, and by
    /// the exit code. Faults that it allows are named.
    pub fn verdict(notices: &[Notice], rules: &NoticeRules) -> Result<(), Self> {
        let is_fault = |notice: &Notice| notice.severity == Severity::Fault;
        let (bad, others): (Vec<&Notice>, Vec<&Notice>) = notices.iter().partition(|notice| rules.is_bad(notice));
        let allowed: BTreeSet<&str> = others.iter().filter(|of| is_fault(of)).map(|of| &*of.id).collect();
        if !allowed.is_empty() {
            to_stderr(&format!("note: allowed by --allow: {}", allowed.into_iter().collect::<Vec<_>>().join(", ")));
        }
        let Some((first, more)) = bad.split_first() else { return Ok(()) };
        let denied = if is_fault(first) { "" } else { " (denied by --deny)" };
        let what = if bad.iter().all(|of| is_fault(of)) { "fault" } else { "notice" };
        let more = match more.len() {
            0 => String::new(),
            1 => format!("; and 1 more {what}"),
            count => format!("; and {count} more {what}s"),
        };
        Err(Self { text: format!("verdict: {}{denied}{more}", first.text), code: BAD_VERDICT })
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
