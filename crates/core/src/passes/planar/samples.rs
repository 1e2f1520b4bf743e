//! Heights of passes at sample rays of a tile, and which passes others surely undercut.
//!
//! In: samples of every pass that the bounds could decide ([`super::bounds`]). Out: those that no other pass dominates.

use super::near::MAX_PHASES;
use crate::dexel::field::Column;
use arrayvec::ArrayVec;

/// Places across a tile at which a pass is sampled at most.
pub const MAX_PLACES: usize = 5;

/// Rays of a tile at which passes are sampled.
pub struct Sampling<'a> {
    /// Rays, evenly across the tile, its ends included.
    pub places: &'a [Column],
    /// Distance between them along the profile, mm.
    pub cell_mm: f64,
    /// Turn of the normals along the profile, 1/mm.
    pub turn_per_mm: f64,
    /// Entries at or below this height belong to the other side of the tooth; the kernel passes over them.
    pub floor_mm: f64,
}

/// Heights of one segment's pass at the sample rays of a tile.
#[derive(Debug, Clone)]
pub struct PassSamples {
    /// Index of the near pass.
    pub pass: usize,
    /// Segment, among those of all edges.
    pub segment: usize,
    /// Place by place across the tile, phase by phase, mm.
    pub heights_mm: ArrayVec<f64, { MAX_PLACES * MAX_PHASES }>,
    /// Error of interpolation between neighbouring samples.
    pub error_mm: f64,
    /// All samples and all that lies between them enter the segment itself, not its continuation.
    pub certain: bool,
}

/// Leaves out every pass that another, certain one undercuts at all corners of all cells (cell by cell); with those
/// that are left, passes and segments of the few certain ones that are lowest at a corner.
///
/// A difference of two bilinear functions is extreme at corners, so comparing there, with both errors added, decides
/// for the whole cell.
pub fn undominated(samples: Vec<PassSamples>, cells: usize) -> (Vec<PassSamples>, Vec<(usize, usize)>) {
    let Some(any) = samples.first() else { return (samples, Vec::new()) };
    let per_place = any.heights_mm.len() / (cells + 1);
    let corners = |cell: usize| cell * per_place..(cell + 2) * per_place;
    // In each cell the certain passes that are lowest at one of its corners: at most a handful, and no other can
    // dominate.
    let dominating: Vec<Vec<usize>> = (0..cells)
        .map(|cell| {
            let mut lowest: Vec<usize> = corners(cell)
                .filter_map(|corner| {
                    (0..samples.len())
                        .filter(|&k| samples[k].certain)
                        .min_by(|&a, &b| samples[a].heights_mm[corner].total_cmp(&samples[b].heights_mm[corner]))
                })
                .collect();
            lowest.sort_unstable();
            lowest.dedup();
            lowest
        })
        .collect();
    let dominates = |other: &PassSamples, k: &PassSamples, cell: usize| {
        corners(cell).all(|c| k.heights_mm[c] - other.heights_mm[c] > k.error_mm + other.error_mm)
    };
    let keep: Vec<bool> = samples
        .iter()
        .map(|k| !(0..cells).all(|cell| dominating[cell].iter().any(|&other| dominates(&samples[other], k, cell))))
        .collect();
    let lowest = dominating.iter().flatten().map(|&k| (samples[k].pass, samples[k].segment));
    let mut lowest: Vec<(usize, usize)> = lowest.collect();
    lowest.sort_unstable();
    lowest.dedup();
    (samples.into_iter().zip(keep).filter_map(|(sample, keep)| keep.then_some(sample)).collect(), lowest)
}
