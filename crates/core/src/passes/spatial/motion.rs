//! The machine's motion as a table: where the work stands in the tool's head at any angle of the tool.
//!
//! In: the linkage's pose as a function of the tool's angle (f64, arc lengths inverted, integrals solved). Out: the
//! same as polynomials of degree seven over panels of an eighth of a turn, so that planning, which asks some ten
//! million times, asks a table. While a hob turns by an eighth the work turns by some hundredths of a radian: the
//! remainder of degree seven is far below 1e-10 mm on any gear; [`MotionTable::error_mm`] measures it.
//!
//! **Smooth pieces** end at the corners, where rates jump (the slide starts, a shift turns round). A sweep that lasts
//! over a corner follows one law before it and another one after it, and each is needed as a smooth motion that goes on
//! a little beyond its end.
//!
//! The head is the frame that carries the tool without turning with it: its z axis is the tool's axis, its x axis is
//! where a blade points at tool angle 0 and blade angle 0.
//!
//! Where the motion carries noise, neighbouring panels meet at steps. Tiles that see a sweep through polynomials of
//! their own ([`super::sweep`]) then disagree on it; [`MotionTable::cubic_error_mm`] bounds by how much.

use crate::frame::Rigid3;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::array::from_fn;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Coefficients of each polynomial.
const TERMS: usize = 8;
/// Panels in a turn of the tool.
const PANELS_PER_TURN: f64 = 8.0;
/// Entries of a pose: nine of the rotation, column by column, and three of the translation.
const ENTRIES: usize = 12;
/// By how much a polynomial through the four places of a sweep may miss a step of height 1 in the motion itself, in its
/// first, second or third rate, over -1 to 1, wherever the step is: cubic, and cut down to a quadratic. Found by
/// going through all places of step and point; the test does it again.
const STEP_ERRORS: [f64; 4] = [1.0, 0.14, 0.045, 0.042];

type PosePanel = [[f64; ENTRIES]; TERMS];

/// How far a panel is from what polynomials of low degree follow. Of each: rotation (norm of the matrix), translation
/// (mm); per rad of the tool to some power.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Roughness {
    /// Bounds of the third and fourth rates.
    rates: [[f64; 2]; 2],
    /// Steps from the panel before it in the same piece, in the motion and its first three rates.
    steps: [[f64; 2]; 4],
}

/// `head_from_work` over a range of tool angles.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionTable {
    /// Ends of the panels, one more than there are panels.
    ends_rad: Vec<f64>,
    panels: Vec<PosePanel>,
    /// First panel of every piece, and the number of panels.
    pieces: Vec<usize>,
    /// One of each panel.
    roughness: Vec<Roughness>,
}

impl MotionTable {
    /// Table over `range_rad`, with panels that end at the tool angles `corners_rad` where rates jump.
    pub fn new(range_rad: [f64; 2], corners_rad: &[f64], head_from_work: impl Fn(f64) -> Rigid3 + Sync) -> Self {
        let inside = |angle: &f64| *angle > range_rad[0] && *angle < range_rad[1];
        let mut corners: Vec<f64> = corners_rad.iter().copied().filter(inside).chain(range_rad).collect();
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        let (mut ends_rad, mut pieces) = (vec![corners[0]], vec![0]);
        for pair in corners.windows(2) {
            let count = ((pair[1] - pair[0]) / TAU * PANELS_PER_TURN).ceil().max(1.0) as usize;
            ends_rad.extend((1..=count).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / count as f64));
            pieces.push(ends_rad.len() - 1);
        }
        let panels: Vec<PosePanel> = ends_rad
            .par_windows(2)
            .map(|ends| {
                let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
                panel(|u| entries(&head_from_work(middle + half * u)))
            })
            .collect();
        let half_rad = |panel: usize| 0.5 * (ends_rad[panel + 1] - ends_rad[panel]);
        let roughness = (0..panels.len()).into_par_iter().map(|panel| {
            let rates = largest_rates(&panels[panel], half_rad(panel), 1.0);
            let rate = |panel: usize, order: usize, at: f64| rate_at(&panels[panel], half_rad(panel), order, at);
            let steps = from_fn(|order| {
                if pieces.binary_search(&panel).is_ok() {
                    return [0.0; 2];
                }
                let [before, after] = [rate(panel - 1, order, 1.0), rate(panel, order, -1.0)];
                norms(&from_fn(|entry| after[entry] - before[entry]))
            });
            Roughness { rates, steps }
        });
        let roughness = roughness.collect();
        Self { ends_rad, panels, pieces, roughness }
    }

    /// How far a sweep's polynomials may be from the law of a piece, mm, within `half_rad` of a tool angle: cubic for a
    /// point of the work `from_origin_mm` away from its origin, quadratic in what turns within `reach_mm` of it.
    ///
    /// Where f has the fourth rate M, a cubic through Chebyshev's four nodes is off by at most M d^4 / 192, d the half
    /// width; the quadratic without the cubic's T3 lacks M' d^3 / 24 more, M' the third rate. A motion with steps is
    /// smooth but for sums of (x - c)^k / k! from each step on.
    pub fn cubic_error_mm(
        &self,
        piece: u32,
        tool_angle_rad: f64,
        half_rad: f64,
        [from_origin_mm, reach_mm]: [f64; 2],
    ) -> f64 {
        let of_piece = self.pieces[piece as usize]..self.pieces[piece as usize + 1];
        let ends = [-half_rad, half_rad].map(|to| panel_at(&self.ends_rad, tool_angle_rad + to, of_piece.clone()));
        let [(first, from), (last, to)] = ends;
        let (mut rates, mut steps) = (self.roughness[first].rates, [[0.0; 2]; 4]);
        for panel in &self.roughness[first + 1..=last] {
            rates = from_fn(|of| from_fn(|part| rates[of][part].max(panel.rates[of][part])));
            steps = from_fn(|order| from_fn(|part| steps[order][part] + panel.steps[order][part]));
        }
        // Beyond the ends of its piece a panel's polynomial goes on.
        for (panel, at) in [(first, -from), (last, to)].into_iter().filter(|&(_, at)| at > 1.0) {
            let panel_rad = 0.5 * (self.ends_rad[panel + 1] - self.ends_rad[panel]);
            let beyond = largest_rates(&self.panels[panel], panel_rad, at);
            rates = from_fn(|of| from_fn(|part| rates[of][part].max(beyond[of][part])));
        }
        let powers: [f64; 5] = from_fn(|k| half_rad.powi(k as i32));
        let cubic: [f64; 2] = from_fn(|part| {
            let of_steps: f64 = (0..4).map(|k| STEP_ERRORS[k] * powers[k] * steps[k][part]).sum();
            rates[1][part] * powers[4] / 192.0 + of_steps
        });
        let quadratic = cubic[0] + rates[0][0] * powers[3] / 24.0;
        cubic[0] * from_origin_mm + cubic[1] + quadratic * reach_mm
    }

    /// First and last tool angle of the table.
    pub fn range_rad(&self) -> [f64; 2] {
        [self.ends_rad[0], self.ends_rad[self.panels.len()]]
    }

    /// Pieces that a range of tool angles has a part in.
    pub fn pieces(&self, [from_rad, to_rad]: [f64; 2]) -> Range<u32> {
        let last = self.pieces.len() - 2;
        // The first and the last one go on beyond the table's ends.
        let starts = &self.pieces[1..=last];
        let before = |angle: f64| starts.partition_point(|&panel| self.ends_rad[panel] <= angle) as u32;
        before(from_rad)..before(to_rad) + 1
    }

    /// Tool angles at which a piece begins and ends; without end where the table does.
    pub fn piece_rad(&self, piece: u32) -> [f64; 2] {
        let (first, end) = (self.pieces[piece as usize], self.pieces[piece as usize + 1]);
        let from = if first == 0 { f64::NEG_INFINITY } else { self.ends_rad[first] };
        [from, if end == self.panels.len() { f64::INFINITY } else { self.ends_rad[end] }]
    }

    /// Pose of the work in the head; beyond its ends the table goes on with its last polynomials.
    pub fn head_from_work(&self, tool_angle_rad: f64) -> Rigid3 {
        self.pose(tool_angle_rad, 0..self.panels.len())
    }

    /// The same by the law of one piece, which goes on beyond its ends.
    pub fn head_from_work_on(&self, piece: u32, tool_angle_rad: f64) -> Rigid3 {
        self.pose(tool_angle_rad, self.pieces[piece as usize]..self.pieces[piece as usize + 1])
    }

    fn pose(&self, tool_angle_rad: f64, panels: Range<usize>) -> Rigid3 {
        let (panel, u) = panel_at(&self.ends_rad, tool_angle_rad, panels);
        let [a, b, c, d, e, f, g, h, i, x, y, z] = horner(&self.panels[panel], u);
        Rigid3 { rotation: DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i]), translation_mm: DVec3::new(x, y, z) }
    }

    /// How far a point of the work moves in the head at most per radian of the tool, mm, and how far the work turns,
    /// rad: bounds from the polynomials' coefficients over all panels, whatever gear and feeds they stand for.
    pub fn largest_rates(&self, point_mm: DVec3) -> [f64; 2] {
        let of_panel = |(panel, ends): (&PosePanel, &[f64])| {
            let mut rates = [0.0; 2];
            // |d/du of the sum of c_k u^k| is at most the sum of k |c_k| for |u| up to 1.
            for (k, term) in panel.iter().enumerate().skip(1) {
                let [a, b, c, d, e, f, g, h, i, x, y, z] = *term;
                let turn = DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i]);
                let squares: f64 = term[..9].iter().map(|entry| entry * entry).sum();
                rates[0] += k as f64 * (turn * point_mm + DVec3::new(x, y, z)).length();
                rates[1] += k as f64 * squares.sqrt();
            }
            rates.map(|rate| 2.0 * rate / (ends[1] - ends[0]))
        };
        let largest = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        self.panels.par_iter().zip(self.ends_rad.par_windows(2)).map(of_panel).reduce(|| [0.0; 2], largest)
    }

    /// Largest distance from the exact motion of a point `reach_mm` away from the work's origin, at the places where
    /// the polynomials err most.
    pub fn error_mm(&self, reach_mm: f64, head_from_work: impl Fn(f64) -> Rigid3 + Sync) -> f64 {
        (0..self.panels.len())
            .into_par_iter()
            .map(|index| {
                let errors = (0..=TERMS).map(|extreme| {
                    let u = (PI * extreme as f64 / TERMS as f64).cos() * (1.0 - 1e-12);
                    let (start, end) = (self.ends_rad[index], self.ends_rad[index + 1]);
                    let angle = 0.5 * (start + end) + 0.5 * (end - start) * u;
                    let (table, exact) = (self.head_from_work(angle), head_from_work(angle));
                    let turn = (table.rotation - exact.rotation).to_cols_array().iter().map(|e| e * e).sum::<f64>();
                    (table.translation_mm - exact.translation_mm).length() + reach_mm * turn.sqrt()
                });
                errors.fold(0.0, f64::max)
            })
            .reduce(|| 0.0, f64::max)
    }
}

/// A rate of a panel's polynomials at u, per rad of the tool.
fn rate_at(panel: &PosePanel, half_rad: f64, order: usize, u: f64) -> [f64; ENTRIES] {
    let scale = half_rad.powi(-(order as i32));
    from_fn(|entry| scale * rate(panel.map(|term| term[entry]), order, u))
}

/// Bounds of a panel's third and fourth rates for |u| up to this.
fn largest_rates(panel: &PosePanel, half_rad: f64, u: f64) -> [[f64; 2]; 2] {
    let sizes = panel.map(|term| norms(&term));
    [3, 4].map(|order| {
        let scale = half_rad.powi(-(order as i32));
        from_fn(|part| scale * rate(sizes.map(|size| size[part]), order, u))
    })
}

/// Sizes of a pose's rotation and translation, or of a rate of them.
fn norms(entries: &[f64; ENTRIES]) -> [f64; 2] {
    let (turn, shift) = entries.split_at(9);
    [turn, shift].map(|part| part.iter().map(|entry| entry * entry).sum::<f64>().sqrt())
}

/// The `order`-th rate of a polynomial at a place; of the coefficients' sizes a bound for all places up to there.
fn rate(coefficients: [f64; TERMS], order: usize, at: f64) -> f64 {
    (order..TERMS).rev().fold(0.0, |value, k| {
        let falling: f64 = (k + 1 - order..=k).map(|factor| factor as f64).product();
        value * at + falling * coefficients[k]
    })
}

/// The panel among some whose law holds at a tool angle, and where in it, -1 to 1; beyond their ends the last one.
fn panel_at(ends_rad: &[f64], tool_angle_rad: f64, panels: Range<usize>) -> (usize, f64) {
    // Panels are nearly even: from where the one looked for would stand if they were.
    let (count, last) = (ends_rad.len() - 1, panels.end - 1);
    let guess = ((tool_angle_rad - ends_rad[0]) / (ends_rad[count] - ends_rad[0]) * count as f64) as usize;
    let mut index = guess.clamp(panels.start, last);
    while index > panels.start && tool_angle_rad < ends_rad[index] {
        index -= 1;
    }
    while index < last && tool_angle_rad >= ends_rad[index + 1] {
        index += 1;
    }
    let (start, end) = (ends_rad[index], ends_rad[index + 1]);
    (index, (2.0 * tool_angle_rad - start - end) / (end - start))
}

/// Values of polynomials in u, lowest terms first.
fn horner<const VALUES: usize>(terms: &[[f64; VALUES]; TERMS], u: f64) -> [f64; VALUES] {
    let mut values = terms[TERMS - 1];
    for term in terms[..TERMS - 1].iter().rev() {
        for (value, coefficient) in values.iter_mut().zip(term) {
            *value = *value * u + coefficient;
        }
    }
    values
}

fn entries(pose: &Rigid3) -> [f64; ENTRIES] {
    let mut entries = [0.0; ENTRIES];
    entries[..9].copy_from_slice(&pose.rotation.to_cols_array());
    entries[9..].copy_from_slice(&pose.translation_mm.to_array());
    entries
}

/// Polynomials through the values at Chebyshev nodes, in powers of u.
fn panel(values: impl Fn(f64) -> [f64; ENTRIES]) -> PosePanel {
    // T_k in powers: T_k = 2 u T_(k-1) - T_(k-2).
    let mut powers = [[0.0; TERMS]; TERMS];
    powers[0][0] = 1.0;
    powers[1][1] = 1.0;
    for k in 2..TERMS {
        for p in 0..TERMS {
            let shifted = if p > 0 { powers[k - 1][p - 1] } else { 0.0 };
            powers[k][p] = 2.0 * shifted - powers[k - 2][p];
        }
    }
    let mut panel = [[0.0; ENTRIES]; TERMS];
    for node in 0..TERMS {
        let angle = PI * (node as f64 + 0.5) / TERMS as f64;
        let at = values(angle.cos());
        for (k, power) in powers.iter().enumerate() {
            let weight = (k as f64 * angle).cos() * if k == 0 { 1.0 } else { 2.0 } / TERMS as f64;
            for (term, p) in panel.iter_mut().zip(power) {
                for (coefficient, value) in term.iter_mut().zip(&at) {
                    *coefficient += weight * p * value;
                }
            }
        }
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::planar::strokes::{NODES, cubic_through};

    /// A work that turns thirty times slower than the tool, 140 mm away, on a path that wobbles.
    fn pose(angle: f64) -> Rigid3 {
        let tilt = DMat3::from_rotation_x(1.4) * DMat3::from_rotation_y(0.2);
        let center = DVec3::new(-200.0 - 6.0 * (0.1 * angle).cos(), 5.0 * (0.1 * angle).sin(), 0.02 * angle);
        Rigid3 { rotation: tilt * DMat3::from_rotation_z(angle / 30.0), translation_mm: center }
    }

    #[test]
    fn the_table_is_the_motion() {
        let table = MotionTable::new([-3.0, 40.0], &[1.0, 17.3], pose);
        assert_eq!(table.range_rad(), [-3.0, 40.0]);
        let error = table.error_mm(150.0, pose);
        assert!(error < 1e-10, "{error:e} mm");
        assert_eq!(table.pieces([-9.0, 0.9]), 0..1);
        assert_eq!(table.pieces([0.9, 17.2]), 0..2);
        assert_eq!(table.pieces([17.3, 90.0]), 2..3);
        assert_eq!([0, 1].map(|piece| table.piece_rad(piece)), [[f64::NEG_INFINITY, 1.0], [1.0, 17.3]]);
        // The measure is alive: another motion is seen.
        assert!(table.error_mm(150.0, |angle| pose(angle + 1e-9)) > 1e-9);
    }

    /// A cubic through a sweep's nodes, within `half` of a place: how far it is from f, and without its T3.
    fn fitted_errors(f: impl Fn(f64) -> f64, middle: f64, half: f64) -> [f64; 2] {
        let [c0, c1, c2, c3] = cubic_through(&NODES.map(|node| f(middle + half * node)));
        let errors = (0..=200).map(|i| f64::from(i) / 100.0 - 1.0).map(|x| {
            let (cubic, exact) = (c0 + x * (c1 + x * (c2 + x * c3)), f(middle + half * x));
            [exact - cubic, exact - cubic + 0.25 * c3 * x * (4.0 * x * x - 3.0)].map(f64::abs)
        });
        errors.fold([0.0, 0.0], |[a, b], [c, d]| [a.max(c), b.max(d)])
    }

    #[test]
    fn steps_are_missed_by_no_more_than_they_are_said_to_be() {
        let mut factorial = 1.0;
        for (k, said) in STEP_ERRORS.into_iter().enumerate() {
            factorial *= (k as f64).max(1.0);
            let of_step = |at: f64| {
                let step = |x: f64| if x > at { (x - at).powi(k as i32) / factorial } else { 0.0 };
                fitted_errors(step, 0.0, 1.0)
            };
            let places = (0..=400).map(|i| f64::from(i) / 200.0 - 1.0 + 1e-9);
            let worst = places.flat_map(of_step).fold(0.0, f64::max);
            assert!(worst <= said + 1e-9 && worst > 0.95 * said, "{k}: {worst}, not {said}");
        }
    }

    /// Motions that are smooth, that wave, and that tremble: fits over any part of the table are within the bound, and
    /// somewhere not far below it.
    #[test]
    fn polynomials_of_sweeps_are_as_near_as_they_are_said_to_be() {
        let tremble = |angle: f64| 1e-3 * (1e3 * (12.9898 * (16.0 * angle).floor()).sin()).fract();
        let wave = |angle: f64| 2e-3 * (8.0 * angle).sin();
        let none = |_: f64| 0.0;
        let of_more: [(&(dyn Fn(f64) -> f64 + Sync), f64); 3] = [(&none, 3.0), (&wave, 30.0), (&tremble, 1e3)];
        for (more, slack) in of_more {
            let table = MotionTable::new([-3.0, 20.0], &[9.0], |angle| {
                let mut at = pose(angle);
                at.translation_mm.x += more(angle);
                at
            });
            let point = DVec3::new(40.0, 30.0, 0.0);
            for (half, piece) in [0.02, 0.1, 0.4].into_iter().flat_map(|half| [(half, 0), (half, 1)]) {
                let ends = [[-3.0, 9.0], [9.0, 20.0]][piece as usize];
                let at = |angle: f64| table.head_from_work_on(piece, angle).point(point).x;
                let said_at = |middle: f64| table.cubic_error_mm(piece, middle, half, [50.0, 0.0]);
                let places = 200;
                let middle =
                    |i: i32| ends[0] + half + (ends[1] - ends[0] - 2.0 * half) * f64::from(i) / f64::from(places);
                let mut found = 0.0_f64;
                for middle in (0..=places).map(middle) {
                    let [error, _] = fitted_errors(at, middle, half);
                    assert!(error <= said_at(middle) + 1e-13, "{half} rad at {middle}: {error:e}");
                    found = found.max(error);
                }
                let said = (0..=places).map(|i| said_at(middle(i))).fold(0.0, f64::max);
                println!("{half} rad: {found:e} mm, at most {said:e}");
                assert!(said < slack * found + 1e-12, "{half} rad: {found:e}, not {said:e}");
                let beyond = [ends[1] + half, ends[0] - half][piece as usize];
                let found = fitted_errors(at, beyond, half)[0];
                let said = said_at(beyond);
                assert!(found <= said + 1e-13, "beyond a corner, {half} rad: {found:e}, not {said:e}");
            }
        }
    }

    /// A work whose turning changes its speed at a corner: every piece goes on smoothly beyond it.
    #[test]
    fn pieces_go_on_beyond_their_corners() {
        let table =
            MotionTable::new([-3.0, 40.0], &[17.3], |angle| pose(angle.min(17.3) + 0.5 * (angle - 17.3).max(0.0)));
        let apart = |a: Rigid3, b: Rigid3| (a.point(DVec3::X) - b.point(DVec3::X)).length();
        for beyond in [0.01, 0.1, 0.4] {
            let before = table.head_from_work_on(0, 17.3 + beyond);
            assert!(apart(before, pose(17.3 + beyond)) < 1e-8);
            let after = table.head_from_work_on(1, 17.3 - beyond);
            assert!(apart(after, pose(17.3 - 0.5 * beyond)) < 1e-8);
            assert!(apart(before, table.head_from_work(17.3 + beyond)) > 1e-6);
        }
    }
}
