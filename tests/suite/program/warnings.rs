//! One list of warnings: what `check` knows is in the list of `cut`, and every place shows that list.

use crate::fixtures::command::{Outcome, gearcut, read_json};
use serde_json::Value;
use std::path::Path;

/// A round gear of nine teeth, which the cutter undercuts, roughed at full depth from the first stroke on.
const UNDERCUT: &str = "scenes/shaping/circular_m3_z24.toml";
const SETTINGS: [&str; 8] = [
    "gear.teeth=9",
    "gear.bore_diameter_mm=5",
    "tool.shaper_cutter.teeth=40",
    "fields.flank.profile_spacing_um=100",
    "fields.flank.lead_spacing_um=5000",
    "fields.chips.spacing_mm=0.3",
    "fields.blank.spacing_mm=1",
    "picture=[]",
];

fn run(command: &str, scene: &str, settings: &[&str], more: &[&str]) -> Outcome {
    let settings = settings.iter().flat_map(|setting| ["--set", setting]);
    gearcut(&[command, scene].into_iter().chain(settings).chain(more.iter().copied()).collect::<Vec<_>>())
}

/// Severity, text and id of every warning in `results.json`, as the terminal shows them.
fn listed(out: &Path) -> Vec<String> {
    let results = read_json(&out.join("results.json"));
    let word = |warning: &Value, key: &str| warning[key].as_str().expect("a text").to_owned();
    let list = results["warnings"].as_array().expect("a list");
    list.iter()
        .map(|warning| format!("{}: {} [{}]", word(warning, "severity"), word(warning, "text"), word(warning, "id")))
        .collect()
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|why| panic!("{}: {why}", path.display()))
}

/// How many lines there are of each severity, in words.
fn counted(lines: &[impl AsRef<str>]) -> String {
    let of = |severity: &str| {
        let count = lines.iter().filter(|line| line.as_ref().starts_with(severity)).count();
        let plural = if count == 1 { "" } else { "s" };
        (count > 0).then(|| format!("{count} {severity}{plural}"))
    };
    ["fault", "warning", "note"].into_iter().filter_map(of).collect::<Vec<_>>().join(", ")
}

/// White space as one blank, as the summary breaks lines.
fn unbroken(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn every_place_shows_the_same_list() {
    let folder = tempfile::tempdir().expect("a folder");
    let (cut, axes) = (folder.path().join("cut"), folder.path().join("axes"));
    let only = ["--only", "axes,report", "--out", cut.to_str().expect("a path")];
    let summary = unbroken(&run("cut", UNDERCUT, &SETTINGS, &only).done().out);
    let listed = listed(&cut);
    assert!(listed[0].starts_with("warning: "), "the gravest first: {listed:?}");
    let has = |words: &str| assert!(listed.iter().any(|line| line.contains(words)), "no {words:?} in {listed:?}");
    has("warning: the cutter undercuts tooth 1 left");
    has("the first stroke comes at full depth and takes");
    // What is known before cutting is in the list, word by word; the count comes last.
    for err in [
        run("check", UNDERCUT, &SETTINGS, &[]).done().err,
        run("axes", UNDERCUT, &SETTINGS, &["--out", axes.to_str().expect("a path")]).done().err,
    ] {
        let lines: Vec<&str> = err.lines().collect();
        let (count, known) = lines.split_last().expect("lines");
        assert!(!known.is_empty() && known.iter().all(|line| listed.iter().any(|of| of == line)), "{err}");
        assert_eq!(*count, counted(known), "{err}");
    }
    let page = text(&cut.join("report.html"));
    for line in &listed {
        let (sentence, id) = line.strip_suffix(']').and_then(|line| line.rsplit_once(" [")).expect("an id");
        let words = sentence.split_once(": ").expect("a severity").1;
        assert!(summary.contains(&unbroken(line)), "{line} is not in the summary: {summary}");
        let on_page = words.replace(" um", " µm").replace('&', "&amp;").replace('"', "&quot;");
        assert!(page.contains(&format!("{on_page} <code>{id}</code>")), "{on_page} is not on the page");
        for operation in ["rough", "finish"].into_iter().filter(|_| !line.starts_with("note")) {
            let program = text(&cut.join(format!("axes/{operation}.ngc")));
            let comment = format!("({})", sentence.replace(['(', ')'], " "));
            // How texture is sampled concerns nobody at the machine.
            assert_ne!(program.contains(&comment), id.starts_with("texture."), "{comment} in the program's head");
        }
    }
    let count = format!("shown above {}", counted(&listed));
    assert!(summary.contains(&count), "no {count:?} in {summary}");
    assert!(page.contains(&format!("{}</a>", counted(&listed))), "the page does not count them");
}

/// A program that cannot be written is known before anything is cut, and told by every command alike, whether it would
/// write one or not.
#[test]
fn a_program_that_cannot_be_written_is_told_by_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a path").to_owned();
    let settings = [&SETTINGS[..], &["machine.limits.work_speed_deg_per_s=0.1"]].concat();
    let told = |command: &str, more: &[&str]| -> Vec<String> {
        let err = run(command, UNDERCUT, &settings, more).done().err;
        err.lines().filter(|line| line.contains("no G-code written")).map(str::to_owned).collect()
    };
    let known = told("check", &[]);
    assert!(known.len() == 2 && known[0].contains("operation rough: no G-code written: the work spindle"), "{known:?}");
    assert_eq!(told("axes", &["--out", &path("axes")]), known);
    run("cut", UNDERCUT, &settings, &["--only", "numbers", "--out", &path("cut")]).done();
    let listed = listed(&folder.path().join("cut"));
    assert!(known.iter().all(|line| listed.contains(line)), "{listed:?}");
    assert_eq!(listed.iter().filter(|line| line.contains("no G-code")).count(), 2, "{listed:?}");
}

/// What is a function of the scene is known before the cut: the first stroke's force, a class that the standard does
/// not give, marks with too few points. What `cut` adds is what `check` says that only a cut can find.
#[test]
fn a_cut_adds_only_what_no_scene_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("cut");
    let settings = [
        &SETTINGS[..],
        &[
            "gear.face_width_mm=3",
            "measure.iso_1328_class=5",
            "measure.limits.profile_form_um=0.01",
            "texture=[{ tooth = 2, profile_spacing_um = 100, lead_spacing_um = 500 }]",
        ],
    ]
    .concat();
    let check = run("check", UNDERCUT, &settings, &[]).done();
    let known: Vec<&str> = check.err.lines().collect();
    for words in [
        "warning: operation rough: the first stroke comes at full depth and takes",
        "warning: class 5 is not judged: ",
        "warning: texture of tooth 2 left, 2 right after finish: a mark along the profile has only",
    ] {
        assert!(known.iter().any(|line| line.starts_with(words)), "no {words:?} in {known:?}");
    }
    run("cut", UNDERCUT, &settings, &["--only", "report", "--out", out.to_str().expect("a path")]).done();
    let added: Vec<String> = listed(&out).into_iter().filter(|line| !known.contains(&line.as_str())).collect();
    let kinds =
        ["beyond the limit of 0.01", "below the target", "points of the window are holes", "is still the blank"];
    for line in &added {
        assert!(kinds.iter().any(|kind| line.contains(kind)), "a scene says: {line}");
    }
    assert!(added.iter().any(|line| line.contains(kinds[0])), "{added:?}");
    for kind in ["deviations beyond limits", "holes of texture windows", "no stroke reaches"] {
        assert!(unbroken(&check.out).contains(kind), "{}", check.out);
    }
}

/// How deep the returning cutter lies has one number from the surfaces that are generated and one from the gear as
/// cut, each told as such; no place is deeper than the way back.
#[test]
fn depths_of_the_returning_cutter_say_whence_they_are() {
    let deep = ["operation.rough.offset_mm=-5"];
    let err = run("check", "scenes/shaping/elliptical_normal.toml", &deep, &[]).failed(3, &[]).err;
    let words = "by the surfaces that it generates, the returning cutter is ";
    let line = err.lines().find(|line| line.contains(words)).expect("it rubs");
    let depth_um: f64 =
        line.split(words).nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).expect("a depth");
    assert!((100.0..200.0).contains(&depth_um), "{line}: a cut of it finds 137 um");
    assert!(err.contains("um to first order for 0.5 mm"), "{err}");
}

/// Two starts on an even number of teeth, and a feed that makes chips of more than half a millimetre.
#[test]
fn a_hob_that_hunts_and_takes_thick_chips_is_warned_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let settings = [
        "gear.teeth=16",
        "tool.hob.starts=2",
        "tool.hob.gashes=6",
        "operation.finish.axial_feed_mm_per_revolution=8",
        "fields.flank.profile_spacing_um=500",
        "fields.flank.lead_spacing_um=5000",
        "fields.blank.spacing_mm=1",
        "fields.blank.slice_spacing_mm=5",
        "picture=[]",
    ];
    let scene = "scenes/hobbing/circular_spur.toml";
    let hunting = "warning: 2 starts and 16 teeth share the divisor 2";
    let thick = "mm thick in the middle of the face, more than 0.5 mm";
    let known = run("check", scene, &settings, &[]).done().err;
    run("cut", scene, &settings, &["--only", "report", "--out", out.to_str().expect("a path")]);
    let listed = listed(&out);
    for words in [hunting, thick] {
        assert!(known.contains(words), "no {words:?} in {known}");
        assert!(listed.iter().any(|line| line.contains(words)), "no {words:?} in {listed:?}");
    }
}

/// A gear clamped 5 um off its axis deviates; it is not gouged.
#[test]
fn five_micrometres_of_runout_are_a_deviation() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let settings = [&["mounting.eccentricity_um=5", "fields.blank.spacing_mm=0.3"], &SETTINGS[3..6]].concat();
    run("cut", UNDERCUT, &settings, &["--only", "report", "--out", out.to_str().expect("a path")]).done();
    let listed = listed(&out);
    assert!(listed.iter().any(|line| line.contains("deviations, no gouges")), "{listed:?}");
    assert!(!listed.iter().any(|line| line.starts_with("fault")), "{listed:?}");
}

/// A denied warning and an allowed fault set the exit code, and the terminal says so; results stay as they are.
#[test]
fn the_command_line_denies_and_allows_notices() {
    let check = |more: &[&str]| run("check", UNDERCUT, &SETTINGS, more);
    assert!(check(&["--deny", "curve.*", "--deny", "hob.*"]).done().out.starts_with("can be cut: "));
    let denied = check(&["--deny", "flank.*", "--allow", "flank.below_target"]);
    let said = ["verdict: the cutter undercuts tooth 1 left", "(denied by --deny)"];
    assert!(denied.failed(3, &said).out.starts_with("not as it is: "));
    check(&["--deny", "flank.*", "--allow", "flank.undercut"]).done();
    // Wrong usage, with the nearest.
    check(&["--deny", "flank.undercuts"]).failed(2, &["did you mean flank.undercut?"]);
    // A fault: an operation that goes deeper than finishing.
    let deep = [&SETTINGS[..], &["operation.rough.offset_mm=-0.5"]].concat();
    let check = |more: &[&str]| run("check", UNDERCUT, &deep, more);
    check(&[]).failed(3, &["goes 0.500 mm deeper than finishing", "[cut.deeper_than_finishing]"]);
    let allowed = check(&["--allow", "cut.*"]).done();
    assert!(allowed.err.contains("note: allowed by --allow: cut.deeper_than_finishing"), "{}", allowed.err);
    assert!(allowed.err.contains("fault: operation rough: it goes"), "{}", allowed.err);
}
