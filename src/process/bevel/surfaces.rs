//! Rays of flanks and what the shared steps ask of a bevel gear.
//!
//! All teeth have the same target, turned by the pitch: its rays are found once for each side, in space 0, and turned
//! to the tooth that is cut. Columns stand at shares of every row's own profile (see [`gearcut_core::bevel::flank`]),
//! arcs are those of the middle of the face.

use super::job::{BevelJob, index};
use crate::job::{CylindricalGear, GearJob, ToothFrame, rows_z_mm};
use crate::measure::cut_grid::{evaluated_face_mm, evaluated_mm};
use crate::scene::Scene;
use gearcut_core::bevel::face_mill::BladeKind;
use gearcut_core::cut::{Backend, CutLayers, CutStats, SweptBy, SweptField};
use gearcut_core::dexel::{FreeRays, Layer, Ray, SpatialField};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::frame::Rigid3;
use gearcut_core::math::roots::halve;
use gearcut_core::terms::Side;
use glam::DVec3;
use rayon::prelude::*;

/// How far below the target rays record cuts, in outer modules.
const RAY_DEPTH_MODULES: f64 = 0.25;
/// Halvings of the way to the blank's surface: from a millimetre down to a nanometre.
const SURFACE_HALVINGS: u32 = 20;

impl BevelJob {
    /// Places of the rays of a flank with the scene's spacing: along its profile and along the tooth, mm.
    pub fn places_mm(&self, side: Side) -> [Vec<f64>; 2] {
        let fields = self.scene.fields;
        let length_mm = self.target_of(side).length_mm();
        let columns = (length_mm / fields.profile_spacing_mm).round().max(1.0) as usize;
        let arcs_mm = (0..=columns).map(|i| length_mm * i as f64 / columns as f64).collect();
        // An even number of intervals, so that a row lies in the middle of the face.
        let width_mm = self.blank.face_width_mm;
        let half = (0.5 * width_mm / fields.lead_spacing_mm).round().max(1.0);
        [arcs_mm, rows_z_mm(width_mm, 0.5 * width_mm / half)]
    }

    /// Ends of the evaluated part of a flank: arcs, and places along the tooth, mm.
    pub fn evaluated_mm(&self, side: Side) -> [[f64; 2]; 2] {
        [evaluated_mm(self.target_of(side).length_mm(), [None; 2]), self.evaluated_face_mm()]
    }

    /// Rays of a flank with the scene's spacing.
    ///
    /// # Errors
    /// A place of the flank that the roll does not generate.
    pub fn rays(&self, tooth: u32, side: Side) -> Result<FreeRays, Refusal> {
        let kept = self.rays.get_or_init(|| {
            let of = |kind: BladeKind| {
                let side = if kind == self.left { Side::Left } else { Side::Right };
                let [arcs_mm, rows_mm] = self.places_mm(side);
                self.rays_in_space_0(side, &arcs_mm, &rows_mm)
            };
            Ok([of(BladeKind::Outside)?, of(BladeKind::Inside)?])
        });
        let kept = kept.as_ref().map_err(Clone::clone)?;
        let [arcs_mm, rows_mm] = self.places_mm(side);
        Ok(self.turned(&kept[self.kind_of(side).index()], tooth, side, [arcs_mm, rows_mm]))
    }

    /// Rays of a part of a flank: arcs from the form point in the middle of the face times places along the tooth, mm.
    ///
    /// # Errors
    /// A place of the flank that the roll does not generate.
    pub fn rays_over(&self, tooth: u32, side: Side, arcs_mm: Vec<f64>, rows_mm: Vec<f64>) -> Result<FreeRays, Refusal> {
        let rays = self.rays_in_space_0(side, &arcs_mm, &rows_mm)?;
        Ok(self.turned(&rays, tooth, side, [arcs_mm, rows_mm]))
    }

    /// Rays with the height of the blank's surface on each, in the gear frame of space 0, column after column.
    fn rays_in_space_0(&self, side: Side, arcs_mm: &[f64], rows_mm: &[f64]) -> Result<Vec<(Ray, f32)>, Refusal> {
        let target = self.target_of(side);
        let shares: Vec<f64> = arcs_mm.iter().map(|&arc_mm| target.share_at(arc_mm)).collect();
        let work_from_gear = self.gear_from_work.inverse();
        // Half of the narrowest part of the slot: farther out is what the other kind of blades leaves.
        let reach_mm = 0.5 * self.head.point_width_mm;
        let row = |&along_mm: &f64| {
            let row = target.row(along_mm)?;
            shares
                .iter()
                .map(|&share| {
                    let point = row.point(share)?;
                    let ray = Ray {
                        origin_mm: self.gear_from_work.point(point.point_mm),
                        normal: self.gear_from_work.direction(point.normal),
                    };
                    let holds = |height_mm: f64| {
                        let [distance_mm, over_mm] =
                            self.blank.cone_distance_and_height_mm(work_from_gear.point(ray.at(height_mm)));
                        over_mm <= self.blank.addendum_mm(distance_mm)
                    };
                    let blank_mm =
                        if holds(reach_mm) { reach_mm } else { halve(holds, 0.0, reach_mm, SURFACE_HALVINGS)[0] };
                    Ok((ray, blank_mm as f32))
                })
                .collect::<Result<Vec<_>, Refusal>>()
        };
        let rows: Vec<Vec<(Ray, f32)>> = rows_mm.par_iter().map(row).collect::<Result<_, _>>()?;
        Ok((0..arcs_mm.len()).flat_map(|column| rows.iter().map(move |row| row[column])).collect())
    }

    /// Rays of space 0 at the place of a tooth.
    fn turned(&self, rays: &[(Ray, f32)], tooth: u32, side: Side, [arcs_mm, rows_mm]: [Vec<f64>; 2]) -> FreeRays {
        let turn = index(self.space_of(tooth, side), self.blank.teeth);
        let low_mm = -RAY_DEPTH_MODULES * self.blank.outer_module_mm();
        let field = SpatialField::new(arcs_mm.len(), rows_mm.len(), low_mm, |column, row| {
            let (ray, blank_mm) = rays[column * rows_mm.len() + row];
            (placed(&turn, ray), f64::from(blank_mm))
        });
        FreeRays { field, arcs_mm, rows_mm }
    }

    /// A field that stands in a space, with the passes of all operations.
    pub fn swept(&self, space: u32, field: SpatialField) -> SweptField<'_> {
        let operations = (0..self.operations.len()).map(|operation| vec![self.slots.of(operation, space)]).collect();
        SweptField { field, operations, by: SweptBy::Candidates }
    }

    /// Runs all operations over a field that stands in a space.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_field(&self, backend: &dyn Backend, space: u32, field: &SpatialField) -> Result<(Vec<Layer>, CutStats)> {
        let CutLayers { layers, stats, .. } = self.swept(space, field.clone()).cut(backend)?;
        Ok((layers, stats))
    }
}

fn placed(turn: &Rigid3, ray: Ray) -> Ray {
    Ray { origin_mm: turn.point(ray.origin_mm), normal: turn.direction(ray.normal) }
}

impl GearJob for BevelJob {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Rows stand at cone distances, in no transverse section.
    fn cylindrical(&self) -> Option<&dyn CylindricalGear> {
        None
    }

    fn operations(&self) -> Vec<(&str, f64)> {
        self.operations.iter().map(|operation| (operation.spec.name.as_str(), operation.spec.offset_mm)).collect()
    }

    fn passes(&self) -> u32 {
        self.slots.count()
    }

    fn pass_time_s(&self, pass: u32) -> f64 {
        let [operation, slot] = self.slots.operation_and_slot(pass);
        let turned_rad = self.slots.turned_in_slot_rad(operation, slot as u32, pass);
        let operation = &self.operations[operation];
        operation.start_s + operation.cycle_s() * slot as f64 + turned_rad / operation.spec.head_speed_rad_per_s
    }

    /// Marks of blades lean across the flank; a head that plunges leaves none.
    fn marks_follow(&self, operation: usize) -> [bool; 2] {
        [!self.operations[operation].settings.plunges(); 2]
    }

    fn profile_length_mm(&self, _tooth: u32, side: Side) -> Result<f64> {
        Ok(self.target_of(side).length_mm())
    }

    fn evaluated_profile_mm(&self, _tooth: u32, side: Side) -> Result<[f64; 2]> {
        Ok(self.evaluated_mm(side)[0])
    }

    fn evaluated_face_mm(&self) -> [f64; 2] {
        evaluated_face_mm(self.blank.face_width_mm)
    }

    /// All teeth have the same flanks; marks differ by their phase alone.
    fn teeth_that_differ_most(&self) -> Vec<u32> {
        vec![1]
    }

    fn tooth_frame(&self, tooth: u32) -> ToothFrame {
        let turn = index(tooth - 1, self.blank.teeth);
        // The tooth stands half a pitch behind the space before it.
        let half = std::f64::consts::PI / f64::from(self.blank.teeth);
        let out = DVec3::new(half.cos(), half.sin(), 0.0);
        let (sin, cos) = self.blank.pitch_angle_rad.sin_cos();
        // The back is at -z: from the apex the pitch cone goes out and down, its normal leans up. Upwards is from the
        // heel to the toe, so that the left flank, counter-clockwise of the tooth, is to the left.
        let heel = turn.direction(sin * out - cos * DVec3::Z);
        let (front, along) = (turn.direction(cos * out + sin * DVec3::Z), -heel);
        let place_mm = self.blank.mean_cone_distance_mm() * heel;
        ToothFrame { place_mm, front, left: along.cross(front), along }
    }

    fn target_points(&self, tooth: u32, side: Side, arcs_mm: &[f64], rows_mm: &[f64]) -> Result<Vec<Vec<Ray>>> {
        let rays = self.rays_over(tooth, side, arcs_mm.to_vec(), rows_mm.to_vec())?;
        let row = |row| (0..arcs_mm.len()).map(|column| rays.field.ray(column, row)).collect();
        Ok((0..rows_mm.len()).map(row).collect())
    }

    fn cut_flank(
        &self,
        backend: &dyn Backend,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_mm: &[f64],
    ) -> Result<Vec<Layer>> {
        let rays = self.rays_over(tooth, side, arcs_mm.to_vec(), rows_mm.to_vec())?;
        Ok(self.cut_field(backend, self.space_of(tooth, side), &rays.field)?.0)
    }
}
