//! Marks that a built-up edge tears into a flank: where they may lie, and what each of them looks like.
//!
//! Work material welds to a cutting edge that is neither too slow nor too fast, grows and breaks off; what breaks off
//! tears pits and scratches into the surface. In: densities and sizes as the scene gives them, a source of random
//! numbers, a part of a flank. Out: marks that may be there; which of them are,
//! `crate::process::shaping::cut::tearing` says.
//!
//! **Density.** Marks are a Poisson process over the flank with the density
//!
//! `lambda(v, h) = lambda_0 W(v) min(1, (h / h_0)^p)`
//!
//! in the cutting speed v and the thickness h of the chip that left the place. W rises in a straight line from 0 at v_1
//! to 1 at v_2 and falls from v_3 to v_4. It is drawn by thinning (Lewis and Shedler, *Simulation of nonhomogeneous
//! Poisson processes by thinning*, Naval Research Logistics Quarterly 26, 1979): marks of the density lambda_0, each
//! with a lot that is even between 0 and 1, of which those stay whose lot is below the rest of the product.
//!
//! **Shape.** An elliptic paraboloid d (1 - rho^2), rho = 1 its rim, a scratch long along the stroke, a pit as long as
//! wide in the mean; width and length are even between nothing and twice their means, d is exponential, which assumes
//! nothing but its mean; all three are independent. Marks that overlap add up. For half axes a and b: integral d pi a b
//! / 2, of the square d^2 pi a b / 3. By Campbell's theorem (Rice, *Mathematical analysis of random noise*, Bell System
//! Technical Journal 23, 1944) the flank is lowered by lambda E(d) pi E(a) E(b) / 2 in the mean, with the variance
//! lambda E(d^2) pi E(a) E(b) / 3, E(d^2) = 2 E(d)^2.
//!
//! **Same marks on any grid.** A flank is divided into cells of [`CELL_MM`], counted from its form point and the middle
//! of the face. Each cell has a key of its own, and its marks follow from that.
//!
//! Road not taken: marks in the order of a field's rays. Another spacing would be another gear.

use crate::process::shaping::scene::model::BuiltUpEdge;
use crate::random::Draws;

/// Size of a cell, mm: a choice; at usual densities some marks lie in it.
const CELL_MM: f64 = 0.25;

/// A place on a flank: arc from its form point, height over the middle of the face; mm.
pub type Place = [f64; 2];

/// A mark that may be there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TornMark {
    /// Its middle.
    pub place_mm: Place,
    /// Depth in the middle, mm.
    pub depth_mm: f64,
    /// Half axes along the profile and along the tooth, mm.
    pub half_mm: [f64; 2],
    /// It is there where the share of the densest marks is above this.
    pub lot: f64,
}

impl TornMark {
    /// How deep it is at a place, mm; nothing outside its rim.
    pub fn depth_at_mm(&self, place_mm: Place) -> f64 {
        let from_middle = |axis: usize| (place_mm[axis] - self.place_mm[axis]) / self.half_mm[axis];
        let [x, z] = [0, 1].map(from_middle);
        self.depth_mm * (1.0 - x * x - z * z).max(0.0)
    }
}

impl BuiltUpEdge {
    /// W: share of the densest marks at a cutting speed.
    pub fn speed_share(&self, speed_mm_per_s: f64) -> f64 {
        let [from, full_from, full_to, to] = self.speeds_mm_per_s;
        match speed_mm_per_s {
            v if v <= from || v >= to => 0.0,
            v if v < full_from => (v - from) / (full_from - from),
            v if v > full_to => (to - v) / (to - full_to),
            _ => 1.0,
        }
    }

    /// Share of the densest marks behind a chip so thick.
    pub fn chip_share(&self, thickness_mm: f64) -> f64 {
        (thickness_mm / self.chip_mm).powf(self.chip_exponent).min(1.0)
    }

    /// Half axes of marks in the mean, mm.
    fn half_mm(&self, is_scratch: bool) -> [f64; 2] {
        [0.5 * self.width_mm, 0.5 * if is_scratch { self.scratch_length_mm } else { self.width_mm }]
    }

    /// How far a mark reaches from its middle at most, along the profile and along the tooth, mm.
    pub fn reach_mm(&self) -> [f64; 2] {
        let [pit, scratch] = [false, true].map(|is_scratch| self.half_mm(is_scratch));
        [0, 1].map(|axis| 2.0 * pit[axis].max(scratch[axis]))
    }

    /// By how much a flank is lowered in the mean, mm, and the root mean square of the heights about it, where marks
    /// are densest: Campbell's theorem.
    #[cfg(feature = "testing")]
    pub fn mean_and_rq_mm(&self) -> [f64; 2] {
        let area_mm2 = |is_scratch: bool| self.half_mm(is_scratch).iter().product::<f64>() * std::f64::consts::PI;
        let share = self.scratch_share;
        let covered = self.density_per_mm2 * (share * area_mm2(true) + (1.0 - share) * area_mm2(false));
        let square_mm2 = 2.0 * self.depth_mm * self.depth_mm;
        [self.depth_mm * covered / 2.0, (square_mm2 * covered / 3.0).sqrt()]
    }

    /// All marks that may lie between two places of a flank, and some beyond them.
    pub fn marks(&self, draws: Draws, flank: i64, [from_mm, to_mm]: [Place; 2]) -> Vec<TornMark> {
        let cell = |mm: f64| (mm / CELL_MM).floor() as i64;
        let mut marks = Vec::new();
        for column in cell(from_mm[0])..=cell(to_mm[0]) {
            for row in cell(from_mm[1])..=cell(to_mm[1]) {
                let mut even = draws.even([flank, (column << 32) + row]);
                // Arrivals of a process whose gaps have the mean 1: as many as come before the mean of the cell.
                let mut left = self.density_per_mm2 * CELL_MM * CELL_MM;
                loop {
                    left += even().ln();
                    if left < 0.0 {
                        break;
                    }
                    let place_mm = [column, row].map(|at| (at as f64 + even()) * CELL_MM);
                    let depth_mm = -self.depth_mm * even().ln();
                    let mean_mm = self.half_mm(even() <= self.scratch_share);
                    let half_mm = mean_mm.map(|mean_mm| 2.0 * even() * mean_mm);
                    marks.push(TornMark { place_mm, depth_mm, half_mm, lot: even() });
                }
            }
        }
        marks
    }
}

#[cfg(test)]
pub(in crate::process::shaping) mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Marks without a meaning for a gear.
    pub fn some_marks() -> BuiltUpEdge {
        BuiltUpEdge {
            density_per_mm2: 30.0,
            speeds_mm_per_s: [50.0, 100.0, 300.0, 700.0],
            chip_mm: 0.001,
            chip_exponent: 0.5,
            depth_mm: 0.002,
            width_mm: 0.05,
            scratch_share: 0.4,
            scratch_length_mm: 0.3,
            seed: 1,
        }
    }

    /// Depths at points 0.02 mm apart between two places: marks add up.
    fn depths_mm(edge: &BuiltUpEdge, seed: u32, [from_mm, to_mm]: [Place; 2]) -> Vec<f64> {
        let reach = edge.reach_mm();
        let around = [[0, 1].map(|axis| from_mm[axis] - reach[axis]), [0, 1].map(|axis| to_mm[axis] + reach[axis])];
        let count = [0, 1].map(|axis| ((to_mm[axis] - from_mm[axis]) / 0.02).round() as usize);
        let mut depths_mm = vec![0.0; count[0] * count[1]];
        for mark in edge.marks(Draws::new(seed, 9), 3, around) {
            let near = |axis: usize| {
                let at = |side: f64| (mark.place_mm[axis] + side * mark.half_mm[axis] - from_mm[axis]) / 0.02;
                at(-1.0).max(0.0) as usize..(at(1.0).max(-1.0) + 1.0).min(count[axis] as f64) as usize
            };
            for column in near(0) {
                for row in near(1) {
                    let place = [from_mm[0] + 0.02 * column as f64, from_mm[1] + 0.02 * row as f64];
                    depths_mm[column * count[1] + row] += mark.depth_at_mm(place);
                }
            }
        }
        depths_mm
    }

    /// Mean and variance over 300 surfaces of 4 mm by 3 mm against Campbell's theorem; the standard error is that of
    /// the
    /// surfaces, which are independent.
    #[test]
    fn heights_have_the_mean_and_the_variance_of_campbell() {
        let edge = some_marks();
        let [mean_mm, rq_mm] = edge.mean_and_rq_mm();
        // By hand: a b pi for pits and scratches, as the scene's keys have them.
        let covered = 30.0 * PI * (0.6 * 0.025 * 0.025 + 0.4 * 0.025 * 0.15);
        assert!((mean_mm / (0.002 * covered / 2.0) - 1.0).abs() < 1e-12);
        assert!((rq_mm.powi(2) / (2.0 * 0.002_f64.powi(2) * covered / 3.0) - 1.0).abs() < 1e-12);
        let surfaces: Vec<[f64; 2]> = (0..300)
            .map(|seed| {
                let depths = depths_mm(&edge, seed, [[0.9, -1.4], [4.9, 1.6]]);
                let count = depths.len() as f64;
                let mean = depths.iter().sum::<f64>() / count;
                [mean, depths.iter().map(|depth| (depth - mean_mm).powi(2)).sum::<f64>() / count]
            })
            .collect();
        for (of, expected) in [(0, mean_mm), (1, rq_mm * rq_mm)] {
            let mean = surfaces.iter().map(|found| found[of]).sum::<f64>() / 300.0;
            let square = surfaces.iter().map(|found| (found[of] - mean).powi(2)).sum::<f64>() / 299.0;
            let (off, error) = (mean / expected - 1.0, (square / 300.0).sqrt() / expected);
            println!("{of}: {off:+.4} of it off, standard error {error:.4}");
            assert!(error < 0.02 && off.abs() < 3.5 * error, "{off} +- {error}");
        }
    }

    /// Numbers of marks in cells have a variance as large as their mean.
    #[test]
    fn numbers_of_marks_are_those_of_poisson() {
        let edge = some_marks();
        let cells = 8000;
        let count = |row: i64| {
            let middle = [0.5 * CELL_MM, (row as f64 + 0.5) * CELL_MM];
            edge.marks(Draws::new(4, 9), 1, [middle, middle]).len() as f64
        };
        let counts: Vec<f64> = (0..cells).map(count).collect();
        let mean = counts.iter().sum::<f64>() / cells as f64;
        let variance = counts.iter().map(|n| (n - mean).powi(2)).sum::<f64>() / cells as f64;
        let expected = 30.0 * CELL_MM * CELL_MM;
        // Mean and variance of n numbers of Poisson scatter by sqrt(m / n) and sqrt((2 m^2 + m) / n): four times that.
        assert!((mean - expected).abs() < 4.0 * (expected / cells as f64).sqrt(), "{mean}");
        let scatter = ((2.0 * expected * expected + expected) / cells as f64).sqrt();
        assert!((variance - expected).abs() < 4.0 * scatter, "{variance}");
    }

    #[test]
    fn marks_lie_where_speed_and_chip_allow_them() {
        let edge = some_marks();
        let shares = [49.0, 50.0, 75.0, 100.0, 299.0, 500.0, 700.0, 5000.0].map(|speed| edge.speed_share(speed));
        assert_eq!(shares, [0.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.0, 0.0]);
        let sharp = BuiltUpEdge { speeds_mm_per_s: [50.0, 50.0, 60.0, 60.0], ..edge };
        assert_eq!([50.0, 55.0, 60.0].map(|speed| sharp.speed_share(speed)), [0.0, 1.0, 0.0]);
        assert_eq!([0.00025, 0.001, 0.5].map(|chip| edge.chip_share(chip)), [0.5, 1.0, 1.0]);
        let thinner = BuiltUpEdge { chip_exponent: -1.0, ..edge };
        assert_eq!([0.0, 0.0005, 0.004].map(|chip| thinner.chip_share(chip)), [1.0, 1.0, 0.25]);
    }

    #[test]
    fn a_mark_is_the_same_one_wherever_it_is_looked_for() {
        let edge = some_marks();
        let marks = |from: Place, to: Place| edge.marks(Draws::new(2, 9), 5, [from, to]);
        let all = marks([0.0, -3.0], [4.0, 3.0]);
        let some = marks([1.1, -0.7], [2.3, 0.2]);
        assert!(all.len() > 600 && some.len() > 30, "{} {}", all.len(), some.len());
        assert!(some.iter().all(|mark| all.contains(mark)));
        let missing = all.iter().filter(|mark| !some.contains(mark)).map(|mark| mark.place_mm);
        assert!(missing.clone().all(|[x, z]| !(1.1..2.3).contains(&x) || !(-0.7..0.2).contains(&z)));
    }
}
