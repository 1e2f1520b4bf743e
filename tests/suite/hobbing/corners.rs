//! Sweeps that last over a corner of the motion, where the shift turns round: heights against the motion itself, moment
//! by moment.

use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Ray;
use gearcut::passes::spatial::turning_passes::{BladePass, TurningPasses};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use glam::DVec3;
use std::path::Path;

/// The pass's place (distance from the axis, y) at the moment at which its rake face holds a point, by iteration, and
/// that moment as the angle that the blade has swept.
fn in_rake_face(job: &HobbingJob, set: &TurningPasses, pass: &BladePass, point_mm: DVec3) -> ([f64; 2], f64) {
    let (linkage, place) = (&job.operations[0].linkage, set.place(pass));
    let at = |swept: f64| linkage.head_from_work(pass.tool_angle_rad + swept).point(point_mm);
    let behind = |swept: f64| {
        let at = at(swept);
        set.turn * at.y.atan2(at.x) - swept
    };
    // The work moves some hundredths as fast as the blade.
    let mut swept = 0.0;
    for _ in 0..12 {
        swept += behind(swept);
    }
    let at = at(swept);
    ([at.truncate().length(), place.y_sign * (at.z - place.axial_mm)], swept)
}

/// Height at which a ray comes out of a pass's tooth through its flank, and the moment.
fn height_mm(job: &HobbingJob, set: &TurningPasses, pass: &BladePass, ray: &Ray, near_mm: f64) -> (f64, f64) {
    let beyond = |height_mm: f64| {
        let [radius_mm, y_mm] = in_rake_face(job, set, pass, ray.at(height_mm)).0;
        y_mm.abs() - job.hob.half_thickness_mm(radius_mm)
    };
    let (mut low, mut high) = (near_mm - 0.05, near_mm + 0.05);
    let falls = beyond(low) > 0.0;
    assert_ne!(falls, beyond(high) > 0.0, "the flank is not near");
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if (beyond(middle) > 0.0) == falls { low = middle } else { high = middle }
    }
    let height_mm = 0.5 * (low + high);
    (height_mm, in_rake_face(job, set, pass, ray.at(height_mm)).1)
}

mod slow {
    use super::*;

    #[test]
    fn heights_are_those_of_both_motions() {
        // The shift turns round six times in a revolution of the work.
        let settings = [
            "operation.finish.linkage.hobbing_diagonal.shift_mm_per_revolution=500",
            "gear.face_width_mm=12",
            "fields.flank.profile_spacing_um=100",
            "fields.flank.lead_spacing_um=50",
        ]
        .map(str::to_owned);
        let scene = load(Path::new("scenes/hobbing/third_order_diagonal.toml"), &settings).expect("the scene").scene;
        let job = HobbingJob::new(&scene).expect("the gear");
        let cutter = HobCutter::new(&job).expect("passes");
        let set = &cutter.operations[0];
        let (mut compared, mut before, mut after, mut worst_nm) = (0, 0, 0, 0.0_f64);
        for (tooth, side) in (5..=35).step_by(8).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
            let flank = cutter.cut(&Cpu::default(), tooth, side).expect("a flank");
            assert_eq!(flank.stats.unconverged, 0);
            let (field, layer) = (&flank.rays.field, &flank.layers[0]);
            for (column, row) in (0..field.columns()).flat_map(|column| (0..field.rows()).map(move |row| (column, row)))
            {
                let at = field.index(column, row);
                let pass = set.pass(layer.passes[at] - set.first_pass);
                let corner = set.motion.piece_rad(set.pieces(&pass).start)[1];
                // The flank is cut within a tenth of a radian of where the tooth points to the work.
                if (pass.tool_angle_rad - corner).abs() > 0.2 {
                    continue;
                }
                let ray = field.ray(column, row);
                let near_mm = f64::from(layer.heights_mm[at]);
                let [radius_mm, _] = in_rake_face(&job, set, &pass, ray.at(near_mm)).0;
                if radius_mm > job.hob.flank_end_radius_mm - 0.01 {
                    continue;
                }
                let (height_mm, swept) = height_mm(&job, set, &pass, &ray, near_mm);
                let from_corner = pass.tool_angle_rad + swept - corner;
                if from_corner.abs() < 0.02 {
                    compared += 1;
                    before += u32::from(from_corner < 0.0);
                    after += u32::from(from_corner > 0.0);
                    let nm = 1e6 * (near_mm - height_mm).abs();
                    if nm > worst_nm {
                        worst_nm = nm;
                        println!(
                            "tooth {tooth} {side:?} column {column} row {row}, {from_corner:.4} rad from the corner: \
                            {nm:.3} nm"
                        );
                    }
                }
            }
        }
        println!("{compared} dexels ({before} before, {after} after their corner), worst {worst_nm:.3} nm");
        assert!(before > 100 && after > 100 && worst_nm < 1.0, "{before}, {after}, {worst_nm} nm");
    }
}
