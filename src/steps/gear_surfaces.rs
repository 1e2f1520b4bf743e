//! Cuts what a closed cylindrical gear needs beside its flanks and roots: tip lands.
//!
//! In: a job, its flanks and roots. Out: [`GearSurfaces`], from which the closed outline is made.

use crate::job::CylindricalGear;
use crate::surface::flanks::SurfaceGrid;
use crate::surface::outline::{GearSurfaces, ToothSurfaces};
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// Cuts tips to go with the flanks, which stand tooth by tooth, left before right, and with the roots, space by space;
/// `tooth_done` is called after each tooth.
///
/// # Errors
/// A flank that the tool does not generate; the backend's.
///
/// # Panics
/// A flank or a root is missing.
pub fn complete(
    job: &dyn CylindricalGear,
    backend: &dyn Backend,
    flanks: Vec<SurfaceGrid>,
    roots: Vec<SurfaceGrid>,
    tooth_done: &(dyn Fn() + Sync),
) -> Result<GearSurfaces> {
    let teeth = job.scene().gear.teeth;
    assert_eq!([flanks.len(), roots.len()], [2, 1].map(|of_tooth| of_tooth * teeth as usize), "every flank and root");
    let tips: Vec<_> = (1..=teeth)
        .into_par_iter()
        .map(|tooth| {
            let tip = job.tip_surface(backend, tooth)?;
            tooth_done();
            Ok(tip)
        })
        .collect::<Result<_>>()?;
    let mut flanks = flanks.into_iter();
    let mut flank = || flanks.next().expect("counted above");
    let teeth = tips
        .into_iter()
        .zip(roots)
        .map(|(tip, root)| {
            let (left, right) = (flank(), flank());
            ToothSurfaces { right, tip, left, root }
        })
        .collect();
    Ok(GearSurfaces { teeth })
}
