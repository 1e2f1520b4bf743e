//! `gearcut check`: facts, warnings, every committed scene, in a second.

use crate::fixtures::command::{check_as_it_is, gearcut, gearcut_briefly, gearcut_in};
use gearcut::passes::SweepPlan;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::{PROCESSES, load};
use gearcut::terms::Side;
use std::path::Path;

const PAPER: &str = "scenes/shaping/elliptical_normal.toml";

#[test]
fn the_papers_gear_is_described() {
    let outcome = check_as_it_is(PAPER).done().says(&[
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
        "rays 0.1 mm apart in 1 sections; ",
        "for blank and chips",
        "to prepare, draw and write",
        "MB",
    ]);
    // Both operations come at full depth; a whole cut of this scene takes 141 and 52.6 kN there.
    for words in [
        "warning: operation finish: backing off by 0.5 mm",
        "warning: operation rough: the first stroke comes at full depth and takes 141 kN, more than 40.0 kN",
        "warning: operation finish: the first stroke comes at full depth and takes 52.6 kN, more than 40.0 kN",
    ] {
        assert!(outcome.err.contains(words), "no {words:?} in {}", outcome.err);
    }
    assert!(outcome.out.contains("Warnings that only a cut can find"), "{}", outcome.out);
}

/// The verdict comes first, and all of it fits on a screen of 50 lines of 80 characters; `--verbose` prints the rest.
#[test]
fn a_screen_holds_the_verdict_and_the_rest_is_asked_for() {
    let many = ["--set", "gear.teeth=9", "--set", "gear.pitch_curve.circle={}", "--set", "tool.shaper_cutter.teeth=40"];
    for arguments in [
        &["check", PAPER][..],
        &["check", "scenes/hobbing/machine_errors.toml"],
        &["check", "scenes/bevel/five_linkage_printed.toml"],
        &[&["check", PAPER][..], &many].concat(),
    ] {
        let brief = gearcut_briefly(arguments);
        let whole = if let ["check", scene] = arguments { check_as_it_is(scene) } else { gearcut(arguments) };
        let lines = |text: &str| text.lines().map(|line| line.chars().count().div_ceil(80).max(1)).sum::<usize>();
        let count = lines(&brief.out) + lines(&brief.err);
        println!("{arguments:?}: {count} lines, {} with --verbose", lines(&whole.out) + lines(&whole.err));
        assert!(count <= 50, "{count} lines:\n{}{}", brief.out, brief.err);
        assert!(brief.out.starts_with("can be cut: "), "{}", brief.out);
        assert!(brief.out.contains("some ") && brief.out.contains("for all of it"), "no time: {}", brief.out);
        // What is left out is printed when it is asked for.
        assert!(lines(&whole.out) > lines(&brief.out), "{}", whole.out);
        assert!(!brief.out.contains("not given") && whole.out.contains("not given"), "{}", whole.out);
    }
    let limited = gearcut_briefly(&["check", PAPER, "--set", "fields.blank.spacing_mm=0"]);
    assert!(limited.out.is_empty() && limited.code != 0, "{}", limited.out);
}

#[test]
fn a_circle_has_the_same_teeth_everywhere() {
    check_as_it_is("scenes/shaping/circular_m3_z24.toml").done().says(&[
        "36.000 mm everywhere; convex",
        "tip land                      2.146 mm on all teeth",
        "0.00 deg everywhere",
    ]);
}

/// Root diameters by hand: m (z / cos(beta) + 2 x - 2.5), and of the paper's gear twice the smallest radius less 2.5 m.
#[test]
fn a_bore_ends_below_the_tooth_roots() {
    const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";
    let of_round = |x: f64, beta_deg: f64| 3.0 * (24.0 / beta_deg.to_radians().cos() + 2.0 * x - 2.5);
    for (scene, x, beta_deg, root_mm) in [
        (ROUND, 0.0, 0.0, of_round(0.0, 0.0)),
        (ROUND, -0.4, 0.0, of_round(-0.4, 0.0)),
        (ROUND, 0.4, 0.0, of_round(0.4, 0.0)),
        (ROUND, 0.0, 30.0, of_round(0.0, 30.0)),
        (PAPER, 0.0, 0.0, 2.0 * 52.872 - 7.5),
    ] {
        for (by_mm, fits) in [(-0.2, true), (0.2, false)] {
            let sets = [("profile_shift_coefficient", x), ("helix_angle_deg", beta_deg)];
            let sets = sets.into_iter().filter(|(_, value)| *value != 0.0);
            let sets = sets.chain([("bore_diameter_mm", root_mm + by_mm)]);
            let sets: Vec<_> = sets.map(|(key, value)| format!("gear.{key}={value}")).collect();
            let sets: Vec<_> = sets.iter().flat_map(|set| ["--set", set]).collect();
            let outcome = gearcut(&[&["check", scene], &sets[..]].concat());
            assert_eq!(outcome.code == 0, fits, "{scene}, {sets:?}: {}", outcome.err);
            assert!(fits || outcome.err.contains("it reaches the tooth roots"), "{}", outcome.err);
        }
    }
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

/// The number before the words `after` on standard output.
fn number_before(out: &str, after: &str) -> f64 {
    let words = out.split(after).next().expect("words").split_whitespace().next_back().expect("a number");
    words.parse().unwrap_or_else(|_| panic!("{words} is no number"))
}

mod slow {
    use super::*;

    #[test]
    fn every_committed_scene_passes() {
        for process in PROCESSES.iter().map(|process| process.scene) {
            let scenes = std::fs::read_dir(format!("scenes/{}", process.name)).expect("the scenes are committed");
            let mut count = 0;
            for scene in
                scenes.map(|entry| entry.expect("a file").path()).filter(|p| p.extension().is_some_and(|e| e == "toml"))
            {
                let path = scene.display().to_string();
                let outcome = if process.name == "hobbing" {
                    // The forecast cuts pieces of a narrow face.
                    gearcut(&["check", &path, "--set", "gear.face_width_mm=2"])
                } else {
                    check_as_it_is(&path)
                };
                let outcome = outcome.done().says(&["Cost of the cut"]);
                assert!(
                    !outcome.out.contains("NaN")
                        && !outcome
                            .out
                            .split_whitespace()
                            .any(|word| word.trim_matches(|c: char| !c.is_alphanumeric()) == "inf"),
                    "{}",
                    outcome.out
                );
                // Words are broken where a terminal's line ends; bars cannot be.
                let bars = outcome.out.lines().filter(|line| line.ends_with('|'));
                let wide: Vec<&str> = bars.filter(|line| line.chars().count() > 80).collect();
                assert!(wide.is_empty(), "{}: {wide:#?}", scene.display());
                count += 1;
            }
            assert_eq!(count, process.scenes.lines().count(), "scenes for {}", process.name);
        }
    }

    /// What `check` expects of a hobbed gear, against all that its cut would do.
    #[test]
    fn the_cost_of_hobbing_is_that_of_its_plans() {
        const SCENE: &str = "scenes/hobbing/third_order_diagonal.toml";
        let settings =
            ["fields.flank.profile_spacing_um=60", "fields.flank.lead_spacing_um=60", "gear.face_width_mm=20"];
        let arguments = [&["check", SCENE][..], &settings.map(|setting| ["--set", setting]).concat()].concat();
        let out = gearcut(&arguments).done().out;
        let scene = load(Path::new(SCENE), &settings.map(str::to_owned)).expect("the scene").scene;
        let job = HobbingJob::new(&scene).expect("the gear");
        let cutter = HobCutter::new(&job).expect("passes");
        let (mut dexels, mut evaluations) = (0, 0);
        for (tooth, side) in (1..=35).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
            let field = cutter.rays(tooth, side).expect("a flank").1.field;
            let plan = SweepPlan::new(&field, &cutter.operations[0]);
            dexels += field.len();
            evaluations += plan.dexel_passes();
        }
        for (what, found, expected, tolerance) in [
            ("dexels", 1e6 * number_before(&out, " million in all"), dexels as f64, 0.02),
            ("evaluations", 1e6 * number_before(&out, " million dexels against"), evaluations as f64, 0.1),
        ] {
            println!("{what}: {found} estimated, {expected} planned");
            assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found} estimated, {expected} planned");
        }
    }
}

/// What `cut` refuses before its first cut, `check` and `axes` refuse in the same words, for every process.
#[test]
fn what_cut_refuses_is_refused_before() {
    let round = "scenes/shaping/circular_m3_z24.toml";
    let hobbed = "scenes/hobbing/circular_spur.toml";
    let bevel = "scenes/bevel/crown_gear.toml";
    let far = "texture=[{ tooth = 1, center_profile_mm = 30, length_profile_mm = 1 }]";
    let many = "texture=[{ tooth = 1, profile_spacing_um = 0.1, lead_spacing_um = 0.1 }]";
    let gone = "texture=[{ tooth = 99 }]";
    let fine = ["fields.blank.spacing_mm=0.001", "fields.blank.slice_spacing_mm=0.01"];
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let out = ["--out", out.to_str().expect("a path")];
    for (scene, settings, words) in [
        (round, &[gone][..], "teeth"),
        (hobbed, &[gone], "teeth"),
        (bevel, &[gone], "teeth"),
        (round, &[far], "does not lie on tooth 1 left"),
        (hobbed, &[far], "does not lie on tooth 1 left"),
        (round, &[many], "more than 8 million"),
        (hobbed, &fine, "fields.blank"),
    ] {
        let settings: Vec<&str> = settings.iter().flat_map(|setting| ["--set", setting]).collect();
        let run = |command: &str, more: &[&str]| gearcut(&[&[command, scene][..], &settings, more].concat());
        let refused = run("check", &[]).failed(1, &[words, "way out"]);
        for command in ["axes", "cut"] {
            let other = run(command, &out).failed(1, &[words]);
            assert!(other.err.contains(refused.err.trim_end()), "{command}: {}\ncheck: {}", other.err, refused.err);
        }
        assert!(!Path::new(out[1]).exists(), "{scene} {settings:?} left a folder");
    }
}

/// The angle at which a ratio passes zero, sin(phi) = -1 / 1.2, at the formula's place in the file; and the same gear
/// by its formula as by the built-in curve.
#[test]
fn a_pitch_curve_by_a_formula_is_checked_like_any_other() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let scene = |curve: &str| {
        let text = format!(
            "[gear]\nmodule_mm = 3.0\nteeth = 42\nface_width_mm = 20.0\n[gear.pitch_curve.{curve}\n\
            [tool.shaper_cutter]\nteeth = 20\n"
        );
        std::fs::write(folder.path().join("scene.toml"), text).expect("a scene");
        gearcut_in(folder.path(), &["check", "scene.toml"])
    };
    scene("ratio_formula]\nratio = \"1 + 1.2*sin(phi)\"").failed(
        1,
        &["scene.toml:6:9", "`1 + 1.2*sin(phi)` passes zero at 236.443 deg", "^^^", "way out: keep the ratio"],
    );
    let built_in = scene("sinusoidal_ratio]\norder = 2\nmean_ratio = 1.2\nratio_amplitude = 0.1").done();
    let formula = scene("ratio_formula]\nratio = \"1.2 + 0.1*sin(2*phi)\"").done();
    let curve = |text: &str| -> Vec<String> {
        let lines = text.lines().skip_while(|line| *line != "Pitch curve").take_while(|line| !line.is_empty());
        lines.filter(|line| !line.contains("driver of")).map(str::to_owned).collect()
    };
    assert!(curve(&formula.out).len() > 4);
    assert_eq!(curve(&built_in.out), curve(&formula.out));
    assert!(formula.out.contains("driver of the ratio 1.2 + 0.1*sin(2*phi)"), "{}", formula.out);
    // A mate turns by 2 pi / sqrt(c^2 - b^2) in a turn: 42 sqrt(1.43) teeth, and 42 where c^2 is 1 + b^2.
    assert!(formula.out.contains("50.225 teeth: no mate closes there"), "{}", formula.out);
    let closing = scene("ratio_formula]\nratio = \"sqrt(1.01) + 0.1*sin(2*phi)\"").done();
    assert!(closing.out.contains("external mate of that ratio   42 teeth\n"), "{}", closing.out);
}

/// Flanks run from 1.933 mm under the pitch circle to 3 mm over it: an end there is reached, one beyond is not, and the
/// active diameters are those of the flanks.
#[test]
fn ends_of_the_drawing_that_no_flank_reaches_are_noted() {
    let check = |ends: [f64; 2]| {
        let [start, end] = ends.map(|mm| format!("{mm:?}"));
        let ends = ["start", "end"].map(|end| format!("measure.profile_{end}_height_mm="));
        let settings = [format!("{}{start}", ends[0]), format!("{}{end}", ends[1])];
        let scene = ["check", "scenes/shaping/circular_m3_z24.toml"];
        gearcut(&[&scene[..], &["--set", &settings[0], "--set", &settings[1]]].concat()).done()
    };
    let noted = "48 flanks do not reach an end of [measure]";
    let [reached, beyond] = [[-1.5, 3.0], [-3.0, 4.0]].map(check);
    assert!(!reached.err.contains(noted) && beyond.err.contains(noted), "{}{}", reached.err, beyond.err);
    for (printed, [start_mm, end_mm]) in [(reached, ["69.", "78."]), (beyond, ["68.", "78."])] {
        let size = |name: &str| printed.out.lines().find(|line| line.contains(name)).expect("a size").to_owned();
        println!("{}\n{}", size("d_Nf"), size("d_Na"));
        assert!(size("d_Nf").contains(start_mm) && size("d_Na").contains(end_mm), "{}", printed.out);
    }
}
