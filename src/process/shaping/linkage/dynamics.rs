//! Speeds and accelerations of the axes over an operation, and their peaks against the machine's limits.
//!
//! In: a stroke schedule and the axis limits. Out: position, velocity and acceleration of work, cutter and centre
//! distance at any stroke, and the largest of them. Law: the axes are series in the stroke coordinate (chain rule, no
//! differences), and d lambda/dt = double strokes per minute / 60. The rotary feed is taken as continuous; a machine
//! that stands still while the cutter is in the work has to cover the same way in the return stroke alone.
//!
//! Speeds jump where an infeed begins or ends. The infinite acceleration there is left out, because every control
//! rounds such a corner; both sides of it are counted in the peaks.

use super::axes::Axes;
use super::schedule::StrokeSchedule;
use crate::machine::Peak;
use crate::math::Jet;
use crate::math::extremum::maximum;
use crate::process::shaping::scene::model::AxisLimits;

/// One axis at one moment; rad or mm, per s, per s^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisMotion {
    /// Where it stands.
    pub position: f64,
    /// How fast it moves, per s.
    pub velocity: f64,
    /// How it accelerates, per s^2.
    pub acceleration: f64,
}

/// All axes at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineMotion {
    /// Time from the beginning of stroke 0, s.
    pub time_s: f64,
    /// Work angle psi_c, rad.
    pub work: AxisMotion,
    /// Cutter angle psi_b, rad.
    pub cutter: AxisMotion,
    /// Centre distance l, mm.
    pub center_distance: AxisMotion,
}

/// Peaks of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisPeaks {
    /// Largest speed.
    pub speed: Peak,
    /// Largest acceleration.
    pub acceleration: Peak,
}

/// Peaks of all axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachinePeaks {
    /// Work spindle.
    pub work: AxisPeaks,
    /// Cutter spindle.
    pub cutter: AxisPeaks,
    /// Centre distance.
    pub center_distance: AxisPeaks,
}

/// The axes at a stroke coordinate (any real).
pub fn motion(schedule: &StrokeSchedule, stroke: f64) -> MachineMotion {
    let rate = 1.0 / schedule.seconds_per_stroke();
    let axis = |series: Jet<3>| AxisMotion {
        position: series.value(),
        velocity: series.derivative(1) * rate,
        acceleration: series.derivative(2) * rate * rate,
    };
    let Axes { psi_c_rad, psi_b_rad, center_distance_mm } = schedule.axes_by_stroke(stroke);
    MachineMotion {
        time_s: schedule.time_s(stroke),
        work: axis(psi_c_rad),
        cutter: axis(psi_b_rad),
        center_distance: axis(center_distance_mm),
    }
}

/// Peaks from the first to the last stroke of an operation.
pub fn peaks(schedule: &StrokeSchedule, limits: &AxisLimits) -> MachinePeaks {
    let pieces = smooth_pieces(schedule);
    let peak = |magnitude: &dyn Fn(&MachineMotion) -> f64, limit: Option<f64>| {
        let value = |stroke: f64| magnitude(&motion(schedule, stroke)).abs();
        let best = pieces.iter().map(|[lo, hi]| maximum(value, *lo, *hi, cells(schedule, hi - lo)));
        let (stroke, value) = best.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, 0.0));
        Peak { value, stroke, limit }
    };
    MachinePeaks {
        work: AxisPeaks {
            speed: peak(&|m| m.work.velocity, limits.work_speed_rad_per_s),
            acceleration: peak(&|m| m.work.acceleration, limits.work_acceleration_rad_per_s2),
        },
        cutter: AxisPeaks {
            speed: peak(&|m| m.cutter.velocity, limits.cutter_speed_rad_per_s),
            acceleration: peak(&|m| m.cutter.acceleration, limits.cutter_acceleration_rad_per_s2),
        },
        center_distance: AxisPeaks {
            speed: peak(&|m| m.center_distance.velocity, limits.center_distance_speed_mm_per_s),
            acceleration: peak(&|m| m.center_distance.acceleration, limits.center_distance_acceleration_mm_per_s2),
        },
    }
}

/// Stroke ranges between the corners of the infeed. A piece ends just before its corner, since the series at the
/// corner belong to the next one.
fn smooth_pieces(schedule: &StrokeSchedule) -> Vec<[f64; 2]> {
    let last = (schedule.count() - 1) as f64;
    let mut pieces = Vec::new();
    let mut from = 0.0;
    for corner in schedule.corners() {
        if corner > from && corner < last {
            pieces.push([from, corner * (1.0 - 1e-12)]);
            from = corner;
        }
    }
    pieces.push([from, last]);
    pieces
}

/// Enough cells to see every lobe of the pitch curve.
fn cells(schedule: &StrokeSchedule, strokes: f64) -> usize {
    let per_turn = schedule.linkage().curve().samples_per_turn() as f64;
    let turns = strokes / f64::from(schedule.strokes_per_revolution());
    (per_turn * turns).ceil().max(16.0) as usize
}
