//! LinuxCNC, from its own documentation (docs/src/gcode/overview.adoc and g-code.adoc of LinuxCNC 2.8 and later).
//!
//! A line has at most 256 characters. A file begins and ends with `%`, or has `M2` or `M30`. Numbers may have any
//! number of digits, some seventeen of them count. `G93` wants F in every block with `G1`. `G4 P` is in seconds. A
//! comment that begins with MSG, DEBUG, PRINT, LOG or their like and a comma is a command. `G64 P` lets corners be
//! rounded by so much.

use super::{Dialect, ascii};

/// First words of comments that the control takes for commands.
const ACTIVE: [&str; 11] = [
    "MSG,",
    "DEBUG,",
    "PRINT,",
    "LOG,",
    "LOGOPEN,",
    "LOGAPPEND,",
    "LOGCLOSE",
    "PROBEOPEN",
    "PROBECLOSE",
    "PY,",
    "ABORT,",
];

pub(super) static DIALECT: Dialect = Dialect {
    extension: "ngc",
    opening: |_| vec!["%".to_owned()],
    tape_ends: true,
    comment_marks: ["(", ")"],
    comment_words: |words| {
        let words = ascii(words);
        let first = words.trim_start().to_ascii_uppercase();
        if ACTIVE.iter().any(|active| first.starts_with(active)) { format!("- {words}") } else { words }
    },
    told: &["CONTROL LinuxCNC; rotary axes count on beyond a turn: WRAPPED_ROTARY is not set"],
    // Numbers are optional, and mean nothing.
    numbers_blocks: false,
    safe_start: |contour_error_mm| {
        vec!["G17 G21 G40 G49 G54 G80 G90 G94".to_owned(), format!("G64 P{contour_error_mm:.6}")]
    },
    approaches: true,
    most_digits: 12,
    largest_position: f64::INFINITY,
    feed_digits: 9,
    most_per_minute: 60_000.0,
    least_per_minute: 0.0,
    carries_time: true,
    whole_speeds: false,
    dwell: |seconds| format!("G4 P{seconds:.6}"),
};
