//! The piece of an edge that a tile can meet, as one polynomial for each record.
//!
//! In: a record of the plan, the tile's rays. Out: the range of y (segment frame) over which any of them can meet the
//! segment, and polynomials of degree five that follow the edge's table there. A tile is a tenth of a millimetre wide,
//! so one polynomial nearly always serves; where rays graze, the range is cut in halves until each is followed closely
//! enough. Edges in rake faces that turn through the work are bent so little that one follows a whole segment: it is
//! found once for a plan, and counted from another place for every record.
//!
//! A shader then reads the edge with the record and looks nothing up: a table indexed by every lane for itself costs a
//! software adapter more than all arithmetic.
//!
//! Road not taken: the table's own cubic, continued beyond its cell. A tenth of a millimetre crosses a cell's end too
//! often, and a quarter of a cell further it errs by 0.1 nm already.

use gearcut_core::dexel::Column;
use gearcut_core::passes::PassRecord;
use gearcut_core::tool::edge_table::EdgeTable;
use glam::DVec2;

/// Places at which a polynomial is compared with the table, between those that define it.
const CHECKS: usize = 16;
/// A range is not halved below this share of a table's cell: there the polynomial is the table's own cubic, but for the
/// joint of two cells.
const SMALLEST_CELLS: f64 = 0.5;
/// What the range is widened by, mm: a thousand times what f32 moves a place.
const MARGIN_MM: f64 = 1e-3;

/// A polynomial of degree five for x over y, and where it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePolynomial {
    /// Point from which it counts, segment frame, mm; on the polynomial, so that its constant is zero.
    pub base_mm: DVec2,
    /// Coefficients of t to t^5, t = y less that of the base.
    pub coefficients: [f64; 5],
    /// Range of t.
    pub range_mm: [f64; 2],
}

/// y over which the tile's rays can meet the segment, between the lowest height that a hit may have and the blank's
/// surface: hulls of the cubics in the stroke's phase, -1 to 1.
pub fn reach_mm(record: &PassRecord, columns: &[Column], tile_origin_mm: DVec2) -> [f64; 2] {
    let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
    for column in columns {
        let (o, n) = (column.origin_mm - tile_origin_mm, column.normal);
        // Shaders drop hits below twice the lowest height, as the native kernel does.
        for height_mm in [2.0 * column.low_mm, column.blank_mm.max(0.0)] {
            let p = o + height_mm * n;
            let y: [f64; 4] = std::array::from_fn(|k| record.y_mm[k] + record.sin[k] * p.x + record.cos[k] * p.y);
            for control in hull(y) {
                reach = [reach[0].min(control), reach[1].max(control)];
            }
        }
    }
    [reach[0] - MARGIN_MM, reach[1] + MARGIN_MM]
}

/// Control values of a cubic over [-1, 1]: it runs between the least and the greatest (Bernstein).
fn hull([c0, c1, c2, c3]: [f64; 4]) -> [f64; 4] {
    let [a0, a1, a2, a3] = [c0 - c1 + c2 - c3, 2.0 * (c1 - 2.0 * c2 + 3.0 * c3), 4.0 * (c2 - 3.0 * c3), 8.0 * c3];
    [a0, a0 + a1 / 3.0, a0 + (2.0 * a1 + a2) / 3.0, a0 + a1 + a2 + a3]
}

/// Polynomials that follow a table over a range within a tolerance, in order of y; each counts from the place nearest
/// to `near_mm`, so that what is near it is small.
pub fn curves(
    table: &EdgeTable,
    [from, to]: [f64; 2],
    near_mm: f64,
    tolerance_mm: f64,
    curves: &mut Vec<EdgePolynomial>,
) {
    let curve = EdgePolynomial::through(table, [from, to], near_mm.clamp(from, to));
    if (to - from) * table.cells_per_mm <= SMALLEST_CELLS || curve.follows(table, tolerance_mm) {
        curves.push(curve);
        return;
    }
    let middle = 0.5 * (from + to);
    self::curves(table, [from, middle], near_mm, tolerance_mm, curves);
    self::curves(table, [middle, to], near_mm, tolerance_mm, curves);
}

impl EdgePolynomial {
    /// Interpolates the table at Chebyshev's places of the range.
    fn through(table: &EdgeTable, [from, to]: [f64; 2], base_y_mm: f64) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from).max(f64::MIN_POSITIVE));
        let places: [f64; 6] = std::array::from_fn(|i| {
            middle - base_y_mm + half * ((2 * i + 1) as f64 * std::f64::consts::PI / 12.0).cos()
        });
        let mut divided = places.map(|t| table.x_and_slope(base_y_mm + t)[0]);
        for order in 1..6 {
            for i in (order..6).rev() {
                divided[i] = (divided[i] - divided[i - 1]) / (places[i] - places[i - order]);
            }
        }
        // Newton's form becomes powers of t.
        let mut powers = [0.0; 6];
        for i in (0..6).rev() {
            for k in (1..6).rev() {
                powers[k] = powers[k - 1] - places[i] * powers[k];
            }
            powers[0] = divided[i] - places[i] * powers[0];
        }
        let [x_mm, coefficients @ ..] = powers;
        let base_mm = DVec2::new(x_mm, base_y_mm);
        Self { base_mm, coefficients, range_mm: [from - base_y_mm, to - base_y_mm] }
    }

    /// The same polynomial counted from its place nearest to `near_mm`.
    #[must_use]
    pub fn seen_from(&self, near_mm: f64) -> Self {
        let [from, to] = self.range_mm.map(|t| self.base_mm.y + t);
        let by = near_mm.clamp(from, to) - self.base_mm.y;
        let [c1, c2, c3, c4, c5] = self.coefficients;
        let mut powers = [0.0, c1, c2, c3, c4, c5];
        for lowest in 0..5 {
            for k in (lowest..5).rev() {
                powers[k] += by * powers[k + 1];
            }
        }
        let [x_mm, coefficients @ ..] = powers;
        Self { base_mm: self.base_mm + DVec2::new(x_mm, by), coefficients, range_mm: self.range_mm.map(|t| t - by) }
    }

    /// x at t, from the base.
    pub fn x_mm(&self, t: f64) -> f64 {
        self.coefficients.iter().rfold(0.0, |sum, c| t * (c + sum))
    }

    fn follows(&self, table: &EdgeTable, tolerance_mm: f64) -> bool {
        let [from, to] = self.range_mm;
        (0..=CHECKS).all(|i| {
            let t = from + (to - from) * i as f64 / CHECKS as f64;
            let x_mm = table.x_and_slope(self.base_mm.y + t)[0];
            (self.base_mm.x + self.x_mm(t) - x_mm).abs() <= tolerance_mm
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::error::NotConverged;
    use gearcut_core::tool::edge_profile::EdgeProfile;

    /// A circle of radius 3 mm.
    struct Circle;

    impl EdgeProfile for Circle {
        fn x_and_slope(&self, y_mm: f64) -> Result<[f64; 2], NotConverged> {
            let x = (9.0 - y_mm * y_mm).sqrt();
            Ok([x, -y_mm / x])
        }
    }

    #[test]
    fn the_polynomials_follow_the_profile_over_the_whole_range_without_gaps() {
        let table = EdgeTable::fit(&Circle, [-2.0, 2.0]).expect("fits");
        let mut found = Vec::new();
        curves(&table, [-1.9, 1.7], 0.4, 1e-7, &mut found);
        assert!(found.len() > 1, "a circle over its whole width is no quintic");
        let mut end = -1.9;
        for curve in &found {
            let [from, to] = curve.range_mm.map(|t| curve.base_mm.y + t);
            assert!((from - end).abs() < 1e-12, "a gap between {end} and {from}");
            end = to;
            for i in 0..=100 {
                let t = curve.range_mm[0] + (to - from) * f64::from(i) / 100.0;
                let error =
                    curve.base_mm.x + curve.x_mm(t) - Circle.x_and_slope(curve.base_mm.y + t).expect("known")[0];
                assert!(error.abs() < 2e-7, "{error} mm at {t}");
            }
        }
        assert!((end - 1.7).abs() < 1e-12);
    }

    #[test]
    fn a_narrow_range_takes_one_polynomial_that_starts_at_the_place_asked_for() {
        let table = EdgeTable::fit(&Circle, [-2.0, 2.0]).expect("fits");
        let mut found = Vec::new();
        curves(&table, [0.9, 1.1], 0.97, 1e-7, &mut found);
        let [curve] = found.as_slice() else { panic!("{} polynomials", found.len()) };
        assert!((curve.base_mm.y - 0.97).abs() < 1e-15);
        assert!((curve.base_mm.x - Circle.x_and_slope(0.97).expect("known")[0]).abs() < 2e-7);
    }

    #[test]
    fn a_polynomial_is_the_same_from_wherever_it_counts() {
        let of = EdgePolynomial {
            base_mm: DVec2::new(0.3, -1.0),
            coefficients: [0.2, -0.1, 0.05, 0.02, -0.01],
            range_mm: [-0.5, 2.5],
        };
        for (near_mm, base_y_mm) in [(0.7, 0.7), (-3.0, -1.5), (9.0, 1.5)] {
            let seen = of.seen_from(near_mm);
            assert!((seen.base_mm.y - base_y_mm).abs() < 1e-15);
            for i in 0..=30 {
                let y_mm = f64::from(i) / 10.0 - 1.5;
                let x_mm = |from: &EdgePolynomial| from.base_mm.x + from.x_mm(y_mm - from.base_mm.y);
                assert!((x_mm(&of) - x_mm(&seen)).abs() < 1e-14, "{} and {} mm", x_mm(&of), x_mm(&seen));
            }
            for end in 0..2 {
                assert!((of.range_mm[end] + of.base_mm.y - seen.range_mm[end] - seen.base_mm.y).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_cubic_stays_in_its_hull() {
        let cubic = [0.3, -1.2, 0.7, 1.9];
        let controls = hull(cubic);
        let (low, high) = controls.iter().fold((f64::MAX, f64::MIN), |(l, h), &c| (l.min(c), h.max(c)));
        for i in 0..=200 {
            let tau = f64::from(i) / 100.0 - 1.0;
            let value = cubic.iter().rfold(0.0, |sum, c| c + tau * sum);
            assert!((low..=high).contains(&value));
        }
        assert!((controls[0] - (0.3 + 1.2 + 0.7 - 1.9)).abs() < 1e-12 && (controls[3] - 1.7).abs() < 1e-12);
    }
}
