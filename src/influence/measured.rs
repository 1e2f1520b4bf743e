//! Measured deviations of flanks, and where they stand among places that can be cut.
//!
//! In: a CSV file with the columns `tooth`, `flank`, `u_mm`, `v_mm` and `deviation_um`, in any order, others beside
//! them. Out: [`MeasuredPoint`]s, and a grid of few places with the weights that lead from its heights to the
//! measured places ([`MeasuredPlaces`]): flanks with many places are cut on a coarser grid, between which influences
//! are bilinear.

use super::gear_grid::{FlankGrid, GearGrid, evenly};
use super::measured_table::{MeasuredRow, MeasuredTable};
use crate::job::GearJob;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;
use std::collections::BTreeMap;
use std::path::Path;

/// Most places along profile and tooth on which a flank is cut: influences are smooth, see
/// [`super::gear_grid::WHOLE_FLANK`].
const MOST_PLACES: [usize; 2] = [33, 17];
/// Places nearer to each other than this are one, mm.
pub(super) const SAME_MM: f64 = 1e-6;

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
pub const COLUMNS: [&str; 6] = ["tooth", "flank", "u_mm", "v_mm", "deviation_um", "chart"];
/// The chart of cumulative pitch deviations.
pub const PITCH: &str = "pitch";

impl MeasuredPoint {
    /// Tooth and side of a row with [`COLUMNS`].
    ///
    /// # Errors
    /// Cells that are not what their column says.
    pub fn flank_of(row: &MeasuredRow<6>) -> Result<(u32, Side)> {
        let side = [Side::Left, Side::Right].into_iter().find(|side| side.name() == row.cell(1));
        let tooth = row.cell(0).parse().map_err(|_| row.wrong(0, "the number of a tooth"))?;
        Ok((tooth, side.ok_or_else(|| row.wrong(1, "left or right"))?))
    }

    /// A row with [`COLUMNS`].
    ///
    /// # Errors
    /// Cells that are not what their column says.
    pub fn of(row: &MeasuredRow<6>) -> Result<Self> {
        let (tooth, side) = Self::flank_of(row)?;
        Ok(Self { tooth, side, u_mm: row.number(2)?, v_mm: row.number(3)?, deviation_um: row.number(4)? })
    }
}

/// Reads measured deviations. The charts of an inspection have them as well, in a column `chart`: of these, profiles
/// and helices are taken, and pitch is left out, for the profiles have it.
///
/// # Errors
/// A file that cannot be read; columns that are missing; cells that are not what their column says; no rows.
pub fn read(path: &Path) -> Result<Vec<MeasuredPoint>> {
    let table = MeasuredTable::read(path, COLUMNS, &["chart"])?;
    // What was not measured has no value.
    let rows = table.rows.iter().filter(|row| !row.cell(4).is_empty() && row.cell(5) != PITCH);
    let points: Vec<MeasuredPoint> = rows.map(MeasuredPoint::of).collect::<Result<_>>()?;
    if points.is_empty() {
        let reason = "no row has a deviation_um".to_owned();
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
