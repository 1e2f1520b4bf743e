//! What a run finds on a hobbed gear: names, units, definitions, places.

mod headline;

use super::{blank, force, load, marks, points, wear};
use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::cutting::{CYCLE_TIME, LINKAGE, OFFSET, PASSES, SHORT_OF_DEPTH};
use crate::findings::quantities::flanks::{MEAN_DEVIATION, PROFILE_LENGTH, SQ, START_OF_FLANK};
use crate::findings::{Findings, Notice, Section, Table};
use crate::machine_errors::ErrorLayer;
use crate::measure::tool_wear::ToolWear;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::AXES;
use crate::process::hobbing::measure::flank_report::HobbedReport;
use crate::process::hobbing::measure::hob_force::OperationForce;
use crate::process::hobbing::measure::hob_load::OperationLoad;
use crate::process::hobbing::measure::marks::MarkLattice;
use crate::process::hobbing::quantities::{
    AXIAL_FEED, EVALUATED, IDLE_TIME, IS_UNDERCUT, NOT_NAMED, PROFILE_END, PROFILE_START,
};
use crate::process::hobbing::{HobCutter, HobbedGear, HobbingJob, warnings};
use crate::steps::axes::{self, AxesOfOperation as _};
use crate::steps::inspection::Inspected;
use crate::steps::inspection::headline::candidates;
use crate::steps::inspection::teeth::{self, flank_table};
use crate::steps::machine_errors::{self, TurnTakenOff, tool_words};
use crate::steps::program_under_test::ProgramUnderTest;
use crate::texture::{self, WindowTexture};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use headline::headline;

/// What was measured beside the flanks.
pub struct Measured<'a> {
    /// What every operation asks of the machine.
    pub motion: &'a [HobbingAxesReport<'a>],
    /// Warnings that were known before the cut.
    pub foreseen: &'a [Notice],
    /// Texture of windows.
    pub textures: &'a [WindowTexture],
    /// Sizes, figures and limits.
    pub inspected: &'a Inspected,
    /// Lattices of cutting marks.
    pub lattices: &'a [MarkLattice],
    /// The whole blank with the hob's load and its forces; none after Ctrl-C.
    pub whole: Option<(&'a blank::WholeBlank, &'a [OperationLoad], &'a [OperationForce])>,
    /// Wear of the hob, where the scene says how it wears.
    pub wear: Option<&'a ToolWear>,
}

/// Everything that was found.
///
/// # Errors
/// A blank field that does not fit in memory.
pub fn findings(cutter: &HobCutter, gear: &HobbedGear, measured: &Measured) -> Result<Findings> {
    let job = cutter.job;
    let work = &gear.work;
    let operations = job.operations.iter().zip(measured.motion).zip(&gear.passes);
    let earlier = &job.operations[..job.operations.len() - 1];
    let mut sections = vec![
        OPERATIONS.section([]).parts(operations.map(|((of, motion), &passes)| operation(of, motion, passes))),
        points::findings(gear),
        marks::findings(measured.lattices),
        Section::new("teeth", "Finished teeth")
            .table(flanks(&gear.flanks, earlier.iter().map(|operation| operation.spec.name.as_str())))
            .parts((1..=job.scene.gear.teeth).map(|number| tooth(gear, number))),
        texture::findings(cutter, measured.textures),
        texture::roughness(cutter, measured.textures),
        Section::new("work", "Work of cutting").entries([candidates(work)]),
    ];
    let mut tool = vec![tool_words(&job.hob_spec.mounting)];
    if job.hob_spec.has_pitch_errors() {
        tool.push("pitch errors given for each gash".to_owned());
    }
    tool.retain(|words| !words.is_empty());
    let tool = (ErrorLayer::Tool, tool.join(", "));
    let turn = TurnTakenOff::of_round(job.turn_rad, &job.scene.gear, &job.curve);
    sections.extend(machine_errors::section(&job.errors, &AXES, &[tool], turn));
    sections.extend(evaluated(job));
    sections.extend(measured.inspected.sections(&job.scene.measure, None));
    if let Some((whole, loads, forces)) = measured.whole {
        sections.push(load::findings(job, loads));
        sections.extend(force::findings(job, forces));
        sections.extend(measured.wear.map(|worn| wear::findings(job, worn)));
        sections.push(blank::findings(cutter, whole));
    }
    let mut list = measured.foreseen.to_vec();
    let of_blank = measured.whole.map(|(whole, loads, _)| (&whole.report, loads));
    list.extend(warnings::after(cutter, gear, of_blank)?);
    list.extend(measured.inspected.warnings());
    list.extend(texture::warnings(cutter, measured.textures));
    let headline = headline(job, gear, measured, &list);
    Ok(Findings::new("hobbing", &job.scene.name, !work.interrupted, headline, list, sections))
}

/// All flanks that were cut.
fn flanks<'a>(cut: &'a [HobbedReport], earlier: impl IntoIterator<Item = &'a str>) -> Table {
    let um = |mm: f64| mm * UM_PER_MM;
    flank_table(cut, earlier)
        .column(&START_OF_FLANK, |of| of.own.form_height_mm)
        .column(&IS_UNDERCUT, |of| if of.own.undercut { "yes" } else { "no" })
        .column(&PROFILE_LENGTH, |of| of.length_mm)
        .column(&MEAN_DEVIATION, |of| of.own.finished.map(|of| um(of.mean_mm)))
        .column(&SQ, |of| of.own.finished.map(|of| um(of.rms_mm)))
        .in_file("flanks")
}

/// Where the scene has profiles evaluated, if it names it.
fn evaluated(job: &HobbingJob) -> Option<Section> {
    let [from_mm, to_mm] = job.scene.measure.heights_mm();
    let ends = [PROFILE_START.of_or(from_mm, NOT_NAMED), PROFILE_END.of_or(to_mm, NOT_NAMED)];
    from_mm.or(to_mm).map(|_| EVALUATED.section(ends))
}

fn operation(operation: &PreparedHobbing, motion: &HobbingAxesReport, passes: u32) -> Section {
    let spec = &operation.spec;
    Section::new(&spec.name, format!("Operation {}", spec.name))
        .entries([
            LINKAGE.of(motion.linkage_words()),
            OFFSET.of(operation.offset_mm),
            SHORT_OF_DEPTH.of(spec.offset_mm),
            PASSES.of(passes),
            AXIAL_FEED.of(spec.axial_feed_mm_per_revolution),
            CYCLE_TIME.of(operation.linkage.end_s()).shown(),
            IDLE_TIME.of(operation.plan.idle_s),
        ])
        .part(axes::findings(motion))
        .parts(motion.program().map(ProgramUnderTest::section))
}

/// Pitch and thickness of a tooth, middle of the face, and the deviations of its flanks.
fn tooth(gear: &HobbedGear, number: u32) -> Section {
    let flank = |side: Side| {
        let found = gear.flanks.iter().find(|flank| flank.tooth == number && flank.side == side);
        Section::new(side.name(), format!("{} flank", side.name()))
            .entries(teeth::pitch(&gear.inspection, number, side))
            .entries(teeth::flank(found))
    };
    Section::new(format!("tooth_{number:02}"), format!("tooth {number}"))
        .entries(teeth::tooth(&gear.inspection, number))
        .part(flank(Side::Left))
        .part(flank(Side::Right))
}
