//! The output folder: complete under its name or not there; only gearcut's own folders are replaced.

use std::fs;
use std::path::Path;

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
