//! Maps of all flanks of a gear, with the colours that they share.
//!
//! Sheets, single maps and the page show the same values: their scales are found once, over all flanks.

use crate::colormap::ColourScale;
use crate::output::flank_maps::FlankMaps;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Deviations whose colours reach the ends of the scale at least, µm: on a finer scale a perfect gear would look
/// faulty.
const LEAST_DEVIATION_UM: f32 = 1.0;
/// Smallest span of the colours of stock, as a share of the stock: finer, an even allowance would look uneven.
const LEAST_SPAN: f32 = 0.05;

/// Maps of all finished flanks, in order of teeth, left before right.
#[derive(Debug)]
pub struct GearMaps {
    /// The maps; empty where nothing that is written needs them.
    pub flanks: Vec<FlankMaps>,
    /// Colours of the stock of every earlier operation, mm.
    pub stock_scales: Vec<ColourScale>,
    /// Colours of the deviations, µm.
    pub deviation_scale: ColourScale,
    /// Colours of the finished surface's heights, highest of each cell, µm.
    pub height_scale: ColourScale,
}

impl GearMaps {
    /// Finds the colours, over what is evaluated of the finished flanks: a fillet that is deep for reasons of its own
    /// would leave none to them, and stays at the end of the colours.
    pub fn new(flanks: Vec<FlankMaps>) -> Self {
        let evaluated = |values: fn(&FlankMaps) -> Vec<f32>| -> Vec<Vec<f32>> {
            let of = |map: &FlankMaps| map.evaluated(&values(map), map.evaluated_mm.len() - 1).to_vec();
            flanks.iter().map(of).collect()
        };
        let deviations_mm = evaluated(|map| map.deviation_mm().to_vec());
        let deviation_scale = match ColourScale::diverging_over(deviations_mm.iter().map(Vec::as_slice)) {
            ColourScale::Diverging { limit } => {
                ColourScale::Diverging { limit: (limit * UM_PER_MM as f32).max(LEAST_DEVIATION_UM) }
            }
            scale @ ColourScale::Sequential { .. } => scale,
        };
        let heights_um = evaluated(finished_heights_um);
        let height_scale = ColourScale::heights_over(heights_um.iter().map(Vec::as_slice));
        let earlier = flanks.first().map_or(0, |map| map.evaluated_mm.len() - 1);
        let stock_scales = (0..earlier).map(|operation| stock_scale(&flanks, operation)).collect();
        Self { flanks, stock_scales, deviation_scale, height_scale }
    }

    /// Flanks that are drawn by themselves: those of `windows`, and those with the largest and the smallest value of
    /// what is evaluated of the finished surface, its mean deviation and the stock for it.
    pub fn drawn(&self, windows: &[(u32, Side)]) -> Vec<&FlankMaps> {
        let last = |map: &FlankMaps| map.evaluated_mm.len() - 1;
        let mut chosen: Vec<usize> = (0..self.flanks.len())
            .filter(|&i| windows.contains(&(self.flanks[i].tooth, self.flanks[i].side)))
            .collect();
        let mut extremes = |values: &dyn Fn(&FlankMaps) -> Vec<f32>, operation: usize| {
            let ends = self.flanks.iter().enumerate().map(|(index, map)| {
                let values = values(map);
                let evaluated = map.evaluated(&values, operation).iter();
                let (low, high) = evaluated
                    .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
                (index, low, high)
            });
            let ends: Vec<_> = ends.filter(|(_, low, high)| low <= high).collect();
            chosen.extend(ends.iter().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, ..)| *index));
            chosen.extend(ends.iter().max_by(|a, b| a.2.total_cmp(&b.2)).map(|(index, ..)| *index));
        };
        let Some(last) = self.flanks.first().map(last) else { return Vec::new() };
        extremes(&finished_heights_um, last);
        extremes(&|map| map.deviation_mm().to_vec(), last);
        if last > 0 {
            extremes(&|map| map.mean_stock_mm(last - 1), last - 1);
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen.into_iter().map(|index| &self.flanks[index]).collect()
    }
}

fn stock_scale(flanks: &[FlankMaps], operation: usize) -> ColourScale {
    let stocks_mm: Vec<Vec<f32>> = flanks.iter().map(|map| map.mean_stock_mm(operation)).collect();
    let evaluated = flanks.iter().zip(&stocks_mm).map(|(map, stock)| map.evaluated(stock, operation));
    let (low, high) = ColourScale::sequential_over(evaluated).ends();
    let middle = 0.5 * (low + high);
    let half = (0.5 * (high - low)).max(0.5 * LEAST_SPAN * middle.abs());
    ColourScale::Sequential { low: middle - half, high: middle + half }
}

/// Heights of a flank's finished surface, highest of each cell, µm.
pub fn finished_heights_um(map: &FlankMaps) -> Vec<f32> {
    map.highest_mm.last().map_or_else(Vec::new, |heights| um(heights))
}

/// Lengths in mm as µm.
pub fn um(lengths_mm: &[f32]) -> Vec<f32> {
    lengths_mm.iter().map(|length| length * UM_PER_MM as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::dexel::{Column, Field};
    use glam::DVec2;

    /// Two rows of so many columns 0.05 mm apart.
    fn field(columns: u32) -> Field {
        let column = |i: u32| Column {
            arc_mm: f64::from(i) * 0.05,
            origin_mm: DVec2::ZERO,
            normal: DVec2::X,
            low_mm: -1.0,
            blank_mm: 1.0,
        };
        Field { columns: (0..columns).map(column).collect(), rows_z_mm: vec![0.0, 0.1] }
    }

    /// A fillet half a millimetre deep below flanks that are 3 um high and have 0.2 mm of stock: the colours are those
    /// of the flanks. A part without a whole cell says nothing, and all of the map counts.
    #[test]
    fn colours_span_what_is_evaluated() {
        let field = field(40);
        let left = |flank_mm: f32| {
            let mut layer = field.blank_layer();
            for (index, height) in layer.heights_mm.iter_mut().enumerate() {
                *height = if index / 2 < 10 { -0.5 } else { flank_mm };
            }
            layer.passes.fill(1);
            layer
        };
        let layers = [left(0.203), left(0.003)];
        let map = |ends_mm: [f64; 2]| {
            let mut map = FlankMaps::sample(1, Side::Left, [&field.arcs_mm(), &field.rows_z_mm], &layers, 0.1);
            map.evaluated_mm = vec![ends_mm; 2];
            map
        };
        let maps = GearMaps::new(vec![map([0.7, 1.9])]);
        let near = |found: (f32, f32), wanted: (f32, f32)| {
            assert!((found.0 - wanted.0).abs() < 1e-4 && (found.1 - wanted.1).abs() < 1e-4, "{found:?}, {wanted:?}");
        };
        near(maps.deviation_scale.ends(), (-3.0, 3.0));
        near(maps.height_scale.ends(), (3.0, 3.0));
        near(maps.stock_scales[0].ends(), (0.195, 0.205));
        near(GearMaps::new(vec![map([0.71, 0.72])]).deviation_scale.ends(), (-500.0, 500.0));
    }

    /// Flank 3 is the highest, flank 5 the lowest, flank 4 has the least stock, flank 6 the most: they are drawn
    /// beside the one that a window looks at, each once.
    #[test]
    fn extremes_are_drawn_beside_the_flanks_of_windows() {
        let field = field(10);
        let flank = |tooth: u32, rough_mm: f32, finish_mm: f32| {
            let layers = [rough_mm, finish_mm].map(|mm| {
                let mut layer = field.blank_layer();
                layer.heights_mm.fill(mm);
                layer.passes.fill(1);
                layer
            });
            FlankMaps::sample(tooth, Side::Left, [&field.arcs_mm(), &field.rows_z_mm], &layers, 0.1)
        };
        let heights = [(0.2, 0.0), (0.2, 0.0), (0.203, 0.003), (0.19, 0.0), (0.198, -0.002), (0.21, 0.0), (0.2, 0.0)];
        let flanks = (1..).zip(heights).map(|(tooth, (rough, finish))| flank(tooth, rough, finish)).collect();
        let maps = GearMaps::new(flanks);
        let drawn = |windows: &[(u32, Side)]| -> Vec<u32> { maps.drawn(windows).iter().map(|map| map.tooth).collect() };
        assert_eq!(drawn(&[(2, Side::Left), (2, Side::Right)]), [2, 3, 4, 5, 6]);
        assert_eq!(drawn(&[]), [3, 4, 5, 6]);
        assert!(GearMaps::new(Vec::new()).drawn(&[(1, Side::Left)]).is_empty());
    }
}
