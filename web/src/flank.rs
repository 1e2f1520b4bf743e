//! Cut flanks as arrays, `[columns, rows]`, rows fastest.

use gearcut::Flank;
use wasm_bindgen::prelude::*;

/// A flank, or a part of one, after all operations.
#[wasm_bindgen]
pub struct WebFlank(pub(crate) Flank);

#[wasm_bindgen]
impl WebFlank {
    /// Normal deviations after an operation, mm; none for an index that no operation has.
    pub fn deviations(&self, operation: usize) -> Option<Vec<f32>> {
        (operation < self.0.operations.len()).then(|| self.0.deviations_mm(operation).to_vec())
    }

    /// What an operation left for those after it, mm, NaN where none came; none for an index that no operation has.
    pub fn stock(&self, operation: usize) -> Option<Vec<f32>> {
        (operation < self.0.operations.len()).then(|| self.0.stock_mm(operation))
    }
}
