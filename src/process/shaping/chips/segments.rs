//! The blades' segments over a column of rays: which of them a pass brings near, and how high it leaves the rays.
//!
//! In: the smooth edge that all blades share with the depth of their roughness, and the passes near a field. Out: the
//! segments that rays can meet, bounds of the height that a pass leaves, and whether it surely stays above a height.
//!
//! **The law.** The edge is convex: the tool lies inside each of its flanks and lands with the tangents at their ends,
//! so that a ray in front of one of these is in front of the tool. Of a corner's arc the circle lies in the tool, not
//! round it, and says nothing of the rest.

use crate::process::shaping::{PreparedOperation, ShapingJob};
use arrayvec::ArrayVec;
use gearcut_core::dexel::field::{Column, Field};
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::planar::near::{MAX_PHASES, NearPass, PhasePoses, near_passes};
use gearcut_core::tool::edge::{Edge, Segment, SegmentShape};
use glam::DVec2;

/// Hits this far beyond a segment's end still count, as in the kernels, mm.
pub(super) const END_OVERLAP_MM: f64 = 1e-9;
/// What the bounds of a pass's heights are widened by, mm.
const TOLERANCE_MM: f64 = 1e-6;

/// One pass that comes near the field.
pub(super) struct Near {
    pub operation: usize,
    pub stroke: usize,
    pub blade: u32,
    /// Poses of the work in the blade frame at both ends and in the middle of its travel along the face, or the only
    /// one.
    blade_from_work: PhasePoses,
    /// How far the blade moves meanwhile, mm.
    travel_mm: f64,
}

/// A set of the blade's segments, one bit each.
pub(super) type SegmentSet = u64;

/// Heights over a column's rays at the phases where passes are looked at, mm: between these they follow a parabola. All
/// three are equal where strokes are frozen.
///
/// Where a guide leads the cutter aside, or the feed goes on, all passes come to other heights at other phases, and
/// alike: compared phase by phase a few dozen nanometres tell them apart, where their heights anywhere on the column
/// overlap by micrometres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhaseHeights([f64; MAX_PHASES]);

impl PhaseHeights {
    /// The same height at every phase.
    pub fn even(height_mm: f64) -> Self {
        Self([height_mm; MAX_PHASES])
    }

    /// Whether it is as high as another or higher at every phase.
    pub fn covers(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(own, other)| own >= other)
    }

    /// Whether it comes as low as another at any phase. Bounds hold between phases as well: what they are widened by
    /// holds how far parabolas dip there.
    pub fn reaches(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).any(|(own, other)| own <= other)
    }

    /// The same, higher by so much.
    pub fn raised(self, by_mm: f64) -> Self {
        Self(self.0.map(|height_mm| height_mm + by_mm))
    }

    /// The highest of its heights at the phases.
    pub fn highest_mm(&self) -> f64 {
        self.0.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether it lies lower than another in the mean.
    pub fn is_lower(&self, other: &Self) -> bool {
        self.0.iter().sum::<f64>() < other.0.iter().sum::<f64>()
    }

    /// Height at a phase.
    pub fn at_mm(&self, tau: f64) -> f64 {
        let [before, middle, after] = self.0;
        middle + 0.5 * tau * (after - before + tau * (before - 2.0 * middle + after))
    }
}

/// A pass whose edge can meet a column's rays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reaching {
    /// Place among the passes near the field.
    pub near: usize,
    /// Segments that can meet the rays.
    pub segments: SegmentSet,
    /// The pass leaves none of the column's rays lower than this.
    pub lowest: PhaseHeights,
    /// It leaves none higher than this; infinite where it may miss one.
    pub highest: PhaseHeights,
}

/// A segment of the smooth edge that all blades share.
pub(super) struct SharedSegment<'a> {
    segment: &'a Segment,
    pub segment_from_blade: Rigid2,
    /// How far blades stay within it along x, mm.
    depth_mm: f64,
    /// How much nearer a ray can stand in front of it than another one, as a share of how far they lie apart.
    nearer: f64,
}

impl SharedSegment<'_> {
    /// Whether the whole tool lies inside the segment and the tangents at its ends: not inside a corner's arc, whose
    /// circle lies in the tool.
    fn holds_tool(&self) -> bool {
        matches!(self.segment.shape, SegmentShape::Table(_))
    }

    /// The same where no blade's edge is rough, so that a ray in front of the segment is in front of every tool.
    pub fn holds_smooth_tool(&self) -> bool {
        self.depth_mm == 0.0 && self.holds_tool()
    }

    /// Whether the segment surely stays behind some heights on a column's rays, and on rays within `apart_mm` of these,
    /// at every phase of a pass.
    fn is_behind(&self, pass: &Near, ray: &Column, heights: &PhaseHeights, apart_mm: f64) -> bool {
        let Self { segment, segment_from_blade, depth_mm, nearer } = self;
        let mut residuals_mm: ArrayVec<f64, MAX_PHASES> = ArrayVec::new();
        for (blade_from_work, &height_mm) in pass.blade_from_work.iter().zip(&heights.0) {
            let o = segment_from_blade.point(blade_from_work.point(ray.origin_mm));
            let n = segment_from_blade.direction(blade_from_work.direction(ray.normal));
            let Some(residual_mm) = residual_mm(segment, o, n, height_mm) else { return false };
            residuals_mm.push(residual_mm);
        }
        let bend_mm = if let [a, b, c] = residuals_mm[..] { (a - 2.0 * b + c).abs() } else { 0.0 };
        let margin_mm = 0.5 * bend_mm + TOLERANCE_MM + depth_mm + apart_mm * nearer;
        residuals_mm.iter().all(|&residual_mm| residual_mm > margin_mm)
    }
}

/// The blades' segments.
pub(super) struct Segments<'a> {
    edge: &'a Edge,
    parts: Vec<SharedSegment<'a>>,
    /// Largest depth of all parts, mm.
    depth_mm: f64,
}

impl<'a> Segments<'a> {
    /// Those of a smooth edge, and how far the edges of blades, segment by segment, stay within it: none for blades
    /// that are smooth themselves.
    pub fn new(edge: &'a Edge, of_blades: &[Edge]) -> Self {
        let part = |(index, segment): (usize, &'a Segment)| {
            let depth_mm = of_blades.iter().map(|edge| edge.segments[index].depth_mm()).fold(0.0, f64::max);
            let steepest = segment.slope_range.map(f64::abs).into_iter().fold(0.0, f64::max);
            let segment_from_blade = segment.blade_from_segment.inverse();
            SharedSegment { segment, segment_from_blade, depth_mm, nearer: steepest.hypot(1.0) }
        };
        let parts: Vec<SharedSegment> = edge.segments.iter().enumerate().map(part).collect();
        let depth_mm = parts.iter().map(|part| part.depth_mm).fold(0.0, f64::max);
        Self { edge, parts, depth_mm }
    }

    /// The segments of a set, with their places in the edge.
    pub fn of(&self, set: SegmentSet) -> impl Iterator<Item = (usize, &SharedSegment<'a>)> {
        self.parts.iter().enumerate().filter(move |(index, _)| set & (1 << index) != 0)
    }

    /// Segments whose places across a column's rays, or across rays that stay within `apart_mm` of these, lie in their
    /// range somewhere along a pass.
    pub fn meeting(&self, pass: &Near, ray: &Column, apart_mm: f64) -> SegmentSet {
        let mut set = 0;
        let around_mm = pass.travel_mm + apart_mm;
        for blade_from_work in pass.blade_from_work.iter() {
            let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
            let reach_mm = self.edge.reach_mm + self.depth_mm + around_mm;
            if direction.perp_dot(self.edge.center_mm - origin).abs() > reach_mm {
                continue;
            }
            for (index, SharedSegment { segment, segment_from_blade, .. }) in self.parts.iter().enumerate() {
                let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
                let ends = [2.0 * ray.low_mm, ray.blank_mm].map(|h| o.y + h * n.y);
                let [from, to] = [segment.y_range_mm[0] - around_mm, segment.y_range_mm[1] + around_mm];
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
    /// this is looked at heights follow a parabola nearly, which passes the lines between its samples by an eighth of
    /// their second difference; half of it is allowed for. Rough edges stay within their depth of the smooth ones.
    pub fn reaching(&self, near: usize, pass: &Near, ray: &Column, segments: SegmentSet) -> Option<Reaching> {
        let at_phases =
            pass.blade_from_work.iter().map(|blade_from_work| self.entry_mm(blade_from_work, ray, segments));
        let at_phases: ArrayVec<[f64; 2], MAX_PHASES> = at_phases.collect();
        let samples: [[f64; 2]; MAX_PHASES] = std::array::from_fn(|phase| at_phases[phase.min(at_phases.len() - 1)]);
        // Below twice the ray's lowest height nothing is recorded.
        if samples.iter().all(|s| !s[0].is_finite() || s[0] <= 2.0 * ray.low_mm) {
            return None;
        }
        let [entry_mm, sure_mm] = [0, 1].map(|bound| samples.map(|sample| sample[bound]));
        let margin_mm = |[a, b, c]: [f64; MAX_PHASES]| 0.5 * (a - 2.0 * b + c).abs() + TOLERANCE_MM;
        // Where it misses the rays at a phase, nothing says how heights run from there to the next one.
        let lowest = if entry_mm.iter().all(|height_mm| height_mm.is_finite()) {
            PhaseHeights(entry_mm).raised(-margin_mm(entry_mm))
        } else {
            PhaseHeights::even(entry_mm.into_iter().fold(f64::INFINITY, f64::min) - TOLERANCE_MM)
        };
        let highest = if sure_mm.iter().all(|height_mm| height_mm.is_finite()) {
            let highest = PhaseHeights(sure_mm).raised(margin_mm(sure_mm));
            PhaseHeights(highest.0.map(|height_mm| height_mm.max(ray.low_mm)))
        } else {
            PhaseHeights::even(f64::INFINITY)
        };
        Some(Reaching { near, segments, lowest, highest })
    }

    /// Whether a pass surely leaves a column's rays, and rays that stay within `apart_mm` of these, higher than some
    /// heights: at every phase it is looked at they run into each of its segments from there on, or into a flank or
    /// land in whose inside the whole tool lies, by one look at the edge instead of a root.
    ///
    /// How far a ray stands in front of a segment is convex in the height, and falls where the ray runs into it: lower
    /// down it stands further away. A ray that stays within a of this one stands nearer by a sqrt(1 + s^2) at most, s
    /// the steepest slope of the segment; for an arc by a.
    pub fn stays_above(
        &self,
        pass: &Near,
        ray: &Column,
        segments: SegmentSet,
        heights: &PhaseHeights,
        apart_mm: f64,
    ) -> bool {
        let mut in_front_of_all = true;
        for (_, part) in self.of(segments) {
            if !part.is_behind(pass, ray, heights, apart_mm) {
                in_front_of_all = false;
            } else if part.holds_tool() {
                return true;
            }
        }
        in_front_of_all
    }

    /// Bounds of the height at which a ray enters the tool through one of the given segments: no lower than the first
    /// (infinite: it does not), and the second if it surely enters.
    fn entry_mm(&self, blade_from_work: &Rigid2, ray: &Column, set: SegmentSet) -> [f64; 2] {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        let (mut inside_mm, mut lowest_mm, mut sure_mm) = (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY);
        for (_, part) in self.of(set) {
            let SharedSegment { segment, segment_from_blade, depth_mm, .. } = part;
            let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
            let [from, to] = segment.y_range_mm;
            // The edge as far out as any blade's, and as far in.
            let out = DVec2::new(*depth_mm, 0.0);
            let Some(hit) = segment.enter(o - out, n) else { continue };
            let on_segment = (from..=to).contains(&hit.y_mm);
            if on_segment || part.holds_tool() {
                inside_mm = inside_mm.max(hit.height_mm);
            }
            lowest_mm = lowest_mm.min(hit.height_mm);
            let deepest = if *depth_mm > 0.0 { segment.enter(o + out, n) } else { Some(hit) };
            let sure = deepest.filter(|hit| (from..=to).contains(&hit.y_mm) && hit.height_mm > 2.0 * ray.low_mm);
            sure_mm = sure.map_or(sure_mm, |hit| sure_mm.min(hit.height_mm));
        }
        [lowest_mm.max(inside_mm), sure_mm]
    }
}

/// All passes of all operations near a field, in order of time.
pub(super) fn passes_near(job: &ShapingJob, field: &Field) -> Vec<Near> {
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

/// How far a ray stands in front of a segment at a height, mm, if it runs into the segment from there on; negative
/// behind it. Segments are convex, and so is this in the height: where it is positive the ray enters higher up, if at
/// all.
pub(super) fn residual_mm(segment: &Segment, o: DVec2, n: DVec2, height_mm: f64) -> Option<f64> {
    let at = o + height_mm * n;
    match segment.shape {
        SegmentShape::Table(_) => {
            let [x, slope] = segment.x_and_slope(at.y);
            (n.x < slope * n.y).then_some(at.x - x)
        }
        SegmentShape::Arc { radius_mm } => {
            let from_center = at + DVec2::new(radius_mm, 0.0);
            (n.dot(from_center) < 0.0).then(|| from_center.length() - radius_mm)
        }
    }
}
