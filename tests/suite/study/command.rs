//! The commands `study` and `sweep` as a user has them: rows, kills, shares, refusals.

use crate::fixtures::command::{Outcome, gearcut, gearcut_in};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// A coarse round gear: a case of its axes takes milliseconds, a whole cut seconds.
const SCENE: &str = "
[gear]
module_mm = 3.0
teeth = 24
face_width_mm = 4.0
[tool.shaper_cutter]
teeth = 20
[fields.flank]
profile_spacing_um = 500.0
lead_spacing_um = 2000.0
[fields.blank]
spacing_mm = 1.0
slice_spacing_mm = 4.0
";

/// Twelve cases, of which those with 2 teeth are refused.
const SWEEP: [&str; 11] = [
    "sweep",
    "round.toml",
    "--quiet",
    "--command",
    "axes",
    "--grid",
    "gear.teeth=24,2",
    "--range",
    "machine.double_strokes_per_minute=200..600/6",
    "--keep",
    "operations.finish.axes.work_speed.peak",
];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    folder
}

fn swept(folder: &Path, more: &[&str]) -> Outcome {
    gearcut_in(folder, &[&SWEEP[..], more].concat())
}

fn rows(path: &Path) -> Vec<String> {
    fs::read_to_string(path.join("rows.csv")).expect("rows").lines().map(str::to_owned).collect()
}

/// Of 2,400 strokes a turn and n double strokes a minute the work turns n / 60 / 2,400 of a turn a second.
#[test]
fn a_row_has_its_parameters_and_what_is_kept() {
    let folder = folder();
    swept(folder.path(), &["--out", "s"]).done().says(&["12 cases, 6 of them failed; their rows are in s/rows.csv"]);
    let rows = rows(&folder.path().join("s"));
    let head = "case,gear.teeth,machine.double_strokes_per_minute,operations.finish.axes.work_speed.peak_deg_per_s,\
        faults,warnings,notices,missing,error";
    assert_eq!(rows[0], head);
    for (case, row) in rows[1..7].iter().enumerate() {
        let fields: Vec<&str> = row.split(',').collect();
        let strokes = 200.0 + 80.0 * case as f64;
        assert_eq!(fields[..3], [case.to_string().as_str(), "24", &strokes.to_string()]);
        let speed: f64 = fields[3].parse().expect("a number");
        assert!((speed - 360.0 * strokes / 60.0 / 2400.0).abs() < 1e-12, "{row}");
        assert_eq!((fields[4], fields[7], fields[8]), ("0", "", ""), "{row}");
    }
    for row in &rows[7..] {
        assert!(row.contains(",2,") && row.contains(",,,,,") && row.contains("`gear.teeth`"), "{row}");
    }
    let about = fs::read_to_string(folder.path().join("s/columns.csv")).expect("columns");
    assert!(about.contains("work_speed.peak_deg_per_s,deg/s,largest magnitude"), "{about}");
}

#[test]
fn shares_together_are_the_whole_and_a_stopped_study_goes_on() {
    let folder = folder();
    let whole = folder.path().join("whole");
    swept(folder.path(), &["--out", "whole"]).done();
    let mut shared: Vec<String> = Vec::new();
    for shard in ["1/3", "2/3", "3/3"] {
        let name = format!("out/round_study/shard_{}", shard.replace('/', "_of_"));
        swept(folder.path(), &["--shard", shard]).done();
        shared.extend(rows(&folder.path().join(name)).split_off(1));
    }
    let case = |row: &String| row.split(',').next().and_then(|case| case.parse::<u64>().ok());
    shared.sort_by_key(case);
    assert_eq!(shared, rows(&whole)[1..]);
    // A study that is not complete, with rows in the order in which they were found and one that a kill cut off.
    let stopped = folder.path().join("stopped");
    fs::create_dir(&stopped).expect("a folder");
    let record = fs::read_to_string(whole.join("run.json")).expect("a record");
    let mut record: serde_json::Map<String, serde_json::Value> = serde_json::from_str(&record).expect("JSON");
    record.remove("files");
    record.insert("complete".to_owned(), false.into());
    fs::write(stopped.join("run.json"), serde_json::to_string(&record).expect("JSON")).expect("written");
    let all = rows(&whole);
    fs::write(stopped.join("rows.csv"), format!("{}\n{}\n{}\n{}", all[0], all[9], all[2], &all[5][..9]))
        .expect("written");
    fs::copy(whole.join("columns.csv"), stopped.join("columns.csv")).expect("copied");
    let changed = swept(folder.path(), &["--out", "stopped", "--set", "gear.face_width_mm=5"]);
    changed.failed(1, &["rows of another scene, flank or version"]);
    swept(folder.path(), &["--out", "stopped"]).done();
    for name in ["rows.csv", "columns.csv"] {
        let read = |folder: &Path| fs::read_to_string(folder.join(name)).expect("a file");
        assert_eq!(read(&stopped), read(&whole), "{name}");
    }
}

/// A study that many processes make of a few hundred cases of axes, into the folder `s`.
#[cfg(unix)]
fn long_study(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearcut"));
    let range = "machine.double_strokes_per_minute=200.0..600.0/150";
    command.args(&SWEEP[..7]).args(["--range", range]).args(&SWEEP[9..]).args(["--out", "s"]);
    command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Killed at twenty moments, wherever it is then: no row is lost, none comes twice, and at the end the files are those
/// of a study that nobody disturbed, byte by byte.
#[cfg(unix)]
#[test]
fn a_killed_study_goes_on() {
    let folder = folder();
    let path = folder.path().join("s/rows.csv");
    let lines = || fs::read_to_string(&path).map_or(0, |text| text.lines().count());
    // Steps of Lehmer's generator: moments that have nothing to do with each other.
    let mut random = 20_u64;
    let mut cut_off = 0;
    for _ in 0..20 {
        let before = lines();
        random = random * 48_271 % 0x7fff_ffff;
        let mut child = long_study(folder.path()).spawn().expect("started");
        // So many rows on, and some moment after the last of them: a fast machine is still at work then, too.
        let enough = before + (random % 8) as usize;
        while lines() < enough && child.try_wait().expect("asked").is_none() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        std::thread::sleep(std::time::Duration::from_micros(random / 8 % 20_000));
        child.kill().expect("killed");
        cut_off += usize::from(child.wait().expect("ended").code().is_none());
        assert!(lines() >= before, "rows are lost");
    }
    assert!(cut_off > 5, "only {cut_off} runs were still at work");
    assert!(long_study(folder.path()).status().expect("a run").success());
    let read = |folder: &Path, name: &str| fs::read(folder.join("s").join(name)).expect("a file");
    let undisturbed = self::folder();
    assert!(long_study(undisturbed.path()).status().expect("a run").success());
    for name in ["rows.csv", "columns.csv"] {
        assert!(read(folder.path(), name) == read(undisturbed.path(), name), "{name}");
    }
    assert_eq!(lines(), 301);
}

/// A second run into the same folder is refused while the first one works, which it does not disturb.
#[cfg(unix)]
#[test]
fn a_folder_takes_one_run_at_once() {
    let folder = folder();
    let mut child = long_study(folder.path()).spawn().expect("started");
    while !folder.path().join("s/rows.csv").exists() {
        assert!(child.try_wait().expect("a child").is_none(), "the study ended without rows");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let range = "machine.double_strokes_per_minute=200.0..600.0/150";
    let again = [&SWEEP[..7], &["--range", range], &SWEEP[9..], &["--out", "s"]].concat();
    gearcut_in(folder.path(), &again).failed(1, &["another run", "--out"]);
    assert!(child.wait().expect("ended").success());
    assert_eq!(rows(&folder.path().join("s")).len(), 301);
}

/// A disk that is full ends the study with the file's name; the rows before it stay, and the study goes on when there
/// is room. A limit on the length of files stands for the disk.
#[cfg(unix)]
#[test]
fn a_full_disk_loses_no_row() {
    let folder = folder();
    let gearcut = env!("CARGO_BIN_EXE_gearcut");
    let range = "machine.double_strokes_per_minute=200.0..600.0/150";
    let study = [&SWEEP[..7], &["--range", range], &SWEEP[9..], &["--out", "s"]].concat();
    let script = format!("trap '' XFSZ; ulimit -f 40; exec {gearcut} \"$@\"");
    let full = Command::new("sh").args(["-c", &script, "gearcut"]).args(&study).current_dir(folder.path()).output();
    let full = full.expect("a run");
    let said = String::from_utf8(full.stderr).expect("UTF-8");
    assert!(full.status.code() == Some(1) && said.contains("rows.csv") && said.contains("too large"), "{said}");
    let there = rows(&folder.path().join("s")).len();
    assert!(there > 10 && there < 301, "{there} rows");
    gearcut_in(folder.path(), &study).done();
    assert_eq!(rows(&folder.path().join("s")).len(), 301);
}

#[test]
fn studies_that_are_none_say_why() {
    let folder = folder();
    let sweep =
        |more: &[&str]| gearcut_in(folder.path(), &[&["sweep", "round.toml", "--command", "axes"], more].concat());
    let grid = ["--grid", "gear.teeth=20,24"];
    let of = |keep: &'static str| sweep(&[&grid[..], &["--keep", keep, "--out", "a"]].concat());
    of("work_speed.peak")
        .failed(1, &["`work_speed.peak` is no quantity of these cases; did you mean operations.rough."]);
    of("axis_margn").failed(1, &["did you mean axis_margin?", "docs/quantities.md"]);
    let many = ["--range", "machine.back_off_mm=0.1..1.0/600000", "--keep", "axis_margin"];
    sweep(&[&grid[..], &many].concat()).failed(1, &["1200000 cases are more than 100000", "--most-cases 1200000"]);
    let wrong = ["--grid", "gear.teth=20,24", "--keep", "axis_margin", "--out", "b"];
    sweep(&wrong).failed(1, &["the first 2 cases all fail", "gear.teeth"]);
    sweep(&["--range", "gear.teeth=9..3/2", "--keep", "axis_margin"]).failed(2, &["the first end must be the smaller"]);
    sweep(&[&grid[..], &["--keep", "axis_margin", "--shard", "5/8"]].concat())
        .failed(1, &["2 cases have no share 5 of 8", "--shard"]);
    let file = |text: &str| {
        fs::write(folder.path().join("study.toml"), text).expect("written");
        gearcut_in(folder.path(), &["study", "study.toml"])
    };
    let head = "[study]\nscene = \"round.toml\"\ncommand = \"axes\"\n";
    file(&format!("{head}kep = [\"axis_margin\"]\n")).failed(1, &["study.toml", "line 4", "kep", "expected one of"]);
    let parameter = "keep = [\"axis_margin\"]\n[[parameter]]\nkey = \"gear.teeth\"\n";
    file(&format!("{head}{parameter}"))
        .failed(1, &["study.toml: parameter `gear.teeth`", "no values, no range and no normal distribution"]);
    file(&format!("{head}{parameter}values = [20, 24]\nlog = true\n")).failed(1, &["count and log belong to a range"]);
    file(&format!("{head}{parameter}normal = [20.0, 0.0]\n")).failed(1, &["must be above 0"]);
    file(&format!("{head}{parameter}normal = [20.0, 1.0]\ncount = 3\n")).failed(1, &["normal excludes values"]);
    file(&format!("{head}{parameter}values = [20, 24]\n")).done().says(&["2 cases; their rows are in"]);
}

/// The speed of the work is that of the strokes alone, 360 n / 60 / 2,400 deg/s, so that they make all of its variance
/// and the cutter none: that of the law over 200 to 600 strokes a minute. A share of a study has no page.
#[test]
fn a_page_says_what_moves_what() {
    let folder = folder();
    let cutters = ["--grid", "tool.shaper_cutter.teeth=20,25,30"];
    let sweep = |out: &str, more: &[&str]| {
        gearcut_in(folder.path(), &[&SWEEP[..5], &cutters, &SWEEP[7..], &["--out", out], more].concat()).done();
        folder.path().join(out)
    };
    let whole = sweep("whole", &[]);
    let effects = fs::read_to_string(whole.join("tables/effects.csv")).expect("effects");
    let cells = |line: &str| -> Vec<String> { line.split(',').map(str::to_owned).collect() };
    let effects: Vec<Vec<String>> = effects.lines().map(cells).collect();
    let number = |row: usize, column: usize| effects[row][column].parse::<f64>().expect("a number");
    assert_eq!(effects[0][1..3], ["key", "first_order_share_percent"]);
    assert_eq!([&effects[1][1], &effects[2][1]], ["tool.shaper_cutter.teeth", "machine.double_strokes_per_minute"]);
    assert!(number(1, 2).abs() < 1e-9 && number(1, 8) < 1e-12, "{effects:?}");
    assert!((number(2, 2) - 100.0).abs() < 1e-9 && (number(2, 8) - 1.0).abs() < 1e-12, "{effects:?}");
    let page = fs::read_to_string(whole.join("report.html")).expect("a page");
    for words in [
        "What moves what",
        "Along the parameters",
        "Case by case",
        "Two parameters together",
        "18 cases of 2 parameters",
        "<title>case 17: tool.shaper_cutter.teeth=30; machine.double_strokes_per_minute=600</title>",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let results = fs::read_to_string(whole.join("results.json")).expect("results");
    let results: serde_json::Value = serde_json::from_str(&results).expect("JSON");
    assert_eq!(results["headline"]["cases"]["value"], 18);
    let share = sweep("share", &["--shard", "1/2"]);
    assert!(share.join("rows.csv").exists() && !share.join("report.html").exists());
}

/// Dexels half a millimetre apart see no scallop: rows, page, table and terminal say that there is none, and why. A
/// case that cannot be made is said there as well. Both others are as fast, and the page leads to the scene of the one
/// with the smaller deviation.
#[test]
fn what_has_no_value_is_said() {
    let folder = folder();
    let keep = [
        "--keep",
        "operations.finish.cycle_time,scallop_height,F_al*",
        "--grid",
        "gear.face_width_mm=4,5,-1",
        "--out",
        "s",
    ];
    let swept = gearcut_in(folder.path(), &[&["sweep", "round.toml", "--quiet"], &keep[..]].concat());
    assert!(swept.err.contains("2 cases have no value of kept quantities"), "{}", swept.err);
    assert!(
        swept.err.contains("scallop_height") && swept.err.contains("1 of 3 cases could not be made"),
        "{}",
        swept.err
    );
    swept.done().says(&["3 cases, 1 of them failed"]);
    let rows = rows(&folder.path().join("s"));
    assert!(rows[0].contains("scallop_height_um,F_alpha_um,faults"), "{}", rows[0]);
    for row in &rows[1..3] {
        assert!(row.contains(",scallop_height: no cusp between facets"), "{row}");
    }
    let missing = fs::read_to_string(folder.path().join("s/tables/missing.csv")).expect("a table");
    assert!(missing.contains("scallop_height,2,no cusp between facets"), "{missing}");
    let page = fs::read_to_string(folder.path().join("s/report.html")).expect("a page");
    for words in ["What has no value", "no cusp between facets", "could not be made", "`gear.face_width_mm`"] {
        assert!(page.contains(words), "{words}");
    }
    let deviation = |case: usize| rows[case + 1].split(',').nth(4).and_then(|cell| cell.parse::<f64>().ok());
    let best = u32::from(deviation(0) > deviation(1));
    let scene = format!("cases/case_{best}.toml");
    assert!(page.contains(&format!("<a href=\"{scene}\"><circle")), "{scene}: {rows:?}");
    let text = fs::read_to_string(folder.path().join("s").join(&scene)).expect("the scene of the best case");
    assert!(text.contains(&format!("face_width_mm = {}.0\n", 4 + best)), "{text}");
    gearcut_in(&folder.path().join("s"), &["check", &scene]).done();
}

/// Nominal gears are m (z_1 + z_2) / 2 apart, and 2 da tan(alpha) more play comes of da more distance, along their
/// pitch circles (to first order; 20 um are a hundredth of what the second one would see).
#[test]
fn pairs_are_cases() {
    let folder = folder();
    let sweep = |more: &[&str]| {
        let pair = ["sweep", "round.toml", "--quiet", "--command", "pair", "--set", "pair.flanks=nominal"];
        gearcut_in(folder.path(), &[&pair[..], more].concat())
    };
    let grid = ["--grid", "mate.gear.teeth=24,30", "--grid", "pair.center_distance_error_um=0,20"];
    let keep = ["--keep", "pair.center_distance,backlash.smallest", "--out", "p"];
    sweep(&[&["--mate", "round.toml"], &grid[..], &keep].concat()).done().says(&["4 cases; their rows"]);
    let rows = rows(&folder.path().join("p"));
    assert!(
        rows[0].starts_with("case,mate.gear.teeth,pair.center_distance_error_um,pair.center_distance_mm,"),
        "{rows:?}"
    );
    let number = |row: usize, column: usize| -> f64 {
        rows[row].split(',').nth(column).and_then(|cell| cell.parse().ok()).expect("a number")
    };
    for (row, teeth) in [(1, 24.0), (3, 30.0)] {
        assert!((number(row, 3) - 3.0 * (24.0 + teeth) / 2.0).abs() < 1e-9, "{rows:?}");
        let more_um = number(row + 1, 4) - number(row, 4);
        let expected_um = 2.0 * 20.0 * 20_f64.to_radians().tan();
        assert!((more_um - expected_um).abs() < 0.01 * expected_um, "{more_um} um, not {expected_um}");
    }
    let about = fs::read_to_string(folder.path().join("p/columns.csv")).expect("columns");
    assert!(about.contains("mate.gear.teeth,,Number of teeth"), "{about}");
    let wrong = |more: &[&str]| sweep(&[more, &keep[..3], &["q"]].concat());
    wrong(&grid).failed(1, &["a pair is a gear and its mate"]);
    wrong(&["--mate", "round.toml", "--grid", "pair.center_distanc_error_um=0,20"]).failed(1, &["no such option"]);
}

/// Every shipped study is read, and its cases are scenes.
#[test]
fn shipped_studies_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("ovals");
    let share = ["study", "studies/axes_of_ovals.toml", "--quiet", "--shard", "1/40", "--out"];
    gearcut(&[&share[..], &[out.to_str().expect("a path")]].concat()).done().says(&["4 cases; their rows"]);
    let rows = rows(&out);
    assert!(rows[1].contains("shaping_normal") && rows[4].contains("shaping_traditional"), "{rows:?}");
    gearcut::study::file::read(Path::new("studies/finishing_feed.toml"), 12).expect("a study of 12 cases");
}
