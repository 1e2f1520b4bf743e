//! What figures need of the dexels of a field: every column's extremes, counts and sums, and two lines of dexels.
//!
//! In: what each operation left on a field. Out: [`ColumnHeights`] and [`ColumnStock`] of its columns, the dexels of
//! one row and of one column after the last operation ([`LinesAt`]). A flank has a thousand times as many dexels as
//! columns: a device that makes these figures where the dexels lie sends them alone ([`FieldFigures`]). Where the
//! dexels are at hand, figures are made when somebody asks ([`FieldColumns`]).
//!
//! Among equal heights the first row counts. Sums go on from column to column in f64, dexel by dexel where these are at
//! hand; a device adds up each column for itself.

use super::field::{Field, Layer, NO_PASS};

/// Cuts shallower than this below the target are numerical, mm: the edge tables, f32 heights and Newton's last step
/// together.
pub const RESOLUTION_MM: f64 = 1e-6;

/// Dexels that are compared at once.
const LANES: usize = 16;

/// Lines of a field whose dexels are wanted one by one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinesAt {
    /// Row of the line along the profile.
    pub row: usize,
    /// Column of the line along the tooth.
    pub column: usize,
}

/// A height, or a difference of heights, and the row of its dexel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowHeight {
    /// Height, mm.
    pub height_mm: f32,
    /// Row.
    pub row: u32,
}

/// Lowest and highest of no dexel.
pub const NO_HEIGHTS: [RowHeight; 2] =
    [RowHeight { height_mm: f32::INFINITY, row: 0 }, RowHeight { height_mm: f32::NEG_INFINITY, row: 0 }];

/// Heights of one column after an operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnHeights {
    /// The lowest dexel.
    pub lowest: RowHeight,
    /// Lowest and highest of the dexels that a pass has reached; infinite if there is none.
    pub reached: [RowHeight; 2],
    /// Dexels that no pass has reached.
    pub untouched: u32,
    /// Dexels as low as their rays record.
    pub at_bottom: u32,
}

/// Stock of one column: what an operation leaves over the last one, on the dexels that it has reached. Where the last
/// one takes nothing because the earlier one has cut below the target, the stock is minus that depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnStock {
    /// Smallest and largest; infinite if there is none.
    pub range: [RowHeight; 2],
    /// Sum, mm.
    pub sum_mm: f64,
    /// Dexels that the operation has not reached.
    pub untouched: u32,
}

impl ColumnHeights {
    /// Of a column's heights and passes; `low_mm`: the lowest height that its rays record.
    fn of(heights_mm: &[f32], passes: &[u32], low_mm: f32) -> Self {
        let mut lowest = [f32::INFINITY; LANES];
        let [mut low, mut high] = [[f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]];
        let [mut untouched, mut at_bottom] = [[0; LANES]; 2];
        for (heights_mm, passes) in heights_mm.chunks(LANES).zip(passes.chunks(LANES)) {
            for (lane, (&height_mm, &pass)) in heights_mm.iter().zip(passes).enumerate() {
                let is_reached = pass != NO_PASS;
                let [if_low, if_high] = if is_reached { [height_mm; 2] } else { [f32::INFINITY, f32::NEG_INFINITY] };
                lowest[lane] = if height_mm < lowest[lane] { height_mm } else { lowest[lane] };
                low[lane] = if if_low < low[lane] { if_low } else { low[lane] };
                high[lane] = if if_high > high[lane] { if_high } else { high[lane] };
                untouched[lane] += u32::from(!is_reached);
                at_bottom[lane] += u32::from(height_mm <= low_mm);
            }
        }
        let first = |value: f32, counts: &dyn Fn(u32) -> bool| {
            let mut dexels = heights_mm.iter().zip(passes);
            let row = dexels.position(|(&height_mm, &pass)| height_mm == value && counts(pass));
            row.map_or(RowHeight { height_mm: value, row: 0 }, |row| RowHeight {
                height_mm: heights_mm[row],
                row: row as u32,
            })
        };
        let [lowest, low] = [lowest, low].map(|lanes| lanes.into_iter().fold(f32::INFINITY, f32::min));
        let high = high.into_iter().fold(f32::NEG_INFINITY, f32::max);
        Self {
            lowest: first(lowest, &|_| true),
            reached: [low, high].map(|value| first(value, &|pass| pass != NO_PASS)),
            untouched: untouched.into_iter().sum(),
            at_bottom: at_bottom.into_iter().sum(),
        }
    }
}

impl ColumnStock {
    /// Of a column's heights and passes after an operation and after the last one; the sum goes on from `before_mm`.
    fn of(
        (earlier_mm, earlier_passes): (&[f32], &[u32]),
        (later_mm, later_passes): (&[f32], &[u32]),
        before_mm: f64,
    ) -> Self {
        let [mut low, mut high] = NO_HEIGHTS;
        let (mut sum_mm, mut untouched) = (before_mm, 0);
        let dexels = earlier_mm.iter().zip(earlier_passes).zip(later_mm.iter().zip(later_passes));
        for (row, ((&before, &pass), (&after, &last_pass))) in dexels.enumerate() {
            if pass == NO_PASS {
                untouched += 1;
                continue;
            }
            let below = pass == last_pass && f64::from(before) < -RESOLUTION_MM;
            let height_mm = if below { before } else { before - after };
            sum_mm += f64::from(height_mm);
            let here = RowHeight { height_mm, row: row as u32 };
            if height_mm < low.height_mm {
                low = here;
            }
            if height_mm > high.height_mm {
                high = here;
            }
        }
        Self { range: [low, high], sum_mm, untouched }
    }
}

/// Figures of a field's columns that a device has made.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldFigures {
    /// Heights of the columns after each operation.
    pub heights: Vec<Vec<ColumnHeights>>,
    /// Stock of the columns, of every operation but the last.
    pub stock: Vec<Vec<ColumnStock>>,
    /// What the last operation left in the row of [`LinesAt`], a dexel for each column.
    pub profile: Layer,
    /// What it left in the column, a dexel for each row.
    pub along: Layer,
}

/// Columns of a cut field as figures ask for them.
#[derive(Debug, Clone, Copy)]
pub enum FieldColumns<'a> {
    /// The dexels are at hand.
    Dexels {
        /// Rays.
        field: &'a Field,
        /// What each operation left, in order.
        layers: &'a [Layer],
        /// Lines that are asked for.
        lines: LinesAt,
    },
    /// A device has made the figures.
    Figures(&'a FieldFigures),
}

impl FieldColumns<'_> {
    /// Number of operations.
    pub fn operations(&self) -> usize {
        match self {
            Self::Dexels { layers, .. } => layers.len(),
            Self::Figures(figures) => figures.heights.len(),
        }
    }

    /// Heights of a column after an operation.
    pub fn heights(&self, operation: usize, column: usize) -> ColumnHeights {
        match *self {
            Self::Dexels { field, layers, .. } => {
                let (heights_mm, passes) = column_of(&layers[operation], column, field.rows());
                ColumnHeights::of(heights_mm, passes, field.columns[column].low_mm as f32)
            }
            Self::Figures(figures) => figures.heights[operation][column],
        }
    }

    /// Stock of an operation but the last in a column; its sum goes on from `before_mm`.
    pub fn stock(&self, operation: usize, column: usize, before_mm: f64) -> ColumnStock {
        match *self {
            Self::Dexels { field, layers, .. } => {
                let [earlier, later] =
                    [operation, layers.len() - 1].map(|operation| column_of(&layers[operation], column, field.rows()));
                ColumnStock::of(earlier, later, before_mm)
            }
            Self::Figures(figures) => {
                let own = figures.stock[operation][column];
                ColumnStock { sum_mm: before_mm + own.sum_mm, ..own }
            }
        }
    }

    /// What the last operation left along the profile, a dexel for each column.
    pub fn profile(&self) -> Layer {
        match *self {
            Self::Dexels { field, layers, lines } => {
                let (layer, rows) = (&layers[layers.len() - 1], field.rows());
                let dexels = (0..field.columns.len()).map(|column| column * rows + lines.row);
                Layer {
                    heights_mm: dexels.clone().map(|dexel| layer.heights_mm[dexel]).collect(),
                    passes: dexels.map(|dexel| layer.passes[dexel]).collect(),
                }
            }
            Self::Figures(figures) => figures.profile.clone(),
        }
    }

    /// What it left along the tooth, a dexel for each row.
    pub fn along(&self) -> Layer {
        match *self {
            Self::Dexels { field, layers, lines } => {
                let (heights_mm, passes) = column_of(&layers[layers.len() - 1], lines.column, field.rows());
                Layer { heights_mm: heights_mm.to_vec(), passes: passes.to_vec() }
            }
            Self::Figures(figures) => figures.along.clone(),
        }
    }
}

/// Heights and passes of one column.
fn column_of(layer: &Layer, column: usize, rows: usize) -> (&[f32], &[u32]) {
    let dexels = column * rows..(column + 1) * rows;
    (&layer.heights_mm[dexels.clone()], &layer.passes[dexels])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of 37 dexels; two of the lowest height: the first counts, as one look at each after the other finds it.
    #[test]
    fn figures_of_a_column_are_those_of_one_look_at_each_dexel() {
        let mut heights_mm: Vec<f32> = (0..37_u16).map(|i| f32::from((i * 73) % 101)).collect();
        let mut passes: Vec<u32> = (0..37).collect();
        for (at, pass) in [(17, NO_PASS), (18, 18), (33, 33)] {
            (heights_mm[at], passes[at]) = (-0.5, pass);
        }
        let of = ColumnHeights::of(&heights_mm, &passes, -0.5);
        let at = |height_mm: f32, row: u32| RowHeight { height_mm, row };
        assert_eq!((of.lowest, of.untouched, of.at_bottom), (at(-0.5, 17), 1, 3));
        let highest = (0..37).filter(|&row| row != 17).max_by(|&a, &b| heights_mm[a].total_cmp(&heights_mm[b]));
        let highest = highest.expect("a dexel");
        assert_eq!(of.reached, [at(-0.5, 18), at(heights_mm[highest], highest as u32)]);
        let none = ColumnHeights::of(&heights_mm, &[NO_PASS; 37], -1.0);
        assert_eq!((none.reached, none.untouched, none.at_bottom), (NO_HEIGHTS, 37, 0));
    }

    /// Stock of three dexels by hand: 3 mm, minus 1 mm where the earlier operation went below and nothing follows, and
    /// one that it did not reach.
    #[test]
    fn stock_of_a_column_is_that_made_by_hand() {
        let earlier = ([4.0, -1.0, 7.0].as_slice(), [1, 2, NO_PASS].as_slice());
        let later = ([1.0, -1.0, 1.0].as_slice(), [5, 2, 6].as_slice());
        let of = ColumnStock::of(earlier, later, 10.0);
        let at = |height_mm: f32, row: u32| RowHeight { height_mm, row };
        assert_eq!(of, ColumnStock { range: [at(-1.0, 1), at(3.0, 0)], sum_mm: 12.0, untouched: 1 });
    }
}
