//! The blank's outline as a closed curve on rays: the pitch curve moved along its normals towards the tips, and the
//! extent of the stock between it and its back.
//!
//! Parameter: polar angle phi of the foot on the pitch curve. With the distance a and the sign s of the tips'
//! direction, the outline is P + s a n and its derivative (1 + s a kappa) s' t; the blank refuses curvatures at which
//! it would turn back. Over the dwell of a sector there are two straight walls and the arc between them, whose
//! parameter is its polar angle.

use super::blank::Blank;
use super::{Back, GearKind};
use crate::math::planar_rays::{ClosedCurve, Piece};
use glam::DVec2;
use std::f64::consts::TAU;

/// Pieces per turn at least: each turns by half a degree on a circle.
const LEAST_PIECES: usize = 720;

/// A piece stays within this many arrow heights at its middle of its chord: 32/27 for a cubic that bends one way (its
/// distance from the chord is t (1 - t) ((1 - t) a + t b) with the slopes a and b at its ends), the rest for what half
/// a degree of a pitch curve has beyond a cubic, and no proof. Too small, a ray that only just meets a bulge misses it,
/// and the blank loses what lies beyond its chord there: `tests/suite/shaping/blank_field.rs` compares volumes with the
/// outline's own.
const SAGITTA_SAFETY: f64 = 2.0;
/// Added to arrow heights, mm: rounding.
const ROUNDING_MM: f64 = 1e-9;

/// Closed outline of the stock on its toothed side, counter-clockwise: round the material of an external gear, round
/// the hole of a ring.
#[derive(Debug)]
pub struct BlankOutline<'a> {
    blank: &'a Blank,
    pieces: Vec<Piece>,
    /// Where each piece begins, and its directions at both ends.
    nodes: Vec<(DVec2, [DVec2; 2])>,
}

/// Laws of pieces: over teeth, and over the dwell of a sector.
const TEETH: u32 = 0;
const DWELL: u32 = 1;

impl<'a> BlankOutline<'a> {
    /// Outline of a blank.
    pub fn new(blank: &'a Blank) -> Self {
        let per_turn = blank.curve().samples_per_turn().clamp(LEAST_PIECES, 1 << 14);
        let ranges = |[from, to]: [f64; 2]| {
            let count = ((to - from) / TAU * per_turn as f64).ceil().max(1.0) as usize;
            let at = move |i: usize| from + (to - from) * i as f64 / count as f64;
            (0..count).map(move |i| [at(i), at(i + 1)])
        };
        let mut laws: Vec<(u32, [f64; 2])> = ranges(blank.curve().toothed_rad()).map(|range| (TEETH, range)).collect();
        if let Some(dwell) = blank.dwell() {
            // A chord runs from the end of the piece before it to the beginning of the one behind it.
            laws.push((Piece::STRAIGHT, [laws[laws.len() - 1].1[1]; 2]));
            laws.extend(ranges(dwell.arc_rad()).map(|range| (DWELL, range)));
            laws.push((Piece::STRAIGHT, [dwell.arc_rad()[1]; 2]));
        }
        let before = |i: usize| if i == 0 { laws.len() - 1 } else { i - 1 };
        let start = |i: usize| match laws[i] {
            (Piece::STRAIGHT, [at, _]) => place(blank, laws[before(i)].0, at)[0],
            (law, [from, _]) => place(blank, law, from)[0],
        };
        let starts: Vec<DVec2> = (0..laws.len()).map(start).collect();
        let piece = |i: usize| {
            let ((law, range), chord) = (laws[i], starts[(i + 1) % laws.len()] - starts[i]);
            if law == Piece::STRAIGHT {
                return (Piece { law, range, sagitta_mm: ROUNDING_MM }, (starts[i], [chord; 2]));
            }
            let middle = place(blank, law, 0.5 * (range[0] + range[1]))[0];
            let sagitta = chord.normalize_or_zero().perp_dot(middle - starts[i]).abs();
            // The end of a turn is its beginning, to the last bit.
            let end = match laws[(i + 1) % laws.len()] {
                (next, [from, _]) if next == law => from,
                _ => range[1],
            };
            let tangents = [range[0], end].map(|at| place(blank, law, at)[1]);
            (Piece { law, range, sagitta_mm: SAGITTA_SAFETY * sagitta + ROUNDING_MM }, (starts[i], tangents))
        };
        let (pieces, nodes) = (0..laws.len()).map(piece).unzip();
        Self { blank, pieces, nodes }
    }

    /// The side of the stock without teeth.
    pub fn back(&self) -> Back {
        self.blank.back
    }

    /// Largest distance of the stock from the gear axis, mm, with what lies between the nodes.
    pub fn reach_mm(&self) -> f64 {
        match self.back() {
            Back { kind: GearKind::Internal, radius_mm } => radius_mm,
            _ => self.nodes.iter().map(|n| n.0.length()).fold(0.0, f64::max) + self.sagitta_mm(),
        }
    }

    /// How near the stock comes to a point in the hole of a ring, or in front of an external gear, mm, at most by what
    /// lies between the nodes too small.
    pub fn clearance_mm(&self, point_mm: DVec2) -> f64 {
        self.nodes.iter().map(|n| n.0.distance(point_mm)).fold(f64::INFINITY, f64::min) - self.sagitta_mm()
    }

    fn sagitta_mm(&self) -> f64 {
        self.pieces.iter().map(|p| p.sagitta_mm).fold(0.0, f64::max)
    }

    /// Box round the stock: lowest and highest corner, mm.
    pub fn bounds_mm(&self) -> [DVec2; 2] {
        if let Back { kind: GearKind::Internal, radius_mm } = self.back() {
            return [DVec2::splat(-radius_mm), DVec2::splat(radius_mm)];
        }
        let sagitta = DVec2::splat(self.sagitta_mm());
        let points = self.nodes.iter().map(|n| n.0);
        let low = points.clone().reduce(DVec2::min).unwrap_or_default();
        [low - sagitta, points.reduce(DVec2::max).unwrap_or_default() + sagitta]
    }
}

impl ClosedCurve for BlankOutline<'_> {
    fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    fn node_mm(&self, index: usize) -> DVec2 {
        self.nodes[index].0
    }

    fn place(&self, law: u32, parameter: f64) -> [DVec2; 2] {
        place(self.blank, law, parameter)
    }

    fn tangents(&self, index: usize) -> [DVec2; 2] {
        self.nodes[index].1
    }
}

fn place(blank: &Blank, law: u32, phi_rad: f64) -> [DVec2; 2] {
    if let (DWELL, Some(dwell)) = (law, blank.dwell()) {
        let out = dwell.radius_mm * DVec2::from_angle(phi_rad);
        return [out, out.perp()];
    }
    let frame = blank.curve().frame(phi_rad);
    let outwards_mm = blank.kind().tip_sign() * blank.addendum_mm;
    let stretch = 1.0 + outwards_mm * frame.curvature_per_mm;
    [frame.point_mm + outwards_mm * frame.normal, stretch * frame.arc_rate_mm_per_rad * frame.tangent]
}
