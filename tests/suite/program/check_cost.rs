//! The work that `gearcut check` expects, against what a cut of the same scene counts. Time is not compared: it depends
//! on the machine.

use crate::fixtures::command::{gearcut, read_json};

/// Dexels follow from the lengths of profiles and the spacings; the estimate rounds each flank's columns.
const DEXELS_SHARE: f64 = 0.03;

/// Coarse scenes of all processes: dexels are many enough for some tiles, the blank and the chips hardly cost anything.
const ROUND: (&str, &[&str]) = (
    "scenes/shaping/circular_m3_z24.toml",
    &["fields.flank.profile_spacing_um=20", "fields.flank.lead_spacing_um=5000", "fields.chips.spacing_mm=2"],
);
const HOBBED: (&str, &[&str]) =
    ("scenes/hobbing/machine_errors.toml", &["fields.flank.profile_spacing_um=80", "fields.blank.slice_spacing_mm=30"]);
const BEVEL: (&str, &[&str]) = (
    "scenes/bevel/crown_pinion.toml",
    &["fields.flank.profile_spacing_um=80", "fields.flank.lead_spacing_um=200", "fields.blank.slice_spacing_mm=30"],
);

/// Dexels of all flanks after all operations, and dexels against passes.
type Counted = [f64; 2];

fn arguments(command: &str, (scene, settings): (&str, &[&str])) -> Vec<String> {
    let settings = settings.iter().chain(&["fields.blank.spacing_mm=4", "picture=[]", "texture=[]"]);
    let settings = settings.flat_map(|setting| ["--set", setting]);
    [command, scene].into_iter().chain(settings).map(str::to_owned).collect()
}

/// What `check` expects; it tells dexels of one surface of each flank.
fn expected(scene: (&str, &[&str]), operations: f64) -> Counted {
    let arguments = arguments("check", scene);
    let out = gearcut(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).done().out;
    let million = |after: &str| {
        let word = out.split(after).next().and_then(|before| before.split_whitespace().next_back());
        1e6 * word.and_then(|word| word.parse::<f64>().ok()).unwrap_or_else(|| panic!("{after}: {out}"))
    };
    [operations * million(" million in all"), million(" million dexels against passes")]
}

/// What a cut counts.
fn counted(scene: (&str, &[&str])) -> Counted {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let mut arguments = arguments("cut", scene);
    let more = ["--only", "numbers", "--quiet", "--backend", "cpu", "--out", out.to_str().expect("a path")];
    arguments.extend(more.map(str::to_owned));
    gearcut(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).done();
    let record = read_json(&out.join("run.json"));
    ["dexels", "dexel_passes"].map(|key| record[key].as_f64().expect("a number"))
}

/// Whether dexels and evaluations agree, the latter within a share.
fn agree(expected: Counted, counted: Counted, share: f64) -> [bool; 2] {
    println!("expected {expected:?}, counted {counted:?}");
    let off = |i: usize| (expected[i] / counted[i] - 1.0).abs();
    [off(0) < DEXELS_SHARE, off(1) < share]
}

/// What agrees no longer with dexels that stand closer together, and with a fifth more evaluations.
fn disagree([dexels, _]: Counted, counted: Counted, share: f64) {
    assert_eq!(agree([dexels, 1.2 * counted[1]], counted, share), [false; 2], "the comparison sees no difference");
}

/// Two bands of two flanks are cut.
#[test]
fn the_work_of_shaping_is_what_its_cut_counts() {
    let counted = counted(ROUND);
    assert_eq!(agree(expected(ROUND, 2.0), counted, 0.1), [true; 2]);
    let finer = (ROUND.0, &["fields.flank.profile_spacing_um=15", "fields.flank.lead_spacing_um=5000"][..]);
    disagree(expected(finer, 2.0), counted, 0.1);
}

/// Two bands about the middle of the face of two flanks are cut.
#[test]
fn the_work_of_hobbing_is_what_its_cut_counts() {
    let counted = counted(HOBBED);
    assert_eq!(agree(expected(HOBBED, 1.0), counted, 0.15), [true; 2]);
    let finer = (HOBBED.0, &["fields.flank.profile_spacing_um=60", "fields.blank.slice_spacing_mm=30"][..]);
    disagree(expected(finer, 1.0), counted, 0.15);
}

/// Two bands of one flank of each side are cut: the others are the same but for a turn.
#[test]
fn the_work_of_bevel_cutting_is_what_its_cut_counts() {
    let counted = counted(BEVEL);
    assert_eq!(agree(expected(BEVEL, 1.0), counted, 0.1), [true; 2]);
    let finer = (BEVEL.0, &["fields.flank.profile_spacing_um=60", "fields.flank.lead_spacing_um=200"][..]);
    disagree(expected(finer, 1.0), counted, 0.1);
}
