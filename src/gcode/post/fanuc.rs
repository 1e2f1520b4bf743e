//! FANUC with the G-codes of machining centres and the increment system IS-C, from the operator's manuals of Series
//! 16/18 (B-62764EN) and 30i (B-64484EN).
//!
//! `%` stands at both ends, `O` and four digits after the first one; 8000 to 9999 may be protected. A number without a
//! decimal point counts least increments, so that every position has one; IS-C has four digits and takes eight in all.
//! `G93` takes F from 0.001 to 9999.999 in every block. `G4 X` with a point is in seconds, where `P` counts
//! milliseconds. S is whole. Comments stand in round brackets, in capitals. An axis that turns beyond the range of
//! positions is commanded in increments (`G91`), which are taken as they are, whether or not positions roll over at 360
//! deg.
//!
//! `G80` is left out of the first block: on gear machines it parts work and hob.

use super::{Dialect, ascii};

/// The first program's number is one more.
const NUMBERS_FROM: u32 = 1000;
/// Most characters of the comment beside the program's number.
const TITLE: usize = 31;

pub(super) static DIALECT: Dialect = Dialect {
    extension: "nc",
    opening: |opening| {
        let title: String = comment(opening.name).chars().take(TITLE).collect();
        vec!["%".to_owned(), format!("O{:04} ({title})", NUMBERS_FROM + opening.number)]
    },
    tape_ends: true,
    comment_marks: ["(", ")"],
    comment_words: comment,
    told: &["CONTROL FANUC, G-codes of machining centres, increment system IS-C: 0.0001 mm and deg"],
    // Numbers are optional, and have five digits, fewer than there may be blocks.
    numbers_blocks: false,
    safe_start: |_| vec!["G21".to_owned(), "G17 G40 G49 G54 G64 G90 G94".to_owned()],
    approaches: true,
    most_digits: 4,
    largest_position: 9999.9999,
    feed_digits: 3,
    most_per_minute: 9999.999,
    // Two seconds: a step of F is then 0.07 ms.
    least_per_minute: 30.0,
    carries_time: true,
    whole_speeds: true,
    // Rounded up, so that a last stroke is made to its end.
    dwell: |seconds| format!("G4 X{:.3}", (seconds * 1e3).ceil() / 1e3),
};

/// Capitals, digits and the signs that every control of the family shows.
fn comment(words: &str) -> String {
    let words = ascii(words).replace('%', "PCT").to_ascii_uppercase();
    let shown = |c: char| c.is_ascii_alphanumeric() || " .,+-/*=:".contains(c);
    words.chars().map(|c| if shown(c) { c } else { ' ' }).collect()
}
