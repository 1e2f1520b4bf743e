//! What a cutter's edge leaves when the linkage runs on continuously: contact by the meshing condition, in closed form.
//! Drawn teeth have no such form: [`super::drawn`].
//!
//! In: linkage, cutter, offset. Out: for each polar angle phi, the point where a cutter flank, tip corner or tip circle
//! touches its envelope in the gear frame.
//!
//! With the cutter's centre O(phi) and orientation chi(phi), a point p of the cutter moves by `O' + chi' i (p - O)`,
//! and it touches the envelope where that velocity has no part along the edge's normal n. An involute's normals all
//! pass its base circle at the distance r_b, so `n . i (p - O) = sigma r_b` whatever the roll, and with
//! `n = i sigma exp(i eta)` the condition becomes
//!
//! `sin(arg O' - eta) = - chi' r_b / |O'|`
//!
//! for **any** linkage; the roll follows from the tooth's own angle, `u = psi_b - sigma (eta - chi_tooth)`. The contact
//! moves along the profile at `lambda = O' . exp(i eta) - sigma r_b u eta'` (mm per rad of phi) and the profile turns
//! at `eta' / lambda`. Where lambda changes its sign the envelope turns back: undercut. A circle of the tool (tip
//! round, sharp corner with radius 0, tip circle) touches along the normal of its centre's path.
//!
//! Here sigma is +1 on the cutter flank that cuts the left gear flank of an external gear, the cutter's own left one.
//! In a ring the cutter's teeth point the other way and its right flank cuts the left gear flank; chi' changes its sign
//! as well, so that the same branch of the arcsine belongs to the same **gear** flank.
//!
//! For the finishing linkages this equals `q = P + (S_e - S) cos(a) (cos(a) t + sigma sin(a) n)`, independent of the
//! cutter (checked against the oracle).

use crate::drawn_tooth::envelope::{DrawnSpaces, EnvelopePoint};
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::linkage::ShapingLinkage;
use crate::process::shaping::tool::involute_tooth::CornerPart;
use gearcut_core::gear::GearKind;
use gearcut_core::math::jet::Jet;
use gearcut_core::terms::Side;
use glam::DVec2;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Continuous generation of all tooth spaces by one operation.
#[derive(Debug, Clone)]
pub struct Generation {
    /// How the cutter moves.
    pub linkage: ShapingLinkage,
    /// What cuts.
    pub cutter: Arc<ShaperCutter>,
    /// The operation's offset, mm.
    pub offset_mm: f64,
    /// What a drawn tooth generates, space by space.
    pub drawn: Option<Arc<DrawnSpaces>>,
}

/// Touch of a cutter flank with its envelope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankContact {
    /// Polar angle (parameter of the linkage), rad.
    pub phi_rad: f64,
    /// Contact point, gear frame, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear.
    pub normal: DVec2,
    /// Roll u on the cutter's involute; not a number on a drawn tooth, as are both rates.
    pub roll: f64,
    /// du/dphi.
    pub roll_rate: f64,
    /// Speed of the contact along exp(i eta), mm per rad of phi; changes its sign where the envelope turns back.
    pub speed_mm_per_rad: f64,
}

impl FlankContact {
    /// Touch of a drawn tooth.
    pub fn drawn(EnvelopePoint { phi_rad, point_mm, normal, .. }: EnvelopePoint) -> Self {
        Self { phi_rad, point_mm, normal, roll: f64::NAN, roll_rate: f64::NAN, speed_mm_per_rad: f64::NAN }
    }

    /// Whether the contact runs on along the flank: towards the root, where exp(i eta) points, as the roll grows.
    /// Behind the place where the envelope turns back it runs the other way.
    pub fn is_sound(&self) -> bool {
        self.speed_mm_per_rad * self.roll_rate > 0.0
    }
}

/// Pose with two derivatives with respect to phi.
pub(super) struct CutterMotion {
    pub center: DVec2,
    pub center_rate: DVec2,
    pub center_rate_2: DVec2,
    pub angle: f64,
    pub angle_rate: f64,
    pub angle_rate_2: f64,
}

/// Part of a cutter tooth's tip that generates the root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TipPart {
    /// Tip circle.
    Circle,
    /// Part of a tip corner, on the left (+1) or right (-1) side.
    Corner(CornerPart, f64),
}

impl Generation {
    pub(super) fn motion(&self, phi_rad: f64) -> CutterMotion {
        let axes = self.linkage.axes(phi_rad, self.offset_mm);
        let d = |jet: &Jet<3>| [jet.value(), jet.derivative(1), jet.derivative(2)];
        let [psi, psi1, psi2] = d(&axes.psi_c_rad);
        let [_, turn1, turn2] = d(&axes.psi_b_rad);
        let [l, l1, l2] = d(&axes.center_distance_mm);
        let out = DVec2::from_angle(psi);
        CutterMotion {
            center: out * l,
            center_rate: out * l1 + out.perp() * (l * psi1),
            center_rate_2: out * (l2 - l * psi1 * psi1) + out.perp() * (2.0 * l1 * psi1 + l * psi2),
            angle: axes.pose(self.gear()).angle_rad,
            angle_rate: psi1 + turn1,
            angle_rate_2: psi2 + turn2,
        }
    }

    /// The gear that is generated.
    pub fn gear(&self) -> GearKind {
        self.linkage.gear()
    }

    /// Cutter orientation for the tooth that cuts space `space` (any number, counted along the arc without wrapping;
    /// between whole ones lie the sections of a helical gear).
    pub(super) fn tooth_angle(&self, cutter_angle: f64, space: f64) -> f64 {
        cutter_angle - self.gear().tip_sign() * TAU * space / f64::from(self.cutter.teeth)
    }

    /// Contact of the cutter flank that cuts side `side` of space `space` at `phi_rad`; `None` where the flank touches
    /// nothing.
    pub fn flank_contact(&self, phi_rad: f64, space: f64, side: Side) -> Option<FlankContact> {
        let sigma = self.gear().tip_sign() * side.sign();
        let m = self.motion(phi_rad);
        let tooth = self.cutter.involute()?;
        let r_b = tooth.base_radius_mm;
        let speed = m.center_rate.length();
        let x = -m.angle_rate * r_b / speed;
        if x.abs() >= 1.0 {
            return None;
        }
        let along = m.center_rate.dot(m.center_rate_2) / speed;
        let path_turn = m.center_rate.perp_dot(m.center_rate_2) / (speed * speed);
        let x_rate = -r_b * (m.angle_rate_2 - m.angle_rate * along / speed) / speed;
        let cos = (1.0 - x * x).sqrt();
        // The branch on which the left flank of the gear touches ahead of the line of centres and the right flank
        // behind it.
        let (delta, delta_rate) =
            if side == Side::Left { (x.asin(), x_rate / cos) } else { (-PI - x.asin(), -x_rate / cos) };
        let eta = m.center_rate.to_angle() - delta;
        let eta_rate = path_turn - delta_rate;
        let chi = self.tooth_angle(m.angle, space);
        let roll = tooth.half_angle_rad - sigma * (eta - chi);
        let roll = roll - TAU * (roll / TAU).round();
        let e = DVec2::from_angle(eta);
        Some(FlankContact {
            phi_rad,
            point_mm: m.center + r_b * (e + sigma * roll * e.perp()),
            normal: -sigma * e.perp(),
            roll,
            roll_rate: -sigma * (eta_rate - m.angle_rate),
            speed_mm_per_rad: m.center_rate.dot(e) - sigma * r_b * roll * eta_rate,
        })
    }

    /// Contact of the straight base below the involute that cuts side `side` of `space`: point (gear frame, mm) and
    /// normal out of the gear; `None` where it touches nothing.
    pub fn base_contact(&self, phi_rad: f64, space: f64, side: Side) -> Option<[DVec2; 2]> {
        let m = self.motion(phi_rad);
        let turn = DVec2::from_angle(self.tooth_angle(m.angle, space));
        let tooth = self.cutter.involute()?;
        let flank = tooth.flank(self.gear().tip_sign() * side.sign());
        let start_roll = tooth.roll_range[0];
        let (start, normal) = (turn.rotate(flank.point(start_roll)), turn.rotate(flank.normal(start_roll)));
        let inwards = flank.side * normal.perp();
        let w = -normal.dot(m.center_rate + m.angle_rate * start.perp()) / (m.angle_rate * normal.dot(inwards.perp()));
        (0.0..=tooth.base_length_mm).contains(&w).then(|| [m.center + start + w * inwards, -normal])
    }

    /// Contact of a tip part of the tooth that cuts `space`: point (gear frame, mm) and normal out of the gear, where
    /// that part touches at all.
    pub fn tip_contact(&self, phi_rad: f64, space: f64, part: &TipPart) -> Option<(DVec2, DVec2)> {
        let m = self.motion(phi_rad);
        let turn = DVec2::from_angle(self.tooth_angle(m.angle, space));
        let in_tooth = |n: DVec2| DVec2::new(turn.x, -turn.y).rotate(n).to_angle();
        let touch_circle = |center: DVec2, radius: f64, [from, to]: [f64; 2]| {
            let from_axis = turn.rotate(center);
            let rate = m.center_rate + m.angle_rate * from_axis.perp();
            let across = rate.normalize_or_zero().perp();
            [across, -across].into_iter().find(|&n| (from..=to).contains(&in_tooth(n))).map(|n| {
                let point = m.center + from_axis + radius * n;
                (point, -n)
            })
        };
        match *part {
            TipPart::Circle => {
                let half = self.tip_half_angle();
                touch_circle(DVec2::ZERO, self.cutter.tip_radius_mm, [-half, half])
            }
            TipPart::Corner(CornerPart::Round { center_mm, radius_mm, normals_rad }, side) => {
                let center = DVec2::new(center_mm.x, side * center_mm.y);
                let [a, b] = normals_rad;
                touch_circle(center, radius_mm, if side > 0.0 { [a, b] } else { [-b, -a] })
            }
            TipPart::Corner(CornerPart::Chamfer { flank_end_mm, tip_end_mm }, side) => {
                let flip = |v: DVec2| DVec2::new(v.x, side * v.y);
                let (start, end) = (turn.rotate(flip(flank_end_mm)), turn.rotate(flip(tip_end_mm)));
                let d = end - start;
                let n = side * d.normalize().perp();
                // n . (O' + chi' i (start + w d)) = 0 is linear in w.
                let w = -n.dot(m.center_rate + m.angle_rate * start.perp()) / (m.angle_rate * n.dot(d.perp()));
                (0.0..=1.0).contains(&w).then(|| (m.center + start + w * d, -n))
            }
        }
    }

    /// Half of the angle that the tip circle takes on a cutter tooth.
    fn tip_half_angle(&self) -> f64 {
        match self.cutter.involute().and_then(|tooth| tooth.corner.last()) {
            Some(CornerPart::Round { normals_rad, .. }) => normals_rad[0],
            Some(CornerPart::Chamfer { tip_end_mm, .. }) => tip_end_mm.to_angle(),
            None => 0.0,
        }
    }

    /// Tip parts in the order in which they follow each other from the left flank of the space to its right flank.
    pub fn tip_parts(&self) -> Vec<TipPart> {
        let sign = self.gear().tip_sign();
        let Some(tooth) = self.cutter.involute() else { return Vec::new() };
        let left = tooth.corner.iter().map(|&part| TipPart::Corner(part, sign));
        let right = tooth.corner.iter().rev().map(|&part| TipPart::Corner(part, -sign));
        left.chain([TipPart::Circle]).chain(right).collect()
    }
}
