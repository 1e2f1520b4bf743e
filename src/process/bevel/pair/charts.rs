//! Charts of a bevel pair: motion error, and the bearing on the gear's flank.
//!
//! In: a rolled pair. Out: charts with the names of their files. The bearing is drawn on the gear's flank rolled flat:
//! along the tooth and up over the pitch cone, heel to the right, with the path of contact and, at some of its places,
//! as much of the ellipse as the flank holds.

use super::findings::{ARCSEC_PER_RAD, words};
use super::{RolledBevels, RolledSide};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use gearcut_core::bevel::contact::Contact;
use gearcut_core::math::roots::halve;
use std::f64::consts::TAU;

/// Smallest distance of two ticks of motion errors, arc seconds: less is rounding, not a fault.
const LEAST_ARCSEC: f64 = 0.02;
/// Rows of the flank's outline.
const OUTLINE_ROWS: usize = 24;
/// Corners of a drawn ellipse.
const CORNERS: usize = 240;
/// Halvings of a side of it where the flank ends: to a thousandth of a side.
const EDGE_HALVINGS: u32 = 10;
/// Half axes beyond this many faces are drawn as long as this: flanks that touch along a line.
const MOST_FACES: f64 = 4.0;
/// Places of the path from one drawn ellipse to the next.
const STEP: usize = 4;

/// All charts.
pub fn charts(rolled: &RolledBevels) -> Vec<(String, LineChart)> {
    let bearings = rolled.sides.iter().map(|side| (format!("bearing_{}", words(side)), bearing(side)));
    std::iter::once(("motion_error".to_owned(), motion_error(rolled))).chain(bearings).collect()
}

fn motion_error(rolled: &RolledBevels) -> LineChart {
    let panel = |side: &RolledSide| {
        let arcsec = |(at_rad, error_rad): (f64, f64)| (at_rad.to_degrees(), ARCSEC_PER_RAD * error_rad);
        let of_teeth = side.running.teeth.iter();
        let of_teeth = of_teeth.map(|(at, met)| arcsec((*at, met.map_or(f64::NAN, |(_, error_rad)| error_rad))));
        let carrying = side.running.carrying.iter().map(|(at, _, error_rad)| arcsec((*at, *error_rad)));
        Panel {
            value_name: format!("{} flanks of the gear", words(side)),
            unit: "″".to_owned(),
            series: vec![
                LineSeries { name: "one pair of teeth".to_owned(), points: of_teeth.collect() },
                LineSeries { name: "teeth that carry, over a pitch".to_owned(), points: carrying.collect() },
            ],
            limits: Vec::new(),
            least_division: LEAST_ARCSEC,
        }
    };
    LineChart {
        title: "Motion error: the gear's angle less that of a constant ratio".to_owned(),
        x_name: "angle of the pinion about the middle of the mesh".to_owned(),
        x_unit: "°".to_owned(),
        panels: rolled.sides.iter().map(panel).collect(),
    }
}

fn bearing(side: &RolledSide) -> LineChart {
    let contacts: Vec<&Contact> =
        side.running.teeth.iter().filter_map(|(_, met)| met.as_ref().map(|(contact, _)| contact)).collect();
    let path = contacts.iter().map(|contact| (contact.place_mm[0], contact.place_mm[1]));
    let most_mm = MOST_FACES * side.pair.gear.blank.face_width_mm;
    let rows = rows(side);
    let mut ellipses = Vec::new();
    for contact in contacts.iter().step_by(STEP) {
        ellipses.extend(ellipse(contact, most_mm, &rows));
        ellipses.push((f64::NAN, f64::NAN));
    }
    let series = |name: &str, points: Vec<(f64, f64)>| LineSeries { name: name.to_owned(), points };
    LineChart {
        title: format!("Contact on the gear's {} flank: toe to the left, heel to the right", words(side)),
        x_name: "along the tooth from the middle of the face".to_owned(),
        x_unit: "mm".to_owned(),
        panels: vec![Panel {
            value_name: "height over the pitch cone".to_owned(),
            unit: "mm".to_owned(),
            series: vec![
                series("flank", outline(&rows)),
                series("contact ellipses", ellipses),
                series("path of contact", path.collect()),
            ],
            limits: Vec::new(),
            least_division: 0.0,
        }],
    }
}

/// Rows of the gear's flank: place along the tooth, heights at which it begins and ends, mm.
fn rows(side: &RolledSide) -> Vec<(f64, [f64; 2])> {
    let gear = &side.pair.gear;
    let half_mm = 0.5 * gear.blank.face_width_mm;
    let along_mm = |i: usize| half_mm * (2.0 * i as f64 / (OUTLINE_ROWS - 1) as f64 - 1.0);
    let ends = |i: usize| {
        let row = gear.row(along_mm(i)).ok()?;
        Some((along_mm(i), [row.form_height_mm, row.tip_height_mm]))
    };
    (0..OUTLINE_ROWS).filter_map(ends).collect()
}

/// The flank's edge: form line, heel, tip, toe.
fn outline(rows: &[(f64, [f64; 2])]) -> Vec<(f64, f64)> {
    let form = rows.iter().map(|(along_mm, ends_mm)| (*along_mm, ends_mm[0]));
    let tip = rows.iter().rev().map(|(along_mm, ends_mm)| (*along_mm, ends_mm[1]));
    form.chain(tip).chain(rows.first().map(|(along_mm, ends_mm)| (*along_mm, ends_mm[0]))).collect()
}

/// Whether the flank has a place.
fn holds(rows: &[(f64, [f64; 2])], (along_mm, height_mm): (f64, f64)) -> bool {
    rows.windows(2).any(|pair| {
        let [(from_mm, from_ends), (to_mm, to_ends)] = [pair[0], pair[1]];
        let share = (along_mm - from_mm) / (to_mm - from_mm);
        let [low_mm, high_mm] = [0, 1].map(|k| from_ends[k] + share * (to_ends[k] - from_ends[k]));
        (0.0..=1.0).contains(&share) && (low_mm..=high_mm).contains(&height_mm)
    })
}

/// The ellipse of a contact where the flank holds it; gaps elsewhere.
fn ellipse(contact: &Contact, most_mm: f64, rows: &[(f64, [f64; 2])]) -> Vec<(f64, f64)> {
    let Some(ellipse) = contact.ellipse else { return Vec::new() };
    let [long_mm, short_mm] = ellipse.half_axes_mm.map(|half_mm| half_mm.min(most_mm));
    let [long, short] = ellipse.directions;
    let place = |angle_rad: f64| {
        let (sin, cos) = angle_rad.sin_cos();
        let at = |k: usize| contact.place_mm[k] + long_mm * cos * long[k] + short_mm * sin * short[k];
        (at(0), at(1))
    };
    let inside = |angle_rad: f64| holds(rows, place(angle_rad));
    let angle = |i: usize| TAU * i as f64 / CORNERS as f64;
    let mut points: Vec<(f64, f64)> = inside(0.0).then(|| place(0.0)).into_iter().collect();
    for [from, to] in (0..CORNERS).map(|i| [angle(i), angle(i + 1)]) {
        match [inside(from), inside(to)] {
            [true, true] => points.push(place(to)),
            [true, false] => points.extend([place(halve(inside, from, to, EDGE_HALVINGS)[0]), (f64::NAN, f64::NAN)]),
            [false, true] => points.extend([place(halve(inside, to, from, EDGE_HALVINGS)[0]), place(to)]),
            [false, false] => {}
        }
    }
    points
}
