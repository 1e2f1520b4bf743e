//! The strokes of one operation: where every axis stands at every stroke, and in between.
//!
//! In: the operation (feed, spacing, window, infeed), the linkage, the machine. Out: [`StrokeSchedule`], which answers
//! for any real stroke coordinate lambda: stroke i (from 0) is lambda = i, and the rotary feed that goes on during a
//! stroke is lambda = i + u.
//!
//! Law: the progress sigma (work angle, arc or time) is linear in the rolling stroke, sigma = sigma_0 + (i_0 + rho)
//! sigma_per_stroke; phi follows by inversion at the offset of that stroke, the axes from phi. With N strokes per
//! revolution and the work angle as progress this is psi_c(i) = (i - 1) 2 pi / N (Gao et al. 2017), whole turns without
//! the stroke N + 1 that repeats the first. A window takes exactly those strokes of this grid that lie in it, ends
//! included; with another progress the grid begins at the window's first angle. Plunging strokes come before rho = 0
//! and stand at the phi of the first rolling stroke.
//!
//! Road not taken: a list of poses. It is large at finishing feeds and has nothing to say between strokes.

mod infeed;
mod progress;

use super::ShapingLinkage;
use super::axes::{Axes, CutterPose};
use crate::process::shaping::scene::model::{Feed, Machine, Operation, StrokeSpacing};
use gearcut_core::error::Refusal;
use gearcut_core::math::Jet;
use gearcut_core::units::TURN_RAD;
use infeed::InfeedPlan;
use progress::PathProgress;

/// Stroke counts are rounded after this much, in strokes: rounding of angles must not add a stroke.
const COUNT_TOLERANCE: f64 = 1e-9;

/// All strokes of an operation.
#[derive(Debug, Clone)]
pub struct StrokeSchedule {
    linkage: ShapingLinkage,
    progress: PathProgress,
    infeed: InfeedPlan,
    start: f64,
    first_index: f64,
    per_stroke: f64,
    count: usize,
    start_phi_rad: f64,
    strokes_per_revolution: u32,
    double_strokes_per_minute: f64,
    seconds_per_stroke: f64,
}

/// The machine at one stroke coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeState {
    /// Polar angle of the pitch point, rad, unwrapped.
    pub phi_rad: f64,
    /// Offset in force, mm.
    pub offset_mm: f64,
    /// Work angle, rad, unwrapped.
    pub psi_c_rad: f64,
    /// Cutter angle, rad, unwrapped.
    pub psi_b_rad: f64,
    /// Centre distance, mm.
    pub center_distance_mm: f64,
    /// Cutter in the gear frame.
    pub pose: CutterPose,
}

impl StrokeSchedule {
    /// Lays out the strokes.
    ///
    /// # Errors
    /// A feed without strokes, a window that no stroke falls into or that is combined with further revolutions, equal
    /// times without a speed limit, an offset at which the linkage does not roll.
    pub fn new(operation: &Operation, linkage: &ShapingLinkage, machine: &Machine) -> Result<Self, Refusal> {
        let key = |name: &str| format!("operation.{}.{name}", operation.name);
        let strokes_per_revolution = strokes_per_revolution(operation.feed, linkage.curve().perimeter_mm(), key)?;
        let dspm = machine.double_strokes_per_minute;
        if !(dspm.is_finite() && dspm > 0.0) {
            let problem = format!("{dspm} double strokes per minute");
            return Err(Refusal::new("machine.double_strokes_per_minute", problem, "give a positive number"));
        }
        let offset_mm = operation.offset_mm;
        linkage.check(offset_mm)?;
        let limits = machine.limits;
        let progress = PathProgress::new(operation.spacing, linkage, limits, offset_mm, &key("stroke_spacing"))?;
        let per_stroke = progress.per_turn(linkage) / f64::from(strokes_per_revolution);
        let whole_rad = f64::from(operation.revolutions) * TURN_RAD + operation.overlap_rad;
        let [from_rad, to_rad] = operation.window_rad.unwrap_or([0.0, whole_rad]);
        if operation.window_rad.is_some() && whole_rad > TURN_RAD {
            let problem = "a window of work angles is cut once, without further revolutions or an overlap";
            let way_out = "leave out the window, or set revolutions = 1 and overlap_deg = 0";
            return Err(Refusal::new(&key("window_deg"), problem, way_out));
        }
        let sigma = |psi_c_rad: f64| {
            let phi = linkage.phi_at_work_angle(psi_c_rad, offset_mm);
            progress.along(linkage, Jet::variable(phi), Jet::constant(offset_mm)).value()
        };
        let (start, first_index) = match operation.spacing {
            // the grid of psi_c begins at 0
            StrokeSpacing::WorkAngle => (0.0, (from_rad / per_stroke - COUNT_TOLERANCE).ceil()),
            _ => (sigma(from_rad), 0.0),
        };
        let reach = (sigma(to_rad) - start) / per_stroke - first_index;
        let rolling = match operation.window_rad {
            Some(_) => (reach + COUNT_TOLERANCE).floor() + 1.0,
            None => (reach - COUNT_TOLERANCE).ceil(),
        };
        if rolling.is_nan() || rolling < 1.0 {
            let problem = format!("no stroke falls between {} and {} deg", from_rad.to_degrees(), to_rad.to_degrees());
            return Err(Refusal::new(
                &key("window_deg"),
                problem,
                "widen the window or take more strokes per revolution",
            ));
        }
        let first_sigma = start + first_index * per_stroke;
        let strokes_over = |angle_rad: f64| (sigma(from_rad + angle_rad) - first_sigma) / per_stroke;
        let infeed = InfeedPlan::new(operation.infeed, offset_mm, strokes_over);
        linkage.check(infeed.largest_offset_mm())?;
        let rolling_offset_mm = infeed.offset(infeed.plunge_strokes() as f64).value();
        Ok(Self {
            start_phi_rad: progress.phi(linkage, first_sigma, rolling_offset_mm),
            linkage: linkage.clone(),
            progress,
            infeed,
            start,
            first_index,
            per_stroke,
            count: infeed.plunge_strokes() + rolling as usize,
            strokes_per_revolution,
            double_strokes_per_minute: dspm,
            seconds_per_stroke: 60.0 / dspm,
        })
    }

    /// Number of strokes, plunging ones included.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Number of strokes at the beginning that plunge without rolling.
    pub fn plunge_count(&self) -> usize {
        self.infeed.plunge_strokes()
    }

    /// N, given or following from the circular feed.
    pub fn strokes_per_revolution(&self) -> u32 {
        self.strokes_per_revolution
    }

    /// Mean arc of pitch curve per double stroke as it is really run, mm: a circular feed is rounded down to whole
    /// strokes per revolution.
    pub fn circular_feed_mm_per_stroke(&self) -> f64 {
        self.linkage.curve().perimeter_mm() / f64::from(self.strokes_per_revolution)
    }

    /// The same strokes at another speed of the ram: that of a program that is cut in their place.
    #[must_use]
    pub fn at_speed(self, double_strokes_per_minute: f64) -> Self {
        Self { double_strokes_per_minute, seconds_per_stroke: 60.0 / double_strokes_per_minute, ..self }
    }

    /// Speed of the ram.
    pub fn double_strokes_per_minute(&self) -> f64 {
        self.double_strokes_per_minute
    }

    /// Time of a stroke coordinate from the beginning of stroke 0, s.
    pub fn time_s(&self, stroke: f64) -> f64 {
        stroke * self.seconds_per_stroke
    }

    /// The linkage that moves the axes.
    pub fn linkage(&self) -> &ShapingLinkage {
        &self.linkage
    }

    /// Stroke coordinates at which the infeed begins or ends and axis speeds jump.
    pub fn corners(&self) -> [f64; 2] {
        self.infeed.corners()
    }

    /// Offset in force at a stroke coordinate, mm.
    pub fn offset_mm(&self, stroke: f64) -> f64 {
        self.infeed.offset(stroke).value()
    }

    /// Polar angle of the pitch point at a stroke coordinate, rad, unwrapped.
    pub fn phi_rad(&self, stroke: f64) -> f64 {
        let rolled = stroke - self.infeed.plunge_strokes() as f64;
        if rolled < 0.0 && self.infeed.plunge_strokes() > 0 {
            return self.start_phi_rad;
        }
        self.progress.phi(&self.linkage, self.sigma(rolled), self.offset_mm(stroke))
    }

    /// The machine at a stroke coordinate (any real; before the first and after the last stroke the motion is
    /// continued).
    pub fn state(&self, stroke: f64) -> StrokeState {
        let (phi_rad, offset_mm) = (self.phi_rad(stroke), self.offset_mm(stroke));
        let axes = self.linkage.axes_along::<1>(Jet::constant(phi_rad), Jet::constant(offset_mm));
        StrokeState {
            phi_rad,
            offset_mm,
            psi_c_rad: axes.psi_c_rad.value(),
            psi_b_rad: axes.psi_b_rad.value(),
            center_distance_mm: axes.center_distance_mm.value(),
            pose: axes.pose(self.linkage.gear()),
        }
    }

    /// Axis positions as series in the stroke coordinate. phi is found first; then its derivatives, one after the
    /// other, from what is missing in sigma(phi(lambda), offset(lambda)) against its linear course.
    pub fn axes_by_stroke(&self, stroke: f64) -> Axes<3> {
        let offset = self.infeed.offset(stroke);
        let rolled = stroke - self.infeed.plunge_strokes() as f64;
        let phi = self.phi_rad(stroke);
        if rolled < 0.0 && self.infeed.plunge_strokes() > 0 {
            return self.linkage.axes_along(Jet::constant(phi), offset);
        }
        let slope = self.progress.along(&self.linkage, Jet::variable(phi), Jet::constant(offset.value())).derivative(1);
        let missing = |phi: Jet<3>| {
            Jet::linear(self.sigma(rolled), self.per_stroke) - self.progress.along(&self.linkage, phi, offset)
        };
        let rate = missing(Jet::constant(phi)).taylor()[1] / slope;
        let bend = missing(Jet::linear(phi, rate)).taylor()[2] / slope;
        self.linkage.axes_along(Jet::from_taylor([phi, rate, bend]), offset)
    }

    /// Seconds per unit of the stroke coordinate.
    pub(super) fn seconds_per_stroke(&self) -> f64 {
        self.seconds_per_stroke
    }

    /// Progress after a number of rolling strokes.
    fn sigma(&self, rolled: f64) -> f64 {
        self.start + (self.first_index + rolled) * self.per_stroke
    }
}

/// Whole number of strokes per revolution of a feed.
fn strokes_per_revolution(feed: Feed, perimeter_mm: f64, key: impl Fn(&str) -> String) -> Result<u32, Refusal> {
    match feed {
        Feed::StrokesPerRevolution(n) if n > 0 => Ok(n),
        Feed::StrokesPerRevolution(_) => {
            Err(Refusal::new(&key("strokes_per_revolution"), "no strokes", "give at least 1"))
        }
        Feed::CircularMmPerStroke(feed_mm) => {
            let strokes = (perimeter_mm / feed_mm - COUNT_TOLERANCE).ceil();
            if (1.0..=f64::from(u32::MAX)).contains(&strokes) {
                return Ok(strokes as u32);
            }
            let problem = format!("a feed of {feed_mm} mm per stroke gives {strokes} strokes on {perimeter_mm:.3} mm");
            Err(Refusal::new(&key("circular_feed_mm_per_stroke"), problem, "give a positive feed below the perimeter"))
        }
    }
}
