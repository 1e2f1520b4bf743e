//! What a hobbing job computes once and keeps: passes of its operations, and target flanks that were asked for.
//!
//! Passes hold the motion as tables; a target flank is some ten kilobytes of polynomials, found by nested searches that
//! take longer than a thousand dexels. Whoever cuts flanks one by one gets the same passes and targets each time; jobs
//! of one gear with other errors share the targets.

use crate::process::hobbing::Hob;
use crate::process::hobbing::actual::ActualHobbing;
use crate::process::hobbing::commanded::HobbingCommand;
use crate::process::hobbing::flank_patch::FlankPatch;
use crate::process::hobbing::hob::HobEnd;
use gearcut_core::error::Refusal;
use gearcut_core::passes::{MotionTable, TurningPasses};
use gearcut_core::terms::Side;
use gearcut_core::tool::SpatialTool;
use gearcut_core::units::TURN_RAD;
use std::sync::{Arc, OnceLock};

/// Passes and targets of a job.
#[derive(Debug)]
pub struct Kept {
    /// Passes of every operation, numbered on from one to the next.
    pub operations: Vec<TurningPasses>,
    /// The thickest chips that are known before the cut, once somebody has asked.
    foreseen_chips: OnceLock<Vec<Option<ForeseenChip>>>,
}

/// The thickest chip of an operation that is known before the cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForeseenChip {
    /// Hob tooth that takes it, in blade order.
    pub tooth: usize,
    /// Its thickness, mm.
    pub thickness_mm: f64,
    /// The end of the hob beyond which there would be teeth to take their share of it.
    pub missed_end: Option<HobEnd>,
}

/// Targets that were asked for: left and right flank of tooth 1, then of tooth 2 and so on.
#[derive(Debug, Clone)]
pub struct KeptTargets(Arc<[OnceLock<Result<FlankPatch, Refusal>>]>);

impl Kept {
    /// Passes of operations with these names, motions and errors.
    ///
    /// # Errors
    /// More passes than can be numbered.
    pub fn new<'a>(
        hob: &Hob,
        of: impl IntoIterator<Item = (&'a str, HobbingCommand<'a>, &'a ActualHobbing)>,
    ) -> Result<Self, Refusal> {
        let mut operations = Vec::new();
        let mut first_pass = 0;
        for (name, commanded, actual) in of {
            let [from, to] = commanded.turned_rad();
            // Sweeps reach a little further than the moments at which their blades point to the work.
            let beyond_rad = hob.half_window_rad();
            let range_rad = [from - beyond_rad, to + beyond_rad];
            if f64::from(first_pass) + passes(hob, commanded) >= f64::from(u32::MAX) {
                return Err(Refusal::new(
                    "operation.axial_feed_mm_per_revolution",
                    format!("operation {name} has more passes than can be numbered"),
                    "use a larger feed or fewer gashes",
                ));
            }
            let corners: Vec<f64> =
                commanded.corners_s().iter().map(|&time_s| commanded.positions(time_s)[0]).collect();
            let motion = MotionTable::new(range_rad, &corners, |angle| actual.head_from_work(commanded, angle));
            let passes = TurningPasses::new(first_pass, hob, hob.hand, motion)?;
            first_pass = passes.end_pass();
            operations.push(passes);
        }
        Ok(Self { operations, foreseen_chips: OnceLock::new() })
    }

    /// The thickest chips that are known before the cut, found by `find` if nobody has asked for them yet.
    ///
    /// # Errors
    /// Those of `find`.
    pub fn foreseen_chips(
        &self,
        find: impl FnOnce() -> gearcut_core::Result<Vec<Option<ForeseenChip>>>,
    ) -> gearcut_core::Result<&[Option<ForeseenChip>]> {
        if let Some(chips) = self.foreseen_chips.get() {
            return Ok(chips);
        }
        let found = find()?;
        Ok(self.foreseen_chips.get_or_init(|| found))
    }
}

impl KeptTargets {
    /// Those of a gear of so many teeth, before anybody has asked.
    pub fn new(teeth: u32) -> Self {
        Self((0..2 * teeth).map(|_| OnceLock::new()).collect())
    }

    /// Target flank of a tooth, found by `find` if nobody has asked for it yet.
    ///
    /// # Errors
    /// Those of `find`.
    pub fn of(
        &self,
        tooth: u32,
        side: Side,
        find: impl FnOnce() -> Result<FlankPatch, Refusal>,
    ) -> Result<&FlankPatch, Refusal> {
        let place = 2 * (tooth as usize - 1) + usize::from(side == Side::Right);
        self.0[place].get_or_init(find).as_ref().map_err(Clone::clone)
    }
}

/// Passes of an operation: every tooth in every turn of the hob.
pub fn passes(hob: &Hob, commanded: HobbingCommand) -> f64 {
    let [from, to] = commanded.turned_rad();
    (to - from) / TURN_RAD * hob.teeth.len() as f64
}
