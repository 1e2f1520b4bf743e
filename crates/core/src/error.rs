//! Errors as values: what was refused, where, and a way out.
//!
//! Problems of a text come with file, line and column from whoever reads it. What only geometry finds out (a pitch
//! curve that crosses itself, a cutter that undercuts) is a [`Refusal`] that names what it blames: this crate a
//! [`crate::parameter`], a program that reads them from a file its own key, whose place there it knows.

use std::path::PathBuf;

/// What can go wrong in a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A text does not say what it should: every problem with its file, line and column.
    #[error("{0}")]
    Scene(Box<dyn std::error::Error + Send + Sync>),
    /// Geometry or size is refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A file could not be read or written.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// What was being done: "cannot read", "cannot write".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A picture, table or map could not be made.
    #[error("cannot write {}: {reason}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// The writer's reason.
        reason: String,
    },
    /// A device failed, and the user wants the run to stop then; what it was in the device's own words.
    #[error("{0}")]
    Device(Box<dyn std::error::Error + Send + Sync>),
    /// A file that was read is not what it should be.
    #[error("cannot use {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// An iteration did not converge.
    #[error(transparent)]
    NotConverged(#[from] NotConverged),
    /// Stopped by the user.
    #[error("stopped by Ctrl-C")]
    Interrupted,
}

/// Geometry that cannot be cut.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("`{key}`: {problem}\n  way out: {way_out}")]
pub struct Refusal {
    /// What is to blame: a parameter such as `module`, or the key that a program reads it from.
    pub key: String,
    /// What is wrong, with the value and the limit.
    pub problem: String,
    /// What the user can do.
    pub way_out: String,
}

impl Refusal {
    /// Refusal that blames `key`.
    pub fn new(key: &str, problem: impl Into<String>, way_out: impl Into<String>) -> Self {
        Self { key: key.to_owned(), problem: problem.into(), way_out: way_out.into() }
    }
}

impl Error {
    /// Adapter for `map_err`: a read that failed.
    pub fn reading(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { action: "cannot read", path, source }
    }

    /// Adapter for `map_err`: a write that failed.
    pub fn writing(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { action: "cannot write", path, source }
    }
}

/// An iteration that was stopped before it had converged.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{what} is not found after {after} steps: last value {last:e}, last step {last_step:e}, residual {residual:e}")]
pub struct NotConverged {
    /// What was looked for.
    pub what: &'static str,
    /// Steps taken.
    pub after: u32,
    /// Last value.
    pub last: f64,
    /// Last step, in the unit of the value.
    pub last_step: f64,
    /// Residual before the last step, in the unit of the function.
    pub residual: f64,
}

impl NotConverged {
    /// The last value, where the last step is at most `step`: for iterations that go on until rounding alone moves
    /// them.
    ///
    /// # Errors
    /// The same, where the last step is larger.
    pub fn settled(self, step: f64) -> Result<f64, Self> {
        if self.last_step.abs() <= step { Ok(self.last) } else { Err(self) }
    }
}

/// Result of everything that can be refused.
pub type Result<T, E = Error> = std::result::Result<T, E>;
