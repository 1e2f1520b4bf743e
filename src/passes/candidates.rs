//! Tiles and the passes that can leave the lowest surface on them.
//!
//! Every (dexel, pass) pair costs, so a tile (16 columns by all rows) visits only passes that can matter. The bound is one of dominance: pass k is left out
//! when some other pass is **lower at every dexel of the tile, for certain**. Between sampled rays (tile ends and three places between them; both ends and the middle of the
//! stroke) the height of a pass is its bilinear interpolation within an error of C L^2 / 8, where C bounds its second derivative. With the target's curvature k_t, the edge's
//! curvature k_e, the angle theta between ray and edge normal and the height a over the target, differentiating the hit along the profile twice gives
//!
//! `a'' = (1 + a k_t) / cos^2 theta [ k_e (1 + a k_t) / cos theta - k_t ] + k_t (1 + a k_t) tan^2 theta + a k_t' tan theta`
//!
//! C takes absolute values and half as much again for what varies inside the tile. A difference of two bilinear functions is extreme at corners, so comparing at sample corners with both
//! errors added decides for the whole cell. What the bounds cannot judge (a ray grazing a corner round, a segment met beyond its end) is kept unless circles show
//! that it stays clear. Equality with brute force over all passes is tested bit for bit.
//!
//! Road not taken: the contact moment from the meshing condition. It knows only the finishing envelope; roughing, plunges, partial turns and undercut need no
//! special case here.

use super::record::PassRecord;
use super::strokes::StrokeSet;
use super::window::{NearPass, near_passes};
use crate::dexel::field::{Column, Field};
use crate::frame::Rigid2;
use crate::tool::CuttingTool;
use crate::tool::edge::{Segment, SegmentShape};
use glam::DVec2;
use std::ops::Range;

/// Columns of a tile: twice the width of a facet at 4,200 strokes and 5 um; wider tiles carry more passes per dexel, narrower ones more records.
pub const TILE_COLUMNS: usize = 16;
/// Cells across a tile in which dominance is decided.
const CELLS: usize = 4;
/// Safety on the bound of the second derivative, for what varies between samples.
const CURVATURE_SAFETY: f64 = 1.5;
/// Rays steeper than this against an edge's normal (cosine) are judged by circles instead of interpolation.
const GRAZING_COSINE: f64 = 0.25;

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
    pub fn new(field: &Field, set: &StrokeSet, tool: &dyn CuttingTool) -> Self {
        Self::build(field, set, tool, |planner, near, columns, seeds| planner.candidates(near, columns, seeds))
    }

    /// Plan with every segment of every pass that can reach the field: what candidates are proved against.
    pub fn brute_force(field: &Field, set: &StrokeSet, tool: &dyn CuttingTool) -> Self {
        let segments = tool.edge().segments.len();
        Self::build(field, set, tool, |_, near, _, _| {
            (0..near.len()).flat_map(|pass| (0..segments).map(move |segment| (pass, segment))).collect()
        })
    }

    fn build(
        field: &Field,
        set: &StrokeSet,
        tool: &dyn CuttingTool,
        choose: impl Fn(&Planner, &[NearPass], &[Column], &mut Vec<usize>) -> Vec<(usize, usize)>,
    ) -> Self {
        let planner = Planner { segments: &tool.edge().segments };
        let (center, reach) = Field::circle(&field.columns);
        let near = near_passes(set, tool, center, reach);
        let blades: Vec<Rigid2> = (0..tool.blade_count()).map(|b| tool.tool_from_blade(b).inverse()).collect();
        let (mut tiles, mut records) = (Vec::new(), Vec::new());
        let mut seeds = Vec::new();
        for start in (0..field.columns.len()).step_by(TILE_COLUMNS) {
            let columns = start..(start + TILE_COLUMNS).min(field.columns.len());
            let rays = &field.columns[columns.clone()];
            let middle = rays[rays.len() / 2];
            let first = records.len();
            for (pass, segment_index) in choose(&planner, &near, rays, &mut seeds) {
                let NearPass { stroke, blade, .. } = near[pass];
                let segment = &planner.segments[segment_index];
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
                record.start_mm = segment.enter(o, n).map_or(0.0, |hit| hit.height_mm);
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
    segments: &'a [Segment],
}

/// Heights of one segment's pass at the sample rays of a tile.
struct Samples {
    pass: usize,
    segment: usize,
    /// Place by place across the tile, phase by phase.
    heights_mm: Vec<f64>,
    /// Error of interpolation between neighbouring places.
    error_mm: f64,
    /// All samples and all that lies between them hit the segment itself, not its continuation.
    certain: bool,
}

/// What the bounds make of a segment's pass over a tile.
enum Verdict {
    Clear,
    Judged(Samples),
    Unjudged,
}

impl Planner<'_> {
    /// (Index of near pass, segment) pairs that may leave the lowest surface somewhere on the tile, in time order.
    ///
    /// `seeds` carries the lowest passes of the neighbouring tile: good first guesses make early refusals cheap.
    fn candidates(&self, near: &[NearPass], rays: &[Column], seeds: &mut Vec<usize>) -> Vec<(usize, usize)> {
        let middle = rays[rays.len() / 2];
        let (first, last) = (rays[0], rays[rays.len() - 1]);
        let width_mm = (last.arc_mm - first.arc_mm).max(first.origin_mm.distance(last.origin_mm));
        // Heights of different passes cannot approach each other by more than this within half a tile: both slopes are below the grazing limit.
        let slope_limit = 2.0 * (1.0 / (GRAZING_COSINE * GRAZING_COSINE) - 1.0).sqrt();
        let half_tile_mm = 0.5 * width_mm * slope_limit;
        let mut ceiling_mm = middle.blank_mm;
        let mut judged: Vec<Samples> = Vec::new();
        let mut unjudged = Vec::new();
        let coarse = [first, middle, last];
        let mut look = |pass: usize, ceiling_mm: &mut f64, keep: bool| {
            for segment in 0..self.segments.len() {
                if self.stays_above(&near[pass], segment, &middle, *ceiling_mm + half_tile_mm) {
                    continue;
                }
                match self.judge(near, pass, segment, &coarse, width_mm) {
                    Verdict::Clear => {}
                    Verdict::Unjudged if keep => unjudged.push((pass, segment)),
                    Verdict::Unjudged => {}
                    Verdict::Judged(samples) => {
                        if samples.certain {
                            let highest = samples.heights_mm.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                            *ceiling_mm = ceiling_mm.min(highest + samples.error_mm);
                        }
                        if keep {
                            judged.push(samples);
                        }
                    }
                }
            }
        };
        for &seed in seeds.iter() {
            look(seed, &mut ceiling_mm, false);
        }
        for pass in (0..near.len()).step_by(16) {
            look(pass, &mut ceiling_mm, false);
        }
        for pass in 0..near.len() {
            look(pass, &mut ceiling_mm, true);
        }
        let survivors = undominated(judged, 2);
        let places: Vec<Column> = (0..=CELLS).map(|i| rays[i * (rays.len() - 1) / CELLS]).collect();
        let cell_mm = places.windows(2).map(|p| p[1].arc_mm - p[0].arc_mm).fold(0.0, f64::max);
        let mut fine = Vec::new();
        for coarse in survivors {
            match self.judge(near, coarse.pass, coarse.segment, &places, cell_mm) {
                Verdict::Clear => {}
                Verdict::Unjudged => unjudged.push((coarse.pass, coarse.segment)),
                Verdict::Judged(samples) => fine.push(samples),
            }
        }
        let fine = undominated(fine, CELLS);
        let (center, reach) = Field::circle(
            &rays.iter().map(|ray| Column { blank_mm: ceiling_mm.min(ray.blank_mm), ..*ray }).collect::<Vec<_>>(),
        );
        let comes_near = |&(pass, segment): &(usize, usize)| {
            let segment = &self.segments[segment];
            near[pass].blade_from_work.iter().any(|blade_from_work| {
                blade_from_work.point(center).distance(segment.blade_from_segment.translation_mm)
                    < segment.reach_mm + reach + self.travel_mm(&near[pass], center)
            })
        };
        let mut chosen: Vec<(usize, usize)> = fine.iter().map(|s| (s.pass, s.segment)).collect();
        *seeds = chosen.iter().map(|&(pass, _)| pass).collect();
        chosen.extend(unjudged.into_iter().filter(comes_near));
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }

    /// How far the blade moves against a point of the work during its stroke.
    fn travel_mm(&self, pass: &NearPass, point_mm: DVec2) -> f64 {
        let places = pass.blade_from_work.iter().map(|blade_from_work| blade_from_work.point(point_mm));
        let first = pass.blade_from_work[0].point(point_mm);
        places.map(|p| p.distance(first)).fold(0.0, f64::max)
    }

    /// Whether the segment surely meets the middle ray above `ceiling_mm`: one residual instead of a root.
    ///
    /// The residual of a convex segment falls ever more slowly, so one Newton step from the ceiling cannot overshoot the entry.
    fn stays_above(&self, pass: &NearPass, segment: usize, ray: &Column, ceiling_mm: f64) -> bool {
        let segment = &self.segments[segment];
        let aim = ray.origin_mm + ceiling_mm * ray.normal;
        let blade_from_work = &pass.blade_from_work[pass.blade_from_work.len() / 2];
        let in_segment = segment.blade_from_segment.rotation;
        let turn = DVec2::new(in_segment.x, -in_segment.y);
        let p = turn.rotate(blade_from_work.point(aim) - segment.blade_from_segment.translation_mm);
        let n = turn.rotate(blade_from_work.direction(ray.normal));
        let (residual_mm, slope) = match &segment.shape {
            SegmentShape::Table(table) => {
                let [x, slope] = table.x_and_slope(p.y);
                (p.x - x, slope)
            }
            SegmentShape::Arc { radius_mm } => {
                let from_center = p + DVec2::new(*radius_mm, 0.0);
                (from_center.length() - radius_mm, -from_center.y / from_center.x)
            }
        };
        let rate = match &segment.shape {
            SegmentShape::Table(_) => n.x - slope * n.y,
            SegmentShape::Arc { radius_mm } => n.dot(p + DVec2::new(*radius_mm, 0.0)) / (residual_mm + radius_mm),
        };
        let travel_mm = 4.0 * self.travel_mm(pass, aim);
        residual_mm > 0.0 && rate < 0.0 && residual_mm > (travel_mm + 1e-3) * -rate
    }

    /// Samples one segment's pass at `places` across the tile.
    fn judge(&self, near: &[NearPass], pass: usize, segment_index: usize, places: &[Column], cell_mm: f64) -> Verdict {
        let segment = &self.segments[segment_index];
        let segment_from_blade = segment.blade_from_segment.inverse();
        let phases = &near[pass].blade_from_work;
        let turn_per_mm = (places[places.len() - 1].normal - places[0].normal).length()
            / (places[places.len() - 1].arc_mm - places[0].arc_mm).max(1e-9);
        let (mut heights_mm, mut curvature) = (Vec::with_capacity(places.len() * phases.len()), 0.0_f64);
        let (mut y_low, mut y_high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut missed, mut away) = (false, 0);
        for ray in places {
            for blade_from_work in phases {
                let origin = segment_from_blade.point(blade_from_work.point(ray.origin_mm));
                let direction = segment_from_blade.direction(blade_from_work.direction(ray.normal));
                let leaves = |slope: f64| direction.x - slope * direction.y > 0.05;
                if segment.slope_range.iter().all(|&slope| leaves(slope)) {
                    away += 1;
                    continue;
                }
                let Some(hit) = segment.enter(origin, direction) else {
                    missed = true;
                    continue;
                };
                let cos = -hit.normal.dot(direction);
                if cos < GRAZING_COSINE {
                    missed = true;
                    continue;
                }
                let tan = (1.0 - cos * cos).max(0.0).sqrt() / cos;
                let stretch = 1.0 + (hit.height_mm * turn_per_mm).abs();
                let margin_mm = 2.0 * cell_mm * stretch / cos;
                let edge_curvature = [-margin_mm, 0.0, margin_mm]
                    .map(|dy| match &segment.shape {
                        SegmentShape::Table(table) => table.curvature(hit.y_mm + dy).abs(),
                        SegmentShape::Arc { radius_mm } => 1.0 / radius_mm,
                    })
                    .into_iter()
                    .fold(hit.curvature_per_mm.abs(), f64::max);
                let bound = stretch / (cos * cos) * (edge_curvature * stretch / cos + turn_per_mm)
                    + turn_per_mm * stretch * tan * tan;
                curvature = curvature.max(bound);
                y_low = y_low.min(hit.y_mm);
                y_high = y_high.max(hit.y_mm);
                heights_mm.push(hit.height_mm);
            }
        }
        if away == places.len() * phases.len() {
            return Verdict::Clear;
        }
        if missed || away > 0 {
            return Verdict::Unjudged;
        }
        let slack_mm = 0.25 * (y_high - y_low) + 1e-6;
        let [y_start, y_end] = segment.y_range_mm;
        if y_low - slack_mm > y_end || y_high + slack_mm < y_start {
            return Verdict::Clear;
        }
        let along_profile_mm = CURVATURE_SAFETY * curvature * cell_mm * cell_mm / 8.0;
        // Along the stroke the middle phase shows the bend; an eighth of the second difference over the half range is the error of a chord.
        let along_stroke_mm = heights_mm
            .chunks_exact(phases.len())
            .filter(|h| h.len() == 3)
            .map(|h| CURVATURE_SAFETY * (h[0] - 2.0 * h[1] + h[2]).abs() / 8.0)
            .fold(0.0, f64::max);
        let certain = y_low - slack_mm > y_start && y_high + slack_mm < y_end;
        let error_mm = along_profile_mm + along_stroke_mm + 1e-9;
        Verdict::Judged(Samples { pass, segment: segment_index, heights_mm, error_mm, certain })
    }
}

/// Leaves out every pass that another, certain one undercuts at all corners of all cells (cell by cell).
fn undominated(samples: Vec<Samples>, cells: usize) -> Vec<Samples> {
    let Some(any) = samples.first() else { return samples };
    let per_place = any.heights_mm.len() / (cells + 1);
    let corners = |cell: usize| cell * per_place..(cell + 2) * per_place;
    // In each cell the certain passes that are lowest at one of its corners: at most a handful, and no other can rule.
    let rulers: Vec<Vec<usize>> = (0..cells)
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
    let rules = |ruler: &Samples, k: &Samples, cell: usize| {
        corners(cell).all(|c| k.heights_mm[c] - ruler.heights_mm[c] > k.error_mm + ruler.error_mm)
    };
    let keep: Vec<bool> = samples
        .iter()
        .map(|k| !(0..cells).all(|cell| rulers[cell].iter().any(|&ruler| rules(&samples[ruler], k, cell))))
        .collect();
    samples.into_iter().zip(keep).filter_map(|(sample, keep)| keep.then_some(sample)).collect()
}
