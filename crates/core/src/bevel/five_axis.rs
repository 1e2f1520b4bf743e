//! The six-axis machine: X, Y, Z move the head, A turns the work, B swings it, C turns the head's frame.
//!
//! In: a pose of the tool in the work, or cradle settings. Out: positions of the axes, and the way back.
//!
//! The chain is p = R_x(-A) (R_y(B) (R_z(C) t + (X, Y, Z)) - (x_e, 0, 0)), Chen, Yan, Ming and Xie (2008), Eqs. 3 and
//! 5: L_pt = R_x R_y R_z, and x_e is the mounting distance from B's axis to the work, fixed on the machine. Any pose
//! has its axes, tilted heads too: B = asin L_13, A = atan2(L_23, L_33), C = atan2(-L_12, L_11), unless the head's axis
//! runs along the work's. From a cradle machine without tilt follow Eqs. 9 to 14 in closed form: B is the root angle
//! and rests, so that five axes are linked and the turn of the head's frame C = q goes into the spindle, where it is of
//! no account. Where the head is tilted B moves, and C is q but for what the lean turns; both in closed form as well.

use super::cradle::{CradleMoment, CradleSettings, Roll, Tilt};
use crate::error::{NotConverged, Refusal};
use crate::frame::Rigid3;
use crate::math::Jet;
use crate::math::least_squares::solve;
use crate::parameter;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Below this cosine of B the head's axis runs along the work's, and A and C are the same turn.
const LEAST_COSINE: f64 = 1e-9;

/// Positions of the six axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SixAxes {
    /// X, Y, Z: the head's middle in the machine, mm.
    pub slides_mm: DVec3,
    /// Work spindle A, rad.
    pub work_rad: f64,
    /// Swing of the work B, rad.
    pub swing_rad: f64,
    /// Turn of the head's frame C, rad.
    pub head_rad: f64,
}

/// The machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FiveAxisMachine {
    /// Mounting distance x_e from the axis of B to the work's origin along the work's axis, mm.
    pub mounting_mm: f64,
}

impl FiveAxisMachine {
    /// Pose of the tool in the work, Eqs. 3 and 5.
    pub fn work_from_tool(&self, axes: &SixAxes) -> Rigid3 {
        let swing = DMat3::from_rotation_x(-axes.work_rad) * DMat3::from_rotation_y(axes.swing_rad);
        let back = DMat3::from_rotation_x(-axes.work_rad) * DVec3::new(self.mounting_mm, 0.0, 0.0);
        Rigid3 {
            rotation: swing * DMat3::from_rotation_z(axes.head_rad),
            translation_mm: swing * axes.slides_mm - back,
        }
    }

    /// Axes at which the tool stands in the work as it should; angles A and C within half a turn of 0.
    ///
    /// # Errors
    /// The head's axis runs along the work's.
    pub fn axes_of(&self, work_from_tool: &Rigid3) -> Result<SixAxes, Refusal> {
        let axes = self.any_axes_of(work_from_tool);
        if axes.swing_rad.cos() < LEAST_COSINE {
            return Err(Refusal::new(
                parameter::MACHINE_ROOT_ANGLE,
                "the head's axis runs along the work's axis: A and C are the same turn",
                "use a root angle below 90 degrees",
            ));
        }
        Ok(axes)
    }

    /// The same, with A and C of any size where they are one turn.
    fn any_axes_of(self, work_from_tool: &Rigid3) -> SixAxes {
        // glam counts columns first: x_axis.y is L_21.
        let l = work_from_tool.rotation;
        let swing_rad = l.z_axis.x.clamp(-1.0, 1.0).asin();
        let work_rad = l.z_axis.y.atan2(l.z_axis.z);
        let head_rad = (-l.y_axis.x).atan2(l.x_axis.x);
        let machine_from_work = DMat3::from_rotation_y(-swing_rad) * DMat3::from_rotation_x(work_rad);
        let slides_mm = machine_from_work * work_from_tool.translation_mm
            + DMat3::from_rotation_y(-swing_rad) * DVec3::new(self.mounting_mm, 0.0, 0.0);
        SixAxes { slides_mm, work_rad, swing_rad, head_rad }
    }

    /// Axes that do what a cradle machine does at a moment of a slot, Eqs. 9 to 14, the sliding base added along z: a
    /// head that plunges moves Z alone.
    pub fn axes_of_cradle(&self, settings: &CradleSettings, moment: f64) -> SixAxes {
        let CradleMoment { settings, cradle_rad } = settings.at(moment);
        if !settings.tilt.is_none() {
            let [x, y, z, work_rad, swing_rad, head_rad] =
                self.axes_of_tilted(&settings, cradle_rad).map(|of: Jet<3>| of.value());
            return SixAxes { slides_mm: DVec3::new(x, y, z), work_rad, swing_rad, head_rad };
        }
        let (sin, cos) = settings.root_angle_rad.sin_cos();
        let (s, out_mm) = (settings.radial_setting_mm, self.mounting_mm - settings.center_to_back_mm);
        SixAxes {
            slides_mm: DVec3::new(
                s * cradle_rad.cos() + settings.cross_shift_mm + out_mm * cos,
                s * cradle_rad.sin() + settings.blank_offset_mm,
                settings.sliding_base_mm + out_mm * sin,
            ),
            work_rad: settings.work_angle(cradle_rad)[0],
            swing_rad: settings.root_angle_rad,
            head_rad: cradle_rad,
        }
    }

    /// X, Y, Z, A, B and C of a tilted head with their derivatives by the cradle angle. With b the head's axis in the
    /// work's directions before it turns, B = asin b_x, and the work turns on by atan2(b_y, b_z).
    pub fn axes_of_tilted(&self, settings: &CradleSettings, cradle_rad: f64) -> [Jet<3>; 6] {
        let (sin_root, cos_root) = settings.root_angle_rad.sin_cos();
        let swung = |[x, y, z]: [Jet<3>; 3]| [x * cos_root + z * sin_root, y, z * cos_root - x * sin_root];
        let (sin_q, cos_q) = Jet::variable(cradle_rad).sin_cos();
        let with_cradle = |at: DVec3| [cos_q * at.x - sin_q * at.y, sin_q * at.x + cos_q * at.y, Jet::constant(at.z)];
        let lean = settings.tilt.rotation();
        let [sin_swing, across, along] = swung(with_cradle(lean.z_axis));
        let cos_swing = (across * across + along * along).sqrt();
        let (sin_on, cos_on) = (across / cos_swing, along / cos_swing);
        // Turned on about the work's axis, and back by B.
        let in_head = |[x, y, z]: [Jet<3>; 3]| {
            let up = sin_on * y + cos_on * z;
            [cos_swing * x - sin_swing * up, cos_on * y - sin_on * z, sin_swing * x + cos_swing * up]
        };
        let [x, y, z] = with_cradle(settings.radial_setting_mm * DVec3::X);
        let middle = [x + settings.cross_shift_mm, y + settings.blank_offset_mm, z + settings.sliding_base_mm];
        let [out, y, z] = swung(middle);
        let [x, y, z] = in_head([out + (-settings.center_to_back_mm), y, z]);
        let [turned_x, turned_y, _] = in_head(swung(with_cradle(lean.x_axis)));
        let head = turned_y.atan2(&turned_x);
        [
            x + cos_swing * self.mounting_mm,
            y,
            z + sin_swing * self.mounting_mm,
            settings.work_angle_jet(cradle_rad) + across.atan2(&along),
            sin_swing.atan2(&cos_swing),
            head + nearest_turn(cradle_rad, head.value()),
        ]
    }

    /// The way back: settings of a cradle machine that does the same as a list of positions along a roll, and the
    /// largest distance of their paths, mm. X, Y over C give S_r, E_m and the middle of the arc; Z gives X_p, once the
    /// sliding base is known, because both move the head along the same line of the plane of the axes; A over C gives
    /// the ratio and the modified roll about `cradle_angle_rad`. A tilt has to be known, as the sliding base has: with
    /// the head turned back by it the positions are those of a machine without.
    ///
    /// # Errors
    /// Fewer than four positions, or positions that lie too near to each other to tell the settings apart.
    pub fn cradle_of(
        &self,
        roll: &[SixAxes],
        cradle_angle_rad: f64,
        sliding_base_mm: f64,
        tilt: Tilt,
    ) -> Result<(CradleSettings, f64), NotConverged> {
        let tool_from_leaning = Rigid3 { rotation: tilt.rotation().transpose(), translation_mm: DVec3::ZERO };
        let upright = |axes: &SixAxes| {
            if tilt.is_none() {
                return *axes;
            }
            let mut found = self.any_axes_of(&self.work_from_tool(axes).after(&tool_from_leaning));
            found.work_rad += nearest_turn(axes.work_rad, found.work_rad);
            found.head_rad += nearest_turn(axes.head_rad, found.head_rad);
            found
        };
        let roll: Vec<SixAxes> = roll.iter().map(upright).collect();
        // S_r cos q + x0 = X and S_r sin q + E_m = Y, over all positions.
        let circle = roll.iter().flat_map(|axes| {
            let (sin, cos) = axes.head_rad.sin_cos();
            [([cos, 1.0, 0.0], axes.slides_mm.x), ([sin, 0.0, 1.0], axes.slides_mm.y)]
        });
        let [radial_setting_mm, middle_mm, blank_offset_mm] = solve(circle)?;
        let law = roll.iter().map(|axes| {
            let by = axes.head_rad - cradle_angle_rad;
            ([1.0, by, by * by, by * by * by], axes.work_rad)
        });
        let [_, ratio, second, third] = solve(law)?;
        let swing_rad = roll.iter().map(|axes| axes.swing_rad).sum::<f64>() / roll.len() as f64;
        let z_mm = roll.iter().map(|axes| axes.slides_mm.z).sum::<f64>() / roll.len() as f64;
        let (sin, cos) = swing_rad.sin_cos();
        let out_mm = (z_mm - sliding_base_mm) / sin;
        let settings = CradleSettings {
            radial_setting_mm,
            cradle_angle_rad,
            blank_offset_mm,
            cross_shift_mm: middle_mm - out_mm * cos,
            sliding_base_mm,
            center_to_back_mm: self.mounting_mm - out_mm,
            root_angle_rad: swing_rad,
            tilt: Tilt::default(),
            roll: Roll {
                ratio,
                second_order_per_rad: -second / ratio,
                third_order_per_rad2: -third / ratio,
                ratio_error: 0.0,
            },
        };
        let off = |axes: &SixAxes| self.axes_of_cradle(&settings, axes.head_rad).slides_mm.distance(axes.slides_mm);
        let off_mm = roll.iter().map(off).fold(0.0, f64::max);
        Ok((CradleSettings { tilt, ..settings }, off_mm))
    }
}

/// Whole turns that bring an angle next to another one, rad.
fn nearest_turn(to_rad: f64, from_rad: f64) -> f64 {
    TAU * ((to_rad - from_rad) / TAU).round()
}
