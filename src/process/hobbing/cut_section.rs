//! The transverse section in the middle of the face while it is being hobbed, pass by pass, and the hob's teeth in it.
//!
//! In: a cutter with its passes and a number of them. Out: one slice of the blank after exactly these passes, and the
//! sections of the teeth that point to the work together, which are the generating rack as far as that gash has it.
//!
//! A tooth is drawn by its edge, point by point where it is when it goes through the section (the law of
//! [`SweptSections`]): that curve is what the pass takes. Steps are the passes whose tip comes as near to the gear's
//! axis as the stock reaches; passes between them are cut all the same.

use super::{HobCutter, HobbingJob};
use crate::steps::frames::place;
use crate::steps::frames::section::SectionByStep;
use crate::steps::whole_blank;
use gearcut_core::cut::Backend as _;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::BlankField;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::passes::TurningPasses;
use gearcut_core::passes::sections::swept_sections::{SweptSection, SweptSections};
use gearcut_core::passes::spatial::turning_passes::BladePass;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use std::ops::Range;

/// Chords of a drawn edge in each of its pieces: a fifth of a millimetre on usual hobs, far below a pixel off.
const CHORDS: u32 = 8;
/// Thickness of the drawn teeth, which lie on the gear's upper face, as a share of the face width.
const THICKNESS: f64 = 0.08;
/// Teeth half a gash away belong to neither side, rad: more than rounding of the hob's angle.
const SAME_GASH_RAD: f64 = 1e-6;

/// The section as it grows smaller.
pub struct HobbedSection<'a> {
    cutter: &'a HobCutter<'a>,
    field: BlankField,
    /// Ids of the passes that come through the stock's section, operation by operation.
    ids: Vec<Vec<u32>>,
    done: usize,
}

impl<'a> HobbedSection<'a> {
    /// The uncut blank, with rays as far apart as in the scene's blank field.
    ///
    /// # Errors
    /// A field that does not fit in memory; passes that never come through the section.
    pub fn new(cutter: &'a HobCutter<'a>) -> Result<Self> {
        let job = cutter.job;
        let reach_mm = reach_mm(job);
        let through = |passes| Ok(sections(passes, reach_mm, |_| true, true)?.ids_through(0.0, reach_mm));
        let ids = cutter.operations.iter().map(through).collect::<Result<Vec<_>>>()?;
        if ids.iter().all(Vec::is_empty) {
            let problem = "no pass of the hob comes through the middle of the face";
            return Err(Refusal::new("operation", problem, "feed the hob past the middle of the face").into());
        }
        Ok(Self { cutter, field: whole_blank::field(&job.scene, &job.stock, true)?, ids, done: 0 })
    }

    /// Operation and place among its own of a pass counted over all operations.
    fn place(&self, step: usize) -> (usize, usize) {
        place(self.ids.iter().map(Vec::len), step)
    }

    /// Passes of an operation and the pass of a step.
    pub fn pass(&self, step: usize) -> (&TurningPasses, BladePass) {
        let (operation, own) = self.place(step);
        let passes = &self.cutter.operations[operation];
        (passes, passes.pass(self.ids[operation][own] - passes.first_pass))
    }
}

impl SectionByStep for HobbedSection<'_> {
    fn steps(&self) -> usize {
        self.ids.iter().map(Vec::len).sum()
    }

    fn advance(&mut self, until: usize) -> Result<()> {
        let mut before = 0;
        for (ids, passes) in self.ids.iter().zip(self.cutter.operations.iter()) {
            // From the pass of one step to that of the next, with what lies between them.
            let at = |step: usize| match step.saturating_sub(before) {
                0 => passes.first_pass,
                own => ids.get(own).copied().unwrap_or(passes.end_pass()),
            };
            let range: Range<u32> = at(self.done)..at(until);
            before += ids.len();
            if range.is_empty() {
                continue;
            }
            let wanted = |pass: &BladePass| range.contains(&pass.pass);
            let sections = sections(passes, reach_mm(self.cutter.job), wanted, true)?;
            // Nothing stops this: a frame is short. What each pass took is not asked for.
            let _taken = Cpu::default().cut_blank_sweeps(&mut self.field, &sections, range, &|| true)?;
        }
        self.done = until;
        Ok(())
    }

    fn field(&self) -> &BlankField {
        &self.field
    }

    fn axis_mm(&self, step: usize) -> DVec2 {
        let (passes, pass) = self.pass(step);
        passes.motion.head_from_work(pass.tool_angle_rad).inverse().translation_mm.truncate()
    }

    fn tool_mm(&self, step: usize) -> Result<Vec<Vec<Vec<DVec2>>>> {
        let (passes, pass) = self.pass(step);
        let half_gash_rad = 0.5 * TURN_RAD / f64::from(self.cutter.job.hob.gashes) - SAME_GASH_RAD;
        let beside = |other: &BladePass| (other.tool_angle_rad - pass.tool_angle_rad).abs() < half_gash_rad;
        let sections = sections(passes, reach_mm(self.cutter.job), beside, false)?;
        let mut section = SweptSection::default();
        let outline = |index| sections.section(index, 0.0, &mut section).then(|| vec![section.outline_mm(CHORDS)]);
        Ok((0..sections.len()).filter_map(outline).collect())
    }

    fn tool_z_mm(&self) -> [f64; 2] {
        [0.5, 0.5 + THICKNESS].map(|share| share * self.cutter.job.scene.gear.face_width_mm)
    }

    fn title(&self, until: usize) -> String {
        let (operation, own) = self.place(until.saturating_sub(1));
        let after = if until == 0 { 0 } else { own + 1 };
        let name = &self.cutter.job.operations[operation].spec.name;
        format!("{name}: pass {after} of {} through the middle of the face", self.ids[operation].len())
    }
}

fn reach_mm(job: &HobbingJob) -> f64 {
    BlankOutline::new(&job.stock).reach_mm()
}

/// Sections of the wanted passes at the middle of the face, culled there if wished.
fn sections(
    passes: &TurningPasses,
    reach_mm: f64,
    wanted: impl Fn(&BladePass) -> bool + Sync,
    cull: bool,
) -> Result<SweptSections, Refusal> {
    SweptSections::new(wanted, passes, reach_mm, 0.0, cull)
}
