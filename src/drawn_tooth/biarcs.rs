//! A smooth chain of points as arcs that follow each other without a kink.
//!
//! In: points of a curve without corners, and how far arcs may pass beside them. Out: arcs and lines by their bulges
//! (tan(sweep / 4), positive counter-clockwise), from point to point of the chain, two to a step.
//!
//! **Law.** Tangents are those of the circle through a point and two others beside it, far enough apart that what
//! points are off hardly turns them; dense points give place and tangent together ([`super::scattered`]). Two arcs with
//! the same tangent where they meet lead from a point and its tangent to another point and its tangent (a biarc, both
//! legs equally long: Bolton, *Biarc curves*, Computer-Aided Design 7, 1975). The greedy walk takes the longest step
//! whose arcs pass all points between within the tolerance. It leads from the centre line outwards on both sides, so
//! that a symmetric chain has symmetric arcs; what arcs are one with the next become one piece.
//!
//! Road not taken: the free arcs of exported drawings, two thirds as many, with kinks between them. An edge
//! with kinks leaves marks on the gear, and the contact of a continuous motion jumps over them.

use super::scattered::{CurvePlace, REACH, Scattered, turn_rad};
use crate::gcode::longest_lines;
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_8};

/// An arc that leaves its chord by less than this is a line, mm.
const STRAIGHT_MM: f64 = 1e-9;
/// Points nearer to the centre line than this are on it, mm.
const CENTRE_MM: f64 = 1e-6;
/// Pieces are one where their ends keep their directions so well, rad.
const SAME_RAD: f64 = 1e-10;

/// An arc or a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcPiece {
    /// Where it begins, mm.
    pub start_mm: DVec2,
    /// Where it ends, mm.
    pub end_mm: DVec2,
    /// tan(sweep / 4), positive counter-clockwise; 0: a line.
    pub bulge: f64,
}

impl ArcPiece {
    /// A line.
    fn line(start_mm: DVec2, end_mm: DVec2) -> Self {
        Self { start_mm, end_mm, bulge: 0.0 }
    }

    /// The arc that begins in a direction.
    fn towards(start_mm: DVec2, along: DVec2, end_mm: DVec2) -> Self {
        let chord = end_mm - start_mm;
        let bulge = (0.5 * turn_rad(along, chord)).tan();
        let is_straight = 0.5 * (bulge * chord.length()).abs() < STRAIGHT_MM;
        Self { start_mm, end_mm, bulge: if is_straight { 0.0 } else { bulge } }
    }

    /// Angle by which its direction turns, rad, positive counter-clockwise.
    pub fn sweep_rad(&self) -> f64 {
        4.0 * self.bulge.atan()
    }

    /// Directions at its ends.
    pub fn directions(&self) -> [DVec2; 2] {
        let chord = (self.end_mm - self.start_mm).normalize_or(DVec2::Y);
        [-0.5, 0.5].map(|half| DVec2::from_angle(half * self.sweep_rad()).rotate(chord))
    }

    /// How far it passes beside a point between its ends, mm.
    fn beside_mm(&self, p: DVec2) -> f64 {
        let chord = self.end_mm - self.start_mm;
        if self.bulge == 0.0 {
            return (chord.perp_dot(p - self.start_mm) / chord.length()).abs();
        }
        let b = self.bulge;
        let arm = (1.0 - b * b) / (4.0 * b) * chord.perp();
        let center = 0.5 * (self.start_mm + self.end_mm) + arm;
        (p.distance(center) - self.start_mm.distance(center)).abs()
    }
}

/// Arcs along a chain of at least two points, which leads from right to left round the axis of the blade.
pub fn fit(chain: &[DVec2], tolerance_mm: f64) -> Vec<ArcPiece> {
    let last = chain.len() - 1;
    let to = chain.iter().position(|at| at.y > CENTRE_MM).unwrap_or(last);
    let from = chain[..=to].iter().rposition(|at| at.y < -CENTRE_MM).unwrap_or(0);
    let walk = ArcWalk::new(chain, tolerance_mm);
    let mirrored: Vec<DVec2> = chain.iter().rev().map(|&at| mirror(at)).collect();
    let right = ArcWalk::new(&mirrored, tolerance_mm).outwards(last - from);
    let right = right.iter().rev().map(|piece| ArcPiece {
        start_mm: mirror(piece.end_mm),
        end_mm: mirror(piece.start_mm),
        bulge: piece.bulge,
    });
    joined(right.chain(walk.over(from, to)).chain(walk.outwards(to)))
}

fn mirror(at: DVec2) -> DVec2 {
    DVec2::new(at.x, -at.y)
}

/// The walk along a chain.
struct ArcWalk<'a> {
    chain: &'a [DVec2],
    places: Vec<CurvePlace>,
    tolerance_mm: f64,
}

impl<'a> ArcWalk<'a> {
    fn new(chain: &'a [DVec2], tolerance_mm: f64) -> Self {
        Self { chain, places: places(chain, tolerance_mm), tolerance_mm }
    }

    fn between(&self, from: usize, to: usize) -> Option<[ArcPiece; 2]> {
        biarc(self.places[from], self.places[to])
    }

    /// Whether arcs pass all points between two within the tolerance.
    fn fits(&self, from: usize, to: usize) -> bool {
        let Some([first, second]) = self.between(from, to) else { return false };
        let is_short = [first, second].iter().all(|piece| piece.bulge.abs() <= FRAC_PI_8.tan());
        let across = second.end_mm - first.start_mm;
        is_short
            && self.chain[from + 1..to].iter().all(|&p| {
                let is_first = (p - first.end_mm).dot(across) < 0.0;
                (if is_first { first } else { second }).beside_mm(p) <= self.tolerance_mm
            })
    }

    /// Arcs from a point to the end of the chain.
    fn outwards(&self, from: usize) -> Vec<ArcPiece> {
        let ends = longest_lines(self.chain.len() - 1 - from, |a, b| self.fits(from + a, from + b));
        let ends: Vec<usize> = [0].into_iter().chain(ends).map(|end| from + end).collect();
        ends.windows(2).flat_map(|pair| self.step(pair[0], pair[1])).collect()
    }

    /// Arcs over a few points, in one step if it may be.
    fn over(&self, from: usize, to: usize) -> Vec<ArcPiece> {
        if self.fits(from, to) {
            return self.step(from, to);
        }
        (from..to).flat_map(|i| self.step(i, i + 1)).collect()
    }

    fn step(&self, from: usize, to: usize) -> Vec<ArcPiece> {
        let chord = ArcPiece::line(self.places[from].point_mm, self.places[to].point_mm);
        // Neighbours whose tangents lead astray are joined by a line.
        let is_near = |pieces: &[ArcPiece; 2]| to > from + 1 || chord.beside_mm(pieces[0].end_mm) <= self.tolerance_mm;
        self.between(from, to).filter(is_near).map_or_else(|| vec![chord], |pieces| pieces.to_vec())
    }
}

/// Pieces without the ends at which nothing changes.
fn joined(pieces: impl Iterator<Item = ArcPiece>) -> Vec<ArcPiece> {
    let mut all: Vec<ArcPiece> = Vec::new();
    for piece in pieces {
        if let Some(before) = all.last_mut() {
            let half_rad = 0.5 * (before.sweep_rad() + piece.sweep_rad());
            let bulge = if half_rad == 0.0 { 0.0 } else { (0.5 * half_rad).tan() };
            let both = ArcPiece { start_mm: before.start_mm, end_mm: piece.end_mm, bulge };
            let ends = [(both.directions()[0], before.directions()[0]), (both.directions()[1], piece.directions()[1])];
            if half_rad.abs() < FRAC_PI_2 && ends.iter().all(|&(a, b)| turn_rad(a, b).abs() < SAME_RAD) {
                *before = both;
                continue;
            }
        }
        all.push(piece);
    }
    all
}

/// The curve at all points of a chain.
fn places(chain: &[DVec2], tolerance_mm: f64) -> Vec<CurvePlace> {
    let scattered = Scattered::new(chain, tolerance_mm);
    let last = chain.len() - 1;
    let place = |(i, tangent): (usize, DVec2)| {
        let own = CurvePlace { point_mm: chain[i], tangent };
        let found = scattered.at(i).unwrap_or(own);
        // Neighbouring chains begin and end with the same points.
        if i == 0 || i == last { CurvePlace { tangent: found.tangent, ..own } } else { found }
    };
    tangents(chain, REACH * tolerance_mm).into_iter().enumerate().map(place).collect()
}

/// Unit tangents at all points of a chain, from points at least so far to either side.
fn tangents(chain: &[DVec2], reach_mm: f64) -> Vec<DVec2> {
    let last = chain.len() - 1;
    let before = |i: usize| (0..i).rev().find(|&j| chain[j].distance(chain[i]) >= reach_mm).or((i > 0).then_some(0));
    let after =
        |i: usize| (i + 1..=last).find(|&j| chain[j].distance(chain[i]) >= reach_mm).or((i < last).then_some(last));
    // From a point to another one on its circle, seen by inversion at the first.
    let away = |i: usize, j: usize| (chain[j] - chain[i]) / chain[j].distance_squared(chain[i]);
    let tangent = |i: usize| {
        let tangent = match (before(i), after(i)) {
            (Some(j), Some(k)) => away(i, k) - away(i, j),
            (None, Some(k)) => away(i, k) - after(k).map_or(DVec2::ZERO, |l| away(i, l)),
            (Some(j), None) => before(j).map_or(DVec2::ZERO, |l| away(i, l)) - away(i, j),
            (None, None) => DVec2::Y,
        };
        tangent.normalize_or(DVec2::Y)
    };
    (0..=last).map(tangent).collect()
}

/// Both arcs from one point with its tangent to another one; none where the tangents lead away from each other.
fn biarc(start: CurvePlace, end: CurvePlace) -> Option<[ArcPiece; 2]> {
    let ([from, to], [start, end]) = ([start.tangent, end.tangent], [start.point_mm, end.point_mm]);
    let (v, t) = (end - start, from + to);
    // Legs of length d along both tangents, whose tips are 2 d apart.
    let (square, linear) = (2.0 * (1.0 - from.dot(to)), v.dot(t));
    if linear <= 0.0 {
        return None;
    }
    let leg_mm = v.length_squared() / (linear + (linear * linear + square * v.length_squared()).sqrt());
    let joint = 0.5 * (start + end + leg_mm * (from - to));
    let first = ArcPiece::towards(start, from, joint);
    let second = ArcPiece::towards(end, -to, joint);
    Some([first, ArcPiece { start_mm: joint, end_mm: end, bulge: -second.bulge }])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest turn from one piece to the next, rad.
    fn kink_rad(pieces: &[ArcPiece]) -> f64 {
        let turn = |pair: &[ArcPiece]| turn_rad(pair[0].directions()[1], pair[1].directions()[0]).abs();
        pieces.windows(2).map(turn).fold(0.0, f64::max)
    }

    #[test]
    fn a_circle_is_arcs_of_its_radius() {
        let chain: Vec<DVec2> = (0..=200).map(|i| 7.0 * DVec2::from_angle(0.005 * f64::from(i))).collect();
        let pieces = fit(&chain, 1e-4);
        assert!(pieces.len() <= 4, "{} pieces", pieces.len());
        for piece in &pieces {
            let radius_mm = 0.5 * piece.start_mm.distance(piece.end_mm) / (0.5 * piece.sweep_rad()).sin();
            assert!((radius_mm - 7.0).abs() < 1e-9, "{piece:?}: {radius_mm}");
        }
        assert!(kink_rad(&pieces) < 1e-12);
    }

    /// An involute, and a curve that bends both ways: between the points as well, arcs pass within the tolerance, and
    /// they meet without a kink.
    #[test]
    fn curves_are_followed_without_kinks() {
        let involute = |t: f64| {
            let u = 0.05 + 0.6 * t;
            20.0 * (DVec2::from_angle(u) - u * DVec2::from_angle(u).perp())
        };
        let wave = |t: f64| DVec2::new(6.0 * t, (5.0 * t).sin());
        let curves: [&dyn Fn(f64) -> DVec2; 2] = [&involute, &wave];
        for (curve, most) in curves.into_iter().zip([12, 60]) {
            let chain: Vec<DVec2> = (0..=300).map(|i| curve(f64::from(i) / 300.0)).collect();
            let pieces = fit(&chain, 5e-4);
            let off_mm = |p: DVec2| {
                let near = |piece: &&ArcPiece| {
                    let chord = piece.end_mm - piece.start_mm;
                    (-1e-3..=1.001).contains(&((p - piece.start_mm).dot(chord) / chord.length_squared()))
                };
                pieces.iter().filter(near).map(|piece| piece.beside_mm(p)).fold(f64::INFINITY, f64::min)
            };
            let worst_mm = (0..=6000).map(|i| off_mm(curve(f64::from(i) / 6000.0))).fold(0.0, f64::max);
            assert!(worst_mm < 5.2e-4 && worst_mm > 1e-5, "{worst_mm} mm off");
            assert!(pieces.len() <= most && kink_rad(&pieces) < 1e-9, "{} pieces", pieces.len());
        }
    }
}
