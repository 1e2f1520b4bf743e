//! How finely a window is sampled whose scene leaves that open, and what its marks then are.
//!
//! In: a window at the spacing of the flank's own dexels, nothing cut. Out: a [`SampledWindow`]: the same with more
//! points in a direction in which marks follow each other with fewer than [`ENOUGH_POINTS`] points each, and the marks
//! and points that are counted in it. Law: marks are counted on two lines through the middle of the window, one along
//! the profile and one along the tooth, cut natively whatever the backend; the step shrinks by what is missing and the
//! line is cut anew, until it is enough. Two lines take milliseconds, so that what they say of a window's numbers is
//! known before anything else is cut ([`super::foreseen`]).
//!
//! A window that would then have too many points becomes shorter about its middle: some 35 marks each way are enough
//! for every parameter. Where the scene names its lengths, or points would be much finer than the flank's dexels (a
//! draft, coarse by intention), it stays as it is, and a note says what its slopes are worth.
//!
//! Road not taken: the length of marks from feed and curvature. Every process has its own law for it, and where passes
//! of several teeth cross, none in closed form.

use super::ENOUGH_POINTS;
use super::window::Window;
use crate::job::GearJob;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// Points of a window that was made finer: some 50 MB while it is evaluated, on every core.
const MOST_POINTS: usize = 500_000;
/// How much finer than the flank's dexels at most: the 1.5 points of a mark that the gashes of a helical gear get along
/// the tooth become enough.
const MOST_TIMES_FINER: f64 = 16.0;
/// The step becomes so much smaller than what is missing says: marks differ along a line.
const ROOM: f64 = 1.1;
/// Times that marks are counted: where they are shorter than points are apart, the first counts are too high.
const ATTEMPTS: usize = 4;

/// Marks of a window's operation on its middle lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LineMarks {
    /// Marks that follow each other along the tooth and along the profile; 0 where they run on without end, or there
    /// are none.
    pub(super) count: [usize; 2],
    /// Points of a whole mark; none where there is no whole one.
    pub(super) points: [Option<f64>; 2],
}

/// A window with its points as they are cut, and what is known of its marks.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledWindow {
    /// The window.
    pub window: Window,
    /// Its marks.
    pub(super) marks: LineMarks,
}

/// Windows of a job, as from [`super::windows()`], sampled as finely as their marks ask for.
///
/// # Errors
/// Geometry.
pub fn sampled(job: &dyn GearJob, windows: &[Window]) -> Result<Vec<SampledWindow>> {
    windows.par_iter().map(|window| sampled_one(job, window)).collect()
}

/// The same for one window.
///
/// # Errors
/// Geometry.
pub(super) fn sampled_one(job: &dyn GearJob, window: &Window) -> Result<SampledWindow> {
    let mut found = window.clone();
    let mut lines = [facets_along(job, &found, 0)?, facets_along(job, &found, 1)?];
    for direction in [0, 1] {
        if window.open_step[direction]
            && let Some((finer, facets)) = finer(job, &found, direction, lines[direction].1)?
        {
            let other = 1 - direction;
            lines[direction] = facets;
            lines[other] = facets_along(job, &finer, other)?;
            found = finer;
        }
    }
    let marks = LineMarks { count: lines.map(|line| line.0), points: lines.map(|line| line.1) };
    Ok(SampledWindow { window: found, marks })
}

/// A window with points closer together in a direction, if its marks, which have so many points as it is, need that and
/// may have it, with its facets along that direction.
fn finer(
    job: &dyn GearJob,
    window: &Window,
    direction: usize,
    points: Option<f64>,
) -> Result<Option<(Window, Facets)>> {
    let fields = job.scene().fields;
    let dexels_mm = [fields.lead_spacing_mm, fields.profile_spacing_mm][direction];
    let finest_mm = window.spacing_mm()[direction].min(dexels_mm) / MOST_TIMES_FINER;
    let mut finer = window.clone();
    let mut facets = (0, points);
    for attempt in 0..ATTEMPTS {
        let Some(few) = facets.1 else { break };
        if few >= ENOUGH_POINTS {
            return Ok((attempt > 0).then_some((finer, facets)));
        }
        let step_mm = finer.spacing_mm()[direction] * few / (ROOM * ENOUGH_POINTS);
        finer = finer.with_step(direction, step_mm).narrowed(MOST_POINTS);
        if attempt + 1 == ATTEMPTS || step_mm < finest_mm || finer.count[0] * finer.count[1] > MOST_POINTS {
            break;
        }
        facets = facets_along(job, &finer, direction)?;
    }
    Ok(None)
}

/// Facets along a line, and the points of a whole one: none where marks run along it without end.
type Facets = (usize, Option<f64>);

/// Facets along the middle line of a window, the line along the tooth (0) or along the profile (1).
fn facets_along(job: &dyn GearJob, window: &Window, direction: usize) -> Result<Facets> {
    let (mut arcs_mm, mut rows_z_mm): (Vec<f64>, Vec<f64>) = (window.arcs_mm().collect(), window.rows_z_mm());
    if !job.marks_follow(window.operation)[direction] {
        return Ok((0, None));
    }
    if direction == 0 {
        arcs_mm = vec![arcs_mm[arcs_mm.len() / 2]];
    } else {
        rows_z_mm = vec![rows_z_mm[rows_z_mm.len() / 2]];
    }
    let layers = job.cut_flank(&Cpu::default(), window.tooth, window.side, &arcs_mm, &rows_z_mm)?;
    Ok(facets(&layers[window.operation].passes))
}

/// Facets along a line, one more than the changes of the pass that left it, and the points of a whole one: parts of
/// marks at both ends are not counted.
fn facets(passes: &[u32]) -> Facets {
    let edges: Vec<usize> = (1..passes.len()).filter(|&i| passes[i] != passes[i - 1]).collect();
    let points = match edges.as_slice() {
        [first, .., last] => Some((last - first) as f64 / (edges.len() - 1) as f64),
        _ => None,
    };
    (edges.len() + 1, points)
}

#[cfg(test)]
mod tests {
    use super::facets;

    #[test]
    fn points_are_those_of_whole_marks() {
        assert_eq!(facets(&[7, 7, 7]), (1, None));
        assert_eq!(facets(&[7, 8, 8]), (2, None));
        // Half a mark, marks of 4 and 2 points, half a mark: 3 points each, not 10 over 4.
        assert_eq!(facets(&[1, 1, 2, 2, 2, 2, 3, 3, 4, 4]), (4, Some(3.0)));
    }
}
