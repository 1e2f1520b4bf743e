//! No control in particular: what gearcut's own reader takes.

use super::{Dialect, ascii};

pub(super) static DIALECT: Dialect = Dialect {
    extension: "ngc",
    opening: |_| vec!["%".to_owned()],
    tape_ends: true,
    comment_marks: ["(", ")"],
    comment_words: ascii,
    told: &[],
    numbers_blocks: true,
    safe_start: |_| vec!["G21 G90 G94".to_owned()],
    approaches: false,
    most_digits: usize::MAX,
    largest_position: f64::INFINITY,
    feed_digits: 9,
    most_per_minute: f64::INFINITY,
    least_per_minute: 0.0,
    carries_time: false,
    whole_speeds: false,
    dwell: |seconds| format!("G4 P{seconds:.9}"),
};
