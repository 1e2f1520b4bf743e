//! What the readers make of programs against the linkages: the path, the way to it and away from it.

use super::controls::{Done, Position};
use super::{fanuc, linuxcnc, siemens};
use crate::fixtures::paper::{NORMAL, TRADITIONAL, operation, paper_scene};
use gearcut::gear::PitchCurveShape;
use gearcut::process;
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::gcode::{self as bevel_gcode, BevelKnot, BevelProgram};
use gearcut::process::bevel::motion::SlotMotion;
use gearcut::process::hobbing::HobbingJob;
use gearcut::process::hobbing::commanded::HobbingKnot;
use gearcut::process::hobbing::gcode::{Gearbox, HobbingProgram, texts};
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::programs;
use gearcut::process::shaping::motion::gcode::{AxisProgram, Knot};
use gearcut::process::shaping::scene::model::{Infeed, Operation, Shaping};
use gearcut::scene::Post;
use std::path::Path;

const POSTS: [Post; 3] = [Post::LinuxCnc, Post::Siemens, Post::Fanuc];

fn read(post: Post, text: &str) -> Done {
    let done = match post {
        Post::LinuxCnc => linuxcnc::read(text),
        Post::Siemens => siemens::read(text),
        Post::Fanuc => fanuc::read(text),
        Post::Plain => unreachable!("gearcut's own reader has its own tests"),
    };
    done.unwrap_or_else(|why| panic!("{post:?}: {why}\n{}", text.chars().take(2000).collect::<String>()))
}

/// How far the rounding of F may move the ends of blocks, min: half a step of three digits at two seconds, and of six.
fn doubt_minutes(post: Post) -> f64 {
    match post {
        Post::Fanuc => 0.0005 / 900.0,
        Post::Siemens => 0.5e-6 / 0.01,
        Post::LinuxCnc | Post::Plain => 1e-9,
    }
}

/// The way to the first position and away from the last one: the clear axis alone first, and last.
fn keeps_clear(post: Post, done: &Done, letter: char, clear: impl Fn(f64) -> bool) {
    let (before, after): (Vec<_>, Vec<_>) = done.rapid.iter().partition(|(begun, _)| !begun);
    let [first, .., start] = before.as_slice() else { panic!("{post:?}: {} positions", before.len()) };
    assert!(first.1.len() == 1 && clear(first.1[&letter]), "{post:?}: begins at {:?}", first.1);
    assert_eq!(start.1, done.path[0].1, "{post:?}");
    let [last] = after.as_slice() else { panic!("{post:?}: {} positions afterwards", after.len()) };
    assert!(clear(last.1[&letter]), "{post:?}: ends at {:?}", last.1);
    let end = &done.path[done.path.len() - 1].1;
    assert!(end.iter().all(|(axis, at)| *axis == letter || last.1[axis] == *at), "{post:?}: another axis moves");
}

fn shaping(operation: Operation, round: bool, post: Post, error_mm: f64) -> ShapingJob {
    let name = "op with-a name, µ (odd)".to_owned();
    let mut scene = paper_scene(vec![Operation { name, ..operation }]);
    if round {
        scene.gear.pitch_curve = PitchCurveShape::Circle;
    }
    scene.output.post = post;
    scene.output.gcode_contour_error_mm = error_mm;
    ShapingJob::new(scene).expect("a gear")
}

#[test]
fn programs_of_shaping_move_the_axes_on_every_control() {
    let continuous = Operation { feed_during_stroke: true, ..operation("", NORMAL, 0.0, 600) };
    let spiral = Operation {
        infeed: Infeed::Spiral { depth_mm: 5.0, angle_rad: 1.234 },
        ..operation("", TRADITIONAL, 1.0, 400)
    };
    for post in POSTS {
        for (operation, round) in [
            (operation("", NORMAL, 0.0, 600), false),
            (continuous.clone(), false),
            (spiral.clone(), false),
            (operation("", NORMAL, 0.0, 600), true),
        ] {
            let job = shaping(operation, round, post, 1e-3);
            let text = programs::text(&job, &job.operations[0], &[]).expect("wanted").expect("written");
            let done = read(post, &text);
            let per_minute = done.speed.expect("a ram that runs");
            assert_eq!(per_minute, 300.0);
            let knot = |(minutes, at): &(f64, Position)| Knot {
                stroke: minutes * per_minute,
                psi_c_rad: -at[&'C'].to_radians(),
                psi_b_rad: at[&'B'].to_radians(),
                center_distance_mm: at[&'X'],
            };
            let knots = done.path.iter().map(knot).collect();
            let program =
                AxisProgram { double_strokes_per_minute: per_minute, knots, runs_on: done.dwell_s * per_minute / 60.0 };
            let schedule = &job.operations[0].schedule;
            let (last, strokes) = (program.knots[program.knots.len() - 1].stroke, schedule.count() as f64 - 1.0);
            let doubt = doubt_minutes(post) * per_minute;
            assert!((last - strokes).abs() <= doubt + 1e-5, "{post:?}: {last} of {strokes} strokes");
            // The last stroke is made at rest.
            assert!(done.dwell_s >= 0.2 - 1e-6 && done.dwell_s < 0.202, "{post:?}: {} s", done.dwell_s);
            let tip_mm = job.cutter.tip_radius_mm;
            let continuous = job.operations[0].spec.feed_during_stroke;
            let (reached_mm, at) = program.contour_error_mm(schedule, tip_mm, continuous);
            // Time in doubt is travel in doubt: less than 0.2 mm of feed in a stroke.
            let asked_mm = 1e-3 + 0.2 * doubt + 1e-5;
            assert!(reached_mm <= asked_mm, "{post:?}, round {round}: {reached_mm} mm at {at}, asked {asked_mm}");
            let reach_mm = job.curve.facts().largest_radius_mm + job.blank.addendum_mm + tip_mm;
            keeps_clear(post, &done, 'X', |x| x > reach_mm && x < reach_mm + 5.0);
        }
    }
}

#[test]
fn names_and_limits_are_the_controls() {
    let job = |strokes_per_minute: f64, post: Post| {
        let mut job = shaping(operation("", NORMAL, 0.0, 300), false, post, 1e-3);
        job.machine.double_strokes_per_minute = strokes_per_minute;
        job
    };
    for number in 1..30 {
        for name in ["finish", "operation_1", "1st", "a", "über-long name of an operation of roughing"] {
            let file = Post::Siemens.file_name(name, number);
            assert!(siemens::takes_name(&file), "{name}: {file}");
        }
    }
    assert_eq!(Post::Siemens.file_name("finish", 1), "finish.mpf");
    assert_ne!(
        Post::Siemens.file_name("a long name that is cut 1", 1),
        Post::Siemens.file_name("a long name that is cut 2", 2)
    );
    assert_eq!(Post::Fanuc.file_name("finish", 1), "finish.nc");
    // Four digits of a degree are too few for a nanometre.
    let mut fine = job(300.0, Post::Fanuc);
    fine.scene.output.gcode_contour_error_mm = 1e-6;
    let why = programs::text(&fine, &fine.operations[0], &[]).expect("wanted").expect_err("too few digits");
    assert!(why.contains("contour error"), "{why}");
    // S without a fraction.
    let mut scene = fine.scene.clone();
    scene.output.gcode_contour_error_mm = 1e-3;
    Shaping::of_mut(&mut scene).expect("shaping").machine.double_strokes_per_minute = 300.5;
    let odd = ShapingJob::new(scene).expect("a gear");
    let why = programs::text(&odd, &odd.operations[0], &[]).expect("wanted").expect_err("a fraction");
    assert!(why.contains("whole number") && why.contains("300.5"), "{why}");
}

fn hobbing(scene: &str, post: &str) -> HobbingJob {
    let settings = [
        "operation.finish.axial_feed_mm_per_revolution=10".to_owned(),
        "output.gcode_contour_error_um=10".to_owned(),
        format!("output.post={post}"),
    ];
    let path = format!("scenes/hobbing/{scene}.toml");
    HobbingJob::new(&process::load(Path::new(&path), &settings).expect("a scene").scene).expect("a job")
}

#[test]
fn programs_of_hobbing_move_the_axes_on_every_control() {
    for post in ["linuxcnc", "siemens", "fanuc"] {
        for scene in ["circular_spur", "third_order_diagonal"] {
            let job = hobbing(scene, post);
            let (post, operation) = (job.scene.output.post, job.finishing());
            let [full, geared] = texts(&job, operation, &[]).expect("wanted").expect("written");
            let exact = |time_s: f64| operation.linkage.axes::<1>(time_s);
            let shift_mm = exact(0.0).shift_mm.value();
            let per_s = (exact(1.0).hob_rad.value() - exact(0.0).hob_rad.value()) / 1.0;
            let gearbox = Gearbox::new(&operation.linkage);
            for (text, geared) in [(full, false), (geared, true)] {
                let done = read(post, &text);
                let first = done.path[0].1[&'B'];
                // The hob turns evenly: its angle is the time, whatever F leaves in doubt.
                let knot = |(minutes, at): &(f64, Position)| {
                    let turned = (at[&'B'] - first).to_radians();
                    let time_s = turned / per_s;
                    assert!((60.0 * minutes - time_s).abs() < 60.0 * doubt_minutes(post) + 1e-3, "{post:?}: {time_s}");
                    let hob_rad = exact(0.0).hob_rad.value() + turned;
                    let shift_mm = at.get(&'W').copied().unwrap_or(shift_mm);
                    HobbingKnot {
                        time_s,
                        axes: [hob_rad, at[&'C'].to_radians(), at[&'X'], at[&'Y'], at[&'Z'], shift_mm],
                    }
                };
                let program = HobbingProgram { knots: done.path.iter().map(knot).collect() };
                let program = if geared { program.with_gearbox(&gearbox) } else { program };
                let (reached_mm, at_s) = program.contour_error_mm(&job, operation);
                // Angles of four digits on a radius of 50 mm stand for 0.05 um each.
                assert!(reached_mm <= 1.02e-2, "{post:?}, {scene}, gearbox {geared}: {reached_mm} mm at {at_s} s");
                keeps_clear(post, &done, 'Y', |y| y > done.path[0].1[&'Y'] + 5.0);
                if post == Post::Fanuc {
                    assert!(text.contains("G91"), "the hob turns beyond the range of positions");
                }
            }
        }
    }
}

#[test]
fn programs_of_bevel_gears_move_the_axes_on_every_control() {
    for post in ["linuxcnc", "siemens", "fanuc"] {
        let settings = [format!("output.post={post}")];
        let path = Path::new("scenes/bevel/five_linkage_printed.toml");
        let job = BevelJob::new(&process::load(path, &settings).expect("a scene").scene).expect("a gear");
        let (post, operation) = (job.scene.output.post, job.finishing());
        let text = bevel_gcode::text(&job, operation, &[]).expect("wanted").expect("a program");
        let done = read(post, &text);
        let knot = |(minutes, at): &(f64, Position)| BevelKnot {
            time_s: 60.0 * minutes,
            axes: [at[&'X'], at[&'Y'], at[&'Z'], at[&'A'].to_radians(), at[&'B'].to_radians()],
        };
        let program = BevelProgram { knots: done.path.iter().map(knot).collect() };
        let (reached_mm, at_s) = program.contour_error_mm(&SlotMotion { job: &job, operation });
        // The slides move with less than 50 mm/s.
        let asked_mm = 1e-3 + 50.0 * 60.0 * doubt_minutes(post) + 1e-5;
        assert!(reached_mm <= asked_mm, "{post:?}: {reached_mm} mm at {at_s} s, asked {asked_mm}");
        let end_s = 61.0 * operation.cycle_s() + operation.course.slot_s();
        let last_s = program.knots[program.knots.len() - 1].time_s;
        assert!((last_s - end_s).abs() < 60.0 * doubt_minutes(post) + 1e-3, "{post:?}: {last_s} of {end_s} s");
        keeps_clear(post, &done, 'Z', |z| z < done.path[0].1[&'Z'] - 5.0);
    }
}
