//! Charts of a pair over the angle of gear A: ratio, transmission error, backlash, contact ratio, tight centre
//! distance; and the waves of the transmission error as bars.
//!
//! In: a rolled pair and its findings. Out: charts with the names of their files.

use super::double_flank::{DoubleFlank, MASTER_TEETH};
use super::findings::ARCSEC_PER_RAD;
use super::fit::SIDES;
use super::quantities::{AMPLITUDE, TRANSMISSION_ERROR, WAVES};
use super::rolled::RolledPair;
use crate::findings::Findings;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use gearcut_core::units::UM_PER_MM;

/// Ticks of value axes stand at least so far apart: less is rounding, not a fault.
const LEAST_ARCSEC: f64 = 0.02;
const LEAST_UM: f64 = 0.02;
const LEAST_PERCENT: f64 = 0.002;

/// A chart of curves with the name of its file.
pub type NamedLines = (&'static str, LineChart);

/// All charts of curves.
pub fn lines(rolled: &RolledPair) -> Vec<NamedLines> {
    let mut lines = vec![
        ("ratio", ratio(rolled)),
        ("transmission_error", transmission_error(rolled)),
        ("backlash", backlash(rolled)),
        ("contact_ratio", contact_ratio(rolled)),
    ];
    lines.extend(double_flank(rolled).map(|chart| ("double_flank", chart)));
    lines
}

/// Angle of gear A over the period, deg, at every moment.
fn angles_deg(rolled: &RolledPair) -> Vec<f64> {
    rolled.period.moments.iter().map(|moment| moment.pitch.phi_1_rad.to_degrees()).collect()
}

fn over_angle(title: &str, panels: Vec<Panel>) -> LineChart {
    LineChart { title: title.to_owned(), x_name: "angle of gear A".to_owned(), x_unit: "°".to_owned(), panels }
}

fn panel(name: &str, unit: &str, least_division: f64, series: Vec<LineSeries>) -> Panel {
    Panel { value_name: name.to_owned(), unit: unit.to_owned(), series, limits: Vec::new(), least_division }
}

fn series(name: &str, at: &[f64], values: impl Iterator<Item = f64>) -> LineSeries {
    LineSeries { name: name.to_owned(), points: at.iter().copied().zip(values).collect() }
}

fn ratio(rolled: &RolledPair) -> LineChart {
    let at = angles_deg(rolled);
    let asked = series("of the pitch curves", &at, rolled.ratios.iter().map(|ratio| ratio[0]));
    let achieved = series("achieved by the flanks", &at, rolled.ratios.iter().map(|ratio| ratio[1]));
    let off = rolled.ratios.iter().map(|[asked, achieved]| 100.0 * (achieved / asked - 1.0));
    over_angle(
        "Ratio of the speeds of A and B",
        vec![
            panel("ratio", "1", 0.0, vec![achieved, asked]),
            panel("deviation from that ratio", "%", LEAST_PERCENT, vec![series("deviation", &at, off)]),
        ],
    )
}

fn transmission_error(rolled: &RolledPair) -> LineChart {
    let at = angles_deg(rolled);
    let moments = &rolled.period.moments;
    let of = |part: usize| -> Vec<LineSeries> {
        let curves = SIDES.iter().zip(&rolled.errors).map(|(side, error)| {
            let values = [&error.total_rad, &error.long_wave_rad, &error.mesh_rad][part];
            series(&format!("{} flanks drive", side.name()), &at, values.iter().map(|rad| ARCSEC_PER_RAD * rad))
        });
        curves.collect()
    };
    let in_um = SIDES.iter().zip(&rolled.errors).map(|(side, error)| {
        let um = error.total_rad.iter().zip(moments).map(|(rad, at)| UM_PER_MM * rad * at.pitch.radius_mm[1]);
        series(&format!("{} flanks drive", side.name()), &at, um)
    });
    over_angle(
        "Transmission error of B, positive ahead",
        vec![
            panel("total", "″", LEAST_ARCSEC, of(0)),
            panel("at the pitch point", "µm", LEAST_UM, in_um.collect()),
            panel("long wave", "″", LEAST_ARCSEC, of(1)),
            panel("tooth mesh", "″", LEAST_ARCSEC, of(2)),
        ],
    )
}

fn backlash(rolled: &RolledPair) -> LineChart {
    let at = angles_deg(rolled);
    let of = |name: &str, of: &dyn Fn(&crate::pair::backlash::Backlash) -> f64| {
        series(name, &at, rolled.backlash.iter().map(|play| UM_PER_MM * of(play)))
    };
    let across = vec![of("j_c", &|play| play.circumferential_mm)];
    let normal = vec![
        of("right flanks, left ones touching", &|play| play.normal_right_mm),
        of("left flanks, right ones touching", &|play| play.normal_left_mm),
    ];
    let mut panels = vec![panel("circumferential, at the pitch point", "µm", LEAST_UM, across)];
    if rolled.fit.no_involutes().is_none() {
        panels.push(panel("normal to the flanks", "µm", LEAST_UM, normal));
    }
    over_angle("Backlash", panels)
}

fn contact_ratio(rolled: &RolledPair) -> LineChart {
    let at = angles_deg(rolled);
    let path = |side: usize| LineSeries {
        name: format!("{} flanks", SIDES[side].name()),
        points: rolled
            .contact_ratio
            .iter()
            .flat_map(|sides| &sides[side])
            .map(|&(moment, ratio)| (at[moment], ratio))
            .collect(),
    };
    let pairs = |side: usize| {
        let counts = rolled.pairs[side].iter().map(|&count| f64::from(count));
        series(&format!("{} flanks", SIDES[side].name()), &at, counts)
    };
    let mut panels = vec![panel("pairs within the marking thickness", "1", 0.5, vec![pairs(0), pairs(1)])];
    if rolled.contact_ratio.is_ok() {
        panels.insert(0, panel("path of contact over the base pitch", "1", 0.01, vec![path(0), path(1)]));
    }
    over_angle("Contact ratio", panels)
}

fn double_flank(rolled: &RolledPair) -> Option<LineChart> {
    let curve = |name: String, found: &DoubleFlank| {
        let points = found.variation_rad_um.iter().map(|[rad, um]| (rad.to_degrees(), *um));
        LineSeries { name, points: points.collect() }
    };
    let mate = rolled.tight.iter().map(|found| curve("A with B".to_owned(), found)).collect();
    let masters = ["A", "B"].iter().zip(&rolled.masters);
    let masters =
        masters.filter_map(|(gear, found)| Some(curve(format!("gear {gear}"), found.as_ref().ok()?))).collect();
    let panels: Vec<Panel> = [
        ("A with B, tight less nominal".to_owned(), mate),
        (format!("with a master of {MASTER_TEETH} teeth, tight less nominal"), masters),
    ]
    .into_iter()
    .filter(|(_, curves): &(String, Vec<LineSeries>)| !curves.is_empty())
    .map(|(name, curves)| panel(&name, "µm", LEAST_UM, curves))
    .collect();
    if panels.is_empty() {
        return None;
    }
    let chart = over_angle("Double-flank rolling: centre distance", panels);
    Some(LineChart { x_name: "angle of the gear".to_owned(), ..chart })
}

/// Waves of the transmission error that have a name.
pub fn waves(found: &Findings) -> Option<BarChart> {
    let tables: Vec<_> = SIDES
        .iter()
        .map(|side| found.group(&TRANSMISSION_ERROR)?.side(*side)?.table_of(&WAVES))
        .collect::<Option<_>>()?;
    let categories = tables[0].names().collect();
    let series = SIDES.iter().zip(&tables).map(|(side, table)| BarSeries {
        name: format!("{} flanks", side.name()),
        values: table.values(&AMPLITUDE).collect(),
    });
    Some(BarChart {
        has_mean: false,
        title: "Waves of the transmission error".to_owned(),
        category_name: "wave".to_owned(),
        categories,
        value_name: "amplitude".to_owned(),
        unit: "″".to_owned(),
        least_division: LEAST_ARCSEC,
        limits: Vec::new(),
        series: series.collect(),
    })
}
