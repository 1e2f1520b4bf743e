//! Linkages of hobbing: six axes from time, and the hob's pose in the work with its velocity.
//!
//! In: pitch curve, gear helix, hob, a law (which motion is kept even, who carries the extra rotation) and a feed path
//! (how slide, shift and infeed move). Out: [`HobbingAxes`] as series in time, and `work_from_tool(t)`.
//!
//! **Machine frame** (Liu et al. 2013, Liu et al. 2015). Origin in the pitch point P, x along the rack's pitch line, y
//! out of the gear, z along the rotation vector of the work. The work turns by +phi; its centre lies at -(X, Y), (X,
//! Y) = r (cos mu, sin mu), theta = phi - mu + pi / 2. The hob's axis crosses the line x = 0, y = R_p + radial at the
//! height z (slide) in the direction d0 = (cos g, 0, sin g), g = h beta - h_b lambda unless the head is set otherwise;
//! shift u moves the hob along d0. The gear frame of the other modules is this one turned over: its z is -z here, theta
//! is its phi.
//!
//! **Rolling.** Hob, slide and shift together carry a rack; the gear's pitch curve rolls on it:
//!
//! `s = (K m_n omega / 2 - u cos lambda) / cos beta - h z tan beta`
//!
//! for the arc s, hob angle omega, slide z and shift u. Every **exact** law keeps this at every moment; then theta
//! follows from s and everything else from theta. The laws differ in what is even in time while the slide rests: the
//! arc (hob at constant speed), the work angle, or the polar angle; and in whether the slide's share is carried by the
//! work (the whole rolling speeds up, ds/dt = v_b - h v_z tan beta) or by the hob.
//!
//! **As printed.** The papers add v_z tan(beta) / r to the work's speed and leave the carriage alone (Liu et al. 2013,
//! Eq. 14 and 15). That is right for a circle only: on other curves work and carriage part. It is kept to show what it
//! does.
//!
//! Velocities and accelerations are the series' coefficients, no differences.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::process::hobbing::scene::model::{EvenMotion, ExtraRotation, LinkageForm};
use gearcut_core::error::Refusal;
use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::Rolling;
use gearcut_core::math::Jet;
use gearcut_core::math::newton::{EVERYWHERE, LastStep, newton_within};

pub mod dynamics;
pub mod feed_marks;
mod feed_piece;
mod geometry;
pub mod marks;
mod path;
pub mod plan;
mod poses;
#[cfg(test)]
mod tests;

use feed_piece::{Clock, FeedPiece};
pub use geometry::{HobbingAxes, HobbingGeometry, work_from_machine_at};
pub use path::{FeedPath, FeedPhase};
pub use plan::FeedPlan;

/// What is even in time and who carries the extra rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HobbingLaw {
    /// Motion that is even while the slide rests.
    pub even: EvenMotion,
    /// Axis that carries the slide's share.
    pub extra: ExtraRotation,
    /// Exact, or as the papers print it.
    pub form: LinkageForm,
}

/// A hobbing linkage with its feed path, ready for queries at any time.
#[derive(Debug, Clone)]
pub struct HobbingLinkage {
    curve: Arc<PitchCurve>,
    geometry: HobbingGeometry,
    law: HobbingLaw,
    /// Time of one cycle along the pitch curve while the slide rests, s.
    cycle_s: f64,
    pieces: Vec<FeedPiece>,
    end_s: f64,
}

impl HobbingLinkage {
    /// Linkage on `curve`; the hob turns at `hob_speed_rad_per_s` in the mean of a cycle without feed (always, when the
    /// arc is even and the work carries the extra rotation).
    ///
    /// # Errors
    /// A law that needs a convex pitch curve on one that is not; feeds so fast that the rolling would stand still or
    /// turn back.
    pub fn new(
        curve: Arc<PitchCurve>,
        geometry: HobbingGeometry,
        law: HobbingLaw,
        hob_speed_rad_per_s: f64,
        path: &FeedPath,
    ) -> Result<Self, Refusal> {
        let cycle_s = curve.perimeter_mm() / (geometry.arc_per_hob_rad_mm() * hob_speed_rad_per_s);
        let mut linkage = Self { curve, geometry, law, cycle_s, pieces: Vec::new(), end_s: 0.0 };
        let mut state = [path.start_slide_mm, path.start_shift_mm, path.start_radial_mm];
        let mut arc_mm = geometry.arc_per_slide() * state[0] + geometry.arc_per_shift() * state[1];
        let (mut start_s, mut drift_rad) = (0.0, 0.0);
        for phase in &path.phases {
            let rates = [phase.slide_mm_per_s, phase.shift_mm_per_s, phase.radial_mm_per_s];
            let piece = linkage.piece(start_s, state, rates, arc_mm, drift_rad)?;
            let end_s = start_s + phase.duration_s;
            let end = linkage.polar_and_drift(&piece, end_s);
            arc_mm = linkage.curve.arc_mm(end[0]);
            if let Clock::Arc(rate) = piece.clock {
                arc_mm = piece.arc_mm + rate * phase.duration_s; // without a round trip through theta
            }
            drift_rad = end[1];
            linkage.pieces.push(piece);
            state = std::array::from_fn(|i| state[i] + rates[i] * phase.duration_s);
            start_s = end_s;
        }
        linkage.end_s = start_s;
        Ok(linkage)
    }

    fn piece_at(&self, time_s: f64) -> &FeedPiece {
        let index = self.pieces.partition_point(|s| s.start_s <= time_s).max(1) - 1;
        &self.pieces[index]
    }

    /// The pitch curve.
    pub fn curve(&self) -> &Arc<PitchCurve> {
        &self.curve
    }

    /// The geometry that gears the axes.
    pub fn geometry(&self) -> &HobbingGeometry {
        &self.geometry
    }

    /// The law.
    pub fn law(&self) -> HobbingLaw {
        self.law
    }

    /// Time of one cycle along the pitch curve while slide and shift rest, s.
    pub fn cycle_s(&self) -> f64 {
        self.cycle_s
    }

    /// Time at which the feed path ends, s; it begins at 0.
    pub fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Times at which a feed begins, changes or ends, s: rates jump there.
    pub fn corners_s(&self) -> Vec<f64> {
        self.pieces.iter().map(|s| s.start_s).chain([self.end_s]).collect()
    }

    /// Axes at a time (any; before the beginning and after the end the feeds go on), N <= 3. Where rates jump, those of
    /// the later piece.
    pub fn axes<const N: usize>(&self, time_s: f64) -> HobbingAxes<N> {
        let piece = self.piece_at(time_s);
        let g = &self.geometry;
        let passed = time_s - piece.start_s;
        let line = |[value, rate]: [f64; 2]| Jet::<N>::linear(value + rate * passed, rate);
        let (slide_mm, shift_mm, radial_mm) = (line(piece.slide), line(piece.shift), line(piece.radial));
        let [theta, drift] = self.polar_and_drift(piece, time_s);
        let printed = piece.drift.is_some();
        let extra = match self.law.extra {
            ExtraRotation::Hob => 0.0,
            ExtraRotation::Work if printed => g.arc_per_shift() * piece.shift[1],
            ExtraRotation::Work => g.arc_per_shift() * piece.shift[1] + g.arc_per_slide() * piece.slide[1],
        };
        // theta'' = (d theta' / d theta) theta'.
        let rate = self.polar_rate(theta, extra);
        let (v, dv) = (rate.value(), rate.derivative(1));
        let polar = Jet::from_taylor(std::array::from_fn(|k| [theta, v, 0.5 * dv * v][k]));
        let rolling = Rolling::new(&self.curve, polar);
        let arc = rolling.arc(&self.curve);
        let mu = rolling.r.atan2(&rolling.dr);
        let mut work = polar + mu + -FRAC_PI_2;
        if let Some(d) = &piece.drift {
            let rate = rolling.r.recip() * d.rate_mm_per_s;
            let taylor = rate.taylor();
            let series: [f64; N] = std::array::from_fn(|k| if k == 0 { drift } else { taylor[k - 1] / k as f64 });
            work = work + Jet::from_taylor(series);
        }
        let per_hob = g.arc_per_hob_rad_mm();
        let rolled = if printed {
            let start = g.arc_per_slide() * self.pieces[0].slide[0];
            arc + -start - shift_mm * g.arc_per_shift()
        } else {
            arc - slide_mm * g.arc_per_slide() - shift_mm * g.arc_per_shift()
        };
        HobbingAxes {
            hob_rad: rolled * (1.0 / per_hob),
            work_rad: work,
            x_mm: rolling.r * rolling.dr / rolling.ds,
            y_mm: rolling.r * rolling.r / rolling.ds,
            slide_mm,
            shift_mm,
            radial_mm,
            polar_rad: polar,
            arc_mm: arc,
        }
    }

    /// Time at which the hob has turned to `hob_rad`; it always turns forwards.
    pub fn time_at_hob_angle(&self, hob_rad: f64) -> f64 {
        let mean_speed = self.curve.perimeter_mm() / (self.geometry.arc_per_hob_rad_mm() * self.cycle_s);
        // Speeds vary by a bounded factor and jump at corners; steps that rounding alone makes are not taken.
        newton_within(hob_rad / mean_speed, EVERYWHERE, LastStep::default(), 100, |time_s| {
            let hob = self.axes::<2>(time_s).hob_rad;
            let missing = hob_rad - hob.value();
            let step = missing / hob.derivative(1).max(0.05 * mean_speed);
            [missing, if step.abs() <= 4.0 * f64::EPSILON * (1.0 + time_s.abs()) { 0.0 } else { step }]
        })
    }
}
