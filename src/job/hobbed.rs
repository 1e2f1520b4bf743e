//! Cutting a hobbing job: the passes of all operations, the dexel field of every flank.
//!
//! In: [`HobbingJob`]. Out: fields and layers, one flank at a time, so that memory does not grow with the number of teeth.

use super::HobbingJob;
use crate::cut::{Backend, CutStats};
use crate::dexel::{Layer, SpatialField};
use crate::error::{Error, Refusal, Result};
use crate::gear::flank_patch::FlankPatch;
use crate::gear::generation::Side;
use crate::passes::hob_teeth::SWEEP_RAD;
use crate::passes::{HobTeeth, MotionTable, SweepPlan};
use crate::tool::CuttingTool;
use std::f64::consts::PI;

/// How far below the target a ray records cuts, in modules.
const RAY_DEPTH_MODULES: f64 = 0.5;
/// How far above the target a ray can reach, in modules: half a pitch, where the neighbouring tooth begins.
const RAY_HEIGHT_MODULES: f64 = 0.5 * PI;
/// Places along profile and tooth at which the blank's height over the flank is taken; between them it is bilinear: it matters only where nothing cuts.
const BLANK_PLACES: usize = 17;

/// A hobbing job with the passes of its operations.
pub struct HobCutter<'a> {
    /// The job.
    pub job: &'a HobbingJob,
    /// Passes of every operation, numbered on from one to the next.
    pub operations: Vec<HobTeeth>,
}

/// One flank after all operations.
#[derive(Debug)]
pub struct HobbedFlank {
    /// The target.
    pub target: FlankPatch,
    /// Rays.
    pub field: SpatialField,
    /// Places of the columns along the profile, mm, in the mean section.
    pub arcs_mm: Vec<f64>,
    /// Places of the rows along the tooth from the middle of the face, mm.
    pub leads_mm: Vec<f64>,
    /// What each operation left, in order.
    pub layers: Vec<Layer>,
    /// What the backend met.
    pub stats: CutStats,
}

impl<'a> HobCutter<'a> {
    /// Passes of all operations.
    ///
    /// # Errors
    /// More passes than can be numbered.
    pub fn new(job: &'a HobbingJob) -> Result<Self> {
        let mut operations = Vec::new();
        let mut first_pass = 0;
        for operation in &job.operations {
            let linkage = &operation.linkage;
            let hob_at = |time_s: f64| linkage.axes::<1>(time_s).hob_rad.value();
            // Sweeps reach a little further than the moments at which their blades point to the work.
            let range_rad = [hob_at(0.0) - SWEEP_RAD, hob_at(linkage.end_s()) + SWEEP_RAD];
            if f64::from(first_pass) + job.passes(operation) >= f64::from(u32::MAX) {
                return Err(Refusal::new(
                    "operation.axial_feed_mm_per_revolution",
                    format!("operation {} has more passes than can be numbered", operation.spec.name),
                    "use a larger feed or fewer gashes",
                )
                .into());
            }
            let corners: Vec<f64> = linkage.corners_s().iter().map(|&time_s| hob_at(time_s)).collect();
            let motion = MotionTable::new(range_rad, &corners, |angle| linkage.head_from_work(angle));
            let passes = HobTeeth::new(first_pass, &job.hob, job.hob.hand, motion);
            first_pass = passes.end_pass();
            operations.push(passes);
        }
        Ok(Self { job, operations })
    }

    /// Rays of a flank with the scene's spacing: target, field, places along profile and tooth.
    ///
    /// # Errors
    /// A flank without a target.
    pub fn field(&self, tooth: u32, side: Side) -> Result<(FlankPatch, SpatialField, [Vec<f64>; 2]), Refusal> {
        let job = self.job;
        let gear = &job.scene.gear;
        let width_mm = gear.face_width_mm;
        let target = FlankPatch::new(&job.target, &job.blank, tooth, side, width_mm)?;
        let fields = job.scene.fields;
        let length_mm = target.length_mm();
        let intervals = |length: f64, spacing: f64| (length / spacing).round().max(1.0) as usize;
        let columns = intervals(length_mm, fields.profile_spacing_mm);
        let rows = intervals(width_mm, fields.lead_spacing_mm);
        let arcs_mm: Vec<f64> = (0..=columns).map(|i| length_mm * i as f64 / columns as f64).collect();
        let leads_mm: Vec<f64> = (0..=rows).map(|i| width_mm * (i as f64 / rows as f64 - 0.5)).collect();
        // The stock is taken as long as the rays need it: at the faces, where normals lean out of it, only the surface counts.
        let limit_mm = RAY_HEIGHT_MODULES * gear.module_mm;
        let last = BLANK_PLACES - 1;
        let exits: Vec<f64> = (0..BLANK_PLACES * BLANK_PLACES)
            .map(|i| {
                let section = target.section(width_mm * ((i % BLANK_PLACES) as f64 / last as f64 - 0.5));
                let ray = section.ray((i / BLANK_PLACES) as f64 / last as f64);
                let across = ray.normal.truncate();
                let (lean, point) = (across.length(), ray.origin_mm.truncate());
                let exit = job.blank.exit_mm(point, across / lean, point.to_angle(), 0.0, limit_mm);
                (exit / lean).min(limit_mm)
            })
            .collect();
        let blank_at = |share: f64, along: f64| {
            let [x, y] = [share, along].map(|v| v * last as f64);
            let [i, j] = [x, y].map(|v| (v as usize).min(last - 1));
            let (p, q) = (x - i as f64, y - j as f64);
            let at = |i: usize, j: usize| exits[i * BLANK_PLACES + j];
            (1.0 - p) * ((1.0 - q) * at(i, j) + q * at(i, j + 1))
                + p * ((1.0 - q) * at(i + 1, j) + q * at(i + 1, j + 1))
        };
        let shares: Vec<f64> = arcs_mm.iter().map(|&arc| target.share_at(arc)).collect();
        let sections: Vec<_> = leads_mm.iter().map(|&lead| target.section(lead)).collect();
        let low_mm = -RAY_DEPTH_MODULES * gear.module_mm;
        let field = SpatialField::new(columns + 1, rows + 1, low_mm, |column, row| {
            (sections[row].ray(shares[column]), blank_at(shares[column], row as f64 / rows as f64))
        });
        Ok((target, field, [arcs_mm, leads_mm]))
    }

    /// Cuts one flank through all operations.
    ///
    /// # Errors
    /// A flank without a target, the backend's.
    pub fn cut(&self, backend: &dyn Backend, tooth: u32, side: Side) -> Result<HobbedFlank, Error> {
        let (target, field, [arcs_mm, leads_mm]) = self.field(tooth, side)?;
        let mut layers: Vec<Layer> = Vec::with_capacity(self.operations.len());
        let mut stats = CutStats::default();
        for passes in &self.operations {
            let plan = SweepPlan::new(&field, passes, self.job.hob.edge());
            let mut layer = layers.last().cloned().unwrap_or_else(|| field.blank_layer());
            stats += backend.cut_spatial(&field, self.job.hob.edge(), &plan, &mut layer)?;
            layers.push(layer);
        }
        Ok(HobbedFlank { target, field, arcs_mm, leads_mm, layers, stats })
    }
}
