//! The return strokes of one operation over a turn: where they are clear, where not, and which direction clears.
//!
//! In: an operation's generation, those before it, the blank. Out: the room round the returning cutter at
//! [`PHASES_PER_PITCH`] places to a pitch ([`Survey::rooms`]), and the directions that clear ([`Survey::tilts`]). Work
//! and cutter are ideal here: no runout, no eccentricity, the final offset; what the strokes of a scene really meet,
//! the blank field says.
//!
//! Directions. An edge that has just made surface with the normal n (out of the tool) leaves it when the cutter moves
//! along u with u . n <= 0. Measured from the normal of the pitch curve into the work, let the normals of all surface
//! that still stands lie between the angles low and high; every direction out of the work tilted by
//!
//! ```text
//! high - 90 deg <= tilt <= low + 90 deg
//! ```
//!
//! then clears, for a small back-off. The middle between the largest lower and the smallest upper bound of a turn is
//! one angle for the whole operation, as a machine sets it.

use super::clearance::{Clearance, ReturnRoom};
use super::swept::POSES_PER_PITCH;
use crate::process::shaping::generation::Generation;
use crate::process::shaping::linkage::CutterPose;
use crate::process::shaping::linkage::retraction::{RetractingCutter, RetractionLaw};
use gearcut_core::error::NotConverged;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::GearKind;
use gearcut_core::gear::blank::Blank;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Places to a pitch at which return strokes are looked at: the room round the cutter repeats from tooth to tooth.
pub const PHASES_PER_PITCH: usize = 6;

/// Return strokes of an operation.
#[derive(Debug)]
pub struct Survey<'a> {
    room: ReturnRoom,
    generation: &'a Generation,
    blank: &'a Blank,
}

/// Room at one place of the turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedRoom {
    /// Place of the survey.
    place: usize,
    /// Gear from cutter on the way back.
    returning: Rigid2,
    /// Polar angle of the pitch point at the stroke, rad.
    pub phi_rad: f64,
    /// Angle from the normal of the pitch curve to the line of centres, rad, positive where the radius grows with phi.
    pub from_normal_rad: f64,
    /// Room round the cutter.
    pub clearance: Clearance,
}

impl<'a> Survey<'a> {
    /// Of the last of some operations, in the order in which they are cut; `teeth` of the gear.
    ///
    /// # Panics
    /// No operation.
    pub fn new(operations: &[&'a Generation], blank: &'a Blank, teeth: u32, module_mm: f64) -> Self {
        let (generation, earlier) = operations.split_last().expect("an operation whose return strokes are looked at");
        let pose_of = |of: &'a Generation| move |phi: f64| of.linkage.pose(phi, of.offset_mm);
        let earlier: Vec<_> = earlier.iter().map(|of| pose_of(of)).collect();
        let earlier: Vec<&dyn Fn(f64) -> CutterPose> =
            earlier.iter().map(|pose| pose as &dyn Fn(f64) -> CutterPose).collect();
        let room = ReturnRoom::new(&generation.cutter, teeth, module_mm, &pose_of(generation), &earlier);
        Self { room, generation, blank }
    }

    /// Room round the cutter over a turn, drawn back by `back_off_mm` by the law that `law(phi)` gives.
    ///
    /// # Errors
    /// A pose that the law does not lead to.
    pub fn rooms(
        &self,
        back_off_mm: f64,
        law: impl Fn(f64) -> RetractionLaw + Sync,
    ) -> Result<Vec<PlacedRoom>, NotConverged> {
        self.places()
            .map(|place| {
                let phi_rad = self.room.swept.phi_rad(place);
                let Generation { linkage, offset_mm, .. } = self.generation;
                let pose = linkage.pose(phi_rad, *offset_mm);
                let back = RetractingCutter::of(linkage).retracted(law(phi_rad), &pose, phi_rad, back_off_mm)?.pose;
                let returning = Rigid2::new(back.angle_rad, back.center_mm);
                let clearance = self.room.at(place, &returning, |p| self.beyond_mm(p, phi_rad));
                let from_normal_rad = self.out_of_work(phi_rad).angle_to(self.sign() * pose.center_mm);
                Ok(PlacedRoom { place, returning, phi_rad, from_normal_rad, clearance })
            })
            .collect()
    }

    /// Area that the returning cutter has in common with what the operation leaves, mm2.
    pub fn overlap_mm2(&self, at: &PlacedRoom) -> f64 {
        self.room.overlap_mm2(at.place, &at.returning, |p| self.beyond_mm(p, at.phi_rad))
    }

    /// Smallest and largest tilt out of the normal that clears everywhere, rad; the first is the larger one where none
    /// does. `None` where no stroke touches the blank.
    pub fn tilts(&self) -> Option<[f64; 2]> {
        let bounds = self.places().filter_map(|place| {
            let phi_rad = self.room.swept.phi_rad(place);
            let into_work = -self.out_of_work(phi_rad);
            let normals = self.room.contact_normals_rad(place, into_work, |p| self.beyond_mm(p, phi_rad));
            normals.map(|[low, high]| [high - FRAC_PI_2, low + FRAC_PI_2])
        });
        bounds.reduce_with(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }

    fn places(&self) -> impl IndexedParallelIterator<Item = usize> {
        let step = POSES_PER_PITCH / PHASES_PER_PITCH;
        (0..self.room.swept.places() / step).into_par_iter().map(move |index| index * step)
    }

    fn sign(&self) -> f64 {
        self.blank.kind().tip_sign()
    }

    /// Direction of the pitch curve's normal away from the work's material.
    fn out_of_work(&self, phi_rad: f64) -> DVec2 {
        self.blank.towards_tip(&self.blank.curve().frame(phi_rad))
    }

    /// How far a point lies outside the uncut blank on its toothed side, mm; negative inside.
    fn beyond_mm(&self, p: DVec2, phi_rad: f64) -> f64 {
        let (facts, radius_mm) = (self.blank.curve().facts(), p.length());
        let beyond_mm = match self.blank.kind() {
            GearKind::External => radius_mm - facts.largest_radius_mm - self.blank.addendum_mm,
            GearKind::Internal => facts.smallest_radius_mm - self.blank.addendum_mm - radius_mm,
        };
        if beyond_mm > 0.0 {
            return beyond_mm;
        }
        let near_rad = phi_rad + DVec2::from_angle(phi_rad).angle_to(p);
        self.blank.height(p, near_rad).0 - self.blank.addendum_mm
    }
}

/// The place with the least room to surfaces that stay, or to all material, by the key.
pub fn tightest(rooms: &[PlacedRoom], of: impl Fn(&PlacedRoom) -> f64) -> Option<&PlacedRoom> {
    rooms.iter().filter(|room| of(room).is_finite()).min_by(|a, b| of(a).total_cmp(&of(b)))
}
