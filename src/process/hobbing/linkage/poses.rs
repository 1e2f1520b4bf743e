//! Poses of the hob in the work over time, and its motion.
//!
//! In: the axes of a linkage. Out: the tool frame and the head in the gear frame, with velocities; frames stand with
//! the linkage.

use super::geometry::{work_from_machine, work_from_machine_at};
use super::{HobbingAxes, HobbingLinkage};
use gearcut_core::frame::Rigid3;
use gearcut_core::math::Jet;
use glam::{DMat3, DVec3};

impl HobbingLinkage {
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

    /// The same at a time with the axes where they really are, in the order of [`super::dynamics::AXES`]: rad and mm.
    /// The linkage gives what is commanded.
    pub fn work_from_tool_at(
        &self,
        time_s: f64,
        [hob_rad, work_rad, x_mm, y_mm, slide_mm, shift_mm]: [f64; 6],
    ) -> Rigid3 {
        // Y carries the infeed: what it is off by is distance from full depth.
        let commanded = self.axes::<1>(time_s).y_mm.value();
        let machine_from_tool = self.geometry.machine_from_tool(hob_rad, y_mm - commanded, slide_mm, shift_mm);
        work_from_machine_at(work_rad, x_mm, commanded).after(&machine_from_tool)
    }

    /// Pose with velocity, gear frame.
    #[cfg(feature = "testing")]
    pub fn motion(&self, time_s: f64) -> gearcut_core::frame::RigidMotion3 {
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
        gearcut_core::frame::RigidMotion3 {
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
}
