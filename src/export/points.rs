//! Points of flanks with their normals, for measuring machines.
//!
//! In: any gear, teeth, how many places along profile and tooth. Out: a CSV with a row for each place; units stand in
//! the names of its columns. Places lie evenly over the evaluated profile and over the face without a tenth of it at
//! either end, ends included; one alone lies in the middle, so that `200x1` is a scanned profile and `1x200` a scanned
//! helix.
//!
//! As cut, the point is the target's moved along its normal by the deviation, which is a column of its own: the table
//! is one that `gearcut diagnose` reads.

use super::cut_heights::cut_heights_mm;
use super::section::ProfileSource;
use super::unit::{FileUnit, fixed};
use crate::influence::gear_grid::evenly;
use crate::job::GearJob;
use crate::pair_job::watch::WatchedUnits;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use rayon::prelude::*;
use std::fmt::Write as _;

/// Share of the face that is left out at either end.
const FACE_MARGIN: f64 = 0.1;
/// Digits of normals: a nanometre at the end of a stylus of a hundred millimetres.
const NORMAL_DIGITS: usize = 9;

/// Which points are wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointsWish {
    /// Target or as cut.
    pub source: ProfileSource,
    /// First and last tooth.
    pub teeth: [u32; 2],
    /// Places along the profile and along the tooth.
    pub grid: [usize; 2],
}

/// The table of points; `stage` counts flanks.
///
/// # Errors
/// The tool generates no flank somewhere; a place that no pass has reached; the backend's; Ctrl-C.
pub fn csv(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    wish: &PointsWish,
    unit: FileUnit,
    stage: &WatchedUnits,
) -> Result<String> {
    let [first, last] = wish.teeth;
    let flanks: Vec<(u32, Side)> =
        (first..=last).flat_map(|tooth| [Side::Left, Side::Right].map(|side| (tooth, side))).collect();
    let rows = |&(tooth, side): &(u32, Side)| {
        let rows = flank_rows(gear, backend, wish, unit, (tooth, side))?;
        stage.count()?;
        Ok(rows)
    };
    let rows: Vec<String> = flanks.par_iter().map(rows).collect::<Result<_>>()?;
    let length = match unit {
        FileUnit::Millimetre => "mm",
        FileUnit::Inch => "in",
    };
    let places = ["u", "v", "x", "y", "z"].map(|name| format!("{name}_{length}")).join(",");
    let deviation = match wish.source {
        ProfileSource::Target => "",
        ProfileSource::Cut => ",deviation_um",
    };
    Ok(format!("tooth,flank,{places},nx,ny,nz{deviation}\n{}", rows.concat()))
}

fn flank_rows(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    wish: &PointsWish,
    unit: FileUnit,
    (tooth, side): (u32, Side),
) -> Result<String> {
    let half_mm = (0.5 - FACE_MARGIN) * gear.scene().gear.face_width_mm;
    let arcs_mm = evenly(gear.evaluated_profile_mm(tooth, side)?, wish.grid[0]);
    let rows_mm = evenly([-half_mm, half_mm], wish.grid[1]);
    let target = gear.target_points(tooth, side, &arcs_mm, &rows_mm)?;
    let heights_mm = match wish.source {
        ProfileSource::Target => None,
        ProfileSource::Cut => {
            let flank = (tooth, side);
            Some(cut_heights_mm(gear, backend, flank, [&arcs_mm, &rows_mm], None)?)
        }
    };
    let mut text = String::new();
    for (column, u_mm) in arcs_mm.iter().enumerate() {
        for (row, v_mm) in rows_mm.iter().enumerate() {
            let ray = &target[row][column];
            let place = column * rows_mm.len() + row;
            let height_mm = heights_mm.as_ref().map_or(0.0, |heights_mm| heights_mm[place]);
            let point = ray.at(height_mm);
            let lengths = [*u_mm, *v_mm, point.x, point.y, point.z].map(|mm| unit.shown(mm)).join(",");
            let normal = ray.normal.to_array().map(|part| fixed(part, NORMAL_DIGITS)).join(",");
            let _ = write!(text, "{tooth},{},{lengths},{normal}", side.name());
            if heights_mm.is_some() {
                let _ = write!(text, ",{}", fixed(height_mm * UM_PER_MM, 4));
            }
            text.push('\n');
        }
    }
    Ok(text)
}
