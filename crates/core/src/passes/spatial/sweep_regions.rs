//! Regions of a spatial field: dexels that are bounded together by nine rays of theirs, and the parts that they are
//! halved into.
//!
//! In: a field. Out: regions with the dexels of their nine rays, first, middle and last column by first, middle and
//! last row, and how far a smooth function with known values there can leave straight lines between them. Neighbouring
//! regions share their edges.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::sweep_tile::{CELLS, PATCH_CELL, TILE_COLUMNS, TILE_ROWS};
use crate::dexel::SpatialField;
use std::ops::Range;

/// Rays sampled along each side.
pub const SIDE: usize = 3;
/// Rays sampled.
pub const RAYS: usize = SIDE * SIDE;
/// All rays of a region, as bits.
pub const ALL: u32 = (1 << RAYS) - 1;
/// Length of a tile along the tooth at most, mm. Rows far apart stand in shorter tiles, down to one row: over a facet's
/// length and more nothing is smooth enough for a sweep to be culled, and every dexel would visit hundreds. It decides
/// about time alone: of roots with rows 1 mm apart, tiles of 32 rows took 1.9 s, those of one row 0.46 s; of flanks
/// with rows 0.05 mm apart, tiles of 16 rows take 8 % longer to plan and 5 % less to cut than those of 32.
const LONGEST_TILE_MM: f64 = 1.7;
/// Length of a tile of a device at most, along and across the tooth, mm: f32 holds 10 mm to 0.6 nm. Shorter tiles are
/// culled better and have fewer dexels for a device's threads: of a bevel blank with rays 0.5 mm apart, tiles of 1.7 mm
/// would have a dozen.
const LONGEST_FRAME_MM: f64 = 10.0;
/// Length of a patch that is more than a tile, mm: of 4.9 mm by 6.7 mm heights were 2.1 nm off, of 2.5 mm by 6.7 mm
/// 0.95 nm.
const LONGEST_PATCH_MM: f64 = 4.0;

/// Lines of dexels in one direction.
#[derive(Debug, Clone, Copy)]
pub struct LineSpan {
    /// First, middle and last line; all dexels lie between first and last.
    pub at: [usize; SIDE],
    /// Number of tiles.
    pub count: usize,
    tile: usize,
    last: usize,
}

impl LineSpan {
    fn new(from: usize, count: usize, tile: usize, last: usize) -> Self {
        // The one line of a tile of one has no cell in common with the next tile.
        let to = if count == 1 && tile <= 1 { from } else { (from + count * tile).min(last) };
        let mut middle = from + if count > 1 { count / 2 * tile } else { tile / 2 };
        // Of a thin tile that line is sampled at which its first half, which is all of it, will be halved.
        while count == 1 && middle > from && middle >= to {
            middle = from + (middle - from) / 2;
        }
        Self { at: [from, middle, to], count, tile, last }
    }

    /// Whether it is a tile with no line beyond its first half: there is nothing to halve.
    pub fn is_thin(&self) -> bool {
        self.count == 1 && self.at[2] <= self.at[0] + self.tile / 2
    }

    /// Dexels of a tile between first and middle (0) or middle and last line (1) of a part of it: the last line is the
    /// next part's, where there is one.
    pub fn between(&self, part: &Self, half: usize) -> Range<usize> {
        let [from, to] = [part.at[half], part.at[half + 1]];
        from..if to + 1 == self.dexels().end { to + 1 } else { to }.max(from + 1)
    }

    /// Its dexels, tile by tile.
    pub fn tiles(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let Self { at: [from, ..], count, tile, last } = *self;
        (0..count).map(move |i| from + i * tile..(from + (i + 1) * tile).min(last + 1))
    }

    /// Its dexels: the line that it shares with the next tile belongs to that one.
    pub fn dexels(&self) -> Range<usize> {
        self.at[0]..(self.at[0] + self.count * self.tile).min(self.last + 1)
    }

    /// Parts to both sides of the middle line; of a thin tile the first holds all lines.
    pub fn halves(&self) -> [Self; 2] {
        let [from, middle, _] = self.at;
        let (counts, tile) = if self.count > 1 {
            ([self.count / 2, self.count - self.count / 2], self.tile)
        } else {
            ([1, 1], self.tile / 2)
        };
        [Self::new(from, counts[0], tile, self.last), Self::new(middle, counts[1], tile, self.last)]
    }

    /// Weights of three values whose sum is how far a function of second degree through them leaves straight lines
    /// between them. With spacings a and b the second derivative is 2 ((f2 - f1) / b - (f1 - f0) / a) / (a + b), and
    /// the line is left by an eighth of it times the square of the larger spacing. Nothing where two of the values are
    /// one.
    fn bend(&self) -> Option<[f64; SIDE]> {
        let [from, middle, to] = self.at;
        let [a, b] = [middle - from, to - middle].map(|lines| lines as f64);
        if to - from <= 1 {
            return Some([0.0; SIDE]);
        }
        (a > 0.0 && b > 0.0).then(|| {
            let scale = 0.25 * a.max(b).powi(2) / (a + b);
            [scale / a, -scale * (1.0 / a + 1.0 / b), scale / b]
        })
    }
}

/// Dexels that are bounded together.
pub struct Region<'a> {
    /// The field.
    pub field: &'a SpatialField,
    /// Columns.
    pub columns: LineSpan,
    /// Rows.
    pub rows: LineSpan,
    bends: Option<[[f64; SIDE]; 2]>,
    /// Height of the blank along each of the nine rays, column by column.
    pub blank_mm: [f64; RAYS],
}

impl<'a> Region<'a> {
    /// All of a field, in tiles short enough for culling.
    pub fn whole(field: &'a SpatialField) -> Self {
        Self::in_tiles(field, [TILE_COLUMNS, short_tile(TILE_ROWS, LONGEST_TILE_MM, field, [0, 1])])
    }

    /// The same in tiles for frames in f32, which may not reach far in either direction.
    pub fn in_small_tiles(field: &'a SpatialField) -> Self {
        Self::in_tiles(field, Self::small_tile(field))
    }

    /// The same in patches, whose cells a device searches: up to four such tiles.
    pub fn in_patches(field: &'a SpatialField) -> Self {
        let [columns, rows] = PATCH_CELL.map(|lines| CELLS * lines);
        let patch = |most, second| short_tile(most, LONGEST_PATCH_MM, field, second);
        let [tile_columns, tile_rows] = Self::small_tile(field);
        Self::in_tiles(field, [patch(columns, [1, 0]).max(tile_columns), patch(rows, [0, 1]).max(tile_rows)])
    }

    fn small_tile(field: &SpatialField) -> [usize; 2] {
        let tile = |most, second| short_tile(most, LONGEST_FRAME_MM, field, second);
        [tile(TILE_COLUMNS, [1, 0]), tile(TILE_ROWS, [0, 1])]
    }

    /// All of a field, in tiles of so many columns and rows.
    pub fn in_tiles(field: &'a SpatialField, [columns, rows]: [usize; 2]) -> Self {
        let span = |lines: usize, tile: usize| LineSpan::new(0, lines.div_ceil(tile), tile, lines - 1);
        Self::new(field, span(field.columns(), columns), span(field.rows(), rows))
    }

    pub fn new(field: &'a SpatialField, columns: LineSpan, rows: LineSpan) -> Self {
        let bends = columns.bend().zip(rows.bend()).map(|(c, r)| [c, r]);
        let blank_mm =
            std::array::from_fn(|i| f64::from(field.blank_mm[field.index(columns.at[i / SIDE], rows.at[i % SIDE])]));
        Self { field, columns, rows, bends, blank_mm }
    }

    /// Whether it is one tile.
    pub fn is_tile(&self) -> bool {
        self.columns.count == 1 && self.rows.count == 1
    }

    /// Number of its tiles.
    pub fn tiles(&self) -> usize {
        self.columns.count * self.rows.count
    }

    /// The nine rays as dexels.
    pub fn dexels(&self) -> [usize; RAYS] {
        std::array::from_fn(|i| self.field.index(self.columns.at[i / SIDE], self.rows.at[i % SIDE]))
    }

    /// Size along the profile and along the tooth, mm.
    pub fn extent_mm(&self) -> [f64; 2] {
        let at = |i: usize, j: usize| self.field.ray(self.columns.at[i], self.rows.at[j]).origin_mm;
        [at(0, 1).distance(at(2, 1)), at(1, 0).distance(at(1, 2))]
    }

    /// How far a smooth function with these values on the nine rays can leave its bilinear interpolation in any of the
    /// four cells between them.
    #[inline(always)]
    pub fn bend(&self, values: &[f64; RAYS]) -> f64 {
        let Some([across, along]) = &self.bends else { return f64::INFINITY };
        let (mut most_across, mut most_along) = (0.0_f64, 0.0_f64);
        for line in 0..SIDE {
            let [a, b, c] = [0, 1, 2].map(|i| values[SIDE * i + line]);
            most_across = most_across.max((across[0] * a + across[1] * b + across[2] * c).abs());
            let [a, b, c] = [0, 1, 2].map(|i| values[SIDE * line + i]);
            most_along = most_along.max((along[0] * a + along[1] * b + along[2] * c).abs());
        }
        most_across + most_along
    }

    /// Which directions are halved: both, or the longer one; facets are some two and a half times as long as wide. A
    /// tile is halved in both, where it has lines in both halves. Whatever the sizes are, 0 and not a number among
    /// them, something of a region of many tiles is halved: halving ends after as many levels as the counts have bits.
    pub fn split(&self) -> [bool; 2] {
        let [width_mm, length_mm] = self.extent_mm();
        let (wide, long) = (self.columns.count > 1, self.rows.count > 1);
        if self.is_tile() {
            return [!self.columns.is_thin(), !self.rows.is_thin()];
        }
        let (is_narrow, is_short) = (5.0 * width_mm < length_mm, length_mm < 1.25 * width_mm);
        [wide && !(long && is_narrow), long && !(wide && is_short)]
    }
}

/// Lines of a tile, at most so many and so long; the field's second line begins with this column and row.
fn short_tile(most: usize, longest_mm: f64, field: &SpatialField, [column, row]: [usize; 2]) -> usize {
    let is_there = column < field.columns() && row < field.rows();
    let to_mm = if is_there { field.ray(column, row).origin_mm } else { field.ray(0, 0).origin_mm };
    let apart_mm = field.ray(0, 0).origin_mm.distance(to_mm);
    let mut tile = most;
    while tile > 1 && tile as f64 * apart_mm > longest_mm {
        tile /= 2;
    }
    tile
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dexel::Ray;
    use glam::DVec3;

    /// Rays that all lie on one point, and rays of which one is not a number: halving ends.
    #[test]
    fn halving_ends_whatever_the_rays_are() {
        let on_a_point = |_, _| DVec3::X;
        let one_lost =
            |column, row| if column + row == 0 { DVec3::NAN } else { DVec3::new(column as f64, 0.0, row as f64) };
        let lost = |_, _| DVec3::NAN;
        let of_origins: [&dyn Fn(usize, usize) -> DVec3; 3] = [&on_a_point, &one_lost, &lost];
        for origin_mm in of_origins {
            let ray = |column, row| (Ray { origin_mm: origin_mm(column, row), normal: DVec3::X }, 1.0);
            let field = SpatialField::new(100, 300, -0.5, ray);
            let mut open = vec![(Region::whole(&field), 0)];
            let mut tiles = 0;
            while let Some((region, level)) = open.pop() {
                assert!(level <= 10, "7 by 10 tiles have 3 and 4 bits");
                if region.is_tile() {
                    tiles += 1;
                    continue;
                }
                let split = region.split();
                let parts = |span: &LineSpan, split: bool| if split { span.halves().to_vec() } else { vec![*span] };
                for columns in parts(&region.columns, split[0]) {
                    for rows in parts(&region.rows, split[1]) {
                        open.push((Region::new(&field, columns, rows), level + 1));
                    }
                }
            }
            let whole = Region::whole(&field);
            assert_eq!(tiles, whole.columns.count * whole.rows.count);
        }
    }
}
