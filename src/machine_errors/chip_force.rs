//! The force of a stroke's chips along one coordinate, as it depends on how far the tool is from its path.
//!
//! In: the elements of the edge in contact ([`EdgeElement`]), each with its chip where the tool is at rest. Out:
//! the force on the tool F(d), d the displacement of the tool less that of the surface which it finds. Law: an
//! element's chip is h = h_0 + m d, its force f(h) in straight pieces, so that F = -sum of f m is a broken line. Forces
//! along inclined edges go with the thickness of all chips.
//!
//! Elements that a displacement lifts off and those that it drives in are two sides: left and right flank, if the tool
//! moves across. Each finds a surface of its own, for a side that is out of the cut keeps the surface that it found.

use super::EdgeElement;
use gearcut_core::cut::LEAST_CHIP_MM;

/// The force of one side, in straight pieces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChipForce {
    /// Corners: displacement and force, by displacement.
    corners: Vec<[f64; 2]>,
    /// Slopes before the first corner and behind the last.
    slopes: [f64; 2],
    /// The tool is out of the cut from here on, or up to here.
    lost: f64,
    /// Whether greater displacements lift this side off.
    lifts: bool,
}

impl ChipForce {
    /// The forces of elements along coordinate `axis`, on the side that greater displacements lift off and on the one
    /// that they drive in; `load` is what inclined edges push with at rest.
    pub fn of_sides(elements: &[EdgeElement], axis: usize, load: f64) -> [Self; 2] {
        let thickness_mm: f64 = elements.iter().map(|element| element.thickness_mm).sum();
        let along = if thickness_mm > 0.0 { load / thickness_mm } else { 0.0 };
        [true, false].map(|lifts| {
            let towards = if lifts { -1.0 } else { 1.0 };
            let of_side = |element: &&EdgeElement| towards * element.moves[axis] > 0.0;
            Self::of_side(elements.iter().filter(of_side), axis, along, lifts)
        })
    }

    fn of_side<'a>(elements: impl Iterator<Item = &'a EdgeElement>, axis: usize, along: f64, lifts: bool) -> Self {
        // From out of the cut inwards: displacements at which the slope changes, and by how much.
        let mut bends: Vec<[f64; 2]> = Vec::new();
        for element in elements {
            let m = element.moves[axis];
            let at = -element.thickness_mm / m;
            let (chip, edge) = (m * (along - m * element.chip_n_per_mm), -m * m * element.edge_n / LEAST_CHIP_MM);
            bends.push([at, chip + edge]);
            bends.push([at + LEAST_CHIP_MM / m, -edge]);
        }
        bends.sort_by(|a, b| if lifts { b[0].total_cmp(&a[0]) } else { a[0].total_cmp(&b[0]) });
        let mut slope = 0.0;
        let mut corners: Vec<[f64; 2]> = Vec::with_capacity(bends.len());
        for [d, bend] in bends {
            let force = corners.last().map_or(0.0, |before| before[1] + slope * (d - before[0]));
            corners.push([d, force]);
            slope += bend;
        }
        let lost = corners.first().map_or(0.0, |corner| corner[0]);
        let slopes = if lifts { [slope, 0.0] } else { [0.0, slope] };
        if lifts {
            corners.reverse();
        }
        Self { corners, slopes, lost, lifts }
    }

    /// Whether this side has chips.
    pub fn is_in_cut(&self) -> bool {
        !self.corners.is_empty()
    }

    /// Force and slope at a displacement.
    pub fn at(&self, d: f64) -> [f64; 2] {
        let Some(last) = self.corners.len().checked_sub(1) else { return [0.0; 2] };
        let behind = self.corners.partition_point(|corner| corner[0] < d);
        let (corner, slope) = match behind {
            0 => (self.corners[0], self.slopes[0]),
            _ if behind > last => (self.corners[last], self.slopes[1]),
            _ => {
                let [from, to] = [self.corners[behind - 1], self.corners[behind]];
                (from, (to[1] - from[1]) / (to[0] - from[0]))
            }
        };
        [corner[1] + slope * (d - corner[0]), slope]
    }

    /// Where the surface lies behind a tool that is at `d`: with it while it cuts.
    pub fn surface(&self, d: f64) -> f64 {
        if self.lifts { d.min(self.lost) } else { d.max(self.lost) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    fn element(thickness_mm: f64, m: f64, chip_n_per_mm: f64, edge_n: f64) -> EdgeElement {
        EdgeElement { thickness_mm, moves: m * DVec4::X, chip_n_per_mm, edge_n }
    }

    /// The broken lines against the sum over the elements.
    #[test]
    fn the_broken_lines_are_the_sum_of_the_elements() {
        let elements: Vec<EdgeElement> = (0..60)
            .map(|i| {
                let a = 0.7 * f64::from(i);
                element(0.02 * (1.1 + a.sin()), (1.3 * a).cos(), 80.0 + f64::from(i), f64::from(i % 4))
            })
            .collect();
        let load = 12.0;
        let sides = ChipForce::of_sides(&elements, 0, load);
        let all_mm: f64 = elements.iter().map(|of| of.thickness_mm).sum();
        let exact = |d: f64| -> f64 {
            let of = |e: &EdgeElement| {
                let h = e.thickness_mm + e.moves.x * d;
                load * h.max(0.0) / all_mm - e.force(h)[0] * e.moves.x
            };
            elements.iter().map(of).sum()
        };
        for i in -400..400 {
            let d = 2.5e-4 * f64::from(i) + 1e-9;
            let [force, slope] = [0, 1].map(|of| sides.iter().map(|side| side.at(d)[of]).sum::<f64>());
            let expected = exact(d);
            assert!((force - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{force} {expected} at {d}");
            let rate = (exact(d + 1e-10) - exact(d - 1e-10)) / 2e-10;
            assert!((slope - rate).abs() < 1e-3 * (1.0 + rate.abs()), "{slope} {rate} at {d}");
        }
    }

    /// A side that is drawn out of the cut keeps the surface where it was lost.
    #[test]
    fn a_side_out_of_the_cut_leaves_the_surface_that_it_found() {
        let elements = [element(0.03, -1.0, 500.0, 3.0), element(0.01, -0.5, 500.0, 3.0), element(0.02, 1.0, 5e3, 0.0)];
        let [lifted, driven] = ChipForce::of_sides(&elements, 0, 0.0);
        assert_eq!([-1.0, 0.0, 0.02, 0.03, 0.5].map(|d| lifted.surface(d)), [-1.0, 0.0, 0.02, 0.03, 0.03]);
        assert_eq!([-0.5, -0.02, 0.0, 0.5].map(|d| driven.surface(d)), [-0.02, -0.02, 0.0, 0.5]);
        assert!(lifted.at(0.04) == [0.0; 2] && driven.at(-0.03) == [0.0; 2]);
        assert!(lifted.at(0.0)[0] > 0.0 && driven.at(0.0)[0] < 0.0);
        assert!(!ChipForce::default().is_in_cut());
    }
}
