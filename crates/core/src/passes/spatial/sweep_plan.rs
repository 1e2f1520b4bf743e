//! Tiles of a spatial field and the sweeps that can leave the lowest surface on them.
//!
//! A field is halved in both directions again and again, down to tiles of at most 16 by 32 dexels and their cells of 4
//! by 8. At every level the sweeps that the level above has kept for the region are sampled on nine rays, and those
//! that another one surely undercuts are culled (see `sweep_samples`, `sweep_bounds`). The search begins with the
//! passes whose blades may hold a point of the field (`sweep_near`). On a third-order gear of 50 mm
//! face these are some thousands of 84,800; a sixteenth of the flank keeps some hundreds, a tile half a dozen, a cell
//! between one and two.
//!
//! Rays go on through the space and the next tooth, far beyond what is left of the blank, and the teeth that cut there
//! come near as well. So candidates are looked for below a guessed ceiling first, and what comes lower nowhere is left
//! out. A tile is found when a sweep that surely cuts there bounds the surface below the ceiling: what was left out is
//! then no part of it. The other tiles are searched again without a ceiling. A wrong guess costs time and changes
//! nothing.
//!
//! Equality with brute force over all passes is tested bit for bit.

use super::sweep::{Sweep, SweepRecord};
use super::sweep_bounds::RegionBounds;
use super::sweep_near::{Ball, near_passes};
use super::sweep_regions::{RAYS, Region, SIDE};
use super::sweep_samples::{Sampled, SweepCandidate, SweepFrame};
use super::sweep_starts::find_starts;
use super::sweep_tile::{CELL, CELLS, PATCH_CELL, SweepTile, TILE_COLUMNS, TILE_ROWS, cells_between};
use super::turning_passes::{BladePass, TurningPasses};
use crate::dexel::{Ray, SpatialField};
use crate::tool::edge::Segment;
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// All cells of a tile.
const ALL_CELLS: u16 = u16::MAX;
/// Parts of a field along its rows whose balls are looked at first. It decides about time alone.
const PARTS: usize = 4;
/// Surroundings reach this much further than the ends of nine rays, for what bulges between them: a surface of radius
/// rho bulges by a / (2 rho) of the reach over a region that reaches a, so that 5 % holds up to a = rho / 10. For
/// larger regions it was found by trial; the comparison with all passes in `tests/suite/hobbing/spatial.rs` stands for
/// it.
const BULGE: f64 = 1.05;
/// A region whose surroundings are smaller than this share of its frame's gets a frame of its own. It decides about
/// time alone: a frame holds for all that is within its reach.
const NEW_FRAME: f64 = 0.7;

/// Candidates are looked for first below this share of the depth to which rays record cuts, as high over the target. It
/// decides about time alone: a first cut leaves roots at 0.3 of the depth, and below 0.25 they were searched twice.
const CEILING_SHARE: f64 = 0.5;

/// Everything a backend needs to run one operation over one field.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweepPlan {
    /// Tiles, covering all dexels.
    pub tiles: Vec<SweepTile>,
    /// Records of all tiles.
    pub records: Vec<SweepRecord>,
    /// Segments that the records name: those of all edges of the tool, one edge after another.
    pub segments: Arc<[Segment]>,
    /// In which cells of its tile a record can be lowest is left to a device; records name all of them.
    pub has_open_cells: bool,
}

impl SweepPlan {
    /// Plan with candidate passes only.
    pub fn new(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner::new(field, set, Considered::Candidates).plan()
    }

    /// Plan with those candidates of whole patches that their nine rays leave, for devices that search the cells of a
    /// patch themselves: a patch is four tiles, and a frame made for it serves all of them. Newton's method starts from
    /// one height.
    pub fn in_patches(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner::new(field, set, Considered::CandidatesInPatches).plan()
    }

    /// Plan with candidates only, cell by cell, in tiles for frames in f32: for devices whose pairs cost as much as the
    /// host's.
    pub fn in_cells(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner::new(field, set, Considered::CandidatesInCells).plan()
    }

    /// Plan with every segment of every pass that can reach the field at all, in tiles as large as they may be: for few
    /// passes, over rays so far apart that nothing would be culled.
    pub fn of_near_passes(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner::new(field, set, Considered::NearUnculled).plan()
    }

    /// The same for the rays of one column alone: a row of rays is slim, and fewer passes come near it.
    pub fn of_passes_near_column(field: &SpatialField, column: usize, set: &TurningPasses) -> Self {
        let mut plan = Self::of_near_passes(&field.column(column), set);
        plan.tiles.iter_mut().for_each(|tile| tile.columns = column..column + 1);
        plan
    }

    /// The same in the tiles of the candidates: what these are compared with.
    pub fn brute_force(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner::new(field, set, Considered::Near).plan()
    }

    /// Plan with every segment of every pass of the operation, wherever it is: what the first look is compared with, on
    /// short operations.
    pub fn of_all_passes(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner::new(field, set, Considered::All).plan()
    }

    fn push(&mut self, (mut tile, mut records): FoundTile) {
        let first = self.records.len();
        self.records.append(&mut records);
        tile.records = first..self.records.len();
        self.tiles.push(tile);
    }

    /// (Dexel, pass) pairs of whole tiles: what a backend visits that does not look at cells.
    pub fn tile_passes(&self) -> u64 {
        self.tiles.iter().map(|t| (t.columns.len() * t.rows.len() * t.records.len()) as u64).sum()
    }

    /// (Dexel, pass) pairs that the plan asks for: records on the dexels of their cells.
    pub fn dexel_passes(&self) -> u64 {
        let of_tile = |tile: &SweepTile| -> u64 {
            let mut dexels = [0_u64; CELLS * CELLS];
            for column in tile.columns.clone() {
                tile.rows.clone().for_each(|row| dexels[tile.cell(column, row)] += 1);
            }
            let visits = |record: &SweepRecord| -> u64 {
                dexels.iter().enumerate().map(|(cell, dexels)| u64::from(record.cells >> cell & 1) * dexels).sum()
            };
            self.records[tile.records.clone()].iter().map(visits).sum()
        };
        self.tiles.iter().map(of_tile).sum()
    }
}

/// A tile with its records.
type FoundTile = (SweepTile, Vec<SweepRecord>);

struct SweepPlanner<'a> {
    field: &'a SpatialField,
    set: &'a TurningPasses,
    passes: Considered,
    /// Below these heights candidates are looked for, one after the other, wherever no search before has shown that the
    /// surface is left below its own, mm.
    ceilings_mm: [f64; 2],
}

/// Which passes a plan looks at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Considered {
    /// Those that may leave the lowest surface.
    Candidates,
    /// The same, patch by patch and not cell by cell.
    CandidatesInPatches,
    /// Candidates cell by cell, in tiles for frames in f32.
    CandidatesInCells,
    /// All whose blades come near the field.
    Near,
    /// The same, in tiles as large as they may be.
    NearUnculled,
    /// All.
    All,
}

impl<'a> SweepPlanner<'a> {
    fn new(field: &'a SpatialField, set: &'a TurningPasses, passes: Considered) -> Self {
        Self { field, set, passes, ceilings_mm: [-CEILING_SHARE * field.low_mm, f64::INFINITY] }
    }

    fn plan(&self) -> SweepPlan {
        let has_open_cells = self.passes == Considered::CandidatesInPatches;
        let mut plan = SweepPlan { segments: self.segments().clone(), has_open_cells, ..SweepPlan::default() };
        if self.field.is_empty() {
            return plan;
        }
        let whole = match self.passes {
            Considered::NearUnculled => Region::in_tiles(self.field, [TILE_COLUMNS, TILE_ROWS]),
            Considered::CandidatesInPatches => Region::in_patches(self.field),
            Considered::CandidatesInCells => Region::in_small_tiles(self.field),
            _ => Region::whole(self.field),
        };
        let near = match self.passes {
            Considered::Candidates | Considered::CandidatesInPatches | Considered::CandidatesInCells => {
                let mut tiles = vec![None; whole.tiles()];
                for ceiling_mm in self.ceilings_mm {
                    self.search(&whole, ceiling_mm, &mut tiles);
                }
                tiles.into_iter().flatten().for_each(|found| plan.push(found));
                return plan;
            }
            Considered::Near | Considered::NearUnculled => {
                let ball = Ball::of_balls(&self.parts(f64::INFINITY));
                near_passes(self.set, &ball, &[ball])
            }
            Considered::All => (0..self.set.count()).map(|index| self.set.pass(index)).collect(),
        };
        let near: Vec<SweepCandidate> = self
            .pieces(near)
            .flat_map(|(pass, piece)| {
                self.segments_of(&pass).map(move |segment| SweepCandidate { pass, piece, segment })
            })
            .collect();
        for columns in whole.columns.tiles() {
            for rows in whole.rows.tiles() {
                plan.push(self.tile(columns.clone(), rows, &near, &vec![ALL_CELLS; near.len()]));
            }
        }
        plan
    }

    /// Passes in the pieces of the motion that each sweeps in.
    fn pieces(&self, passes: Vec<BladePass>) -> impl Iterator<Item = (BladePass, u32)> {
        passes.into_iter().flat_map(|pass| self.set.pieces(&pass).map(move |piece| (pass, piece)))
    }

    /// Finds tiles, of all in the order in which regions are halved: those that are not found yet and where the surface
    /// is certainly left below a ceiling.
    fn search(&self, whole: &Region, ceiling_mm: f64, tiles: &mut [Option<FoundTile>]) {
        if tiles.iter().all(Option::is_some) {
            return;
        }
        let parts = self.parts(ceiling_mm);
        let near = near_passes(self.set, &Ball::of_balls(&parts), &parts);
        let highest_mm = f64::from(self.field.blank_mm.iter().copied().fold(0.0, f32::max));
        let frame = self.near_frame(whole, self.pieces(near), highest_mm.min(ceiling_mm));
        let sampled = whole.sample(&frame, self.segments());
        self.halve(whole, &frame, &sampled, [highest_mm, ceiling_mm], tiles);
    }

    /// Records of those segments of some sweeps that can come near the field below a height at all: each sweep is made
    /// once, and most segments of a blade need no record.
    fn near_frame(
        &self,
        whole: &Region,
        sweeps: impl Iterator<Item = (BladePass, u32)>,
        highest_mm: f64,
    ) -> SweepFrame {
        let (origin_mm, reach_mm) = self.surroundings(&whole.dexels());
        let mut one_each = SweepFrame { origin_mm, reach_mm, candidates: Vec::new(), records: Vec::new() };
        let mut made = Vec::new();
        for (pass, piece) in sweeps {
            let Some(sweep) = Sweep::new(self.set, &pass, piece, origin_mm, reach_mm) else { continue };
            let segment = self.segments_of(&pass).start;
            one_each.records.push(sweep.record(pass.pass, segment, &self.segments()[segment]));
            one_each.candidates.push(SweepCandidate { pass, piece, segment });
            made.push(sweep);
        }
        let bounds = self.bounds(whole, &one_each, highest_mm);
        let near = bounds.near(highest_mm, |candidate| self.segments_of(&candidate.pass));
        let candidate = |&(sweep, segment): &(usize, usize)| SweepCandidate { segment, ..one_each.candidates[sweep] };
        let record = |&(sweep, segment): &(usize, usize)| {
            made[sweep].record(one_each.candidates[sweep].pass.pass, segment, &self.segments()[segment])
        };
        SweepFrame {
            origin_mm,
            reach_mm,
            candidates: near.iter().map(candidate).collect(),
            records: near.iter().map(record).collect(),
        }
    }

    /// Finds tiles of a region from its samples, below a bound of the surface left there and a ceiling.
    fn halve(
        &self,
        region: &Region,
        frame: &SweepFrame,
        sampled: &[Sampled],
        [upper_bound_mm, ceiling_mm]: [f64; 2],
        tiles: &mut [Option<FoundTile>],
    ) {
        let (mut alive, upper_bound_mm) = self.bounds(region, frame, ceiling_mm).keep(sampled, upper_bound_mm);
        if region.is_tile() && upper_bound_mm > ceiling_mm {
            // What is higher was not looked for, and may be the surface here.
            return;
        }
        if self.passes == Considered::CandidatesInPatches && region.is_tile() {
            tiles[0] = Some(self.patch(region, frame, alive));
            return;
        }
        // Only what is left is seen from a new frame: a sweep in another frame costs as much as its samples.
        let (origin_mm, reach_mm) = self.surroundings(&region.dexels());
        let own = (reach_mm <= NEW_FRAME * frame.reach_mm).then(|| self.frame(origin_mm, reach_mm, frame, &mut alive));
        let frame = own.as_ref().unwrap_or(frame);
        let parts = region.parts(frame, self.segments(), &alive);
        if region.is_tile() {
            tiles[0] = Some(self.bounded_tile(region, frame, &parts, [upper_bound_mm, ceiling_mm]));
            return;
        }
        let mut open = tiles;
        for (part, sampled) in parts {
            let (own, others) = open.split_at_mut(part.tiles());
            if own.iter().any(Option::is_none) {
                self.halve(&part, frame, &sampled, [upper_bound_mm, ceiling_mm], own);
            }
            open = others;
        }
    }

    /// Candidates of a frame in another one within it, without those whose blades hold its origin at no moment.
    fn frame(&self, origin_mm: DVec3, reach_mm: f64, of: &SweepFrame, alive: &mut Vec<(Sampled, u8)>) -> SweepFrame {
        let candidates: Vec<SweepCandidate> = alive.iter().map(|(s, _)| of.candidates[s.index as usize]).collect();
        let (frame, index_of) = SweepFrame::new(self.set, origin_mm, reach_mm, &candidates);
        let mut places = index_of.into_iter();
        alive.retain_mut(|(sampled, _)| {
            places.next().flatten().is_some_and(|index| {
                sampled.index = index;
                true
            })
        });
        frame
    }

    /// Middle of nine rays, and a distance from there that nothing between lowest and blank height of any of them
    /// exceeds.
    fn surroundings(&self, dexels: &[usize; RAYS]) -> (DVec3, f64) {
        let ray = |dexel: usize| self.field.ray(dexel / self.field.rows(), dexel % self.field.rows());
        let origin_mm = ray(dexels[RAYS / 2]).origin_mm;
        let ends = dexels.iter().flat_map(|&dexel| {
            let Ray { origin_mm: from_mm, normal } = ray(dexel);
            let local = Ray { origin_mm: from_mm - origin_mm, normal };
            [self.field.low_mm, f64::from(self.field.blank_mm[dexel])].map(|h| local.at(h).length())
        });
        (origin_mm, BULGE * ends.fold(0.0, f64::max))
    }

    /// A ball that holds all that can be found on some rays below a ceiling: a root counts from twice the lowest height
    /// up to the blank's.
    fn ball(&self, columns: Range<usize>, rows: Range<usize>, ceiling_mm: f64) -> Ball {
        let field = self.field;
        let (origins_mm, normals) = (field.origins_mm(), field.normals());
        let lowest_mm = 2.0 * field.low_mm;
        // Component by component, as rays lie in memory: every ray of a flank is asked.
        let spans = columns.map(|column| field.index(column, rows.start)..field.index(column, rows.end));
        let (mut low_mm, mut high_mm) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for span in spans {
            let blank_mm = &field.blank_mm[span.clone()];
            for axis in 0..3 {
                let (mut low, mut high) = (low_mm[axis], high_mm[axis]);
                let components = origins_mm[axis][span.clone()].iter().zip(&normals[axis][span.clone()]);
                for ((from, along), &blank) in components.zip(blank_mm) {
                    let (a, b) = (from + lowest_mm * along, from + f64::from(blank).min(ceiling_mm) * along);
                    (low, high) = (low.min(a.min(b)), high.max(a.max(b)));
                }
                (low_mm[axis], high_mm[axis]) = (low, high);
            }
        }
        let center_mm = 0.5 * (low_mm + high_mm);
        Ball { center_mm, radius_mm: 0.5 * (high_mm - low_mm).length() }
    }

    /// Balls of parts of the field: together they are much slimmer than one of the whole.
    fn parts(&self, ceiling_mm: f64) -> Vec<Ball> {
        let (columns, rows) = (self.field.columns(), self.field.rows());
        let step = rows.div_ceil(PARTS);
        (0..rows).step_by(step).map(|from| self.ball(0..columns, from..(from + step).min(rows), ceiling_mm)).collect()
    }

    /// Segments of a pass's blade.
    fn segments_of(&self, pass: &BladePass) -> Range<usize> {
        self.set.edges.segments_of(self.set.place(pass).blade)
    }

    fn segments(&self) -> &Arc<[Segment]> {
        self.set.edges.segments()
    }

    fn bounds<'b>(&'b self, region: &'b Region, frame: &'b SweepFrame, ceiling_mm: f64) -> RegionBounds<'b> {
        RegionBounds { field: self.field, segments: self.segments(), region, frame, ceiling_mm }
    }

    /// A patch in a frame about its middle. Newton's method starts from the mean height of the rays that surely enter a
    /// candidate, or from the lowest one.
    fn patch(&self, region: &Region, frame: &SweepFrame, mut alive: Vec<(Sampled, u8)>) -> FoundTile {
        let (origin_mm, reach_mm) = self.surroundings(&region.dexels());
        let mut frame = self.frame(origin_mm, reach_mm, frame, &mut alive);
        for (record, (sampled, _)) in frame.records.iter_mut().zip(&alive) {
            record.start.height_mm[0] = sampled.mean_entry_mm().unwrap_or(2.0 * self.field.low_mm);
        }
        let (columns, rows) = (region.columns.dexels(), region.rows.dexels());
        (SweepTile { columns, rows, cell: PATCH_CELL, origin_mm, records: 0..frame.records.len() }, frame.records)
    }

    /// Bounds the parts of a tile: a record costs more in the kernel than here, and it is told in which cells it can be
    /// lowest.
    fn bounded_tile(
        &self,
        region: &Region,
        frame: &SweepFrame,
        parts: &[(Region, Vec<Sampled>)],
        [upper_bound_mm, ceiling_mm]: [f64; 2],
    ) -> FoundTile {
        let mut cells = vec![0_u16; frame.candidates.len()];
        let mut kept = Vec::new();
        let from = [region.columns.at[0], region.rows.at[0]];
        for (part, sampled) in parts {
            let cells_of: [u16; 4] = std::array::from_fn(|bit| {
                let columns = region.columns.between(&part.columns, bit / 2);
                let rows = region.rows.between(&part.rows, bit % 2);
                cells_between(from, [columns, rows])
            });
            for (sampled, alive) in self.bounds(part, frame, ceiling_mm).keep(sampled, upper_bound_mm).0 {
                let cells = &mut cells[sampled.index as usize];
                if *cells == 0 {
                    kept.push(sampled.index);
                }
                for bit in (0..4).filter(|bit| alive >> bit & 1 == 1) {
                    *cells |= cells_of[bit];
                }
            }
        }
        kept.sort_unstable();
        let candidates: Vec<SweepCandidate> = kept.iter().map(|&index| frame.candidates[index as usize]).collect();
        let cells: Vec<u16> = kept.iter().map(|&index| cells[index as usize]).collect();
        self.tile(region.columns.dexels(), region.rows.dexels(), &candidates, &cells)
    }

    fn tile(&self, columns: Range<usize>, rows: Range<usize>, kept: &[SweepCandidate], cells: &[u16]) -> FoundTile {
        let dexels = {
            let lines =
                |range: &Range<usize>| [range.start, usize::midpoint(range.start, range.end - 1), range.end - 1];
            let (columns, rows) = (lines(&columns), lines(&rows));
            std::array::from_fn(|i| self.field.index(columns[i / SIDE], rows[i % SIDE]))
        };
        let (origin_mm, reach_mm) = self.surroundings(&dexels);
        let (SweepFrame { mut records, .. }, index_of) = SweepFrame::new(self.set, origin_mm, reach_mm, kept);
        for (index, cells) in index_of.iter().zip(cells) {
            if let Some(index) = index {
                records[*index as usize].cells = *cells;
            }
        }
        let tile = SweepTile { columns, rows, cell: CELL, origin_mm, records: 0..records.len() };
        find_starts(self.field, &tile, self.segments(), &mut records);
        (tile, records)
    }
}

#[cfg(test)]
mod tests;
