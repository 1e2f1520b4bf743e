//! Layers and seeds as findings: every number of every case, every gear, median and interval.

use super::Scatter;
use super::layers::{ALL, all_but, alone};
use super::notices::{Missing, NotRandom};
use super::numbers::NUMBERS;
use super::quantities::{
    CASES, COUNT, FIRST_CAUSE, GEARS, HIGH, KEPT, KEY, LAYERS, LOW, SA, SEED, SHARE, SIDE_TOTAL_PITCH, SPREAD,
    TOLERANCES, UNEVENNESS, VALUE,
};
use super::statistics::{INTERVAL, Spread};
use crate::findings::quantities::flanks::F_ALPHA;
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Columns, Entry, Findings, Notice, QuantityRow, Section, Table};
use crate::machine_errors::ErrorLayer;
use crate::scene::Scene;

/// Numbers of the headline.
static FIRST: [&QuantityRow; 4] = [&SA, &F_ALPHA, &SIDE_TOTAL_PITCH, &UNEVENNESS];

/// The tree.
pub fn findings(scene: &Scene, found: &Scatter) -> Findings {
    let mut sections = vec![layers(found)];
    if found.gears.is_some() {
        sections.push(scatter(found));
    }
    Findings::new(scene.process_name(), &scene.name, true, headline(found), warnings(found), sections)
}

/// Place of a number in [`NUMBERS`].
pub(super) fn place_of(row: &QuantityRow) -> usize {
    NUMBERS.iter().position(|number| number.key == row.key).expect("a number that is measured")
}

/// The layer without which a number becomes smallest, or, of two and fewer, the one that makes most of it alone.
fn first_cause(found: &Scatter, number: usize) -> Option<ErrorLayer> {
    let layers = &found.cases.iter().find(|(case, _)| case.name == ALL)?.0.kept;
    let size = |name: String| found.in_case(&name, number).map(f64::abs);
    let least = layers.iter().filter_map(|&layer| Some((size(all_but(layer))?, layer)));
    let most = layers.iter().filter_map(|&layer| Some((size(alone(layer))?, layer)));
    let [least, most] = [least.min_by(|a, b| a.0.total_cmp(&b.0)), most.max_by(|a, b| a.0.total_cmp(&b.0))];
    least.or(most).map(|(_, layer)| layer)
}

fn headline(found: &Scatter) -> Vec<Entry> {
    let spreads = found.spreads();
    let first = FIRST
        .iter()
        .map(|&row| (row, place_of(row)))
        .filter(|&(_, number)| found.cases.iter().any(|(_, values)| values[number].is_some()));
    let number = |(row, number): (&QuantityRow, usize)| {
        let (value, remark) = match found.gears {
            Some(gears) => (spreads[number].map(|spread| spread.median), format!("; median of {gears} gears")),
            None => (found.in_case(ALL, number), "; with all layers of errors".to_owned()),
        };
        let entry = row.of_or(value, "it does not exist in this gear".to_owned()).remarked(&remark);
        entry.titled(row.symbol_or_title())
    };
    let cause = first_cause(found, place_of(&SA)).map(|layer| FIRST_CAUSE.of(layer.name()));
    first.map(number).chain(cause).collect()
}

fn warnings(found: &Scatter) -> Vec<Notice> {
    let random = |layer: &ErrorLayer| layer.is_random();
    let any = found.cases.iter().any(|(case, _)| case.kept.iter().any(random));
    let alike = (!any && found.tolerances.is_empty()).then(|| NotRandom {}.notice());
    let is_missing =
        |number: usize| found.gears.is_some_and(|gears| (1..gears as usize).contains(&found.values(number).count()));
    let missing = NUMBERS.iter().enumerate().filter(|(number, _)| is_missing(*number));
    let missing: Vec<String> = missing.map(|(_, row)| row.symbol_or_title()).collect();
    let missing = (!missing.is_empty()).then(|| Missing { numbers: missing.join(", ") }.notice().about("scatter"));
    found.unfollowed.iter().cloned().chain(alike).chain(missing).collect()
}

/// With the columns of all numbers.
fn with_numbers<T>(table: Columns<T>, values: impl Fn(&T) -> &[Option<f64>]) -> Columns<T> {
    let all = NUMBERS.iter().enumerate();
    all.fold(table, |table, (number, &row)| table.column(row, |of| values(of)[number]))
}

/// A row for each case.
fn layers(found: &Scatter) -> Section {
    let table = CASES.table(&found.cases).column(&KEPT, |(case, _)| case.name.as_str());
    let table = with_numbers(table, |(_, values)| values).at("layers");
    LAYERS.section([TOOTH.of(found.flank.tooth), FLANK.of(found.flank.side.name())]).table(table)
}

/// Median and interval, and a row for each gear.
fn scatter(found: &Scatter) -> Section {
    let spreads = found.spreads();
    let of = |value: fn(&Spread) -> f64| spreads.iter().map(|of| of.as_ref().map(value)).collect::<Vec<_>>();
    let shares = [(INTERVAL[0], of(|s| s.low)), (0.5, of(|s| s.median)), (INTERVAL[1], of(|s| s.high))];
    let spread = SPREAD.table(shares).column(&SHARE, |(share, _)| 100.0 * share);
    let seeds = Table::over("seeds", "Gears", &found.rows).column(&SEED, |(seed, _)| **seed);
    let section = GEARS
        .section([COUNT.of(found.gears.unwrap_or(0))])
        .table(with_numbers(spread, |(_, values)| values).at("scatter"))
        .table(with_numbers(seeds, |(_, values)| values).rows_in_file("seeds").at("seeds"));
    drawn(found).into_iter().fold(section, Section::table)
}

/// Limits of what differs from gear to gear, and its value in every gear; no table where nothing does.
fn drawn(found: &Scatter) -> Vec<Table> {
    if found.tolerances.is_empty() {
        return Vec::new();
    }
    let limits = TOLERANCES
        .table(&found.tolerances)
        .column(&KEY, |of| of.key.as_str())
        .column(&LOW, |of| of.limits[0])
        .column(&HIGH, |of| of.limits[1])
        .at("tolerances");
    let rows = found.rows.keys().flat_map(|&seed| {
        found.tolerances.iter().enumerate().map(move |(place, of)| (seed, of, of.value(place, seed)))
    });
    let values = Table::over("drawn", "Values of every gear", rows)
        .column(&SEED, |(seed, ..)| *seed)
        .column(&KEY, |(_, of, _)| of.key.as_str())
        .column(&VALUE, |(.., value)| *value)
        .rows_in_file("drawn");
    vec![limits, values.at("drawn")]
}
