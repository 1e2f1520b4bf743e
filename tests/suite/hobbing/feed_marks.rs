//! Ridges between two feeds as cut, against the second order of one gash's sweep.

use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Ray, SpatialField};
use gearcut::process;
use gearcut::process::hobbing::linkage::feed_marks::{RidgePlace, ridge_mm};
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::terms::Side;
use std::path::Path;

/// Rays along the profile and along the tooth.
const RAYS: [usize; 2] = [25, 61];
/// Feed along the tooth, mm.
const FEED_MM: f64 = 2.5;

/// A gear as long as some feeds, cut by a hob of so many gashes that generating marks are a hundredth of feed marks.
fn job(settings: &[&str]) -> HobbingJob {
    let fine = [
        "gear.teeth=30",
        "gear.face_width_mm=10",
        "tool.hob.gashes=60",
        "tool.hob.length_mm=60",
        &format!("operation.finish.axial_feed_mm_per_revolution={FEED_MM}")[..],
    ];
    let settings: Vec<String> = fine.iter().chain(settings).map(|&s| s.to_owned()).collect();
    let loaded = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).expect("a scene");
    HobbingJob::new(&loaded.scene).expect("a job")
}

/// Highest place as cut over some gashes and more than a feed, about the places `height_mm` over the pitch circle.
fn highest_mm(job: &HobbingJob, side: Side, height_mm: f64) -> f64 {
    let cutter = HobCutter::new(job).expect("passes");
    let space = i64::from(side == Side::Left);
    // On a circle: (r + h)^2 = r^2 + c^2 + 2 r c sin(alpha_t), c = -e roll cos(alpha_t).
    let (sin, cos) = job.target.rack.pressure_angle_rad.sin_cos();
    let radius_mm = job.curve.facts().largest_radius_mm;
    let distance_mm = ((radius_mm * sin).powi(2) + height_mm * (2.0 * radius_mm + height_mm)).sqrt() - radius_mm * sin;
    let roll_mm = -side.sign() * distance_mm / cos;
    let half_mm = [1.5 * job.gash_arc_mm(), 0.55 * FEED_MM];
    let place = |k: usize, i: usize| half_mm[k] * (2.0 * i as f64 / (RAYS[k] - 1) as f64 - 1.0);
    let field = SpatialField::new(RAYS[0], RAYS[1], -1.0, |column, row| {
        let contact = job.target.flank_contact(space, side, roll_mm + place(0, column), place(1, row));
        (Ray { origin_mm: contact.point_mm, normal: contact.normal }, 2.0)
    });
    let (layers, _) = cutter.cut_field(&Cpu::default(), &field).expect("cut");
    layers[0].heights_mm.iter().map(|&height| f64::from(height)).fold(0.0, f64::max)
}

/// Hands of gear and hob, gashes, starts and worms, at the pitch line and beside it: within half a feed over the hob's
/// radius, 3 %, which the third order may be.
#[test]
fn ridges_between_feeds_are_as_high_as_the_second_order_of_a_gash_says() {
    let helical = "gear.helix_angle_deg=25";
    let cases: [(&str, &[&str]); 7] = [
        ("spur", &[]),
        ("right, right", &[helical]),
        ("right, left", &[helical, "tool.hob.hand=left"]),
        ("left, right", &[helical, "gear.hand=left"]),
        ("helical gashes", &[helical, "tool.hob.gash_form=helical", "tool.hob.hand=left"]),
        ("two starts", &[helical, "tool.hob.starts=2", "gear.teeth=31", "tool.hob.hand=left"]),
        ("straight-sided, 25 deg", &[helical, "tool.hob.worm=straight_sided", "gear.pressure_angle_deg=25"]),
    ];
    for (name, settings) in cases {
        let job = job(settings);
        let mut least_of_one = f64::INFINITY;
        for side in [Side::Left, Side::Right] {
            for height_mm in [-1.2, 0.0, 2.0] {
                let contact = RidgePlace {
                    side: side.sign(),
                    pressure_angle_rad: job.scene.gear.pressure_angle_rad,
                    curvature_per_mm: job.curve.facts().largest_curvature.curvature_per_mm,
                    height_mm,
                };
                let geometry = job.finishing().linkage.geometry();
                let ridge_um = 1e3 * ridge_mm(&job.hob, geometry, &contact, FEED_MM).expect("a worm");
                let cut_um = 1e3 * highest_mm(&job, side, height_mm);
                let radius_mm = job.hob.pitch_radius_mm - height_mm;
                let of_one_um =
                    1e3 * (FEED_MM / geometry.head_angle_rad.cos()).powi(2) * job.scene.gear.pressure_angle_rad.sin()
                        / (8.0 * radius_mm);
                println!(
                    "{name} {side:?} {height_mm} mm: {cut_um:.3} um as cut, {ridge_um:.3} foreseen, \
                     {of_one_um:.3} one gash"
                );
                assert!((cut_um / ridge_um - 1.0).abs() < 0.03, "{name}: {cut_um} um for {ridge_um}");
                least_of_one = least_of_one.min(ridge_um / of_one_um);
            }
        }
        // The form of one gash alone would be far too high on every helical gear here.
        assert!(name == "spur" || least_of_one < 0.8, "{name}: {least_of_one}");
    }
}
