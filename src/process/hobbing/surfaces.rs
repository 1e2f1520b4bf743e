//! Surfaces of a hobbed gear, as meshes, pictures and texture ask for them.
//!
//! Everything stands section by section along the tooth, each section's rays turned with the helix. Roots are taken
//! along rays from the target's root to a point in the middle of the space: gashes are few, and what they leave in a
//! tight fillet stands higher than its normals can go before they cross. Tips are taken along the normals of the pitch
//! curve; they are cut only by a hob that tops the gear, and otherwise the blank's own surface stands there. The
//! linkage as printed destroys flanks and tips alike: the run makes no closed body of it.

use crate::job::{
    CylindricalGear, GearJob, RAY_DEPTH_MODULES, ROOT_SPACING_MM, TIP_SPACING_MM, ToolSection, ToothFrame,
    ToothSection, TrialBlank, rows_z_mm, teeth_of_extreme_radius,
};
use crate::measure::round_gear::{RoundGear, ToothEnds, is_round};
use crate::process::hobbing::cutter::HobCutter;
use crate::process::hobbing::linkage::marks::Marks;
use crate::process::hobbing::rack_root::RackRootPoint;
use crate::scene::Scene;
use crate::surface::SurfaceGrid;
use crate::surface::flanks::points_of_sections;
use crate::surface::triangles::SectionProfile;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::PlacedRays;
use gearcut_core::dexel::{BlankField, Layer, Ray, SpatialField};
use gearcut_core::error::Result;
use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use gearcut_core::tool::CuttingTool;
use glam::DVec2;
use std::f64::consts::PI;

/// Distance of the sections that show a helical gear's shape, mm: chords a micrometre off a helix of 20 deg on a radius
/// of 60 mm.
const VIEW_SECTION_MM: f64 = 5.0;

/// Passes over the blank in a trial, those that do not reach it included.
const TRIAL_PASSES: u32 = 1024;
/// Share of a root's length at either end over which its rays turn from the flank's normal to the middle of the space.
const BLEND_SHARE: f64 = 0.2;
/// Rays of a root end before the point in the middle of the space, where they meet.
const FOCUS_SHARE: f64 = 0.95;

impl GearJob for HobCutter<'_> {
    fn scene(&self) -> &Scene {
        &self.job.scene
    }

    fn operations(&self) -> Vec<(&str, f64)> {
        self.job.operations.iter().map(|o| (o.spec.name.as_str(), o.offset_mm)).collect()
    }

    fn passes(&self) -> u32 {
        self.operations.last().map_or(0, gearcut_core::passes::TurningPasses::end_pass)
    }

    fn pass_time_s(&self, pass: u32) -> f64 {
        let at = self.operations.partition_point(|set| set.end_pass() <= pass);
        let (set, operation) = (&self.operations[at], &self.job.operations[at]);
        let hob_rad = set.pass(pass - set.first_pass).tool_angle_rad;
        operation.actual.start_s() + operation.commanded().time_at_hob_angle(hob_rad)
    }

    /// Passes that a device takes at once, in the middle of the last operation.
    fn trial_blank(&self) -> Result<Option<TrialBlank<'_>>> {
        let Some(last) = self.operations.len().checked_sub(1) else { return Ok(None) };
        let sections = self.middle_sections(last, TRIAL_PASSES)?;
        let ids = self.operations[last].first_pass..self.operations[last].end_pass();
        let cut = move |backend: &dyn Backend, mut blank: BlankField| {
            backend.cut_blank_sweeps(&mut blank, &sections, ids.clone(), &|| true).map(drop)
        };
        Ok(Some(TrialBlank { uncut: self.job.blank_field()?, cut: Box::new(cut) }))
    }

    fn marks_follow(&self, _operation: usize) -> [bool; 2] {
        [true; 2] // every hob tooth cuts a facet that ends along the tooth, too
    }

    /// Next to each other stand what two gashes leave at the pitch line and what one hob tooth leaves in two turns of
    /// the work; where the shift crosses the profile, the feed still is the period along the tooth.
    fn mark_spacing_mm(&self) -> Option<[f64; 2]> {
        let job = self.job;
        if job.drawn.is_some() {
            return None;
        }
        let operation = job.finishing();
        let side = Side::Left;
        let marks = Marks { linkage: &operation.linkage, target: &job.target, hob: &job.hob, side };
        let (gash, space, _) = marks.nearest(1, job.scene.gear.teeth, 0.0);
        let roll_mm = marks.to_next_gash(gash, space).x.abs();
        let feed_mm = operation.plan.slide_feeds_mm.into_iter().fold(0.0, f64::max);
        Some([roll_mm * job.target.rack.pressure_angle_rad.sin(), feed_mm])
    }

    fn profile_length_mm(&self, tooth: u32, side: Side) -> Result<f64> {
        Ok(self.target(tooth, side)?.length_mm())
    }

    fn evaluated_profile_mm(&self, tooth: u32, side: Side) -> Result<[f64; 2]> {
        let target = self.target(tooth, side)?;
        Ok(self.evaluated_mm(target)[0])
    }

    fn rolls_mm(&self, tooth: u32, side: Side, arcs_mm: &[f64]) -> Result<Vec<f64>> {
        let target = self.target(tooth, side)?;
        Ok(arcs_mm.iter().map(|&arc_mm| target.roll_mm(arc_mm)).collect())
    }

    fn teeth_that_differ_most(&self) -> Vec<u32> {
        teeth_of_extreme_radius(&self.job.curve, self.job.scene.gear.teeth)
    }

    fn tooth_frame(&self, tooth: u32) -> ToothFrame {
        ToothFrame::of_cylinder(&self.job.blank, &self.job.scene.gear, tooth)
    }

    fn target_points(&self, tooth: u32, side: Side, arcs_mm: &[f64], rows_mm: &[f64]) -> Result<Vec<Vec<Ray>>> {
        self.target_in_space(tooth, side, arcs_mm, rows_mm)
    }

    fn cut_flank(
        &self,
        backend: &dyn Backend,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_z_mm: &[f64],
    ) -> Result<Vec<Layer>> {
        let rays = self.rays_over(self.target(tooth, side)?, arcs_mm.to_vec(), rows_z_mm.to_vec());
        Ok(self.cut_field(backend, &rays.field)?.0)
    }

    fn cylindrical(&self) -> Option<&dyn CylindricalGear> {
        Some(self)
    }
}

impl CylindricalGear for HobCutter<'_> {
    fn curve(&self) -> &PitchCurve {
        &self.job.curve
    }

    fn blank(&self) -> &Blank {
        &self.job.blank
    }

    fn round_gear(&self) -> Result<Option<RoundGear>> {
        // Sizes of involute teeth: a drawn tooth cuts others.
        if !is_round(&self.job.curve) || self.job.drawn.is_some() {
            return Ok(None);
        }
        let (gear, rack) = (&self.job.scene.gear, &self.job.target.rack);
        let diameter_mm = |height_mm: f64| gear.transverse_module_mm() * f64::from(gear.teeth) + 2.0 * height_mm;
        let form_mm = self.target(1, Side::Left)?.middle_form_height_mm;
        let involute_mm = [form_mm, self.job.blank.addendum_mm].map(diameter_mm);
        let root_mm = diameter_mm(-rack.tip_height_mm);
        let thickness_mm = PI * rack.transverse_module_mm - 2.0 * rack.half_thickness_mm;
        let round = RoundGear::new(gear, ToothEnds { root_mm, involute_mm }, thickness_mm);
        Ok(Some(RoundGear { tip_diameter_mm: involute_mm[1], ..round }))
    }

    fn view_rows_z_mm(&self) -> Vec<f64> {
        let gear = &self.job.scene.gear;
        let spacing_mm = if gear.helix_angle_rad == 0.0 { f64::INFINITY } else { VIEW_SECTION_MM };
        rows_z_mm(gear.face_width_mm, spacing_mm)
    }

    fn target_profiles(
        &self,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_z_mm: &[f64],
    ) -> Result<Vec<SectionProfile>> {
        let target = self.target(tooth, side)?;
        let shares: Vec<f64> = arcs_mm.iter().map(|&arc| target.share_at(arc)).collect();
        let profile = |&z_mm: &f64| {
            let section = target.section(z_mm);
            shares.iter().map(|&share| section.ray(share)).map(|ray| (ray.origin_mm.truncate(), ray.normal)).collect()
        };
        Ok(rows_z_mm.iter().map(profile).collect())
    }

    fn target_roots(&self, space: u32, spacing_mm: f64, rows_z_mm: &[f64]) -> Result<Vec<SectionProfile>> {
        let roots = self.roots(space, spacing_mm, rows_z_mm)?;
        Ok(roots
            .into_iter()
            .map(|root| root.into_iter().map(|point| (point.point_mm, point.normal.extend(0.0))).collect())
            .collect())
    }

    fn cut_root(
        &self,
        backend: &dyn Backend,
        space: u32,
        spacing_mm: f64,
        rows_z_mm: &[f64],
    ) -> Result<Vec<Vec<DVec2>>> {
        let rays = self.root_rays(space, spacing_mm, rows_z_mm)?;
        let (layers, _) = self.cut_field(backend, &rays.field)?;
        Ok(points_of_sections(&rays, &layers))
    }

    fn target_section(&self, tooth: u32, z_mm: f64, spacing_mm: f64) -> Result<ToothSection> {
        Ok(self.job.tooth_section(tooth, z_mm, spacing_mm))
    }

    fn tool_section(&self, chord_mm: f64) -> ToolSection {
        let hob = &self.job.hob;
        let in_section = |p: DVec2| DVec2::new(-p.y, p.x - hob.pitch_radius_mm);
        let words = "edge of one hob tooth in its rake face, x along the hob's axis, y away from it, origin on the \
            pitch cylinder in the middle of the tooth";
        ToolSection {
            points_mm: hob.edge_of(0).points_mm(chord_mm).into_iter().map(in_section).collect(),
            is_closed: false,
            words: words.to_owned(),
        }
    }

    fn errors_vary_along_tooth(&self) -> bool {
        self.job.errors.vary_along_feed() || self.job.operations.iter().any(|operation| operation.program.is_some())
    }

    fn tip_surface(&self, backend: &dyn Backend, tooth: u32) -> Result<Option<SurfaceGrid>> {
        let job = self.job;
        let rows_z_mm = rows_z_mm(job.scene.gear.face_width_mm, TIP_SPACING_MM[1]);
        let flanks = [self.target(tooth, Side::Right)?, self.target(tooth, Side::Left)?];
        // Ends of the tip land in every section, as arcs of the pitch curve.
        let ends: Vec<[f64; 2]> = rows_z_mm
            .iter()
            .map(|&z_mm| {
                flanks.map(|flank| {
                    let tip_mm = flank.section(z_mm).ray(1.0).origin_mm.truncate();
                    job.curve.arc_mm(job.blank.height(tip_mm, tip_mm.to_angle()).1)
                })
            })
            .map(|[from, to]| [from, from + (to - from).rem_euclid(job.curve.perimeter_mm())])
            .collect();
        let widths = ends.iter().map(|[from, to]| to - from);
        // Flanks that have crossed leave nearly a whole turn between them.
        if widths.clone().fold(0.0, f64::max) > 0.5 * job.curve.perimeter_mm() {
            return Ok(None);
        }
        let count = (widths.fold(f64::INFINITY, f64::min) / TIP_SPACING_MM[0]).floor();
        if count < 2.0 {
            return Ok(None);
        }
        let share = |column: usize| (column as f64 + 0.5) / count;
        let field = self.field(count as usize, &rows_z_mm, |column, row| {
            let [from, to] = ends[row];
            let frame = job.curve.frame(job.curve.phi_at_arc(from + (to - from) * share(column)));
            (frame.point_mm, frame.normal, job.stock.addendum_mm)
        });
        let [from, to] = ends[ends.len() / 2];
        let arcs_mm = (0..count as usize).map(|column| (to - from) * share(column)).collect();
        let rays = PlacedRays { field, arcs_mm, rows_z_mm };
        let spacing_mm = job.scene.output.mesh_spacing_mm;
        // A hob whose roots stay outside of the blank has no edge that reaches a tip land: roots come nearest where
        // they pass the pitch point.
        if job.tops_the_gear() {
            return self.surface(backend, &rays, spacing_mm).map(Some);
        }
        Ok(Some(SurfaceGrid::new(&rays, &[rays.field.blank_layer()], spacing_mm)))
    }
}

impl HobCutter<'_> {
    /// Surface of the root of a space (space j lies after tooth j) after all operations.
    ///
    /// # Errors
    /// The hob generates no flank there; the backend's.
    pub fn root_surface(&self, backend: &dyn Backend, space: u32) -> Result<SurfaceGrid> {
        let fields = self.job.scene.fields;
        let rows_z_mm = rows_z_mm(self.job.scene.gear.face_width_mm, fields.lead_spacing_mm.max(ROOT_SPACING_MM[1]));
        let rays = self.root_rays(space, fields.profile_spacing_mm.max(ROOT_SPACING_MM[0]), &rows_z_mm)?;
        self.surface(backend, &rays, self.job.scene.output.mesh_spacing_mm)
    }

    /// Rays from the root of a space, points about `spacing_mm` apart in every section, to the middle of the space.
    ///
    /// # Errors
    /// The hob generates no flank there.
    pub fn root_rays(&self, space: u32, spacing_mm: f64, rows_z_mm: &[f64]) -> Result<PlacedRays> {
        let roots = self.roots(space, spacing_mm, rows_z_mm)?;
        let target = &self.job.target;
        // In every section a point in the middle of the space, half way from the pitch line down, or half a module over
        // the root where a profile shift lifts it.
        let tip_mm = target.rack.tip_height_mm;
        let depth_mm = tip_mm - 0.5 * tip_mm.max(target.rack.transverse_module_mm);
        let focus: Vec<DVec2> = rows_z_mm
            .iter()
            .map(|&z_mm| {
                let arc_mm = target.space_arc_mm(i64::from(space), z_mm);
                let frame = self.job.curve.frame(self.job.curve.phi_at_arc(arc_mm));
                frame.point_mm - depth_mm * frame.normal
            })
            .collect();
        let field = self.field(roots[0].len(), rows_z_mm, |column, row| {
            let root = &roots[row];
            let (point, last) = (root[column], root[root.len() - 1]);
            let to_focus = focus[row] - point.point_mm;
            // At both ends rays begin as the flanks' own, so that root and flank join in one point.
            let [before, after] = [point.arc_mm, last.arc_mm - point.arc_mm];
            let end_normal = if before < after { root[0].normal } else { last.normal };
            let share = (before.min(after) / (BLEND_SHARE * last.arc_mm)).min(1.0);
            let direction = end_normal.lerp(to_focus.normalize_or(point.normal), share);
            (point.point_mm, direction.normalize_or(point.normal), FOCUS_SHARE * to_focus.length())
        });
        let arcs_mm = roots[roots.len() / 2].iter().map(|point| point.arc_mm).collect();
        Ok(PlacedRays { field, arcs_mm, rows_z_mm: rows_z_mm.to_vec() })
    }

    /// Root of the space after tooth `space` in every section.
    fn roots(&self, space: u32, spacing_mm: f64, rows_z_mm: &[f64]) -> Result<Vec<Vec<RackRootPoint>>> {
        let job = self.job;
        let after = space % job.scene.gear.teeth + 1;
        let starts = [self.target(space, Side::Left)?.form_roll_mm, self.target(after, Side::Right)?.form_roll_mm];
        let root = |z_mm: f64, count| match &job.drawn {
            Some(rack) => rack.root(i64::from(space), z_mm, count),
            None => job.target.root(&job.blank, i64::from(space), starts, z_mm, count),
        };
        let length_mm = root(0.0, 2)[1].arc_mm;
        let count = (length_mm / spacing_mm).ceil().max(8.0) as usize + 1;
        if job.target.is_straight() {
            return Ok(vec![root(0.0, count); rows_z_mm.len()]);
        }
        Ok(rows_z_mm.iter().map(|&z_mm| root(z_mm, count)).collect())
    }

    /// Rays across the gear's axis: origin, direction and height of the blank of each.
    fn field(
        &self,
        columns: usize,
        rows_z_mm: &[f64],
        ray: impl Fn(usize, usize) -> (DVec2, DVec2, f64),
    ) -> SpatialField {
        let low_mm = -RAY_DEPTH_MODULES * self.job.scene.gear.module_mm;
        SpatialField::new(columns, rows_z_mm.len(), low_mm, |column, row| {
            let (origin, normal, blank_mm) = ray(column, row);
            (Ray { origin_mm: origin.extend(rows_z_mm[row]), normal: normal.extend(0.0) }, blank_mm)
        })
    }

    fn surface(&self, backend: &dyn Backend, rays: &PlacedRays, spacing_mm: f64) -> Result<SurfaceGrid> {
        let (layers, _) = self.cut_field(backend, &rays.field)?;
        Ok(SurfaceGrid::new(rays, &layers, spacing_mm))
    }
}
