//! Feed plans of shipped scenes: what they cover, and what is refused.

use super::clear_before_mm;
use crate::findings::notice::Severity;
use crate::process;
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::steps::axes::warnings;
use std::path::Path;

fn job(file: &str, settings: &[&str]) -> gearcut_core::Result<HobbingJob> {
    let settings: Vec<String> = settings.iter().map(|&s| format!("operation.finish.{s}")).collect();
    HobbingJob::new(&process::load(Path::new(&format!("scenes/hobbing/{file}.toml")), &settings)?.scene)
}

fn diagonal(settings: &[&str]) -> gearcut_core::Result<HobbingJob> {
    job("third_order_diagonal", settings)
}

/// Key and problem of a refusal.
fn refused(result: gearcut_core::Result<HobbingJob>) -> (String, String) {
    match result {
        Err(gearcut_core::Error::Refused(refusal)) => (refusal.key, refusal.problem),
        other => panic!("not refused: {other:?}"),
    }
}

#[test]
fn the_slide_crosses_the_face_and_the_shift_stays_on_the_hob() {
    for strategy in ["reciprocating", "repeating"] {
        let strategy = format!("linkage.hobbing_diagonal.strategy={strategy}");
        let job = diagonal(&[&strategy]).unwrap();
        let operation = job.finishing();
        let (plan, linkage) = (&operation.plan, &operation.linkage);
        let [low, high] = plan.shift_range_mm;
        assert!((high + plan.contact_half_length_mm - 0.5 * job.hob.length_mm).abs() < 1e-9);
        let (start, end) = (linkage.axes::<1>(0.0), linkage.axes::<1>(linkage.end_s()));
        // A left-hand hob climbs downwards, from above the face to below it.
        assert!((start.slide_mm.value() - 25.0 - plan.approach_mm).abs() < 1e-9);
        assert!((end.slide_mm.value() + 25.0 + plan.overrun_mm).abs() < 1e-6, "{}", end.slide_mm.value());
        let (mut least, mut most, mut idle_s) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        let steps = 20_000;
        for i in 0..=steps {
            let axes = linkage.axes::<2>(linkage.end_s() * f64::from(i) / f64::from(steps));
            (least, most) = (axes.shift_mm.value().min(least), axes.shift_mm.value().max(most));
            if axes.slide_mm.derivative(1) == 0.0 {
                idle_s += linkage.end_s() / f64::from(steps);
            }
        }
        assert!(least > low - 1e-6 && most < high + 1e-6 && most - least > 0.99 * (high - low));
        assert!((idle_s - plan.idle_s).abs() < 0.3, "{idle_s} {}", plan.idle_s);
        assert_eq!(plan.idle_s > 0.0, strategy.ends_with("repeating"));
    }
}

#[test]
fn the_papers_feeds_follow_from_their_resultant() {
    // Liu et al. 2015, Table 1, with the shift that belongs to it: v_z for v*_z = -50 / 300 mm/s.
    for (direction, hand, expected) in [
        ("adds", "left", 0.22976615123458155),
        ("adds", "right", 0.046693835497048974),
        ("subtracts", "left", 0.10356718209875178),
        ("subtracts", "right", 0.28663949783628434),
    ] {
        let settings = [
            format!("operation.finish.linkage.hobbing_diagonal.shift_direction={direction}"),
            "operation.finish.linkage.hobbing_diagonal.feed_of=resultant".to_owned(),
            format!("gear.hand={hand}"),
        ];
        let scene = process::load(Path::new("scenes/hobbing/third_order_diagonal.toml"), &settings).unwrap().scene;
        let job = HobbingJob::new(&scene).unwrap();
        // The scene's feeds are per revolution of nearly 15 s.
        let found = job.finishing().plan.slide_feeds_mm[0] / 15.0;
        assert!((found - expected).abs() < 1e-9, "{direction} {hand}: {found}");
    }
}

#[test]
fn shifts_and_hobs_that_do_not_fit_are_refused() {
    let (key, problem) = refused(diagonal(&[
        "linkage.hobbing_diagonal.strategy=one_way",
        "linkage.hobbing_diagonal.shift_mm_per_revolution=75",
    ]));
    assert!(key.ends_with("strategy") && problem.contains("mm of shift"), "{problem}");
    let (key, _) = refused(diagonal(&["linkage.hobbing_diagonal.stroke_mm=90"]));
    assert!(key.ends_with("stroke_mm"));
    let (key, _) = refused(diagonal(&["shift_start_mm=60"]));
    assert!(key.ends_with("shift_start_mm"));
    let (key, _) = refused(diagonal(&[
        "linkage.hobbing_diagonal.feed_of=resultant",
        "linkage.hobbing_diagonal.shift_mm_per_revolution=75",
    ]));
    assert!(key.ends_with("shift_mm_per_revolution"));
    let short =
        process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &["tool.hob.length_mm=40".to_owned()]);
    let (key, problem) = refused(HobbingJob::new(&short.unwrap().scene));
    assert!(key == "tool.hob.length_mm" && problem.contains("whole contact"), "{problem}");
}

#[test]
fn hollow_curves_are_refused_and_say_why() {
    let settings = ["gear.pitch_curve.ellipse.eccentricity=0.2".to_owned()];
    let scene = process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &settings).unwrap().scene;
    let (key, problem) = refused(HobbingJob::new(&scene));
    assert!(key == "gear.pitch_curve" && problem.contains("straight line"), "{problem}");
    // The limit of convexity, 1 / (n^2 - 1), is not refused.
    let settings = ["gear.pitch_curve.ellipse.eccentricity=0.125".to_owned()];
    let scene = process::load(Path::new("scenes/hobbing/third_order_plain.toml"), &settings).unwrap().scene;
    HobbingJob::new(&scene).unwrap();
}

#[test]
fn two_cuts_keep_the_phase_and_conventional_turns_the_feed() {
    let job = job("circular_helical", &[]).unwrap();
    let [rough, finish] = job.operations.as_slice() else { panic!("two operations") };
    assert!((rough.offset_mm * 20_f64.to_radians().sin() - 0.15).abs() < 1e-12);
    let slide = |o: &process::hobbing::job::PreparedHobbing| o.linkage.axes::<2>(o.linkage.end_s()).slide_mm;
    // Right-hand hob: climb feeds up, conventional down.
    assert!(slide(rough).derivative(1) > 0.0 && slide(finish).derivative(1) < 0.0);
    let start = rough.linkage.axes::<1>(0.0).radial_mm.value();
    assert!(
        start > 6.0
            && (rough.linkage.axes::<1>(rough.linkage.end_s()).radial_mm.value() - rough.offset_mm).abs() < 1e-9
    );
}

/// A hob of 87.5 mm that is 6.75 mm deep in blanks of 40 teeth, module 3: without tilt the chord of its own tip circle,
/// sqrt(h (d_a0 - h)); with it what points all over both cylinders gave.
#[test]
fn the_hob_is_clear_of_the_blank_where_both_cylinders_part() {
    let clear_mm = |helix_deg: f64, head_deg: f64| {
        let outline_mm = 60.0 / helix_deg.to_radians().cos() + 3.0;
        clear_before_mm(43.75, outline_mm, 6.75, [50.0, outline_mm], head_deg.to_radians())
    };
    assert!((clear_mm(0.0, 0.0) - (6.75 * 80.75_f64).sqrt()).abs() < 1e-6);
    for (helix_deg, head_deg, sampled_mm) in [
        (0.0, -2.149, 23.39),
        (10.0, 7.851, 23.94),
        (20.0, 17.851, 26.49),
        (30.0, 27.851, 31.35),
        (45.0, 42.851, 45.36),
    ] {
        let found_mm = clear_mm(helix_deg, head_deg);
        assert!((found_mm - sampled_mm).abs() < 0.006, "{helix_deg} deg: {found_mm} mm for {sampled_mm}");
    }
}

/// What a scene gives is held against what the hob needs; what it leaves out is enough.
#[test]
fn a_travel_that_is_too_short_is_told_and_gets_no_program() {
    let ids = |settings: &[&str]| {
        let job = job("circular_helical", settings).unwrap();
        let axes = HobbingAxesReport::of_job(&job);
        let given: Vec<_> =
            warnings(&axes).into_iter().map(|notice| (notice.id.into_owned(), notice.severity)).collect();
        let of = |id: &str| given.iter().find(|(own, _)| own == id).map(|of| of.1);
        ["hob.starts_inside", "program.none", "hob.short_overrun"].map(of)
    };
    let (fault, warning) = (Some(Severity::Fault), Some(Severity::Warning));
    assert_eq!(ids(&[]), [None; 3]);
    assert_eq!(ids(&["approach=axial", "approach_mm=5"]), [fault, warning, None]);
    assert_eq!(ids(&["overrun_mm=0.5"]), [None, None, warning]);
}

/// A shift that begins in the middle of the hob has half of it ahead.
#[test]
fn a_start_that_leaves_too_little_of_the_hob_is_named() {
    let one_way = ["linkage.hobbing_diagonal.strategy=one_way", "linkage.hobbing_diagonal.shift_mm_per_revolution=1.2"];
    let whole = diagonal(&one_way).unwrap();
    let plan = &whole.finishing().plan;
    let [low, high] = plan.shift_range_mm;
    let needed_mm = 1.2 * whole.finishing().linkage.end_s() / whole.finishing().linkage.cycle_s();
    assert!((high - low - needed_mm).abs() < 1e-9, "{low} to {high} mm for {needed_mm} mm");
    let half_mm = 0.5 * whole.hob.length_mm - plan.contact_half_length_mm;
    assert!(needed_mm < 2.0 * half_mm && needed_mm > half_mm, "{needed_mm} of {half_mm} mm");
    let (key, problem) = refused(diagonal(&[one_way[0], one_way[1], "shift_start_mm=0"]));
    assert_eq!(key, "operation.shift_start_mm");
    assert!(problem.contains(&format!("{half_mm:.1} mm with full contact")), "{problem}");
}
