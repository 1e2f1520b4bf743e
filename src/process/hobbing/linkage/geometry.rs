//! How the axes of a hobbing machine are geared together, where they stand, and where the work is in the machine.
//!
//! In: the hob and the gear's helix. Out: [`HobbingGeometry`] with the arcs that hob, slide and shift roll, the pose of
//! the tool in the machine frame, and that of the machine in the gear frame; frames and signs stand with the linkage.

use crate::process::hobbing::Hob;
use gearcut_core::frame::Rigid3;
use gearcut_core::math::Jet;
use glam::{DMat3, DVec3};

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

/// The gear frame from the machine frame: turned over, moved to the work's centre, turned with the work.
pub(super) fn work_from_machine<const N: usize>(axes: &HobbingAxes<N>) -> Rigid3 {
    work_from_machine_at(axes.work_rad.value(), axes.x_mm.value(), axes.y_mm.value())
}

/// The same from the work's angle (rad) and the place of the pitch point against its axis, tangential and radial (mm).
pub fn work_from_machine_at(work_rad: f64, x_mm: f64, y_mm: f64) -> Rigid3 {
    let (sin, cos) = work_rad.sin_cos();
    let (x, y) = (DVec3::new(-sin, cos, 0.0), DVec3::new(cos, sin, 0.0));
    Rigid3 { rotation: DMat3::from_cols(x, y, DVec3::NEG_Z), translation_mm: x * x_mm + y * y_mm }
}
