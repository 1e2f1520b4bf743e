//! Axes in programs: sentences where straight lines ask too much.

use crate::machine::{Axis, Limits, Order};

/// A sentence for each limit of an axis that a program exceeds; its largest speed and acceleration in rad or mm, per s
/// and s^2.
pub fn beyond_limits(axis: &Axis, limits: &Limits, [speed, acceleration]: [f64; 2]) -> Vec<String> {
    let asked = [(Order::Speed, speed), (Order::Acceleration, acceleration)];
    let beyond = asked.into_iter().filter_map(|(order, asked)| {
        let limit = limits.of(order).filter(|&limit| asked > limit)?;
        let [asked, limit] = [asked, limit].map(|value| axis.kind.shown(value));
        let unit = axis.kind.unit(order);
        Some(format!("the {} needs {asked:.4} {unit}, the machine allows {limit:.4}", axis.noun))
    });
    beyond.collect()
}
