//! Other people's crates: under which licences they come, from where, and how many of one name.
//!
//! The same as `cargo deny check licenses sources bans` asks by `deny.toml`, from `cargo metadata` alone: cargo-deny
//! itself takes minutes to build on a fresh machine. Advisories need a list that changes every day and are no test of
//! the code. And how builds are made: from locked versions, a release with checks for overflow.

use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Command;

/// Words of a list in `deny.toml`: the licences of which one must be offered for every part of a crate, permissive ones
/// that are compatible with both of ours, and the crates of which two versions are linked, since others ask for both.
fn rules(section: &str, list: &str) -> Vec<String> {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/deny.toml")).expect("the rules");
    let rules: toml::Table = text.parse().expect("TOML");
    let list = rules[section][list].as_array().expect("a list");
    list.iter().map(|word| word.as_str().expect("a word").to_owned()).collect()
}

/// Packages of the lock file for all platforms.
fn packages() -> Vec<Value> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["metadata", "--locked", "--offline", "--format-version", "1"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    // Crates of other platforms may not have been fetched; cargo then asks for the network.
    let output = if output.status.success() {
        output
    } else {
        Command::new("cargo")
            .args(["metadata", "--locked", "--format-version", "1"])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("cargo runs")
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    metadata["packages"].as_array().expect("a list").clone()
}

/// Whether an SPDX expression offers only licences of the list: every part joined by AND, one of those joined by OR.
fn is_free(expression: &str, licences: &[String]) -> bool {
    let is_free = |part: &str| is_free(part, licences);
    let plain = expression.replace(" WITH LLVM-exception", "").replace('/', " OR ");
    match plain.split_once(')') {
        // "(A OR B) AND C"
        Some((first, rest)) => {
            let rest = rest.trim().trim_start_matches("AND").trim();
            is_free(first.trim_start_matches('(')) && (rest.is_empty() || is_free(rest))
        }
        None => plain
            .split(" AND ")
            .all(|part| part.split(" OR ").any(|one| licences.iter().any(|known| known == one.trim()))),
    }
}

#[test]
fn every_crate_comes_from_the_registry_under_a_free_licence_and_once() {
    let (packages, licences, double) = (packages(), rules("licenses", "allow"), rules("bans", "skip"));
    assert!(packages.len() > 100, "{} packages", packages.len());
    let mut wrong = Vec::new();
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for package in &packages {
        let text = |key: &str| package[key].as_str().unwrap_or_default();
        let (name, version) = (text("name"), text("version"));
        versions.entry(name).or_default().push(version);
        if !is_free(text("license"), &licences) {
            wrong.push(format!("{name} {version}: licence `{}`", text("license")));
        }
        let ours = package["source"].is_null() && name.starts_with("gearcut");
        if !ours && !text("source").starts_with("registry+") {
            wrong.push(format!("{name} {version} comes from {}", package["source"]));
        }
        // A dependency on Cargo's own registry names none.
        for dependency in package["dependencies"].as_array().expect("a list") {
            if !dependency["registry"].is_null() {
                wrong.push(format!("{name} {version} takes {} from {}", dependency["name"], dependency["registry"]));
            }
        }
    }
    let twice: Vec<&&str> = versions.iter().filter(|(_, of)| of.len() > 1).map(|(name, _)| name).collect();
    wrong.extend(
        twice.iter().filter(|name| !double.iter().any(|of| of == **name)).map(|name| format!("{name} is linked twice")),
    );
    wrong.extend(
        double.iter().filter(|name| !twice.contains(&&name.as_str())).map(|name| format!("{name} is linked once now")),
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn licences_that_are_not_free_are_noticed() {
    let licences = rules("licenses", "allow");
    let is_free = |expression: &str| is_free(expression, &licences);
    for free in ["MIT", "MIT/Apache-2.0", "MIT OR LGPL-2.1-or-later", "(MIT OR Apache-2.0) AND Unicode-3.0"] {
        assert!(is_free(free), "{free}");
    }
    for other in ["", "GPL-3.0", "MIT AND GPL-3.0", "(MIT OR Apache-2.0) AND GPL-2.0", "LGPL-2.1-or-later"] {
        assert!(!is_free(other), "{other}");
    }
}

/// README's first command is `cargo run` without the name of a program. Of the workspace's programs one must be its
/// choice, or cargo refuses.
#[test]
fn cargo_run_chooses_gearcut() {
    let readme = std::fs::read_to_string("README.md").expect("a page");
    assert!(readme.contains("\ncargo run --release -- cut scenes/"), "README's first command is another one");
    let packages = packages();
    let choices: Vec<_> = packages.iter().filter(|package| package["source"].is_null()).collect();
    let choices = choices.iter().filter_map(|package| package["default_run"].as_str());
    assert_eq!(choices.collect::<Vec<_>>(), ["gearcut"]);
}

/// Lines of a script or page that build with cargo, without `--locked`.
fn unlocked(text: &str, subcommands: &[&str]) -> Vec<String> {
    let builds = |line: &&str| subcommands.iter().any(|subcommand| line.contains(&format!("cargo {subcommand} ")));
    let unlocked = text.lines().filter(builds).filter(|line| !line.trim_start().starts_with('#'));
    unlocked.filter(|line| !line.contains("--locked")).map(str::to_owned).collect()
}

#[test]
fn builds_take_the_locked_versions() {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_else(|why| panic!("{path}: {why}"));
    for script in [".ci/run", "tests/run", "tests/interop/run", "tests/interop/meshes", "tests/browser/run"] {
        let found = unlocked(&read(script), &["build", "test", "run", "clippy", "doc", "bench", "install"]);
        assert!(found.is_empty(), "{script}: {found:?}");
    }
    // Of the commands that pages show, `install` alone leaves the lock file out unless it is told.
    let pages = std::fs::read_dir("docs").expect("pages").map(|entry| entry.expect("a page").path());
    let pages = pages.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    for page in pages.chain(["README.md".into(), "CONTRIBUTING.md".into()]) {
        let found = unlocked(&read(page.to_str().expect("a name")), &["install"]);
        assert!(found.is_empty(), "{}: {found:?}", page.display());
    }
    assert_eq!(unlocked("cargo test --workspace\n# cargo test x\ncargo test --locked", &["test"]).len(), 1);
}

/// Kernels are bounded where they are called, and other people's crates answer for themselves.
#[test]
fn releases_check_for_overflow_outside_of_kernels() {
    let manifest: toml::Table = std::fs::read_to_string("Cargo.toml").expect("a manifest").parse().expect("TOML");
    let release = &manifest["profile"]["release"];
    assert_eq!(release["overflow-checks"].as_bool(), Some(true));
    let without = release["package"].as_table().expect("packages").iter();
    let without = without.filter(|(_, package)| package["overflow-checks"].as_bool() == Some(false));
    assert_eq!(without.map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["*", "gearcut-core"]);
}
