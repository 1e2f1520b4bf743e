//! Scallops: the cusps that stand between neighbouring strokes' facets.
//!
//! Along a profile the dexels of one facet carry the same pass id. Where the id changes, the two facets meet in a cusp
//! between two dexels; quadratics through three dexels of either facet, continued to where they cross, give its height
//! without the loss that the grid's spacing would cause. For closed forms see Gao et al.'s errata in the docs:
//! `h = (ds^2 / 8) (1/rho_g + 1/rho_t)`.

use gearcut_core::dexel::{Field, Layer};
use gearcut_core::math::newton::{LastStep, newton};

/// A cusp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cusp {
    /// Arc along the profile, mm.
    pub arc_mm: f64,
    /// Normal deviation, mm.
    pub height_mm: f64,
}

/// Cusps along one row, from the form point to the tip; facets narrower than three dexels are passed over.
pub fn cusps(field: &Field, layer: &Layer, row: usize) -> Vec<Cusp> {
    let rows = field.rows();
    let at = |column: usize| {
        let index = column * rows + row;
        (field.columns[column].arc_mm, f64::from(layer.heights_mm[index]), layer.passes[index])
    };
    let count = field.columns.len();
    (2..count.saturating_sub(3))
        .filter(|&i| at(i).2 != at(i + 1).2)
        .filter(|&i| (i - 2..i).all(|k| at(k).2 == at(i).2) && (i + 2..i + 4).all(|k| at(k).2 == at(i + 1).2))
        .filter_map(|i| {
            let origin = at(i).0;
            let left = quadratic([i - 2, i - 1, i].map(|k| (at(k).0 - origin, at(k).1)));
            let right = quadratic([i + 1, i + 2, i + 3].map(|k| (at(k).0 - origin, at(k).1)));
            let [c, b, a] = [left[0] - right[0], left[1] - right[1], left[2] - right[2]];
            let gap = at(i + 1).0 - origin;
            // The difference changes its sign within the gap; near-equal curvatures make it nearly straight.
            let arc = crossing(a, b, c, gap)?;
            Some(Cusp { arc_mm: origin + arc, height_mm: left[0] + arc * (left[1] + arc * left[2]) })
        })
        .collect()
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
    use super::{crossing, nearest_root};

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
