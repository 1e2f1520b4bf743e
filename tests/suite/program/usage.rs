//! The command line itself: help, exit codes, schema, new scenes.

use crate::fixtures::command::{gearcut, gearcut_in};

const COMMANDS: [&str; 15] = [
    "cut",
    "check",
    "axes",
    "compare",
    "texture",
    "devices",
    "schema",
    "new",
    "mate",
    "export",
    "pair",
    "budget",
    "deviations",
    "diagnose",
    "calibrate",
];

#[test]
fn help_teaches_every_command_with_an_example() {
    let help = gearcut(&["--help"]).done();
    for command in COMMANDS {
        assert!(help.out.contains(&format!("  {command} ")), "{command} is not in the help: {}", help.out);
        gearcut(&[command, "--help"]).done().says(&["Example:", &format!("gearcut {command}"), "Usage:"]);
    }
    gearcut(&["cut", "--help"]).done().says(&[
        "--out",
        "--backend",
        "--set",
        "--quiet",
        "--json",
        "results.json",
        "um",
    ]);
}

#[test]
fn wrong_usage_ends_with_2() {
    gearcut(&[]).failed(2, &["Usage:"]);
    gearcut(&["grind"]).failed(2, &["grind"]);
    gearcut(&["check"]).failed(2, &["<SCENE>"]);
    gearcut(&["check", "a.toml", "b.toml"]).failed(2, &["b.toml"]);
    gearcut(&["cut", "a.toml", "--backend", "abacus"]).failed(2, &["auto", "gpu", "cpu"]);
    gearcut(&["cut", "a.toml", "--quiet", "--json"]).failed(2, &["--json"]);
    gearcut(&["new", "whittling"]).failed(2, &["shaping"]);
}

#[test]
fn a_number_that_is_none_has_a_way_out() {
    let wire = ["export", "scenes/shaping/circular_m3_z24.toml", "--wire", "gear.ngc", "--gap-um"];
    let gap = |typed| gearcut(&[&wire[..], &[typed]].concat());
    gap("12,5").failed(2, &["'12,5'", "write 12.5"]);
    gap("20um").failed(2, &["'20um'", "write 20:"]);
    assert!(!gap("narrow").failed(2, &["'narrow'"]).err.contains("write"));
    gap("-5").failed(1, &["--gap-um", "-5 is not 0 to 500"]);
    gearcut(&["export", "scenes/shaping/circular_m3_z24.toml", "--dxf", "gear.dxf", "--gap-um", "5"])
        .failed(2, &["--wire <FILE>"]);
}

#[test]
fn a_missing_scene_ends_with_1_and_a_way_out() {
    for command in ["check", "axes", "cut"] {
        let outcome = gearcut(&[command, "no_such_scene.toml"]).failed(1, &["no_such_scene.toml", "way out:"]);
        assert_eq!(outcome.out, "");
    }
}

#[test]
fn a_broken_scene_is_shown_at_its_place() {
    let broken = "tests/broken/75_eight_at_once.toml";
    let expected = std::fs::read_to_string("tests/broken/75_eight_at_once.expected").expect("it lies beside the scene");
    let outcome = gearcut(&["check", broken]).failed(1, &["error: tests/broken/75_eight_at_once.toml:", "way out:"]);
    let problems = |text: &str| text.matches("error: ").count();
    assert_eq!(problems(&outcome.err), problems(&expected));
}

#[test]
fn what_geometry_refuses_is_shown_at_its_place_too() {
    let scene = "scenes/shaping/elliptical_normal.toml";
    // The written semi-major axis does not close on 43 teeth.
    gearcut(&["check", scene, "--set", "gear.teeth=43"])
        .failed(1, &["error: scenes/shaping/elliptical_normal.toml:", "semi_major_axis_mm = 61.11", "^^^", "way out:"]);
    gearcut(&["check", scene, "--set", "gear.modul_mm=3"]).failed(1, &["--set gear.modul_mm=3", "module_mm"]);
}

#[test]
fn the_schema_is_the_committed_one() {
    let committed = std::fs::read_to_string("scenes/schema.json").expect("the schema is committed");
    assert_eq!(gearcut(&["schema"]).done().out, committed);
}

#[test]
fn a_new_scene_can_be_checked_and_is_never_overwritten() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    gearcut_in(folder.path(), &["new", "shaping", "--out", "mine.toml"]).done().says(&["gearcut check mine.toml"]);
    let written = std::fs::read_to_string(folder.path().join("mine.toml")).expect("just written");
    assert_eq!(gearcut(&["new", "shaping"]).done().out, written);
    gearcut_in(folder.path(), &["check", "mine.toml"]).done().says(&["mine: ", "Pitch curve", "Cost"]);
    gearcut_in(folder.path(), &["new", "shaping", "--out", "mine.toml"]).failed(1, &["mine.toml", "--out"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("mine.toml")).expect("still there"), written);
    gearcut_in(folder.path(), &["new", "shaping", "--out", "no/mine.toml"]).failed(1, &["no/mine.toml"]);
}

#[test]
fn the_processor_is_always_a_device() {
    gearcut(&["devices"]).done().says(&["cpu"]);
}

#[cfg(not(feature = "gpu"))]
#[test]
fn a_build_without_the_gpu_backend_says_so() {
    let way_out = "way out: build it without --no-default-features";
    gearcut(&["devices"]).done().says(&["built without its GPU backend", way_out, "--backend auto takes cpu"]);
    let cut = ["cut", "scenes/shaping/circular_m3_z24.toml", "--backend", "gpu", "--out"];
    let folder = tempfile::tempdir().expect("a folder for the test");
    let out = folder.path().join("out");
    let out = out.to_str().expect("UTF-8");
    gearcut(&[&cut[..], &[out]].concat()).failed(1, &["built without its GPU backend", way_out, "--backend cpu"]);
}

/// Mesa's layer names this variable on standard error where no window system runs.
#[cfg(target_os = "linux")]
#[test]
fn devices_says_nothing_of_window_systems() {
    let mut devices = std::process::Command::new(env!("CARGO_BIN_EXE_gearcut"));
    devices.arg("devices");
    for empty in [false, true] {
        let set = if empty { devices.env("XDG_RUNTIME_DIR", "") } else { devices.env_remove("XDG_RUNTIME_DIR") };
        let ended = set.output().expect("the program is built before its tests");
        assert!(ended.status.success());
        let told = String::from_utf8(ended.stderr).expect("UTF-8");
        assert!(!told.contains("XDG_RUNTIME_DIR"), "empty {empty}: {told}");
    }
}

/// Where the system starts no more threads, the command says so with the way out, and takes it; it does not panic.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_start_are_an_error_with_a_way_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |threads: &str| {
        // Each thread has a stack of 2 MiB: a thousand have no room in as many megabytes and a half.
        std::process::Command::new("sh")
            .args(["-c", "ulimit -v 1500000; exec \"$0\" axes \"$1\" --out \"$2\""])
            .args([env!("CARGO_BIN_EXE_gearcut"), "scenes/shaping/circular_m3_z24.toml"])
            .arg(folder.path().join("axes"))
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("a shell")
    };
    let refused = run("4000");
    let told = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{told}");
    assert!(told.contains("way out: RAYON_NUM_THREADS=1") && !told.contains("panicked"), "{told}");
    assert!(!folder.path().join("axes").exists());
    let done = run("1");
    assert_ne!(done.status.code(), Some(1), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(folder.path().join("axes/run.json").exists());
}
