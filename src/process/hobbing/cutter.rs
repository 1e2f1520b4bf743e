//! Cutting a hobbing job: the passes of all operations, the dexel field of every flank.
//!
//! In: [`HobbingJob`]. Out: fields and layers, one flank at a time, so that memory does not grow with the number of
//! teeth. Of every flank only the target stays, once somebody has asked for it: some ten kilobytes of polynomials,
//! found by nested searches that take longer than a thousand dexels.

use super::HobbingJob;
use crate::cut::{Backend, CutStats};
use crate::dexel::PlacedRays;
use crate::dexel::{Layer, SpatialField};
use crate::error::{Refusal, Result};
use crate::job::{RAY_DEPTH_MODULES, RAY_HEIGHT_MODULES, rows_z_mm};
use crate::passes::{MotionTable, SweepPlan, TurningPasses};
use crate::process::hobbing::flank_patch::FlankPatch;
use crate::terms::Side;
use crate::tool::SpatialTool;
use std::sync::OnceLock;

/// Places along profile and tooth at which the blank's height over the flank is taken; between them it is bilinear: it
/// matters only where nothing cuts.
const BLANK_PLACES: usize = 17;

/// A hobbing job with the passes of its operations.
pub struct HobCutter<'a> {
    /// The job.
    pub job: &'a HobbingJob,
    /// Passes of every operation, numbered on from one to the next.
    pub operations: Vec<TurningPasses>,
    /// Targets that were asked for: left and right flank of tooth 1, then of tooth 2 and so on.
    targets: Vec<OnceLock<Result<FlankPatch, Refusal>>>,
}

/// One flank after all operations.
#[derive(Debug)]
pub struct HobbedFlank<'a> {
    /// The target.
    pub target: &'a FlankPatch,
    /// Rays; columns stand at arcs of the middle section.
    pub rays: PlacedRays,
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
            let beyond_rad = job.hob.half_sweep_rad();
            let range_rad = [hob_at(0.0) - beyond_rad, hob_at(linkage.end_s()) + beyond_rad];
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
            let passes = TurningPasses::new(first_pass, &job.hob, job.hob.hand, motion);
            first_pass = passes.end_pass();
            operations.push(passes);
        }
        let targets = (0..2 * job.scene.gear.teeth).map(|_| OnceLock::new()).collect();
        Ok(Self { job, operations, targets })
    }

    /// Target flank of a tooth.
    ///
    /// # Errors
    /// The hob generates no flank there.
    pub fn target(&self, tooth: u32, side: Side) -> Result<&FlankPatch, Refusal> {
        let job = self.job;
        let place = 2 * (tooth as usize - 1) + usize::from(side == Side::Right);
        let find = || FlankPatch::new(&job.target, &job.blank, tooth, side, job.scene.gear.face_width_mm);
        self.targets[place].get_or_init(find).as_ref().map_err(Clone::clone)
    }

    /// Places of the rays of a flank with the scene's spacing: along its profile and along the tooth, mm.
    pub fn places_mm(&self, target: &FlankPatch) -> [Vec<f64>; 2] {
        let fields = self.job.scene.fields;
        let length_mm = target.length_mm();
        let columns = (length_mm / fields.profile_spacing_mm).round().max(1.0) as usize;
        let arcs_mm = (0..=columns).map(|i| length_mm * i as f64 / columns as f64).collect();
        [arcs_mm, rows_z_mm(self.job.scene.gear.face_width_mm, fields.lead_spacing_mm)]
    }

    /// Rays of a flank with the scene's spacing.
    ///
    /// # Errors
    /// A flank without a target.
    pub fn rays(&self, tooth: u32, side: Side) -> Result<(&FlankPatch, PlacedRays), Refusal> {
        let target = self.target(tooth, side)?;
        let [arcs_mm, rows_z_mm] = self.places_mm(target);
        Ok((target, self.rays_over(target, arcs_mm, rows_z_mm)))
    }

    /// Rays of a part of a flank: places along the profile, arcs of the middle section from where the patch begins, and
    /// along the tooth, mm.
    pub fn rays_over(&self, target: &FlankPatch, arcs_mm: Vec<f64>, rows_z_mm: Vec<f64>) -> PlacedRays {
        let job = self.job;
        let gear = &job.scene.gear;
        let width_mm = gear.face_width_mm;
        // The stock is taken as long as the rays need it: at the faces, where normals lean out of it, only the surface
        // counts.
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
        let sections: Vec<_> = rows_z_mm.iter().map(|&z_mm| target.section(z_mm)).collect();
        let low_mm = -RAY_DEPTH_MODULES * gear.module_mm;
        let field = SpatialField::new(arcs_mm.len(), rows_z_mm.len(), low_mm, |column, row| {
            (sections[row].ray(shares[column]), blank_at(shares[column], rows_z_mm[row] / width_mm + 0.5))
        });
        PlacedRays { field, arcs_mm, rows_z_mm }
    }

    /// Runs all operations over a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_field(&self, backend: &dyn Backend, field: &SpatialField) -> Result<(Vec<Layer>, CutStats)> {
        let mut layers: Vec<Layer> = Vec::with_capacity(self.operations.len());
        let mut stats = CutStats::default();
        for passes in &self.operations {
            let plan = SweepPlan::new(field, passes);
            let mut layer = layers.last().cloned().unwrap_or_else(|| field.blank_layer());
            stats += backend.cut_spatial(field, &plan, &mut layer)?;
            layers.push(layer);
        }
        Ok((layers, stats))
    }

    /// Cuts one flank through all operations.
    ///
    /// # Errors
    /// A flank without a target, the backend's.
    pub fn cut(&self, backend: &dyn Backend, tooth: u32, side: Side) -> Result<HobbedFlank<'_>> {
        let (target, rays) = self.rays(tooth, side)?;
        let (layers, stats) = self.cut_field(backend, &rays.field)?;
        Ok(HobbedFlank { target, rays, layers, stats })
    }
}
