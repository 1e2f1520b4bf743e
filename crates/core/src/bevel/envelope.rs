//! The envelope of a cutting surface over the roll: where the head leaves the flank in the limit of many blades.
//!
//! In: settings of the machine and a cutting surface. Out: points and normals of the flank.
//!
//! **Law.** A point of the surface is on the envelope in the moment when its normal is square to its velocity in the
//! work. Along a straight edge the normal n is the same, and the velocity v + w x r is linear in the place u on the
//! edge: u = -n . (v + w x r0) / (n . (w x d)), r0 the point in the plane of the tips, d the edge's direction. What is
//! left are two unknowns, the angle theta about the head's axis and the cradle angle q, for the two coordinates that a
//! point of the flank is asked for by; Newton's method finds them to rounding. The fillet, made by the round of the
//! corner, is nobody's target: rays through the blank show it.
//!
//! **No roll.** The flank of a head that plunges is its cone at full depth: every shallower cone lies within it. The
//! unknowns are then theta and the place u on the edge, counted in radii of the cone, so that both are of one size.
//!
//! Source: Litvin and Fuentes, Gear Geometry and Applied Theory (2004), chapters 6 and 22.

use super::blank::BevelBlank;
use super::cradle::CradleSettings;
use super::face_mill::CuttingSurface;
use crate::error::NotConverged;
use crate::frame::RigidMotion3;
use glam::{DVec2, DVec3};

/// A step of both coordinates as small as this is the last, rad: the error after it is of its square times the
/// difference quotients' share.
const LAST_STEP_RAD: f64 = 1e-11;
/// Step of the difference quotients, rad; the steps that they give are off by a share of about as much.
const DIFFERENCE_RAD: f64 = 1e-6;
/// Largest step, rad: beyond it the linear picture does not hold.
const LARGEST_STEP_RAD: f64 = 0.1;
/// Steps at most; from the guess of [`Envelope::guess`] it takes four to eight.
const MOST_STEPS: u32 = 60;

/// A cutting surface and the machine that leads it through a slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// The machine.
    pub settings: CradleSettings,
    /// What cuts.
    pub surface: CuttingSurface,
}

/// A point of the flank, work frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPoint {
    /// The point, mm.
    pub point_mm: DVec3,
    /// Unit normal out of the gear's material.
    pub normal: DVec3,
    /// Angle about the head's axis, tool frame, rad.
    pub head_rad: f64,
    /// Cradle angle at which it is cut, rad.
    pub cradle_rad: f64,
    /// Place on the cutting edge from the plane of the tips, mm.
    pub edge_mm: f64,
    /// Its coordinates in [`Envelope::at`].
    pub coordinates: [f64; 2],
}

/// How far beside its moment a cone is compared with a point of its envelope, rad: it is over it by hundredths of a
/// micrometre there.
const BESIDE_RAD: f64 = 1e-3;
/// Places on the edge are known to this, mm.
const EDGE_MM: f64 = 1e-7;

/// What fixes a point on a flank beside its cone distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OnFlank {
    /// Height over the pitch cone, mm.
    Height(f64),
    /// Place on the cutting edge, mm.
    Edge(f64),
}

impl Envelope {
    /// Point of the flank that belongs to an angle about the head's axis, rad, and to the cradle angle at which it is
    /// generated, rad; without roll to the place on the edge in radii of the cone at the tips.
    pub fn at(&self, head_rad: f64, second: f64) -> FlankPoint {
        self.at_moment(&self.motion(second), head_rad, second)
    }

    /// How the head moves when the second coordinate is this.
    fn motion(&self, second: f64) -> RigidMotion3 {
        self.settings.motion(if self.settings.plunges() { 0.0 } else { second })
    }

    /// As [`Self::at`], with the motion that belongs to the second coordinate.
    fn at_moment(&self, motion: &RigidMotion3, head_rad: f64, second: f64) -> FlankPoint {
        let (normal, start_mm) = (self.surface.normal(head_rad), self.surface.point_mm(head_rad, 0.0));
        let along = self.surface.edge_direction(head_rad);
        let pose = motion.pose;
        let (cradle_rad, edge_mm) = if self.settings.plunges() {
            (self.settings.cradle_angle_rad, second * self.surface.point_radius_mm)
        } else {
            let from_work = pose.rotation.transpose();
            let v = from_work * motion.velocity_mm_per_s;
            let w = from_work * motion.angular_velocity_rad_per_s;
            (second, -normal.dot(v + w.cross(start_mm)) / normal.dot(w.cross(along)))
        };
        FlankPoint {
            point_mm: pose.point(start_mm + edge_mm * along),
            normal: pose.direction(normal),
            head_rad,
            cradle_rad,
            edge_mm,
            coordinates: [head_rad, second],
        }
    }

    /// How far a point of the work stands beyond the cone at a cradle angle, mm: what the blades leave over it where
    /// they pass at that moment alone. A point of the envelope has 0 at its own moment and more before and after.
    pub fn beyond_mm(&self, point_mm: DVec3, cradle_rad: f64) -> f64 {
        let in_tool = self.settings.work_from_tool(cradle_rad).inverse().point(point_mm);
        let head_rad = in_tool.y.atan2(in_tool.x);
        (self.surface.point_mm(head_rad, 0.0) - in_tool).dot(self.surface.normal(head_rad))
    }

    /// Whether a point of the envelope lies on the flank: the cone passes over it just before and just after its own
    /// moment. Beyond an edge of regression, as on undercut teeth, the cone goes below it, and the envelope is no flank
    /// there; neither is it below the place where the corner's round begins.
    pub fn has_flank_at(&self, point: &FlankPoint) -> bool {
        if point.edge_mm < self.surface.corner_end_mm() - EDGE_MM {
            return false;
        }
        let beside_mm = |by_rad: f64| self.beyond_mm(point.point_mm, point.cradle_rad + by_rad);
        self.settings.plunges() || beside_mm(BESIDE_RAD) + beside_mm(-BESIDE_RAD) > 0.0
    }

    /// Coordinates of a point near the flank at a cone distance: where the circle of the points, seen along the
    /// cradle's axis, crosses the circle of the cone distance, at the moment when that crossing lies on the line along
    /// which the head touches the root cone; without roll on the circle itself.
    pub fn guess(&self, cone_distance_mm: f64) -> [f64; 2] {
        let (s, r) = (self.settings.radial_setting_mm, self.surface.point_radius_mm);
        let cosine = (cone_distance_mm.powi(2) - s * s - r * r) / (2.0 * s * r);
        let head_rad = -self.settings.cradle_angle_rad.signum() * cosine.clamp(-1.0, 1.0).acos();
        let at = DVec2::new(s, 0.0) + r * DVec2::from_angle(head_rad);
        [head_rad, if self.settings.plunges() { 0.0 } else { -at.to_angle() }]
    }

    /// Point of the flank at a cone distance and at a height over the pitch cone, or where a place of the edge has cut
    /// it; `start` are coordinates near it.
    ///
    /// # Errors
    /// There is no such point near the start.
    pub fn find(
        &self,
        blank: &BevelBlank,
        cone_distance_mm: f64,
        place: OnFlank,
        start: [f64; 2],
    ) -> Result<FlankPoint, NotConverged> {
        let missing = |motion: &RigidMotion3, coordinates: DVec2| {
            let point = self.at_moment(motion, coordinates.x, coordinates.y);
            let [distance_mm, height_mm] = blank.cone_distance_and_height_mm(point.point_mm);
            let second = match place {
                OnFlank::Height(wanted_mm) => wanted_mm - height_mm,
                OnFlank::Edge(wanted_mm) => wanted_mm - point.edge_mm,
            };
            DVec2::new(cone_distance_mm - distance_mm, second)
        };
        let mut coordinates = DVec2::from(start);
        let mut lost = NotConverged {
            what: "a point of the flank",
            after: MOST_STEPS,
            last: cone_distance_mm,
            last_step: f64::INFINITY,
            residual: f64::INFINITY,
        };
        for _ in 0..MOST_STEPS {
            // One motion serves both angles about the head's axis.
            let here = self.motion(coordinates.y);
            let later = coordinates + DIFFERENCE_RAD * DVec2::Y;
            let left = missing(&here, coordinates);
            let by_head = (missing(&here, coordinates + DIFFERENCE_RAD * DVec2::X) - left) / DIFFERENCE_RAD;
            let by_second = (missing(&self.motion(later.y), later) - left) / DIFFERENCE_RAD;
            let determinant = by_head.perp_dot(by_second);
            let step = DVec2::new(-left.perp_dot(by_second), -by_head.perp_dot(left)) / determinant;
            (lost.residual, lost.last_step) = (left.length(), step.length());
            if !step.is_finite() {
                return Err(lost);
            }
            coordinates += step.clamp_length_max(LARGEST_STEP_RAD);
            if step.length() <= LAST_STEP_RAD {
                return Ok(self.at(coordinates.x, coordinates.y));
            }
        }
        Err(lost)
    }
}
