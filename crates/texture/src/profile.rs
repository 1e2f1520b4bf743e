//! Profile parameters along one line (ISO 21920-2:2021): Ra, Rq, Rz, Rt, RSm, Rsk, Rku, Rk, Rpk, Rvk, Mr1, Mr2.
//!
//! The line is taken from the surface after its chain, about its own mean line. Evaluation length: the whole line. Rz
//! is the mean of the heights of five sections of equal length; all others are of the whole length. RSm: spacing of
//! profile elements by the crossing-the-line segmentation; an element counts when its peak and its pit rise over and
//! under the mean line by a tenth of Rz and both are wider than a hundredth of a section (ISO 4287:1997, 4.3.1, whose
//! limits ISO 21920 keeps as a choice).

use super::core::Core;
use super::ratio::MaterialRatio;
use super::surface::check_heights;

/// Sections for Rz.
const SECTIONS: usize = 5;
/// Height that a peak or pit needs to count, as a share of Rz.
const HEIGHT_SHARE: f64 = 0.1;
/// Width that it needs, as a share of a section.
const WIDTH_SHARE: f64 = 0.01;

/// Profile parameters; um, per cent for Mr1 and Mr2.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Evaluation length, mm.
    pub length_mm: f64,
    /// Arithmetical mean height.
    pub ra: f64,
    /// Root mean square height.
    pub rq: f64,
    /// Mean of the heights of five sections.
    pub rz: f64,
    /// Height of the whole profile.
    pub rt: f64,
    /// Mean spacing of profile elements.
    pub rsm: Result<f64, String>,
    /// Skewness; NaN on a flat line.
    pub rsk: f64,
    /// Kurtosis; NaN on a flat line.
    pub rku: f64,
    /// Core: Rk, Rpk, Rvk, Mr1, Mr2.
    pub core: Core,
}

impl Profile {
    /// Of heights (um) at equal distances.
    ///
    /// # Errors
    /// Holes on the line, heights beyond [`crate::surface::LARGEST_HEIGHT_UM`], or too few points for five sections.
    pub fn of(heights_um: &[f64], spacing_um: f64) -> Result<Self, String> {
        let n = heights_um.len();
        if n < 2 * SECTIONS {
            return Err(format!("a line of {n} points has no five sections"));
        }
        let holes = heights_um.iter().filter(|z| z.is_nan()).count();
        if holes > 0 {
            return Err(format!("the line crosses {holes} holes"));
        }
        check_heights(heights_um).map_err(|(i, reason)| format!("the height of point {} {reason}", i + 1))?;
        let count = n as f64;
        let mean = heights_um.iter().sum::<f64>() / count;
        let z: Vec<f64> = heights_um.iter().map(|z| z - mean).collect();
        let moment = |power: i32| z.iter().map(|z| z.powi(power)).sum::<f64>() / count;
        let rq = moment(2).sqrt();
        let range = |part: &[f64]| {
            let (low, high) = part.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &z| (l.min(z), h.max(z)));
            high - low
        };
        let rt = range(&z);
        let rz =
            (0..SECTIONS).map(|i| range(&z[i * n / SECTIONS..(i + 1) * n / SECTIONS])).sum::<f64>() / SECTIONS as f64;
        let over = |moment: f64, power: i32| if rt == 0.0 { f64::NAN } else { moment / rq.powi(power) };
        Ok(Self {
            length_mm: (count - 1.0) * spacing_um * 1e-3,
            ra: z.iter().map(|z| z.abs()).sum::<f64>() / count,
            rq,
            rz,
            rt,
            rsm: spacing(&z, spacing_um, rz),
            rsk: over(moment(3), 3),
            rku: over(moment(4), 4),
            core: Core::of(&MaterialRatio::of_heights(&z)),
        })
    }
}

/// RSm, um: mean distance between the upward crossings of significant peaks and pits.
fn spacing(z: &[f64], spacing_um: f64, rz: f64) -> Result<f64, String> {
    let (least_height, least_width) = (HEIGHT_SHARE * rz, WIDTH_SHARE * z.len() as f64 / SECTIONS as f64);
    // Runs above and below the mean line; where they cross it, between points.
    let mut runs: Vec<(bool, f64, f64, f64)> = Vec::new(); // above, start, end, extreme
    let mut start = 0.0;
    let mut extreme = 0.0_f64;
    for i in 0..z.len() {
        extreme = extreme.max(z[i].abs());
        let ends = i + 1 == z.len();
        if ends || (z[i] > 0.0) != (z[i + 1] > 0.0) {
            let end = if ends { i as f64 } else { i as f64 + z[i] / (z[i] - z[i + 1]) };
            runs.push((z[i] > 0.0, start, end, extreme));
            (start, extreme) = (end, 0.0);
        }
    }
    // What is too low or too narrow goes to its neighbours; equal neighbours join.
    let mut kept: Vec<(bool, f64, f64, f64)> = Vec::new();
    for run in runs {
        let counts = run.3 >= least_height && run.2 - run.1 >= least_width;
        match kept.last_mut() {
            Some(last) if !counts || last.0 == run.0 => {
                last.2 = run.2;
                if last.0 == run.0 {
                    last.3 = last.3.max(run.3);
                }
            }
            _ if counts => kept.push(run),
            _ => {}
        }
    }
    // The first and the last run are cut off by the ends of the line: elements are counted between upward crossings.
    let upward: Vec<f64> = kept.windows(2).filter(|pair| !pair[0].0 && pair[1].0).map(|pair| pair[1].1).collect();
    match upward[..] {
        [first, .., last] => Ok((last - first) / (upward.len() - 1) as f64 * spacing_um),
        _ => Err("the line holds no whole profile element".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn a_sine_has_its_closed_forms() {
        // 20 waves of 50 points, amplitude 2 um, 0.5 um apart.
        let heights: Vec<f64> = (0..1000).map(|i| 7.0 + 2.0 * (TAU * (f64::from(i) + 0.3) / 50.0).sin()).collect();
        let profile = Profile::of(&heights, 0.5).expect("a good line");
        let near = |value: f64, closed: f64, share: f64| {
            assert!((value - closed).abs() <= share * closed, "{value} is not {closed}");
        };
        near(profile.ra, 4.0 / PI, 1e-3);
        near(profile.rq, 2_f64.sqrt(), 1e-3);
        near(profile.rz, 4.0, 2e-3);
        near(profile.rt, 4.0, 2e-3);
        near(profile.rku, 1.5, 1e-3);
        near(profile.rsm.expect("whole waves"), 25.0, 1e-3);
        near(profile.core.sk, 1.7747 * 2.0, 5e-3);
        assert!(profile.rsk.abs() < 1e-6);
    }

    #[test]
    fn small_ripples_are_no_elements() {
        let heights: Vec<f64> =
            (0..1000).map(|i| (TAU * f64::from(i) / 200.0).sin() + 0.03 * (TAU * f64::from(i) / 7.0).sin()).collect();
        let rsm = Profile::of(&heights, 1.0).expect("a good line").rsm.expect("whole waves");
        assert!((rsm - 200.0).abs() < 3.0, "{rsm}");
    }

    #[test]
    fn what_cannot_be_evaluated_says_why() {
        assert!(Profile::of(&[0.0; 5], 1.0).expect_err("short").contains("five sections"));
        let mut line = vec![1.0; 50];
        assert!(Profile::of(&line, 1.0).expect("flat").rsm.is_err());
        line[7] = f64::NAN;
        assert!(Profile::of(&line, 1.0).expect_err("a hole").contains("1 holes"));
    }
}
