//! Between which places each ray of a family can cross a closed curve at all, before anything is solved: from a polygon and how far the curve may lie from it.
//!
//! In: a [`LooseOutline`]. Out: per ray the least and the largest place that the curve can have on it; whatever the curve encloses on that ray lies between them.
//!
//! The law: a piece within `slack` of its chord is met only by rays within the chord's ends and the slack, and there no further from the chord's line than slack x sqrt(1 + slope^2) along the ray, nor beyond
//! the chord's ends by more than the slack.

use crate::planar_rays::{ClosedCurve, Family, RayRow};
use glam::DVec2;
use std::ops::Range;

/// Rays within this share of their distance of a piece's end count as met: division rounds.
const ROUNDING_RAYS: f64 = 1e-9;
/// Places are that sure, mm.
const ROUNDING_MM: f64 = 1e-9;

/// Steeper sides run along the rays.
const LARGEST_SLOPE: f64 = 1e4;

/// A closed polygon and how far from each of its sides a curve may lie.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LooseOutline {
    /// Corners, one after the other.
    pub corners_mm: Vec<DVec2>,
    /// How far the curve may lie from the side that begins at the corner, mm.
    pub slacks_mm: Vec<f64>,
}

impl LooseOutline {
    /// The chords of a curve.
    pub fn set_chords(&mut self, curve: &impl ClosedCurve) {
        let pieces = curve.pieces();
        self.corners_mm.clear();
        self.corners_mm.extend((0..pieces.len()).map(|index| curve.node_mm(index)));
        self.slacks_mm.clear();
        self.slacks_mm.extend(pieces.iter().map(|piece| piece.sagitta_mm));
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
        let from_ray = |across_mm: f64| {
            let place = (across_mm - row.first_mm) * per_mm - ROUNDING_RAYS;
            let below = place as usize;
            (below + usize::from(place > below as f64)).min(row.count)
        };
        let to_ray = |across_mm: f64| {
            let place = (across_mm - row.first_mm) * per_mm + ROUNDING_RAYS;
            if place < 0.0 { 0 } else { (place as usize + 1).min(row.count) }
        };
        let LooseOutline { corners_mm, slacks_mm } = outline;
        let mut ends_mm = [f64::INFINITY, f64::NEG_INFINITY];
        for (index, (corner, slack_mm)) in corners_mm.iter().zip(slacks_mm).enumerate() {
            let slack_mm = slack_mm.max(slacks_mm[index.checked_sub(1).unwrap_or(slacks_mm.len() - 1)]);
            let across_mm = family.across(*corner);
            ends_mm = [ends_mm[0].min(across_mm - slack_mm), ends_mm[1].max(across_mm + slack_mm)];
        }
        self.rays = from_ray(ends_mm[0])..to_ray(ends_mm[1]);
        self.places_mm.clear();
        self.places_mm.resize(self.rays.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        let Some(&last) = corners_mm.last().filter(|_| !self.rays.is_empty()) else { return };
        // Sides are taken by their ends: the first one is that from the last corner to the first.
        let (mut start, mut slack_mm) = (last, slacks_mm[slacks_mm.len() - 1]);
        for (corner, next_slack_mm) in corners_mm.iter().zip(slacks_mm) {
            let [a, b] = [start, *corner].map(|p| [family.across(p), family.along(p)]);
            let side_slack_mm = slack_mm;
            (start, slack_mm) = (*corner, *next_slack_mm);
            let from = from_ray(a[0].min(b[0]) - side_slack_mm);
            let to = to_ray(a[0].max(b[0]) + side_slack_mm);
            if from >= to {
                continue;
            }
            let low_mm = a[1].min(b[1]) - side_slack_mm - ROUNDING_MM;
            let high_mm = a[1].max(b[1]) + side_slack_mm + ROUNDING_MM;
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            // Along the rays a side's ends alone are taken: rounding would be stretched beyond bounds. (The largest and the least of a number and of what is no number are the number.)
            let slope = if slope.abs() < LARGEST_SLOPE { slope } else { f64::NAN };
            let along_slack_mm = side_slack_mm * (1.0 + slope * slope).sqrt() + ROUNDING_MM;
            let (first_mm, step_mm) = (a[1] + slope * (row.at_mm(from) - a[0]), slope * row.spacing_mm);
            for (i, places_mm) in self.places_mm[from - self.rays.start..to - self.rays.start].iter_mut().enumerate() {
                let near_mm = first_mm + step_mm * i as f64;
                places_mm[0] = places_mm[0].min((near_mm - along_slack_mm).max(low_mm));
                places_mm[1] = places_mm[1].max((near_mm + along_slack_mm).min(high_mm));
            }
        }
    }
}
