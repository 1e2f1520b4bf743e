//! Cuts what a closed gear needs beside its flanks: roots and tip lands.
//!
//! Both are coarse fields of their own: roots along the normals of the target's fillet, tips along the normals of the blank's outline, from the pitch curve up. A tip ray that no pass reached says
//! that the blank's own surface stands there; where the cutter's base has cut the tips down, or a window left a tooth alone, it says that too.

use super::flanks::SurfaceGrid;
use crate::cut::Backend;
use crate::dexel::{Column, Field};
use crate::error::Result;
use crate::gear::generation::Side;
use crate::job::Job;
use crate::surface::outline::{GearSurfaces, ToothSurfaces};
use rayon::prelude::*;

/// Distance of tip rays along profile and tooth, mm.
const TIP_SPACING_MM: [f64; 2] = [0.02, 1.0];

/// Cuts roots and tips to go with the flanks, which stand tooth by tooth, left before right; `tooth_done` is called after each tooth.
///
/// # Errors
/// As [`cut_root`] and [`cut_tip`].
///
/// # Panics
/// A flank is missing.
pub fn complete(
    job: &Job,
    backend: &dyn Backend,
    flanks: Vec<SurfaceGrid>,
    tooth_done: &(dyn Fn() + Sync),
) -> Result<GearSurfaces> {
    let teeth = job.scene.gear.teeth;
    assert_eq!(flanks.len(), 2 * teeth as usize, "both flanks of every tooth");
    let others: Vec<_> = (1..=teeth)
        .into_par_iter()
        .map(|tooth| {
            let both = (cut_tip(job, backend, tooth)?, cut_root(job, backend, tooth)?);
            tooth_done();
            Ok(both)
        })
        .collect::<Result<_>>()?;
    let mut flanks = flanks.into_iter();
    let mut flank = || flanks.next().expect("counted above");
    let teeth = others
        .into_iter()
        .map(|(tip, root)| {
            let (left, right) = (flank(), flank());
            ToothSurfaces { right, tip, left, root }
        })
        .collect();
    Ok(GearSurfaces { teeth })
}

/// Surface of the root of a space (space j lies after tooth j) after all operations.
///
/// # Errors
/// The backend's.
pub fn cut_root(job: &Job, backend: &dyn Backend, space: u32) -> Result<SurfaceGrid> {
    let cut = job.cut(backend, job.root_field(space))?;
    Ok(SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm))
}

/// Surface of the tip land of a tooth after all operations; `None` on a pointed tooth.
///
/// # Errors
/// The backend's; a flank that the cutter does not generate.
pub fn cut_tip(job: &Job, backend: &dyn Backend, tooth: u32) -> Result<Option<SurfaceGrid>> {
    let Some(field) = tip_field(job, tooth)? else { return Ok(None) };
    let cut = job.cut(backend, field)?;
    Ok(Some(SurfaceGrid::new(&cut.field, &cut.layers, job.scene.output.mesh_spacing_mm)))
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
    let intervals = (width_mm / TIP_SPACING_MM[1]).round().max(1.0);
    let leads_mm = (0..=intervals as u32).map(|i| width_mm * (f64::from(i) / intervals - 0.5)).collect();
    Ok(Some(Field { columns, leads_mm }))
}
