//! The material ratio curve of a window as a chart.

use crate::measure::topography::core::Core;
use crate::measure::topography::ratio::MaterialRatio;
use crate::output::ratio_chart::{RatioChart, SkConstruction};

/// Points that the curve is drawn with.
const POINTS: u32 = 1000;
/// Width of the window of the flattest secant, per cent.
const WINDOW_PERCENT: f64 = 40.0;

/// Heights of the curve at `count` + 1 ratios from 0 to 100 %, um.
pub fn points(curve: &MaterialRatio, count: u32) -> Vec<(f64, f64)> {
    (0..=count).map(|i| 100.0 * f64::from(i) / f64::from(count)).map(|p| (p, curve.smc_um(p))).collect()
}

/// The curve with the construction of the Sk family.
pub fn abbott(title: String, curve: &MaterialRatio, core: &Core) -> RatioChart {
    RatioChart {
        title,
        curve: points(curve, POINTS),
        sk: Some(SkConstruction {
            line_um: [core.upper_um, core.lower_um],
            window_percent: [core.window_percent, core.window_percent + WINDOW_PERCENT],
            smr1_percent: core.smr1,
            smr2_percent: core.smr2,
            spk_um: core.spk,
            svk_um: core.svk,
        }),
    }
}
