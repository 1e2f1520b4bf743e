//! Tips of teeth: rays that pass through a thin one into the next space, and rays of the tip corner that rounding or a
//! shift of the gear leaves uncut, are no defects; what is cut away or left is told.

use crate::fixtures::command::gearcut;
use gearcut::cut::cpu::Cpu;
use gearcut::findings::{Notice, Severity};
use gearcut::interrupt::Interrupt;
use gearcut::process::load;
use gearcut::process::shaping::findings::warnings;
use gearcut::process::shaping::gear::measure::GearReport;
use gearcut::process::shaping::{ShapingJob, cut_gear};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::steps::parts::Stages;

/// A scene, cut; what its flanks, not its blank, say.
fn cut(scene: &str, settings: &[&str]) -> (GearReport, Vec<Notice>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene).expect("written");
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scene = load(&path, &settings).unwrap_or_else(|problems| panic!("{problems}"));
    let job = ShapingJob::new(scene.scene).expect("a gear");
    let progress = Progress::new(ProgressMode::Quiet);
    let gear = cut_gear(&job, Stages::ALL, &Cpu::default(), (&progress, &Interrupt::default()), None).expect("a gear");
    let told = warnings::after(&job, &gear.report, &gear.chips, &gear.work, None);
    (gear.report, told)
}

fn has(told: &[Notice], words: &str) -> bool {
    told.iter().any(|of| of.text.contains(words))
}

/// Twelve teeth with a tip land of a fifteenth of a module or none.
const THIN: &str = "[gear]\nmodule_mm = 3.0\nteeth = 12\nface_width_mm = 5\nprofile_shift_coefficient = 0.8\n\
                    [tool.shaper_cutter]\nteeth = 20\n";
const POINTED: [&str; 2] = ["gear.profile_shift_coefficient=0.4", "gear.addendum_coefficient=2"];
const COARSE: [&str; 2] = ["fields.flank.profile_spacing_um=20", "fields.flank.lead_spacing_um=2500"];

/// Roots of the cutter below the gear's tips top it by the difference of dedendum and addendum, outside and in a ring,
/// and by the more the deeper it stands: inv(a') = inv(20 deg) + 0.5 / 60 has it 0.639 mm beyond the ring's distance.
#[test]
fn a_cutter_with_short_roots_is_said_to_top_the_gear() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("short.toml");
    for (kind, teeth, more, code, words) in [
        ("external", 30, "tool.shaper_cutter.dedendum_coefficient=0.9", 3, "takes 200 um off the tips"),
        ("internal", 50, "tool.shaper_cutter.dedendum_coefficient=0.995", 0, "takes 10.0 um off the tips"),
        ("internal", 50, "gear.tooth_thickness_allowance_mm=-0.5", 3, "takes 139 um off the tips"),
        ("external", 30, "tool.shaper_cutter.dedendum_coefficient=1", 0, ""),
    ] {
        let gear = format!("[gear]\nkind = \"{kind}\"\nmodule_mm = 2.0\nteeth = {teeth}\nface_width_mm = 5\n");
        std::fs::write(&scene, gear + "[tool.shaper_cutter]\nteeth = 20\n").expect("written");
        let said = gearcut(&["check", scene.to_str().expect("a path"), "--set", more]);
        assert_eq!(said.code, code, "{kind}, {more}: {}", said.err);
        assert!(said.err.contains(words), "{kind}, {more}: {}", said.err);
        assert_eq!(said.err.contains("off the tips"), !words.is_empty(), "{}", said.err);
    }
}

#[test]
fn a_ray_through_a_thin_tip_is_no_gouge() {
    for more in [&[][..], &POINTED] {
        let (report, told) = cut(THIN, &[&COARSE[..], more].concat());
        assert!(!has(&told, "below the target") && !has(&told, "rays record"), "{more:?}: {told:?}");
        for flank in &report.flanks {
            let [lowest, _] = flank.own.finished.expect("a finished flank");
            assert!(lowest.value_mm > -1e-6 && flank.own.below_range == 0 && !flank.own.is_lost, "{lowest:?}");
        }
    }
}

/// A roughing 0.2 mm too deep takes 70 um off every flank.
#[test]
fn a_gouge_at_a_thin_tip_is_found() {
    let deep = ["operation=[{name=\"rough\",offset_mm=-0.2,strokes_per_revolution=600},{name=\"finish\"}]"];
    let (report, told) = cut(THIN, &[&COARSE[..], &deep].concat());
    assert!(told.iter().any(|of| of.severity == Severity::Fault && of.text.contains("24 flanks are cut below")));
    for flank in &report.flanks {
        let deepest_mm = flank.own.below_target.expect("a cut").value_mm;
        assert!((-0.1..-0.05).contains(&deepest_mm) && flank.own.below_range == 0, "{deepest_mm} mm");
    }
}

/// Ten finishing strokes turn the cutter by 0.1 degrees, some 50 um at its pitch circle, where they finish the tip of a
/// flank: the gouge is found there.
#[test]
fn a_gouge_of_a_thin_tip_alone_is_found() {
    const STROKES: usize = 600;
    let operations = |program: &str| {
        format!(
            "operation=[{{name=\"rough\",offset_mm=0.3,strokes_per_revolution={STROKES}}},\
             {{name=\"finish\",strokes_per_revolution={STROKES}{program}}}]"
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_str().expect("a path").to_owned();
    std::fs::write(at("thin.toml"), THIN).expect("written");
    let code = gearcut(&["axes", &at("thin.toml"), "--out", &at("axes"), "--set", &operations("")]).code;
    assert_eq!(code, 0);
    let own = std::fs::read_to_string(at("axes/axes/finish.ngc")).expect("a program");
    // A block to stroke 332 of the turn, to the next with the cutter turned, nine so, one back, and the rest.
    let mut blocks = String::new();
    let mut stroke = 0.0;
    for (strokes, turned_deg) in [(332.0, 0.0), (1.0, 0.1), (9.0, 0.1), (1.0, 0.0), (256.0, 0.0)] {
        stroke += strokes;
        let work_deg = 4.2 + 0.6 * stroke;
        let (cutter_deg, rate) = (0.6 * work_deg + turned_deg, 400.0 / strokes);
        blocks.extend([format!("N60 G93 G1 X50.0970 C-{work_deg:.5} B{cutter_deg:.5} F{rate:.9}\n")]);
    }
    let whole_turn = own.lines().find(|line| line.starts_with("N60 G93 G1 X50.0970 C-363.60000")).expect("a turn");
    std::fs::write(at("turned.ngc"), own.replace(&format!("{whole_turn}\n"), &blocks)).expect("written");
    let named = operations(&format!(",program=\"{}\"", at("turned.ngc")));
    let (report, told) = cut(THIN, &[&COARSE[..], &[named.as_str()]].concat());
    let deepest = report.flanks.iter().filter_map(|flank| Some((flank, flank.own.below_target?)));
    let found: Vec<(f64, f64)> = deepest.map(|(flank, of)| (of.arc_mm / flank.length_mm, of.value_mm)).collect();
    assert!(found.iter().any(|&(share, mm)| share > 0.9 && mm < -0.02), "{found:?}");
    assert!(has(&told, "below the target") && !has(&told, "rays record"), "{told:?}");
}

/// An oval whose last columns, at the tip corner, the blank's outline keeps; and a gear clamped 20 um off its axis.
const OVAL: &str = "[gear]\nmodule_mm = 2.0\nteeth = 24\nface_width_mm = 6\n[gear.pitch_curve.ellipse]\norder = 2\n\
                    eccentricity = 0.3\n[tool.shaper_cutter]\nteeth = 20\n[machine.limits]\nwork_speed_deg_per_s = \
                    100\n";
const ROUND: &str = "[gear]\nmodule_mm = 3.0\nteeth = 18\nface_width_mm = 6\n[tool.shaper_cutter]\nteeth = 20\n\
                     [mounting]\neccentricity_um = 20\n";

#[test]
fn rays_of_the_tip_corner_are_no_blank_left() {
    for scene in [OVAL, ROUND] {
        let (report, told) = cut(scene, &["fields.flank.lead_spacing_um=3000"]);
        let untouched: u64 = report.flanks.iter().map(|flank| flank.untouched).sum();
        assert!(untouched > 0, "no ray is left: the scene says nothing");
        assert!(!has(&told, "reached by no pass"), "{told:?}");
    }
}

/// Clamped 0.5 mm off its axis, the gear keeps a strip of the blank's outline at its tips: told, with its place.
#[test]
fn blank_left_on_a_flank_is_told_with_its_place() {
    let (report, told) = cut(ROUND, &["mounting.eccentricity_um=500", "fields.flank.lead_spacing_um=3000"]);
    let most = report.flanks.iter().max_by_key(|flank| flank.untouched).expect("a flank");
    let text = &told.iter().find(|of| of.text.contains("reached by no pass")).expect("told").text;
    let place = format!("tooth {} {}", most.tooth, most.side.name());
    assert!(text.contains(&place) && text.contains("mm above the start of the involute"), "{text}");
}
