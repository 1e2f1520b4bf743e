//! Rings and the way into them, before anything is cut: the largest cutter that goes in radially, what an infeed trims,
//! and the exit code of what cannot be made.

use crate::fixtures::command::{Outcome, gearcut};
use std::fs;

/// What `check` says of a ring of module 1 with a sharp cutter.
fn check(ring_teeth: u32, cutter_teeth: u32) -> Outcome {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ring.toml");
    let text = format!(
        "[gear]\nkind = \"internal\"\nmodule_mm = 1.0\nteeth = {ring_teeth}\nface_width_mm = 5.0\n\
         [tool.shaper_cutter]\nteeth = {cutter_teeth}\n[tool.shaper_cutter.tip.sharp]\n"
    );
    fs::write(&path, text).expect("a scene");
    gearcut(&["check", path.to_str().expect("a path")])
}

/// 22 cutter teeth go into a ring of 40 radially. More gouge its tips on the way in.
#[test]
fn check_says_what_goes_in_radially_and_what_is_trimmed() {
    let fits = check(40, 22).done().says(&["largest for radial infeed     22 teeth"]);
    assert!(!fits.err.contains("trims the ring"), "{}", fits.err);
    for teeth in [24, 26] {
        check(40, teeth).failed(3, &["fault: going in, the cutter trims the ring's teeth by", "Use 22 cutter teeth"]);
    }
}

/// 38 teeth in a ring of 40: tip corners stand a millimetre deep in the teeth beside their space.
#[test]
fn check_ends_as_a_cut_does_of_what_cannot_be_made() {
    check(40, 38).failed(3, &["fault: the tip corners of the cutter cut"]);
}
