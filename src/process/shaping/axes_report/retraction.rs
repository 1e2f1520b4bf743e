//! What the axes have to do where they draw the cutter back themselves: findings, terminal, chart.
//!
//! In: an operation whose retraction is in the axes, its motion. Nothing of this is said where the machine's own relief
//! draws back: then the axes have nothing to do with it.

use super::OperationAxes;
use super::strokes::StrokeRow;
use crate::findings::{Notice, Place, Quantity, Section};
use crate::machine::Order;
use crate::output::line_chart::Panel;
use crate::output::text::{Sheet, significant};
use crate::process::shaping::PreparedOperation;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::notices::{ReturnNoDirection, ReturnNoTime, ReturnSlow};
use crate::process::shaping::returns::motion::RetractionMotion;
use crate::steps::axes::charts::panel;
use crate::steps::axes::{AxesOfOperation as _, STEADY};

/// Why there is no cost.
const NO_LIMITS: &str = "machine.limits says nothing of the axes' speeds and accelerations";
const NO_TIME: &str = "the ram does not leave the face at both ends: machine.approach_mm or machine.overrun_mm is zero";

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
    let mut section = Section::new("retraction", "Retraction by the axes")
        .with("direction", Quantity::text(plan.asked().words(), "how the cutter is drawn back for the return stroke"))
        .with("back_off", Quantity::number(plan.back_off_mm(), "mm", "how far the cutter's axis is drawn back"))
        .with(
            "turned_strokes",
            Quantity::count(
                motion.turned_strokes as u64,
                "strokes",
                "strokes after which the cutter is turned as well",
            ),
        );
    if let Some([low, high]) = plan.tilts_rad() {
        let tilt = "angle from the normal of the pitch curve to the retraction, in the direction of growing phi";
        section = section
            .with("tilt", Quantity::number(0.5 * (low + high).to_degrees(), "deg", tilt))
            .with("smallest_tilt", Quantity::number(low.to_degrees(), "deg", "smallest such angle that clears"))
            .with("largest_tilt", Quantity::number(high.to_degrees(), "deg", "largest such angle that clears"));
    }
    for (axis, added) in AXES.iter().zip(&motion.axes) {
        let at = Place::default().and("stroke", added.stroke as u64);
        let of = |order: Order, value: f64, what: &str| {
            let definition = format!("{what} of the {} for the retraction, from rest to rest", axis.name);
            let value = value.is_finite().then(|| axis.kind.shown(value));
            Quantity::number_or(value, axis.kind.unit(order), definition, NO_TIME).at(at.clone())
        };
        section = section
            .with(&format!("{}_travel", axis.stem), of(Order::Position, added.travel, "largest travel"))
            .with(&format!("{}_speed", axis.stem), of(Order::Speed, added.speed, "largest speed"))
            .with(
                &format!("{}_acceleration", axis.stem),
                of(Order::Acceleration, added.acceleration, "largest acceleration"),
            );
    }
    let definition = "factor by which double strokes have to last longer so that the axes keep their limits";
    let lost = "time that this adds to the operation";
    let why = if motion.time_s > 0.0 { NO_LIMITS } else { NO_TIME };
    let slowdown = motion.slowdown().filter(|factor| factor.is_finite());
    let total_s = schedule.time_s(schedule.count() as f64);
    let per_minute = slowdown.map(|factor| schedule.double_strokes_per_minute() / factor);
    section
        .with(
            "time_outside_face",
            Quantity::number(motion.time_s, "s", "time of the ram outside the face, shorter end"),
        )
        .with("slowdown", Quantity::number_or(slowdown, "1", definition, why))
        .with("strokes_per_minute", Quantity::number_or(per_minute, "1/min", "double strokes that leave the time", why))
        .with("added_time", Quantity::number_or(slowdown.map(|factor| (factor - 1.0) * total_s), "s", lost, why))
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
