//! Budgets and calibrations that were stopped go on with the cuts that they have made, and find the same.

use super::round::{SCENE, loaded};
use crate::fixtures::command::{gearcut_in, read_json};
use gearcut::backend::{BackendWish, Choice, OnFailure, choose};
use gearcut::influence::budget::{BudgetOptions, budget, chosen};
use gearcut::influence::calibrate::{Calibration, MeasuredGear};
use gearcut::influence::charts::MeasuredLine;
use gearcut::influence::known_cuts::KnownCuts;
use gearcut::influence::measured::{Chart, MeasuredPoint};
use gearcut::interrupt::Interrupt;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::terms::Side;
use serde_json::{Map, json};
use std::fs;
use std::path::Path;
#[cfg(unix)]
use std::process::{Command, Stdio};

const GUIDE: &str = "machine.errors.guide";

fn growing(folder: &Path) -> KnownCuts {
    let record = [("program", json!("gearcut")), ("command", json!("budget"))];
    let record: Map<_, _> = record.map(|(key, value)| (key.to_owned(), value)).into_iter().collect();
    KnownCuts::growing_in(folder, record).expect("a folder")
}

fn choice() -> Choice {
    choose(BackendWish::Cpu, OnFailure::default()).expect("the processor")
}

/// A budget of the guide's four errors on one flank, as text with all digits.
fn guide_budget(settings: &[&str], numbers: bool, known: &KnownCuts) -> String {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let options = BudgetOptions { parameters: vec![GUIDE.to_owned()], flanks: vec![(2, Side::Left)], numbers };
    let (quiet, go_on) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    format!("{:?}", budget(&loaded(&settings), &options, &choice(), &quiet, &go_on, known).expect("cut"))
}

/// A fit of two slopes to a helix that leans and bends.
fn fit(known: &KnownCuts) -> String {
    let loaded = loaded(&[]);
    let parameters = chosen(&loaded, &[GUIDE.to_owned()]).expect("a guide");
    let point = |v_mm: f64| MeasuredPoint {
        tooth: 5,
        side: Side::Left,
        u_mm: 2.5,
        v_mm,
        deviation_um: 0.3 * v_mm + 0.02 * v_mm * v_mm,
    };
    let line = MeasuredLine { chart: Chart::Helix, points: (-4..=4).map(|i| point(2.0 * f64::from(i))).collect() };
    let measured = MeasuredGear { lines: vec![line], noise_um: 0.1, ..MeasuredGear::default() };
    let (quiet, go_on) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    format!("{:?}", Calibration::new(&loaded, &parameters, &measured, &choice(), &quiet, &go_on, known).expect("cut"))
}

/// What a kill after some cuts leaves: their rows, and a row without its end.
fn killed_after(rows: usize, whole: &Path, folder: &Path) {
    fs::create_dir_all(folder).expect("made");
    fs::copy(whole.join("run.json"), folder.join("run.json")).expect("copied");
    let text = fs::read_to_string(whole.join("cuts.csv")).expect("rows");
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let half = lines.get(1 + rows).map_or("", |line| &line[..line.len() / 2]);
    fs::write(folder.join("cuts.csv"), lines[..=rows].concat() + half).expect("written");
}

/// Runs work that is stopped after some of its cuts, and once more; gives how many cuts the whole work takes.
fn goes_on(work: impl Fn(&KnownCuts) -> String) -> usize {
    let folder = tempfile::tempdir().expect("a folder");
    let without = KnownCuts::default();
    let expected = work(&without);
    let whole = folder.path().join("whole");
    let known = growing(&whole);
    assert_eq!(work(&known), expected, "rows change nothing");
    let [all, taken] = known.made_and_taken();
    assert_eq!((taken, without.made_and_taken()), (0, [all, 0]));
    for done in [0, 1, all / 2, all - 1, all] {
        let stopped = folder.path().join(format!("stopped_{done}"));
        killed_after(done, &whole, &stopped);
        let known = growing(&stopped);
        assert_eq!(work(&known), expected, "stopped after {done} cuts");
        assert_eq!(known.made_and_taken(), [all - done, done]);
    }
    all
}

#[test]
fn a_budget_goes_on_with_the_cuts_that_it_has_made() {
    // The scene, and of four errors both sides of the step and of half the step.
    assert_eq!(goes_on(|known| guide_budget(&[], false, known)), 1 + 4 * 4);
}

#[test]
fn a_fit_goes_on_with_the_cuts_that_it_has_made() {
    assert!(goes_on(fit) > 1 + 2 * 4);
}

/// Cuts of another scene, or that other numbers are asked of, are no cuts of this one.
#[test]
fn cuts_of_other_scenes_and_places_are_not_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("cuts");
    let first = guide_budget(&[], false, &growing(&place));
    let other = |settings: &[&str]| {
        let known = growing(&place);
        assert_ne!(guide_budget(settings, false, &known), first);
        known.made_and_taken()
    };
    assert_eq!(other(&["operation.finish.strokes_per_revolution=2401"]), [17, 0]);
    assert_eq!(other(&["gear.face_width_mm=21"]), [17, 0]);
    // Twice the same are one: all rows of both are there.
    let known = growing(&place);
    assert_eq!(guide_budget(&[], false, &known), first);
    assert_eq!(known.made_and_taken(), [0, 17]);
    let fitted = growing(&place);
    fit(&fitted);
    assert_eq!(fitted.made_and_taken()[1], 0, "charts are other numbers than grids");
    // A folder of another command is left alone.
    fs::write(place.join("run.json"), "{\"program\": \"gearcut\", \"command\": \"cut\"}").expect("written");
    let before = fs::read(place.join("cuts.csv")).expect("rows");
    let known = growing(&place);
    assert_eq!(guide_budget(&[], false, &known), first);
    assert_eq!(known.made_and_taken(), [17, 0]);
    assert_eq!(fs::read(place.join("cuts.csv")).expect("rows"), before);
}

/// As a user has it: a kill, then Ctrl-C, then the same command to its end.
#[cfg(unix)]
#[test]
fn the_command_goes_on_after_a_kill_and_after_ctrl_c() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    let budget = ["budget", "round.toml", "--parameters", "mounting,machine.errors.guide", "--flanks", "2-left"];
    let rows = || fs::read_to_string(folder.path().join("b.partial/cuts.csv")).map_or(0, |text| text.lines().count());
    let ended_by = |signal: &str| {
        let before = rows();
        let mut child = Command::new(env!("CARGO_BIN_EXE_gearcut"))
            .args(budget)
            .args(["--out", "b"])
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        while rows() < before.max(1) + 2 {
            assert!(child.try_wait().expect("a child").is_none(), "it ended before it could be stopped");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().expect("a signal").success());
        child.wait().expect("ended").code()
    };
    assert_eq!(ended_by("-KILL"), None, "killed");
    let partial = folder.path().join("b.partial");
    assert_eq!(read_json(&partial.join("run.json"))["complete"], false);
    assert!(!folder.path().join("b").exists() && !partial.join("results.json").exists());
    assert_eq!(ended_by("-INT"), Some(130));
    let kept = rows();
    assert!(kept >= 4, "{kept} rows");
    let done = gearcut_in(folder.path(), &[&budget[..], &["--out", "b"]].concat()).done();
    let note = format!("{} cuts are those of a run that was stopped; {} were made now", kept - 1, 37 + 1 - kept);
    assert!(done.err.contains(&note), "{note}: {}", done.err);
    assert!(!partial.exists(), "the complete run removes it");
    let whole = gearcut_in(folder.path(), &[&budget[..], &["--out", "whole"]].concat()).done();
    assert!(!whole.err.contains("stopped"), "{}", whole.err);
    for name in ["budget.csv", "report.html", "results.json", "run.json", "tables/influence_maps.csv"] {
        let [resumed, whole] = ["b", "whole"].map(|out| fs::read(folder.path().join(out).join(name)).expect("a file"));
        assert!(resumed == whole, "{name} has other bytes after a stop");
    }
    assert!(!folder.path().join("b/cuts.csv").exists(), "a complete result needs no cuts");
    // What is refused leaves nothing.
    let refused = [&budget[..2], &["--flanks", "25-left", "--out", "c"]].concat();
    gearcut_in(folder.path(), &refused).failed(1, &["25"]);
    assert!(!folder.path().join("c.partial").exists());
}

/// A file that may not grow any further is a full disk: the cuts before it stay, the message tells where, and the same
/// command goes on with them.
#[cfg(unix)]
#[test]
fn a_full_disk_costs_no_finished_cut() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    let budget = ["budget", "round.toml", "--parameters", GUIDE, "--flanks", "2-left", "--out", "b"];
    // Blocks are of 512 bytes; without its signal a write beyond them is an error.
    let limited = Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 30; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_gearcut")])
        .args(budget)
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    let told = String::from_utf8_lossy(&limited.stderr);
    assert_eq!(limited.status.code(), Some(1), "{told}");
    let cuts = fs::read_to_string(folder.path().join("b.partial/cuts.csv")).expect("rows that stay");
    let whole = cuts.lines().count() - 1 - usize::from(!cuts.ends_with('\n'));
    assert!((1..17).contains(&whole), "{whole} whole rows");
    assert!(told.contains("b.partial") && told.contains("the same command goes on"), "{told}");
    let done = gearcut_in(folder.path(), &budget).done();
    let note = format!("{whole} cuts are those of a run that was stopped; {} were made now", 17 - whole);
    assert!(done.err.contains(&note), "{note}: {}", done.err);
}
