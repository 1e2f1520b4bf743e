//! What a run finds on a bevel gear: names, units, definitions, places.

mod tables;
pub mod whole;

use super::axes_report::{BevelAxesReport, idle_share};
use super::blank::{CellGrid, CutCells};
use super::chips::SlotLedger;
use super::gear::BevelGear;
use super::job::BevelJob;
use super::measure::{self, BevelReport};
use super::motion::AXES;
use super::net::Position;
use crate::findings::notice::ranked;
use crate::findings::{Datum, Entry, Findings, Notice, Place, Quantity, Section, Table, TableColumn};
use crate::machine_errors::ErrorLayer;
use crate::output::text::significant;
use crate::steps::axes::{self, AxesOfOperation as _};
use crate::steps::foreseen::Foreseen;
use crate::steps::machine_errors::{self, size, tool_words};
use crate::steps::program_under_test::ProgramUnderTest;
use crate::steps::untouched_dexels;
use crate::texture::{self, WindowTexture};
use gearcut_core::bevel::ease_off::{Explained, Setting};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use tables::{blades, flanks, grid, slot};

const UNTOUCHED: &str = "a dexel of the evaluated part was reached by no pass";
const TRACE: &str = "a dexel of the trace was reached by no pass";

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
    let candidates = Quantity::number(
        work.stats.dexel_passes as f64 / work.dexels.max(1) as f64,
        "passes",
        "passes visited per dexel and operation; two or three touch it",
    );
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
    sections.push(Section::new("work", "Work of cutting").with("candidates", candidates));
    Ok(Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: "bevel".to_owned(),
        scene: job.scene.name.clone(),
        complete: !work.interrupted,
        headline: headline(job, gear, motion),
        warnings: ranked(warnings),
        sections,
    })
}

/// What is known before anything is cut: keys that contradict each other, a head that hits the next tooth, undercut,
/// what the axes say, and where texture is looked at.
///
/// # Errors
/// A place that the roll does not generate, a window that lies on no flank, too many rays through the blank.
pub fn foresee(job: &BevelJob, motion: &[BevelAxesReport]) -> Result<Foreseen> {
    CellGrid::of_scene(job)?;
    let windows = texture::windows(job)?;
    let own = job.next_tooth_warning()?.into_iter().chain(job.contradictions()).chain(job.undercut_warning()?);
    let own = own.chain(axes::warnings(motion)).collect();
    Foreseen::new(job, &windows, own, true)
}

fn headline(job: &BevelJob, gear: &BevelGear, motion: &[BevelAxesReport]) -> Vec<Entry> {
    let extreme = |end: usize, sign: f64, definition: &'static str| {
        let found = gear.flanks.iter().filter_map(|flank| Some((flank.own.finished?, flank)));
        let found = found.max_by(|a, b| (sign * a.0.range_mm[end]).total_cmp(&(sign * b.0.range_mm[end])));
        match found {
            None => Quantity::undefined("um", definition, UNTOUCHED),
            Some((heights, flank)) => {
                let [u_mm, v_mm] = heights.at_mm[end];
                Quantity::number(sign * heights.range_mm[end] * UM_PER_MM, "um", definition).at(Place::on_flank(
                    flank.tooth,
                    flank.side.name(),
                    u_mm,
                    v_mm,
                ))
            }
        }
    };
    let largest = |value: fn(&BevelReport) -> Option<f64>, definition: &'static str| {
        let found = gear.flanks.iter().filter_map(value).reduce(f64::max);
        Quantity::number_or(found.map(|mm| mm * UM_PER_MM), "um", definition, TRACE)
    };
    let middle = gear.slot.get(gear.slot.len() / 2);
    let in_slot = |value: Option<f64>, definition: &'static str| {
        Quantity::number_or(value, "mm", definition, "the slot behind tooth 1 was not cut as a whole")
    };
    let teeth = f64::from(job.blank.teeth);
    vec![
        Entry::headline(
            "highest_deviation",
            "highest deviation",
            extreme(1, 1.0, "largest normal deviation on the evaluated part of any flank"),
        ),
        Entry::headline(
            "deepest_cut",
            "deepest cut",
            extreme(0, -1.0, "deepest place below the target on the evaluated part of any flank, positive inwards"),
        ),
        Entry::headline(
            "slot_depth",
            "slot depth",
            in_slot(
                middle.and_then(|row| row.depth_mm),
                "depth of the slot behind tooth 1 in the middle of the face, from the face cone, square to the \
                pitch cone",
            ),
        ),
        Entry::headline(
            "whole_depth",
            "whole depth of the blank",
            in_slot(middle.map(|row| row.whole_depth_mm), "addendum and dedendum of the blank at the same place"),
        ),
        Entry::headline(
            "slot_width",
            "slot width",
            in_slot(
                middle.and_then(|row| row.width_mm),
                "width of the slot behind tooth 1 on the circle of the pitch cone in the middle of the face",
            ),
        ),
        Entry::headline(
            "profile_deviation",
            "profile deviation",
            largest(
                |flank| flank.profile.map(|d| d.total_mm),
                "largest range along the profile in the middle of the face",
            ),
        ),
        Entry::headline(
            "lead_deviation",
            "lead deviation",
            largest(
                |flank| flank.lead.map(|d| d.total_mm),
                "largest range along the tooth in the middle of the profile",
            ),
        ),
        axes::margin_entry(motion),
        Entry::headline(
            "idle_share",
            "idle share of the roll",
            Quantity::number(
                idle_share(job, job.finishing()),
                "1",
                "share of the last operation's roll in which no point of the target flanks is generated",
            ),
        ),
        Entry::headline(
            "cutting_time",
            "cutting time",
            Quantity::number(
                job.operations.iter().map(|operation| teeth * operation.cycle_s()).sum(),
                "s",
                "time of all operations: roll and idle time of every slot",
            ),
        ),
    ]
}

/// Settings as they hold, and what they say of the cutter.
fn settings(job: &BevelJob) -> Section {
    let of = &job.finishing().settings;
    let deg = |rad: f64, definition: &'static str| Quantity::number(rad.to_degrees(), "deg", definition);
    let mm = |value: f64, definition: &'static str| Quantity::number(value, "mm", definition);
    let given = if job.spec.head.radius_mm.is_some() { "given by the scene" } else { "inferred from the settings" };
    Section::new("settings", "Settings of the machine")
        .with("radial_setting", mm(of.radial_setting_mm, "S_r: from the cradle's axis to the head's"))
        .with("cradle_angle", deg(of.cradle_angle_rad, "q in the middle of the roll"))
        .with("blank_offset", mm(of.blank_offset_mm, "E_m"))
        .with("sliding_base", mm(of.sliding_base_mm, "along the cradle's axis, offsets of operations included"))
        .with("center_to_back", mm(of.center_to_back_mm, "X_p"))
        .with("root_angle", deg(of.root_angle_rad, "gamma_m"))
        .with("roll_ratio", Quantity::number(of.roll.ratio, "1", "R_a: work angle per cradle angle"))
        .with("cutter_radius", mm(job.head.radius_mm, "mean cutter radius in use"))
        .with("cutter_radius_source", Quantity::text(given, "where the cutter radius comes from"))
        .with(
            "inferred_radius",
            mm(job.inferred.radius_mm, "radius of the circle that the settings lead through the mean point"),
        )
        .with("inferred_spiral_angle", deg(job.inferred.spiral_angle_rad, "spiral angle of that circle there"))
        .with(
            "modified_roll_c",
            Quantity::number(of.roll.second_order_per_rad, "1/rad", "C of the modified roll; 0 where the roll is even"),
        )
        .with(
            "modified_roll_d",
            Quantity::number(of.roll.third_order_per_rad2, "1/rad^2", "D of the modified roll; 0 where it is even"),
        )
        .with("inferred_roll_ratio", Quantity::number(job.inferred.roll_ratio, "1", "R_a of a crown gear"))
        .with(
            "missed_depth",
            mm(job.depth_missed_mm(), "how far the tips stand short of the blank's roots, middle of the face"),
        )
}

fn operations(job: &BevelJob, motion: &[BevelAxesReport]) -> Result<Section> {
    let mut section = Section::new("operations", "Operations");
    for (index, report) in motion.iter().enumerate() {
        let operation = report.operation();
        let deg = |rad: f64, definition: &'static str| Quantity::number(rad.to_degrees(), "deg", definition);
        let ids = job.slots.ids(index);
        let mut fits = Table::new(
            "axis_fits",
            "Polynomials of the axes over one slot's roll",
            vec![
                TableColumn::words("axis", "letter of the axis"),
                TableColumn::new("order", "1", "order of the polynomial in time from the beginning of the roll, s"),
                TableColumn::new("largest_error", "mm or deg", "largest error over the roll"),
            ],
        );
        for fit in report.fits()? {
            fits = fits.with_rows([vec![
                Datum::Word(fit.letter.to_string()),
                Datum::from(fit.order as u32),
                Datum::from(fit.fit.largest_error),
            ]]);
        }
        section = section.part(
            Section::new(&operation.spec.name, format!("Operation {}", operation.spec.name))
                .with("linkage", Quantity::text(report.linkage_words(), "linkage of head and work"))
                .with("offset", Quantity::number(operation.spec.offset_mm, "mm", "how far the head stays back"))
                .with(
                    "passes",
                    Quantity::count((ids.end - ids.start).into(), "passes", "blades times turns over all slots"),
                )
                .with("roll_from", deg(operation.roll_rad[0], "cradle angle at which a slot begins"))
                .with("roll_to", deg(operation.roll_rad[1], "cradle angle at which it ends"))
                .shown(
                    "slot_time",
                    "time for a slot",
                    Quantity::number(operation.cycle_s(), "s", "roll and idle time of one slot"),
                )
                .with(
                    "idle_share",
                    Quantity::number(idle_share(job, operation), "1", "share of the roll that generates no flank"),
                )
                .table(fits)
                .part(axes::findings(report))
                .parts(report.program().map(ProgramUnderTest::section)),
        );
    }
    Ok(section)
}

fn marks(job: &BevelJob) -> Result<Section> {
    let mut section = Section::new("marks", "Marks of the blades, closed form");
    for side in [Side::Left, Side::Right] {
        let marks = measure::marks(job, side)?;
        section = section.part(
            Section::new(side.name(), format!("{} flanks", side.name()))
                .with("blades", Quantity::text(job.kind_of(side).name(), "blades that cut these flanks"))
                .with("form", Quantity::text(job.kind_of(side).flank(), "form of these flanks along the tooth"))
                .with(
                    "height",
                    Quantity::number(
                        marks.height_mm * UM_PER_MM,
                        "um",
                        "how far the cone stands over its envelope half a period of the blades beside the moment of \
                        generation, middle of the flank",
                    ),
                )
                .with(
                    "spacing",
                    Quantity::number(
                        marks.spacing_mm,
                        "mm",
                        "cradle angle from blade to blade of the kind over the gradient of the moment of generation",
                    ),
                ),
        );
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
    machine_errors::section(&spec.errors, &AXES, &own)
}

/// Thickness, spiral and pressure angle error: what gear inspection takes apart from the form of flanks.
fn position(gear: &BevelGear) -> Section {
    let of = |side: Side, value: &dyn Fn(&Position) -> f64| -> Option<f64> {
        let flanks = gear.flanks.iter().filter(|flank| flank.side == side);
        let values: Vec<f64> = flanks.map(|flank| Position::of(flank).map(|of| value(&of))).collect::<Option<_>>()?;
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let why = "a point of the grid was not cut";
    let um = |value_mm: Option<f64>, definition: &'static str| {
        Quantity::number_or(value_mm.map(|mm| mm * UM_PER_MM), "um", definition, why)
    };
    let thickness = of(Side::Left, &|of| of.middle_mm).zip(of(Side::Right, &|of| of.middle_mm));
    let mut section = Section::new("position", "Thickness, spiral and pressure angle").shown(
        "thickness",
        "thickness",
        um(
            thickness.map(|(left, right)| left + right),
            "what both flanks of a tooth are too thick by along their normals, middle of the grid",
        ),
    );
    for side in [Side::Left, Side::Right] {
        for (name, which, definition) in [
            ("spiral angle", 0, "deviation of the grid's plane from toe to heel, positive where the heel is higher"),
            ("pressure angle", 1, "deviation of the grid's plane from root to tip, positive where the tip is higher"),
        ] {
            let key = format!("{}_{}", name.replace(' ', "_"), side.name());
            let quantity = um(of(side, &|of| of.over_grid_mm()[which]), definition);
            section = section.shown(&key, &format!("{name}, {}", side.name()), quantity);
        }
    }
    section
}

/// Settings whose errors explain the deviations of tooth 1.
fn errors(job: &BevelJob, gear: &BevelGear) -> Result<Section> {
    let mut section = Section::new("settings_errors", "Errors of settings that would explain the deviations");
    let why = "all deviations of the grid are below 0.5 um, or a point of it was not cut";
    for flank in gear.flanks.iter().filter(|flank| flank.tooth == 1) {
        let side = flank.side.name();
        let Some(found) = measure::explained(job, flank)? else {
            section =
                section.with(side, Quantity::undefined("mm", "error of the setting that explains them best", why));
            continue;
        };
        let columns = vec![
            TableColumn::words("setting", "the setting, by itself"),
            TableColumn::new("error", "mm or deg", "its error that explains most; of the ratio of roll a pure number"),
            TableColumn::new("left", "um", "root mean square of what it leaves unexplained on the grid"),
        ];
        let rows = found.iter().map(|one| {
            let error = if one.setting.is_angle() { one.error.to_degrees() } else { one.error };
            vec![Datum::Word(one.setting.name().to_owned()), error.into(), (one.left_rms_mm * UM_PER_MM).into()]
        });
        let (first, second) = (found[0], found[1]);
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
        let words = Quantity::text(
            format!("{}; next {}", said(&first), said(&second)),
            "settings whose error, each by itself, explains most of the deviations of the grid, and root mean square \
            of what it leaves",
        );
        section = section
            .shown(&format!("{side}_explained"), &format!("tooth 1 {side}"), words)
            .table(Table::new(side, &format!("Tooth 1, {side} flank"), columns).with_rows(rows));
    }
    Ok(section)
}
