//! A program under test and its ram: which strokes are made until the ram stops, and where the axes go between strokes.
//!
//! The scene's own program, written with a block for every stroke, gets other ends and excursions between two strokes.

use gearcut::findings::Severity;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::axes_report::programs;
use gearcut::process::shaping::findings::program;
use gearcut::process::shaping::motion::gcode::{AxisProgram, read};
use std::fmt::Write as _;
use std::path::Path;

const SCENE: &str = "scenes/shaping/circular_m3_z24.toml";
/// The stroke after which the axes leave their way.
const BEFORE: usize = 100;

fn job(more: &[String]) -> gearcut_core::Result<ShapingJob> {
    let settings = ["operation.rough.strokes_per_revolution=200", "operation.finish.strokes_per_revolution=200"];
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).chain(more.to_vec()).collect();
    let scene = load(Path::new(SCENE), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    ShapingJob::new(scene.scene)
}

/// The scene's own program.
fn own() -> AxisProgram {
    let job = job(&[]).expect("a gear");
    let text = programs::text(&job, &job.operations[1], &[]).expect("wanted").expect("written");
    read::program(&text).expect("its own program")
}

/// Words of the axes at a stroke coordinate, with millimetres added to X and degrees to B.
fn words(own: &AxisProgram, stroke: f64, [x_mm, b_deg]: [f64; 2]) -> String {
    let knot = own.at(stroke);
    let (x, c, b) = (knot.center_distance_mm + x_mm, -knot.psi_c_rad.to_degrees(), knot.psi_b_rad.to_degrees() + b_deg);
    format!("G93 G1 X{x:.9} C{c:.9} B{b:.9}")
}

/// The program with a block for every stroke, an excursion half-way after stroke [`BEFORE`], and an end.
fn text(own: &AxisProgram, excursion: Option<[f64; 2]>, end: &str) -> String {
    let per_minute = own.double_strokes_per_minute;
    let start = words(own, 0.0, [0.0; 2]).replace("G93 G1", "G0");
    let mut text = format!("G21 G90 G94\n{start}\nS{per_minute} M3\n");
    for stroke in 1..own.count() {
        let to = words(own, stroke as f64, [0.0; 2]);
        match excursion.filter(|_| stroke == BEFORE + 1) {
            None => writeln!(text, "{to} F{per_minute}"),
            Some(by) => {
                let out = words(own, BEFORE as f64 + 0.5, by);
                writeln!(text, "{out} F{0}\n{to} F{0}", 2.0 * per_minute)
            }
        }
        .expect("written");
    }
    text + end
}

/// The job that a program cuts.
fn cut_by(text: &str) -> gearcut_core::Result<ShapingJob> {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), text).expect("written");
    job(&[format!("operation.finish.program='{}'", file.path().display())])
}

/// Gravest severity and all sentences on a program.
fn verdict(text: &str) -> (Option<Severity>, String) {
    let job = cut_by(text).unwrap_or_else(|why| panic!("{why}"));
    let told = program::warnings(&job, &OperationAxes::of_job(&job));
    let words = told.iter().map(|of| of.text.as_str()).collect::<Vec<_>>().join("; ");
    (told.iter().map(|of| of.severity).max(), words)
}

/// A dwell of so many double strokes.
fn dwell(own: &AxisProgram, strokes: f64) -> String {
    format!("G4 P{:.9}\n", 60.0 * strokes / own.double_strokes_per_minute)
}

#[test]
fn strokes_are_counted_until_the_ram_stops() {
    let own = own();
    let (count, stroke) = (own.count(), dwell(&own, 1.0));
    let in_the_gear = words(&own, count as f64 - 1.0, [-5.0, 0.0]) + " F1000000\n";
    for (end, told) in [
        (format!("{stroke}M5\nM30\n"), None),
        // A control that takes milliseconds rounds a dwell up.
        (format!("{}M5\nM30\n", dwell(&own, 1.01)), None),
        (format!("{stroke}M30\n"), None),
        (format!("{stroke}M5\nG0 X500\nM30\n"), None),
        (format!("{stroke}M5\nG4 P5\nG94 G1 X500 F100\nM30\n"), None),
        (
            "M5\nM30\n".to_owned(),
            Some(format!("1 of the scene's strokes is missing from the program, stroke {}", count - 1)),
        ),
        (
            format!("{}M5\nM30\n", dwell(&own, 2.0)),
            Some(format!("1 stroke of the program is made twice, stroke {count}")),
        ),
        (
            format!("{stroke}{stroke}{stroke}M30\n"),
            Some(format!("2 strokes of the program are made twice, the first is stroke {count}")),
        ),
        (
            format!("{in_the_gear}{}M5\nM30\n", dwell(&own, 100.0)),
            Some(format!("99 strokes of the program are none of the scene's, the first is stroke {count}")),
        ),
        (format!("{in_the_gear}{stroke}M5\nM30\n"), Some("between strokes".to_owned())),
    ] {
        let (severity, words) = verdict(&text(&own, None, &end));
        match told {
            None => assert_eq!((severity, words.as_str()), (None, ""), "{end}"),
            Some(told) => assert!(severity == Some(Severity::Fault) && words.contains(&told), "{end}: {words}"),
        }
    }
}

#[test]
fn a_ram_that_runs_on_is_refused_and_so_is_one_without_a_stroke() {
    let own = own();
    let cut = cut_by(&text(&own, None, "G4 P100000\nM5\nM30\n"));
    let why = cut.map(|_| ()).expect_err("666,666 strokes").to_string();
    assert!(why.contains("more than 10 times as many"), "{why}");
    let why = read::program("G21 G90\nG0 X90 C0 B0\nS300 M3\nM5\nM30\n").expect_err("no stroke");
    assert!(why.contains("line 4") && why.contains("M5") && why.contains("before it has made a stroke"), "{why}");
}

#[test]
fn an_excursion_between_two_strokes_is_told() {
    let own = own();
    let end = dwell(&own, 1.0) + "M5\nM30\n";
    let job = job(&[]).expect("a gear");
    let clearance_mm = OperationAxes::new(&job, 1).relief().clearance_mm(job.machine.back_off_mm);
    assert!(clearance_mm > 0.1, "{clearance_mm} mm");
    for (by, expected) in [
        ([0.0, 0.0], None),
        // Drawn back, and less far in than the relief holds the cutter off.
        ([31.0, 0.0], None),
        ([-0.9 * clearance_mm, 0.0], None),
        ([-1.05 * clearance_mm, 0.0], Some(Severity::Warning)),
        ([-1.5 * clearance_mm, 0.0], Some(Severity::Fault)),
        ([-29.0, 0.0], Some(Severity::Fault)),
        ([0.0, 2.0], Some(Severity::Fault)),
    ] {
        let (severity, words) = verdict(&text(&own, Some(by), &end));
        assert_eq!(severity, expected, "{by:?}: {words}");
        assert!(
            expected.is_none() || words.contains("between strokes") && words.contains("at stroke 100.5"),
            "{words}"
        );
    }
    // In no time at all, on the way or where a stroke stands.
    let (there, back) = (words(&own, 50.0, [-20.0, 0.0]), words(&own, 50.0, [0.0; 2]));
    let text = text(&own, None, &end);
    let at = text.find(&back).expect("stroke 50");
    let after = at + text[at..].find('\n').expect("more lines") + 1;
    for feed in ["1000000", "1000000000"] {
        let (before, rest) = text.split_at(after);
        let (severity, words) = verdict(&format!("{before}{there} F{feed}\n{back} F{feed}\n{rest}"));
        assert!(severity == Some(Severity::Fault) && words.contains("between strokes"), "F{feed}: {words}");
    }
}
