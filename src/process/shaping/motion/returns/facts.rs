//! What is known of the return strokes of an operation before anything is cut.
//!
//! In: the survey of the operation, its retraction plan, what the axes can do. Out: [`ReturnFacts`]: the room round the
//! returning cutter along the curve, its tightest places, and where the cutter rubs on stock the one direction that
//! clears all of it, with what it costs in stroke time. Work and cutter are ideal; what the strokes of a scene really
//! meet, the blank field of a run says.

use super::motion::{RamTimes, RetractionMotion};
use super::plan::{CLEAR_MM, RetractionPlan, no_pose};
use super::survey::{PlacedRoom, Survey, tightest};
use crate::machine::Limits;
use crate::process::shaping::linkage::StrokeSchedule;
use crate::process::shaping::scene::model::Retraction;
use gearcut_core::error::Refusal;

/// What is known of return strokes.
#[derive(Debug, Clone)]
pub struct ReturnFacts {
    /// Room over one period of the pitch curve.
    pub period: Vec<PlacedRoom>,
    /// Where the line of centres is farthest from the normal.
    pub steepest: PlacedRoom,
    /// Where the cutter comes nearest to the surfaces that stay; `None` where it meets none.
    pub surface: Option<PlacedRoom>,
    /// Area that it has in common with them there, mm2.
    pub overlap_mm2: f64,
    /// Where it comes nearest to any material, stock included.
    pub material: Option<PlacedRoom>,
    /// The direction that clears stock, where the cutter rubs on it.
    pub offer: Offer,
}

/// A direction that clears stock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Offer {
    /// None is needed.
    NotNeeded,
    /// No direction clears all of it, or the cutter is tilted already.
    Nothing,
    /// `machine.retraction = "tilted"`.
    Tilt {
        /// Smallest and largest tilt out of the normal, rad.
        tilts_rad: [f64; 2],
        /// What the axes then ask for.
        cost: TiltCost,
    },
}

/// What a retraction by the axes costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TiltCost {
    /// The scene does not say how fast the axes are.
    Unknown,
    /// The ram leaves the axes no time outside the face.
    NoTime,
    /// Double strokes have to last so many times as long, 1 or more.
    Slowdown(f64),
}

impl ReturnFacts {
    /// Of an operation whose cutter is drawn back.
    ///
    /// # Errors
    /// A back-off so large that the retraction leads to no pose.
    pub fn new(
        survey: &Survey,
        plan: &RetractionPlan,
        schedule: &StrokeSchedule,
        ram: &RamTimes,
        limits: &[Limits; 3],
    ) -> Result<Self, Refusal> {
        let back_off_mm = plan.back_off_mm();
        let mut rooms = survey.rooms(back_off_mm, |phi| plan.law(phi)).map_err(|_| no_pose(back_off_mm))?;
        // All periods are alike: the first place is told.
        rooms.truncate(survey.period_places());
        let steepest = rooms.iter().min_by(|a, b| b.from_normal_rad.abs().total_cmp(&a.from_normal_rad.abs()));
        let steepest = *steepest.expect("a turn has places");
        let surface = tightest(&rooms, |room| room.clearance.surface_mm).copied();
        let material = tightest(&rooms, |room| room.clearance.material_mm).copied();
        let in_surface = surface.filter(|room| room.clearance.surface_mm < 0.0);
        let offer = match (material, plan.asked()) {
            (Some(room), Retraction::Tilted) if room.clearance.material_mm <= -CLEAR_MM => Offer::Nothing,
            (Some(room), _) if room.clearance.material_mm <= -CLEAR_MM => match survey.tilts() {
                Some(tilts_rad) if tilts_rad[0] < tilts_rad[1] => {
                    let plan = RetractionPlan::tilted(back_off_mm, tilts_rad);
                    let slowdown = RetractionMotion::new(schedule, &plan, ram, limits).and_then(|of| of.slowdown());
                    Offer::Tilt { tilts_rad, cost: TiltCost::of(slowdown) }
                }
                _ => Offer::Nothing,
            },
            _ => Offer::NotNeeded,
        };
        Ok(Self {
            period: rooms,
            steepest,
            surface,
            overlap_mm2: in_surface.map_or(0.0, |room| survey.overlap_mm2(&room)),
            material,
            offer,
        })
    }
}

impl TiltCost {
    fn of(slowdown: Option<f64>) -> Self {
        match slowdown {
            None => Self::Unknown,
            Some(factor) if factor.is_finite() => Self::Slowdown(factor),
            Some(_) => Self::NoTime,
        }
    }
}
