//! The cradle machine: its settings under their usual names, and the tool's pose in the work while a slot is cut.
//!
//! In: settings and a moment of the slot. Out: pose and velocity of the tool in the work (frames: [`super`]).
//!
//! **Moment.** One number says where the machine is in a slot. Where the gear is generated it is the cradle angle, rad.
//! A gear that is not generated (Formate) has a ratio of roll of 0: cradle and work rest, the sliding base brings the
//! head in, and the moment is how far the head stands beyond its full depth, mm: negative on the way, 0 at the end.
//!
//! Source: Chen, Yan, Ming and Xie (2008), Eq. 6, which this pose equals entry by entry; for the sliding base along the
//! cradle's axis, the modified roll and the names Litvin and Zhang, NASA CR-4342 (1991). The paper draws X_B along the
//! machine's x axis, where it acts like a part of X_p; on a machine the sliding base runs along the cradle's axis. Both
//! are settings here, so that the printed example and a corrected one can be told apart.
//!
//! **Tilt.** The head may lean against the cradle's axis ([`Tilt`]): between R_z(q) and the tool's points comes
//! R_z(j) R_y(i) R_z(-j), about the middle of the plane of the tips, so that S_r and X_D are that point's.

use crate::frame::{Rigid3, RigidMotion3};
use crate::math::Jet;
use glam::{DMat3, DVec2, DVec3};

/// Settings of a cradle machine; mm and rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CradleSettings {
    /// Radial setting S_r: distance of the head's axis from the cradle's.
    pub radial_setting_mm: f64,
    /// Cradle angle q at the middle of the roll; positive and negative ones cut opposite hands of spiral.
    pub cradle_angle_rad: f64,
    /// Blank offset E_m, along the machine's y axis; 0 on spiral bevel gears.
    pub blank_offset_mm: f64,
    /// The paper's X_B, along the machine's x axis.
    pub cross_shift_mm: f64,
    /// Sliding base X_D, along the cradle's axis towards the work: how much deeper the tips stand.
    pub sliding_base_mm: f64,
    /// Machine centre to back X_p: how far the work stands back along its own axis.
    pub center_to_back_mm: f64,
    /// Machine root angle gamma_m.
    pub root_angle_rad: f64,
    /// How the head leans.
    pub tilt: Tilt,
    /// How the work follows the cradle.
    pub roll: Roll,
}

/// How the head's axis leans against the cradle's: by i towards the direction j, which counts from the line of the
/// radial setting and turns with the cradle. In the machine it runs along (sin i cos(q + j), sin i sin(q + j), cos i).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tilt {
    /// Tilt i, rad; 0: the head's axis is parallel to the cradle's.
    pub tilt_rad: f64,
    /// Swivel j, rad.
    pub swivel_rad: f64,
}

impl Tilt {
    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        self.tilt_rad == 0.0
    }

    /// R_z(j) R_y(i) R_z(-j).
    pub fn rotation(&self) -> DMat3 {
        if self.is_none() {
            return DMat3::IDENTITY;
        }
        let swivel = DMat3::from_rotation_z(self.swivel_rad);
        swivel * DMat3::from_rotation_y(self.tilt_rad) * swivel.transpose()
    }
}

/// Where the machine is at a moment of a slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CradleMoment {
    /// Settings with the sliding base of the moment.
    pub settings: CradleSettings,
    /// Cradle angle, rad.
    pub cradle_rad: f64,
}

/// Work angle over cradle angle: A(q) = A(q0) + R_a (d - C d^2 - D d^3), d = q - q0, q0 the cradle angle at the middle
/// of the roll. C and D are Litvin's coefficients of modified roll; with both 0 the ratio is the same all the time.
/// A(q0) is R_a q0 with the ratio that is meant: an error of it bends flanks and turns no gear as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Roll {
    /// Ratio of roll R_a: work angle per cradle angle at the middle of the roll; 0 where nothing rolls.
    pub ratio: f64,
    /// C, 1/rad.
    pub second_order_per_rad: f64,
    /// D, 1/rad^2.
    pub third_order_per_rad2: f64,
    /// By how much the ratio is off the one that is meant.
    pub ratio_error: f64,
}

impl CradleSettings {
    /// Whether nothing rolls: the head plunges into each slot, and flanks are its cones (Formate).
    pub fn plunges(&self) -> bool {
        self.roll.ratio == 0.0
    }

    /// Where the machine is at a moment of a slot.
    pub fn at(&self, moment: f64) -> CradleMoment {
        if self.plunges() {
            let settings = Self { sliding_base_mm: self.sliding_base_mm + moment, ..*self };
            CradleMoment { settings, cradle_rad: self.cradle_angle_rad }
        } else {
            CradleMoment { settings: *self, cradle_rad: moment }
        }
    }

    /// How far the plane of the tips at full depth stands short of a place of the axial section (along the work's axis
    /// and away from it, mm) on the head's side, along the head's axis in the middle of the roll; negative where it
    /// lies beyond.
    pub fn short_of_mm(&self, axial_mm: DVec2) -> f64 {
        let head = self.machine_from_tool(self.cradle_angle_rad);
        head.rotation.z_axis.dot(self.machine_from_axial_mm(axial_mm) - head.translation_mm)
    }

    /// A place of the axial section in the machine, on the head's side of the work.
    pub(super) fn machine_from_axial_mm(&self, axial_mm: DVec2) -> DVec3 {
        let (sin, cos) = self.root_angle_rad.sin_cos();
        let out_mm = axial_mm.x + self.center_to_back_mm;
        DVec3::new(cos * out_mm + sin * axial_mm.y, 0.0, sin * out_mm - cos * axial_mm.y)
    }

    /// Work angle A and its rate dA/dq at a cradle angle; A is R_a q where the roll is even and its ratio right.
    pub fn work_angle(&self, cradle_rad: f64) -> [f64; 2] {
        let Roll { ratio, second_order_per_rad: c, third_order_per_rad2: d, ratio_error } = self.roll;
        let by = cradle_rad - self.cradle_angle_rad;
        [
            ratio * (self.cradle_angle_rad + by * (1.0 - by * (c + by * d))) - ratio_error * self.cradle_angle_rad,
            ratio * (1.0 - by * (2.0 * c + 3.0 * d * by)),
        ]
    }

    /// The same with d^2 A / dq^2.
    pub fn work_angle_jet(&self, cradle_rad: f64) -> Jet<3> {
        let Roll { ratio, second_order_per_rad: c, third_order_per_rad2: d, .. } = self.roll;
        let bend = -ratio * (2.0 * c + 6.0 * d * (cradle_rad - self.cradle_angle_rad));
        let [work_rad, rate] = self.work_angle(cradle_rad);
        Jet::from_derivatives([work_rad, rate, bend])
    }

    /// Tool in the machine frame, the blank's offset and both bases included.
    fn machine_from_tool(&self, cradle_rad: f64) -> Rigid3 {
        let (sin, cos) = cradle_rad.sin_cos();
        let s = self.radial_setting_mm;
        Rigid3 {
            rotation: DMat3::from_rotation_z(cradle_rad) * self.tilt.rotation(),
            translation_mm: DVec3::new(
                s * cos + self.cross_shift_mm,
                s * sin + self.blank_offset_mm,
                self.sliding_base_mm,
            ),
        }
    }

    /// Machine in the work at a work angle.
    fn work_from_machine(&self, work_rad: f64) -> Rigid3 {
        let still = Rigid3 {
            rotation: DMat3::from_rotation_y(self.root_angle_rad),
            translation_mm: DVec3::new(-self.center_to_back_mm, 0.0, 0.0),
        };
        let turn = Rigid3 { rotation: DMat3::from_rotation_x(-work_rad), translation_mm: DVec3::ZERO };
        turn.after(&still)
    }

    /// The paper's M_pt: pose of the tool in the work at a cradle angle and a work angle.
    pub fn work_from_tool_at(&self, cradle_rad: f64, work_rad: f64) -> Rigid3 {
        self.work_from_machine(work_rad).after(&self.machine_from_tool(cradle_rad))
    }

    /// Pose of the tool in the work at a moment of a slot.
    pub fn work_from_tool(&self, moment: f64) -> Rigid3 {
        let CradleMoment { settings, cradle_rad } = self.at(moment);
        settings.work_from_tool_at(cradle_rad, settings.work_angle(cradle_rad)[0])
    }

    /// The same with its velocity where the moment grows by one per second.
    pub fn motion(&self, moment: f64) -> RigidMotion3 {
        let CradleMoment { settings, cradle_rad } = self.at(moment);
        let [work_rad, rate] = settings.work_angle(cradle_rad);
        let work_from_machine = settings.work_from_machine(work_rad);
        let pose = work_from_machine.after(&settings.machine_from_tool(cradle_rad));
        let work_from_machine = work_from_machine.rotation;
        if self.plunges() {
            let velocity_mm_per_s = work_from_machine * DVec3::Z;
            return RigidMotion3 { pose, velocity_mm_per_s, angular_velocity_rad_per_s: DVec3::ZERO };
        }
        let (sin, cos) = cradle_rad.sin_cos();
        let turn = -rate * DVec3::X;
        let swing = self.radial_setting_mm * DVec3::new(-sin, cos, 0.0);
        RigidMotion3 {
            pose,
            velocity_mm_per_s: work_from_machine * swing + turn.cross(pose.translation_mm),
            angular_velocity_rad_per_s: work_from_machine * DVec3::Z + turn,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_are_the_rates_of_poses() {
        let settings = CradleSettings {
            radial_setting_mm: 98.0,
            cradle_angle_rad: 0.9,
            blank_offset_mm: 12.0,
            cross_shift_mm: -0.4,
            sliding_base_mm: 1.3,
            center_to_back_mm: 2.5,
            root_angle_rad: 1.1,
            tilt: Tilt { tilt_rad: 0.2, swivel_rad: -0.7 },
            roll: Roll { ratio: 1.08, second_order_per_rad: 0.03, third_order_per_rad2: -0.2, ..Roll::default() },
        };
        let (q, h, at) = (1.02, 1e-5, DVec3::new(40.0, -81.0, -3.0));
        let formate = CradleSettings { roll: Roll::default(), tilt: Tilt::default(), ..settings };
        for (settings, moment) in [(settings, q), (formate, -2.0)] {
            let motion = settings.motion(moment);
            let moved = |moment: f64| settings.work_from_tool(moment).point(at);
            let wanted = (moved(moment + h) - moved(moment - h)) / (2.0 * h);
            let got = motion.velocity_at(motion.pose.point(at));
            assert!(got.distance(wanted) < 1e-6, "{got} not {wanted}");
        }
        // The rest of the third derivative at the step, and rounding: what a wrong sign would leave is 1e8 times
        // larger.
        let [before, rate] = settings.work_angle(q);
        assert!((settings.work_angle(q + h)[0] - before - h * rate).abs() < 1e-10);
        assert!((settings.work_angle(0.9)[0] - 1.08 * 0.9).abs() < 1e-15);
        // A ratio that is off turns the work as before in the middle of the roll, and from there on with the distance.
        let roll = Roll { ratio: 1.082, ratio_error: 0.002, ..settings.roll };
        let off = CradleSettings { roll, ..settings };
        let by: f64 = q - 0.9;
        let more = 0.002 * by * (1.0 - by * (0.03 - 0.2 * by));
        assert!((off.work_angle(0.9)[0] - 1.08 * 0.9).abs() < 1e-15);
        assert!((off.work_angle(q)[0] - before - more).abs() < 1e-15);
    }
}
