//! What each property of a hob or of its setting does to the gear, against closed forms: profiles by the rack that the
//! thread sweeps, marks, starts.

use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{NO_PASS, Ray, SpatialField};
use gearcut::math::planar_rays::FAMILIES;
use gearcut::passes::SweepPlan;
use gearcut::process::hobbing::measure::offset_curves;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use gearcut::terms::Side;
use gearcut::units::TURN_RAD;
use glam::DVec2;
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::Path;

const MODULE_MM: f64 = 3.0;

fn job(scene: &str, sets: &[&str]) -> HobbingJob {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let loaded = load(Path::new(&format!("scenes/hobbing/{scene}.toml")), &sets).unwrap_or_else(|e| panic!("{e}"));
    HobbingJob::new(&loaded.scene).expect("a scene that cuts")
}

/// Heights that all passes of the last operation leave on rays, mm, down to half a module.
fn heights(job: &HobbingJob, rays: &[Ray]) -> Vec<f64> {
    let cutter = HobCutter::new(job).expect("passes");
    let field = SpatialField::new(rays.len(), 1, -0.5 * MODULE_MM, |column, _| (rays[column], 0.5));
    let plan = SweepPlan::brute_force(&field, cutter.operations.last().expect("one"));
    let mut layer = field.blank_layer();
    Cpu::default().cut_spatial(&field, &plan, &mut layer).expect("cuts");
    layer.heights_mm.iter().map(|&h| f64::from(h)).collect()
}

/// A straight rack flank rolled on a circle: one of both flanks of the space at phi = 0, gear frame. The flank crosses
/// the pitch line at the half width `half_mm` from the space's middle.
struct RolledFlank {
    radius_mm: f64,
    pressure_angle_rad: f64,
    half_mm: f64,
}

impl RolledFlank {
    /// The ray on which the rack's flank touches at a height over its pitch line (negative below), at z, towards either
    /// side of the space.
    fn ray(&self, height_mm: f64, z_mm: f64, side: f64) -> Ray {
        let (sin, cos) = self.pressure_angle_rad.sin_cos();
        // The contact stands on the flank's normal through the pitch point, x along the pitch line, material on the
        // side of larger x; the rack has rolled on so far that its flank is there.
        let contact = DVec2::new(-height_mm * cos / sin, height_mm);
        let rolled_mm = contact.x - self.half_mm - height_mm * sin / cos;
        let back = DVec2::from_angle(rolled_mm / self.radius_mm);
        let place = back.rotate(contact + DVec2::new(0.0, self.radius_mm));
        let normal = back.rotate(DVec2::new(-cos, sin));
        let to_gear = |v: DVec2| DVec2::new(v.y, side * v.x);
        Ray { origin_mm: to_gear(place).extend(z_mm), normal: to_gear(normal).extend(0.0) }
    }
}

/// Sweeping rack of a thread: half thickness of its tooth along the rack at distance `x_mm` from the hob's axis, the
/// thread's axial section `half_thickness_mm(rho)` wound with the parameter `p`, seen along the gear's axis, the head
/// tilted by `tilt_rad`. The furthest place that the helicoid reaches, over its turn.
fn swept_half_mm(half_thickness_mm: impl Fn(f64) -> f64, parameter_mm: f64, tilt_rad: f64, x_mm: f64) -> f64 {
    let reach = |turn: f64| {
        let axial = half_thickness_mm(x_mm / turn.cos()) + parameter_mm * turn;
        axial * tilt_rad.cos() - x_mm * turn.tan() * tilt_rad.sin()
    };
    // Golden section; the reach is concave near its largest value.
    let (mut low, mut high) = (-1.0, 1.0);
    let ratio = 0.5 * (5_f64.sqrt() - 1.0);
    for _ in 0..120 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if reach(a) > reach(b) { high = b } else { low = a }
    }
    reach(0.5 * (low + high))
}

/// Three starts on a small diameter: a lead angle of 8.6 deg makes differences large.
const STEEP: [&str; 6] = [
    "tool.hob.starts=3",
    "tool.hob.reference_diameter_mm=60",
    "tool.hob.gashes=60",
    "tool.hob.tip_radius_mm=0.3",
    "gear.face_width_mm=4",
    "operation.finish.axial_feed_mm_per_revolution=0.4",
];

#[test]
fn an_involute_hob_at_a_wrong_head_angle_keeps_the_profile_and_loses_thickness() {
    // A thread whose involute helicoid has the gear's base pitch meshes with it at any crossing of the axes. The rack
    // runs by p cos(g) per radian then, so that it rolls on the circle r cos(g) / cos(lambda) under the pressure angle
    // that keeps the base circle; where the flanks stand follows from the width of the rack on that circle.
    let (pressure_angle, radius, r) = (20_f64.to_radians(), 30.0, 60.0);
    let new = job("circular_spur", &STEEP);
    let job = job("circular_spur", &[&STEEP[..], &["operation.finish.head_angle_deg=-9.4"]].concat());
    let tilt = 9.4_f64.to_radians();
    let slower = tilt.cos() / new.hob.lead_angle_rad.cos();
    let rolling_mm = r * slower;
    let half_mm = swept_half_mm(
        |rho| new.hob.half_thickness_mm(rho),
        new.hob.lead_mm / TURN_RAD,
        tilt,
        radius - (rolling_mm - r),
    );
    let inv = |angle: f64| angle.tan() - angle;
    let wider_rad = (half_mm / rolling_mm - inv((pressure_angle.cos() / slower).acos()))
        - (0.25 * PI * MODULE_MM / r - inv(pressure_angle));
    let expected_um = -1e3 * r * pressure_angle.cos() * wider_rad;
    let flank = RolledFlank { radius_mm: r, pressure_angle_rad: pressure_angle, half_mm: 0.25 * PI * MODULE_MM };
    for side in [1.0, -1.0] {
        let rays: Vec<Ray> =
            [-2.5, -1.5, -0.5, 0.5, 1.5, 2.5].iter().map(|&level| flank.ray(level, 0.13, side)).collect();
        for (found, mark) in heights(&job, &rays).iter().zip(heights(&new, &rays)) {
            let found_um = 1e3 * (found - mark);
            println!("{found_um:.3} um, {expected_um:.3} expected");
            assert!((found_um - expected_um).abs() < 0.25);
        }
    }
}

/// Beyond half a module under the target no ray looks for the surface.
#[test]
fn flanks_that_a_head_angle_far_off_cuts_away_have_points_without_values() {
    let sets = ["gear.face_width_mm=3", "gear.teeth=21", "operation.finish.head_angle_deg=-17.5"];
    let job = job("circular_helical", &sets);
    let cutter = HobCutter::new(&job).expect("passes");
    let points = offset_curves::measure(&cutter, &Cpu::default(), &[(1, Side::Left)]).expect("it can be measured");
    let lost: Vec<Ray> = points[0]
        .iter()
        .filter(|point| point.cut_mm.is_none() && point.along_mm.is_none())
        .map(|point| {
            let frame = job.curve.frame(job.curve.phi_at_arc(point.target.foot_arc_mm));
            Ray { origin_mm: point.target.point_mm.extend(0.0), normal: frame.tangent.extend(0.0) }
        })
        .collect();
    assert!(!lost.is_empty());
    assert_eq!(heights(&job, &lost), vec![-0.5 * MODULE_MM; lost.len()]);
}

#[test]
fn every_start_cuts_every_tooth_unless_they_share_a_divisor() {
    for (teeth, alone) in [("gear.teeth=21", false), ("gear.teeth=20", true)] {
        let job = job(
            "circular_helical",
            &[teeth, "gear.face_width_mm=4", "fields.blank.spacing_mm=0.4", "fields.blank.slice_spacing_mm=1"],
        );
        let cutter = HobCutter::new(&job).expect("passes");
        let blank = cutter
            .cut_blank(&Cpu::default(), job.blank_field().expect("fits"), &|| true)
            .expect("cuts")
            .expect("not stopped");
        let grid = &blank.cut.field.grid;
        let finish = cutter.operations.last().expect("two");
        // Starts whose passes left the flanks of each space near the pitch curve.
        let count = job.scene.gear.teeth as usize;
        let mut starts = vec![BTreeSet::new(); count];
        for (slice, &z_mm) in blank.cut.field.slices.iter().zip(&grid.slices_z_mm) {
            for (f, family) in FAMILIES.into_iter().enumerate() {
                for (ray, spans) in slice.rays[f].iter().enumerate() {
                    for end in spans.iter().flat_map(|span| [span.low, span.high]) {
                        let place = family.point(end.at_mm, grid.rows[f].at_mm(ray));
                        if end.pass == NO_PASS
                            || end.pass < finish.first_pass
                            || job.blank.height(place, place.to_angle()).0.abs() > 1.5
                        {
                            continue;
                        }
                        let arc =
                            job.curve.arc_mm(place.to_angle().rem_euclid(TURN_RAD)) - job.target.space_arc_mm(0, z_mm);
                        let pitch = PI * job.scene.gear.transverse_module_mm();
                        let space = (arc / pitch).round().rem_euclid(count as f64) as usize;
                        let tooth = job.hob.teeth[finish.blade_of(end.pass).1 as usize];
                        starts[space].insert(tooth.start);
                    }
                }
            }
        }
        let each: Vec<usize> = starts.iter().map(BTreeSet::len).collect();
        println!("{teeth}: {each:?}");
        assert!(each.iter().all(|&n| n == if alone { 1 } else { 2 }));
        if alone {
            // Neighbouring spaces belong to the other start.
            assert!((0..count).all(|i| starts[i] != starts[(i + 1) % count]));
        }
    }
}

mod slow {
    use super::*;

    #[test]
    fn a_protuberance_relieves_the_root_by_its_own_involute() {
        let sets = [
            "gear.teeth=80",
            "gear.face_width_mm=4",
            "tool.hob.gashes=30",
            "tool.hob.tip_radius_mm=0.2",
            "tool.hob.protuberance_height_mm=1.8",
            "tool.hob.protuberance_angle_deg=14",
            "operation.finish.axial_feed_mm_per_revolution=0.4",
        ];
        let job = job("circular_spur", &sets);
        let angle = |degrees: f64| f64::to_radians(degrees);
        let half_mm = 0.25 * PI * MODULE_MM;
        let main = RolledFlank { radius_mm: 120.0, pressure_angle_rad: angle(20.0), half_mm };
        // The protuberance meets the flank 1.8 mm below the tip, 1.95 mm under the pitch line.
        let meets_mm = -(1.25 * MODULE_MM - 1.8);
        let wider_mm = -meets_mm * (angle(20.0).tan() - angle(14.0).tan());
        let relief = RolledFlank { radius_mm: 120.0, pressure_angle_rad: angle(14.0), half_mm: half_mm - wider_mm };
        for side in [1.0, -1.0] {
            let levels: Vec<f64> = (0..8).map(|i| meets_mm - 0.2 - 0.15 * f64::from(i)).collect();
            let of = |flank: &RolledFlank, levels: &[f64]| -> Vec<f64> {
                heights(&job, &levels.iter().map(|&y| flank.ray(y, 0.1, side)).collect::<Vec<_>>())
            };
            let relieved = of(&relief, &levels);
            let above = of(&main, &[meets_mm + 0.4, -1.0, 0.0, 1.0, 2.0]);
            // On the involute that the flank alone would leave, the relief shows as missing material.
            let under = of(&main, &levels[3..6]);
            println!("{relieved:?} {above:?} {under:?}");
            // The protuberance is straight in the rake face, where the thread would be an involute: half a micrometre.
            assert!(
                relieved.iter().all(|h| (-6e-4..4e-3).contains(h)) && above.iter().all(|h| (-1e-6..4e-3).contains(h))
            );
            for (level, found) in levels[3..6].iter().zip(under) {
                let depth = (meets_mm - level) * (angle(20.0).tan() - angle(14.0).tan()) * angle(20.0).cos();
                println!("{level:.2} mm: {found:.4} mm, about {:.4} for the rack itself", -depth);
                assert!(found < -0.5 * depth && found > -2.0 * depth);
            }
        }
    }

    #[test]
    fn threads_leave_the_profile_of_the_rack_that_they_sweep() {
        let pressure_angle = 20_f64.to_radians();
        let new = job("circular_spur", &STEEP);
        let (radius, lead) = (30.0, new.hob.lead_angle_rad);
        let parameter = new.hob.lead_mm / TURN_RAD;
        let flank = RolledFlank { radius_mm: 60.0, pressure_angle_rad: pressure_angle, half_mm: 0.25 * PI * MODULE_MM };
        let levels = [-2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5];
        // Rays of both flanks, and what the new involute hob's marks leave on them.
        let sides = [1.0, -1.0].map(|side| {
            let rays: Vec<Ray> = levels.iter().map(|&y| flank.ray(y, 0.13, side)).collect();
            let marks = heights(&new, &rays);
            (rays, marks)
        });
        assert!(sides.iter().flat_map(|(_, marks)| marks).all(|mark| (0.0..5e-4).contains(mark)));
        for (what, setting, regrind_mm, least_um) in [
            ("straight-sided", "tool.hob.worm=straight_sided", 0.0, 3.0),
            ("reground", "tool.hob.regrind_mm=2.0", 2.0, 3.0),
            ("thinned", "tool.hob.thinning_mm=0.04", 0.0, 15.0),
        ] {
            let sets = [&STEEP[..], &[setting]].concat();
            let job = job("circular_spur", &sets);
            let half = |rho: f64| job.hob.half_thickness_mm(rho);
            let (mut largest_um, mut worst_um) = (0.0_f64, 0.0_f64);
            for (rays, marks) in &sides {
                let found = heights(&job, rays);
                for ((&level, found), mark) in levels.iter().zip(found).zip(marks) {
                    // Over the pitch line of the gear is towards the hob's axis.
                    let swept = swept_half_mm(half, parameter, lead, radius - regrind_mm - level);
                    let straight = 0.25 * PI * MODULE_MM + level * pressure_angle.tan();
                    let expected_um = -1e3 * (swept - straight) * pressure_angle.cos();
                    let found_um = 1e3 * (found - mark);
                    println!(
                        "{what}, {level} mm: {found_um:.3} um, {expected_um:.3} by the swept rack, marks {:.3}",
                        1e3 * mark
                    );
                    largest_um = largest_um.max(expected_um.abs());
                    worst_um = worst_um.max((found_um - expected_um).abs());
                }
            }
            println!("{what}: up to {largest_um:.2} um, {worst_um:.3} um apart");
            assert!(largest_um >= least_um && worst_um < 0.3 + 0.05 * largest_um, "{what}");
        }
    }

    #[test]
    fn climb_and_conventional_leave_the_same_marks() {
        let flank =
            RolledFlank { radius_mm: 60.0, pressure_angle_rad: 20_f64.to_radians(), half_mm: 0.25 * PI * MODULE_MM };
        let highest = |direction: &str| {
            let sets = ["gear.face_width_mm=12", &format!("operation.finish.feed_direction={direction}")[..]];
            let job = job("circular_spur", &sets);
            // One feed along the tooth and more than one facet along the profile.
            let rays: Vec<Ray> = (0..24)
                .flat_map(|i| (0..21).map(move |j| (-0.6 + 0.05 * f64::from(i), -1.0 + 0.1 * f64::from(j))))
                .map(|(level, z)| flank.ray(level, z, 1.0))
                .collect();
            let heights = heights(&job, &rays);
            let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let highest = heights.iter().copied().fold(0.0, f64::max);
            println!("{direction}: {:.4} to {:.4} um", 1e3 * lowest, 1e3 * highest);
            (lowest, highest, job.feed_mark_mm(job.finishing()).expect("a worm"))
        };
        let [climb, conventional] = ["climb", "conventional"].map(highest);
        assert!(climb.0 > -1e-6 && conventional.0 > -1e-6);
        assert!((climb.1 / conventional.1 - 1.0).abs() < 0.05);
        // Feed marks as their closed form, at the tip, generating marks on top.
        assert!(climb.1 > 0.9 * climb.2 && climb.1 < 1.3 * climb.2 && climb.2 == conventional.2);
    }
}
