//! What a rack leaves when the pitch curve rolls on it: flanks and roots of hobbed gears, in closed form, section by
//! section along the tooth.
//!
//! In: pitch curve, helix, the rack that the hob stands for. Out: points, normals and ends of any flank in any
//! transverse section; where the fillet of the rack's tip corner takes over from the flank.
//!
//! **Law.** In the section at z (gear frame) the rack is the one at z = 0 moved by h z tan(beta) along its pitch line,
//! so that flank e of space i crosses the pitch curve at the arc
//!
//! `s_f = i pi m_t - e w + h z tan(beta)`,  w half the rack's tooth on the pitch line,
//!
//! e = +1 for the flank at the low-arc side of the space (the left flank of tooth i), -1 for the other one. When the
//! curve has rolled on by sigma from there, the flank touches at
//! `q = P(s_f + sigma) + c (e cos(alpha_t) t + sin(alpha_t) n)`, c = -e sigma cos(alpha_t): contact normals pass
//! through the pitch point (Litvin and Fuentes 2004, chapter 5). Along the profile
//! `dl = (sin(alpha_t) + c / rho) dsigma`; where that turns negative the envelope turns back and the tip corner has
//! **undercut** the flank: the profile goes on with the corner's own path ([`super::rack_corner`]).
//!
//! The ideal is a hob with infinitely many gashes and infinitely fine feed.

use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::{halve, regula_falsi};
use gearcut_core::terms::Side;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// The rack in the transverse section, as its tooth fills a gear space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rack {
    /// m_t, mm.
    pub transverse_module_mm: f64,
    /// alpha_t.
    pub pressure_angle_rad: f64,
    /// Half thickness of the tooth on the pitch line, mm.
    pub half_thickness_mm: f64,
    /// Height of the tip under the pitch line, mm.
    pub tip_height_mm: f64,
    /// Radius of the tip round, mm.
    pub tip_radius_mm: f64,
    /// beta, not negative.
    pub helix_angle_rad: f64,
    /// h: +1 for a right-hand gear.
    pub hand: f64,
}

impl Rack {
    /// The same rack pulled back from the gear.
    #[must_use]
    pub fn pulled_back(&self, by_mm: f64) -> Self {
        Self {
            half_thickness_mm: self.half_thickness_mm - by_mm * self.pressure_angle_rad.tan(),
            tip_height_mm: self.tip_height_mm - by_mm,
            ..*self
        }
    }

    /// Height under the pitch line at which the straight flank ends and the tip round begins.
    pub fn flank_end_height_mm(&self) -> f64 {
        self.tip_height_mm - self.tip_radius_mm * (1.0 - self.pressure_angle_rad.sin())
    }
}

/// Generation of all spaces of a gear by a rack.
#[derive(Debug, Clone)]
pub struct RackGeneration {
    /// The pitch curve.
    pub curve: Arc<PitchCurve>,
    /// The rack.
    pub rack: Rack,
}

/// Contact on a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RackContact {
    /// Roll past the crossing with the pitch line, mm of arc.
    pub roll_mm: f64,
    /// Polar angle of the pitch point, rad.
    pub phi_rad: f64,
    /// Point in the gear frame, mm.
    pub point_mm: DVec3,
    /// Unit normal out of the gear.
    pub normal: DVec3,
    /// c: distance from the pitch point in the transverse section, positive towards the tip, mm.
    pub distance_mm: f64,
    /// dl / dsigma = sin(alpha_t) + c / rho: profile length per roll; not positive where the flank is undercut.
    pub length_per_roll: f64,
}

/// What formed a point of the profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProfilePart {
    /// The rack's flank.
    Flank,
    /// The rack's tip corner.
    Fillet,
}

/// Where a profile crosses a curve beside the pitch curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileCrossing {
    /// Point in the transverse section, gear frame, mm.
    pub point_mm: DVec2,
    /// Arc of its foot on the pitch curve, mm.
    pub foot_arc_mm: f64,
    /// What formed it.
    pub part: ProfilePart,
}

impl ProfileCrossing {
    /// Whether a corner's crossing of the same curve has cut this one of a flank away: the tooth of a left flank lies
    /// at the low arc, and what reaches further that way has removed more.
    fn is_cut_by(&self, corner: &Self, side: Side) -> bool {
        sign(side) * (self.foot_arc_mm - corner.foot_arc_mm) > CORNER_TOLERANCE_MM
    }
}

/// e of a gear flank: +1 for left flanks, which lie at the low-arc side of their space.
fn sign(side: Side) -> f64 {
    side.sign()
}

impl RackGeneration {
    /// Whether all sections along the tooth are alike: a spur gear.
    pub fn is_straight(&self) -> bool {
        self.rack.helix_angle_rad == 0.0
    }

    /// Arc s_f at which a flank of `space` crosses the pitch curve in the section `z_mm`.
    pub fn crossing_arc_mm(&self, space: i64, side: Side, z_mm: f64) -> f64 {
        self.space_arc_mm(space, z_mm) - sign(side) * self.rack.half_thickness_mm
    }

    /// Arc of a space's middle in the section `z_mm`.
    pub fn space_arc_mm(&self, space: i64, z_mm: f64) -> f64 {
        let rack = &self.rack;
        space as f64 * PI * rack.transverse_module_mm + rack.hand * rack.helix_angle_rad.tan() * z_mm
    }

    /// Contact of a flank at a roll (any; also where it is undercut).
    pub fn flank_contact(&self, space: i64, side: Side, roll_mm: f64, z_mm: f64) -> RackContact {
        let e = sign(side);
        let (sin, cos) = self.rack.pressure_angle_rad.sin_cos();
        let phi_rad = self.curve.phi_at_arc(self.crossing_arc_mm(space, side, z_mm) + roll_mm);
        let frame = self.curve.frame(phi_rad);
        let distance_mm = -e * roll_mm * cos;
        let across = e * cos * frame.tangent + sin * frame.normal;
        // The flank holds the tooth trace, so the normal leans along the axis: n_z = -e h tan(beta) cos(alpha_t) of its
        // transverse part.
        let lean = -e * self.rack.hand * self.rack.helix_angle_rad.tan() * cos;
        RackContact {
            roll_mm,
            phi_rad,
            point_mm: (frame.point_mm + distance_mm * across).extend(z_mm),
            normal: across.extend(lean).normalize(),
            distance_mm,
            length_per_roll: sin + distance_mm * frame.curvature_per_mm,
        }
    }

    /// Roll at which the rack's flank ends at its tip corner (the flank itself may be undercut before).
    pub fn tip_corner_roll_mm(&self, side: Side) -> f64 {
        let (sin, cos) = self.rack.pressure_angle_rad.sin_cos();
        sign(side) * self.rack.flank_end_height_mm() / (sin * cos)
    }

    /// A roll towards the tip that is beyond a height of the flank, as `is_beyond` says: usual teeth end within four
    /// modules of the pitch line, those of large profile shifts within eight.
    pub fn roll_beyond_mm(&self, side: Side, is_beyond: impl Fn(f64) -> bool) -> f64 {
        let [near, far] = [4.0, 8.0].map(|modules| -sign(side) * modules * self.rack.transverse_module_mm);
        if is_beyond(near) { near } else { far }
    }

    /// Where the profile of a flank crosses the curve `height_mm` over the pitch curve (along its normals, negative
    /// inwards): on the flank, or on the fillet where the corner has cut deeper into the tooth. `None` where neither
    /// reaches that height.
    #[cfg(feature = "testing")]
    pub fn crossing(
        &self,
        blank: &Blank,
        space: i64,
        side: Side,
        height_mm: f64,
        z_mm: f64,
    ) -> Option<ProfileCrossing> {
        let sound_roll_mm = self.sound_roll_mm(space, side, z_mm);
        self.crossing_from(sound_roll_mm, blank, space, side, height_mm, z_mm)
    }

    /// The same where it is known how far the flank is sound ([`Self::sound_roll_mm`]).
    pub fn crossing_from(
        &self,
        sound_roll_mm: f64,
        blank: &Blank,
        space: i64,
        side: Side,
        height_mm: f64,
        z_mm: f64,
    ) -> Option<ProfileCrossing> {
        let over = |roll: f64| self.flank_foot(blank, space, side, roll, z_mm).0 - height_mm;
        // Rolls towards the root have the sign of e; the flank ends at the corner or where it turns back.
        let tip_roll = self.roll_beyond_mm(side, |roll| over(roll) >= 0.0);
        let flank = regula_falsi(over, sound_roll_mm, tip_roll, ZERO_MM)
            .map(|roll| self.flank_foot(blank, space, side, roll, z_mm).1);
        let corner = self.corner_at_height(blank, space, side, height_mm, z_mm).map(|(_, corner)| corner);
        match (flank, corner) {
            (Some(flank), Some(corner)) if flank.is_cut_by(&corner, side) => Some(corner),
            (flank, corner) => flank.or(corner),
        }
    }

    /// Height of a flank over the pitch curve at a roll, mm, and the crossing there.
    fn flank_foot(&self, blank: &Blank, space: i64, side: Side, roll_mm: f64, z_mm: f64) -> (f64, ProfileCrossing) {
        let contact = self.flank_contact(space, side, roll_mm, z_mm);
        let point_mm = contact.point_mm.truncate();
        let (height_mm, foot) = blank.height(point_mm, contact.phi_rad);
        (height_mm, ProfileCrossing { point_mm, foot_arc_mm: self.curve.arc_mm(foot), part: ProfilePart::Flank })
    }

    /// Last roll towards the root at which the flank is sound: the corner's, or just before the envelope turns back.
    pub fn sound_roll_mm(&self, space: i64, side: Side, z_mm: f64) -> f64 {
        let corner = self.tip_corner_roll_mm(side);
        let sound = |roll: f64| self.flank_contact(space, side, roll, z_mm).length_per_roll > 0.0;
        let steps = 64;
        let first_bad = (1..=steps).map(|i| corner * f64::from(i) / f64::from(steps)).find(|&roll| !sound(roll));
        let Some(bad) = first_bad else { return corner };
        halve(sound, bad - corner / f64::from(steps), bad, 60)[0]
    }

    /// Where the flank begins: at the tip corner's end or, undercut, where the fillet meets it.
    pub fn form_point(&self, blank: &Blank, space: i64, side: Side, z_mm: f64) -> FormPoint {
        let e = sign(side);
        let at = |roll_mm: f64| self.flank_foot(blank, space, side, roll_mm, z_mm);
        // The corner's lean where its path has cut the flank away.
        let cut_at = |roll_mm: f64| {
            let (height_mm, flank) = at(roll_mm);
            let (lean, corner) = self.corner_at_height(blank, space, side, height_mm, z_mm)?;
            flank.is_cut_by(&corner, side).then_some(lean)
        };
        let deepest = self.sound_roll_mm(space, side, z_mm);
        // Just before that, towards the tip.
        let start = deepest - e * START_MODULES * self.rack.transverse_module_mm;
        let cut = cut_at(start);
        let mut corner_lean = cut.unwrap_or(self.rack.flank_lean());
        if cut.is_none() && deepest == self.tip_corner_roll_mm(side) {
            return FormPoint { roll_mm: deepest, height_mm: at(deepest).0, corner_lean, undercut: false };
        }
        // Sound just over the pitch line, or over the flank's end above it, unless the corner has taken everything.
        let sound = -e * ((-e * deepest).max(0.0) + 0.5 * self.rack.transverse_module_mm);
        let is_sound = |roll_mm: f64| {
            let cut = cut_at(roll_mm);
            corner_lean = cut.unwrap_or(corner_lean);
            cut.is_none()
        };
        let [roll_mm, _] = halve(is_sound, sound, start, 50);
        FormPoint { roll_mm, height_mm: at(roll_mm).0, corner_lean, undercut: true }
    }
}

/// How far before its end a flank is looked at, in modules of roll.
const START_MODULES: f64 = 1e-9;
/// A height nearer to 0 than this is 0, mm.
pub(super) const ZERO_MM: f64 = 1e-13;
/// Corner and flank meet tangentially where nothing is undercut; closer than this they are one.
const CORNER_TOLERANCE_MM: f64 = 1e-9;

/// Where a flank begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FormPoint {
    /// Roll past the pitch line, mm.
    pub roll_mm: f64,
    /// Height over the pitch curve, mm; negative below it.
    pub height_mm: f64,
    /// Lean ([`RackGeneration::corner_contact`]) at which the path of the tip corner ends at the flank.
    pub corner_lean: f64,
    /// Whether the tip corner has undercut the flank.
    pub undercut: bool,
}
