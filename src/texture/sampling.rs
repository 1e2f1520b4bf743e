//! How finely a window is sampled whose scene leaves that open.
//!
//! In: a window at the spacing of the flank's own dexels, cut. Out: one with more points in a direction in which marks
//! follow each other with fewer than [`ENOUGH_POINTS`] points each, or none where they have enough. Law: the points of
//! marks are counted on two lines through the middle of the window, one along the profile and one along the tooth; the
//! step shrinks by what is missing and the line is cut anew, until it is enough.
//!
//! A window that would then have too many points, or points much finer than the flank's dexels (a draft, coarse by
//! intention), stays as it is, and a note tells what its slopes are worth ([`super::WindowTexture::notes`]).
//!
//! Road not taken: the length of marks from feed and curvature. Every process has its own law for it, and where passes
//! of several teeth cross, none in closed form.

use super::window::Window;
use super::{ENOUGH_POINTS, facets, middle_line};
use crate::job::GearJob;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::Layer;
use gearcut_core::error::Result;

/// Points of a window that was made finer: some 50 MB while it is evaluated, on every core.
const MOST_POINTS: usize = 500_000;
/// How much finer than the flank's dexels at most: 2.4 points of a mark, the fewest that a scene that ships has, become
/// enough.
const MOST_TIMES_FINER: f64 = 10.0;
/// The step becomes so much smaller than what is missing says: marks differ along a line.
const ROOM: f64 = 1.1;
/// Times that marks are counted: where they are shorter than points are apart, the first count is too high.
const ATTEMPTS: usize = 3;

/// A finer window than the one that left these layers, if it needs one.
///
/// # Errors
/// Geometry and the backend.
pub(super) fn finer(
    job: &dyn GearJob,
    backend: &dyn Backend,
    window: &Window,
    layers: &[Layer],
) -> Result<Option<Window>> {
    let mut sampled = None;
    for direction in [0, 1] {
        if !window.open_step[direction] {
            continue;
        }
        let finest_mm = window.spacing_mm()[direction] / MOST_TIMES_FINER;
        let mut finer = sampled.as_ref().unwrap_or(window).clone();
        for attempt in 0..ATTEMPTS {
            let as_cut = attempt == 0 && sampled.is_none();
            let line = if as_cut {
                middle_line(&layers[window.operation], finer.count, direction)
            } else {
                cut_line(job, backend, &finer, direction)?
            };
            let follow = direction == 1 || job.marks_follow_along_tooth(window.operation);
            let points = if follow { facets(&line).1 } else { None };
            let Some(points) = points else { break };
            if points >= ENOUGH_POINTS {
                if !as_cut {
                    sampled = Some(finer);
                }
                break;
            }
            let step_mm = finer.spacing_mm()[direction] * points / (ROOM * ENOUGH_POINTS);
            finer = finer.with_step(direction, step_mm);
            if step_mm < finest_mm || finer.count[0] * finer.count[1] > MOST_POINTS {
                break;
            }
        }
    }
    Ok(sampled)
}

/// Passes along the middle line of a window, cut alone.
fn cut_line(job: &dyn GearJob, backend: &dyn Backend, window: &Window, direction: usize) -> Result<Vec<u32>> {
    let (mut arcs_mm, mut rows_z_mm): (Vec<f64>, Vec<f64>) = (window.arcs_mm().collect(), window.rows_z_mm());
    if direction == 0 {
        arcs_mm = vec![arcs_mm[arcs_mm.len() / 2]];
    } else {
        rows_z_mm = vec![rows_z_mm[rows_z_mm.len() / 2]];
    }
    let mut layers = job.cut_flank(backend, window.tooth, window.side, &arcs_mm, &rows_z_mm)?;
    Ok(layers.swap_remove(window.operation).passes)
}
