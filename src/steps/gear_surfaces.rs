//! Cuts what a closed gear needs beside its flanks: roots and tip lands.
//!
//! In: a job and its flanks. Out: [`GearSurfaces`], from which the closed outline is made.

use crate::cut::Backend;
use crate::error::Result;
use crate::job::GearJob;
use crate::surface::flanks::SurfaceGrid;
use crate::surface::outline::{GearSurfaces, ToothSurfaces};
use rayon::prelude::*;

/// Cuts roots and tips to go with the flanks, which stand tooth by tooth, left before right; `tooth_done` is called
/// after each tooth.
///
/// # Errors
/// A flank that the tool does not generate; the backend's.
///
/// # Panics
/// A flank is missing.
pub fn complete(
    job: &dyn GearJob,
    backend: &dyn Backend,
    flanks: Vec<SurfaceGrid>,
    tooth_done: &(dyn Fn() + Sync),
) -> Result<GearSurfaces> {
    let teeth = job.scene().gear.teeth;
    assert_eq!(flanks.len(), 2 * teeth as usize, "both flanks of every tooth");
    let others: Vec<_> = (1..=teeth)
        .into_par_iter()
        .map(|tooth| {
            let both = (job.tip_surface(backend, tooth)?, job.root_surface(backend, tooth)?);
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
