//! A made-up machine of ten axes, turning and sliding in turn: columns, units, peaks, limits, margins.

use super::{Axis, AxisKind, AxisMotion, Limits, Motion, MotionPiece, Order, peaks, smallest_margin};

/// Ten axes that swing, axis k by `amplitude(k)` at `omega_per_s(k)`; the last one moves at constant feeds.
pub(crate) struct Swinging;

pub(crate) const AXES: [Axis; 10] = [
    Axis::new("work spindle", "work", 'C', AxisKind::Rotary).at("psi"),
    Axis::new("X", "x", 'X', AxisKind::Linear).called("tangential axis"),
    Axis::new("tool spindle", "tool", 'B', AxisKind::Rotary),
    Axis::new("Y", "y", 'Y', AxisKind::Linear),
    Axis::new("cradle", "cradle", 'Q', AxisKind::Rotary),
    Axis::new("Z", "z", 'Z', AxisKind::Linear),
    Axis::new("root angle", "root", 'A', AxisKind::Rotary),
    Axis::new("sliding base", "base", 'U', AxisKind::Linear),
    Axis::new("tilt", "tilt", 'D', AxisKind::Rotary),
    Axis::new("shift", "shift", 'W', AxisKind::Linear).at_constant_feed(),
];

/// rad or mm.
pub(crate) fn amplitude(axis: usize) -> f64 {
    0.3 + 0.2 * axis as f64
}

pub(crate) fn omega_per_s(axis: usize) -> f64 {
    1.0 + 0.5 * axis as f64
}

impl Motion<10> for Swinging {
    const AXES: &'static [Axis; 10] = &AXES;

    fn at(&self, time_s: f64) -> [AxisMotion; 10] {
        std::array::from_fn(|axis| {
            let (amplitude, omega) = (amplitude(axis), omega_per_s(axis));
            let (sin, cos) = (omega * time_s + axis as f64).sin_cos();
            AxisMotion {
                position: amplitude * sin,
                velocity: amplitude * omega * cos,
                acceleration: -amplitude * omega * omega * sin,
            }
        })
    }

    /// In two pieces; the first one is too short for the slow axes to reach their peaks.
    fn pieces(&self) -> Vec<MotionPiece> {
        vec![MotionPiece { from: 0.0, to: 0.5, cells: 16 }, MotionPiece { from: 0.5, to: 20.0, cells: 512 }]
    }
}

#[test]
fn columns_and_units_follow_from_the_kind() {
    let names = |index: usize| [Order::Position, Order::Speed, Order::Acceleration].map(|o| AXES[index].column(o));
    assert_eq!(names(0), ["psi_deg", "work_speed_deg_per_s", "work_acceleration_deg_per_s2"]);
    assert_eq!(names(1), ["x_mm", "x_speed_mm_per_s", "x_acceleration_mm_per_s2"]);
    for axis in AXES {
        let base = if axis.kind == AxisKind::Rotary { ["deg", "°"] } else { ["mm", "mm"] };
        for (order, ends) in
            [(Order::Position, ["", ""]), (Order::Speed, ["/s", "/s"]), (Order::Acceleration, ["/s^2", "/s²"])]
        {
            assert_eq!(axis.kind.unit(order), format!("{}{}", base[0], ends[0]));
            assert_eq!(axis.kind.sign(order), format!("{}{}", base[1], ends[1]));
        }
        assert!((axis.kind.read(axis.kind.shown(0.7)) - 0.7).abs() < 1e-15);
    }
    assert!(!AXES[9].has(Order::Acceleration) && AXES[9].has(Order::Speed) && AXES[8].has(Order::Acceleration));
}

#[test]
fn peaks_of_sinusoids_are_amplitude_times_omega() {
    let found = peaks(&Swinging, &[Limits::default(); 10]);
    // Two of every axis, less the acceleration of the one at constant feeds.
    assert_eq!(found.len(), 19);
    for (index, axis) in AXES.iter().enumerate() {
        let of_axis: Vec<_> = found.iter().filter(|peak| peak.axis == axis).collect();
        for (order, power) in [(Order::Speed, 1), (Order::Acceleration, 2)].into_iter().filter(|(o, _)| axis.has(*o)) {
            let peak = of_axis.iter().find(|peak| peak.order == order).expect("a peak of every quantity");
            let expected = amplitude(index) * omega_per_s(index).powi(power);
            assert!((peak.value / expected - 1.0).abs() < 1e-12, "{}: {} not {expected}", peak.name(), peak.value);
            let there = Swinging.at(peak.at)[index].of(order).abs();
            assert!((there / expected - 1.0).abs() < 1e-12, "{} at {}", peak.name(), peak.at);
            let shown = if axis.kind == AxisKind::Rotary { expected * 180.0 / std::f64::consts::PI } else { expected };
            assert!((peak.shown() / shown - 1.0).abs() < 1e-12, "{} {}", peak.shown(), peak.unit());
        }
    }
}

#[test]
fn the_tightest_limit_gives_the_margin() {
    let mut limits = [Limits::default(); 10];
    assert_eq!(smallest_margin(&peaks(&Swinging, &limits)), None);
    // Four times, and half as much, as the axes need.
    limits[2].speed = Some(4.0 * amplitude(2) * omega_per_s(2));
    let found = peaks(&Swinging, &limits);
    assert!((smallest_margin(&found).expect("a limit") - 0.75).abs() < 1e-12);
    assert!(!found.iter().any(super::Peak::exceeds_its_limit));
    limits[7].acceleration = Some(0.5 * amplitude(7) * omega_per_s(7).powi(2));
    let found = peaks(&Swinging, &limits);
    assert!((smallest_margin(&found).expect("limits") + 1.0).abs() < 1e-12);
    let exceeded: Vec<_> = found.iter().filter(|peak| peak.exceeds_its_limit()).map(super::Peak::name).collect();
    assert_eq!(exceeded, ["sliding base acceleration"]);
    // An axis at constant feeds states no acceleration, whatever it is allowed.
    limits[9].acceleration = Some(1e-9);
    assert_eq!(peaks(&Swinging, &limits).len(), 19);
}
