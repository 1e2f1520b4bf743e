//! Notices of gears of many seeds.

use crate::findings::notice::notices;

notices! {
    /// More seeds show nothing more.
    NotRandom: Note "scatter.not_random", "errors.md", (),
        "nothing in the scene is random: every seed makes the same gear"; "Give an axis noise, or name a --tolerance."
    /// Median and interval are those of the other gears.
    Missing: Note "scatter.missing", "errors.md", (numbers),
        "some gears do not have these numbers and are not in their spread: {numbers}";
        "Look at single seeds: some gears may be damaged."
}
