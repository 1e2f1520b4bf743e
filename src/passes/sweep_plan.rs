//! Tiles of a spatial field and the sweeps that can leave the lowest surface on them.
//!
//! A field is halved again and again, down to tiles of 16 by 32 dexels; at every level the passes that the level above has kept are sampled on nine rays, and those go that another
//! one surely undercuts (see `sweep_bounds`). A flank hobbed in twenty cycles is reached by some two thousand sweeps; half of them fall in the first halvings,
//! where a sample stands for a thousand dexels, so that the tiles themselves see a dozen.
//!
//! Equality with brute force over all passes is tested bit for bit.

use super::hob_teeth::{BladePass, HobTeeth};
use super::sweep::{Meeting, Sweep, SweepRecord};
use super::sweep_bounds::{Judge, Region};
use crate::dexel::{Ray, SpatialField};
use crate::tool::edge::Edge;
use glam::DVec3;
use std::ops::Range;

/// Columns of a tile at most.
pub const TILE_COLUMNS: usize = 16;
/// Rows of a tile at most: whole chunks of every backend.
pub const TILE_ROWS: usize = 32;

/// A blade's sweep by one of its segments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The pass.
    pub pass: BladePass,
    /// Index of the segment in the blade's edge.
    pub segment: usize,
}

/// Some dexels and the sweeps that they visit.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepTile {
    /// Columns of the field.
    pub columns: Range<usize>,
    /// Rows of the field.
    pub rows: Range<usize>,
    /// Origin of the tile's frame, gear frame, mm; axes are parallel to the gear's.
    pub origin_mm: DVec3,
    /// Records in [`SweepPlan::records`], in order of pass id.
    pub records: Range<usize>,
}

/// Everything a backend needs to run one operation over one field.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweepPlan {
    /// Tiles, covering all dexels.
    pub tiles: Vec<SweepTile>,
    /// Records of all tiles.
    pub records: Vec<SweepRecord>,
}

impl SweepPlan {
    /// Plan with candidate passes only.
    pub fn new(field: &SpatialField, set: &HobTeeth, edge: &Edge) -> Self {
        Planner { field, set, edge, prune: true }.plan()
    }

    /// Plan with every segment of every pass that can reach the field at all: what candidates are proved against.
    pub fn brute_force(field: &SpatialField, set: &HobTeeth, edge: &Edge) -> Self {
        Planner { field, set, edge, prune: false }.plan()
    }

    /// (Dexel, pass) pairs that the plan visits.
    pub fn dexel_passes(&self) -> u64 {
        self.tiles.iter().map(|t| (t.columns.len() * t.rows.len() * t.records.len()) as u64).sum()
    }
}

struct Planner<'a> {
    field: &'a SpatialField,
    set: &'a HobTeeth,
    edge: &'a Edge,
    prune: bool,
}

impl Planner<'_> {
    fn plan(&self) -> SweepPlan {
        let mut plan = SweepPlan::default();
        if self.field.is_empty() {
            return plan;
        }
        let (columns, rows) = (0..self.field.columns(), 0..self.field.rows());
        let region = Region::new(self.field, columns.clone(), rows.clone());
        let near: Vec<Candidate> = near_passes(self.set, self.edge, region.origin_mm, region.reach_mm)
            .into_iter()
            .flat_map(|pass| (0..self.edge.segments.len()).map(move |segment| Candidate { pass, segment }))
            .collect();
        self.halve(columns, rows, near, f64::from(self.field.blank_mm.iter().copied().fold(0.0, f32::max)), &mut plan);
        plan
    }

    fn halve(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        candidates: Vec<Candidate>,
        ceiling_mm: f64,
        plan: &mut SweepPlan,
    ) {
        let region = Region::new(self.field, columns.clone(), rows.clone());
        let (kept, ceiling_mm) = if self.prune {
            Judge { set: self.set, edge: self.edge, region: &region }.keep(&candidates, ceiling_mm)
        } else {
            (candidates, ceiling_mm)
        };
        let (tiles_wide, tiles_long) = (columns.len().div_ceil(TILE_COLUMNS), rows.len().div_ceil(TILE_ROWS));
        if tiles_wide == 1 && tiles_long == 1 {
            self.tile(columns, rows, &region, &kept, plan);
            return;
        }
        // Across where it is longer: facets are some two and a half times as long as wide.
        let [width_mm, length_mm] = region.extent_mm();
        if tiles_long == 1 || (tiles_wide > 1 && 2.5 * width_mm > length_mm) {
            let middle = columns.start + tiles_wide / 2 * TILE_COLUMNS;
            self.halve(columns.start..middle, rows.clone(), kept.clone(), ceiling_mm, plan);
            self.halve(middle..columns.end, rows, kept, ceiling_mm, plan);
        } else {
            let middle = rows.start + tiles_long / 2 * TILE_ROWS;
            self.halve(columns.clone(), rows.start..middle, kept.clone(), ceiling_mm, plan);
            self.halve(columns, middle..rows.end, kept, ceiling_mm, plan);
        }
    }

    fn tile(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        region: &Region,
        kept: &[Candidate],
        plan: &mut SweepPlan,
    ) {
        let first = plan.records.len();
        let middle = Ray { origin_mm: DVec3::ZERO, normal: region.middle().normal };
        for of_pass in kept.chunk_by(|a, b| a.pass.pass == b.pass.pass) {
            let pass = &of_pass[0].pass;
            let Some(sweep) = Sweep::new(self.set, pass, region.origin_mm, region.reach_mm) else { continue };
            plan.records.extend(of_pass.iter().map(|candidate| {
                let segment = &self.edge.segments[candidate.segment];
                let mut record = sweep.record(pass.pass, candidate.segment, segment);
                record.start_mm = match record.enter(segment, &middle, 0.0) {
                    Meeting::Enters(hit) => hit.height_mm,
                    Meeting::Leaves | Meeting::Missed => 2.0 * self.field.low_mm,
                };
                record
            }));
        }
        plan.tiles.push(SweepTile { columns, rows, origin_mm: region.origin_mm, records: first..plan.records.len() });
    }
}

/// Passes whose blade comes within `reach_mm` of a place of the work, in time order.
///
/// While the rake face goes through the neighbourhood the place itself moves in the head, and with it everything within reach turns a little: some per cent of
/// the sweep. The bound takes a tenth of the reach for that, and a millimetre more.
fn near_passes(set: &HobTeeth, edge: &Edge, center_mm: DVec3, reach_mm: f64) -> Vec<BladePass> {
    let margin_mm = 1.1 * reach_mm + 1.0;
    let y_reach_mm = edge.center_mm.y.abs() + edge.reach_mm;
    let tip_mm = edge.center_mm.x + edge.reach_mm;
    (0..set.count())
        .map(|index| set.pass(index))
        .filter(|pass| {
            let place = set.place(pass);
            // Where the place stands when the blade points to it, to the first order of the motion in between.
            let at = |swept: f64| set.motion.head_from_work(pass.tool_angle_rad + set.turn * swept).point(center_mm);
            let first = at(0.0);
            if first.x.hypot(first.y) - margin_mm > tip_mm + 20.0 + 0.2 * reach_mm {
                return false;
            }
            let swept = first.y.atan2(first.x);
            let second = at(swept);
            let spread = reach_mm / (second.x.hypot(second.y) - reach_mm).max(0.25 * tip_mm);
            let moved_mm = (at(swept + spread.min(1.0)) - at(swept - spread.min(1.0))).length();
            let margin_mm = margin_mm + moved_mm;
            second.x.hypot(second.y) <= tip_mm + margin_mm
                && (second.z - place.axial_mm).abs() <= y_reach_mm + margin_mm
                && swept.abs() <= super::hob_teeth::SWEEP_RAD + spread
        })
        .collect()
}
