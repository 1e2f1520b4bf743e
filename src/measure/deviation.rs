//! Profile, pitch and thickness deviations in the style of ISO 1328-1:2013, for gears that are not round.
//!
//! Profile: heights over the target along its local normals, over a stated range of the profile: total deviation F_alpha (range), slope deviation f_H_alpha (the mean line's rise over the range)
//! and form deviation f_f_alpha (range about the mean line). Pitch: places where the flanks cross the pitch curve, as arcs of that curve, against one pitch pi m each: single f_p and cumulative F_p. No
//! tolerance class is given: the standard's classes are for round gears.

use super::crossing::Crossing;
use crate::dexel::{Field, Layer, NO_PASS};

/// Profile deviations of one flank in one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileDeviation {
    /// F_alpha, mm.
    pub total_mm: f64,
    /// f_H_alpha, mm: positive when material is left towards the tip.
    pub slope_mm: f64,
    /// f_f_alpha, mm.
    pub form_mm: f64,
}

/// Profile deviation of a row between two arc lengths; `None` with fewer than three dexels or untouched ones among them.
pub fn profile(field: &Field, layer: &Layer, row: usize, [from_mm, to_mm]: [f64; 2]) -> Option<ProfileDeviation> {
    let rows = field.rows();
    let inside = |arc: f64| arc >= from_mm - 1e-9 && arc <= to_mm + 1e-9;
    let points: Vec<(f64, f64)> = field
        .columns
        .iter()
        .enumerate()
        .filter(|(_, column)| inside(column.arc_mm))
        .map(|(i, column)| {
            (layer.passes[i * rows + row] != NO_PASS)
                .then(|| (column.arc_mm, f64::from(layer.heights_mm[i * rows + row])))
        })
        .collect::<Option<_>>()?;
    of_points(&points)
}

/// Deviations of heights over places of an evaluated length, both in mm; `None` with fewer than three of them.
pub fn of_points(points: &[(f64, f64)]) -> Option<ProfileDeviation> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let (x_mean, y_mean) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xx, xy) = points.iter().fold((0.0, 0.0), |(xx, xy), p| {
        let dx = p.0 - x_mean;
        (xx + dx * dx, xy + dx * (p.1 - y_mean))
    });
    let slope = xy / xx;
    let range = |value: &dyn Fn(&(f64, f64)) -> f64| {
        let (low, high) =
            points.iter().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        high - low
    };
    Some(ProfileDeviation {
        total_mm: range(&|p| p.1),
        slope_mm: slope * (points[points.len() - 1].0 - points[0].0),
        form_mm: range(&|p| p.1 - slope * (p.0 - x_mean)),
    })
}

/// Pitch deviations of all flanks of one side.
#[derive(Debug, Clone, PartialEq)]
pub struct PitchDeviations {
    /// f_p of each tooth against the one before it (the first against the last), mm.
    pub single_mm: Vec<f64>,
    /// Cumulative deviation of each tooth from the first, mm.
    pub cumulative_mm: Vec<f64>,
}

impl PitchDeviations {
    /// Largest |f_p|, mm.
    pub fn largest_single_mm(&self) -> f64 {
        self.single_mm.iter().map(|f| f.abs()).fold(0.0, f64::max)
    }

    /// F_p: range of the cumulative deviations, mm.
    pub fn total_mm(&self) -> f64 {
        let range = self.cumulative_mm.iter().fold((0.0_f64, 0.0_f64), |(l, h), &v| (l.min(v), h.max(v)));
        range.1 - range.0
    }
}

/// Pitch deviations from the crossings of all flanks of one side in order of teeth; `perimeter_mm` closes the turn. `None` if one is missing.
pub fn pitch(crossings: &[Option<Crossing>], pitch_mm: f64, perimeter_mm: f64) -> Option<PitchDeviations> {
    let arcs: Vec<f64> = crossings.iter().map(|c| c.map(|c| c.arc_mm)).collect::<Option<_>>()?;
    let first = *arcs.first()?;
    let previous = |i: usize| if i == 0 { arcs[arcs.len() - 1] - perimeter_mm } else { arcs[i - 1] };
    Some(PitchDeviations {
        single_mm: (0..arcs.len()).map(|i| arcs[i] - previous(i) - pitch_mm).collect(),
        cumulative_mm: arcs.iter().enumerate().map(|(i, arc)| arc - first - pitch_mm * i as f64).collect(),
    })
}
