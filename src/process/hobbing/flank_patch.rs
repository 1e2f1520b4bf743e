//! The target flank of a hobbed tooth as a patch of polynomials, ready for a million dexels.
//!
//! In: the rack's generation, the blank, tooth and side. Out: points and normals at any share of the profile and any
//! place along the tooth. A contact takes the inverse of an arc length; on a flank both coordinates are smooth, so
//! Chebyshev polynomials of a dozen terms hold them to a picometre, and a dexel costs some products. The number of
//! terms is doubled until an error measured between the nodes is small enough.
//!
//! Along the profile the patch runs from where the flank is whole over the whole face (the latest start of the involute
//! in any section: near the ends of an undercut tooth a little flank below is left out) to the blank's outline, by
//! shares of the roll between them: the profile's length is no smooth coordinate where the envelope nearly stands
//! still.
//!
//! The flank of a drawn tooth is no polynomial: it is the curve through its envelope's points, by shares of its length,
//! turned along the tooth ([`super::drawn_rack`]).

mod chebyshev;
mod source;

use super::drawn_rack::DrawnRack;
use super::rack_generation::{FormPoint, RackGeneration};
use crate::drawn_tooth::flank::DrawnFlank;
use chebyshev::{PARTS, clenshaw};
use gearcut_core::dexel::Ray;
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::regula_falsi;
use gearcut_core::terms::Side;
use glam::{DVec2, DVec3};
use source::{Source, error_mm};
use std::sync::Arc;

/// Largest distance of the patch from the flank, mm: a hundredth of what the dexels resolve.
const TOLERANCE_MM: f64 = 1e-9;
/// Terms of the first try, and the most.
const TERMS: [usize; 2] = [10, 80];
/// Sections to either side of the middle of the face in which the beginning of the flank is found.
const MIDDLE_SECTION: usize = 4;
/// Rounding of heights over the pitch curve, mm.
const HEIGHT_MM: f64 = 1e-12;
/// Panels of the profile's length.
const PANELS: usize = 64;

/// A target flank.
#[derive(Debug, Clone)]
pub struct FlankPatch {
    /// Coefficients along the tooth of coefficients along the profile.
    coefficients: Vec<Vec<[f64; PARTS]>>,
    face_width_mm: f64,
    /// Roll past the pitch line at which the patch begins in every section, mm.
    pub form_roll_mm: f64,
    /// Height over the pitch curve where the patch begins, in the section where the flank begins last, mm.
    pub form_height_mm: f64,
    /// Height over the pitch curve at which the flank begins in the middle of the face, mm.
    pub middle_form_height_mm: f64,
    /// Whether the tip corner has undercut the flank there.
    pub middle_undercut: bool,
    /// Whether the tip corner has undercut the flank in any section.
    pub undercut: bool,
    /// Largest distance from the flank found between the nodes, mm.
    pub error_mm: f64,
    /// Length of the profile in the middle section up to the ends of equal shares of its roll, mm.
    lengths_mm: Vec<f64>,
    /// Places of the contact on the line of action at both ends of the middle section's profile, mm from the pitch
    /// point towards the tip.
    on_line_of_action_mm: [f64; 2],
    /// The curve itself where a drawn tooth generates it.
    drawn: Option<DrawnPatch>,
}

/// The flank of a drawn tooth.
#[derive(Debug, Clone)]
struct DrawnPatch {
    flank: Arc<DrawnFlank>,
    turn_rad_per_mm: f64,
    /// Rolls at equal shares of the profile, mm.
    rolls_mm: Vec<f64>,
}

/// One section of a patch: polynomials along the profile.
#[derive(Debug, Clone)]
pub enum PatchSection {
    /// Polynomials along the profile.
    Polynomials(Vec<[f64; PARTS]>),
    /// The curve of a drawn tooth.
    Drawn {
        /// It.
        flank: Arc<DrawnFlank>,
        /// Its turn along the tooth, rad/mm.
        turn_rad_per_mm: f64,
        /// Its place along the tooth, mm.
        z_mm: f64,
    },
}

impl FlankPatch {
    /// Patch of the flank of `tooth` (from 1) over the face.
    ///
    /// # Errors
    /// A flank that does not reach the tip anywhere, or is not smooth enough.
    pub fn new(
        generation: &RackGeneration,
        blank: &Blank,
        tooth: u32,
        side: Side,
        face_width_mm: f64,
    ) -> Result<Self, Refusal> {
        // The left flank of a tooth bounds the space after it.
        let space = i64::from(tooth) - i64::from(side == Side::Right);
        let middle_form = generation.form_point(blank, space, side, 0.0);
        let form_in = |section: usize| {
            let z_mm = face_width_mm * (section as f64 / (2 * MIDDLE_SECTION) as f64 - 0.5);
            if section == MIDDLE_SECTION || generation.is_straight() {
                middle_form
            } else {
                generation.form_point(blank, space, side, z_mm)
            }
        };
        let forms: Vec<FormPoint> = (0..=2 * MIDDLE_SECTION).map(form_in).collect();
        // Rolls towards the root have the side's sign.
        let latest = forms
            .iter()
            .min_by(|a, b| (side.sign() * a.roll_mm).total_cmp(&(side.sign() * b.roll_mm)))
            .expect("a middle section at least");
        let source = Source { generation, blank, space, side, face_width_mm, form_roll_mm: latest.roll_mm };
        let no_tip = || {
            Refusal::new(
                "gear.addendum_coefficient",
                format!("the {} flank of tooth {tooth} does not reach the blank's outline", side.name()),
                "use a smaller addendum_coefficient",
            )
        };
        let tip_roll_mm = source.tip_roll_mm(0.0).ok_or_else(no_tip)?;
        let on_line_of_action_mm =
            [latest.roll_mm, tip_roll_mm].map(|roll| generation.flank_contact(space, side, roll, 0.0).distance_mm);
        let mut patch = Self {
            coefficients: Vec::new(),
            face_width_mm,
            form_roll_mm: latest.roll_mm,
            form_height_mm: latest.height_mm,
            middle_form_height_mm: middle_form.height_mm,
            middle_undercut: middle_form.undercut,
            undercut: forms.iter().any(|form| form.undercut),
            error_mm: 0.0,
            lengths_mm: source.lengths_mm(tip_roll_mm),
            on_line_of_action_mm,
            drawn: None,
        };
        let checks = source.checks();
        let mut terms = TERMS[0];
        while terms <= TERMS[1] {
            patch.coefficients = source.coefficients(terms).ok_or_else(no_tip)?;
            patch.error_mm = error_mm(&checks, &patch);
            if patch.error_mm <= TOLERANCE_MM {
                return Ok(patch);
            }
            terms = terms * 3 / 2;
        }
        Err(Refusal::new(
            "gear.pitch_curve",
            format!(
                "the {} flank of tooth {tooth} is not smooth: polynomials keep an error of {:.3} nm",
                side.name(),
                patch.error_mm * 1e6
            ),
            "use a pitch curve without corners",
        ))
    }

    /// Patch of the flank that a drawn tooth generates.
    ///
    /// # Errors
    /// The contour does not shape it.
    pub fn drawn(rack: &DrawnRack, tooth: u32, side: Side, face_width_mm: f64) -> Result<Self, Refusal> {
        let space = i64::from(tooth) - i64::from(side == Side::Right);
        let flank = Arc::new(rack.flank(space, side)?);
        let undercut = rack.is_undercut(space, side);
        let form = flank.at_arc(0.0);
        let form_height_mm = rack.blank().height(form.point_mm, form.phi_rad).0;
        let length_mm = flank.length_mm();
        let panel_mm = |i: usize| length_mm * i as f64 / PANELS as f64;
        let roll_mm = |i: usize| {
            let at = flank.at_arc(panel_mm(i));
            (at.point_mm - rack.pitch_point_mm(at.phi_rad)).dot(at.normal)
        };
        let rolls_mm: Vec<f64> = (0..=PANELS).map(roll_mm).collect();
        let drawn = DrawnPatch { flank: flank.clone(), turn_rad_per_mm: rack.turn_rad_per_mm(), rolls_mm };
        Ok(Self {
            coefficients: Vec::new(),
            face_width_mm,
            form_roll_mm: drawn.rolls_mm[0],
            form_height_mm,
            middle_form_height_mm: form_height_mm,
            middle_undercut: undercut,
            undercut,
            error_mm: 0.0,
            lengths_mm: (0..=PANELS).map(panel_mm).collect(),
            on_line_of_action_mm: [drawn.rolls_mm[0], drawn.rolls_mm[PANELS]],
            drawn: Some(drawn),
        })
    }

    /// Section at `z_mm` (from the middle of the face).
    pub fn section(&self, z_mm: f64) -> PatchSection {
        if let Some(DrawnPatch { flank, turn_rad_per_mm, .. }) = &self.drawn {
            return PatchSection::Drawn { flank: flank.clone(), turn_rad_per_mm: *turn_rad_per_mm, z_mm };
        }
        let y = 2.0 * z_mm / self.face_width_mm;
        PatchSection::Polynomials(self.coefficients.iter().map(|along| clenshaw(along, y)).collect())
    }
}

impl FlankPatch {
    /// Length of the profile in the middle of the face, mm.
    pub fn length_mm(&self) -> f64 {
        self.lengths_mm[PANELS]
    }

    /// Roll ([`crate::job::GearJob::rolls_mm`]) at which the profile of the middle section is touched where it has a
    /// length, both in mm.
    pub fn roll_mm(&self, length_mm: f64) -> f64 {
        if let Some(DrawnPatch { rolls_mm, .. }) = &self.drawn {
            let place = self.share_at(length_mm) * PANELS as f64;
            let panel = (place as usize).min(PANELS - 1);
            return rolls_mm[panel] + (place - panel as f64) * (rolls_mm[panel + 1] - rolls_mm[panel]);
        }
        let [form_mm, tip_mm] = self.on_line_of_action_mm;
        form_mm + self.share_at(length_mm) * (tip_mm - form_mm)
    }

    /// Arc of the middle section's profile at which it stands at this height over the pitch curve, both in mm; `None`
    /// where it does not.
    pub fn arc_at_height_mm(&self, blank: &Blank, height_mm: f64) -> Option<f64> {
        let section = self.section(0.0);
        let over_mm = |arc_mm: f64| {
            let point = section.ray(self.share_at(arc_mm)).origin_mm.truncate();
            blank.height(point, point.to_angle()).0 - height_mm
        };
        // Heights climb steadily along a flank.
        regula_falsi(over_mm, 0.0, self.length_mm(), HEIGHT_MM)
    }

    /// Share of the roll at which the profile of the middle section has a length, mm. Between panels the length is a
    /// parabola through its own rates: a column stands within some nanometres of its place, and on the flank exactly.
    /// Where undercut begins the envelope stands still at the form point, and the parabola begins level or falling.
    pub fn share_at(&self, length_mm: f64) -> f64 {
        if length_mm <= 0.0 {
            return 0.0;
        }
        let length_mm = length_mm.min(self.length_mm());
        if self.drawn.is_some() {
            return length_mm / self.length_mm();
        }
        let panel = self.lengths_mm.partition_point(|&l| l <= length_mm).clamp(1, PANELS) - 1;
        let at = |i: usize| self.lengths_mm[i];
        let first = panel.clamp(1, PANELS - 1) - 1;
        // Parabola through three ends of panels, in panels from the first.
        let (a, b, c) = (at(first), at(first + 1), at(first + 2));
        let (slope, bend) = (0.5 * (4.0 * b - 3.0 * a - c), 0.5 * (a - 2.0 * b + c));
        let missing = length_mm - a;
        let x = 2.0 * missing / (slope + (slope * slope + 4.0 * bend * missing).max(0.0).sqrt());
        ((first as f64 + x) / PANELS as f64).clamp(0.0, 1.0)
    }
}

impl PatchSection {
    /// Ray at a share of the roll, 0 at the beginning and 1 at the tip.
    pub fn ray(&self, share: f64) -> Ray {
        match self {
            Self::Polynomials(coefficients) => {
                let [x, y, z, nx, ny, nz] = clenshaw(coefficients, 2.0 * share - 1.0);
                Ray { origin_mm: DVec3::new(x, y, z), normal: DVec3::new(nx, ny, nz) }
            }
            Self::Drawn { flank, turn_rad_per_mm, z_mm } => {
                let at = flank.at_arc(share * flank.length_mm());
                let turn = DVec2::from_angle(turn_rad_per_mm * z_mm);
                let (point, normal) = (turn.rotate(at.point_mm), turn.rotate(at.normal));
                // The flank holds the tooth trace: along it points turn about the axis.
                let lean = -turn_rad_per_mm * normal.dot(point.perp());
                Ray { origin_mm: point.extend(*z_mm), normal: normal.extend(lean).normalize() }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::hobbing::rack_generation::Rack;
    use gearcut_core::gear::PitchCurve;
    use gearcut_core::gear::PitchCurveShape;
    use gearcut_core::math::roots::halve;
    use std::f64::consts::PI;
    use std::sync::Arc;

    #[test]
    fn a_patch_is_its_flank() {
        let shape = PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1, semi_major_axis_mm: None };
        let (beta, module_mm) = (0.184_423_f64, 8.0 / 0.184_423_f64.cos());
        let curve = Arc::new(PitchCurve::new(&shape, module_mm, 35).expect("a curve"));
        let blank = Blank::new(curve.clone(), 8.0).expect("a blank");
        let rack = Rack {
            transverse_module_mm: module_mm,
            pressure_angle_rad: (20_f64.to_radians().tan() / beta.cos()).atan(),
            half_thickness_mm: 0.25 * PI * module_mm,
            tip_height_mm: 10.0,
            tip_radius_mm: 0.0,
            helix_angle_rad: beta,
            hand: -1.0,
        };
        let generation = RackGeneration { curve, rack };
        for (tooth, side) in [(1, Side::Left), (6, Side::Right), (12, Side::Left)] {
            let patch = FlankPatch::new(&generation, &blank, tooth, side, 50.0).expect("a flank");
            assert!(patch.error_mm < TOLERANCE_MM);
            let section = patch.section(13.0);
            let (a, b) = (section.ray(0.25), section.ray(0.75));
            assert!((a.origin_mm.z - 13.0).abs() < 1e-12 && (a.normal.length() - 1.0).abs() < 1e-10);
            // Columns stand evenly along the profile of the middle section.
            let middle = patch.section(0.0);
            let steps = [0.1, 0.5, 0.9].map(|part| {
                let at = |mm: f64| middle.ray(patch.share_at(part * patch.length_mm() + mm)).origin_mm;
                at(0.05).distance(at(-0.05))
            });
            assert!(steps.iter().all(|step| (step / 0.1 - 1.0).abs() < 1e-3), "{steps:?}");
            assert!(a.origin_mm.distance(b.origin_mm) > 1.0);
            let tip = section.ray(1.0).origin_mm.truncate();
            assert!((blank.height(tip, tip.to_angle()).0 - 8.0).abs() < 1e-8);
        }
    }

    /// At the largest tip height without undercut the envelope stands still at the form point, and lengths begin level,
    /// or with a parabola that falls: columns go along the profile from its beginning to its end all the same.
    #[test]
    fn columns_stand_in_order_where_undercut_begins() {
        let (module_mm, teeth) = (3.0, 24);
        let shape = PitchCurveShape::Ellipse { order: 2, eccentricity: 0.126, semi_major_axis_mm: None };
        let curve = Arc::new(PitchCurve::new(&shape, module_mm, teeth).expect("a curve"));
        let blank = Blank::new(curve.clone(), module_mm).expect("a blank");
        let mut falling = 0;
        for (tooth, side) in (1..=3).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
            let generation = |tip_height_mm: f64| RackGeneration {
                curve: curve.clone(),
                rack: Rack {
                    transverse_module_mm: module_mm,
                    pressure_angle_rad: 20_f64.to_radians(),
                    half_thickness_mm: 0.25 * PI * module_mm,
                    tip_height_mm,
                    tip_radius_mm: 0.0,
                    helix_angle_rad: 0.0,
                    hand: 1.0,
                },
            };
            let space = i64::from(tooth) - i64::from(side == Side::Right);
            let is_whole =
                |tip_height_mm: f64| !generation(tip_height_mm).form_point(&blank, space, side, 0.0).undercut;
            let [whole_mm, undercut_mm] = halve(is_whole, 1.0, 6.0, 40);
            for tip_height_mm in [0.999 * whole_mm, whole_mm, undercut_mm, 1.001 * undercut_mm] {
                let patch = FlankPatch::new(&generation(tip_height_mm), &blank, tooth, side, 10.0).expect("a flank");
                falling += u32::from(4.0 * patch.lengths_mm[1] <= patch.lengths_mm[2]);
                let share = |i: u32| patch.share_at(f64::from(i) / 400.0 * patch.length_mm());
                let shares: Vec<f64> = (0..=400).map(share).collect();
                assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "tooth {tooth} {side:?}: {shares:?}");
                assert!(shares[0] == 0.0 && shares[400] > 1.0 - 1e-12);
            }
        }
        assert!(falling > 0, "no parabola begins falling: the place of 0 / 0 is not met");
    }
}
