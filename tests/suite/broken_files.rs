//! Broken files of every kind that is read, and the exact words with which each is refused.
//!
//! Every file in `tests/data/broken/` must be refused with the text beside it in `.expected`: programs (`.ngc`),
//! results (`.results.json`), surfaces (all others). A file that once did harm stays here. To rewrite the expected
//! texts, run the test with `GEARCUT_BLESS=1`, then read them. Broken scenes have a folder of their own
//! (`scene::broken`).

use gearcut::findings::Findings;
use gearcut::output::surface_files::read_surface;
use gearcut::process::shaping::motion::gcode;
use gearcut::wrap::printable;
use std::path::Path;

/// The folder, relative to the package, as it stands in the messages.
const FOLDER: &str = "tests/data/broken";
/// Fewer files than this mean that the folder was not found as a whole.
const FEWEST: usize = 24;

/// Why a file is refused, as it is printed.
fn refusal(path: &Path) -> Option<String> {
    let name = path.to_string_lossy();
    let refused = if name.ends_with(".ngc") {
        gcode::read::file(path).err().map(|error| error.to_string())
    } else if name.ends_with(".results.json") {
        Findings::read(path).err().map(|error| error.to_string())
    } else {
        // A spacing for formats that have none.
        read_surface(path, Some([1.0, 1.0])).err().map(|error| error.to_string())
    };
    refused.map(|text| format!("{}\n", printable(&text)))
}

#[test]
fn every_broken_file_gets_its_message() {
    let mut names: Vec<String> = std::fs::read_dir(FOLDER)
        .expect("the folder of broken files")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| !name.ends_with(".expected"))
        .collect();
    names.sort();
    assert!(names.len() >= FEWEST, "only {} broken files in {FOLDER}", names.len());
    let bless = std::env::var_os("GEARCUT_BLESS").is_some();
    let mut wrong = Vec::new();
    for name in &names {
        let path = format!("{FOLDER}/{name}");
        let Some(found) = refusal(Path::new(&path)) else {
            wrong.push(format!("{path} is taken"));
            continue;
        };
        let beside = format!("{path}.expected");
        if bless {
            std::fs::write(&beside, &found).expect("write the expected text");
        }
        let expected = std::fs::read_to_string(&beside).unwrap_or_default().replace("\r\n", "\n");
        if found != expected {
            wrong.push(format!("{path}\n--- expected\n{expected}--- found\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What has no end, and what waits for its other end, is refused at once.
#[cfg(unix)]
#[test]
fn devices_and_pipes_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe.ngc");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs");
    assert!(made.success());
    for path in [Path::new("/dev/zero"), pipe.as_path()] {
        let refusals = [
            gcode::read::file(path).expect_err("a program").to_string(),
            Findings::read(path).expect_err("a result").to_string(),
            gearcut::process::load(path, &[]).expect_err("a scene").to_string(),
            read_surface(path, None).expect_err("a surface").to_string(),
        ];
        for text in refusals {
            assert!(text.contains("a device, pipe or socket"), "{}: {text}", path.display());
        }
    }
}
