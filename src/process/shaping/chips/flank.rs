//! The chip with which every place of a flank got its surface.
//!
//! In: the job and a field of rays on a flank (few of them: those of a map). Out, after each operation: uncut chip
//! thickness, the part of the cutter's edge that took it, and the pass.
//!
//! **Definition.** Every pass that touches a ray is taken in strict order of time, over all operations so far. A pass
//! that lies lower than all before it lowers the surface; the material between is solid, for no earlier pass has
//! reached it. Its length along the ray times the cosine between ray and edge normal is the thickness across the chip:
//! where the edge runs parallel to the surface that it finds, as it does within milliradians from stroke to stroke, the
//! distance between them. The last pass that lowers the surface leaves it. Where it is the first pass of all, the chip
//! reaches to the blank's surface or to the end of the ray, half a pitch out.
//!
//! The candidates that suffice for heights do not do here: the pass before the last one may lie above it on a whole
//! tile, and be culled. So passes are chosen column by column, from bounds of the height that each leaves on the
//! column's rays; a test holds the choice against all passes. Heights are f64 throughout: on finished flanks the edge
//! goes through the contact, chips are thinner than a micrometre, and the ledger's sections, good to a tenth of a
//! micrometre, would not see them. Away from the contact by t strokes, passes stand c t^2 over the target (c is four
//! times the height of a scallop, t at most a half on the surface that is left), so thickness runs from 0 at one end of
//! a facet through c in its middle to 2 c at the other.

use crate::measure::LastChips;
use crate::process::shaping::edge_polygon::EdgeSide;
use crate::process::shaping::{PreparedOperation, ShapingJob};
use arrayvec::ArrayVec;
use gearcut_core::dexel::field::{Column, Field, NO_PASS};
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::planar::near::{MAX_PHASES, NearPass, near_passes};
use gearcut_core::tool::edge::{Edge, Segment, SegmentShape};
use gearcut_core::tool::{CuttingTool, PlanarTool};
use glam::DVec2;

/// Hits this far beyond a segment's end still count, as in the kernels, mm.
const END_OVERLAP_MM: f64 = 1e-9;

/// What the bounds of a pass's heights are widened by, mm.
const TOLERANCE_MM: f64 = 1e-6;

/// Part of the edge as maps have it: 0 for none.
pub fn side_code(side: Option<EdgeSide>) -> u32 {
    side.map_or(0, |side| side as u32 + 1)
}

/// What a ray knows at some moment.
#[derive(Debug, Clone, Copy)]
struct RaySurface {
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
    /// Poses of the work in the blade frame at both ends and in the middle of its travel along the face, or the only
    /// one.
    blade_from_work: ArrayVec<Rigid2, MAX_PHASES>,
    /// How far the blade moves meanwhile, mm.
    travel_mm: f64,
}

/// A set of the blade's segments, one bit each.
type SegmentSet = u64;

/// A pass whose edge can meet a column's rays.
#[derive(Debug, Clone, Copy)]
struct Reaching {
    /// Place among the passes near the field.
    near: usize,
    /// Segments that can meet the rays.
    segments: SegmentSet,
    /// Lowest and highest height that the pass leaves on any of the column's rays, mm; the highest is infinite where it
    /// may miss one.
    heights_mm: [f64; 2],
}

/// Passes that can decide the last chip on any ray of a column: those that may lie lowest, and those that may lie
/// lowest of all before one of these. The others lower surfaces too, but surfaces that are gone when the last chip is
/// cut.
fn counting(reaching: &[Reaching], blank_mm: f64) -> Vec<Reaching> {
    let surely = |passes: &[Reaching]| passes.iter().map(|pass| pass.heights_mm[1]).fold(blank_mm, f64::min);
    let left_mm = surely(reaching);
    let may_rule = |pass: &Reaching| pass.heights_mm[0] <= left_mm;
    let (Some(first), Some(last)) = (reaching.iter().position(may_rule), reaching.iter().rposition(may_rule)) else {
        return Vec::new();
    };
    let before_mm = surely(&reaching[..first]);
    reaching[..=last].iter().filter(|pass| pass.heights_mm[0] <= before_mm).copied().collect()
}

/// The blade's segments, each with the motion into its frame.
struct Segments<'a> {
    edge: &'a Edge,
    parts: Vec<(&'a Segment, Rigid2)>,
}

/// Chips that left the surface after each operation, in their order.
pub fn last_chips(job: &ShapingJob, field: &Field) -> Vec<LastChips> {
    last_chips_of(job, field, counting)
}

/// The same of those passes that `choose` leaves of all that reach a column whose blank is so high.
fn last_chips_of(
    job: &ShapingJob,
    field: &Field,
    choose: impl Fn(&[Reaching], f64) -> Vec<Reaching>,
) -> Vec<LastChips> {
    let rows_z_mm: &[f64] = if job.planar().rows_are_alike() { &[0.0] } else { &field.rows_z_mm };
    let segments = Segments::new(job.cutter.edge());
    let blades: Vec<Rigid2> = (0..job.cutter.blade_count()).map(|b| job.cutter.tool_from_blade(b).inverse()).collect();
    let near = passes_near(job, field);
    let mut after: Vec<Vec<RaySurface>> = vec![Vec::new(); job.operations.len()];
    for ray in &field.columns {
        // Passes whose edge can meet the column's rays, in order of time.
        let reaching: Vec<Reaching> =
            near.iter().enumerate().filter_map(|(index, pass)| segments.reaching(index, pass, ray)).collect();
        for (operation, after) in after.iter_mut().enumerate() {
            let so_far = reaching.partition_point(|pass| near[pass.near].operation <= operation);
            let counting = choose(&reaching[..so_far], ray.blank_mm);
            for &z_mm in rows_z_mm {
                let mut surface =
                    RaySurface { height_mm: ray.blank_mm, thickness_mm: f64::NAN, side: None, pass: NO_PASS };
                for reaching in &counting {
                    let pass = &near[reaching.near];
                    let set = &job.operations[pass.operation].strokes;
                    let work_from_tool = set.pose_at(pass.stroke, set.law.tau(z_mm));
                    let blade_from_work = blades[pass.blade as usize].after(&work_from_tool.inverse());
                    let id = set.pass_id(pass.stroke, pass.blade);
                    segments.lower(&mut surface, &blade_from_work, ray, id, reaching.segments);
                }
                after.push(surface);
            }
        }
    }
    let copies = field.rows() / rows_z_mm.len();
    after.into_iter().map(|surfaces| last_chips_on(&surfaces, copies)).collect()
}

/// What the surfaces of a section say, repeated on as many rows.
fn last_chips_on(surfaces: &[RaySurface], copies: usize) -> LastChips {
    let all = || surfaces.iter().flat_map(|surface| std::iter::repeat_n(surface, copies));
    LastChips {
        thickness_mm: all().map(|s| s.thickness_mm as f32).collect(),
        sides: all().map(|s| side_code(s.side)).collect(),
        passes: all().map(|s| s.pass).collect(),
    }
}

impl<'a> Segments<'a> {
    fn new(edge: &'a Edge) -> Self {
        let parts = edge.segments.iter().map(|segment| (segment, segment.blade_from_segment.inverse())).collect();
        Self { edge, parts }
    }

    /// The segments of a set, each with the motion into its frame.
    fn of(&self, set: SegmentSet) -> impl Iterator<Item = &(&Segment, Rigid2)> {
        self.parts.iter().enumerate().filter(move |(index, _)| set & (1 << index) != 0).map(|(_, part)| part)
    }

    /// Segments whose places across a column's rays lie in their range somewhere along a pass.
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

    /// A pass over a column: which segments can meet its rays, and how high it leaves them.
    ///
    /// The tool lies inside each of its flanks and lands with the tangents at their ends, for its edge is convex: it
    /// enters no lower than the highest of their entries, nor lower than all those of the segments that the rays can
    /// meet (others are not looked at), and just there if that one lies on its segment. Between the phases at which
    /// this is looked at heights follow a parabola nearly, which passes its samples by an eighth of their second
    /// difference; half of it is allowed for.
    fn reaching(&self, near: usize, pass: &Near, ray: &Column) -> Option<Reaching> {
        let segments = self.meeting(pass, ray);
        if segments == 0 {
            return None;
        }
        let at_phases =
            pass.blade_from_work.iter().map(|blade_from_work| self.entry_mm(blade_from_work, ray, segments));
        let samples: ArrayVec<[f64; 2], MAX_PHASES> = at_phases.collect();
        // Below twice the ray's lowest height nothing is recorded.
        if samples.iter().all(|s| !s[0].is_finite() || s[0] <= 2.0 * ray.low_mm) {
            return None;
        }
        let bend = |bound: usize| match samples.as_slice() {
            [a, b, c] if [a, b, c].iter().all(|s| s[bound].is_finite()) => (a[bound] - 2.0 * b[bound] + c[bound]).abs(),
            _ => 0.0,
        };
        let low_mm = samples.iter().map(|s| s[0]).fold(f64::INFINITY, f64::min) - 0.5 * bend(0) - TOLERANCE_MM;
        let high_mm = samples.iter().map(|s| s[1]).fold(f64::NEG_INFINITY, f64::max) + 0.5 * bend(1) + TOLERANCE_MM;
        Some(Reaching { near, segments, heights_mm: [low_mm, high_mm].map(|h| h.max(ray.low_mm)) })
    }

    /// Bounds of the height at which a ray enters the tool through one of the given segments: no lower than the first
    /// (infinite: it does not), and the second if it surely enters.
    fn entry_mm(&self, blade_from_work: &Rigid2, ray: &Column, set: SegmentSet) -> [f64; 2] {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        let (mut inside_mm, mut lowest_mm, mut sure_mm) = (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY);
        for (segment, segment_from_blade) in self.of(set) {
            let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
            let Some(hit) = segment.enter(o, n) else { continue };
            let [from, to] = segment.y_range_mm;
            let on_segment = (from..=to).contains(&hit.y_mm);
            // The whole circle of a corner's arc lies in the tool, not round it.
            if on_segment || matches!(segment.shape, SegmentShape::Table(_)) {
                inside_mm = inside_mm.max(hit.height_mm);
            }
            lowest_mm = lowest_mm.min(hit.height_mm);
            if on_segment && hit.height_mm > 2.0 * ray.low_mm {
                sure_mm = sure_mm.min(hit.height_mm);
            }
        }
        [lowest_mm.max(inside_mm), sure_mm]
    }

    /// Takes one pass from a ray.
    fn lower(&self, surface: &mut RaySurface, blade_from_work: &Rigid2, ray: &Column, pass: u32, set: SegmentSet) {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        // Kernels follow rays down to twice their lowest height and record the lowest one there.
        let below_mm = 2.0 * ray.low_mm;
        let mut lowest: Option<(f64, f64, EdgeSide)> = None;
        for (segment, segment_from_blade) in self.of(set) {
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
            *surface = RaySurface { height_mm, thickness_mm, side: Some(side), pass };
        }
    }
}

/// All passes of all operations near a field, in order of time.
fn passes_near(job: &ShapingJob, field: &Field) -> Vec<Near> {
    let (center_mm, reach_mm) = Field::circle(&field.columns);
    let of_operation = |(operation, prepared): (usize, &PreparedOperation)| {
        let near = near_passes(&prepared.strokes, &job.cutter, center_mm, reach_mm);
        near.into_iter().map(move |pass| {
            let middle = *pass.middle();
            let motion_mm = |pose: &Rigid2| {
                let turn = (pose.rotation - middle.rotation).length();
                pose.point(center_mm).distance(middle.point(center_mm)) + turn * reach_mm
            };
            let travel_mm = pass.blade_from_work.iter().map(motion_mm).fold(0.0, f64::max);
            let NearPass { stroke, blade, blade_from_work } = pass;
            Near { operation, stroke, blade, blade_from_work, travel_mm }
        })
    };
    job.operations.iter().enumerate().flat_map(of_operation).collect()
}

/// Whether a ray that runs into a segment does so above a height, by one look at the segment there: the residual of a
/// convex segment is convex in h, so where it is positive and falls its root lies higher.
fn is_above(segment: &Segment, o: DVec2, n: DVec2, height_mm: f64) -> bool {
    let SegmentShape::Table(_) = segment.shape else { return false };
    let [x, slope] = segment.x_and_slope(o.y + height_mm * n.y);
    o.x + height_mm * n.x > x && n.x < slope * n.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use crate::process::shaping::scene::model::Shaping;
    use gearcut_core::terms::Side;
    use std::path::Path;

    #[test]
    fn the_passes_that_count_leave_the_chips_of_all() {
        let mut scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("the shipped scene").scene;
        for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
            operation.feed_during_stroke = true;
        }
        let job = ShapingJob::new(scene).expect("the shipped gear");
        let (mut all, mut kept) = (0, 0);
        for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
            let field = job.flank_field(job.target_flank(tooth, side));
            let columns: Vec<usize> = (0..field.columns.len()).step_by(31).collect();
            let field = field.at([&columns, &[0, 100, 300, 500, 600]]);
            let chosen = last_chips(&job, &field);
            let of_all = last_chips_of(&job, &field, |reaching, _| reaching.to_vec());
            for (chosen, of_all) in chosen.iter().zip(&of_all) {
                let bits = |chips: &LastChips| chips.thickness_mm.iter().map(|h| h.to_bits()).collect::<Vec<_>>();
                assert_eq!((&chosen.passes, bits(chosen)), (&of_all.passes, bits(of_all)));
            }
            let counted = std::cell::Cell::new([0, 0]);
            last_chips_of(&job, &field, |reaching, blank_mm| {
                let counting = counting(reaching, blank_mm);
                let [a, k] = counted.get();
                counted.set([a + reaching.len(), k + counting.len()]);
                counting
            });
            let [a, k] = counted.get();
            (all, kept) = (all + a, kept + k);
        }
        println!("{kept} of {all} passes count");
        assert!(20 * kept < all, "{kept} of {all}");
    }
}
