//! Where an earlier operation cuts below the flanks that finishing is to leave, known before anything is cut.
//!
//! In: the envelopes of all operations ([`ShapingJob::envelope_flank`]). Out: for every operation that cuts too deep
//! its deepest place. Law: at the same heights over the pitch curve the point of the earlier envelope is off the
//! finished one by (p - q) n, n the finished flank's normal; negative is a gouge of the finished gear that no later
//! stroke mends.
//!
//! Road not taken: dexels of both. They know the strokes as well, but only once they are cut.

use crate::process::shaping::ShapingJob;
use crate::steps::flanks_of;
use gearcut_core::terms::Side;
use rayon::prelude::*;

/// Heights of a flank at which both envelopes are compared: stock varies slowly along a profile.
const HEIGHTS: u32 = 17;
/// Shallower cuts are rounding, mm.
const LEAST_MM: f64 = 1e-6;

/// An operation that cuts below the finished flanks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BelowFinished {
    /// Index of the operation.
    pub operation: usize,
    /// Flanks on which it does.
    pub flanks: usize,
    /// Largest depth along the finished flank's normal, mm.
    pub depth_mm: f64,
    /// Tooth that has it, from 1.
    pub tooth: u32,
    /// Flank that has it.
    pub side: Side,
    /// Its height over the pitch curve, mm.
    pub height_mm: f64,
}

/// Operations before the last that cut below what it leaves, in order. Where the pitch curve repeats after a number of
/// teeth, so do the envelopes, and only the teeth of one period are looked at: on a circle one.
pub fn below_finished(job: &ShapingJob) -> Vec<BelowFinished> {
    (0..job.operations.len() - 1).filter_map(|operation| of_operation(job, operation)).collect()
}

fn of_operation(job: &ShapingJob, operation: usize) -> Option<BelowFinished> {
    let teeth = job.scene.gear.teeth;
    let period = job.curve.period_teeth(teeth);
    let flanks: Vec<_> = flanks_of(job)
        .into_par_iter()
        .filter(|(tooth, _)| *tooth <= period)
        .filter_map(|(tooth, side)| {
            let [depth_mm, height_mm] = deepest_mm(job, operation, tooth, side)?;
            (depth_mm > LEAST_MM).then_some((tooth, side, depth_mm, height_mm))
        })
        .collect();
    let &(tooth, side, depth_mm, height_mm) = flanks.iter().max_by(|a, b| a.2.total_cmp(&b.2))?;
    Some(BelowFinished {
        operation,
        flanks: flanks.len() * (teeth / period) as usize,
        depth_mm,
        tooth,
        side,
        height_mm,
    })
}

/// Largest depth on a flank and its height over the pitch curve, mm; none where the operation generates no flank there.
fn deepest_mm(job: &ShapingJob, operation: usize, tooth: u32, side: Side) -> Option<[f64; 2]> {
    let finished = job.target_flank(tooth, side);
    let earlier = job.envelope_flank(operation, tooth, side)?;
    let height_mm = |arc_mm: f64| {
        let contact = finished.at_arc(arc_mm);
        job.blank.height(contact.point_mm, contact.phi_rad).0
    };
    let (low_mm, high_mm) = (height_mm(0.0), height_mm(finished.length_mm()));
    (0..HEIGHTS)
        .filter_map(|i| {
            let at_mm = low_mm + (high_mm - low_mm) * (f64::from(i) + 0.5) / f64::from(HEIGHTS);
            let (_, q) = finished.at_height(&job.blank, at_mm)?;
            let (_, p) = earlier.at_height(&job.blank, at_mm)?;
            Some([-(p.point_mm - q.point_mm).dot(q.normal), at_mm])
        })
        .max_by(|a, b| a[0].total_cmp(&b[0]))
}
