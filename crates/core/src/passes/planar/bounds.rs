//! Bounds on one segment's pass over one tile: clear of it, bounded by samples, or undecided.
//!
//! Samples are entries of the segment at a few rays across the tile (places) and at one or three phases of the stroke.
//! Between them the height is bilinear within an error C L^2 / 8, where C bounds the second derivative along the
//! profile. With the target's curvature k_t, the edge's curvature k_e, the angle theta between ray and edge normal and
//! the height a over the target, differentiating the entry along the profile twice gives
//!
//! ```text
//! a'' = (1 + a k_t) / cos^2 theta [ k_e (1 + a k_t) / cos theta - k_t ]
//!     + k_t (1 + a k_t) tan^2 theta + a k_t' tan theta
//! ```
//!
//! C takes absolute values and half as much again for what varies inside the tile.
//!
//! Most passes need no samples: a segment is convex, so it lies behind its tangent at any place, and a tile whose
//! lowest certain surface stays in front of that tangent by more than the edge can bulge between two samples is not
//! touched. The same look culls a whole time interval of strokes at once ([`super::time_intervals`]): there the tangent
//! must stay away by as much as any of the strokes moves the blade.
//!
//! A rough segment is not convex. It is bounded by its smooth course, moved out and in by the depth of its roughness.

use super::near::NearPass;
use super::samples::{PassSamples, Sampling};
use super::upper_bound::BoundHeights;
use crate::dexel::field::Column;
use crate::frame::Rigid2;
use crate::tool::edge::{RayHit, Segment, SegmentShape};
use crate::tool::segment_course::SegmentCourse;
use arrayvec::ArrayVec;
use glam::DVec2;

/// Safety on every bound of a second derivative. C is taken at the samples; between them the edge's curvature, the
/// angle of the ray and the height may raise it. No proof says that they raise it by less than half: what stands for it
/// is the comparison with all passes, bit for bit, in `tests/suite/shaping/flank_heights.rs`.
const CURVATURE_SAFETY: f64 = 1.5;
/// Rays steeper than this against an edge's normal (cosine) are not interpolated: C grows with the third power of 1 /
/// cosine, to 64 times the curvature here. A larger value is safe: what is not interpolated is undecided, and kept
/// unless its box stays clear of the rays.
const GRAZING_COSINE: f64 = 0.25;
/// How far entries between samples may lie beyond those of the samples along the segment: this share of the samples'
/// range, and [`END_MM`]. Entries that run evenly along the edge need nothing of it; for others it was found by trial
/// and has no proof. Too small, a pass is dropped whose entry lies on the segment between two samples that miss its
/// end, and the surface stays too high there. Brute force takes no samples: the comparison with it in
/// `tests/suite/shaping/flank_heights.rs` sees such a loss on the fields it looks at, and no other.
const END_SHARE: f64 = 0.25;
/// The same as a length, for entries that all lie in one place, mm: a thousand times what places are computed to.
const END_MM: f64 = 1e-6;
/// A pass whose samples all lie deeper than this below the floor is clear of the rays, mm. Between samples that stand L
/// apart heights rise above the highest of them by C L^2 / 8 at most: on a tile of the usual width (L = 0.04 mm) 1 um
/// holds up to C = 5 / mm. For wider tiles there is no proof but the comparison with all passes.
const FLOOR_MM: f64 = 1e-3;
/// A ray leaves a segment where the edge's residual rises along it by more than this per mm. The rate is linear in the
/// edge's slope, so that both ends of the slope's range decide for the whole segment, and it is a sine of the ray's
/// angle: between two rays for which it is positive it is larger than at one of them. So any positive value serves
/// where the normals turn one way between samples; this one leaves room for those that do not.
const LEAVING_SLOPE: f64 = 0.05;
/// Added to lengths that rounding may shorten, mm: coordinates of 100 mm are kept to 1e-14 mm.
const ROUNDING_MM: f64 = 1e-9;

/// What the bounds make of a segment's pass over a tile.
#[derive(Debug)]
pub enum Verdict {
    /// It cannot lower any dexel of the tile.
    Clear,
    /// Bounded by samples.
    Bounded(PassSamples),
    /// It may do anything that its box allows.
    Undecided,
}

/// A ray of the work in a blade's frame, at one phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladeRay {
    /// Origin, mm.
    pub origin_mm: DVec2,
    /// Unit direction.
    pub direction: DVec2,
}

impl BladeRay {
    /// A ray of the work seen from one pose of a blade.
    pub fn of_pose(blade_from_work: &Rigid2, ray: &Column) -> Self {
        Self { origin_mm: blade_from_work.point(ray.origin_mm), direction: blade_from_work.direction(ray.normal) }
    }

    /// All places of a tile in a pass's blade frame, place by place, pose by pose of those that are looked at.
    pub fn of_poses<'a>(poses: &'a [Rigid2], places: &'a [Column]) -> impl Iterator<Item = Self> + 'a {
        places.iter().flat_map(|ray| poses.iter().map(|blade_from_work| Self::of_pose(blade_from_work, ray)))
    }
}

/// Where a ray enters an edge that stands a little beside another one: height, place along the segment, cosine, and
/// what the height may be off by.
struct EntryBeside {
    height_mm: f64,
    y_mm: f64,
    cos: f64,
    error_mm: f64,
}

impl EntryBeside {
    /// The entry of the ray that stands `shift_mm` beside the one that enters at `hit`, in the segment's frame. Along
    /// the normal N the shift e brings the ray N e out of the tangent, and the edge falls back from that by k t^2 / 2
    /// where the ray comes to a place t further along it: it goes on by (N e + k t^2 / 2) / cos theta. Half of the bend
    /// is allowed for what the curvature changes on the way.
    fn new(hit: &RayHit, direction: DVec2, shift_mm: DVec2) -> Self {
        let cos = -hit.normal.dot(direction);
        let along = hit.normal.perp();
        let out_mm = hit.normal.dot(shift_mm);
        let t_mm = along.dot(shift_mm + out_mm / cos * direction);
        let bend_mm = 0.5 * hit.curvature_per_mm * t_mm * t_mm;
        let further_mm = (out_mm + bend_mm) / cos;
        Self {
            height_mm: hit.height_mm + further_mm,
            y_mm: hit.y_mm + shift_mm.y + further_mm * direction.y,
            cos: cos - (hit.curvature_per_mm * t_mm).abs(),
            error_mm: 0.5 * bend_mm.abs() / cos,
        }
    }
}

/// How far the poses that one look stands for may differ from the one looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionBound {
    /// Largest distance of any point of the field in the blade's frame, mm.
    pub distance_mm: f64,
    /// Largest turn, rad.
    pub turn_rad: f64,
}

/// Courses of the segments of all edges of a tool, one edge after another.
#[derive(Debug, Clone, Copy)]
pub struct SegmentBounds<'a>(pub &'a [SegmentCourse]);

impl SegmentBounds<'_> {
    /// Whether the segment's box comes within `margin_mm` of a ray between two heights, in any sampled phase; `rays`
    /// are one place's.
    pub fn box_meets(&self, rays: &[BladeRay], segment: usize, heights_mm: [f64; 2], margin_mm: f64) -> bool {
        let SegmentCourse { segment: Segment { blade_from_segment, y_range_mm, .. }, depth_mm, .. } = &self.0[segment];
        let [x_low, x_high] = self.0[segment].x_range_mm;
        // A ray through the joint of two segments meets the box of both.
        let margin_mm = margin_mm + depth_mm + ROUNDING_MM;
        let turn = DVec2::new(blade_from_segment.rotation.x, -blade_from_segment.rotation.y);
        rays.iter().any(|ray| {
            let o = turn.rotate(ray.origin_mm - blade_from_segment.translation_mm);
            let n = turn.rotate(ray.direction);
            let [mut from, mut to] = heights_mm;
            let sides = [(o.x, n.x, x_low, x_high), (o.y, n.y, y_range_mm[0], y_range_mm[1])];
            for (o, n, low, high) in sides {
                if n.abs() < 1e-12 {
                    if o < low - margin_mm || o > high + margin_mm {
                        return false;
                    }
                    continue;
                }
                let (a, b) = ((low - margin_mm - o) / n, (high + margin_mm - o) / n);
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            }
            from <= to
        })
    }

    /// Whether the segment surely meets all rays of the tile above the upper bounds, as many for each of `rays` as
    /// there are `shifts_mm` from it in the blade's frame: one residual each instead of a root.
    ///
    /// A convex segment lies behind its tangent at the aimed point's y; a ray that still runs towards it there enters
    /// it further up, and so does one beside it that is as far in front of that tangent. Between neighbouring samples
    /// the segment can bulge by `k_e L^2 / 8`, and the surface of the upper bounds by `k_t (1 + 2 s + a k_t) L^2 / 8`,
    /// its slope s and height a over a target of curvature k_t included; `motion_bound` is how far the poses themselves
    /// may differ.
    pub fn stays_above(
        &self,
        (rays, shifts_mm): (&[BladeRay], &[DVec2]),
        segment_index: usize,
        sampling: &Sampling,
        upper: &BoundHeights,
        travel_mm: f64,
        motion_bound: MotionBound,
    ) -> bool {
        let SegmentCourse { segment, depth_mm, curvature_per_mm: curvature, .. } = &self.0[segment_index];
        let frame = &segment.blade_from_segment;
        let turn = DVec2::new(frame.rotation.x, -frame.rotation.y);
        let reach_mm2 = sampling.cell_mm * sampling.cell_mm + travel_mm * travel_mm;
        // Over a distance d the edge's normal turns by k_e d. Twice that is given, as the aimed point moves along the
        // edge by more than d where ray and edge are steep to each other: a safety without proof, as that of the
        // curvature.
        let grazing = GRAZING_COSINE + 2.0 * curvature * motion_bound.distance_mm + motion_bound.turn_rad;
        let slope = upper.climb_mm / sampling.cell_mm.max(1e-9);
        let middle = shifts_mm.len() / 2;
        rays.iter().zip(upper.heights_mm.chunks_exact(shifts_mm.len())).all(|(ray, heights_mm)| {
            let aim = ray.origin_mm + heights_mm[middle] * ray.direction;
            let p = turn.rotate(aim - frame.translation_mm);
            let n = turn.rotate(ray.direction);
            let (residual_mm, normal) = match &segment.shape {
                SegmentShape::Table(table) => {
                    let [x, slope] = table.x_and_slope(p.y);
                    (p.x - x, DVec2::new(1.0, -slope))
                }
                SegmentShape::Arc { radius_mm } => {
                    let from_center = p + DVec2::new(*radius_mm, 0.0);
                    let distance_mm = from_center.length();
                    (distance_mm - radius_mm, from_center / distance_mm.max(1e-12))
                }
            };
            let stretch = normal.length_squared();
            let length = stretch.sqrt();
            shifts_mm.iter().zip(heights_mm).all(|(&shift_mm, height_mm)| {
                let beside_mm = turn.rotate(shift_mm) + (height_mm - heights_mm[middle]) * n;
                let surface = sampling.turn_per_mm * (1.0 + 2.0 * slope + height_mm.abs() * sampling.turn_per_mm);
                let bulge_mm = CURVATURE_SAFETY * (curvature * stretch + surface) * reach_mm2 / 8.0;
                let grazing = grazing + 2.0 * curvature * beside_mm.length();
                residual_mm + normal.dot(beside_mm)
                    > length * (bulge_mm + motion_bound.distance_mm + depth_mm + ROUNDING_MM)
                    && -n.dot(normal) > grazing * length
            })
        })
    }

    /// Samples one segment's pass.
    pub fn bound(&self, near: &NearPass, pass: usize, segment_index: usize, sampling: &Sampling) -> Verdict {
        let SegmentCourse { segment, depth_mm, slope_range, .. } = &self.0[segment_index];
        let segment_from_blade = segment.blade_from_segment.inverse();
        let (poses, shifts_mm) = near.blade_from_work.looks();
        let phases = near.blade_from_work.len();
        let looks = sampling.places.len() * poses.len();
        let (mut heights_mm, mut curvature, mut least_cos) = (ArrayVec::new(), 0.0_f64, 1.0_f64);
        let mut beside_mm = 0.0_f64;
        let (mut y_low, mut y_high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut missed, mut away) = (false, 0);
        for ray in sampling.places {
            for blade_from_work in poses {
                let origin = segment_from_blade.point(blade_from_work.point(ray.origin_mm));
                let direction = segment_from_blade.direction(blade_from_work.direction(ray.normal));
                let leaves = |slope: f64| direction.x - slope * direction.y > LEAVING_SLOPE;
                if slope_range.iter().all(|&slope| leaves(slope)) {
                    away += 1;
                    continue;
                }
                let hit = segment.enter(origin, direction).filter(|hit| -hit.normal.dot(direction) >= GRAZING_COSINE);
                let Some(hit) = hit else {
                    missed = true;
                    continue;
                };
                let cos = -hit.normal.dot(direction);
                let tan2 = 1.0 / (cos * cos) - 1.0;
                let turn = sampling.turn_per_mm;
                let stretch = 1.0 + (hit.height_mm * turn).abs();
                // One cell further the entry lies this far along the edge; twice that, as it may not run evenly.
                let margin_mm = 2.0 * sampling.cell_mm * stretch / cos;
                let edge = match &segment.shape {
                    SegmentShape::Table(table) => [-margin_mm, margin_mm]
                        .map(|dy| table.curvature(hit.y_mm + dy).abs())
                        .into_iter()
                        .fold(hit.curvature_per_mm.abs(), f64::max),
                    SegmentShape::Arc { radius_mm } => 1.0 / radius_mm,
                };
                let bound = stretch / (cos * cos) * (edge * stretch / cos + turn) + turn * stretch * tan2;
                curvature = curvature.max(bound);
                for &shift_mm in &shifts_mm {
                    let entry = EntryBeside::new(&hit, direction, segment_from_blade.direction(shift_mm));
                    missed |= entry.cos < GRAZING_COSINE;
                    least_cos = least_cos.min(entry.cos);
                    beside_mm = beside_mm.max(entry.error_mm);
                    y_low = y_low.min(entry.y_mm);
                    y_high = y_high.max(entry.y_mm);
                    heights_mm.push(entry.height_mm);
                }
            }
        }
        if away == looks {
            return Verdict::Clear;
        }
        if missed || away > 0 {
            return Verdict::Undecided;
        }
        // What roughness moves an entry by, along the ray and along the edge.
        let rough_mm = CURVATURE_SAFETY * depth_mm / least_cos;
        let lowest = heights_mm.iter().copied().fold(f64::INFINITY, f64::min) - rough_mm;
        let highest = heights_mm.iter().copied().fold(f64::NEG_INFINITY, f64::max) + rough_mm;
        if lowest <= sampling.floor_mm {
            return if highest < sampling.floor_mm - FLOOR_MM { Verdict::Clear } else { Verdict::Undecided };
        }
        let wander_mm = near.wander_mm / least_cos;
        let tolerance_mm = END_SHARE * (y_high - y_low) + END_MM + rough_mm + wander_mm;
        let [y_start, y_end] = segment.y_range_mm;
        if y_low - tolerance_mm > y_end || y_high + tolerance_mm < y_start {
            return Verdict::Clear;
        }
        let along_profile_mm = CURVATURE_SAFETY * curvature * sampling.cell_mm * sampling.cell_mm / 8.0;
        // Along the stroke the middle phase shows the bend: an eighth of the second difference over the half range is
        // the error of a chord.
        let along_stroke_mm = heights_mm
            .chunks_exact(phases)
            .filter(|h| h.len() == 3)
            .map(|h| CURVATURE_SAFETY * (h[0] - 2.0 * h[1] + h[2]).abs() / 8.0)
            .fold(0.0, f64::max);
        let certain = y_low - tolerance_mm > y_start && y_high + tolerance_mm < y_end;
        let error_mm = along_profile_mm + along_stroke_mm + wander_mm + beside_mm + rough_mm + ROUNDING_MM;
        Verdict::Bounded(PassSamples { pass, segment: segment_index, heights_mm, error_mm, certain })
    }
}
