//! Errors of which only differences are known: the pitch errors of a tool's teeth, all by as much, are a turn of the
//! tool, and a round gear turns with it. On the measuring machine it lies as it may.
//!
//! In: columns of such a source, and the sizes that were fitted. Out: columns of differences, and sizes about their
//! median, so that a tooth that is off alone is named alone. Cut and cut again with what no measurement knows, sizes
//! would wander together from round to round.

use super::FittedSize;
use gearcut_core::math::column_basis::norm;

/// Columns shorter than this share of the longest one are no influence: the tooth cuts nothing that was measured.
const LEAST_SHARE: f64 = 1e-3;

/// Columns less their mean: what a source does beside the turn. One of them follows from the others. Columns that do
/// nothing become 0.
pub(super) fn differences(columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let longest = columns.iter().map(|column| norm(column)).fold(0.0, f64::max);
    let acts = |column: &[f64]| norm(column) > LEAST_SHARE * longest;
    let count = columns.iter().filter(|column| acts(column)).count() as f64;
    let mut mean = vec![0.0; columns.first().map_or(0, Vec::len)];
    for column in columns.iter().filter(|column| acts(column)) {
        mean.iter_mut().zip(column).for_each(|(mean, value)| *mean += value / count);
    }
    let less = |column: Vec<f64>| {
        let share = if acts(&column) { 1.0 } else { 0.0 };
        column.iter().zip(&mean).map(|(value, mean)| share * (value - mean)).collect()
    };
    columns.into_iter().map(less).collect()
}

/// Mean of fitted sizes over the columns that act; that which follows from the others has the size 0.
pub(super) fn common(columns: &[Vec<f64>], fitted: &[Option<FittedSize>]) -> f64 {
    let sizes = sizes(columns, fitted);
    sizes.iter().sum::<f64>() / sizes.len().max(1) as f64
}

/// Sizes of the columns that act.
fn sizes(columns: &[Vec<f64>], fitted: &[Option<FittedSize>]) -> Vec<f64> {
    let of = |(column, fitted): (&Vec<f64>, &Option<FittedSize>)| {
        (norm(column) > 0.0).then(|| fitted.map_or(0.0, |fitted| fitted.size))
    };
    columns.iter().zip(fitted).filter_map(of).collect()
}

/// The same sizes counted from their median. The one that follows from the others is as uncertain as they are.
pub(super) fn about_the_median(columns: &[Vec<f64>], fitted: Vec<Option<FittedSize>>) -> Vec<Option<FittedSize>> {
    let mut sizes = sizes(columns, &fitted);
    sizes.sort_unstable_by(f64::total_cmp);
    let Some(&median) = sizes.get(sizes.len().saturating_sub(1) / 2) else { return fitted };
    let half = fitted.iter().flatten().map(|of| of.half_if_right).fold(0.0, f64::max);
    let reach = fitted.iter().flatten().map(|of| of.interval.map(|end| end - of.size));
    let reach = reach.fold([0.0_f64; 2], |all, own| [all[0].min(own[0]), all[1].max(own[1])]);
    let following = FittedSize { size: 0.0, interval: reach, half_if_right: half };
    let moved = |of: FittedSize| FittedSize {
        size: of.size - median,
        interval: of.interval.map(|end| end - median),
        half_if_right: of.half_if_right,
    };
    let sized = |(column, fitted): (&Vec<f64>, Option<FittedSize>)| {
        (norm(column) > 0.0).then(|| moved(fitted.unwrap_or(following)))
    };
    columns.iter().zip(fitted).map(sized).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(size: f64) -> FittedSize {
        FittedSize { size, interval: [size - 0.1, size + 0.2], half_if_right: 0.15 }
    }

    /// Three teeth that act and one that cuts nothing: what all three do alike is no column.
    #[test]
    fn differences_know_no_common_size() {
        let columns = vec![vec![1.0, 0.0, 2.0], vec![0.0, 1.0, 2.0], vec![0.0; 3], vec![1.0, 1.0, 0.5]];
        let found = differences(columns);
        for place in 0..3 {
            assert!(found.iter().map(|column| column[place]).sum::<f64>().abs() < 1e-12);
        }
        assert_eq!(norm(&found[2]), 0.0);
    }

    /// The tooth that is 4 um off is the one from which the others follow.
    #[test]
    fn a_tooth_that_is_off_alone_is_named_alone() {
        let columns = vec![vec![1.0, 0.0], vec![0.0, 1.0], vec![0.0; 2], vec![-1.0, -1.0]];
        let others = [Some(fitted(-4.0)), Some(fitted(-4.0)), None, None];
        let found = about_the_median(&columns, others.to_vec());
        let sizes: Vec<Option<f64>> = found.iter().map(|of| of.map(|of| of.size)).collect();
        assert_eq!(sizes, [Some(0.0), Some(0.0), None, Some(4.0)]);
        assert_eq!(found[3].map(|of| of.half_if_right), Some(0.15));
        assert!((common(&columns, &others) + 8.0 / 3.0).abs() < 1e-12);
    }
}
