//! Points on five curves beside the pitch curve, as cut against as meant: histogram, findings, and
//! `tables/offset_curves.csv`, which alone has its rows: five or more for every flank.

use crate::findings::{Datum, Quantity, Section, Table, TableColumn};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::hobbing::HobbedGear;
use crate::process::hobbing::measure::offset_curves::{CurvePoint, ErrorSpread};
use gearcut_core::units::UM_PER_MM;

/// Points of the curve of a normal distribution.
const CURVE_POINTS: u32 = 200;

/// Errors of all points in one direction.
pub struct Errors {
    /// Key in the results.
    pub key: &'static str,
    /// Name in charts.
    pub name: &'static str,
    /// What it is.
    definition: &'static str,
    /// Spread; `None` where fewer than two points were cut.
    pub spread: Option<ErrorSpread>,
}

/// Errors in x, in y, and along the curves, of all flanks.
pub fn errors(gear: &HobbedGear) -> [Errors; 3] {
    let um = |error: &dyn Fn(&CurvePoint) -> Option<f64>| {
        let all: Vec<f64> = points(gear).filter_map(|(.., point)| error(point)).map(|mm| mm * UM_PER_MM).collect();
        ErrorSpread::of(&all)
    };
    [
        Errors {
            key: "error_x",
            name: "δx",
            definition: "x of the gear frame, as cut less as meant",
            spread: um(&|point| point.error_mm().map(|e| e.x)),
        },
        Errors {
            key: "error_y",
            name: "δy",
            definition: "y of the gear frame, as cut less as meant",
            spread: um(&|point| point.error_mm().map(|e| e.y)),
        },
        Errors {
            key: "error_along_curve",
            name: "along the curve",
            definition: "distance along the offset curve, positive where material is left",
            spread: um(&|point| point.along_mm),
        },
    ]
}

fn points(gear: &HobbedGear) -> impl Iterator<Item = (u32, &'static str, &CurvePoint)> {
    gear.flanks
        .iter()
        .zip(&gear.points)
        .flat_map(|(flank, points)| points.iter().map(|point| (flank.tooth, flank.side.name(), point)))
}

/// Frequencies of the errors with the fitted normal distribution; none where nothing spreads.
pub fn chart(scene: &str, gear: &HobbedGear) -> Option<LineChart> {
    let all = errors(gear);
    let panels: Vec<Panel> = all.iter().filter_map(panel).collect();
    (!panels.is_empty()).then(|| LineChart {
        title: format!("{scene}: errors of the points on five curves beside the pitch curve"),
        x_name: "error".to_owned(),
        x_unit: "µm".to_owned(),
        panels,
    })
}

fn panel(errors: &Errors) -> Option<Panel> {
    let spread = errors.spread.as_ref()?;
    let medians = spread.medians_um();
    let half = 0.5 * spread.interval_um;
    // The outline of the bars.
    let mut steps = vec![(medians[0] - half, 0.0)];
    for (median, &count) in medians.iter().zip(&spread.frequencies) {
        steps.extend([(median - half, count as f64), (median + half, count as f64)]);
    }
    steps.push((medians[medians.len() - 1] + half, 0.0));
    let (from, to) = (steps[0].0, steps[steps.len() - 1].0);
    let curve = (0..=CURVE_POINTS).map(|i| from + (to - from) * f64::from(i) / f64::from(CURVE_POINTS));
    let mut series = vec![LineSeries { name: format!("{}, {} points", errors.name, spread.count), points: steps }];
    if spread.sigma_um > 0.0 {
        series.push(LineSeries {
            name: format!("normal distribution, mean {:.3} µm, σ {:.3} µm", spread.mean_um, spread.sigma_um),
            points: curve.map(|x| (x, spread.expected(x))).collect(),
        });
    }
    Some(Panel {
        least_division: 0.0,
        value_name: format!("frequency of {}", errors.name),
        unit: "1".to_owned(),
        series,
        limits: Vec::new(),
    })
}

/// Counts of points and the spreads of their errors.
pub fn findings(gear: &HobbedGear) -> Section {
    let count = points(gear).count() as u64;
    let fillets = points(gear).filter(|(.., point)| point.on_fillet()).count() as u64;
    Section::new("offset_curves", "Points on five curves")
        .with(
            "points",
            Quantity::count(
                count,
                "points",
                "crossings of five curves beside the pitch curve with all flanks, middle of the face",
            ),
        )
        .with(
            "points_on_fillets",
            Quantity::count(fillets, "points", "those whose target the hob's tip corner has left"),
        )
        .table(all_points(gear))
        .parts(errors(gear).iter().map(spread))
}

fn all_points(gear: &HobbedGear) -> Table {
    let not_cut = "the flank was not cut there";
    let new = |key, unit, definition| TableColumn::new(key, unit, definition);
    let columns = vec![
        new("tooth", "1", "number of the tooth, from 1"),
        TableColumn::words("flank", "flank: left or right"),
        new("curve_offset", "mm", "distance of the curve from the pitch curve, positive outwards"),
        TableColumn::words("target", "what the curve crosses there: flank or fillet"),
        new("target_x", "mm", "x of the gear frame, as meant"),
        new("target_y", "mm", "y of the gear frame, as meant"),
        new("x", "mm", "x of the gear frame, as cut").or(not_cut),
        new("y", "mm", "y of the gear frame, as cut").or(not_cut),
        new("error_x", "um", "x as cut less as meant").or(not_cut),
        new("error_y", "um", "y as cut less as meant").or(not_cut),
        new("error_along_curve", "um", "distance along the offset curve, positive where material is left").or(not_cut),
    ];
    let um = |value: Option<f64>| Datum::from(value.map(|mm| mm * UM_PER_MM));
    let rows = points(gear).map(|(tooth, side, point)| {
        vec![
            tooth.into(),
            side.into(),
            point.offset_mm.into(),
            if point.on_fillet() { "fillet" } else { "flank" }.into(),
            point.target.point_mm.x.into(),
            point.target.point_mm.y.into(),
            point.cut_mm.map(|p| p.x).into(),
            point.cut_mm.map(|p| p.y).into(),
            um(point.error_mm().map(|e| e.x)),
            um(point.error_mm().map(|e| e.y)),
            um(point.along_mm),
        ]
    });
    Table::new("all_points", "Points as meant and as cut", columns).with_rows(rows).rows_in_file("offset_curves")
}

fn spread(errors: &Errors) -> Section {
    let spread = errors.spread.as_ref();
    let number = |value: fn(&ErrorSpread) -> f64, definition: String| {
        Quantity::number_or(spread.map(value), "um", definition, "fewer than two points were cut")
    };
    let of = errors.definition;
    let columns = vec![
        TableColumn::new("median", "um", "middle of an interval of the error"),
        TableColumn::new("frequency", "points", "points whose error lies in it"),
    ];
    let rows = spread.into_iter().flat_map(|spread| {
        let rows = spread.medians_um().into_iter().zip(&spread.frequencies);
        rows.map(|(median, &frequency)| vec![Datum::from(median), Datum::from(frequency as u64)]).collect::<Vec<_>>()
    });
    Section::new(errors.key, errors.key.replace('_', " "))
        .with("mean", number(|s| s.mean_um, format!("mean error: {of}")))
        .with("sigma", number(|s| s.sigma_um, format!("standard deviation of the errors about their mean: {of}")))
        .with(
            "interval",
            number(|s| s.interval_um, "width of an interval; the middle one is centred on zero".to_owned()),
        )
        .table(Table::new("frequencies", "Frequencies of the errors", columns).with_rows(rows))
}
