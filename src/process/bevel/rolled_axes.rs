//! The linked axes as series in the cradle angle.

use crate::machine::{Axis, AxisKind};
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::bevel::five_axis::FiveAxisMachine;
use gearcut_core::math::Jet;

/// The linked axes.
pub const AXES: [Axis; 5] = [
    Axis::new("X", "x", 'X', AxisKind::Linear).called("X axis"),
    Axis::new("Y", "y", 'Y', AxisKind::Linear).called("Y axis"),
    Axis::new("Z", "z", 'Z', AxisKind::Linear).called("Z axis"),
    Axis::new("A work spindle", "work", 'A', AxisKind::Rotary).called("work spindle"),
    Axis::new("B swing", "swing", 'B', AxisKind::Rotary).called("swing axis"),
];

/// X, Y, Z, A and B at a cradle angle with two derivatives with respect to it, mm and rad: those of a circle and of the
/// roll's polynomial.
pub fn rolled_axes(machine: FiveAxisMachine, settings: &CradleSettings, cradle_rad: f64) -> [Jet<3>; 5] {
    let axes = machine.axes_of_cradle(settings, cradle_rad);
    let [x, y, z] = axes.slides_mm.to_array();
    let (sin, cos) = cradle_rad.sin_cos();
    let s = settings.radial_setting_mm;
    let roll = settings.roll;
    let by = cradle_rad - settings.cradle_angle_rad;
    let bend = -roll.ratio * (2.0 * roll.second_order_per_rad + 6.0 * roll.third_order_per_rad2 * by);
    [
        Jet::from_derivatives([x, -s * sin, -s * cos]),
        Jet::from_derivatives([y, s * cos, -s * sin]),
        Jet::constant(z),
        Jet::from_derivatives([axes.work_rad, settings.work_angle(cradle_rad)[1], bend]),
        Jet::constant(axes.swing_rad),
    ]
}
