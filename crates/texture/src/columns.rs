//! Lines that are made one after the other and read as columns.
//!
//! In: how line `y` of some maps is made. Out: [`TurnedMap`], the maps turned over, so that the next step, which runs
//! along y, reads its lines one by one. Law: sixteen lines at a time are made in buffers and kept as a tile, in which
//! the sixteen values of one column lie in one piece, and those of the next column beside them. Columns that are read
//! one after the other read every tile from its front to its end.
//!
//! Road not taken: one vector with every column in one piece. Columns of 2048 complex numbers begin 32 KiB apart, at
//! the same places of every cache, and a vector beyond 32 MiB is fresh from the system, page by page, each time: it
//! took more than twice as long.

use rayon::prelude::*;

/// Lines of a tile: sixteen numbers of 8 bytes are two cache lines.
const LINES: usize = 16;

/// `N` maps turned over.
pub(crate) struct TurnedMap<T, const N: usize> {
    tiles: Vec<[Vec<T>; N]>,
}

impl<T: Copy + Default + Send + Sync, const N: usize> TurnedMap<T, N> {
    /// Maps of `count` lines with `width` values each; `make` fills line y of all of them.
    pub(crate) fn of<S>(
        [width, count]: [usize; 2],
        scratch: impl Fn() -> S + Sync,
        make: impl Fn(&mut S, usize, &mut [Vec<T>; N]) + Sync,
    ) -> Self {
        let lines =
            || -> Vec<[Vec<T>; N]> { (0..LINES).map(|_| std::array::from_fn(|_| vec![T::default(); width])).collect() };
        let tile = |(scratch, lines): &mut (S, Vec<[Vec<T>; N]>), first: usize| {
            let lines = &mut lines[..LINES.min(count - first)];
            for (y, line) in (first..).zip(lines.iter_mut()) {
                make(scratch, y, line);
            }
            std::array::from_fn(|map| {
                let mut tile = vec![T::default(); width * lines.len()];
                for (x, column) in tile.chunks_exact_mut(lines.len()).enumerate() {
                    for (value, line) in column.iter_mut().zip(lines.iter()) {
                        *value = line[map][x];
                    }
                }
                tile
            })
        };
        let starts = (0..count.div_ceil(LINES)).into_par_iter().map(|index| index * LINES);
        Self { tiles: starts.map_init(|| (scratch(), lines()), tile).collect() }
    }

    /// Column `x` of one of the maps, laid into `column`, which has a place for every line.
    pub(crate) fn read(&self, map: usize, x: usize, column: &mut [T]) {
        for (part, tile) in column.chunks_mut(LINES).zip(&self.tiles) {
            part.copy_from_slice(&tile[map][x * part.len()..(x + 1) * part.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_hold_the_values_of_all_lines() {
        let [width, count] = [21, 37];
        let turned = TurnedMap::of(
            [width, count],
            || 0.5,
            |half, y, [line, halves]| {
                line.iter_mut().zip(halves).enumerate().for_each(|(x, (value, halved))| {
                    *value = (100 * y + x) as f64;
                    *halved = *half * *value;
                });
            },
        );
        let mut column = vec![0.0; count];
        for x in 0..width {
            for (map, factor) in [(0, 1.0), (1, 0.5)] {
                turned.read(map, x, &mut column);
                assert!(column.iter().enumerate().all(|(y, value)| *value == factor * (100 * y + x) as f64));
            }
        }
    }
}
