//! From an operation to its feed path: where slide, shift and infeed begin, how they run, how long it takes.
//!
//! In: the operation, hob, gear. Out: [`FeedPlan`]. The slide begins where the hob clears the blank and ends where the
//! last contact has left the other face; both follow from the hob's tip cylinder and the length of contact unless the
//! scene gives them (the beginning by a bound: chord and height of the tip cylinder are both taken where they are
//! largest). The hob must carry full contact at every moment: it touches the rack's flanks up to h /
//! tan(alpha_t) beside the pitch point, h the largest of both addenda and of the depth to which a negative profile
//! shift takes the hob's tips, so its teeth must reach that far along its axis on both sides of the pitch point.
//!
//! A **shift** moves the hob along its own axis and therefore moves no point of that axis against the gear: what spaces
//! the feed marks is the slide alone. Liu et al. 2015 keep v*_z = v_z + v_u sin(g) constant, slide and the shift's
//! component together; a scene may ask for that.

mod diagonal;
#[cfg(test)]
mod tests;

use super::{FeedPath, FeedPhase, HobbingGeometry};
use crate::process::hobbing::Hob;
use crate::process::hobbing::scene::model::{Approach, FeedDirection, HobbingKind, HobbingOperation};
use crate::scene::model::Gear;
use diagonal::DiagonalCut;
use gearcut_core::error::Refusal;
use gearcut_core::gear::PitchCurve;
use gearcut_core::math::extremum::maximum;

/// Room left between hob and blank before the cut, mm.
const CLEARANCE_MM: f64 = 1.0;
/// Angles round the hob at which its reach is looked at.
const ANGLES: usize = 64;

/// A feed path with what it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedPlan {
    /// The path.
    pub path: FeedPath,
    /// Travel of the slide before the face, mm.
    pub approach_mm: f64,
    /// Travel of the slide beyond the face, mm.
    pub overrun_mm: f64,
    /// Travel before the face from which on the hob, at depth, is clear of the blank, mm.
    pub clear_mm: f64,
    /// Travel beyond the face with which every tooth's last contact leaves the work, mm.
    pub leaves_mm: f64,
    /// Distance from the pitch point, along the hob, that contact needs on both sides, mm.
    pub contact_half_length_mm: f64,
    /// Lowest and highest place of the hob's middle along its axis while it cuts, mm.
    pub shift_range_mm: [f64; 2],
    /// Feed of the slide in the time of one cycle, mm, always positive; first and, where it differs after a reversal of
    /// the shift, second.
    pub slide_feeds_mm: [f64; 2],
    /// Time in which the hob does not cut: idle travel of a repeating shift, s.
    pub idle_s: f64,
    /// Number of shift strokes begun; 1 without a shift.
    pub shift_strokes: u32,
}

impl FeedPlan {
    /// Plan of an operation whose cycle along the pitch curve takes `cycle_s`; `offset_mm` is how far the hob stays
    /// back from full depth, allowances included, `contact_x_mm` how far from the pitch point, along the pitch line in
    /// the transverse section, hob and gear touch at most.
    ///
    /// # Errors
    /// A hob too short for its contact, a shift longer than the hob, a shift that outruns the feed.
    pub fn new(
        operation: &HobbingOperation,
        [offset_mm, contact_x_mm]: [f64; 2],
        hob: &Hob,
        geometry: &HobbingGeometry,
        gear: &Gear,
        curve: &PitchCurve,
        cycle_s: f64,
    ) -> Result<Self, Refusal> {
        let tilt = geometry.head_angle_rad;
        let gear_addendum_mm = gear.addendum_mm();
        let depth_mm = hob.tip_radius_mm - hob.pitch_radius_mm + gear_addendum_mm - offset_mm;
        let contact_half_length_mm = contact_x_mm / tilt.cos();
        let room_mm = 0.5 * hob.length_mm - contact_half_length_mm;
        if room_mm < 0.0 {
            return Err(Refusal::new(
                "tool.hob.length_mm",
                format!(
                    "a hob {} mm long does not carry the whole contact, which takes {:.3} mm",
                    hob.length_mm,
                    2.0 * contact_half_length_mm
                ),
                "use a longer hob",
            ));
        }
        let [bound_mm, clear_mm] = Self::before_the_face_mm(hob, curve, gear, depth_mm, tilt);
        let approach_mm = operation.approach_mm.unwrap_or(bound_mm + CLEARANCE_MM);
        // Hob and flank touch on the normal through the pitch point, which leans along the gear's axis by tan(beta) of
        // its way along the pitch line. Each tooth's last pass comes up to one feed before the end, and cuts half a
        // feed to either side.
        let lean_mm = contact_x_mm * gear.helix_angle_rad.tan();
        let leaves_mm = lean_mm + 0.5 * operation.axial_feed_mm_per_revolution;
        let overrun_mm = operation.overrun_mm.unwrap_or(leaves_mm + CLEARANCE_MM);
        // A left-hand hob's teeth go up through the work (+z of the machine), so that climb feeds down.
        let climb = geometry.hob_hand;
        let direction = match operation.feed_direction {
            FeedDirection::Climb => climb,
            FeedDirection::Conventional => -climb,
        };
        let from_face_mm = 0.5 * gear.face_width_mm;
        let feed_mm = operation.axial_feed_mm_per_revolution;
        let (start_ahead_mm, start_radial_mm, infeed) = match operation.approach {
            Approach::Axial => (approach_mm, offset_mm, None),
            Approach::Radial { feed_mm_per_revolution } => {
                let start_mm = offset_mm + depth_mm + CLEARANCE_MM;
                let rate = feed_mm_per_revolution / cycle_s;
                let phase = FeedPhase {
                    duration_s: (depth_mm + CLEARANCE_MM) / rate,
                    slide_mm_per_s: 0.0,
                    shift_mm_per_s: 0.0,
                    radial_mm_per_s: -rate,
                };
                (overrun_mm, start_mm, Some(phase))
            }
        };
        let start_slide_mm = -direction * (from_face_mm + start_ahead_mm);
        let travel_mm = start_ahead_mm + gear.face_width_mm + overrun_mm;
        let mut plan = Self {
            path: FeedPath {
                start_slide_mm,
                start_shift_mm: 0.0,
                start_radial_mm,
                phases: infeed.into_iter().collect(),
            },
            approach_mm: start_ahead_mm,
            overrun_mm,
            clear_mm,
            leaves_mm,
            contact_half_length_mm,
            shift_range_mm: [0.0, 0.0],
            slide_feeds_mm: [feed_mm, feed_mm],
            idle_s: 0.0,
            shift_strokes: 1,
        };
        match operation.kind {
            HobbingKind::Plain { .. } => {
                let place_mm = operation.shift_start_mm.unwrap_or(0.0);
                Self::within(place_mm, [-room_mm, room_mm])?;
                plan.path.start_shift_mm = place_mm;
                plan.shift_range_mm = [place_mm, place_mm];
                let slide_mm_per_s = direction * feed_mm / cycle_s;
                plan.path.phases.push(FeedPhase {
                    duration_s: travel_mm / slide_mm_per_s.abs(),
                    slide_mm_per_s,
                    shift_mm_per_s: 0.0,
                    radial_mm_per_s: 0.0,
                });
            }
            HobbingKind::Diagonal { .. } => {
                let cut = DiagonalCut { direction, travel_mm, room_mm, depth_mm, tilt, cycle_s };
                plan.diagonal(operation, &cut)?;
            }
        }
        Ok(plan)
    }

    /// Travel of the slide before the face with which the hob at depth is clear of the blank: a bound, and the least,
    /// mm.
    fn before_the_face_mm(hob: &Hob, curve: &PitchCurve, gear: &Gear, depth_mm: f64, tilt: f64) -> [f64; 2] {
        // Half the chord that the tip line cuts from the blank, no longer than the hob or the blank; a flat curve has
        // no chord of its own.
        let gear_addendum_mm = gear.addendum_mm();
        let facts = curve.facts();
        let flattest = facts.smallest_curvature.curvature_per_mm;
        let outline_mm = if flattest > 0.0 { 1.0 / flattest + gear_addendum_mm } else { f64::INFINITY };
        let chord_mm = (outline_mm.powi(2) - (outline_mm - depth_mm).powi(2)).sqrt();
        let blank_mm = facts.largest_radius_mm + gear_addendum_mm;
        let longest_mm = (0.5 * hob.length_mm * tilt.cos()).min(blank_mm);
        let reach_mm = if chord_mm.is_finite() { chord_mm.min(longest_mm) } else { longest_mm };
        let sink_mm = (hob.tip_radius_mm.powi(2) - (hob.tip_radius_mm - depth_mm).powi(2)).max(0.0).sqrt();
        let bound_mm = sink_mm / tilt.cos() + reach_mm * tilt.tan().abs();
        let ends_mm = [0.5 * hob.length_mm, blank_mm];
        [bound_mm, clear_before_mm(hob.tip_radius_mm, outline_mm, depth_mm, ends_mm, tilt).min(bound_mm)]
    }

    fn within(place_mm: f64, [low_mm, high_mm]: [f64; 2]) -> Result<(), Refusal> {
        if (low_mm..=high_mm).contains(&place_mm) {
            return Ok(());
        }
        Err(Refusal::new(
            "operation.shift_start_mm",
            format!("with its middle at {place_mm} mm the hob does not carry the whole contact"),
            format!("set it between {low_mm:.3} and {high_mm:.3} mm, or use a longer hob"),
        ))
    }
}

/// How far the tip cylinder of a hob reaches over its axis along the gear's where it is inside a blank's cylinder, mm.
///
/// A point of the tip cylinder at the angle p from the deepest line is q = h - r (1 - cos p) deep in the outline of
/// radius R, where that is sqrt(2 R q - q^2) wide to either side of the line of centres. Out there by x along the pitch
/// line, the point lies x tan(tilt) + r sin p / cos(tilt) along the gear's axis. The hob and the blank end at `ends_mm`
/// from their middles.
fn clear_before_mm(tip_radius_mm: f64, outline_mm: f64, depth_mm: f64, ends_mm: [f64; 2], tilt: f64) -> f64 {
    let (sin, cos) = tilt.abs().sin_cos();
    let along = |angle: f64| {
        let (beside_mm, below_mm) = (tip_radius_mm * angle.sin(), tip_radius_mm * (1.0 - angle.cos()));
        let deep_mm = (depth_mm - below_mm).max(0.0);
        // A flat outline is as wide as the blank.
        let half_mm = (deep_mm * (2.0 * outline_mm - deep_mm)).max(0.0).sqrt().min(ends_mm[1]);
        half_mm.min(ends_mm[0] * cos - beside_mm * sin) * sin / cos + beside_mm / cos
    };
    let widest = (1.0 - depth_mm / tip_radius_mm).clamp(-1.0, 1.0).acos();
    maximum(along, 0.0, widest, ANGLES).1
}
