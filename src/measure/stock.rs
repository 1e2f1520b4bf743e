//! Normal stock: what one operation leaves over another one, along the target's normals.
//!
//! Dexels that the earlier operation never reached still have the blank's height; their stock is not a stock of machining. They are counted, and left out of the figures.

use crate::dexel::{Field, Layer, NO_PASS};

/// A value and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// Value, mm.
    pub value_mm: f64,
    /// Arc along the profile, mm.
    pub arc_mm: f64,
    /// Place along the tooth, mm.
    pub lead_mm: f64,
}

/// Stock over one field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stock {
    /// Smallest.
    pub smallest: Extreme,
    /// Largest.
    pub largest: Extreme,
    /// Mean, mm.
    pub mean_mm: f64,
    /// Dexels with a figure.
    pub dexels: u64,
    /// Dexels that the earlier operation never reached.
    pub untouched: u64,
}

/// Height of an operation over the target, for every dexel as `f32` NaN where no pass reached it.
pub fn height_or_nan(layer: &Layer, index: usize) -> f32 {
    if layer.passes[index] == NO_PASS { f32::NAN } else { layer.heights_mm[index] }
}

/// Stock between an earlier and a later layer; `None` if the earlier operation reached nothing.
pub fn stock(field: &Field, earlier: &Layer, later: &Layer) -> Option<Stock> {
    let rows = field.rows();
    let (mut low, mut high) = ((f32::INFINITY, 0), (f32::NEG_INFINITY, 0));
    let (mut sum, mut dexels, mut untouched) = (0.0_f64, 0_u64, 0_u64);
    for column in 0..field.columns.len() {
        let range = column * rows..(column + 1) * rows;
        for index in range {
            if earlier.passes[index] == NO_PASS {
                untouched += 1;
                continue;
            }
            let value = earlier.heights_mm[index] - later.heights_mm[index];
            if value < low.0 {
                low = (value, index);
            }
            if value > high.0 {
                high = (value, index);
            }
            sum += f64::from(value);
            dexels += 1;
        }
    }
    let place = |(value, index): (f32, usize)| Extreme {
        value_mm: f64::from(value),
        arc_mm: field.columns[index / rows].arc_mm,
        lead_mm: field.leads_mm[index % rows],
    };
    (dexels > 0).then(|| Stock {
        smallest: place(low),
        largest: place(high),
        mean_mm: sum / dexels as f64,
        dexels,
        untouched,
    })
}
