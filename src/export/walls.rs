//! Smooth walls through sections of a gear, and how far sections are off them.
//!
//! In: sections, each with the same parts from corner to corner. Out: [`SolidWall`]s, cubic B-splines along the
//! profile, by least squares over the arc of every part: spans between knots are halved where a point is farther off
//! than [`PROFILE_SHARE`] of the tolerance, in all sections alike. Neighbours share the points in which they meet.

use super::b_spline::CubicKnots;
use super::section::SectionWish;
use crate::influence::gear_grid::evenly;
use crate::number_text::significant;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use rayon::prelude::*;

/// Share of the tolerance that the fit along the profile may take; the rest is left to the one along the tooth. With
/// twice as much the area of a thin ring was off by 1.9e-5 at the default tolerance.
const PROFILE_SHARE: f64 = 0.35;
/// Points that either half of a span must have in every section for it to be halved.
pub const LEAST_POINTS: usize = 2;
/// Points of a part at least; shorter ones get points on their chords.
const LEAST_PART: usize = 8;
/// Steps of Newton's method to the foot on a curve: it begins at the same share of the arc.
const FOOT_STEPS: u32 = 3;

/// A wall between two seams that run along the tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidWall {
    /// Knots along the profile.
    pub along: CubicKnots,
    /// Control points: a straight wall has one row; others one for each control point along the tooth.
    pub rows_mm: Vec<Vec<DVec2>>,
}

/// A section of all walls.
pub type PlaneWalls<'a> = Vec<(&'a CubicKnots, Vec<DVec2>)>;

/// Faces that are farther off than the tolerance; `instead`: what else can be exported.
pub fn too_coarse(wish: &SectionWish, off_mm: f64, instead: &str) -> Refusal {
    let [off_um, within_um] = [off_mm, wish.tolerance_mm].map(|mm| significant(mm * UM_PER_MM, 2));
    let problem = format!("smooth faces are {off_um} um off the profile, and {within_um} um are allowed");
    Refusal::new("--tolerance-um", problem, format!("allow more, or {instead}"))
}

/// [`too_coarse`] of a cylindrical gear.
pub fn too_coarse_a_wall(wish: &SectionWish, off_mm: f64) -> Refusal {
    too_coarse(wish, off_mm, "export the section with --dxf")
}

/// Walls through all sections, each of which has the same parts; control points are still those of the sections.
///
/// # Errors
/// Sections with other parts; parts that no walls meet within the tolerance.
pub fn fitted(sections: &[Vec<Vec<DVec2>>], wish: &SectionWish) -> Result<Vec<SolidWall>> {
    let count = sections[0].len();
    if sections.iter().any(|parts| parts.len() != count) {
        let problem = "a corner of the profile begins or ends inside the face, so that its faces have no four edges";
        let way_out = "export sections with --dxf and --section-mm, or take mesh/ of `gearcut cut`";
        return Err(Refusal::new("--step", problem, way_out).into());
    }
    let walls_of = |i: usize| {
        let rows: Vec<PartPoints> = sections.iter().map(|parts| PartPoints::new(&parts[i])).collect();
        walls_of(rows, PROFILE_SHARE * wish.tolerance_mm).map_err(|off_mm| too_coarse_a_wall(wish, off_mm).into())
    };
    let walls: Vec<Vec<SolidWall>> = (0..count).into_par_iter().map(walls_of).collect::<Result<_>>()?;
    Ok(walls.into_iter().flatten().collect())
}

/// A wall through sections of a part with the knots that `like_mm`, which is smooth, needs: what lies beside it is
/// averaged by least squares, however far.
///
/// # Errors
/// No wall meets `like_mm` within the tolerance.
pub fn averaged(like_mm: &[DVec2], sections_mm: &[Vec<DVec2>], wish: &SectionWish) -> Result<SolidWall> {
    let missed = |off_mm| too_coarse_a_wall(wish, off_mm);
    let like = wall(&[PartPoints::new(like_mm)], PROFILE_SHARE * wish.tolerance_mm);
    let along = like.map_err(|like| missed(like.off_mm))?.along;
    let fit = |points_mm: &Vec<DVec2>| {
        let part = PartPoints::new(points_mm);
        along.fit(&part.shares, &part.points_mm).ok_or_else(|| missed(f64::INFINITY).into())
    };
    let rows_mm = sections_mm.iter().map(fit).collect::<Result<_>>()?;
    Ok(SolidWall { along, rows_mm })
}

/// A chain's places so evenly far apart that they are no farther than `spacing_mm`.
pub fn evenly_spaced(points_mm: &[DVec2], spacing_mm: f64) -> Vec<DVec2> {
    let part = PartPoints::new(points_mm);
    let length_mm: f64 = points_mm.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let place = |share: f64| {
        let after = part.shares.partition_point(|&other| other <= share).clamp(1, part.shares.len() - 1);
        let [from, to] = [after - 1, after].map(|i| part.shares[i]);
        part.points_mm[after - 1].lerp(part.points_mm[after], (share - from) / (to - from))
    };
    evenly([0.0, 1.0], 1 + (length_mm / spacing_mm).ceil().max(1.0) as usize).into_iter().map(place).collect()
}

/// Walls of a part. A straight part is cut where spans as narrow as they can be do not meet it, at the sharpest point
/// there; others take all of the tolerance. How far they are off is the error, mm.
fn walls_of(rows: Vec<PartPoints>, tolerance_mm: f64) -> Result<Vec<SolidWall>, f64> {
    let mut walls = Vec::new();
    let mut open = vec![rows];
    while let Some(rows) = open.pop() {
        let missed = match wall(&rows, tolerance_mm) {
            Ok(wall) => {
                walls.push(wall);
                continue;
            }
            Err(missed) => missed,
        };
        let [part] = &rows[..] else {
            // What is left along the tooth is measured.
            let wall = missed.wall.filter(|_| missed.off_mm <= tolerance_mm / PROFILE_SHARE);
            walls.push(wall.ok_or(missed.off_mm)?);
            continue;
        };
        let mut cuts: Vec<usize> = missed.spans.iter().filter_map(|&span| part.sharpest(span)).collect();
        cuts.dedup();
        if cuts.is_empty() {
            return Err(missed.off_mm);
        }
        let ends: Vec<usize> = [0].into_iter().chain(cuts).chain([part.points_mm.len() - 1]).collect();
        let parts = ends.windows(2).map(|ends| vec![PartPoints::new(&part.points_mm[ends[0]..=ends[1]])]);
        // The first one is next.
        open.extend(parts.rev());
    }
    Ok(walls)
}

/// Points of a part with their shares of its arc.
struct PartPoints {
    points_mm: Vec<DVec2>,
    shares: Vec<f64>,
}

impl PartPoints {
    fn new(points_mm: &[DVec2]) -> Self {
        let pieces = LEAST_PART.div_ceil(points_mm.len()).max(1) as u32;
        let points_mm = divided(points_mm, pieces);
        let mut arc_mm = 0.0;
        let mut arcs_mm = vec![0.0];
        for pair in points_mm.windows(2) {
            arc_mm += pair[0].distance(pair[1]);
            arcs_mm.push(arc_mm);
        }
        let shares = arcs_mm.iter().map(|of_mm| of_mm / arc_mm).collect();
        Self { points_mm, shares }
    }

    /// The inner point of a span, or next to it, where the chain turns most.
    fn sharpest(&self, [from, to]: [f64; 2]) -> Option<usize> {
        let first = self.shares.partition_point(|&share| share < from).saturating_sub(1).max(1);
        let end = (self.shares.partition_point(|&share| share <= to) + 1).min(self.shares.len() - 1);
        let turn = |i: usize| {
            let [before, own, after] = [i - 1, i, i + 1].map(|i| self.points_mm[i]);
            (own - before).angle_to(after - own).abs()
        };
        (first..end).max_by(|&a, &b| turn(a).total_cmp(&turn(b)))
    }

    fn between(&self, [from, to]: [f64; 2]) -> usize {
        self.shares.partition_point(|&share| share < to) - self.shares.partition_point(|&share| share <= from)
    }
}

/// A chain with every chord in so many pieces.
pub fn divided(points_mm: &[DVec2], pieces: u32) -> Vec<DVec2> {
    let chord = |pair: &[DVec2]| {
        let [from, to] = [pair[0], pair[1]];
        (0..pieces).map(move |i| from.lerp(to, f64::from(i) / f64::from(pieces)))
    };
    points_mm.windows(2).flat_map(chord).chain(points_mm.last().copied()).collect()
}

/// Where no wall is within the tolerance.
struct Missed {
    /// How far the wall is off, mm.
    off_mm: f64,
    /// The nearest one; none where points do not determine it.
    wall: Option<SolidWall>,
    /// Spans that cannot be halved and are too far off.
    spans: Vec<[f64; 2]>,
}

/// The wall with the fewest knots by halving.
fn wall(rows: &[PartPoints], tolerance_mm: f64) -> Result<SolidWall, Missed> {
    let mut places = vec![0.0, 1.0];
    loop {
        let along = CubicKnots::new(&places);
        let fit = |row: &PartPoints| along.fit(&row.shares, &row.points_mm);
        let rows_mm = rows.iter().map(fit).collect::<Option<Vec<_>>>();
        let rows_mm = rows_mm.ok_or(Missed { off_mm: f64::INFINITY, wall: None, spans: vec![[0.0, 1.0]] })?;
        let mut off_mm = vec![0.0_f64; places.len() - 1];
        for (row, controls_mm) in rows.iter().zip(&rows_mm) {
            for (&share, point_mm) in row.shares.iter().zip(&row.points_mm) {
                let span = places[1..places.len() - 1].partition_point(|&place| place <= share);
                off_mm[span] = off_mm[span].max(along.place_mm(controls_mm, share)[0].distance(*point_mm));
            }
        }
        let worst_mm = off_mm.iter().copied().fold(0.0, f64::max);
        if worst_mm <= tolerance_mm {
            return Ok(SolidWall { along, rows_mm });
        }
        let (mut finer, mut spans) = (vec![0.0], Vec::new());
        for (ends, off_mm) in places.windows(2).zip(off_mm) {
            let middle = f64::midpoint(ends[0], ends[1]);
            let holds = |ends| rows.iter().all(|row| row.between(ends) >= LEAST_POINTS);
            if off_mm > tolerance_mm && holds([ends[0], middle]) && holds([middle, ends[1]]) {
                finer.push(middle);
            } else if off_mm > tolerance_mm {
                spans.push([ends[0], ends[1]]);
            }
            finer.push(ends[1]);
        }
        if finer.len() == places.len() {
            return Err(Missed { off_mm: worst_mm, wall: Some(SolidWall { along, rows_mm }), spans });
        }
        places = finer;
    }
}

/// Rows of control points whose splines along the tooth are nearest to those of the sections.
pub fn along_tooth(across: &CubicKnots, rows_z_mm: &[f64], rows_mm: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let mut controls_mm = vec![Vec::new(); rows_mm.len()];
    for column in 0..rows_mm[0].len() {
        let points_mm: Vec<DVec2> = rows_mm.iter().map(|row_mm| row_mm[column]).collect();
        let along_tooth_mm = across.fit(rows_z_mm, &points_mm).expect("points in every span");
        for (row_mm, control_mm) in controls_mm.iter_mut().zip(along_tooth_mm) {
            row_mm.push(control_mm);
        }
    }
    controls_mm
}

/// The section of walls at a place along the tooth.
pub fn in_plane<'a>(walls: &'a [SolidWall], across: Option<&CubicKnots>, z_mm: f64) -> PlaneWalls<'a> {
    let section = |wall: &'a SolidWall| {
        let Some(across) = across else { return (&wall.along, wall.rows_mm[0].clone()) };
        let (first, weights) = across.blend(z_mm);
        let control = |i: usize| weights.iter().zip(&wall.rows_mm[first..]).map(|(w, row_mm)| *w * row_mm[i]).sum();
        (&wall.along, (0..wall.along.count()).map(control).collect())
    };
    walls.iter().map(section).collect()
}

/// Largest distance of points round the gear from walls in their plane, mm.
pub fn off_mm(walls: &PlaneWalls<'_>, points_mm: &[DVec2]) -> f64 {
    offs_mm(walls, points_mm).into_iter().fold(0.0, f64::max)
}

/// The same wall by wall.
pub fn offs_mm(walls: &PlaneWalls<'_>, points_mm: &[DVec2]) -> Vec<f64> {
    let nearest = |place_mm: DVec2| {
        let far = |i: &usize| points_mm[*i].distance_squared(place_mm);
        (0..points_mm.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or_default()
    };
    let starts: Vec<usize> = walls.par_iter().map(|(_, controls_mm)| nearest(controls_mm[0])).collect();
    let count = walls.len();
    let of_wall = |wall: usize| {
        let (from, to) = (starts[wall], starts[(wall + 1) % count]);
        let length = (to + points_mm.len() - from) % points_mm.len();
        let own_mm: Vec<DVec2> = (0..=length).map(|i| points_mm[(from + i) % points_mm.len()]).collect();
        let own = PartPoints::new(&own_mm);
        let off = |(&point_mm, &share): (&DVec2, &f64)| {
            let off_mm = from_wall_mm(&walls[wall], share, point_mm);
            // The nearest point to a corner may lie beyond it.
            let beside = [(wall + count - 1) % count, (wall + 1) % count];
            beside.into_iter().zip([1.0, 0.0]).fold(off_mm, |off_mm, (beside, end)| {
                if share > 0.1 && share < 0.9 {
                    off_mm
                } else {
                    off_mm.min(from_wall_mm(&walls[beside], end, point_mm))
                }
            })
        };
        own.points_mm.iter().zip(&own.shares).map(off).fold(0.0, f64::max)
    };
    (0..count).into_par_iter().map(of_wall).collect()
}

/// Distance of a point from a wall, from a share of its arc on.
fn from_wall_mm((along, controls_mm): &(&CubicKnots, Vec<DVec2>), share: f64, point_mm: DVec2) -> f64 {
    let step = |share: f64| {
        let [place_mm, slope_mm] = along.place_mm(controls_mm, share);
        (share + (point_mm - place_mm).dot(slope_mm) / slope_mm.length_squared()).clamp(0.0, 1.0)
    };
    let foot = (0..FOOT_STEPS).fold(share, |share, _| step(share));
    along.place_mm(controls_mm, foot)[0].distance(point_mm)
}
