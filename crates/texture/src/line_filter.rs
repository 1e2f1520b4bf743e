//! Gaussian filter of profiles (ISO 16610-21) as a local regression, and its robust form (ISO 16610-31).
//!
//! Weighting function `s(x) = 1 / (a L) exp(-pi (x / (a L))^2)` with `a = sqrt(ln 2 / pi)`: a wave of length lambda
//! passes with `2^-(L / lambda)^2`, half of it at lambda = L. Every point gets the value of the straight line that fits
//! its neighbourhood best with those weights (moment criterion of first order, ISO 16610-28), as
//! [`gaussian`](super::gaussian) does it with planes: the plain filter away from the ends, and tilts pass unchanged to
//! the very end. The robust form weights points down that lie far off, as the areal one does.

use super::gaussian::{LineKernels, settled};
use crate::error::TextureError;

/// Waves longer than the cut-off; with `robust`, also the number of rounds.
///
/// # Errors
/// A cut-off under two points, or a robust filter that does not settle.
pub fn low_pass(
    heights_um: &[f64],
    spacing_um: f64,
    cutoff_um: f64,
    robust: bool,
) -> Result<(Vec<f64>, Option<usize>), TextureError> {
    if !(cutoff_um.is_finite() && cutoff_um >= 2.0 * spacing_um) {
        return Err(TextureError::ShortFilter { index_um: cutoff_um, spacing_um });
    }
    let kernels = LineKernels::new(heights_um.len(), spacing_um, cutoff_um);
    let ones = vec![1.0; heights_um.len()];
    let mean = local_lines(&kernels, heights_um, &ones);
    if !robust {
        return Ok((mean, None));
    }
    let again = |weights: &[f64]| local_lines(&kernels, heights_um, weights);
    let (mean, rounds) = settled(cutoff_um, heights_um, mean, again)?;
    Ok((mean, Some(rounds)))
}

/// Values in the middle of the lines that fit best round every point.
fn local_lines(kernels: &LineKernels, heights_um: &[f64], weights: &[f64]) -> Vec<f64> {
    let buffers = &mut kernels.buffers();
    let [z, zx] = kernels.sums(buffers, heights_um.iter().zip(weights).map(|(z, w)| w * z));
    let [m, mx, mxx] = kernels.sums(buffers, weights.iter().copied());
    let at = |i: usize| {
        let determinant = m[i] * mxx[i] - mx[i] * mx[i];
        // Too little weight on one side determines no tilt; then the mean has to do.
        if determinant > 1e-6 * m[i] * mxx[i] { (z[i] * mxx[i] - zx[i] * mx[i]) / determinant } else { z[i] / m[i] }
    };
    (0..heights_um.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// 2^-(L / lambda)^2 to 1e-6, on every line whose points are a tenth of the cut-off apart or closer.
    #[test]
    fn waves_pass_as_the_law_says() {
        for spacing in [4.0, 8.0, 50.0, 80.0] {
            let cutoff = 800.0;
            for wave in [400.0, 800.0, 1000.0, 2000.0, 3440.0, 8000.0] {
                let count = (40_000.0 / spacing) as usize + 1;
                let at = |i: usize| (TAU * (i as f64 * spacing / wave + 0.1)).sin();
                let line: Vec<f64> = (0..count).map(at).collect();
                let (passed, _) = low_pass(&line, spacing, cutoff, false).expect("a filter");
                // Ten cut-offs away from the ends.
                let range = (8_000.0 / spacing) as usize..(32_000.0 / spacing) as usize;
                let product: f64 = range.clone().map(|i| line[i] * passed[i]).sum();
                let share = product / range.map(|i| line[i] * line[i]).sum::<f64>();
                let law = 2_f64.powf(-(cutoff / wave).powi(2));
                assert!((share - law).abs() < 1e-6, "{spacing} {wave}: {share} is not {law}");
            }
        }
    }

    #[test]
    fn tilted_lines_pass_unchanged_and_a_line_read_backwards_is_filtered_alike() {
        let tilted: Vec<f64> = (0..300).map(|i| 5.0 - 0.3 * f64::from(i)).collect();
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        for robust in [false, true] {
            assert!(off(&low_pass(&tilted, 2.0, 80.0, robust).expect("a filter").0, &tilted) < 1e-10);
            let rough = (0..300).map(|i| (0.37 * f64::from(i)).sin() * (0.011 * f64::from(i * i)).cos());
            let rough: Vec<f64> = rough.collect();
            let backwards: Vec<f64> = rough.iter().rev().copied().collect();
            let there = low_pass(&rough, 2.0, 80.0, robust).expect("a filter").0;
            let mut back = low_pass(&backwards, 2.0, 80.0, robust).expect("a filter").0;
            back.reverse();
            assert!(off(&there, &back) < 1e-9, "{robust}");
        }
    }

    #[test]
    fn a_robust_filter_is_not_pulled_into_a_groove() {
        let line: Vec<f64> = (0..2000)
            .map(|i| 0.05 * (f64::from(i) * 1.7).sin() - if (990..1010).contains(&i) { 20.0 } else { 0.0 })
            .collect();
        let largest = |robust| {
            let (mean, rounds) = low_pass(&line, 1.0, 250.0, robust).expect("a filter");
            assert_eq!(rounds.is_some(), robust);
            mean.iter().fold(0.0, |most: f64, z| most.max(z.abs()))
        };
        assert!(largest(false) > 1.0 && largest(true) < 0.02, "{} {}", largest(false), largest(true));
    }

    #[test]
    fn a_cutoff_below_two_points_is_refused() {
        assert!(
            low_pass(&[0.0; 100], 8.0, 15.0, false).expect_err("too short").to_string().contains("points 8 um apart")
        );
    }
}
