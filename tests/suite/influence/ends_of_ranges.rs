//! Fits that measured values draw beyond what a scene may say.

use super::refused_tables::SCENE;
use crate::fixtures::command::gearcut_in;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

/// Loose places of a gear that runs out by so much, um.
fn eccentric(um: f64) -> String {
    let mut table = "tooth,flank,u_mm,v_mm,deviation_um\n".to_owned();
    for tooth in 1..=12 {
        for (flank, sign) in [("left", 1.0), ("right", -1.0)] {
            let angle = TAU * f64::from(tooth - 1) / 12.0;
            // About what an eccentric gear shows: the normal turns with the tooth.
            let around = um * (angle + sign * 20_f64.to_radians()).cos();
            for u_mm in [1.5, 2.5] {
                let _ = writeln!(table, "{tooth},{flank},{u_mm},0,{around}");
            }
        }
    }
    table
}

/// Nanometres in a column of micrometres: the fit ends at the end of the key's range, says so, and its settings make a
/// scene that can be read.
#[test]
fn a_fit_ends_at_the_end_of_a_range_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    fs::write(folder.path().join("nm.csv"), eccentric(9000.0)).expect("written");
    fs::write(folder.path().join("um.csv"), eccentric(9.0)).expect("written");
    let key = "mounting.eccentricity_um";
    let fit = |file: &str, out: &str| {
        let arguments =
            ["calibrate", "round.toml", "--measured", file, "--noise-um", "0.5", "--fit", key, "--out", out];
        gearcut_in(folder.path(), &arguments).done()
    };
    let done = fit("nm.csv", "nm").says(&["end of its range"]);
    assert!(done.err.contains("is at the end of its range"), "{}", done.err);
    let sets: Vec<&str> = done.out.lines().filter_map(|line| line.trim().strip_prefix("--set '")).collect();
    let sets: Vec<&str> = sets.into_iter().map(|set| set.trim_end_matches('\'')).collect();
    let size = sets.iter().find_map(|set| set.strip_prefix("mounting.eccentricity_um=")).expect("a size");
    let size_um: f64 = size.parse().expect("a number");
    assert!((990.0..=1000.0).contains(&size_um), "{size_um} um; the key goes to 1000");
    let check: Vec<&str> =
        ["check", "round.toml"].into_iter().chain(sets.iter().flat_map(|set| ["--set", *set])).collect();
    assert_ne!(gearcut_in(folder.path(), &check).code, 1, "the settings are a scene's");
    // No interval is made up there; in micrometres nothing is said.
    let table = fs::read_to_string(folder.path().join("nm/tables/fits.csv")).expect("a table");
    assert!(table.lines().skip(1).any(|row| row.split(',').nth(3) == Some("")), "{table}");
    let done = fit("um.csv", "um");
    assert!(!done.out.contains("end of its range") && !done.err.contains("end of its range"), "{}", done.out);
}
