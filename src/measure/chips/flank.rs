//! The chip with which every place of a flank got its surface.
//!
//! In: the job and a field of rays on a flank (few of them: those of a map). Out, after each operation: uncut chip thickness, the part of the cutter's edge that took it, and the pass.
//!
//! **Definition.** Every pass that touches a ray is taken in strict order of time, over all operations so far. A pass that lies lower than all before it lowers the surface; the material between is solid, for
//! no earlier pass has reached it. Its length along the ray times the cosine between ray and edge normal is the thickness across the chip: where the edge runs parallel to the surface that it finds, as it does within milliradians
//! from stroke to stroke, the distance between them. The last pass that lowers the surface leaves it. Where it is the first pass of all, the chip reaches to the blank's surface or to the end of the ray, half a pitch out.
//!
//! The candidates that suffice for heights do not do here: the pass before the last one may lie above it on a whole tile, and be pruned. Heights are f64 throughout: on finished flanks the edge goes through the
//! contact, chips are thinner than a micrometre, and the ledger's sections, good to a tenth of a micrometre, would not see them. Away from the contact by t strokes, passes stand c t^2 over the target
//! (c is four times the height of a scallop, t at most a half on the surface that is left), so thickness runs from 0 at one end of a facet through c in its middle to 2 c at the other.

use super::edge_polygon::EdgeSide;
use crate::dexel::field::{Column, Field, NO_PASS};
use crate::frame::Rigid2;
use crate::job::{Job, PreparedOperation};
use crate::passes::bounds::MAX_PHASES;
use crate::passes::near::{NearPass, near_passes};
use crate::tool::edge::{Edge, Segment, SegmentShape};
use crate::tool::{CuttingTool, PlanarTool};
use arrayvec::ArrayVec;
use glam::DVec2;

/// Hits this far beyond a segment's end still count, as in the kernels, mm.
const END_OVERLAP_MM: f64 = 1e-9;

/// Part of the edge as maps have it: 0 for none.
pub fn side_code(side: Option<EdgeSide>) -> u32 {
    side.map_or(0, |side| side as u32 + 1)
}

/// The last chips on a field after one operation, column by column (rows contiguous).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LastChips {
    /// Uncut chip thickness, mm; NaN where no pass came.
    pub thickness_mm: Vec<f32>,
    /// Part of the edge: 0 none, 1 right, 2 tip, 3 left.
    pub sides: Vec<u32>,
    /// The pass; [`NO_PASS`] where none came.
    pub passes: Vec<u32>,
}

/// What a ray knows at some moment.
#[derive(Debug, Clone, Copy)]
struct Surface {
    height_mm: f64,
    thickness_mm: f64,
    side: Option<EdgeSide>,
    pass: u32,
}

/// One pass that comes near the field.
struct Near {
    operation: usize,
    stroke: usize,
    blade: u32,
    /// Poses of the work in the blade frame at both ends and in the middle of its way along the face, or the only one.
    blade_from_work: ArrayVec<Rigid2, MAX_PHASES>,
    /// How far the blade moves meanwhile, mm.
    travel_mm: f64,
}

/// A set of the blade's segments, one bit each.
type SegmentSet = u64;

/// The blade's segments, each with the motion into its frame.
struct Segments<'a> {
    edge: &'a Edge,
    parts: Vec<(&'a Segment, Rigid2)>,
}

/// Chips that left the surface after each operation, in their order.
pub fn last_chips(job: &Job, field: &Field) -> Vec<LastChips> {
    let leads_mm: &[f64] = if job.rows_are_alike() { &[0.0] } else { &field.leads_mm };
    let segments = Segments::new(job.cutter.edge());
    let blades: Vec<Rigid2> = (0..job.cutter.blade_count()).map(|b| job.cutter.tool_from_blade(b).inverse()).collect();
    let near = passes_near(job, field);
    // Passes whose edge can meet a column's rays, in order of time, and which segments of it.
    let reaching: Vec<Vec<(usize, SegmentSet)>> = field
        .columns
        .iter()
        .map(|ray| {
            let meeting = near.iter().map(|pass| segments.meeting(pass, ray)).enumerate();
            meeting.filter(|&(_, segments)| segments != 0).collect()
        })
        .collect();
    let mut after: Vec<Vec<Surface>> = vec![Vec::new(); job.operations.len()];
    let rows: Vec<Vec<Rigid2>> = leads_mm
        .iter()
        .map(|&lead_mm| {
            let pose = |pass: &Near| {
                let set = &job.operations[pass.operation].strokes;
                blades[pass.blade as usize].after(&set.pose_at(pass.stroke, set.law.tau(lead_mm)).inverse())
            };
            near.iter().map(pose).collect()
        })
        .collect();
    for (ray, passes) in field.columns.iter().zip(&reaching) {
        for blade_from_work in &rows {
            let mut surface = Surface { height_mm: ray.blank_mm, thickness_mm: f64::NAN, side: None, pass: NO_PASS };
            let mut passes = passes.iter().peekable();
            for (operation, after) in after.iter_mut().enumerate() {
                while let Some(&(i, set)) = passes.next_if(|&&(i, _)| near[i].operation == operation) {
                    let id = job.operations[operation].strokes.pass_id(near[i].stroke, near[i].blade);
                    segments.lower(&mut surface, &blade_from_work[i], ray, id, set);
                }
                after.push(surface);
            }
        }
    }
    let copies = field.rows() / leads_mm.len();
    after.into_iter().map(|surfaces| LastChips::new(&surfaces, copies)).collect()
}

impl LastChips {
    fn new(surfaces: &[Surface], copies: usize) -> Self {
        let all = || surfaces.iter().flat_map(|surface| std::iter::repeat_n(surface, copies));
        Self {
            thickness_mm: all().map(|s| s.thickness_mm as f32).collect(),
            sides: all().map(|s| side_code(s.side)).collect(),
            passes: all().map(|s| s.pass).collect(),
        }
    }
}

impl<'a> Segments<'a> {
    fn new(edge: &'a Edge) -> Self {
        let parts = edge.segments.iter().map(|segment| (segment, segment.blade_from_segment.inverse())).collect();
        Self { edge, parts }
    }

    /// Segments whose places across a column's rays lie in their range somewhere on the way of a pass.
    fn meeting(&self, pass: &Near, ray: &Column) -> SegmentSet {
        let mut set = 0;
        for blade_from_work in &pass.blade_from_work {
            let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
            if direction.perp_dot(self.edge.center_mm - origin).abs() > self.edge.reach_mm + pass.travel_mm {
                continue;
            }
            for (index, (segment, segment_from_blade)) in self.parts.iter().enumerate() {
                let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
                let ends = [2.0 * ray.low_mm, ray.blank_mm].map(|h| o.y + h * n.y);
                let [from, to] = [segment.y_range_mm[0] - pass.travel_mm, segment.y_range_mm[1] + pass.travel_mm];
                if ends[0].max(ends[1]) >= from - END_OVERLAP_MM && ends[0].min(ends[1]) <= to + END_OVERLAP_MM {
                    set |= 1 << index;
                }
            }
        }
        set
    }

    /// Takes one pass from a ray.
    fn lower(&self, surface: &mut Surface, blade_from_work: &Rigid2, ray: &Column, pass: u32, set: SegmentSet) {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        // Kernels follow rays down to twice their lowest height and record the lowest one there.
        let below_mm = 2.0 * ray.low_mm;
        let mut lowest: Option<(f64, f64, EdgeSide)> = None;
        for (segment, segment_from_blade) in
            self.parts.iter().enumerate().filter(|(index, _)| set & (1 << index) != 0).map(|(_, part)| part)
        {
            let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
            if is_above(segment, o, n, surface.height_mm) {
                continue;
            }
            let [from, to] = [segment.y_range_mm[0] - END_OVERLAP_MM, segment.y_range_mm[1] + END_OVERLAP_MM];
            let Some(hit) = segment.enter(o, n).filter(|hit| (from..=to).contains(&hit.y_mm)) else { continue };
            if hit.height_mm > below_mm && lowest.is_none_or(|(h, ..)| hit.height_mm < h) {
                lowest = Some((hit.height_mm, hit.normal.dot(n).abs(), EdgeSide::of(segment.name)));
            }
        }
        let Some((height_mm, cosine, side)) = lowest else { return };
        let height_mm = height_mm.max(ray.low_mm);
        if height_mm < surface.height_mm {
            let thickness_mm = (surface.height_mm - height_mm) * cosine;
            *surface = Surface { height_mm, thickness_mm, side: Some(side), pass };
        }
    }
}

/// All passes of all operations near a field, in order of time.
fn passes_near(job: &Job, field: &Field) -> Vec<Near> {
    let (center_mm, reach_mm) = Field::circle(&field.columns);
    let of_operation = |(operation, prepared): (usize, &PreparedOperation)| {
        let near = near_passes(&prepared.strokes, &job.cutter, center_mm, reach_mm);
        near.into_iter().map(move |pass| {
            let middle = *pass.middle();
            let strays = |pose: &Rigid2| {
                let turn = (pose.rotation - middle.rotation).length();
                pose.point(center_mm).distance(middle.point(center_mm)) + turn * reach_mm
            };
            let travel_mm = pass.blade_from_work.iter().map(strays).fold(0.0, f64::max);
            let NearPass { stroke, blade, blade_from_work } = pass;
            Near { operation, stroke, blade, blade_from_work, travel_mm }
        })
    };
    job.operations.iter().enumerate().flat_map(of_operation).collect()
}

/// Whether a ray that runs into a segment does so above a height, by one look at the segment there: the residual of a convex segment is convex in h, so where it is positive and falls its root lies higher.
fn is_above(segment: &Segment, o: DVec2, n: DVec2, height_mm: f64) -> bool {
    let SegmentShape::Table(_) = segment.shape else { return false };
    let [x, slope] = segment.x_and_slope(o.y + height_mm * n.y);
    o.x + height_mm * n.x > x && n.x < slope * n.y
}
