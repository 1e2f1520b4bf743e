//! The spatial kernel: rays of one tile against the sweeps of its passes.
//!
//! In: rays in space, records ([`SweepRecord`], where the equations are derived), edge segments, the layer so far. Out:
//! lowered heights and the passes that lowered them.
//!
//! Eight rows of a column go together. Newton's method ([`crate::passes::spatial::sweep_roots`]) starts from
//! polynomials over the tile and mostly takes two steps.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]
#![expect(clippy::needless_bitwise_bool, reason = "lanes are evaluated without branches, or they would not vectorise")]

use crate::cut::CutStats;
use crate::dexel::SpatialField;
use crate::passes::spatial::sweep::SweepRecord;
use crate::passes::spatial::sweep_roots::{LANES, Lanes, Rays};
use crate::passes::spatial::sweep_tile::SweepTile;
use crate::tool::edge::{Segment, SegmentShape};

/// Hits this far beyond a segment's end still count: neighbouring segments then leave no slit for a ray to slip
/// through.
const END_OVERLAP_MM: f64 = 1e-9;
/// Newton steps below this, in mm and in t, are the last: the error after them is of their squares, so that heights do
/// not depend on where the search started.
const LAST_STEP: f64 = 1e-8;
/// A last step below this has arrived, mm.
const CONVERGED_MM: f64 = 1e-6;

/// One tile's work; called through the instruction set dispatch.
pub struct SpatialTileCut<'a> {
    pub field: &'a SpatialField,
    pub tile: &'a SweepTile,
    pub records: &'a [SweepRecord],
    pub segments: &'a [Segment],
    pub heights_mm: &'a mut [f32],
    pub passes: &'a mut [u32],
}

impl pulp::NullaryFnOnce for SpatialTileCut<'_> {
    type Output = CutStats;

    #[inline(always)]
    fn call(self) -> CutStats {
        let Self { field, tile, records, segments, heights_mm, passes } = self;
        let mut stats = CutStats::default();
        // All rays of the tile first: they lie all over the memory, and waiting for many at a time costs little more
        // than waiting for one.
        let mut chunks: Vec<Chunk> = Vec::with_capacity(tile.columns.len() * tile.rows.len().div_ceil(LANES));
        for column in tile.columns.clone() {
            for first in tile.rows.clone().step_by(LANES) {
                chunks.push(Chunk::load(field, tile, [column, first], heights_mm, passes));
            }
        }
        for chunk in &mut chunks {
            let cell = chunk.cell;
            for record in records.iter().filter(|record| record.cells >> cell & 1 == 1) {
                let (unknown, _) = chunk.lower(record, segments, field.low_mm);
                stats.unconverged += unknown[..chunk.there].iter().sum::<u64>();
                stats.dexel_passes += chunk.there as u64;
            }
        }
        for chunk in &chunks {
            chunk.store(heights_mm, passes);
        }
        stats
    }
}

/// What one record took from the rays of a ledger.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Taken {
    /// Sum over the rays of the length taken, each weighted by (1 + curvature x height), mm.
    pub length_mm: f64,
    /// Largest thickness taken across the edge's surface, mm.
    pub thickness_mm: f64,
    /// Rays that lost something.
    pub rays: u32,
}

/// One tile's work with a ledger: every record in the order of time, and what each took.
pub struct LedgerCut<'a> {
    pub cut: SpatialTileCut<'a>,
    /// How much rays part as they leave the work, 1 / mm, column by column of the field.
    pub spread_per_mm: &'a [f64],
    /// One entry for each record.
    pub taken: &'a mut [Taken],
}

impl pulp::NullaryFnOnce for LedgerCut<'_> {
    type Output = CutStats;

    #[inline(always)]
    fn call(self) -> CutStats {
        let Self { cut, spread_per_mm, taken } = self;
        let mut stats = CutStats::default();
        for column in cut.tile.columns.clone() {
            let spread = 0.5 * spread_per_mm[column];
            for first in cut.tile.rows.clone().step_by(LANES) {
                let mut chunk = Chunk::load(cut.field, cut.tile, [column, first], cut.heights_mm, cut.passes);
                let there = chunk.there;
                for (record, taken) in cut.records.iter().zip(taken.iter_mut()) {
                    let before = chunk.best;
                    let (unknown, cosines) = chunk.lower(record, cut.segments, cut.field.low_mm);
                    stats.unconverged += unknown[..there].iter().sum::<u64>();
                    for l in 0..there {
                        let length = before[l] - chunk.best[l];
                        if length > 0.0 {
                            taken.length_mm += length * (1.0 + spread * (before[l] + chunk.best[l]));
                            taken.thickness_mm = taken.thickness_mm.max(length * cosines[l]);
                            taken.rays += 1;
                        }
                    }
                }
                chunk.store(cut.heights_mm, cut.passes);
            }
        }
        stats.dexel_passes = (cut.tile.columns.len() * cut.tile.rows.len() * cut.records.len()) as u64;
        stats
    }
}

/// Eight rays with what is left on them.
struct Chunk {
    /// First dexel and number of dexels; lanes beyond it repeat the last one and write nothing.
    base: usize,
    there: usize,
    /// Cell of the tile in which it lies.
    cell: usize,
    rays: Rays,
    /// Columns of all lanes and rows of each from the tile's middle ray.
    place: (f64, Lanes),
    best: Lanes,
    best_pass: [u32; LANES],
}

impl Chunk {
    #[inline(always)]
    fn load(
        field: &SpatialField,
        tile: &SweepTile,
        [column, first]: [usize; 2],
        heights_mm: &[f32],
        passes: &[u32],
    ) -> Self {
        let (base, there) = (field.index(column, first), (tile.rows.end - first).min(LANES));
        let mut at = [base; LANES];
        for l in 0..there {
            at[l..].fill(base + l);
        }
        let rays = if there == LANES {
            Rays::following(field, tile.origin_mm, base)
        } else {
            Rays::new(field, tile.origin_mm, at)
        };
        let (mut best, mut best_pass) = ([0.0; LANES], [0_u32; LANES]);
        for l in 0..LANES {
            best[l] = f64::from(heights_mm[at[l]]);
            best_pass[l] = passes[at[l]];
        }
        let middle = tile.middle().map(|line| line as f64);
        let rows = std::array::from_fn(|l| (first + l) as f64 - middle[1]);
        Self {
            base,
            there,
            cell: tile.cell(column, first),
            rays,
            place: (column as f64 - middle[0], rows),
            best,
            best_pass,
        }
    }

    #[inline(always)]
    fn store(&self, heights_mm: &mut [f32], passes: &mut [u32]) {
        for l in 0..self.there {
            heights_mm[self.base + l] = self.best[l] as f32;
            passes[self.base + l] = self.best_pass[l];
        }
    }

    /// Values of a polynomial of [`SweepStart`](crate::passes::spatial::sweep::SweepStart) on the rays.
    #[inline(always)]
    fn start(&self, [c, x, y, xx, xy, yy]: &[f64; 6]) -> Lanes {
        let (column, rows) = &self.place;
        let (from, slope) = (c + column * (x + column * xx), y + column * xy);
        std::array::from_fn(|l| from + rows[l] * (slope + rows[l] * yy))
    }

    /// Lowers the heights by one record; gives for every lane whether its root is unknown though it may lie below what
    /// is there, and the cosine at which the ray met the edge.
    #[inline(always)]
    fn lower(&mut self, record: &SweepRecord, segments: &[Segment], low_mm: f64) -> ([u64; LANES], Lanes) {
        let segment = &segments[record.segment as usize];
        let lowest = 2.0 * low_mm;
        let start = [self.start(&record.start.height_mm), self.start(&record.start.t)];
        let roots = record.roots(segment, &self.rays, [&start[0], &start[1]], lowest, LAST_STEP);
        let [y_from, y_to] = segment.y_range_mm;
        let behind = match &segment.shape {
            SegmentShape::Table(_) => f64::NEG_INFINITY,
            SegmentShape::Arc { radius_mm } => -radius_mm,
        };
        let [t_from, t_to] = record.t_range;
        let mut unknown = [0; LANES];
        for (l, unknown) in unknown.iter_mut().enumerate() {
            let (h, y) = (roots.height_mm[l], roots.y_mm[l]);
            let on_segment = (y >= y_from - END_OVERLAP_MM)
                & (y <= y_to + END_OVERLAP_MM)
                & (roots.x_mm[l] > behind)
                & roots.falls[l]
                & (roots.t[l] > t_from)
                & (roots.t[l] < t_to);
            let converged = roots.step_mm[l].abs() < CONVERGED_MM;
            *unknown = u64::from(on_segment & !converged & (roots.rises[l] < 2.0) & (h < self.best[l]));
            let height = h.max(low_mm);
            let lower = on_segment & converged & (h > lowest) & (height < self.best[l]);
            self.best[l] = if lower { height } else { self.best[l] };
            self.best_pass[l] = if lower { record.pass } else { self.best_pass[l] };
        }
        (unknown, roots.cosine)
    }
}
