//! Hills of a surface: watershed, and Wolf pruning of those that are too low.
//!
//! Every point belongs to the hill that its steepest path up leads to. Two neighbouring hills meet in a saddle, the
//! highest pass between them. Wolf pruning takes the hill that rises least over its highest saddle and gives it to the
//! neighbour there, until all rise at least by the threshold. Going through the saddles from the highest down and
//! letting the lower of two peaks end at the saddle where they first meet does the same in one sweep (the rise that is
//! compared is the persistence of the peak).
//!
//! A place has eight neighbours. Equal heights are told apart by their place in the map, so that plateaus have one
//! peak. Holes end a hill as the edge of the map does. Dales are the hills of the surface turned upside down.
//!
//! Source: G. W. Wolf, "Metric surface networks", Proc. 4th Int. Symp. on Spatial Data Handling, 1990; ISO
//! 25178-2:2021, clause on segmentation.

use rayon::prelude::*;

use super::surface::Surface;

/// A hill that was left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hill {
    /// Index of the peak in the surface's heights.
    pub peak: usize,
    /// Whether the hill reaches the edge of the map or a hole.
    pub open: bool,
    /// Points that belong to it, those of pruned neighbours included.
    pub points: usize,
}

/// A place where two hills meet.
#[derive(Clone, Copy)]
struct Saddle {
    height: f64,
    hills: [u32; 2],
}

/// Hills of a surface (`sign` 1) or its dales (`sign` -1) that rise at least `threshold_um` over their highest saddle.
pub(crate) fn hills(surface: &Surface, sign: f64, threshold_um: f64) -> Vec<Hill> {
    let grid = Grid::new(surface, sign);
    let (hill_of, peaks) = grid.climb();
    let open = grid.open(&hill_of, peaks.len());
    let mut saddles = grid.saddles(&hill_of);
    let mut points = vec![0_usize; peaks.len()];
    for &hill in hill_of.iter().filter(|&&hill| hill != HOLE) {
        points[hill as usize] += 1;
    }
    drop(hill_of);
    saddles.par_sort_unstable_by(|a, b| b.height.total_cmp(&a.height).then(a.hills.cmp(&b.hills)));
    // Islands: what has met already, each with its highest peak as the root. Merged: hills given to a neighbour.
    let mut islands = Parents::new(peaks.len());
    let mut merged = Parents::new(peaks.len());
    for Saddle { height, hills: [a, b] } in saddles {
        let (island_a, island_b) = (islands.root(a), islands.root(b));
        if island_a == island_b {
            continue;
        }
        let a_is_higher = grid.above(peaks[island_a as usize], peaks[island_b as usize]);
        let (winner, loser, side) = if a_is_higher { (island_a, island_b, a) } else { (island_b, island_a, b) };
        islands.0[loser as usize] = winner;
        if grid.z[peaks[loser as usize]] - height < threshold_um {
            // A hill that ends here has met only lower ones, all given to it: it is one hill.
            let into = merged.root(side);
            merged.0[loser as usize] = into;
        }
    }
    let mut is_open = open;
    for hill in 0..peaks.len() {
        let root = merged.root(hill as u32) as usize;
        if root != hill {
            is_open[root] |= is_open[hill];
            points[root] += points[hill];
        }
    }
    (0..peaks.len())
        .filter(|&hill| merged.0[hill] as usize == hill)
        .map(|hill| Hill { peak: grid.index_in_surface(peaks[hill]), open: is_open[hill], points: points[hill] })
        .collect()
}

/// Union-find.
struct Parents(Vec<u32>);

impl Parents {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut node: u32) -> u32 {
        while self.0[node as usize] != node {
            let above = self.0[self.0[node as usize] as usize];
            self.0[node as usize] = above;
            node = above;
        }
        node
    }
}

/// Rows whose passes are looked for at once; fixed, so that the number of threads never changes an order.
const ROWS: usize = 16;
/// No hill: a hole, or the frame round the map.
const HOLE: u32 = u32::MAX;

/// Heights in a frame of one point, so that every point has eight neighbours at fixed distances. Frame and holes lie
/// below everything.
struct Grid {
    z: Vec<f64>,
    /// Points along a row, frame included.
    width: usize,
    nx: usize,
    ny: usize,
    holes: bool,
}

impl Grid {
    fn new(surface: &Surface, sign: f64) -> Self {
        let (nx, ny) = (surface.nx(), surface.ny());
        let width = nx + 2;
        let mut z = vec![f64::NEG_INFINITY; width * (ny + 2)];
        z.par_chunks_mut(width).skip(1).take(ny).enumerate().for_each(|(y, row)| {
            for (framed, height) in row[1..=nx].iter_mut().zip(surface.row(y)) {
                if !height.is_nan() {
                    *framed = sign * height;
                }
            }
        });
        Self { z, width, nx, ny, holes: surface.holes() > 0 }
    }

    fn index_in_surface(&self, index: usize) -> usize {
        (index / self.width - 1) * self.nx + index % self.width - 1
    }

    /// The eight neighbours of a point that is not on the frame.
    fn neighbours(&self, index: usize) -> [usize; 8] {
        let (up, down) = (index - self.width, index + self.width);
        [up - 1, up, up + 1, index - 1, index + 1, down - 1, down, down + 1]
    }

    /// Whether point `a` stands above point `b`; equal ones by their place.
    fn above(&self, a: usize, b: usize) -> bool {
        self.z[a] > self.z[b] || (self.z[a] == self.z[b] && a < b)
    }

    /// The hill of every point, and the peak of every hill.
    fn climb(&self) -> (Vec<u32>, Vec<usize>) {
        let mut uphill: Vec<u32> = vec![HOLE; self.z.len()];
        uphill.par_chunks_mut(self.width).enumerate().skip(1).take(self.ny).for_each(|(y, row)| {
            for (x, step) in row.iter_mut().enumerate().skip(1).take(self.nx) {
                let index = y * self.width + x;
                if self.z[index] == f64::NEG_INFINITY {
                    continue;
                }
                let mut best = index;
                for n in self.neighbours(index) {
                    if self.above(n, best) {
                        best = n;
                    }
                }
                *step = best as u32;
            }
        });
        let mut peaks = Vec::new();
        let mut hill_of = vec![HOLE; uphill.len()];
        for (index, &up) in uphill.iter().enumerate() {
            if up as usize == index {
                hill_of[index] = peaks.len() as u32;
                peaks.push(index);
            }
        }
        let mut path = Vec::new();
        for start in 0..uphill.len() {
            let mut index = start;
            while uphill[index] != HOLE && hill_of[index] == HOLE {
                path.push(index);
                index = uphill[index] as usize;
            }
            let hill = hill_of[index];
            for step in path.drain(..) {
                hill_of[step] = hill;
            }
        }
        (hill_of, peaks)
    }

    /// Which hills reach the edge of the map or a hole: those with the frame or a hole beside them.
    fn open(&self, hill_of: &[u32], hills: usize) -> Vec<bool> {
        let mut open = vec![false; hills];
        for y in 1..=self.ny {
            let inside = y > 1 && y < self.ny && !self.holes;
            let step = if inside { (self.nx - 1).max(1) } else { 1 };
            for index in (y * self.width + 1..=y * self.width + self.nx).step_by(step) {
                let hill = hill_of[index];
                if hill != HOLE && self.neighbours(index).into_iter().any(|n| hill_of[n] == HOLE) {
                    open[hill as usize] = true;
                }
            }
        }
        open
    }

    /// Passes between hills: of some rows the highest from each hill to each other among its higher neighbours. A lower
    /// one would meet hills that have met already.
    fn saddles(&self, hill_of: &[u32]) -> Vec<Saddle> {
        let of_rows = |first: usize| {
            let mut found = Vec::new();
            for y in first..(first + ROWS).min(self.ny + 1) {
                for index in y * self.width + 1..=y * self.width + self.nx {
                    let hill = hill_of[index];
                    if hill == HOLE {
                        continue;
                    }
                    for n in self.neighbours(index) {
                        let other = hill_of[n];
                        if other != hill && other != HOLE && self.above(n, index) {
                            found.push(Saddle { height: self.z[index], hills: [hill, other] });
                        }
                    }
                }
            }
            found.sort_unstable_by(|a, b| a.hills.cmp(&b.hills).then(b.height.total_cmp(&a.height)));
            found.dedup_by_key(|saddle| saddle.hills);
            found.shrink_to_fit();
            found
        };
        let rows: Vec<Vec<Saddle>> =
            (0..self.ny.div_ceil(ROWS)).into_par_iter().map(|k| of_rows(1 + k * ROWS)).collect();
        rows.concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Profile of heights repeated along y, so that ridges are hills.
    fn ridges(profile: &[f64]) -> Surface {
        let heights = profile.repeat(4);
        Surface::new(profile.len(), 4, 1.0, 1.0, heights).expect("a grid")
    }

    fn peaks_of(surface: &Surface, sign: f64, threshold: f64) -> Vec<usize> {
        let mut peaks: Vec<usize> = hills(surface, sign, threshold).iter().map(|h| h.peak % surface.nx()).collect();
        peaks.sort_unstable();
        peaks
    }

    #[test]
    fn pruning_takes_the_lowest_rise_first_and_keeps_the_rest() {
        //                    0    1    2    3    4    5    6    7    8    9   10
        let surface = ridges(&[0.0, 5.0, 4.5, 4.8, 1.0, 3.0, 2.0, 9.0, 0.5, 2.0, 0.0]);
        assert_eq!(peaks_of(&surface, 1.0, 0.0), [1, 3, 5, 7, 9]);
        assert_eq!(peaks_of(&surface, 1.0, 0.4), [1, 5, 7, 9], "4.8 rises 0.3 over 4.5");
        assert_eq!(peaks_of(&surface, 1.0, 1.2), [1, 7, 9], "3 rises 1 over 2");
        assert_eq!(peaks_of(&surface, 1.0, 2.0), [1, 7], "2 rises 1.5 over 0.5, 5 rises 4 over 1");
        assert_eq!(peaks_of(&surface, 1.0, 100.0), [7], "the highest peak is never pruned");
        assert_eq!(
            peaks_of(&surface, -1.0, 1.2),
            [0, 4, 8, 10],
            "dales: 4.5 falls 0.3 and 2 falls 1 under the way out"
        );
    }

    #[test]
    fn edges_and_holes_open_a_hill() {
        let cone = |x: f64, y: f64| -((x - 5.0).hypot(y - 5.0));
        let heights: Vec<f64> = (0..121).map(|i| cone(f64::from(i % 11), f64::from(i / 11))).collect();
        // One hill fills the map: it reaches the edge.
        let alone = Surface::new(11, 11, 1.0, 1.0, heights.clone()).expect("a grid");
        assert_eq!(hills(&alone, 1.0, 0.1), [Hill { peak: 60, open: true, points: 121 }]);
        // A rim round it takes the edge.
        let mut rimmed = heights;
        for (i, z) in rimmed.iter_mut().enumerate() {
            if [0, 10].contains(&(i % 11)) || [0, 10].contains(&(i / 11)) {
                *z = 1.0;
            }
        }
        let inner = |s: &Surface| hills(s, 1.0, 0.1).into_iter().find(|h| h.peak == 60).expect("the cone stays");
        assert!(!inner(&Surface::new(11, 11, 1.0, 1.0, rimmed.clone()).expect("a grid")).open);
        rimmed[4 * 11 + 4] = f64::NAN;
        assert!(inner(&Surface::new(11, 11, 1.0, 1.0, rimmed).expect("a grid")).open);
    }
}
