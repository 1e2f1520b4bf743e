//! Light on a map: how bright each cell is when a lamp stands to the upper left.
//!
//! Lambert's law on the surface's normals, the lamp 45 deg over the map. Flanks would look flat in true scale, where
//! slopes are thousandths: heights are exaggerated by a round factor that makes nine slopes in ten smaller than 0.7 (a
//! single step on the surface is no reason to draw all else flat), and the factor is stated.

use crate::output::grid::MapGrid;

/// Slope that the exaggeration aims at, of which [`STEEPER`] are steeper.
const SHOWN_SLOPE: f64 = 0.7;
/// Share of the cells that may be drawn steeper.
const STEEPER: f64 = 0.1;
/// Direction to the lamp: along v (right), along u (up), out of the map.
const LAMP: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];

/// Brightness of every cell: 1 where the surface lies flat, down to 0.35 in the shade, up to 1.35 towards the lamp.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// In the grid's order; NaN beside holes.
    pub brightness: Vec<f32>,
    /// Factor on heights.
    pub exaggeration: f64,
}

impl Relief {
    /// Relief of values that are `mm_per_value` mm high.
    pub fn of(grid: &MapGrid, values: &[f32], mm_per_value: f64) -> Self {
        let (rows, columns) = (grid.u.count, grid.v.count);
        let difference = |low: usize, high: usize, steps: usize, step_mm: f64| {
            f64::from(values[high] - values[low]) * mm_per_value / (steps as f64 * step_mm).max(f64::MIN_POSITIVE)
        };
        let slopes: Vec<[f64; 2]> = (0..rows * columns)
            .map(|i| {
                let (u, v) = (i / columns, i % columns);
                let (v0, v1) = (v.saturating_sub(1), (v + 1).min(columns - 1));
                let (u0, u1) = (u.saturating_sub(1), (u + 1).min(rows - 1));
                [
                    difference(u * columns + v0, u * columns + v1, v1 - v0, grid.v.step_mm),
                    difference(u0 * columns + v, u1 * columns + v, u1 - u0, grid.u.step_mm),
                ]
            })
            .collect();
        let mut steepness: Vec<f64> = slopes.iter().map(|[x, y]| x.hypot(*y)).filter(|s| s.is_finite()).collect();
        let steep = match steepness.len() {
            0 => 0.0,
            count => *steepness.select_nth_unstable_by((STEEPER * count as f64) as usize, |a, b| b.total_cmp(a)).1,
        };
        let exaggeration = if steep > 0.0 { round_factor(SHOWN_SLOPE / steep).max(1.0) } else { 1.0 };
        let brightness = slopes
            .iter()
            .map(|[x, y]| {
                let (x, y) = (exaggeration * x, exaggeration * y);
                let light = (LAMP[2] - LAMP[0] * x - LAMP[1] * y) / (1.0 + x * x + y * y).sqrt();
                // Flat ground has the brightness of the lamp's height; it keeps the colour of the scale.
                (1.0 + (light - LAMP[2])).clamp(0.35, 1.35) as f32
            })
            .collect();
        Self { brightness, exaggeration }
    }

    /// What stands below the picture.
    pub fn words(&self) -> String {
        format!(
            "shaded relief: light from the upper left, heights exaggerated {} times against u and v",
            self.exaggeration
        )
    }
}

/// 1, 2 or 5 times a power of ten, the nearest below.
fn round_factor(factor: f64) -> f64 {
    let power = 10_f64.powf(factor.log10().floor());
    let digit = factor / power;
    power
        * if digit >= 5.0 {
            5.0
        } else if digit >= 2.0 {
            2.0
        } else {
            1.0
        }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::grid::MapAxis;

    #[test]
    fn slopes_towards_the_lamp_are_bright_and_flat_ground_keeps_its_colour() {
        let axis = |count| MapAxis { name: "a".into(), meaning: "a".into(), start_mm: 0.0, step_mm: 0.01, count };
        let grid = MapGrid { u: axis(3), v: axis(7) };
        // A ridge along u in the middle of v: its left side faces the lamp.
        let values: Vec<f32> = [0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 0.0].repeat(3);
        let relief = Relief::of(&grid, &values, 1e-3);
        let row = &relief.brightness[7..14];
        assert!(row[1] > 1.05 && row[5] < 0.95 && (row[3] - 1.0).abs() < 1e-6, "{row:?}");
        assert!([1.0, 2.0, 5.0].iter().any(|digit| (relief.exaggeration / digit).log10().fract() == 0.0));
        assert!(Relief::of(&grid, &[1.0; 21], 1e-3).brightness.iter().all(|b| *b == 1.0));
    }
}
