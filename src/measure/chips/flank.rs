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
use crate::passes::near::near_passes;
use crate::tool::edge::{Edge, Segment};
use crate::tool::{CuttingTool, PlanarTool};
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
    /// Centre of the blade's circle in the middle of its stroke, gear frame.
    center_mm: DVec2,
    /// How far the circle moves along the face, mm.
    travel_mm: f64,
}

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
    // Passes whose blade's circle meets a column's rays, in order of time.
    let reaching: Vec<Vec<usize>> = field
        .columns
        .iter()
        .map(|ray| {
            let meets = |pass: &Near| distance_mm(ray, pass.center_mm) <= segments.edge.reach_mm + pass.travel_mm;
            (0..near.len()).filter(|&i| meets(&near[i])).collect()
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
                while let Some(&&i) = passes.peek().filter(|&&&i| near[i].operation == operation) {
                    let id = job.operations[operation].strokes.pass_id(near[i].stroke, near[i].blade);
                    segments.lower(&mut surface, &blade_from_work[i], ray, id);
                    passes.next();
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

    /// Takes one pass from a ray.
    fn lower(&self, surface: &mut Surface, blade_from_work: &Rigid2, ray: &Column, pass: u32) {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        if direction.perp_dot(self.edge.center_mm - origin).abs() > self.edge.reach_mm {
            return;
        }
        // Kernels follow rays down to twice their lowest height and record the lowest one there.
        let below_mm = 2.0 * ray.low_mm;
        let mut lowest: Option<(f64, f64, EdgeSide)> = None;
        for (segment, segment_from_blade) in &self.parts {
            let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
            let [from, to] = [segment.y_range_mm[0] - END_OVERLAP_MM, segment.y_range_mm[1] + END_OVERLAP_MM];
            let ends = [below_mm, surface.height_mm].map(|h| o.y + h * n.y);
            if ends[0].max(ends[1]) < from || ends[0].min(ends[1]) > to {
                continue;
            }
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
    let blade_center_mm = job.cutter.edge().center_mm;
    let of_operation = |(operation, prepared): (usize, &PreparedOperation)| {
        let near = near_passes(&prepared.strokes, &job.cutter, center_mm, reach_mm);
        near.into_iter().map(move |pass| {
            let places = pass.blade_from_work.iter().map(|pose| pose.inverse().point(blade_center_mm));
            let center_mm = pass.middle().inverse().point(blade_center_mm);
            let travel_mm = places.map(|p| p.distance(center_mm)).fold(0.0, f64::max);
            Near { operation, stroke: pass.stroke, blade: pass.blade, center_mm, travel_mm }
        })
    };
    job.operations.iter().enumerate().flat_map(of_operation).collect()
}

/// Distance of a point from a column's rays, from twice their lowest height to the blank.
fn distance_mm(ray: &Column, point_mm: DVec2) -> f64 {
    let along_mm = (point_mm - ray.origin_mm).dot(ray.normal).clamp(2.0 * ray.low_mm, ray.blank_mm);
    (ray.origin_mm + along_mm * ray.normal).distance(point_mm)
}
