//! Dexels of a map's cells whose chips are followed: one of each cell after each operation.
//!
//! In: what every operation left, and the cells. Out: columns and rows of dexels, and which pairs of them are followed.
//!
//! **The law.** A chip's thickness runs from 0 at one end of a mark, where it meets the mark of an earlier pass, to its
//! largest value at the other, where a later pass has cut it off: in first approximation it is the distance from the
//! former times the length of the mark. Of [`CHIPS_OF_A_CELL`] columns spread evenly over a cell, the one for which
//! this is largest is followed. Passes are those of the dexels, so that this costs a look at each of them.
//!
//! Road not taken: following all of these columns and showing the thickest. It took four times as long. On finished
//! flanks of the paper's gear it shows the same chip in more than nine of ten cells, and on average one that is 2 %
//! thicker; after roughing, whose chips differ more from mark to mark, in three of four cells, and 5 %.

use gearcut_core::dexel::{Layer, NO_PASS};
use std::ops::Range;

/// Columns of a cell of which one is followed, evenly over its columns in its middle row. Marks of finishing are as
/// long as a cell or longer, and of one that four dexels meet the thickest chip is at least three quarters of the
/// largest.
pub const CHIPS_OF_A_CELL: usize = 4;

/// Places of a flank's field whose chips are followed.
#[derive(Debug, Clone, PartialEq)]
pub struct ChipPlaces {
    /// Columns of the field, cell by cell.
    pub columns: Vec<usize>,
    /// Rows of the field, each once.
    pub rows: Vec<usize>,
    /// Whether the chip of a column in a row is asked for, after each operation, column by column.
    wanted: Vec<Vec<bool>>,
}

impl ChipPlaces {
    /// One column of each cell in each row. Layers are those after each operation, `field_rows` rows long; a row may be
    /// that of many cells.
    pub fn thickest(layers: &[Layer], field_rows: usize, cells: &[Vec<usize>], rows: &[usize]) -> Self {
        let rows = each_once(rows);
        let columns = cells.concat();
        let chosen = |layer: &Layer| {
            let mut wanted = vec![false; columns.len() * rows.len()];
            for (at, &row) in rows.iter().enumerate() {
                let passes: Vec<u32> = layer.passes.iter().skip(row).step_by(field_rows).copied().collect();
                let likely = thickness_shares(&passes);
                let mut first = 0;
                for cell in cells {
                    let places = first..first + cell.len();
                    let thickest = places.max_by(|&a, &b| likely[columns[a]].total_cmp(&likely[columns[b]]));
                    if let Some(column) = thickest {
                        wanted[column * rows.len() + at] = true;
                    }
                    first += cell.len();
                }
            }
            wanted
        };
        Self { wanted: layers.iter().map(chosen).collect(), columns, rows }
    }

    /// Whether the chip that an operation left in a row of a column (places in the lists) is asked for.
    pub fn wants(&self, operation: usize, [column, row]: [usize; 2]) -> bool {
        self.wanted[operation][column * self.rows.len() + row]
    }

    /// Whether any chip of a column is.
    pub fn wants_any(&self, column: usize) -> bool {
        let rows = column * self.rows.len()..(column + 1) * self.rows.len();
        self.wanted.iter().any(|wanted| wanted[rows.clone()].contains(&true))
    }
}

/// Rows in order, each once.
pub fn each_once(rows: &[usize]) -> Vec<usize> {
    let mut rows = rows.to_vec();
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// Columns of a cell of which one is followed, evenly spread; all of them where they are few.
pub fn chip_columns(cell: &Range<usize>) -> Vec<usize> {
    let count = cell.len().min(CHIPS_OF_A_CELL);
    (0..count).map(|i| cell.start + (2 * i + 1) * cell.len() / (2 * count)).collect()
}

/// How thick the chips of a row's dexels are against each other: distance from the thin end of their mark times its
/// length, in dexels. Below nothing where no pass came.
fn thickness_shares(passes: &[u32]) -> Vec<f64> {
    let mut shares = Vec::with_capacity(passes.len());
    for mark in passes.chunk_by(|a, b| a == b) {
        let (from, length, pass) = (shares.len(), mark.len(), mark[0]);
        let earlier = |neighbour: Option<&u32>| neighbour.is_some_and(|&neighbour| neighbour < pass);
        let thin_before = earlier(from.checked_sub(1).and_then(|before| passes.get(before)));
        let thin_after = earlier(passes.get(from + length));
        shares.extend((0..length).map(|at| {
            let before = if thin_before { at as f64 + 0.5 } else { length as f64 };
            let after = if thin_after { (length - at) as f64 - 0.5 } else { length as f64 };
            if pass == NO_PASS { -1.0 } else { before.min(after) * length as f64 }
        }));
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marks of three passes that cut from right to left, and two dexels that none came to.
    #[test]
    fn the_followed_dexel_lies_at_the_thick_end_of_the_longest_mark() {
        let passes = [NO_PASS, NO_PASS, 9, 9, 9, 9, 8, 8, 3, 3];
        assert_eq!(thickness_shares(&passes), [-1.0, -1.0, 14.0, 10.0, 6.0, 2.0, 3.0, 1.0, 4.0, 4.0]);
        let layer = Layer { heights_mm: vec![0.0; 10], passes: passes.to_vec() };
        let places = ChipPlaces::thickest(&[layer], 1, &[vec![0, 1, 2, 3], vec![4, 5, 6, 7], vec![8, 9]], &[0]);
        let followed: Vec<usize> = (0..10).filter(|&column| places.wants(0, [column, 0])).collect();
        assert_eq!(followed, [2, 4, 9]);
        assert!(!places.wants_any(0) && places.wants_any(2));
    }
}
