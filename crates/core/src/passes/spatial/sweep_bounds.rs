//! Which sweeps can leave the lowest surface on a region of a spatial field.
//!
//! Every candidate's heights on nine rays are known (`sweep_samples`): where its segment, or the continuation of it,
//! enters them. In each of the four cells between the rays the difference of two sweeps' heights lies above its lowest
//! corner less an eighth of its second differences along both sides. All sweeps of one tool bend nearly alike, so these
//! differences are small where those of the heights are not. A sweep is culled from a cell when another one, certain to
//! enter through the segment itself there, is lower by this measure and half as much again for what second differences
//! cannot show. It is culled as well when its own entries lie beyond the segment's ends by the same measure.
//!
//! This is no proof. Second differences of nine values bound a function that is smooth between them, as sweeps are; one
//! that turned within a cell would be missed by more than the safety holds. The comparison with all passes, bit for
//! bit, on regions of all sizes stands for it (`tests/suite/hobbing/spatial.rs`).
//!
//! Heights are those that the region's frame sees, and the kernel cuts in the tile's. Where the motion is not smooth
//! the two differ, by no more than their polynomials are off ([`SweepRecord::off_mm`]), over the cosine at which rays
//! enter; every comparison has this as a margin.
//!
//! A sweep is undecided where one of the rays has no root, or where it ends at a corner of the motion. It is kept
//! unless its segment stays clear of all that the rays pass below the lowest certain surface.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::sweep::{LARGEST_T, SweepRecord};
use super::sweep_regions::{ALL, RAYS, Region, SIDE};
use super::sweep_roots::{LANES, Rays};
use super::sweep_samples::{Sampled, SweepCandidate, SweepFrame};
use crate::dexel::SpatialField;
use crate::tool::edge::Segment;
use pulp::Arch;
use std::ops::Range;

/// Safety on second differences, for what varies inside a cell. No proof: see the head of this file.
const BEND_SAFETY: f64 = 1.5;
/// Added to every bound: what the roots of samples and of the native kernel may err, mm. Both end after a step below
/// 1e-5 mm, which leaves picometres; 0.2 nm is a hundred times as much.
const ROUNDING_MM: f64 = 2e-7;
/// Added to places along a segment, mm: a thousand times what they are computed to.
const END_MARGIN_MM: f64 = 1e-6;
/// A candidate is clear of the rays where all nine heights lie below the floor by this share of their range, and by
/// [`FLOOR_MM`]: between the rays heights may pass the highest of them. The share is that of a function whose second
/// differences are 1.6 times its range; for others it was found by trial and has no proof. Too small, a sweep is
/// dropped that rises over the floor between the rays, and the surface stays too high there. Brute force knows no
/// floor: the comparison with it in `tests/suite/hobbing/spatial.rs` sees such a loss on the fields it looks at, and no
/// other.
const FLOOR_SHARE: f64 = 0.2;
/// The same as a length, for heights that are all alike, mm.
const FLOOR_MM: f64 = 1e-3;
/// Heights of a sweep rise over the highest of their nine by no more than this share of their range, whatever their
/// second differences: where the rays of a root begin to turn heights have an inflection, and three of them on a line
/// may lie straight by chance. Found by trial, no proof: 0.86 was needed on a root of a shipped scene, whose pass was
/// lost without it.
const UPPER_SHARE: f64 = 2.0;
/// Steps at most towards the moment at which a rake face holds a point: each gains more than a digit on usual gears.
/// Where the last one still moves a point by more than [`MOMENT_MM`], as with few teeth per start, the box is not
/// known.
const MOMENT_STEPS: usize = 5;
/// A tenth of [`BOX_MARGIN_MM`].
const MOMENT_MM: f64 = 1e-4;
/// Radius of curvature of a path through the rake face at least, as a share of the distance from the tool's axis: seen
/// from the rake face a point of the work goes on a circle about that axis, but for the work's own motion, which is
/// given half. No proof for that half; candidates are compared with all passes in `tests/suite/hobbing/spatial.rs`.
const PATH_RADIUS_SHARE: f64 = 0.5;
/// Smallest distance from the tool's axis that counts there, mm: no path bends with a smaller radius than half of it.
const LEAST_RADIUS_MM: f64 = 1.0;
/// Added to boxes in the rake face, mm.
const BOX_MARGIN_MM: f64 = 1e-3;
/// Cells between the rays: index of the first corner; the others follow at 1, 3 and 4.
const CELLS: [usize; 4] = [0, 1, 3, 4];
/// All cells, as bits.
const ALL_CELLS: u8 = (1 << CELLS.len()) - 1;

/// Bounds of candidates on one region.
pub struct RegionBounds<'a> {
    /// The field.
    pub field: &'a SpatialField,
    /// Segments of all edges, one edge after another.
    pub segments: &'a [Segment],
    /// The region.
    pub region: &'a Region<'a>,
    /// Where the candidates are seen from.
    pub frame: &'a SweepFrame,
    /// Only what is left below this height is looked for, mm.
    pub ceiling_mm: f64,
}

/// A candidate whose entries into all nine rays are known.
struct Bounded<'a> {
    sampled: &'a Sampled,
    /// Cells in which the ray enters through the segment itself, wherever it is, as bits.
    certain: u8,
    /// Cells in which it may.
    possible: u8,
    /// What its heights in the kernel may be from those sampled, mm.
    off_mm: f64,
}

impl RegionBounds<'_> {
    /// Candidates that may leave the lowest surface in some cells of the region below the ceiling, in their order, with
    /// these cells as bits; and a height that the surface left is certainly below, which the ceiling does not count
    /// for: `upper_bound_mm` is such a height of a region around this one.
    pub fn keep(&self, candidates: &[Sampled], upper_bound_mm: f64) -> (Vec<(Sampled, u8)>, f64) {
        let (mut bounded, mut undecided) = (Vec::new(), Vec::new());
        for sampled in candidates {
            match self.bound(sampled) {
                Some(Ok(known)) => bounded.push(known),
                Some(Err(())) => undecided.push(sampled),
                None => {}
            }
        }
        let upper_bound_mm = self.upper_bound_mm(&bounded).min(upper_bound_mm);
        let below_mm = upper_bound_mm.min(self.ceiling_mm);
        let mut kept = self.undominated(&bounded, below_mm);
        if !undecided.is_empty() {
            let enters: Vec<bool> = undecided.iter().map(|sampled| self.enters_below(sampled, below_mm)).collect();
            let unsure = undecided.iter().zip(&enters).filter(|(_, enters)| !**enters);
            let mut meeting =
                self.meeting(unsure.map(|(sampled, _)| sampled.index).collect(), below_mm).into_iter().peekable();
            let mut enters = enters.into_iter();
            undecided.retain(|sampled| enters.next().unwrap_or(true) || meeting.next_if_eq(&sampled.index).is_some());
            kept.extend(undecided.into_iter().map(|sampled| (*sampled, ALL_CELLS)));
            kept.sort_unstable_by_key(|(sampled, _)| sampled.index);
        }
        (kept, upper_bound_mm)
    }

    /// What the samples say of a candidate; an error if they do not decide it, nothing if it is clear of the region.
    fn bound<'s>(&self, sampled: &'s Sampled) -> Option<Result<Bounded<'s>, ()>> {
        if sampled.left == ALL {
            return None;
        }
        let record = &self.frame.records[sampled.index as usize];
        if sampled.entered != ALL || record.ends_in_tile() {
            return Some(Err(()));
        }
        let off_mm = off_mm(record) / sampled.cosine;
        let floor_mm = 2.0 * self.field.low_mm;
        let [lowest, highest] = range(sampled.height_mm);
        if lowest <= floor_mm {
            let margin_mm = FLOOR_SHARE * (highest - lowest) + FLOOR_MM + off_mm;
            return if highest < floor_mm - margin_mm { None } else { Some(Err(())) };
        }
        let [y_start, y_end] = self.segment(sampled).y_range_mm;
        let tolerance_mm = BEND_SAFETY * self.region.bend(&sampled.y_mm) + END_MARGIN_MM + 2.0 * off_mm;
        let (mut certain, mut possible) = (0, 0);
        for (bit, cell) in CELLS.into_iter().enumerate() {
            let [low, high] = range(corners(cell).map(|corner| sampled.y_mm[corner]));
            certain |= u8::from(low - tolerance_mm > y_start && high + tolerance_mm < y_end) << bit;
            possible |= u8::from(low - tolerance_mm <= y_end && high + tolerance_mm >= y_start) << bit;
        }
        (possible != 0).then_some(Ok(Bounded { sampled, certain, possible, off_mm }))
    }

    /// A height that the surface left is below everywhere.
    fn upper_bound_mm(&self, bounded: &[Bounded]) -> f64 {
        let mut uppers = [range(self.region.blank_mm)[1]; CELLS.len()];
        for known in bounded.iter().filter(|known| known.certain != 0) {
            let heights = &known.sampled.height_mm;
            let [lowest, highest] = range(*heights);
            let bend_mm = (BEND_SAFETY * self.region.bend(heights)).max(UPPER_SHARE * (highest - lowest));
            for (bit, cell) in CELLS.into_iter().enumerate() {
                if known.certain >> bit & 1 == 1 {
                    let top = range(corners(cell).map(|c| heights[c]))[1];
                    uppers[bit] = uppers[bit].min(top + bend_mm + known.off_mm);
                }
            }
        }
        range(uppers)[1]
    }

    fn undominated(&self, bounded: &[Bounded], upper_bound_mm: f64) -> Vec<(Sampled, u8)> {
        // In each cell the certain sweeps that are lowest at one of its corners: no other can dominate.
        let dominating: [Vec<usize>; CELLS.len()] = std::array::from_fn(|bit| {
            let mut lowest: Vec<usize> = corners(CELLS[bit])
                .into_iter()
                .filter_map(|corner| {
                    let height = |k: usize| bounded[k].sampled.height_mm[corner];
                    (0..bounded.len())
                        .filter(|&k| bounded[k].certain >> bit & 1 == 1)
                        .min_by(|&a, &b| height(a).total_cmp(&height(b)))
                })
                .collect();
            lowest.sort_unstable();
            lowest.dedup();
            lowest
        });
        // Whether a candidate stays above other heights in a cell.
        let above = |heights: &[f64; RAYS], others: &[f64; RAYS], off_mm: f64, cell: usize| {
            let difference: [f64; RAYS] = std::array::from_fn(|i| heights[i] - others[i]);
            if corners(cell).into_iter().any(|corner| difference[corner] <= ROUNDING_MM + off_mm) {
                return false;
            }
            let margin_mm = BEND_SAFETY * self.region.bend(&difference) + ROUNDING_MM + off_mm;
            corners(cell).into_iter().all(|corner| difference[corner] > margin_mm)
        };
        let upper = [upper_bound_mm; RAYS];
        bounded
            .iter()
            .enumerate()
            .filter_map(|(index, known)| {
                let (heights, off_mm) = (&known.sampled.height_mm, known.off_mm);
                let mut alive = 0;
                for (bit, &cell) in CELLS.iter().enumerate() {
                    let dead = known.possible >> bit & 1 == 0
                        || above(heights, &upper, off_mm, cell)
                        || above(heights, &self.region.blank_mm, off_mm, cell)
                        || dominating[bit].iter().map(|&r| (r, &bounded[r])).any(|(r, other)| {
                            r != index && above(heights, &other.sampled.height_mm, off_mm + other.off_mm, cell)
                        });
                    alive |= u8::from(!dead) << bit;
                }
                (alive != 0).then_some((*known.sampled, alive))
            })
            .collect()
    }

    /// Whether a ray enters the segment itself between its lowest height and an upper bound: the box would say as much.
    fn enters_below(&self, sampled: &Sampled, upper_bound_mm: f64) -> bool {
        let (lowest_mm, [y_start, y_end]) = (2.0 * self.field.low_mm, self.segment(sampled).y_range_mm);
        (0..RAYS).any(|ray| {
            sampled.entered >> ray & 1 == 1
                && (lowest_mm..=upper_bound_mm).contains(&sampled.height_mm[ray])
                && (y_start..=y_end).contains(&sampled.y_mm[ray])
        })
    }

    fn segment(&self, sampled: &Sampled) -> &Segment {
        &self.segments[self.frame.records[sampled.index as usize].segment as usize]
    }

    /// Of sweeps, each in the frame with one candidate, those that can come near the region below an upper bound:
    /// their place in the frame with every segment of their blades that can, `segments_of` it.
    pub fn near(
        &self,
        upper_bound_mm: f64,
        segments_of: impl Fn(&SweepCandidate) -> Range<usize>,
    ) -> Vec<(usize, usize)> {
        let all: Vec<u32> = (0..self.frame.candidates.len() as u32).collect();
        let boxes = self.boxes(&all, upper_bound_mm);
        let of_sweep = |(sweep, bounds): (usize, RakeFaceBox)| {
            let segments = segments_of(&self.frame.candidates[sweep]);
            segments.filter(move |&segment| bounds.meets(&self.segments[segment])).map(move |segment| (sweep, segment))
        };
        boxes.into_iter().enumerate().flat_map(of_sweep).collect()
    }

    /// Those of some candidates (by their place in the frame, in order) whose segments meet what the rays pass between
    /// their lowest height and an upper bound while the blade sweeps.
    fn meeting(&self, mut indices: Vec<u32>, upper_bound_mm: f64) -> Vec<u32> {
        let candidates = &self.frame.candidates;
        let sweep = |index: &u32| candidates[*index as usize].sweep();
        let firsts: Vec<u32> = indices.chunk_by(|a, b| sweep(a) == sweep(b)).map(|of_sweep| of_sweep[0]).collect();
        let boxes = self.boxes(&firsts, upper_bound_mm);
        let mut of_sweep = firsts.iter().map(sweep).zip(&boxes).peekable();
        indices.retain(|index| {
            while of_sweep.peek().is_some_and(|(of, _)| *of != sweep(index)) {
                of_sweep.next();
            }
            let bounds = of_sweep.peek().expect("every sweep has its box").1;
            bounds.meets(&self.segments[candidates[*index as usize].segment])
        });
        indices
    }

    /// Boxes of sweeps, each by one of its candidates.
    fn boxes(&self, firsts: &[u32], upper_bound_mm: f64) -> Vec<RakeFaceBox> {
        let mut boxes = Vec::with_capacity(firsts.len());
        Arch::new().dispatch(RakeFaceBoxes { bounds: self, firsts, upper_bound_mm, boxes: &mut boxes });
        boxes
    }
}

/// Finds boxes in the rake face of all that a region's rays pass between their lowest height and an upper bound while
/// the blade sweeps.
struct RakeFaceBoxes<'a, 'b> {
    bounds: &'a RegionBounds<'b>,
    /// One record of each sweep.
    firsts: &'a [u32],
    upper_bound_mm: f64,
    boxes: &'a mut Vec<RakeFaceBox>,
}

impl pulp::NullaryFnOnce for RakeFaceBoxes<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let RegionBounds { field, segments, region, frame, .. } = self.bounds;
        let dexels = region.dexels();
        // The rays around; the middle one is held by the margin.
        let rays =
            Rays::new(field, frame.origin_mm, std::array::from_fn(|l| dexels[if l < RAYS / 2 { l } else { l + 1 }]));
        let floor_mm = 2.0 * field.low_mm;
        let heights_mm = [floor_mm, 0.5 * (floor_mm + self.upper_bound_mm), self.upper_bound_mm];
        let [width_mm, length_mm] = region.extent_mm();
        let cell_mm = (0.5 * width_mm).hypot(0.5 * length_mm).max(0.5 * (self.upper_bound_mm - floor_mm));
        for &first in self.firsts {
            let record = &frame.records[first as usize];
            let base_mm = segments[record.segment as usize].blade_from_segment.translation_mm;
            let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            let mut known = true;
            // A quarter of what a last step may move a point, which stays well within twice the segment's radius.
            let last_t = 0.125 * MOMENT_MM / record.radius_mm;
            for [t, rho, along, step_t] in record.places(&rays, &heights_mm, MOMENT_STEPS, last_t) {
                for l in 0..LANES {
                    // dt is half the angle; the point moves more slowly than the rake face turns.
                    let moved_mm = 2.0 * step_t[l].abs() * (rho[l] + record.radius_mm);
                    known &= t[l].abs() < LARGEST_T && moved_mm < MOMENT_MM;
                    for (axis, place) in [rho[l] + base_mm.x, along[l] + base_mm.y].into_iter().enumerate() {
                        low[axis] = low[axis].min(place);
                        high[axis] = high[axis].max(place);
                    }
                }
            }
            // An arc of radius R leaves its chord of length L by L^2 / 8 R; boxes count from the blade's origin.
            let nearest_mm = low[0] + (record.radius_mm - base_mm.x);
            let radius_mm = PATH_RADIUS_SHARE * nearest_mm.max(LEAST_RADIUS_MM);
            let margin_mm = cell_mm * cell_mm / (8.0 * radius_mm) + BOX_MARGIN_MM + off_mm(record);
            self.boxes.push(if known {
                RakeFaceBox { low: low.map(|v| v - margin_mm), high: high.map(|v| v + margin_mm) }
            } else {
                RakeFaceBox { low: [f64::NEG_INFINITY; 2], high: [f64::INFINITY; 2] }
            });
        }
    }
}

/// Ranges of r and w in the rake face, from the blade's origin, mm.
struct RakeFaceBox {
    low: [f64; 2],
    high: [f64; 2],
}

impl RakeFaceBox {
    fn meets(&self, segment: &Segment) -> bool {
        // The chord's box, widened by what the segment's circle has beyond half the chord.
        let center = segment.blade_from_segment.translation_mm.to_array();
        let [x, y] = segment.blade_from_segment.rotation.to_array();
        let half = 0.5 * (segment.y_range_mm[1] - segment.y_range_mm[0]);
        let bulge = (segment.reach_mm * segment.reach_mm - half * half).max(0.0).sqrt();
        let reach = [(half * y).abs() + bulge, (half * x).abs() + bulge];
        (0..2).all(|axis| self.low[axis] <= center[axis] + reach[axis] && self.high[axis] >= center[axis] - reach[axis])
    }
}

/// How far two tiles may see a point of a sweep apart, mm: the one whose frame this is, and one within it.
#[inline(always)]
fn off_mm(record: &SweepRecord) -> f64 {
    2.0 * record.off_mm
}

/// Corners of a cell.
fn corners(first: usize) -> [usize; 4] {
    [first, first + 1, first + SIDE, first + SIDE + 1]
}

/// Smallest and largest.
fn range<const N: usize>(values: [f64; N]) -> [f64; 2] {
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
}
