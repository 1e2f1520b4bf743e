//! The blank's outline as a closed curve on rays: the pitch curve moved outwards along its normals.
//!
//! Parameter: polar angle phi of the foot on the pitch curve. With the distance a, the outline is P + a n and its
//! derivative (1 + a kappa) s' t; the blank refuses hollows tighter than a, so it never turns back.

use super::blank::Blank;
use crate::math::planar_rays::{ClosedCurve, Piece};
use glam::DVec2;
use std::f64::consts::TAU;

/// Pieces per turn at least: each turns by half a degree on a circle.
const LEAST_PIECES: usize = 720;

/// A piece stays within this many arrow heights at its middle of its chord: 32/27 for a cubic that bends one way (its
/// distance from the chord is t (1 - t) ((1 - t) a + t b) with the slopes a and b at its ends), the rest for what half a
/// degree of a pitch curve has beyond a cubic, and no proof. Too small, a ray that only just meets a bulge misses it,
/// and the blank loses what lies beyond its chord there: `tests/suite/shaping/blank_field.rs` compares volumes with the
/// outline's own.
const SAGITTA_SAFETY: f64 = 2.0;
/// Added to arrow heights, mm: rounding.
const ROUNDING_MM: f64 = 1e-9;

/// Closed outline of the stock, counter-clockwise.
#[derive(Debug)]
pub struct BlankOutline<'a> {
    blank: &'a Blank,
    pieces: Vec<Piece>,
    nodes: Vec<[DVec2; 2]>,
}

impl<'a> BlankOutline<'a> {
    /// Outline of a blank.
    pub fn new(blank: &'a Blank) -> Self {
        let count = blank.curve().samples_per_turn().clamp(LEAST_PIECES, 1 << 14);
        let at = |i: usize| TAU * i as f64 / count as f64;
        let nodes: Vec<[DVec2; 2]> = (0..count).map(|i| place(blank, at(i))).collect();
        let pieces = (0..count)
            .map(|i| {
                let (start, end) = (nodes[i][0], nodes[(i + 1) % count][0]);
                let middle = place(blank, 0.5 * (at(i) + at(i + 1)))[0];
                let sagitta = (end - start).normalize_or_zero().perp_dot(middle - start).abs();
                Piece { law: 0, range: [at(i), at(i + 1)], sagitta_mm: SAGITTA_SAFETY * sagitta + ROUNDING_MM }
            })
            .collect();
        Self { blank, pieces, nodes }
    }

    /// Largest distance of the outline from the gear axis, mm, with what lies between the nodes.
    pub fn reach_mm(&self) -> f64 {
        let sagitta = self.pieces.iter().map(|p| p.sagitta_mm).fold(0.0, f64::max);
        self.nodes.iter().map(|n| n[0].length()).fold(0.0, f64::max) + sagitta
    }

    /// Box round the outline: lowest and highest corner, mm.
    pub fn bounds_mm(&self) -> [DVec2; 2] {
        let sagitta = DVec2::splat(self.pieces.iter().map(|p| p.sagitta_mm).fold(0.0, f64::max));
        let points = self.nodes.iter().map(|n| n[0]);
        let low = points.clone().reduce(DVec2::min).unwrap_or_default();
        [low - sagitta, points.reduce(DVec2::max).unwrap_or_default() + sagitta]
    }
}

impl ClosedCurve for BlankOutline<'_> {
    fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    fn node_mm(&self, index: usize) -> DVec2 {
        self.nodes[index][0]
    }

    fn place(&self, _law: u32, phi_rad: f64) -> [DVec2; 2] {
        place(self.blank, phi_rad)
    }

    fn tangents(&self, index: usize) -> [DVec2; 2] {
        [self.nodes[index][1], self.nodes[(index + 1) % self.nodes.len()][1]]
    }
}

fn place(blank: &Blank, phi_rad: f64) -> [DVec2; 2] {
    let frame = blank.curve().frame(phi_rad);
    let stretch = 1.0 + blank.addendum_mm * frame.curvature_per_mm;
    [frame.point_mm + blank.addendum_mm * frame.normal, stretch * frame.arc_rate_mm_per_rad * frame.tangent]
}
