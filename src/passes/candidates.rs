//! Tiles and the passes that can leave the lowest surface on them.
//!
//! Every (dexel, pass) pair costs, so a tile (up to 16 columns by all rows) visits only passes that can matter. Pass k is left out when some other pass is **lower at every dexel of the
//! tile, for certain**: see [`super::bounds`]. First a coarse look with cheap refusals finds the handful of passes near the lowest surface, then a finer one in quarters
//! of the tile decides. What the bounds cannot judge (a ray grazing a corner round, a segment met partly beyond its end) is kept unless its box stays clear of the rays
//! below the surface that is already certain. Equality with brute force over all passes is tested bit for bit.
//!
//! Road not taken: the contact moment from the meshing condition. It knows only the finishing envelope; roughing, plunges, partial turns and undercut need no
//! special case here.

use super::bounds::{BladeRay, Sampling, SegmentBounds, Verdict, undominated};
use super::near::{NearPass, near_passes};
use super::record::PassRecord;
use super::strokes::StrokeSet;
use crate::dexel::field::{Column, Field};
use crate::frame::Rigid2;
use crate::tool::PlanarTool;
use crate::tool::edge::Edge;
use glam::DVec2;
use std::ops::Range;

/// Most columns of a tile; narrower tiles carry fewer passes per dexel but more records.
pub const TILE_COLUMNS: usize = 16;
/// Tiles are no wider than this where the columns are coarse: twice the width of a facet at 4,200 strokes. Wider ones collect passes of many facets.
const TILE_WIDTH_MM: f64 = 0.08;
/// Tiles of fewer dexels than this are widened all the same: planning one costs about as much as some thousand dexel-passes.
const MIN_TILE_DEXELS: usize = 4096;
/// Cells across a tile in which dominance is decided.
const CELLS: usize = 4;
/// Some columns and the passes that they visit.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Columns of the field.
    pub columns: Range<usize>,
    /// Origin of the tile's frame, gear frame, mm; axes are parallel to the gear's.
    pub origin_mm: DVec2,
    /// Records in [`CutPlan::records`], in order of pass id.
    pub records: Range<usize>,
}

/// Everything a backend needs to run one operation over one field.
#[derive(Debug, Clone, PartialEq)]
pub struct CutPlan {
    /// Tiles, covering all columns.
    pub tiles: Vec<Tile>,
    /// Records of all tiles.
    pub records: Vec<PassRecord>,
    /// Phase tau of every row.
    pub row_phases: Vec<f64>,
}

impl CutPlan {
    /// Plan with candidate passes only.
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method's path is not general enough in its lifetimes"
    )]
    pub fn new(field: &Field, set: &StrokeSet, tool: &dyn PlanarTool) -> Self {
        Self::build(field, set, tool, |planner, near, columns, seeds| planner.candidates(near, columns, seeds))
    }

    /// Plan with every segment of every pass that can reach the field: what candidates are proved against.
    pub fn brute_force(field: &Field, set: &StrokeSet, tool: &dyn PlanarTool) -> Self {
        let segments = tool.edge().segments.len();
        Self::build(field, set, tool, |_, near, _, _| {
            (0..near.len()).flat_map(|pass| (0..segments).map(move |segment| (pass, segment))).collect()
        })
    }

    fn build(
        field: &Field,
        set: &StrokeSet,
        tool: &dyn PlanarTool,
        choose: impl Fn(&Planner, &[NearPass], &[Column], &mut Vec<usize>) -> Vec<(usize, usize)>,
    ) -> Self {
        let planner = Planner { edge: tool.edge(), bounds: SegmentBounds::new(&tool.edge().segments) };
        let (center, reach) = Field::circle(&field.columns);
        let near = near_passes(set, tool, center, reach);
        let blades: Vec<Rigid2> = (0..tool.blade_count()).map(|b| tool.tool_from_blade(b).inverse()).collect();
        let (mut tiles, mut records) = (Vec::new(), Vec::new());
        let mut seeds = Vec::new();
        let length_mm = field.columns.last().map_or(0.0, |last| last.arc_mm - field.columns[0].arc_mm);
        let spacing_mm = length_mm / field.columns.len().saturating_sub(1).max(1) as f64;
        let by_width = (TILE_WIDTH_MM / spacing_mm.max(1e-9)).round() as usize;
        let width = by_width.max(MIN_TILE_DEXELS / field.rows().max(1)).clamp(1, TILE_COLUMNS);
        for start in (0..field.columns.len()).step_by(width) {
            let columns = start..(start + width).min(field.columns.len());
            let rays = &field.columns[columns.clone()];
            let middle = rays[rays.len() / 2];
            let first = records.len();
            for (pass, segment_index) in choose(&planner, &near, rays, &mut seeds) {
                let NearPass { stroke, blade, .. } = near[pass];
                let segment = &planner.bounds.segments[segment_index];
                let mut record = PassRecord::new(
                    set,
                    stroke,
                    blade,
                    &blades[blade as usize],
                    segment_index,
                    segment,
                    middle.origin_mm,
                );
                let (o, n) = record.ray_in_segment(DVec2::ZERO, middle.normal, 0.0);
                record.start_mm = segment.enter(o, n).map_or(2.0 * middle.low_mm, |hit| hit.height_mm);
                records.push(record);
            }
            tiles.push(Tile { columns, origin_mm: middle.origin_mm, records: first..records.len() });
        }
        let row_phases = field.leads_mm.iter().map(|&lead| set.law.tau(lead)).collect();
        Self { tiles, records, row_phases }
    }

    /// (Dexel, pass) pairs that the plan visits.
    pub fn dexel_passes(&self) -> u64 {
        let rows = self.row_phases.len() as u64;
        self.tiles.iter().map(|t| t.columns.len() as u64 * t.records.len() as u64 * rows).sum()
    }
}

/// Chooses candidates for tiles of one field.
struct Planner<'a> {
    edge: &'a Edge,
    bounds: SegmentBounds<'a>,
}

impl Planner<'_> {
    /// (Index of near pass, segment) pairs that may leave the lowest surface somewhere on the tile, in time order.
    ///
    /// `seeds` carries the lowest passes of the neighbouring tile: good first guesses make early refusals cheap.
    fn candidates(&self, near: &[NearPass], rays: &[Column], seeds: &mut Vec<usize>) -> Vec<(usize, usize)> {
        let Some(phases) = near.first().map(|pass| pass.blade_from_work.len()) else { return Vec::new() };
        let middle = rays[rays.len() / 2];
        let ends = rays[0].origin_mm.distance(rays[rays.len() - 1].origin_mm);
        let coarse_places = places(rays, 2);
        let coarse = sampling(&coarse_places);
        // The lowest heights that are certain so far, place by place and phase by phase, and over the whole tile.
        let mut ceilings_mm: Vec<f64> =
            coarse_places.iter().flat_map(|ray| std::iter::repeat_n(ray.blank_mm, phases)).collect();
        let mut ceiling_mm = rays.iter().map(|ray| ray.blank_mm).fold(0.0, f64::max);
        let (mut judged, mut unjudged) = (Vec::new(), Vec::new());
        let mut blade_rays = Vec::new();
        let scouts = seeds.iter().copied().chain((0..near.len()).step_by(16)).map(|pass| (pass, false));
        for (pass, keep) in scouts.chain((0..near.len()).map(|pass| (pass, true))) {
            let travel_mm = travel_mm(&near[pass], &middle);
            let margin_mm = ends + travel_mm;
            blade_rays.clear();
            blade_rays.extend(BladeRay::of_pass(&near[pass], &coarse_places));
            // The middle place's ray against the whole blade's circle before any segment is looked at.
            let middle_rays = phases..2 * phases;
            let passes_by = |ray: &BladeRay| {
                ray.direction.perp_dot(self.edge.center_mm - ray.origin_mm).abs() > self.edge.reach_mm + margin_mm
            };
            if blade_rays[middle_rays.clone()].iter().all(passes_by) {
                continue;
            }
            for segment in 0..self.bounds.segments.len() {
                let heights_mm = [coarse.floor_mm, ceiling_mm];
                if !self.bounds.box_meets(&blade_rays[middle_rays.clone()], segment, heights_mm, margin_mm)
                    || self.bounds.stays_above(&blade_rays, segment, &coarse, &ceilings_mm, travel_mm)
                {
                    continue;
                }
                match self.bounds.judge(near, pass, segment, &coarse) {
                    Verdict::Unjudged if keep => unjudged.push((pass, segment)),
                    Verdict::Clear | Verdict::Unjudged => {}
                    Verdict::Judged(samples) => {
                        if samples.certain {
                            let highest = samples.heights_mm.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                            ceiling_mm = ceiling_mm.min(highest + samples.error_mm);
                            for (ceiling, height) in ceilings_mm.iter_mut().zip(&samples.heights_mm) {
                                *ceiling = ceiling.min(height + samples.error_mm);
                            }
                        }
                        if keep {
                            judged.push(samples);
                        }
                    }
                }
            }
        }
        let fine_places = places(rays, CELLS);
        let fine = sampling(&fine_places);
        let mut finely_judged = Vec::new();
        for coarse in undominated(judged, 2) {
            match self.bounds.judge(near, coarse.pass, coarse.segment, &fine) {
                Verdict::Clear => {}
                Verdict::Unjudged => unjudged.push((coarse.pass, coarse.segment)),
                Verdict::Judged(samples) => finely_judged.push(samples),
            }
        }
        let mut chosen: Vec<(usize, usize)> =
            undominated(finely_judged, CELLS).iter().map(|s| (s.pass, s.segment)).collect();
        *seeds = chosen.iter().map(|&(pass, _)| pass).collect();
        seeds.dedup();
        chosen.extend(unjudged.into_iter().filter(|&(pass, segment)| {
            let margin_mm = ends + travel_mm(&near[pass], &middle);
            let rays: Vec<BladeRay> = BladeRay::of_pass(&near[pass], &[middle]).collect();
            self.bounds.box_meets(&rays, segment, [fine.floor_mm, ceiling_mm], margin_mm)
        }));
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }
}

/// `cells` + 1 rays evenly across a tile.
fn places(rays: &[Column], cells: usize) -> Vec<Column> {
    (0..=cells).map(|i| rays[i * (rays.len() - 1) / cells]).collect()
}

fn sampling(places: &[Column]) -> Sampling<'_> {
    let (first, last) = (places[0], places[places.len() - 1]);
    let length_mm = (last.arc_mm - first.arc_mm).max(1e-9);
    Sampling {
        places,
        cell_mm: places.windows(2).map(|p| p[1].arc_mm - p[0].arc_mm).fold(0.0, f64::max),
        turn_per_mm: (last.normal - first.normal).length() / length_mm,
        floor_mm: 2.0 * first.low_mm,
    }
}

/// How far the blade moves against the ray's origin during its stroke, mm.
fn travel_mm(pass: &NearPass, ray: &Column) -> f64 {
    let mut places = pass.blade_from_work.iter().map(|blade_from_work| blade_from_work.point(ray.origin_mm));
    let Some(first) = places.next() else { return 0.0 };
    places.map(|p| p.distance(first)).fold(0.0, f64::max)
}
