//! The teeth as finishing would leave them in the limit of many strokes: where flanks begin and end, how wide the tips
//! are.
//!
//! In: a prepared [`ShapingJob`]. Out: [`ToothFacts`] of every tooth. Nothing is cut for this.
//!
//! Heights are measured over the pitch curve along its normal, so that they mean the same on every tooth of a
//! non-circular gear.

use crate::process::shaping::ShapingJob;
use crate::process::shaping::target::{FlankEnd, TargetFlank};
use gearcut_core::terms::Side;

/// One flank of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankFacts {
    /// Start of the involute, height over the pitch curve, mm.
    pub start_height_mm: f64,
    /// What is there.
    pub start: FlankEnd,
    /// End of the flank, height over the pitch curve, mm.
    pub tip_height_mm: f64,
    /// What is there.
    pub end: FlankEnd,
    /// Length of the profile between them, mm.
    pub length_mm: f64,
}

/// One tooth of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothFacts {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Left flank (larger arc).
    pub left: FlankFacts,
    /// Right flank (smaller arc).
    pub right: FlankFacts,
    /// Width of the tip between the flanks, mm.
    pub tip_land_mm: f64,
}

impl ToothFacts {
    /// Of all teeth of a job.
    pub fn of_job(job: &ShapingJob) -> Vec<Self> {
        let facts = |tooth| {
            let target = job.target(tooth);
            let [left, right] = [Side::Left, Side::Right].map(|side| FlankFacts::new(job, target.flank(side)));
            Self { tooth, left, right, tip_land_mm: target.tip_land_mm }
        };
        (1..=job.scene.gear.teeth).map(facts).collect()
    }

    /// Both flanks with their sides.
    pub fn flanks(&self) -> [(Side, FlankFacts); 2] {
        [(Side::Left, self.left), (Side::Right, self.right)]
    }

    /// Whether the flanks meet below the blank's outline.
    pub fn is_pointed(&self) -> bool {
        self.left.end == FlankEnd::PointedTip || self.right.end == FlankEnd::PointedTip
    }
}

impl FlankFacts {
    fn new(job: &ShapingJob, flank: &TargetFlank) -> Self {
        let height_mm = |arc_mm: f64| {
            let contact = flank.at_arc(arc_mm);
            job.blank.height(contact.point_mm, contact.phi_rad).0
        };
        Self {
            start_height_mm: height_mm(0.0),
            start: flank.form_end,
            tip_height_mm: height_mm(flank.length_mm()),
            end: flank.tip_end,
            length_mm: flank.length_mm(),
        }
    }

    /// Whether the cutter's tip has cut away the beginning of the flank.
    pub fn is_undercut(&self) -> bool {
        self.start == FlankEnd::Undercut
    }
}
