//! What the axes have to do where they draw the cutter back themselves: findings, terminal, chart.
//!
//! In: an operation whose retraction is in the axes, its motion. Nothing of this is said where the machine's own relief
//! draws back: then the axes have nothing to do with it.

use super::OperationAxes;
use super::strokes::StrokeRow;
use crate::findings::{Notice, Place, QuantityRow, Section};
use crate::machine::Order;
use crate::number_text::significant;
use crate::output::line_chart::Panel;
use crate::output::text::Sheet;
use crate::process::shaping::PreparedOperation;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::motion::returns::motion::RetractionMotion;
use crate::process::shaping::notices::{ReturnNoDirection, ReturnNoTime, ReturnSlow};
use crate::process::shaping::quantities::axes::{
    ADDED_TIME, BACK_OFF, LARGEST_TILT, NO_LIMITS, NO_TIME, RETRACTION, RETRACTION_ACCELERATION, RETRACTION_SPEED,
    SLOWDOWN, SMALLEST_TILT, STROKES_IN_TIME, TILT, TIME_OUTSIDE, TRAVEL, TURNED_STROKES,
};
use crate::process::shaping::quantities::returns::DIRECTION;
use crate::steps::axes::charts::panel;
use crate::steps::axes::{AxesOfOperation as _, STEADY};

/// Travel of every axis over the strokes.
pub(super) fn panels(rows: &[StrokeRow]) -> Vec<Panel> {
    let travel = |axis: usize| {
        let kind = AXES[axis].kind;
        let points = rows.iter().map(|row| {
            let moved = row.returning.map_or(0.0, |there| there[axis] - row.motion[axis].position);
            // An axis that moves evenly shows as a straight line, not as the noise of its last digits.
            (row.motion[0].position.to_degrees(), (kind.shown(moved) / STEADY).round() * STEADY)
        });
        panel([AXES[axis].name, kind.sign(Order::Position)], vec![(AXES[axis].name, points.collect())], [])
    };
    (0..AXES.len()).map(travel).collect()
}

/// What the retraction asks of the axes.
pub(super) fn findings(operation: &PreparedOperation, motion: &RetractionMotion) -> Section {
    let (plan, schedule) = (&operation.retraction, &operation.schedule);
    let mut entries = vec![
        DIRECTION.of(plan.asked().words()),
        BACK_OFF.of(plan.back_off_mm()),
        TURNED_STROKES.of(motion.turned_strokes),
    ];
    if let Some([low, high]) = plan.tilts_rad() {
        entries.extend([
            TILT.of(0.5 * (low + high).to_degrees()),
            SMALLEST_TILT.of(low.to_degrees()),
            LARGEST_TILT.of(high.to_degrees()),
        ]);
    }
    for (axis, added) in AXES.iter().zip(&motion.axes) {
        let of = |row: &QuantityRow, order: Order, value: f64| {
            let value = value.is_finite().then(|| axis.kind.shown(value));
            let entry = row.of_or(value, NO_TIME).at(Place::default().and("stroke", added.stroke as u64));
            let key = format!("{}_{}", axis.stem, row.key);
            entry.titled(key.replace('_', " ")).keyed(key).in_unit(axis.kind.unit(order))
        };
        entries.extend([
            of(&TRAVEL, Order::Position, added.travel),
            of(&RETRACTION_SPEED, Order::Speed, added.speed),
            of(&RETRACTION_ACCELERATION, Order::Acceleration, added.acceleration),
        ]);
    }
    let why = if motion.time_s > 0.0 { NO_LIMITS } else { NO_TIME };
    let slowdown = motion.slowdown().filter(|factor| factor.is_finite());
    let total_s = schedule.time_s(schedule.count() as f64);
    entries.extend([
        TIME_OUTSIDE.of(motion.time_s),
        SLOWDOWN.of_or(slowdown, why),
        STROKES_IN_TIME.of_or(slowdown.map(|factor| schedule.double_strokes_per_minute() / factor), why),
        ADDED_TIME.of_or(slowdown.map(|factor| (factor - 1.0) * total_s), why),
    ]);
    RETRACTION.section(entries)
}

/// Lines for the terminal.
pub(super) fn print(axes: &OperationAxes, motion: &RetractionMotion, sheet: &mut Sheet) {
    let plan = &axes.operation().retraction;
    let mut words = plan.asked().words().to_owned();
    if let Some([low, high]) = plan.tilts_rad() {
        let [low, high] = [low, high].map(f64::to_degrees);
        words = format!("{words} by {:.1} deg; {low:.1} to {high:.1} deg clear", 0.5 * (low + high));
    }
    if motion.turned_strokes > 0 {
        words =
            format!("{words}; turned after {} of {} strokes", motion.turned_strokes, axes.operation().schedule.count());
    }
    sheet.line("retraction", words);
    let travel = AXES.iter().zip(&motion.axes).map(|(axis, added)| {
        format!("{} {} {}", axis.letter, significant(axis.kind.shown(added.travel), 3), axis.kind.unit(Order::Position))
    });
    let time = format!("in {} ms", significant(1e3 * motion.time_s, 3));
    sheet.line("axes travel", format!("{} {time}", travel.collect::<Vec<_>>().join(", ")));
    let cost = match motion.slowdown() {
        Some(factor) if factor.is_finite() && factor > 1.0 => {
            let most = axes.operation().schedule.double_strokes_per_minute() / factor;
            format!("double strokes last {factor:.2} times as long: at most {most:.0} per minute")
        }
        Some(factor) if factor.is_finite() => "none: the ram is outside the face for long enough".to_owned(),
        Some(_) => NO_TIME.to_owned(),
        None => format!("not known: {NO_LIMITS}"),
    };
    sheet.line("cost", cost);
}

/// What the user should know: the axes are too slow, or no tilt clears.
pub(super) fn warnings(axes: &OperationAxes, motion: &RetractionMotion) -> Vec<Notice> {
    let (operation, mut warnings) = (axes.name(), Vec::new());
    if motion.time_s <= 0.0 {
        warnings.push(ReturnNoTime { operation, why: NO_TIME }.notice());
    } else if let Some(factor) = motion.slowdown().filter(|factor| *factor > 1.0) {
        let most_per_minute = axes.operation().schedule.double_strokes_per_minute() / factor;
        let slow = ReturnSlow {
            operation,
            needed_ms: significant(1e3 * motion.needed_s.unwrap_or_default(), 3),
            free_ms: significant(1e3 * motion.time_s, 3),
            most_per_minute: format!("{most_per_minute:.0}"),
        };
        warnings.push(slow.notice());
    }
    if let Some(tilts_rad) = axes.operation().retraction.tilts_rad().filter(|[low, high]| low > high) {
        let [above_deg, below_deg] = tilts_rad.map(|rad| format!("{:.1}", rad.to_degrees()));
        warnings.push(ReturnNoDirection { operation, above_deg, below_deg }.notice());
    }
    warnings
}
