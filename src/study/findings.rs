//! A study as findings: what each parameter does to each kept quantity, and the cases that no other one betters.
//!
//! In: [`StudyRows`]. Out: the tree, with tables of effects, of means along parameters, and of the front of Pareto of
//! time against each quantity, where a time is kept. Cases without a value are left out of what is said of it; which
//! quantities have none, and why, is a table, and a notice says that there is one.

use super::effects::{Effect, StudiedCases, VarianceShare, total};
use super::kept::counted_missing;
use super::map::is_of_map;
use super::notices::{CasesFailed, ManyWords, ValuesMissing};
use super::plan::StudyPlan;
use super::quantities::{
    AT, CASE, CASES, FAILED, FIRST_ORDER, FIRST_ORDER_HIGH, FIRST_ORDER_LOW, MEAN, MISSING_CASES, PART_CASES, QUANTITY,
    STUDY, SWING, TIME, TOTAL, TOTAL_HIGH, TOTAL_LOW, VALUE, WHY,
};
use super::rows::{StudyColumn, StudyRows};
use crate::findings::{Findings, Notice, Table};
use crate::influence::quantities::UNIT;
use crate::scatter::quantities::KEY;
use crate::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};

/// Most quantities that a notice names.
const MOST_NAMED: usize = 6;

/// What a study's parameters do.
#[derive(Debug, Clone)]
pub struct StudyEffects<'a> {
    /// Kept quantities that are numbers, with the effects of the parameters on them.
    pub of: Vec<(&'a StudyColumn, Vec<(&'a StudyColumn, Effect)>)>,
    /// Cases that no other one betters in time and in the size of a quantity together.
    pub fronts: Vec<ParetoFront<'a>>,
}

/// The best cases for one quantity.
#[derive(Debug, Clone)]
pub struct ParetoFront<'a> {
    /// The time.
    pub time: &'a StudyColumn,
    /// The quantity.
    pub quantity: &'a StudyColumn,
    /// Places of the cases among the rows, time and value; the fastest first.
    pub best: Vec<(usize, [f64; 2])>,
}

impl<'a> StudyEffects<'a> {
    /// Of all rows; places of maps are data and no results.
    pub fn of(plan: &StudyPlan, rows: &'a StudyRows) -> Self {
        let place_of: BTreeMap<u64, usize> =
            rows.cases.iter().enumerate().map(|(place, &case)| (case, place)).collect();
        let numbers =
            rows.kept.iter().filter(|column| !is_of_map(&column.name)).map(|column| (column, column.numbers()));
        let numbers: Vec<(&StudyColumn, Vec<(usize, f64)>)> =
            numbers.filter(|(_, values)| !values.is_empty()).collect();
        let effects = |(column, numbers): &(&'a StudyColumn, Vec<(usize, f64)>)| {
            let points: Vec<(usize, f64)> =
                numbers.iter().copied().filter(|&(place, _)| plan.is_a_point(rows.cases[place])).collect();
            let quantity: Vec<f64> = points.iter().map(|(_, value)| *value).collect();
            let is_whole = plan.is_a_grid() && points.len() as u64 == plan.cases();
            let cases = if is_whole { StudiedCases::WholeGrid } else { StudiedCases::Some };
            let at: BTreeMap<usize, f64> = numbers.iter().copied().collect();
            let on = rows.parameters.iter().enumerate().map(|(number, parameter)| {
                let values: Vec<&str> = points.iter().map(|&(place, _)| parameter.cells[place].as_str()).collect();
                let pairs = points.iter().filter_map(|&(place, first)| {
                    let partners = plan.partners(rows.cases[place], number)?;
                    let [second, between] = partners.map(|case| place_of.get(&case).and_then(|place| at.get(place)));
                    Some([first, *second?, *between?])
                });
                let pairs: Vec<[f64; 3]> = pairs.collect();
                (parameter, Effect { total: total(&pairs), ..Effect::of(&values, &quantity, cases) })
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

impl StudyEffects<'_> {
    /// Those of the first `most` quantities alone.
    #[must_use]
    pub fn first(&self, most: usize) -> Self {
        Self {
            of: self.of.iter().take(most).cloned().collect(),
            fronts: self.fronts.iter().take(most).cloned().collect(),
        }
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
    let headline = [CASES.of(rows.cases.len() + rows.failed()), FAILED.of(rows.failed())];
    let mut section = STUDY.section([]).table(effects(found)).table(means(found));
    if !found.fronts.is_empty() {
        section = section.table(fronts(rows, found));
    }
    let missing = counted_missing(rows.missing.iter().map(String::as_str));
    let notices = notices(rows, found, &missing);
    if !missing.is_empty() {
        section = section.table(
            Table::over("missing", "Quantities without a value", &missing)
                .column(&QUANTITY, |([path, _], _)| path.as_str())
                .column(&MISSING_CASES, |(_, cases)| **cases)
                .column(&WHY, |([_, why], _)| why.as_str())
                .in_file("missing"),
        );
    }
    Findings::new(scene.process_name(), &scene.name, true, headline, notices, vec![section])
}

/// What the rows do not say.
fn notices(rows: &StudyRows, found: &StudyEffects, missing: &BTreeMap<[String; 2], usize>) -> Vec<Notice> {
    let failed = rows.reasons.iter().max_by_key(|(_, (cases, _))| *cases).map(|(reason, (count, first))| {
        let cases = rows.cases.len() + rows.failed();
        CasesFailed { failed: rows.failed(), cases, first: *first, reason: reason.clone(), count: *count }.notice()
    });
    let mut quantities: Vec<&str> = missing.keys().map(|[path, _]| path.as_str()).collect();
    quantities.dedup();
    let without = (!quantities.is_empty()).then(|| {
        let cases = rows.missing.iter().filter(|cell| !cell.is_empty()).count();
        let more = quantities.len().saturating_sub(MOST_NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let names = quantities.iter().take(MOST_NAMED).copied().collect::<Vec<_>>().join(", ");
        ValuesMissing { quantities: names + &more, cases }.notice()
    });
    let is_stated = |parameter: &&StudyColumn| {
        let values: BTreeSet<&String> = parameter.cells.iter().collect();
        let any = found.of.iter().any(|(_, on)| on.iter().any(|(own, _)| own.name == parameter.name));
        any || values.len() < 2 || found.of.is_empty()
    };
    let unstated: Vec<&str> = rows.parameters.iter().filter(|of| !is_stated(of)).map(|of| of.name.as_str()).collect();
    let unstated = (!unstated.is_empty()).then(|| ManyWords { keys: unstated.join(", ") }.notice());
    failed.into_iter().chain(without).chain(unstated).collect()
}

fn effects(found: &StudyEffects) -> Table {
    let rows = found.of.iter().flat_map(|(quantity, on)| on.iter().map(move |of| (*quantity, of)));
    let index = |share: Option<VarianceShare>| share.map(|share| 100.0 * share.index);
    let end = |share: Option<VarianceShare>, end: usize| share.map(|share| 100.0 * share.interval[end]);
    Table::over("effects", "Effects of the parameters", rows)
        .column(&QUANTITY, |(quantity, _)| quantity.name.as_str())
        .column(&KEY, |(_, (parameter, _))| parameter.name.as_str())
        .column(&FIRST_ORDER, |(_, (_, effect))| index(effect.share))
        .column(&FIRST_ORDER_LOW, |(_, (_, effect))| end(effect.share, 0))
        .column(&FIRST_ORDER_HIGH, |(_, (_, effect))| end(effect.share, 1))
        .column(&TOTAL, |(_, (_, effect))| index(effect.total))
        .column(&TOTAL_LOW, |(_, (_, effect))| end(effect.total, 0))
        .column(&TOTAL_HIGH, |(_, (_, effect))| end(effect.total, 1))
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
