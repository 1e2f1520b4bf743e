//! Sizes of a round gear that its drawing states and a workshop measures: diameters, profile shift, span, balls.
//!
//! In: teeth, normal module and pressure angle, helix, the tooth's thickness on the reference circle, and where its
//! profile begins and ends. Out: [`RoundGear`] with [`SpanMeasure`] and [`OverBalls`]. A ring is the same with its
//! spaces for teeth.
//!
//! **Law** (ISO 21771:2007; involute function inv): with alpha_t the transverse pressure angle, beta_b the base helix,
//! x_E the shift that the thickness stands for, `s_t = m_t pi / 2 + 2 x_E m_n tan(alpha_t)`:
//!
//! - span over k teeth `W_k = m_n cos(alpha_n) ((k - 1/2) pi + z inv(alpha_t) + 2 x_E tan(alpha_n))`; it touches at the
//!   diameter `sqrt(d_b^2 + (W_k cos(beta_b))^2)`;
//! - a tooth's chord at the reference circle, `d_v sin(psi)`, and its height below the tip, `h_a + (d_v / 2) (1 -
//!   cos(psi))`, psi = s_n / d_v, s_n = s_t cos(beta), d_v = d / cos(beta)^2 being the circle that osculates the normal
//!   section (what a gear tooth vernier is set to; of spur gears both are exact);
//! - a ball of diameter D_M in a space has its centre at `d_K = d_b / cos(alpha_K)`, where
//!   `inv(alpha_K) = inv(alpha_t) + D_M / (z m_n cos(alpha_n)) - eta` and eta is half the space's angle on the
//!   reference circle; the dimension over two balls is `d_K + D_M`, for an odd number of teeth
//!   `d_K cos(pi / 2z) + D_M`. In a ring D_M and eta change their sign, and the dimension is that between balls.
//!
//! Pins in helical gears with an odd number of teeth lie otherwise than balls; the figure is that of balls.

use crate::scene::model::{Gear, base_helix_cosine, transverse_pressure_angle_rad};
use gearcut_core::gear::{GearKind, PitchCurve};
use gearcut_core::tool::involute::inv;
use std::f64::consts::{FRAC_PI_2, PI};

/// Usual diameter of measuring pins over the normal module: that of Van Keuren wires, 1.728 outside and 1.44 in rings
/// (Machinery's Handbook, "Checking gear sizes by measurement over wires or pins"). They touch near the reference
/// circle.
const PIN_MODULES: [f64; 2] = [1.728, 1.44];

/// Sizes of a round gear in mm; diameters are positive, also in a ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundGear {
    /// External, or a ring.
    pub kind: GearKind,
    /// z.
    pub teeth: u32,
    /// m_n.
    pub normal_module_mm: f64,
    /// alpha_n.
    pub normal_pressure_angle_rad: f64,
    /// beta.
    pub helix_angle_rad: f64,
    /// b.
    pub face_width_mm: f64,
    /// h_a of the basic rack, normal modules.
    pub addendum_coefficient: f64,
    /// x, as the scene gives it.
    pub profile_shift_coefficient: f64,
    /// d_a.
    pub tip_diameter_mm: f64,
    /// d_f.
    pub root_diameter_mm: f64,
    /// d_Ff: where the involute begins.
    pub form_diameter_mm: f64,
    /// d_Fa: where it ends.
    pub tip_form_diameter_mm: f64,
    /// s_t: thickness on the reference circle, transverse arc.
    pub thickness_mm: f64,
}

/// Whether a pitch curve is a whole circle about the gear's axis.
pub fn is_round(curve: &PitchCurve) -> bool {
    let facts = curve.facts();
    curve.sector_rad().is_none() && facts.largest_radius_mm - facts.smallest_radius_mm <= 1e-9 * facts.largest_radius_mm
}

/// Diameters of a tooth's ends, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothEnds {
    /// Root circle.
    pub root_mm: f64,
    /// Start and end of the involute.
    pub involute_mm: [f64; 2],
}

/// A span measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanMeasure {
    /// k.
    pub teeth: u32,
    /// W_k, mm.
    pub length_mm: f64,
    /// Diameter at which it touches, mm.
    pub touch_diameter_mm: f64,
}

/// A measurement over two balls, between them in a ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverBalls {
    /// D_M, mm.
    pub ball_mm: f64,
    /// M_d, mm.
    pub dimension_mm: f64,
    /// Diameter at which the balls touch, mm.
    pub touch_diameter_mm: f64,
}

impl RoundGear {
    /// Of a gear whose pitch curve is a circle.
    pub fn new(gear: &Gear, ends: ToothEnds, thickness_mm: f64) -> Self {
        let d = gear.transverse_module_mm() * f64::from(gear.teeth);
        Self {
            kind: gear.kind,
            teeth: gear.teeth,
            normal_module_mm: gear.module_mm,
            normal_pressure_angle_rad: gear.pressure_angle_rad,
            helix_angle_rad: gear.helix_angle_rad,
            face_width_mm: gear.face_width_mm,
            addendum_coefficient: gear.addendum_coefficient,
            profile_shift_coefficient: gear.profile_shift_coefficient,
            tip_diameter_mm: d + 2.0 * gear.kind.tip_sign() * gear.addendum_mm(),
            root_diameter_mm: ends.root_mm,
            form_diameter_mm: ends.involute_mm[0],
            tip_form_diameter_mm: ends.involute_mm[1],
            thickness_mm,
        }
    }

    /// The same with teeth of another thickness.
    #[must_use]
    pub fn with_thickness(&self, thickness_mm: f64) -> Self {
        Self { thickness_mm, ..*self }
    }

    fn z(&self) -> f64 {
        f64::from(self.teeth)
    }

    /// d, mm.
    pub fn reference_diameter_mm(&self) -> f64 {
        self.z() * self.normal_module_mm / self.helix_angle_rad.cos()
    }

    fn transverse_pressure_angle_rad(&self) -> f64 {
        transverse_pressure_angle_rad(self.normal_pressure_angle_rad, self.helix_angle_rad)
    }

    /// d_b, mm.
    pub fn base_diameter_mm(&self) -> f64 {
        self.reference_diameter_mm() * self.transverse_pressure_angle_rad().cos()
    }

    /// cos(beta_b): normal over transverse deviations of the flank.
    pub fn base_helix_cosine(&self) -> f64 {
        base_helix_cosine(self.normal_pressure_angle_rad, self.helix_angle_rad)
    }

    /// x_E: the profile shift that the thickness stands for.
    pub fn generating_shift(&self) -> f64 {
        let m_t = self.normal_module_mm / self.helix_angle_rad.cos();
        let thicker_mm = self.thickness_mm - FRAC_PI_2 * m_t;
        thicker_mm / (2.0 * self.normal_module_mm * self.transverse_pressure_angle_rad().tan())
    }

    /// Where the involute of the flank begins to carry with a rack as mate, d_Nf, mm: no external mate of this basic
    /// rack begins lower. None in a ring, with which no rack runs.
    pub fn active_diameter_with_rack_mm(&self) -> Option<f64> {
        let alpha = self.transverse_pressure_angle_rad();
        let below_mm = (self.addendum_coefficient - self.profile_shift_coefficient) * self.normal_module_mm;
        let roll_mm = 0.5 * self.reference_diameter_mm() * alpha.sin() - below_mm / alpha.sin();
        let diameter_mm = self.base_diameter_mm().hypot(2.0 * roll_mm.max(0.0));
        (self.kind == GearKind::External).then_some(diameter_mm.max(self.form_diameter_mm))
    }

    /// Tip clearance c, mm, in a mesh without backlash with a mate of the same basic rack and the opposite shift.
    pub fn tip_clearance_mm(&self) -> f64 {
        let depth_mm = 0.5 * self.kind.tip_sign() * (self.reference_diameter_mm() - self.root_diameter_mm);
        depth_mm - (self.addendum_coefficient - self.profile_shift_coefficient) * self.normal_module_mm
    }

    /// x_E of what a span goes over: teeth, or the spaces of a ring.
    fn spanned_shift(&self) -> f64 {
        self.kind.tip_sign() * self.generating_shift()
    }

    /// Chord of a tooth at the reference circle and its height below the tip circle, normal section, mm. None in a
    /// ring, in which no vernier stands.
    pub fn chordal_mm(&self) -> Option<[f64; 2]> {
        let cosine = self.helix_angle_rad.cos();
        let virtual_mm = self.reference_diameter_mm() / (cosine * cosine);
        let half_rad = self.thickness_mm * cosine / virtual_mm;
        let addendum_mm = 0.5 * (self.tip_diameter_mm - self.reference_diameter_mm());
        let height_mm = addendum_mm + 0.5 * virtual_mm * (1.0 - half_rad.cos());
        (self.kind == GearKind::External).then_some([virtual_mm * half_rad.sin(), height_mm])
    }

    /// Span over k teeth, in a ring across k spaces.
    pub fn span_over(&self, teeth: u32) -> SpanMeasure {
        let alpha_n = self.normal_pressure_angle_rad;
        let pitches = (f64::from(teeth) - 0.5) * PI + self.z() * inv(self.transverse_pressure_angle_rad());
        let length_mm = self.normal_module_mm * alpha_n.cos() * (pitches + 2.0 * self.spanned_shift() * alpha_n.tan());
        let touch_diameter_mm = self.base_diameter_mm().hypot(length_mm * self.base_helix_cosine());
        SpanMeasure { teeth, length_mm, touch_diameter_mm }
    }

    /// The span that touches nearest to the middle of the flank, d + 2 x m_n.
    ///
    /// # Errors
    /// Why none can be taken, in words.
    pub fn span(&self) -> Result<SpanMeasure, String> {
        let sign = self.kind.tip_sign();
        let middle_mm =
            self.reference_diameter_mm() + 2.0 * sign * self.profile_shift_coefficient * self.normal_module_mm;
        let spans = (2..=self.teeth / 2).map(|k| self.span_over(k)).filter(|span| self.touches(span.touch_diameter_mm));
        let away = |span: &SpanMeasure| (span.touch_diameter_mm - middle_mm).abs();
        let best = spans.min_by(|a, b| away(a).total_cmp(&away(b)));
        if self.kind == GearKind::Internal && self.helix_angle_rad != 0.0 {
            return Err("plane anvils find no common normal between helical teeth of a ring".to_owned());
        }
        let span = best.ok_or("over no number of teeth does a span touch the involutes")?;
        let sine = (1.0 - self.base_helix_cosine().powi(2)).sqrt();
        let needed_mm = span.length_mm * sine;
        if self.face_width_mm < needed_mm {
            return Err(format!("the face would have to be wider than W_k sin(beta_b) = {needed_mm:.2} mm"));
        }
        Ok(span)
    }

    /// Whether a diameter lies on the involute.
    fn touches(&self, diameter_mm: f64) -> bool {
        let [a, b] = [self.form_diameter_mm, self.tip_form_diameter_mm];
        (a.min(b)..=a.max(b)).contains(&diameter_mm)
    }

    /// Usual diameter of the balls, mm.
    pub fn usual_ball_mm(&self) -> f64 {
        PIN_MODULES[usize::from(self.kind == GearKind::Internal)] * self.normal_module_mm
    }

    /// Dimension over two balls.
    ///
    /// # Errors
    /// Why the balls do not fit, in words.
    pub fn over_balls(&self, ball_mm: f64) -> Result<OverBalls, String> {
        let sign = self.kind.tip_sign();
        let (z, m_n, alpha_n) = (self.z(), self.normal_module_mm, self.normal_pressure_angle_rad);
        let half_space = (FRAC_PI_2 - 2.0 * self.generating_shift() * alpha_n.tan()) / z;
        let inv_k =
            inv(self.transverse_pressure_angle_rad()) + sign * (ball_mm / (z * m_n * alpha_n.cos()) - half_space);
        let alpha_k = angle_of_inv(inv_k).ok_or("the balls are too small and sink to the root")?;
        let center_mm = self.base_diameter_mm() / alpha_k.cos();
        let apart_mm = if self.teeth.is_multiple_of(2) { center_mm } else { center_mm * (FRAC_PI_2 / z).cos() };
        // The ball touches D_M / 2 along the normal from its centre: on the line of action of the transverse section
        // that is D_M cos(beta_b) / 2 of its length.
        let along_mm = self.base_diameter_mm() * alpha_k.tan() - sign * ball_mm * self.base_helix_cosine();
        let touch_diameter_mm = self.base_diameter_mm().hypot(along_mm);
        // In a ring balls are held by stems, and nothing rests on them.
        let hidden = self.kind == GearKind::External && center_mm + ball_mm <= self.tip_diameter_mm;
        if !self.touches(touch_diameter_mm) || along_mm < 0.0 {
            return Err(format!("balls of {ball_mm:.3} mm touch at {touch_diameter_mm:.3} mm, not on the involute"));
        }
        if hidden {
            return Err(format!("balls of {ball_mm:.3} mm do not rise over the tips"));
        }
        Ok(OverBalls { ball_mm, dimension_mm: apart_mm + sign * ball_mm, touch_diameter_mm })
    }
}

/// The angle below a right one whose involute function is this; none below 0.
fn angle_of_inv(value: f64) -> Option<f64> {
    // inv rises from 0 without bound below a right angle.
    let angle = |t: f64| t.atan();
    (value > 0.0).then(|| {
        let over = |t: f64| t - angle(t) - value;
        let high = (value + FRAC_PI_2).max(1.0);
        angle(gearcut_core::math::roots::bisect(|t| over(t) < 0.0, 0.0, high))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gear(kind: GearKind, teeth: u32, module_mm: f64, beta_deg: f64, shift: f64) -> RoundGear {
        let beta = f64::to_radians(beta_deg);
        let alpha_n = f64::to_radians(20.0);
        let alpha_t = (alpha_n.tan() / beta.cos()).atan();
        let d = module_mm * f64::from(teeth) / beta.cos();
        let sign = kind.tip_sign();
        RoundGear {
            kind,
            teeth,
            normal_module_mm: module_mm,
            normal_pressure_angle_rad: alpha_n,
            helix_angle_rad: beta,
            face_width_mm: 100.0,
            addendum_coefficient: 1.0,
            profile_shift_coefficient: shift,
            tip_diameter_mm: d + sign * 2.0 * module_mm * (1.0 + shift),
            root_diameter_mm: d - sign * 2.0 * module_mm * (1.25 - shift),
            form_diameter_mm: d - sign * 1.9 * module_mm * (1.0 - shift),
            tip_form_diameter_mm: d + sign * 2.0 * module_mm * (1.0 + shift),
            thickness_mm: FRAC_PI_2 * module_mm / beta.cos() + 2.0 * shift * module_mm * alpha_t.tan(),
        }
    }

    fn close(found: f64, printed: f64) {
        assert!((found - printed).abs() <= 0.51e-4, "{found} for {printed}");
    }

    /// 20 teeth of module 1 (MESYS AG, "Calculation of geometry for helical gear", mesys.ag): all figures as printed.
    #[test]
    fn spur_gears_have_the_figures_of_another_program() {
        let gear = gear(GearKind::External, 20, 1.0, 0.0, 0.0);
        close(gear.base_diameter_mm(), 18.7939);
        let span = gear.span_over(2);
        close(span.length_mm, 4.7083);
        close(span.touch_diameter_mm, 19.3746);
        // Over three teeth it touches at 20.29 mm, nearer to the reference circle.
        assert_eq!(gear.span().expect("it can be spanned").teeth, 3);
        let over = gear.over_balls(1.7).expect("they fit");
        close(over.dimension_mm, 22.2941);
        close(over.touch_diameter_mm, 19.9594);
        close(gear.tip_clearance_mm(), 0.25);
    }

    /// Half angle 90 deg / z + 360 deg x tan(alpha) / (pi z), chord z m sin of it, height z m (1 - cos) / 2 + h_a (gear
    /// tooth vernier; KHK, Calculation of gear dimensions): 12 teeth of module 10, x 0.3, and two more.
    #[test]
    fn chords_are_those_of_a_gear_tooth_vernier() {
        let spur = gear(GearKind::External, 12, 10.0, 0.0, 0.3).chordal_mm().expect("an external gear");
        close(spur[0], 17.8256);
        close(spur[1], 13.6657);
        for (teeth, module_mm, shift) in [(20, 1.0, 0.0), (35, 4.0, -0.2)] {
            let [chord_mm, height_mm] =
                gear(GearKind::External, teeth, module_mm, 0.0, shift).chordal_mm().expect("an external gear");
            let (z, d) = (f64::from(teeth), f64::from(teeth) * module_mm);
            let half_deg = 90.0 / z + 360.0 * shift * 20_f64.to_radians().tan() / (PI * z);
            close(chord_mm, d * half_deg.to_radians().sin());
            close(height_mm, 0.5 * d * (1.0 - half_deg.to_radians().cos()) + (1.0 + shift) * module_mm);
        }
        assert_eq!(gear(GearKind::Internal, 60, 2.0, 0.0, 0.0).chordal_mm(), None);
    }

    /// 30 teeth of module 1, thinned by 0.03 mm (ONDRIVES' calculator at mesys.ch): x_E -0.0412, radius over one ball
    /// 16.1190.
    #[test]
    fn thinned_teeth_are_a_smaller_shift() {
        let gear = gear(GearKind::External, 30, 1.0, 0.0, 0.0);
        let thinned = gear.with_thickness(gear.thickness_mm - 0.03);
        close(thinned.generating_shift(), -0.0412);
        close(0.5 * thinned.over_balls(1.7).expect("they fit").dimension_mm, 16.1190);
    }

    /// Module 3, 24 teeth, 25 deg, x 0.4: 42.0085 mm over five teeth (Elements of Metric Gear Technology, SDP/SI,
    /// section 10, example of helical gears).
    #[test]
    fn helical_gears_are_spanned_in_the_normal_section() {
        let span = gear(GearKind::External, 24, 3.0, 25.0, 0.4).span_over(5);
        assert!((span.length_mm - 42.0085).abs() < 5e-4, "{}", span.length_mm);
        let narrow = RoundGear { face_width_mm: 5.0, ..gear(GearKind::External, 24, 3.0, 25.0, 0.4) };
        assert!(narrow.span().expect_err("too narrow").contains("wider"));
    }

    /// What is space in a ring is tooth on the gear that fills it: balls in the ring's spaces touch as its teeth would.
    #[test]
    fn a_ring_is_measured_where_its_involutes_are() {
        let ring = gear(GearKind::Internal, 60, 2.0, 0.0, 0.3);
        let filling = gear(GearKind::External, 60, 2.0, 0.0, -0.3);
        close(ring.span_over(7).length_mm, filling.span_over(7).length_mm);
        // A ball that touches both flanks: its centre lies on the bisector of the space, D_M / 2 from the involutes.
        let over = ring.over_balls(ring.usual_ball_mm()).expect("they fit");
        let center_mm = 0.5 * (over.dimension_mm + over.ball_mm);
        let base_mm = 0.5 * ring.base_diameter_mm();
        // Half angle of the space on the base circle; distance of a point on its bisector from the involute along the
        // normal is r_b (half angle - inv) inside the filling tooth.
        let half = 0.5 * filling.thickness_mm / 60.0 + inv(f64::to_radians(20.0));
        let inv_center = inv((base_mm / center_mm).acos());
        close(base_mm * (half - inv_center), 0.5 * over.ball_mm);
    }

    #[test]
    fn what_cannot_be_measured_says_why() {
        let gear = gear(GearKind::External, 20, 1.0, 0.0, 0.0);
        assert!(gear.over_balls(0.5).is_err());
        assert!(gear.over_balls(9.0).is_err());
    }
}
