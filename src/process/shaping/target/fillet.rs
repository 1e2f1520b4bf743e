//! The fillet of a space: the path of the cutter's tip, from the left flank of the space to the right one.
//!
//! In: the generation of an operation, a space. Out: [`Fillet`], a curve over a parameter that counts its pieces, and
//! points along it, on which the dexels of a root stand.
//!
//! Each part of the cutter's tip (corners, tip circle) touches over one range of phi; the ranges are found on a grid
//! and follow each other. Parts that never touch (a tip circle in a sharp hollow) are left out.
//!
//! Which way phi runs along a piece follows from its normal: on the way from left to right the outside of an external
//! gear lies to the right, that of a ring to the left. Road not taken: the ends' polar angles. The path of a corner
//! that undercuts swings back under the tooth, and its ends say nothing.

use crate::drawn_tooth::flank::DrawnFlank;
use crate::process::shaping::target::generation::{Generation, TipPart};
use crate::steps::planar::ProfilePoint;
use gearcut_core::gear::GearKind;
use gearcut_core::math::roots::{bisect, halve};
use glam::DVec2;
use std::f64::consts::PI;

/// Chords by which the length of a piece is taken.
const CHORDS: u32 = 64;
/// Steps of the grid on which a part's contact is sought, and of the walk to its ends, to a pitch.
const STEPS_PER_PITCH: f64 = 128.0;

/// Path of a cutter tooth's tip in the gear frame.
#[derive(Debug, Clone)]
pub struct Fillet<'a> {
    generation: &'a Generation,
    space: f64,
    pieces: Vec<FilletPiece>,
}

/// What one part of the tip leaves.
#[derive(Debug, Clone)]
enum FilletPiece {
    /// Of an involute tooth.
    Tip {
        /// Which part.
        part: TipPart,
        /// Parameter of the linkage at its end on the left and on the right.
        phi_rad: [f64; 2],
    },
    /// All of a drawn tooth.
    Drawn(DrawnFlank),
}

impl<'a> Fillet<'a> {
    /// Of the space after tooth `space` (space 0 is centred on phi = 0).
    pub fn new(generation: &'a Generation, space: f64) -> Self {
        let curve = generation.linkage.curve();
        let pitch_arc_mm = 2.0 * PI * generation.cutter.pitch_radius_mm / f64::from(generation.cutter.teeth);
        let phi_space = curve.phi_at_arc(space * pitch_arc_mm);
        let step = pitch_arc_mm / curve.frame(phi_space).arc_rate_mm_per_rad / STEPS_PER_PITCH;
        let piece = |part: TipPart| {
            let contact = |phi: f64| generation.tip_contact(phi, space, &part);
            let inside = |phi: f64| contact(phi).is_some();
            // Contact may start anywhere within a pitch of the space: the grid finds it, bisection its ends.
            let seed = (0..256)
                .map(|i| phi_space + step * f64::from((i + 1) / 2 * (1 - 2 * (i % 2))))
                .find(|&phi| inside(phi))?;
            let (from, to) = (boundary(seed, -step, inside)?, boundary(seed, step, inside)?);
            let [a, b] = [0.5, 0.5 + 1.0 / f64::from(CHORDS)].map(|share| contact(from + share * (to - from)));
            let ((a, normal), (b, _)) = (a?, b?);
            let is_backwards = (b - a).dot(normal.perp()) * generation.gear().tip_sign() < 0.0;
            Some(FilletPiece::Tip { part, phi_rad: if is_backwards { [to, from] } else { [from, to] } })
        };
        if let Some(profile) = generation.space_profile(space.round() as i64) {
            // From the left flank of the gear to the right one.
            let mut points = profile.map_or(Vec::new(), |profile| profile.root().to_vec());
            if generation.gear() == GearKind::External {
                points.reverse();
            }
            let pieces =
                if points.is_empty() { Vec::new() } else { vec![FilletPiece::Drawn(DrawnFlank::through(points))] };
            return Self { generation, space, pieces };
        }
        Self { generation, space, pieces: generation.tip_parts().into_iter().filter_map(piece).collect() }
    }

    /// End of the parameter: the number of pieces.
    pub fn end(&self) -> f64 {
        self.pieces.len() as f64
    }

    /// Place on the normal of the pitch curve through the middle of the space.
    pub fn middle(&self) -> f64 {
        let curve = self.generation.linkage.curve();
        let pitch_arc_mm = 2.0 * PI * self.generation.cutter.pitch_radius_mm / f64::from(self.generation.cutter.teeth);
        let frame = curve.frame(curve.phi_at_arc(self.space * pitch_arc_mm));
        let is_before = |place: f64| {
            self.at(place).is_some_and(|(_, point_mm, _)| (point_mm - frame.point_mm).dot(frame.tangent) < 0.0)
        };
        bisect(is_before, 0.0, self.end())
    }

    /// Parameter of the linkage, point (gear frame, mm) and normal out of the gear at a place, 0 to [`Self::end`] from
    /// left to right.
    pub fn at(&self, place: f64) -> Option<(f64, DVec2, DVec2)> {
        let index = (place as usize).min(self.pieces.len().checked_sub(1)?);
        self.on_piece(&self.pieces[index], place - index as f64)
    }

    fn on_piece(&self, piece: &FilletPiece, share: f64) -> Option<(f64, DVec2, DVec2)> {
        match piece {
            FilletPiece::Tip { part, phi_rad: [from, to] } => {
                // Beyond its very end, by rounding, nothing touches.
                let phi = if share < 1.0 { from + (to - from) * share } else { *to };
                let (point, normal) = self.generation.tip_contact(phi, self.space, part)?;
                Some((phi, point, normal))
            }
            FilletPiece::Drawn(curve) => {
                let contact = curve.at_arc(share * curve.length_mm());
                Some((contact.phi_rad, contact.point_mm, contact.normal))
            }
        }
    }

    /// Points about `spacing_mm` apart between two places, both and all ends of pieces between them included.
    pub fn chain_mm(&self, [from, to]: [f64; 2], spacing_mm: f64) -> Vec<DVec2> {
        let joints = (0..=self.pieces.len()).map(|joint| joint as f64).filter(|&joint| joint > from && joint < to);
        let ends: Vec<f64> = [from].into_iter().chain(joints).chain([to]).collect();
        let end_mm = |place: f64| self.at(place).map(|(_, point_mm, _)| point_mm);
        let piece = |pair: &[f64]| {
            let inside = self.points([pair[0], pair[1]], spacing_mm).into_iter().map(|point| point.point_mm);
            end_mm(pair[0]).into_iter().chain(inside).collect::<Vec<_>>()
        };
        ends.windows(2).flat_map(piece).chain(end_mm(to)).collect()
    }

    /// Points about `spacing_mm` apart between two places, half a spacing off the ends of every piece.
    pub fn points(&self, ends: [f64; 2], spacing_mm: f64) -> Vec<ProfilePoint> {
        let shares = self.shares(ends, spacing_mm);
        Self::profile(shares.into_iter().filter_map(|(index, share)| self.on_piece(&self.pieces[index], share)))
    }

    /// As many points between two places as those of another fillet between its `other_ends`, at the same parts of the
    /// way: sections of one root.
    pub fn points_like(&self, [from, to]: [f64; 2], other: (&Self, [f64; 2]), spacing_mm: f64) -> Vec<ProfilePoint> {
        let (other, other_ends) = other;
        let [other_from, other_to] = other_ends;
        let shares = other.shares(other_ends, spacing_mm).into_iter();
        let part = |(index, share): (usize, f64)| (index as f64 + share - other_from) / (other_to - other_from);
        Self::profile(shares.filter_map(|place| self.at(from + (to - from) * part(place))))
    }

    /// Points with their lengths from the first one.
    fn profile(places: impl Iterator<Item = (f64, DVec2, DVec2)>) -> Vec<ProfilePoint> {
        let mut points: Vec<ProfilePoint> = Vec::new();
        for (phi_rad, point_mm, normal) in places {
            let arc_mm = points.last().map_or(0.0, |last| last.arc_mm + last.point_mm.distance(point_mm));
            points.push(ProfilePoint { arc_mm, point_mm, normal, phi_rad });
        }
        points
    }

    /// Pieces and shares of them about `spacing_mm` apart between two places, half a spacing off the ends of each.
    fn shares(&self, [from, to]: [f64; 2], spacing_mm: f64) -> Vec<(usize, f64)> {
        let mut places = Vec::new();
        for (index, piece) in self.pieces.iter().enumerate() {
            let shares = [from, to].map(|place| (place - index as f64).clamp(0.0, 1.0));
            let share_at = |part: f64| shares[0] + (shares[1] - shares[0]) * part;
            let chords: Vec<(f64, DVec2)> = (0..=CHORDS)
                .filter_map(|i| {
                    let share = share_at(f64::from(i) / f64::from(CHORDS));
                    self.on_piece(piece, share).map(|(_, point, _)| (share, point))
                })
                .collect();
            let length: f64 = chords.windows(2).map(|w| w[0].1.distance(w[1].1)).sum();
            let count = (length / spacing_mm).ceil().max(1.0) as u32;
            let mut travelled = 0.0;
            let mut next = 0.5 * length / f64::from(count);
            for pair in chords.windows(2) {
                let length_mm = pair[0].1.distance(pair[1].1);
                while next <= travelled + length_mm && length_mm > 0.0 {
                    let share = pair[0].0 + (pair[1].0 - pair[0].0) * (next - travelled) / length_mm;
                    places.push((index, share));
                    next += length / f64::from(count);
                }
                travelled += length_mm;
            }
        }
        places
    }
}

/// Last place where `inside` holds, walking from `start` (inside) by `step` and halving at the end.
pub(in crate::process::shaping) fn boundary(start: f64, step: f64, inside: impl Fn(f64) -> bool) -> Option<f64> {
    let mut last = start;
    let outside = (1..=512).map(|i| start + step * f64::from(i)).find(|&phi| {
        let holds = inside(phi);
        if holds {
            last = phi;
        }
        !holds
    })?;
    Some(halve(inside, last, outside, 60)[0])
}
