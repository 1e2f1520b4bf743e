//! Which law every return stroke of an operation follows.
//!
//! In: what the scene asks for, the back-off, the survey of the operation. Out:
//! [`RetractionPlan`]: the law at every polar angle, and the retracted pose of every stroke.
//!
//! `auto` draws the cutter back along the line of centres wherever that clears the surfaces that the operation leaves
//! by [`CLEAR_MM`], and turns it where it does not. A zone in which it turns reaches to the next place of the survey
//! that is clear. Stock that later strokes take is no reason to turn: turning does not clear it, a tilt does.

use super::survey::Survey;
use crate::process::shaping::linkage::retraction::{RetractingCutter, RetractionLaw};
use crate::process::shaping::linkage::{CutterPose, ShapingLinkage, StrokeSchedule};
use crate::process::shaping::scene::model::{Machine, Retraction};
use gearcut_core::error::{NotConverged, Refusal};
use gearcut_core::units::TURN_RAD;

/// Less clearance than this counts as none: the bound of what the survey resolves between its poses.
pub const CLEAR_MM: f64 = 0.001;
/// The clear places at the ends of a zone do not belong to it, whatever their rounding.
const EDGE_RAD: f64 = 1e-9;

/// How the cutter is drawn back over a turn.
#[derive(Debug, Clone, PartialEq)]
pub struct RetractionPlan {
    asked: Retraction,
    back_off_mm: f64,
    /// Tilts that clear everywhere for a small back-off, rad, where one is asked for.
    tilts_rad: Option<[f64; 2]>,
    /// Zones of polar angle in which `auto` turns the cutter, rad, within one turn and beyond its end.
    turned_rad: Vec<[f64; 2]>,
}

impl RetractionPlan {
    /// What a machine does with an operation; the survey is asked where the choice depends on it.
    ///
    /// # Errors
    /// A back-off so large that a law leads to no pose after some stroke.
    pub fn new(machine: &Machine, schedule: &StrokeSchedule, survey: &Survey) -> Result<Self, Refusal> {
        let (asked, back_off_mm) = (machine.retraction, machine.back_off_mm);
        let mut plan = Self { asked, back_off_mm, tilts_rad: None, turned_rad: Vec::new() };
        match asked {
            _ if back_off_mm <= 0.0 => {}
            Retraction::CenterLine | Retraction::Normal | Retraction::Turned => {}
            Retraction::Tilted => plan.tilts_rad = Some(survey.tilts().unwrap_or_default()),
            Retraction::Auto => {
                let clear = survey.clear(back_off_mm, |_| RetractionLaw::CenterLine, CLEAR_MM);
                plan.turned_rad = zones(&clear.map_err(|_| no_pose(back_off_mm))?);
            }
        }
        let strokes = if plan.is_in_axes() { schedule.count() } else { 0 };
        for stroke in 0..strokes {
            let state = schedule.state(stroke as f64);
            plan.try_retracted(schedule.linkage(), &state.pose, state.phi_rad).map_err(|_| no_pose(back_off_mm))?;
        }
        Ok(plan)
    }

    /// Tilted out of the normal, within what clears.
    pub fn tilted(back_off_mm: f64, tilts_rad: [f64; 2]) -> Self {
        Self { asked: Retraction::Tilted, back_off_mm, tilts_rad: Some(tilts_rad), turned_rad: Vec::new() }
    }

    /// What the scene asks for.
    pub fn asked(&self) -> Retraction {
        self.asked
    }

    /// How far the cutter is drawn back, mm.
    pub fn back_off_mm(&self) -> f64 {
        self.back_off_mm
    }

    /// Whether the program moves the axes for it; otherwise the machine's own relief draws the cutter back.
    pub fn is_in_axes(&self) -> bool {
        self.asked != Retraction::CenterLine && self.back_off_mm > 0.0
    }

    /// Smallest and largest tilt that clears, rad; `None` where the direction is not tilted.
    pub fn tilts_rad(&self) -> Option<[f64; 2]> {
        self.tilts_rad
    }

    /// Zones of polar angle, rad, in which `auto` turns the cutter.
    #[cfg(feature = "testing")]
    pub fn turned_rad(&self) -> &[[f64; 2]] {
        &self.turned_rad
    }

    /// The law at a polar angle.
    pub fn law(&self, phi_rad: f64) -> RetractionLaw {
        match self.asked {
            Retraction::CenterLine => RetractionLaw::CenterLine,
            Retraction::Normal => RetractionLaw::Normal,
            Retraction::Turned => RetractionLaw::Turned,
            Retraction::Tilted => {
                let [low, high] = self.tilts_rad.unwrap_or_default();
                RetractionLaw::Tilted(0.5 * (low + high))
            }
            Retraction::Auto => {
                let within = |[from, to]: &[f64; 2]| {
                    let into_rad = (phi_rad - from).rem_euclid(TURN_RAD);
                    to - from >= TURN_RAD || (into_rad > EDGE_RAD && into_rad < to - from - EDGE_RAD)
                };
                if self.turned_rad.iter().any(within) { RetractionLaw::Turned } else { RetractionLaw::CenterLine }
            }
        }
    }

    /// The cutter after it has been drawn back from a pose that belongs to `phi_rad`.
    pub fn retracted(&self, linkage: &ShapingLinkage, pose: &CutterPose, phi_rad: f64) -> CutterPose {
        self.try_retracted(linkage, pose, phi_rad).expect("every stroke's way back was looked at beforehand")
    }

    fn try_retracted(
        &self,
        linkage: &ShapingLinkage,
        pose: &CutterPose,
        phi_rad: f64,
    ) -> Result<CutterPose, NotConverged> {
        let cutter = RetractingCutter::of(linkage);
        Ok(cutter.retracted(self.law(phi_rad), pose, phi_rad, self.back_off_mm)?.pose)
    }
}

/// A law that leads to no pose with a back-off.
pub fn no_pose(back_off_mm: f64) -> Refusal {
    Refusal::new(
        "machine.back_off_mm",
        format!("drawn back by {back_off_mm} mm, the cutter's axis is on no normal of the pitch curve nearby"),
        "back off by less, a few tenths of a millimetre, or set machine.retraction = \"center_line\"",
    )
}

/// Neighbouring places without clearance, from the clear place before them to the one behind them.
fn zones(clear: &[bool]) -> Vec<[f64; 2]> {
    let step_rad = TURN_RAD / clear.len() as f64;
    let Some(start) = clear.iter().position(|&clear| clear) else {
        return vec![[0.0, TURN_RAD]];
    };
    let mut zones: Vec<[f64; 2]> = Vec::new();
    for index in start + 1..start + clear.len() {
        if clear[index % clear.len()] {
            continue;
        }
        let [from, to] = [index - 1, index + 1].map(|near| near as f64 * step_rad);
        match zones.last_mut() {
            Some(last) if last[1] >= from - 0.5 * step_rad => last[1] = to,
            _ => zones.push([from, to]),
        }
    }
    zones
}
