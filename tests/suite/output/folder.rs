//! The output folder: complete under its name or not there; only gearcut's own folders are replaced.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use gearcut::output::folder::OutputFolder;
use gearcut::{Error, Result};
use serde_json::json;

/// Makes a finished folder with one result in it.
fn run_into(path: &Path, result: &str) -> Result<()> {
    let folder = OutputFolder::create(path)?;
    fs::write(folder.path("tables/result.txt")?, result).expect("the subfolder was made");
    folder.write_json("run.json", &json!({"program": "gearcut"}))?;
    assert_eq!(folder.finish()?, path);
    Ok(())
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .expect("the folder exists")
        .map(|entry| entry.expect("listed").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn message(outcome: Result<impl Sized>) -> String {
    outcome.err().expect("this must be refused").to_string()
}

#[test]
fn a_folder_appears_only_when_finished_and_makes_its_parents() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("out/first_cut");
    let folder = OutputFolder::create(&path).expect("parents are made");
    let inside = folder.path("maps/finish/tooth_07_left.png").expect("subfolders are made");
    fs::write(&inside, "x").expect("writable");
    assert!(!path.exists() && !inside.starts_with(&path));
    folder.write_json("run.json", &json!({"program": "gearcut"})).expect("writable");
    folder.finish().expect("nothing in the way");
    assert_eq!(fs::read(path.join("maps/finish/tooth_07_left.png")).expect("moved along"), b"x");
    assert_eq!(names_in(path.parent().expect("it has one")), ["first_cut"]);
}

#[test]
fn an_earlier_run_is_replaced_whole() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    run_into(&path, "old").expect("free name");
    fs::write(path.join("only_in_the_old_one"), "x").expect("writable");
    run_into(&path, "new").expect("ours, so replaced");
    assert_eq!(fs::read_to_string(path.join("tables/result.txt")).expect("there"), "new");
    assert_eq!(names_in(&path), ["run.json", "tables"]);
    assert_eq!(names_in(place.path()), ["first_cut"]);
}

/// What was found can be said before the files of an earlier run are removed, which takes a second for a thousand.
#[test]
fn a_result_has_its_name_before_the_earlier_one_is_removed() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("gear");
    for cleared in [true, false] {
        run_into(&path, "old").expect("free name");
        let folder = OutputFolder::create(&path).expect("ours, so replaced");
        fs::write(folder.path("tables/result.txt").expect("made"), "new").expect("writable");
        folder.write_json("run.json", &json!({"program": "gearcut"})).expect("writable");
        let named = folder.take_name().expect("nothing in the way");
        let read = |path: &Path| fs::read_to_string(path.join("tables/result.txt")).expect("whole");
        assert_eq!([named.path.as_path(), &place.path().join(".gear.gearcut/new")].map(read), ["new", "old"]);
        // With a word or without: nothing is left.
        if cleared {
            assert_eq!(named.cleared().expect("removed"), path);
        } else {
            drop(named);
        }
        assert_eq!(names_in(place.path()), ["gear"]);
    }
}

/// Numbers alone, or a draft, do not take the place of a whole result; nor does another command.
#[test]
fn a_complete_result_is_not_replaced_by_less() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("gear");
    let run = |parts: &[&str], complete: bool| {
        let folder = OutputFolder::create_of(&path, "cut", parts)?;
        let record = json!({"program": "gearcut", "command": "cut", "written": parts, "complete": complete});
        folder.write_json("run.json", &record)?;
        if complete { folder.finish() } else { folder.finish_partial() }
    };
    run(&["numbers"], true).expect("free name");
    run(&["numbers", "maps"], true).expect("as much and more");
    let told = message(run(&["numbers"], true));
    assert!(told.contains("(maps)") && told.contains("--out"), "{told}");
    assert!(message(OutputFolder::create_of(&path, "axes", &[])).contains("gearcut cut"));
    run(&["numbers", "maps"], true).expect("the same again");
    run(&["numbers", "maps"], false).expect("a partial result stands beside it");
}

/// A run whose record names its files.
fn recorded_run_into(path: &Path, result: &str) -> Result<()> {
    let folder = OutputFolder::create(path)?;
    fs::write(folder.path("tables/result.txt")?, result).expect("the subfolder was made");
    let serde_json::Value::Object(record) = json!({"program": "gearcut"}) else { unreachable!() };
    folder.write_record(record)?;
    folder.finish().map(drop)
}

/// What somebody put into a result is not replaced with it: the next run is refused before any work, or keeps its own
/// results beside it if the file came meanwhile.
#[test]
fn files_of_others_in_a_result_survive() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    recorded_run_into(&path, "old").expect("free name");
    recorded_run_into(&path, "again").expect("nothing but what gearcut wrote");
    for name in ["notes.txt", "tables/my_own.csv"] {
        fs::write(path.join(name), "precious").expect("writable");
        let told = message(OutputFolder::create(&path));
        assert!(told.contains(name) && told.contains("--out"), "{told}");
        assert_eq!(fs::read_to_string(path.join(name)).expect("it survives"), "precious");
        fs::remove_file(path.join(name)).expect("removed");
    }
    // What a file manager leaves is nobody's, and so is the half of a file that a killed writer leaves.
    for name in [".DS_Store", "tables/Thumbs.db", ".gearcut-a1b2c3.part"] {
        fs::write(path.join(name), "x").expect("writable");
    }
    let folder = OutputFolder::create(&path).expect("nothing precious");
    let serde_json::Value::Object(record) = json!({"program": "gearcut"}) else { unreachable!() };
    folder.write_record(record).expect("writable");
    fs::write(path.join("notes.txt"), "precious").expect("writable");
    let told = message(folder.finish());
    assert!(told.contains("notes.txt") && told.contains("first_cut.new"), "{told}");
    assert_eq!(names_in(&path.with_file_name("first_cut.new")), ["run.json"]);
    assert!(path.join("notes.txt").exists() && path.join("tables/result.txt").exists());
}

#[test]
fn a_failed_run_leaves_the_earlier_one_alone() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    run_into(&path, "old").expect("free name");
    let folder = OutputFolder::create(&path).expect("ours");
    fs::write(folder.path("half.txt").expect("writable"), "half").expect("writable");
    drop(folder);
    assert_eq!(fs::read_to_string(path.join("tables/result.txt")).expect("there"), "old");
    assert_eq!(names_in(place.path()), ["first_cut"]);
}

#[test]
fn a_folder_of_somebody_else_is_refused_before_any_work() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("thesis");
    fs::create_dir(&path).expect("free name");
    for record in [None, Some("{}"), Some(r#"{"program": "other"}"#), Some("not json")] {
        fs::write(path.join("chapter.tex"), "precious").expect("writable");
        if let Some(record) = record {
            fs::write(path.join("run.json"), record).expect("writable");
        }
        let text = message(OutputFolder::create(&path));
        assert!(text.contains("thesis") && text.contains("--out"), "{text}");
        assert_eq!(names_in(place.path()), ["thesis"]);
        assert!(path.join("chapter.tex").exists());
    }
}

#[test]
fn somebody_elses_folder_that_appears_during_the_run_is_not_lost() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("out");
    let folder = OutputFolder::create(&path).expect("free name");
    folder.write_json("run.json", &json!({"program": "gearcut"})).expect("writable");
    fs::create_dir(&path).expect("free name");
    fs::write(path.join("chapter.tex"), "precious").expect("writable");
    assert!(message(folder.finish()).contains("not written by gearcut"));
    assert_eq!(names_in(&path), ["chapter.tex"]);
}

#[test]
fn a_file_in_the_way_is_refused() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("out");
    fs::write(&path, "precious").expect("writable");
    assert!(message(OutputFolder::create(&path)).contains("in the way"));
    let below = path.join("first_cut");
    assert!(message(OutputFolder::create(&below)).contains("out"), "a parent that is a file");
    assert_eq!(fs::read(&path).expect("untouched"), b"precious");
}

#[test]
fn a_path_without_a_name_is_refused() {
    for path in ["/", "..", "."] {
        assert!(message(OutputFolder::create(Path::new(path))).contains("name of its own"));
    }
}

/// The proc file system takes no folders from anybody, not even from root.
#[cfg(target_os = "linux")]
#[test]
fn a_parent_that_cannot_be_written_is_told_with_its_path() {
    let outcome = OutputFolder::create(Path::new("/proc/gearcut/out"));
    assert!(matches!(outcome, Err(Error::Io { .. })));
    assert!(message(outcome).contains("/proc/gearcut"));
}

#[test]
fn a_run_without_its_record_is_not_published() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("out");
    let folder = OutputFolder::create(&path).expect("free name");
    assert!(message(folder.finish()).contains("run.json"));
    assert_eq!(names_in(place.path()), Vec::<String>::new());
}

/// A run that Ctrl-C ended early.
fn partial_run_into(path: &Path, result: &str) -> Result<()> {
    let folder = OutputFolder::create(path)?;
    fs::write(folder.path("tables/result.txt")?, result).expect("the subfolder was made");
    folder.write_json("run.json", &json!({"program": "gearcut", "complete": false}))?;
    assert_eq!(folder.finish_partial()?, path.with_file_name("first_cut.partial"));
    Ok(())
}

#[test]
fn a_partial_result_stands_beside_the_complete_one_until_the_next_complete_one() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    let result = |name: &str| fs::read_to_string(place.path().join(name).join("tables/result.txt")).expect("there");
    partial_run_into(&path, "a third").expect("free name");
    assert_eq!(names_in(place.path()), ["first_cut.partial"]);
    run_into(&path, "whole").expect("free name");
    assert_eq!(names_in(place.path()), ["first_cut"]);
    partial_run_into(&path, "a third").expect("free name");
    partial_run_into(&path, "a half").expect("ours and partial, so replaced");
    assert_eq!((result("first_cut"), result("first_cut.partial")), ("whole".into(), "a half".into()));
    assert_eq!(names_in(place.path()), ["first_cut", "first_cut.partial"]);
}

#[test]
fn under_the_partial_name_nothing_complete_and_nothing_of_others_is_replaced() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let (path, partial) = (place.path().join("first_cut"), place.path().join("first_cut.partial"));
    run_into(&partial, "whole").expect("free name");
    assert!(message(OutputFolder::create(&path)).contains("complete results"));
    fs::remove_dir_all(&partial).expect("made above");
    fs::create_dir(&partial).expect("free name");
    fs::write(partial.join("chapter.tex"), "precious").expect("writable");
    assert!(message(OutputFolder::create(&path)).contains("not written by gearcut"));
    // It appears during the run: the results are kept elsewhere.
    fs::remove_dir_all(&partial).expect("made above");
    let folder = OutputFolder::create(&path).expect("free name");
    folder.write_json("run.json", &json!({"program": "gearcut", "complete": false})).expect("writable");
    fs::create_dir(&partial).expect("free name");
    fs::write(partial.join("chapter.tex"), "precious").expect("writable");
    let told = message(folder.finish_partial());
    assert!(told.contains(&format!("results of this run are in {}", place.path().join("first_cut.new").display())));
    assert_eq!(names_in(place.path()), ["first_cut.new", "first_cut.partial"]);
    assert_eq!(names_in(&partial), ["chapter.tex"]);
}

#[test]
fn one_run_at_a_time_writes_to_a_name() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    let first = OutputFolder::create(&path).expect("free name");
    let told = message(OutputFolder::create(&path));
    assert!(told.contains("another run of gearcut") && told.contains("--out"), "{told}");
    assert!(told.contains(&std::process::id().to_string()) || cfg!(windows), "{told}");
    let _other_name = OutputFolder::create(&place.path().join("second_cut")).expect("another name, another lock");
    drop(first);
    run_into(&path, "new").expect("the first one is gone");
}

/// The lock of a process that is dead is free, whatever the file says.
#[test]
fn what_a_dead_run_left_is_removed_and_what_others_put_there_is_not() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    let hidden = place.path().join(".first_cut.gearcut");
    fs::create_dir_all(hidden.join("new/maps")).expect("free name");
    fs::write(hidden.join("lock"), "gearcut 1\n").expect("writable");
    fs::write(hidden.join("new/maps/half.exr"), "half").expect("writable");
    run_into(&path, "new").expect("nobody holds the lock");
    assert_eq!(names_in(place.path()), ["first_cut"]);
    for foreign in ["chapter.tex", "lock"] {
        fs::create_dir(&hidden).expect("free name");
        fs::write(hidden.join(foreign), "precious").expect("writable");
        assert!(message(OutputFolder::create(&path)).contains("not gearcut's"), "{foreign}");
        assert_eq!(fs::read(hidden.join(foreign)).expect("untouched"), b"precious");
        fs::remove_dir_all(&hidden).expect("made above");
    }
    fs::write(&hidden, "precious").expect("writable");
    assert!(message(OutputFolder::create(&path)).contains("not gearcut's"));
    assert_eq!(fs::read(&hidden).expect("untouched"), b"precious");
}

/// Forty threads want the same name at the same time, again and again: each time one at most has it.
#[test]
fn of_many_runs_at_the_same_time_each_has_the_name_alone() {
    let place = tempfile::tempdir().expect("a folder for the test");
    let path = place.path().join("first_cut");
    let at_work = AtomicU32::new(0);
    std::thread::scope(|scope| {
        for _ in 0..40 {
            scope.spawn(|| {
                for _ in 0..50 {
                    match OutputFolder::create(&path) {
                        Ok(folder) => {
                            assert_eq!(at_work.fetch_add(1, Ordering::SeqCst), 0);
                            fs::write(folder.path("result.txt").expect("alone"), "x").expect("alone");
                            at_work.fetch_sub(1, Ordering::SeqCst);
                        }
                        Err(refused) => {
                            let told = refused.to_string();
                            assert!(told.contains("another run") || told.contains("other runs"), "{told}");
                        }
                    }
                }
            });
        }
    });
    run_into(&path, "new").expect("all are gone");
    assert_eq!(names_in(place.path()), ["first_cut"]);
}
