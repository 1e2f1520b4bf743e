//! Where Newton's method starts on the dexels of a tile.
//!
//! In: a tile, its records. Out: in every record polynomials over the tile's columns and rows, for the height and the
//! place along the segment.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::sweep::{SweepRecord, SweepStart};
use super::sweep_roots::{LANES, Lanes, Rays};
use super::sweep_samples::{LAST_STEP, entered};
use super::sweep_tile::SweepTile;
use crate::dexel::SpatialField;
use crate::tool::edge::Segment;
use pulp::Arch;

/// Gives the records of a tile the polynomials that Newton's method starts from: through the middle ray, the ends of
/// the middle column and row, and two corners. Where one of them does not meet the segment or its continuation, only
/// the middle ray counts; where that one does not, the lowest height.
pub fn find_starts(field: &SpatialField, tile: &SweepTile, segments: &[Segment], records: &mut [SweepRecord]) {
    Arch::new().dispatch(Starting { field, tile, segments, records });
}

struct Starting<'a> {
    field: &'a SpatialField,
    tile: &'a SweepTile,
    segments: &'a [Segment],
    records: &'a mut [SweepRecord],
}

impl pulp::NullaryFnOnce for Starting<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let [column, row] = self.tile.middle();
        let [columns, rows] = [&self.tile.columns, &self.tile.rows].map(|lines| [lines.start, lines.end - 1]);
        let places = [
            [column, row],
            [columns[0], row],
            [columns[1], row],
            [column, rows[0]],
            [column, rows[1]],
            [columns[0], rows[0]],
            [columns[1], rows[1]],
            [column, row],
        ];
        let from_middle = places.map(|[c, r]| [c as f64 - column as f64, r as f64 - row as f64]);
        let rays = Rays::new(self.field, self.tile.origin_mm, places.map(|[c, r]| self.field.index(c, r)));
        let lowest_mm = 2.0 * self.field.low_mm;
        for record in self.records {
            let segment = &self.segments[record.segment as usize];
            let roots = record.roots_from(segment, &rays, &[0.0; LANES], lowest_mm, LAST_STEP);
            record.start = if (0..LANES).all(|l| entered(&roots, l)) {
                SweepStart {
                    height_mm: quadratic(&from_middle, &roots.height_mm),
                    t: quadratic(&from_middle, &roots.t),
                }
            } else {
                let middle_mm = if entered(&roots, 0) { roots.height_mm[0] } else { lowest_mm };
                SweepStart { height_mm: [middle_mm, 0.0, 0.0, 0.0, 0.0, 0.0], t: [0.0; 6] }
            };
        }
    }
}

/// Coefficients of 1, x, y, x^2, x y, y^2 through values in the middle, to both sides along x and along y, and in two
/// corners (their mean).
#[inline(always)]
fn quadratic(places: &[[f64; 2]; LANES], values: &Lanes) -> [f64; 6] {
    let along = |axis: usize, before: usize, after: usize| {
        let ([a, b], [f, g]) =
            ([places[before][axis], places[after][axis]], [before, after].map(|i| values[i] - values[0]));
        if a == 0.0 || b == 0.0 {
            // A line, or nothing, where there are too few rays.
            return [if b == 0.0 { 0.0 } else { g / b }, 0.0];
        }
        let bend = (g / b - f / a) / (b - a);
        [g / b - bend * b, bend]
    };
    let ([x, xx], [y, yy]) = (along(0, 1, 2), along(1, 3, 4));
    let twist = |corner: usize| {
        let [u, v] = places[corner];
        let rest = values[corner] - values[0] - u * (x + u * xx) - v * (y + v * yy);
        if u * v == 0.0 { 0.0 } else { rest / (u * v) }
    };
    [values[0], x, y, xx, 0.5 * (twist(5) + twist(6)), yy]
}
