//! How far the work is, and Ctrl-C: what every long loop of a pair tells and asks after each of its units.
//!
//! In: where progress is shown, the flag that Ctrl-C raises. Out: [`WatchedUnits`]s; a unit that is done is counted,
//! and no other begins once the flag is raised.
//!
//! A pair keeps nothing of what Ctrl-C ends: half a period has no transmission error.

use crate::interrupt::Interrupt;
use crate::progress::{Progress, ProgressStep};
use gearcut_core::error::Result;

/// Names of the stages, in their order.
pub const CUT: [&str; 2] = ["cut gear A", "cut gear B"];
/// The contact search at every position.
pub const ROLL: &str = "roll";
/// Path of contact at some positions.
pub const RATIO: &str = "contact ratio";
/// Where contact begins and ends.
pub const BY_TOOTH: &str = "contact by tooth";
/// Smallest gaps on all flanks.
pub const PATTERN: &str = "contact pattern";
/// Tip corners in the mate.
pub const CORNERS: &str = "tip corners";
/// The same gears at a larger centre distance.
pub const DISTANCE: &str = "centre distance";
/// Tight mesh with the mate.
pub const TIGHT: &str = "tight mesh";
/// Tight mesh of either gear with a master.
pub const MASTERS: [&str; 2] = ["master with gear A", "master with gear B"];
/// The animation.
pub const PICTURES: &str = "pictures";

/// How much there is to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingWork {
    /// Teeth of both gears.
    pub teeth: [u32; 2],
    /// Whether gear B is a ring.
    pub ring: bool,
    /// Whether flanks are cut.
    pub cut: bool,
    /// Whether teeth are helical.
    pub helical: bool,
    /// Transverse sections.
    pub sections: usize,
    /// Positions in the period.
    pub positions: usize,
    /// Pitches of the tight mesh.
    pub pitches: u32,
}

/// Where progress is shown and what ends the work.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    progress: &'a Progress,
    interrupt: &'a Interrupt,
}

/// Work that consists of equal units, done from any thread.
pub struct WatchedUnits<'a> {
    step: ProgressStep<'a>,
    interrupt: &'a Interrupt,
}

impl<'a> Watch<'a> {
    /// Shows progress there, and stops on that flag.
    pub fn new(progress: &'a Progress, interrupt: &'a Interrupt) -> Self {
        Self { progress, interrupt }
    }

    /// Tells what is to come, so that the time left of the whole command can be shown.
    pub fn plan(&self, work: &RollingWork) {
        let [sections, positions] = [work.sections, work.positions].map(|count| count as f64);
        let [teeth_a, teeth_b] = work.teeth.map(f64::from);
        // Seconds by trial on two cores; only their proportions count. Helical teeth are hobbed, in space.
        let cut = if !work.cut {
            0.0
        } else if work.helical {
            0.25 * sections
        } else {
            0.06 * sections
        };
        self.progress.plan(vec![
            (CUT[0], cut * teeth_a),
            (CUT[1], cut * teeth_b),
            (ROLL, 6e-4 * positions * sections),
            (BY_TOOTH, 1e-5 * positions * sections),
            (PATTERN, 4e-4 * positions * sections),
            (CORNERS, 2e-4 * positions * sections),
            (RATIO, 5e-5 * positions),
            (TIGHT, 4e-2 * f64::from(work.pitches) * sections),
            (MASTERS[0], 3e-2 * teeth_a),
            (MASTERS[1], if work.ring { 0.0 } else { 3e-2 * teeth_b }),
            (DISTANCE, 5e-5 * positions * sections),
            (PICTURES, 2.0),
        ]);
    }

    /// Begins a stage of `total` units.
    ///
    /// # Errors
    /// Ctrl-C.
    pub fn stage(&self, name: &str, total: usize, unit: &str) -> Result<WatchedUnits<'a>> {
        self.check()?;
        Ok(WatchedUnits { step: self.progress.step(name, total as u64, unit), interrupt: self.interrupt })
    }

    /// Between pieces of work that are no stage.
    ///
    /// # Errors
    /// Ctrl-C.
    pub fn check(&self) -> Result<()> {
        self.interrupt.check()
    }
}

impl WatchedUnits<'_> {
    /// A unit is done.
    ///
    /// # Errors
    /// Ctrl-C: the next one is not to begin.
    pub fn count(&self) -> Result<()> {
        self.step.advance(1);
        self.interrupt.check()
    }

    /// All units are done.
    pub fn finish(self) {
        self.step.finish();
    }
}
