//! Scallops: the cusps that stand between neighbouring strokes' facets.
//!
//! In: a field, a layer and a row. Out: the row's facets, and the cusps between them. Along a profile the dexels of one
//! facet carry the same pass id; a quadratic through three of them beside a cusp is the facet there, continued to where
//! its neighbour's crosses it.
//!
//! **A cusp's height** is that over its own two facets: over the line that touches both. The facets bend by 2 a_1 and
//! 2 a_2 and meet at the slopes s_1 and s_2; a line of slope s that lies h below the cusp touches both where
//! (s_1 - s)^2 = 4 a_1 h and (s_2 - s)^2 = 4 a_2 h, hence
//!
//! ```text
//! h = ((s_1 - s_2) / (2 (sqrt(a_1) + sqrt(a_2))))^2
//! ```
//!
//! On a flank without error this is the closed form `h = (ds^2 / 8) (1/rho_g + 1/rho_t)` (Gao et al., errata in the
//! docs). Where a flank lies off its target or leans, the height stays: a line has none of it. Road not taken: the
//! normal deviation at the cusp, which is that of the flank wherever the flank has one.

use super::stock::Extreme;
use gearcut_core::dexel::{Field, Layer, NO_PASS};
use gearcut_core::math::newton::{LastStep, newton};

/// Dexels of the narrowest facet that is looked at.
const FEWEST: usize = 3;
/// Dexels between two of those three beside a cusp at most. Farther apart they are less moved by the rounding of
/// heights to f32: over 40 dexels it is 0.04 % of a bend where dexels are 0.2 um apart. A facet that runs on over a
/// whole flank is no quadratic.
const WIDEST: usize = 20;

/// A facet: what one pass left of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// Its pass.
    pub pass: u32,
    /// Columns of its first and last dexel.
    columns: [usize; 2],
    /// Arc and normal deviation of three dexels beside its first one, beside its last one, and over all of it, mm.
    dexels_mm: [Dexels; 3],
}

/// Arc and normal deviation of three dexels, mm.
type Dexels = [(f64, f64); FEWEST];

/// A cusp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cusp {
    /// Arc along the profile, mm.
    pub arc_mm: f64,
    /// Height over the line that touches both its facets, mm.
    pub height_mm: f64,
    /// Passes of its facets.
    pub passes: [u32; 2],
}

/// Facets along one row in order of arcs; narrower ones than three dexels are passed over.
pub fn facets(field: &Field, layer: &Layer, row: usize) -> Vec<Facet> {
    let rows = field.rows();
    let at = |column: usize| (field.columns[column].arc_mm, f64::from(layer.heights_mm[column * rows + row]));
    let passes: Vec<u32> = (0..field.columns.len()).map(|column| layer.passes[column * rows + row]).collect();
    let mut from = 0;
    let runs = passes.chunk_by(|a, b| a == b).map(|run| {
        let columns = [from, from + run.len() - 1];
        from += run.len();
        (run[0], columns)
    });
    runs.filter(|&(pass, [first, last])| pass != NO_PASS && last + 1 - first >= FEWEST)
        .map(|(pass, columns @ [first, last])| {
            let apart = ((last - first) / 2).min(WIDEST);
            let beside_first = [first, first + apart, first + 2 * apart];
            let beside_last = [last - 2 * apart, last - apart, last];
            let dexels_mm = [beside_first, beside_last, [first, first.midpoint(last), last]].map(|of| of.map(at));
            Facet { pass, columns, dexels_mm }
        })
        .collect()
}

/// Cusps between facets that follow each other without a narrower one between them.
pub fn cusps(facets: &[Facet]) -> Vec<Cusp> {
    let neighbours = facets.windows(2).filter(|pair| pair[0].columns[1] + 1 == pair[1].columns[0]);
    neighbours.filter_map(|pair| cusp(&pair[0], &pair[1])).collect()
}

/// The cusp of two facets; `None` where they do not cross between their dexels, or are no valleys with a ridge between
/// them.
fn cusp(left: &Facet, right: &Facet) -> Option<Cusp> {
    let [beside_left, beside_right] = [left.dexels_mm[1], right.dexels_mm[0]];
    let origin_mm = beside_left[2].0;
    let [of_left, of_right] = [beside_left, beside_right].map(|dexels_mm| about(dexels_mm, origin_mm));
    let [c, b, a] = [0, 1, 2].map(|i| of_left[i] - of_right[i]);
    // The difference changes its sign within the gap; near-equal curvatures make it nearly straight.
    let at_mm = crossing(a, b, c, beside_right[0].0 - origin_mm)?;
    let bends = [of_left, of_right].map(|of| of[2]);
    let corner = b + 2.0 * a * at_mm;
    let is_ridge = corner > 0.0 && bends.iter().all(|&bend| bend > 0.0);
    let height_mm = (corner / (2.0 * (bends[0].sqrt() + bends[1].sqrt()))).powi(2);
    is_ridge.then_some(Cusp { arc_mm: origin_mm + at_mm, height_mm, passes: [left.pass, right.pass] })
}

/// The largest step between neighbouring facets whose strokes are more than `apart` from each other, `stroke` of a pass
/// its number: how far the bottom of the later facet lies over that of the earlier, negative where it is deeper. `None`
/// where no such facets are neighbours.
pub fn step(facets: &[Facet], apart: usize, stroke: impl Fn(u32) -> Option<usize>) -> Option<Extreme> {
    let steps = facets.windows(2).filter_map(|pair| {
        let [left, right] = [stroke(pair[0].pass)?, stroke(pair[1].pass)?];
        let [earlier, later] = if left < right { [&pair[0], &pair[1]] } else { [&pair[1], &pair[0]] };
        let value_mm = later.bottom_mm()? - earlier.bottom_mm()?;
        (left.abs_diff(right) > apart).then_some(Extreme { value_mm, arc_mm: pair[1].dexels_mm[0][0].0, z_mm: 0.0 })
    });
    steps.max_by(|a, b| a.value_mm.abs().total_cmp(&b.value_mm.abs()))
}

impl Facet {
    /// Lowest height of its quadratic, wherever along the profile, mm; `None` where it bends outwards.
    fn bottom_mm(&self) -> Option<f64> {
        let whole_mm = self.dexels_mm[2];
        let [c, b, a] = about(whole_mm, whole_mm[1].0);
        (a > 0.0).then(|| c - b * b / (4.0 * a))
    }
}

/// Quadratic through three dexels, arcs counted from an origin.
fn about(dexels_mm: Dexels, origin_mm: f64) -> [f64; 3] {
    quadratic(dexels_mm.map(|(arc_mm, height_mm)| (arc_mm - origin_mm, height_mm)))
}

/// Quadratic through three points: coefficients of 1, x, x^2.
fn quadratic([(x0, y0), (x1, y1), (x2, y2)]: [(f64, f64); 3]) -> [f64; 3] {
    let s01 = (y1 - y0) / (x1 - x0);
    let s12 = (y2 - y1) / (x2 - x1);
    let a = (s12 - s01) / (x2 - x0);
    [y0 - x0 * (s01 - a * x1), s01 - a * (x0 + x1), a]
}

/// Root of a x^2 + b x + c between 0 and `gap`, or a tenth of it beyond either end.
fn crossing(a: f64, b: f64, c: f64, gap: f64) -> Option<f64> {
    let middle = 0.5 * gap;
    let found = newton("a cusp between two facets", middle, LastStep::absolute(1e-12), 20, |x| {
        let value = c + x * (b + x * a);
        [value, -(value / (b + 2.0 * a * x))]
    });
    // From a middle where the parabola turns, or beside a double root, in closed form.
    let x = found.ok().or_else(|| nearest_root([c, b, a], middle))?;
    (x > -0.1 * gap && x < 1.1 * gap).then_some(x)
}

/// Root of c + b x + a x^2 nearest to a place, without the loss of digits of the school formula; `None` if none is
/// real.
fn nearest_root([c, b, a]: [f64; 3], place: f64) -> Option<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [q / a, c / q]
        .into_iter()
        .filter(|root| root.is_finite())
        .min_by(|x, y| (x - place).abs().total_cmp(&(y - place).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::dexel::Column;
    use glam::DVec2;

    const SPACING_MM: f64 = 0.011;

    /// One row of strokes' parabolas of bends 2 `a` about places `feed_mm` apart, each over `base_mm`, stroke by
    /// stroke, all of it on a flank that deviates.
    fn cut(a: f64, places_mm: &[f64], base_mm: &[f64], deviation_mm: impl Fn(f64) -> f64) -> (Field, Layer) {
        let column = |i: u32| Column {
            arc_mm: SPACING_MM * f64::from(i),
            origin_mm: DVec2::ZERO,
            normal: DVec2::X,
            low_mm: -1.0,
            blank_mm: 1.0,
        };
        let field = Field { columns: (0..600).map(column).collect(), rows_z_mm: vec![0.0] };
        let mut layer = field.blank_layer();
        for (index, column) in field.columns.iter().enumerate() {
            let of_stroke = |(stroke, place_mm): (u32, &f64)| {
                (base_mm[stroke as usize] + a * (column.arc_mm - place_mm).powi(2), stroke)
            };
            let lowest = (0..).zip(places_mm).map(of_stroke).min_by(|a, b| a.0.total_cmp(&b.0)).expect("strokes");
            layer.heights_mm[index] = (lowest.0 + deviation_mm(column.arc_mm)) as f32;
            layer.passes[index] = lowest.1;
        }
        (field, layer)
    }

    /// Parabolas a feed f apart leave ridges of a f^2 / 4, whatever the flank does below them.
    #[test]
    fn ridges_are_as_high_on_a_flank_that_is_off() {
        let (a, feed_mm) = (0.07, 0.4_f64);
        let places_mm: Vec<f64> = (0..18).map(|stroke| feed_mm * f64::from(stroke)).collect();
        let expected_mm = 0.25 * a * feed_mm.powi(2);
        let flanks: [&dyn Fn(f64) -> f64; 4] =
            [&|_| 0.0, &|_| -0.04, &|arc_mm| 0.01 - 0.004 * arc_mm, &|arc_mm| 0.01 * (0.3 * arc_mm).sin()];
        for (flank, deviation_mm) in flanks.into_iter().enumerate() {
            let (field, layer) = cut(a, &places_mm, &[0.0; 18], deviation_mm);
            let found = cusps(&facets(&field, &layer, 0));
            assert!(found.len() >= 14);
            for cusp in found {
                let share = cusp.height_mm / expected_mm;
                assert!((share - 1.0).abs() < 0.02, "flank {flank}: {share} of the height at {}", cusp.arc_mm);
            }
        }
    }

    /// Unequal parabolas, by their common tangent: y = 0 touches both.
    #[test]
    fn a_cusp_of_unequal_facets_stands_over_their_common_tangent() {
        let (a, b) = (0.05_f64, 0.2_f64);
        let facet = |pass, bend: f64, place_mm: f64, arcs_mm: [f64; 3]| Facet {
            pass,
            columns: [0, 2].map(|column| 3 * pass as usize + column),
            dexels_mm: [arcs_mm.map(|x| (x, bend * (x - place_mm).powi(2))); 3],
        };
        let left = facet(0, a, 0.0, [0.0, 0.1, 0.2]);
        let right = facet(1, b, 0.33, [0.225, 0.325, 0.425]);
        // sqrt(a) x = sqrt(b) (0.33 - x).
        let x = 0.33 * b.sqrt() / (a.sqrt() + b.sqrt());
        let found = cusp(&left, &right).expect("a ridge");
        assert!((found.arc_mm - x).abs() < 1e-9 && (found.height_mm - a * x * x).abs() < 1e-12, "{found:?}");
    }

    /// A later half of the strokes that lies deeper or higher by 5 um: the step has its sign, whichever side is later.
    #[test]
    fn a_step_between_strokes_far_apart_has_its_sign() {
        let places_mm: Vec<f64> = (0..18).map(|stroke| 0.4 * f64::from(stroke)).collect();
        for step_mm in [-0.005, 0.005] {
            let base_mm: Vec<f64> = (0..18).map(|stroke| if stroke < 9 { 0.0 } else { step_mm }).collect();
            let (field, layer) = cut(0.07, &places_mm, &base_mm, |_| 0.0);
            let facets = facets(&field, &layer, 0);
            // Strokes are 100 later on the one side, or on the other.
            for (late, sign) in [(1, 1.0), (0, -1.0)] {
                let stroke = |pass: u32| Some(pass as usize + if usize::from(pass >= 9) == late { 100 } else { 0 });
                let found = step(&facets, 50, stroke).expect("a step");
                assert!((found.value_mm - sign * step_mm).abs() < 1e-7, "{found:?}");
                assert!((found.arc_mm - 3.4).abs() < 0.2, "{found:?}");
            }
            assert_eq!(step(&facets, 50, |pass| Some(pass as usize)), None);
        }
    }

    #[test]
    fn parabolas_cross_where_their_factors_say() {
        for roots in [[0.3, 5.0], [0.3, -2.0], [0.99, 1e6], [0.5, 0.5]] {
            let [p, q] = roots;
            let found = crossing(1.0, -(p + q), p * q, 1.0).expect("within the gap");
            assert!((found - p).abs() < 1e-9, "{found} for {roots:?}");
            assert!((nearest_root([p * q, -(p + q), 1.0], 0.5).expect("real") - p).abs() < 1e-9);
        }
        assert_eq!(nearest_root([-2.0, 4.0, 0.0], 0.0), Some(0.5));
    }

    #[test]
    fn no_root_or_none_near_is_none() {
        assert_eq!(crossing(1.0, 0.0, 1.0, 1.0), None);
        assert_eq!(crossing(1.0, -8.0, 15.0, 1.0), None);
        // The parabola turns in the middle of the gap, where Newton's method has no step.
        assert_eq!(crossing(1.0, -1.0, 1.0, 1.0), None);
        let found = crossing(1.0, -1.0, 0.16, 1.0).expect("roots at 0.2 and 0.8");
        assert!((found - 0.2).abs() < 1e-12 || (found - 0.8).abs() < 1e-12);
    }
}
