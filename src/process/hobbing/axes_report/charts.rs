//! Axis charts of one cycle in the middle of the cut, the feed path of the whole operation, and how the hob's teeth
//! share one transverse section.

use super::linkage_words;
use crate::machine::{AxisMotion, Motion as _, Order};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, Panel};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::{self, AXES};
use crate::process::hobbing::measure::engagement::Engagement;
use crate::process::hobbing::scene::model::HobbingKind;
use crate::steps::axes::NamedChart;
use crate::steps::axes::charts::{Abscissa, chart, panel, panels};
use gearcut_core::error::NotConverged;
use gearcut_core::math::newton::{EVERYWHERE, LastStep, newton_within};
use gearcut_core::units::TURN_RAD;

/// Spacing of the points at which the work of the teeth is shared out, modules.
const ENGAGEMENT_MODULES: f64 = 0.05;
/// Points of a chart of one cycle.
const CHART_POINTS: u32 = 1440;

/// Velocities, accelerations and the feed path.
pub(super) fn all(job: &HobbingJob, operation: &PreparedHobbing) -> [NamedChart<LineChart>; 3] {
    let limits = dynamics::limits(&job.limits);
    let cycle = cycle(operation);
    let (start_s, start_rad) = cycle.first().map_or((0.0, 0.0), |place| (place.time_s, place.polar_rad));
    // Without diagonal feed the shift rests.
    let moving = match operation.spec.kind {
        HobbingKind::Diagonal { .. } => AXES.len(),
        HobbingKind::Plain { .. } => AXES.len() - 1,
    };
    let over = |x: &dyn Fn(&CycleMoment) -> f64, order: Order| {
        let points: Vec<_> = cycle.iter().map(|place| (x(place), place.motion)).collect();
        panels(&AXES, 0..moving, &limits, order, &points)
    };
    let velocities = over(&|place| (place.polar_rad - start_rad).to_degrees(), Order::Speed);
    let accelerations = over(&|place| place.time_s - start_s, Order::Acceleration);
    let linkage = linkage_words(operation);
    let words = [operation.spec.name.as_str(), &job.scene.name, &linkage];
    let chart = |what: &str, x: Abscissa, panels: Vec<Panel>| chart(words, what, x, panels);
    [
        ("velocities", chart("axis velocities", ["polar angle of the pitch point", "°"], velocities)),
        ("accelerations", chart("axis accelerations", ["time within the cycle", "s"], accelerations)),
        ("path", chart("feed path", ["time", "s"], path(operation))),
    ]
}

/// One moment of a cycle.
struct CycleMoment {
    time_s: f64,
    polar_rad: f64,
    motion: [AxisMotion; 6],
}

/// One cycle in the middle of the longest piece.
fn cycle(operation: &PreparedHobbing) -> Vec<CycleMoment> {
    let linkage = &operation.linkage;
    let corners = linkage.corners_s();
    let longest = corners.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let [from, to] = longest.map_or([0.0, 1.0], |c| [c[0], c[1]]);
    // From where a cycle begins, if the piece holds a whole one.
    let middle = (0.5 * (from + to - linkage.cycle_s())).max(from);
    let turn = (linkage.axes::<1>(middle).polar_rad.value() / TURN_RAD).ceil();
    let start = polar_time(operation, turn * TURN_RAD, middle);
    let end = polar_time(operation, (turn + 1.0) * TURN_RAD, start + linkage.cycle_s());
    let place = |i: u32| {
        let time_s = start + (end - start) * f64::from(i) / f64::from(CHART_POINTS);
        let axes = linkage.axes(time_s);
        CycleMoment { time_s, polar_rad: axes.polar_rad.value(), motion: dynamics::motion(&axes) }
    };
    (0..=CHART_POINTS).map(place).collect()
}

/// Time near `guess_s` at which the pitch point has the polar angle `polar_rad`.
fn polar_time(operation: &PreparedHobbing, polar_rad: f64, guess_s: f64) -> f64 {
    newton_within(guess_s, EVERYWHERE, LastStep::relative(1e-12), 50, |time_s| {
        let polar = operation.linkage.axes::<2>(time_s).polar_rad;
        let missing_rad = polar_rad - polar.value();
        [missing_rad, missing_rad / polar.derivative(1)]
    })
}

/// Slide, shift and infeed; feeds are constant between corners, so that the corners draw the path exactly.
fn path(operation: &PreparedHobbing) -> Vec<Panel> {
    let linkage = &operation.linkage;
    let corners = linkage.corners_s();
    let motion: Vec<_> = corners.iter().map(|&time_s| (time_s, linkage.at(time_s))).collect();
    let infeed = corners.iter().map(|&time_s| (time_s, linkage.axes::<1>(time_s).radial_mm.value())).collect();
    let mut panels = panels(&AXES, 4..AXES.len(), &Default::default(), Order::Position, &motion);
    panels.push(panel(["back from full depth", "mm"], vec![("back from full depth", infeed)], []));
    panels
}

/// Share of an operation's work on every hob tooth: one space in the middle of the face stands for all.
///
/// # Errors
/// A work that turns nearly as fast as its hob.
pub(super) fn work_of_teeth(job: &HobbingJob, operation: &PreparedHobbing) -> Result<BarChart, NotConverged> {
    let module_mm = job.scene.gear.module_mm;
    let depth_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
    let grid = [depth_mm, job.stock.addendum_mm, ENGAGEMENT_MODULES * module_mm];
    let work = Engagement::of_space(&operation.linkage, &job.target, &job.hob, 0, 0.0, grid)?;
    let numbered = job.hob.teeth.iter().filter(|tooth| tooth.start == 0);
    let (categories, values) =
        numbered.map(|tooth| (tooth.number.to_string(), Some(100.0 * work.share(tooth.passage)))).unzip();
    Ok(BarChart {
        has_mean: true,
        least_division: 0.0,
        limits: Vec::new(),
        title: format!(
            "{} of {}: area that each hob tooth takes, space 0 ({})",
            operation.spec.name,
            job.scene.name,
            linkage_words(operation)
        ),
        category_name: "hob tooth along the thread".to_owned(),
        categories,
        value_name: "share of the space".to_owned(),
        unit: "%".to_owned(),
        series: vec![BarSeries { name: "all starts".to_owned(), values }],
    })
}
