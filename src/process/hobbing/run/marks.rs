//! The lattice of cutting marks of the texture windows' flanks, and all its steps side by side in `tables/marks.csv`.

use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Quantity, QuantityGroup, QuantityRow, Section, Table};
use crate::process::hobbing::HobCutter;
use crate::process::hobbing::linkage::marks::MarkStep;
use crate::process::hobbing::measure::marks;
use crate::process::hobbing::measure::marks::{MarkLattice, between_rad};
use crate::process::hobbing::quantities::{
    AXIAL_STEP, DIFFERENCE, KINEMATIC, LENGTH, MARKS, ROLL, STEP, SURFACE, TO_AXIS, TO_TRACE,
};
use crate::steps::Tools;
use crate::texture::SampledWindow;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// Lattices of every flank that has a texture window, in the windows' order; none of a drawn tooth's flanks, whose
/// contact has no one pressure angle.
///
/// # Errors
/// The backend's. After Ctrl-C those that are finished are returned.
pub fn measure(cutter: &HobCutter, windows: &[SampledWindow], tools: &Tools) -> Result<Vec<MarkLattice>> {
    if cutter.job.drawn.is_some() {
        return Ok(Vec::new());
    }
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
    let all = lattices.iter().map(lattice).fold(MARKS.section([]), |all, flank| {
        // Windows may return to a flank; its marks are the same.
        if all.is_free(&flank.key) { all.part(flank) } else { all }
    });
    let steps = steps(&all.sections);
    all.table(steps)
}

/// Columns of the table of all steps: what begins their keys, the section of a step, the row.
static COLUMNS: [(&QuantityGroup, &QuantityRow); 11] = [
    (&KINEMATIC, &ROLL),
    (&KINEMATIC, &AXIAL_STEP),
    (&KINEMATIC, &LENGTH),
    (&KINEMATIC, &TO_TRACE),
    (&KINEMATIC, &TO_AXIS),
    (&SURFACE, &LENGTH),
    (&SURFACE, &TO_TRACE),
    (&SURFACE, &TO_AXIS),
    (&DIFFERENCE, &LENGTH),
    (&DIFFERENCE, &TO_TRACE),
    (&DIFFERENCE, &TO_AXIS),
];

/// All steps side by side; the rows are in the file alone, since their values have sections.
fn steps(flanks: &[Section]) -> Table {
    let steps = flanks.iter().flat_map(|flank| (1_u32..).zip(&flank.sections).map(move |of| (flank, of)));
    let table = Table::over("steps", "Steps of all flanks", steps)
        .column(&TOOTH, |(flank, _)| flank.of(&TOOTH).and_then(Quantity::whole))
        .column(&FLANK, |(flank, _)| flank.text(&FLANK))
        .column(&STEP, |&(_, (number, _))| number);
    let table = COLUMNS.iter().fold(table, |table, &(source, row)| {
        let column = row.as_column().keyed(format!("{}_{}", source.key, row.key));
        table.column(column, move |(_, (_, step))| step.group(source).and_then(|of| of.value(row)))
    });
    table.rows_in_file("marks")
}

fn lattice(lattice: &MarkLattice) -> Section {
    let (tooth, side) = (lattice.tooth, lattice.side.name());
    let why = lattice.surface.as_ref().err().map_or("", String::as_str);
    let steps = (0..2).map(|i| {
        let known = lattice.kinematic[i];
        let seen = lattice.surface.as_ref().ok().map(|steps| steps[i]);
        let apart = seen.map(|seen| difference(&seen, &known));
        let [roll_mm, axial_mm] = [known.step_mm.x, known.step_mm.y];
        Section::new(format!("step_{}", i + 1), format!("step {}", i + 1))
            .part(step(&KINEMATIC, Some(values(&known)), "").entries([ROLL.of(roll_mm), AXIAL_STEP.of(axial_mm)]))
            .part(step(&SURFACE, seen.as_ref().map(values), why))
            .part(step(&DIFFERENCE, apart, why))
    });
    Section::new(format!("tooth_{tooth:02}_{side}"), format!("tooth {tooth} {side}"))
        .entries([TOOTH.of(tooth), FLANK.of(side)])
        .parts(steps)
}

/// Length (mm), angles to the trace and to the axis (deg) of a step.
fn values(step: &MarkStep) -> [f64; 3] {
    [step.length_mm(), step.to_trace_rad().to_degrees(), step.to_axis_rad.to_degrees()]
}

fn step(source: &QuantityGroup, values: Option<[f64; 3]>, why: &str) -> Section {
    let entry = |row: &QuantityRow, index: usize| row.of_or(values.map(|of| of[index]), why.to_owned());
    source.section([entry(&LENGTH, 0), entry(&TO_TRACE, 1), entry(&TO_AXIS, 2)])
}
