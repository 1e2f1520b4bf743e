//! Two pitch curves that roll on each other, and the straight-sided rack's flanks that run with them.
//!
//! In: the driver's pitch curve and the numbers of teeth. Out: the mate's pitch curve by the ratio law, the centre
//! distance at which it closes, and conjugate flanks of both gears point by point.
//!
//! Law: r2 = a - s r1 with s = +1 external, -1 internal (a + r1), dphi_2/dphi_1 = r1 / r2; the mate closes when phi_2
//! gains 2 pi z1 / z2 in a turn of phi_1 (Litvin and Fuentes, *Noncircular Gears*, 2009, ch. 2). Machine frame:
//! driver's axis at the origin, turned by -phi_1 so that the pitch point lies on +x; driven axis at s a, turned by +s
//! phi_2. Tangent t = (cos mu, sin mu), normal n = -i t out of the driver. Contact lies on the line through the pitch
//! point along v = cos(alpha) t + sigma sin(alpha) n at lambda = (S_e - S) cos(alpha), where S_e is the arc at which
//! the flank crosses the pitch curve.
//!
//! Road not taken: the mate as a curve r2(theta) of its own. Everything about it is a function of the driver's angle,
//! and no inverse has to be interpolated.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec2;

use gearcut_core::error::Refusal;
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::math::newton::{LastStep, newton};
use gearcut_core::math::periodic_integral::PeriodicIntegral;
use gearcut_core::math::roots::{bisect, try_bisect};
use gearcut_core::terms::Side;

/// Accuracy of the driven angle, rad.
const ANGLE_ACCURACY_RAD: f64 = 1e-13;

/// Last step of the centre distance, as a share of it, and steps at most: from the mean of many samples one or two
/// suffice.
const CLOSING_SHARE: f64 = 1e-12;
const CLOSING_STEPS: u32 = 20;
/// Last step to a foot, rad, and steps at most; where rounding keeps the last bits from resting, what may be left.
const FOOT_STEP: LastStep = LastStep { absolute: 1e-14, relative: 0.0 };
const FOOT_STEPS: u32 = 40;
const FOOT_SETTLED_RAD: f64 = 1e-11;
/// Steps in a pitch, and how many are gone, towards the place where a tip is passed.
const STEPS_PER_PITCH: u32 = 16;
const MOST_PITCH_STEPS: u32 = 32;

/// One of the two gears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// Gear 1.
    Driver,
    /// Gear 2.
    Driven,
}

/// What both gears have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairTeeth {
    /// Transverse module, mm.
    pub module_mm: f64,
    /// Transverse pressure angle.
    pub pressure_angle_rad: f64,
    /// cos(beta_b): what is normal to the flanks over what is normal to them in the transverse section; 1 of spur
    /// gears.
    pub base_helix_cosine: f64,
    /// Numbers of teeth of driver and driven gear.
    pub count: [u32; 2],
    /// Kind of the driven gear: beside the driver, or a ring round it.
    pub driven: GearKind,
}

/// The pitch point at one angle of the driver; vectors in the machine frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PitchPoint {
    /// Driver's angle phi_1.
    pub phi_1_rad: f64,
    /// Driven gear's angle phi_2 by the pitch curves.
    pub phi_2_rad: f64,
    /// Radii r1 and r2, mm.
    pub radius_mm: [f64; 2],
    /// Angle from the line of centres to the common tangent.
    pub mu_rad: f64,
    /// Arc S rolled since phi_1 = 0, mm.
    pub arc_mm: f64,
    /// Curvatures of both pitch curves, convex positive; an internal driven curve counts by its own outline.
    pub curvature_per_mm: [f64; 2],
    /// Common tangent, in the direction of growing arc of the driver.
    pub tangent: DVec2,
    /// Common normal, out of the driver.
    pub normal: DVec2,
}

/// Point of a flank in its gear's own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConjugatePoint {
    /// Place, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the tooth.
    pub normal: DVec2,
}

/// Two pitch curves rolling on each other.
#[derive(Debug, Clone)]
pub struct PitchPair {
    curve: Arc<PitchCurve>,
    teeth: PairTeeth,
    center_distance_mm: f64,
    driven_angle: PeriodicIntegral,
}

impl PitchPair {
    /// The pair of a driver's curve with the mate that closes.
    ///
    /// # Errors
    /// No centre distance at which the mate closes; a ratio law that cannot be integrated.
    pub fn closing(curve: Arc<PitchCurve>, teeth: PairTeeth) -> Result<Self, Refusal> {
        let s = teeth.driven.tip_sign();
        let refused = |problem: String| {
            Refusal::new("gear.teeth", problem, "change the numbers of teeth or the driver's pitch curve")
        };
        let samples = 4 * curve.samples_per_turn();
        let radii: Vec<f64> = (0..samples).map(|i| curve.radius(TAU * i as f64 / samples as f64).value()).collect();
        let turn = |a: f64| TAU * radii.iter().map(|r| r / (a - s * r)).sum::<f64>() / samples as f64;
        let wanted = TAU * f64::from(teeth.count[0]) / f64::from(teeth.count[1]);
        let (least, most) = radii.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), r| (l.min(*r), m.max(*r)));
        // Beyond these bounds the mate is smaller than nothing, or turns more slowly than it may at the largest radius.
        let low = if s > 0.0 { most } else { 0.0_f64.max(-least) };
        let high = most * (s + TAU / wanted) + most;
        if turn(high) >= wanted || (s < 0.0 && turn(low) <= wanted) {
            return Err(refused(format!(
                "no mate of {} teeth closes with a driver of {} teeth",
                teeth.count[1], teeth.count[0]
            )));
        }
        let start_mm = bisect(|a| turn(a) > wanted, low, high);
        // The mean of samples is good to their spacing; the integral of the ratio law takes it on.
        let driven_angle_at = |a: f64| {
            let rate = |phi: f64| {
                let r = curve.radius(phi).value();
                r / (a - s * r)
            };
            PeriodicIntegral::new(rate, &curve.breaks_rad(), 16, ANGLE_ACCURACY_RAD)
                .map_err(|why| refused(format!("the ratio law at {a:.6} mm centre distance: {why}")))
        };
        let last = LastStep { absolute: 0.0, relative: CLOSING_SHARE };
        let mut failed = None;
        let found = newton("the centre distance at which the mate closes", start_mm, last, CLOSING_STEPS, |a| {
            let slope = TAU * radii.iter().map(|r| r / (a - s * r).powi(2)).sum::<f64>() / samples as f64;
            let missing = driven_angle_at(a).map_or_else(
                |refusal| {
                    failed = Some(refusal);
                    f64::NAN
                },
                |angle| angle.closed() - wanted,
            );
            [missing, missing / slope]
        });
        if let Some(refusal) = failed {
            return Err(refusal);
        }
        let center_distance_mm = found.map_err(|lost| refused(lost.to_string()))?;
        let driven_angle = driven_angle_at(center_distance_mm)?;
        Ok(Self { curve, teeth, center_distance_mm, driven_angle })
    }

    /// The driver's pitch curve.
    pub fn curve(&self) -> &Arc<PitchCurve> {
        &self.curve
    }

    /// Module, pressure angle, teeth, kind.
    pub fn teeth(&self) -> &PairTeeth {
        &self.teeth
    }

    /// s: +1 external, -1 internal.
    pub fn sign(&self) -> f64 {
        self.teeth.driven.tip_sign()
    }

    /// Arc of the pitch curves from tooth to tooth, mm.
    pub fn pitch_mm(&self) -> f64 {
        PI * self.teeth.module_mm
    }

    /// Distance of the axes at which the mate closes, mm.
    pub fn center_distance_mm(&self) -> f64 {
        self.center_distance_mm
    }

    /// The pitch point when the driver stands at `phi_1_rad` (any real).
    pub fn at(&self, phi_1_rad: f64) -> PitchPoint {
        let s = self.sign();
        let frame = self.curve.frame(phi_1_rad);
        let (r1, mu) = (frame.radius_mm, frame.mu_rad);
        let r2 = self.center_distance_mm - s * r1;
        // Euler and Savary: kappa1 + s kappa2 = (1/r1 + s/r2) sin(mu).
        let kappa2 = s * ((1.0 / r1 + s / r2) * mu.sin() - frame.curvature_per_mm);
        let tangent = DVec2::from_angle(mu);
        PitchPoint {
            phi_1_rad,
            phi_2_rad: self.driven_angle.at(phi_1_rad),
            radius_mm: [r1, r2],
            mu_rad: mu,
            arc_mm: self.curve.arc_mm(phi_1_rad),
            curvature_per_mm: [frame.curvature_per_mm, kappa2],
            tangent,
            normal: -tangent.perp(),
        }
    }

    /// Lever of the line of action about the driven axis, mm: what a displacement along the flanks' normal is divided
    /// by to become a rotation. Right: r2 sin(mu + alpha), left: r2 sin(mu - alpha), times cos(beta_b): the normal of a
    /// helical flank leads out of the transverse section.
    pub fn arm_mm(&self, point: &PitchPoint, side: Side) -> f64 {
        let in_section_mm = point.radius_mm[1] * (point.mu_rad - side.sign() * self.teeth.pressure_angle_rad).sin();
        self.teeth.base_helix_cosine * in_section_mm
    }

    /// Direction v of the line of action, machine frame.
    pub fn line_of_action(&self, point: &PitchPoint, side: Side) -> DVec2 {
        let (sin, cos) = self.teeth.pressure_angle_rad.sin_cos();
        cos * point.tangent + side.sign() * sin * point.normal
    }

    /// A vector of the machine in the frame of a gear.
    pub fn gear_from_machine(&self, point: &PitchPoint, member: Member, v: DVec2) -> DVec2 {
        let angle = match member {
            Member::Driver => point.phi_1_rad,
            Member::Driven => -self.sign() * point.phi_2_rad,
        };
        DVec2::from_angle(angle).rotate(v)
    }

    /// Axis of a gear in the machine at the closing centre distance, mm.
    pub fn axis_mm(&self, member: Member) -> DVec2 {
        match member {
            Member::Driver => DVec2::ZERO,
            Member::Driven => DVec2::new(self.sign() * self.center_distance_mm, 0.0),
        }
    }

    /// Point of a gear's flank that crosses the pitch curve at the driver's arc `crossing_mm`, where it is generated at
    /// `phi_1_rad`; the gear's own frame.
    pub fn flank_point(&self, member: Member, side: Side, crossing_mm: f64, phi_1_rad: f64) -> ConjugatePoint {
        let point = self.at(phi_1_rad);
        let v = self.line_of_action(&point, side);
        let lambda = (crossing_mm - point.arc_mm) * self.teeth.pressure_angle_rad.cos();
        let contact = DVec2::new(point.radius_mm[0], 0.0) + lambda * v;
        let out = match member {
            Member::Driver => side.sign(),
            Member::Driven => -side.sign(),
        };
        ConjugatePoint {
            point_mm: self.gear_from_machine(&point, member, contact - self.axis_mm(member)),
            normal: self.gear_from_machine(&point, member, out * v),
        }
    }

    /// Height of a point of a gear (own frame) over its pitch curve, towards its tips, and the driver's angle at the
    /// foot; Newton's method from `guess_rad`.
    ///
    /// # Errors
    /// It runs to no foot: the point lies near the curve's centres of curvature.
    pub fn height(&self, member: Member, point_mm: DVec2, guess_rad: f64) -> Result<(f64, f64), Refusal> {
        let at_foot = |phi: f64| {
            let at = self.at(phi);
            let foot = DVec2::new(at.radius_mm[0], 0.0) - self.axis_mm(member);
            let d = point_mm - self.gear_from_machine(&at, member, foot);
            let tangent = self.gear_from_machine(&at, member, at.tangent);
            let normal = self.gear_from_machine(&at, member, at.normal);
            let (out, curvature) = match member {
                Member::Driver => (normal, at.curvature_per_mm[0]),
                Member::Driven => (-normal, self.sign() * at.curvature_per_mm[1]),
            };
            let height = d.dot(out);
            let arc_rate = at.radius_mm[0] / at.mu_rad.sin();
            let beside = d.dot(tangent);
            (height, [beside, beside / (arc_rate * (1.0 + curvature * height))])
        };
        let phi = newton("the foot on a pitch curve", guess_rad, FOOT_STEP, FOOT_STEPS, |phi| at_foot(phi).1)
            .or_else(|lost| lost.settled(FOOT_SETTLED_RAD))
            .map_err(|lost| {
                let way_out = "use a smaller addendum_coefficient, or a pitch curve with less curvature";
                Refusal::new("gear.addendum_coefficient", lost.to_string(), way_out)
            })?;
        Ok((at_foot(phi).0, phi))
    }

    /// Where the normal of a point of a gear's flank meets its pitch curve: the driver's angle at which the point is in
    /// contact, and its distance from the pitch point along v then, mm. Point and normal out of the tooth are those of
    /// the gear's own frame; Newton's method for the foot begins at `guess_rad`.
    ///
    /// # Errors
    /// The normal does not meet the pitch curve within two pitches.
    pub fn contact_of(
        &self,
        member: Member,
        side: Side,
        on: &ConjugatePoint,
        guess_rad: f64,
    ) -> Result<(f64, f64), Refusal> {
        let out = match member {
            Member::Driver => side.sign(),
            Member::Driven => -side.sign(),
        };
        // Below the pitch curve the normal out of the tooth climbs to it, above it the other one falls to it.
        let from_root = self.height(member, on.point_mm, guess_rad)?.0 < 0.0;
        let towards = if from_root { 1.0 } else { -1.0 };
        let at = |along_mm: f64| self.height(member, on.point_mm + towards * along_mm * on.normal, guess_rad);
        let before = |along_mm: f64| Ok((at(along_mm)?.0 < 0.0) == from_root);
        let along_mm = passing(self.pitch_mm(), before, || {
            format!("the normal of a {} flank does not meet the pitch curve", side.name())
        })?;
        Ok((at(along_mm)?.1, -towards * along_mm * out))
    }

    /// Driver's angle at which a flank's contact lies on the tip curve of a gear: the pitch curve moved by `height_mm`
    /// along its normals.
    ///
    /// # Errors
    /// The flank does not reach that height within two pitches of rolling.
    pub fn phi_at_tip(&self, member: Member, side: Side, crossing_mm: f64, height_mm: f64) -> Result<f64, Refusal> {
        let towards = match member {
            Member::Driver => -side.sign(),
            Member::Driven => side.sign(),
        };
        let phi_at = |rolled_mm: f64| self.curve.phi_at_arc(crossing_mm + towards * rolled_mm);
        let below = |rolled_mm: f64| {
            let phi = phi_at(rolled_mm);
            let point_mm = self.flank_point(member, side, crossing_mm, phi).point_mm;
            Ok(self.height(member, point_mm, phi)?.0 < height_mm)
        };
        let rolled_mm = passing(self.pitch_mm(), below, || {
            format!("a {} flank does not reach {height_mm:.3} mm over the pitch curve", side.name())
        })?;
        Ok(phi_at(rolled_mm))
    }

    /// How much of the flank's radius of curvature is left at `phi_1_rad`, as a share of its value at the pitch point;
    /// zero where the flank turns back. `depth_mm` is the distance along the line of action towards the gear's root.
    pub fn curvature_margin(&self, member: Member, phi_1_rad: f64, depth_mm: f64) -> f64 {
        let at = self.at(phi_1_rad);
        let curvature = match member {
            Member::Driver => at.curvature_per_mm[0],
            Member::Driven => self.sign() * at.curvature_per_mm[1],
        };
        1.0 - curvature * depth_mm / self.teeth.pressure_angle_rad.sin()
    }

    /// Driver's arc at which the nominal flank of a tooth crosses the pitch curve: the driver has a space centred on 0,
    /// tooth j between spaces j - 1 and j. The driven gear's flank of the same label is the one that it touches.
    pub fn crossing_mm(&self, side: Side, tooth: i64) -> f64 {
        let quarter = match side {
            Side::Left => 0.25,
            Side::Right => 0.75,
        };
        (tooth as f64 - quarter) * self.pitch_mm()
    }
}

/// Distance, within two pitches, at which what holds from the beginning on ceases; `problem` says what does not.
pub(super) fn passing(
    pitch_mm: f64,
    below: impl Fn(f64) -> Result<bool, Refusal>,
    problem: impl Fn() -> String,
) -> Result<f64, Refusal> {
    let step_mm = pitch_mm / f64::from(STEPS_PER_PITCH);
    for passed_mm in (1..=MOST_PITCH_STEPS).map(|i| f64::from(i) * step_mm) {
        if !below(passed_mm)? {
            return try_bisect(below, passed_mm - step_mm, passed_mm);
        }
    }
    Err(Refusal::new("gear.addendum_coefficient", problem(), "use a smaller addendum_coefficient"))
}
