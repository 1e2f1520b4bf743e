//! Programs of hobbing machines: written, read back, with and without an electronic gearbox, and refused where they
//! must be.

use gearcut::process;
use gearcut::process::hobbing::HobbingJob;
use gearcut::process::hobbing::commanded::read;
use gearcut::process::hobbing::gcode::{Gearbox, HobbingProgram, texts};
use glam::DVec3;
use std::path::Path;

fn job(name: &str, settings: &[&str]) -> HobbingJob {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    let path = format!("scenes/hobbing/{name}.toml");
    HobbingJob::new(&process::load(Path::new(&path), &settings).expect("a scene").scene).expect("a job")
}

/// Largest distance between points of the hob, as a program has them in the work and as the linkage has them, at odd
/// moments, mm.
fn apart_mm(job: &HobbingJob, program: &HobbingProgram) -> f64 {
    let linkage = &job.finishing().linkage;
    (0..4001)
        .map(|i| {
            let time_s = linkage.end_s() * f64::from(i) / 4001.0;
            let [hob, work, x, y, slide, shift] = program.at(time_s);
            // The papers' own equations, by hand: the work's centre at -(x, y), turned by the work's angle; frame and
            // turn-over as documented.
            let g = linkage.geometry();
            let (axis, up) = (DVec3::new(g.head_angle_rad.cos(), 0.0, g.head_angle_rad.sin()), DVec3::Y);
            // A hob tooth's tip and two places of the thread beside it, on the side of the work.
            [-12.0, 0.0, 12.0]
                .map(|along| {
                    let exact = linkage.work_from_tool(time_s);
                    let on_hob = linkage
                        .geometry()
                        .machine_from_tool(
                            linkage.axes::<1>(time_s).hob_rad.value(),
                            linkage.axes::<1>(time_s).radial_mm.value(),
                            linkage.axes::<1>(time_s).slide_mm.value(),
                            linkage.axes::<1>(time_s).shift_mm.value(),
                        )
                        .inverse()
                        .point(along * axis - 5.0 * up + DVec3::Z * linkage.axes::<1>(time_s).slide_mm.value());
                    let machine = g.machine_from_tool(hob, 0.0, slide, shift).point(on_hob) + DVec3::new(x, y, 0.0);
                    let (sin, cos) = work.sin_cos();
                    let work_point =
                        DVec3::new(-sin * machine.x + cos * machine.y, cos * machine.x + sin * machine.y, -machine.z);
                    work_point.distance(exact.point(on_hob))
                })
                .into_iter()
                .fold(0.0, f64::max)
        })
        .fold(0.0, f64::max)
}

#[test]
fn programs_read_back_to_the_axes_within_the_contour_error() {
    for (name, settings) in [
        ("circular_spur", &[][..]),
        ("third_order_diagonal", &["operation.finish.axial_feed_mm_per_revolution=10"]),
        (
            "ellipse_six_schemes",
            &[
                "operation.finish.axial_feed_mm_per_revolution=10",
                "operation.finish.linkage.hobbing.extra_rotation=hob",
                "operation.finish.hob_speed_per_minute=132",
            ],
        ),
    ] {
        let mut job = job(name, settings);
        let mut lines = Vec::new();
        for error_mm in [0.01, 0.001] {
            job.scene.output.gcode_contour_error_mm = error_mm;
            let operation = job.finishing();
            let [full, geared] =
                texts(&job, operation, &[]).expect("wanted").unwrap_or_else(|why| panic!("{name}: {why}"));
            let shift_mm = operation.linkage.axes::<1>(0.0).shift_mm.value();
            let program = read(&full, shift_mm).expect("its own program");
            assert_eq!(program.knots.len(), HobbingProgram::fit(&job, operation, error_mm).knots.len());
            let time_s = program.knots.last().expect("knots").time_s;
            assert!((time_s - operation.linkage.end_s()).abs() < 1e-6, "{name}: {time_s} s");
            let found_mm = apart_mm(&job, &program);
            let by_gearbox =
                read(&geared, shift_mm).expect("its own program").with_gearbox(&Gearbox::new(&operation.linkage));
            let found_geared_mm = apart_mm(&job, &by_gearbox);
            println!(
                "{name}, {error_mm} mm: {} blocks, {found_mm:.2e} and {found_geared_mm:.2e} mm off",
                program.knots.len()
            );
            assert!(found_mm <= error_mm && found_geared_mm <= error_mm, "{found_mm} {found_geared_mm}");
            lines.push(program.knots.len());
            // What is left for C: nothing on a circle, a variation without growth on other curves.
            let commanded = read(&geared, shift_mm).expect("read");
            let work = commanded.knots.iter().map(|knot| knot.axes[1]);
            let span = work.clone().fold(f64::NEG_INFINITY, f64::max) - work.fold(f64::INFINITY, f64::min);
            assert!(
                if name == "circular_spur" { span < 1e-6 } else { span > 0.01 && span < 1.5 },
                "{name}: {span} rad"
            );
        }
        assert!(name == "circular_spur" || lines[1] > 2 * lines[0], "{name}: {lines:?}");
        assert!(
            name != "circular_spur" || lines[1] < 20,
            "{name}: a round spur gear needs no interpolation: {lines:?}"
        );
    }
}

#[test]
fn printed_linkages_and_exceeded_limits_have_no_program() {
    let why = |job: &HobbingJob| texts(job, job.finishing(), &[]).expect("wanted").expect_err("refused");
    let coarse = "operation.finish.axial_feed_mm_per_revolution=10";
    let printed = job("ellipse_six_schemes", &[coarse, "operation.finish.linkage.hobbing.form=as_printed"]);
    assert!(why(&printed).contains("as printed"), "{}", why(&printed));
    let mut fast = job("third_order_plain", &[coarse]);
    fast.scene.output.gcode_contour_error_mm = 0.01;
    fast.limits.speeds[1] = Some(0.1);
    assert!(why(&fast).contains("work spindle") && why(&fast).contains("deg/s"), "{}", why(&fast));
    fast.limits.speeds[1] = None;
    fast.limits.accelerations[2] = Some(1e-3);
    assert!(why(&fast).contains("tangential axis") && why(&fast).contains("mm/s^2"), "{}", why(&fast));
    fast.limits.accelerations[2] = None;
    fast.scene.output.gcode_contour_error_mm = 1e-7;
    assert!(why(&fast).contains("blocks of") && why(&fast).contains("um are asked"), "{}", why(&fast));
}

#[test]
fn malformed_programs_are_refused_by_line_and_word() {
    let start = "G21 G90 G94\nG0 X1 Y2 Z3 B4 C5\n";
    for (program, expected) in [
        ("", "the program ends without M30"),
        ("M30\n", "no axis has moved"),
        ("G20\n", "line 1: word `G20`: inches"),
        ("G2 X1\n", "line 1: word `G2`: arcs"),
        ("G4 P1\n", "line 1: word `G4`: this G is not read"),
        ("S100 M3\n", "line 1: word `S100`: this letter is not read"),
        ("G21 G90 G1 X1 Y1 Z1 B1 C1 F3\n", "line 1: the program does not begin with G0"),
        ("G21 G90 G0 X1 Y1\n", "line 1: axes move before axis B has a position"),
        (&format!("{start}G1 X2 F3\n"), "line 3: axes move without G93"),
        ("G0 X1 Y2 Z3 B4 C5\n", "line 1: axes move before `G21`"),
        (&format!("{start}G93 G94 G1 X2 F3\n"), "line 3: word `G94`: `G93` is in the same block"),
        (&format!("{start}G93 G1 X2\n"), "line 3: word `F` is missing"),
        (&format!("{start}G0 X2\n"), "line 3: word `G0`: rapid travel"),
        (&format!("{start}M30\nG0 X2\n"), "line 4: a block after the end"),
        (&format!("{start}G93 G1 X2 F10\n"), "without M30"),
    ] {
        let why = read(program, 0.0).expect_err(program);
        assert!(why.contains(expected), "{program:?}: {why}");
    }
    let read = read(&format!("{start}g93 g1 x2.5 f30 (half)\nM30\n%\n"), 7.0).expect("well formed");
    assert_eq!((read.knots.len(), read.knots[1].time_s), (2, 2.0));
    assert!((read.at(1.0)[2] - 1.75).abs() < 1e-12 && read.at(1.0)[5] == 7.0);
}
