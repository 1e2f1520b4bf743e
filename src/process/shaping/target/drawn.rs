//! Where a drawn tooth touches what it generates when the linkage runs on continuously.
//!
//! In: a generation whose cutter has a [`crate::drawn_tooth::DrawnTooth`], the blank, a space. Out: its
//! [`SpaceProfile`].
//!
//! **Contact.** A place p of the edge with the normal n touches its envelope where n has no part of the velocity
//! O' + chi' i (p - O) of the cutter. Its normal then meets the pitch curve where the pitch circle of the cutter rolls
//! on it: the crossing of that normal with the pitch circle gives the parameter nearly, and Newton's method the
//! parameter for any linkage and offset. Of two crossings the one counts that follows from the tip along the edge:
//! behind the edge outside the pitch circle, before it inside. Arcs, lines and corners go this way alike, and an arc
//! about the pitch point, which touches all at once, is no exception: the edge is followed, not the parameter.

use crate::drawn_tooth::EdgePlace;
use crate::drawn_tooth::envelope::{EnvelopePoint, SAME_MM, SpaceProfile};
use crate::process::shaping::target::generation::Generation;
use gearcut_core::error::Refusal;
use gearcut_core::math::newton::{LastStep, newton};
use glam::DVec2;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Newton steps to a contact, and the last of them, rad.
const CONTACT_STEPS: u32 = 30;
const LAST_STEP_RAD: f64 = 1e-13;
const SETTLED_RAD: f64 = 1e-7;
impl Generation {
    /// The envelope of a space (any integer, counted along the arc) by a drawn tooth; `None` for involute teeth.
    ///
    /// # Errors
    /// A tooth that ends within the blank, or that has no flank.
    pub fn space_profile(&self, space: i64) -> Option<Result<Arc<SpaceProfile>, Refusal>> {
        let (tooth, spaces) = (self.cutter.drawn()?, self.drawn.as_ref()?);
        let module_mm = 2.0 * self.cutter.pitch_radius_mm / f64::from(self.cutter.teeth);
        let find =
            || SpaceProfile::new(tooth, &spaces.blank, space, module_mm, |place, part| self.touch(place, space, part));
        Some(spaces.known_or(space, find))
    }

    /// Where a place of the edge touches its envelope in a space.
    fn touch(&self, EdgePlace { point_mm: p, normal: n }: EdgePlace, space: i64, part: usize) -> Option<EnvelopePoint> {
        let r_c = self.cutter.pitch_radius_mm;
        let along = p.dot(n);
        let inside = r_c * r_c - p.length_squared();
        // Normals of a cycloid touch the pitch circle where it begins, but for rounding.
        let root = Some(along * along + inside).filter(|&square| square > -SAME_MM)?.max(0.0).sqrt();
        let way_mm = if inside > 0.0 || along > 0.0 { root - along } else { -along - root };
        let crossing_rad = (p + way_mm * n).to_angle();
        let curve = self.linkage.curve();
        let pitch_mm = TAU * r_c / f64::from(self.cutter.teeth);
        let start = curve.phi_at_arc(space as f64 * pitch_mm - self.gear().tip_sign() * r_c * crossing_rad);
        let in_work = |phi: f64| {
            let m = self.motion(phi);
            let turn = DVec2::from_angle(self.tooth_angle(m.angle, space as f64));
            (turn.rotate(p), turn.rotate(n), m)
        };
        let last = LastStep::absolute(LAST_STEP_RAD);
        let found = newton("the contact of a drawn edge", start, last, CONTACT_STEPS, |phi| {
            let (p, n, m) = in_work(phi);
            let velocity = m.center_rate + m.angle_rate * p.perp();
            let bend = m.center_rate_2 + m.angle_rate_2 * p.perp() - m.angle_rate * m.angle_rate * p;
            let rate = m.angle_rate * n.perp().dot(velocity) + n.dot(bend);
            [-n.dot(velocity), -n.dot(velocity) / rate]
        });
        // Where it only just touches, steps end at the square root of rounding.
        let phi_rad = found.or_else(|error| error.settled(SETTLED_RAD)).ok()?;
        let near_rad = pitch_mm / curve.frame(start).arc_rate_mm_per_rad;
        let (p, n, m) = in_work(phi_rad);
        ((phi_rad - start).abs() < near_rad).then(|| EnvelopePoint {
            phi_rad,
            point_mm: m.center + p,
            normal: -n,
            part,
        })
    }
}
