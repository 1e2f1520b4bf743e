//! The blades' segments over a column of rays: which of them a pass brings near, and how high it leaves the rays.
//!
//! In: the smooth edge that all blades share with the depth of their roughness, and the passes near a field. Out: the
//! segments that rays can meet, bounds of the height that a pass leaves, and whether it surely stays above a height.
//!
//! **The law.** Where the edge is convex the tool lies inside each of its flanks and lands with the tangents at their
//! ends, so that a ray in front of one of these is in front of the tool. Of a corner's arc the circle lies in the tool,
//! not round it, and says nothing of the rest. Of a drawn edge with a hollow no segment says anything of the others.

use super::near::Near;
use super::phase_heights::PhaseHeights;
use super::shared_segment::{Beside, SegmentEntry, SharedSegment, TOLERANCE_MM};
use gearcut_core::dexel::field::Column;
use gearcut_core::passes::planar::near::MAX_PHASES;
use gearcut_core::tool::edge::{Edge, Segment};

/// Hits this far beyond a segment's end still count, as in the kernels, mm.
pub(super) const END_OVERLAP_MM: f64 = 1e-9;

/// A set of the blade's segments, one bit each.
pub(super) type SegmentSet = u128;

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
            SharedSegment::new(segment, depth_mm, edge.is_convex)
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
        for [origin, direction] in pass.looks(ray) {
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

    /// Whether a column's rays, and rays beside them, surely come out of a pass's tool where they begin to count, or
    /// are past it there: they do not enter it further up. So it is with blades in the space behind the tooth, half of
    /// all that come near. Asked of passes whose edge is looked at once.
    pub fn misses(&self, pass: &Near, ray: &Column, segments: SegmentSet, beside: Beside) -> bool {
        let [pose] = &pass.poses[..] else { return false };
        let beside = Beside { apart_mm: beside.apart_mm + pass.travel_mm, ..beside };
        let mut flanks = self.of(segments).filter(|(_, part)| part.holds_tool());
        flanks.any(|(_, part)| part.is_passed(pose, ray, 2.0 * ray.low_mm, beside))
    }

    /// A pass over a column: which segments can meet its rays, and how high it leaves them.
    ///
    /// A convex tool lies inside each of its flanks and lands with the tangents at their ends: it
    /// enters no lower than the highest of their entries, nor lower than all those of the segments that the rays can
    /// meet (others are not looked at), and just there if that one lies on its segment. Between the phases at which
    /// this is looked at heights follow a parabola nearly, which passes the lines between its samples by an eighth of
    /// their second difference; half of it is allowed for, and what the pass wanders from a parabola itself. Rough
    /// edges stay within their depth of the smooth ones.
    pub fn reaching(&self, near: usize, pass: &Near, ray: &Column, segments: SegmentSet) -> Option<Reaching> {
        let mut bounds = [EntryBounds::NONE; MAX_PHASES];
        for (_, part) in self.of(segments) {
            let SharedSegment { depth_mm, .. } = part;
            // The edge as far out as any blade's, and as far in.
            let outer = part.entries(pass, ray, *depth_mm);
            let inner = if *depth_mm > 0.0 { part.entries(pass, ray, -depth_mm) } else { outer };
            for (bounds, (outer, inner)) in bounds.iter_mut().zip(outer.into_iter().zip(inner)) {
                bounds.add(part, outer, inner, 2.0 * ray.low_mm);
            }
        }
        let samples = bounds.map(|bounds| bounds.heights_mm());
        // Below twice the ray's lowest height nothing is recorded.
        if samples.iter().all(|s| !s[0].is_finite() || s[0] <= 2.0 * ray.low_mm) {
            return None;
        }
        let [entry_mm, sure_mm] = [0, 1].map(|bound| samples.map(|sample| sample[bound]));
        let fall = bounds.iter().map(|bounds| bounds.fall).fold(1.0, f64::min);
        let tolerance_mm = TOLERANCE_MM + pass.wander_mm / fall;
        let margin_mm = |[a, b, c]: [f64; MAX_PHASES]| 0.5 * (a - 2.0 * b + c).abs() + tolerance_mm;
        // Where it misses the rays at a phase, nothing says how heights run from there to the next one.
        let lowest = if entry_mm.iter().all(|height_mm| height_mm.is_finite()) {
            PhaseHeights(entry_mm).raised(-margin_mm(entry_mm))
        } else {
            PhaseHeights::even(entry_mm.into_iter().fold(f64::INFINITY, f64::min) - tolerance_mm)
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
}

/// Bounds of the height at which a ray enters the tool through one of some segments.
#[derive(Debug, Clone, Copy)]
struct EntryBounds {
    /// The highest of those through segments in which the tool lies.
    inside_mm: f64,
    /// The lowest of all, and the lowest that is sure.
    lowest_and_sure_mm: [f64; 2],
    /// The least fall of all.
    fall: f64,
}

impl EntryBounds {
    /// Those of no segment.
    const NONE: Self = Self { inside_mm: f64::NEG_INFINITY, lowest_and_sure_mm: [f64::INFINITY; 2], fall: 1.0 };

    /// With another segment, as far out as any blade's and as far in; no entry counts below some height.
    fn add(&mut self, part: &SharedSegment, outer: Option<SegmentEntry>, inner: Option<SegmentEntry>, below_mm: f64) {
        let Some(outer) = outer else { return };
        let [from, to] = part.segment.y_range_mm;
        let is_on = |entry: &SegmentEntry| (from..=to).contains(&entry.y_mm);
        if part.is_of_convex && is_on(&outer) || part.holds_tool() {
            self.inside_mm = self.inside_mm.max(outer.height_mm);
        }
        self.fall = self.fall.min(outer.fall);
        let sure = inner.filter(|entry| is_on(entry) && entry.height_mm > below_mm);
        let [lowest_mm, sure_mm] = &mut self.lowest_and_sure_mm;
        *lowest_mm = lowest_mm.min(outer.height_mm);
        *sure_mm = sure.map_or(*sure_mm, |entry| sure_mm.min(entry.height_mm));
    }

    /// No lower than the first (infinite: it does not enter), and the second if it surely enters.
    fn heights_mm(&self) -> [f64; 2] {
        let [lowest_mm, sure_mm] = self.lowest_and_sure_mm;
        [lowest_mm.max(self.inside_mm), sure_mm]
    }
}
