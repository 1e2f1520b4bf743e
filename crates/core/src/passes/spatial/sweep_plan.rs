//! Tiles of a spatial field and the sweeps that can leave the lowest surface on them.
//!
//! A field is halved in both directions again and again, down to tiles of at most 16 by 32 dexels and their cells of 4
//! by 8. At every level the sweeps that the level above has kept for the region are sampled on nine rays, and those
//! that another one surely undercuts are culled (see `sweep_samples`, `sweep_bounds`). The search begins with the
//! passes whose blades may hold a point of the field (`sweep_near`). On a third-order gear of 50 mm
//! face these are some thousands of 84,800; a sixteenth of the flank keeps some hundreds, a tile half a dozen, a cell
//! between one and two.
//!
//! Equality with brute force over all passes is tested bit for bit.

use super::sweep::{Sweep, SweepRecord};
use super::sweep_bounds::RegionBounds;
use super::sweep_near::{Ball, near_passes};
use super::sweep_regions::{RAYS, Region, SIDE};
use super::sweep_samples::{Sampled, SweepCandidate, SweepFrame};
use super::sweep_starts::find_starts;
use super::sweep_tile::{CELLS, SweepTile, TILE_COLUMNS, TILE_ROWS, cells_between};
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

/// Everything a backend needs to run one operation over one field.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweepPlan {
    /// Tiles, covering all dexels.
    pub tiles: Vec<SweepTile>,
    /// Records of all tiles.
    pub records: Vec<SweepRecord>,
    /// Segments that the records name: those of all edges of the tool, one edge after another.
    pub segments: Arc<[Segment]>,
}

impl SweepPlan {
    /// Plan with candidate passes only.
    pub fn new(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner { field, set, passes: Considered::Candidates }.plan()
    }

    /// Plan with those candidates of whole tiles that their nine rays leave, for devices: where in the tile each can be
    /// lowest is not looked for, and Newton's method starts from one height. Searching cells takes longer than what it
    /// spares a device, which visits all dexels of a tile.
    pub fn in_tiles(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner { field, set, passes: Considered::CandidatesInTiles }.plan()
    }

    /// Plan with every segment of every pass that can reach the field at all, in tiles as large as they may be: for few
    /// passes, over rays so far apart that nothing would be culled.
    pub fn of_near_passes(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner { field, set, passes: Considered::NearUnculled }.plan()
    }

    /// The same for the rays of one column alone: a row of rays is slim, and fewer passes come near it.
    pub fn of_passes_near_column(field: &SpatialField, column: usize, set: &TurningPasses) -> Self {
        let mut plan = Self::of_near_passes(&field.column(column), set);
        plan.tiles.iter_mut().for_each(|tile| tile.columns = column..column + 1);
        plan
    }

    /// The same in the tiles of the candidates: what these are compared with.
    pub fn brute_force(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner { field, set, passes: Considered::Near }.plan()
    }

    /// Plan with every segment of every pass of the operation, wherever it is: what the first look is compared with, on
    /// short operations.
    pub fn of_all_passes(field: &SpatialField, set: &TurningPasses) -> Self {
        SweepPlanner { field, set, passes: Considered::All }.plan()
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

struct SweepPlanner<'a> {
    field: &'a SpatialField,
    set: &'a TurningPasses,
    passes: Considered,
}

/// Which passes a plan looks at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Considered {
    /// Those that may leave the lowest surface.
    Candidates,
    /// The same, tile by tile and not cell by cell.
    CandidatesInTiles,
    /// All whose blades come near the field.
    Near,
    /// The same, in tiles as large as they may be.
    NearUnculled,
    /// All.
    All,
}

impl SweepPlanner<'_> {
    fn plan(&self) -> SweepPlan {
        let mut plan = SweepPlan { segments: self.segments().clone(), ..SweepPlan::default() };
        if self.field.is_empty() {
            return plan;
        }
        let whole = match self.passes {
            Considered::NearUnculled => Region::in_tiles(self.field, [TILE_COLUMNS, TILE_ROWS]),
            Considered::CandidatesInTiles => Region::in_small_tiles(self.field),
            _ => Region::whole(self.field),
        };
        let (origin_mm, reach_mm) = self.surroundings(&whole.dexels());
        let parts = || {
            let parts = self.parts();
            (Ball::of_balls(&parts), parts)
        };
        let near = match self.passes {
            Considered::Candidates | Considered::CandidatesInTiles => {
                let (whole, parts) = parts();
                near_passes(self.set, &whole, &parts)
            }
            Considered::Near | Considered::NearUnculled => {
                let whole = parts().0;
                near_passes(self.set, &whole, &[whole])
            }
            Considered::All => (0..self.set.count()).map(|index| self.set.pass(index)).collect(),
        };
        let sweeps = near.into_iter().flat_map(|pass| self.set.pieces(&pass).map(move |piece| (pass, piece)));
        if matches!(self.passes, Considered::Candidates | Considered::CandidatesInTiles) {
            let highest_mm = f64::from(self.field.blank_mm.iter().copied().fold(0.0, f32::max));
            let frame = self.near_frame(&whole, (origin_mm, reach_mm), sweeps, highest_mm);
            let sampled = whole.sample(&frame, self.segments());
            self.halve(&whole, &frame, &sampled, highest_mm, &mut plan);
        } else {
            let near: Vec<SweepCandidate> = sweeps
                .flat_map(|(pass, piece)| {
                    self.segments_of(&pass).map(move |segment| SweepCandidate { pass, piece, segment })
                })
                .collect();
            for columns in whole.columns.tiles() {
                for rows in whole.rows.tiles() {
                    self.tile(columns.clone(), rows, &near, &vec![ALL_CELLS; near.len()], &mut plan);
                }
            }
        }
        plan
    }

    /// Records of those segments of some sweeps that can come near the field at all: each sweep is made once, and most
    /// segments of a blade need no record.
    fn near_frame(
        &self,
        whole: &Region,
        (origin_mm, reach_mm): (DVec3, f64),
        sweeps: impl Iterator<Item = (BladePass, u32)>,
        highest_mm: f64,
    ) -> SweepFrame {
        let mut one_each = SweepFrame { origin_mm, reach_mm, candidates: Vec::new(), records: Vec::new() };
        let mut made = Vec::new();
        for (pass, piece) in sweeps {
            let Some(sweep) = Sweep::new(self.set, &pass, piece, origin_mm, reach_mm) else { continue };
            let segment = self.segments_of(&pass).start;
            one_each.records.push(sweep.record(pass.pass, segment, &self.segments()[segment]));
            one_each.candidates.push(SweepCandidate { pass, piece, segment });
            made.push(sweep);
        }
        let near = self.bounds(whole, &one_each).near(highest_mm, |candidate| self.segments_of(&candidate.pass));
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

    fn halve(
        &self,
        region: &Region,
        frame: &SweepFrame,
        sampled: &[Sampled],
        upper_bound_mm: f64,
        plan: &mut SweepPlan,
    ) {
        let (mut alive, upper_bound_mm) = self.bounds(region, frame).keep(sampled, upper_bound_mm);
        if self.passes == Considered::CandidatesInTiles && region.is_tile() {
            self.whole_tile(region, frame, alive, plan);
            return;
        }
        // Only what is left is seen from a new frame: a sweep in another frame costs as much as its samples.
        let (origin_mm, reach_mm) = self.surroundings(&region.dexels());
        let own = (reach_mm <= NEW_FRAME * frame.reach_mm).then(|| self.frame(origin_mm, reach_mm, frame, &mut alive));
        let frame = own.as_ref().unwrap_or(frame);
        let parts = region.parts(frame, self.segments(), &alive);
        if region.is_tile() {
            self.bounded_tile(region, frame, &parts, upper_bound_mm, plan);
            return;
        }
        for (part, sampled) in parts {
            self.halve(&part, frame, &sampled, upper_bound_mm, plan);
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

    /// A ball that holds all that can be found on some rays: a root counts from twice the lowest height up to the
    /// blank's.
    fn ball(&self, columns: Range<usize>, rows: Range<usize>) -> Ball {
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
                    let (a, b) = (from + lowest_mm * along, from + f64::from(blank) * along);
                    (low, high) = (low.min(a.min(b)), high.max(a.max(b)));
                }
                (low_mm[axis], high_mm[axis]) = (low, high);
            }
        }
        let center_mm = 0.5 * (low_mm + high_mm);
        Ball { center_mm, radius_mm: 0.5 * (high_mm - low_mm).length() }
    }

    /// Balls of parts of the field: together they are much slimmer than one of the whole.
    fn parts(&self) -> Vec<Ball> {
        let (columns, rows) = (self.field.columns(), self.field.rows());
        let step = rows.div_ceil(PARTS);
        (0..rows).step_by(step).map(|from| self.ball(0..columns, from..(from + step).min(rows))).collect()
    }

    /// Segments of a pass's blade.
    fn segments_of(&self, pass: &BladePass) -> Range<usize> {
        self.set.edges.segments_of(self.set.place(pass).blade)
    }

    fn segments(&self) -> &Arc<[Segment]> {
        self.set.edges.segments()
    }

    fn bounds<'a>(&'a self, region: &'a Region, frame: &'a SweepFrame) -> RegionBounds<'a> {
        RegionBounds { field: self.field, segments: self.segments(), region, frame }
    }

    /// A tile in a frame about its middle. Newton's method starts from the mean height of the rays that surely enter a
    /// candidate, or from the lowest one.
    fn whole_tile(&self, region: &Region, frame: &SweepFrame, mut alive: Vec<(Sampled, u8)>, plan: &mut SweepPlan) {
        let (origin_mm, reach_mm) = self.surroundings(&region.dexels());
        let mut frame = self.frame(origin_mm, reach_mm, frame, &mut alive);
        for (record, (sampled, _)) in frame.records.iter_mut().zip(&alive) {
            record.start.height_mm[0] = sampled.mean_entry_mm().unwrap_or(2.0 * self.field.low_mm);
        }
        let first = plan.records.len();
        plan.records.append(&mut frame.records);
        let (columns, rows) = (region.columns.dexels(), region.rows.dexels());
        plan.tiles.push(SweepTile { columns, rows, origin_mm, records: first..plan.records.len() });
    }

    /// Bounds the parts of a tile: a record costs more in the kernel than here, and it is told in which cells it can be
    /// lowest.
    fn bounded_tile(
        &self,
        region: &Region,
        frame: &SweepFrame,
        parts: &[(Region, Vec<Sampled>)],
        upper_bound_mm: f64,
        plan: &mut SweepPlan,
    ) {
        let mut cells = vec![0_u16; frame.candidates.len()];
        let mut kept = Vec::new();
        let from = [region.columns.at[0], region.rows.at[0]];
        for (part, sampled) in parts {
            let cells_of: [u16; 4] = std::array::from_fn(|bit| {
                let columns = region.columns.between(&part.columns, bit / 2);
                let rows = region.rows.between(&part.rows, bit % 2);
                cells_between(from, [columns, rows])
            });
            for (sampled, alive) in self.bounds(part, frame).keep(sampled, upper_bound_mm).0 {
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
        self.tile(region.columns.dexels(), region.rows.dexels(), &candidates, &cells, plan);
    }

    fn tile(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        kept: &[SweepCandidate],
        cells: &[u16],
        plan: &mut SweepPlan,
    ) {
        let dexels = {
            let lines =
                |range: &Range<usize>| [range.start, usize::midpoint(range.start, range.end - 1), range.end - 1];
            let (columns, rows) = (lines(&columns), lines(&rows));
            std::array::from_fn(|i| self.field.index(columns[i / SIDE], rows[i % SIDE]))
        };
        let (origin_mm, reach_mm) = self.surroundings(&dexels);
        let (frame, index_of) = SweepFrame::new(self.set, origin_mm, reach_mm, kept);
        let first = plan.records.len();
        plan.records.extend(frame.records);
        for (index, cells) in index_of.iter().zip(cells) {
            if let Some(index) = index {
                plan.records[first + *index as usize].cells = *cells;
            }
        }
        let tile = SweepTile { columns, rows, origin_mm, records: first..plan.records.len() };
        find_starts(self.field, &tile, self.segments(), &mut plan.records[first..]);
        plan.tiles.push(tile);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::Backend as _;
    use crate::cut::cpu::Cpu;
    use crate::frame::Rigid3;
    use crate::passes::spatial::motion::MotionTable;
    use crate::passes::spatial::straight_hob::StraightHob;
    use glam::DMat3;
    use std::f64::consts::{PI, TAU};

    /// A machine that trembles by steps, which no polynomials follow: every frame sees another surface, and what one of
    /// them culls may be lowest in another.
    #[test]
    fn a_motion_with_steps_loses_no_pass() {
        let (module_mm, teeth, pitch_radius_mm) = (2.0, 40.0, 30.0);
        let radius_mm = 0.5 * module_mm * teeth;
        let hob = StraightHob::new(module_mm, 1, pitch_radius_mm);
        // A flank of the space that is cut about tool angle 0, as a plane through the pitch point.
        let (sin, cos) = 20_f64.to_radians().sin_cos();
        let out = DVec3::new(-1.0, 0.0, 0.0);
        let around = DVec3::Z.cross(out);
        let pitch_mm = radius_mm * out + 0.25 * PI * module_mm * around;
        let (normal, along) = (sin * out - cos * around, cos * out + sin * around);
        for seed in 0..2 {
            let of = |angle: f64, axis: f64| (1e3 * (1.7 * angle).floor() + 7.0 * axis + f64::from(seed)).sin();
            let turns = 3.0 * teeth;
            let motion = MotionTable::new([-0.5 * turns * TAU, 0.5 * turns * TAU], &[], |angle| Rigid3 {
                rotation: DMat3::from_rotation_y(-angle / teeth) * DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
                translation_mm: DVec3::new(pitch_radius_mm + radius_mm, angle / (TAU * teeth), 0.0)
                    + 3e-3 * DVec3::new(of(angle, 0.0), of(angle, 1.0), of(angle, 2.0)),
            });
            let set = TurningPasses::new(0, &hob, 1.0, motion).expect("a hob");
            for (columns, apart_mm) in [(40, 0.05), (33, 0.08)] {
                let field = SpatialField::new(columns, 40, -0.5, |column, row| {
                    let place = [column as f64 - 0.5 * columns as f64, row as f64 - 20.0];
                    let origin_mm = pitch_mm + place[0] * apart_mm * along + place[1] * 0.05 * DVec3::Z;
                    (Ray { origin_mm, normal }, 3.0)
                });
                let cut = |plan: &SweepPlan| {
                    let mut layer = field.blank_layer();
                    Cpu::default().cut_spatial(&field, plan, &mut layer).expect("cuts");
                    layer
                };
                let [plan, all] = [SweepPlan::new, SweepPlan::brute_force].map(|make| make(&field, &set));
                let (few, every) = (cut(&plan), cut(&all));
                let lost = (0..field.len()).filter(|&i| few.heights_mm[i] != every.heights_mm[i]);
                let lost: Vec<usize> = lost.collect();
                assert!(lost.is_empty(), "seed {seed}, {columns} columns: {} dexels, {:?}", lost.len(), lost[0]);
                assert!(few.passes == every.passes && 8 * plan.records.len() < all.records.len());
            }
        }
    }
}
