//! Forty defects planted in a program, with the verdict that each must get; the program itself gets none.
//!
//! A program with a knot for every stroke is what a shop would run; each defect is one that a hand, a post-processor or
//! a wrong table leaves in it. Nothing is cut: the judgement compares axes with the scene's own strokes.

use crate::fixtures::own_program::{own_program, renumbered};
use gearcut::findings::Severity;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::findings::program;
use gearcut::process::shaping::motion::gcode::{AxisProgram, Knot};
use std::path::Path;

const SCENE: &str = "scenes/shaping/elliptical_normal.toml";
/// Strokes of the operation under test: a turn of the work.
const STROKES: usize = 840;

fn job(more: &[&str]) -> ShapingJob {
    let settings = ["operation.rough.strokes_per_revolution=840", "operation.finish.strokes_per_revolution=840"];
    let settings: Vec<String> = settings.iter().chain(more).map(|&setting| setting.to_owned()).collect();
    let scene = load(Path::new(SCENE), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    ShapingJob::new(scene.scene).expect("a gear")
}

/// Gravest severity and all sentences on a program.
fn verdict(job: &mut ShapingJob, planted: AxisProgram) -> (Option<Severity>, String) {
    job.operations[1].program = Some(planted);
    let motion = OperationAxes::of_job(job);
    let told = program::warnings(job, &motion);
    let exceeded = gearcut::steps::axes::warnings(&motion).into_iter().filter(|of| of.severity == Severity::Fault);
    let told: Vec<_> = told.into_iter().chain(exceeded).collect();
    let words = told.iter().map(|of| of.text.as_str()).collect::<Vec<_>>().join("; ");
    (told.iter().map(|of| of.severity).max(), words)
}

type Plant = Box<dyn Fn(AxisProgram) -> AxisProgram>;

/// What is planted: a name, the verdict, words of it, and the defect.
type Case = (String, Severity, String, Plant);

/// The same change of every knot.
fn all(change: impl Fn(&mut Knot) + 'static) -> Plant {
    Box::new(move |mut program| {
        program.knots.iter_mut().for_each(&change);
        program
    })
}

/// A change of one knot.
fn one(stroke: usize, change: impl Fn(&mut Knot) + 'static) -> Plant {
    Box::new(move |mut program| {
        change(&mut program.knots[stroke]);
        program
    })
}

fn cases() -> Vec<Case> {
    use Severity::{Fault, Warning};
    let mut cases: Vec<Case> = Vec::new();
    let mut add = |name: String, severity: Severity, words: String, plant: Plant| {
        cases.push((name, severity, words, plant));
    };
    // Strokes removed: one, five, 120, anywhere.
    for (count, from) in [(1, 1), (1, 100), (1, 417), (1, 838), (2, 300), (5, 200), (5, 700), (20, 50), (120, 400)] {
        let words = if count == 1 {
            format!("1 of the scene's strokes is missing from the program, stroke {from}")
        } else {
            format!("{count} of the scene's strokes are missing from the program, the first is stroke {from}")
        };
        add(
            format!("{count} removed from {from} on"),
            Fault,
            words,
            Box::new(move |mut program| {
                program.knots.drain(from..from + count);
                renumbered(program)
            }),
        );
    }
    // Strokes made twice.
    for (count, from) in [(1, 1), (1, 250), (1, 800), (3, 400), (12, 600)] {
        let words = if count == 1 {
            "1 stroke of the program is made twice".to_owned()
        } else {
            format!("{count} strokes of the program are made twice")
        };
        add(
            format!("{count} doubled from {from} on"),
            Fault,
            words,
            Box::new(move |mut program| {
                let again = program.knots[from..from + count].to_vec();
                program.knots.splice(from..from, again);
                renumbered(program)
            }),
        );
    }
    // One stroke off its place: half a feed, five feeds, the radial axis a millimetre in.
    for stroke in [3, 420, 836] {
        add(
            format!("stroke {stroke} half a feed ahead"),
            Fault,
            "1 stroke of the program is none of the scene's".to_owned(),
            Box::new(move |mut program| {
                let (a, b) = (program.knots[stroke], program.knots[stroke + 1]);
                program.knots[stroke].psi_c_rad = 0.5 * (a.psi_c_rad + b.psi_c_rad);
                program.knots[stroke].psi_b_rad = 0.5 * (a.psi_b_rad + b.psi_b_rad);
                program
            }),
        );
    }
    let off = || "lies up to".to_owned();
    add("stroke 210 a millimetre deep".to_owned(), Fault, off(), one(210, |k| k.center_distance_mm -= 1.0));
    add("stroke 211 0.1 mm deep".to_owned(), Fault, off(), one(211, |k| k.center_distance_mm -= 0.1));
    add("stroke 212 a jump of 594 mm".to_owned(), Fault, off(), one(212, |k| k.center_distance_mm -= 594.0));
    add("stroke 213 two micrometres deep".to_owned(), Warning, off(), one(213, |k| k.center_distance_mm -= 0.002));
    add("stroke 215 1.2 um deep".to_owned(), Warning, off(), one(215, |k| k.center_distance_mm -= 0.0012));
    add("stroke 214 15 um deep".to_owned(), Warning, off(), one(214, |k| k.center_distance_mm -= 0.015));
    // The ram.
    for factor in [0.5, 0.99, 1.01, 2.0] {
        add(
            format!("S times {factor}"),
            Fault,
            "the program's S is".to_owned(),
            Box::new(move |mut program| {
                program.double_strokes_per_minute *= factor;
                program
            }),
        );
    }
    // Signs, units, tables.
    add("work turns the other way".to_owned(), Fault, off(), all(|k| k.psi_c_rad = -k.psi_c_rad));
    add("cutter turns the other way".to_owned(), Fault, off(), all(|k| k.psi_b_rad = -k.psi_b_rad));
    add(
        "work and cutter changed over".to_owned(),
        Fault,
        off(),
        all(|k| {
            std::mem::swap(&mut k.psi_b_rad, &mut k.psi_c_rad);
        }),
    );
    add("inches for millimetres".to_owned(), Fault, off(), all(|k| k.center_distance_mm /= 25.4));
    add("radians for degrees".to_owned(), Fault, off(), all(|k| k.psi_c_rad = k.psi_c_rad.to_radians()));
    add("a tooth more on the cutter".to_owned(), Fault, off(), all(|k| k.psi_b_rad *= 20.0 / 21.0));
    add("a tooth less on the cutter".to_owned(), Fault, off(), all(|k| k.psi_b_rad *= 20.0 / 19.0));
    add("a tooth more on the gear".to_owned(), Fault, off(), all(|k| k.psi_b_rad *= 43.0 / 42.0));
    // Offsets of an axis.
    add("centre distance 0.5 mm out".to_owned(), Fault, off(), all(|k| k.center_distance_mm += 0.5));
    add("centre distance 10 um in".to_owned(), Warning, off(), all(|k| k.center_distance_mm -= 0.01));
    add("cutter half a degree round".to_owned(), Fault, off(), all(|k| k.psi_b_rad += 0.5_f64.to_radians()));
    add("cutter a degree round".to_owned(), Fault, off(), all(|k| k.psi_b_rad += 1.0_f64.to_radians()));
    // Slow drifts.
    add(
        "centre distance drifts by 50 um".to_owned(),
        Fault,
        off(),
        all(|k| {
            k.center_distance_mm += 0.05 * k.stroke / STROKES as f64;
        }),
    );
    add(
        "centre distance drifts by 5 um".to_owned(),
        Warning,
        off(),
        all(|k| {
            k.center_distance_mm += 0.005 * k.stroke / STROKES as f64;
        }),
    );
    cases
}

#[test]
fn forty_planted_defects_get_their_verdicts() {
    let mut job = job(&[]);
    let own = own_program(&job);
    assert_eq!(own.knots.len(), STROKES);
    assert_eq!(verdict(&mut job, own.clone()), (None, String::new()), "the program itself");
    let cases = cases();
    assert!(cases.len() >= 40, "{} cases", cases.len());
    let mut wrong = Vec::new();
    for (name, severity, words, plant) in &cases {
        let (found, told) = verdict(&mut job, plant(own.clone()));
        if found != Some(*severity) || !told.contains(words.as_str()) {
            wrong.push(format!("{name}: {found:?}: {told}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

/// A gouge of a micrometre is what a program may be off where `output.gcode_contour_error_um` asks for 1: both sides of
/// the rule, and where less is asked.
#[test]
fn a_micrometre_deep_is_within_what_is_asked() {
    let deep = |depth_um: f64, asked: &[&str]| {
        let mut job = job(asked);
        let mut planted = own_program(&job);
        planted.knots[213].center_distance_mm -= 1e-3 * depth_um;
        verdict(&mut job, planted)
    };
    assert_eq!(deep(1.0, &[]), (None, String::new()));
    for (depth_um, asked) in [(1.01, &[][..]), (1.0, &["output.gcode_contour_error_um=0.9"])] {
        let (severity, told) = deep(depth_um, asked);
        assert_eq!(severity, Some(Severity::Warning), "{depth_um} um: {told}");
        assert!(told.contains("um off the scene's own strokes, at stroke 213"), "{told}");
    }
}

/// A jump in one stroke shows in the program's own speeds, whatever the schedule asks of the axes.
#[test]
fn a_jump_is_judged_against_the_limits_of_the_axes() {
    let limits = ["machine.limits.center_distance_speed_mm_per_s=50"];
    let mut job = job(&limits);
    let mut jump = own_program(&job);
    jump.knots[300].center_distance_mm -= 594.0;
    let strokes_per_s = jump.double_strokes_per_minute / 60.0;
    let (severity, told) = verdict(&mut job, jump);
    assert_eq!(severity, Some(Severity::Fault));
    let speed = OperationAxes::new(&job, 1);
    let peaks = gearcut::steps::axes::AxesOfOperation::peaks(&speed);
    let fastest = peaks.iter().find(|peak| peak.name().ends_with("distance speed")).expect("a peak");
    // 594 mm in the time of one double stroke, but for the schedule's own micrometres.
    assert!((fastest.value / (594.0 * strokes_per_s) - 1.0).abs() < 1e-3, "{} mm/s", fastest.value);
    assert!(told.contains("the machine allows 50.00 mm/s"), "{told}");
    assert!(program::not_of_the_gear(&job, &OperationAxes::of_job(&job)).is_some());
}
