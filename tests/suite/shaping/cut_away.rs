//! A gear of which flanks are cut away, by an operation or by a program: nothing of the scene's gear stands for it.

use crate::fixtures::command::gearcut;
use crate::fixtures::own_program::{own_program, renumbered};
use gearcut::cut::cpu::Cpu;
use gearcut::findings::Section;
use gearcut::interrupt::Interrupt;
use gearcut::process::load;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::motion::gcode::{AxisProgram, Knot};
use gearcut::process::shaping::{ShapingJob, cut_gear, findings};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::steps::parts::Stages;
use std::path::Path;

const COARSE: [&str; 4] = [
    "fields.flank.profile_spacing_um=50",
    "fields.flank.lead_spacing_um=10000",
    "operation.rough.strokes_per_revolution=600",
    "operation.finish.strokes_per_revolution=600",
];
/// What follows from the meshing condition alone.
const OF_THE_SCENE: [&str; 4] = ["start_of_flank", "undercut_flanks", "tip_land", "pointed_teeth"];

fn job(settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = COARSE.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
    let scene = load(Path::new("scenes/shaping/circular_m3_z24.toml"), &settings);
    ShapingJob::new(scene.unwrap_or_else(|problems| panic!("{problems}")).scene).expect("a gear")
}

/// The finishing operation's own strokes with a change.
fn planted(job: &ShapingJob, change: impl Fn(&mut Vec<Knot>)) -> AxisProgram {
    let mut program = own_program(job);
    change(&mut program.knots);
    renumbered(program)
}

#[test]
fn headlines_of_a_gear_that_is_cut_away_are_not_those_of_the_scene() {
    // Roughed 5 mm too deep, every flank is gone.
    for offset_mm in ["0.3", "-5"] {
        let offset = format!("operation.rough.offset_mm={offset_mm}");
        let job = job(&[&offset]);
        let progress = Progress::new(ProgressMode::Quiet);
        let gear =
            cut_gear(&job, Stages::ALL, &Cpu::default(), (&progress, &Interrupt::default()), None).expect("a gear");
        let lost = gear.report.flanks.iter().filter(|flank| flank.own.is_lost).count();
        let motion = OperationAxes::of_job(&job);
        let headline = findings::headline(&job, &gear, &motion);
        let of = |key: &str| &headline.iter().find(|entry| entry.key == key).expect("an entry").quantity;
        assert_eq!(lost, if offset_mm == "-5" { 48 } else { 0 });
        for key in OF_THE_SCENE {
            let why = of(key).why().unwrap_or_default();
            assert_eq!(why.contains("48 of 48 flanks are cut away"), lost > 0, "{key}: {why}");
            assert_eq!(of(key).value().is_some(), lost == 0, "{key}");
        }
        let sections = findings::sections(&job, &gear.report, &gear.chips, &motion).expect("sections");
        let teeth = sections.iter().find(|section| section.key == "teeth").expect("teeth");
        for path in ["tooth_01/tip_land", "tooth_24/right/start_of_flank", "tooth_07/left/tip_height"] {
            assert_eq!(number(teeth, path).is_some(), lost == 0, "{path}");
        }
        assert_eq!(of("smallest_tooth_thickness").value().is_some(), lost == 0);
    }
}

/// Where one tooth of 24 has a flank that is cut away, the thickness is that of the others and says so.
#[test]
fn the_thickness_says_of_how_many_teeth_it_is() {
    let job = job(&[]);
    let progress = Progress::new(ProgressMode::Quiet);
    let mut gear =
        cut_gear(&job, Stages::ALL, &Cpu::default(), (&progress, &Interrupt::default()), None).expect("a gear");
    gear.report.flanks[4].own.is_lost = true;
    gear.report.inspection.thickness[2] = None;
    let headline = findings::headline(&job, &gear, &OperationAxes::of_job(&job));
    for key in ["smallest_tooth_thickness", "largest_tooth_thickness"] {
        let thickness = &headline.iter().find(|of| of.key == key).expect("an entry").quantity;
        assert!(thickness.value().is_some());
        assert!(thickness.definition().ends_with("of 23 of 24 teeth; the others are cut away"), "{thickness:?}");
    }
}

/// The number at a path below a section.
fn number(section: &Section, path: &str) -> Option<f64> {
    match path.split_once('/') {
        Some((part, rest)) => number(section.sections.iter().find(|of| of.key == part).expect("a part"), rest),
        None => section.entries.iter().find(|entry| entry.key == path).expect("an entry").quantity.value(),
    }
}

#[test]
fn the_summary_says_how_many_flanks_are_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let scene = "scenes/shaping/circular_m3_z24.toml";
    let mut arguments = vec!["cut", scene, "--draft", "--backend", "cpu", "--only", "numbers"];
    arguments.extend(["--out", out.to_str().expect("a path"), "--set", "operation.rough.offset_mm=-5"]);
    let told = gearcut(&arguments).out;
    assert!(told.contains("48 of 48 flanks cut, 48 of them away"), "{told}");
}

#[test]
fn a_stroke_off_or_missing_makes_another_gear() {
    let mut job = job(&[]);
    let with = |job: &mut ShapingJob, program| {
        job.operations[1].program = Some(program);
        findings::program::not_of_the_gear(job, &OperationAxes::of_job(job))
    };
    let own = planted(&job, |_| ());
    assert_eq!(with(&mut job, own), None);
    let off = planted(&job, |knots| {
        let (a, b) = (knots[203], knots[204]);
        knots[203].psi_c_rad = 0.5 * (a.psi_c_rad + b.psi_c_rad);
        knots[203].psi_b_rad = 0.5 * (a.psi_b_rad + b.psi_b_rad);
    });
    let missing = planted(&job, |knots| drop(knots.drain(203..213)));
    for (program, words) in [(off, "makes 1 that"), (missing, "leaves out 10")] {
        let why = with(&mut job, program).expect("another gear");
        assert!(why.contains("own strokes alone") && why.contains(words), "{why}");
    }
}
