//! The gear that a drawn basic rack generates when the pitch curve rolls on it.
//!
//! In: the contour of the hob's tooth in the normal section, pitch curve, helix, how far the hob stays back. Out:
//! flanks and roots in any transverse section.
//!
//! **Law.** In the transverse section the rack is the contour with its width stretched by 1 / cos(beta). A place (X,
//! Y), X along the pitch line from the space's middle and Y out of the gear, touches when its normal meets the pitch
//! line, at X - Y n_X / n_Y: there the pitch point lies when the curve has rolled on so far
//! ([`super::rack_generation`]). The envelope says what is left of the touches ([`crate::drawn_tooth::envelope`]).
//!
//! **Sections.** Those of a helical gear are one section, turned with the helix; so its pitch curve is a circle.

use super::hob::LEAST_SLOPE;
use super::rack_generation::{ProfileCrossing, ProfilePart, RackGeneration};
use super::rack_root::RackRootPoint;
use crate::drawn_tooth::envelope::{DrawnSpaces, EnvelopePoint, SpaceProfile};
use crate::drawn_tooth::flank::DrawnFlank;
use crate::drawn_tooth::{DrawnTooth, EdgePlace};
use crate::job::ToothSection;
use crate::measure::round_gear::is_round;
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::bisect;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use rayon::prelude::*;
use std::sync::Arc;

/// Generation of all spaces of a gear by a drawn rack.
#[derive(Debug)]
pub struct DrawnRack {
    tooth: Arc<DrawnTooth>,
    generation: RackGeneration,
    /// How far the hob stays back, mm.
    back_mm: f64,
    spaces: DrawnSpaces,
}

impl DrawnRack {
    /// All spaces of a gear from this blank.
    ///
    /// # Errors
    /// A contour that ends within the blank, that generates no flank, or a helical gear that is not round.
    pub fn new(
        tooth: Arc<DrawnTooth>,
        generation: RackGeneration,
        back_mm: f64,
        blank: &Blank,
        teeth: u32,
    ) -> Result<Self, Refusal> {
        if !generation.is_straight() && !is_round(&generation.curve) {
            return Err(Refusal::new(
                "gear.helix_angle_deg",
                "a drawn hob tooth cuts helical gears with a round pitch curve, and spur gears with any",
                "remove the helix angle, or [tool.hob.profile]",
            ));
        }
        let ends = [(tooth.parts.first(), 0.0), (tooth.parts.last(), 1.0)];
        let end_mm = ends.into_iter().filter_map(|(part, share)| Some(part?.law.at(share).point_mm.x));
        let below_mm = blank.addendum_mm - back_mm + end_mm.fold(f64::NEG_INFINITY, f64::max);
        if below_mm > 0.0 {
            return Err(Refusal::new(
                &tooth.place.file_key(),
                format!("the contour ends {below_mm:.4} mm below the tips of the gear, which it does not shape"),
                "lead it further towards the hob's axis, or take a smaller gear.addendum_coefficient",
            ));
        }
        let all = Self { tooth, generation, back_mm, spaces: DrawnSpaces::new(blank.clone()) };
        let check =
            |space: i64| [Side::Left, Side::Right].into_iter().try_for_each(|side| all.flank(space, side).map(|_| ()));
        (0..=i64::from(teeth)).into_par_iter().try_for_each(check)?;
        Ok(all)
    }

    /// Whether another one leaves the same gear.
    pub fn generates_as(&self, other: &Self) -> bool {
        self.tooth == other.tooth && self.back_mm == other.back_mm
    }

    /// Envelope of a space in the middle of the face.
    fn profile(&self, space: i64) -> Result<Arc<SpaceProfile>, Refusal> {
        let module_mm = self.generation.rack.transverse_module_mm;
        let touch = |place: EdgePlace, part: usize| self.touch(place, part, space);
        self.spaces.known_or(space, || SpaceProfile::new(&self.tooth, &self.spaces.blank, space, module_mm, touch))
    }

    /// The same of a space that was looked at before.
    fn known(&self, space: i64) -> Arc<SpaceProfile> {
        self.profile(space).expect("all spaces were found when the scene was made ready")
    }

    fn touch(&self, place: EdgePlace, part: usize, space: i64) -> Option<EnvelopePoint> {
        let n = place.normal;
        if n.x.abs() < LEAST_SLOPE {
            return None;
        }
        let RackGeneration { curve, rack } = &self.generation;
        let cos = rack.helix_angle_rad.cos();
        // The contour's tip looks into the gear, its left side to smaller arcs.
        let at = DVec2::new(-place.point_mm.y / cos, self.back_mm - place.point_mm.x);
        let normal = DVec2::new(-n.y * cos, -n.x).normalize();
        let rolled_mm = at.x - at.y * normal.x / normal.y;
        let phi_rad = curve.phi_at_arc(self.generation.space_arc_mm(space, 0.0) + rolled_mm);
        let frame = curve.frame(phi_rad);
        Some(EnvelopePoint {
            phi_rad,
            point_mm: frame.point_mm + (at.x - rolled_mm) * frame.tangent + at.y * frame.normal,
            normal: -(normal.x * frame.tangent + normal.y * frame.normal),
            part,
        })
    }

    /// Flank of a space up to the blank's outline, in the middle of the face.
    ///
    /// # Errors
    /// The contour does not shape it.
    pub fn flank(&self, space: i64, side: Side) -> Result<DrawnFlank, Refusal> {
        let blank = &self.spaces.blank;
        let points = self.profile(space)?.flank(side == Side::Left);
        DrawnFlank::through(points).up_to(blank, blank.addendum_mm).ok_or_else(|| {
            let problem = format!("the {} flank in space {space} does not reach the blank's outline", side.name());
            Refusal::new(&self.tooth.place.file_key(), problem, "have the tooth drawn thinner or deeper")
        })
    }

    /// Whether something is cut away of a flank.
    pub fn is_undercut(&self, space: i64, side: Side) -> bool {
        self.known(space).undercut_mm(side == Side::Left, &self.tooth).is_some()
    }

    /// The blank's outline.
    pub fn blank(&self) -> &Blank {
        &self.spaces.blank
    }

    /// Pitch point of a contact.
    pub fn pitch_point_mm(&self, phi_rad: f64) -> DVec2 {
        self.generation.curve.frame(phi_rad).point_mm
    }

    /// Turn of the section along the tooth, rad/mm.
    pub fn turn_rad_per_mm(&self) -> f64 {
        let rack = &self.generation.rack;
        let radius_mm = self.generation.curve.facts().largest_radius_mm;
        rack.hand * rack.helix_angle_rad.tan() / radius_mm
    }

    /// How far from the pitch point, along the pitch line, what is left touches the rack at most, mm.
    pub fn contact_reach_mm(&self, teeth: u32) -> f64 {
        let reach_mm = |at: &EnvelopePoint| {
            let frame = self.generation.curve.frame(at.phi_rad);
            (at.point_mm - frame.point_mm).dot(frame.tangent).abs()
        };
        let of = |space: i64| self.known(space).points().iter().map(reach_mm).fold(0.0, f64::max);
        (0..i64::from(teeth)).map(of).fold(0.0, f64::max)
    }

    /// Root of a space in the section `z_mm` from its left flank to its right one, points evenly along it.
    pub fn root(&self, space: i64, z_mm: f64, count: usize) -> Vec<RackRootPoint> {
        let turn = DVec2::from_angle(self.turn_rad_per_mm() * z_mm);
        let mut points = self.known(space).root().to_vec();
        points.reverse();
        let root = DrawnFlank::through(points);
        let arc_mm = |i: usize| root.length_mm() * i as f64 / (count - 1) as f64;
        let at = |arc_mm: f64| {
            let at = root.at_arc(arc_mm);
            RackRootPoint { arc_mm, point_mm: turn.rotate(at.point_mm), normal: turn.rotate(at.normal) }
        };
        (0..count).map(|i| at(arc_mm(i))).collect()
    }

    /// Where the profile of one side of a space crosses the curve `height_mm` over the pitch curve, in the middle of
    /// the face.
    pub fn crossing(&self, space: i64, side: Side, height_mm: f64) -> Option<ProfileCrossing> {
        let blank = self.blank();
        let profile = self.known(space);
        let over_mm = |at: &EnvelopePoint| blank.height(at.point_mm, at.phi_rad).0 - height_mm;
        let on = |points: Vec<EnvelopePoint>, part: ProfilePart| {
            let above = points.iter().position(|at| over_mm(at) >= 0.0).filter(|&index| index > 0)?;
            let course = DrawnFlank::through(points[above - 1..=above].to_vec());
            let arc_mm = bisect(|arc_mm| over_mm(&course.at_arc(arc_mm)) < 0.0, 0.0, course.length_mm());
            let at = course.at_arc(arc_mm);
            let foot_rad = blank.height(at.point_mm, at.phi_rad).1;
            Some(ProfileCrossing { point_mm: at.point_mm, foot_arc_mm: self.generation.curve.arc_mm(foot_rad), part })
        };
        let mut root = profile.root().to_vec();
        if side == Side::Right {
            root.reverse();
        }
        // From the deepest place up to this side's flank.
        let deepest = (0..root.len()).min_by(|&a, &b| over_mm(&root[a]).total_cmp(&over_mm(&root[b])))?;
        on(profile.flank(side == Side::Left), ProfilePart::Flank)
            .or_else(|| on(root.split_off(deepest), ProfilePart::Fillet))
    }

    /// Right flank, tip land, left flank and the root behind a tooth, counter-clockwise, in the section `z_mm`.
    pub fn tooth_section(&self, tooth: i64, z_mm: f64, spacing_mm: f64) -> ToothSection {
        let turn = DVec2::from_angle(self.turn_rad_per_mm() * z_mm);
        let blank = self.blank();
        let steps = |length_mm: f64| (length_mm.abs() / spacing_mm).ceil().max(1.0) as usize;
        let flank = |space: i64, side: Side| -> Vec<DVec2> {
            let flank = self.flank(space, side).expect("all flanks were found when the scene was made ready");
            let count = steps(flank.length_mm());
            (0..=count).map(|i| flank.at_arc(flank.length_mm() * i as f64 / count as f64).point_mm).collect()
        };
        let mut points = flank(tooth - 1, Side::Right);
        let left = flank(tooth, Side::Left);
        let foot = |p: DVec2| blank.height(p, p.to_angle()).1;
        let ends = [points[points.len() - 1], left[left.len() - 1]];
        let from = foot(ends[0]);
        let to = from + (foot(ends[1]) - from).rem_euclid(TURN_RAD);
        let count = steps(ends[0].distance(ends[1]));
        points.extend((1..count).map(|i| blank.outline_mm(from + (to - from) * i as f64 / count as f64)));
        points.extend(left.into_iter().rev());
        // Corners stay in it.
        let profile = self.known(tooth);
        let mut root_mm: Vec<DVec2> = Vec::new();
        let all = profile.root();
        for (i, at) in all.iter().enumerate().rev() {
            let is_end = i == 0 || i + 1 == all.len() || all[i - 1].part != at.part || all[i + 1].part != at.part;
            if is_end || root_mm.last().is_none_or(|last| last.distance(at.point_mm) >= spacing_mm) {
                root_mm.push(at.point_mm);
            }
        }
        let turned = |points: Vec<DVec2>| points.into_iter().map(|at| turn.rotate(at)).collect();
        ToothSection { tooth_mm: turned(points), root_mm: turned(root_mm) }
    }
}
