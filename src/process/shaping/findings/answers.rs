//! A question that is answered before cutting: the number with its place, and beside it what to change.
//!
//! In: an entry and a sentence. Out: the entry, and the sentence under `<key>_advice`; on the
//! terminal and on the page both stand in one line.

use crate::findings::{Entry, Place, QuantityRow, Section, unit};
use crate::output::report::PageTable;
use crate::output::summary;
use crate::output::text::Sheet;
use crate::process::shaping::quantities::returns::ADVICE;
use crate::steps::report::quantities::value_and_unit;

/// What the key of a sentence ends with.
const SUFFIX: &str = "_advice";

/// What the sentence of an answer begins with that is as it should be.
const NOTHING: &str = "nothing";

/// An answer, and what to change.
pub fn answered(answer: Entry, advice: impl Into<String>) -> [Entry; 2] {
    let key = format!("{}{SUFFIX}", answer.key);
    let advice = ADVICE.of(advice.into()).titled(key.replace('_', " ")).keyed(key);
    [answer, advice]
}

/// What to change, beside the answer of this row.
pub fn advice<'a>(section: &'a Section, row: &QuantityRow) -> &'a str {
    answers(section).find(|(entry, _)| entry.key == row.key).map_or("", |(_, advice)| advice)
}

/// Entries of a section that are answers, with their sentences.
fn answers(section: &Section) -> impl Iterator<Item = (&Entry, &str)> {
    section.entries.iter().filter_map(|entry| {
        let key = format!("{}{SUFFIX}", entry.key);
        let advice = section.entries.iter().find(|other| other.key == key)?;
        Some((entry, advice.quantity.words()?))
    })
}

/// Titles of the answers that ask for a change: the sentences of the others begin with "nothing".
pub fn that_ask_for_a_change(section: &Section) -> impl Iterator<Item = &str> {
    answers(section).filter(|(_, advice)| !advice.starts_with(NOTHING)).map(|(entry, _)| entry.title.as_str())
}

/// Lines for the terminal.
pub fn print(sheet: &mut Sheet, section: &Section) {
    for (entry, advice) in answers(section) {
        summary::line(sheet, &entry.title, &format!("{}; {advice}", summary::shown(&entry.quantity)));
    }
}

/// Rows for the page.
pub fn table(section: &Section, caption: &str) -> PageTable {
    let row = |(entry, advice): (&Entry, &str)| {
        let (value, unit_word) = value_and_unit(&entry.quantity);
        let number = match entry.quantity.why() {
            Some(why) => format!("none: {why}"),
            None => unit::with_signs(&value, &unit_word),
        };
        let place = entry.quantity.place().map_or_else(|| "–".to_owned(), Place::words_with_signs);
        vec![entry.title.clone(), number, place, unit::sentence_with_signs(advice)]
    };
    PageTable {
        caption: caption.to_owned(),
        columns: ["Question", "Answer", "Where", "What to change"].map(str::to_owned).into(),
        rows: answers(section).map(row).collect(),
    }
}
