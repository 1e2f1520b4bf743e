//! One pair of teeth through its mesh: contacts and motion error.
//!
//! **Signs.** Angles grow along the sense in which the pinion turns when it drives these flanks, and the motion error
//! along the sense in which the gear then turns: it is above 0 where the gear is ahead of a constant ratio. The two
//! sides of a tooth drive in opposite senses, so that a sign that counted from a fixed axis would say "ahead" of one
//! side and "behind" of the other one.

use super::{BevelPair, Contact};
use crate::bevel::flank::BevelFlank;
use crate::error::{NotConverged, Refusal};
use std::f64::consts::TAU;

/// One pair of teeth.
#[derive(Debug)]
pub struct BevelMesh<'a> {
    pair: &'a BevelPair,
    thickness_mm: f64,
    /// Contact at the angle at which the middles of both flanks were cut.
    middle: Contact,
}

impl BevelPair {
    /// A pair of teeth; ellipses are those of `thickness_mm` of marking compound.
    ///
    /// # Errors
    /// The flanks do not meet in the middle, or the search does not end.
    pub fn mesh(&self, thickness_mm: f64) -> Result<BevelMesh<'_>, Refusal> {
        let [pinion_rad, gear_rad] = self.middle_rad()?;
        let middle = self.contact(pinion_rad, gear_rad, thickness_mm).map_err(lost)?;
        Ok(BevelMesh { pair: self, thickness_mm, middle: middle.ok_or_else(|| not_met(pinion_rad))? })
    }

    /// Angles of pinion and gear at which the middles of both flanks were cut: near these they touch there.
    ///
    /// # Errors
    /// A flank without a middle.
    pub fn middle_rad(&self) -> Result<[f64; 2], Refusal> {
        let of = |flank: &BevelFlank| -> Result<f64, Refusal> {
            let point = flank.row(0.0)?.point(0.5)?;
            Ok(flank.envelope.settings.work_angle(point.cradle_rad)[0])
        };
        Ok([of(&self.pinion)?, of(&self.gear)?])
    }

    /// Contacts and motion errors at even angles of the pinion over so many pitches about the middle.
    ///
    /// # Errors
    /// The flanks do not meet somewhere.
    pub fn motion(&self, pitches: f64, count: u32, thickness_mm: f64) -> Result<Vec<(Contact, f64)>, Refusal> {
        let mesh = self.mesh(thickness_mm)?;
        let range_rad = pitches * TAU / f64::from(self.pinion.blank.teeth);
        let at = |i| {
            let met = mesh.at(range_rad * (f64::from(i) / f64::from(count - 1) - 0.5), 0.0)?;
            met.ok_or_else(|| not_met(mesh.middle.pinion_rad))
        };
        (0..count).map(at).collect()
    }
}

impl BevelMesh<'_> {
    /// The contact in the middle.
    pub fn middle(&self) -> &Contact {
        &self.middle
    }

    /// Contact and motion error, rad, 0 in the middle, at an angle of the pinion about the middle, where the flanks
    /// meet; `near_rad` is a motion error near it.
    ///
    /// # Errors
    /// The search does not end.
    pub fn at(&self, by_rad: f64, near_rad: f64) -> Result<Option<(Contact, f64)>, Refusal> {
        let Self { pair, middle, .. } = self;
        let ratio = f64::from(pair.pinion.blank.teeth) / f64::from(pair.gear.blank.teeth);
        // Where a growing angle of the gear closes gaps the pinion pushes it back. Gear and pinion turn in opposite
        // senses about axes that both point away from their apexes.
        let [pinion_sense, gear_sense] = [middle.closing, -middle.closing];
        let even_rad = middle.gear_rad + gear_sense * ratio * by_rad;
        let pinion_rad = middle.pinion_rad + pinion_sense * by_rad;
        let contact = pair.contact(pinion_rad, even_rad + gear_sense * near_rad, self.thickness_mm).map_err(lost)?;
        Ok(contact.map(|contact| (contact, gear_sense * (contact.gear_rad - even_rad))))
    }
}

fn not_met(pinion_rad: f64) -> Refusal {
    Refusal::new(
        "pair",
        format!("both flanks do not meet near {:.4} deg of the pinion", pinion_rad.to_degrees()),
        "check the mounting and both scenes",
    )
}

fn lost(lost: NotConverged) -> Refusal {
    Refusal::new("pair", lost.to_string(), "check the mounting and the settings of both: flanks are there")
}
