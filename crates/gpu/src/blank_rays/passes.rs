//! Passes as the kernel reads them: closed outlines from their centres, places in whole units.
//!
//! In: curves in f64, places in mm. Out: records. The law: what lies far from the axis is a whole number of units, a
//! power of two, so that differences are exact; an outline counts from its own centre and is millimetres in size.

use crate::blank_records::{BlankPass, BlankTile, OutlinePiece};
use gearcut_core::math::planar_rays::{ClosedCurve, Piece};
use glam::DVec2;
use std::ops::Range;

/// Bits of places: their differences stay below 2^31.
const PLACE_BITS: f64 = 29.0;
/// Distance of a run of pieces from its chord at most, unless it is one piece, mm. Nearer runs are more, and farther
/// ones have the kernel look at the pieces of rays that meet nothing.
const RUN_REACH_MM: f64 = 0.05;
/// What f32 may move a node across the rays by and off its run's chord, as a share of its distance from the centre:
/// both ends of the chord and the node are turned and moved beside the ray, three roundings each.
const ROUNDING: f64 = 1.0 / (1 << 20) as f64;
/// Bits of a run's number of pieces.
const RUN_PIECES: u32 = 0xff;
/// Pieces of a run at most.
const MOST_PIECES: u32 = 32;

/// Unit of places: the power of two by which the farthest of them is some 2^29.
pub fn unit_mm(farthest_mm: f64) -> f64 {
    (farthest_mm.log2().ceil() - PLACE_BITS).exp2()
}

/// A place in units.
pub fn units(at_mm: f64, mm_per_unit: f64) -> i32 {
    (at_mm / mm_per_unit).round() as i32
}

/// A closed curve as the kernel reads it, from its centre.
pub fn outline_pieces(curve: &impl ClosedCurve, center_mm: DVec2) -> Vec<OutlinePiece> {
    let count = curve.pieces().len();
    let pieces = curve.pieces().iter().enumerate().map(|(index, piece)| {
        let node_mm = curve.node_mm(index);
        let rates = if piece.law == Piece::STRAIGHT {
            [curve.node_mm((index + 1) % count) - node_mm; 2]
        } else {
            let [start, end] = piece.range;
            piece.range.map(|at| curve.place(piece.law, at)[1] * (end - start))
        };
        let pair = |v: DVec2| v.as_vec2().to_array();
        OutlinePiece {
            node_mm: pair(node_mm - center_mm),
            rate_start: pair(rates[0]),
            rate_end: pair(rates[1]),
            sagitta_mm: piece.sagitta_mm as f32,
            run: 0,
        }
    });
    let mut pieces: Vec<OutlinePiece> = pieces.collect();
    let farthest_mm = (0..count).map(|index| curve.node_mm(index).distance(center_mm)).fold(0.0, f64::max);
    for run in runs(curve) {
        pieces[run.first].run = run.record(farthest_mm * ROUNDING);
    }
    pieces
}

/// Neighbouring pieces of an outline that lie near one chord: the kernel goes round runs, and only where one may meet a
/// ray with material on it round its pieces.
struct OutlineRun {
    first: usize,
    pieces: u32,
    /// Distance from the run's chord at most, mm.
    reach_mm: f64,
}

impl OutlineRun {
    fn record(&self, rounding_mm: f64) -> u32 {
        // Upwards.
        ((((self.reach_mm + rounding_mm) as f32).next_up().to_bits() + RUN_PIECES) & !RUN_PIECES) | self.pieces
    }
}

/// The runs of a curve: each as long as all of it lies within [`RUN_REACH_MM`] of its chord.
fn runs(curve: &impl ClosedCurve) -> Vec<OutlineRun> {
    let pieces = curve.pieces();
    let node_mm = |index: usize| curve.node_mm(index % pieces.len());
    // A piece lies within its sagitta of its chord, a chord as near to the run's as its ends.
    let reach_mm = |run: Range<usize>| {
        let chord = [node_mm(run.start), node_mm(run.end)];
        let nodes_mm = (run.start + 1..run.end).map(|index| distance_mm(node_mm(index), chord)).fold(0.0, f64::max);
        nodes_mm + pieces[run].iter().map(|piece| piece.sagitta_mm).fold(0.0, f64::max)
    };
    let mut runs: Vec<OutlineRun> = Vec::new();
    for index in 0..pieces.len() {
        if let Some(run) = runs.last_mut() {
            let longer_mm = reach_mm(run.first..index + 1);
            if longer_mm <= RUN_REACH_MM && run.pieces < MOST_PIECES {
                (run.pieces, run.reach_mm) = (run.pieces + 1, longer_mm);
                continue;
            }
        }
        runs.push(OutlineRun { first: index, pieces: 1, reach_mm: reach_mm(index..index + 1) });
    }
    runs
}

/// Distance from a straight line between two places.
fn distance_mm(p: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let run = to - from;
    let share = ((p - from).dot(run) / run.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(from + share * run)
}

/// Passes over tiles of some rays.
#[derive(Default)]
pub struct RayPasses {
    /// Passes that visit each tile in order of time, tile after tile.
    pub visits: Vec<u32>,
    /// The passes.
    pub passes: Vec<BlankPass>,
    /// Their outlines.
    pub outline: Vec<OutlinePiece>,
    /// Unit of places, mm.
    pub mm_per_unit: f32,
    /// Outlines stay this near to their centres, mm.
    pub reach_mm: f32,
    /// Accounts of what is removed.
    pub accounts: usize,
    /// Pieces that there is room for; 0 if nobody asks for them.
    pub piece_room: usize,
}

impl RayPasses {
    /// A tile of rays of a family with its visits.
    pub fn tile(&mut self, rays: Range<usize>, family: usize, units_per_mm: f64, visits: &[u32]) -> BlankTile {
        let tile = BlankTile {
            first_visit: self.visits.len() as u32,
            visit_count: visits.len() as u32,
            first_ray: rays.start as u32,
            ray_count: rays.len() as u32,
            family: family as u32,
            units_per_mm: units_per_mm as f32,
            padding_1: 0,
            padding_2: 0,
        };
        self.visits.extend_from_slice(visits);
        tile
    }
}
