//! The gear as a solid: smooth walls round the teeth, two plane ends, bore or rim.
//!
//! In: a cylindrical gear, what is wanted of its section. Out: [`GearSolid`]: one wall for each flank, tip land and
//! root, cubic B-splines along the profile, and how far the target is off them at most.
//!
//! **Along the profile** every part of the contour between corners and ends of flanks is fitted by least squares over
//! its arc. Spans between knots are halved where a point is farther off than [`PROFILE_SHARE`] of the tolerance.
//! Neighbours share the points in which they meet.
//!
//! **Along the tooth** straight walls are swept. Helical ones are fitted in transverse sections with the same knots in
//! all of them, and cubic splines with the parameter z pass through the sections' control points: any section of the
//! wall is then one B-spline in its plane, and both edges are those of the neighbours to the last bit.
//!
//! **Measured** are points of the target some three times as dense as those of the fit, in the transverse plane, where
//! no distance is smaller than in space: for helical walls at both ends and half way between all fitted sections. While
//! that is too far, there are twice as many sections.

use super::arcs::distinct;
use super::b_spline::CubicKnots;
use super::section::{ProfileSource, SectionWish, profile_mm, spacing_mm, target_parts_mm};
use crate::job::CylindricalGear;
use crate::number_text::significant;
use crate::pair_job::watch::Watch;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::Back;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use rayon::prelude::*;

/// Share of the tolerance that the fit along the profile may take; the rest is left to the one along the tooth. With
/// twice as much the area of a thin ring was off by 1.9e-5 at the default tolerance.
const PROFILE_SHARE: f64 = 0.35;
/// Spacing of measured points over that of fitted ones.
const MEASURED_SHARE: f64 = 0.37;
/// A corner of a cut profile turns by so much, rad: tip corners by 0.7 and more.
const CORNER_RAD: f64 = 0.4;
/// Within such a reach to either side, modules: edges of marks turn by a tenth, fillets of a fifth of a module, too.
const CORNER_REACH_MODULES: f64 = 0.02;
/// Points of a cut profile that are nearer than this share of the tolerance are one.
const NEAREST_SHARE: f64 = 0.05;
/// Pieces of a chord of a cut profile where it is measured.
const CHORD_PIECES: u32 = 4;
/// Points that either half of a span must have in every section for it to be halved.
const LEAST_POINTS: usize = 2;
/// Points of a part at least; shorter ones get points on their chords.
const LEAST_PART: usize = 8;
/// Steps of Newton's method to the foot on a curve: it begins at the same share of the arc.
const FOOT_STEPS: u32 = 3;
/// Distances of fitted sections over the face, at first and at most.
const INTERVALS: [usize; 2] = [3, 96];

/// A wall between two seams that run along the tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidWall {
    /// Knots along the profile.
    pub along: CubicKnots,
    /// Control points: a straight wall has one row; others one for each control point along the tooth.
    pub rows_mm: Vec<Vec<DVec2>>,
}

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
}

/// A section of all walls.
type PlaneWalls<'a> = Vec<(&'a CubicKnots, Vec<DVec2>)>;

impl GearSolid {
    /// The whole gear within the tolerance of `wish`.
    ///
    /// # Errors
    /// A helical gear as cut; a profile that is not met within the tolerance; those of the profile.
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
            let solid = Self { walls, across, half_face_mm, back: gear.blank().back, off_mm };
            if off_mm > wish.tolerance_mm { Err(too_coarse_a_wall(wish, off_mm).into()) } else { Ok(solid) }
        };
        if wish.source == ProfileSource::Cut {
            if !is_straight {
                let problem = "a helical gear as cut is no section that is swept straight";
                let way_out = "leave --as-cut out; mesh/ of `gearcut cut` has the surface with its marks";
                return Err(Refusal::new("--as-cut", problem, way_out).into());
            }
            let stage = watch.stage("profile", gear.scene().gear.teeth as usize, "teeth")?;
            let chain_mm = profile_mm(gear, backend, wish, &stage)?;
            stage.finish();
            let round_mm = [&chain_mm[..], &chain_mm[..1]].concat();
            let walls = fitted(&[cut_parts(&chain_mm, gear.scene().gear.module_mm, wish)], wish)?;
            let off_mm = off_mm(&in_plane(&walls, None, 0.0), &divided(&round_mm, CHORD_PIECES));
            return solid(walls, None, off_mm);
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
                    wall.rows_mm = through(across, &rows_z_mm, &wall.rows_mm);
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

/// Faces that are farther off than the tolerance; `instead`: what else can be exported.
pub fn too_coarse(wish: &SectionWish, off_mm: f64, instead: &str) -> Refusal {
    let [off_um, within_um] = [off_mm, wish.tolerance_mm].map(|mm| significant(mm * UM_PER_MM, 2));
    let problem = format!("smooth faces are {off_um} um off the profile, and {within_um} um are allowed");
    Refusal::new("--tolerance-um", problem, format!("allow more, or {instead}"))
}

fn too_coarse_a_wall(wish: &SectionWish, off_mm: f64) -> Refusal {
    too_coarse(wish, off_mm, "export the section with --dxf")
}

/// Walls through all sections, each of which has the same parts; control points are still those of the sections.
fn fitted(sections: &[Vec<Vec<DVec2>>], wish: &SectionWish) -> Result<Vec<SolidWall>> {
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

/// Parts of a cut profile between its corners, from one of them round to itself. A corner is where the chain turns by
/// more than [`CORNER_RAD`] within a reach that no mark's edge and no fillet turns so much in. Middles of chords are
/// points, too.
fn cut_parts(chain_mm: &[DVec2], module_mm: f64, wish: &SectionWish) -> Vec<Vec<DVec2>> {
    let mut chain_mm = distinct(chain_mm, true, NEAREST_SHARE * wish.tolerance_mm);
    let (count, reach_mm) = (chain_mm.len(), CORNER_REACH_MODULES * module_mm);
    // Turn at a point between those that are the reach away on either side.
    let turn_rad = |i: usize| {
        let away = |step: usize| {
            let place = |k: usize| chain_mm[(i + k * step) % count];
            (1..count).map(place).find(|p| p.distance(chain_mm[i]) >= reach_mm).unwrap_or(chain_mm[i])
        };
        (chain_mm[i] - away(count - 1)).angle_to(away(1) - chain_mm[i]).abs()
    };
    let turns_rad: Vec<f64> = (0..count).into_par_iter().map(turn_rad).collect();
    // The sharpest place of each stretch that turns so much.
    let is_corner = |i: usize| {
        let near = |step: usize| {
            let places = (1..count).map(move |k| (i + k * step) % count);
            places.take_while(|&k| chain_mm[k].distance(chain_mm[i]) < reach_mm)
        };
        turns_rad[i] > CORNER_RAD
            && near(1).all(|k| turns_rad[k] <= turns_rad[i])
            && near(count - 1).all(|k| turns_rad[k] < turns_rad[i])
    };
    let corners: Vec<usize> = (0..count).filter(|&i| is_corner(i)).collect();
    let first = corners.first().copied().unwrap_or_default();
    chain_mm.rotate_left(first);
    chain_mm.push(chain_mm[0]);
    let starts = if corners.is_empty() { vec![0] } else { corners };
    let ends: Vec<usize> = starts.into_iter().map(|corner| corner - first).chain([count]).collect();
    ends.windows(2).map(|ends| divided(&chain_mm[ends[0]..=ends[1]], 2)).collect()
}

/// Walls of a part. A straight part is cut where spans as narrow as they can be do not meet it, at the sharpest point
/// there. How far others are off is the error, mm.
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
        let [part] = &rows[..] else { return Err(missed.off_mm) };
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
fn divided(points_mm: &[DVec2], pieces: u32) -> Vec<DVec2> {
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
        let rows_mm = rows_mm.ok_or(Missed { off_mm: f64::INFINITY, spans: vec![[0.0, 1.0]] })?;
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
            return Err(Missed { off_mm: worst_mm, spans });
        }
        places = finer;
    }
}

/// Rows of control points whose splines along the tooth pass through those of the sections.
fn through(across: &CubicKnots, rows_z_mm: &[f64], rows_mm: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let mut controls_mm = vec![Vec::new(); rows_mm.len()];
    for column in 0..rows_mm[0].len() {
        let points_mm: Vec<DVec2> = rows_mm.iter().map(|row_mm| row_mm[column]).collect();
        let along_tooth_mm = across.fit(rows_z_mm, &points_mm).expect("as many points as control points");
        for (row_mm, control_mm) in controls_mm.iter_mut().zip(along_tooth_mm) {
            row_mm.push(control_mm);
        }
    }
    controls_mm
}

/// The section of walls at a place along the tooth.
fn in_plane<'a>(walls: &'a [SolidWall], across: Option<&CubicKnots>, z_mm: f64) -> PlaneWalls<'a> {
    let section = |wall: &'a SolidWall| {
        let Some(across) = across else { return (&wall.along, wall.rows_mm[0].clone()) };
        let (first, weights) = across.blend(z_mm);
        let control = |i: usize| weights.iter().zip(&wall.rows_mm[first..]).map(|(w, row_mm)| *w * row_mm[i]).sum();
        (&wall.along, (0..wall.along.count()).map(control).collect())
    };
    walls.iter().map(section).collect()
}

/// Largest distance of points round the gear from walls in their plane, mm.
fn off_mm(walls: &PlaneWalls<'_>, points_mm: &[DVec2]) -> f64 {
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
    (0..count).into_par_iter().map(of_wall).reduce(|| 0.0, f64::max)
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
