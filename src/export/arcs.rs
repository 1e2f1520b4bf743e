//! A dense chain of points as few arcs and lines.
//!
//! In: points of a curve, so close that the curve lies within a small share of the tolerance of their chords. Out:
//! [`ArcPath`]: every vertex is one of the points, and no point is farther from its arc than the tolerance.
//!
//! **Law.** Arcs from A to B are one family, by the bulge b = tan(sweep / 4), positive counter-clockwise. The arc
//! through a point q has b = tan(t / 2), t being the turn from AQ to QB. An arc that passes between q- and q+, the
//! places a tolerance to either side of a point, is within the tolerance of it: every point gives a range of b, and an
//! arc exists where all ranges overlap. The greedy walk takes the longest one; with as many pieces the tolerance is
//! then made as small as it goes, so that the last piece is no remnant.
//!
//! Corners of the chain are vertices. Elsewhere arcs follow each other with hardly a kink, though nothing demands it:
//! on a curve whose curvature changes evenly both neighbours leave their common point by the same angle.
//!
//! Road not taken: biarcs, tangent everywhere. Their error is three times that of free arcs of the same length
//! (k' l^3 / 40 to k' l^3 / 125 for curvature that changes by k'), so that they need half as many pieces again.

use crate::gcode::longest_lines;
use glam::DVec2;

/// A chain that turns by more than this at a point has a corner there, rad. Neighbouring chords of smooth curves turn
/// by hundredths: points are closer together by far than their radius of curvature.
const CORNER_RAD: f64 = 0.2;
/// Points nearer than this to the one before are the same one, mm.
const NEAREST_MM: f64 = 1e-7;
/// Halvings of the tolerance at one number of pieces.
const EVENING_STEPS: u32 = 12;
/// Largest bulge: half a circle. Programs that read arcs disagree on longer ones.
const LARGEST_BULGE: f64 = 1.0;

/// What a path is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathPieces {
    /// Arcs, and lines where these suffice.
    Arcs,
    /// Lines alone.
    Lines,
}

/// A vertex with the piece that follows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcVertex {
    /// Place, mm.
    pub point_mm: DVec2,
    /// tan(sweep / 4) of the arc to the next vertex, positive counter-clockwise; 0: a line.
    pub bulge: f64,
}

/// Arcs and lines, each from where the one before ended.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcPath {
    /// Vertices in order.
    pub vertices: Vec<ArcVertex>,
    /// Whether the last vertex is joined to the first; the bulge of the last one means nothing else.
    pub is_closed: bool,
}

impl ArcPath {
    /// Path along a chain within `tolerance_mm` of every point of it; a closed chain does not repeat its first point.
    ///
    /// # Panics
    /// Fewer than two points.
    pub fn fit(points_mm: &[DVec2], is_closed: bool, tolerance_mm: f64, pieces: PathPieces) -> Self {
        assert!(points_mm.len() >= 2, "a chain has a beginning and an end");
        let parts = smooth_parts(points_mm, is_closed);
        let mut vertices: Vec<ArcVertex> = parts.iter().flat_map(|part| evened(part, tolerance_mm, pieces)).collect();
        if !is_closed {
            vertices.push(ArcVertex { point_mm: points_mm[points_mm.len() - 1], bulge: 0.0 });
        }
        Self { vertices, is_closed }
    }

    /// Places along the path, about `step_mm` apart, the vertices among them.
    pub fn places_mm(&self, step_mm: f64) -> Vec<DVec2> {
        let ends = self.vertices.iter().skip(1).chain(self.vertices.first().filter(|_| self.is_closed));
        let piece = |(vertex, end): (&ArcVertex, &ArcVertex)| {
            let (start, chord) = (vertex.point_mm, end.point_mm - vertex.point_mm);
            let half_rad = 2.0 * vertex.bulge.atan();
            let count = (chord.length() / step_mm).ceil().max(1.0) as u32;
            // The chord to a place at a share t of the arc is turned and shortened as the angle at the circumference
            // says: sin(t a) / sin(a), by (t - 1) a, with the half sweep a.
            let place = move |i: u32| {
                let share = f64::from(i) / f64::from(count);
                if half_rad == 0.0 {
                    return start + share * chord;
                }
                let turned = DVec2::from_angle((share - 1.0) * half_rad).rotate(chord);
                start + (share * half_rad).sin() / half_rad.sin() * turned
            };
            (0..count).map(place)
        };
        let open_end = self.vertices.last().filter(|_| !self.is_closed).map(|vertex| vertex.point_mm);
        self.vertices.iter().zip(ends).flat_map(piece).chain(open_end).collect()
    }

    /// Number of arcs and lines.
    pub fn count(&self) -> usize {
        self.vertices.len() - usize::from(!self.is_closed)
    }

    /// How many of them are lines.
    pub fn lines(&self) -> usize {
        self.vertices[..self.count()].iter().filter(|vertex| vertex.bulge == 0.0).count()
    }
}

/// The chain without points nearer than `nearest_mm` to the one before; a closed one does not repeat its first either.
pub fn distinct(points_mm: &[DVec2], is_closed: bool, nearest_mm: f64) -> Vec<DVec2> {
    let mut chain = points_mm.to_vec();
    chain.dedup_by(|later, kept| later.distance(*kept) < nearest_mm);
    if is_closed && chain.len() > 2 && chain[0].distance(chain[chain.len() - 1]) < nearest_mm {
        chain.pop();
    }
    chain
}

/// A chain cut at its corners: each part begins with the point with which the one before ends. A closed chain without a
/// corner is one part, which ends where it begins; a chain whose points are all the same has none.
pub fn smooth_parts(points_mm: &[DVec2], is_closed: bool) -> Vec<Vec<DVec2>> {
    let mut chain = distinct(points_mm, is_closed, NEAREST_MM);
    let mut corners: Vec<usize> = (0..chain.len()).filter(|&i| is_corner(&chain, i, is_closed)).collect();
    if is_closed {
        // From corner to corner, and round to the first one.
        let first = corners.first().copied().unwrap_or(0);
        chain.rotate_left(first);
        for corner in &mut corners {
            *corner -= first;
        }
        chain.push(chain[0]);
    } else if let (Some(last), Some(&end)) = (chain.last_mut(), points_mm.last()) {
        *last = end;
    }
    let ends = [0].into_iter().chain(corners.into_iter().filter(|&i| i > 0)).chain([chain.len() - 1]);
    let ends: Vec<usize> = ends.collect();
    ends.windows(2).filter(|pair| pair[1] > pair[0]).map(|pair| chain[pair[0]..=pair[1]].to_vec()).collect()
}

fn is_corner(chain: &[DVec2], i: usize, is_closed: bool) -> bool {
    let count = chain.len();
    if !is_closed && (i == 0 || i + 1 == count) {
        return false;
    }
    let [before, after] = [chain[(i + count - 1) % count], chain[(i + 1) % count]];
    (chain[i] - before).angle_to(after - chain[i]).abs() > CORNER_RAD
}

/// Vertices along a chain without corners, the last point left out.
fn evened(chain: &[DVec2], tolerance_mm: f64, pieces: PathPieces) -> Vec<ArcVertex> {
    let mut best = greedy(chain, tolerance_mm, pieces);
    let (mut low, mut high) = (0.0, tolerance_mm);
    for _ in 0..EVENING_STEPS {
        let middle = 0.5 * (low + high);
        let tried = greedy(chain, middle, pieces);
        if tried.len() == best.len() {
            (best, high) = (tried, middle);
        } else {
            low = middle;
        }
    }
    best
}

fn greedy(chain: &[DVec2], tolerance_mm: f64, pieces: PathPieces) -> Vec<ArcVertex> {
    let within = |from: usize, to: usize| bulge_within(&chain[from..=to], tolerance_mm, pieces);
    let mut from = 0;
    let vertex = |to: usize| {
        // Neighbours are joined by their chord, whatever the tolerance.
        let bulge = within(from, to).unwrap_or_default();
        let point_mm = chain[std::mem::replace(&mut from, to)];
        ArcVertex { point_mm, bulge }
    };
    longest_lines(chain.len() - 1, |from, to| within(from, to).is_some()).into_iter().map(vertex).collect()
}

/// Bulge of an arc from the first point of a chain to its last one that is within the tolerance of all others.
fn bulge_within(chain: &[DVec2], tolerance_mm: f64, pieces: PathPieces) -> Option<f64> {
    let (a, b) = (chain[0], chain[chain.len() - 1]);
    let (mut low, mut high) = (-LARGEST_BULGE, LARGEST_BULGE);
    for around in chain.windows(3) {
        let point = around[1];
        if point.distance(a).min(point.distance(b)) <= tolerance_mm {
            continue;
        }
        let aside = tolerance_mm * (around[2] - around[0]).normalize_or_zero().perp();
        let [left, right] = [point + aside, point - aside].map(|q| {
            let (to, on) = (q - a, b - q);
            to.perp_dot(on) / (to.length() * on.length() + to.dot(on))
        });
        low = low.max(left.min(right));
        high = high.min(left.max(right));
        if low > high {
            return None;
        }
    }
    if low <= 0.0 && high >= 0.0 {
        return Some(0.0);
    }
    (pieces == PathPieces::Arcs).then_some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// Distance of a point from a path: to circles about centres, by a formula that the fit does not use.
    fn distance_mm(path: &ArcPath, p: DVec2) -> f64 {
        let count = path.vertices.len();
        let of_piece = |i: usize| {
            let (vertex, end) = (path.vertices[i], path.vertices[(i + 1) % count].point_mm);
            let (start, b) = (vertex.point_mm, vertex.bulge);
            let ends = p.distance(start).min(p.distance(end));
            let chord = end - start;
            if b == 0.0 {
                let share = (p - start).dot(chord) / chord.length_squared();
                return p.distance(start + share.clamp(0.0, 1.0) * chord);
            }
            let centre = start + 0.5 * chord + (1.0 - b * b) / (4.0 * b) * chord.perp();
            let radius = centre.distance(start);
            let turned = (start - centre).angle_to(p - centre) * b.signum();
            let sweep = 4.0 * b.abs().atan();
            if turned.rem_euclid(TAU) <= sweep { (p.distance(centre) - radius).abs() } else { ends }
        };
        (0..path.count()).map(of_piece).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_circle_is_two_arcs_and_a_square_four_lines() {
        let circle: Vec<DVec2> = (0..1000).map(|i| 30.0 * DVec2::from_angle(TAU * f64::from(i) / 1000.0)).collect();
        let path = ArcPath::fit(&circle, true, 1e-3, PathPieces::Arcs);
        assert!(path.count() <= 3 && path.lines() == 0, "{path:?}");
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(DVec2::from);
        let path = ArcPath::fit(&square, true, 1e-3, PathPieces::Arcs);
        assert_eq!((path.count(), path.lines()), (4, 4), "{path:?}");
        assert!(path.vertices.iter().all(|vertex| vertex.point_mm != DVec2::X), "points of a line are left out");
    }

    /// Involutes are the spirals r_b (u^2 / 2) long: the curve itself, sampled a hundred times finer than the fit had
    /// it, is within the tolerance, both ways, and arcs are far fewer than chords.
    #[test]
    fn the_curve_between_the_points_is_within_the_tolerance() {
        let involute = |u: f64| 30.0 * (DVec2::from_angle(u) - u * DVec2::from_angle(u).perp());
        let (from, to, points) = (0.05, 0.9, 2000_u32);
        let at = |i: u32, of: u32| involute(from + (to - from) * f64::from(i) / f64::from(of));
        let chain: Vec<DVec2> = (0..=points).map(|i| at(i, points)).collect();
        for tolerance_mm in [1e-2, 1e-3, 1e-4] {
            let path = ArcPath::fit(&chain, false, tolerance_mm, PathPieces::Arcs);
            let off = (0..=100 * points).map(|i| distance_mm(&path, at(i, 100 * points))).fold(0.0, f64::max);
            assert!(off <= 1.001 * tolerance_mm && off > 0.2 * tolerance_mm, "{off} mm within {tolerance_mm} mm");
            // A spiral of length l is k' l^3 / (72 sqrt 3) off the arc through its ends. An involute has the slope
            // k' = 1 / (r_b^2 u^3) of its curvature and ds = r_b u du, so that equally good arcs divide u evenly.
            let fewest = (30.0 / (72.0 * 3_f64.sqrt() * tolerance_mm)).cbrt() * (to - from);
            let chords = ArcPath::fit(&chain, false, tolerance_mm, PathPieces::Lines).count();
            let count = path.count();
            assert!(count as f64 <= fewest.ceil() && 3 * count < chords, "{count} of {fewest}, {chords} chords");
        }
    }

    #[test]
    fn neighbouring_arcs_of_a_spiral_have_hardly_a_kink() {
        let spiral = |t: f64| (10.0 + t) * DVec2::from_angle(t);
        let chain: Vec<DVec2> = (0..=4000).map(|i| spiral(f64::from(i) / 2000.0)).collect();
        let path = ArcPath::fit(&chain, false, 1e-3, PathPieces::Arcs);
        let ends: Vec<[DVec2; 2]> = path
            .vertices
            .windows(2)
            .map(|pair| {
                let chord = pair[1].point_mm - pair[0].point_mm;
                [-2.0, 2.0].map(|of| chord.rotate(DVec2::from_angle(of * pair[0].bulge.atan())))
            })
            .collect();
        let kink = ends.windows(2).map(|pair| pair[0][1].angle_to(pair[1][0]).abs()).fold(0.0, f64::max);
        assert!(ends.len() > 3 && kink < 0.1 * PI / 180.0, "{} pieces, {kink} rad", ends.len());
    }

    #[test]
    fn corners_are_vertices() {
        let corner = DVec2::new(5.0, 0.0);
        let arm = |direction: DVec2| move |i: i32| corner + direction * f64::from(i) * 0.01;
        let chain: Vec<DVec2> = (0..500).rev().map(arm(DVec2::NEG_X)).chain((1..500).map(arm(DVec2::Y))).collect();
        let path = ArcPath::fit(&chain, false, 0.1, PathPieces::Arcs);
        assert_eq!(path.count(), 2);
        assert_eq!(path.vertices[1].point_mm, corner);
    }
}
