//! A hob on a pitch curve with hollows: the scene is refused with a depth; cut all the same, the gear loses that much
//! of its roots, and only there.

use gearcut::cut::cpu::Cpu;
use gearcut::process::hobbing::job::cut_under_hollows_mm;
use gearcut::process::hobbing::measure::blank_report;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::units::TURN_RAD;
use std::path::Path;

/// A third-order gear of module 3: convex up to the eccentricity 1 / (3^2 - 1).
fn scene(eccentricity: f64) -> gearcut::scene::Scene {
    let settings = [
        &format!("gear.pitch_curve.ellipse.eccentricity={eccentricity}")[..],
        "gear.module_mm=3",
        "gear.helix_angle_deg=0",
        "gear.teeth=45",
        "gear.face_width_mm=4",
        "tool.hob.length_mm=60",
        "tool.hob.gashes=14",
        "operation.finish.axial_feed_mm_per_revolution=2.0",
        "fields.blank.spacing_mm=0.3",
        "fields.blank.slice_spacing_mm=2",
    ]
    .map(str::to_owned);
    load(Path::new("scenes/hobbing/third_order_plain.toml"), &settings).unwrap_or_else(|e| panic!("{e}")).scene
}

#[test]
fn a_hob_cuts_under_the_roots_of_hollows_and_nowhere_on_a_convex_curve() {
    // From 0.2 on whole teeth go, and depths are distances from what is left of the target.
    for eccentricity in [0.12, 0.14, 0.16] {
        let scene = scene(eccentricity);
        let convex = eccentricity < 1.0 / 8.0;
        assert_eq!(HobbingJob::new(&scene).is_ok(), convex, "{eccentricity}");
        let job = HobbingJob::past_hollows(&scene).expect("a hob and a gear");
        let expected_mm = cut_under_hollows_mm(&job.curve, &job.hob);
        assert_eq!(expected_mm.is_none(), convex);
        let cutter = HobCutter::new(&job).expect("passes");
        let blank = cutter
            .cut_blank(&Cpu::default(), job.blank_field().expect("fits"), &|| true)
            .expect("cuts")
            .expect("not stopped");
        let report = blank_report::measure(&cutter, &blank.cut);
        let deepest = report.gouges.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm));
        println!("{eccentricity}: {expected_mm:?} mm, {} places, deepest {deepest:?}", report.gouges.len());
        let Some(expected_mm) = expected_mm else {
            assert!(report.gouges.is_empty(), "{:?}", report.gouges);
            continue;
        };
        // All of them within half the hob's length (and half a tooth) of a place where the curve is hollow, along the
        // curve.
        let perimeter_mm = job.curve.perimeter_mm();
        let frame = |arc_mm: f64| job.curve.frame(job.curve.phi_at_arc(arc_mm));
        let hollow_mm: Vec<f64> = (0..1000)
            .map(|i| perimeter_mm * f64::from(i) / 1000.0)
            .filter(|&s| frame(s).curvature_per_mm < 0.0)
            .collect();
        for gouge in &report.gouges {
            let arc_mm = job.curve.arc_mm(gouge.point_mm.to_angle().rem_euclid(TURN_RAD));
            let away =
                |s: f64| ((arc_mm - s) / perimeter_mm - ((arc_mm - s) / perimeter_mm).round()).abs() * perimeter_mm;
            let nearest_mm = hollow_mm.iter().map(|&s| away(s)).fold(f64::INFINITY, f64::min);
            assert!(nearest_mm < 0.5 * job.hob.length_mm + 2.5, "{nearest_mm} mm from the hollow: {gouge:?}");
        }
        let deepest = deepest.expect("a gouge");
        assert!(deepest.depth_mm > 0.8 * expected_mm && deepest.depth_mm < 1.02 * expected_mm);
    }
}
