//! Questions that are answered before cutting: entries with advice, on the terminal and on the page.

use crate::findings::{Advice, Entry, Place, Section, unit};
use crate::output::report::PageTable;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::steps::report::quantities::value_and_unit;

/// Entries of a section that are answers, with their advice.
fn answers(section: &Section) -> impl Iterator<Item = (&Entry, &Advice)> {
    section.entries.iter().filter_map(|entry| Some((entry, entry.advice.as_ref()?)))
}

/// Titles of the answers after which something should be changed.
pub fn changes(section: &Section) -> impl Iterator<Item = &str> {
    answers(section).filter(|(_, advice)| advice.change).map(|(entry, _)| entry.title.as_str())
}

/// Lines for the terminal.
pub fn print(sheet: &mut Sheet, section: &Section) {
    for (entry, advice) in answers(section) {
        summary::line(sheet, &entry.title, &format!("{}. {}", summary::shown(&entry.quantity), advice.text));
    }
}

/// Rows for the page.
pub fn table(section: &Section, caption: &str) -> PageTable {
    let row = |(entry, advice): (&Entry, &Advice)| {
        let (value, unit_word) = value_and_unit(&entry.quantity);
        let number = match entry.quantity.why() {
            Some(why) => format!("none: {why}"),
            None => unit::with_signs(&value, &unit_word),
        };
        let place = entry.quantity.place().map_or_else(|| "–".to_owned(), Place::words_with_signs);
        vec![entry.title.clone(), number, place, unit::sentence_with_signs(&advice.text)]
    };
    PageTable {
        caption: caption.to_owned(),
        columns: ["Question", "Answer", "Where", "What follows"].map(str::to_owned).into(),
        rows: answers(section).map(row).collect(),
    }
}
