//! Allowances AB and CD of every tooth and their unevenness (Gao et al. 2017, Fig. 9 and Eq. 14).
//!
//! The equation's print is lost. Two denominators fit the paper's figures about equally well, so both are always given,
//! by name: the **mean** of AB and CD, `|AB - CD| / ((AB + CD) / 2)`, and the **rack** allowance,
//! `|AB - CD| / (delta_d tan(alpha))`, what the offset delta_d leaves on a straight rack.

use super::crossing::{envelope_crossing, stroke_crossing};
use crate::error::Result;
use crate::measure::crossing::Crossing;
use crate::process::shaping::Job;
use crate::terms::Side;
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
pub enum Surface {
    /// The limit of infinitely many strokes.
    Envelope,
    /// What the strokes leave in the middle of the face.
    Strokes,
}

impl ToothAllowance {
    /// Chord AB, mm.
    pub fn ab_mm(&self) -> Option<f64> {
        Some(self.a?.point_mm.distance(self.b?.point_mm))
    }

    /// Chord CD, mm.
    pub fn cd_mm(&self) -> Option<f64> {
        Some(self.c?.point_mm.distance(self.d?.point_mm))
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

/// Allowances of all teeth between an operation and the finishing one.
///
/// # Errors
/// No flank is generated on some tooth, or what the strokes leave on one is not found.
pub fn allowances(job: &Job, operation: usize, surface: Surface) -> Result<Vec<ToothAllowance>> {
    let finishing = job.operations.len() - 1;
    let (rough, finish) = (job.generation(operation), job.target_generation());
    (1..=job.scene.gear.teeth)
        .into_par_iter()
        .map(|tooth| {
            let pair = |side: Side| -> Result<_> {
                let target = envelope_crossing(job, &finish, tooth, side);
                Ok(match surface {
                    Surface::Envelope => (envelope_crossing(job, &rough, tooth, side), target),
                    Surface::Strokes => {
                        let at = |operation| match target {
                            Some(start) => stroke_crossing(job, operation, side, start),
                            None => Ok(None),
                        };
                        (at(operation)?, at(finishing)?)
                    }
                })
            };
            let ((a, b), (d, c)) = (pair(Side::Left)?, pair(Side::Right)?);
            Ok(ToothAllowance { tooth, a, b, c, d })
        })
        .collect()
}

/// delta_d tan(alpha): what the offset between an operation and finishing leaves on a straight rack along the pitch
/// line, mm.
pub fn rack_allowance_mm(job: &Job, operation: usize) -> f64 {
    (job.operations[operation].spec.offset_mm - job.finishing().spec.offset_mm)
        * job.scene.gear.pressure_angle_rad.tan()
}

/// Largest and mean of some percentages; `None` of none.
pub fn summarise(percents: impl IntoIterator<Item = Option<f64>>) -> Option<Unevenness> {
    let known: Vec<f64> = percents.into_iter().flatten().collect();
    (!known.is_empty()).then(|| Unevenness {
        max_percent: known.iter().copied().fold(0.0, f64::max),
        mean_percent: known.iter().sum::<f64>() / known.len() as f64,
    })
}
