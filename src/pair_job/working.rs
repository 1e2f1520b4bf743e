//! Round gears at any distance of their axes: the circles that roll on each other there.
//!
//! In: two round gears with their profile shifts, and the distance where one is named. Out: [`RollingCircles`]: the
//! pitch pair of that distance, heights of tips over its circles, thickness of teeth on them.
//!
//! Law (ISO 21771, 5.3): an involute keeps its base circle, so cos(alpha_w) = a_0 cos(alpha) / a, and a tooth that is s
//! thick on r is r_w (s / r + 2 sigma (inv alpha - inv alpha_w)) thick on r_w, with sigma = +1 outside and -1 in a
//! ring. Teeth without play fill the pitch there: inv(alpha_w) = inv(alpha) + s 2 (x1 + x2) / (z2 + s z1) tan(alpha),
//! with s = +1 external and -1 internal. A shift counts towards the tips, in a ring as well; thickness allowances stay
//! out of the distance, for they are the play.
//!
//! Road not taken: the gears' own pitch circles with an error of the distance. Contact ratio, heights and play would
//! belong to circles that do not roll on each other.

use std::sync::Arc;

use crate::pair::pitch_pair::{PairTeeth, PitchPair};
use crate::scene::model::Gear;
use gearcut_core::error::Refusal;
use gearcut_core::gear::{PitchCurve, PitchCurveShape};
use gearcut_core::math::roots::bisect;

/// Beyond every working pressure angle: its involute is 12.6, and shifts of 3 modules on one tooth of difference ask
/// for
/// 6.2.
const STEEPEST_RAD: f64 = 1.5;

/// How much nearer than without play the axes may be named, modules: twice the usual bottom clearance, beyond which the
/// tips would be in the bodies of the gears. What jams less is rolled, with a warning.
const NEAREST_MODULES: f64 = 0.5;

/// The pitch circles of a round pair at the distance at which it works.
#[derive(Debug, Clone, Copy)]
pub struct RollingCircles {
    own: PairTeeth,
    center_distance_mm: f64,
    pressure_angle_rad: f64,
}

impl RollingCircles {
    /// The circles at the named distance, or at that of the shifts; none where the gears' own pitch circles roll on
    /// each other.
    ///
    /// # Errors
    /// No distance without play; a distance at which no teeth run.
    pub fn of(own: &PairTeeth, gears: [&Gear; 2], named_mm: Option<f64>) -> Result<Option<Self>, Refusal> {
        let alpha = own.pressure_angle_rad;
        let own_mm = 0.5 * own.module_mm * apart(own);
        let center_distance_mm = match named_mm {
            Some(named_mm) => named_mm,
            None => {
                let shifts = gears.map(|gear| gear.profile_shift_coefficient);
                if shifts[0] + shifts[1] == 0.0 {
                    return Ok(None);
                }
                own_mm * alpha.cos() / working_angle(own, gears)?.cos()
            }
        };
        if center_distance_mm == own_mm {
            return Ok(None);
        }
        // Shifts that never have no play have no distance to be too near to.
        let sign = own.driven.tip_sign();
        let playless_mm = working_angle(own, gears).ok().map(|angle_rad| own_mm * alpha.cos() / angle_rad.cos());
        let nearest_mm = playless_mm.map(|mm| mm - sign * NEAREST_MODULES * own.module_mm);
        let cos = own_mm * alpha.cos() / center_distance_mm;
        let circles = Self { own: *own, center_distance_mm, pressure_angle_rad: cos.acos() };
        let near_mm = nearest_mm.map_or(0.0, |mm| sign * (mm - center_distance_mm));
        let height_mm: f64 = circles.addendum_mm(gears).iter().sum();
        // NaN where the base circles overlap, at distances of 0 and below.
        if circles.pressure_angle_rad > 0.0 && height_mm > 0.0 && near_mm <= 0.0 {
            return Ok(Some(circles));
        }
        let tips_mm = own_mm + own.driven.tip_sign() * gears.map(Gear::addendum_mm).iter().sum::<f64>();
        let base_mm = own_mm * alpha.cos();
        let [low_mm, high_mm] = if sign > 0.0 {
            [nearest_mm.map_or(base_mm, |mm| mm.max(base_mm)), tips_mm]
        } else {
            [tips_mm.max(base_mm), nearest_mm.unwrap_or(f64::INFINITY)]
        };
        let range = if high_mm.is_finite() {
            format!("above {low_mm:.4} and below {high_mm:.4} mm")
        } else {
            format!("above {low_mm:.4} mm")
        };
        let problem = match playless_mm.filter(|_| near_mm > 0.0 && circles.pressure_angle_rad > 0.0) {
            Some(playless_mm) => format!(
                "at a centre distance of {center_distance_mm} mm the axes are {:.3} mm too {}: these teeth have no \
                 play at {playless_mm:.4} mm, and their tips would be in the roots of the mate",
                (playless_mm - center_distance_mm).abs(),
                if sign > 0.0 { "near" } else { "far apart" }
            ),
            None => format!(
                "at a centre distance of {center_distance_mm} mm these teeth do not run on each other: the base \
                 circles touch at {base_mm:.4} mm, and the tips pass each other at {tips_mm:.4} mm"
            ),
        };
        let way_out = format!("name a distance {range}; without one they roll at that of their shifts");
        Err(Refusal::new("gear.center_distance_mm", problem, way_out))
    }

    /// The circles as a pitch pair.
    ///
    /// # Errors
    /// None that its own curves do not have.
    pub fn pair(&self) -> Result<PitchPair, Refusal> {
        let module_mm = 2.0 * self.center_distance_mm / apart(&self.own);
        let circle = PitchCurve::new(&PitchCurveShape::Circle, module_mm, self.own.count[0])?;
        let teeth = PairTeeth { module_mm, pressure_angle_rad: self.pressure_angle_rad, ..self.own };
        PitchPair::closing(Arc::new(circle), teeth)
    }

    /// Heights of both gears' tips over their circles, mm.
    pub fn addendum_mm(&self, gears: [&Gear; 2]) -> [f64; 2] {
        self.each(gears, |gear, sigma, [own_mm, here_mm]| gear.addendum_mm() + sigma * (own_mm - here_mm))
    }

    /// How much thicker than half a pitch the teeth of both gears are on their circles, mm.
    pub fn extra_thickness_mm(&self, gears: [&Gear; 2]) -> [f64; 2] {
        let rolled = involute(self.own.pressure_angle_rad) - involute(self.pressure_angle_rad);
        self.each(gears, |gear, sigma, [own_mm, here_mm]| {
            here_mm * (gear.extra_thickness_mm() / own_mm + 2.0 * sigma * rolled)
        })
    }

    /// Something of both gears, of the sign of their kind and the radii of own circle and circle here, mm.
    fn each(&self, gears: [&Gear; 2], of: impl Fn(&Gear, f64, [f64; 2]) -> f64) -> [f64; 2] {
        let radii = |teeth: u32| {
            [0.5 * self.own.module_mm, self.center_distance_mm / apart(&self.own)].map(|half| half * f64::from(teeth))
        };
        gears.map(|gear| of(gear, gear.kind.tip_sign(), radii(gear.teeth)))
    }
}

/// Number of teeth that the centre distance counts: their sum, in a ring their difference.
fn apart(teeth: &PairTeeth) -> f64 {
    let [a, b] = teeth.count.map(f64::from);
    b + teeth.driven.tip_sign() * a
}

fn involute(angle_rad: f64) -> f64 {
    angle_rad.tan() - angle_rad
}

/// Pressure angle at which teeth with these shifts run without play.
///
/// # Errors
/// Shifts so far to one side that the base circles would overlap.
fn working_angle(own: &PairTeeth, gears: [&Gear; 2]) -> Result<f64, Refusal> {
    let sign = own.driven.tip_sign();
    let [x1, x2] = gears.map(|gear| gear.profile_shift_coefficient);
    // The shift is in normal modules, tan(alpha) is that of the normal section: 2 x m tan(alpha_t) / m_t.
    let per_shift = 2.0 * sign * gears[0].pressure_angle_rad.tan() / apart(own);
    let wanted = involute(own.pressure_angle_rad) + per_shift * (x1 + x2);
    if wanted > 0.0 {
        return Ok(bisect(|angle| involute(angle) < wanted, 0.0, STEEPEST_RAD));
    }
    let limit = -involute(own.pressure_angle_rad) / per_shift;
    let side = if sign > 0.0 { "above" } else { "below" };
    Err(Refusal::new(
        "gear.profile_shift_coefficient",
        format!(
            "with shifts of {x1} and {x2}, {:.4} in all, there is no distance at which these teeth have no play",
            x1 + x2
        ),
        format!("give shifts that are {side} {limit:.4} in all, or name a distance with --center-distance-mm"),
    ))
}
