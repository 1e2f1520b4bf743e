//! Keys of shaping in `[output]`: the forms of its axis programs.

use crate::scene::keys::{Addition, Key};

/// `gcode` with the form that only shaping has.
pub(super) static ADDED: Addition = Addition {
    path: "output",
    keys: &[Key::word(
        "gcode",
        &["linear", "paper_g84", "none"],
        "linear",
        "\"linear\"",
        "Form of the axis programs: straight lines in inverse time, with a shaper cutter the one-block form of Gao et \
        al. 2017 (not to be run: G84 taps on most machines), or none.",
    )],
    groups: &[],
};
