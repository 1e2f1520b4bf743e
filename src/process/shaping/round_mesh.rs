//! Cutter and round gear in mesh without backlash: how the distance of their axes goes with the thickness of the teeth.
//!
//! In: kind, transverse module, transverse pressure angle and numbers of teeth. Out: working pressure angles and
//! offsets of the cutter from the distance at which the pitch curves touch, by ISO 21771:2007:
//! `inv(alpha') = inv(alpha) + s / (m (z + z0))` and `a' = a cos(alpha) / cos(alpha')` for teeth thicker by s on the
//! reference circle, a ring's z negative.

use gearcut_core::gear::GearKind;
use gearcut_core::math::roots::bisect;
use gearcut_core::tool::involute::inv;
use std::f64::consts::PI;

/// A gear and its cutter in the transverse section.
#[derive(Debug, Clone, Copy)]
pub(super) struct RoundMesh {
    /// m (z + z0), negative of a ring: twice the distance of the axes.
    both_mm: f64,
    /// alpha, at which the pitch curves touch.
    pressure_angle_rad: f64,
}

impl RoundMesh {
    /// A gear of so many teeth with a cutter of so many.
    pub fn new(kind: GearKind, module_mm: f64, pressure_angle_rad: f64, [gear, cutter]: [u32; 2]) -> Self {
        let both_mm = module_mm * (f64::from(gear) * kind.tip_sign() + f64::from(cutter));
        Self { both_mm, pressure_angle_rad }
    }

    /// Working pressure angle at which the gear's teeth are so much thicker on the reference circle than at another
    /// one, rad; `None` where no depth of the cutter makes them so.
    pub fn thicker_rad(&self, working_rad: f64, thicker_mm: f64) -> Option<f64> {
        let wanted = inv(working_rad) + thicker_mm / self.both_mm;
        (wanted.is_finite() && wanted > 0.0).then(|| bisect(|angle| inv(angle) < wanted, 0.0, 0.5 * PI))
    }

    /// The thickness on the reference circle by which teeth can be thinned, or a ring's thickened, from a working
    /// pressure angle on, mm.
    pub fn room_mm(&self, working_rad: f64) -> f64 {
        inv(working_rad) * self.both_mm.abs()
    }

    /// Whether it is a ring's cutter that comes to its limit where teeth are made thicker.
    pub fn thickens_to_limit(&self) -> bool {
        self.both_mm < 0.0
    }

    /// How much further from the pitch curve the cutter's centre lies at a working pressure angle, mm.
    pub fn offset_mm(&self, working_rad: f64) -> f64 {
        0.5 * self.both_mm * (self.pressure_angle_rad.cos() / working_rad.cos() - 1.0)
    }

    /// Working pressure angle at an offset, rad; `None` where the base circles do not roll there.
    pub fn working_rad(&self, offset_mm: f64) -> Option<f64> {
        let cos = self.pressure_angle_rad.cos() / (1.0 + 2.0 * offset_mm / self.both_mm);
        (cos > 0.0 && cos < 1.0).then(|| cos.acos())
    }
}
