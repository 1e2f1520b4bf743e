//! The part of a sector's turn without teeth: the stock's outline from the last tooth space to the first one.
//!
//! In: the pitch curve of a sector, the radius of the dwell. Out: [`Dwell`]: from the end of the sector inwards along
//! the normal of the pitch curve there, on an arc about the gear's axis to the normal at its beginning, and outwards
//! along that. Half of the first and of the last tooth space so belongs to the stock, and the cutter meets nothing
//! beyond.
//!
//! Road not taken: walls along radii. The middle of a space lies on the normal, and a radius would cut it in two
//! unequal halves wherever r' is not zero.

use crate::error::Refusal;
use crate::gear::PitchCurve;
use crate::parameter;
use crate::units::TURN_RAD;
use glam::DVec2;

/// Places of the outline as near to the dwell lie on it, mm.
const ON_DWELL_MM: f64 = 1e-6;

/// Outline of the stock over the dwell of a sector.
#[derive(Debug, Clone, PartialEq)]
pub struct Dwell {
    /// Radius of the arc about the gear's axis, mm.
    pub radius_mm: f64,
    /// Where the walls at the beginning and at the end of the sector meet the arc, gear frame, mm.
    feet_mm: [DVec2; 2],
    /// Unit normals of these walls, out of the stock.
    normals: [DVec2; 2],
}

impl Dwell {
    /// Of a sector.
    ///
    /// # Errors
    /// A radius that the normals at the ends of the sector do not meet below the pitch curve.
    pub fn new(curve: &PitchCurve, radius_mm: f64) -> Result<Option<Self>, Refusal> {
        let Some(range_rad) = curve.sector_rad() else { return Ok(None) };
        let mut feet_mm = [DVec2::ZERO; 2];
        let mut normals = [DVec2::ZERO; 2];
        for (at, outwards) in [(0, -1.0), (1, 1.0)] {
            let frame = curve.frame(range_rad[at]);
            let (p, n) = (frame.point_mm, frame.normal);
            let beside = radius_mm * radius_mm - p.dot(frame.tangent).powi(2);
            if beside.is_nan() || beside <= 0.0 || radius_mm >= frame.radius_mm {
                return Err(Refusal::new(
                    parameter::DWELL_RADIUS,
                    format!(
                        "an arc of radius {radius_mm:.3} mm does not end on the normal of the pitch curve at polar \
                        angle {:.3} deg, which meets radii between {:.3} and {:.3} mm",
                        range_rad[at].to_degrees(),
                        p.dot(frame.tangent).abs(),
                        frame.radius_mm
                    ),
                    "give a radius between these, below the roots of the teeth",
                ));
            }
            feet_mm[at] = p + n * (beside.sqrt() - p.dot(n));
            normals[at] = frame.tangent * outwards;
        }
        Ok(Some(Self { radius_mm, feet_mm, normals }))
    }

    /// Polar angles of the arc, counter-clockwise from the end of the sector to its beginning, rad.
    pub fn arc_rad(&self) -> [f64; 2] {
        let [first, last] = self.feet_mm.map(DVec2::to_angle);
        [last, last + (first - last).rem_euclid(TURN_RAD)]
    }

    /// Whether a place of the gear's outline lies on the dwell: on its arc, or on one of its walls.
    pub fn has(&self, point_mm: DVec2) -> bool {
        let on_wall = |at: usize| (point_mm - self.feet_mm[at]).dot(self.normals[at]).abs() < ON_DWELL_MM;
        let beyond = |at: usize| (point_mm - self.feet_mm[at]).dot(self.feet_mm[at]) >= 0.0;
        (point_mm.length() - self.radius_mm).abs() < ON_DWELL_MM || (0..2).any(|at| on_wall(at) && beyond(at))
    }

    /// Points and outward normals from a place on the wall at the end of the sector to one on the wall at its
    /// beginning, about `spacing_mm` apart; both places are left out.
    pub fn path_mm(&self, [from_mm, to_mm]: [DVec2; 2], spacing_mm: f64) -> Vec<[DVec2; 2]> {
        let parts = |length_mm: f64| (length_mm / spacing_mm).ceil().max(1.0) as u32;
        let wall = |a: DVec2, b: DVec2, normal: DVec2| {
            let count = parts(a.distance(b));
            (0..=count).map(move |i| [a.lerp(b, f64::from(i) / f64::from(count)), normal])
        };
        let [start, end] = self.arc_rad();
        let count = parts(self.radius_mm * (end - start));
        let arc = (1..count).map(|i| {
            let out = DVec2::from_angle(start + (end - start) * f64::from(i) / f64::from(count));
            [self.radius_mm * out, out]
        });
        let down = wall(from_mm, self.feet_mm[1], self.normals[1]).skip(1);
        let up = wall(self.feet_mm[0], to_mm, self.normals[0]);
        let mut path: Vec<[DVec2; 2]> = down.chain(arc).chain(up).collect();
        path.pop();
        path
    }
}
