//! The target flank as a grid: rows along the tooth, each with its profile from the form point to the tip.
//!
//! In: an envelope and the blank. Out: rows at places along the tooth, and on each the points and normals of the flank
//! at shares of its profile.
//!
//! A **row** stands at one cone distance: it lies in the cone square to the pitch cone, as ISO's transverse sections of
//! bevel gears do. Its place along the tooth counts from the middle of the face along the pitch cone, towards the heel.
//! Its **profile** begins in the form point, where the round of the cutting corner ends, and ends on the face cone; its
//! share runs evenly over the height between them, so that all rows have the same columns although teeth get deeper
//! towards the heel. Profile arcs in mm are those of the middle of the face.

use super::blank::BevelBlank;
use super::envelope::{Envelope, FlankPoint, OnFlank};
use crate::error::{NotConverged, Refusal};
use crate::parameter;
use glam::{DVec2, DVec3};

/// Intervals over which the arc of the middle profile is summed: chords of 0.1 mm on a radius of 100 mm are short by
/// 4e-8 of themselves.
const ARC_INTERVALS: usize = 100;

/// One flank of a tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelFlank {
    /// How it is generated.
    pub envelope: Envelope,
    /// The blank.
    pub blank: BevelBlank,
    /// Arcs of the middle profile at even shares, mm.
    arcs_mm: Vec<f64>,
}

/// One row of a flank.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankRow<'a> {
    flank: &'a BevelFlank,
    /// Cone distance, mm.
    pub cone_distance_mm: f64,
    /// Where the flank begins: height over the pitch cone, mm.
    pub form_height_mm: f64,
    /// Where it ends: the addendum here, mm.
    pub tip_height_mm: f64,
    /// Coordinates on the envelope of the form point, the middle of the profile and the tip.
    coordinates: [DVec2; 3],
}

impl BevelFlank {
    /// The flank, if the head generates it from toe to heel.
    ///
    /// # Errors
    /// A row without form point or tip: the settings miss the blank.
    pub fn new(envelope: Envelope, blank: BevelBlank) -> Result<Self, Refusal> {
        let mut flank = Self { envelope, blank, arcs_mm: vec![0.0] };
        let half_mm = 0.5 * blank.face_width_mm;
        for along_mm in [-half_mm, half_mm] {
            flank.row(along_mm)?;
        }
        let middle = flank.row(0.0)?;
        let mut arcs_mm = vec![0.0];
        let mut before = middle.point(0.0)?.point_mm;
        for i in 1..=ARC_INTERVALS {
            let here = middle.point(i as f64 / ARC_INTERVALS as f64)?.point_mm;
            arcs_mm.push(arcs_mm[i - 1] + here.distance(before));
            before = here;
        }
        flank.arcs_mm = arcs_mm;
        Ok(flank)
    }

    /// Length of the profile in the middle of the face, mm.
    pub fn length_mm(&self) -> f64 {
        self.arcs_mm.last().copied().unwrap_or_default()
    }

    /// Share of the profile that ends at an arc from the form point, in the middle of the face.
    pub fn share_at(&self, arc_mm: f64) -> f64 {
        let last = self.arcs_mm.len() - 1;
        let after = self.arcs_mm.partition_point(|&arc| arc <= arc_mm).clamp(1, last);
        let [from, to] = [self.arcs_mm[after - 1], self.arcs_mm[after]];
        ((after - 1) as f64 + (arc_mm - from) / (to - from)) / last as f64
    }

    /// Arc from the form point at which a share of the profile ends, in the middle of the face, mm.
    pub fn arc_at(&self, share: f64) -> f64 {
        let last = self.arcs_mm.len() - 1;
        let place = share * last as f64;
        let before = (place.max(0.0) as usize).min(last - 1);
        self.arcs_mm[before] + (place - before as f64) * (self.arcs_mm[before + 1] - self.arcs_mm[before])
    }

    /// The row at a place along the tooth, mm from the middle of the face, positive towards the heel.
    ///
    /// # Errors
    /// The head cuts no form point or no tip there.
    pub fn row(&self, along_mm: f64) -> Result<FlankRow<'_>, Refusal> {
        let (envelope, blank) = (&self.envelope, &self.blank);
        let cone_distance_mm = blank.mean_cone_distance_mm() + along_mm;
        let tip_height_mm = blank.addendum_mm(cone_distance_mm);
        let find = |place, start| envelope.find(blank, cone_distance_mm, place, start);
        let rows = || -> Result<_, NotConverged> {
            let pitch = find(OnFlank::Height(0.0), envelope.guess(cone_distance_mm))?;
            let start = pitch.coordinates;
            let form = find(OnFlank::Edge(envelope.surface.corner_end_mm()), start)?;
            let [_, form_height_mm] = blank.cone_distance_and_height_mm(form.point_mm);
            let tip = find(OnFlank::Height(tip_height_mm), start)?;
            let middle = find(OnFlank::Height(0.5 * (form_height_mm + tip_height_mm)), start)?;
            Ok((form_height_mm, [form, middle, tip].map(|point| point.coordinates.into())))
        };
        let (form_height_mm, coordinates) = rows().map_err(|lost| {
            Refusal::new(
                parameter::CRADLE,
                format!(
                    "at a cone distance of {cone_distance_mm:.3} mm the {} blades make no flank between root and \
                     tip: {lost}",
                    envelope.surface.kind.name()
                ),
                "check radial setting, cradle angle, ratio of roll and cutter radius against the blank",
            )
        })?;
        if form_height_mm >= tip_height_mm {
            return Err(Refusal::new(
                parameter::SLIDING_BASE,
                format!(
                    "at a cone distance of {cone_distance_mm:.3} mm the {} blades reach down to {form_height_mm:.3} mm \
                     over the pitch cone, and the tips are at {tip_height_mm:.3} mm",
                    envelope.surface.kind.name()
                ),
                "bring the head deeper by the sliding base, or check the blank's addendum",
            ));
        }
        Ok(FlankRow { flank: self, cone_distance_mm, form_height_mm, tip_height_mm, coordinates })
    }
}

impl FlankRow<'_> {
    /// Share of the profile at which it crosses the pitch cone; beyond 0 to 1 where it does not.
    pub fn pitch_share(&self) -> f64 {
        -self.form_height_mm / (self.tip_height_mm - self.form_height_mm)
    }

    /// Spiral angle on the pitch cone, rad: from the generatrix to the tooth's trace, positive for right-hand spirals.
    ///
    /// # Errors
    /// The flank does not reach the pitch cone here.
    pub fn spiral_angle_rad(&self) -> Result<f64, Refusal> {
        let pitch = self.point(self.pitch_share())?;
        let away = pitch.point_mm.with_x(0.0).normalize();
        let (sin, cos) = self.flank.blank.pitch_angle_rad.sin_cos();
        let [generatrix, out] = [DVec3::X * cos + sin * away, cos * away - sin * DVec3::X];
        let trace = pitch.normal.cross(out);
        Ok((trace.dot(generatrix.cross(out)) / trace.dot(generatrix)).atan())
    }

    /// Point of the flank at a share of the profile: 0 in the form point, 1 on the face cone.
    ///
    /// # Errors
    /// There is no such point.
    pub fn point(&self, share: f64) -> Result<FlankPoint, Refusal> {
        let [form, middle, tip] = self.coordinates;
        // A parabola through the three known places.
        let (bend, slope) = (2.0 * (form + tip - 2.0 * middle), 4.0 * middle - 3.0 * form - tip);
        let start = form + share * (slope + share * bend);
        let height_mm = self.form_height_mm + share * (self.tip_height_mm - self.form_height_mm);
        let BevelFlank { envelope, blank, .. } = self.flank;
        envelope.find(blank, self.cone_distance_mm, OnFlank::Height(height_mm), start.into()).map_err(|lost| {
            Refusal::new(
                parameter::CRADLE,
                format!("at a cone distance of {:.3} mm, height {height_mm:.3} mm: {lost}", self.cone_distance_mm),
                "check the settings against the blank",
            )
        })
    }
}
