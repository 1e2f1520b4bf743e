//! One blade's sweep as seen from a tile of dexels, and where it meets a ray.
//!
//! **The law.** A point p of the work is in the rake face at one moment of the sweep; it is removed if it lies inside
//! the blade's edge then. With the moment as t = tan(delta / 2), delta the angle of the rake face from where it holds
//! the tile's origin, and the point in axes fixed to the head there (r out of the axis, q in the direction of rotation,
//! y along the axis, which is w of the rake face, see [`super::turning_passes`]), the moment is the root of
//!
//! `q (1 - t^2) = 2 t R`,  R the distance along r from the axis,
//!
//! and the point's distance from the axis is then exactly `R + q t`: no square root, no transcendental function, and
//! nothing large is subtracted from anything large once r counts from a point of the edge. A helically gashed tool has
//! rake faces that turn with y; the point is turned back by that angle first.
//!
//! The work moves meanwhile. Its pose in those axes is a polynomial in u = t - t^3 / 3 + t^5 / 5, which is delta / 2
//! but for t^7 / 7, over the little that a tile needs: cubic for the tile's origin (140 mm away from the axis it turns
//! about), quadratic for directions. On a ray o + h n this gives two equations, the moment and the edge, in the
//! unknowns h and t; Newton's method solves both at once.
//!
//! Where the rates of slide or shift jump during a sweep, each of the two motions makes a sweep of its own, smooth, and
//! good up to that moment or from it on.
//!
//! Two tiles see one sweep through two polynomials, and a motion that is not smooth makes them differ: by how much at
//! most goes with the sweep, for whoever compares heights of one tile with those of another.
//!
//! Road not taken: eliminating t beforehand by a polynomial in the tile's three coordinates. It needs order four in one
//! of them, and long rays leave its range.

use crate::error::NotConverged;
use crate::math::convergence::{Step, iterate};
use crate::math::roots::bisect;
use crate::passes::planar::strokes::{NODES, cubic_through};
use crate::passes::spatial::turning_passes::{BladePass, TurningPasses};
use crate::tool::edge::Segment;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

/// Largest |t|: a quarter turn of the tool to either side of the moment at which the rake face holds the tile's origin.
/// Entries further round do not count, with candidates and with brute force alike; both are compared with an
/// independent solver in `tests/suite/hobbing/spatial.rs`.
pub const LARGEST_T: f64 = 1.0;
/// Steps at most towards the moment at which a rake face holds a point, and the last one (in t): the work turns some
/// hundredths as fast as the tool, so that each gains more than a digit.
const MAX_STEPS: u32 = 24;
const LAST_T: f64 = 1e-12;
/// Moments asked for, as a share of reach / (distance - reach). From the axis a reach x (in shares of the distance) is
/// seen under the angle asin x, so that t = tan(asin(x) / 2) is at most 0.5 x / (1 - x). A fifth more is left for the
/// work's own motion; for it there is no proof but the comparison with an independent solver.
const REACH_SHARE: f64 = 0.6;
/// Distance less reach counts as this share of the distance at least. Where it is less, the moments asked for are 0.6 x
/// 0.7 / 0.3 = 1.4 or more, beyond [`LARGEST_T`], so that the tile gets all moments.
const LEAST_DISTANCE: f64 = 0.3;
/// Secants at most towards the moment at which a rake face holds a tile's origin, and the angle that may be missing,
/// rad.
const MOST_SECANTS: u32 = 20;
const LAST_MISSING_RAD: f64 = 1e-14;

/// Sweeps that end at a corner of the motion go on by this much in t, so that no ray slips through between two of them:
/// ten nanometres of the blade's travel.
const CORNER_OVERLAP: f64 = 1e-7;

/// u and du/dt: nearly half the angle, by a polynomial that every backend computes alike.
#[inline(always)]
#[expect(clippy::inline_always, reason = "called inside vector code")]
pub fn half_angle(t: f64) -> [f64; 2] {
    let z = t * t;
    [t * (1.0 - z * (1.0 / 3.0 - z * 0.2)), 1.0 - z + z * z]
}

/// A sweep near a tile, for all segments of the blade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// Directions: `(r, q, y) = (turn[0] + u turn[1] + u^2 turn[2]) p_tile + place(u)`.
    turn: [DMat3; 3],
    /// Tile's origin: coefficients of u^0 to u^3; r from the tool's axis.
    place_mm: [DVec3; 4],
    /// Turn of the rake face against t = 0 per mm of y, rad/mm, in the direction of q.
    twist_rad_per_mm: f64,
    /// Moments at which it is good.
    t_range: [f64; 2],
    /// Largest angle of the rake face from the head's x axis in the work, rad.
    half_window_rad: f64,
    /// Distance of the blade's origin from the tool's axis, mm.
    radial_mm: f64,
    /// See [`SweepRecord::off_mm`].
    off_mm: f64,
    /// Angle of the rake face from the head's x axis where it holds the tile's origin, in the direction of rotation.
    pub sweep_angle_rad: f64,
}

/// One sweep of one segment over one tile: what a backend reads.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRecord {
    /// Pass id.
    pub pass: u32,
    /// Index of the segment in the plan's list.
    pub segment: u32,
    /// Cells of the tile in which it can leave the lowest surface, as bits (see
    /// [`super::sweep_tile::SweepTile::cell`]).
    pub cells: u16,
    /// Where Newton's method starts.
    pub start: SweepStart,
    /// Distance of the segment's origin from the tool's axis, mm; r counts from there, y from the segment's origin.
    pub radius_mm: f64,
    /// Turn of the rake face per mm of y, rad/mm.
    pub twist_rad_per_mm: f64,
    /// Moments at which it is good: all that a tile can ask for, unless the motion has a corner among them.
    pub t_range: [f64; 2],
    /// Rows r, q, y of the rotation; coefficients of u^0 to u^2.
    pub turn: [[[f64; 3]; 3]; 3],
    /// Tile's origin in (r, q, y): coefficients of u^0 to u^3, mm.
    pub place_mm: [[f64; 3]; 4],
    /// How far the polynomials may be from the motion, mm.
    pub off_mm: f64,
}

/// Heights and moments from which Newton's method starts on a tile: polynomials in columns x and rows y from the tile's
/// middle ray, coefficients of 1, x, y, x^2, x y, y^2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SweepStart {
    /// Heights, mm.
    pub height_mm: [f64; 6],
    /// Moments.
    pub t: [f64; 6],
}

impl SweepRecord {
    /// Whether the motion has a corner among the moments that a tile can ask for, so that rays may miss the sweep where
    /// its continuation goes on.
    pub fn ends_in_tile(&self) -> bool {
        self.t_range != [-LARGEST_T, LARGEST_T]
    }
}

impl Sweep {
    /// Sweep of a pass in a piece of the motion as seen from a tile with its origin at `origin_mm` (gear frame) and
    /// nothing further than `reach_mm` from it. `None`: the blade holds the tile at no moment of its sweep, or at none
    /// of the piece.
    pub fn new(set: &TurningPasses, pass: &BladePass, piece: u32, origin_mm: DVec3, reach_mm: f64) -> Option<Self> {
        let place = set.place(pass);
        let twist = set.rake_twist_rad_per_mm;
        let head_from_work = |swept: f64| set.motion.head_from_work_on(piece, pass.tool_angle_rad + set.turn * swept);
        let blade_y = |z: f64| place.y_sign * (z - place.axial_mm);
        let missing_at = |swept: f64| {
            let at = head_from_work(swept).point(origin_mm);
            (within_half_a_turn(at.y.atan2(at.x) - twist * blade_y(at.z) - swept), at)
        };
        // Moments that a tile can ask for, from the one at which the rake face holds its origin.
        let range = |radius_mm: f64| {
            (REACH_SHARE * reach_mm / (radius_mm - reach_mm).max(LEAST_DISTANCE * radius_mm)).min(LARGEST_T)
        };
        // The window is that of all points of the tile, not of its origin alone.
        let window_rad = |at: DVec3| set.half_window_rad + 2.0 * range(at.x.hypot(at.y)).atan();
        // The rake face follows the point, which moves some hundredths as fast: the secant of what is missing.
        let mut at = DVec3::ZERO;
        let mut before: Option<[f64; 2]> = None;
        let moment = iterate("the moment at which a rake face holds a tile", 0.0, MOST_SECANTS, |swept| {
            let missing;
            (missing, at) = missing_at(swept);
            let rate = before.map_or(-1.0, |[angle, less]| (missing - less) / (swept - angle));
            before = Some([swept, missing]);
            let to = swept - missing / rate;
            if to.abs() > set.half_window_rad && to.abs() > window_rad(at) {
                ControlFlow::Break(None)
            } else if missing.abs() < LAST_MISSING_RAD {
                ControlFlow::Break(Some(to))
            } else {
                ControlFlow::Continue(Step { to, residual: missing })
            }
        });
        // What is missing falls over the whole sweep: secants that do not settle leave it to halving.
        let swept = moment.unwrap_or_else(|_| {
            let ahead = |swept: f64| missing_at(swept).0 > 0.0;
            let ends = [-1.0, 1.0].map(|sign| sign * window_rad(at));
            let found = (ahead(ends[0]) && !ahead(ends[1])).then(|| bisect(ahead, ends[0], ends[1]))?;
            at = missing_at(found).1;
            Some(found)
        })?;
        // Axes at blade y = 0 of the rake face at this moment.
        let (sin, cos) = swept.sin_cos();
        let axes = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), place.y_sign * DVec3::Z);
        let from_head = axes.transpose();
        let radius_mm = at.x.hypot(at.y);
        let range = range(radius_mm);
        let [from, to] = set.motion.piece_rad(piece).map(|angle| set.turn * (angle - pass.tool_angle_rad));
        let t_at_swept = |angle: f64| match 0.5 * (angle - swept) {
            half if half.abs() < 0.25 * PI => half.tan(),
            half => LARGEST_T.copysign(half),
        };
        let [from, to] = [t_at_swept(from.min(to)) - CORNER_OVERLAP, t_at_swept(from.max(to)) + CORNER_OVERLAP];
        if from > range || to < -range {
            return None;
        }
        let t_range = if from < -range && to > range { [-LARGEST_T, LARGEST_T] } else { [from, to] };
        let (mut turns, mut places) = ([[0.0; 4]; 9], [[0.0; 4]; 3]);
        let largest_u = half_angle(range)[0];
        // The nodes stand in pairs about the middle.
        let [outer, inner] = [NODES[3], NODES[2]].map(|share| 2.0 * t_at(largest_u * share).atan());
        for (node, delta) in [-outer, -inner, inner, outer].into_iter().enumerate() {
            let head_from_work = head_from_work(swept + delta);
            let turn = (from_head * head_from_work.rotation).to_cols_array();
            let origin = head_from_work.point(origin_mm) - DVec3::new(0.0, 0.0, place.axial_mm);
            let origin = (from_head * origin).to_array();
            turns.iter_mut().zip(turn).for_each(|(entry, value)| entry[node] = value);
            places.iter_mut().zip(origin).for_each(|(entry, value)| entry[node] = value);
        }
        let turns = turns.map(|values| {
            // A cube is 3/4 of its base but for the Chebyshev polynomial T3, the smallest in its worst place: a
            // quadratic is enough.
            let [c0, c1, c2, c3] = cubic_through(&values);
            [c0, (c1 + 0.75 * c3) / largest_u, c2 / largest_u.powi(2)]
        });
        let places = places.map(|values| {
            let [c0, c1, c2, c3] = cubic_through(&values);
            [c0, c1 / largest_u, c2 / largest_u.powi(2), c3 / largest_u.powi(3)]
        });
        let angle_rad = pass.tool_angle_rad + set.turn * swept;
        let off_mm = set.motion.cubic_error_mm(piece, angle_rad, 2.0 * range.atan(), [origin_mm.length(), reach_mm]);
        Some(Self {
            turn: [0, 1, 2].map(|k| DMat3::from_cols_array(&turns.map(|entry| entry[k]))),
            place_mm: [0, 1, 2, 3].map(|k| DVec3::from_array(places.map(|entry| entry[k]))),
            twist_rad_per_mm: twist,
            t_range,
            half_window_rad: set.half_window_rad,
            radial_mm: place.radial_mm,
            off_mm,
            sweep_angle_rad: swept,
        })
    }

    /// The sweep of one segment; cells and starts are the caller's.
    pub fn record(&self, pass: u32, segment_index: usize, segment: &Segment) -> SweepRecord {
        let base = segment.blade_from_segment.translation_mm;
        // Axes of the rake face at the segment's own y, where these turn.
        let turned = (self.twist_rad_per_mm != 0.0).then(|| DMat3::from_rotation_z(-self.twist_rad_per_mm * base.y));
        let mut place_mm = self.place_mm.map(|place| turned.map_or(place, |turned| turned * place).to_array());
        let radius_mm = self.radial_mm + base.x;
        place_mm[0][0] -= radius_mm;
        place_mm[0][2] -= base.y;
        SweepRecord {
            pass,
            segment: segment_index as u32,
            cells: u16::MAX,
            start: SweepStart::default(),
            radius_mm,
            twist_rad_per_mm: self.twist_rad_per_mm,
            t_range: self.t_range,
            turn: self.turn.map(|turn| turned.map_or(turn, |turned| turned * turn).transpose().to_cols_array_2d()),
            place_mm,
            off_mm: self.off_mm,
        }
    }

    /// Distance from the tool's axis and place along it, from the blade's origin in the direction of w, of a point
    /// (tile frame) at the moment when the rake face holds it. `None`: at no moment of the sweep and the piece.
    ///
    /// # Errors
    /// The moment is not found: the work turns nearly as fast as the tool.
    pub fn in_rake_face(&self, p_mm: DVec3) -> Result<Option<[f64; 2]>, NotConverged> {
        iterate("the moment at which a rake face holds a point", 0.0, MAX_STEPS, |t| {
            let [u, _] = half_angle(t);
            let point = self.place_mm[0]
                + u * (self.place_mm[1] + u * (self.place_mm[2] + u * self.place_mm[3]))
                + (self.turn[0] * p_mm + u * (self.turn[1] * p_mm + u * (self.turn[2] * p_mm)));
            let point = DMat3::from_rotation_z(-self.twist_rad_per_mm * point.z) * point;
            // tan(delta / 2) of the point, exactly.
            let next = point.y / (point.x + point.x.hypot(point.y));
            let residual = next - t;
            if residual.abs() < LAST_T {
                let inside = (self.sweep_angle_rad + 2.0 * next.atan()).abs() <= self.half_window_rad
                    && (self.t_range[0]..=self.t_range[1]).contains(&next);
                ControlFlow::Break(inside.then_some([point.x.hypot(point.y), point.z]))
            } else if next.abs() > LARGEST_T {
                ControlFlow::Break(None)
            } else {
                ControlFlow::Continue(Step { to: next, residual })
            }
        })
    }
}

/// The same angle between -pi and pi.
fn within_half_a_turn(angle_rad: f64) -> f64 {
    if angle_rad.abs() <= PI { angle_rad } else { angle_rad - TAU * (angle_rad / TAU).round() }
}

/// Inverse of [`half_angle`] at the nodes of a sweep, to rounding: a fixed number of Newton steps. It cannot fail:
/// there are no other arguments than those between the largest t and its negative, and the test goes through them.
fn t_at(u: f64) -> f64 {
    (0..4).fold(u.tan(), |t, _| {
        let [value, rate] = half_angle(t);
        t - (value - u) / rate
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_steps_invert_the_half_angle_at_all_nodes() {
        for i in 1..=1000 {
            let largest_u = half_angle(LARGEST_T * f64::from(i) / 1000.0)[0];
            for node in NODES {
                let u = largest_u * node;
                assert!((half_angle(t_at(u))[0] - u).abs() < 1e-15, "{} for {u}", half_angle(t_at(u))[0]);
            }
        }
    }
}
