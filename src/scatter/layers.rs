//! Each layer of errors alone, all together, all but one.

use super::FlankWish;
use super::numbers::{Values, measure};
use crate::interrupt::Interrupt;
use crate::machine_errors::ErrorLayer;
use crate::process::ProcessJob;
use crate::progress::Progress;
use crate::scene::Scene;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use rayon::prelude::*;

/// A gear with some of its layers.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerCase {
    /// In words: `ideal machine`, `noise alone`, `all`, `all but noise`.
    pub name: String,
    /// Layers that are on.
    pub kept: Vec<ErrorLayer>,
}

/// Name of the case without any layer.
pub const IDEAL: &str = "ideal machine";
/// Name of the case with all of them.
pub const ALL: &str = "all";

/// Name of the case with one layer.
pub fn alone(layer: ErrorLayer) -> String {
    format!("{} alone", layer.name())
}

/// Name of the case with all layers but one.
pub fn all_but(layer: ErrorLayer) -> String {
    format!("all but {}", layer.name())
}

/// The cases of a scene with these layers: none, each alone, all, all but each; without layers none alone.
pub fn cases(layers: &[ErrorLayer]) -> Vec<LayerCase> {
    let but = |without: ErrorLayer| layers.iter().copied().filter(|&layer| layer != without).collect();
    let without = layers.iter().map(|&layer| LayerCase { name: all_but(layer), kept: but(layer) });
    let mut cases = vec![LayerCase { name: IDEAL.to_owned(), kept: Vec::new() }];
    if layers.is_empty() {
        return cases;
    }
    cases.extend(layers.iter().map(|&layer| LayerCase { name: alone(layer), kept: vec![layer] }));
    cases.push(LayerCase { name: ALL.to_owned(), kept: layers.to_vec() });
    // Of one layer, none is left without it; of two, each stands alone without the other.
    if layers.len() > 2 {
        cases.extend(without);
    }
    cases
}

/// Cuts and measures the cases; each is given back with its numbers.
///
/// # Errors
/// Geometry, the backend; Ctrl-C.
pub fn measure_cases(
    (scene, like): (&Scene, &dyn ProcessJob),
    cases: Vec<LayerCase>,
    flank: FlankWish,
    backend: &dyn Backend,
    (progress, interrupt): (&Progress, &Interrupt),
) -> Result<Vec<(LayerCase, Values)>> {
    let step = progress.step("layers", cases.len() as u64, "gears");
    let found = cases
        .into_par_iter()
        .map(|case| {
            interrupt.check()?;
            let mut scene = scene.clone();
            scene.process.keep_layers(&case.kept);
            let values = measure(&scene, like, flank, backend)?;
            step.advance(1);
            Ok((case, values))
        })
        .collect();
    step.finish();
    found
}
