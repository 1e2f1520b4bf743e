//! Hills of a surface: watershed, and Wolf pruning of those that are too low.
//!
//! Every point belongs to the hill that its steepest way up leads to. Two neighbouring hills meet in a saddle, the highest pass between them. Wolf pruning takes the hill that rises
//! least over its highest saddle and gives it to the neighbour there, until all rise at least by the threshold. Going through the saddles from the highest down and letting the lower of two peaks
//! end at the saddle where they first meet does the same in one sweep (the rise that is compared is the persistence of the peak).
//!
//! Neighbours are all eight. Equal heights are told apart by their place in the map, so that plateaus have one peak. Holes end a hill as the edge of the map does. Dales are the hills of
//! the surface turned upside down.
//!
//! Source: G. W. Wolf, "Metric surface networks", Proc. 4th Int. Symp. on Spatial Data Handling, 1990; ISO 25178-2:2021, clause on segmentation.

use rayon::prelude::*;

use super::surface::Surface;

/// A hill that was left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hill {
    /// Index of the peak in the surface's heights.
    pub peak: usize,
    /// Whether the hill reaches the edge of the map or a hole.
    pub open: bool,
}

/// A place where two hills meet.
#[derive(Clone, Copy)]
struct Saddle {
    height: f64,
    hills: [u32; 2],
}

/// Hills of a surface (`sign` 1) or its dales (`sign` -1) that rise at least `threshold_um` over their highest saddle.
pub(super) fn hills(surface: &Surface, sign: f64, threshold_um: f64) -> Vec<Hill> {
    let grid = Grid { surface, sign };
    let (mut hill_of, peaks) = grid.climb();
    let open = grid.open(&hill_of, peaks.len());
    let mut saddles = grid.saddles(&hill_of);
    hill_of.clear();
    saddles.par_sort_unstable_by(|a, b| b.height.total_cmp(&a.height).then(a.hills.cmp(&b.hills)));
    let rank = |hill: u32| (grid.at(peaks[hill as usize]), std::cmp::Reverse(peaks[hill as usize]));
    let higher = |a: u32, b: u32| {
        let (ra, rb) = (rank(a), rank(b));
        ra.0.total_cmp(&rb.0).then(ra.1.cmp(&rb.1)).is_gt()
    };
    // Islands: what has met already, each with its highest peak as the root. Merged: hills given to a neighbour.
    let mut islands = Parents::new(peaks.len());
    let mut merged = Parents::new(peaks.len());
    for Saddle { height, hills: [a, b] } in saddles {
        let (island_a, island_b) = (islands.root(a), islands.root(b));
        if island_a == island_b {
            continue;
        }
        let (winner, loser, side) =
            if higher(island_a, island_b) { (island_a, island_b, a) } else { (island_b, island_a, b) };
        islands.0[loser as usize] = winner;
        if grid.at(peaks[loser as usize]) - height < threshold_um {
            // A hill that ends here has met only lower ones, all given to it: it is one hill.
            let into = merged.root(side);
            merged.0[loser as usize] = into;
        }
    }
    let mut is_open = vec![false; peaks.len()];
    for (hill, open) in open.into_iter().enumerate() {
        let root = merged.root(hill as u32) as usize;
        is_open[root] |= open;
    }
    (0..peaks.len())
        .filter(|&hill| merged.0[hill] as usize == hill)
        .map(|hill| Hill { peak: peaks[hill], open: is_open[hill] })
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

/// No hill: a hole.
const HOLE: u32 = u32::MAX;

struct Grid<'a> {
    surface: &'a Surface,
    sign: f64,
}

impl Grid<'_> {
    fn at(&self, index: usize) -> f64 {
        self.sign * self.surface.heights_um()[index]
    }

    /// Whether point `a` stands above point `b`; equal ones by their place. Never for holes.
    fn above(&self, a: usize, b: usize) -> bool {
        let (za, zb) = (self.at(a), self.at(b));
        za > zb || (za == zb && a < b)
    }

    /// Indices of the neighbours of a point that lie in the map.
    fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let (nx, ny) = (self.surface.nx(), self.surface.ny());
        let (x, y) = (index % nx, index / nx);
        (y.saturating_sub(1)..(y + 2).min(ny))
            .flat_map(move |v| (x.saturating_sub(1)..(x + 2).min(nx)).map(move |u| v * nx + u))
            .filter(move |&n| n != index)
    }

    /// The hill of every point, and the peak of every hill.
    fn climb(&self) -> (Vec<u32>, Vec<usize>) {
        let nx = self.surface.nx();
        let heights = self.surface.heights_um();
        let mut way: Vec<u32> = vec![HOLE; heights.len()];
        way.par_chunks_mut(nx).enumerate().for_each(|(y, row)| {
            for (x, step) in row.iter_mut().enumerate() {
                let index = y * nx + x;
                if heights[index].is_nan() {
                    continue;
                }
                let up = self
                    .neighbours(index)
                    .filter(|&n| self.above(n, index))
                    .reduce(|best, n| if self.above(n, best) { n } else { best });
                *step = up.unwrap_or(index) as u32;
            }
        });
        let mut peaks = Vec::new();
        let mut hill_of = vec![HOLE; way.len()];
        for (index, &up) in way.iter().enumerate() {
            if up as usize == index {
                hill_of[index] = peaks.len() as u32;
                peaks.push(index);
            }
        }
        let mut path = Vec::new();
        for start in 0..way.len() {
            let mut index = start;
            while way[index] != HOLE && hill_of[index] == HOLE {
                path.push(index);
                index = way[index] as usize;
            }
            let hill = hill_of[index];
            for step in path.drain(..) {
                hill_of[step] = hill;
            }
        }
        (hill_of, peaks)
    }

    /// Which hills reach the edge of the map or a hole.
    fn open(&self, hill_of: &[u32], hills: usize) -> Vec<bool> {
        let (nx, ny) = (self.surface.nx(), self.surface.ny());
        let mut open = vec![false; hills];
        let holes = hill_of.contains(&HOLE);
        for (index, &hill) in hill_of.iter().enumerate().filter(|(_, hill)| **hill != HOLE) {
            let (x, y) = (index % nx, index / nx);
            let edge = x == 0 || y == 0 || x + 1 == nx || y + 1 == ny;
            if edge || (holes && self.neighbours(index).any(|n| hill_of[n] == HOLE)) {
                open[hill as usize] = true;
            }
        }
        open
    }

    /// Passes between hills, one for each point and each other hill among its higher neighbours.
    fn saddles(&self, hill_of: &[u32]) -> Vec<Saddle> {
        let nx = self.surface.nx();
        let rows: Vec<Vec<Saddle>> = (0..self.surface.ny())
            .into_par_iter()
            .map(|y| {
                let mut found = Vec::new();
                for index in y * nx..(y + 1) * nx {
                    let hill = hill_of[index];
                    if hill == HOLE {
                        continue;
                    }
                    let first = found.len();
                    for n in self.neighbours(index) {
                        let other = hill_of[n];
                        if other != hill && other != HOLE && self.above(n, index) {
                            let saddle = Saddle { height: self.at(index), hills: [hill, other] };
                            if found[first..].iter().all(|s: &Saddle| s.hills != saddle.hills) {
                                found.push(saddle);
                            }
                        }
                    }
                }
                found
            })
            .collect();
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
        assert_eq!(hills(&alone, 1.0, 0.1), [Hill { peak: 60, open: true }]);
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
