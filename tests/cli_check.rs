//! `gearcut check`: facts, warnings, every committed scene, in a second.

#[path = "common/command.rs"]
mod command;

use command::gearcut;

const PAPER: &str = "scenes/shaping/elliptical_normal.toml";

#[test]
fn the_papers_gear_is_described() {
    let outcome = gearcut(&["check", PAPER]).done().says(&[
        "42 teeth, module 3 mm, pressure angle 20 deg, face width 30 mm",
        "395.840616 mm for pi m z = 395.840674 mm: 0.0588 um too short",
        "28.868 mm at polar angle 0.00 deg and 2 more",
        "52.67 to 67.33, 172.67 to 187.33, 292.67 to 307.33 deg",
        "radius 765.301 mm at polar angle 60.00 deg",
        "pitch 30.000 mm, base 28.191 mm, tip 33.750 mm",
        "14.95 deg at polar angle",
        "26 % of a circular gear's",
        "undercut                      none",
        "million dexels",
        "rays 0.1 mm apart in 1 sections; 8.7 million cross a cutter tooth",
        "thousand cutter teeth reach the blank",
        "of it for blank and chips",
        "MB",
    ]);
    assert!(outcome.err.contains("warning: operation finish: backing off by 0.5 mm"), "{}", outcome.err);
}

#[test]
fn every_committed_scene_passes() {
    let scenes = std::fs::read_dir("scenes/shaping").expect("the scenes are committed");
    let mut count = 0;
    for scene in
        scenes.map(|entry| entry.expect("a file").path()).filter(|p| p.extension().is_some_and(|e| e == "toml"))
    {
        let outcome = gearcut(&["check", &scene.display().to_string()]).done();
        assert!(!outcome.out.contains("NaN") && !outcome.out.contains("inf"), "{}", outcome.out);
        count += 1;
    }
    assert!(count >= 8, "{count} scenes");
}

#[test]
fn a_circle_has_the_same_teeth_everywhere() {
    gearcut(&["check", "scenes/shaping/circular_m3_z24.toml"]).done().says(&[
        "36.000 mm everywhere; convex",
        "tip land                      2.146 mm on all teeth",
        "0.00 deg everywhere",
    ]);
}

#[test]
fn limits_undercut_and_narrow_tips_are_warned_about() {
    let exceeded = gearcut(&["check", PAPER, "--set", "machine.limits.cutter_speed_deg_per_s=1.0"]).done();
    assert!(exceeded.err.contains("cutter spindle speed reaches 1.321 deg/s, the machine allows 1.000 deg/s"));
    assert!(exceeded.out.contains("-32 %"), "{}", exceeded.out);
    let few = ["--set", "gear.teeth=9", "--set", "gear.pitch_curve.circle={}", "--set", "tool.shaper_cutter.teeth=40"];
    let undercut = gearcut(&[&["check", PAPER][..], &few].concat()).done();
    assert!(undercut.err.contains("warning: the cutter undercuts tooth 1 left"), "{}", undercut.err);
}
