//! What is measured on a hobbed gear: points on curves beside the pitch curve, and the lattice of marks, each by two
//! ways that share only the passes.

use crate::fixtures::oracle_cases::{data, numbers};
use gearcut::cut::cpu::Cpu;
use gearcut::job::GearJob;
use gearcut::process;
use gearcut::process::hobbing::measure::marks;
use gearcut::process::hobbing::measure::marks::between_rad;
use gearcut::process::hobbing::measure::offset_curves;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::terms::Side;
use glam::DVec2;
use std::path::Path;

/// The third-order gear of the 2015 paper with sharp tip corners.
fn job(settings: &[&str]) -> HobbingJob {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    let scene = process::load(Path::new("tests/data/hobbing/three_lobes.toml"), &settings).expect("a scene").scene;
    HobbingJob::new(&scene).expect("a job")
}

#[test]
fn points_on_five_curves_are_those_of_the_paper_and_agree_with_the_flanks_heights() {
    let job = job(&[]);
    let cutter = HobCutter::new(&job).expect("passes");
    let backend = Cpu::default();
    let file = data("p07_points350_s2");
    let (mut fillets, mut largest_um) = (0, 0.0_f64);
    for (tooth, side) in [(1, Side::Right), (12, Side::Left), (6, Side::Right)] {
        let points = offset_curves::measure(&cutter, &backend, &[(tooth, side)]).expect("cut").remove(0);
        assert_eq!(points.len(), 5);
        // Targets: the independent implementation's rows of this flank; its x and y are exchanged, its spaces those
        // before (right flanks) or after the tooth.
        let space = f64::from(tooth) - if side == Side::Right { 1.0 } else { 0.0 };
        let rows: Vec<Vec<f64>> = file["rows"].as_array().expect("rows").iter().map(numbers).collect();
        let rows = rows.iter().filter(|row| row[0] == space && row[1] == side.sign());
        for (point, row) in points.iter().zip(rows) {
            assert_eq!(point.offset_mm, row[2]);
            assert!(point.target.point_mm.distance(DVec2::new(row[5], row[4])) < 1e-6, "{point:?} {row:?}");
            assert_eq!(point.on_fillet(), row[6] == 1.0);
            fillets += u32::from(point.on_fillet());
            // Marks stand over the target, some micrometres high.
            let along_mm = point.along_mm.expect("cut");
            assert!((-1e-7..0.03).contains(&along_mm), "tooth {tooth} {side:?}: {point:?}");
            if point.on_fillet() {
                continue;
            }
            // The flank's own ray through the target's point, along its normal.
            let flank = cutter.target(tooth, side).expect("a flank");
            let section = flank.section(0.0);
            let distance =
                |arc: f64| section.ray(flank.share_at(arc)).origin_mm.truncate().distance(point.target.point_mm);
            let (mut low, mut high) = (0.0, flank.length_mm());
            for _ in 0..100 {
                let [a, b] = [(2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0];
                if distance(a) < distance(b) { high = b } else { low = a }
            }
            assert!(distance(low) < 1e-5, "{} mm from the flank", distance(low));
            let layers = cutter.cut_flank(&backend, tooth, side, &[low], &[0.0]).expect("cut");
            let height_mm = f64::from(layers[0].heights_mm[0]);
            let normal = section.ray(flank.share_at(low)).normal.truncate();
            let tangent = job.curve.frame(job.curve.phi_at_arc(point.target.foot_arc_mm)).tangent;
            let expected_mm = height_mm / (side.sign() * tangent.dot(normal));
            largest_um = largest_um.max(1e3 * along_mm);
            // Facets of marks lean by some thousandths against the target.
            let apart_mm = (along_mm - expected_mm).abs();
            println!(
                "tooth {tooth} {side:?} at {}: {along_mm:.6} mm along, {expected_mm:.6} by the normal",
                point.offset_mm
            );
            assert!(apart_mm < 1e-6 + 0.02 * along_mm, "{along_mm} and {expected_mm} mm");
        }
    }
    assert!(fillets > 0 && largest_um > 0.5, "{fillets} on fillets, {largest_um} um");
}

#[test]
fn a_surface_shows_the_marks_that_the_motion_makes() {
    for settings in
        [&[][..], &["gear.pitch_curve.ellipse.eccentricity=0.05", "operation.finish.axial_feed_mm_per_revolution=4"]]
    {
        let job = job(settings);
        let cutter = HobCutter::new(&job).expect("passes");
        for (tooth, side) in [(6, Side::Left), (18, Side::Right)] {
            let lattice = marks::measure(&cutter, &Cpu::default(), tooth, side).expect("cut");
            let seen = lattice.surface.expect("marks are seen");
            for (seen, known) in seen.iter().zip(&lattice.kinematic) {
                println!("tooth {tooth} {side:?}: {seen:?} for {known:?}");
                assert!((seen.length_mm() / known.length_mm() - 1.0).abs() < 0.02, "{seen:?} for {known:?}");
                assert!(between_rad(seen.to_trace_rad(), known.to_trace_rad()) < 0.03, "{seen:?} for {known:?}");
                assert!((seen.to_axis_rad - known.to_axis_rad).abs() < 0.03, "{seen:?} for {known:?}");
            }
            // Without shift one of both steps is the feed along the tooth, inclined by the helix angle to the axis.
            let feed_mm = job.finishing().plan.slide_feeds_mm[0] / job.scene.gear.helix_angle_rad.cos();
            let along = lattice.kinematic.iter().find(|step| step.to_trace_rad().abs() < 1e-6);
            if let Some(step) = along {
                assert!((step.length_mm() - feed_mm).abs() < 1e-6, "{step:?} for {feed_mm}");
                assert!((step.to_axis_rad - job.scene.gear.helix_angle_rad).abs() < 1e-9);
            }
        }
    }
}

mod slow {
    use super::*;

    /// Approach and overrun are long enough: at both faces the marks of every flank are no higher than in the middle,
    /// whichever tooth the hob meets last. Rows lie six or more to a mark, so that none
    /// hides its height.
    #[test]
    fn faces_are_finished_as_the_middle_is() {
        let settings =
            ["fields.flank.profile_spacing_um=800", "fields.flank.lead_spacing_um=250", "gear.face_width_mm=12"];
        for scene in ["third_order_plain", "circular_helical"] {
            let path = format!("scenes/hobbing/{scene}.toml");
            let scene = process::load(Path::new(&path), &settings.map(str::to_owned)).expect("the scene").scene;
            let job = HobbingJob::new(&scene).expect("the gear");
            let cutter = HobCutter::new(&job).expect("passes");
            let mut worst = (0.0_f64, String::new());
            for (tooth, side) in
                (1..=job.scene.gear.teeth).step_by(9).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
            {
                let flank = cutter.cut(&Cpu::default(), tooth, side).expect("a flank");
                let (field, heights) = (&flank.rays.field, &flank.layers[flank.layers.len() - 1].heights_mm);
                let highest = |near_face: bool| {
                    let rows = (0..field.rows()).filter(|&row| (flank.rays.rows_z_mm[row].abs() > 3.0) == near_face);
                    rows.flat_map(|row| (0..field.columns()).map(move |column| heights[field.index(column, row)]))
                        .fold(0.0, f32::max)
                };
                let ratio = f64::from(highest(true) / highest(false));
                if ratio > worst.0 {
                    worst = (ratio, format!("tooth {tooth} {side:?}"));
                }
            }
            println!("{path}: marks at the faces up to {:.3} of those in the middle, {}", worst.0, worst.1);
            assert!(worst.0 < 1.1, "{path}: {worst:?}");
        }
    }
}
