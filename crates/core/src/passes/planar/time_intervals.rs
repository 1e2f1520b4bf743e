//! Near passes as trees over time, so that one look culls a whole time interval of strokes.
//!
//! A time interval is a run of near passes of one blade, one after the other in time. It is looked at in one pose, with
//! the distance that any of its strokes, in any phase, moves a point of the field in the blade's frame away from that
//! pose: measured, so nothing is assumed about the motion, but strokes that follow each other move little. Halves of a
//! time interval are time intervals again, down to single passes. Of N passes near a flank a tile looks at a few times
//! log N instead of all N.

use super::bounds::MotionBound;
use super::near::NearPass;
use crate::frame::Rigid2;
use glam::DVec2;
use std::ops::Range;

/// A run of near passes of one blade.
#[derive(Debug, Clone)]
pub struct TimeInterval {
    /// The blade.
    pub blade: u32,
    /// The pose looked at: the work in the blade's frame.
    pub blade_from_work: Rigid2,
    /// What the poses of the run differ from it.
    pub motion_bound: MotionBound,
    /// What it is made of.
    pub content: Content,
}

/// Content of a time interval.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Content {
    /// One near pass, by its index.
    Pass(usize),
    /// Two halves, by their index in the tree.
    Halves([usize; 2]),
}

/// All near passes of a field as time intervals, one tree for each blade.
#[derive(Debug, Clone, Default)]
pub struct IntervalTree {
    /// Intervals; halves come after the whole.
    pub intervals: Vec<TimeInterval>,
    /// Whole intervals, one for each blade that comes near.
    pub roots: Vec<usize>,
}

impl IntervalTree {
    /// Tree over the near passes of a field that lies within `reach_mm` of `center_mm`.
    pub fn new(near: &[NearPass], center_mm: DVec2, reach_mm: f64) -> Self {
        let mut order: Vec<usize> = (0..near.len()).collect();
        // Stable: strokes of one blade stay in time order.
        order.sort_by_key(|&pass| near[pass].blade);
        let mut tree = Self::default();
        let region = Surroundings { near, center_mm, reach_mm };
        for run in order.chunk_by(|&a, &b| near[a].blade == near[b].blade) {
            let root = tree.grow(&region, run, 0..run.len());
            tree.roots.push(root);
        }
        tree
    }

    fn grow(&mut self, region: &Surroundings, run: &[usize], part: Range<usize>) -> usize {
        let index = self.intervals.len();
        let middle = part.start + part.len() / 2;
        let NearPass { blade, .. } = region.near[run[middle]];
        let blade_from_work = *region.near[run[middle]].middle();
        let motion_bound = region.motion_bound(&blade_from_work, &run[part.clone()]);
        self.intervals.push(TimeInterval { blade, blade_from_work, motion_bound, content: Content::Pass(run[middle]) });
        if part.len() > 1 {
            let halves = [part.start..middle, middle..part.end].map(|half| self.grow(region, run, half));
            self.intervals[index].content = Content::Halves(halves);
        }
        index
    }
}

/// The field that the passes are near to.
struct Surroundings<'a> {
    near: &'a [NearPass],
    center_mm: DVec2,
    reach_mm: f64,
}

impl Surroundings<'_> {
    fn motion_bound(&self, pose: &Rigid2, passes: &[usize]) -> MotionBound {
        let center = pose.point(self.center_mm);
        let mut motion_bound = MotionBound::default();
        for pass in passes {
            let pass = &self.near[*pass];
            let bend_mm = pass.bend_mm(self.center_mm, self.reach_mm);
            for blade_from_work in pass.blade_from_work.iter() {
                let turn = (blade_from_work.rotation - pose.rotation).length();
                let shift_mm = blade_from_work.point(self.center_mm).distance(center);
                motion_bound.distance_mm = motion_bound.distance_mm.max(shift_mm + turn * self.reach_mm + bend_mm);
                // `turn` is the chord 2 sin(angle / 2); up to half a turn the angle is at most pi / 2 times as large.
                motion_bound.turn_rad = motion_bound.turn_rad.max(turn * std::f64::consts::FRAC_PI_2);
            }
        }
        motion_bound
    }
}
