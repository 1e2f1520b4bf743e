//! The drawing of the machine's settings: the file in the docs, and places in it against the settings.

use super::jobs::job;
use gearcut::process::bevel::drawing::{Drawn, svg};

const FILE: &str = "docs/pictures/bevel_settings.svg";

/// Settings that are all large enough to be seen.
fn drawn() -> String {
    let job = job("crown_gear", &[]).expect("a gear");
    let mut settings = job.finishing().settings;
    settings.blank_offset_mm = 14.0;
    settings.center_to_back_mm = 12.0;
    settings.cross_shift_mm = -9.0;
    settings.sliding_base_mm = 6.0;
    svg(&Drawn { settings: &settings, ..Drawn::of(&job) })
}

#[test]
fn the_drawing_in_the_docs_is_that_of_the_program() {
    let drawn = drawn();
    if std::env::var_os("GEARCUT_BLESS").is_some() {
        std::fs::write(FILE, &drawn).expect("the docs");
    }
    let file = std::fs::read_to_string(FILE).unwrap_or_default();
    assert!(file == drawn, "{FILE} is stale: GEARCUT_BLESS=1 cargo test --test suite bevel::drawing");
}

/// Every setting has its name and value, and those that are long enough their line in the drawing.
#[test]
fn every_setting_is_named() {
    let drawn = drawn();
    for words in [
        "S_r  radial setting: 70.6368 mm",
        "q  cradle angle, middle of the roll: 60.4296°",
        "E_m  blank offset: 14.0000 mm",
        "X_D  sliding base, along z: 6.0000 mm",
        "X_B  cross shift, along x: -9.0000 mm",
        "X_p  machine centre to back: 12.0000 mm",
        "γ_m  machine root angle: 65.1363°",
        "R_a  ratio of roll, work angle A over q: 1.102158",
    ] {
        assert!(drawn.contains(words), "{words}");
    }
    for name in ["S_r", "q", "E_m", "X_D", "X_B", "X_p", "γ_m", "r_c"] {
        assert!(drawn.contains(&format!(">{name}</text>")), "{name} is not drawn");
    }
    // Without offsets their lines are left out.
    let plain = job("crown_gear", &["machine.cradle.sliding_base_mm=5"]).expect("a gear");
    let plain = svg(&Drawn::of(&plain));
    assert!(!plain.contains(">E_m</text>") && plain.contains("E_m  blank offset: 0.0000 mm"));
}
