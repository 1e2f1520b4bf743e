//! The gear as a solid: smooth walls round the teeth, two plane ends, bore or rim.
//!
//! In: a cylindrical gear, what is wanted of its section. Out: [`GearSolid`]: one wall for each flank, tip land and
//! root, cubic B-splines along the profile ([`super::walls`]), and how far the profile is off them at most. As cut:
//! [`super::cut_walls`]. The target:
//!
//! **Along the tooth** straight walls are swept. Helical ones are fitted in transverse sections with the same knots in
//! all of them, and cubic splines with the parameter z pass through the sections' control points: any section of the
//! wall is then one B-spline in its plane, and both edges are those of the neighbours to the last bit.
//!
//! **Measured** are points of the target some three times as dense as those of the fit, in the transverse plane, where
//! no distance is smaller than in space: for helical walls at both ends and half way between all fitted sections. While
//! that is too far, there are twice as many sections.

use super::b_spline::CubicKnots;
use super::cut_walls::{CutWalls, cut_helical, cut_straight};
use super::section::{ProfileSource, SectionWish, spacing_mm, target_parts_mm};
use super::walls::{SolidWall, along_tooth, fitted, in_plane, off_mm, too_coarse_a_wall};
use crate::job::CylindricalGear;
use crate::pair_job::watch::Watch;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::gear::Back;
use glam::DVec2;
use rayon::prelude::*;

/// Spacing of measured points over that of fitted ones.
const MEASURED_SHARE: f64 = 0.37;
/// Distances of fitted sections over the face, at first and at most.
const INTERVALS: [usize; 2] = [3, 96];

/// The gear as a solid, gear frame, mm.
#[derive(Debug, Clone, PartialEq)]
pub struct GearSolid {
    /// Walls, counter-clockwise; each begins where the one before ends.
    pub walls: Vec<SolidWall>,
    /// Knots along the tooth, over z in mm; none: walls are straight.
    pub across: Option<CubicKnots>,
    /// Half of the face width, mm.
    pub half_face_mm: f64,
    /// Bore or rim.
    pub back: Back,
    /// Largest distance of a measured place of the profile from the walls, mm.
    pub off_mm: f64,
    /// The same of roots where these are no part of it, mm.
    pub roots_mm: Option<f64>,
}

impl GearSolid {
    /// The whole gear within the tolerance of `wish`.
    ///
    /// # Errors
    /// A profile that is not met within the tolerance; those of the profile.
    pub fn new(
        gear: &dyn CylindricalGear,
        backend: &dyn Backend,
        wish: &SectionWish,
        watch: &Watch<'_>,
    ) -> Result<Self> {
        let half_face_mm = 0.5 * gear.scene().gear.face_width_mm;
        let is_straight = gear.scene().gear.helix_angle_rad == 0.0;
        let fine_mm = MEASURED_SHARE * spacing_mm(gear, wish);
        let solid = |walls, across, off_mm| {
            let solid = Self { walls, across, half_face_mm, back: gear.blank().back, off_mm, roots_mm: None };
            if off_mm > wish.tolerance_mm { Err(too_coarse_a_wall(wish, off_mm).into()) } else { Ok(solid) }
        };
        if wish.source == ProfileSource::Cut {
            let cut = if is_straight { cut_straight } else { cut_helical };
            let CutWalls { walls, across, off_mm, roots_mm } = cut(gear, backend, wish, watch)?;
            return Ok(Self { roots_mm, ..solid(walls, across, off_mm)? });
        }
        let teeth = gear.scene().gear.teeth as usize;
        let sections = |name: &str, rows_z_mm: &[f64], spacing_mm: f64| -> Result<Vec<Vec<Vec<DVec2>>>> {
            let stage = watch.stage(name, rows_z_mm.len() * teeth, "teeth")?;
            let section = |&z_mm: &f64| target_parts_mm(gear, z_mm, spacing_mm, &stage);
            let parts = rows_z_mm.par_iter().map(section).collect::<Result<_>>()?;
            stage.finish();
            Ok(parts)
        };
        let mut intervals = if is_straight { 0 } else { INTERVALS[0] };
        loop {
            let place_mm = |of: f64| if is_straight { 0.0 } else { half_face_mm * (2.0 * of / intervals as f64 - 1.0) };
            let rows_z_mm: Vec<f64> = (0..=intervals).map(|i| place_mm(i as f64)).collect();
            let mut walls = fitted(&sections("profile", &rows_z_mm, spacing_mm(gear, wish))?, wish)?;
            let across = (!is_straight).then(|| CubicKnots::through(&rows_z_mm));
            if let Some(across) = &across {
                for wall in &mut walls {
                    wall.rows_mm = along_tooth(across, &rows_z_mm, &wall.rows_mm);
                }
            }
            let between = (0..intervals).map(|i| place_mm(i as f64 + 0.5));
            let measured_z_mm: Vec<f64> = between.chain([place_mm(0.0), place_mm(intervals as f64)]).collect();
            let measured_z_mm = if is_straight { vec![0.0] } else { measured_z_mm };
            let fine = sections("distance", &measured_z_mm, fine_mm)?;
            let off = |(&z_mm, parts): (&f64, &Vec<Vec<DVec2>>)| {
                off_mm(&in_plane(&walls, across.as_ref(), z_mm), &parts.concat())
            };
            let off_mm = measured_z_mm.iter().zip(&fine).map(off).fold(0.0, f64::max);
            if is_straight || off_mm <= wish.tolerance_mm || intervals >= INTERVALS[1] {
                return solid(walls, across, off_mm);
            }
            intervals *= 2;
        }
    }
}
