//! Actual motion of a machine's axes.
//!
//! In: the commanded motion over time. Out: actual positions at any time. The lag of drives and the turning points of
//! backlash need the motion's past: they are worked out once, over cells of the whole [`Course`]. Everything else is
//! worked out where it is asked for.

use super::axis::{AxisErrors, GearboxCycle};
use super::backlash::Play;
use super::servo::{Lag, Rates, SpeedCell};
use crate::machine::AxisMotion;
use gearcut_core::math::roots::halve;
use rayon::prelude::*;

/// Speeds below this, rad/s or mm/s, are those of a drive at rest: rounding.
const RESTING: f64 = 1e-12;
/// Halvings of a cell in search of a turning point.
const HALVINGS: u32 = 60;
/// Just inside of a cell's end, as a share of the cell: what holds at a corner belongs to the next cell.
const INSIDE: f64 = 1e-9;

/// How long a motion lasts, and where it has corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// First moment that will be asked for, s.
    pub from_s: f64,
    /// Last one.
    pub to_s: f64,
    /// Times at which rates jump, s, in any order.
    pub corners_s: Vec<f64>,
    /// Cells over the whole of it, no hump of a speed narrower than some of them.
    pub cells: usize,
    /// Time from one knot of smooth noise to the next, s, where passes keep the motion as polynomials.
    pub noise_knots_s: Option<f64>,
}

/// When actual positions are asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineMoment<const N: usize> {
    /// Time of the commanded motion, s.
    pub time_s: f64,
    /// Time from the beginning of the first operation, s: what drifts follow.
    pub since_start_s: f64,
    /// How much later than that noise is asked for, s, while the commanded axes and all that hangs on the feed rest;
    /// below 0 before the moment at which they are taken.
    pub at_rest_s: f64,
    /// Which passage of the tool through the work, counted from the first operation on; 0 where the tool is in the work
    /// all the time.
    pub passage: i64,
    /// How far each axis has been indexed besides.
    pub indexed: [f64; N],
}

/// N axes as they really move.
#[derive(Debug, Clone)]
pub struct ActualMotion<const N: usize> {
    starts_s: Vec<f64>,
    axes: [ActualAxis; N],
    noise_knots_s: Option<f64>,
}

#[derive(Debug, Clone)]
struct ActualAxis {
    errors: AxisErrors,
    lag: Option<Lag>,
    play: Option<Play>,
}

impl<const N: usize> ActualMotion<N> {
    /// Actual motion behind a commanded one over time; `None` where no axis has errors.
    pub fn new(
        errors: &[AxisErrors; N],
        course: &Course,
        commanded: impl Fn(f64) -> [AxisMotion; N] + Sync,
    ) -> Option<Self> {
        if errors.iter().all(AxisErrors::is_none) {
            return None;
        }
        let remembers = |errors: &AxisErrors| errors.servo.is_some() || errors.backlash > 0.0;
        let bounds = if errors.iter().any(remembers) { course.bounds(errors) } else { Vec::new() };
        let starts_s: Vec<f64> = bounds.iter().map(|bounds| bounds[0]).collect();
        let ends: Vec<[[AxisMotion; N]; 2]> = bounds
            .par_iter()
            .map(|&[from, to]| {
                let inside = INSIDE * (to - from);
                [commanded(from + inside), commanded(to - inside)]
            })
            .collect();
        let axes = std::array::from_fn(|axis| {
            let errors = errors[axis].clone();
            if !remembers(&errors) {
                return ActualAxis { errors, lag: None, play: None };
            }
            let rates = |of: &[AxisMotion; N]| {
                let AxisMotion { velocity, acceleration, .. } = of[axis];
                Rates { velocity, acceleration }
            };
            let cells: Vec<SpeedCell> = bounds
                .iter()
                .zip(&ends)
                .map(|(&[from_s, to_s], [from, to])| SpeedCell::new(from_s, to_s, rates(from), rates(to)))
                .collect();
            let lag = errors.servo.map(|servo| Lag::new(servo, &cells));
            let play = (errors.backlash > 0.0).then(|| {
                let position = |time_s: f64| commanded(time_s)[axis].position;
                play(errors.backlash, &bounds, &cells, lag.as_ref(), position)
            });
            ActualAxis { errors, lag, play }
        });
        Some(Self { starts_s, axes, noise_knots_s: course.noise_knots_s })
    }

    /// Where the axes are at a moment; `commanded` gives where they should be at any time, indexing left out.
    pub fn positions(&self, moment: &MachineMoment<N>, commanded: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        let time_s = moment.time_s;
        let now = commanded(time_s);
        let cell = self.cell(time_s);
        std::array::from_fn(|index| {
            let errors = &self.axes[index].errors;
            let command = match errors.gearbox {
                Some(gearbox) => gearbox.command(time_s, |time_s| commanded(time_s)[index]),
                None => now[index],
            };
            let axis = self.driven(index, cell, time_s, command);
            let noise = errors.noise.iter().map(|noise| {
                let at_rest_s = if noise.law.goes_on_at_rest() { moment.at_rest_s } else { 0.0 };
                let since_start_s = moment.since_start_s + at_rest_s;
                match self.noise_knots_s {
                    None => noise.at(since_start_s, moment.passage),
                    Some(knots_s) => noise.smoothed_at(since_start_s, moment.passage, knots_s),
                }
            });
            errors.guided(axis + moment.indexed[index], moment.since_start_s) + noise.sum::<f64>()
        })
    }

    /// How far the work is turned against the tool at a time, rad, by what drives, gearbox and play hold both behind
    /// their commands: the work's own, less what it turns in the time by which the axes of the tool come late.
    pub fn turn_rad(
        &self,
        work: usize,
        tool: &[usize],
        time_s: f64,
        commanded: impl Fn(f64) -> [AxisMotion; N],
    ) -> f64 {
        let (now, cell) = (commanded(time_s), self.cell(time_s));
        let behind = |index: usize| {
            let command = match self.axes[index].errors.gearbox {
                // Steps of the commands are off to both sides.
                Some(gearbox) => {
                    GearboxCycle { increment: 0.0, ..gearbox }.command(time_s, |t| commanded(t)[index].position)
                }
                None => now[index].position,
            };
            now[index].position - self.driven(index, cell, time_s, command)
        };
        let square: f64 = tool.iter().map(|&index| now[index].velocity.powi(2)).sum();
        let along: f64 = tool.iter().map(|&index| behind(index) * now[index].velocity).sum();
        let late_s = if square > 0.0 { along / square } else { 0.0 };
        late_s * now[work].velocity - behind(work)
    }

    fn cell(&self, time_s: f64) -> usize {
        self.starts_s.partition_point(|&start_s| start_s <= time_s).max(1) - 1
    }

    /// Where an axis is by its drive and play alone, `command` in force.
    fn driven(&self, index: usize, cell: usize, time_s: f64, command: f64) -> f64 {
        let ActualAxis { lag, play, .. } = &self.axes[index];
        let behind = lag.as_ref().map_or(0.0, |lag| lag.in_cell(cell, time_s - self.starts_s[cell])[0]);
        let drive = command - behind;
        play.as_ref().map_or(drive, |play| play.axis(time_s, drive))
    }
}

impl Course {
    /// Ends of the cells, from so early that all drives have settled when the course begins.
    fn bounds(&self, errors: &[AxisErrors]) -> Vec<[f64; 2]> {
        let settling_s = errors.iter().filter_map(|of| of.servo).map(|servo| servo.settling_s()).fold(0.0, f64::max);
        let cell_s = (self.to_s - self.from_s) / self.cells.max(1) as f64;
        // Backlash needs a little of what is before.
        let from_s = self.from_s - settling_s.max(cell_s);
        let inside = self.corners_s.iter().copied().filter(|corner_s| (from_s..self.to_s).contains(corner_s));
        let mut corners: Vec<f64> = inside.chain([from_s, self.to_s]).collect();
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        let cells = |piece: &[f64]| {
            let (from, to) = (piece[0], piece[1]);
            let count = ((to - from) / cell_s).ceil().max(1.0);
            (0..count as usize).map(move |i| [i, i + 1].map(|i| from + (to - from) * i as f64 / count))
        };
        corners.windows(2).flat_map(cells).collect()
    }
}

/// Play of an axis whose drive follows its command with or without lag.
fn play(
    width: f64,
    bounds: &[[f64; 2]],
    cells: &[SpeedCell],
    lag: Option<&Lag>,
    position: impl Fn(f64) -> f64,
) -> Play {
    let behind = |cell: usize, time_s: f64| lag.map_or([0.0; 2], |lag| lag.in_cell(cell, time_s - bounds[cell][0]));
    let sign = |cell: usize, time_s: f64| {
        let speed = cells[cell].speed(time_s) - behind(cell, time_s)[1];
        if speed.abs() < RESTING { 0.0 } else { speed.signum() }
    };
    let at = |cell: usize, time_s: f64| (time_s, position(time_s) - behind(cell, time_s)[0]);
    let first = (0..bounds.len()).map(|cell| sign(cell, bounds[cell][0])).find(|&sign| sign != 0.0);
    let mut direction = first.unwrap_or(0.0);
    let start = direction;
    let mut turns = vec![at(0, bounds[0][0])];
    for (cell, &[from_s, to_s]) in bounds.iter().enumerate() {
        // A cell may hold two turns: its middle is looked at as well.
        let places = [from_s, 0.5 * (from_s + to_s), to_s];
        for (index, &time_s) in places.iter().enumerate() {
            let now = sign(cell, time_s);
            if now == 0.0 || now == direction {
                continue;
            }
            // The sign before it, or rest, holds up to the turn.
            let before_s = places[index.max(1) - 1];
            let [_, turn_s] = halve(|time_s| sign(cell, time_s) != now, before_s, time_s, HALVINGS);
            turns.push(at(cell, turn_s));
            direction = now;
        }
    }
    Play::new(width, start, turns)
}
