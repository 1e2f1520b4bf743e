//! Scallops: the cusps that stand between neighbouring strokes' facets.
//!
//! Along a profile the dexels of one facet carry the same pass id. Where the id changes, the two facets meet in a cusp between two dexels; quadratics through
//! three dexels of either facet, continued to where they cross, give its height without the loss that the grid's spacing would cause.
//! For closed forms see Gao et al.'s errata in the docs: `h = (ds^2 / 8) (1/rho_g + 1/rho_t)`.

use crate::dexel::{Field, Layer};

/// A cusp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cusp {
    /// Arc along the profile, mm.
    pub arc_mm: f64,
    /// Height over the target, mm.
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

/// Root of a x^2 + b x + c between 0 and `gap`, a little slack allowed.
fn crossing(a: f64, b: f64, c: f64, gap: f64) -> Option<f64> {
    let mut x = 0.5 * gap;
    for _ in 0..20 {
        let rate = b + 2.0 * a * x;
        if rate == 0.0 {
            return None;
        }
        let step = (c + x * (b + x * a)) / rate;
        x -= step;
        if step.abs() < 1e-12 {
            break;
        }
    }
    (x > -0.1 * gap && x < 1.1 * gap).then_some(x)
}
