//! Whole runs that are killed, and whole runs on a full disk, at every step on the disk: the earlier result or the new
//! one stands, both whole, and nothing hidden is left after the next run.
//!
//! A killed process does nothing more, not even its clean-up; so from the chosen step on every step is refused. A full
//! disk refuses what writes, and does the rest.

use crate::fixtures::command::read_json;
use gearcut::output::folder::OutputFolder;
use gearcut::steps::parts::{Part, Parts};
use gearcut::{Error, Job};
use gearcut_texture::disk_steps::{DiskStep, watch_below};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

const SETTINGS: [&str; 9] = [
    "gear.teeth=9",
    "operation.rough.strokes_per_revolution=60",
    "gear.bore_diameter_mm=5",
    "fields.flank.profile_spacing_um=300",
    "fields.flank.lead_spacing_um=10000",
    "fields.chips.spacing_mm=1",
    "fields.blank.spacing_mm=2",
    "picture=[]",
    "texture=[{tooth=1,side='left',length_profile_mm=1,length_lead_mm=10}]",
];

const RECORD: &str = "run.json";

type Files = Vec<(PathBuf, Vec<u8>)>;

/// A small gear with so many finishing strokes, cut into a folder.
fn cut(strokes: u32, parts: Parts, out: &Path) -> Result<bool, Error> {
    let strokes = format!("operation.finish.strokes_per_revolution={strokes}");
    let settings: Vec<String> = SETTINGS.iter().map(|&set| set.to_owned()).chain([strokes]).collect();
    let scene = gearcut::load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings).expect("a scene");
    let done = Job::new(scene)?.run().only(parts).into_folder(out)?;
    Ok(done.findings.complete)
}

/// What happens at the chosen step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    /// The process is killed there.
    Death,
    /// The disk is full from there on.
    Full,
    /// The system refuses this write and does the later ones.
    OneWrite,
}

/// A run with a fault at step `n` of those that the fault can meet; whether the fault was met.
fn with_fault(
    folder: &Path,
    fault: Fault,
    n: usize,
    run: impl FnOnce() -> Result<bool, Error>,
) -> (Result<bool, Error>, usize) {
    let taken = Arc::new(AtomicUsize::new(0));
    let counter = taken.clone();
    let watch = watch_below(
        folder,
        Arc::new(move |step: DiskStep, _: &Path| {
            let writes = matches!(step, DiskStep::Create | DiskStep::Write);
            if fault != Fault::Death && !writes {
                return Ok(());
            }
            let number = counter.fetch_add(1, Ordering::SeqCst);
            let fails = if fault == Fault::OneWrite { number == n } else { number >= n };
            if fails { Err(io::ErrorKind::StorageFull.into()) } else { Ok(()) }
        }),
    );
    let outcome = run();
    drop(watch);
    (outcome, taken.load(Ordering::SeqCst))
}

/// One call forces all files to the disk, and it is a stage of the run, whose time the record tells: no less than all
/// stages together, no more than the caller waits.
#[test]
fn files_go_to_the_disk_at_once_and_within_the_time_of_the_run() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let out = place.path().join("gear");
    let syncs = Arc::new(AtomicUsize::new(0));
    let counter = syncs.clone();
    let watch = watch_below(
        place.path(),
        Arc::new(move |step: DiskStep, _: &Path| {
            counter.fetch_add(usize::from(step == DiskStep::Sync), Ordering::SeqCst);
            Ok(())
        }),
    );
    let started = Instant::now();
    assert!(cut(60, Parts::of([Part::Maps]), &out).expect("a sound disk"));
    let waited_s = started.elapsed().as_secs_f64();
    drop(watch);
    let record = read_json(&out.join(RECORD));
    let files = record["sha256"].as_object().expect("checksums").len();
    // The file system, the record and its folder, the folder of the results.
    let syncs = syncs.load(Ordering::SeqCst);
    assert!(syncs <= 4 || !cfg!(target_os = "linux"), "{syncs} calls for {files} files");
    assert!(files > 20, "{files} files");
    let stages = record["stages"].as_array().expect("stages");
    assert!(stages.iter().any(|stage| stage["stage"] == "to the disk"), "{stages:?}");
    let stages_s: f64 = stages.iter().map(|stage| stage["wall_s"].as_f64().expect("seconds")).sum();
    let wall_s = record["wall_time_s"].as_f64().expect("seconds");
    assert!(stages_s <= wall_s && wall_s <= waited_s, "stages {stages_s} s, run {wall_s} s, waited {waited_s} s");
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the test's own folder");
    let mut names: Vec<_> = entries.map(|e| e.expect("listed").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Files below a folder with their bytes.
fn files(folder: &Path) -> Files {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let bytes = std::fs::read(&path).expect("a file");
                found.push((path.strip_prefix(folder).expect("inside").to_owned(), bytes));
            }
        }
    }
    found.sort();
    found
}

/// Whether a folder holds these files and no others, and its record the checksums of these; times differ.
fn holds(folder: &Path, wanted: &Files) -> bool {
    let but_record = |files: &Files| -> Files { files.iter().filter(|(path, _)| path != RECORD).cloned().collect() };
    let record: serde_json::Value = wanted
        .iter()
        .find(|(path, _)| path == RECORD)
        .map(|(_, bytes)| serde_json::from_slice(bytes))
        .expect("a record")
        .expect("JSON");
    but_record(&files(folder)) == but_record(wanted) && read_json(&folder.join(RECORD))["sha256"] == record["sha256"]
}

fn put(files: &Files, folder: &Path) {
    for (path, bytes) in files {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("the test's own folder");
        std::fs::write(path, bytes).expect("the test's own folder");
    }
}

/// Runs with a fault at each of the steps that `chosen` names among so many; the number of runs.
fn at_steps(fault: Fault, parts: Parts, chosen: impl Fn(usize, usize) -> bool) -> usize {
    let place = tempfile::tempdir().expect("a folder");
    let whole = |strokes: u32| {
        let out = place.path().join(format!("whole_{strokes}"));
        let (done, steps) = with_fault(place.path(), fault, usize::MAX, || cut(strokes, parts, &out));
        assert!(done.expect("a sound disk"));
        (files(&out), steps)
    };
    let ((early, _), (late, steps)) = (whole(60), whole(90));
    assert!(!holds(&place.path().join("whole_60"), &late));
    let mut runs = 0;
    for n in (0..steps).filter(|&n| chosen(n, steps)) {
        let place = tempfile::tempdir().expect("a folder");
        let out = place.path().join("gear");
        put(&early, &out);
        let (outcome, taken) = with_fault(place.path(), fault, n, || cut(90, parts, &out));
        assert!(taken > n, "step {n} of {steps} was not met");
        let told = match &outcome {
            Ok(complete) => format!("complete: {complete}"),
            Err(error) => error.to_string(),
        };
        let is_late = holds(&out, &late);
        assert!(is_late || holds(&out, &early), "{fault:?} at step {n} of {steps} left a mixture; {told}");
        // What is less than whole stands beside it and says so.
        assert!(!matches!(outcome, Ok(true)) || is_late, "{fault:?} at step {n}: {told}");
        drop(OutputFolder::create(&out).expect("the next run opens"));
        assert!(holds(&out, if is_late { &late } else { &early }), "{fault:?} at step {n}: the next run changed it");
        let names = names_in(place.path());
        let partial = names.iter().any(|name| name == "gear.partial");
        assert_eq!(partial, matches!(outcome, Ok(false)), "{fault:?} at step {n}: {names:?}; {told}");
        assert!(names.iter().all(|name| ["gear", "gear.partial"].contains(&name.as_str())), "{n}: {names:?}; {told}");
        runs += 1;
    }
    println!("{fault:?}: {runs} of {steps} steps on the disk");
    runs
}

/// Every fourth step while files are written, and each of the last, which give them their names.
fn last_and_some(n: usize, steps: usize) -> bool {
    n + 12 > steps || n.is_multiple_of(4)
}

mod slow {
    use super::*;

    #[test]
    fn a_run_that_is_killed_at_any_step_leaves_the_earlier_or_the_new_result() {
        let runs = at_steps(Fault::Death, Parts::of([]), last_and_some);
        assert!(runs > 15, "{runs}");
    }

    #[test]
    fn a_disk_that_fills_at_any_write_costs_no_earlier_result() {
        let runs = at_steps(Fault::Full, Parts::of([]), last_and_some);
        assert!(runs > 15, "{runs}");
        // A write that fails alone.
        let runs = at_steps(Fault::OneWrite, Parts::of([]), |n, _| n % 4 == 1);
        assert!(runs > 4, "{runs}");
    }

    /// Everything is written: each step from the end of the cut to the names, and every 300th before.
    #[test]
    fn runs_that_write_everything_lose_nothing_either() {
        let all = Parts::of([Part::Maps, Part::Meshes, Part::Axes, Part::Report]);
        for fault in [Fault::Death, Fault::OneWrite] {
            let runs = at_steps(fault, all, |n, steps| n + 6 > steps || n % 300 == 0);
            assert!(runs >= 7, "{runs}");
        }
    }
}
