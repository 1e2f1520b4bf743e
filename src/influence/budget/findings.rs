//! A budget as findings: every figure of every parameter, and the maps.

use super::{Budget, BudgetLine};
use crate::findings::{Datum, Entry, Findings, Notice, Quantity, Section, Table, TableColumn};
use crate::influence::gear_grid::WHOLE_FLANK;
use crate::influence::notices::{BudgetStopped, NotLinear, StepRefused};
use crate::output::text::{plain, significant};
use crate::scene::Scene;

/// Parameters of the headline, and with maps as pictures.
pub(super) const FIRST: usize = 4;
/// What is smaller is nothing, um.
pub(super) const LEAST_UM: f64 = 0.005;

/// The tree.
pub fn findings(scene: &Scene, budget: &Budget) -> Findings {
    let first = budget.lines.iter().take(FIRST).enumerate().map(|(rank, line)| {
        let parameter = &line.influence.parameter;
        let definition = format!(
            "predicted: largest normal deviation that {} {} of it leave ({})",
            plain(parameter.step),
            parameter.unit,
            parameter.id
        );
        let um = Quantity::number(line.largest_per_step_um(), "um", definition);
        Entry::headline(&format!("rank_{}", rank + 1), &parameter.title, um)
    });
    let whole = budget.grid.flanks.iter().filter(|flank| !flank.is_point()).count();
    let section = Section::new("budget", "Error budget")
        .with("parameters", Quantity::count(budget.lines.len() as u64, "parameters", "parameters that were shifted"))
        .with(
            "whole_flanks",
            Quantity::count(
                whole as u64,
                "flanks",
                format!(
                    "flanks on {} x {} places; if none was asked for, of all others the middle, for pitch",
                    WHOLE_FLANK[0], WHOLE_FLANK[1]
                ),
            ),
        )
        .table(influences(budget))
        .table(maps(budget));
    let section = if budget.reported.is_empty() { section } else { section.table(numbers(budget)) };
    Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: scene.process_name().to_owned(),
        scene: scene.name.clone(),
        complete: budget.complete,
        headline: first.collect(),
        warnings: warnings(budget),
        sections: vec![section],
    }
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

/// A row for each parameter.
fn influences(budget: &Budget) -> Table {
    let mut columns = vec![
        TableColumn::words("parameter", "key of the error, and behind @ which part of it"),
        TableColumn::words("error", "what it is"),
        TableColumn::words("unit", "unit of the parameter"),
        TableColumn::by_row("step", "natural step of the parameter; it is shifted by as much to both sides"),
        TableColumn::new("per_step", "um", "predicted: largest normal deviation that the step leaves"),
    ];
    if let Some(line) = budget.lines.first() {
        columns.extend(line.per_unit.named().map(|(key, definition, _)| TableColumn {
            definition: format!("predicted: um that a unit of it alone makes on an ideal gear: {definition}").into(),
            ..TableColumn::by_row(format!("{key}_um_per_unit"), "").or("pitch and thickness need all flanks")
        }));
    }
    columns.extend([
        TableColumn::new(
            "half_step",
            "%",
            "largest difference from what half the step gives, of the largest influence",
        )
        .or("it has no influence"),
        TableColumn::new(
            "bend",
            "%",
            "largest difference of both directions from their mean, of the largest influence",
        )
        .or("it has no influence, or is shifted upwards only"),
        TableColumn::words("course", "linear; bent; upwards only: the scene has no value below"),
    ]);
    let mut table =
        Table::new("influences", "Influence of every parameter", columns).with_rows(budget.lines.iter().map(row));
    table.file = Some("budget.csv".to_owned());
    table
}

fn row(line: &BudgetLine) -> Vec<Datum> {
    let influence = &line.influence;
    let parameter = &influence.parameter;
    let most_um = influence.largest_um();
    let percent = |um: f64| Datum::from((most_um > 0.0).then_some(100.0 * um / most_um));
    let course = match (influence.upwards_only, influence.is_linear()) {
        (true, true) => "linear, upwards only",
        (true, false) => "bent, upwards only",
        (false, true) => "linear",
        (false, false) => "bent",
    };
    let mut row = vec![
        parameter.id.as_str().into(),
        parameter.title.as_str().into(),
        parameter.unit.into(),
        parameter.step.into(),
        line.largest_per_step_um().into(),
    ];
    row.extend(line.per_unit.named().map(|(_, _, um)| Datum::from(um)));
    row.push(percent(influence.half_step_um));
    row.push(if influence.upwards_only { Datum::Undefined } else { percent(influence.bend_um()) });
    row.push(course.into());
    row
}

/// The maps: a row for each place, a column for each parameter.
fn maps(budget: &Budget) -> Table {
    let mut columns = vec![
        TableColumn::new("tooth", "1", "tooth, from 1"),
        TableColumn::words("flank", "left or right"),
        TableColumn::new("u", "mm", "arc along the profile from the form point"),
        TableColumn::new("v", "mm", "place along the tooth from the middle of the face"),
    ];
    columns.extend(budget.lines.iter().map(|line| TableColumn {
        definition: format!("predicted: normal deviation for a unit of {}", line.influence.parameter.title).into(),
        unit: Some(per(line.influence.parameter.unit).into()),
        // Keys have no dots: these part the steps of a path through the findings.
        ..TableColumn::new(line.influence.parameter.id.replace(['.', '@'], "_"), "", "").or("no pass came there")
    }));
    let mut rows = Vec::new();
    let mut place = 0;
    for flank in &budget.grid.flanks {
        for &u_mm in &flank.arcs_mm {
            for &v_mm in &flank.faces_mm {
                let mut row: Vec<Datum> = vec![flank.tooth.into(), flank.side.name().into(), u_mm.into(), v_mm.into()];
                row.extend(budget.lines.iter().map(|line| Datum::from(line.influence.um_per_unit[place])));
                rows.push(row);
                place += 1;
            }
        }
    }
    Table::new("maps", "Influence maps", columns).with_rows(rows).rows_in_file("influence_maps")
}

/// Micrometres per unit.
pub(super) fn per(unit: &str) -> String {
    if unit.contains('/') { format!("um/({unit})") } else { format!("um/{unit}") }
}

/// A row for each parameter and each reported number that it moves.
fn numbers(budget: &Budget) -> Table {
    let columns = vec![
        TableColumn::words("parameter", "key of the error, and behind @ which part of it"),
        TableColumn::words("quantity", "path of the number in results.json; headline.KEY for those of its headline"),
        TableColumn::words("unit", "unit of the number; derivatives are for one unit of the error"),
        TableColumn::by_row("value", "predicted: by the scene as it is"),
        TableColumn::by_row("derivative", "predicted: what it gains for a unit of the error, both directions")
            .or("one of the directions is not there"),
        TableColumn::by_row("upwards", "predicted: the same from the scene's value upwards")
            .or("the number vanishes there"),
        TableColumn::by_row("downwards", "predicted: the same from below to the scene's value")
            .or("the number vanishes there, or the scene has no word for less"),
    ];
    let rows = budget.reported.iter().map(|of| {
        let both = of.upwards.zip(of.downwards).map(|(up, down)| 0.5 * (up + down));
        let mut row: Vec<Datum> = [&of.parameter, &of.quantity, &of.unit].map(|word| Datum::from(word.as_str())).into();
        row.push(of.value.into());
        row.extend([both, of.upwards, of.downwards].map(Datum::from));
        row
    });
    Table::new("numbers", "Influence on every reported number", columns).with_rows(rows).rows_in_file("numbers")
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
