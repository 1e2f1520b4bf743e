//! Tables of measured values that are wrong are refused before the work, by both commands alike, with what is wrong.

use crate::fixtures::command::gearcut_in;
use std::fs;

/// Twelve teeth, few strokes: what is refused here costs nothing anyway.
pub const SCENE: &str = "picture = []
    [gear]
    module_mm = 3.0
    teeth = 12
    face_width_mm = 5.0
    [tool.shaper_cutter]
    teeth = 20
    [mounting]
    eccentricity_um = 10
    [[operation]]
    name = \"finish\"
    strokes_per_revolution = 120
    [fields.flank]
    profile_spacing_um = 100.0
    lead_spacing_um = 5000.0
";

const TABLE: &str = "chart,tooth,flank,u_mm,v_mm,deviation_um
profile,1,left,1.0,0,3.5
profile,1,left,1.5,0,2.5
profile,4,left,1.0,0,-3.5
profile,4,left,1.5,0,-2.0
";

/// Runs both commands on a table, and asserts that both refuse it with these words.
fn refuse(table: &[u8], words: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    fs::write(folder.path().join("gear.csv"), table).expect("written");
    for command in [["diagnose", "--parameters"], ["calibrate", "--fit"]] {
        let arguments =
            [command[0], "round.toml", "--measured", "gear.csv", "--noise-um", "0.5", command[1], "mounting"];
        gearcut_in(folder.path(), &arguments).failed(1, &[&["gear.csv"], words].concat());
        assert!(!folder.path().join("out").exists(), "{command:?} left something behind");
    }
}

#[test]
fn a_place_that_is_measured_twice_is_refused() {
    let twice = format!("{TABLE}profile,1,left,1.5,0,52.5\n");
    refuse(twice.as_bytes(), &["line 6", "line 3", "tooth 1 left"]);
    let loose = TABLE.replace("chart,", "").replace("profile,", "") + "4,left,1.0000000001,0,3\n";
    refuse(loose.as_bytes(), &["line 6", "line 4", "tooth 4 left"]);
}

/// A profile and a helix cross at one place: that is two lines, and no place twice.
#[test]
fn charts_may_cross() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("gear.csv");
    fs::write(&path, format!("{TABLE}helix,1,left,1.5,0,2.4\nhelix,1,left,1.5,1,2.2\n")).expect("written");
    assert_eq!(gearcut::influence::measured::read(&path).expect("a table").len(), 6);
    assert_eq!(gearcut::influence::charts::read_lines(&path).expect("a table").len(), 3);
}

#[test]
fn deviations_that_no_gear_has_and_unknown_charts_are_refused() {
    for um in ["1e300", "-1.1e6", "1e150", "inf", "nan"] {
        refuse(TABLE.replace("2.5", um).as_bytes(), &["line 3", "deviation_um", um, "1e6"]);
    }
    refuse(TABLE.replace("profile,4", "foo,4").as_bytes(), &["line 4", "foo", "profile, helix or pitch"]);
    refuse(TABLE.replace("profile,4", "Profile,4").as_bytes(), &["line 4", "Profile"]);
}

#[test]
fn tables_in_other_spellings_are_named() {
    refuse(TABLE.replace(',', ";").replace('.', ",").as_bytes(), &["semicolons"]);
    refuse(TABLE.replace(',', "\t").as_bytes(), &["tabs"]);
    refuse(TABLE.replace("deviation_um", "Deviation_um").as_bytes(), &["Deviation_um", "`deviation_um`"]);
    for (mark, bytes) in [([0xff, 0xfe], u16::to_le_bytes as fn(u16) -> [u8; 2]), ([0xfe, 0xff], u16::to_be_bytes)] {
        let text: Vec<u8> = TABLE.encode_utf16().flat_map(bytes).collect();
        refuse(&[&mark[..], &text].concat(), &["UTF-16"]);
        refuse(&text, &["UTF-16"]);
    }
    refuse(b"", &["empty"]);
    refuse(b"tooth,flank,height\n1,left,2\n", &["deviation_um"]);
}

/// Numbers are no measures either where squares of them overflow.
#[test]
fn numbers_that_no_result_has_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("round.toml"), SCENE).expect("written");
    let fit = |value: &str, uncertainty: &str| {
        let table = format!("quantity,value,uncertainty\nheadline.F_r,{value},{uncertainty}\n");
        fs::write(folder.path().join("numbers.csv"), table).expect("written");
        let fit = ["calibrate", "round.toml", "--measured", "numbers.csv", "--fit", "mounting"];
        gearcut_in(folder.path(), &fit)
    };
    fit("1e300", "1").failed(1, &["line 2", "`value`", "1e12"]);
    fit("1", "1e-300").failed(1, &["line 2", "`uncertainty`", "1e-12"]);
}
