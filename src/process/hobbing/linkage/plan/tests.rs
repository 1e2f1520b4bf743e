//! Feed plans of shipped scenes: what they cover, and what is refused.

use crate::process;
use crate::process::hobbing::HobbingJob;
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
