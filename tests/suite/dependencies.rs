//! Other people's crates: under which licences they come, from where, and how many of one name.
//!
//! The same as `cargo deny check licenses sources bans` asks, from `cargo metadata` alone: cargo-deny itself takes
//! minutes to build on a fresh machine. Advisories need a list that changes every day and are no test of the code.

use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Command;

/// Licences of which one must be offered for every part of a crate: permissive ones, all compatible with both of ours.
const LICENCES: [&str; 9] =
    ["MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "ISC", "Zlib", "0BSD", "Unicode-3.0", "Unlicense"];
/// Crates of which two versions are linked, since others ask for both; a new one wants a reason.
const TWICE: [&str; 4] = ["cpufeatures", "hashbrown", "miniz_oxide", "syn"];

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
fn is_free(expression: &str) -> bool {
    let plain = expression.replace(" WITH LLVM-exception", "").replace('/', " OR ");
    match plain.split_once(')') {
        // "(A OR B) AND C"
        Some((first, rest)) => {
            let rest = rest.trim().trim_start_matches("AND").trim();
            is_free(first.trim_start_matches('(')) && (rest.is_empty() || is_free(rest))
        }
        None => plain.split(" AND ").all(|part| part.split(" OR ").any(|one| LICENCES.contains(&one.trim()))),
    }
}

#[test]
fn every_crate_comes_from_the_registry_under_a_free_licence_and_once() {
    let packages = packages();
    assert!(packages.len() > 100, "{} packages", packages.len());
    let mut wrong = Vec::new();
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for package in &packages {
        let text = |key: &str| package[key].as_str().unwrap_or_default();
        let (name, version) = (text("name"), text("version"));
        versions.entry(name).or_default().push(version);
        if !is_free(text("license")) {
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
    wrong.extend(twice.iter().filter(|name| !TWICE.contains(**name)).map(|name| format!("{name} is linked twice")));
    wrong.extend(TWICE.iter().filter(|name| !twice.contains(name)).map(|name| format!("{name} is linked once now")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn licences_that_are_not_free_are_noticed() {
    for free in ["MIT", "MIT/Apache-2.0", "MIT OR LGPL-2.1-or-later", "(MIT OR Apache-2.0) AND Unicode-3.0"] {
        assert!(is_free(free), "{free}");
    }
    for other in ["", "GPL-3.0", "MIT AND GPL-3.0", "(MIT OR Apache-2.0) AND GPL-2.0", "LGPL-2.1-or-later"] {
        assert!(!is_free(other), "{other}");
    }
}
