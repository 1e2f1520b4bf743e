//! Measured deviations of flanks, and where they stand among places that can be cut.
//!
//! In: a CSV file with the columns `tooth`, `flank`, `u_mm`, `v_mm` and `deviation_um`, in any order, others beside
//! them. Out: [`MeasuredPoint`]s, and a grid of few places with the weights that lead from its heights to the
//! measured places ([`MeasuredPlaces`]): flanks with many places are cut on a coarser grid, between which influences
//! are bilinear.

use super::gear_grid::{FlankGrid, GearGrid, evenly};
use super::measured_table::{MeasuredRow, MeasuredTable};
use crate::job::GearJob;
use crate::measure::topography::surface::LARGEST_HEIGHT_UM;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;
use std::collections::BTreeMap;
use std::path::Path;

/// Most places along profile and tooth on which a flank is cut: influences are smooth, see
/// [`super::gear_grid::WHOLE_FLANK`].
const MOST_PLACES: [usize; 2] = [33, 17];
/// Places nearer to each other than this are one, mm.
pub(super) const SAME_MM: f64 = 1e-6;
/// Deviations beyond this are none, um: a metre, as of heights of surfaces.
const LARGEST_DEVIATION_UM: f64 = LARGEST_HEIGHT_UM;

/// A measured place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Arc from the form point, mm.
    pub u_mm: f64,
    /// Place along the tooth from the middle of the face, mm.
    pub v_mm: f64,
    /// Normal deviation from the target, um, positive where material is.
    pub deviation_um: f64,
}

/// Columns of a table of measured places.
const COLUMNS: [&str; 6] = ["tooth", "flank", "u_mm", "v_mm", "deviation_um", "chart"];

/// What a line of an inspection is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Chart {
    /// Loose places.
    Places,
    /// Along the profile.
    Profile,
    /// Along the tooth.
    Helix,
    /// Cumulative pitch deviations of all flanks of a side.
    Pitch,
}

impl Chart {
    /// As files and tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Places => "places",
            Self::Profile => "profile",
            Self::Helix => "helix",
            Self::Pitch => "pitch",
        }
    }

    fn of(row: &MeasuredRow<6>) -> Result<Self> {
        let name = row.cell(5);
        if name.is_empty() {
            return Ok(Self::Places);
        }
        let known = [Self::Profile, Self::Helix, Self::Pitch].into_iter().find(|chart| chart.name() == name);
        known.ok_or_else(|| row.wrong(5, "profile, helix or pitch"))
    }
}

impl MeasuredPoint {
    fn of(row: &MeasuredRow<6>, chart: Chart) -> Result<Self> {
        let (tooth, side) = row.flank([0, 1])?;
        let [u_mm, v_mm] = match chart {
            Chart::Pitch => [f64::NAN; 2],
            Chart::Places | Chart::Profile | Chart::Helix => [row.number(2)?, row.number(3)?],
        };
        Ok(Self { tooth, side, u_mm, v_mm, deviation_um: row.number_within(4, LARGEST_DEVIATION_UM)? })
    }
}

/// Reads measured deviations in the order of the file, each with its chart; pitch has no place on its flank. Rows
/// without a deviation are left out: what was not measured has no value.
///
/// # Errors
/// A file that cannot be read; columns that are missing; cells that are not what their column says; a place that a
/// chart has twice; no rows.
pub fn read_charts(path: &Path) -> Result<Vec<(Chart, MeasuredPoint)>> {
    let table = MeasuredTable::read(path, COLUMNS, &["chart"])?;
    let mut found = Vec::new();
    let mut places = BTreeMap::new();
    for row in table.rows.iter().filter(|row| !row.cell(4).is_empty()) {
        let chart = Chart::of(row)?;
        let point = MeasuredPoint::of(row, chart)?;
        let MeasuredPoint { tooth, side, u_mm, v_mm, .. } = point;
        // NaN, where pitch is, becomes 0.
        let [u, v] = [u_mm, v_mm].map(|mm| (mm / SAME_MM).round() as i64);
        if let Some(first) = places.insert((chart, tooth, side, u, v), row) {
            let flank = format!("tooth {tooth} {}", side.name());
            let what = match chart {
                Chart::Pitch => format!("the pitch of {flank}"),
                _ => format!("u {u_mm} mm, v {v_mm} mm of {flank}"),
            };
            return Err(row.repeats(first, &what));
        }
        found.push((chart, point));
    }
    if found.is_empty() {
        let reason = "no row has a deviation_um".to_owned();
        return Err(Error::Unreadable { path: path.to_owned(), reason });
    }
    Ok(found)
}

/// Reads measured deviations. The charts of an inspection have them as well, in a column `chart`: of these, profiles
/// and helices are taken, and pitch is left out, for the profiles have it.
///
/// # Errors
/// As for [`read_charts`]; nothing but pitch.
pub fn read(path: &Path) -> Result<Vec<MeasuredPoint>> {
    let on_flanks = read_charts(path)?.into_iter().filter(|(chart, _)| *chart != Chart::Pitch);
    let points: Vec<MeasuredPoint> = on_flanks.map(|(_, point)| point).collect();
    if points.is_empty() {
        let reason = "pitch is all that it has; a diagnosis takes places on flanks".to_owned();
        return Err(Error::Unreadable { path: path.to_owned(), reason });
    }
    Ok(points)
}

/// Measured places among those of a grid.
#[derive(Debug, Clone)]
pub struct MeasuredPlaces {
    /// Where the gear is cut.
    pub grid: GearGrid,
    /// Of each measured place the places of the grid around it, with their weights.
    around: Vec<[(usize, f64); 4]>,
}

impl MeasuredPlaces {
    /// A grid over measured places.
    ///
    /// # Errors
    /// Teeth that the gear does not have, places off its flanks, flanks that the tool does not generate.
    pub fn new(gear: &dyn GearJob, points: &[MeasuredPoint]) -> Result<Self> {
        let teeth = gear.scene().gear.teeth;
        let mut flanks: BTreeMap<(u32, Side), Vec<usize>> = BTreeMap::new();
        for (index, point) in points.iter().enumerate() {
            refuse_off_flank(gear, point)?;
            flanks.entry((point.tooth, point.side)).or_default().push(index);
        }
        let mut grids = Vec::new();
        let mut around = vec![[(0, 0.0); 4]; points.len()];
        let mut before = 0;
        for ((tooth, side), indices) in flanks {
            let places = |of: fn(&MeasuredPoint) -> f64, most: usize| {
                let mut places: Vec<f64> = indices.iter().map(|&index| of(&points[index])).collect();
                places.sort_by(f64::total_cmp);
                places.dedup_by(|a, b| (*a - *b).abs() < SAME_MM);
                if places.len() > most { evenly([places[0], places[places.len() - 1]], most) } else { places }
            };
            let arcs_mm = places(|point| point.u_mm, MOST_PLACES[0]);
            let faces_mm = places(|point| point.v_mm, MOST_PLACES[1]);
            let grid = FlankGrid::new(gear, tooth, side, arcs_mm, faces_mm)?;
            for index in indices {
                let [(i, p), (j, q)] =
                    [between(&grid.arcs_mm, points[index].u_mm), between(&grid.faces_mm, points[index].v_mm)];
                let next = |i: usize, share: f64| if share > 0.0 { i + 1 } else { i };
                let at = |i: usize, j: usize| before + grid.index(i, j);
                around[index] = [
                    (at(i, j), (1.0 - p) * (1.0 - q)),
                    (at(next(i, p), j), p * (1.0 - q)),
                    (at(i, next(j, q)), (1.0 - p) * q),
                    (at(next(i, p), next(j, q)), p * q),
                ];
            }
            before += grid.places();
            grids.push(grid);
        }
        Ok(Self { grid: GearGrid { teeth, flanks: grids }, around })
    }

    /// Values at those places of the grid that weigh most.
    pub fn nearest(&self, values: &[f64]) -> Vec<f64> {
        let nearest =
            |around: &[(usize, f64); 4]| around.iter().fold((0, 0.0), |a, b| if b.1 > a.1 { *b } else { a }).0;
        self.around.iter().map(|around| values[nearest(around)]).collect()
    }

    /// Values at the grid's places, taken to the measured ones.
    pub fn at_points(&self, values: &[f64]) -> Vec<f64> {
        let mean = |around: &[(usize, f64); 4]| {
            around.iter().filter(|(_, weight)| *weight > 0.0).map(|&(place, weight)| weight * values[place]).sum()
        };
        self.around.iter().map(mean).collect()
    }
}

/// Refuses a tooth that the gear does not have.
///
/// # Errors
/// There is no such tooth.
pub fn refuse_tooth(gear: &dyn GearJob, tooth: u32) -> Result<()> {
    let teeth = gear.scene().gear.teeth;
    if (1..=teeth).contains(&tooth) {
        return Ok(());
    }
    let problem = format!("tooth {tooth} was measured, the gear has {teeth}");
    Err(Refusal::new("--measured", problem, "teeth count from 1, counter-clockwise").into())
}

/// Refuses a place that is off its flank.
///
/// # Errors
/// It is; the tool does not generate the flank.
pub fn refuse_off_flank(gear: &dyn GearJob, point: &MeasuredPoint) -> Result<()> {
    refuse_tooth(gear, point.tooth)?;
    let half_mm = 0.5 * gear.scene().gear.face_width_mm + SAME_MM;
    let length_mm = gear.profile_length_mm(point.tooth, point.side)? + SAME_MM;
    if (-SAME_MM..=length_mm).contains(&point.u_mm) && point.v_mm.abs() <= half_mm {
        return Ok(());
    }
    let problem = format!(
        "u {} mm, v {} mm of tooth {} {} is off the flank: u goes from 0 to {length_mm:.4} mm, v from {:.4} to \
         {half_mm:.4} mm",
        point.u_mm,
        point.v_mm,
        point.tooth,
        point.side.name(),
        -half_mm
    );
    let way_out = "u is the arc from the form point, v counts from the middle of the face";
    Err(Refusal::new("--measured", problem, way_out).into())
}

/// The place at or before a value in an increasing list, and how far the value is on the way to the next one, 0 to 1.
fn between(places: &[f64], value: f64) -> (usize, f64) {
    let index = places.partition_point(|place| *place <= value + SAME_MM).max(1) - 1;
    if index + 1 == places.len() {
        return (index, 0.0);
    }
    let share = (value - places[index]) / (places[index + 1] - places[index]);
    (index, if share * (places[index + 1] - places[index]) < SAME_MM { 0.0 } else { share })
}
