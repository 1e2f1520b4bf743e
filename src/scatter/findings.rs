//! Layers and seeds as findings: every number of every case, every gear, median and interval.

use super::Scatter;
use super::layers::{ALL, all_but, alone};
use super::notices::{Missing, NotRandom};
use super::numbers::{NUMBERS, Number};
use super::statistics::{INTERVAL, Spread};
use super::tolerance::Tolerance;
use crate::findings::{Datum, Entry, Findings, Notice, Quantity, Section, Table, TableColumn};
use crate::machine_errors::ErrorLayer;
use crate::scene::Scene;

/// Numbers of the headline.
const FIRST: [&str; 4] = ["Sa", "F_alpha", "F_p", "unevenness"];

/// The tree.
pub fn findings(scene: &Scene, found: &Scatter) -> Findings {
    let mut sections = vec![layers(found)];
    if found.gears.is_some() {
        sections.push(scatter(found));
    }
    Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: scene.process_name().to_owned(),
        scene: scene.name.clone(),
        complete: true,
        headline: headline(found),
        warnings: warnings(found),
        sections,
    }
}

/// Place of a number in [`NUMBERS`].
pub(super) fn place_of(key: &str) -> usize {
    NUMBERS.iter().position(|number| number.key == key).expect("a number that is measured")
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
    let mut entries: Vec<Entry> = FIRST
        .iter()
        .map(|key| (key, place_of(key)))
        .filter(|&(_, number)| found.cases.iter().any(|(_, values)| values[number].is_some()))
        .map(|(key, number)| {
            let Number { symbol, unit, definition, .. } = NUMBERS[number];
            let why = "it does not exist in this gear";
            let quantity = match (found.gears, spreads[number]) {
                (Some(gears), spread) => {
                    let median = spread.map(|spread| spread.median);
                    Quantity::number_or(median, unit, format!("{definition}; median of {gears} gears"), why)
                }
                (None, _) => {
                    let words = format!("{definition}; with all layers of errors");
                    Quantity::number_or(found.in_case(ALL, number), unit, words, why)
                }
            };
            Entry::headline(key, symbol, quantity)
        })
        .collect();
    if let Some(layer) = first_cause(found, place_of("Sa")) {
        let what = "the layer of errors without which Sa would be smallest; of two and fewer, the one that makes \
                    most of it alone";
        entries.push(Entry::headline("first_cause_of_Sa", "first cause of Sa", Quantity::text(layer.name(), what)));
    }
    entries
}

fn warnings(found: &Scatter) -> Vec<Notice> {
    let random = |layer: &ErrorLayer| layer.is_random();
    let any = found.cases.iter().any(|(case, _)| case.kept.iter().any(random));
    let alike = (!any && found.tolerances.is_empty()).then(|| NotRandom {}.notice());
    let missing = |number: &(usize, &Number)| {
        found.gears.is_some_and(|gears| (1..gears as usize).contains(&found.values(number.0).count()))
    };
    let missing: Vec<&str> = NUMBERS.iter().enumerate().filter(missing).map(|(_, number)| number.symbol).collect();
    let missing = (!missing.is_empty()).then(|| Missing { numbers: missing.join(", ") }.notice().about("scatter"));
    found.unfollowed.iter().cloned().chain(alike).chain(missing).collect()
}

/// The columns of all numbers behind one that names the rows.
fn columns(first: TableColumn) -> Vec<TableColumn> {
    std::iter::once(first).chain(NUMBERS.iter().map(Number::column)).collect()
}

fn row(first: Datum, values: impl IntoIterator<Item = Option<f64>>) -> Vec<Datum> {
    std::iter::once(first).chain(values.into_iter().map(Datum::from)).collect()
}

/// A row for each case.
fn layers(found: &Scatter) -> Section {
    let first = TableColumn::words("layers", "which layers of errors are on");
    let rows = found.cases.iter().map(|(case, values)| row(case.name.as_str().into(), values.iter().copied()));
    let mut table = Table::new("cases", "Layers of errors", columns(first)).with_rows(rows);
    table.file = Some("layers.csv".to_owned());
    Section::new("layers", "Layers of errors")
        .with("tooth", Quantity::count(found.flank.tooth.into(), "1", "tooth that is looked at, from 1"))
        .with("flank", Quantity::text(found.flank.side.name(), "which of its flanks"))
        .table(table)
}

/// Median and interval, and a row for each gear.
fn scatter(found: &Scatter) -> Section {
    let spreads = found.spreads();
    let of = |value: fn(&Spread) -> f64| spreads.iter().map(move |spread| spread.as_ref().map(value));
    let shares = [(INTERVAL[0], of(|s| s.low)), (0.5, of(|s| s.median)), (INTERVAL[1], of(|s| s.high))];
    let first = TableColumn::new("share", "%", "share of the gears whose number is smaller (Hyndman and Fan, type 7)");
    let rows = shares.into_iter().map(|(share, values)| row((100.0 * share).into(), values));
    let mut spread = Table::new("spread", "Median and interval of the gears", columns(first)).with_rows(rows);
    spread.file = Some("scatter.csv".to_owned());
    let first =
        TableColumn::new("seed", "1", "seed of the gear; those beyond the number of gears are of an earlier run");
    let rows = found.rows.iter().map(|(&seed, values)| row(seed.into(), values.iter().copied()));
    let mut seeds = Table::new("seeds", "Gears", columns(first)).with_rows(rows).rows_in_file("seeds");
    seeds.file = Some("seeds.csv".to_owned());
    let gears = u64::from(found.gears.unwrap_or(0));
    let section = Section::new("scatter", "Gears of many seeds")
        .with("gears", Quantity::count(gears, "gears", "gears over which median and interval are taken, seeds from 1"))
        .table(spread)
        .table(seeds);
    drawn(found).into_iter().fold(section, Section::table)
}

/// Limits of what differs from gear to gear, and its value in every gear; no table where nothing does.
fn drawn(found: &Scatter) -> Vec<Table> {
    if found.tolerances.is_empty() {
        return Vec::new();
    }
    let key = || TableColumn::words("key", "key of the scene; its name says the unit");
    let columns = vec![
        key(),
        TableColumn::words("low", "smallest value, in the key's unit"),
        TableColumn::words("high", "largest value, in the key's unit"),
    ];
    let rows = found
        .tolerances
        .iter()
        .map(|Tolerance { key, limits: [low, high] }| vec![key.as_str().into(), (*low).into(), (*high).into()]);
    let mut limits = Table::new("tolerances", "What differs from gear to gear", columns).with_rows(rows);
    limits.file = Some("tolerances.csv".to_owned());
    let columns = vec![
        TableColumn::new("seed", "1", "seed of the gear"),
        key(),
        TableColumn::words("value", "value in this gear, in the key's unit: as likely as any other within the limits"),
    ];
    let rows = found.rows.keys().flat_map(|&seed| {
        let of_gear = found.tolerances.iter().enumerate();
        of_gear.map(move |(place, of)| vec![seed.into(), of.key.as_str().into(), of.value(place, seed).into()])
    });
    let mut values = Table::new("drawn", "Values of every gear", columns).with_rows(rows).rows_in_file("drawn");
    values.file = Some("drawn.csv".to_owned());
    vec![limits, values]
}
