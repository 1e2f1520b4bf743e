//! The lattice of cutting marks of the texture windows' flanks: table, results, lines of the summary.

use crate::error::Result;
use crate::job::HobCutter;
use crate::linkage::hobbing::marks::MarkStep;
use crate::measure::marks::{self, MarkLattice, between_rad};
use crate::output::folder::OutputFolder;
use crate::output::quantity::Quantity;
use crate::output::table::{Cell, write_table};
use crate::run::Tools;
use crate::texture;
use rayon::prelude::*;
use serde_json::{Value, json};

/// Lattices of every flank that has a texture window, in the windows' order.
///
/// # Errors
/// The backend's. After Ctrl-C those that are finished are returned.
pub fn measure(cutter: &HobCutter, tools: &Tools) -> Result<Vec<MarkLattice>> {
    let mut flanks: Vec<_> = texture::windows(cutter)?.iter().map(|window| (window.tooth, window.side)).collect();
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

/// Columns of the table.
const COLUMNS: [&str; 14] = [
    "tooth",
    "flank",
    "step",
    "kinematic_roll_mm",
    "kinematic_axial_mm",
    "kinematic_length_mm",
    "kinematic_to_trace_deg",
    "kinematic_to_axis_deg",
    "surface_length_mm",
    "surface_to_trace_deg",
    "surface_to_axis_deg",
    "length_difference_mm",
    "trace_difference_deg",
    "axis_difference_deg",
];

/// Writes `tables/marks.csv`.
///
/// # Errors
/// The file cannot be written.
pub fn write(lattices: &[MarkLattice], folder: &OutputFolder) -> Result<()> {
    let rows = lattices.iter().flat_map(|lattice| {
        (0..2).map(move |i| {
            let known = lattice.kinematic[i];
            let seen = lattice.surface.as_ref().ok().map(|steps| steps[i]);
            let number = |value: fn(&MarkStep) -> f64| Cell::from(seen.as_ref().map(value));
            let apart = seen.map(|seen| difference(&seen, &known));
            vec![
                lattice.tooth.into(),
                lattice.side.name().into(),
                (i as u32 + 1).into(),
                known.step_mm.x.into(),
                known.step_mm.y.into(),
                known.length_mm().into(),
                known.to_trace_rad().to_degrees().into(),
                known.to_axis_rad.to_degrees().into(),
                number(MarkStep::length_mm),
                number(|step| step.to_trace_rad().to_degrees()),
                number(|step| step.to_axis_rad.to_degrees()),
                apart.map(|d| d[0]).into(),
                apart.map(|d| d[1]).into(),
                apart.map(|d| d[2]).into(),
            ]
        })
    });
    write_table(&folder.path("tables/marks.csv")?, &COLUMNS, rows)
}

/// Length (mm), angle to the tooth trace and to the gear's axis (deg) on the surface less those of the kinematics; the angle to the trace without its sign.
fn difference(seen: &MarkStep, known: &MarkStep) -> [f64; 3] {
    [
        seen.length_mm() - known.length_mm(),
        between_rad(seen.to_trace_rad(), known.to_trace_rad()).to_degrees(),
        (seen.to_axis_rad - known.to_axis_rad).to_degrees(),
    ]
}

/// The lattices as they stand in `results.json`.
pub fn results(lattices: &[MarkLattice]) -> Value {
    let step = |step: Option<&MarkStep>, source: &str, why: &str| {
        let number = |value: fn(&MarkStep) -> f64, unit: &'static str, definition: String| {
            Quantity::number_or(step.map(value), unit, definition, why)
        };
        json!({
            "length": number(MarkStep::length_mm, "mm", format!("length on the flank at the pitch line of a shortest step from mark to mark, {source}")),
            "angle_to_trace": number(|s| s.to_trace_rad().to_degrees(), "deg", format!("its angle to the tooth trace, {source}")),
            "angle_to_axis": number(|s| s.to_axis_rad.to_degrees(), "deg", format!("its angle to the gear's axis, {source}")),
        })
    };
    let lattice = |lattice: &MarkLattice| {
        let why = lattice.surface.as_ref().err().map_or("", String::as_str);
        let steps: Vec<Value> = (0..2)
            .map(|i| {
                let known = lattice.kinematic[i];
                let seen = lattice.surface.as_ref().ok().map(|steps| steps[i]);
                let apart = seen.map(|seen| difference(&seen, &known));
                let less = |k: usize, unit: &'static str, definition: &'static str| {
                    Quantity::number_or(apart.map(|d| d[k]), unit, definition, why)
                };
                json!({
                    "kinematic": step(Some(&known), "from the machine's motion", ""),
                    "surface": step(seen.as_ref(), "from the autocorrelation of the heights as cut", why),
                    "difference": {
                        "length": less(0, "mm", "length on the surface less that of the kinematics"),
                        "angle_to_trace": less(1, "deg", "angle between both steps' directions against the tooth trace"),
                        "angle_to_axis": less(2, "deg", "angle to the gear's axis on the surface less that of the kinematics"),
                    },
                })
            })
            .collect();
        json!({"tooth": lattice.tooth, "flank": lattice.side.name(), "steps": steps})
    };
    lattices.iter().map(lattice).collect()
}

/// A lattice in a line: both steps from kinematics, from the surface, and how far they are apart.
pub fn words(lattice: &MarkLattice) -> String {
    let step = |s: &MarkStep| format!("{:.3} mm at {:.1} deg", s.length_mm(), s.to_trace_rad().to_degrees());
    let [a, b] = &lattice.kinematic;
    let known = format!("{} and {} to the tooth trace by kinematics", step(a), step(b));
    match &lattice.surface {
        Ok(seen) => {
            let [a, b] = [0, 1].map(|i| difference(&seen[i], &lattice.kinematic[i]));
            format!(
                "{known}; {} and {} on the surface: {:.3} and {:.3} mm, {:.2} and {:.2} deg apart",
                step(&seen[0]),
                step(&seen[1]),
                a[0].abs(),
                b[0].abs(),
                a[1],
                b[1]
            )
        }
        Err(why) => format!("{known}; none seen on the surface: {why}"),
    }
}
