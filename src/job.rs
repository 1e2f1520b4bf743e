//! What meshes, pictures, maps and texture ask of a job, whatever its process.
//!
//! In: a prepared job. Out: the target's profiles section by section, and surfaces of flanks and tips after all
//! operations. Every process answers in its own way; nothing behind this interface knows strokes or hobs.

use crate::cut::Backend;
use crate::dexel::Layer;
use crate::error::Result;
use crate::gear::PitchCurve;
use crate::gear::blank::Blank;
use crate::scene::Scene;
use crate::surface::SurfaceGrid;
use crate::surface::triangles::SectionProfile;
use crate::terms::Side;

/// How far below the target a ray records cuts, in modules: undercut and wrong linkages stay well inside.
pub const RAY_DEPTH_MODULES: f64 = 0.5;
/// How far above the target a ray can reach, in modules: half a pitch, where the neighbouring tooth begins.
pub const RAY_HEIGHT_MODULES: f64 = 0.5 * std::f64::consts::PI;
/// Root fields are coarser than flanks, at least so far apart along profile and tooth: roots carry no feed marks that
/// matter.
pub const ROOT_SPACING_MM: [f64; 2] = [0.02, 1.0];
/// Distance of tip rays along profile and tooth, mm.
pub const TIP_SPACING_MM: [f64; 2] = [0.02, 1.0];

/// A job that is ready to cut.
pub trait GearJob: Sync {
    /// The scene.
    fn scene(&self) -> &Scene;

    /// The pitch curve.
    fn curve(&self) -> &PitchCurve;

    /// The stock.
    fn blank(&self) -> &Blank;

    /// Name of every operation and how far its tool stays back from full depth, mm, in order; the last one finishes.
    fn operations(&self) -> Vec<(&str, f64)>;

    /// Passes of all operations.
    fn passes(&self) -> u32;

    /// Whether marks of an operation follow each other along the tooth. Where the axes rest during strokes a single
    /// mark runs along it without end.
    fn marks_follow_along_tooth(&self, operation: usize) -> bool;

    /// Length of a target flank's profile in the middle of the face, mm.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn profile_length_mm(&self, tooth: u32, side: Side) -> Result<f64>;

    /// Ends of the evaluated part of a profile, arcs from the form point, mm.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn evaluated_profile_mm(&self, tooth: u32, side: Side) -> Result<[f64; 2]>;

    /// Places along the tooth at which the target's sections say all of its shape: both ends of the face where it is
    /// straight.
    fn view_rows_z_mm(&self) -> Vec<f64>;

    /// Arcs from the form point about `spacing_mm` apart, and the target flank's profile there in every section of
    /// `rows_z_mm`.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn target_profiles(
        &self,
        tooth: u32,
        side: Side,
        spacing_mm: f64,
        rows_z_mm: &[f64],
    ) -> Result<(Vec<f64>, Vec<SectionProfile>)>;

    /// Root of the space after tooth `space` in every section of `rows_z_mm`, equally many points about `spacing_mm`
    /// apart, between the ends of its flanks.
    ///
    /// # Errors
    /// The tool generates no flank there.
    fn target_roots(&self, space: u32, spacing_mm: f64, rows_z_mm: &[f64]) -> Result<Vec<SectionProfile>>;

    /// What every operation left on a part of a flank: arcs from the form point times places along the tooth, mm.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    fn cut_flank(
        &self,
        backend: &dyn Backend,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_z_mm: &[f64],
    ) -> Result<Vec<Layer>>;

    /// Surface of a flank after all operations with all the dexels of the scene's spacing, no further than `reach_mm`
    /// from the middle of the face.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    fn flank_surface(&self, backend: &dyn Backend, tooth: u32, side: Side, reach_mm: f64) -> Result<SurfaceGrid>;

    /// Surface of the tip land of a tooth after all operations; `None` on a pointed tooth.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    fn tip_surface(&self, backend: &dyn Backend, tooth: u32) -> Result<Option<SurfaceGrid>>;
}

/// Places evenly over a face of `width_mm` about `spacing_mm` apart, both ends included.
pub fn rows_z_mm(width_mm: f64, spacing_mm: f64) -> Vec<f64> {
    let intervals = (width_mm / spacing_mm).round().max(1.0) as usize;
    (0..=intervals).map(|i| width_mm * (i as f64 / intervals as f64 - 0.5)).collect()
}

/// Rows of `rows_z_mm` nearer to the middle of the face than `reach_mm`, and one at either side of that band.
pub fn band_mm(mut rows_z_mm: Vec<f64>, reach_mm: f64) -> Vec<f64> {
    rows_z_mm.retain(|z_mm| z_mm.abs() < reach_mm);
    rows_z_mm.insert(0, -reach_mm);
    rows_z_mm.push(reach_mm);
    rows_z_mm
}
