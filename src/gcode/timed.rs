//! Programs of axes that run along straight lines over time: how they are read, whatever the axes are.
//!
//! In: the text, the axes of the machine in their order, and positions that stand before the first block. Out: knots,
//! the moments at which blocks end. Law: `G0` to the first position, then `G1` in `G93`, where F is the reciprocal of a
//! block's time in minutes. Only what is known is read; everything else is refused by line and word.

use super::statement::{Grammar, Move, Statement, statements};
use crate::machine::Axis;

/// Moments that differ by less are one: what nine digits of F leave of an hour.
const SAME_MOMENT_S: f64 = 1e-6;

/// Axes at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedKnot<const N: usize> {
    /// Time from the first knot, s.
    pub time_s: f64,
    /// Where the axes stand, mm or rad, in the machine's order.
    pub axes: [f64; N],
}

/// A program: straight lines between knots in order of time, the first at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedProgram<const N: usize> {
    /// At least one.
    pub knots: Vec<TimedKnot<N>>,
}

impl<const N: usize> TimedProgram<N> {
    /// Where the axes stand at a time; before the first and after the last knot the motion is continued.
    pub fn at(&self, time_s: f64) -> [f64; N] {
        let after = self.block_ending_after(|knot| knot.time_s <= time_s);
        self.knots.get(after).map_or(self.knots[0].axes, |b| self.knots[after - 1].between(b, time_s))
    }

    /// Speeds of the axes in the block that is run at a time, per s.
    pub fn speeds(&self, time_s: f64) -> [f64; N] {
        let after = self.block_ending_after(|knot| knot.time_s <= time_s);
        let Some(b) = self.knots.get(after) else { return [0.0; N] };
        let a = &self.knots[after - 1];
        std::array::from_fn(|axis| (b.axes[axis] - a.axes[axis]) / (b.time_s - a.time_s))
    }

    /// Knots from one moment to another, those that the digits of F leave beside its ends among them.
    pub fn knots_between(&self, [from_s, to_s]: [f64; 2]) -> &[TimedKnot<N>] {
        let first = self.knots.partition_point(|knot| knot.time_s < from_s - SAME_MOMENT_S);
        let end = self.knots.partition_point(|knot| knot.time_s <= to_s + SAME_MOMENT_S);
        &self.knots[first..end]
    }

    /// Time of the last knot, s.
    pub fn end_s(&self) -> f64 {
        self.knots[self.knots.len() - 1].time_s
    }

    /// When an axis that never rests or turns back stands at a place.
    pub fn time_at(&self, axis: usize, place: f64) -> f64 {
        let after = self.block_ending_after(|knot| knot.axes[axis] <= place);
        let Some(b) = self.knots.get(after) else { return 0.0 };
        let a = &self.knots[after - 1];
        a.time_s + (b.time_s - a.time_s) * (place - a.axes[axis]) / (b.axes[axis] - a.axes[axis])
    }

    /// Number of the knot that ends the block after those that lie before; that of a block in any case.
    fn block_ending_after(&self, before: impl Fn(&TimedKnot<N>) -> bool) -> usize {
        self.knots.partition_point(before).clamp(1, self.knots.len().max(2) - 1)
    }
}

impl<const N: usize> TimedKnot<N> {
    /// Axes at a time on the straight line from this knot to another.
    pub fn between(&self, other: &Self, time_s: f64) -> [f64; N] {
        let lasts_s = other.time_s - self.time_s;
        let share = if lasts_s > 0.0 { (time_s - self.time_s) / lasts_s } else { 0.0 };
        std::array::from_fn(|axis| self.axes[axis] + share * (other.axes[axis] - self.axes[axis]))
    }
}

/// Knots of a program in this dialect: `G0` to the start, `G1` in `G93` with `F` in every block, `G21`, `G90`, `G94`,
/// `M2`, `M30`, `N`, words of the axes, comments. `standing` holds positions, in mm or deg, of axes that a program may
/// leave out.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read_timed<const N: usize>(
    text: &str,
    axes: &[Axis; N],
    standing: [Option<f64>; N],
) -> Result<Vec<TimedKnot<N>>, String> {
    let names = axes.map(|axis| axis.letter.to_string()).join(", ");
    let grammar = Grammar { axes: axes.map(|axis| (axis.letter, axis.kind)), names: &names, ram: false, arcs: false };
    let mut reader = Reader { axes, position: standing, knots: Vec::new() };
    let (lines, ended) = statements(text, &grammar, |statement| reader.take(statement))?;
    ended?;
    if reader.knots.is_empty() {
        return Err(format!("line {lines}: no axis has moved"));
    }
    Ok(reader.knots)
}

/// What the blocks so far have done.
struct Reader<'a, const N: usize> {
    axes: &'a [Axis; N],
    /// In mm and deg.
    position: [Option<f64>; N],
    knots: Vec<TimedKnot<N>>,
}

impl<const N: usize> Reader<'_, N> {
    fn take(&mut self, statement: Statement<N>) -> Result<(), String> {
        let Some((motion, target)) = statement.travel else { return Ok(()) };
        for (axis, value) in self.position.iter_mut().zip(target) {
            *axis = value.or(*axis);
        }
        if let Some(axis) = self.position.iter().position(Option::is_none) {
            return Err(format!("axes move before axis {} has a position", self.axes[axis].letter));
        }
        let axes = std::array::from_fn(|axis| self.axes[axis].kind.read(self.position[axis].unwrap_or_default()));
        let time_s = match (motion, self.knots.last()) {
            (Move::Rapid, None) => 0.0,
            (Move::Rapid, Some(_)) => return Err("word `G0`: rapid travel after the start; use G1 with G93".to_owned()),
            (Move::Straight, None) => {
                return Err("the program does not begin with G0 to its first position".to_owned());
            }
            (Move::Straight, Some(_)) if !statement.inverse_time => {
                return Err("axes move without G93: the time of the block is not known".to_owned());
            }
            (Move::Straight, Some(last)) => match statement.feed {
                Some(per_minute) => last.time_s + 60.0 / per_minute,
                None => return Err("word `F` is missing: in G93 every block needs its own".to_owned()),
            },
        };
        self.knots.push(TimedKnot { time_s, axes });
        Ok(())
    }
}
