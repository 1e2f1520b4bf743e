//! Outlines as arrays of x and y in turn, mm.

use gearcut::PlanarView;
use wasm_bindgen::prelude::*;

/// Gear, stock and tool in a transverse section.
#[wasm_bindgen]
pub struct WebDrawing(pub(crate) PlanarView);

#[wasm_bindgen]
impl WebDrawing {
    /// The target.
    pub fn gear(&self) -> Vec<f32> {
        pairs(&self.0.gear_mm)
    }

    /// The pitch curve.
    pub fn pitch(&self) -> Vec<f32> {
        pairs(&self.0.pitch_mm)
    }

    /// The stock.
    pub fn stock(&self) -> Vec<f32> {
        pairs(&self.0.stock_mm)
    }

    /// Radius of bore or rim, mm.
    pub fn back(&self) -> f64 {
        self.0.back_radius_mm
    }

    /// The tool in its own frame.
    pub fn tool(&self) -> Vec<f32> {
        pairs(&self.0.tool_mm)
    }

    /// Turn, rad, and place of the tool, mm, stroke by stroke: three numbers each.
    pub fn strokes(&self) -> Vec<f32> {
        self.0.strokes.iter().flat_map(|&(turn, at)| [turn, at.x, at.y]).map(|value| value as f32).collect()
    }
}

fn pairs(points: &[impl Into<[f64; 2]> + Copy]) -> Vec<f32> {
    points.iter().flat_map(|&point| point.into()).map(|value| value as f32).collect()
}
