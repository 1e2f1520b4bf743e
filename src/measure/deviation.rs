//! Profile, lead, pitch and runout deviations in the style of ISO 1328:2013, for gears that are not round.
//!
//! Profile and lead: normal deviations over a stated range of a line: total deviation F_alpha or F_beta (range), slope
//! deviation f_H (the mean line's rise over the range) and form deviation f_f (range about the mean line). Pitch:
//! places where the flanks cross the pitch curve, as arcs of that curve, against its mean pitch, its length over the
//! number of teeth (ISO 1328-1:2013, 4.2): single f_p and cumulative F_p. So single deviations add up to zero over the
//! turn, and F_p is never below f_p. Road not taken: pi m as the pitch. A curve that closes a hair short of z pi m then
//! charges all of that to the first tooth. Limits and classes stand in [`super::verdict`].

use super::crossing::Crossing;
use gearcut_core::dexel::{Field, Layer, NO_PASS};
use gearcut_core::gear::blank::Blank;

/// Finished heights along one line of a flank, as a measuring machine traces it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Places of the dexels, mm, increasing: roll, or place along the tooth.
    pub places_mm: Vec<f64>,
    /// Normal deviations, mm; NaN where no pass came.
    pub heights_mm: Vec<f64>,
}

/// Deviations of one trace in one evaluated range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceDeviation {
    /// F_alpha or F_beta, mm: range of the heights.
    pub total_mm: f64,
    /// f_H_alpha or f_H_beta, mm: rise of the mean line; positive when material is left towards the tip, or towards
    /// larger v.
    pub slope_mm: f64,
    /// f_f_alpha or f_f_beta, mm: range about the mean line.
    pub form_mm: f64,
    /// Ends of the evaluated range, mm.
    pub between_mm: [f64; 2],
    /// Heights of the mean line (least squares) there, mm.
    pub mean_line_mm: [f64; 2],
}

impl Trace {
    /// The profile of one row, whose columns have these rolls.
    pub fn along_profile(rolls_mm: Vec<f64>, field: &Field, layer: &Layer, row: usize) -> Self {
        let rows = field.rows();
        Self {
            places_mm: rolls_mm,
            heights_mm: (0..field.columns.len()).map(|column| height_mm(layer, column * rows + row)).collect(),
        }
    }

    /// The line along the tooth of one column.
    pub fn along_tooth(field: &Field, layer: &Layer, column: usize) -> Self {
        let rows = field.rows();
        Self {
            places_mm: field.rows_z_mm.clone(),
            heights_mm: (0..rows).map(|row| height_mm(layer, column * rows + row)).collect(),
        }
    }

    /// A line along the tooth over all rows, where one row may stand for them.
    #[must_use]
    pub fn over_rows(mut self, rows_z_mm: &[f64]) -> Self {
        if let [height_mm] = self.heights_mm[..] {
            self = Self { places_mm: rows_z_mm.to_vec(), heights_mm: vec![height_mm; rows_z_mm.len()] };
        }
        self
    }

    /// Deviations between two places; `None` with fewer than three dexels or untouched ones among them.
    pub fn deviation(&self, between_mm: [f64; 2]) -> Option<TraceDeviation> {
        let [from_mm, to_mm] = between_mm;
        let points: Vec<(f64, f64)> = self
            .places_mm
            .iter()
            .zip(&self.heights_mm)
            .filter(|&(&place, _)| place >= from_mm - 1e-9 && place <= to_mm + 1e-9)
            .map(|(&place, &height)| height.is_finite().then_some((place, height)))
            .collect::<Option<_>>()?;
        of_points(&points, between_mm)
    }
}

/// Deviations of heights over places of an evaluated range, all in mm; `None` with fewer than three of them.
fn of_points(points: &[(f64, f64)], between_mm: [f64; 2]) -> Option<TraceDeviation> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    // From the first height on, so that equal ones have no slope at all.
    let first_mm = points[0].1;
    let (x_mean, above_mean) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + (p.1 - first_mm) / n));
    let y_mean = first_mm + above_mean;
    let (xx, xy) = points.iter().fold((0.0, 0.0), |(xx, xy), p| {
        let dx = p.0 - x_mean;
        (xx + dx * dx, xy + dx * (p.1 - first_mm - above_mean))
    });
    let slope = xy / xx;
    let range = |value: &dyn Fn(&(f64, f64)) -> f64| {
        let (low, high) =
            points.iter().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        high - low
    };
    Some(TraceDeviation {
        total_mm: range(&|p| p.1),
        slope_mm: slope * (between_mm[1] - between_mm[0]),
        form_mm: range(&|p| p.1 - slope * (p.0 - x_mean)),
        between_mm,
        mean_line_mm: between_mm.map(|place| y_mean + slope * (place - x_mean)),
    })
}

fn height_mm(layer: &Layer, index: usize) -> f64 {
    if layer.passes[index] == NO_PASS { f64::NAN } else { f64::from(layer.heights_mm[index]) }
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
    /// Of the flanks of one side in order of teeth, by how far each stands from its nominal place along the circle, in
    /// the unit of the places.
    pub fn of_places(places: &[f64]) -> Self {
        let before = |tooth: usize| places[if tooth == 0 { places.len() - 1 } else { tooth - 1 }];
        Self {
            single_mm: (0..places.len()).map(|tooth| places[tooth] - before(tooth)).collect(),
            cumulative_mm: places.iter().map(|place| place - places[0]).collect(),
        }
    }

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

/// Pitch deviations from the crossings of all flanks of one side in order of teeth, on a pitch curve of this length
/// with so many pitches. `None` if one is missing. Before tooth 1 of a sector there is no tooth: its single
/// deviation is 0.
pub fn pitch(crossings: &[Option<Crossing>], perimeter_mm: f64, pitches: u32) -> Option<PitchDeviations> {
    let arcs: Vec<f64> = crossings.iter().map(|c| c.map(|c| c.arc_mm)).collect::<Option<_>>()?;
    let first = *arcs.first()?;
    let mean_mm = perimeter_mm / f64::from(pitches);
    let previous = |i: usize| match i {
        0 if arcs.len() < pitches as usize => first - mean_mm,
        0 => arcs[arcs.len() - 1] - perimeter_mm,
        _ => arcs[i - 1],
    };
    Some(PitchDeviations {
        single_mm: (0..arcs.len()).map(|i| arcs[i] - previous(i) - mean_mm).collect(),
        cumulative_mm: arcs.iter().enumerate().map(|(i, arc)| arc - first - mean_mm * i as f64).collect(),
    })
}

/// Radial places of a probe in the spaces of a gear, about their mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Runout {
    /// Of the space after each tooth, mm, positive outwards; behind the last tooth of a sector there is none.
    pub radial_mm: Vec<f64>,
}

impl Runout {
    /// F_r: range, mm.
    pub fn total_mm(&self) -> f64 {
        let fold = |(low, high): (f64, f64), &v: &f64| (low.min(v), high.max(v));
        let (low, high) = self.radial_mm.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold);
        high - low
    }
}

/// Runout from the crossings of all flanks with the blank's pitch curve, in order of teeth; `None` if one is missing.
///
/// The probe touches both flanks of a space at the pitch curve, as a ball of fitting size does. Between the flanks the
/// curve's normal turns by 2 gamma; a probe that moves by d along the normal in the middle then moves each contact by d
/// (tan(alpha) cos(gamma) + sin(gamma)) along the curve, so in a space that is wider by w it lies w / (2 (tan(alpha)
/// cos(gamma) + sin(gamma))) deeper. The range is F_r of ISO 1328-2:1997 on a round gear, for small deviations; on
/// other gears no axis is common to all spaces, and the figure says how evenly they were cut to depth. In a ring the
/// probe moves outwards into its space, where the curve's normals open: sin(gamma) is taken off.
///
/// Road not taken: w / (2 tan(alpha)), the law of a rack. On 24 teeth it is 18 % too large.
pub fn runout(
    blank: &Blank,
    left: &[Option<Crossing>],
    right: &[Option<Crossing>],
    pressure_angle_rad: f64,
) -> Option<Runout> {
    let all = |side: &[Option<Crossing>]| side.iter().copied().collect::<Option<Vec<Crossing>>>();
    let (left, right) = (all(left)?, all(right)?);
    let (curve, sign) = (blank.curve(), blank.kind().tip_sign());
    let first = right.first()?;
    let after_turn = Crossing { arc_mm: first.arc_mm + curve.perimeter_mm(), ..*first };
    // The space after a tooth lies between its left flank and the next tooth's right one.
    let last = curve.sector_rad().is_none().then_some(after_turn);
    let spaces: Vec<(Crossing, Crossing)> = left.into_iter().zip(right[1..].iter().copied().chain(last)).collect();
    let width_mm = |(left, right): &(Crossing, Crossing)| right.arc_mm - left.arc_mm;
    let mean_mm = spaces.iter().map(width_mm).sum::<f64>() / spaces.len() as f64;
    let depth = |(left, right): &(Crossing, Crossing)| {
        let [from, to] = [left, right].map(|crossing| curve.frame(crossing.phi_rad).tangent);
        let (sin, cos) = (0.5 * from.perp_dot(to).atan2(from.dot(to))).sin_cos();
        2.0 * (pressure_angle_rad.tan() * cos + sign * sin)
    };
    Some(Runout { radial_mm: spaces.iter().map(|space| sign * (mean_mm - width_mm(space)) / depth(space)).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// A parabola over a slope has its figures in closed form.
    #[test]
    fn a_bent_and_tilted_trace_has_the_figures_of_its_formula() {
        let places_mm: Vec<f64> = (0..=2000).map(|i| f64::from(i) * 1e-3 - 1.0).collect();
        let heights_mm = places_mm.iter().map(|x| 0.004 * x + 0.002 * x * x).collect();
        let trace = Trace { places_mm, heights_mm };
        let deviation = trace.deviation([-1.0, 1.0]).expect("it is complete");
        assert!((deviation.slope_mm - 0.008).abs() < 1e-12);
        assert!((deviation.form_mm - 0.002).abs() < 1e-12);
        // Lowest at the vertex x = -1 (f = -0.002), highest at x = 1 (f = 0.006).
        assert!((deviation.total_mm - 0.008).abs() < 1e-12);
        let mean_mm = 0.002 / 3.0;
        assert!((deviation.mean_line_mm[0] - (mean_mm - 0.004)).abs() < 1e-6);
        let mut holed = trace;
        holed.heights_mm[700] = f64::NAN;
        assert_eq!(holed.deviation([-1.0, 1.0]), None);
        assert!(holed.deviation([0.0, 1.0]).is_some(), "the hole is outside");
    }

    /// Dexels that stop short of the ends of the range, by much or by little, leave the slope what it is.
    #[test]
    fn a_slope_is_the_rise_over_the_whole_range_at_any_distance_of_dexels() {
        for spacing_mm in [0.3, 0.4, 0.7] {
            let places_mm: Vec<f64> = (-2..=2).map(|i| f64::from(i) * spacing_mm).collect();
            let heights_mm = places_mm.iter().map(|x| 0.002 * x).collect();
            let found = Trace { places_mm, heights_mm }.deviation([-1.8, 1.8]).expect("it is complete");
            assert!((found.slope_mm - 0.0072).abs() < 1e-15, "{spacing_mm} mm: {}", found.slope_mm);
            assert!((found.total_mm - 0.008 * spacing_mm).abs() < 1e-15);
            assert_eq!(found.between_mm, [-1.8, 1.8]);
            assert!(found.mean_line_mm.iter().zip([-0.0036, 0.0036]).all(|(at, line)| (at - line).abs() < 1e-15));
        }
    }

    /// Flanks in their places but for the third, on a curve that is 0.06 um short of its teeth's nominal pitches.
    #[test]
    fn pitch_deviations_close_over_the_turn() {
        let (teeth, pitch_mm, off_mm) = (42, 3.0 * std::f64::consts::PI, 0.004);
        let perimeter_mm = f64::from(teeth) * pitch_mm - 6e-5;
        let at =
            |tooth: u32| f64::from(tooth) / f64::from(teeth) * perimeter_mm + if tooth == 2 { off_mm } else { 0.0 };
        let crossing = |tooth| Some(Crossing { point_mm: DVec2::ZERO, phi_rad: 0.0, arc_mm: at(tooth) });
        let mut crossings: Vec<_> = (0..teeth).map(crossing).collect();
        let found = pitch(&crossings, perimeter_mm, teeth).expect("all teeth");
        assert!(found.single_mm.iter().sum::<f64>().abs() < 1e-10);
        for (tooth, expected_mm) in [(0, 0.0), (2, off_mm), (3, -off_mm), (41, 0.0)] {
            assert!((found.single_mm[tooth] - expected_mm).abs() < 1e-10, "tooth {tooth}: {:?}", found.single_mm);
        }
        assert!((found.total_mm() - off_mm).abs() < 1e-10);
        assert!(found.total_mm() >= found.largest_single_mm() - 1e-10);
        crossings[7] = None;
        assert_eq!(pitch(&crossings, perimeter_mm, teeth), None);
    }

    /// Four teeth on 40 mm, by hand: mean pitch 10 mm, single -1, 3, -5, 3 um, cumulative 0, 3, -2, 1 um, F_p 5 um. Any
    /// single deviation is a difference of two cumulative ones, so it cannot be larger than their range.
    #[test]
    fn pitch_deviations_are_those_made_by_hand() {
        let at = |arc_mm| Some(Crossing { point_mm: DVec2::ZERO, phi_rad: 0.0, arc_mm });
        let found = pitch(&[0.0, 10.003, 19.998, 30.001].map(at), 40.0, 4).expect("all teeth");
        let um = |values: &[f64]| values.iter().map(|mm| (mm * 1e6).round() / 1e3).collect::<Vec<_>>();
        assert_eq!(um(&found.single_mm), [-1.0, 3.0, -5.0, 3.0]);
        assert_eq!(um(&found.cumulative_mm), [0.0, 3.0, -2.0, 1.0]);
        assert_eq!(um(&[found.largest_single_mm(), found.total_mm()]), [5.0, 5.0]);
        // Whatever the places: the order of two teeth exchanged, one far off.
        for arcs in [[0.0, 9.0, 21.0, 30.0], [0.0, 10.0, 20.0, 39.0], [3.0, 12.5, 20.0, 31.0]] {
            let found = pitch(&arcs.map(at), 40.0, 4).expect("all teeth");
            assert!(found.total_mm() >= found.largest_single_mm() - 1e-12, "{found:?}");
        }
    }
}
