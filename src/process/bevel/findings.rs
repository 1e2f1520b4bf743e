//! What a run finds on a bevel gear: names, units, definitions, places.

mod tables;
pub mod whole;

use super::axes_report::{BevelAxesReport, idle_share};
use super::blank::{CellGrid, CutCells};
use super::chips::{SlotLedger, SlotPass};
use super::entry;
use super::gear::BevelGear;
use super::job::BevelJob;
use super::measure;
use super::motion::AXES;
use super::net::Position;
use super::operation::PreparedBevel;
use super::quantities::{
    AXIS, BLANK_OFFSET, CENTER_TO_BACK, CRADLE, CUTTER_RADIUS, DWELL, ERRORS, EXPLAINED, FITS, FLANK_BLADES, FORM,
    IDLE_SHARE, INFEED, INFERRED_RADIUS, INFERRED_RATIO, INFERRED_SPIRAL, LARGEST_ERROR, MARK_HEIGHT, MARK_SPACING,
    MARKS, MISSED_DEPTH, MODIFIED_C, MODIFIED_D, NO_GRID, NO_MARKS, NO_SLOT, NOTHING_TO_EXPLAIN, ORDER, PLUNGE_WAY,
    POSITION, PRESSURE, RADIAL, RADIUS_SOURCE, ROLL_FROM, ROLL_RATIO, ROLL_TO, ROOT_ANGLE, SETTING, SETTING_ERROR,
    SETTINGS, SETTINGS_SOURCE, SLIDING_BASE, SLOT_DEPTH, SLOT_TIME, SLOT_WIDTH, SPIRAL, SWIVEL, THICKNESS, TILT,
    UNEXPLAINED, WHOLE_DEPTH,
};
use super::scene::model::SlotFeed;
use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::cutting::{CYCLE_TIME, IDLE, LINKAGE, NO_MATERIAL, OFFSET, PASSES, STOPPED};
use crate::findings::{Entry, Findings, Notice, QuantityRow, Section, Table};
use crate::machine_errors::ErrorLayer;
use crate::number_text::{significant, size};
use crate::steps::axes::{self, AxesOfOperation as _};
use crate::steps::foreseen::{Foreseen, windows};
use crate::steps::inspection::headline::{self, Cutting, Placed, candidates};
use crate::steps::machine_errors::{self, TurnTakenOff, tool_words};
use crate::steps::parts::Stages;
use crate::steps::program_under_test::ProgramUnderTest;
use crate::steps::untouched_dexels;
use crate::texture::{self, WindowTexture};
use gearcut_core::bevel::ease_off::{Explained, Setting};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
use tables::{blades, flanks, grid, slot};

/// What was measured besides the flanks.
pub struct BevelMeasured<'a> {
    /// The six-axis machine, operation by operation.
    pub motion: &'a [BevelAxesReport<'a>],
    /// Warnings that were known before the cut.
    pub foreseen: &'a [Notice],
    /// Texture windows.
    pub textures: &'a [WindowTexture],
    /// The whole gear and the chips of a slot; nothing where the run was stopped before.
    pub whole: Option<(&'a CutCells, &'a SlotLedger)>,
}

/// Everything that was found.
///
/// # Errors
/// Flanks without a middle.
pub fn findings(job: &BevelJob, gear: &BevelGear, measured: &BevelMeasured) -> Result<Findings> {
    let BevelMeasured { motion, foreseen, textures, whole } = *measured;
    let work = &gear.work;
    let mut warnings = foreseen.to_vec();
    let untouched = gear.flanks.iter().map(|flank| flank.untouched).sum();
    warnings.extend(untouched_dexels(untouched, "the roll does not cover the whole flanks"));
    warnings.extend(work.warnings());
    warnings.extend(texture::warnings(job, textures));
    let mut sections = vec![
        settings(job),
        operations(job, motion)?,
        marks(job)?,
        Section::new("teeth", "Finished teeth").table(flanks(job, gear)).table(grid(job, gear)),
        slot(gear),
        position(gear),
        errors(job, gear)?,
        blades(job, gear),
    ];
    sections.extend(errors_of_machine(job));
    if let Some((blank, ledger)) = whole {
        sections.extend([whole::blank(job, blank), whole::chips(job, ledger)]);
    }
    sections.extend([texture::findings(job, textures), texture::roughness(job, textures)]);
    sections.push(Section::new("work", "Work of cutting").entries([candidates(work)]));
    let headline = headline(job, gear, measured);
    Ok(Findings::new("bevel", &job.scene.name, !work.interrupted, headline, warnings, sections))
}

/// What is known before anything is cut: keys that contradict each other, a head that hits the next tooth, undercut,
/// what the axes say, and where texture is looked at.
///
/// # Errors
/// A place that the roll does not generate, a window that lies on no flank, too many rays through the blank.
pub fn foresee(job: &BevelJob, motion: &[BevelAxesReport], wanted: Stages) -> Result<Foreseen> {
    CellGrid::of_scene(job)?;
    let windows = windows(job, wanted)?;
    let own = job.next_tooth_warning()?.into_iter().chain(job.contradictions()).chain(job.undercut_warning()?);
    let own = own.chain(entry::warning(job)).chain(axes::warnings(motion)).collect();
    Foreseen::new(job, &windows, own, true)
}

fn headline(job: &BevelJob, gear: &BevelGear, measured: &BevelMeasured) -> Vec<Entry> {
    let passes = || measured.whole.map(|(_, ledger)| ledger.passes.iter().filter(|pass| !pass.is_plunge()));
    let largest = |value: &dyn Fn(&SlotPass) -> f64| -> Placed {
        let found = passes().ok_or(STOPPED)?.max_by(|a, b| value(a).total_cmp(&value(b))).ok_or(IDLE)?;
        Ok((value(found), whole::place(job, found)))
    };
    let force_n = match job.spec.material {
        None => Err(NO_MATERIAL),
        Some(_) => largest(&|pass| pass.force_n.unwrap_or_default()),
    };
    let teeth = f64::from(job.blank.teeth);
    let cutting = Cutting {
        operations: job.operations.len(),
        cycle_s: job.operations.iter().map(|operation| teeth * operation.cycle_s()).sum(),
        margin: axes::margin(measured.motion),
        thickest_um: largest(&|pass| pass.thickness_mm * UM_PER_MM),
        force_n,
        removed_mm3: measured.whole.and_then(|(blank, _)| Some(blank.blank_mm3 - blank.left_mm3.last()?)),
    };
    let mut entries = headline::headline(&gear.flanks, None, cutting, &gear.work);
    let middle = gear.slot.iter().min_by(|a, b| a.along_mm.abs().total_cmp(&b.along_mm.abs()));
    entries.extend([
        SLOT_DEPTH.of_or(middle.and_then(|row| row.depth_mm), NO_SLOT),
        WHOLE_DEPTH.of_or(middle.map(|row| row.whole_depth_mm), NO_SLOT),
        SLOT_WIDTH.of_or(middle.and_then(|row| row.width_mm), NO_SLOT),
    ]);
    entries.extend(idle_share(job, job.finishing()).map(|share| IDLE_SHARE.of(share)));
    entries
}

/// Settings as they hold, and what they say of the cutter.
fn settings(job: &BevelJob) -> Section {
    let of = &job.finishing().settings;
    let given = if job.spec.head.radius_mm.is_some() { "given by the scene" } else { "inferred from the settings" };
    let tilt = (!of.tilt.is_none())
        .then(|| [TILT.of(of.tilt.tilt_rad.to_degrees()), SWIVEL.of(of.tilt.swivel_rad.to_degrees())]);
    SETTINGS
        .section([
            SETTINGS_SOURCE.of(job.spec.settings_source()),
            RADIAL.of(of.radial_setting_mm),
            CRADLE.of(of.cradle_angle_rad.to_degrees()),
            BLANK_OFFSET.of(of.blank_offset_mm),
            SLIDING_BASE.of(of.sliding_base_mm),
            CENTER_TO_BACK.of(of.center_to_back_mm),
            ROOT_ANGLE.of(of.root_angle_rad.to_degrees()),
            ROLL_RATIO.of(of.roll.ratio),
            CUTTER_RADIUS.of(job.head.radius_mm),
            RADIUS_SOURCE.of(given),
            INFERRED_RADIUS.of(job.inferred.radius_mm),
            INFERRED_SPIRAL.of(job.inferred_spiral_rad().to_degrees()),
            MODIFIED_C.of(of.roll.second_order_per_rad),
            MODIFIED_D.of(of.roll.third_order_per_rad2),
            INFERRED_RATIO.of(job.inferred.roll_ratio),
            MISSED_DEPTH.of(job.depth_missed_mm()),
        ])
        .entries(tilt.into_iter().flatten())
}

fn operations(job: &BevelJob, motion: &[BevelAxesReport]) -> Result<Section> {
    let mut section = OPERATIONS.section([]);
    for (index, report) in motion.iter().enumerate() {
        let operation = report.operation();
        let ids = job.slots.ids(index);
        let fits = report.fits()?;
        let is_fitted = !fits.is_empty();
        let fits = Table::over(FITS.key, FITS.title, fits)
            .column(&AXIS, |fit| fit.letter.to_string())
            .column(&ORDER, |fit| fit.order as u32)
            .column(&LARGEST_ERROR, |fit| fit.fit.largest_error);
        let part = Section::new(&operation.spec.name, format!("Operation {}", operation.spec.name))
            .entries([
                LINKAGE.of(report.linkage_words()),
                OFFSET.of(operation.spec.offset_mm),
                PASSES.of(ids.end - ids.start),
            ])
            .entries(way(operation))
            .entries([
                SLOT_TIME.of(operation.cycle_s()),
                CYCLE_TIME.of(f64::from(job.blank.teeth) * operation.cycle_s()),
            ])
            .entries(idle_share(job, operation).map(|share| IDLE_SHARE.of(share)));
        let part = if is_fitted { part.table(fits) } else { part };
        section =
            section.part(part.part(axes::findings(report)).parts(report.program().map(ProgramUnderTest::section)));
    }
    Ok(section)
}

/// How the head goes through a slot.
fn way(operation: &PreparedBevel) -> Vec<Entry> {
    let [from, to] = operation.course.range;
    match operation.spec.feed {
        SlotFeed::Roll { .. } => vec![ROLL_FROM.of(from.to_degrees()), ROLL_TO.of(to.to_degrees())],
        SlotFeed::Plunge { mm_per_turn, .. } => {
            vec![PLUNGE_WAY.of(to - from), INFEED.of(mm_per_turn), DWELL.of(operation.course.dwell_s)]
        }
    }
}

fn marks(job: &BevelJob) -> Result<Section> {
    let mut section = MARKS.section([]);
    for side in [Side::Left, Side::Right] {
        let marks = measure::marks(job, side)?;
        let entries = [
            FLANK_BLADES.of(job.kind_of(side).name()),
            FORM.of(job.kind_of(side).flank()),
            MARK_HEIGHT.of_or(marks.map(|marks| marks.height_mm * UM_PER_MM), NO_MARKS),
            MARK_SPACING.of_or(marks.map(|marks| marks.spacing_mm), NO_MARKS),
        ];
        section = section.part(Section::new(side.name(), format!("{} flanks", side.name())).entries(entries));
    }
    Ok(section)
}

/// The layers of errors that are on; none of an ideal machine.
fn errors_of_machine(job: &BevelJob) -> Option<Section> {
    let spec = &job.spec;
    let settings = spec.settings.errors.iter().flat_map(|&(setting, error)| match setting {
        Setting::RollRatio => size(setting.name(), error, ""),
        setting if setting.is_angle() => size(setting.name(), error.to_degrees(), "deg"),
        _ => size(setting.name(), error, "mm"),
    });
    let settings = settings.map(|words| words.trim_end().to_owned()).collect::<Vec<_>>().join(", ");
    let mut own = vec![(ErrorLayer::Axes, settings), (ErrorLayer::Tool, tool_words(&spec.head.mounting))];
    if spec.head.runouts_mm.iter().any(|&runout| runout != 0.0) {
        own.push((ErrorLayer::Tool, "runouts given for each blade".to_owned()));
    }
    let middle = job.target_of(Side::Left).row(0.0).and_then(|row| row.point(0.5)).ok();
    // The work turns about x against the gear's frame, which looks from the other side.
    let mm_per_rad = middle.map_or(0.0, |at| -DVec3::X.cross(at.point_mm).dot(at.normal));
    machine_errors::section(&spec.errors, &AXES, &own, TurnTakenOff { turn_rad: job.turn_rad, mm_per_rad })
}

/// Thickness, spiral and pressure angle error: what gear inspection takes apart from the form of flanks.
fn position(gear: &BevelGear) -> Section {
    let of = |side: Side, value: &dyn Fn(&Position) -> f64| -> Option<f64> {
        let flanks = gear.flanks.iter().filter(|flank| flank.side == side);
        let values: Vec<f64> = flanks.map(|flank| Position::of(flank).map(|of| value(&of))).collect::<Option<_>>()?;
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let um = |row: &QuantityRow, value_mm: Option<f64>| row.of_or(value_mm.map(|mm| mm * UM_PER_MM), NO_GRID);
    let thickness = of(Side::Left, &|of| of.middle_mm).zip(of(Side::Right, &|of| of.middle_mm));
    let angles = [Side::Left, Side::Right].into_iter().flat_map(|side| [(side, &SPIRAL, 0), (side, &PRESSURE, 1)]);
    let angles =
        angles.map(|(side, row, which)| {
            um(row, of(side, &|of| of.over_grid_mm()[which]))
                .keyed(format!("{}_{}", row.key, side.name()))
                .titled(format!("{}, {}", row.title(), side.name()))
        });
    POSITION.section([um(&THICKNESS, thickness.map(|(left, right)| left + right))].into_iter().chain(angles))
}

/// Settings whose errors explain the deviations of tooth 1.
fn errors(job: &BevelJob, gear: &BevelGear) -> Result<Section> {
    let mut section = ERRORS.section([]);
    for flank in gear.flanks.iter().filter(|flank| flank.tooth == 1) {
        let side = flank.side.name();
        let found = measure::explained(job, flank)?;
        let said = |one: &Explained| {
            let (error, unit) = match one.setting {
                Setting::RollRatio => (one.error, ""),
                setting if setting.is_angle() => (one.error.to_degrees(), " deg"),
                _ => (one.error, " mm"),
            };
            let left_um = one.left_rms_mm * UM_PER_MM;
            let (error, left_um) = (significant(error, 3), significant(left_um, 2));
            format!("{} off by {error}{unit} leaves {left_um} um rms", one.setting.name())
        };
        let words = found.as_ref().map(|found| format!("{}; next {}", said(&found[0]), said(&found[1])));
        let explained = EXPLAINED.of_or(words, NOTHING_TO_EXPLAIN);
        section =
            section.entries([explained.keyed(format!("{side}_{}", EXPLAINED.key)).titled(format!("tooth 1 {side}"))]);
        let Some(found) = found else { continue };
        let table = Table::over(side, &format!("Tooth 1, {side} flank"), found)
            .column(&SETTING, |one| one.setting.name())
            .column(&SETTING_ERROR, |one| if one.setting.is_angle() { one.error.to_degrees() } else { one.error })
            .column(&UNEXPLAINED, |one| one.left_rms_mm * UM_PER_MM);
        section = section.table(table);
    }
    Ok(section)
}
