//! Errors of a hobbing machine, its clamping and its hob come out on flanks as their closed forms say.
//!
//! To first order a displacement d of the hob against the work at the moment of contact moves the flank by n . d. At
//! the pitch point of a round gear the contact stands on the line of centres, at the work angle that is the point's
//! polar angle. Each flank is cut twice, with the error and without it: both carry the same marks.

use super::spatial::same_as_brute_force;
use crate::fixtures::closed_form;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Layer, SpatialField};
use gearcut::machine_errors::{AxisNoise, NoiseLaw};
use gearcut::process;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::random::Draws;
use gearcut::scatter::FlankWish;
use gearcut::scatter::numbers::{NUMBERS, measure};
use gearcut::terms::Side;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::path::Path;

/// Places along the tooth, mm.
const ROWS_MM: [f64; 6] = [-3.0, -1.9, -0.8, 0.5, 1.7, 3.0];
const PITCH_MM: f64 = 36.0;
const ARCSEC_RAD: f64 = std::f64::consts::PI / 180.0 / 3600.0;
/// Speed of the hob, rad/s.
const HOB_RAD_PER_S: f64 = 200.0 * TAU / 60.0;

fn job(settings: &[&str]) -> HobbingJob {
    let fine = [
        "gear.teeth=24",
        "gear.face_width_mm=8",
        "tool.hob.gashes=24",
        "operation.finish.axial_feed_mm_per_revolution=0.6",
    ];
    let settings: Vec<String> = fine.iter().chain(settings).map(|&s| s.to_owned()).collect();
    let loaded = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).expect("a scene");
    HobbingJob::new(&loaded.scene).expect("a job")
}

/// A place near the pitch circle.
struct Place {
    point_mm: DVec3,
    normal: DVec3,
    /// Tool angle of the pass that left it in the faulty gear, its time (s) and where the slide stood then, along the
    /// gear's z (mm): up to half a feed from the place.
    tool_angle_rad: f64,
    time_s: f64,
    slide_z_mm: f64,
    /// Hob tooth of that pass.
    tooth: usize,
}

impl Place {
    /// Outwards, counter-clockwise about the gear, along its axis.
    fn directions(&self) -> [DVec3; 3] {
        let out = self.point_mm.truncate().normalize().extend(0.0);
        [out, DVec3::Z.cross(out), DVec3::Z]
    }

    /// Height after a shift of the hob in those directions, mm.
    fn shifted(&self, by_mm: [f64; 3]) -> f64 {
        self.directions().iter().zip(by_mm).map(|(along, mm)| mm * along.dot(self.normal)).sum()
    }

    fn polar_rad(&self) -> f64 {
        self.point_mm.truncate().to_angle()
    }
}

fn finished(job: &HobbingJob, field: &SpatialField) -> Layer {
    let (layers, stats) = HobCutter::new(job).expect("passes").cut_field(&Cpu::default(), field).expect("cut");
    assert_eq!(stats.unconverged, 0);
    layers.last().expect("an operation").clone()
}

/// A gear without errors: rays near the pitch circle of both flanks of some teeth, and how its cut leaves them.
struct Sound {
    job: HobbingJob,
    cuts: Vec<(SpatialField, Layer)>,
}

impl Sound {
    fn new(settings: &[&str], teeth: &[u32]) -> Self {
        let job = job(settings);
        let cutter = HobCutter::new(&job).expect("passes");
        let flanks = teeth.iter().flat_map(|&tooth| [(tooth, Side::Left), (tooth, Side::Right)]);
        let cuts = flanks.map(|(tooth, side)| {
            let target = cutter.target(tooth, side).expect("a flank");
            let arc_mm = target.arc_at_height_mm(&job.blank, 0.0).expect("the pitch circle");
            let field = cutter.rays_over(target, vec![arc_mm], ROWS_MM.to_vec()).field;
            let layer = finished(&job, &field);
            (field, layer)
        });
        let cuts = cuts.collect();
        Self { job, cuts }
    }
}

/// What an error changes near the pitch circle, mm, where the same pass leaves the surface with it and without it.
/// Elsewhere the heights of two marks are in the difference, and an error that grows along the tooth moves the borders
/// of marks.
fn changes(sound: &Sound, faulty: &HobbingJob) -> Vec<(Place, f64)> {
    let cutter = HobCutter::new(&sound.job).expect("passes");
    let passes = &cutter.operations[0];
    let linkage = &sound.job.finishing().linkage;
    let mut found = Vec::new();
    for (field, before) in &sound.cuts {
        let after = finished(faulty, field);
        for row in 0..ROWS_MM.len() {
            let ray = field.ray(0, row);
            let index = field.index(0, row);
            if before.passes[index] != after.passes[index] {
                continue;
            }
            let pass = passes.pass(after.passes[index] - passes.first_pass);
            let tool_angle_rad = pass.tool_angle_rad;
            let time_s = linkage.time_at_hob_angle(tool_angle_rad);
            let place = Place {
                point_mm: ray.origin_mm,
                normal: ray.normal,
                tool_angle_rad,
                time_s,
                slide_z_mm: -linkage.axes::<1>(time_s).slide_mm.value(),
                tooth: passes.places[pass.rank as usize].blade as usize,
            };
            found.push((place, f64::from(after.heights_mm[index]) - f64::from(before.heights_mm[index])));
        }
    }
    assert!(3 * found.len() > sound.cuts.len() * ROWS_MM.len(), "only {} places", found.len());
    found
}

/// To 1 % of the closed form's largest value, or 0.1 um.
fn agree(name: &str, found: &[(Place, f64)], least_um: f64, expected: impl Fn(&Place) -> f64) {
    closed_form::agree(name, found, [least_um, 0.1], expected);
}

#[test]
fn errors_of_a_round_gear_are_their_closed_forms() {
    let sound = Sound::new(&[], &[2, 13]);
    let case = |name: &str, settings: &[&str], least_um: f64, expected: &dyn Fn(&Place) -> f64| {
        agree(name, &changes(&sound, &job(settings)), least_um, expected);
    };
    case(
        "waves of the work spindle",
        &["machine.errors.work.periodic_orders=[2.0]", "machine.errors.work.periodic_amplitudes_arcsec=[40.0]"],
        3.0,
        &|place| place.shifted([0.0, PITCH_MM * 40.0 * ARCSEC_RAD * (2.0 * place.polar_rad()).sin(), 0.0]),
    );
    // A hob that lags lets the rack stay behind: the gear runs ahead of it. What turns the whole gear is taken off: it
    // is known, and nothing of it is on the flanks.
    let lag_rad = 1.5 * HOB_RAD_PER_S * (1.0 - 0.98) / 100.0 / PITCH_MM;
    let hob = ["machine.errors.hob.velocity_gain_per_s=100", "machine.errors.hob.feed_forward=0.98"];
    let work = ["machine.errors.work.velocity_gain_per_s=100", "machine.errors.work.feed_forward=0.98"];
    for (name, settings, turn_rad) in [
        ("lag of the hob spindle", hob.to_vec(), lag_rad),
        ("lag of the work spindle", work.to_vec(), -lag_rad),
        ("the same lag of both", [hob, work].concat(), 0.0),
    ] {
        let found = job(&settings).turn_rad;
        assert!((found - turn_rad).abs() < 1e-6 * lag_rad, "{name}: {found} rad, {turn_rad} expected");
        case(name, &settings, 0.0, &|_| 0.0);
    }
    case("scale of the radial slide", &["machine.errors.y.scale_um_per_m=300"], 3.0, &|place| {
        place.shifted([300e-6 * PITCH_MM, 0.0, 0.0])
    });
    case("drift of the tangential slide", &["machine.errors.x.drift_um_per_h=300"], 3.0, &|place| {
        place.shifted([0.0, 0.3 / 3600.0 * place.time_s, 0.0])
    });
    // Slow enough to stand still while a tooth passes: over 17 ms it changes by 0.7 % of 40 arcsec.
    let noise = AxisNoise {
        deviation: 40.0 * ARCSEC_RAD,
        law: NoiseLaw::InTime { bandwidth_hz: 2e-4 },
        draws: Draws::new(6, 1),
    };
    case(
        "noise of the work spindle",
        &[
            "machine.errors.seed=6",
            "machine.errors.work.noise_arcsec=40",
            "machine.errors.work.noise_bandwidth_hz=2e-4",
        ],
        1.0,
        &|place| place.shifted([0.0, PITCH_MM * noise.at(place.time_s, 0), 0.0]),
    );
    case(
        "slide out of parallel",
        &["machine.errors.guide.radial_um_per_100mm=200", "machine.errors.guide.tangential_um_per_100mm=-150"],
        3.0,
        &|place| place.shifted([200e-5 * place.slide_z_mm, -150e-5 * place.slide_z_mm, 0.0]),
    );
    let direction = |degrees: f64| DVec2::from_angle(degrees.to_radians()).extend(0.0);
    case(
        "eccentricity and wobble of the work",
        &[
            "mounting.eccentricity_um=8",
            "mounting.eccentricity_angle_deg=70",
            "mounting.wobble_um_per_100mm=120",
            "mounting.wobble_angle_deg=-20",
        ],
        5.0,
        &|place| -(8e-3 * direction(70.0) + 120e-5 * place.point_mm.z * direction(-20.0)).dot(place.normal),
    );
}

/// Roughing twice as fast lags twice as far. The zero of the work spindle is one for both operations, that of the last:
/// the roughed gear is turned against the finished one by the difference.
#[test]
fn operations_of_other_speeds_are_turned_against_each_other() {
    const TWO: &str = "[gear]\nmodule_mm = 3.0\nteeth = 24\nface_width_mm = 8.0\n[tool.hob]\ngashes = 24\n\
        [[operation]]\nname = \"rough\"\noffset_mm = 0.3\nhob_speed_per_minute = 200.0\n\
        [[operation]]\nname = \"finish\"\nhob_speed_per_minute = 100.0\n";
    let jobs = [&[][..], &["machine.errors.work.velocity_gain_per_s=100".to_owned()]].map(|lag| {
        let loaded = process::parse(TWO, "two.toml", Path::new(""), lag).expect("a scene");
        HobbingJob::new(&loaded.scene).expect("a job")
    });
    let lag_rad = |per_minute: f64| per_minute * TAU / 60.0 / 24.0 / 100.0;
    for (operation, turn_rad) in [(0, lag_rad(100.0) - lag_rad(200.0)), (1, 0.0)] {
        let poses = jobs.each_ref().map(|job| {
            let of = &job.operations[operation];
            let hob_rad = 0.4 * of.commanded().turned_rad()[1];
            of.actual.head_from_work(of.commanded(), hob_rad)
        });
        let turned = poses[0].inverse().after(&poses[1]).rotation;
        let found = -turned.x_axis.truncate().to_angle();
        assert!(
            (found - turn_rad).abs() < 1e-3 * lag_rad(100.0),
            "operation {operation}: {found}, {turn_rad} expected"
        );
    }
}

/// On a helical gear what moves along the axis moves flanks as well.
#[test]
fn errors_along_the_axis_show_on_a_helical_gear() {
    let helical = "gear.helix_angle_deg=20";
    let sound = Sound::new(&[helical], &[5]);
    let case = |name: &str, setting: &str, expected: &dyn Fn(&Place) -> f64| {
        agree(name, &changes(&sound, &job(&[helical, setting])), 1.0, expected);
    };
    case("scale of the slide", "machine.errors.slide.scale_um_per_m=3000", &|place| {
        place.shifted([0.0, 0.0, 3e-3 * place.slide_z_mm])
    });
    case("offset of the work", "mounting.axial_offset_um=-12", &|place| place.shifted([0.0, 0.0, 12e-3]));
}

/// The hob's axis runs round its spindle's: the pass that left a place says where it was.
#[test]
fn runout_of_the_hob_follows_its_angle() {
    let sound = Sound::new(&[], &[2, 9]);
    let (runout_mm, angle_rad) = (8e-3, 0.5);
    let faulty = job(&[
        "tool.hob.runout_um=8",
        &format!("tool.hob.runout_angle_deg={}", angle_rad * 180.0 / std::f64::consts::PI),
    ]);
    let geometry = faulty.finishing().linkage.geometry();
    agree("runout of the hob", &changes(&sound, &faulty), 1.0, |place| {
        let tool = geometry.machine_from_tool(place.tool_angle_rad, 0.0, 0.0, 0.0).rotation;
        let shift = runout_mm * (tool.x_axis * f64::cos(angle_rad) + tool.y_axis * f64::sin(angle_rad));
        // Machine x is counter-clockwise about the gear, y outwards, z against the gear's.
        place.shifted([shift.y, shift.x, -shift.z])
    });
}

/// A tooth that stands off its thread by e along the hob's axis moves what it leaves by e along that axis, and no other
/// one does. The axis runs along the machine's x, counter-clockwise about the gear, but for the lead; towards it lies
/// the end at which uncut work arrives, for a right-hand thread runs against it.
#[test]
fn teeth_off_their_thread_leave_their_own_errors() {
    let sound = Sound::new(&[], &[2, 9]);
    let geometry = sound.job.finishing().linkage.geometry();
    let along = |place: &Place| {
        let axis = geometry.machine_from_tool(place.tool_angle_rad, 0.0, 0.0, 0.0).rotation.z_axis;
        place.shifted([axis.y, axis.x, -axis.z])
    };
    let error_mm = |gash: i64| 1e-3 * (8.0 * (gash * 7 % 24) as f64 / 23.0 - 4.0);
    let list: Vec<f64> = (0..24).map(|gash| 1e3 * error_mm(gash)).collect();
    let faulty = job(&[&format!("tool.hob.pitch_errors_um={list:?}")]);
    let found = changes(&sound, &faulty);
    // Gashes cut one after the other: the one that looks at the gear at the hob's angle 0 is the first.
    let of_gash = |place: &Place| error_mm((24.0 * place.tool_angle_rad / TAU).round().rem_euclid(24.0) as i64);
    agree("pitch errors of a hob", &found, 2.0, |place| of_gash(place) * along(place));
    let [_, other_um] = closed_form::differences_um("planted", &found, |place| -of_gash(place) * along(place));
    assert!(other_um > 2.0, "the other way is seen");
    // A thread that runs too far: two starts, errors of the second one alone.
    let two = ["tool.hob.starts=2", "gear.teeth=25"];
    let second = [vec!["0.0"; 24], vec!["5.0"; 24]].concat().join(", ");
    let setting = format!("tool.hob.pitch_errors_um=[{second}]");
    let (sound, faulty) = (Sound::new(&two, &[2, 9]), job(&[&two[..], &[&setting]].concat()));
    let found = changes(&sound, &faulty);
    let of_thread = |place: &Place| if sound.job.hob.teeth[place.tooth].start == 1 { 5e-3 } else { 0.0 };
    agree("a thread off its place", &found, 2.0, |place| of_thread(place) * along(place));
    assert!(found.iter().any(|(place, _)| of_thread(place) == 0.0), "both threads leave places");
    let wrong: Vec<String> = vec!["tool.hob.pitch_errors_um=[1.0, 2.0]".to_owned()];
    let refused = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &wrong).expect_err("two of them");
    assert!(refused.to_string().contains("one value per gash"), "{refused}");
}

#[test]
fn errors_of_nothing_change_no_byte() {
    let sound = job(&[]);
    let cut = |job: &HobbingJob| {
        let cutter = HobCutter::new(&sound).expect("passes");
        let target = cutter.target(5, Side::Left).expect("a flank");
        finished(job, &cutter.rays_over(target, vec![1.0, 3.0], vec![-2.0, 1.5]).field)
    };
    let whole = cut(&sound);
    let zeros = [0.0; 24];
    let pitch = format!("tool.hob.pitch_errors_um={zeros:?}");
    let alone: [&[&str]; 7] = [
        &["machine.errors.y.drift_um_per_h=0"],
        &["machine.errors.hob.periodic_orders=[1.0]", "machine.errors.hob.periodic_amplitudes_arcsec=[0.0]"],
        &["machine.errors.work.velocity_gain_per_s=30", "machine.errors.work.feed_forward=1.0"],
        &["tool.hob.runout_um=0", "tool.hob.runout_angle_deg=30", "tool.hob.wobble_angle_deg=10"],
        &["mounting.eccentricity_angle_deg=20", "mounting.wobble_um_per_100mm=0"],
        &["machine.errors.work.noise_arcsec=0", "machine.errors.work.noise_bandwidth_hz=0.1"],
        &[&pitch],
    ];
    for zeros in alone {
        let zero = job(zeros);
        let layers = zero.scene.process.error_layers();
        assert!(layers.is_empty(), "{zeros:?} are {layers:?}");
        assert!(whole == cut(&zero), "{zeros:?}");
    }
    assert!(whole != cut(&job(&["machine.errors.y.drift_um_per_h=300"])), "a drift is seen");
}

/// Errors at once, the fastest that are allowed among them.
const MANY: [&str; 13] = [
    "tool.hob.pitch_errors_um=[0, 12, -8, 3, 0, 5, -15, 2, 9, -4, 0, 7, 1, -6, 11, -2, 4, 0, -9, 6, 3, -7, 8, -1]",
    "mounting.eccentricity_um=30",
    "mounting.wobble_um_per_100mm=80",
    "tool.hob.runout_um=20",
    "tool.hob.wobble_um_per_100mm=60",
    "machine.errors.guide.tangential_bow_um=15",
    "machine.errors.hob.periodic_orders=[1.0, 8.0]",
    "machine.errors.hob.periodic_amplitudes_arcsec=[90.0, 10.0]",
    "machine.errors.work.periodic_orders=[100.0]",
    "machine.errors.work.periodic_amplitudes_arcsec=[10.0]",
    "machine.errors.work.velocity_gain_per_s=40",
    "machine.errors.work.feed_forward=0.99",
    "machine.errors.y.drift_um_per_h=500",
];

#[test]
fn passes_follow_a_machine_with_errors_and_candidates_equal_brute_force() {
    let faulty = job(&MANY);
    let cutter = HobCutter::new(&faulty).expect("passes");
    let operation = faulty.finishing();
    let passes = &cutter.operations[0];
    let off_mm = passes.motion.error_mm(40.0, |angle| operation.actual.head_from_work(operation.commanded(), angle));
    // 10 arcsec of eight waves in a turn of the hob are 2 um on the gear; a hundredth of a micrometre is left.
    println!("the table of the motion is {off_mm:e} mm off");
    assert!(off_mm < 1e-5, "{off_mm:e} mm");
    equal_brute_force("a machine with errors", &faulty);
    // A fifth of a wave in a turn of the hob.
    let noise = ["y.noise_um=10", "y.noise_bandwidth_hz=0.6", "work.noise_arcsec=20", "work.noise_bandwidth_hz=0.6"];
    let noise = noise.map(|key| format!("machine.errors.{key}"));
    let settings: Vec<&str> = MANY.into_iter().chain(noise.iter().map(String::as_str)).collect();
    equal_brute_force("a machine with errors and noise", &job(&settings));
}

fn equal_brute_force(name: &str, faulty: &HobbingJob) {
    let cutter = HobCutter::new(faulty).expect("passes");
    let target = cutter.target(4, Side::Right).expect("a flank");
    let arcs_mm = (0..6).map(|i| 0.3 + 0.8 * f64::from(i)).collect();
    let field = cutter.rays_over(target, arcs_mm, vec![-2.0, 1.0]).field;
    same_as_brute_force(name, &cutter.operations[0], &field, &field.blank_layer());
}

#[test]
fn waves_that_are_too_short_are_refused() {
    let settings: Vec<String> =
        ["machine.errors.hob.periodic_orders=[9.0]", "machine.errors.hob.periodic_amplitudes_arcsec=[1.0]"]
            .map(str::to_owned)
            .to_vec();
    let loaded = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).expect("a scene");
    let refused = HobbingJob::new(&loaded.scene).expect_err("nine waves in a turn of the hob").to_string();
    assert!(refused.contains("machine.errors.hob") && refused.contains("9.0 waves"), "{refused}");
}

/// An eccentric helical gear: normals turn with the helix, so that a pitch taken by the normal pressure angle alone
/// would be too small by cos(beta). Along the pitch circle a tooth is off by e sin(psi) / cos(alpha_t).
#[test]
fn scatter_finds_the_pitch_of_an_eccentric_helical_gear() {
    const ECCENTRICITY_UM: f64 = 40.0;
    let settings = [
        "gear.teeth=15",
        "gear.helix_angle_deg=30",
        "gear.hand='right'",
        "gear.face_width_mm=4",
        "gear.profile_shift_coefficient=0.3",
        "tool.hob.starts=1",
        "operation.finish.axial_feed_mm_per_revolution=1",
        "mounting.eccentricity_um=40",
    ];
    let settings: Vec<String> = settings.map(str::to_owned).to_vec();
    let scene = process::load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).expect("a scene").scene;
    let flank = FlankWish { tooth: 1, side: Side::Left };
    let job = process::prepare(&scene).expect("a gear");
    let values = measure(&scene, job.as_ref(), flank, &Cpu::default()).expect("a gear");
    let of = |key: &str| {
        let number = NUMBERS.iter().position(|number| number.key == key).expect("a number");
        values[number].expect("a value")
    };
    let wanted_um = 2.0 * ECCENTRICITY_UM / scene.gear.transverse_pressure_angle_rad().cos();
    // Of fifteen teeth none needs to stand at the top of the wave: the range is cos(pi / 30) of it at least.
    let found_um = of("F_p");
    println!("F_p {found_um} um, {wanted_um} um by hand");
    assert!((0.99..1.01).contains(&(found_um / wanted_um)), "{found_um} um, {wanted_um} um expected");
}
