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
//! The road not taken: eight sides at once, or eight rays. A side meets a handful of rays, one by one in any case, and
//! what is prepared for it in vectors goes through memory first: a sixth more time.

use crate::math::planar_rays::{ClosedCurve, Family, RayRow};
use glam::DVec2;
use std::ops::Range;

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
}

impl RayReach {
    /// Takes the place of what was known before.
    pub fn set(&mut self, outline: &LooseOutline, family: Family, row: &RayRow) {
        let per_mm = row.spacing_mm.recip();
        // Whole numbers of 32 bits: processors turn places into no others in one step.
        let from_ray = |across_mm: f64| {
            let place = ((across_mm - row.first_mm) * per_mm - ROUNDING_RAYS).max(0.0);
            let below = place as i32;
            (below as usize + usize::from(place > f64::from(below))).min(row.count)
        };
        let to_ray = |across_mm: f64| {
            let place = (across_mm - row.first_mm) * per_mm + ROUNDING_RAYS + 1.0;
            (place.max(0.0) as i32 as usize).min(row.count)
        };
        let LooseOutline { corners_mm, tolerances_mm } = outline;
        let mut ends_mm = [f64::INFINITY, f64::NEG_INFINITY];
        for (index, (corner, tolerance_mm)) in corners_mm.iter().zip(tolerances_mm).enumerate() {
            let tolerance_mm = tolerance_mm.max(tolerances_mm[index.checked_sub(1).unwrap_or(tolerances_mm.len() - 1)]);
            let across_mm = family.across(*corner);
            ends_mm = [ends_mm[0].min(across_mm - tolerance_mm), ends_mm[1].max(across_mm + tolerance_mm)];
        }
        self.rays = from_ray(ends_mm[0])..to_ray(ends_mm[1]);
        self.places_mm.clear();
        self.places_mm.resize(self.rays.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        let Some(&last) = corners_mm.last().filter(|_| !self.rays.is_empty()) else { return };
        // Sides are taken by their ends: the first one is that from the last corner to the first.
        let (mut start, mut tolerance_mm) = (last, tolerances_mm[tolerances_mm.len() - 1]);
        for (corner, next_tolerance_mm) in corners_mm.iter().zip(tolerances_mm) {
            let [a, b] = [start, *corner].map(|p| [family.across(p), family.along(p)]);
            let side_tolerance_mm = tolerance_mm;
            (start, tolerance_mm) = (*corner, *next_tolerance_mm);
            let from = from_ray(a[0].min(b[0]) - side_tolerance_mm);
            let to = to_ray(a[0].max(b[0]) + side_tolerance_mm);
            if from >= to {
                continue;
            }
            let low_mm = a[1].min(b[1]) - side_tolerance_mm - ROUNDING_MM;
            let high_mm = a[1].max(b[1]) + side_tolerance_mm + ROUNDING_MM;
            let run = [b[0] - a[0], b[1] - a[1]];
            let slope = run[1] / run[0];
            // Along the rays a side's ends alone are taken: rounding would be stretched beyond bounds.
            let (slope, along_tolerance_mm) = if run[1].abs() < LARGEST_SLOPE * run[0].abs() {
                (slope, side_tolerance_mm * (1.0 + slope * slope).sqrt() + ROUNDING_MM)
            } else {
                (0.0, f64::INFINITY)
            };
            let (first_mm, step_mm) = (a[1] + slope * (row.at_mm(from) - a[0]), slope * row.spacing_mm);
            for (i, places_mm) in self.places_mm[from - self.rays.start..to - self.rays.start].iter_mut().enumerate() {
                let near_mm = first_mm + step_mm * i as f64;
                places_mm[0] = least(places_mm[0], largest(near_mm - along_tolerance_mm, low_mm));
                places_mm[1] = largest(places_mm[1], least(near_mm + along_tolerance_mm, high_mm));
            }
        }
    }
}

/// Of two numbers; `f64::min` and `f64::max` also look whether they are any, and take three times as long.
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

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
