//! Maps averaged over one mark: what is left of a surface when its marks are taken away.
//!
//! In: values of cells, column by column, and how many cells a mark takes along both. Out: the mean over a window of
//! that size about each cell. Where marks repeat on a lattice, a window of one step along each of its directions holds
//! every part of a mark once, wherever it lies. At the edges it stays inside, beside the cell's own middle. Cells
//! without a value do not count.

/// Mean over `window` cells (along the columns, along the rows) about every cell; NaN where there is none.
pub fn averaged(values: &[f32], [columns, rows]: [usize; 2], window: [f64; 2]) -> Vec<f32> {
    let mut means: Vec<f64> = values.iter().map(|&value| f64::from(value)).collect();
    for column in means.chunks_mut(rows.max(1)) {
        let along = running_mean(column, window[1]);
        column.copy_from_slice(&along);
    }
    for row in 0..rows {
        let line: Vec<f64> = (0..columns).map(|column| means[column * rows + row]).collect();
        for (column, mean) in running_mean(&line, window[0]).into_iter().enumerate() {
            means[column * rows + row] = mean;
        }
    }
    means.into_iter().map(|mean| mean as f32).collect()
}

/// Means over a window of `width` cells, not less than one cell and not more than the line.
fn running_mean(line: &[f64], width: f64) -> Vec<f64> {
    let cells = line.len() as f64;
    let width = width.clamp(1.0, cells.max(1.0));
    // Sum and count of the values before each cell's edge.
    let mut before = vec![[0.0, 0.0]];
    for (i, value) in line.iter().enumerate() {
        let [sum, count] = before[i];
        before.push(if value.is_nan() { [sum, count] } else { [sum + value, count + 1.0] });
    }
    let at = |edge: f64| {
        let cell = (edge as usize).min(line.len() - 1);
        let part = edge - cell as f64;
        [0, 1].map(|k| before[cell][k] + part * (before[cell + 1][k] - before[cell][k]))
    };
    (0..line.len())
        .map(|i| {
            let from = (i as f64 + 0.5 - 0.5 * width).clamp(0.0, cells - width);
            let [[sum, count], [to_sum, to_count]] = [at(from), at(from + width)];
            if to_count - count > 1e-9 { (to_sum - sum) / (to_count - count) } else { f64::NAN }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::averaged;

    /// Marks on a lattice askew, 9.6 cells along the rows and 4.3 along the columns, over an error of form that is a
    /// slope: the slope alone is left away from the edges; a window of half a mark leaves marks.
    #[test]
    fn one_mark_in_both_directions_leaves_the_form() {
        let (columns, rows) = (40, 60);
        let cell = |i: usize| [(i / rows) as f64, (i % rows) as f64];
        let mark = |i: usize| {
            let [u, v] = cell(i);
            let phase = v / 9.6 + 0.3 * u / 4.3;
            5.0 * (std::f64::consts::TAU * phase).cos() + (std::f64::consts::TAU * u / 4.3).cos()
        };
        let slope = |i: usize| 0.1 * cell(i)[1];
        let values: Vec<f32> = (0..columns * rows).map(|i| (mark(i) + slope(i)) as f32).collect();
        let inside = |i: &usize| (5.0..54.0).contains(&cell(*i)[1]) && (3.0..36.0).contains(&cell(*i)[0]);
        let worst = |window: [f64; 2]| {
            let means = averaged(&values, [columns, rows], window);
            let left = (0..values.len()).filter(inside).map(|i| (f64::from(means[i]) - slope(i)).abs());
            left.fold(0.0, f64::max)
        };
        assert!(worst([4.3, 9.6]) < 0.1, "{}", worst([4.3, 9.6]));
        assert!(worst([4.3, 4.8]) > 1.0, "{}", worst([4.3, 4.8]));
    }

    #[test]
    fn cells_without_a_value_do_not_count() {
        let means = averaged(&[1.0, f32::NAN, 3.0, f32::NAN], [1, 4], [1.0, 3.0]);
        assert_eq!(means[..3], [2.0, 2.0, 3.0]);
        assert!(averaged(&[f32::NAN; 4], [2, 2], [2.0, 2.0]).iter().all(|mean| mean.is_nan()));
    }
}
