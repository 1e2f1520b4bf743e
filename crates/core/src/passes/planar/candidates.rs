//! Tiles and the passes that can leave the lowest surface on them.
//!
//! Every (dexel, pass) pair costs, so a tile (up to 16 columns by all rows) visits only passes that can matter. Pass k
//! is left out when some other pass is **lower at every dexel of the tile, for certain**: see [`super::bounds`]. First
//! a coarse look down the trees of [`super::time_intervals`] finds the handful of passes near the lowest surface, then,
//! where a tile has dexels enough to pay for it, a finer one in quarters of the tile decides. What the bounds cannot
//! decide (a ray grazing a corner round, a segment met partly beyond its end) is kept unless its box stays clear of the
//! rays below the surface that is already certain. Equality with brute force over all passes is tested bit for bit.
//!
//! Road not taken: the contact moment from the meshing condition. It knows only the finishing envelope; roughing,
//! plunges, partial turns and undercut need no special case here.

use super::bounds::{BladeRay, MotionBound, SegmentBounds, Verdict};
use super::near::{MAX_PHASES, NearPass, near_passes};
use super::record::PassRecord;
use super::samples::{MAX_PLACES, PassSamples, Sampling, undominated};
use super::strokes::StrokeSet;
use super::time_intervals::{Content, IntervalTree, TimeInterval};
use super::upper_bound::UpperBound;
use crate::dexel::field::{Column, Field};
use crate::frame::Rigid2;
use crate::tool::PlanarTool;
use crate::tool::blade_edges::BladeEdges;
use crate::tool::edge::{Edge, Segment};
use arrayvec::ArrayVec;
use glam::DVec2;
use std::ops::Range;
use std::sync::Arc;

/// Most columns of a tile; narrower tiles carry fewer passes per dexel but more records.
pub const TILE_COLUMNS: usize = 16;
/// Tiles are no wider than this where the columns are coarse: twice the width of a facet at 4,200 strokes. Wider ones
/// collect passes of many facets.
const TILE_WIDTH_MM: f64 = 0.08;
/// Tiles of fewer dexels than this are widened all the same, and the coarse look decides where they come to fewer even
/// so: planning one costs about as much as some thousand dexel-passes.
const MIN_TILE_DEXELS: usize = 4096;
/// Cells across a tile in which dominance is decided.
const CELLS: usize = 4;
/// Cells of the first, coarse look.
const COARSE_CELLS: usize = 2;

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
    /// Segments that the records name: those of all edges of the tool, one edge after another.
    pub segments: Arc<[Segment]>,
}

impl CutPlan {
    /// Plan with candidate passes only.
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method's path is not general enough in its lifetimes"
    )]
    pub fn new(field: &Field, set: &StrokeSet, tool: &dyn PlanarTool) -> Self {
        Self::build(field, set, tool, |planner, columns, seeds| planner.candidates(columns, seeds))
    }

    /// Plan with every segment of every pass that can reach the field: what candidates are compared with.
    pub fn brute_force(field: &Field, set: &StrokeSet, tool: &dyn PlanarTool) -> Self {
        Self::build(field, set, tool, |planner, _, _| {
            let segments_of = |pass: usize| planner.edges.segments_of(planner.near[pass].blade);
            (0..planner.near.len()).flat_map(|pass| segments_of(pass).map(move |segment| (pass, segment))).collect()
        })
    }

    fn build(
        field: &Field,
        set: &StrokeSet,
        tool: &dyn PlanarTool,
        choose: impl Fn(&PassPlanner, &[Column], &mut Vec<(usize, usize)>) -> Vec<(usize, usize)>,
    ) -> Self {
        let planner = PassPlanner::new(field, set, tool);
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
            for (pass, segment_index) in choose(&planner, rays, &mut seeds) {
                let NearPass { stroke, blade, .. } = planner.near[pass];
                let segment = &planner.bounds.0[segment_index].segment;
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
        let row_phases = field.rows_z_mm.iter().map(|&z_mm| set.law.tau(z_mm)).collect();
        Self { tiles, records, row_phases, segments: tool.edges().segments().clone() }
    }

    /// The same for some of its columns, in their order, on rows at these phases: a pass is left out for every phase,
    /// so candidates hold on all rows there are.
    #[must_use]
    pub fn of_columns(&self, columns: &[usize], row_phases: Vec<f64>) -> Self {
        let place = |column: usize| columns.partition_point(|&kept| kept < column);
        let kept = |tile: &Tile| {
            let columns = place(tile.columns.start)..place(tile.columns.end);
            (!columns.is_empty()).then(|| Tile { columns, ..tile.clone() })
        };
        let tiles = self.tiles.iter().filter_map(kept).collect();
        Self { tiles, records: self.records.clone(), row_phases, segments: self.segments.clone() }
    }

    /// (Dexel, pass) pairs that the plan visits.
    pub fn dexel_passes(&self) -> u64 {
        let rows = self.row_phases.len() as u64;
        self.tiles.iter().map(|t| t.columns.len() as u64 * t.records.len() as u64 * rows).sum()
    }
}

/// Chooses candidates for tiles of one field.
struct PassPlanner<'a> {
    edges: &'a BladeEdges,
    bounds: SegmentBounds<'a>,
    near: Vec<NearPass>,
    intervals: IntervalTree,
    rows: usize,
}

/// A set of the segments of one blade's edge, one bit each.
type SegmentSet = u128;

impl<'a> PassPlanner<'a> {
    fn new(field: &Field, set: &StrokeSet, tool: &'a dyn PlanarTool) -> Self {
        let edges = tool.edges();
        let most = edges.edges().iter().map(|edge| edge.segments.len()).max().unwrap_or(0);
        assert!(most <= SegmentSet::BITS as usize, "a blade's segments fit into a set of bits");
        let (center_mm, reach_mm) = Field::circle(&field.columns);
        let near = near_passes(set, tool, center_mm, reach_mm);
        // Rays are followed down to twice their lowest height.
        let below_mm = field.columns.iter().map(|column| -column.low_mm).fold(0.0, f64::max);
        let intervals = IntervalTree::new(&near, center_mm, reach_mm + below_mm);
        Self { edges, bounds: SegmentBounds(edges.courses()), near, intervals, rows: field.rows() }
    }

    /// (Index of near pass, segment) pairs that may leave the lowest surface somewhere on the tile, in time order.
    ///
    /// `seeds` carries the lowest passes of the neighbouring tile with their segments: good first guesses make early
    /// culling cheap.
    fn candidates(&self, rays: &[Column], seeds: &mut Vec<(usize, usize)>) -> Vec<(usize, usize)> {
        let Some(phases) = self.near.first().map(|pass| pass.blade_from_work.len()) else { return Vec::new() };
        let all_segments = |blade: u32| {
            let count = self.edges.edge_of(blade).segments.len();
            SegmentSet::MAX >> (SegmentSet::BITS as usize - count)
        };
        let highest_mm = rays.iter().map(|ray| ray.blank_mm).fold(0.0, f64::max);
        let coarse_places = places(rays, COARSE_CELLS);
        let mut look = CoarseLook {
            planner: self,
            middle: rays[rays.len() / 2],
            ends_mm: rays[0].origin_mm.distance(rays[rays.len() - 1].origin_mm),
            coarse: sampling(&coarse_places),
            upper: UpperBound::new(COARSE_CELLS, phases, highest_mm),
            bounded: Vec::new(),
            undecided: Vec::new(),
        };
        let first_segment = |pass: usize| self.edges.segments_of(self.near[pass].blade).start;
        for &(pass, segment) in seeds.iter() {
            look.at_pass(pass, 1 << (segment - first_segment(pass)));
        }
        let whole = |&root: &usize| (root, all_segments(self.intervals.intervals[root].blade));
        let mut intervals: Vec<(usize, SegmentSet)> = self.intervals.roots.iter().map(whole).collect();
        while let Some((index, segments)) = intervals.pop() {
            let interval = &self.intervals.intervals[index];
            let segments = look.at_interval(interval, segments);
            match interval.content {
                _ if segments == 0 => {}
                Content::Halves([earlier, later]) => intervals.extend([(later, segments), (earlier, segments)]),
                Content::Pass(pass) => {
                    let seen = seeds.iter().filter(|(seed, _)| *seed == pass);
                    let seen = seen.fold(0, |set, (_, segment)| set | 1 << (segment - first_segment(pass)));
                    look.at_pass(pass, segments & !seen);
                }
            }
        }
        let CoarseLook { middle, ends_mm, coarse, upper, bounded, mut undecided, .. } = look;
        let (mut left, mut lowest) = undominated(bounded, COARSE_CELLS);
        if rays.len() * self.rows >= MIN_TILE_DEXELS {
            let fine_places = places(rays, CELLS);
            let fine = sampling(&fine_places);
            let mut finely_bounded = Vec::new();
            for coarse in left {
                match self.bounds.bound(&self.near[coarse.pass], coarse.pass, coarse.segment, &fine) {
                    Verdict::Clear => {}
                    Verdict::Undecided => undecided.push((coarse.pass, coarse.segment)),
                    Verdict::Bounded(samples) => finely_bounded.push(samples),
                }
            }
            (left, lowest) = undominated(finely_bounded, CELLS);
        }
        *seeds = lowest;
        let mut chosen: Vec<(usize, usize)> = left.iter().map(|s| (s.pass, s.segment)).collect();
        chosen.extend(undecided.into_iter().filter(|&(pass, segment)| {
            let pass = &self.near[pass];
            let rays: ArrayVec<BladeRay, MAX_PHASES> =
                BladeRay::of_poses(pass.blade_from_work.looks().0, &[middle]).collect();
            let margin_mm = ends_mm + travel_mm(pass, &middle);
            self.bounds.box_meets(&rays, segment, [coarse.floor_mm, upper.highest_mm], margin_mm)
        }));
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }
}

/// The coarse look at one tile: what is certain so far, and who is left.
struct CoarseLook<'a> {
    planner: &'a PassPlanner<'a>,
    middle: Column,
    ends_mm: f64,
    coarse: Sampling<'a>,
    upper: UpperBound,
    bounded: Vec<PassSamples>,
    undecided: Vec<(usize, usize)>,
}

impl CoarseLook<'_> {
    /// The segments of a time interval that some pass of it may lower the tile with.
    fn at_interval(&self, interval: &TimeInterval, mut segments: SegmentSet) -> SegmentSet {
        let PassPlanner { edges, bounds, .. } = self.planner;
        let (edge, first) = (edges.edge_of(interval.blade), edges.segments_of(interval.blade).start);
        let rays: ArrayVec<BladeRay, MAX_PLACES> =
            self.coarse.places.iter().map(|ray| BladeRay::of_pose(&interval.blade_from_work, ray)).collect();
        let middle = BladeRay::of_pose(&interval.blade_from_work, &self.middle);
        let margin_mm = self.ends_mm + interval.motion_bound.distance_mm;
        if passes_by(edge, &middle, margin_mm) {
            return 0;
        }
        for segment in members(segments) {
            let (heights_mm, place) = ([self.coarse.floor_mm, self.upper.highest_mm], first + segment);
            if !bounds.box_meets(&[middle], place, heights_mm, margin_mm)
                || bounds.stays_above(
                    (&rays, &[DVec2::ZERO]),
                    place,
                    &self.coarse,
                    &self.upper.all_phases,
                    0.0,
                    interval.motion_bound,
                )
            {
                segments &= !(1 << segment);
            }
        }
        segments
    }

    /// Samples the segments of a pass that are not culled at once, and lowers what is certain.
    fn at_pass(&mut self, index: usize, segments: SegmentSet) {
        let PassPlanner { edges, bounds, near, .. } = self.planner;
        let pass = &near[index];
        let (edge, first) = (edges.edge_of(pass.blade), edges.segments_of(pass.blade).start);
        let travel_mm = travel_mm(pass, &self.middle);
        let margin_mm = self.ends_mm + travel_mm;
        let (poses, shifts_mm) = pass.blade_from_work.looks();
        let middle: ArrayVec<BladeRay, MAX_PHASES> = BladeRay::of_poses(poses, &[self.middle]).collect();
        // The middle ray against the whole blade's circle before any segment is looked at.
        if middle.iter().all(|ray| passes_by(edge, ray, margin_mm)) {
            return;
        }
        let rays: ArrayVec<BladeRay, { MAX_PLACES * MAX_PHASES }> =
            BladeRay::of_poses(poses, self.coarse.places).collect();
        let reach_mm = self.ends_mm - self.coarse.floor_mm + self.upper.highest_mm;
        let motion_bound = MotionBound { distance_mm: pass.bend_mm(self.middle.origin_mm, reach_mm), turn_rad: 0.0 };
        for segment in members(segments).map(|segment| first + segment) {
            let heights_mm = [self.coarse.floor_mm, self.upper.highest_mm];
            if !bounds.box_meets(&middle, segment, heights_mm, margin_mm)
                || bounds.stays_above(
                    (&rays, &shifts_mm),
                    segment,
                    &self.coarse,
                    &self.upper.by_phase,
                    travel_mm,
                    motion_bound,
                )
            {
                continue;
            }
            match bounds.bound(pass, index, segment, &self.coarse) {
                Verdict::Clear => {}
                Verdict::Undecided => self.undecided.push((index, segment)),
                Verdict::Bounded(samples) => {
                    if samples.certain {
                        self.upper.lower(&samples);
                    }
                    self.bounded.push(samples);
                }
            }
        }
    }
}

/// Numbers of the segments in a set, from the first one of the blade's edge.
fn members(mut segments: SegmentSet) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let first = (segments != 0).then(|| segments.trailing_zeros() as usize)?;
        segments &= segments - 1;
        Some(first)
    })
}

/// Whether a ray stays away from the blade's circle by more than a margin.
fn passes_by(edge: &Edge, ray: &BladeRay, margin_mm: f64) -> bool {
    ray.direction.perp_dot(edge.center_mm - ray.origin_mm).abs() > edge.reach_mm + margin_mm
}

/// `cells` + 1 rays evenly across a tile.
fn places(rays: &[Column], cells: usize) -> ArrayVec<Column, MAX_PLACES> {
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
    places.map(|p| p.distance(first)).fold(0.0, f64::max) + pass.wander_mm
}
