//! Profile elements by the crossing-the-line segmentation (ISO 21920-2), and their mean spacing.
//!
//! In: heights about the mean line. Law: hills and dales are what lies between two crossings of the mean line. One that
//! is too low or too narrow to count goes to its neighbours; neighbours of the same kind then are one. Where several
//! crossings lie between a hill and a dale that count, their border is the middle between the first and the last. An
//! element is a hill with a dale beside it; spacings are counted from dale to hill and from hill to dale, over the
//! whole line, and their mean is the parameter. A line that is read backwards, or upside down, so has the same spacing.
//!
//! Road not taken: going along the line and giving what is too small to what came before. The spacing then depends on
//! the direction of the trace (P. J. Scott, Meas. Sci. Technol. 17 (2006) 559).

use crate::error::TextureError;

/// Height that a hill or dale needs to count, as a share of Rz (ISO 4287:1997, 4.3.1; a default of ISO 21920-3).
const HEIGHT_SHARE: f64 = 0.1;
/// Width that it needs, as a share of a section.
const WIDTH_SHARE: f64 = 0.01;

/// A hill or dale between two crossings; places in points.
struct Lobe {
    hill: bool,
    start: f64,
    end: f64,
    extreme: f64,
}

/// Mean spacing of profile elements, um.
///
/// # Errors
/// No whole element.
pub(crate) fn spacing(z: &[f64], spacing_um: f64, section_points: f64, rz: f64) -> Result<f64, TextureError> {
    let (least_height, least_width) = (HEIGHT_SHARE * rz, WIDTH_SHARE * section_points);
    let runs = runs(z);
    let counting: Vec<&Lobe> =
        runs.iter().filter(|run| run.extreme > least_height && run.end - run.start >= least_width).collect();
    let mut up = Vec::new();
    let mut down = Vec::new();
    for pair in counting.windows(2).filter(|pair| pair[0].hill != pair[1].hill) {
        let borders = if pair[1].hill { &mut up } else { &mut down };
        borders.push(0.5 * (pair[0].end + pair[1].start));
    }
    let elements = up.len().saturating_sub(1) + down.len().saturating_sub(1);
    let length: f64 = [up, down].iter().filter_map(|borders| Some(borders.last()? - borders.first()?)).sum();
    if elements == 0 {
        return Err(TextureError::NoElement);
    }
    Ok(length / elements as f64 * spacing_um)
}

/// What lies between the crossings of the mean line, which are found between points.
fn runs(z: &[f64]) -> Vec<Lobe> {
    let mut runs = Vec::new();
    let (mut start, mut extreme) = (0.0, 0.0_f64);
    for i in 0..z.len() {
        extreme = extreme.max(z[i].abs());
        let ends = i + 1 == z.len();
        if ends || (z[i] > 0.0) != (z[i + 1] > 0.0) {
            let end = if ends { i as f64 } else { i as f64 + z[i] / (z[i] - z[i + 1]) };
            runs.push(Lobe { hill: z[i] > 0.0, start, end, extreme });
            (start, extreme) = (end, 0.0);
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deep pits at uneven distances with ripples beside them: which crossing counts is not plain, and must not depend
    /// on the direction.
    #[test]
    fn a_line_read_backwards_or_upside_down_has_the_same_spacing() {
        let at = |i: i32| {
            let x = f64::from(i);
            (0.031 * x).sin() + 0.4 * (0.0071 * x * (1.0 + 0.0001 * x)).sin() + 0.12 * (0.83 * x).sin()
        };
        let line: Vec<f64> = (0..4000).map(at).collect();
        let mean = line.iter().sum::<f64>() / 4000.0;
        let line: Vec<f64> = line.iter().map(|z| z - mean).collect();
        let there = spacing(&line, 0.5, 800.0, 2.5).expect("elements");
        let back: Vec<f64> = line.iter().rev().copied().collect();
        let over: Vec<f64> = line.iter().map(|z| -z).collect();
        for other in [back, over] {
            let found = spacing(&other, 0.5, 800.0, 2.5).expect("elements");
            assert!((found / there - 1.0).abs() < 1e-12, "{found} is not {there}");
        }
    }

    #[test]
    fn small_ripples_are_no_elements() {
        let wave = |i: u32, length: f64| (std::f64::consts::TAU * f64::from(i) / length).sin();
        let line: Vec<f64> = (0..2000).map(|i| wave(i, 200.0) + 0.03 * wave(i, 7.0)).collect();
        let found = spacing(&line, 1.0, 400.0, 2.06).expect("whole waves");
        assert!((found - 200.0).abs() < 1.0, "{found}");
        assert!(spacing(&[0.0; 50], 1.0, 10.0, 0.0).is_err(), "a flat line has none");
    }
}
