//! Drives, play and gearboxes against their closed forms.

use super::*;
use crate::machine::AxisMotion;
use glam::{DVec2, DVec3};

fn course(to_s: f64, corners_s: &[f64]) -> Course {
    Course { from_s: 0.0, to_s, corners_s: corners_s.to_vec(), cells: 400, noise_knots_s: None }
}

fn at(time_s: f64) -> MachineMoment<1> {
    MachineMoment { time_s, since_start_s: time_s, at_rest_s: 0.0, passage: 0, indexed: [0.0] }
}

/// The axis behind a command of its own.
fn actual<F: Fn(f64) -> AxisMotion + Sync>(
    errors: AxisErrors,
    course: &Course,
    command: F,
) -> impl Fn(f64) -> f64 + use<F> {
    let motion = ActualMotion::new(&[errors], course, |time_s| [command(time_s)]).expect("an axis with errors");
    move |time_s| motion.positions(&at(time_s), |time_s| [command(time_s).position])[0]
}

fn sine(amplitude: f64, per_s: f64) -> impl Fn(f64) -> AxisMotion + Sync + Copy {
    move |time_s| AxisMotion {
        position: amplitude * (per_s * time_s).sin(),
        velocity: amplitude * per_s * (per_s * time_s).cos(),
        acceleration: -amplitude * per_s * per_s * (per_s * time_s).sin(),
    }
}

fn ramp(speed: f64) -> impl Fn(f64) -> AxisMotion + Sync + Copy {
    move |time_s| AxisMotion { position: speed * time_s, velocity: speed, acceleration: 0.0 }
}

/// (K + f i w) / (K - T w^2 + i w): gain and phase of the loop on a sinusoid.
fn response(servo: Servo, per_s: f64) -> (f64, f64) {
    let Servo { velocity_gain_per_s: gain, feed_forward, speed_loop_s } = servo;
    let above = DVec2::new(gain, feed_forward * per_s);
    let below = DVec2::new(gain - speed_loop_s * per_s * per_s, per_s);
    (above.length() / below.length(), above.to_angle() - below.to_angle())
}

#[test]
fn a_drive_follows_a_sinusoid_with_the_gain_and_phase_of_its_loop() {
    // First order; second order below, at and above critical damping, K T = 1/4; with feed-forward. Between nodes 0.75
    // ms apart the speed's cubics are 1e-9 of it off.
    for (velocity_gain_per_s, speed_loop_s, feed_forward) in [
        (20.0, 0.0, 0.0),
        (20.0, 0.05, 0.0),
        (20.0, 0.0125, 0.0),
        (20.0, 0.002, 0.0),
        (60.0, 0.004, 0.7),
        (5.0, 0.0, 0.9),
    ] {
        let servo = Servo { velocity_gain_per_s, feed_forward, speed_loop_s };
        for per_s in [0.5, 8.0] {
            let course = Course { cells: 4000, ..course(3.0, &[]) };
            let made = actual(AxisErrors { servo: Some(servo), ..AxisErrors::default() }, &course, sine(2.0, per_s));
            let (gain, phase) = response(servo, per_s);
            for i in 0..=60 {
                let time_s = 0.05 * f64::from(i);
                let expected = 2.0 * gain * (per_s * time_s + phase).sin();
                assert!((made(time_s) - expected).abs() < 2e-9, "{servo:?} at {per_s} rad/s: {time_s} s");
            }
        }
    }
}

#[test]
fn a_drive_lags_by_its_speed_over_its_gain() {
    for (feed_forward, speed_loop_s) in [(0.0, 0.0), (0.0, 0.01), (0.4, 0.03)] {
        let servo = Servo { velocity_gain_per_s: 25.0, feed_forward, speed_loop_s };
        let made = actual(AxisErrors { servo: Some(servo), ..AxisErrors::default() }, &course(2.0, &[]), ramp(3.0));
        for time_s in [0.0, 0.7, 2.0] {
            assert!((3.0 * time_s - made(time_s) - (1.0 - feed_forward) * 3.0 / 25.0).abs() < 1e-12);
        }
    }
}

/// From rest to a constant speed at a corner: v / K (1 - exp(-K t)), and for the second order the step answer's
/// integral.
#[test]
fn a_corner_of_the_command_is_forgotten_as_the_loop_decays() {
    let command = |time_s: f64| {
        if time_s < 1.0 {
            AxisMotion { position: 0.0, velocity: 0.0, acceleration: 0.0 }
        } else {
            AxisMotion { position: 2.0 * (time_s - 1.0), velocity: 2.0, acceleration: 0.0 }
        }
    };
    let gain = 15.0;
    let first = Servo { velocity_gain_per_s: gain, feed_forward: 0.0, speed_loop_s: 0.0 };
    let made = actual(AxisErrors { servo: Some(first), ..AxisErrors::default() }, &course(2.0, &[1.0]), command);
    for passed in [0.001, 0.02, 0.1, 0.5] {
        let behind = 2.0 * passed - made(1.0 + passed);
        assert!((behind - 2.0 / gain * (1.0 - (-gain * passed).exp())).abs() < 1e-8, "{passed} s: {behind}");
    }
    // Second order, underdamped: the axis starts with no jump of its speed, x = v (t - 1/K + ...): its own speed is the
    // step answer 1 - exp(-d t) (cos w t + d / w sin w t).
    let t = 0.05;
    let second = Servo { velocity_gain_per_s: gain, feed_forward: 0.0, speed_loop_s: t };
    let made = actual(AxisErrors { servo: Some(second), ..AxisErrors::default() }, &course(2.0, &[1.0]), command);
    let (d, w) = (0.5 / t, (gain / t - 0.25 / t / t).sqrt());
    let h = 1e-4;
    for passed in [0.01, 0.06, 0.2] {
        let speed = (made(1.0 + passed + h) - made(1.0 + passed - h)) / (2.0 * h);
        let expected = 2.0 * (1.0 - (-d * passed).exp() * ((w * passed).cos() + d / w * (w * passed).sin()));
        assert!((speed - expected).abs() < 1e-4, "{passed} s: {speed} instead of {expected}");
    }
}

#[test]
fn an_axis_with_backlash_stands_still_while_its_drive_turns_back() {
    let (width, amplitude) = (0.02, 0.5);
    let errors = AxisErrors { backlash: width, ..AxisErrors::default() };
    let made = actual(errors, &course(12.0, &[]), sine(amplitude, 1.0));
    let turn = std::f64::consts::FRAC_PI_2;
    for cycle in [0.0, std::f64::consts::TAU] {
        // Rising, half the play behind; after the turn at rest until the drive has come back by the whole of it.
        assert!((made(cycle + 1.0) - (amplitude * 1.0_f64.sin() - 0.5 * width)).abs() < 1e-12);
        let back = (1.0 - width / amplitude).acos();
        for share in [0.0, 0.5, 0.99] {
            assert!((made(cycle + turn + share * back) - (amplitude - 0.5 * width)).abs() < 1e-12);
        }
        assert!((made(cycle + 3.0) - (amplitude * 3.0_f64.sin() + 0.5 * width)).abs() < 1e-12);
    }
    // A drive with lag turns later, and so does the axis.
    let servo = Servo { velocity_gain_per_s: 10.0, feed_forward: 0.0, speed_loop_s: 0.0 };
    let errors = AxisErrors { backlash: width, servo: Some(servo), ..AxisErrors::default() };
    let made = actual(errors, &course(12.0, &[]), sine(amplitude, 1.0));
    let (gain, phase) = response(servo, 1.0);
    assert!((made(turn - phase) - (amplitude * gain - 0.5 * width)).abs() < 1e-9);
}

#[test]
fn a_gearbox_gives_rounded_commands_a_cycle_late() {
    let gearbox = GearboxCycle { cycle_s: 0.004, increment: 0.0 };
    let made = actual(AxisErrors { gearbox: Some(gearbox), ..AxisErrors::default() }, &course(1.0, &[]), ramp(5.0));
    for time_s in [0.0, 0.1, 0.3331] {
        assert!((made(time_s) - 5.0 * (time_s - 0.004)).abs() < 1e-12);
    }
    let rounding = GearboxCycle { increment: 0.01, ..gearbox };
    let made = actual(AxisErrors { gearbox: Some(rounding), ..AxisErrors::default() }, &course(1.0, &[]), ramp(5.0));
    // At the beginning of a cycle: 5 x 0.1 rounds to itself, 5 x 0.104 = 0.52 too, 5 x 0.101 is between.
    assert!((made(0.104) - 0.5).abs() < 1e-12 && (made(0.1053) - (0.5 + 0.02 * 0.325)).abs() < 1e-12);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..5000 {
        let time_s = 0.5 + 1e-4 * f64::from(i);
        let off = made(time_s) - (5.0 + 1e-3) * (time_s - 0.004);
        (low, high) = (low.min(off), high.max(off));
    }
    assert!(high - low < 0.012, "{low} to {high}");
}

#[test]
fn scale_waves_and_drift_add_up() {
    let periodic = vec![PeriodicError { rate: 3.0, amplitude: 1e-3, phase_rad: 0.4 }];
    let drift = |time_constant_s| Some(ThermalDrift { per_s: 1e-4, time_constant_s });
    let even = AxisErrors { scale: 2e-5, periodic, drift: drift(None), ..AxisErrors::default() };
    let made = actual(even.clone(), &course(1.0, &[]), ramp(2.0));
    let expected = |time_s: f64| {
        let y = 2.0 * time_s;
        y + 2e-5 * y + 1e-3 * (3.0 * y + 0.4).sin()
    };
    assert!((made(0.7) - expected(0.7) - 0.7e-4).abs() < 1e-15);
    let made = actual(AxisErrors { drift: drift(Some(0.5)), ..even }, &course(1.0, &[]), ramp(2.0));
    assert!((made(0.7) - expected(0.7) - 0.5e-4 * (1.0 - (-1.4_f64).exp())).abs() < 1e-15);
}

/// Errors in the position hold where the axis really is: after indexing.
#[test]
fn waves_follow_the_indexed_axis() {
    let errors = AxisErrors {
        periodic: vec![PeriodicError { rate: 1.0, amplitude: 1e-3, phase_rad: 0.0 }],
        ..AxisErrors::default()
    };
    let motion = ActualMotion::new(&[errors], &course(1.0, &[]), |t| [ramp(1.0)(t)]).expect("errors");
    let moment = MachineMoment { time_s: 0.3, since_start_s: 9.0, at_rest_s: 0.0, passage: 0, indexed: [2.0] };
    let made = motion.positions(&moment, |t| [t])[0];
    assert!((made - 2.3 - 1e-3 * 2.3_f64.sin()).abs() < 1e-15);
}

#[test]
fn no_errors_are_no_motion_of_their_own() {
    assert!(ActualMotion::new(&[AxisErrors::default()], &course(1.0, &[]), |t| [ramp(1.0)(t)]).is_none());
}

#[test]
fn a_leaning_gear_crosses_its_spindle_where_it_should() {
    let mounting = WorkMounting {
        eccentricity_mm: 0.01,
        eccentricity_angle_rad: 0.3,
        wobble_rad: 2e-4,
        wobble_angle_rad: 1.1,
        axial_offset_mm: 0.05,
    };
    let spindle_from_gear = mounting.gear_from_spindle(-70.0).inverse();
    for z_mm in [-80.0, -70.0, -55.0] {
        let axis = spindle_from_gear.point(DVec3::new(0.0, 0.0, z_mm));
        assert!(axis.truncate().distance(mounting.axis_mm(z_mm + 70.0)) < 1e-9);
        assert!((axis.z - z_mm - 0.05).abs() < 1e-6);
        // A place off the axis lies higher or lower, to the square of the lean.
        for place_mm in [DVec2::new(38.0, 0.0), DVec2::new(-12.0, 30.0)] {
            let at = spindle_from_gear.point(place_mm.extend(z_mm));
            assert!((at.z + 70.0 - mounting.height_mm(place_mm.extend(z_mm + 70.0))).abs() < 1e-6);
        }
    }
    let tool = ToolMounting { runout_mm: 0.02, runout_angle_rad: 0.5, wobble_rad: 1e-4, wobble_angle_rad: -0.7 };
    let high = tool.spindle_from_tool().point(DVec3::Z);
    let expected = 0.02 * DVec2::from_angle(0.5) + 1e-4 * DVec2::from_angle(-0.7);
    assert!(high.truncate().distance(expected) < 1e-12);
}
