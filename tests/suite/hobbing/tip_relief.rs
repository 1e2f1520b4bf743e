//! Hobs whose flanks stand out towards their roots: what the gear's tips lose.

use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Ray, SpatialField};
use gearcut::process;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::terms::Side;
use std::path::Path;

/// 30 teeth of 2 mm, marks of some tenths of a micrometre.
fn load(settings: &[&str]) -> gearcut::Result<HobbingJob> {
    let fine = [
        "gear.module_mm=2",
        "gear.teeth=30",
        "gear.face_width_mm=4",
        "tool.hob.reference_diameter_mm=60",
        "tool.hob.length_mm=60",
        "tool.hob.gashes=40",
        "operation.finish.axial_feed_mm_per_revolution=0.5",
    ];
    let settings: Vec<String> = fine.iter().chain(settings).map(|&s| s.to_owned()).collect();
    HobbingJob::new(&process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings)?.scene)
}

/// Heights on the hob over its pitch line of contacts along a flank in the middle of the face, up to the gear's tip,
/// mm, and the deviation as cut there, um.
fn profile(job: &HobbingJob, side: Side) -> Vec<(f64, f64)> {
    let cutter = HobCutter::new(job).expect("passes");
    let (sin, cos) = job.target.rack.pressure_angle_rad.sin_cos();
    // r_a^2 = (r cos)^2 + (r sin + c)^2
    let tip_mm = (32_f64.powi(2) - (30.0 * cos).powi(2)).sqrt() - 30.0 * sin;
    let distances_mm: Vec<f64> = (0..=60).map(|i| tip_mm * f64::from(i) / 60.0).collect();
    let field = SpatialField::new(distances_mm.len(), 1, -1.0, |column, _| {
        let contact = job.target.flank_contact(1, side, -side.sign() * distances_mm[column] / cos, 0.0);
        (Ray { origin_mm: contact.point_mm, normal: contact.normal }, 1.0)
    });
    let (layers, _) = cutter.cut_field(&Cpu::default(), &field).expect("cut");
    distances_mm.iter().zip(&layers[0].heights_mm).map(|(c, &mm)| (c * sin, 1e3 * f64::from(mm))).collect()
}

/// What the gear lacks where a hob flank that stands out by 20 um over 0.8 mm from 1.2 mm on has cut it, um, at a
/// height of contact on the flank without relief.
///
/// The relief is straight, so it generates an involute of its own angle: tan alpha' = tan alpha + 20 um / (0.8 mm cos
/// alpha). Both hob flanks part at 1.2 mm, so the gear's tooth of the relief is 1.2 mm (tan alpha' - tan alpha) a side
/// thicker on the pitch circle. The gear is the lower one of both involutes: the relief begins at 1.191 mm.
fn lack_um(height_mm: f64) -> f64 {
    let involute = |angle: f64| angle.tan() - angle;
    let (alpha, pitch_mm) = (20_f64.to_radians(), 30.0);
    let steeper = (alpha.tan() + 0.02 / (0.8 * alpha.cos())).atan();
    let base_mm = pitch_mm * alpha.cos();
    let tangent_mm = pitch_mm * alpha.sin() + height_mm / alpha.sin();
    // Half angles of a tooth, less that on the pitch circle: of the relieved flank at a radius, and of the place that
    // lies below the flank along its normal, a tangent of its base circle.
    let relieved = |radius_mm: f64| {
        1.2 * (steeper.tan() - alpha.tan()) / pitch_mm + involute(steeper)
            - involute((pitch_mm * steeper.cos() / radius_mm).acos())
    };
    let below = |mm: f64| involute(alpha) - tangent_mm / base_mm + ((tangent_mm - mm) / base_mm).atan();
    let step = |mm: f64| mm + base_mm * (below(mm) - relieved(base_mm.hypot(tangent_mm - mm)));
    1e3 * (0..8).fold(0.0, |mm, _| step(mm)).max(0.0)
}

/// The gear's tip is cut at 1.67 mm, not at the hob's addendum.
#[test]
fn the_gear_lacks_what_the_hob_stands_out_by() {
    let plain = load(&[]).expect("a job");
    let relieved = load(&["tool.hob.tip_relief_height_mm=1.2", "tool.hob.tip_relief_um=20"]).expect("a job");
    for side in [Side::Left, Side::Right] {
        let [without, with] = [&plain, &relieved].map(|job| profile(job, side));
        for ((height_mm, marks_um), (_, found_um)) in without.iter().zip(&with) {
            let expected_um = -lack_um(*height_mm);
            let apart_um = found_um - marks_um - expected_um;
            assert!(apart_um.abs() < 0.1, "{height_mm} mm: {found_um} um, marks {marks_um}, expected {expected_um}");
        }
        let (tip_mm, tip_um) = with[with.len() - 1];
        assert!((tip_mm - 1.669).abs() < 1e-3 && (tip_um + lack_um(tip_mm)).abs() < 0.2, "{tip_um} um at {tip_mm} mm");
    }
}

/// A chamfer of 45 deg from 1.5 mm on rolls an involute of its own; where both flanks of the gear are as thick, the
/// involutes of 20 and of 45 deg through hob flanks that part at 1.5 mm, the gear's chamfer begins: at the radius of
/// 31.59425 mm, which is cut at 1.3694 mm.
#[test]
fn a_chamfer_begins_where_its_involute_leaves_the_flank() {
    let job = load(&["tool.hob.semi_topping_height_mm=1.5"]).expect("a job");
    let profile = profile(&job, Side::Left);
    let below = profile.iter().filter(|(height_mm, _)| *height_mm < 1.3694);
    assert!(below.map(|(_, um)| um.abs()).fold(0.0, f64::max) < 0.5, "{profile:?}");
    let above = profile.iter().filter(|(height_mm, _)| *height_mm > 1.3694 + 0.01);
    assert!(above.map(|(_, um)| *um).fold(-170.0, f64::max) < -5.0, "{profile:?}");
}

#[test]
fn reliefs_that_take_nothing_off_are_refused() {
    for (settings, key) in [
        (&["tool.hob.tip_relief_height_mm=2.1"][..], "tip_relief_height_mm"),
        (&["tool.hob.semi_topping_height_mm=1.5", "tool.hob.semi_topping_angle_deg=15"], "semi_topping_angle_deg"),
        (&["tool.hob.tip_relief_height_mm=1.2", "tool.hob.semi_topping_height_mm=1.0"], "semi_topping_height_mm"),
        (&["tool.hob.semi_topping_height_mm=2.6"], "tip relief or semi-topping begins 2.600 mm"),
    ] {
        let error = load(settings).err().unwrap_or_else(|| panic!("{key}: taken")).to_string();
        assert!(error.contains(key), "{error}");
    }
}
