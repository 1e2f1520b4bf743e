//! Quantities of findings on a page, whatever they are: of pairs of gears, which no process knows.

use crate::findings::{Entry, Place, Quantity, Section, unit};
use crate::number_text::{plain, significant};
use crate::output::report::{KeyNumber, PageTable};
use crate::progress::duration_text;
use gearcut_core::cut::KERNEL_UM;

/// Shares below this are rounding, per cent.
const LEAST_PERCENT: f64 = 1e-9;
/// What stands where there is no value.
const NONE: &str = "–";

/// The quantities of a section as a table, with their places where one of them has a place.
pub fn table(section: &Section) -> PageTable {
    let with_places = section.entries.iter().any(|entry| entry.quantity.place().is_some());
    let placed = |cells: [String; 4]| {
        cells.into_iter().enumerate().filter(|(k, _)| with_places || *k != 2).map(|(_, cell)| cell).collect()
    };
    let rows = section.entries.iter().map(|entry| {
        let what = entry.quantity.why().unwrap_or(entry.quantity.definition());
        let [name, what] = [entry.heading().as_str(), what].map(unit::sentence_with_signs);
        placed([name, value_with_unit(&entry.quantity), place(&entry.quantity), what])
    });
    PageTable {
        caption: section.title.clone(),
        columns: placed(["", "Value", "At", "What it is"].map(str::to_owned)),
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

/// A number of the headline. A place on a flank is a button of its own.
pub fn key_number(entry: &Entry) -> KeyNumber {
    let (value, unit) = value_and_unit(&entry.quantity);
    let on_flank = entry.quantity.place().is_some_and(|place| place.flank().is_some());
    let note = entry.quantity.why().map(str::to_owned);
    KeyNumber {
        name: unit::sentence_with_signs(&entry.heading()),
        value,
        unit,
        definition: unit::sentence_with_signs(entry.quantity.definition()),
        note: note.unwrap_or_else(|| if on_flank { String::new() } else { place(&entry.quantity) }),
        place: entry.quantity.place().cloned(),
    }
}

/// Number or words, and the unit in the signs of a page. Pure numbers stay as they are, a ratio of 1.5 is no 150 %;
/// what lies below the resolution is rounding and reads as zero.
pub fn value_and_unit(quantity: &Quantity) -> (String, String) {
    let unit = quantity.unit().unwrap_or("");
    let Some(value) = quantity.value() else {
        return (unit::sentence_with_signs(quantity.words().unwrap_or(NONE)), unit::signs(unit));
    };
    let text = |digits| significant(value, digits).replace('-', "−");
    let value = match unit {
        _ if quantity.whole().is_some() => plain(value),
        "s" => return (duration_text(value), String::new()),
        "um" if value.abs() < KERNEL_UM => "0".to_owned(),
        "%" if value.abs() < LEAST_PERCENT => "0".to_owned(),
        // Sizes and distances of axes to the micrometre.
        "mm" if value.abs() >= 10.0 => plain((value * 1e3).round() / 1e3).replace('-', "−"),
        "um" | "%" => text(3),
        _ => text(4),
    };
    (value, unit::signs(unit).replace("arcsec", "″"))
}

fn place(quantity: &Quantity) -> String {
    quantity.place().map_or_else(String::new, Place::words_with_signs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::QuantityRow;

    /// The same number reads the same on the page of a gear and on that of a pair.
    #[test]
    fn pure_numbers_stay_ratios_and_rounding_reads_as_zero() {
        let shown = |unit: &'static str, value: f64| {
            value_and_unit(&QuantityRow::new("made", unit, "made by hand").of(value).quantity)
        };
        let pair = |value: &str, unit: &str| (value.to_owned(), unit.to_owned());
        assert_eq!(shown("1", 1.534), pair("1.534", ""), "a contact ratio is no 153.4 %");
        assert_eq!(shown("%", -12.34), pair("−12.3", "%"), "a share below nothing is no nothing");
        assert_eq!(shown("%", -1e-12), pair("0", "%"));
        assert_eq!(shown("um", 1e-5), pair("0", "µm"));
        assert_eq!(shown("arcsec", 12.345), pair("12.35", "″"));
        assert_eq!(shown("mm", 123.456_78), pair("123.457", "mm"));
        assert_eq!(shown("s", 90.0), (duration_text(90.0), String::new()));
    }
}
