//! Errors of a bevel machine, its clamping and its head come out on flanks as their closed forms say: to first order a
//! displacement d of the head against the work at the moment of contact moves the flank by n . d.

use super::jobs::job;
use crate::fixtures::closed_form;
use gearcut::cut::cpu::Cpu;
use gearcut::frame::Rigid3;
use gearcut::machine_errors::{AxisNoise, NoiseLaw};
use gearcut::passes::SweepPlan;
use gearcut::process::bevel::BevelJob;
use gearcut::random::Draws;
use gearcut::terms::Side;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::TAU;

const SCENE: &str = "five_linkage_printed";
const ARCSEC_RAD: f64 = std::f64::consts::PI / 180.0 / 3600.0;

/// A place on a flank, gear frame.
struct Place {
    point_mm: DVec3,
    normal: DVec3,
    /// Cradle angle of the contact, rad.
    cradle_rad: f64,
    slot: u32,
    /// Pose of the head at the contact.
    gear_from_head: Rigid3,
}

impl Place {
    /// Height after the head has been turned about the gear's axis, rad.
    fn turned(&self, by_rad: f64) -> f64 {
        (by_rad * DVec3::Z.cross(self.point_mm)).dot(self.normal)
    }

    /// Direction of the slide Z, along the head's axis.
    fn along_head(&self) -> DVec3 {
        self.gear_from_head.direction(DVec3::Z)
    }

    /// Height per rad of a turn of the head about an axis through the middle of the plane of its tips, head frame.
    fn leaned(&self, about: DVec3) -> f64 {
        let arm_mm = self.point_mm - self.gear_from_head.translation_mm;
        self.gear_from_head.direction(about).cross(arm_mm).dot(self.normal)
    }
}

/// What an error changes on both flanks of a few teeth, mm.
fn changes(sound: &BevelJob, faulty: &BevelJob, teeth: &[u32]) -> Vec<(Place, f64)> {
    let mut found = Vec::new();
    for &tooth in teeth {
        for side in [Side::Left, Side::Right] {
            let target = sound.target_of(side);
            let arc_mm = 0.55 * target.length_mm();
            let rows_mm = [-6.0, 0.0, 8.0];
            let rays = sound.rays_over(tooth, side, vec![arc_mm], rows_mm.to_vec()).expect("rays");
            let slot = sound.space_of(tooth, side);
            let cut = |job: &BevelJob| {
                job.cut_field(&Cpu::default(), slot, &rays.field).expect("cuts").0.last().expect("a layer").clone()
            };
            let (before, after) = (cut(sound), cut(faulty));
            for (row, &along_mm) in rows_mm.iter().enumerate() {
                let contact = target.row(along_mm).expect("a row").point(target.share_at(arc_mm)).expect("a point");
                let ray = rays.field.ray(0, row);
                let turn = DMat3::from_rotation_z(TAU * f64::from(slot) / f64::from(sound.blank.teeth));
                let turn = Rigid3 { rotation: turn, translation_mm: DVec3::ZERO };
                let work_from_head = sound.finishing().as_set.work_from_tool(contact.cradle_rad);
                let place = Place {
                    point_mm: ray.origin_mm,
                    normal: ray.normal,
                    cradle_rad: contact.cradle_rad,
                    slot,
                    gear_from_head: turn.after(&sound.gear_from_work).after(&work_from_head),
                };
                let index = rays.field.index(0, row);
                found.push((place, f64::from(after.heights_mm[index]) - f64::from(before.heights_mm[index])));
            }
        }
    }
    found
}

/// To 1 % of the closed form's largest value, or 0.1 um.
fn agree(name: &str, found: &[(Place, f64)], least_um: f64, expected: impl Fn(&Place) -> f64) {
    closed_form::agree(name, found, [least_um, 0.1], expected);
}

#[test]
fn errors_are_their_closed_forms() {
    let sound = job(SCENE, &[]).expect("a gear");
    let finishing = sound.finishing();
    let teeth = [1, 17, 40];
    let case = |name: &str, settings: &[&str], least_um: f64, expected: &dyn Fn(&Place) -> f64| {
        agree(name, &changes(&sound, &job(SCENE, settings).expect("a gear"), &teeth), least_um, expected);
    };
    case(
        "waves of the work spindle",
        &["machine.errors.work.periodic_orders=[1.0]", "machine.errors.work.periodic_amplitudes_arcsec=[15.0]"],
        5.0,
        &|place| {
            let indexed = TAU * f64::from(place.slot) / f64::from(sound.blank.teeth);
            let work_rad = finishing.as_set.work_angle(place.cradle_rad)[0];
            place.turned(15.0 * ARCSEC_RAD * (work_rad + indexed).sin())
        },
    );
    let work_rad_per_s = finishing.as_set.work_angle(0.0)[1] * finishing.course.per_s;
    // A lag of an even roll turns the whole gear: it is known, and nothing of it is on the flanks.
    let lag = ["machine.errors.work.velocity_gain_per_s=600"];
    let (turn_rad, lag_rad) = (job(SCENE, &lag).expect("a gear").turn_rad, work_rad_per_s / 600.0);
    assert!((turn_rad + lag_rad).abs() < 1e-6 * lag_rad.abs(), "{turn_rad} rad, lag {lag_rad} rad");
    case("lag of the work spindle", &lag, 0.0, &|_| 0.0);
    case(
        "eccentricity of the work",
        &["mounting.eccentricity_um=10", "mounting.eccentricity_angle_deg=30"],
        3.0,
        &|place| -10e-3 * DVec2::from_angle(30_f64.to_radians()).extend(0.0).dot(place.normal),
    );
    case("mounting distance", &["mounting.axial_offset_um=10"], 1.0, &|place| -10e-3 * place.normal.z);
    let noise = AxisNoise { deviation: 3e-3, law: NoiseLaw::InTime { bandwidth_hz: 1e-3 }, draws: Draws::new(6, 2) };
    case(
        "noise of the slide along the head",
        &["machine.errors.seed=6", "machine.errors.z.noise_um=3", "machine.errors.z.noise_bandwidth_hz=1e-3"],
        1.0,
        &|place| {
            let passed_s = (place.cradle_rad - finishing.course.range[0]) / finishing.course.per_s;
            let time_s = f64::from(place.slot) * finishing.cycle_s() + passed_s;
            noise.at(time_s, 0) * place.along_head().dot(place.normal)
        },
    );
    case("drift of the slide along the head", &["machine.errors.z.drift_um_per_h=60"], 1.0, &|place| {
        let passed_s = (place.cradle_rad - finishing.course.range[0]) / finishing.course.per_s;
        let time_s = f64::from(place.slot) * finishing.cycle_s() + passed_s;
        60e-3 / 3600.0 * time_s * place.along_head().dot(place.normal)
    });
}

/// Settings that are off: the head deeper along the cradle's axis, the work further back, a ratio of roll by which the
/// work turns more the further it is from the middle of the roll.
#[test]
fn errors_of_settings_are_their_closed_forms() {
    let sound = job(SCENE, &[]).expect("a gear");
    let finishing = sound.finishing();
    let case = |key: &str, size: f64, least_um: f64, expected: &dyn Fn(&Place) -> f64| {
        let faulty = job(SCENE, &[&format!("machine.cradle_errors.{key}={size}")]).expect("a gear");
        agree(key, &changes(&sound, &faulty, &[1, 17]), least_um, |place| size * expected(place));
    };
    // The blades' plane is square to the cradle's axis, which the head's is too: its normal stands at the blade angle
    // of 20 deg to every flank. Deeper is less material.
    case("sliding_base_mm", 0.02, 5.0, &|_| -20_f64.to_radians().sin());
    // The gear's z axis runs from its back to the apex.
    case("center_to_back_mm", 0.02, 1.0, &|place| place.normal.z);
    let middle_rad = finishing.as_set.cradle_angle_rad;
    // The pass that leaves a place is up to half a mark from its contact, and turned by as much more or less.
    case("roll_ratio", 0.0002, 0.9, &|place| place.turned(place.cradle_rad - middle_rad));
    // An upright head that leans towards the line of the radial setting turns about its own y axis.
    case("tilt_deg", 0.01, 1.0, &|place| place.leaned(DVec3::Y).to_radians());
}

/// The lean R_z(j) R_y(i) R_z(-j) turns with i about (-sin j, cos j, 0) and with j about z less the head's own axis.
#[test]
fn errors_of_tilt_and_swivel_are_their_closed_forms() {
    const SCENE: &str = "tilted";
    let sound = job(SCENE, &[]).expect("a gear");
    let lean = sound.finishing().settings.tilt;
    let about_tilt = DVec3::new(-lean.swivel_rad.sin(), lean.swivel_rad.cos(), 0.0);
    let about_swivel = lean.rotation().transpose() * DVec3::Z - DVec3::Z;
    for (key, size_deg, about) in [("tilt_deg", 0.01, about_tilt), ("swivel_deg", 0.3, about_swivel)] {
        let error = format!("machine.cradle_errors.{key}={size_deg}");
        let faulty = job(SCENE, &[&error]).expect("a gear");
        let expected = |place: &Place| size_deg * place.leaned(about).to_radians();
        agree(key, &changes(&sound, &faulty, &[1, 17]), 1.0, expected);
    }
}

#[test]
fn errors_of_nothing_change_no_byte() {
    let sound = job(SCENE, &[]).expect("a gear");
    let (slot, side) = (4, Side::Left);
    let rays = sound.rays_over(slot + 1, side, vec![1.0, 2.5], vec![-6.0, 8.0]).expect("rays");
    let cut = |job: &BevelJob| {
        let slot = sound.space_of(slot + 1, side);
        job.cut_field(&Cpu::default(), slot, &rays.field).expect("cuts").0.last().expect("a layer").clone()
    };
    let whole = cut(&sound);
    let zeros = [0.0; 16];
    let runouts = format!("tool.face_mill.runouts_um={zeros:?}");
    let alone: [&[&str]; 6] = [
        &["machine.errors.z.drift_um_per_h=0"],
        &["machine.errors.work.periodic_orders=[1.0]", "machine.errors.work.periodic_amplitudes_arcsec=[0.0]"],
        &["machine.errors.work.velocity_gain_per_s=30", "machine.errors.work.feed_forward=1.0"],
        &["tool.face_mill.wobble_um_per_100mm=0", "tool.face_mill.wobble_angle_deg=30"],
        &["mounting.eccentricity_um=0", "mounting.eccentricity_angle_deg=20", "mounting.axial_offset_um=0"],
        &["machine.cradle_errors.sliding_base_mm=0", "machine.cradle_errors.roll_ratio=0", &runouts],
    ];
    for zeros in alone {
        let zero = job(SCENE, zeros).expect("a gear");
        let layers = zero.scene.process.error_layers();
        assert!(layers.is_empty(), "{zeros:?} are {layers:?}");
        assert!(whole == cut(&zero), "{zeros:?}");
    }
    assert!(whole != cut(&job(SCENE, &["machine.errors.z.drift_um_per_h=300"]).expect("a gear")), "a drift is seen");
}

/// A leaning head lowers each blade's tip by as much at every place of its way: R w cos of the angle between both.
#[test]
fn a_leaning_head_lowers_its_blades_one_by_one() {
    let (lean, towards_rad) = (30e-5, 0.4_f64);
    let sound = job(SCENE, &[]).expect("a gear");
    let towards = format!("tool.face_mill.wobble_angle_deg={}", towards_rad.to_degrees());
    let faulty = job(SCENE, &["tool.face_mill.wobble_um_per_100mm=30", &towards]).expect("a gear");
    let radius_mm = sound.head.radius_mm;
    for slot in [0, 9] {
        let [before, after] = [&sound, &faulty].map(|job| job.slots.of(0, slot));
        for pass in (0..before.count()).step_by(37) {
            let pass = before.pass(pass);
            let blade_rad = before.place(&pass).angle_rad;
            for off_rad in [-0.2, 0.0, 0.15] {
                let tool_rad = pass.tool_angle_rad + off_rad;
                let tip = (radius_mm * DVec2::from_angle(blade_rad + tool_rad)).extend(0.0);
                let [exact, moved] = [before, after].map(|set| set.motion.head_from_work(tool_rad).inverse());
                let lower_mm = -(moved.point(tip) - exact.point(tip)).dot(exact.direction(DVec3::Z));
                let expected_mm = radius_mm * lean * (blade_rad - towards_rad).cos();
                assert!((lower_mm - expected_mm).abs() < 1e-6, "{lower_mm} instead of {expected_mm} mm");
            }
        }
    }
}

#[test]
fn candidates_equal_brute_force_on_a_machine_with_errors() {
    let faulty = job(
        SCENE,
        &[
            "operation.finish.roll_speed_deg_per_s=20",
            "mounting.eccentricity_um=30",
            "mounting.wobble_um_per_100mm=60",
            "tool.face_mill.wobble_um_per_100mm=20",
            "machine.errors.work.periodic_orders=[40.0]",
            "machine.errors.work.periodic_amplitudes_arcsec=[10.0]",
            "machine.errors.x.backlash_um=10",
            "machine.errors.y.velocity_gain_per_s=50",
            "machine.errors.work.noise_arcsec=10",
            "machine.errors.work.noise_bandwidth_hz=0.3",
        ],
    )
    .expect("a gear");
    for side in [Side::Left, Side::Right] {
        let middle_mm = 0.5 * faulty.target_of(side).length_mm();
        let arcs_mm = (0..16).map(|i| middle_mm + 0.05 * f64::from(i)).collect();
        let rays = faulty.rays_over(5, side, arcs_mm, vec![-1.0, 0.0, 1.0]).expect("rays");
        let set = faulty.slots.of(0, faulty.space_of(5, side));
        let [few, all] = [SweepPlan::new, SweepPlan::brute_force].map(|make| {
            let mut layer = rays.field.blank_layer();
            gearcut::cut::Backend::cut_spatial(&Cpu::default(), &rays.field, &make(&rays.field, set), &mut layer)
                .expect("cuts");
            layer
        });
        assert!(few.passes == all.passes && few.heights_mm == all.heights_mm, "{side:?}");
    }
}
