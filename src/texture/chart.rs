//! The material ratio curve as a chart, with the construction of the Sk family on it.

use crate::measure::topography::core::Core;
use crate::measure::topography::ratio::MaterialRatio;
use crate::output::line_chart::{LineChart, LineSeries, Panel};

/// Points that the curve is drawn with.
const POINTS: u32 = 1000;
/// Width of the window of the flattest secant, per cent.
const WINDOW_PERCENT: f64 = 40.0;

/// Heights of the curve at `POINTS` + 1 ratios from 0 to 100 %, um.
pub fn points(curve: &MaterialRatio, count: u32) -> Vec<(f64, f64)> {
    (0..=count).map(|i| 100.0 * f64::from(i) / f64::from(count)).map(|p| (p, curve.smc_um(p))).collect()
}

/// Abbott curve with the 40 % window, the equivalent line, and the triangles of Spk and Svk.
pub fn abbott(title: String, curve: &MaterialRatio, core: &Core) -> LineChart {
    let series = |name: String, points: Vec<(f64, f64)>| LineSeries { name, points };
    let (upper, lower) = (core.upper_um, core.lower_um);
    let on_line = |percent: f64| upper + (lower - upper) * percent / 100.0;
    let window = [core.window_percent, (core.window_percent + WINDOW_PERCENT).min(100.0)];
    let mut all = vec![
        series("material ratio curve".to_owned(), points(curve, POINTS)),
        series(format!("equivalent line, Sk {:.4} µm between its ends", core.sk), vec![(0.0, upper), (100.0, lower)]),
        series(
            "40 % window of the flattest secant".to_owned(),
            window.map(|percent| (percent, on_line(percent))).to_vec(),
        ),
    ];
    all.push(series(
        format!("Spk {:.4} µm on Smr1 {:.2} %", core.spk, core.smr1),
        vec![(0.0, upper + core.spk), (core.smr1, upper), (0.0, upper), (0.0, upper + core.spk)],
    ));
    all.push(series(
        format!("Svk {:.4} µm on 100 − Smr2, Smr2 {:.2} %", core.svk, core.smr2),
        vec![(100.0, lower - core.svk), (core.smr2, lower), (100.0, lower), (100.0, lower - core.svk)],
    ));
    LineChart {
        title,
        x_name: "areal material ratio".to_owned(),
        x_unit: "%".to_owned(),
        panels: vec![Panel {
            least_division: 0.0,
            value_name: "height".to_owned(),
            unit: "µm".to_owned(),
            series: all,
            limits: Vec::new(),
        }],
    }
}
