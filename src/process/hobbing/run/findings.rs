//! What a run finds on a hobbed gear: names, units, definitions, places.

mod headline;

use super::{blank, flank_table, force, load, marks, points};
use crate::findings::notice::ranked;
use crate::findings::{Findings, Notice, Quantity, Section};
use crate::machine_errors::ErrorLayer;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::AXES;
use crate::process::hobbing::measure::hob_force::OperationForce;
use crate::process::hobbing::measure::hob_load::OperationLoad;
use crate::process::hobbing::measure::marks::MarkLattice;
use crate::process::hobbing::{HobCutter, HobbedGear, HobbingJob, warnings};
use crate::steps::axes::{self, AxesOfOperation as _};
use crate::steps::inspection::Inspected;
use crate::steps::machine_errors::{self, tool_words};
use crate::steps::program_under_test::ProgramUnderTest;
use crate::texture::{self, WindowTexture};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use headline::headline;

/// Why a pitch is not known.
const NOT_CROSSED: &str = "a flank was not cut or does not cross the pitch curve";

/// What the ends of the evaluated profile are.
const START: &str = "lower end of the evaluated profile, as height over the pitch curve along its normal in the middle \
    of the face; heights and profile deviations are those inside of it";
const END: &str = "upper end of the evaluated profile, as height over the pitch curve along its normal in the middle \
    of the face; heights and profile deviations are those inside of it";

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
        Section::new("operations", "Operations")
            .parts(operations.map(|((of, motion), &passes)| operation(of, motion, passes))),
        points::findings(gear),
        marks::findings(measured.lattices),
        Section::new("teeth", "Finished teeth")
            .table(flank_table::flanks(
                &gear.flanks,
                earlier.iter().map(|operation| operation.spec.name.as_str()),
                job.scene.measure.heights_mm().iter().any(Option::is_some),
            ))
            .parts((1..=job.scene.gear.teeth).map(|number| tooth(gear, number))),
        texture::findings(cutter, measured.textures),
        texture::roughness(cutter, measured.textures),
        Section::new("work", "Work of cutting").with(
            "candidates",
            Quantity::number(
                work.stats.dexel_passes as f64 / work.dexels.max(1) as f64,
                "passes",
                "passes visited per dexel and operation; two or three touch it",
            ),
        ),
    ];
    let mut tool = vec![tool_words(&job.hob_spec.mounting)];
    if job.hob_spec.has_pitch_errors() {
        tool.push("pitch errors given for each gash".to_owned());
    }
    tool.retain(|words| !words.is_empty());
    let tool = (ErrorLayer::Tool, tool.join(", "));
    sections.extend(machine_errors::section(&job.errors, &AXES, &[tool]));
    sections.extend(evaluated(job));
    sections.extend(measured.inspected.sections(&job.scene.measure, None));
    if let Some((whole, loads, forces)) = measured.whole {
        sections.push(load::findings(job, loads));
        sections.extend(force::findings(job, forces));
        sections.push(blank::findings(cutter, whole));
    }
    let mut list = measured.foreseen.to_vec();
    let of_blank = measured.whole.map(|(whole, loads, _)| (&whole.report, loads));
    list.extend(warnings::after(cutter, gear, of_blank)?);
    list.extend(measured.inspected.warnings());
    list.extend(texture::warnings(cutter, measured.textures));
    Ok(Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: "hobbing".to_owned(),
        scene: job.scene.name.clone(),
        complete: !work.interrupted,
        headline: headline(job, gear, measured),
        warnings: ranked(list),
        sections,
    })
}

/// Where the scene has profiles evaluated, if it names it.
fn evaluated(job: &HobbingJob) -> Option<Section> {
    let heights_mm = job.scene.measure.heights_mm();
    let end = |height_mm: Option<f64>, definition: &'static str| {
        Quantity::number_or(height_mm, "mm", definition, "not named: 5 % of the profile are left out")
    };
    heights_mm.iter().any(Option::is_some).then(|| {
        Section::new("measure", "Evaluated profile")
            .with("profile_start_height", end(heights_mm[0], START))
            .with("profile_end_height", end(heights_mm[1], END))
    })
}

fn operation(operation: &PreparedHobbing, motion: &HobbingAxesReport, passes: u32) -> Section {
    let spec = &operation.spec;
    Section::new(&spec.name, format!("Operation {}", spec.name))
        .with("linkage", Quantity::text(motion.linkage_words(), "linkage of hob and work"))
        .with(
            "offset",
            Quantity::number(
                operation.offset_mm,
                "mm",
                "how far the hob stays back from full depth, allowance included",
            ),
        )
        .with("passes", Quantity::count(passes.into(), "passes", "teeth times turns of the hob"))
        .with(
            "axial_feed",
            Quantity::number(
                spec.axial_feed_mm_per_revolution,
                "mm",
                "feed along the gear's axis in the time of one cycle",
            ),
        )
        .shown("cycle_time", "time", Quantity::number(operation.linkage.end_s(), "s", "time of the operation"))
        .shown("idle_time", "idle", Quantity::number(operation.plan.idle_s, "s", "time in which the hob does not cut"))
        .part(axes::findings(motion))
        .parts(motion.program().map(ProgramUnderTest::section))
}

/// Pitch and thickness of a tooth, middle of the face.
fn tooth(gear: &HobbedGear, number: u32) -> Section {
    let row = number as usize - 1;
    let side = |key: &str, index: usize| {
        let pitch = gear.inspection.pitch[index].as_ref();
        let um = |value: Option<f64>, definition: &'static str| {
            Quantity::number_or(value.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
        };
        Section::new(key, format!("{key} flank"))
            .with(
                "single_pitch",
                um(
                    pitch.map(|p| p.single_mm[row]),
                    "f_p: arc of the pitch curve from the tooth before, less the mean pitch",
                ),
            )
            .with(
                "cumulative_pitch",
                um(pitch.map(|p| p.cumulative_mm[row]), "arc of the pitch curve from tooth 1, less its mean pitches"),
            )
    };
    let thickness = gear.inspection.thickness.get(row).copied().flatten();
    let mm = |value: Option<f64>, definition: &'static str| Quantity::number_or(value, "mm", definition, NOT_CROSSED);
    Section::new(format!("tooth_{number:02}"), format!("tooth {number}"))
        .with("thickness_arc", mm(thickness.map(|t| t.arc_mm), "tooth thickness along the pitch curve"))
        .with(
            "thickness_chord",
            mm(thickness.map(|t| t.chord_mm), "tooth thickness straight between its crossings with the pitch curve"),
        )
        .part(side("left", 0))
        .part(side("right", 1))
}
