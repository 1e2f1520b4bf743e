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
//! Eq. 14 and 15). That is right for a circle only: on other curves work and carriage part. Kept to show what it does.
//!
//! Velocities and accelerations are the series' coefficients, no differences.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::error::Refusal;
use crate::frame::{Rigid3, RigidMotion3};
use crate::gear::PitchCurve;
use crate::gear::Rolling;
use crate::math::Jet;
use crate::math::newton::{EVERYWHERE, LastStep, newton_within};
use crate::math::periodic_integral::PeriodicIntegral;
use crate::process::hobbing::Hob;
use crate::process::hobbing::scene::model::{EvenMotion, ExtraRotation, LinkageForm};

pub mod dynamics;
pub mod marks;
mod path;
pub mod plan;
#[cfg(test)]
mod tests;

pub use path::{FeedPath, FeedPhase};
pub use plan::FeedPlan;

/// Accuracy of the time integrals, s: 1e-10 mm at a metre per second.
const TIME_ACCURACY_S: f64 = 1e-13;

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

/// The geometry that gears the axes together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HobbingGeometry {
    /// Number of starts K.
    pub starts: f64,
    /// Normal module m_n, mm.
    pub module_mm: f64,
    /// Lead angle lambda of the hob.
    pub lead_angle_rad: f64,
    /// h_b: +1 for a right-hand hob.
    pub hob_hand: f64,
    /// R_p: distance of the hob's axis from the pitch plane, mm.
    pub pitch_radius_mm: f64,
    /// Helix angle beta of the gear, not negative.
    pub helix_angle_rad: f64,
    /// h: +1 for a right-hand gear.
    pub gear_hand: f64,
    /// g: tilt of the hob's axis against x.
    pub head_angle_rad: f64,
}

impl HobbingGeometry {
    /// Geometry of a hob on a gear; the head stands at g = h beta - h_b lambda.
    pub fn new(hob: &Hob, helix_angle_rad: f64, gear_hand: f64) -> Self {
        Self {
            starts: f64::from(hob.starts),
            module_mm: hob.module_mm,
            lead_angle_rad: hob.lead_angle_rad,
            hob_hand: hob.hand,
            pitch_radius_mm: hob.pitch_radius_mm,
            helix_angle_rad,
            gear_hand,
            head_angle_rad: gear_hand * helix_angle_rad - hob.hand * hob.lead_angle_rad,
        }
    }

    /// Arc of the pitch curve per radian of the hob, slide and shift at rest, mm.
    pub fn arc_per_hob_rad_mm(&self) -> f64 {
        0.5 * self.starts * self.module_mm / self.helix_angle_rad.cos()
    }

    /// Arc per mm of slide, work carrying the extra rotation.
    pub fn arc_per_slide(&self) -> f64 {
        -self.gear_hand * self.helix_angle_rad.tan()
    }

    /// Arc per mm of shift, work carrying the extra rotation.
    pub fn arc_per_shift(&self) -> f64 {
        -self.lead_angle_rad.cos() / self.helix_angle_rad.cos()
    }

    /// d0 in the machine frame.
    pub fn hob_axis(&self) -> DVec3 {
        DVec3::new(self.head_angle_rad.cos(), 0.0, self.head_angle_rad.sin())
    }

    /// Pose of the tool in the machine frame, whose origin is the pitch point: hob angle (rad), distance from full
    /// depth, slide and shift (mm).
    pub fn machine_from_tool(&self, hob_rad: f64, radial_mm: f64, slide_mm: f64, shift_mm: f64) -> Rigid3 {
        let axis = self.hob_axis();
        let (sin, cos) = (self.hob_hand * hob_rad).sin_cos();
        let (towards, across) = (DVec3::NEG_Y, axis.cross(DVec3::NEG_Y));
        let x = towards * cos + across * sin;
        let stand = DVec3::new(0.0, self.pitch_radius_mm + radial_mm, slide_mm);
        Rigid3 { rotation: DMat3::from_cols(x, axis.cross(x), axis), translation_mm: stand + axis * shift_mm }
    }
}

/// Axes as series in time (s) with N terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HobbingAxes<const N: usize> {
    /// Hob angle omega in the cutting direction, rad, unwrapped.
    pub hob_rad: Jet<N>,
    /// Work angle phi, rad, unwrapped.
    pub work_rad: Jet<N>,
    /// X: pitch point against the work's centre along the rack, mm.
    pub x_mm: Jet<N>,
    /// Y: pitch point against the work's centre out of the gear, mm.
    pub y_mm: Jet<N>,
    /// Slide along the work's rotation vector, mm.
    pub slide_mm: Jet<N>,
    /// Shift along the hob's axis, mm.
    pub shift_mm: Jet<N>,
    /// How far the hob stands back from full depth, mm.
    pub radial_mm: Jet<N>,
    /// Polar angle of the pitch point, rad, unwrapped: the gear frame's phi.
    pub polar_rad: Jet<N>,
    /// Rolled arc s, mm.
    pub arc_mm: Jet<N>,
}

/// One stretch of the feed path with the state at its beginning.
#[derive(Debug, Clone)]
struct Stretch {
    start_s: f64,
    /// Slide, shift, radial: value at the beginning and rate.
    slide: [f64; 2],
    shift: [f64; 2],
    radial: [f64; 2],
    /// s at the beginning.
    arc_mm: f64,
    /// What follows s from time.
    clock: Clock,
    /// As printed: extra rotation at the beginning, rate times radius, and the integral of time over radius.
    drift: Option<Drift>,
}

/// From time to the place on the pitch curve.
#[derive(Debug, Clone)]
enum Clock {
    /// Arc at a constant rate, mm/s.
    Arc(f64),
    /// Time is an integral over theta; value at the beginning.
    Polar(Arc<PeriodicIntegral>, f64),
}

/// Extra rotation as printed: rate / r, integrated over theta.
#[derive(Debug, Clone)]
struct Drift {
    start_rad: f64,
    rate_mm_per_s: f64,
    integral: Arc<PeriodicIntegral>,
    start_integral: f64,
}

/// A hobbing linkage with its feed path, ready for queries at any time.
#[derive(Debug, Clone)]
pub struct HobbingLinkage {
    curve: Arc<PitchCurve>,
    geometry: HobbingGeometry,
    law: HobbingLaw,
    /// Time of one cycle along the pitch curve while the slide rests, s.
    cycle_s: f64,
    stretches: Vec<Stretch>,
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
        let mut linkage = Self { curve, geometry, law, cycle_s, stretches: Vec::new(), end_s: 0.0 };
        let mut state = [path.start_slide_mm, path.start_shift_mm, path.start_radial_mm];
        let mut arc_mm = geometry.arc_per_slide() * state[0] + geometry.arc_per_shift() * state[1];
        let (mut start_s, mut drift_rad) = (0.0, 0.0);
        for phase in &path.phases {
            let rates = [phase.slide_mm_per_s, phase.shift_mm_per_s, phase.radial_mm_per_s];
            let stretch = linkage.stretch(start_s, state, rates, arc_mm, drift_rad)?;
            let end_s = start_s + phase.duration_s;
            let end = linkage.polar_and_drift(&stretch, end_s);
            arc_mm = linkage.curve.arc_mm(end[0]);
            if let Clock::Arc(rate) = stretch.clock {
                arc_mm = stretch.arc_mm + rate * phase.duration_s; // without a round trip through theta
            }
            drift_rad = end[1];
            linkage.stretches.push(stretch);
            state = std::array::from_fn(|i| state[i] + rates[i] * phase.duration_s);
            start_s = end_s;
        }
        linkage.end_s = start_s;
        Ok(linkage)
    }

    fn stretch(
        &self,
        start_s: f64,
        [slide, shift, radial]: [f64; 3],
        [slide_rate, shift_rate, radial_rate]: [f64; 3],
        arc_mm: f64,
        drift_rad: f64,
    ) -> Result<Stretch, Refusal> {
        let g = &self.geometry;
        let printed = self.is_printed();
        let from_shift = g.arc_per_shift() * shift_rate;
        let from_slide = g.arc_per_slide() * slide_rate;
        let extra_mm_per_s = match self.law.extra {
            ExtraRotation::Hob => 0.0,
            ExtraRotation::Work if printed => from_shift,
            ExtraRotation::Work => from_shift + from_slide,
        };
        let rate = |theta: f64| self.polar_rate(theta, extra_mm_per_s).value();
        let backwards = |why: String| {
            Refusal::new(
                "operation.axial_feed_mm_per_revolution",
                format!(
                    "the feeds' share of the rolling is faster than the rolling itself, or the pitch curve is not \
                    convex where the law needs it: {why}"
                ),
                "use smaller feeds; on a pitch curve with hollows keep the arc even (basis = \"arc_length\")",
            )
        };
        let clock = match self.law.even {
            EvenMotion::ArcLength => {
                let arc_rate = self.curve.perimeter_mm() / self.cycle_s + extra_mm_per_s;
                if arc_rate <= 0.0 {
                    return Err(backwards(format!("the arc would grow by {arc_rate} mm/s")));
                }
                Clock::Arc(arc_rate)
            }
            EvenMotion::RotationAngle | EvenMotion::PolarAngle => {
                let integral = self.integral(|theta| 1.0 / rate(theta)).map_err(backwards)?;
                let start = integral.at(self.curve.phi_at_arc(arc_mm));
                Clock::Polar(Arc::new(integral), start)
            }
        };
        let drift = if printed {
            let integral =
                self.integral(|theta| 1.0 / (rate(theta) * self.curve.radius(theta).value())).map_err(backwards)?;
            let resultant = slide_rate + shift_rate * g.head_angle_rad.sin();
            Some(Drift {
                start_rad: drift_rad,
                rate_mm_per_s: g.arc_per_slide() * resultant,
                start_integral: integral.at(self.curve.phi_at_arc(arc_mm)),
                integral: Arc::new(integral),
            })
        } else {
            None
        };
        Ok(Stretch {
            start_s,
            slide: [slide, slide_rate],
            shift: [shift, shift_rate],
            radial: [radial, radial_rate],
            arc_mm,
            clock,
            drift,
        })
    }

    fn integral(&self, f: impl Fn(f64) -> f64) -> Result<PeriodicIntegral, String> {
        let panels = (self.curve.samples_per_turn() / 8).max(16);
        PeriodicIntegral::new(f, &self.curve.breaks_rad(), panels, TIME_ACCURACY_S).map_err(|why| why.to_string())
    }

    /// Whether the printed form differs from the exact one: it does where the work carries the extra rotation.
    fn is_printed(&self) -> bool {
        self.law.form == LinkageForm::AsPrinted && self.law.extra == ExtraRotation::Work
    }

    /// d theta / dt at `theta` with one derivative, when feeds add `extra_mm_per_s` to the rolling.
    fn polar_rate(&self, theta: f64, extra_mm_per_s: f64) -> Jet<2> {
        let radius = self.curve.radius(theta);
        let r = radius.truncate::<2>();
        let dr = radius.differentiate::<2>();
        let d2r = radius.differentiate::<3>().differentiate::<2>();
        let square = r * r + dr * dr;
        let per_arc = square.sqrt().recip();
        let even = match self.law.even {
            EvenMotion::ArcLength => per_arc * (self.curve.perimeter_mm() / self.cycle_s),
            EvenMotion::RotationAngle => {
                // d theta / d phi, Liu et al. 2013, Eq. 5.
                let turn = square / (square + dr * dr - r * d2r);
                turn * (2.0 * PI / self.cycle_s)
            }
            EvenMotion::PolarAngle => Jet::constant(2.0 * PI / self.cycle_s),
        };
        even + per_arc * extra_mm_per_s
    }

    /// theta and printed extra rotation at a time of a stretch.
    fn polar_and_drift(&self, stretch: &Stretch, time_s: f64) -> [f64; 2] {
        let passed = time_s - stretch.start_s;
        let theta = match &stretch.clock {
            Clock::Arc(rate) => self.curve.phi_at_arc(stretch.arc_mm + rate * passed),
            Clock::Polar(integral, start) => integral.angle_at(start + passed),
        };
        let drift = stretch
            .drift
            .as_ref()
            .map_or(0.0, |d| d.start_rad + d.rate_mm_per_s * (d.integral.at(theta) - d.start_integral));
        [theta, drift]
    }

    fn stretch_at(&self, time_s: f64) -> &Stretch {
        let index = self.stretches.partition_point(|s| s.start_s <= time_s).max(1) - 1;
        &self.stretches[index]
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
        self.stretches.iter().map(|s| s.start_s).chain([self.end_s]).collect()
    }

    /// Axes at a time (any; before the beginning and after the end the feeds go on), N <= 3. Where rates jump, those of
    /// the later stretch.
    pub fn axes<const N: usize>(&self, time_s: f64) -> HobbingAxes<N> {
        let stretch = self.stretch_at(time_s);
        let g = &self.geometry;
        let passed = time_s - stretch.start_s;
        let line = |[value, rate]: [f64; 2]| Jet::<N>::linear(value + rate * passed, rate);
        let (slide_mm, shift_mm, radial_mm) = (line(stretch.slide), line(stretch.shift), line(stretch.radial));
        let [theta, drift] = self.polar_and_drift(stretch, time_s);
        let printed = stretch.drift.is_some();
        let extra = match self.law.extra {
            ExtraRotation::Hob => 0.0,
            ExtraRotation::Work if printed => g.arc_per_shift() * stretch.shift[1],
            ExtraRotation::Work => g.arc_per_shift() * stretch.shift[1] + g.arc_per_slide() * stretch.slide[1],
        };
        // theta'' = (d theta' / d theta) theta'.
        let rate = self.polar_rate(theta, extra);
        let (v, dv) = (rate.value(), rate.derivative(1));
        let polar = Jet::from_taylor(std::array::from_fn(|k| [theta, v, 0.5 * dv * v][k]));
        let rolling = Rolling::new(&self.curve, polar);
        let arc = rolling.arc(&self.curve);
        let mu = rolling.r.atan2(&rolling.dr);
        let mut work = polar + mu + -FRAC_PI_2;
        if let Some(d) = &stretch.drift {
            let rate = rolling.r.recip() * d.rate_mm_per_s;
            let taylor = rate.taylor();
            let series: [f64; N] = std::array::from_fn(|k| if k == 0 { drift } else { taylor[k - 1] / k as f64 });
            work = work + Jet::from_taylor(series);
        }
        let per_hob = g.arc_per_hob_rad_mm();
        let rolled = if printed {
            let start = g.arc_per_slide() * self.stretches[0].slide[0];
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

    /// Pose of the tool frame in the gear frame.
    pub fn work_from_tool(&self, time_s: f64) -> Rigid3 {
        let axes = self.axes::<1>(time_s);
        work_from_machine(&axes).after(&self.machine_from_tool(&axes))
    }

    /// Pose of the head in the gear frame: the tool frame as it stands at hob angle 0, carried along but not turning
    /// with the hob.
    pub fn work_from_head(&self, time_s: f64) -> Rigid3 {
        let axes = HobbingAxes { hob_rad: Jet::constant(0.0), ..self.axes::<1>(time_s) };
        work_from_machine(&axes).after(&self.machine_from_tool(&axes))
    }

    /// Pose of the work in the hob's head, the frame that carries the hob without turning with it, when the hob has
    /// turned to `hob_rad`.
    pub fn head_from_work(&self, hob_rad: f64) -> Rigid3 {
        let tool_from_work = self.work_from_tool(self.time_at_hob_angle(hob_rad)).inverse();
        let rotation = DMat3::from_rotation_z(self.geometry.hob_hand * hob_rad);
        Rigid3 { rotation, translation_mm: DVec3::ZERO }.after(&tool_from_work)
    }

    /// Pose with velocity, gear frame.
    pub fn motion(&self, time_s: f64) -> RigidMotion3 {
        let axes = self.axes::<2>(time_s);
        let machine_from_tool = self.machine_from_tool(&axes);
        let work_from_machine = work_from_machine(&axes);
        let d = |jet: Jet<2>| jet.derivative(1);
        let axis = self.geometry.hob_axis();
        let center = DVec3::new(axes.x_mm.value(), axes.y_mm.value(), 0.0);
        let center_rate = DVec3::new(d(axes.x_mm), d(axes.y_mm), 0.0);
        let work_turn = DVec3::new(0.0, 0.0, d(axes.work_rad));
        let tool_rate = DVec3::new(0.0, d(axes.radial_mm), d(axes.slide_mm)) + axis * d(axes.shift_mm);
        let from_center = machine_from_tool.translation_mm + center;
        let velocity = tool_rate + center_rate - work_turn.cross(from_center);
        let turn = axis * (self.geometry.hob_hand * d(axes.hob_rad)) - work_turn;
        RigidMotion3 {
            pose: work_from_machine.after(&machine_from_tool),
            velocity_mm_per_s: work_from_machine.direction(velocity),
            angular_velocity_rad_per_s: work_from_machine.direction(turn),
        }
    }

    fn machine_from_tool<const N: usize>(&self, axes: &HobbingAxes<N>) -> Rigid3 {
        self.geometry.machine_from_tool(
            axes.hob_rad.value(),
            axes.radial_mm.value(),
            axes.slide_mm.value(),
            axes.shift_mm.value(),
        )
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

/// The gear frame from the machine frame: turned over, moved to the work's centre, turned with the work.
fn work_from_machine<const N: usize>(axes: &HobbingAxes<N>) -> Rigid3 {
    work_from_machine_at(axes.work_rad.value(), axes.x_mm.value(), axes.y_mm.value())
}

/// The same from the work's angle (rad) and the place of the pitch point against its axis, tangential and radial (mm).
pub fn work_from_machine_at(work_rad: f64, x_mm: f64, y_mm: f64) -> Rigid3 {
    let (sin, cos) = work_rad.sin_cos();
    let (x, y) = (DVec3::new(-sin, cos, 0.0), DVec3::new(cos, sin, 0.0));
    Rigid3 { rotation: DMat3::from_cols(x, y, DVec3::NEG_Z), translation_mm: x * x_mm + y * y_mm }
}
