//! The edge as both backends read it: x over y in cubic cells of equal width.
//!
//! A segment that is not an arc is tabulated in its own frame (origin at its middle, y along its chord, x out of the
//! tool) as Hermite cubics with direct index. The residual of a ray, `x - U(y)`, then has no division and no
//! transcendental function, which is what keeps the f32 kernels at a fraction of a nanometre on hardware that rounds
//! divisions to 2.5 ULP, and it takes any profile. Beyond its ends the table goes on along its end tangents: candidate
//! bounds need an edge that continues, hits there are not accepted.
//!
//! Road not taken: the analytic involute in the kernel (needs an arctangent; seven times the f32 error).

use super::edge_profile::EdgeProfile;
use crate::error::NotConverged;

/// Largest distance between table and edge: far below what the dexels resolve (0.1 nm).
pub const TABLE_TOLERANCE_MM: f64 = 5e-8;
/// More cells than this mean that the segment should have been split: it would not fit the caches of any backend.
const MAX_CELLS: usize = 4096;

/// Why an edge has no table.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The finest table misses the edge.
    #[error("the edge table keeps an error of {:.3} nm", error_mm * 1e6)]
    Coarse {
        /// By this much at some place, mm.
        error_mm: f64,
    },
    /// The edge has no place with a y of its chord.
    #[error(transparent)]
    NotConverged(#[from] NotConverged),
}

/// Cubic table of one segment.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeTable {
    /// y of the first cell's start, mm; the last cell ends at `-y_start_mm` or wherever the cells end.
    pub y_start_mm: f64,
    /// 1 / cell width.
    pub cells_per_mm: f64,
    /// Coefficients of `x = c0 + t (c1 + t (c2 + t c3))`, t = y - start of the cell, mm.
    pub cells: Vec<[f64; 4]>,
    /// End of the last cell: every look at the edge needs it, so it is divided once.
    y_end_mm: f64,
}

impl EdgeTable {
    /// Table of a profile between two places, both given as y; halves the cells until the largest error met is below
    /// [`TABLE_TOLERANCE_MM`].
    ///
    /// # Errors
    /// Even 4096 cells do not reach the tolerance, or the profile has no place with some y.
    pub fn fit(profile: &impl EdgeProfile, [y0, y1]: [f64; 2]) -> Result<Self, TableError> {
        let at = |count: usize, node: usize| profile.x_and_slope(y0 + (y1 - y0) / count as f64 * node as f64);
        let (mut count, mut worst_cell) = (1, 0);
        let mut nodes = vec![at(1, 0)?, at(1, 1)?];
        loop {
            let table = Self::through(&nodes, [y0, y1]);
            let Some((cell, error_mm)) = table.missed(profile, worst_cell)? else { return Ok(table) };
            if count >= MAX_CELLS {
                return Err(TableError::Coarse { error_mm });
            }
            // Where it misses, halves are likely to miss again.
            (count, worst_cell) = (2 * count, 2 * cell);
            // Halved cells begin where whole ones do, to the last bit.
            let between = (1..count).step_by(2).map(|node| at(count, node)).collect::<Result<Vec<_>, _>>()?;
            let last = nodes[nodes.len() - 1];
            nodes = nodes.into_iter().zip(between).flat_map(|(node, between)| [node, between]).chain([last]).collect();
        }
    }

    /// Table through x and dx/dy at places evenly from the first y to the last one.
    pub fn through(nodes: &[[f64; 2]], [y0, y1]: [f64; 2]) -> Self {
        let width = (y1 - y0) / (nodes.len() - 1) as f64;
        let cells = nodes
            .windows(2)
            .map(|node| {
                let ([x0, s0], [x1, s1]) = (node[0], node[1]);
                let secant = (x1 - x0) / width;
                [x0, s0, (3.0 * secant - 2.0 * s0 - s1) / width, (s0 + s1 - 2.0 * secant) / (width * width)]
            })
            .collect();
        Self::of_cells(y0, 1.0 / width, cells)
    }

    fn of_cells(y_start_mm: f64, cells_per_mm: f64, cells: Vec<[f64; 4]>) -> Self {
        let y_end_mm = y_start_mm + cells.len() as f64 / cells_per_mm;
        Self { y_start_mm, cells_per_mm, cells, y_end_mm }
    }

    /// Largest distance from another table over the same range along x, mm: a bound, from nodes, middles and slopes of
    /// the cells here.
    pub fn largest_distance_mm(&self, other: &Self) -> f64 {
        let width = 1.0 / self.cells_per_mm;
        let at = |y: f64| {
            let ([x, slope], [other_x, other_slope]) = (self.x_and_slope(y), other.x_and_slope(y));
            (x - other_x, (slope - other_slope).abs())
        };
        (0..self.cells.len())
            .map(|cell| {
                let start = self.y_start_mm + width * cell as f64;
                let [from, middle, to] = [0.0, 0.5, 1.0].map(|share| at(start + share * width));
                // Hermite's form of the difference: the values' part lies between them, that of the slopes is
                // t (1 - t) times something between both. The other table is one cubic there, or nearly so.
                let (ends, slopes) = (from.0.abs().max(to.0.abs()), from.1.max(to.1));
                middle.0.abs().max(ends + 0.25 * width * slopes)
            })
            .fold(0.0, f64::max)
    }

    /// The first cell from one on, round and round, that misses a profile by more than [`TABLE_TOLERANCE_MM`], and by
    /// how much, mm: at three places inside every cell (a Hermite cubic errs most near the middle).
    fn missed(&self, profile: &impl EdgeProfile, first: usize) -> Result<Option<(usize, f64)>, NotConverged> {
        let width = 1.0 / self.cells_per_mm;
        for cell in (first..self.cells.len()).chain(0..first) {
            for part in [0.25, 0.5, 0.75] {
                let y = self.y_start_mm + width * (cell as f64 + part);
                let error_mm = (self.x_and_slope(y)[0] - profile.x_and_slope(y)?[0]).abs();
                if error_mm > TABLE_TOLERANCE_MM {
                    return Ok(Some((cell, error_mm)));
                }
            }
        }
        Ok(None)
    }

    /// End of the last cell.
    pub fn y_end_mm(&self) -> f64 {
        self.y_end_mm
    }

    /// x and dx/dy at `y_mm`; along the end tangents outside.
    pub fn x_and_slope(&self, y_mm: f64) -> [f64; 2] {
        let inside = y_mm.clamp(self.y_start_mm, self.y_end_mm);
        let index = (((inside - self.y_start_mm) * self.cells_per_mm) as usize).min(self.cells.len() - 1);
        let [c0, c1, c2, c3] = self.cells[index];
        let t = inside - self.y_start_mm - index as f64 / self.cells_per_mm;
        let slope = c1 + t * (2.0 * c2 + t * (3.0 * c3));
        [c0 + t * (c1 + t * (c2 + t * c3)) + (y_mm - inside) * slope, slope]
    }

    /// By how much the slope differs at most between two places, for each mm between them.
    pub fn largest_bend_per_mm(&self) -> f64 {
        let width = 1.0 / self.cells_per_mm;
        let bends = self.cells.iter().flat_map(|[_, _, c2, c3]| [2.0 * c2, 2.0 * c2 + 6.0 * c3 * width]);
        bends.map(f64::abs).fold(0.0, f64::max)
    }

    /// Curvature of the edge at `y_mm` in 1/mm, positive where the tool is convex; 0 outside.
    pub fn curvature(&self, y_mm: f64) -> f64 {
        let place = (y_mm - self.y_start_mm) * self.cells_per_mm;
        if place < 0.0 || place >= self.cells.len() as f64 {
            return 0.0;
        }
        let index = place as usize;
        let [_, c1, c2, c3] = self.cells[index];
        let t = y_mm - self.y_start_mm - index as f64 / self.cells_per_mm;
        let slope = c1 + t * (2.0 * c2 + t * (3.0 * c3));
        let stretch = 1.0 + slope * slope;
        -(2.0 * c2 + 6.0 * c3 * t) / (stretch * stretch.sqrt())
    }

    /// The table of x = U(-y).
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let w = 1.0 / self.cells_per_mm;
        let turn = |&[c0, c1, c2, c3]: &[f64; 4]| {
            [c0 + w * (c1 + w * (c2 + w * c3)), -(c1 + w * (2.0 * c2 + w * 3.0 * c3)), c2 + 3.0 * w * c3, -c3]
        };
        Self::of_cells(-self.y_end_mm, self.cells_per_mm, self.cells.iter().rev().map(turn).collect())
    }
}
