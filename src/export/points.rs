//! Points of flanks with their normals, for measuring machines.
//!
//! In: any gear, teeth, how many places along profile and tooth. Out: [`FlankPoints`], which [`csv()`] and
//! [`super::qif`] write. Places lie evenly over the evaluated profile and over the face without a tenth of it at either
//! end, ends included; one alone lies in the middle, so that `200x1` is a scanned profile and `1x200` a scanned helix.
//!
//! As cut, a point is the target's moved along its normal by the deviation: the table has it as a column of its own and
//! is one that `gearcut diagnose` reads.

use super::cut_heights::cut_heights_mm;
use super::section::ProfileSource;
use super::unit::{FileUnit, fixed};
use crate::influence::gear_grid::evenly;
use crate::job::GearJob;
use crate::pair_job::watch::WatchedUnits;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::Ray;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
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

impl PointsWish {
    /// Flanks.
    pub fn flanks(&self) -> usize {
        2 * (self.teeth[1] + 1 - self.teeth[0]) as usize
    }

    /// Points on all flanks.
    pub fn points(&self) -> usize {
        self.grid.iter().fold(self.flanks(), |product, &count| product.saturating_mul(count))
    }
}

/// Points of one flank: from the form point to the tip, those of one arc one after the other along the tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankPoints {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Arc from the form point and place along the tooth of every point, mm.
    pub places_mm: Vec<[f64; 2]>,
    /// The same on the target, each with the normal out of the gear.
    pub target: Vec<Ray>,
    /// Deviation of the cut flank from the target along these normals, mm; none of the target itself.
    pub heights_mm: Option<Vec<f64>>,
}

impl FlankPoints {
    fn new(gear: &dyn GearJob, backend: &dyn Backend, wish: &PointsWish, (tooth, side): (u32, Side)) -> Result<Self> {
        let half_mm = (0.5 - FACE_MARGIN) * gear.scene().gear.face_width_mm;
        let arcs_mm = evenly(gear.evaluated_profile_mm(tooth, side)?, wish.grid[0]);
        let rows_mm = evenly([-half_mm, half_mm], wish.grid[1]);
        let rows = gear.target_points(tooth, side, &arcs_mm, &rows_mm)?;
        let heights_mm = match wish.source {
            ProfileSource::Target => None,
            ProfileSource::Cut => {
                let flank = (tooth, side);
                Some(cut_heights_mm(gear, backend, flank, [&arcs_mm, &rows_mm], None)?)
            }
        };
        let places_mm = arcs_mm.iter().flat_map(|&u_mm| rows_mm.iter().map(move |&v_mm| [u_mm, v_mm])).collect();
        let target = (0..arcs_mm.len()).flat_map(|column| rows.iter().map(move |row| row[column])).collect();
        Ok(Self { tooth, side, places_mm, target, heights_mm })
    }

    /// The points as cut, or those of the target, mm.
    pub fn points_mm(&self) -> impl Iterator<Item = DVec3> + '_ {
        let height_mm = |place: usize| self.heights_mm.as_ref().map_or(0.0, |heights_mm| heights_mm[place]);
        self.target.iter().enumerate().map(move |(place, ray)| ray.at(height_mm(place)))
    }
}

/// The points; `stage` counts flanks.
///
/// # Errors
/// The tool generates no flank somewhere; a place that no pass has reached; the backend's; Ctrl-C.
pub fn flank_points(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    wish: &PointsWish,
    stage: &WatchedUnits,
) -> Result<Vec<FlankPoints>> {
    let [first, last] = wish.teeth;
    let flanks: Vec<(u32, Side)> =
        (first..=last).flat_map(|tooth| [Side::Left, Side::Right].map(|side| (tooth, side))).collect();
    let points = |&flank: &(u32, Side)| {
        let points = FlankPoints::new(gear, backend, wish, flank)?;
        stage.count()?;
        Ok(points)
    };
    flanks.par_iter().map(points).collect()
}

/// A table with a row for each point; units are in the names of its columns.
pub fn csv(flanks: &[FlankPoints], unit: FileUnit) -> String {
    let length = match unit {
        FileUnit::Millimetre => "mm",
        FileUnit::Inch => "in",
    };
    let places = ["u", "v", "x", "y", "z"].map(|name| format!("{name}_{length}")).join(",");
    let is_cut = flanks.iter().any(|flank| flank.heights_mm.is_some());
    let mut text = format!("tooth,flank,{places},nx,ny,nz{}\n", if is_cut { ",deviation_um" } else { "" });
    for flank in flanks {
        for (place, point_mm) in flank.points_mm().enumerate() {
            let [u, v] = flank.places_mm[place].map(|mm| unit.shown(mm));
            let [point, normal] = [shown(point_mm, unit), direction(flank.target[place].normal)];
            let [point, normal] = [point, normal].map(|parts| parts.join(","));
            let _ = write!(text, "{},{},{u},{v},{point},{normal}", flank.tooth, flank.side.name());
            if let Some(heights_mm) = &flank.heights_mm {
                let _ = write!(text, ",{}", fixed(heights_mm[place] * UM_PER_MM, 4));
            }
            text.push('\n');
        }
    }
    text
}

/// Coordinates of a point as files have them.
pub(super) fn shown(point_mm: DVec3, unit: FileUnit) -> [String; 3] {
    point_mm.to_array().map(|mm| unit.shown(mm))
}

/// Parts of a unit vector as files have them.
pub(super) fn direction(normal: DVec3) -> [String; 3] {
    normal.to_array().map(|part| fixed(part, NORMAL_DIGITS))
}
