//! Programs of hobbing machines under test: read back they cut the same flanks, and a wrong one is told.

use gearcut::cut::cpu::Cpu;
use gearcut::findings::{Notice, Severity};
use gearcut::job::GearJob as _;
use gearcut::process::hobbing::axes_report::HobbingAxesReport;
use gearcut::process::hobbing::gcode::texts;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::steps::axes::AxesOfOperation;
use gearcut::terms::Side;
use std::fmt::Write as _;
use std::path::Path;

const COARSE: &str = "operation.finish.axial_feed_mm_per_revolution=10";

fn load_job(scene: &str, settings: &[String]) -> gearcut::Result<HobbingJob> {
    let path = format!("scenes/hobbing/{scene}.toml");
    HobbingJob::new(&load(Path::new(&path), settings).unwrap_or_else(|e| panic!("{e}")).scene)
}

/// The scene, cut by the text of a program.
fn cut_by(scene: &str, settings: &[&str], program: &str) -> gearcut::Result<HobbingJob> {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), program).expect("written");
    let mut settings: Vec<String> = settings.iter().map(|&set| set.to_owned()).collect();
    settings.push(format!("operation.finish.program='{}'", file.path().display()));
    load_job(scene, &settings)
}

fn own(scene: &str, settings: &[&str]) -> (HobbingJob, String) {
    let settings: Vec<String> = settings.iter().map(|&set| set.to_owned()).collect();
    let job = load_job(scene, &settings).expect("a gear");
    let [full, _] = texts(&job, job.finishing(), &[]).expect("wanted").unwrap_or_else(|why| panic!("{scene}: {why}"));
    (job, full)
}

/// Heights of both flanks of some teeth on a few profiles along the face, mm.
fn heights(job: &HobbingJob) -> Vec<f64> {
    let cutter = HobCutter::new(job).expect("passes");
    let mut heights = Vec::new();
    for (tooth, side) in [(1, Side::Left), (5, Side::Right)] {
        let length_mm = cutter.target(tooth, side).expect("a flank").length_mm();
        let arcs_mm: Vec<f64> = (1..6).map(|i| length_mm * f64::from(i) / 6.0).collect();
        let layers = cutter.cut_flank(&Cpu::default(), tooth, side, &arcs_mm, &[-1.3, 0.4, 2.1]).expect("cut");
        heights.extend(layers.last().expect("an operation").heights_mm.iter().map(|&height| f64::from(height)));
    }
    heights
}

fn told(job: &HobbingJob) -> Vec<Notice> {
    HobbingAxesReport::of_job(job).iter().flat_map(AxesOfOperation::own_warnings).collect()
}

#[test]
fn a_program_read_back_cuts_the_same_flanks() {
    for (scene, settings) in [("circular_spur", &[][..]), ("third_order_diagonal", &[COARSE][..])] {
        for error_um in ["10", "1"] {
            let contour = format!("output.gcode_contour_error_um={error_um}");
            let settings = [settings, &[contour.as_str()]].concat();
            let (job, program) = own(scene, &settings);
            let under_test = cut_by(scene, &settings, &program).expect("its own program");
            let pairs = heights(&job).into_iter().zip(heights(&under_test));
            let worst_mm = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let asked_mm = 1e-3 * error_um.parse::<f64>().expect("a number");
            let judged = HobbingAxesReport::of_job(&under_test)[0].program().expect("judged").clone();
            println!("{scene}, {error_um} um asked: flanks {worst_mm:.2e} mm off, {judged:?}");
            // A flank sees the part of the displacement that is normal to it; the digits of F leave nanometres.
            assert!(worst_mm <= 1.01 * asked_mm, "{scene}: {worst_mm:e} mm");
            let about_programs = |told: Vec<Notice>| told.into_iter().filter(|of| of.text.contains("the program"));
            assert_eq!(about_programs(told(&under_test)).next(), None, "{scene}");
            assert!(judged.distance_mm <= asked_mm && judged.missing < 1e-9, "{judged:?}");
        }
    }
}

/// The program with every block changed by `change`, which gets its number and its words.
fn changed(program: &str, change: impl Fn(usize, &mut Vec<String>)) -> String {
    let (mut text, mut block) = (String::new(), 0);
    for line in program.lines() {
        let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        if line.starts_with('N') && line.contains(" G1 ") {
            change(block, &mut words);
            block += 1;
        }
        let _ = writeln!(text, "{}", words.join(" "));
    }
    assert!(block > 0, "no blocks");
    text
}

fn add(words: &mut [String], letter: char, by: f64) {
    let word = words.iter_mut().find(|word| word.starts_with(letter)).expect("a word");
    let value: f64 = word[1..].parse().expect("a number");
    *word = format!("{letter}{:.7}", value + by);
}

#[test]
fn wrong_programs_are_told_and_seen_on_the_flanks() {
    use Severity::{Fault, Warning};
    let scene = "circular_spur";
    let (job, program) = own(scene, &[]);
    let direct = heights(&job);
    // The first position as well.
    let moved = |letter: char, by: f64| {
        let shifted = |line: &str| {
            let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            add(&mut words, letter, by);
            words.join(" ")
        };
        let lines = program.lines().map(|line| if line.contains(" G0 ") { shifted(line) } else { line.to_owned() });
        changed(&lines.collect::<Vec<_>>().join("\n"), |_, words| add(words, letter, by))
    };
    let mean = |under_test: &HobbingJob| {
        let pairs = direct.iter().zip(heights(under_test));
        pairs.map(|(a, b)| b - a).sum::<f64>() / direct.len() as f64
    };
    // Radially out by a tenth of a millimetre: all flanks keep about 0.1 sin(20 deg) more.
    let text = moved('Y', 0.1);
    let out = cut_by(scene, &[], &text).expect("judged, not refused");
    let expected_mm = 0.1 * 20_f64.to_radians().sin();
    assert!((mean(&out) - expected_mm).abs() < 0.03 * expected_mm, "{} mm", mean(&out));
    let slow = changed(&program, |_, words| {
        let word = words.iter_mut().find(|word| word.starts_with('F')).expect("a feed");
        *word = format!("F{:.9}", 0.5 * word[1..].parse::<f64>().expect("a number"));
    });
    // Straight lines of a round gear: the last one ends half way.
    let axes = |line: &str| -> Vec<(char, f64)> {
        let words = line.split(' ').filter(|word| word.starts_with(['X', 'Y', 'Z', 'B', 'C']));
        words.map(|word| (word.chars().next().unwrap_or(' '), word[1..].parse().expect("a number"))).collect()
    };
    let ends: Vec<&str> = program.lines().filter(|line| line.contains(" G0 ") || line.contains(" G1 ")).collect();
    let [from, to] = [ends[ends.len() - 2], ends[ends.len() - 1]].map(axes);
    let cut_off = changed(&program, |block, words| {
        if block == ends.len() - 2 {
            for (&(letter, from), &(_, to)) in from.iter().zip(&to) {
                add(words, letter, 0.5 * (from - to));
            }
            let feed = words.iter_mut().find(|word| word.starts_with('F')).expect("a feed");
            *feed = format!("F{:.9}", 2.0 * feed[1..].parse::<f64>().expect("a number"));
        }
    });
    for (name, text, severity, words) in [
        ("0.1 mm out", &text, Fault, "um off the scene's own motion"),
        ("3 um in", &moved('Y', -0.003), Warning, "um off the scene's own motion"),
        ("work 0.1 deg round", &moved('C', 0.1), Fault, "um off the scene's own motion"),
        ("half the speed", &slow, Fault, "s for what the scene does in"),
        ("half of the last block missing", &cut_off, Fault, "leaves out, of the scene's own motion,"),
    ] {
        let under_test = cut_by(scene, &[], text).unwrap_or_else(|why| panic!("{name}: {why}"));
        let told = told(&under_test);
        assert!(told.iter().any(|of| of.severity == severity && of.text.contains(words)), "{name}: {told:?}");
    }
    let back = changed(&program, |block, words| {
        if block == 0 {
            add(words, 'B', -1e6);
        }
    });
    let why = cut_by(scene, &[], &back).expect_err("a hob that turns back").to_string();
    assert!(why.contains("operation.finish.program") && why.contains("let B grow in every block"), "{why}");
}
