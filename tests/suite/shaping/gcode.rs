//! G-code: written, read back, cut as read, and refused by line and word where it is malformed.

use crate::fixtures::paper::*;
use gearcut::cut::cpu::Cpu;
use gearcut::findings::Severity;
use gearcut::output::table::write_table;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::OperationAxes;
use gearcut::process::shaping::axes_report::programs;
use gearcut::process::shaping::cut::chips::ChipLedger;
use gearcut::process::shaping::findings::program;
use gearcut::process::shaping::motion::gcode::{AxisProgram, read};
use gearcut::process::shaping::scene::model::*;
use gearcut::scene::Post;
use gearcut::steps::axes::AxesOfOperation as _;
use gearcut::terms::Side;

fn job(operation: Operation) -> ShapingJob {
    let mut scene = paper_scene(vec![operation]);
    scene.fields.profile_spacing_mm = 0.05;
    scene.fields.lead_spacing_mm = 15.0;
    ShapingJob::new(scene).expect("the paper's gear")
}

fn text(job: &ShapingJob) -> String {
    programs::text(job, &job.operations[0], &[]).expect("wanted").expect("written")
}

/// Heights of some flanks after the cut, mm.
fn heights(job: &ShapingJob) -> Vec<f32> {
    let mut heights = Vec::new();
    for (tooth, side) in [(1, Side::Right), (7, Side::Left), (8, Side::Right), (21, Side::Left), (42, Side::Left)] {
        let target = job.target_flank(tooth, side);
        let cut = job.cut(&Cpu::default(), job.flank_field(target)).expect("cut");
        heights.extend(&cut.layers[0].heights_mm);
    }
    heights
}

/// The same job, cut by a program file.
fn cut_by(mut operation: Operation, program: &str) -> ShapingJob {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), program).expect("written");
    operation.program = Some(file.path().to_owned());
    job(operation)
}

#[test]
fn a_program_reads_back_to_its_knots_and_keeps_its_contour_error() {
    for (linkage, offset_mm, continuous) in [(NORMAL, 0.0, false), (TRADITIONAL, 2.0, false), (NORMAL, 2.0, true)] {
        let mut operation = operation("cut", linkage, offset_mm, 1200);
        operation.feed_during_stroke = continuous;
        let job = job(operation);
        let schedule = &job.operations[0].schedule;
        let tip = job.cutter.tip_radius_mm;
        let mut blocks = Vec::new();
        for error_mm in [0.01, 0.001, 1e-5] {
            let program = AxisProgram::fit(schedule, tip, error_mm, continuous, Post::Plain);
            let (reached, stroke) = program.contour_error_mm(schedule, tip, continuous);
            assert!(reached <= error_mm, "{reached} mm at stroke {stroke}, {error_mm} asked");
            blocks.push((program.knots.len(), reached / error_mm));
        }
        println!("blocks and share of the error: {blocks:?}");
        // Straight lines on a smooth path: a tenth of the error takes three times the blocks, until there is one per
        // stroke.
        assert!(blocks[0].0 < blocks[1].0 && blocks[1].0 < blocks[2].0, "{blocks:?}");
        assert!(blocks[0].1 > 0.5, "blocks could be longer: {blocks:?}");
        let read = read::program(&text(&job)).expect("its own program");
        let program = AxisProgram::fit(schedule, tip, job.scene.output.gcode_contour_error_mm, continuous, Post::Plain);
        assert_eq!(read.count(), schedule.count());
        assert_eq!(read.double_strokes_per_minute, 300.0);
        assert_eq!(read.knots.len(), program.knots.len());
        for (a, b) in read.knots.iter().zip(&program.knots) {
            assert_eq!(a.stroke, b.stroke);
            assert!((a.psi_c_rad - b.psi_c_rad).abs() < 1e-13 && (a.psi_b_rad - b.psi_b_rad).abs() < 1e-13);
            assert!((a.center_distance_mm - b.center_distance_mm).abs() < 1e-12);
        }
    }
}

#[test]
fn cutting_the_written_program_gives_the_same_gear() {
    for continuous in [false, true] {
        let mut operation = operation("cut", NORMAL, 0.0, 1200);
        operation.feed_during_stroke = continuous;
        let mut job = job(operation.clone());
        let direct = heights(&job);
        // What is cut under a moving feed puts a cubic through four poses of every stroke, which leaves 10 nm of lines.
        let tight_mm = if continuous { 1e-4 } else { 1e-6 };
        for error_mm in [1e-3, tight_mm] {
            job.scene.output.gcode_contour_error_mm = error_mm;
            let program = text(&job);
            let by_program = heights(&cut_by(operation.clone(), &program));
            let worst = direct.iter().zip(&by_program).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
            let lines = program.lines().count();
            println!("continuous {continuous}, asked {error_mm} mm: {lines} lines, flanks {worst:.2e} mm off");
            assert!(worst <= error_mm, "{worst}");
            assert!(error_mm < 1e-3 || worst > 1e-5, "a micrometre is seen on the flanks: {worst}");
        }
    }
}

#[test]
fn a_wrong_program_is_seen_on_the_flanks() {
    let operation = operation("cut", NORMAL, 0.0, 1200);
    let job = job(operation.clone());
    // Every X a tenth of a millimetre too large: all flanks keep about 0.1 sin(20 deg) more.
    let shifted: Vec<String> = text(&job)
        .lines()
        .map(|line| match line.split_once(" X") {
            Some((before, after)) if line.starts_with('N') => {
                let (x, rest) = after.split_once(' ').expect("more words");
                format!("{before} X{:.6} {rest}", x.parse::<f64>().expect("a number") + 0.1)
            }
            _ => line.to_owned(),
        })
        .collect();
    let (direct, wrong) = (heights(&job), heights(&cut_by(operation, &shifted.join("\n"))));
    let mean = direct.iter().zip(&wrong).map(|(a, b)| f64::from(b - a)).sum::<f64>() / direct.len() as f64;
    println!("mean {mean:.4} mm");
    assert!((mean - 0.1 * 20_f64.to_radians().sin()).abs() < 0.004, "{mean}");
}

/// A program with other strokes than the scene's is cut and judged; only one with many times as many is refused.
#[test]
fn a_program_of_another_length_is_cut_and_judged() {
    let program = text(&job(operation("cut", NORMAL, 0.0, 600)));
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), program).expect("written");
    let under_test = |strokes: u32| {
        let mut operation = operation("cut", NORMAL, 0.0, strokes);
        operation.program = Some(file.path().to_owned());
        let mut scene = paper_scene(vec![operation]);
        scene.fields.profile_spacing_mm = 0.05;
        scene.fields.lead_spacing_mm = 15.0;
        ShapingJob::new(scene)
    };
    for (strokes, words) in [
        (1200, "600 of the scene's strokes are missing from the program"),
        (300, "300 strokes of the program are none of the scene's"),
    ] {
        let job = under_test(strokes).expect("judged, not refused");
        assert_eq!(job.operations[0].count(), 600);
        let motion = OperationAxes::of_job(&job);
        let told = program::warnings(&job, &motion);
        let fault = told.iter().find(|warning| warning.text.contains(words));
        assert!(fault.is_some_and(|fault| fault.severity == Severity::Fault), "{strokes}: {told:?}");
        // Its own strokes are cut and followed: as many chips as the program makes.
        let ledger = ChipLedger::new(&job, &|| true).expect("not stopped");
        assert_eq!(ledger.operations[0].strokes.len(), 600);
        let own = ShapingJob::new(paper_scene(vec![operation("cut", NORMAL, 0.0, 600)])).expect("the paper's gear");
        let alone = ChipLedger::new(&own, &|| true).expect("not stopped");
        let (cut, alone) = (ledger.area_mm2(0), alone.area_mm2(0));
        assert!((cut / alone - 1.0).abs() < 1e-3, "{cut} mm2 under the program, {alone} mm2 by its own scene");
        // The axis table has the program's axes, and the scene's beside them.
        let folder = tempfile::tempdir().expect("a folder");
        let table = folder.path().join("cut.csv");
        write_table(&table, &motion[0].table()).expect("written");
        let table = std::fs::read_to_string(table).expect("text");
        let mut lines = table.lines();
        let names: Vec<&str> = lines.next().expect("names").split(',').collect();
        let column = |name: &str| names.iter().position(|own| *own == name).unwrap_or_else(|| panic!("{names:?}"));
        let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 600);
        let number = |row: usize, name: &str| rows[row][column(name)].parse::<f64>().expect("a number");
        let turn = |strokes: u32| 360.0 / f64::from(strokes);
        assert!((number(100, "psi_c_deg") - 100.0 * turn(600)).abs() < 1e-3, "the program's");
        assert!((number(100, "scene_psi_c_deg") - 100.0 * turn(strokes)).abs() < 1e-9, "the scene's");
        assert_eq!(rows[599][column("scene_psi_c_deg")].is_empty(), strokes == 300, "beyond the scene's last stroke");
    }
    let refused = under_test(50).expect_err("12 times as many").to_string();
    assert!(refused.contains("operation.cut.program") && refused.contains("600 strokes"), "{refused}");
}

/// A program for 200 double strokes per minute in a scene that says 400: times, drifts and lags are those of the scene
/// that says 200, and power and rates with them.
#[test]
fn a_program_runs_at_its_own_speed() {
    let prepared = |per_minute: u32, programs: &[tempfile::NamedTempFile]| {
        let mut settings = vec![
            format!("machine.double_strokes_per_minute={per_minute}"),
            "operation.finish.strokes_per_revolution=1200".to_owned(),
            "machine.errors.center_distance.drift_um_per_h=6000".to_owned(),
            "machine.errors.work.velocity_gain_per_s=30".to_owned(),
            "output.gcode_contour_error_um=0.01".to_owned(),
        ];
        for (name, file) in ["rough", "finish"].into_iter().zip(programs) {
            settings.push(format!("operation.{name}.program='{}'", file.path().display()));
        }
        let scene = load(std::path::Path::new("scenes/shaping/order_2.toml"), &settings);
        ShapingJob::new(scene.unwrap_or_else(|problems| panic!("{problems}")).scene).expect("a gear")
    };
    let (slow, fast) = (prepared(200, &[]), prepared(400, &[]));
    let files = [0, 1].map(|operation| {
        let file = tempfile::NamedTempFile::new().expect("a file");
        let text = programs::text(&slow, &slow.operations[operation], &[]).expect("wanted").expect("written");
        std::fs::write(file.path(), text).expect("written");
        file
    });
    let under_test = prepared(400, &files);
    let apart_mm = |a: &ShapingJob, b: &ShapingJob| {
        let pose = |job: &ShapingJob, stroke: u32| job.operations[1].pose(f64::from(stroke));
        let between = |stroke: u32| {
            let (a, b) = (pose(a, stroke), pose(b, stroke));
            let tip_mm = slow.cutter.tip_radius_mm;
            a.center_mm.distance(b.center_mm) + tip_mm * (a.angle_rad - b.angle_rad).sin().abs()
        };
        (0..1200).step_by(7).map(between).fold(0.0, f64::max)
    };
    let ([same, other], seconds) = ([&slow, &fast].map(|job| apart_mm(job, &under_test)), |job: &ShapingJob| {
        job.operations[1].schedule.time_s(1200.0)
    });
    println!("{same:.2e} mm off the scene of its own speed, {other:.3} mm off the scene's");
    // 6 mm an hour over three minutes more, and over five more of roughing before.
    assert!(same < 5e-5 && other > 0.75, "{same} mm, {other} mm");
    assert!((seconds(&under_test) - 360.0).abs() < 1e-9 && (seconds(&fast) - 180.0).abs() < 1e-9);
    let motion = OperationAxes::of_job(&under_test);
    let told = program::warnings(&under_test, &motion);
    assert!(
        told.iter().any(|warning| warning.text.contains("S is 200") && warning.text.contains("says 400")),
        "{told:?}"
    );
}

#[test]
fn limits_are_checked_and_as_printed_is_never_written() {
    let as_printed = Linkage::ShapingNormal { reading: NormalReading::AsPrinted };
    let printed = job(operation("cut", as_printed, 2.0, 600));
    let why = programs::text(&printed, &printed.operations[0], &[]).expect("wanted").expect_err("never written");
    assert!(why.contains("as printed"), "{why}");

    let mut fast = job(operation("cut", NORMAL, 0.0, 600));
    fast.machine.limits.work_speed_rad_per_s = Some(0.001);
    let why = programs::text(&fast, &fast.operations[0], &[]).expect("wanted").expect_err("too fast");
    assert!(why.contains("work spindle") && why.contains("deg/s"), "{why}");
}

#[test]
fn the_papers_form_is_marked_and_reads_as_refused() {
    let mut job = job(operation("cut", NORMAL, 2.0, 600));
    job.gcode = GcodeDialect::PaperG84;
    let text = text(&job);
    assert!(text.lines().take(2).all(|line| line.starts_with("(DO NOT RUN")), "{text}");
    assert!(text.contains("\nG84 A61.11 N3 K0.1348 R30 D0 S2\n"), "{text}");
    let refused = read::program(&text).expect_err("G84 is not read");
    assert!(refused.contains("line 5") && refused.contains("`G84`") && refused.contains("tapping"), "{refused}");
    job.gcode = GcodeDialect::None;
    assert!(programs::text(&job, &job.operations[0], &[]).is_none());
}

#[test]
fn malformed_programs_are_refused_by_line_and_word() {
    let cases = [
        ("", "the program ends and the ram never ran"),
        ("G20\n", "line 1: word `G20`: inches"),
        ("G21 G91\n", "line 1: word `G91`: relative"),
        ("G2 X1\n", "line 1: word `G2`: arcs"),
        ("G54\n", "line 1: word `G54`: this G is not read"),
        ("M8\n", "line 1: word `M8`: this M is not read"),
        ("Y1\n", "line 1: word `Y1`: this letter is not read"),
        ("X\n", "line 1: word `X`: no number"),
        ("X1..2\n", "line 1: word `X1..2`: no number"),
        ("X1 X2\n", "line 1: word `X2`: this letter is twice"),
        ("#1=3\n", "line 1: `#1=3` does not begin with a letter"),
        ("(open\n", "line 1: the comment `(open` is not closed"),
        ("G21 G90 X1 C1 B1\n", "line 1: axes move, but neither G0 nor G1"),
        ("G21 G90 G0 X90\nS300 M3\n", "line 2: word `M3`: the ram starts before axis C"),
        ("G21 G90 G0 X90 C0 B0\nM3\n", "line 2: word `M3`: the ram starts without S"),
        ("S-3\n", "line 1: word `S-3`: double strokes"),
        ("G4\n", "line 1: word `G4`: a dwell needs P"),
        ("G1 P3\n", "line 1: word `P3`: P belongs to a dwell"),
    ];
    for (program, expected) in cases {
        let why = read::program(program).expect_err(program);
        assert!(why.contains(expected), "{program:?}: {why}");
    }
    for (tail, expected) in [
        ("G1 X91 F10\n", "line 4: axes move under the running ram without G93"),
        ("G93 G1 X91\n", "line 4: word `F` is missing"),
        ("G0 X91\n", "line 4: word `G0`: rapid travel"),
        ("G93 G1 X91 F0\n", "line 4: word `F0`: a feed"),
        ("G93 G1 X91 F10 S200\n", "line 4: word `S200`: the ram's speed changes"),
        ("G93 G1 X91 F10\n", "line 4: the program ends without M30"),
        ("G4 P1\nM30\nG0 X1\n", "line 6: a block after the end"),
        ("G4 P1\nM5\nS300 M3\n", "line 6: word `M3`: the ram starts a second time"),
    ] {
        let why = read::program(&format!("G21 G90 G94\nG0 X90 C0 B0\nS300 M3\n{tail}")).expect_err(tail);
        assert!(why.contains(expected), "{tail:?}: {why}");
    }
}

/// Names and warnings from anywhere stand in comments of printable characters: a line end in one of them would end the
/// comment, and what follows would be run.
#[test]
fn names_are_cleaned_in_every_form() {
    let mut job = job(operation("cut", NORMAL, 2.0, 600));
    job.scene.name = "half µ (two)\nG0 X0 %".to_owned();
    for gcode in [GcodeDialect::Linear, GcodeDialect::PaperG84] {
        job.gcode = gcode;
        let text = text(&job);
        assert!(text.contains("half u  two ?G0 X0 %"), "{}", &text[..400]);
        assert!(text.is_ascii() && !text.contains("\nG0 X0"), "{}", &text[..400]);
    }
}

#[test]
fn dwells_lower_case_and_comments_are_understood() {
    let program = "%\n(head)\nn1 g21 g90 g94\nG0X90C-1B+2.5 ; to the start\nS60M3\nG93 G1 X91 (in) F30\nG4 P3\nG1 X92 \
        F60\nM5\nM30\n";
    let read = read::program(program).expect("well formed");
    // 60 per minute: two strokes in 1/30 min, three at rest, one more; the ram stops at the top of the next.
    let knots: Vec<[f64; 2]> = read.knots.iter().map(|k| [k.stroke, k.center_distance_mm]).collect();
    assert_eq!(knots, [[0.0, 90.0], [2.0, 91.0], [5.0, 91.0], [6.0, 92.0]]);
    assert_eq!((read.count(), read.runs_on), (6, 0.0));
    // C counts counter-clockwise, and the work turns by -psi_c.
    assert!((read.knots[0].psi_c_rad.to_degrees() - 1.0).abs() < 1e-12);
    assert!((read.knots[0].psi_b_rad.to_degrees() - 2.5).abs() < 1e-12);
    assert!((read.at(3.5).center_distance_mm - 91.0).abs() < 1e-12);
}

/// Roughing gets a program whatever its infeed, with the axes at rest during strokes or not.
#[test]
fn every_infeed_has_a_program() {
    let infeeds = [
        Infeed::None,
        Infeed::Plunge { depth_mm: 4.0, strokes: 37 },
        Infeed::Spiral { depth_mm: 5.0, angle_rad: 1.234 },
        Infeed::PlungeAndRoll { plunge_depth_mm: 2.0, strokes: 21, roll_depth_mm: 3.0, angle_rad: 0.777 },
    ];
    for infeed in infeeds {
        for continuous in [false, true] {
            for linkage in [NORMAL, TRADITIONAL] {
                let mut roughing = operation("rough", linkage, 0.5, 360);
                roughing.infeed = infeed;
                roughing.feed_during_stroke = continuous;
                let job = job(roughing);
                let written = programs::text(&job, &job.operations[0], &[]).expect("wanted");
                let text = written.unwrap_or_else(|why| panic!("{infeed:?}, continuous {continuous}: {why}"));
                let program = read::program(&text).expect("its own program");
                let schedule = &job.operations[0].schedule;
                assert_eq!(program.count(), schedule.count());
                let (reached_mm, stroke) = program.contour_error_mm(schedule, job.cutter.tip_radius_mm, continuous);
                assert!(reached_mm <= 1.001e-3, "{infeed:?}, continuous {continuous}: {reached_mm} mm at {stroke}");
                // An infeed ends between two strokes, where the scene has the cutter.
                let (off_mm, stroke) = program.between_mm(schedule, job.cutter.tip_radius_mm, None);
                assert!(off_mm <= 1.001e-3, "{infeed:?}, continuous {continuous}: {off_mm} mm off at {stroke}");
            }
        }
    }
}
