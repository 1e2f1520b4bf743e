//! Runs that are stopped, killed, doubled or short of disk: what was there is there afterwards, and nothing hidden is
//! left.

use crate::fixtures::command::gearcut;
use gearcut::measure::topography::Surface;
use gearcut::output::folder::OutputFolder;
use gearcut::output::surface_files::{Format, SurfaceFile, write_surface};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const PAPER: &str = "scenes/shaping/elliptical_normal.toml";
const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";
/// Fields so coarse that a whole gear takes moments.
const COARSE: [&str; 12] = [
    "--set",
    "operation=[{name='finish',strokes_per_revolution=480}]",
    "--set",
    "fields.flank.profile_spacing_um=500",
    "--set",
    "fields.flank.lead_spacing_um=5000",
    "--set",
    "fields.chips.spacing_mm=0.4",
    "--set",
    "fields.blank.spacing_mm=2",
    "--set",
    "picture=[]",
];

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder exists");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("listed").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A complete result of an earlier run, with one file.
fn earlier(path: &Path) {
    let folder = OutputFolder::create(path).expect("free name");
    std::fs::write(folder.path("precious.txt").expect("writable"), "precious").expect("writable");
    folder
        .write_json("run.json", &json!({"program": "gearcut", "command": "cut", "complete": true}))
        .expect("writable");
    folder.finish().expect("nothing in the way");
}

/// Whether the folder is what [`earlier`] made.
fn is_earlier(path: &Path) -> bool {
    names_in(path) == ["precious.txt", "run.json"]
        && std::fs::read(path.join("precious.txt")).expect("a file") == b"precious"
}

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearcut"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// Waits until something is so; `false` if the child ended before.
fn wait_until(child: &mut Child, is_so: impl Fn() -> bool) -> bool {
    let end = Instant::now() + Duration::from_secs(120);
    while Instant::now() < end {
        if is_so() {
            return true;
        }
        if child.try_wait().expect("a child").is_some() {
            return false;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("nothing happened in two minutes");
}

/// Starts a long run to `out` and waits until its first maps stand in the hidden folder.
fn started(out: &Path) -> Child {
    let command = ["cut", PAPER, "--backend", "cpu", "--set", "fields.flank.lead_spacing_um=20", "--out"];
    let mut child = program().args(command).arg(out).spawn().expect("the program starts");
    let name = out.file_name().expect("a name").to_str().expect("UTF-8");
    let maps = out.with_file_name(format!(".{name}.gearcut/new/allowance"));
    let has_maps = || std::fs::read_dir(&maps).is_ok_and(|mut files| files.next().is_some());
    assert!(wait_until(&mut child, has_maps), "the run ended before it could be stopped");
    child
}

/// Sends SIGINT, as Ctrl-C does, and waits for the end.
fn ctrl_c(child: Child) -> Output {
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(kill.success());
    child.wait_with_output().expect("an end")
}

fn coarse_cut(out: &Path) -> crate::fixtures::command::Outcome {
    let out = out.to_str().expect("a path");
    gearcut(&[&["cut", ROUND, "--quiet", "--backend", "cpu", "--out", out], &COARSE[..]].concat())
}

#[test]
fn ctrl_c_keeps_the_finished_flanks_beside_the_earlier_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    earlier(&out);
    let stopped = ctrl_c(started(&out));
    assert_eq!(stopped.status.code(), Some(130));
    assert!(is_earlier(&out), "a partial result replaced a complete one");
    assert_eq!(names_in(folder.path()), ["gear", "gear.partial"], "nothing hidden is left");
    let partial = folder.path().join("gear.partial");
    let results = read_json(&partial.join("results.json"));
    assert_eq!(results["complete"], false);
    assert_eq!(read_json(&partial.join("run.json"))["complete"], false);
    let maps = std::fs::read_dir(partial.join("allowance")).expect("maps").count();
    assert!(maps >= 2, "the finished flanks' maps are there");
    assert!(results["headline"]["smallest_stock"]["value"].is_number());
    let told = String::from_utf8(stopped.stderr).expect("UTF-8");
    let last = told.lines().last().expect("words");
    assert!(last.contains(&format!("finished is in {}", partial.display())) && last.contains("untouched"), "{last}");

    coarse_cut(&out).done();
    assert_eq!(read_json(&out.join("run.json"))["complete"], true);
    assert_eq!(names_in(folder.path()), ["gear"], "a complete run removes the partial one");
}

#[test]
fn a_second_run_to_the_same_folder_is_refused_until_the_first_one_is_dead() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let mut first = started(&out);
    let process = format!("(process {})", first.id());
    coarse_cut(&out).failed(1, &["another run of gearcut", &process, "--out"]);
    first.kill().expect("killed");
    first.wait().expect("an end");
    assert_eq!(names_in(folder.path()), [".gear.gearcut"], "a killed run leaves nothing under the final name");
    coarse_cut(&out).done();
    assert_eq!(names_in(folder.path()), ["gear"], "what the killed run left is removed");
}

/// Every file below a folder with its bytes; of `run.json`, which holds times, that it is there.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let has_times = path.file_name().is_some_and(|name| name == "run.json");
                let bytes = if has_times { Vec::new() } else { std::fs::read(&path).expect("a file") };
                found.insert(path, bytes);
            }
        }
    }
    found
}

/// Runs a command again and again into the same folder, killed after parts of the time that it needs.
fn killed_at_any_time(command: &[&str], percents: &[u32]) {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let run = || program().args(command).arg("--out").arg(&out).spawn().expect("the program starts");
    let clock = Instant::now();
    assert!(run().wait().expect("an end").success());
    let whole_run = clock.elapsed();
    let written = files(&out);
    assert!(written.len() > 10);
    for percent in percents {
        let mut child = run();
        std::thread::sleep(whole_run * *percent / 100);
        child.kill().expect("killed, or ended already");
        child.wait().expect("an end");
        assert!(files(&out) == written, "killed after {percent} % of its time");
    }
    assert!(run().wait().expect("an end").success());
    assert!(files(&out) == written);
    assert_eq!(names_in(folder.path()), ["gear"], "the last run swept up after the others");
}

/// The limit on the size of files stands for the full disk: both make `write` fail in the middle of a file.
#[test]
fn a_write_that_fails_names_the_file_and_leaves_the_earlier_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("gear");
    let run = |out: &Path| {
        let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"";
        let ended = Command::new("sh")
            .args(["-c", limited, env!("CARGO_BIN_EXE_gearcut"), "cut", ROUND, "--quiet", "--backend", "cpu", "--out"])
            .arg(out)
            .args(COARSE)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("a shell");
        assert_eq!(ended.status.code(), Some(1));
        String::from_utf8(ended.stderr).expect("UTF-8")
    };
    let told = run(&out);
    assert!(told.contains(&format!("cannot write {}/", out.display())), "the file by its final name: {told}");
    assert!(told.contains("File too large") && told.contains("nothing was left behind"), "{told}");
    assert_eq!(names_in(folder.path()), Vec::<String>::new());
    earlier(&out);
    let told = run(&out);
    assert!(told.contains(&format!("earlier results in {} are untouched", out.display())), "{told}");
    assert!(is_earlier(&out));
    assert_eq!(names_in(folder.path()), ["gear"]);
}

#[test]
fn ctrl_c_leaves_nothing_of_axis_tables() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("tables");
    let mut child = program().args(["axes", PAPER, "--out"]).arg(&out).spawn().expect("the program starts");
    let hidden = folder.path().join(".tables.gearcut/new");
    assert!(wait_until(&mut child, || hidden.exists()), "the command ended before it could be stopped");
    assert_eq!(ctrl_c(child).status.code(), Some(130));
    assert_eq!(names_in(folder.path()), Vec::<String>::new());
}

/// A pair of round gears, cut in moments.
const COARSE_PAIR: [&str; 6] = ["pair", ROUND, "--mate", "36", "--set-a", "fields.flank.profile_spacing_um=50"];

#[test]
fn ctrl_c_leaves_no_temporary_name_of_a_saved_surface() {
    let folder = tempfile::tempdir().expect("a folder");
    let input = folder.path().join("ramp.npy");
    let surface =
        Surface::new(1500, 1500, 1.0, 1.0, (0..1500 * 1500).map(|i| f64::from(i % 977) * 0.123_456_789).collect());
    let file = SurfaceFile { surface: surface.expect("a surface"), notes: Vec::new() };
    write_surface(&input, Format::Npy, &file).expect("there is room");
    let temporary = || names_in(folder.path()).iter().any(|name| name.starts_with(".gearcut-"));
    let mut saved: Vec<PathBuf> = Vec::new();
    for attempt in 0..20 {
        let outs: Vec<PathBuf> = (0..4).map(|k| folder.path().join(format!("saved_{attempt}_{k}.npy"))).collect();
        let mut command = program();
        command.args(["texture", "--form", "none"]).arg(&input);
        for out in &outs {
            command.arg("--save").arg(out);
        }
        let mut child = command.spawn().expect("the program starts");
        saved.extend(outs);
        if wait_until(&mut child, temporary) {
            assert_eq!(ctrl_c(child).status.code(), Some(130));
            assert!(!temporary(), "{:?}", names_in(folder.path()));
            assert!(!saved[saved.len() - 1].exists(), "it was stopped before the last file");
            return;
        }
    }
    panic!("the writing of a file was never met");
}

mod slow {
    use super::*;

    #[test]
    fn pairs_killed_at_any_time_leave_a_whole_result() {
        killed_at_any_time(&[&COARSE_PAIR[..], &["--positions", "900"]].concat(), &[30, 95]);
    }

    #[test]
    fn cuts_killed_at_any_time_leave_a_whole_result() {
        killed_at_any_time(&[&["cut", ROUND, "--quiet", "--backend", "cpu"], &COARSE[..]].concat(), &[50, 95]);
    }

    #[test]
    fn axis_tables_killed_at_any_time_stay_whole() {
        killed_at_any_time(&["axes", ROUND], &[5, 40, 60, 80, 90, 95, 98, 100]);
    }

    #[test]
    fn ctrl_c_ends_a_pair_at_once_in_every_stage() {
        for stage in ["cut gear A", "roll", "pictures"] {
            let folder = tempfile::tempdir().expect("a folder");
            let out = folder.path().join("rolled");
            let mut child = program()
                .args(COARSE_PAIR)
                .args(["--positions", "2000", "--json", "--out"])
                .arg(&out)
                .spawn()
                .expect("it starts");
            let mut events = BufReader::new(child.stderr.take().expect("piped")).lines().map_while(Result::ok);
            let begins = |line: String| line.contains("step_started") && line.contains(&format!("\"{stage}\""));
            assert!(events.any(begins), "{stage} never began");
            let clock = Instant::now();
            let rest = std::thread::spawn(move || events.last());
            assert_eq!(ctrl_c(child).status.code(), Some(130), "in {stage}");
            let took = clock.elapsed();
            // A second on an idle machine; others may compute as well.
            assert!(took < Duration::from_secs(5), "{stage} went on for {took:?}");
            let told = rest.join().expect("a reader").expect("a last line");
            assert!(told.contains("stopped"), "{told}");
            assert_eq!(names_in(folder.path()), Vec::<String>::new(), "in {stage}");
        }
    }
}
