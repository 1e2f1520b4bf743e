//! Combinations of a source's parameters that every fit has beside them, and no gear shows.
//!
//! In: the columns of a source, and those of what is always fitted, over the noise. Out: directions in the source's
//! parameters, each as long as what is always fitted is seen.
//!
//! A pitch error of all gashes of a hob, or of all teeth of a cutter, is a turn of the gear, and the gear lies turned
//! on the measuring machine as well. Differences know influences to a few per cent, so that no two columns come out
//! exactly alike: what is beside the turn of their sum is an error of the influence, and least squares would answer it
//! by sizes without end. Of all answers that fit as well the shortest has nothing along such a direction: the mean of
//! the gashes is 0.

use gearcut_core::math::column_basis::{ColumnBasis, norm};

/// What of a column may be beside a source's own, as a share of it, where both count as one: influences are not known
/// better.
const ALIKE: f64 = 0.03;

/// Directions in the parameters of a source with several that do what one of the columns `always` does.
pub(super) fn free_directions(columns: &[Vec<f64>], always: &[Vec<f64>]) -> Vec<Vec<f64>> {
    if columns.len() < 2 {
        return Vec::new();
    }
    let mut basis = ColumnBasis::default();
    let taken: Vec<bool> = columns.iter().map(|column| basis.take(column)).collect();
    let direction = |column: &Vec<f64>| {
        let length = norm(column);
        if basis.left_of(column).sqrt() > ALIKE * length || length == 0.0 {
            return None;
        }
        let mut sizes = basis.solve(column).values.into_iter();
        let direction: Vec<f64> =
            taken.iter().map(|&taken| if taken { sizes.next().unwrap_or_default() } else { 0.0 }).collect();
        let unit = length / norm(&direction).powi(2);
        Some(direction.into_iter().map(|size| unit * size).collect())
    };
    always.iter().filter_map(direction).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three columns, the sum of which is a turn but for a hundredth of it: all alike. The direction is as long as the
    /// turn that a unit of it makes.
    #[test]
    fn the_sum_of_columns_that_make_a_turn_is_free() {
        let on = |of: usize| (0..12).map(|place| if place % 3 == of { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let mut columns = vec![on(0), on(1), on(2)];
        let turn = vec![vec![1.0; 12]];
        columns[1][4] = 1.04;
        let found = free_directions(&columns, &turn);
        let [direction] = &found[..] else { panic!("{found:?}") };
        let expected = 12.0_f64.sqrt() / 3.0;
        assert!(direction.iter().all(|of| (of - expected).abs() < 0.02 * expected), "{direction:?}, {expected}");
        // Nor are two of them, one that is three times as long at a place, or a single column.
        columns[1][4] = 3.0;
        assert!(free_directions(&columns, &turn).is_empty());
        assert!(free_directions(&columns[..2], &turn).is_empty() && free_directions(&turn, &turn).is_empty());
    }
}
