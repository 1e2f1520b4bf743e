//! Quantities of findings on a page, whatever they are: of pairs of gears, which no process knows.

use crate::findings::{Entry, Place, Quantity, Section, unit};
use crate::output::report::{KeyNumber, PageTable};
use crate::output::text::{plain, significant};

/// What stands where there is no value.
const NONE: &str = "–";

/// The quantities of a section as a table.
pub fn table(section: &Section) -> PageTable {
    let rows = section.entries.iter().map(|entry| {
        let what = entry.quantity.why().unwrap_or(entry.quantity.definition());
        let [name, what] = [entry.heading().as_str(), what].map(unit::sentence_with_signs);
        vec![name, value_with_unit(&entry.quantity), place(&entry.quantity), what]
    });
    PageTable {
        caption: section.title.clone(),
        columns: ["", "Value", "At", "What it is"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

/// Number or words with the unit, as a cell; a dash without a unit where there is none.
pub fn value_with_unit(quantity: &Quantity) -> String {
    let (value, unit) = value_and_unit(quantity);
    if value == NONE { value } else { format!("{value} {unit}").trim().to_owned() }
}

/// Number or words alone, where the column's name has the unit.
pub fn value_alone(quantity: &Quantity) -> String {
    value_and_unit(quantity).0
}

/// A number of the headline.
pub fn key_number(entry: &Entry) -> KeyNumber {
    let (value, unit) = value_and_unit(&entry.quantity);
    KeyNumber {
        name: unit::sentence_with_signs(&entry.heading()),
        value,
        unit,
        definition: unit::sentence_with_signs(entry.quantity.definition()),
        note: entry.quantity.why().map_or_else(|| place(&entry.quantity), str::to_owned),
        place: None,
    }
}

/// Number or words, and the unit in the signs of a page: ratios stay ratios, and signs stay with deviations.
fn value_and_unit(quantity: &Quantity) -> (String, String) {
    let value = match (quantity.value(), quantity.words()) {
        (Some(count), _) if quantity.is_count() => plain(count),
        // Sizes and distances of axes to the micrometre.
        (Some(value), _) if quantity.unit() == Some("mm") && value.abs() >= 10.0 => {
            plain((value * 1e3).round() / 1e3).replace('-', "−")
        }
        (Some(value), _) => significant(value, 4).replace('-', "−"),
        (None, words) => words.unwrap_or(NONE).to_owned(),
    };
    (value, quantity.unit().map_or_else(String::new, |unit| unit::signs(unit).replace("arcsec", "″")))
}

fn place(quantity: &Quantity) -> String {
    quantity.place().map_or_else(String::new, Place::words_with_signs)
}
