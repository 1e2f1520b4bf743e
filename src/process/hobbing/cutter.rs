//! Cutting a hobbing job: the passes of all operations, the dexel field of every flank.
//!
//! In: [`HobbingJob`]. Out: fields and layers, one flank at a time, so that memory does not grow with the number of
//! teeth. Passes and the targets that somebody has asked for stay with the job, which makes them once.

use super::HobbingJob;
use crate::job::{RAY_DEPTH_MODULES, RAY_HEIGHT_MODULES, rows_z_mm};
use crate::measure::cut_grid::{evaluated_face_mm, evaluated_mm};
use crate::process::hobbing::flank_patch::FlankPatch;
use crate::process::hobbing::kept::ForeseenChip;
use gearcut_core::cut::{Backend, CutLayers, CutStats, SweptBy, SweptField};
use gearcut_core::dexel::PlacedRays;
use gearcut_core::dexel::{Layer, SpatialField};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::passes::TurningPasses;
use gearcut_core::terms::Side;
use std::borrow::Cow;

/// Places along profile and tooth at which the blank's height over the flank is taken; between them it is bilinear: it
/// matters only where nothing cuts.
const BLANK_PLACES: usize = 17;

/// A hobbing job with the passes of its operations.
pub struct HobCutter<'a> {
    /// The job.
    pub job: &'a HobbingJob,
    /// Passes of every operation, numbered on from one to the next.
    pub operations: Cow<'a, [TurningPasses]>,
}

/// One flank after all operations.
#[derive(Debug)]
pub struct HobbedFlank<'a> {
    /// The target.
    pub target: &'a FlankPatch,
    /// Rays; columns stand at arcs of the middle section.
    pub rays: PlacedRays,
    /// Ends of its evaluated part: arcs, and places along the tooth, mm.
    pub evaluated_mm: [[f64; 2]; 2],
    /// What each operation left, in order.
    pub layers: Vec<Layer>,
    /// What the backend met.
    pub stats: CutStats,
}

impl<'a> HobCutter<'a> {
    /// The cutter of a job; the job makes the passes when the first one asks for them.
    ///
    /// # Errors
    /// More passes than can be numbered.
    pub fn new(job: &'a HobbingJob) -> Result<Self> {
        let kept = job.kept()?;
        Ok(Self { job, operations: Cow::Borrowed(&kept.operations) })
    }

    /// Target flank of a tooth.
    ///
    /// # Errors
    /// The hob generates no flank there.
    pub fn target(&self, tooth: u32, side: Side) -> Result<&FlankPatch, Refusal> {
        let job = self.job;
        let face_width_mm = job.scene.gear.face_width_mm;
        let find = || match &job.drawn {
            Some(rack) => FlankPatch::drawn(rack, tooth, side, face_width_mm),
            None => FlankPatch::new(&job.target, &job.blank, tooth, side, face_width_mm),
        };
        job.targets.of(tooth, side, find)
    }

    /// The thickest chips that are known before the cut, found by `find` if nobody has asked for them yet.
    ///
    /// # Errors
    /// Those of `find`.
    pub fn foreseen_chips(
        &self,
        find: impl FnOnce() -> Result<Vec<Option<ForeseenChip>>>,
    ) -> Result<&'a [Option<ForeseenChip>]> {
        self.job.kept()?.foreseen_chips(find)
    }

    /// Arcs of a target's profile, in the middle of the face, at the heights between which the scene evaluates it, mm;
    /// `None` where the scene names no height, or the flank does not reach it.
    pub fn measured_ends_mm(&self, target: &FlankPatch) -> [Option<f64>; 2] {
        self.job.scene.measure.ends_mm(|height_mm| target.arc_at_height_mm(&self.job.blank, height_mm))
    }

    /// Ends of the evaluated part of a flank: arcs, and places along the tooth, mm.
    pub fn evaluated_mm(&self, target: &FlankPatch) -> [[f64; 2]; 2] {
        let profile_mm = evaluated_mm(target.length_mm(), self.measured_ends_mm(target));
        [profile_mm, evaluated_face_mm(self.job.scene.gear.face_width_mm)]
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
                let exit = job.stock.exit_mm(point, across / lean, point.to_angle(), 0.0, limit_mm);
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

    /// A field with the passes of all operations.
    pub fn swept(&self, field: SpatialField) -> SweptField<'_> {
        let operations = self.operations.iter().map(|passes| vec![passes]).collect();
        SweptField { field, operations, by: SweptBy::Candidates }
    }

    /// Runs all operations over a field.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_field(&self, backend: &dyn Backend, field: &SpatialField) -> Result<(Vec<Layer>, CutStats)> {
        let CutLayers { layers, stats, .. } = self.swept(field.clone()).cut(backend)?;
        Ok((layers, stats))
    }

    /// Cuts one flank through all operations.
    ///
    /// # Errors
    /// A flank without a target, the backend's.
    #[cfg(feature = "testing")]
    pub fn cut(&self, backend: &dyn Backend, tooth: u32, side: Side) -> Result<HobbedFlank<'_>> {
        let field = self.rays(tooth, side)?.1.field;
        let left = self.swept(field.clone()).cut(backend)?;
        self.flank(tooth, side, field, left)
    }

    /// A flank whose field is cut.
    ///
    /// # Errors
    /// A flank without a target.
    pub fn flank(&self, tooth: u32, side: Side, field: SpatialField, left: CutLayers) -> Result<HobbedFlank<'_>> {
        let target = self.target(tooth, side)?;
        let [arcs_mm, rows_z_mm] = self.places_mm(target);
        let evaluated_mm = self.evaluated_mm(target);
        let CutLayers { layers, stats, .. } = left;
        let rays = PlacedRays { field, arcs_mm, rows_z_mm };
        Ok(HobbedFlank { target, rays, evaluated_mm, layers, stats })
    }
}
