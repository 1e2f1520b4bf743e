//! Lines that are made one after the other and laid down as columns.
//!
//! In: how line `y` of a map is made. Out: the map turned over, so that the next step, which runs along y, finds its
//! lines in one piece. Law: value x of line y lies at `x * count + y`. A block of lines is made in buffers and written
//! at once, so that whole cache lines are, and no second copy of the map is ever held.

use rayon::prelude::*;

/// Lines of a block: sixteen numbers of 8 bytes are two cache lines.
const BLOCK: usize = 16;

/// `N` maps of `count` lines with `width` values each, turned over; `make` fills line y of all of them.
pub(crate) fn by_columns<T, S, const N: usize>(
    [width, count]: [usize; 2],
    scratch: impl Fn() -> S + Sync,
    make: impl Fn(&mut S, usize, &mut [Vec<T>; N]) + Sync,
) -> [Vec<T>; N]
where
    T: Copy + Default + Send + Sync,
{
    let mut maps: [Vec<T>; N] = std::array::from_fn(|_| rayon::iter::repeat_n(T::default(), width * count).collect());
    // For every block its place in every column.
    let mut blocks: Vec<[Vec<&mut [T]>; N]> =
        (0..count.div_ceil(BLOCK)).map(|_| std::array::from_fn(|_| Vec::with_capacity(width))).collect();
    for (k, map) in maps.iter_mut().enumerate() {
        for column in map.chunks_mut(count) {
            for (block, part) in blocks.iter_mut().zip(column.chunks_mut(BLOCK)) {
                block[k].push(part);
            }
        }
    }
    let buffers =
        || -> Vec<[Vec<T>; N]> { (0..BLOCK).map(|_| std::array::from_fn(|_| vec![T::default(); width])).collect() };
    blocks.into_par_iter().enumerate().for_each_init(
        || (scratch(), buffers()),
        |(scratch, lines), (index, places)| {
            let first = index * BLOCK;
            for (y, line) in (first..count).zip(lines.iter_mut()) {
                make(scratch, y, line);
            }
            for (k, columns) in places.into_iter().enumerate() {
                for (x, column) in columns.into_iter().enumerate() {
                    for (value, line) in column.iter_mut().zip(lines.iter()) {
                        *value = line[k][x];
                    }
                }
            }
        },
    );
    maps
}

/// Columns as rows: `nx` x `ny` values become `ny` x `nx`.
pub(crate) fn transposed<T: Copy + Default + Send + Sync>(values: &[T], nx: usize, ny: usize) -> Vec<T> {
    let [turned] = by_columns([nx, ny], || (), |(), y, [line]| line.copy_from_slice(&values[y * nx..(y + 1) * nx]));
    turned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transposing_twice_changes_nothing() {
        let values: Vec<f64> = (0..37 * 21).map(f64::from).collect();
        let turned = transposed(&values, 37, 21);
        assert_eq!(turned[3 * 21 + 5], values[5 * 37 + 3]);
        assert_eq!(transposed(&turned, 21, 37), values);
    }
}
