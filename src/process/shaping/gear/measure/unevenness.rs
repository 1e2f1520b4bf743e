//! Allowances AB and CD of every tooth and their unevenness (Gao et al. 2017, Fig. 9 and Eq. 14).
//!
//! The equation's print is lost. Two denominators fit the paper's figures about equally well, so both are always given,
//! by name: the **mean** of AB and CD, `|AB - CD| / ((AB + CD) / 2)`, and the **rack** allowance,
//! `|AB - CD| / (delta_d tan(alpha))`, what the offset delta_d leaves on a straight rack.

use super::crossing::{envelope_crossing, stroke_crossing};
use crate::measure::crossing::Crossing;
use crate::process::shaping::ShapingJob;
use gearcut_core::error::NotConverged;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use rayon::prelude::*;

/// Points and allowances of one tooth; `None` where a surface does not cross the pitch curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothAllowance {
    /// Tooth, from 1.
    pub tooth: u32,
    /// A: operation, left flank.
    pub a: Option<Crossing>,
    /// B: finished, left flank.
    pub b: Option<Crossing>,
    /// C: finished, right flank.
    pub c: Option<Crossing>,
    /// D: operation, right flank.
    pub d: Option<Crossing>,
}

/// Largest and mean unevenness, percent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unevenness {
    /// Largest.
    pub max_percent: f64,
    /// Mean over the teeth.
    pub mean_percent: f64,
}

/// Which surface is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossedSurface {
    /// The limit of infinitely many strokes.
    Envelope,
    /// What the strokes leave in the middle of the face, those of earlier operations included.
    Strokes,
    /// What the strokes of the operation would leave there without those before.
    OwnStrokes,
}

impl ToothAllowance {
    /// Chord AB, mm; negative where A lies inside the finished tooth.
    pub fn ab_mm(&self) -> Option<f64> {
        Some(chord_mm(&self.b?, &self.a?))
    }

    /// Chord CD, mm; negative where D lies inside the finished tooth.
    pub fn cd_mm(&self) -> Option<f64> {
        Some(chord_mm(&self.d?, &self.c?))
    }

    /// |AB - CD| over the mean of both, percent.
    pub fn unevenness_mean_percent(&self) -> Option<f64> {
        let (ab, cd) = (self.ab_mm()?, self.cd_mm()?);
        (ab + cd > 0.0).then(|| 200.0 * (ab - cd).abs() / (ab + cd))
    }

    /// |AB - CD| over the rack allowance delta_d tan(alpha), percent; `rack_mm` is that allowance.
    pub fn unevenness_rack_percent(&self, rack_mm: f64) -> Option<f64> {
        (rack_mm > 0.0).then_some(100.0 * (self.ab_mm()? - self.cd_mm()?).abs() / rack_mm)
    }
}

/// Chord from one crossing to another, mm; negative where the second has the smaller arc.
fn chord_mm(from: &Crossing, to: &Crossing) -> f64 {
    let ahead_rad = to.phi_rad - from.phi_rad;
    let ahead_rad = ahead_rad - TURN_RAD * (ahead_rad / TURN_RAD).round();
    let chord_mm = from.point_mm.distance(to.point_mm);
    if ahead_rad < 0.0 { -chord_mm } else { chord_mm }
}

/// Crossings of a tooth's left and right flank with the pitch curve.
pub type ToothCrossings = [Option<Crossing>; 2];

/// Crossings of all teeth with one surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossings {
    /// Tooth by tooth; none where the surface does not cross the curve, and where its crossing is not found.
    pub teeth: Vec<ToothCrossings>,
    /// Flanks whose crossing is not found: the surface jumps where it meets the curve.
    pub unsettled: Vec<(u32, Side)>,
}

/// Where the surface that an operation leaves crosses the pitch curve, tooth by tooth.
///
/// Strokes far off their places leave surfaces that jump along the curve; there a crossing is not defined. Such flanks
/// are named, and the rest of the gear is measured.
pub fn crossings(job: &ShapingJob, operation: usize, surface: CrossedSurface) -> Crossings {
    let finishing = job.operations.len() - 1;
    let found: Vec<[Result<Option<Crossing>, NotConverged>; 2]> = (1..=job.scene.gear.teeth)
        .into_par_iter()
        .map(|tooth| {
            [Side::Left, Side::Right].map(|side| {
                let first = match surface {
                    CrossedSurface::Envelope => return Ok(envelope_crossing(job, operation, tooth, side)),
                    CrossedSurface::Strokes => 0,
                    CrossedSurface::OwnStrokes => operation,
                };
                match envelope_crossing(job, finishing, tooth, side) {
                    Some(start) => stroke_crossing(job, first..operation + 1, side, start),
                    None => Ok(None),
                }
            })
        })
        .collect();
    let sides = (1_u32..)
        .zip(&found)
        .flat_map(|(tooth, [left, right])| [(tooth, Side::Left, left.is_err()), (tooth, Side::Right, right.is_err())]);
    let unsettled = sides.filter(|of| of.2).map(|(tooth, side, _)| (tooth, side)).collect();
    Crossings { teeth: found.into_iter().map(|tooth| tooth.map(|side| side.ok().flatten())).collect(), unsettled }
}

/// Allowances of all teeth between what an operation leaves and what the finishing one leaves.
pub fn allowances(operation: &[ToothCrossings], finished: &[ToothCrossings]) -> Vec<ToothAllowance> {
    let teeth = (1..).zip(operation.iter().zip(finished));
    teeth.map(|(tooth, (&[a, d], &[b, c]))| ToothAllowance { tooth, a, b, c, d }).collect()
}

/// delta_d tan(alpha): what the offset between an operation and finishing leaves on a straight rack along the pitch
/// line, mm.
pub fn rack_allowance_mm(job: &ShapingJob, operation: usize) -> f64 {
    (job.operations[operation].spec.offset_mm - job.finishing().spec.offset_mm)
        * job.transverse.pressure_angle_rad.tan()
}

/// Largest and mean of some percentages; `None` of none.
pub fn summarise(percents: impl IntoIterator<Item = Option<f64>>) -> Option<Unevenness> {
    let known: Vec<f64> = percents.into_iter().flatten().collect();
    (!known.is_empty()).then(|| Unevenness {
        max_percent: known.iter().copied().fold(0.0, f64::max),
        mean_percent: known.iter().sum::<f64>() / known.len() as f64,
    })
}
