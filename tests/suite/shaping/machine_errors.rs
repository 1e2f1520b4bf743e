//! Errors of machine and clamping come out on flanks as their closed forms say, told apart left and right.
//!
//! To first order a displacement of the cutter against the work at the moment of contact moves the flank by its part
//! along the normal: h = n . (d + w x (p - o)) for a shift d of the cutter's axis o and a turn w of the cutter. At the
//! pitch point of a round gear that is h = a sin(alpha) + s t cos(alpha), for a outwards and t counter-clockwise along
//! the pitch circle, s = 1 on left flanks and -1 on right ones. Each flank is cut twice, with the error and without it:
//! both carry the same facets.

use super::flank_heights::compare_whole_field;
use crate::fixtures::closed_form;
use crate::fixtures::shaped_gear::shaped_gear;
use gearcut::cut::cpu::Cpu;
use gearcut::machine::Motion;
use gearcut::process::shaping::ShapingJob;
use gearcut::terms::Side;
use glam::DVec2;
use std::f64::consts::TAU;
use std::path::Path;

pub const ROUND: &str = shaped_gear!("teeth = 24", 3600, "[operation.infeed.none]");
pub const ELLIPTICAL: &str = shaped_gear!(
    "teeth = 42\n[gear.pitch_curve.ellipse]\norder = 3\neccentricity = 0.1348",
    3600,
    "[operation.infeed.none]"
);
const SECONDS_PER_STROKE: f64 = 60.0 / 300.0;
const STROKES: f64 = 3600.0;
/// Speed of the round gear's work spindle, rad/s.
const WORK_RAD_PER_S: f64 = TAU / STROKES / SECONDS_PER_STROKE;
pub const ALPHA_RAD: f64 = 20.0 * std::f64::consts::PI / 180.0;
pub const PITCH_MM: f64 = 36.0;
const CUTTER_MM: f64 = 30.0;
/// Places along the tooth, mm.
const ROWS_MM: [f64; 3] = [-9.0, 1.0, 9.0];
pub const ARCSEC_RAD: f64 = std::f64::consts::PI / 180.0 / 3600.0;

pub fn job(text: &str, settings: &[&str]) -> ShapingJob {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    let scene = gearcut::process::parse(text, "scene.toml", Path::new(""), &settings).expect("a scene");
    ShapingJob::new(scene.scene).expect("a gear")
}

/// A place on a flank.
pub struct Place {
    /// +1 left, -1 right.
    pub side: f64,
    /// Polar angle of the pitch point at contact, rad, 0 to a turn.
    pub phi_rad: f64,
    /// Stroke that comes nearest.
    pub stroke: f64,
    pub z_mm: f64,
    point_mm: DVec2,
    normal: DVec2,
}

impl Place {
    /// Time of the contact.
    fn time_s(&self) -> f64 {
        self.stroke * SECONDS_PER_STROKE
    }

    /// Height after a shift at the pitch point: outwards and counter-clockwise, mm.
    fn shifted(&self, out_mm: f64, around_mm: f64) -> f64 {
        out_mm * ALPHA_RAD.sin() + self.side * around_mm * ALPHA_RAD.cos()
    }
}

/// What an error changes at a few places near the pitch curve: place and change of height, mm.
pub fn changes(sound: &ShapingJob, faulty: &ShapingJob, teeth: &[u32]) -> Vec<(Place, f64)> {
    let mut found = Vec::new();
    for &tooth in teeth {
        for side in [Side::Left, Side::Right] {
            let flank = sound.target_flank(tooth, side);
            let height = |arc_mm: f64| {
                let contact = flank.at_arc(arc_mm);
                sound.blank.height(contact.point_mm, contact.phi_rad).0
            };
            // The arc at which the flank crosses the pitch curve.
            let (mut low, mut high) = (0.0, flank.length_mm());
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if height(middle) < 0.0 { low = middle } else { high = middle }
            }
            let arcs = || (-2..=2).map(|i| low + 0.02 * f64::from(i));
            let cut = |job: &ShapingJob| {
                job.cut(&Cpu::default(), sound.field_over(flank, arcs(), ROWS_MM.to_vec())).expect("native")
            };
            let (a, b) = (cut(sound), cut(faulty));
            let contact = flank.at_arc(low);
            let phi_rad = contact.phi_rad.rem_euclid(TAU);
            let psi_rad = sound.finishing().linkage.axes(phi_rad, 0.0).psi_c_rad.value();
            for (row, &z_mm) in ROWS_MM.iter().enumerate() {
                let mean = |cut: &gearcut::steps::planar::CutField| {
                    let finished = cut.layers.last().expect("an operation");
                    (0..5).map(|column| f64::from(finished.column(column, ROWS_MM.len())[row])).sum::<f64>() / 5.0
                };
                let place = Place {
                    side: side.sign(),
                    phi_rad,
                    stroke: psi_rad / TAU * STROKES,
                    z_mm,
                    point_mm: contact.point_mm,
                    normal: contact.normal,
                };
                found.push((place, mean(&b) - mean(&a)));
            }
        }
    }
    found
}

/// To 1 % of the closed form's largest value, or 0.02 um.
fn agree(name: &str, found: &[(Place, f64)], least_um: f64, expected: impl Fn(&Place) -> f64) {
    closed_form::agree(name, found, [least_um, 0.02], expected);
}

#[test]
fn errors_of_a_round_gear_are_their_closed_forms() {
    let sound = job(ROUND, &[]);
    let teeth = [3, 11, 20];
    let case = |name: &str, settings: &[&str], least_um: f64, expected: &dyn Fn(&Place) -> f64| {
        agree(name, &changes(&sound, &job(ROUND, settings), &teeth), least_um, expected);
    };
    let work = |place: &Place, turn_rad: f64| place.shifted(0.0, PITCH_MM * turn_rad);
    // The cutter's edge stands on its gear side: what turns counter-clockwise there moves clockwise about the gear.
    let cutter = |place: &Place, turn_rad: f64| place.shifted(0.0, -CUTTER_MM * turn_rad);
    case(
        "waves of the work spindle",
        &[
            "machine.errors.work.periodic_orders=[3.0]",
            "machine.errors.work.periodic_amplitudes_arcsec=[40.0]",
            "machine.errors.work.periodic_phases_deg=[25.0]",
        ],
        3.0,
        &|place| work(place, 40.0 * ARCSEC_RAD * (3.0 * place.phi_rad + 25_f64.to_radians()).sin()),
    );
    case(
        "waves of the cutter spindle",
        &["machine.errors.cutter.periodic_orders=[1.0]", "machine.errors.cutter.periodic_amplitudes_arcsec=[60.0]"],
        3.0,
        &|place| cutter(place, 60.0 * ARCSEC_RAD * (PITCH_MM / CUTTER_MM * place.phi_rad).sin()),
    );
    let distance_mm = PITCH_MM + CUTTER_MM;
    case("scale of the centre distance", &["machine.errors.center_distance.scale_um_per_m=120"], 2.0, &|place| {
        place.shifted(120e-6 * distance_mm, 0.0)
    });
    case(
        "lead of the screw",
        &[
            "machine.errors.center_distance.periodic_lengths_mm=[10.0]",
            "machine.errors.center_distance.periodic_amplitudes_um=[8.0]",
        ],
        1.0,
        &|place| place.shifted(8e-3 * (TAU * distance_mm / 10.0).sin(), 0.0),
    );
    case(
        "drift of the centre distance",
        &[
            "machine.errors.center_distance.drift_um_per_h=60",
            "machine.errors.center_distance.drift_time_constant_min=6",
        ],
        1.0,
        &|place| place.shifted(60e-3 / 3600.0 * 360.0 * (1.0 - (-place.time_s() / 360.0).exp()), 0.0),
    );
    // What turns the whole gear is taken off: it is known, and nothing of it is on the flanks.
    let turned = |name: &str, settings: &[&str], turn_rad: f64| {
        let found = job(ROUND, settings).turn_rad;
        assert!((found - turn_rad).abs() < 1e-6 * turn_rad.abs() + 1e-12, "{name}: {found} rad, {turn_rad} expected");
        case(name, settings, 0.0, &|_| 0.0);
    };
    turned(
        "lag of the work spindle",
        &["machine.errors.work.velocity_gain_per_s=30", "machine.errors.work.feed_forward=0.25"],
        -0.75 * WORK_RAD_PER_S / 30.0,
    );
    turned(
        "lag of the cutter spindle, second order",
        &["machine.errors.cutter.velocity_gain_per_s=30", "machine.errors.cutter.speed_loop_ms=4"],
        WORK_RAD_PER_S / 30.0,
    );
    turned(
        "the same lag of both",
        &["machine.errors.work.velocity_gain_per_s=30", "machine.errors.cutter.velocity_gain_per_s=30"],
        0.0,
    );
    let backlash = ["machine.errors.work.backlash_arcsec=60"];
    turned("backlash of the work spindle", &backlash, -30.0 * ARCSEC_RAD);
    let cycle = ["machine.errors.work.gearbox_cycle_ms=10"];
    turned("cycle of the gearbox", &cycle, -0.010 * WORK_RAD_PER_S);
    let lean = |um_per_100mm: f64, place: &Place| um_per_100mm * 1e-5 * place.z_mm;
    for feed_during_stroke in [false, true] {
        let feed = format!("operation.finish.feed_during_stroke={feed_during_stroke}");
        let sound = job(ROUND, &[&feed]);
        let case = |name: &str, settings: &[&str], expected: &dyn Fn(&Place) -> f64| {
            let settings: Vec<&str> = settings.iter().copied().chain([feed.as_str()]).collect();
            agree(name, &changes(&sound, &job(ROUND, &settings), &teeth), 1.0, expected);
        };
        case("ram out of parallel, radially", &["machine.errors.guide.radial_um_per_100mm=80"], &|place| {
            place.shifted(lean(80.0, place), 0.0)
        });
        case("ram out of parallel, sideways", &["machine.errors.guide.tangential_um_per_100mm=80"], &|place| {
            place.shifted(0.0, lean(80.0, place))
        });
        let bow = |place: &Place| place.shifted(0.0, 6e-3 * (place.z_mm / 10.0).powi(2));
        let bowed = ["machine.errors.guide.tangential_bow_um=6"];
        if feed_during_stroke {
            // A stroke's pose is a cubic through four phases of the crank, the Chebyshev nodes. Half a stroke is 13 mm,
            // z = 13 mm sin(theta): the cubic misses z^2 by 3.8 % of that at the ends of the face at most, by 3.5 % in
            // these rows.
            let faulty = job(ROUND, &[bowed[0], &feed]);
            let [largest_um, worst_um] =
                closed_form::differences_um("bow in the feed", &changes(&sound, &faulty, &teeth), bow);
            assert!(largest_um > 4.0 && worst_um < 0.04 * 6.0, "{worst_um} um off of {largest_um} um");
        } else {
            case("bow of the guide", &bowed, &bow);
        }
        case("wobble of the work", &["mounting.wobble_um_per_100mm=60", "mounting.wobble_angle_deg=50"], &|place| {
            -lean(60.0, place) * DVec2::from_angle(50_f64.to_radians()).dot(place.normal)
        });
    }
    case(
        "eccentricity of the work",
        &["mounting.eccentricity_um=10", "mounting.eccentricity_angle_deg=200"],
        5.0,
        &|place| -10e-3 * DVec2::from_angle(200_f64.to_radians()).dot(place.normal),
    );
    case(
        "offset along the axis, on a guide out of parallel",
        &["mounting.axial_offset_um=5000", "machine.errors.guide.radial_um_per_100mm=80"],
        2.0,
        &|place| place.shifted(80e-5 * (place.z_mm + 5.0), 0.0),
    );
}

/// Height after small errors of the axes at a stroke: work and cutter, rad, centre distance, mm.
pub fn displaced(job: &ShapingJob, place: &Place, errors: impl Fn(f64) -> [f64; 3]) -> f64 {
    let [work_rad, cutter_rad, distance_mm] = errors(place.stroke);
    let state = job.finishing().schedule.state(place.stroke);
    let out = DVec2::from_angle(state.psi_c_rad);
    let shift_mm = distance_mm * out + state.center_distance_mm * work_rad * out.perp();
    let turned_mm = (work_rad + cutter_rad) * (place.point_mm - state.pose.center_mm).perp();
    (shift_mm + turned_mm).dot(place.normal)
}

/// Where axes accelerate the lag is more than v / K_v: on sinusoids the series v / K - a / K^2 begins so. Equal drives
/// only delay the motion; what is left of it is a / (2 K^2).
#[test]
fn drives_lag_on_an_elliptical_gear_as_their_series_says() {
    let sound = job(ELLIPTICAL, &[]);
    let teeth = [2, 4, 7, 9];
    let gain = 20.0;
    let one = |axis: usize| {
        let sound = &sound;
        move |place: &Place| {
            let motion = sound.finishing().schedule.at(place.stroke)[axis];
            let mut errors = [0.0; 3];
            errors[axis] = -motion.velocity / gain + motion.acceleration / gain / gain;
            displaced(sound, place, |_| errors)
        }
    };
    for (axis, name, least_um) in [(0, "work", 10.0), (1, "cutter", 10.0), (2, "center_distance", 0.5)] {
        let faulty = job(ELLIPTICAL, &[&format!("machine.errors.{name}.velocity_gain_per_s={gain}")]);
        agree(&format!("lag of {name}"), &changes(&sound, &faulty, &teeth), least_um, one(axis));
    }
    let all =
        ["work", "cutter", "center_distance"].map(|name| format!("machine.errors.{name}.velocity_gain_per_s={gain}"));
    let faulty = job(ELLIPTICAL, &all.each_ref().map(String::as_str));
    agree("equal lag of all axes", &changes(&sound, &faulty, &teeth), 0.0, |place| {
        let motion = sound.finishing().schedule.at(place.stroke);
        displaced(&sound, place, |_| motion.map(|axis| 0.5 * axis.acceleration / gain / gain))
    });
}

/// The radial axis of an elliptical gear turns back at every end of a half-axis: left of it flanks lie half the play on
/// one side, right of it on the other.
#[test]
fn backlash_of_the_radial_axis_changes_sign_where_it_turns_back() {
    let sound = job(ELLIPTICAL, &[]);
    let faulty = job(ELLIPTICAL, &["machine.errors.center_distance.backlash_um=12"]);
    let found = changes(&sound, &faulty, &[3, 5, 6, 9, 11, 12]);
    let way = |place: &Place| sound.finishing().schedule.at(place.stroke)[2].velocity.signum();
    for sign in [1.0, -1.0] {
        assert!(found.iter().filter(|(place, _)| way(place) == sign).count() >= 6, "flanks on both sides of a turn");
    }
    agree("backlash of the radial axis", &found, 1.5, |place| {
        displaced(&sound, place, |_| [0.0, 0.0, -6e-3 * way(place)])
    });
}

/// Every error at once.
const MANY: [&str; 15] = [
    "mounting.eccentricity_um=30",
    "mounting.wobble_um_per_100mm=80",
    "machine.errors.guide.radial_um_per_100mm=60",
    "machine.errors.guide.tangential_bow_um=15",
    "machine.errors.work.periodic_orders=[1.0, 150.0]",
    "machine.errors.work.periodic_amplitudes_arcsec=[60.0, 20.0]",
    "machine.errors.work.velocity_gain_per_s=20",
    "machine.errors.work.gearbox_cycle_ms=8",
    "machine.errors.work.gearbox_increment_arcsec=20",
    "machine.errors.center_distance.backlash_um=20",
    "machine.errors.center_distance.drift_um_per_h=300",
    "tool.shaper_cutter.runout_um=20",
    "machine.errors.work.noise_arcsec=20",
    "machine.errors.center_distance.noise_um=10",
    "machine.errors.center_distance.noise_bandwidth_hz=3",
];

#[test]
fn candidates_equal_brute_force_on_a_machine_with_errors() {
    for feed in ["operation.finish.feed_during_stroke=false", "operation.finish.feed_during_stroke=true"] {
        let coarse = ["operation.finish.strokes_per_revolution=500", "fields.flank.lead_spacing_um=5000"];
        let settings: Vec<&str> = MANY.into_iter().chain(coarse).chain([feed]).collect();
        let faulty = job(ELLIPTICAL, &settings);
        for (tooth, side) in [(3, Side::Left), (9, Side::Right)] {
            let flank = faulty.target_flank(tooth, side);
            compare_whole_field(&faulty, &faulty.flank_field(flank), faulty.finishing());
        }
    }
}

/// Noise that goes on during a stroke moves the cutter on cubics, with the strokes so close that marks are no deeper
/// than what the cubics leave parabolas by.
#[test]
fn candidates_equal_brute_force_where_axes_wander() {
    let noise = [
        "machine.errors.work.noise_arcsec=2",
        "machine.errors.work.noise_bandwidth_hz=3",
        "machine.errors.center_distance.noise_um=2",
        "machine.errors.center_distance.noise_bandwidth_hz=3",
        "operation.finish.feed_during_stroke=false",
        "operation.finish.strokes_per_revolution=4200",
        "fields.flank.lead_spacing_um=1000",
    ];
    let wandering = job(ELLIPTICAL, &noise);
    for (tooth, side) in [(3, Side::Left), (9, Side::Right)] {
        let field = wandering.flank_field(wandering.target_flank(tooth, side));
        let (columns, rows): (Vec<usize>, Vec<usize>) = ((300..360).collect(), (0..field.rows()).collect());
        compare_whole_field(&wandering, &field.at([&columns, &rows]), wandering.finishing());
    }
}

/// Each alone and all at once: an axis with one error is worked out another way than one without.
#[test]
fn errors_of_nothing_change_no_byte() {
    let alone: [&[&str]; 5] = [
        &["machine.errors.center_distance.drift_um_per_h=0"],
        &["machine.errors.work.periodic_orders=[1.0]", "machine.errors.work.periodic_amplitudes_arcsec=[0.0]"],
        &["machine.errors.work.velocity_gain_per_s=30", "machine.errors.work.feed_forward=1.0"],
        &["tool.shaper_cutter.pitch_errors_um=[]", "tool.shaper_cutter.runout_angle_deg=20"],
        &["operation.finish.stock_scatter_um=0", "mounting.wobble_angle_deg=30"],
    ];
    let zeros = [
        "mounting.eccentricity_um=0",
        "mounting.eccentricity_angle_deg=30",
        "machine.errors.guide.radial_um_per_100mm=0",
        "machine.errors.work.backlash_arcsec=0",
        "machine.errors.center_distance.scale_um_per_m=0",
        "machine.errors.seed=9",
        "machine.errors.work.noise_arcsec=0",
        "machine.errors.center_distance.noise_um=0",
        "machine.errors.center_distance.noise_bandwidth_hz=3",
        "machine.errors.center_distance.drift_um_per_h=0",
        "machine.errors.center_distance.drift_time_constant_min=5",
        "machine.errors.cutter.periodic_orders=[1.0, 2.0]",
        "machine.errors.cutter.periodic_amplitudes_arcsec=[0.0, 0.0]",
    ];
    let coarse = "operation.finish.strokes_per_revolution=700";
    let with = |settings: &[&str]| job(ELLIPTICAL, &[&[coarse], settings].concat());
    let sound = with(&[]);
    let cut = |job: &ShapingJob| {
        let field = job.field_over(job.target_flank(5, Side::Left), [1.0, 2.0, 3.0].into_iter(), ROWS_MM.to_vec());
        job.cut(&Cpu::default(), field).expect("native").layers
    };
    let whole = cut(&sound);
    for zeros in alone.into_iter().chain([&zeros[..]]) {
        let zero = with(zeros);
        let layers = zero.scene.process.error_layers();
        assert!(layers.is_empty(), "{zeros:?} are {layers:?}");
        assert!(whole == cut(&zero), "{zeros:?}");
        let poses =
            |job: &ShapingJob| (0..700).map(|stroke| job.finishing().pose(f64::from(stroke))).collect::<Vec<_>>();
        assert!(poses(&zero) == poses(&sound), "{zeros:?}");
    }
    for least in ["mounting.eccentricity_um=1", "machine.errors.center_distance.drift_um_per_h=300"] {
        assert!(whole != cut(&with(&[least])), "{least} is seen");
    }
    // An offset along the axis means nothing where no guide runs out of parallel.
    assert!(whole == cut(&with(&["mounting.axial_offset_um=100"])));
}

/// Where the axes rest, slices of the blank stand where a shift along the face is told: both ends, the middle of a bow
/// as well; as the scene says, if it does; one in the middle for all that lies within a tenth of the distance of the
/// rays. What is left of the blank is that of slices ten times as dense, to a part in ten thousand, but for the share
/// of the bow.
#[test]
fn slices_of_the_blank_follow_the_guide() {
    let slope = "machine.errors.guide.radial_um_per_100mm=520";
    let (bow, wobble) = ("machine.errors.guide.radial_bow_um=40", "mounting.wobble_um_per_100mm=520");
    let small = ["machine.errors.guide.radial_um_per_100mm=200", "mounting.wobble_um_per_100mm=100"];
    let left = |settings: &[&str]| {
        let coarse = ["operation.finish.strokes_per_revolution=240", "fields.blank.spacing_mm=0.5"];
        let settings: Vec<String> = coarse.iter().chain(settings).map(|&setting| setting.to_owned()).collect();
        let loaded = gearcut::process::parse(ROUND, "round.toml", Path::new(""), &settings).expect("a scene");
        let job = ShapingJob::new(loaded.scene).expect("a job");
        let field = job.planar().blank_field().expect("rays");
        let slices = field.slices.len();
        let cut = job.cut_blank(&Cpu::default(), field, &|| true).expect("cut").expect("not stopped");
        let [x, y] = cut.left_mm3[0];
        (slices, 0.5 * (x + y))
    };
    let (alike, ideal_mm3) = left(&[]);
    assert_eq!(alike, 1);
    let feeds = "operation.finish.feed_during_stroke=true";
    assert_eq!(left(&[feeds, slope]).0, 9, "the feed goes on: every 2.5 mm of 20");
    let dense = "fields.blank.slice_spacing_mm=1";
    for (errors, slices) in [(&[slope][..], 2), (&[wobble], 2), (&[slope, bow], 3)] {
        let ((found, few_mm3), (all, many_mm3)) = (left(errors), left(&[errors, &[dense]].concat()));
        assert_eq!((found, all), (slices, 21), "{errors:?}");
        // A bow of b moves sections by b (z / h)^2, 1/3 of it in the mean, where three slices say 1/2.
        let bent_mm3 = if slices == 3 { (1.0 / 2.0 - 1.0 / 3.0) * 0.040 * TAU * 36.0 * 20.0 } else { 0.0 };
        assert!((few_mm3 - many_mm3).abs() < bent_mm3 + 1e-4 * ideal_mm3, "{errors:?}: {few_mm3}, {many_mm3} mm3");
    }
    // The middle section is the ideal one; rays half a millimetre apart know its area to two parts in ten thousand.
    let ((one, few_mm3), (_, many_mm3)) = (left(&small), left(&[&small[..], &[dense]].concat()));
    assert_eq!((one, few_mm3), (1, ideal_mm3));
    assert!((few_mm3 - many_mm3).abs() < 2e-4 * ideal_mm3, "{few_mm3}, {many_mm3} mm3");
}
