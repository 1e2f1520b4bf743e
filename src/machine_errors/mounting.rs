//! How work and tool sit on their spindles, and how a guide runs: rigid motions and shifts.
//!
//! Lengths in mm, angles in rad. The gear frame turns with the gear, its z axis is the gear's; the spindle frame turns
//! with the work spindle. Both are one where nothing is wrong.

use gearcut_core::frame::Rigid3;
use glam::{DMat3, DVec2, DVec3};

/// How the work sits on its spindle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WorkMounting {
    /// Distance of the gear's axis from the spindle's in the middle of the face.
    pub eccentricity_mm: f64,
    /// Direction of the gear's axis from the spindle's, counter-clockwise from phi = 0 of the gear.
    pub eccentricity_angle_rad: f64,
    /// Angle between both axes.
    pub wobble_rad: f64,
    /// Direction in which the gear's axis leans along its z, counter-clockwise from phi = 0 of the gear.
    pub wobble_angle_rad: f64,
    /// How far the gear sits too high along its z.
    pub axial_offset_mm: f64,
}

/// How the tool sits on its spindle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ToolMounting {
    /// Distance of the tool's axis from the spindle's at the tool's origin.
    pub runout_mm: f64,
    /// Direction of the tool's axis from the spindle's, counter-clockwise about the tool's z from its x axis.
    pub runout_angle_rad: f64,
    /// Angle between both axes.
    pub wobble_rad: f64,
    /// Direction in which the tool's axis leans along its z, from the tool's x axis.
    pub wobble_angle_rad: f64,
}

/// How the guide along the gear's axis runs: where the tool is shifted to while it is higher along the gear's z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Guide {
    /// Away from the gear's axis along the line of centres, mm per mm.
    pub radial_slope: f64,
    /// Counter-clockwise about the gear's axis, mm per mm.
    pub tangential_slope: f64,
    /// Away from the gear's axis at both ends of the face, against its middle; a parabola.
    pub radial_bow_mm: f64,
    /// Counter-clockwise at both ends of the face, against its middle; a parabola.
    pub tangential_bow_mm: f64,
}

impl WorkMounting {
    /// Whether nothing is wrong.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The gear's axis in the spindle frame at a height over the middle of the face, mm.
    pub fn axis_mm(&self, z_mm: f64) -> DVec2 {
        let lean = self.wobble_rad * z_mm * DVec2::from_angle(self.wobble_angle_rad);
        self.eccentricity_mm * DVec2::from_angle(self.eccentricity_angle_rad) + lean
    }

    /// Height on the machine of a place of the gear, both over the middle of the face of a gear without errors, mm: one
    /// on the side to which the axis leans lies lower, to first order by the lean times its distance.
    pub fn height_mm(&self, place_mm: DVec3) -> f64 {
        let lower_mm = self.wobble_rad * DVec2::from_angle(self.wobble_angle_rad).dot(place_mm.truncate());
        place_mm.z + self.axial_offset_mm - lower_mm
    }

    /// The spindle frame in the gear frame, where the middle of the face stands at `middle_z_mm`.
    pub fn gear_from_spindle(&self, middle_z_mm: f64) -> Rigid3 {
        let rotation = leaning(self.wobble_rad, self.wobble_angle_rad);
        let middle = DVec3::new(0.0, 0.0, middle_z_mm);
        let shift = self.axis_mm(0.0).extend(self.axial_offset_mm);
        Rigid3 { rotation, translation_mm: middle + shift - rotation * middle }.inverse()
    }
}

impl ToolMounting {
    /// Whether nothing is wrong.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The tool frame in the frame of its spindle.
    pub fn spindle_from_tool(&self) -> Rigid3 {
        Rigid3 {
            rotation: leaning(self.wobble_rad, self.wobble_angle_rad),
            translation_mm: (self.runout_mm * DVec2::from_angle(self.runout_angle_rad)).extend(0.0),
        }
    }
}

impl Guide {
    /// Whether nothing is wrong.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Shift of the tool at a height over the middle of the face, radial and tangential, mm.
    pub fn shift_mm(&self, z_mm: f64, half_face_mm: f64) -> DVec2 {
        let square = (z_mm / half_face_mm).powi(2);
        DVec2::new(
            self.radial_slope * z_mm + self.radial_bow_mm * square,
            self.tangential_slope * z_mm + self.tangential_bow_mm * square,
        )
    }
}

/// Turn of the z axis by an angle towards a direction in the transverse plane.
fn leaning(angle_rad: f64, towards_rad: f64) -> DMat3 {
    let about = DVec2::from_angle(towards_rad).perp().extend(0.0);
    DMat3::from_axis_angle(about, angle_rad)
}
