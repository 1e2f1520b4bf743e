//! A study as findings: what each parameter does to each kept quantity, and the cases that no other one betters.
//!
//! In: [`StudyRows`]. Out: the tree, with tables of effects, of means along parameters, and of the front of Pareto of
//! time against each quantity, where a time is kept. Cases without a value are left out of what is said of it.

use super::effects::Effect;
use super::quantities::{
    AT, CASE, CASES, FAILED, FIRST_ORDER, FIRST_ORDER_HIGH, FIRST_ORDER_LOW, MEAN, PART_CASES, QUANTITY, STUDY, SWING,
    TIME, VALUE,
};
use super::rows::{StudyColumn, StudyRows};
use crate::findings::{Findings, Table};
use crate::influence::quantities::UNIT;
use crate::scatter::quantities::KEY;
use crate::scene::Scene;
use std::collections::BTreeMap;

/// What a study's parameters do.
#[derive(Debug)]
pub struct StudyEffects<'a> {
    /// Kept quantities that are numbers, with the effects of the parameters on them.
    pub of: Vec<(&'a StudyColumn, Vec<(&'a StudyColumn, Effect)>)>,
    /// Cases that no other one betters in time and in the size of a quantity together.
    pub fronts: Vec<ParetoFront<'a>>,
}

/// The best cases for one quantity.
#[derive(Debug)]
pub struct ParetoFront<'a> {
    /// The time.
    pub time: &'a StudyColumn,
    /// The quantity.
    pub quantity: &'a StudyColumn,
    /// Places of the cases among the rows, time and value; the fastest first.
    pub best: Vec<(usize, [f64; 2])>,
}

impl<'a> StudyEffects<'a> {
    /// Of all rows.
    pub fn of(rows: &'a StudyRows) -> Self {
        let numbers = rows.kept.iter().map(|column| (column, column.numbers()));
        let numbers: Vec<(&StudyColumn, Vec<(usize, f64)>)> =
            numbers.filter(|(_, values)| !values.is_empty()).collect();
        let effects = |(column, numbers): &(&'a StudyColumn, Vec<(usize, f64)>)| {
            let quantity: Vec<f64> = numbers.iter().map(|(_, value)| *value).collect();
            let on = rows.parameters.iter().map(|parameter| {
                let values: Vec<&str> = numbers.iter().map(|&(place, _)| parameter.cells[place].as_str()).collect();
                (parameter, Effect::of(&values, &quantity))
            });
            (*column, on.filter(|(_, effect)| effect.parts.len() > 1).collect())
        };
        let time = numbers.iter().find(|(column, _)| column.unit == "s");
        let front = |(time, times): &(&'a StudyColumn, Vec<(usize, f64)>)| {
            let times: BTreeMap<usize, f64> = times.iter().copied().collect();
            let others = numbers.iter().filter(|(column, _)| column.unit != "s");
            let of = |(quantity, values): &(&'a StudyColumn, Vec<(usize, f64)>)| {
                let both = values.iter().filter_map(|&(place, value)| Some((place, [*times.get(&place)?, value])));
                ParetoFront { time, quantity, best: best(both.collect()) }
            };
            others.map(of).collect()
        };
        Self { of: numbers.iter().map(effects).collect(), fronts: time.map_or_else(Vec::new, front) }
    }
}

/// Of times and values, those of which no other one is as fast and smaller in size, or as small and faster.
fn best(mut cases: Vec<(usize, [f64; 2])>) -> Vec<(usize, [f64; 2])> {
    cases.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].abs().total_cmp(&b[1].abs())));
    let mut smallest = f64::INFINITY;
    cases.retain(|(_, [_, value])| {
        let betters = value.abs() < smallest;
        smallest = smallest.min(value.abs());
        betters
    });
    cases
}

/// The tree.
pub fn findings(scene: &Scene, rows: &StudyRows, found: &StudyEffects) -> Findings {
    let headline = [CASES.of(rows.cases.len() + rows.failed), FAILED.of(rows.failed)];
    let mut section = STUDY.section([]).table(effects(found)).table(means(found));
    if !found.fronts.is_empty() {
        section = section.table(fronts(rows, found));
    }
    Findings::new(scene.process_name(), &scene.name, true, headline, [], vec![section])
}

fn effects(found: &StudyEffects) -> Table {
    let rows = found.of.iter().flat_map(|(quantity, on)| on.iter().map(move |of| (*quantity, of)));
    let percent = |share: Option<f64>| share.map(|share| 100.0 * share);
    Table::over("effects", "Effects of the parameters", rows)
        .column(&QUANTITY, |(quantity, _)| quantity.name.as_str())
        .column(&KEY, |(_, (parameter, _))| parameter.name.as_str())
        .column(&FIRST_ORDER, |(_, (_, effect))| percent(effect.share.map(|share| share.index)))
        .column(&FIRST_ORDER_LOW, |(_, (_, effect))| percent(effect.share.map(|share| share.interval[0])))
        .column(&FIRST_ORDER_HIGH, |(_, (_, effect))| percent(effect.share.map(|share| share.interval[1])))
        .column(&SWING, |(_, (_, effect))| effect.swing())
        .column(&UNIT, |(quantity, _)| quantity.unit.as_str())
        .in_file("effects")
}

fn means(found: &StudyEffects) -> Table {
    let parts = found.of.iter().flat_map(|(quantity, on)| {
        on.iter()
            .flat_map(move |(parameter, effect)| effect.parts.iter().map(move |part| (*quantity, *parameter, part)))
    });
    Table::over("means", "Means along the parameters", parts)
        .column(&QUANTITY, |(quantity, ..)| quantity.name.as_str())
        .column(&KEY, |(_, parameter, _)| parameter.name.as_str())
        .column(&AT, |(.., part)| part.at.as_str())
        .column(&MEAN, |(.., part)| part.mean)
        .column(&UNIT, |(quantity, ..)| quantity.unit.as_str())
        .column(&PART_CASES, |(.., part)| part.cases)
        .rows_in_file("means")
}

fn fronts(rows: &StudyRows, found: &StudyEffects) -> Table {
    let best = found.fronts.iter().flat_map(|front| front.best.iter().map(move |of| (front.quantity, of)));
    Table::over("fronts", "Best cases: time against each quantity", best)
        .column(&QUANTITY, |(quantity, _)| quantity.name.as_str())
        .column(&CASE, |(_, (place, _))| rows.cases[*place])
        .column(&TIME, |(_, (_, [time, _]))| *time)
        .column(&VALUE, |(_, (_, [_, value]))| *value)
        .column(&UNIT, |(quantity, _)| quantity.unit.as_str())
        .in_file("fronts")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_has_the_cases_that_no_other_one_betters() {
        let cases = [[5.0, 0.5], [1.0, 9.0], [2.0, -4.0], [2.0, 6.0], [4.0, 4.0]];
        let cases: Vec<usize> = best(cases.into_iter().enumerate().collect()).iter().map(|of| of.0).collect();
        assert_eq!(cases, [1, 2, 0]);
    }
}
