//! Between which places each ray of a family can cross a closed curve at all, before anything is solved: from a polygon
//! and how far the curve may lie from it.
//!
//! In: a [`LooseOutline`]. Out: per ray the least and the largest place that the curve can have on it; whatever the
//! curve encloses on that ray lies between them.
//!
//! The law: a piece within `tolerance` of its chord is met only by rays within the chord's ends and the tolerance, and
//! there no further from the chord's line than tolerance x sqrt(1 + slope^2) along the ray, nor beyond the chord's ends
//! by more than the tolerance.
//!
//! Eight sides are prepared at once; the rays that each meets follow one by one. The road not taken: eight rays at once
//! as well. A side meets a handful of them, and every vector waits for the one that the side before it wrote, partly
//! over the same rays.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use crate::math::planar_rays::{ClosedCurve, Family, RayRow};
use glam::DVec2;
use pulp::Arch;
use std::array::from_fn;
use std::ops::Range;

/// Sides that are prepared together.
const LANES: usize = 8;
type Lanes = [f64; LANES];

/// Rays within this share of their distance of a piece's end count as met: division rounds.
const ROUNDING_RAYS: f64 = 1e-9;
/// Error of places through rounding at most, mm.
const ROUNDING_MM: f64 = 1e-9;

/// Steeper sides run along the rays.
const LARGEST_SLOPE: f64 = 1e4;

/// A closed polygon and how far from each of its sides a curve may lie.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LooseOutline {
    /// Corners, one after the other.
    pub corners_mm: Vec<DVec2>,
    /// How far the curve may lie from the side that begins at the corner, mm.
    pub tolerances_mm: Vec<f64>,
}

impl LooseOutline {
    /// The chords of a curve.
    pub fn set_chords(&mut self, curve: &impl ClosedCurve) {
        let pieces = curve.pieces();
        self.corners_mm.clear();
        self.corners_mm.extend((0..pieces.len()).map(|index| curve.node_mm(index)));
        self.tolerances_mm.clear();
        self.tolerances_mm.extend(pieces.iter().map(|piece| piece.sagitta_mm));
    }
}

/// What a curve can reach on the rays of a family.
#[derive(Debug, Default)]
pub struct RayReach {
    /// Rays that it may cross.
    pub rays: Range<usize>,
    /// Least and largest place on each of them, mm; the least is larger where it cannot cross.
    pub places_mm: Vec<[f64; 2]>,
    sides: Vec<Sides>,
}

/// Eight sides of an outline.
#[derive(Debug, Default)]
struct Sides {
    /// First ray that each may meet, and the one behind the last: whole numbers.
    rays: [Lanes; 2],
    /// Place of its line on the first of them, and how it moves on from ray to ray, mm.
    first_mm: Lanes,
    step_mm: Lanes,
    /// How far from that line the curve may cross a ray, mm.
    tolerance_mm: Lanes,
    /// Places that it does not leave, mm.
    ends_mm: [Lanes; 2],
}

impl RayReach {
    /// Takes the place of what was known before.
    pub fn set(&mut self, outline: &LooseOutline, family: Family, row: &RayRow) {
        Arch::new().dispatch(ReachToSet { reach: self, outline, family, row });
    }

    #[inline(always)]
    fn set_lanes(&mut self, outline: &LooseOutline, family: Family, row: &RayRow) {
        let LooseOutline { corners_mm, tolerances_mm } = outline;
        let count = corners_mm.len();
        self.sides.clear();
        let mut ends = [f64::INFINITY, 0.0];
        for first in (0..count).step_by(LANES) {
            // Lanes beyond the last side repeat it.
            let at: [usize; LANES] = from_fn(|l| (first + l).min(count - 1));
            let from = at.map(|i| corners_mm[i]);
            let to = at.map(|i| corners_mm[if i + 1 < count { i + 1 } else { 0 }]);
            let [along, across] =
                [Family::along, Family::across].map(|of| [from, to].map(|p| p.map(|p| of(family, p))));
            let sides = Sides::new(along, across, at.map(|i| tolerances_mm[i]), row);
            ends[0] = sides.rays[0].iter().fold(ends[0], |a, b| least(a, *b));
            ends[1] = sides.rays[1].iter().fold(ends[1], |a, b| largest(a, *b));
            self.sides.push(sides);
        }
        let [from, to] = ends.map(|ray| ray as usize);
        self.rays = from.min(to)..to;
        self.places_mm.clear();
        self.places_mm.resize(self.rays.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for (sides, rest) in self.sides.iter().zip((1..=count).rev().step_by(LANES)) {
            for l in 0..LANES.min(rest) {
                sides.widen(l, self.rays.start, &mut self.places_mm);
            }
        }
    }
}

impl Sides {
    /// From places along and across the rays of the ends of each side.
    #[inline(always)]
    fn new(along: [Lanes; 2], across: [Lanes; 2], tolerances_mm: Lanes, row: &RayRow) -> Self {
        let (per_mm, count) = (row.spacing_mm.recip(), row.count as f64);
        let mut sides = Self::default();
        for l in 0..LANES {
            let (a, b, tolerance_mm) = ([across[0][l], along[0][l]], [across[1][l], along[1][l]], tolerances_mm[l]);
            let from = (least(a[0], b[0]) - tolerance_mm - row.first_mm) * per_mm - ROUNDING_RAYS;
            let to = (largest(a[0], b[0]) + tolerance_mm - row.first_mm) * per_mm + ROUNDING_RAYS + 1.0;
            // Whole numbers of 32 bits: processors turn places into no others in one step.
            let [from, to] = [from, to].map(|place| least(largest(place, 0.0), count));
            let [below, to] = [from, to].map(|place| f64::from(place as i32));
            let from = below + if from > below { 1.0 } else { 0.0 };
            (sides.rays[0][l], sides.rays[1][l]) = (from, to);
            sides.ends_mm[0][l] = least(a[1], b[1]) - tolerance_mm - ROUNDING_MM;
            sides.ends_mm[1][l] = largest(a[1], b[1]) + tolerance_mm + ROUNDING_MM;
            let run = [b[0] - a[0], b[1] - a[1]];
            // Along the rays a side's ends alone are taken: rounding would be stretched beyond bounds.
            let crosses = run[1].abs() < LARGEST_SLOPE * run[0].abs();
            let slope = run[1] / run[0];
            let slope = if crosses { slope } else { 0.0 };
            let along_mm = tolerance_mm * (1.0 + slope * slope).sqrt() + ROUNDING_MM;
            sides.tolerance_mm[l] = if crosses { along_mm } else { f64::INFINITY };
            sides.first_mm[l] = a[1] + slope * (row.first_mm + from * row.spacing_mm - a[0]);
            sides.step_mm[l] = slope * row.spacing_mm;
        }
        sides
    }

    /// Widens places on rays, the first of them ray `start`, by what one side can reach.
    #[inline(always)]
    fn widen(&self, side: usize, start: usize, places_mm: &mut [[f64; 2]]) {
        let [from, to] = [0, 1].map(|end: usize| self.rays[end][side] as usize);
        let (first_mm, step_mm, tolerance_mm) = (self.first_mm[side], self.step_mm[side], self.tolerance_mm[side]);
        let [low_mm, high_mm] = [0, 1].map(|end: usize| self.ends_mm[end][side]);
        // A side meets a handful of rays: by themselves, since vectors would wait for those of the side before.
        let mut rays_on = 0.0;
        if from >= to {
            return;
        }
        for places_mm in &mut places_mm[from - start..to - start] {
            let near_mm = first_mm + step_mm * rays_on;
            places_mm[0] = least(places_mm[0], largest(near_mm - tolerance_mm, low_mm));
            places_mm[1] = largest(places_mm[1], least(near_mm + tolerance_mm, high_mm));
            rays_on += 1.0;
        }
    }
}

/// A reach about to be set, called through the instruction set dispatch.
struct ReachToSet<'a> {
    reach: &'a mut RayReach,
    outline: &'a LooseOutline,
    family: Family,
    row: &'a RayRow,
}

impl pulp::NullaryFnOnce for ReachToSet<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.reach.set_lanes(self.outline, self.family, self.row);
    }
}

/// Of two numbers; `f64::min` and `f64::max` also look whether they are any, and take three times as long.
#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn largest(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::planar_rays::FAMILIES;
    use proptest::prelude::*;

    proptest! {
        /// A polygon whose corners are moved by the tolerance at most crosses no ray elsewhere.
        #[test]
        fn crossings_lie_within_reach(
            corners in proptest::collection::vec(([-3.0_f64..13.0, -3.0..13.0], [-1.0_f64..1.0, -1.0..1.0]), 3..12),
            tolerance_mm in 1e-6_f64..0.5,
            upright in 0_usize..4,
        ) {
            let mut at: Vec<DVec2> = corners.iter().map(|(p, _)| DVec2::from_array(*p)).collect();
            // A side along the rays, but for a rounding.
            at[1].x = at[0].x + [0.0, 1e-13, 1e-5, 1.0][upright];
            let share_mm = tolerance_mm / 2.0_f64.sqrt();
            let moved = at.iter().zip(&corners).map(|(p, (_, m))| *p + share_mm * DVec2::from_array(*m));
            let moved: Vec<DVec2> = moved.collect();
            let outline = LooseOutline { tolerances_mm: vec![tolerance_mm; at.len()], corners_mm: at };
            let row = RayRow { first_mm: 0.05, spacing_mm: 0.1, count: 100 };
            for family in FAMILIES {
                let mut reach = RayReach::default();
                reach.set(&outline, family, &row);
                prop_assert_eq!(reach.rays.len(), reach.places_mm.len());
                for ray in 0..row.count {
                    let across = row.at_mm(ray);
                    for (index, a) in moved.iter().enumerate() {
                        let b = moved[(index + 1) % moved.len()];
                        let [from, to] = [*a, b].map(|p| family.across(p));
                        if (from < across) == (to < across) {
                            continue;
                        }
                        let share = (across - from) / (to - from);
                        let along = family.along(*a) + share * (family.along(b) - family.along(*a));
                        prop_assert!(reach.rays.contains(&ray));
                        let [low, high] = reach.places_mm[ray - reach.rays.start];
                        prop_assert!(low <= along && along <= high, "ray {} at {}: {} to {}", ray, along, low, high);
                    }
                }
            }
        }
    }

    #[test]
    fn the_reach_of_an_upright_square_is_its_own() {
        let corners_mm = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]].map(DVec2::from_array).to_vec();
        let outline = LooseOutline { corners_mm, tolerances_mm: vec![0.0; 4] };
        let mut reach = RayReach::default();
        reach.set(&outline, Family::X, &RayRow { first_mm: 0.05, spacing_mm: 0.1, count: 100 });
        assert_eq!(reach.rays, 10..20);
        assert!(reach.places_mm.iter().all(|[low, high]| (low - 1.0).abs() < 1e-8 && (high - 2.0).abs() < 1e-8));
    }
}
