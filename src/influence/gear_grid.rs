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
    /// How far the middle goes counter-clockwise where it rises by 1 along its normal: along the pitch curve if it lies
    /// there, else along the circle through it.
    pub along_per_height: f64,
}

/// A profile's crossing with the pitch curve is looked for among so many places, and again between two of them, where
/// the profile is straight.
const CROSSING_PLACES: usize = 17;
const CROSSING_ROUNDS: usize = 2;

impl FlankGrid {
    /// A grid over these places.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn new(gear: &dyn GearJob, tooth: u32, side: Side, arcs_mm: Vec<f64>, faces_mm: Vec<f64>) -> Result<Self> {
        let rows = gear.target_points(tooth, side, &arcs_mm, &faces_mm)?;
        let rays: Vec<Ray> = (0..arcs_mm.len()).flat_map(|column| rows.iter().map(move |row| row[column])).collect();
        let rolls_mm = gear.rolls_mm(tooth, side, &arcs_mm)?;
        let mut grid = Self { tooth, side, arcs_mm, rolls_mm, faces_mm, rays, along_per_height: 1.0 };
        grid.along_per_height = grid.around_per_height(grid.middle());
        Ok(grid)
    }

    /// The place in the middle of the face where the target crosses the pitch curve, as pitch is measured; none where
    /// it does not, and on gears without such a curve.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn on_pitch_curve(gear: &dyn GearJob, tooth: u32, side: Side) -> Result<Option<Self>> {
        let Some(cylinder) = gear.cylindrical() else { return Ok(None) };
        let foot = |ray: &Ray| {
            let place_mm = ray.origin_mm.truncate();
            cylinder.blank().height(place_mm, place_mm.to_angle())
        };
        let mut crossing_mm = 0.0;
        let mut ends_mm = [0.0, gear.profile_length_mm(tooth, side)?];
        for round in 0..CROSSING_ROUNDS {
            let arcs_mm = evenly(ends_mm, CROSSING_PLACES);
            let rows = gear.target_points(tooth, side, &arcs_mm, &[0.0])?;
            let heights_mm: Vec<f64> = rows[0].iter().map(foot).map(|(height_mm, _)| height_mm).collect();
            let above = heights_mm.partition_point(|&height| height < 0.0);
            if round == 0 && (above == 0 || above == CROSSING_PLACES) {
                return Ok(None);
            }
            let above = above.clamp(1, CROSSING_PLACES - 1);
            let [below_mm, above_mm] = [heights_mm[above - 1], heights_mm[above]];
            let [from_mm, to_mm] = [arcs_mm[above - 1], arcs_mm[above]];
            crossing_mm = from_mm + below_mm / (below_mm - above_mm) * (to_mm - from_mm);
            ends_mm = [from_mm, to_mm];
        }
        let mut place = Self::new(gear, tooth, side, vec![crossing_mm], vec![0.0])?;
        let tangent = cylinder.curve().frame(foot(&place.rays[0]).1).tangent;
        place.along_per_height = 1.0 / tangent.dot(place.rays[0].normal.truncate());
        Ok(Some(place))
    }

    /// Where the pitch of a flank is taken: on the pitch curve, or in the middle of a profile that does not cross one.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn of_pitch(gear: &dyn GearJob, tooth: u32, side: Side) -> Result<Self> {
        Self::on_pitch_curve(gear, tooth, side)?.map_or_else(|| Self::inspected(gear, tooth, side, [1, 1]), Ok)
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

    /// Whether it is a single place, where pitch is taken.
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
    /// These flanks as a whole, the evaluated part of the profile over the face without its ends; `and_pitch`: of all
    /// flanks the place where pitch is taken as well.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn inspected(gear: &dyn GearJob, whole: &[(u32, Side)], and_pitch: bool) -> Result<Self> {
        let mut asked = flanks_of(gear);
        asked.retain(|flank| and_pitch || whole.contains(flank));
        let flanks = asked.into_par_iter().map(|(tooth, side)| {
            let is_whole = whole.contains(&(tooth, side));
            let of_profile = is_whole.then(|| FlankGrid::inspected(gear, tooth, side, WHOLE_FLANK));
            let of_pitch = and_pitch.then(|| FlankGrid::of_pitch(gear, tooth, side));
            of_profile.into_iter().chain(of_pitch).collect()
        });
        Ok(Self { teeth: gear.scene().gear.teeth, flanks: flanks.collect::<Result<Vec<Vec<_>>>>()?.concat() })
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
