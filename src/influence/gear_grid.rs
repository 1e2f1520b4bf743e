//! Places on the flanks of a gear at which heights are compared, and the gear cut there.
//!
//! In: a gear and how its flanks are looked at. Out: [`GearGrid`], and heights at all its places in their order.

use crate::job::GearJob;
use crate::process::ProcessJob;
use crate::steps::flanks_of;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{NO_PASS, Ray};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Places along profile and tooth of a flank that is looked at as a whole, odd numbers, so that there is a middle: the
/// shortest waves of errors in use are several times as long as the distance between places.
pub const WHOLE_FLANK: [usize; 2] = [21, 9];
/// Radians in a second of arc.
const RAD_PER_ARCSEC: f64 = PI / 180.0 / 3600.0;
/// Share of the face that is left out at either end.
const FACE_MARGIN: f64 = 0.05;

/// Places on a flank: arcs along the profile times places along the tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankGrid {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Arcs from the form point, mm, increasing.
    pub arcs_mm: Vec<f64>,
    /// Rolls of these arcs, mm.
    pub rolls_mm: Vec<f64>,
    /// Places along the tooth from the middle of the face, mm, increasing.
    pub faces_mm: Vec<f64>,
    /// Points and normals of the target, arc by arc.
    pub rays: Vec<Ray>,
}

impl FlankGrid {
    /// A grid over these places.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn new(gear: &dyn GearJob, tooth: u32, side: Side, arcs_mm: Vec<f64>, faces_mm: Vec<f64>) -> Result<Self> {
        let rows = gear.target_points(tooth, side, &arcs_mm, &faces_mm)?;
        let rays = (0..arcs_mm.len()).flat_map(|column| rows.iter().map(move |row| row[column])).collect();
        let rolls_mm = gear.rolls_mm(tooth, side, &arcs_mm)?;
        Ok(Self { tooth, side, arcs_mm, rolls_mm, faces_mm, rays })
    }

    /// So many places evenly over the evaluated part of the profile and over the face without its ends; of one the
    /// middle.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn inspected(gear: &dyn GearJob, tooth: u32, side: Side, [columns, rows]: [usize; 2]) -> Result<Self> {
        let half_mm = (0.5 - FACE_MARGIN) * gear.scene().gear.face_width_mm;
        let profile_mm = gear.evaluated_profile_mm(tooth, side)?;
        Self::new(gear, tooth, side, evenly(profile_mm, columns), evenly([-half_mm, half_mm], rows))
    }

    /// Heights of a gear over the target, um; NaN where no pass came.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    pub fn heights_um(&self, gear: &dyn GearJob, backend: &dyn Backend) -> Result<Vec<f64>> {
        self.finished(gear, backend, |height_mm, _| UM_PER_MM * f64::from(height_mm))
    }

    /// When the passes that leave these heights are made, s from the beginning of the first operation; NaN where no
    /// pass came.
    ///
    /// # Errors
    /// The tool generates no flank there; the backend's.
    pub fn times_s(&self, gear: &dyn GearJob, backend: &dyn Backend) -> Result<Vec<f64>> {
        self.finished(gear, backend, |_, pass| gear.pass_time_s(pass))
    }

    /// What height, mm, and pass of the last operation say at every place.
    fn finished(&self, gear: &dyn GearJob, backend: &dyn Backend, of: impl Fn(f32, u32) -> f64) -> Result<Vec<f64>> {
        let layers = gear.cut_flank(backend, self.tooth, self.side, &self.arcs_mm, &self.faces_mm)?;
        let finished = layers.last().expect("a job has an operation");
        let at = |(&height_mm, &pass): (&f32, &u32)| if pass == NO_PASS { f64::NAN } else { of(height_mm, pass) };
        Ok(finished.heights_mm.iter().zip(&finished.passes).map(at).collect())
    }

    /// How many places it has.
    pub fn places(&self) -> usize {
        self.arcs_mm.len() * self.faces_mm.len()
    }

    /// Whether only its middle is looked at.
    pub fn is_point(&self) -> bool {
        self.places() == 1
    }

    /// Number of the place at a column and a row.
    pub fn index(&self, column: usize, row: usize) -> usize {
        column * self.faces_mm.len() + row
    }

    /// Number of the middle place.
    pub fn middle(&self) -> usize {
        self.index(self.arcs_mm.len() / 2, self.faces_mm.len() / 2)
    }

    /// How far a flank moves along the circle through a place, counter-clockwise, where it rises by 1 along its normal.
    pub fn around_per_height(&self, place: usize) -> f64 {
        let Ray { origin_mm, normal } = self.rays[place];
        1.0 / DVec3::Z.cross(origin_mm.with_z(0.0)).normalize().dot(normal)
    }
}

/// Places on the flanks of a gear; heights come in the order of the flanks, place by place.
#[derive(Debug, Clone, PartialEq)]
pub struct GearGrid {
    /// How many teeth the gear has.
    pub teeth: u32,
    /// Flanks, in the order of teeth, left before right.
    pub flanks: Vec<FlankGrid>,
}

impl GearGrid {
    /// These flanks as a whole, the evaluated part of the profile over the face without its ends; `and_others`: of all
    /// others the middle of that.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn inspected(gear: &dyn GearJob, whole: &[(u32, Side)], and_others: bool) -> Result<Self> {
        let mut asked = flanks_of(gear);
        asked.retain(|flank| and_others || whole.contains(flank));
        let flanks = asked.into_par_iter().map(|(tooth, side)| {
            let places = if whole.contains(&(tooth, side)) { WHOLE_FLANK } else { [1, 1] };
            FlankGrid::inspected(gear, tooth, side, places)
        });
        Ok(Self { teeth: gear.scene().gear.teeth, flanks: flanks.collect::<Result<_>>()? })
    }

    /// How many places it has.
    pub fn places(&self) -> usize {
        self.flanks.iter().map(FlankGrid::places).sum()
    }

    /// The flanks with their parts of `values`, which has one for each place.
    pub fn split<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = (&'a FlankGrid, &'a [f64])> {
        let mut rest = values;
        self.flanks.iter().map(move |flank| {
            let (own, others) = rest.split_at(flank.places());
            rest = others;
            (flank, own)
        })
    }

    /// Heights of a scene's gear over the target, um; NaN where no pass came. The scene's target must be the grid's.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's.
    #[cfg(feature = "testing")]
    pub fn heights_um(&self, scene: &crate::scene::Scene, backend: &dyn Backend) -> Result<Vec<f64>> {
        self.heights_of_um(crate::process::prepare(scene)?.as_ref(), backend)
    }

    /// The same of a scene that is ready.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's.
    pub fn heights_of_um(&self, job: &dyn ProcessJob, backend: &dyn Backend) -> Result<Vec<f64>> {
        self.of_flanks(job, |flank, gear| flank.heights_um(gear, backend))
    }

    /// When the passes that leave these heights are made, s; NaN where no pass came.
    ///
    /// # Errors
    /// As for [`Self::heights_of_um`].
    pub fn times_s(&self, job: &dyn ProcessJob, backend: &dyn Backend) -> Result<Vec<f64>> {
        self.of_flanks(job, |flank, gear| flank.times_s(gear, backend))
    }

    fn of_flanks(
        &self,
        job: &dyn ProcessJob,
        of: impl Fn(&FlankGrid, &dyn GearJob) -> Result<Vec<f64>> + Sync,
    ) -> Result<Vec<f64>> {
        let mut values = Vec::new();
        job.with_gear(&mut |gear| {
            let flanks: Result<Vec<Vec<f64>>> = self.flanks.par_iter().map(|flank| of(flank, gear)).collect();
            values = flanks?.concat();
            Ok(())
        })?;
        Ok(values)
    }
}

/// What a turn of the gear counter-clockwise adds at the places of a grid, um per arc second.
pub fn turn_um_per_arcsec(grid: &GearGrid) -> Vec<f64> {
    let of_flank = |flank: &FlankGrid| -> Vec<f64> {
        let at = |place: usize| {
            let radius_mm = flank.rays[place].origin_mm.truncate().length();
            UM_PER_MM * RAD_PER_ARCSEC * radius_mm / flank.around_per_height(place)
        };
        (0..flank.places()).map(at).collect()
    };
    grid.flanks.iter().flat_map(of_flank).collect()
}

/// So many places from one to the other, both included; the middle if it is one.
pub fn evenly([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    if count == 1 {
        return vec![0.5 * (from + to)];
    }
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}
