//! Measured deviations as lines of inspection charts and as loose places, and what a gear is predicted to show there.
//!
//! In: a CSV file as gearcut writes it for its own inspections (`inspection_charts.csv`), or with places alone. Out:
//! [`MeasuredLine`]s, and [`LaidCharts`]: the same lines on the flanks of a gear.
//!
//! **Law.** A measuring machine does not know where zero is. A profile or helix stands anywhere on its chart, and so do
//! the cumulative pitch deviations of a side: what is compared are deviations from the mean of the line, of the
//! measured and of the predicted one alike. Loose places are compared but for a turn of the gear on the measuring
//! machine. Profiles and helices are cut at their own places, pitch where the flanks of the target cross the pitch
//! curve; to first order a flank that stands h higher there crosses the curve h / (t . n) further on, t being the
//! curve's tangent.

use super::gear_grid::{FlankGrid, GearGrid, turn_um_per_arcsec};
use super::measured::{Chart, MeasuredPlaces, MeasuredPoint, SAME_MM, read_charts, refuse_off_flank, refuse_tooth};
use crate::job::GearJob;
use crate::process::ProcessJob;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// A line of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredLine {
    /// What it is.
    pub chart: Chart,
    /// Its places, in order along it; those of pitch have no u and v.
    pub points: Vec<MeasuredPoint>,
}

impl MeasuredLine {
    /// What it is and where, in words.
    pub fn title(&self) -> String {
        let MeasuredPoint { tooth, side, .. } = self.points[0];
        match self.chart {
            Chart::Places => "places".to_owned(),
            Chart::Profile | Chart::Helix => format!("{} of tooth {tooth} {}", self.chart.name(), side.name()),
            Chart::Pitch => format!("pitch of {} flanks", side.name()),
        }
    }

    fn refuse(&self, problem: &str, way_out: &str) -> Refusal {
        Refusal::new("--measured", format!("{} {problem}", self.title()), way_out)
    }
}

/// Reads lines of charts, or loose places where the file has no column `chart`.
///
/// # Errors
/// As for [`read_charts`]; lines that do not run along the flank, or with fewer than two places.
pub fn read_lines(path: &Path) -> Result<Vec<MeasuredLine>> {
    let mut lines: BTreeMap<(Chart, u32, Side), Vec<MeasuredPoint>> = BTreeMap::new();
    for (chart, point) in read_charts(path)? {
        let key = match chart {
            Chart::Places => (chart, 0, Side::Left),
            Chart::Profile | Chart::Helix => (chart, point.tooth, point.side),
            Chart::Pitch => (chart, 0, point.side),
        };
        lines.entry(key).or_default().push(point);
    }
    let line = |((chart, _, _), points): ((Chart, u32, Side), Vec<MeasuredPoint>)| {
        let mut line = MeasuredLine { chart, points };
        let along = |point: &MeasuredPoint| match chart {
            Chart::Places => 0.0,
            Chart::Profile => point.u_mm,
            Chart::Helix => point.v_mm,
            Chart::Pitch => f64::from(point.tooth),
        };
        line.points.sort_by(|a, b| along(a).total_cmp(&along(b)));
        if line.points.len() < 2 {
            return Err(line.refuse("has a single place", "a line says nothing without a second one").into());
        }
        let across = |point: &MeasuredPoint| if chart == Chart::Profile { point.v_mm } else { point.u_mm };
        let wanders = |point: &MeasuredPoint| (across(point) - across(&line.points[0])).abs() > SAME_MM;
        if matches!(chart, Chart::Profile | Chart::Helix) && line.points.iter().any(wanders) {
            let way_out = "a profile runs at one v, a helix at one u; leave the column chart out for loose places";
            return Err(line.refuse("does not run along the flank", way_out).into());
        }
        Ok(line)
    };
    lines.into_iter().map(line).collect()
}

/// Lines on the flanks of a gear.
#[derive(Debug, Clone)]
pub struct LaidCharts {
    grid: GearGrid,
    lines: Vec<LaidLine>,
}

/// A line among the heights of the grid.
#[derive(Debug, Clone)]
struct LaidLine {
    title: String,
    heights: Range<usize>,
    /// Loose places stand between those of the grid.
    places: Option<MeasuredPlaces>,
    /// Predicted deviation for a height of 1.
    per_height: Vec<f64>,
    /// What the measuring machine adds and nobody knows: a constant, or a turn.
    free: Vec<f64>,
}

impl LaidCharts {
    /// Lays lines on a gear.
    ///
    /// # Errors
    /// Places that the gear does not have, flanks that the tool does not generate, pitch of a gear without a pitch
    /// curve.
    pub fn new(gear: &dyn GearJob, lines: &[MeasuredLine]) -> Result<Self> {
        let mut grid = GearGrid { teeth: gear.scene().gear.teeth, flanks: Vec::new() };
        let mut laid = Vec::new();
        for line in lines {
            let (before, count) = (grid.places(), line.points.len());
            let (mut places, mut per_height, mut free) = (None, vec![1.0; count], vec![1.0; count]);
            let MeasuredPoint { tooth, side, u_mm, v_mm, .. } = line.points[0];
            if matches!(line.chart, Chart::Profile | Chart::Helix) {
                line.points.iter().try_for_each(|point| refuse_off_flank(gear, point))?;
            }
            let all = |of: fn(&MeasuredPoint) -> f64| line.points.iter().map(of).collect::<Vec<f64>>();
            match line.chart {
                Chart::Places => {
                    let of = MeasuredPlaces::new(gear, &line.points)?;
                    free = of.at_points(&turn_um_per_arcsec(&of.grid));
                    grid.flanks.extend(of.grid.flanks.iter().cloned());
                    places = Some(of);
                }
                Chart::Profile => grid.flanks.push(FlankGrid::new(gear, tooth, side, all(|p| p.u_mm), vec![v_mm])?),
                Chart::Helix => grid.flanks.push(FlankGrid::new(gear, tooth, side, vec![u_mm], all(|p| p.v_mm))?),
                Chart::Pitch => {
                    for (point, per_height) in line.points.iter().zip(&mut per_height) {
                        let flank = at_pitch_curve(gear, point)?;
                        *per_height = flank.along_per_height;
                        grid.flanks.push(flank);
                    }
                }
            }
            laid.push(LaidLine { title: line.title(), heights: before..grid.places(), places, per_height, free });
        }
        Ok(Self { grid, lines: laid })
    }

    /// Deviations that the gear of a scene made ready has on every line, um, less what the measuring machine adds.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's; places where no pass comes.
    pub fn predicted_um(&self, job: &dyn ProcessJob, backend: &dyn Backend) -> Result<Vec<Vec<f64>>> {
        let heights_um = self.grid.heights_of_um(job, backend)?;
        let of_line = |(index, line): (usize, &LaidLine)| {
            let own = &heights_um[line.heights.clone()];
            let um = match &line.places {
                Some(places) => places.at_points(own),
                None => own.iter().zip(&line.per_height).map(|(height, per_height)| height * per_height).collect(),
            };
            if um.iter().any(|um| um.is_nan()) {
                let problem = format!("no pass comes to a place of {}", line.title);
                return Err(Refusal::new("--measured", problem, "leave out places that the scene does not cut").into());
            }
            Ok(self.known(index, &um))
        };
        self.lines.iter().enumerate().map(of_line).collect()
    }

    /// What is left of the deviations of a line without what the measuring machine may have added.
    pub fn known(&self, line: usize, um: &[f64]) -> Vec<f64> {
        let free = &self.lines[line].free;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let size = dot(free, um) / dot(free, free);
        um.iter().zip(free).map(|(um, free)| um - size * free).collect()
    }
}

/// The place of a flank where its target crosses the pitch curve.
fn at_pitch_curve(gear: &dyn GearJob, point: &MeasuredPoint) -> Result<FlankGrid> {
    let MeasuredPoint { tooth, side, .. } = *point;
    refuse_tooth(gear, tooth)?;
    let found = FlankGrid::on_pitch_curve(gear, tooth, side)?;
    Ok(found.ok_or_else(|| {
        let problem = match gear.cylindrical() {
            Some(_) => format!("tooth {tooth} {} does not cross the pitch curve", side.name()),
            None => "the gear has no pitch curve".to_owned(),
        };
        Refusal::new("--measured", problem, "leave out the chart of pitch")
    })?)
}
