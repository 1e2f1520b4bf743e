//! What the tip corner of a rack leaves: fillets and trochoids of hobbed gears.
//!
//! In: the rack's generation, a space and its side. Out: points and normals of the corner's path in any transverse
//! section, and where it reaches a height.
//!
//! **Law.** A tip round of radius r (in the normal section, taken as circular in the transverse one) touches along the
//! line through the pitch point P and its centre (Litvin and Fuentes 2004, chapter 6), in every direction from the tip
//! line's normal to the flank's; a sharp corner is a round with r = 0. With t the tangent of that direction against the
//! space's middle (its **lean**) and y the height of the centre over the pitch line, the curve has rolled -e y t past
//! the place at which it has the centre on its normal, and the round touches at (e t, 1) y + r (-e t, -1) / sqrt(1 +
//! t^2) from P.
//!
//! **By direction, not by roll.** Where a profile shift lifts the centre over the pitch line the roll runs the other
//! way round the corner, and where the centre lies on that line the whole round touches at once. The lean grows from
//! the tip line to the flank whatever the shift, so a fillet that is not undercut ends at cot(alpha_t), unsearched.

use super::rack_generation::{ProfileCrossing, ProfilePart, Rack, RackGeneration, ZERO_MM};
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::regula_falsi;
use gearcut_core::terms::Side;
use glam::DVec2;

/// The corner's path is followed in such steps of its lean, as shares of that at the flank's end, and as far as four
/// times that: undercut or not, a profile goes over to its flank before.
const CORNER_STEP: f64 = 0.2;
const CORNER_STEPS: u32 = 20;

/// Contact of a tip corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerContact {
    /// Polar angle of the pitch point, rad.
    pub phi_rad: f64,
    /// Point in the transverse section, gear frame, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear in that section.
    pub normal: DVec2,
}

impl Rack {
    /// Lean ([`RackGeneration::corner_contact`]) at which the tip round ends at the straight flank: cot(alpha_t).
    pub fn flank_lean(&self) -> f64 {
        1.0 / self.pressure_angle_rad.tan()
    }

    /// Centre of the tip round against the tooth's middle, on the low-arc side: (x, y).
    fn corner_center_mm(&self) -> DVec2 {
        let (sin, cos) = self.pressure_angle_rad.sin_cos();
        let height = self.flank_end_height_mm();
        let end = DVec2::new(-(self.half_thickness_mm - height * sin / cos), -height);
        // The flank's normal out of the rack's low side is (-cos, -sin).
        end + self.tip_radius_mm * DVec2::new(cos, sin)
    }
}

impl RackGeneration {
    /// Contact of the tip corner of a space in the section `z_mm` where the tangent of the angle between its normal and
    /// the space's middle is `lean`: 0 at the tip line, cot(alpha_t) at the end of the flank.
    pub fn corner_contact(&self, space: i64, side: Side, lean: f64, z_mm: f64) -> CornerContact {
        let e = side.sign();
        let center = self.rack.corner_center_mm();
        let arc_mm = self.corner_bottom_arc_mm(space, side, z_mm) - e * center.y * lean;
        let phi_rad = self.curve.phi_at_arc(arc_mm);
        let frame = self.curve.frame(phi_rad);
        let out = DVec2::new(-e * lean, -1.0).normalize();
        let touch = center.y * DVec2::new(e * lean, 1.0) + self.rack.tip_radius_mm * out;
        CornerContact {
            phi_rad,
            point_mm: frame.point_mm + touch.x * frame.tangent + touch.y * frame.normal,
            normal: -(out.x * frame.tangent + out.y * frame.normal),
        }
    }

    /// Rolled arc at which the tip corner is deepest: its centre is on the pitch curve's normal.
    pub fn corner_bottom_arc_mm(&self, space: i64, side: Side, z_mm: f64) -> f64 {
        self.space_arc_mm(space, z_mm) + side.sign() * self.rack.corner_center_mm().x
    }

    /// Where the path of the tip corner first climbs, on the flank's side, through a height over the pitch curve: its
    /// lean ([`Self::corner_contact`]) and the crossing. `None` where it does not reach that height from below.
    pub(super) fn corner_at_height(
        &self,
        blank: &Blank,
        space: i64,
        side: Side,
        height_mm: f64,
        z_mm: f64,
    ) -> Option<(f64, ProfileCrossing)> {
        let foot = |lean: f64| {
            let contact = self.corner_contact(space, side, lean, z_mm);
            (contact.point_mm, blank.height(contact.point_mm, contact.phi_rad))
        };
        let over = |lean: f64| foot(lean).1.0 - height_mm;
        // The bracket's ends are leans whose heights are known, no sums of them: rounding cannot take the root away.
        let mut leans = (0..=CORNER_STEPS).map(|i| CORNER_STEP * f64::from(i) * self.rack.flank_lean());
        let mut from = None;
        let to = leans.find(|&lean| {
            let is_below = over(lean) < 0.0;
            from = if is_below { Some(lean) } else { from };
            !is_below && from.is_some()
        })?;
        let lean = regula_falsi(over, from?, to, ZERO_MM)?;
        let (point_mm, (_, foot)) = foot(lean);
        Some((lean, ProfileCrossing { point_mm, foot_arc_mm: self.curve.arc_mm(foot), part: ProfilePart::Fillet }))
    }

    /// Length of the tip corner's path up to a lean, mm: that of its round or of its roll, the larger one.
    pub fn corner_length_mm(&self, lean: f64) -> f64 {
        lean * self.rack.corner_center_mm().y.abs().max(self.rack.tip_radius_mm)
    }
}
