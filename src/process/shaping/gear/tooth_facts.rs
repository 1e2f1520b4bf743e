//! The teeth as finishing would leave them in the limit of many strokes: where flanks begin and end, how wide the tips
//! are.
//!
//! In: a prepared [`ShapingJob`]. Out: [`ToothFacts`] of every tooth. Nothing is cut for this.
//!
//! Heights are measured over the pitch curve along its normal, so that they mean the same on every tooth of a
//! non-circular gear.

use crate::findings::Notice;
use crate::findings::notices::Unreached;
use crate::measure::cut_grid::PLACE_MM;
use crate::measure::damage::{LEAST_DEPTH_MM, gouge_mm};
use crate::number_text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::notices::{CutterBase, NarrowTip, Pointed, Topped, Undercut};
use crate::process::shaping::target::{FlankEnd, TargetFlank};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Tip lands below this (in modules) are called narrow: case-hardened tips break below about 0.2 to 0.3 modules.
const NARROW_LAND_MODULES: f64 = 0.25;

/// What an empty list reads as.
const NONE: &str = "none";
/// Entries of a list that are shown.
const SHOWN: usize = 8;

/// One flank of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankFacts {
    /// Start of the involute, height over the pitch curve, mm.
    pub start_height_mm: f64,
    /// What is there.
    pub start: FlankEnd,
    /// How deep the cutter's tip cuts below the flank under its start, mm; 0 where it is not undercut.
    pub undercut_mm: f64,
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
            undercut_mm: flank.undercut.map_or(0.0, |undercut| undercut.depth_mm),
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

/// What must be known of them before cutting.
pub fn warnings(job: &ShapingJob, facts: &[ToothFacts]) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let undercut = flanks_with(facts, FlankFacts::is_undercut);
    let flanks = facts.iter().flat_map(|tooth| tooth.flanks().map(|(_, flank)| flank));
    let deepest_mm = flanks.map(|flank| flank.undercut_mm).fold(0.0, f64::max);
    if deepest_mm >= LEAST_DEPTH_MM {
        let depth_um = significant(UM_PER_MM * deepest_mm, 3);
        warnings.push(Undercut { flanks: undercut, depth_um }.notice());
    }
    let reaches = |flank: &FlankFacts| {
        let ends_mm = flank.start_height_mm - PLACE_MM..=flank.tip_height_mm + PLACE_MM;
        job.scene.measure.heights_mm().into_iter().flatten().all(|height_mm| ends_mm.contains(&height_mm))
    };
    let unreached = facts.iter().flat_map(ToothFacts::flanks).filter(|(_, flank)| !reaches(flank)).count();
    if unreached > 0 {
        warnings.push(Unreached { flanks: unreached }.notice());
    }
    let base = flanks_with(facts, |flank| flank.end == FlankEnd::CutterBase);
    if base != NONE {
        warnings.push(CutterBase { flanks: base }.notice());
    }
    // The root circle rolls with the pitch circle: outside and in a ring it ends at one height over the pitch curve.
    let nearest_mm = job.operations.iter().map(|operation| operation.spec.offset_mm).fold(f64::INFINITY, f64::min);
    let root_mm = job.cutter.pitch_radius_mm + nearest_mm - job.cutter.root_radius_mm;
    let topped_mm = job.blank.addendum_mm - root_mm;
    if topped_mm >= LEAST_DEPTH_MM {
        let topped = Topped { depth_um: significant(UM_PER_MM * topped_mm, 3) };
        warnings.push(topped.notice().fault_where(topped_mm > gouge_mm(job.scene.gear.module_mm)));
    }
    let pointed = list(facts.iter().filter(|tooth| tooth.is_pointed()).map(|tooth| tooth.tooth.to_string()));
    if pointed != NONE {
        warnings.push(Pointed { teeth: pointed }.notice());
    }
    let narrow_mm = NARROW_LAND_MODULES * job.scene.gear.module_mm;
    let narrow = facts.iter().filter(|tooth| !tooth.is_pointed() && tooth.tip_land_mm < narrow_mm);
    let narrow = list(narrow.map(|tooth| tooth.tooth.to_string()));
    if narrow != NONE {
        let narrow_mm = format!("{narrow_mm:.3}");
        warnings.push(NarrowTip { modules: NARROW_LAND_MODULES, narrow_mm, teeth: narrow }.notice());
    }
    warnings
}

/// Entries with commas, the first ones when there are many.
pub fn list(entries: impl Iterator<Item = String>) -> String {
    let entries: Vec<String> = entries.collect();
    match entries.len() {
        0 => NONE.to_owned(),
        1..=SHOWN => entries.join(", "),
        more => format!("{} and {} more", entries[..SHOWN].join(", "), more - SHOWN),
    }
}

/// Flanks for which something holds, as a list.
pub fn flanks_with(facts: &[ToothFacts], holds: impl Fn(&FlankFacts) -> bool) -> String {
    let flanks = facts.iter().flat_map(|tooth| tooth.flanks().map(|(side, flank)| (tooth.tooth, side, flank)));
    list(flanks.filter(|(_, _, flank)| holds(flank)).map(|(tooth, side, _)| format!("tooth {tooth} {}", side.name())))
}
