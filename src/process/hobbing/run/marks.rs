//! The lattice of cutting marks of the texture windows' flanks, and all its steps side by side in `tables/marks.csv`.

use crate::findings::{Datum, Quantity, Section, Table, TableColumn};
use crate::process::hobbing::HobCutter;
use crate::process::hobbing::linkage::marks::MarkStep;
use crate::process::hobbing::measure::marks;
use crate::process::hobbing::measure::marks::{MarkLattice, between_rad};
use crate::steps::Tools;
use crate::texture::SampledWindow;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// Lattices of every flank that has a texture window, in the windows' order.
///
/// # Errors
/// The backend's. After Ctrl-C those that are finished are returned.
pub fn measure(cutter: &HobCutter, windows: &[SampledWindow], tools: &Tools) -> Result<Vec<MarkLattice>> {
    let mut flanks: Vec<_> = windows.iter().map(|of| (of.window.tooth, of.window.side)).collect();
    flanks.dedup();
    let step = tools.progress.step("marks", flanks.len() as u64, "flanks");
    let lattices: Vec<Option<MarkLattice>> = flanks
        .par_iter()
        .map(|&(tooth, side)| {
            let done = (!tools.interrupt.is_raised()).then(|| marks::measure(cutter, tools.backend, tooth, side));
            step.advance(1);
            done.transpose()
        })
        .collect::<Result<_>>()?;
    step.finish();
    Ok(lattices.into_iter().flatten().collect())
}

/// Length (mm), angle to the tooth trace and to the gear's axis (deg) on the surface less those of the kinematics; the
/// angle to the trace without its sign.
fn difference(seen: &MarkStep, known: &MarkStep) -> [f64; 3] {
    [
        seen.length_mm() - known.length_mm(),
        between_rad(seen.to_trace_rad(), known.to_trace_rad()).to_degrees(),
        (seen.to_axis_rad - known.to_axis_rad).to_degrees(),
    ]
}

/// The lattices, flank by flank.
pub fn findings(lattices: &[MarkLattice]) -> Section {
    let all = Section::new("marks", "Cutting marks: steps from mark to mark");
    let all = lattices.iter().map(lattice).fold(all, |all, flank| {
        // Windows may return to a flank; its marks are the same.
        if all.is_free(&flank.key) { all.part(flank) } else { all }
    });
    let steps = steps(&all.sections);
    all.table(steps)
}

/// Columns of the table of all steps, and where their values stand in the section of a step.
const COLUMNS: [(&str, &str, &str); 11] = [
    ("kinematic_roll", "mm", "kinematic.roll"),
    ("kinematic_axial", "mm", "kinematic.axial"),
    ("kinematic_length", "mm", "kinematic.length"),
    ("kinematic_to_trace", "deg", "kinematic.angle_to_trace"),
    ("kinematic_to_axis", "deg", "kinematic.angle_to_axis"),
    ("surface_length", "mm", "surface.length"),
    ("surface_to_trace", "deg", "surface.angle_to_trace"),
    ("surface_to_axis", "deg", "surface.angle_to_axis"),
    ("length_difference", "mm", "difference.length"),
    ("trace_difference", "deg", "difference.angle_to_trace"),
    ("axis_difference", "deg", "difference.angle_to_axis"),
];

/// All steps side by side; the rows stand in the file alone, since their values have sections.
fn steps(flanks: &[Section]) -> Table {
    let mut columns = vec![
        TableColumn::new("tooth", "1", "number of the tooth, from 1"),
        TableColumn::words("flank", "flank: left or right"),
        TableColumn::new("step", "1", "shortest step, then the next one"),
    ];
    columns.extend(
        COLUMNS.map(|(key, unit, path)| TableColumn::new(key, unit, path).or("the section of its step tells why")),
    );
    let rows = flanks.iter().flat_map(|flank| {
        let name = |key: &str| flank.quantity(key).map_or(Datum::Undefined, Datum::from);
        (1_u32..).zip(&flank.sections).map(move |(number, step)| {
            let values = COLUMNS.map(|(.., path)| Datum::from(step.number(path)));
            [name("tooth"), name("flank"), number.into()].into_iter().chain(values).collect()
        })
    });
    Table::new("steps", "Steps of all flanks", columns).with_rows(rows).rows_in_file("marks")
}

fn lattice(lattice: &MarkLattice) -> Section {
    let (tooth, side) = (lattice.tooth, lattice.side.name());
    let why = lattice.surface.as_ref().err().map_or("", String::as_str);
    let steps = (0..2).map(|i| {
        let known = lattice.kinematic[i];
        let seen = lattice.surface.as_ref().ok().map(|steps| steps[i]);
        let apart = seen.map(|seen| difference(&seen, &known));
        let less = |k: usize, unit: &'static str, definition: &'static str| {
            Quantity::number_or(apart.map(|d| d[k]), unit, definition, why)
        };
        let difference = Section::new("difference", "surface less kinematics")
            .with("length", less(0, "mm", "length on the surface less that of the kinematics"))
            .with("angle_to_trace", less(1, "deg", "angle between both steps' directions against the tooth trace"))
            .with(
                "angle_to_axis",
                less(2, "deg", "angle to the gear's axis on the surface less that of the kinematics"),
            );
        Section::new(format!("step_{}", i + 1), format!("step {}", i + 1))
            .part(
                step("kinematic", Some(&known), "from the machine's motion", "")
                    .with(
                        "roll",
                        Quantity::number(known.step_mm.x, "mm", "roll of the step, from the machine's motion"),
                    )
                    .with(
                        "axial",
                        Quantity::number(
                            known.step_mm.y,
                            "mm",
                            "the step along the gear's axis, from the machine's motion",
                        ),
                    ),
            )
            .part(step("surface", seen.as_ref(), "from the autocorrelation of the heights as cut", why))
            .part(difference)
    });
    Section::new(format!("tooth_{tooth:02}_{side}"), format!("tooth {tooth} {side}"))
        .with("tooth", Quantity::count(tooth.into(), "1", "tooth, from 1"))
        .with("flank", Quantity::text(side, "flank: left or right"))
        .parts(steps)
}

fn step(key: &str, step: Option<&MarkStep>, source: &str, why: &str) -> Section {
    let number = |value: fn(&MarkStep) -> f64, unit: &'static str, definition: String| {
        Quantity::number_or(step.map(value), unit, definition, why)
    };
    Section::new(key, source)
        .with(
            "length",
            number(
                MarkStep::length_mm,
                "mm",
                format!("length on the flank at the pitch line of a shortest step from mark to mark, {source}"),
            ),
        )
        .with(
            "angle_to_trace",
            number(|s| s.to_trace_rad().to_degrees(), "deg", format!("its angle to the tooth trace, {source}")),
        )
        .with(
            "angle_to_axis",
            number(|s| s.to_axis_rad.to_degrees(), "deg", format!("its angle to the gear's axis, {source}")),
        )
}
