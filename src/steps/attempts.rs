//! What follows the cut: a part that fails is told, and everything else is written.
//!
//! In: the outcome of each part (texture, sheets, pictures, meshes, programs, page). Out: its value, or none and a
//! fault in the run's list. A gear that is cut and measured is not lost for a picture. Where the disk refused a file,
//! the result is not whole and takes no whole one's place.
//!
//! Two failures end the run all the same: Ctrl-C, and a device that failed where the user wants the run to stop then.
//! Road not taken: files of single flanks, which are written while the gear is cut. Where those fail, nothing else can
//! be written either.

use crate::findings::Notice;
use crate::findings::notices::PartFailed;
use crate::progress::Progress;
use gearcut_core::error::{Error, Result};

/// Parts of a run that follow its cut, with what is to be told of them.
pub struct Attempts<'a> {
    progress: &'a Progress,
    told: Vec<Notice>,
    lost_files: bool,
}

impl<'a> Attempts<'a> {
    /// Nothing attempted yet; notes are shown on `progress` at once.
    pub fn new(progress: &'a Progress) -> Self {
        Self { progress, told: Vec::new(), lost_files: false }
    }

    /// The outcome of a part; none where it failed.
    ///
    /// # Errors
    /// Ctrl-C; a device that failed where the user wants the run to stop.
    pub fn of<T>(&mut self, part: &str, outcome: Result<T>) -> Result<Option<T>> {
        match outcome {
            Ok(value) => Ok(Some(value)),
            Err(error @ (Error::Interrupted | Error::Device(_))) => Err(error),
            Err(error) => {
                self.lost_files |= matches!(error, Error::Io { .. });
                let why = error.to_string().split('\n').map(str::trim).collect::<Vec<_>>().join("; ");
                self.tell(PartFailed { part, why }.notice());
                Ok(None)
            }
        }
    }

    /// One more sentence for the run's list, shown as a note at once.
    pub fn tell(&mut self, warning: Notice) {
        self.progress.note(&warning.text);
        self.told.push(warning);
    }

    /// Whether the disk refused something, so that what is there is less than a whole result.
    pub fn lost_files(&self) -> bool {
        self.lost_files
    }

    /// What has been told so far.
    pub fn told(&self) -> Vec<Notice> {
        self.told.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::Severity;
    use crate::progress::ProgressMode;
    use gearcut_core::error::Refusal;

    #[test]
    fn a_part_that_fails_is_told_and_ctrl_c_is_not_taken_for_one() {
        let progress = Progress::new(ProgressMode::Quiet);
        let mut attempts = Attempts::new(&progress);
        assert_eq!(attempts.of("the page", Ok(7)).expect("done"), Some(7));
        let refused = Refusal::new("picture", "it shows nothing", "look elsewhere");
        assert_eq!(attempts.of::<()>("pictures", Err(refused.into())).expect("told"), None);
        assert!(attempts.of::<()>("pictures", Err(Error::Interrupted)).is_err());
        assert!(!attempts.lost_files());
        let told = attempts.told();
        let text = "pictures: `picture`: it shows nothing; way out: look elsewhere; everything else is there";
        assert_eq!(told, [Notice::new("cut.part_failed", Severity::Fault, text)]);
        let full = Error::writing("gear.png")(std::io::ErrorKind::StorageFull.into());
        assert_eq!(attempts.of::<()>("pictures", Err(full)).expect("told"), None);
        assert!(attempts.lost_files());
    }
}
