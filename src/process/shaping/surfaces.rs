//! Surfaces of a shaped gear, as meshes, pictures and texture ask for them.
//!
//! Roots and tips are coarse fields of their own: roots along the normals of the target's fillet, tips along the
//! normals of the blank's outline, from the pitch curve up. A tip ray that no pass reached says that the blank's own
//! surface stands there; where the cutter's base has cut the tips down, or a window left a tooth alone, it says that
//! too.

use crate::cut::Backend;
use crate::dexel::{Column, Field, Layer};
use crate::error::Result;
use crate::gear::PitchCurve;
use crate::gear::blank::Blank;
use crate::job::{GearJob, TIP_SPACING_MM, band_mm, leads_mm};
use crate::process::shaping::job::Job;
use crate::process::shaping::measure::flank_report;
use crate::process::shaping::target::target_root;
use crate::scene::Scene;
use crate::surface::SurfaceGrid;
use crate::surface::triangles::Profile;
use crate::terms::Side;

impl GearJob for Job {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn curve(&self) -> &PitchCurve {
        &self.curve
    }

    fn blank(&self) -> &Blank {
        &self.blank
    }

    fn operations(&self) -> Vec<(&str, f64)> {
        self.operations.iter().map(|o| (o.spec.name.as_str(), o.spec.offset_mm)).collect()
    }

    fn passes(&self) -> u32 {
        self.operations.last().map_or(0, |operation| operation.strokes.end_pass())
    }

    fn marks_follow_along_tooth(&self, operation: usize) -> bool {
        self.operations[operation].spec.feed_during_stroke
    }

    fn profile_length_mm(&self, tooth: u32, side: Side) -> Result<f64> {
        let generation = self.target_generation();
        Ok(self.target_flank(&generation, tooth, side)?.length_mm())
    }

    fn evaluated_profile_mm(&self, tooth: u32, side: Side) -> Result<[f64; 2]> {
        let generation = self.target_generation();
        Ok(flank_report::evaluated_profile_mm(self, &self.target_flank(&generation, tooth, side)?))
    }

    fn view_leads_mm(&self) -> Vec<f64> {
        let half_mm = 0.5 * self.scene.gear.face_width_mm;
        vec![-half_mm, half_mm]
    }

    fn target_profiles(
        &self,
        tooth: u32,
        side: Side,
        spacing_mm: f64,
        leads_mm: &[f64],
    ) -> Result<(Vec<f64>, Vec<Profile>)> {
        let generation = self.target_generation();
        let target = self.target_flank(&generation, tooth, side)?;
        let intervals = (target.length_mm() / spacing_mm).ceil().max(1.0);
        let arcs: Vec<f64> = (0..=intervals as usize).map(|i| target.length_mm() * i as f64 / intervals).collect();
        let profile: Profile = arcs
            .iter()
            .map(|&arc| target.at_arc(arc))
            .map(|contact| (contact.point_mm, contact.normal.extend(0.0)))
            .collect();
        Ok((arcs, vec![profile; leads_mm.len()]))
    }

    fn target_roots(&self, space: u32, spacing_mm: f64, leads_mm: &[f64]) -> Result<Vec<Profile>> {
        let points = target_root(&self.target_generation(), i64::from(space), spacing_mm);
        let profile: Profile = points.iter().map(|point| (point.point_mm, point.normal.extend(0.0))).collect();
        Ok(vec![profile; leads_mm.len()])
    }

    fn cut_flank(
        &self,
        backend: &dyn Backend,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        leads_mm: &[f64],
    ) -> Result<Vec<Layer>> {
        let generation = self.target_generation();
        let flank = self.target_flank(&generation, tooth, side)?;
        let field = self.field_over(&flank, arcs_mm.iter().copied(), leads_mm.to_vec());
        Ok(self.cut(backend, field)?.layers)
    }

    fn flank_surface(&self, backend: &dyn Backend, tooth: u32, side: Side, reach_mm: f64) -> Result<SurfaceGrid> {
        let generation = self.target_generation();
        let mut field = self.flank_field(&self.target_flank(&generation, tooth, side)?);
        field.leads_mm = band_mm(field.leads_mm, reach_mm);
        let cut = self.cut(backend, field)?;
        Ok(SurfaceGrid::new(&cut.field, &cut.layers, self.scene.fields.profile_spacing_mm))
    }

    fn root_surface(&self, backend: &dyn Backend, space: u32) -> Result<SurfaceGrid> {
        let cut = self.cut(backend, self.root_field(space))?;
        Ok(SurfaceGrid::new(&cut.field, &cut.layers, self.scene.output.mesh_spacing_mm))
    }

    fn tip_surface(&self, backend: &dyn Backend, tooth: u32) -> Result<Option<SurfaceGrid>> {
        let Some(field) = tip_field(self, tooth)? else { return Ok(None) };
        let cut = self.cut(backend, field)?;
        Ok(Some(SurfaceGrid::new(&cut.field, &cut.layers, self.scene.output.mesh_spacing_mm)))
    }
}

fn tip_field(job: &Job, tooth: u32) -> Result<Option<Field>> {
    let generation = job.target_generation();
    let [from, to] = {
        let tip = |side| -> Result<f64> {
            let flank = job.target_flank(&generation, tooth, side)?;
            let contact = flank.at_arc(flank.length_mm());
            Ok(job.blank.height(contact.point_mm, contact.phi_rad).1)
        };
        [tip(Side::Right)?, tip(Side::Left)?]
    };
    let [from_mm, to_mm] = [from, to].map(|phi| job.curve.arc_mm(phi));
    let count = ((to_mm - from_mm) / TIP_SPACING_MM[0]).floor();
    if count < 2.0 {
        return Ok(None);
    }
    let module_mm = job.scene.gear.module_mm;
    let columns = (0..count as u32)
        .map(|i| {
            let arc_mm = (to_mm - from_mm) * (f64::from(i) + 0.5) / count;
            let frame = job.curve.frame(job.curve.phi_at_arc(from_mm + arc_mm));
            Column {
                arc_mm,
                origin_mm: frame.point_mm,
                normal: frame.normal,
                low_mm: -0.5 * module_mm,
                blank_mm: job.blank.addendum_mm,
            }
        })
        .collect();
    let width_mm = job.scene.gear.face_width_mm;
    Ok(Some(Field { columns, leads_mm: leads_mm(width_mm, TIP_SPACING_MM[1]) }))
}
