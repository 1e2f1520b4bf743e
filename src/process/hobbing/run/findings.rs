//! What a run finds on a hobbed gear: names, units, definitions, places.

use super::{blank, flank_table, force, load, marks, points};
use crate::findings::warning::ranked;
use crate::findings::{Entry, Findings, Place, Quantity, Section, Warning};
use crate::machine_errors::ErrorLayer;
use crate::measure::deviation::PitchDeviations;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::AXES;
use crate::process::hobbing::measure::flank_report::HobbedReport;
use crate::process::hobbing::measure::hob_force::OperationForce;
use crate::process::hobbing::measure::hob_load::OperationLoad;
use crate::process::hobbing::measure::marks::MarkLattice;
use crate::process::hobbing::{HobCutter, HobbedGear, HobbingJob, warnings};
use crate::steps::axes::{self, AxesOfOperation as _};
use crate::steps::inspection::Inspected;
use crate::steps::machine_errors::{self, tool_words};
use crate::texture::{self, WindowTexture};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

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
    pub foreseen: &'a [Warning],
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
        headline: headline(job, gear, measured.motion),
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

/// Largest value over all flanks with its flank.
fn largest(gear: &HobbedGear, value: impl Fn(&HobbedReport) -> Option<f64>) -> Option<(f64, &HobbedReport)> {
    gear.flanks.iter().filter_map(|flank| value(flank).map(|v| (v, flank))).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// What to look at first.
fn headline(job: &HobbingJob, gear: &HobbedGear, motion: &[HobbingAxesReport]) -> Vec<Entry> {
    type At<'a> = &'a dyn Fn(&HobbedReport) -> Option<[f64; 2]>;
    let extreme_at = |value: &dyn Fn(&HobbedReport) -> Option<f64>, at: At, definition: &'static str| {
        let found = largest(gear, value);
        let quantity = Quantity::number_or(
            found.map(|(v, _)| v * UM_PER_MM),
            "um",
            definition,
            "a dexel of every evaluated part was reached by no pass",
        );
        match found {
            None => quantity,
            Some((_, flank)) => {
                let [u_mm, v_mm] = at(flank).unwrap_or([0.5 * flank.length_mm, 0.0]);
                quantity.at(Place::on_flank(flank.tooth, flank.side.name(), u_mm, v_mm))
            }
        }
    };
    // Traces stand in the middle of the flank.
    let extreme = |value: &dyn Fn(&HobbedReport) -> Option<f64>, definition: &'static str| {
        extreme_at(value, &|_| None, definition)
    };
    let of_pitch = |pick: fn(&PitchDeviations) -> f64, definition: &'static str| {
        let largest = gear.inspection.pitch.iter().flatten().map(pick).reduce(f64::max);
        Quantity::number_or(largest.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
    };
    let sharpest = job.curve.facts().largest_curvature.curvature_per_mm;
    vec![
        Entry::headline(
            "highest_mark",
            "highest mark",
            extreme_at(
                &|f| f.own.finished.map(|h| h.highest_mm),
                &|f| f.own.finished.map(|h| h.extremes_at_mm[1]),
                "largest normal deviation of the finished surface on the evaluated part of any flank: feed and \
                generating marks together",
            ),
        ),
        Entry::headline(
            "deepest_cut",
            "deepest cut",
            extreme_at(
                &|f| f.own.finished.map(|h| -h.lowest_mm),
                &|f| f.own.finished.map(|h| h.extremes_at_mm[0]),
                "deepest place of the finished surface below the target, positive inwards; an exact linkage leaves \
                none",
            ),
        ),
        Entry::headline(
            "feed_mark_closed_form",
            "feed mark, closed form",
            Quantity::number(
                job.finishing().plan.feed_mark_mm * UM_PER_MM,
                "um",
                "f^2 sin(alpha_n) / (8 R_c) of the last operation, f the feed over cos of the head angle, R_c the \
                hob's smallest contact radius",
            ),
        ),
        Entry::headline(
            "generating_mark_closed_form",
            "generating mark, closed form",
            Quantity::number(
                job.generating_mark_mm(sharpest) * UM_PER_MM,
                "um",
                "arc per gash squared times sin(alpha_t) cos(beta_b) / (8 rho) where the pitch curve bends most",
            ),
        ),
        Entry::headline(
            "profile_deviation",
            "profile deviation",
            extreme(&|f| f.profile.map(|d| d.total_mm), "largest F_alpha in the middle of the face"),
        ),
        Entry::headline(
            "helix_deviation",
            "helix deviation",
            extreme(&|f| f.lead.map(|d| d.total_mm), "largest F_beta in the middle of the profile"),
        ),
        Entry::headline(
            "single_pitch_deviation",
            "single pitch deviation",
            of_pitch(PitchDeviations::largest_single_mm, "largest f_p of either flank, arc of the pitch curve"),
        ),
        Entry::headline(
            "total_pitch_deviation",
            "total pitch deviation",
            of_pitch(PitchDeviations::total_mm, "F_p, range of the cumulative pitch deviations, larger of both flanks"),
        ),
        Entry::headline(
            "runout",
            "runout",
            Quantity::number_or(
                gear.inspection.runout.as_ref().map(|r| r.total_mm() * UM_PER_MM),
                "um",
                "F_r, range of a probe's place along the pitch curve's normal over all spaces",
                NOT_CROSSED,
            ),
        ),
        Entry::headline(
            "undercut_flanks",
            "undercut flanks",
            Quantity::count(
                gear.flanks.iter().filter(|f| f.own.undercut).count() as u64,
                "flanks",
                "flanks whose involute the hob's tip corner has cut away in some section",
            ),
        ),
        axes::margin_entry(motion),
        Entry::headline(
            "cycle_time",
            "cycle time",
            Quantity::number(
                job.operations.iter().map(|o| o.linkage.end_s()).sum(),
                "s",
                "time of all operations, approach, overrun and idle travel included",
            ),
        ),
    ]
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
