//! Chebyshev polynomials through points and normals of a flank.

use std::f64::consts::PI;

/// Components: point and normal.
pub(super) const PARTS: usize = 6;
/// Coefficients of the Chebyshev polynomials through values at their nodes.
pub(super) fn chebyshev(values: &[[f64; PARTS]]) -> Vec<[f64; PARTS]> {
    let terms = values.len();
    (0..terms)
        .map(|k| {
            let mut sum = [0.0; PARTS];
            for (i, value) in values.iter().enumerate() {
                let weight = (PI * k as f64 * (i as f64 + 0.5) / terms as f64).cos();
                sum.iter_mut().zip(value).for_each(|(s, v)| *s += weight * v);
            }
            sum.map(|s| s * if k == 0 { 1.0 } else { 2.0 } / terms as f64)
        })
        .collect()
}

/// Value at a place from -1 to 1 (Clenshaw's recurrence).
pub(super) fn clenshaw(coefficients: &[[f64; PARTS]], x: f64) -> [f64; PARTS] {
    let (mut b1, mut b2) = ([0.0; PARTS], [0.0; PARTS]);
    for c in coefficients[1..].iter().rev() {
        for part in 0..PARTS {
            let b = c[part] + 2.0 * x * b1[part] - b2[part];
            b2[part] = b1[part];
            b1[part] = b;
        }
    }
    std::array::from_fn(|part| coefficients[0][part] + x * b1[part] - b2[part])
}
