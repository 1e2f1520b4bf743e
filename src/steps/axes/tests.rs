//! What is said of a made-up machine of ten axes, compared with its closed form; a machine whose rotary axes are taken
//! for linear ones must be noticed.

use super::*;
use crate::findings::quantities::cutting::{OFFSET, TIME};
use crate::findings::{Datum, Table, TableColumn};
use crate::machine::tests::{AXES, Swinging, amplitude, omega_per_s};
use crate::machine::{Axis, AxisKind, Limits, Motion as _, Order, peaks};
use std::f64::consts::PI;

fn own() -> Notice {
    Notice::new("axis.made", Severity::Note, "its own")
}

struct Made {
    peaks: Vec<Peak>,
}

const WORDS: PeakWords = PeakWords {
    at: "at",
    place: "time_s",
    place_unit: ("s", 3),
    place_note: "",
    way_out: "go slower",
    named: |peak| Named { key: peak.name().replace(' ', "_"), title: peak.name(), unlimited: "no limit".to_owned() },
    zero_below: 0.0,
};

impl AxesOfOperation for Made {
    fn name(&self) -> &'static str {
        "finish"
    }

    fn linkage_words(&self) -> String {
        "ten axes".to_owned()
    }

    fn peak_words(&self) -> &PeakWords {
        &WORDS
    }

    fn peaks(&self) -> &[Peak] {
        &self.peaks
    }

    fn place(&self, peak: &Peak) -> f64 {
        peak.at
    }

    fn print_facts(&self, sheet: &mut Sheet) {
        sheet.heading("Operation finish");
    }

    fn own_warnings(&self) -> Vec<Notice> {
        vec![own()]
    }

    fn table(&self) -> Table {
        table_of(&AXES, 0.7)
    }

    fn charts(&self) -> &[NamedChart<LineChart>] {
        &[]
    }

    fn programs(&self, _: &[Notice]) -> Option<Result<Vec<(String, String)>, String>> {
        None
    }
}

fn made(limits: &[Limits; 10]) -> Made {
    Made { peaks: peaks(&Swinging, limits) }
}

/// The axis table at a moment.
fn table_of(axes: &[Axis; 10], time_s: f64) -> Table {
    let table = Table::over("axes", "Axes", [Swinging.at(time_s)]).column(&TIME, |_| time_s);
    rates(positions(table, axes, |motion| motion).column(&OFFSET, |_| 0.5), axes, |motion| motion).into()
}

/// Columns of the axis table at a moment whose numbers are not those of the closed form in the unit that their names
/// end with.
fn wrong_columns(axes: &[Axis; 10], time_s: f64) -> Vec<String> {
    let table = table_of(axes, time_s);
    let names: Vec<String> = table.columns.iter().map(TableColumn::head).collect();
    let cells = table.row(0);
    assert_eq!(names.len(), 1 + 10 + 1 + 10 + 9);
    let closed = [Order::Position, Order::Speed, Order::Acceleration].into_iter().flat_map(|order| {
        let moving = (0..10).filter(move |&axis| axis < 9 || order != Order::Acceleration);
        moving.map(move |axis| {
            let (phase, omega) = (omega_per_s(axis) * time_s + axis as f64, omega_per_s(axis));
            let unit = if axis % 2 == 0 { 180.0 / PI } else { 1.0 };
            let value = match order {
                Order::Position => phase.sin(),
                Order::Speed => omega * phase.cos(),
                Order::Acceleration => -omega * omega * phase.sin(),
            };
            unit * amplitude(axis) * value
        })
    });
    let own = |(name, _): &(String, Datum)| ["time_s", "offset_mm"].contains(&name.as_str());
    let numbers = names.into_iter().zip(cells).filter(|of| !own(of)).zip(closed);
    let wrong = numbers.filter(
        |((_, cell), closed)| !matches!(cell, Datum::Number(value) if (value - closed).abs() <= 1e-12 * closed.abs()),
    );
    wrong.map(|((name, _), _)| name).collect()
}

/// The ten axes as they would be if a rotary one were printed in rad.
fn planted() -> [Axis; 10] {
    AXES.map(|axis| Axis { kind: AxisKind::Linear, ..axis })
}

#[test]
fn tables_are_in_the_units_of_their_columns() {
    assert_eq!(wrong_columns(&AXES, 0.7), Vec::<String>::new());
    let names: Vec<String> = table_of(&AXES, 0.7).columns.iter().map(TableColumn::head).collect();
    assert_eq!(names[..3], ["time_s", "psi_deg", "x_mm"]);
    assert_eq!(names[11..14], ["offset_mm", "work_speed_deg_per_s", "x_speed_mm_per_s"]);
    assert_eq!(names[30..], ["tilt_acceleration_deg_per_s2"]);
}

#[test]
fn a_rotary_axis_in_rad_is_noticed() {
    let wrong = wrong_columns(&planted(), 0.7);
    assert_eq!(wrong.len(), 15, "three columns of each of five rotary axes: {wrong:?}");
    assert_eq!(wrong[0], "psi_mm");
}

#[test]
fn the_terminal_tells_peaks_limits_and_what_is_left() {
    let mut limits = [Limits::default(); 10];
    limits[0].speed = Some(0.6);
    limits[1].speed = Some(0.5);
    let made = made(&limits);
    let rows = peaks::rows(&made);
    assert_eq!((rows.len(), rows[0][2].as_str()), (20, "at"));
    // 0.3 rad/s of 0.6 rad/s allowed; 0.5 mm times 1.5 per s = 0.75 mm/s of 0.5 mm/s.
    assert_eq!([0, 1, 3, 4].map(|i| rows[1][i].as_str()), ["work spindle speed", "17.19 deg/s", "34.38 deg/s", "50 %"]);
    assert_eq!([0, 1, 3, 4].map(|i| rows[3][i].as_str()), ["X speed", "0.7500 mm/s", "0.5000 mm/s", "-50 %"]);
    assert_eq!(
        [0, 1, 3, 4].map(|i| rows[2][i].as_str()),
        ["work spindle acceleration", "17.19 deg/s^2", "not given", ""]
    );
    let told = warnings(&[made]);
    let exceeded = "operation finish: the X speed reaches 0.7500 mm/s, the machine allows 0.5000 mm/s: go slower";
    assert_eq!(told, [Notice::new("axis.limit", Severity::Warning, exceeded), own()]);
}

#[test]
fn findings_carry_units_limits_and_places() {
    let mut limits = [Limits::default(); 10];
    limits[4].acceleration = Some(20.0);
    let made = made(&limits);
    let found = findings(&made);
    assert_eq!(found.sections.len(), 19);
    let cradle = found.at_path("cradle_acceleration").expect("a part of every peak");
    // 1.1 rad times (3 per s)^2 = 9.9 rad/s^2.
    let peak = cradle.quantity("peak").expect("a peak");
    assert_eq!(peak.unit(), Some("deg/s^2"));
    assert!((peak.value().expect("a number") - 9.9 * 180.0 / PI).abs() < 1e-9 && peak.place().is_some());
    assert!((cradle.number("limit").expect("given") - 20.0 * 180.0 / PI).abs() < 1e-9);
    assert!((cradle.number("margin").expect("given") - (1.0 - 9.9 / 20.0)).abs() < 1e-12);
    let free = found.at_path("cradle_speed").and_then(|part| part.quantity("limit")).expect("a limit");
    assert_eq!((free.value(), free.why()), (None, Some("no limit")));
    assert!((margin(&[made]).expect("a limit") - (1.0 - 9.9 / 20.0)).abs() < 1e-12);
}

#[test]
fn panels_show_units_and_limits_on_the_sides_that_are_reached() {
    let mut limits = [Limits::default(); 10];
    (limits[0].speed, limits[1].speed) = (Some(PI), Some(7.0));
    // From a place where the work spindle turns forwards only and X turns back.
    let points = [0.0, 0.3, 0.6].map(|time_s| (time_s, Swinging.at(time_s)));
    let panels = charts::panels(&AXES, 0..10, &limits, Order::Speed, &points);
    assert_eq!(panels.len(), 10);
    let limits_of = |index: usize| panels[index].limits.iter().map(|limit| limit.value).collect::<Vec<_>>();
    assert_eq!((panels[0].unit.as_str(), limits_of(0)), ("°/s", vec![180.0]));
    assert_eq!((panels[1].unit.as_str(), limits_of(1)), ("mm/s", vec![7.0, -7.0]));
    let drawn = panels[0].series[0].points[0].1;
    assert!((drawn - 0.3 * 180.0 / PI).abs() < 1e-8, "{drawn}");
    assert_eq!(charts::panels(&AXES, 0..10, &limits, Order::Acceleration, &points).len(), 9);
}
