//! Axes in programs: words of positions, and sentences where straight lines ask too much.

use crate::machine::{Axis, Limits, Order};

/// The word that sends an axis to a position, rad or mm, with so many digits after the point.
pub fn axis_word(axis: &Axis, position: f64, digits: usize) -> String {
    let shown = axis.kind.shown(position);
    // Negated zeros read as nonsense.
    let shown = if shown == 0.0 { 0.0 } else { shown };
    format!("{}{shown:.digits$}", axis.letter)
}

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
