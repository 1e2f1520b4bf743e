//! One blade's sweep as seen from a tile of dexels, and where it meets a ray.
//!
//! **The law.** A point p of the work is in the rake face at one moment of the sweep; it is removed if it lies inside the blade's edge then. With the moment as t = tan(delta / 2), delta the angle
//! of the rake face from where it holds the tile's origin, and the point in axes fixed to the head there (r out of the axis, q in the direction of rotation, y along the blade's y), the moment is the
//! root of
//!
//! `q (1 - t^2) = 2 t R`,  R the distance along r from the axis,
//!
//! and the point's distance from the axis is then exactly `R + q t`: no square root, no transcendental function, and nothing large is subtracted from anything
//! large once r counts from a point of the edge. A helically gashed tool has rake faces that turn with y; the point is turned back by that angle first.
//!
//! The work moves meanwhile. Its pose in those axes is a polynomial in u = t - t^3 / 3 + t^5 / 5, which is delta / 2 but for t^7 / 7, over the little that a tile needs: cubic for
//! the tile's origin (140 mm away from the axis it turns about), quadratic for directions. On a ray o + h n this gives two equations, the moment and the edge, in the unknowns h and t; Newton's method solves both at once.
//!
//! Road not taken: eliminating t beforehand by a polynomial in the tile's three coordinates. It needs order four in one of them, and long rays leave its range.

use super::hob_teeth::{BladePass, HobTeeth, SWEEP_RAD};
use super::strokes::{NODES, cubic_through};
use crate::dexel::Ray;
use crate::tool::edge::{Segment, SegmentShape};
use glam::{DMat3, DVec3};

/// Largest |t|: a sweep's whole range from one of its ends.
const LARGEST_T: f64 = 1.0;

/// u and du/dt: nearly half the angle, by a polynomial that every backend computes alike.
#[inline(always)]
#[expect(clippy::inline_always, reason = "called inside vector code")]
pub fn half_angle(t: f64) -> [f64; 2] {
    let z = t * t;
    [t * (1.0 - z * (1.0 / 3.0 - z * 0.2)), 1.0 - z + z * z]
}

/// Newton steps at most.
const MAX_STEPS: usize = 24;

/// A sweep near a tile, for all segments of the blade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// Directions: `(r, q, y) = (turn[0] + u turn[1] + u^2 turn[2]) p_tile + place(u)`.
    turn: [DMat3; 3],
    /// Tile's origin: coefficients of u^0 to u^3; r from the tool's axis.
    place_mm: [DVec3; 4],
    /// Turn of the rake face against t = 0 per mm of y, rad/mm, in the direction of q.
    twist_rad_per_mm: f64,
    /// Angle of the rake face from the head's x axis where it holds the tile's origin, in the direction of rotation.
    pub sweep_angle_rad: f64,
}

/// One sweep of one segment over one tile: what a backend reads.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRecord {
    /// Pass id.
    pub pass: u32,
    /// Index of the segment in the blade's edge.
    pub segment: u32,
    /// Height at which Newton's method starts, mm.
    pub start_mm: f64,
    /// Distance of the segment's origin from the tool's axis, mm; r counts from there, y from the segment's origin.
    pub radius_mm: f64,
    /// Turn of the rake face per mm of y, rad/mm.
    pub twist_rad_per_mm: f64,
    /// Rows r, q, y of the rotation; coefficients of u^0 to u^2.
    pub turn: [[[f64; 3]; 3]; 3],
    /// Tile's origin in (r, q, y): coefficients of u^0 to u^3, mm.
    pub place_mm: [[f64; 3]; 4],
}

/// Where a ray enters a segment's sweep or the continuation of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepHit {
    /// Ray parameter, mm.
    pub height_mm: f64,
    /// Moment.
    pub t: f64,
    /// Place along the segment, mm.
    pub y_mm: f64,
    /// How fast the ray runs into the segment, against the edge's unit normal.
    pub cosine: f64,
}

/// What became of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meeting {
    /// An entry.
    Enters(SweepHit),
    /// The ray runs out of the tool wherever it meets the segment.
    Leaves,
    /// Nothing was found.
    Missed,
}

impl Sweep {
    /// Sweep of a pass as seen from a tile with its origin at `origin_mm` (gear frame) and nothing further than `reach_mm` from it. `None`: the
    /// blade holds the origin at no moment of its sweep.
    pub fn new(set: &HobTeeth, pass: &BladePass, origin_mm: DVec3, reach_mm: f64) -> Option<Self> {
        let place = set.place(pass);
        let twist = set.rake_twist_rad_per_mm;
        let blade_y = |z: f64| place.y_sign * (z - place.axial_mm);
        // The rake face follows the point: a fixed point with the ratio of the speeds, some hundredths.
        let mut swept = 0.0;
        let mut at = DVec3::ZERO;
        for _ in 0..20 {
            at = set.motion.head_from_work(pass.tool_angle_rad + set.turn * swept).point(origin_mm);
            let next = at.y.atan2(at.x) - twist * blade_y(at.z);
            let step = next - swept;
            swept = next;
            if swept.abs() > SWEEP_RAD || step.abs() < 1e-14 {
                break;
            }
        }
        if swept.abs() > SWEEP_RAD {
            return None;
        }
        // Axes at blade y = 0 of the rake face at this moment.
        let (sin, cos) = swept.sin_cos();
        let axes = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), place.y_sign * DVec3::Z);
        let from_head = axes.transpose();
        let radius_mm = at.x.hypot(at.y);
        let range = (0.6 * reach_mm / (radius_mm - reach_mm).max(0.3 * radius_mm)).min(LARGEST_T);
        let (mut turns, mut places) = ([[0.0; 4]; 9], [[0.0; 4]; 3]);
        let largest_u = half_angle(range)[0];
        for (node, &share) in NODES.iter().enumerate() {
            let delta = 2.0 * t_at(largest_u * share).atan();
            let head_from_work = set.motion.head_from_work(pass.tool_angle_rad + set.turn * (swept + delta));
            let turn = (from_head * head_from_work.rotation).to_cols_array();
            let origin = head_from_work.point(origin_mm) - DVec3::new(0.0, 0.0, place.axial_mm);
            let origin = (from_head * origin).to_array();
            turns.iter_mut().zip(turn).for_each(|(entry, value)| entry[node] = value);
            places.iter_mut().zip(origin).for_each(|(entry, value)| entry[node] = value);
        }
        let turns = turns.map(|values| {
            // A cube is 3/4 of its base but for the Chebyshev polynomial T3, the smallest in its worst place: a quadratic is enough.
            let [c0, c1, c2, c3] = cubic_through(&values);
            [c0, (c1 + 0.75 * c3) / largest_u, c2 / largest_u.powi(2)]
        });
        let places = places.map(|values| {
            let [c0, c1, c2, c3] = cubic_through(&values);
            [c0, c1 / largest_u, c2 / largest_u.powi(2), c3 / largest_u.powi(3)]
        });
        Some(Self {
            turn: [0, 1, 2].map(|k| DMat3::from_cols_array(&turns.map(|entry| entry[k]))),
            place_mm: [0, 1, 2, 3].map(|k| DVec3::from_array(places.map(|entry| entry[k]))),
            twist_rad_per_mm: twist,
            sweep_angle_rad: swept,
        })
    }

    /// The sweep of one segment; `start_mm` is the caller's.
    pub fn record(&self, pass: u32, segment_index: usize, segment: &Segment) -> SweepRecord {
        let base = segment.blade_from_segment.translation_mm;
        // Axes of the rake face at the segment's own y.
        let turned = DMat3::from_rotation_z(-self.twist_rad_per_mm * base.y);
        let mut place_mm = self.place_mm.map(|place| (turned * place).to_array());
        place_mm[0][0] -= base.x;
        place_mm[0][2] -= base.y;
        SweepRecord {
            pass,
            segment: segment_index as u32,
            start_mm: 0.0,
            radius_mm: base.x,
            twist_rad_per_mm: self.twist_rad_per_mm,
            turn: self.turn.map(|turn| (turned * turn).transpose().to_cols_array_2d()),
            place_mm,
        }
    }

    /// Distance from the tool's axis and place along the blade's y of a point (tile frame) at the moment when the rake face holds it. `None`: at no moment of
    /// the sweep.
    pub fn in_rake_face(&self, p_mm: DVec3) -> Option<[f64; 2]> {
        let mut t = 0.0_f64;
        for _ in 0..MAX_STEPS {
            let [u, _] = half_angle(t);
            let point = self.place_mm[0]
                + u * (self.place_mm[1] + u * (self.place_mm[2] + u * self.place_mm[3]))
                + (self.turn[0] * p_mm + u * (self.turn[1] * p_mm + u * (self.turn[2] * p_mm)));
            let point = DMat3::from_rotation_z(-self.twist_rad_per_mm * point.z) * point;
            // tan(delta / 2) of the point, exactly.
            let next = point.y / (point.x + point.x.hypot(point.y));
            let step = next - t;
            t = next;
            if step.abs() < 1e-12 {
                let inside = (self.sweep_angle_rad + 2.0 * t.atan()).abs() <= SWEEP_RAD;
                return inside.then_some([point.x.hypot(point.y), point.z]);
            }
            if t.is_nan() || t.abs() > LARGEST_T {
                return None;
            }
        }
        None
    }
}

/// Inverse of [`half_angle`].
fn t_at(u: f64) -> f64 {
    let mut t = u.tan();
    for _ in 0..4 {
        let [value, rate] = half_angle(t);
        t -= (value - u) / rate;
    }
    t
}

/// Residuals of both equations with their derivatives.
struct Residuals {
    /// The moment: value, rate over h, rate over t.
    moment: [f64; 3],
    /// The edge: value, rate over h, rate over t.
    edge: [f64; 3],
    y_mm: f64,
    /// Length of the edge's normal as the residual has it.
    normal: f64,
}

impl SweepRecord {
    fn residuals(&self, segment: &Segment, ray: &LocalRay, h: f64, t: f64) -> Residuals {
        let [u, u_t] = half_angle(t);
        let place = ray.place[0] + u * (ray.place[1] + u * (ray.place[2] + u * ray.place[3]));
        let place_u = ray.place[1] + u * (2.0 * ray.place[2] + u * (3.0 * ray.place[3]));
        let along = ray.along[0] + u * (ray.along[1] + u * ray.along[2]);
        let along_u = ray.along[1] + u * (2.0 * ray.along[2]);
        let mut p = place + h * along;
        let mut p_t = u_t * (place_u + h * along_u);
        let mut p_h = along;
        if self.twist_rad_per_mm != 0.0 {
            let (sin, cos) = (self.twist_rad_per_mm * p.z).sin_cos();
            let big = p.x + self.radius_mm;
            let turned = |v: DVec3, about: f64| {
                DVec3::new(
                    cos * v.x + sin * v.y + about * (cos * p.y - sin * big),
                    cos * v.y - sin * v.x - about * (sin * p.y + cos * big),
                    v.z,
                )
            };
            (p_t, p_h) = (turned(p_t, self.twist_rad_per_mm * p_t.z), turned(p_h, self.twist_rad_per_mm * p_h.z));
            p = DVec3::new(cos * big + sin * p.y - self.radius_mm, cos * p.y - sin * big, p.z);
        }
        let big = p.x + self.radius_mm;
        let half = 1.0 - t * t;
        let moment = [
            p.y * half - 2.0 * t * big,
            p_h.y * half - 2.0 * t * p_h.x,
            p_t.y * half - 2.0 * t * (p.y + p_t.x) - 2.0 * big,
        ];
        let frame = segment.blade_from_segment.rotation;
        let rho = [p.x + p.y * t, p_h.x + p_h.y * t, p_t.x + p_t.y * t + p.y];
        let [x, x_h, x_t] = [0, 1, 2].map(|i| frame.x * rho[i] + frame.y * [p.z, p_h.z, p_t.z][i]);
        let [y, y_h, y_t] = [0, 1, 2].map(|i| frame.x * [p.z, p_h.z, p_t.z][i] - frame.y * rho[i]);
        let [value, g_x, g_y] = match &segment.shape {
            SegmentShape::Table(table) => {
                let [u, slope] = table.x_and_slope(y);
                [x - u, 1.0, -slope]
            }
            SegmentShape::Arc { radius_mm } => {
                let k = 0.5 / radius_mm;
                [x + k * (x * x + y * y), 1.0 + 2.0 * k * x, 2.0 * k * y]
            }
        };
        Residuals {
            moment,
            edge: [value, g_x * x_h + g_y * y_h, g_x * x_t + g_y * y_t],
            y_mm: y,
            normal: g_x.hypot(g_y),
        }
    }

    /// Where a ray (tile frame) enters the segment's sweep or its continuation, nearest to the start.
    pub fn enter(&self, segment: &Segment, ray: &Ray, start_mm: f64) -> Meeting {
        let local = self.local(ray);
        let (mut h, mut t) = (start_mm, 0.0);
        // The moment at the start height first.
        for _ in 0..3 {
            let r = self.residuals(segment, &local, h, t);
            t -= r.moment[0] / r.moment[2];
        }
        for _ in 0..MAX_STEPS {
            if t.is_nan() || t.abs() > LARGEST_T || h.abs() > 1e3 {
                return Meeting::Missed;
            }
            let Residuals { moment, edge, y_mm, normal } = self.residuals(segment, &local, h, t);
            let determinant = moment[1] * edge[2] - moment[2] * edge[1];
            // Rate of the edge's residual along the ray, the moment following.
            let rate = -determinant / moment[2];
            if rate > -1e-6 * normal {
                return if rate > 0.05 * normal { Meeting::Leaves } else { Meeting::Missed };
            }
            let step_h = (moment[0] * edge[2] - moment[2] * edge[0]) / determinant;
            let step_t = (moment[1] * edge[0] - edge[1] * moment[0]) / determinant;
            h -= step_h;
            t -= step_t;
            if step_h.abs() < 1e-11 && step_t.abs() < 1e-12 {
                return Meeting::Enters(SweepHit { height_mm: h, t, y_mm, cosine: -rate / normal });
            }
        }
        Meeting::Missed
    }

    fn local(&self, ray: &Ray) -> LocalRay {
        let turn = self.turn.map(|rows| DMat3::from_cols_array_2d(&rows).transpose());
        let mut place = self.place_mm.map(DVec3::from_array);
        for (place, turn) in place.iter_mut().zip(&turn) {
            *place += *turn * ray.origin_mm;
        }
        LocalRay { place, along: turn.map(|turn| turn * ray.normal) }
    }
}

/// A ray in the record's axes: polynomials in u.
struct LocalRay {
    place: [DVec3; 4],
    along: [DVec3; 3],
}
