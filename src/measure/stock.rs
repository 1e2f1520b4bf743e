//! Normal stock: what one operation leaves over another one, along the target's normals.
//!
//! Dexels that the earlier operation never reached still have the blank's height; their stock is not a stock of
//! machining. They are counted, and left out of the figures. A stock below zero is a cut into the finished gear, and
//! keeps its sign.

use gearcut_core::dexel::{Field, Layer, NO_PASS};

/// Cuts shallower than this below the target are numerical, mm: the edge tables, f32 heights and Newton's last step
/// together.
pub const RESOLUTION_MM: f64 = 1e-6;

/// Dexels that are compared at once.
const LANES: usize = 16;

/// A value and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// Value, mm.
    pub value_mm: f64,
    /// Arc along the profile, mm.
    pub arc_mm: f64,
    /// Place along the tooth, mm.
    pub z_mm: f64,
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

impl Stock {
    /// The same of so many rows that are all alike.
    #[must_use]
    pub fn of_rows(self, copies: u64) -> Self {
        Self { dexels: self.dexels * copies, untouched: self.untouched * copies, ..self }
    }
}

/// Smallest and largest value over a field's chosen columns; `None` if no dexel has one.
pub fn extremes(
    field: &Field,
    column_counts: impl Fn(usize) -> bool,
    value: impl Fn(usize) -> Option<f32>,
) -> Option<[Extreme; 2]> {
    let rows = field.rows();
    let (mut low, mut high) = ((f32::INFINITY, 0), (f32::NEG_INFINITY, 0));
    for column in (0..field.columns.len()).filter(|&column| column_counts(column)) {
        for index in column * rows..(column + 1) * rows {
            let Some(value) = value(index) else { continue };
            if value < low.0 {
                low = (value, index);
            }
            if value > high.0 {
                high = (value, index);
            }
        }
    }
    places(field, [low, high])
}

/// Lowest height of a field; `None` if it has no dexel.
pub fn lowest(field: &Field, heights_mm: &[f32]) -> Option<Extreme> {
    let rows = field.rows();
    let mut low = (f32::INFINITY, 0);
    for (column, heights_mm) in heights_mm.chunks(rows).enumerate() {
        // Several dexels at once: a gear has a hundred million.
        let mut lanes = [f32::INFINITY; LANES];
        for chunk in heights_mm.chunks(LANES) {
            for (least, &height_mm) in lanes.iter_mut().zip(chunk) {
                *least = if height_mm < *least { height_mm } else { *least };
            }
        }
        let least = lanes.into_iter().fold(f32::INFINITY, f32::min);
        if least < low.0 {
            let row = heights_mm.iter().position(|&height_mm| height_mm == least).unwrap_or(0);
            low = (least, column * rows + row);
        }
    }
    (low.0 < f32::INFINITY).then(|| places(field, [low, low]))?.map(|[low, _]| low)
}

/// Lowest and highest value with their dexels as extremes; `None` where no dexel had one.
fn places(field: &Field, [low, high]: [(f32, usize); 2]) -> Option<[Extreme; 2]> {
    let rows = field.rows();
    let place = |(value, index): (f32, usize)| Extreme {
        value_mm: f64::from(value),
        arc_mm: field.columns[index / rows].arc_mm,
        z_mm: field.rows_z_mm[index % rows],
    };
    (low.0 <= high.0).then(|| [place(low), place(high)])
}

/// Stock between an earlier and a later layer over a field's chosen columns; `None` if the earlier operation reached
/// nothing there. Where the later operation takes nothing because the earlier one has cut below the target, the stock
/// is minus that depth.
pub fn stock(field: &Field, earlier: &Layer, later: &Layer, column_counts: impl Fn(usize) -> bool) -> Option<Stock> {
    let rows = field.rows();
    let (mut low, mut high) = ((f32::INFINITY, 0), (f32::NEG_INFINITY, 0));
    let (mut sum, mut dexels, mut untouched) = (0.0, 0, 0);
    // One look at every dexel: a gear has a hundred million.
    for column in (0..field.columns.len()).filter(|&column| column_counts(column)) {
        for index in column * rows..(column + 1) * rows {
            let pass = earlier.passes[index];
            if pass == NO_PASS {
                untouched += 1;
                continue;
            }
            let (before, after) = (earlier.heights_mm[index], later.heights_mm[index]);
            let below = pass == later.passes[index] && f64::from(before) < -RESOLUTION_MM;
            let value = if below { before } else { before - after };
            sum += f64::from(value);
            dexels += 1;
            if value < low.0 {
                low = (value, index);
            }
            if value > high.0 {
                high = (value, index);
            }
        }
    }
    let [smallest, largest] = places(field, [low, high])?;
    Some(Stock { smallest, largest, mean_mm: sum / dexels as f64, dexels, untouched })
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::dexel::Column;
    use glam::DVec2;

    /// Columns of 37 dexels, two of them lowest: the first counts, as one look at each after the other finds it.
    #[test]
    fn the_lowest_dexel_is_that_of_one_look_at_each() {
        let column = |i: u32| Column {
            arc_mm: f64::from(i),
            origin_mm: DVec2::ZERO,
            normal: DVec2::X,
            low_mm: -1.0,
            blank_mm: 1.0,
        };
        let field = Field { columns: (0..5).map(column).collect(), rows_z_mm: (0..37).map(f64::from).collect() };
        let mut heights_mm: Vec<f32> = (0..field.len()).map(|i| ((i * 73) % 101) as f32).collect();
        for at in [3 * 37 + 36, 2 * 37 + 17, 2 * 37 + 18] {
            heights_mm[at] = -0.5;
            let one_by_one = extremes(&field, |_| true, |index| Some(heights_mm[index])).map(|[low, _]| low);
            assert_eq!(lowest(&field, &heights_mm), one_by_one);
            assert_eq!(one_by_one.map(|low| low.value_mm), Some(-0.5));
        }
        assert_eq!(lowest(&Field { columns: Vec::new(), ..field }, &[]), None);
    }
}
