//! One scene with many seeds.

use super::FlankWish;
use super::numbers::measure;
use super::rows::{Rows, SeedFile};
use crate::interrupt::Interrupt;
use crate::process::ProcessJob;
use crate::progress::Progress;
use crate::scene::Scene;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// Cuts and measures the seeds 1 to `seeds` that the rows do not have yet; each is written as soon as it is found.
/// `scene` gives the scene of a seed, and `like` is the job of one of them. Gives all rows that there are then.
///
/// # Errors
/// Geometry, the backend, the file. Ctrl-C is no error: what is finished is returned.
pub fn measure_seeds(
    (rows, file): (Rows, &SeedFile),
    seeds: u32,
    scene: impl Fn(u32) -> Result<Scene> + Sync,
    like: &dyn ProcessJob,
    (flank, backend): (FlankWish, &dyn Backend),
    (progress, interrupt): (&Progress, &Interrupt),
) -> Result<Rows> {
    let missing: Vec<u32> = (1..=seeds).filter(|seed| !rows.contains_key(seed)).collect();
    let step = progress.step("seeds", missing.len() as u64, "gears");
    let found: Vec<Option<_>> = missing
        .into_par_iter()
        .with_max_len(1)
        .map(|seed| {
            if interrupt.is_raised() {
                return Ok(None);
            }
            let values = measure(&scene(seed)?, like, flank, backend)?;
            file.add(&seed, &values)?;
            step.advance(1);
            Ok(Some((seed, values)))
        })
        .collect::<Result<_>>()?;
    step.finish();
    let mut rows = rows;
    rows.extend(found.into_iter().flatten());
    Ok(rows)
}
