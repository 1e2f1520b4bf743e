//! One segment of the edge that all blades share, over a column of rays.
//!
//! In: the smooth segment with the depth of its roughness, a pass and a ray. Out: whether the segment stays behind some
//! heights, where the ray enters it, and whether the ray is past it.
//!
//! **One look for a pass that drifts.** How far a place stands in front of a segment is convex: where a shift takes the
//! place it stands in front by no less than the first order of the shift says. So what one look at the middle of the
//! face shows, with its gradient, answers for all phases ([`super::near`]). Entries at the ends of the face follow from
//! that in the middle by one step of Newton's.

use super::near::Near;
use super::phase_heights::PhaseHeights;
use gearcut_core::dexel::field::Column;
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::planar::near::MAX_PHASES;
use gearcut_core::tool::edge::{RayHit, Segment, SegmentShape};
use glam::DVec2;

/// What the bounds of a pass's heights are widened by, mm.
pub(super) const TOLERANCE_MM: f64 = 1e-6;
/// Longest step of Newton's that is the last one, mm. At the rate below it leaves less than half of [`TOLERANCE_MM`]
/// where the edge's radius is above 20 micrometres.
const LAST_STEP_MM: f64 = 3e-5;
/// Least fall of the residual along a ray at which entries follow from others beside them.
const STEEP_FALL: f64 = 0.05;

/// A segment of the smooth edge that all blades share.
pub(super) struct SharedSegment<'a> {
    pub segment: &'a Segment,
    pub segment_from_blade: Rigid2,
    /// How far blades stay within it along x, mm.
    pub depth_mm: f64,
    /// Whether the whole edge is convex.
    pub is_of_convex: bool,
    /// How much nearer a ray can stand in front of it than another one, as a share of how far they lie apart.
    nearer: f64,
    /// How much its slope differs at most between two places, for each mm between them; endless for an arc, round which
    /// rays are not followed.
    bend_per_mm: f64,
}

/// Rays that lie beside one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    /// How far places of the same height lie apart, mm.
    pub apart_mm: f64,
    /// How much directions differ, length of the difference of unit vectors.
    pub turned: f64,
}

impl Beside {
    /// The ray itself.
    pub const ALONE: Self = Self { apart_mm: 0.0, turned: 0.0 };
}

impl<'a> SharedSegment<'a> {
    /// A segment within whose smooth course blades stay by so much along x.
    pub fn new(segment: &'a Segment, depth_mm: f64, is_of_convex: bool) -> Self {
        let steepest = segment.slope_range.map(f64::abs).into_iter().fold(0.0, f64::max);
        let bend_per_mm = match &segment.shape {
            SegmentShape::Table(table) => table.largest_bend_per_mm(),
            SegmentShape::Arc { .. } => f64::INFINITY,
        };
        let segment_from_blade = segment.blade_from_segment.inverse();
        Self { segment, segment_from_blade, depth_mm, is_of_convex, nearer: steepest.hypot(1.0), bend_per_mm }
    }

    /// Whether the whole tool lies inside the segment and the tangents at its ends: not inside a corner's arc, whose
    /// circle lies in the tool, nor where the edge has a hollow.
    pub fn holds_tool(&self) -> bool {
        self.is_of_convex && matches!(self.segment.shape, SegmentShape::Table(_))
    }

    /// The same where no blade's edge is rough, so that a ray in front of the segment is in front of every tool.
    pub fn holds_smooth_tool(&self) -> bool {
        self.depth_mm == 0.0 && self.holds_tool()
    }

    /// Whether the segment surely stays behind some heights on a column's rays, and on rays within `apart_mm` of these,
    /// at every phase of a pass.
    pub fn is_behind(&self, pass: &Near, ray: &Column, heights: &PhaseHeights, apart_mm: f64) -> bool {
        let Some(residuals_mm) = self.residuals_mm(pass, ray, heights) else { return false };
        let [before, middle, after] = residuals_mm;
        let margin_mm = 0.5 * (before - 2.0 * middle + after).abs()
            + TOLERANCE_MM
            + self.depth_mm
            + (apart_mm + pass.wander_mm) * self.nearer;
        residuals_mm.iter().all(|&residual_mm| residual_mm > margin_mm)
    }

    /// No less than this a column's ray stands in front of the segment at some heights, and lower down, at each phase
    /// of a pass. `None`: it may run out of the segment there.
    fn residuals_mm(&self, pass: &Near, ray: &Column, heights: &PhaseHeights) -> Option<[f64; MAX_PHASES]> {
        let look = |pose: &Rigid2, height_mm: f64| {
            let [o, n] = self.ray(pose, ray);
            front(self.segment, o, n, height_mm).map(|front| (front, n))
        };
        let [_, middle_mm, _] = heights.0;
        let mut residuals_mm = [0.0; MAX_PHASES];
        match (&pass.poses[..], &pass.drift_mm) {
            ([pose], None) => residuals_mm = [look(pose, middle_mm)?.0.residual_mm; MAX_PHASES],
            ([pose], Some(drift_mm)) => {
                let (Front { residual_mm, gradient }, n) = look(pose, middle_mm)?;
                for (phase_mm, (shift_mm, height_mm)) in residuals_mm.iter_mut().zip(drift_mm.iter().zip(heights.0)) {
                    let shift_mm = self.segment_from_blade.direction(*shift_mm) + (height_mm - middle_mm) * n;
                    *phase_mm = residual_mm + gradient.dot(shift_mm);
                }
            }
            (poses, _) => {
                for (phase_mm, (pose, height_mm)) in residuals_mm.iter_mut().zip(poses.iter().zip(heights.0)) {
                    *phase_mm = look(pose, height_mm)?.0.residual_mm;
                }
            }
        }
        Some(residuals_mm)
    }

    /// Where a column's ray enters the segment or its continuation at each phase of a pass, if the edge stood out by so
    /// much along x.
    pub fn entries(&self, pass: &Near, ray: &Column, out_mm: f64) -> [Option<SegmentEntry>; MAX_PHASES] {
        let place = |pose: &Rigid2| {
            let [o, n] = self.ray(pose, ray);
            [o - DVec2::new(out_mm, 0.0), n]
        };
        let hit = |[o, n]: [DVec2; 2]| self.segment.enter(o, n);
        let entry = |hit: RayHit, n: DVec2| {
            let RayHit { height_mm, y_mm, normal, .. } = hit;
            SegmentEntry { height_mm, y_mm, fall: -normal.dot(n) }
        };
        let enter = |[o, n]: [DVec2; 2]| hit([o, n]).map(|hit| entry(hit, n));
        match (&pass.poses[..], &pass.drift_mm) {
            ([pose], None) => [enter(place(pose)); MAX_PHASES],
            ([pose], Some(drift_mm)) => {
                let [o, n] = place(pose);
                let middle = hit([o, n]);
                drift_mm.map(|shift_mm| {
                    let shift_mm = self.segment_from_blade.direction(shift_mm);
                    let beside = middle.and_then(|hit| entry_beside(self.segment, &hit, [o, n], shift_mm));
                    beside.or_else(|| enter([o + shift_mm, n]))
                })
            }
            (poses, _) => std::array::from_fn(|phase| enter(place(&poses[phase]))),
        }
    }

    /// A column's ray in the segment's frame: its origin and direction.
    fn ray(&self, blade_from_work: &Rigid2, ray: &Column) -> [DVec2; 2] {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        [self.segment_from_blade.point(origin), self.segment_from_blade.direction(direction)]
    }

    /// Whether a column's ray, and rays beside it, are past the segment at a height: in front of it, and on the way
    /// out. So they are all the way from there on, by its convexity.
    pub fn is_passed(&self, blade_from_work: &Rigid2, ray: &Column, height_mm: f64, beside: Beside) -> bool {
        let Beside { apart_mm, turned } = beside;
        let [o, n] = self.ray(blade_from_work, ray);
        let apart_mm = apart_mm + TOLERANCE_MM;
        let least_rise = apart_mm * self.bend_per_mm + turned * self.nearer;
        let rise = |slope: f64| n.x - slope * n.y;
        if !self.segment.slope_range.into_iter().any(|slope| rise(slope) > least_rise) {
            return false;
        }
        let at = o + height_mm * n;
        let [x, slope] = self.segment.x_and_slope(at.y);
        rise(slope) > least_rise && at.x - x > self.depth_mm + apart_mm * self.nearer
    }
}

/// Where a ray enters a segment or its continuation, mm: along the ray, and along the segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct SegmentEntry {
    pub height_mm: f64,
    pub y_mm: f64,
    /// How fast the ray comes nearer there, mm per mm.
    pub fall: f64,
}

/// Where a ray enters a segment that is shifted by so much against one whose hit is known, if a step of Newton's tells.
fn entry_beside(segment: &Segment, hit: &RayHit, [o, n]: [DVec2; 2], shift_mm: DVec2) -> Option<SegmentEntry> {
    let fall = -hit.normal.dot(n);
    if fall < STEEP_FALL {
        return None;
    }
    let (o, from_mm) = (o + shift_mm, hit.height_mm + hit.normal.dot(shift_mm) / fall);
    let Front { residual_mm, gradient } = front(segment, o, n, from_mm)?;
    let step_mm = -residual_mm / gradient.dot(n);
    let height_mm = from_mm + step_mm;
    (step_mm.abs() < LAST_STEP_MM).then_some(SegmentEntry { height_mm, y_mm: o.y + height_mm * n.y, fall })
}

/// A place of a ray in front of a segment.
pub(super) struct Front {
    /// How far, mm; negative behind it.
    pub residual_mm: f64,
    /// How that grows with the place, mm per mm.
    gradient: DVec2,
}

/// How a ray stands in front of a segment at a height, mm, if it runs into the segment from there on. Segments are
/// convex, and so is this in the place: where it is positive the ray enters higher up, if at all.
pub(super) fn front(segment: &Segment, o: DVec2, n: DVec2, height_mm: f64) -> Option<Front> {
    let at = o + height_mm * n;
    match segment.shape {
        SegmentShape::Table(_) => {
            let [x, slope] = segment.x_and_slope(at.y);
            let gradient = DVec2::new(1.0, -slope);
            (n.x < slope * n.y).then_some(Front { residual_mm: at.x - x, gradient })
        }
        SegmentShape::Arc { radius_mm } => {
            let from_center = at + DVec2::new(radius_mm, 0.0);
            (n.dot(from_center) < 0.0).then(|| {
                let length_mm = from_center.length();
                Front { residual_mm: length_mm - radius_mm, gradient: from_center / length_mm }
            })
        }
    }
}
