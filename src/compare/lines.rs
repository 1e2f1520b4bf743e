//! The lines of a comparison: every number under its key, with one value per result.
//!
//! Numbers are read from the results' own serialised form, so that every one that joins the headline joins the comparison. Lines of the headline stand even where no result has a value; others only where one has.

use std::collections::BTreeSet;

use serde::Serialize;
use serde_json::Value;

use super::Compared;
use super::hob_load;
use crate::output::quantity::Quantity;
use crate::output::results::{HobbedResults, Results};

/// Texture parameters that are compared, by symbol.
const HEIGHTS: [&str; 3] = ["Sa", "Sq", "Sz"];

/// One line of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    /// Key in `results.json`, with the operation's name in front where there is one.
    pub name: String,
    /// One per result, in order; none where it has no such key.
    pub quantities: Vec<Option<Quantity>>,
}

/// Quantities of one result under their names.
type Named = Vec<(String, Quantity)>;

/// Headline numbers, then the spreads of unevenness of each operation that has any.
pub(super) fn of_shaped(results: &[Compared<Results>]) -> Vec<Line> {
    let headlines: Vec<Named> = results.iter().map(|one| quantities(&one.results.headline)).collect();
    lines(&headlines, |one| {
        let operations = results[one].results.operations.iter();
        operations.flat_map(|of| prefixed(&format!("{}.unevenness", of.name), quantities(&of.unevenness))).collect()
    })
}

/// Headline numbers; of each operation its feeds, times and the hob's load; then damage, points, marks and texture.
pub(super) fn of_hobbed(results: &[Compared<HobbedResults>]) -> Vec<Line> {
    let headlines: Vec<Named> = results.iter().map(|one| quantities(&one.results.headline)).collect();
    lines(&headlines, |one| {
        let of = &results[one].results;
        let mut named = Named::new();
        for operation in &of.operations {
            let plain = operation.rest.iter().filter_map(|(key, value)| Some((key.clone(), quantity(value)?)));
            named.extend(prefixed(&operation.name, plain.collect()));
        }
        for load in of.hob_load.iter().flat_map(|load| &load.operations) {
            let mut of_load = quantities(load);
            of_load.extend(hob_load::peak_load_ratio(results, load));
            named.extend(prefixed(&format!("{}.hob_load", load.name), of_load));
        }
        // Of the blank what is left and what is hurt; how the rays stand is no result.
        for key in ["left_volume", "gouges", "interference"] {
            let mut of_blank = Vec::new();
            collect(key, &of.blank[key], &mut of_blank);
            named.extend(prefixed("blank", of_blank));
        }
        named.extend(prefixed("offset_curves", quantities(&of.offset_curves)));
        for marks in &of.marks {
            for (number, step) in (1..).zip(&marks.steps) {
                let place = format!("marks.tooth_{}_{}.step_{number}", marks.tooth, marks.flank);
                for source in ["kinematic", "surface"] {
                    named.extend(prefixed(&format!("{place}.{source}"), quantities(&step[source])));
                }
            }
        }
        for window in &of.texture {
            let heights = window.parameters.0.iter().filter(|(symbol, _)| HEIGHTS.contains(&symbol.as_str()));
            let place = format!("texture.{}.tooth_{}_{}", window.operation, window.tooth, window.flank);
            named.extend(prefixed(&place, heights.cloned().collect()));
        }
        named
    })
}

/// Lines of the headlines, and of everything else that `more` finds in a result.
fn lines(headlines: &[Named], more: impl Fn(usize) -> Named) -> Vec<Line> {
    let rest: Vec<Named> = (0..headlines.len()).map(more).collect();
    let known = |line: &Line| line.quantities.iter().flatten().any(|q| q.value().is_some() || q.words().is_some());
    joined(headlines).into_iter().chain(joined(&rest).into_iter().filter(known)).collect()
}

/// One line per name, in the order in which the results first have it.
fn joined(results: &[Named]) -> Vec<Line> {
    let mut seen = BTreeSet::new();
    let names = results.iter().flatten().map(|(name, _)| name).filter(|name| seen.insert(name.as_str()));
    names
        .map(|name| Line {
            name: name.clone(),
            quantities: results
                .iter()
                .map(|of| of.iter().find(|(other, _)| other == name).map(|(_, quantity)| quantity.clone()))
                .collect(),
        })
        .collect()
}

fn prefixed(label: &str, named: Named) -> Named {
    named.into_iter().map(|(key, quantity)| (format!("{label}.{key}"), quantity)).collect()
}

/// Every quantity of a struct under its key; structs inside it give keys with dots. Lists are left out.
fn quantities(of: &impl Serialize) -> Named {
    let mut found = Vec::new();
    if let Ok(value) = serde_json::to_value(of) {
        collect("", &value, &mut found);
    }
    found
}

fn collect(prefix: &str, value: &Value, found: &mut Named) {
    if let Some(quantity) = quantity(value) {
        found.push((prefix.to_owned(), quantity));
    } else if let Value::Object(entries) = value {
        for (key, entry) in entries {
            let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
            collect(&name, entry, found);
        }
    }
}

fn quantity(value: &Value) -> Option<Quantity> {
    serde_json::from_value(value.clone()).ok()
}

impl Line {
    /// Any of them, for unit and definition.
    pub(super) fn either(&self) -> Option<&Quantity> {
        self.quantities.iter().flatten().next()
    }

    /// Values less the first one, of the results after it; none where units differ.
    pub(super) fn differences(&self) -> impl Iterator<Item = Option<f64>> {
        let first = self.quantities.first().and_then(Option::as_ref);
        self.quantities.iter().skip(1).map(move |other| {
            let (first, other) = (first?, other.as_ref()?);
            (first.unit() == other.unit()).then_some(())?;
            Some(other.value()? - first.value()?)
        })
    }
}
