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

/// Unit of places: the power of two by which the farthest of them is some 2^29.
pub fn unit_mm(farthest_mm: f64) -> f64 {
    (farthest_mm.log2().ceil() - PLACE_BITS).exp2()
}

/// A place in units.
pub fn units(at_mm: f64, mm_per_unit: f64) -> i32 {
    (at_mm / mm_per_unit).round() as i32
}

/// A closed curve as the kernel reads it, from its centre.
pub fn outline_pieces(curve: &impl ClosedCurve, center_mm: DVec2) -> impl Iterator<Item = OutlinePiece> {
    let count = curve.pieces().len();
    curve.pieces().iter().enumerate().map(move |(index, piece)| {
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
            padding: 0,
        }
    })
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
