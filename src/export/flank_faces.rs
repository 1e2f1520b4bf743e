//! Flanks as smooth faces, of gears whose teeth are no swept sections: spiral bevel gears.
//!
//! In: a gear, what is wanted of its flanks. Out: [`FlankFaces`]: a bicubic B-spline face for each flank, from the form
//! point to the tip and over the whole face width, and how far places of the flank are off it at most.
//!
//! Parameters of a face are the arc from the form point in the middle of the face and the place along the tooth, mm, as
//! in tables and maps. Least squares along the profile of every row, then along the tooth through the rows' control
//! points, are least squares over the whole grid. Knots lie evenly; those along a direction are doubled while it is too
//! far off. What is compared is the place of the same two parameters, which no foot is farther than.
//!
//! As cut, marks lower than the tolerance are averaged; the grid is fine enough to see them.

use super::b_spline::CubicKnots;
use super::cut_heights::cut_heights_mm;
use super::section::{ProfileSource, SectionWish};
use super::walls::too_coarse;
use crate::influence::gear_grid::evenly;
use crate::job::GearJob;
use crate::pair_job::watch::Watch;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use glam::DVec3;
use rayon::prelude::*;

/// Spans between knots along the profile and along the tooth at first: of the target, which is smooth, and of a cut
/// flank.
const SPANS: [usize; 2] = [2, 8];
/// At most.
const MOST_SPANS: usize = 32;
/// Places of a span that are measured; every second one is fitted.
const PLACES: usize = 8;
/// Share of the tolerance that the fit along the profile may take.
const PROFILE_SHARE: f64 = 0.5;

/// One flank, gear frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankFace {
    /// Tooth and side.
    pub flank: (u32, Side),
    /// Knots along the profile, over the arc from the form point, and along the tooth, from the middle of the face, mm.
    pub knots: [CubicKnots; 2],
    /// Control points: rows along the tooth, each along the profile, mm.
    pub rows_mm: Vec<Vec<DVec3>>,
    /// Whether the profile's direction times the tooth's points out of the tooth.
    pub is_outward: bool,
}

/// All flanks of a gear.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankFaces {
    /// Faces, tooth after tooth, the left one first.
    pub faces: Vec<FlankFace>,
    /// Largest distance of a measured place of a flank from its face, mm.
    pub off_mm: f64,
}

impl FlankFaces {
    /// The flanks of all teeth within the tolerance of `wish`.
    ///
    /// # Errors
    /// A flank that is not met within the tolerance; a place that no pass reaches; the backend's; Ctrl-C.
    pub fn new(gear: &dyn GearJob, backend: &dyn Backend, wish: &SectionWish, watch: &Watch<'_>) -> Result<Self> {
        let teeth = gear.scene().gear.teeth;
        let flanks: Vec<(u32, Side)> =
            (1..=teeth).flat_map(|tooth| [Side::Left, Side::Right].map(|side| (tooth, side))).collect();
        let stage = watch.stage("flanks", flanks.len(), "flanks")?;
        let fit = |&flank: &(u32, Side)| {
            let fitted = fitted(gear, backend, wish, flank)?;
            stage.count()?;
            Ok(fitted)
        };
        let fitted: Vec<(FlankFace, f64)> = flanks.par_iter().map(fit).collect::<Result<_>>()?;
        stage.finish();
        let off_mm = fitted.iter().map(|(_, off_mm)| *off_mm).fold(0.0, f64::max);
        Ok(Self { faces: fitted.into_iter().map(|(face, _)| face).collect(), off_mm })
    }
}

/// Places of a flank on a grid: `points_mm[row][column]`.
struct FlankPlaces {
    arcs_mm: Vec<f64>,
    rows_mm: Vec<f64>,
    points_mm: Vec<Vec<DVec3>>,
    is_outward: bool,
}

impl FlankPlaces {
    fn new(
        gear: &dyn GearJob,
        backend: &dyn Backend,
        wish: &SectionWish,
        (tooth, side): (u32, Side),
        spans: [usize; 2],
    ) -> Result<Self> {
        let half_mm = 0.5 * gear.scene().gear.face_width_mm;
        let ends_mm = [[0.0, gear.profile_length_mm(tooth, side)?], [-half_mm, half_mm]];
        let [arcs_mm, rows_mm] = [0, 1].map(|d| evenly(ends_mm[d], PLACES * spans[d] + 1));
        let target = gear.target_points(tooth, side, &arcs_mm, &rows_mm)?;
        let mut points_mm: Vec<Vec<DVec3>> =
            target.iter().map(|row| row.iter().map(|ray| ray.origin_mm).collect()).collect();
        if wish.source == ProfileSource::Cut {
            // On the face cone the blank ends on the flank itself.
            let heights_mm =
                cut_heights_mm(gear, backend, (tooth, side), [&arcs_mm, &rows_mm], Some(wish.tolerance_mm))?;
            for (row, row_mm) in points_mm.iter_mut().enumerate() {
                for (column, point_mm) in row_mm.iter_mut().enumerate() {
                    *point_mm = target[row][column].at(heights_mm[column * rows_mm.len() + row]);
                }
            }
        }
        let [row, column] = [rows_mm.len() / 2, arcs_mm.len() / 2];
        let [own, up, on] = [[row, column], [row, column + 1], [row + 1, column]].map(|[r, c]| target[r][c].origin_mm);
        let is_outward = (up - own).cross(on - own).dot(target[row][column].normal) > 0.0;
        Ok(Self { arcs_mm, rows_mm, points_mm, is_outward })
    }
}

/// A face with the fewest knots by doubling, and how far the flank is off it, mm.
fn fitted(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    wish: &SectionWish,
    flank: (u32, Side),
) -> Result<(FlankFace, f64)> {
    let mut spans = [SPANS[usize::from(wish.source == ProfileSource::Cut)]; 2];
    loop {
        let places = FlankPlaces::new(gear, backend, wish, flank, spans)?;
        let [along, across] = [(&places.arcs_mm, spans[0]), (&places.rows_mm, spans[1])].map(|(params, spans)| {
            let last = params.len() - 1;
            CubicKnots::new(&evenly([params[0], params[last]], spans + 1))
        });
        let determined = "four fitted places in every span";
        let every_second = |values: &[f64]| values.iter().copied().step_by(2).collect::<Vec<_>>();
        let [fitted_arcs_mm, fitted_rows_mm] = [&places.arcs_mm, &places.rows_mm].map(|params| every_second(params));
        let profile = |points_mm: &Vec<DVec3>| {
            let own_mm: Vec<DVec3> = points_mm.iter().copied().step_by(2).collect();
            along.fit(&fitted_arcs_mm, &own_mm).expect(determined)
        };
        let profiles_mm: Vec<Vec<DVec3>> = places.points_mm.iter().step_by(2).map(profile).collect();
        let off_row = |controls_mm: &[DVec3], points_mm: &[DVec3]| {
            let off = |(&arc_mm, point_mm): (&f64, &DVec3)| along.place_mm(controls_mm, arc_mm)[0].distance(*point_mm);
            places.arcs_mm.iter().zip(points_mm).map(off).fold(0.0, f64::max)
        };
        let rows = profiles_mm.iter().zip(places.points_mm.iter().step_by(2));
        let profile_mm = rows.map(|(controls_mm, points_mm)| off_row(controls_mm, points_mm)).fold(0.0, f64::max);
        let columns_mm: Vec<Vec<DVec3>> = (0..along.count())
            .map(|i| {
                let column_mm: Vec<DVec3> = profiles_mm.iter().map(|controls_mm| controls_mm[i]).collect();
                across.fit(&fitted_rows_mm, &column_mm).expect(determined)
            })
            .collect();
        let off = |(&row_mm, points_mm): (&f64, &Vec<DVec3>)| {
            let controls_mm: Vec<DVec3> =
                columns_mm.iter().map(|column_mm| across.place_mm(column_mm, row_mm)[0]).collect();
            off_row(&controls_mm, points_mm)
        };
        let off_mm = places.rows_mm.iter().zip(&places.points_mm).map(off).fold(0.0, f64::max);
        if off_mm <= wish.tolerance_mm {
            let rows_mm =
                (0..across.count()).map(|row| columns_mm.iter().map(|column_mm| column_mm[row]).collect()).collect();
            let is_outward = places.is_outward;
            return Ok((FlankFace { flank, knots: [along, across], rows_mm, is_outward }, off_mm));
        }
        let direction = usize::from(profile_mm <= PROFILE_SHARE * wish.tolerance_mm);
        spans[direction] *= 2;
        if spans[direction] > MOST_SPANS {
            return Err(too_coarse(wish, off_mm, "take --points, or mesh/ of `gearcut cut`").into());
        }
    }
}
