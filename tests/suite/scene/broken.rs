//! Broken scenes and the exact words they are answered with.
//!
//! Every `tests/broken/*.toml` must be refused with the text beside it in `.expected`. Lines `#! --set KEY=VALUE` in a
//! scene are its settings; `{tools}` stands for the names of all tools, `{headers of tools}` for their headers. To
//! rewrite the expected texts, run the test with `GEARCUT_BLESS=1`, then read them.

use std::fs;
use std::path::Path;

use gearcut::process::{load, table};
use gearcut::scene::keys::either;

/// The folder, relative to the package, as it stands in the messages.
const FOLDER: &str = "tests/broken";
/// Fewer files than this mean that the folder was not found as a whole.
const FEWEST: usize = 45;

#[test]
fn every_broken_scene_gets_its_message() {
    let mut names: Vec<String> = fs::read_dir(FOLDER)
        .expect("the folder of broken scenes")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| Path::new(name).extension().is_some_and(|extension| extension == "toml"))
        .collect();
    names.sort();
    assert!(names.len() >= FEWEST, "only {} broken scenes in {FOLDER}", names.len());
    let bless = std::env::var_os("GEARCUT_BLESS").is_some();
    let mut wrong = Vec::new();
    for name in &names {
        let path = format!("{FOLDER}/{name}");
        let found = message(&path);
        let expected_path = Path::new(&path).with_extension("expected");
        if bless {
            fs::write(&expected_path, &found).expect("write the expected text");
        }
        let expected = fs::read_to_string(&expected_path).unwrap_or_default();
        wrong.extend(mismatch(&path, &found, &expected));
    }
    println!("{} broken scenes, {} with another message than expected", names.len(), wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The difference between a message and the expected one, if there is any.
#[must_use]
fn mismatch(path: &str, found: &str, expected: &str) -> Option<String> {
    let expected = expected.replace("\r\n", "\n"); // as git may check it out on Windows
    (found != expected).then(|| format!("{path}\n--- expected\n{expected}--- found\n{found}"))
}

/// What the scene at `path` is answered with; a scene that loads is answered with a word that no file expects.
fn message(path: &str) -> String {
    let text = fs::read_to_string(path).expect("a broken scene");
    let settings: Vec<String> =
        text.lines().filter_map(|line| line.strip_prefix("#! --set ")).map(str::to_owned).collect();
    match load(Path::new(path), &settings) {
        Ok(_) => panic!("{path} loads, but it should not"),
        Err(errors) => {
            let tools: Vec<&str> = table().processes().iter().map(|process| process.tool).collect();
            let headers = table().processes().iter().map(|process| process.tool_header());
            let text = format!("{errors}\n").replace(&tools.join(", "), "{tools}");
            text.replace(&either(headers), "{headers of tools}")
        }
    }
}

#[test]
fn a_wrong_expectation_is_noticed() {
    let path = format!("{FOLDER}/01_unknown_key.toml");
    let expected = fs::read_to_string(Path::new(&path).with_extension("expected")).expect("an expected text");
    assert!(mismatch(&path, &message(&path), &expected).is_none());
    for (right, wrong) in [(":2:1:", ":2:2:"), ("0.1 to 50", "0.1 to 51"), ("^^^^", "^^^")] {
        assert!(expected.contains(right), "{right}");
        assert!(mismatch(&path, &message(&path), &expected.replace(right, wrong)).is_some(), "{wrong}");
    }
}
