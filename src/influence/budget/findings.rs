//! A budget as findings: every figure of every parameter, and the maps.

use super::{Budget, BudgetLine};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Findings, Notice, QuantityRow, Table};
use crate::influence::derivative::Influence;
use crate::influence::figures::Figures;
use crate::influence::gear_grid::WHOLE_FLANK;
use crate::influence::notices::{BudgetStopped, NotLinear, StepRefused};
use crate::influence::quantities::budget::{
    BEND, BUDGET, COURSE, DERIVATIVE, DOWNWARDS_OF, HALF_STEP, HELIX, HELIX_SLOPE, INFLUENCE_MAPS,
    INFLUENCE_ON_NUMBERS, INFLUENCES, LARGEST, LARGEST_OF_STEP, PER_STEP, PER_UNIT, PROFILE, PROFILE_SLOPE, QUANTITY,
    SHIFTED, SINGLE_PITCH, STEP, THICKNESS, TOTAL_PITCH, U, UNIT_OF_NUMBER, UPWARDS_OF, V, VALUE, WHOLE_FLANKS,
};
use crate::influence::quantities::{ERROR, PARAMETER, UNIT};
use crate::number_text::{plain, significant};
use crate::scene::Scene;
use crate::scene::error_parameters::ErrorParameter;

/// Parameters of the headline, and with maps as pictures.
pub(super) const FIRST: usize = 4;
/// What is smaller is nothing, um.
pub(super) const LEAST_UM: f64 = 0.005;

/// The tree.
pub fn findings(scene: &Scene, budget: &Budget) -> Findings {
    let first = budget.lines.iter().take(FIRST).enumerate().map(|(rank, line)| {
        let ErrorParameter { id, title, step, unit, .. } = &line.influence.parameter;
        let entry =
            LARGEST_OF_STEP.of(line.largest_per_step_um()).remarked(&format!(": {} {unit} of {id}", plain(*step)));
        entry.keyed(format!("{}_{}", LARGEST_OF_STEP.key, rank + 1)).titled(title.as_str())
    });
    let whole = budget.grid.flanks.iter().filter(|flank| !flank.is_point()).count();
    let [columns, rows] = WHOLE_FLANK;
    let section = BUDGET
        .section([
            SHIFTED.of(budget.lines.len()),
            WHOLE_FLANKS.of(whole).remarked(&format!("; {columns} x {rows} places on each")),
        ])
        .table(influences(budget))
        .table(maps(budget));
    let section = if budget.reported.is_empty() { section } else { section.table(numbers(budget)) };
    Findings::new(scene.process_name(), &scene.name, budget.complete, first, warnings(budget), vec![section])
}

fn warnings(budget: &Budget) -> Vec<Notice> {
    let refused = budget
        .refused
        .iter()
        .map(|(parameter, why)| StepRefused { parameter: &parameter.id, why }.notice().about("budget"));
    let bent: Vec<&str> = budget
        .lines
        .iter()
        .filter(|line| !line.influence.is_linear())
        .map(|line| line.influence.parameter.title.as_str())
        .collect();
    let bent = (!bent.is_empty()).then(|| NotLinear { parameters: bent.join("; ") }.notice().about("budget"));
    let stopped = (!budget.complete).then(|| BudgetStopped {}.notice());
    refused.chain(bent).chain(stopped).collect()
}

/// A figure of a unit of an error with its column.
type Figure = (&'static QuantityRow, fn(&Figures) -> f64);
/// All of them.
static FIGURES: [Figure; 8] = [
    (&LARGEST, |of| of.largest),
    (&PROFILE, |of| of.profile),
    (&PROFILE_SLOPE, |of| of.profile_slope),
    (&HELIX, |of| of.helix),
    (&HELIX_SLOPE, |of| of.helix_slope),
    (&SINGLE_PITCH, |of| of.single_pitch),
    (&TOTAL_PITCH, |of| of.total_pitch),
    (&THICKNESS, |of| of.thickness),
];

/// A row for each parameter.
fn influences(budget: &Budget) -> Table {
    let percent = |of: &Influence, um: f64| Some(of.largest_um()).filter(|um| *um > 0.0).map(|most| 100.0 * um / most);
    let course = |of: &Influence| match (of.upwards_only, of.is_linear()) {
        (true, true) => "linear, upwards only",
        (true, false) => "bent, upwards only",
        (false, true) => "linear",
        (false, false) => "bent",
    };
    let mut table = INFLUENCES
        .table(&budget.lines)
        .column(&PARAMETER, |line| line.influence.parameter.id.as_str())
        .column(&ERROR, |line| line.influence.parameter.title.as_str())
        .column(&UNIT, |line| line.influence.parameter.unit)
        .column(&STEP, |line| line.influence.parameter.step)
        .column(&PER_STEP, |line| line.largest_per_step_um());
    for (row, figure) in &FIGURES {
        let column = row.as_column().keyed(format!("{}_um_per_unit", row.key));
        table = table.column(column, |line| figure(&line.per_unit));
    }
    table
        .column(&HALF_STEP, |line| percent(&line.influence, line.influence.half_step_um))
        .column(&BEND, |BudgetLine { influence, .. }| {
            Some(influence).filter(|of| !of.upwards_only).and_then(|of| percent(of, of.bend_um()))
        })
        .column(&COURSE, |line| course(&line.influence))
        .at("budget")
}

/// The maps: a row for each place, a column for each parameter.
fn maps(budget: &Budget) -> Table {
    let places = budget.grid.flanks.iter().flat_map(|flank| {
        let along = flank.arcs_mm.iter().flat_map(|&u_mm| flank.faces_mm.iter().map(move |&v_mm| [u_mm, v_mm]));
        along.map(move |place| (flank, place))
    });
    let mut table = INFLUENCE_MAPS
        .table(places.enumerate())
        .column(&TOOTH, |(_, (flank, _))| flank.tooth)
        .column(&FLANK, |(_, (flank, _))| flank.side.name())
        .column(&U, |(_, (_, [u_mm, _]))| *u_mm)
        .column(&V, |(_, (_, [_, v_mm]))| *v_mm);
    for BudgetLine { influence, .. } in &budget.lines {
        let ErrorParameter { id, title, unit, .. } = &influence.parameter;
        // Keys have no dots: these part the steps of a path through the findings.
        let column =
            PER_UNIT.as_column().keyed(id.replace(['.', '@'], "_")).in_unit(per(unit)).remarked(&format!(": {title}"));
        table = table.column(column, |(place, _)| influence.um_per_unit[*place]);
    }
    table.rows_in_file("influence_maps")
}

/// Micrometres per unit.
pub(super) fn per(unit: &str) -> String {
    if unit.contains('/') { format!("um/({unit})") } else { format!("um/{unit}") }
}

/// A row for each parameter and each reported number that it moves.
fn numbers(budget: &Budget) -> Table {
    INFLUENCE_ON_NUMBERS
        .table(&budget.reported)
        .column(&PARAMETER, |of| of.parameter.as_str())
        .column(&QUANTITY, |of| of.quantity.as_str())
        .column(&UNIT_OF_NUMBER, |of| of.unit.as_str())
        .column(&VALUE, |of| of.value)
        .column(&DERIVATIVE, |of| of.upwards.zip(of.downwards).map(|(up, down)| 0.5 * (up + down)))
        .column(&UPWARDS_OF, |of| of.upwards)
        .column(&DOWNWARDS_OF, |of| of.downwards)
        .rows_in_file("numbers")
}

/// Rows for the terminal, at most 80 columns wide: what a natural step of each error makes, um.
pub fn printed(budget: &Budget) -> Vec<Vec<String>> {
    let head = ["error", "step", "largest", "F_a", "F_b", "F_p"].map(str::to_owned).to_vec();
    let rows = budget.lines.iter().map(|line| {
        let parameter = &line.influence.parameter;
        let per = line.per_unit;
        let mut cells = vec![parameter.title.clone(), format!("{} {}", plain(parameter.step), parameter.unit)];
        cells.extend([per.largest, per.profile, per.helix, per.total_pitch].map(|um| shown_um(um * parameter.step)));
        cells
    });
    std::iter::once(head).chain(rows).collect()
}

/// Two decimals and no more than three digits that matter; below 5 nm, or where it is not known, it is nothing.
pub(super) fn shown_um(um: f64) -> String {
    if um.abs() < LEAST_UM || um.is_nan() {
        "-".to_owned()
    } else if um < 10.0 {
        format!("{um:.2}")
    } else {
        significant(um, 3)
    }
}
