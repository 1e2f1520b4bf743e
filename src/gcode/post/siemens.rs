//! SINUMERIK 840D sl, 828D and ONE in Siemens mode, from the programming manuals NC programming (6FC5398-2EP40,
//! 12/2019) and Fundamentals (6FC5398-1BP40, 03/2013).
//!
//! A block has at most 512 characters with its comment and its end; a comment begins with `;`. The program's name is
//! the file's: at most 24 letters, digits and underscores, the first two of them letters, or an underscore and a
//! letter. Metric input is `G710`, dwell is `G4 F` in seconds, `G93` takes F in 1/min. There is no tape end in a file.
//! Positions are rounded to the steps of MD10200 and MD10210.

use super::{Dialect, ascii};

/// Most characters of a program's name.
const NAME: usize = 24;

pub(super) static DIALECT: Dialect = Dialect {
    extension: "mpf",
    opening: |_| Vec::new(),
    tape_ends: false,
    comment_marks: ["; ", ""],
    comment_words: ascii,
    told: &[
        "CONTROL SINUMERIK, Siemens mode; rotary axes count on beyond a turn: MD30310 ROT_IS_MODULO is 0",
        "MD10200 and MD10210, steps per mm and per deg, must not be coarser than the digits of the positions",
    ],
    numbers_blocks: true,
    safe_start: |_| vec!["G17 G40 G54 G64 G90 G94 G710 D0".to_owned()],
    approaches: true,
    // Enough for a nanometre at a metre's reach.
    most_digits: 8,
    largest_position: f64::INFINITY,
    feed_digits: 6,
    most_per_minute: 60_000.0,
    least_per_minute: 0.1,
    carries_time: true,
    whole_speeds: false,
    dwell: |seconds| format!("G4 F{seconds:.6}"),
};

/// A name that the control takes; where that is not the name itself, the program's number keeps it from another one's.
pub(super) fn program_name(name: &str, number: u32) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let begins = plain.len() >= 2 && plain.chars().take(2).all(|c| c.is_ascii_alphabetic());
    if begins && plain == name && plain.len() <= NAME {
        return plain;
    }
    let (before, number) = (if begins { "" } else { "OP_" }, number.to_string());
    let room = NAME - before.len() - 1 - number.len();
    format!("{before}{}_{number}", plain.chars().take(room).collect::<String>())
}
