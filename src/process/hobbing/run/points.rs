//! Points on five curves beside the pitch curve, as cut against as meant: histogram, findings, and
//! `tables/offset_curves.csv`, which alone has its rows: five or more for every flank.

use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Section, Table};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::hobbing::HobbedGear;
use crate::process::hobbing::measure::offset_curves::{CurvePoint, ErrorSpread};
use crate::process::hobbing::quantities::{
    COUNT, CROSSED, CURVE_OFFSET, CUT_X, CUT_Y, ERROR_ALONG, ERROR_X, ERROR_Y, FREQUENCY, INTERVAL, MEAN_ERROR, MEDIAN,
    ON_FILLETS, POINTS, SIGMA, TARGET_X, TARGET_Y, TOO_FEW,
};
use gearcut_core::units::UM_PER_MM;

/// Points of the curve of a normal distribution.
const CURVE_POINTS: u32 = 200;

/// Errors of all points in one direction.
pub struct Errors {
    /// Key in the results.
    pub key: &'static str,
    /// Name in charts.
    pub name: &'static str,
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
        Errors { key: "error_x", name: "δx", spread: um(&|point| point.error_mm().map(|e| e.x)) },
        Errors { key: "error_y", name: "δy", spread: um(&|point| point.error_mm().map(|e| e.y)) },
        Errors { key: "error_along_curve", name: "along the curve", spread: um(&|point| point.along_mm) },
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
    let fillets = points(gear).filter(|(.., point)| point.on_fillet()).count();
    POINTS
        .section([COUNT.of(points(gear).count()), ON_FILLETS.of(fillets)])
        .table(all_points(gear))
        .parts(errors(gear).iter().map(spread))
}

fn all_points(gear: &HobbedGear) -> Table {
    let um = |value: Option<f64>| value.map(|mm| mm * UM_PER_MM);
    Table::over("all_points", "Points as meant and as cut", points(gear))
        .column(&TOOTH, |&(tooth, ..)| tooth)
        .column(&FLANK, |&(_, side, _)| side)
        .column(&CURVE_OFFSET, |(.., point)| point.offset_mm)
        .column(&CROSSED, |(.., point)| if point.on_fillet() { "fillet" } else { "flank" })
        .column(&TARGET_X, |(.., point)| point.target.point_mm.x)
        .column(&TARGET_Y, |(.., point)| point.target.point_mm.y)
        .column(&CUT_X, |(.., point)| point.cut_mm.map(|p| p.x))
        .column(&CUT_Y, |(.., point)| point.cut_mm.map(|p| p.y))
        .column(&ERROR_X, |(.., point)| um(point.error_mm().map(|e| e.x)))
        .column(&ERROR_Y, |(.., point)| um(point.error_mm().map(|e| e.y)))
        .column(&ERROR_ALONG, |(.., point)| um(point.along_mm))
        .rows_in_file("offset_curves")
}

fn spread(errors: &Errors) -> Section {
    let spread = errors.spread.as_ref();
    let counted = spread.into_iter().flat_map(|spread| spread.medians_um().into_iter().zip(&spread.frequencies));
    let frequencies = Table::over("frequencies", "Frequencies of the errors", counted)
        .column(&MEDIAN, |&(median_um, _)| median_um)
        .column(&FREQUENCY, |&(_, &count)| count);
    Section::new(errors.key, errors.key.replace('_', " "))
        .entries([
            MEAN_ERROR.of_or(spread.map(|of| of.mean_um), TOO_FEW),
            SIGMA.of_or(spread.map(|of| of.sigma_um), TOO_FEW),
            INTERVAL.of_or(spread.map(|of| of.interval_um), TOO_FEW),
        ])
        .table(frequencies)
}
