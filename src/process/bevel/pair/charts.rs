//! Chart of a bevel pair's motion error.

use super::findings::{ARCSEC_PER_RAD, words};
use super::{RolledBevels, RolledSide};
use crate::number_text::significant;
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use std::f64::consts::TAU;

/// Smallest distance of two ticks of motion errors, arc seconds: less is rounding, not a fault.
const LEAST_ARCSEC: f64 = 0.02;

/// Motion error of one pair of teeth, of the pair before and after it, and of those that carry; with the parabola that
/// the pair's error is while it carries.
pub fn motion_error(rolled: &RolledBevels) -> LineChart {
    let panel = |side: &RolledSide| {
        let arcsec = |(at_rad, error_rad): (f64, f64)| (at_rad.to_degrees(), ARCSEC_PER_RAD * error_rad);
        let pitch_deg = (TAU / f64::from(side.pair.pinion.blank.teeth)).to_degrees();
        let of_teeth = side.running.teeth.iter();
        let of_teeth = of_teeth.map(|(at, met)| arcsec((*at, met.map_or(f64::NAN, |(_, error_rad)| error_rad))));
        let of_teeth: Vec<(f64, f64)> = of_teeth.collect();
        let ends_deg = [of_teeth[0].0, of_teeth[of_teeth.len() - 1].0];
        let beside = |pitches: f64| {
            let moved = of_teeth.iter().map(move |(at, error)| (at + pitches * pitch_deg, *error));
            moved.filter(move |(at, _)| (ends_deg[0]..=ends_deg[1]).contains(at))
        };
        // As many pairs to either side as reach into the chart.
        let most = ((ends_deg[1] - ends_deg[0]) / pitch_deg).ceil() as i32;
        let others = (-most..=most).filter(|pitches| *pitches != 0);
        let gap = std::iter::once((f64::NAN, f64::NAN));
        let others = others.flat_map(|pitches| beside(f64::from(pitches)).chain(gap.clone())).collect();
        let carrying = side.running.carrying.iter().map(|(at, _, error_rad)| arcsec((*at, *error_rad)));
        Panel {
            value_name: format!("{} flanks of the gear", words(side)),
            unit: "″".to_owned(),
            series: [
                LineSeries { name: "one pair of teeth".to_owned(), points: of_teeth },
                LineSeries { name: "other pairs of teeth".to_owned(), points: others },
                LineSeries { name: "teeth that carry, over a pitch".to_owned(), points: carrying.collect() },
            ]
            .into_iter()
            .chain(side.running.parabola().map(|parabola| LineSeries {
                name: format!(
                    "parabola, {} ″ at half a pitch",
                    significant(ARCSEC_PER_RAD * parabola.over_pitch_rad(), 3).replace('-', "−")
                ),
                points: parabola.points().map(arcsec).collect(),
            }))
            .collect(),
            limits: Vec::new(),
            least_division: LEAST_ARCSEC,
        }
    };
    LineChart {
        title: "Motion error: how far the gear is ahead of a constant ratio".to_owned(),
        x_name: "angle of the pinion about the middle of the mesh, as it drives these flanks".to_owned(),
        x_unit: "°".to_owned(),
        panels: rolled.sides.iter().map(panel).collect(),
    }
}
