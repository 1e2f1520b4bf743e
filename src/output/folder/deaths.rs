//! Runs that die at every step on the disk, and disks that fail once at every step.
//!
//! A killed process does nothing more, not even its clean-up; so from the chosen step on, every step is refused. What a
//! dead run leaves is then what a new run must cope with.

use super::steps::{Disk, Steps};
use super::{OutputFolder, RUN_RECORD};
use gearcut_core::Result;
use serde_json::json;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// What happens at the chosen step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum DiskFault {
    /// The process is gone: this step and all later ones do not happen.
    Death,
    /// The same, but a removal is half done.
    DeathHalfway,
    /// The system refuses this step and does the later ones.
    Refusal,
}

/// A disk that counts its steps and has a fault at one of them.
#[derive(Debug, Clone)]
struct FaultyDisk {
    taken: Arc<AtomicU32>,
    fault_at: u32,
    fault: DiskFault,
    /// Whether two names can be exchanged here.
    exchanges: bool,
}

impl FaultyDisk {
    fn new(fault_at: u32, fault: DiskFault, exchanges: bool) -> Self {
        Self { taken: Arc::default(), fault_at, fault, exchanges }
    }

    fn step(&self) -> io::Result<()> {
        let step = self.taken.fetch_add(1, Ordering::SeqCst);
        let fails = if self.fault == DiskFault::Refusal { step == self.fault_at } else { step >= self.fault_at };
        if fails { Err(io::Error::other("the disk gave up")) } else { Ok(()) }
    }

    fn has_failed(&self) -> bool {
        self.taken.load(Ordering::SeqCst) > self.fault_at
    }
}

impl Steps for FaultyDisk {
    fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.step().and_then(|()| Disk.create_folder(path))
    }

    fn open_lock(&self, path: &Path) -> io::Result<File> {
        self.step().and_then(|()| Disk.open_lock(path))
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.step().and_then(|()| Disk.rename(from, to))
    }

    fn exchange(&self, one: &Path, other: &Path) -> io::Result<bool> {
        self.step()?;
        if self.exchanges { Disk.exchange(one, other) } else { Ok(false) }
    }

    fn sync_file(&self, path: &Path) -> io::Result<()> {
        self.step().and_then(|()| Disk.sync_file(path))
    }

    fn sync_all(&self, folder: &Path) -> io::Result<bool> {
        self.step()?;
        if self.exchanges { Disk.sync_all(folder) } else { Ok(false) }
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.step().and_then(|()| Disk.sync_folder(path))
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        let first_to_fail = self.taken.load(Ordering::SeqCst) == self.fault_at;
        if first_to_fail && self.fault == DiskFault::DeathHalfway && path.join(RUN_RECORD).exists() {
            // The worst half: what is left no longer says that gearcut wrote it.
            fs::remove_file(path.join(RUN_RECORD))?;
        }
        self.step().and_then(|()| Disk.remove_folder(path))
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        self.step().and_then(|()| Disk.remove_file(path))
    }
}

/// A run to `path` whose only result is a word.
fn run(path: &Path, word: &str, complete: bool, disk: &FaultyDisk) -> Result<()> {
    let folder = OutputFolder::create_by(path, Box::new(disk.clone()))?;
    fs::write(folder.path("tables/result.txt")?, word).expect("the test's own folder");
    folder.write_json(RUN_RECORD, &json!({"program": "gearcut", "complete": complete}))?;
    if complete { folder.finish() } else { folder.finish_partial() }.map(drop)
}

/// The word of a whole result; nothing if there is none.
fn word(path: &Path) -> Option<String> {
    path.join(RUN_RECORD).exists().then(|| fs::read_to_string(path.join("tables/result.txt")).expect("a whole result"))
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the test's own folder");
    let mut names: Vec<_> = entries.map(|e| e.expect("listed").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn sound() -> FaultyDisk {
    FaultyDisk::new(u32::MAX, DiskFault::Death, true)
}

/// Calls `with_fault` with faults at step 0, 1, ... until the run gets by without meeting it; the number of steps.
fn at_every_step(fault: DiskFault, exchanges: bool, with_fault: impl Fn(&FaultyDisk)) -> u32 {
    for step in 0..100 {
        let disk = FaultyDisk::new(step, fault, exchanges);
        with_fault(&disk);
        if !disk.has_failed() {
            return step;
        }
    }
    panic!("a run takes more than 100 steps on the disk");
}

const DEATHS: [(DiskFault, bool); 4] = [
    (DiskFault::Death, true),
    (DiskFault::Death, false),
    (DiskFault::DeathHalfway, true),
    (DiskFault::DeathHalfway, false),
];

/// Where names can be exchanged, a whole result is under the name at every moment; elsewhere the next run, even one
/// that does nothing, puts it back.
#[test]
fn a_run_that_dies_at_any_step_loses_no_earlier_result() {
    for (fault, exchanges) in DEATHS {
        let steps = at_every_step(fault, exchanges, |disk| {
            let place = tempfile::tempdir().expect("a folder for the test");
            let path = place.path().join("gear");
            run(&path, "early", true, &sound()).expect("a sound disk");
            run(&path, "half", false, &sound()).expect("a sound disk");
            let died = run(&path, "late", true, disk);
            let left = names_in(place.path());
            assert!(died.is_ok() || disk.has_failed(), "{died:?}");
            if exchanges {
                assert!(word(&path).is_some(), "{disk:?} left {left:?}");
            }
            let idle = OutputFolder::create(&path).expect("the next run opens");
            drop(idle);
            let found = word(&path);
            assert!(found.as_deref() == Some("early") || found.as_deref() == Some("late"), "{disk:?}: {found:?}");
            assert!(died.is_err() || found.as_deref() == Some("late"), "{disk:?}: {found:?}");
            run(&path, "next", true, &sound()).expect("the next run ends well");
            assert_eq!(word(&path).as_deref(), Some("next"));
            assert_eq!(names_in(place.path()), ["gear"], "{disk:?} left {left:?}");
        });
        assert!(steps >= 8, "{steps} steps are too few to be all of them");
    }
}

/// A run that Ctrl-C ended early and that dies while it says so: the complete result is not touched at any moment, and
/// of the partial ones a whole one is left.
#[test]
fn a_partial_run_that_dies_at_any_step_loses_neither_result() {
    for (fault, exchanges) in DEATHS {
        at_every_step(fault, exchanges, |disk| {
            let place = tempfile::tempdir().expect("a folder for the test");
            let path = place.path().join("gear");
            let partial = place.path().join("gear.partial");
            run(&path, "early", true, &sound()).expect("a sound disk");
            run(&path, "half", false, &sound()).expect("a sound disk");
            let died = run(&path, "more than half", false, disk);
            assert_eq!(word(&path).as_deref(), Some("early"), "{disk:?}");
            drop(OutputFolder::create(&path).expect("the next run opens"));
            let found = word(&partial);
            assert!(
                found.as_deref() == Some("more than half") || died.is_err() && found.as_deref() == Some("half"),
                "{disk:?}: {found:?}"
            );
            assert_eq!(names_in(place.path()), ["gear", "gear.partial"], "{disk:?}");
        });
    }
}

/// The first run to a name dies: nothing or a whole result is there, and nothing hidden after the next run.
#[test]
fn a_first_run_that_dies_at_any_step_leaves_all_or_nothing() {
    for (fault, exchanges) in DEATHS {
        at_every_step(fault, exchanges, |disk| {
            let place = tempfile::tempdir().expect("a folder for the test");
            let path = place.path().join("gear");
            let died = run(&path, "late", true, disk);
            assert_eq!(path.exists(), word(&path).is_some(), "{disk:?}");
            assert!(died.is_err() || path.exists());
            run(&path, "next", true, &sound()).expect("the next run ends well");
            assert_eq!(names_in(place.path()), ["gear"], "{disk:?}");
        });
    }
}

/// The system refuses one step of a run that goes on: afterwards the earlier result or the new one is under the name,
/// and if the new one was whole, it is there or under the name that the error tells.
#[test]
fn a_refused_step_loses_nothing() {
    for exchanges in [true, false] {
        at_every_step(DiskFault::Refusal, exchanges, |disk| {
            let place = tempfile::tempdir().expect("a folder for the test");
            let path = place.path().join("gear");
            run(&path, "early", true, &sound()).expect("a sound disk");
            let outcome = run(&path, "late", true, disk);
            let kept = place.path().join("gear.new");
            if let Err(told) = &outcome {
                let told = told.to_string();
                assert!(told.contains("the disk gave up"), "{disk:?}: {told}");
                assert_eq!(word(&kept).is_some(), told.contains(&kept.display().to_string()), "{disk:?}: {told}");
            }
            match word(&path).as_deref() {
                Some("late") => assert!(!kept.exists()),
                Some("early") => {
                    assert!(outcome.is_err() && (!kept.exists() || word(&kept).as_deref() == Some("late")));
                }
                other => panic!("{disk:?}: {other:?}"),
            }
            run(&path, "next", true, &sound()).expect("the next run ends well");
            assert!(names_in(place.path()).iter().all(|name| name == "gear" || name == "gear.new"), "{disk:?}");
        });
    }
}

/// Two renames in a row are refused: neither the final name nor another one can be had. The results stay hidden and the
/// error tells where.
#[test]
fn results_without_any_name_stay_where_they_are() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("gear");
    let disk = FaultyDisk::new(4, DiskFault::Death, true);
    let told = run(&path, "late", true, &disk).expect_err("no rename is done").to_string();
    let hidden = place.path().join(".gear.gearcut/new");
    assert!(told.contains(&hidden.display().to_string()), "{told}");
    assert_eq!(word(&hidden).as_deref(), Some("late"));
}
