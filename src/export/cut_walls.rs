//! Walls of a gear as the passes leave it, marks averaged where they are lower than the tolerance.
//!
//! In: a cylindrical gear, what is wanted of its section. Out: [`CutWalls`], and how far the cut surface is off them.
//!
//! **Straight**: the cut section at one place along the tooth, from corner to corner.
//!
//! **Helical**: sections all along the face. Flanks and tip lands are fitted in every second one and, by least squares
//! with as few knots as the tolerance allows, along the tooth; marks count in all sections. Roots have the knots of the
//! target's and no limit: where a sharp tip corner cuts them, their marks are tenfold those of the flanks and run
//! across the face, so that no smooth face follows them. How far they are off is found by itself.

use super::arcs::distinct;
use super::b_spline::CubicKnots;
use super::section::{CutTooth, SectionWish, cut_teeth, profile_mm, spacing_mm};
use super::walls::{
    LEAST_POINTS, SolidWall, along_tooth, averaged, divided, evenly_spaced, fitted, in_plane, off_mm, offs_mm,
};
use crate::influence::gear_grid::evenly;
use crate::job::CylindricalGear;
use crate::pair_job::watch::Watch;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use glam::DVec2;
use rayon::prelude::*;

/// A corner of a cut profile turns by so much, rad: tip corners by 0.7 and more.
const CORNER_RAD: f64 = 0.4;
/// Within such a reach to either side, modules: edges of marks turn by a tenth, fillets of a fifth of a module, too.
const CORNER_REACH_MODULES: f64 = 0.02;
/// Points of a cut profile that are nearer than this share of the tolerance are one.
const NEAREST_SHARE: f64 = 0.05;
/// Pieces of a chord of a cut profile where it is measured.
const CHORD_PIECES: u32 = 4;
/// Distance of sections of a cut helical gear, mm, and pairs of such distances over the face at least. Feed marks are
/// some ten times as long, and on the flanks of all teeth sections meet them at every place.
const CUT_ROWS_MM: f64 = 0.2;
const LEAST_PAIRS: f64 = 8.0;
/// Parts of a tooth: right flank, tip land, left flank, root.
const PARTS: usize = 4;

/// Walls as the passes leave them.
#[derive(Debug, Clone, PartialEq)]
pub struct CutWalls {
    /// Walls, counter-clockwise.
    pub walls: Vec<SolidWall>,
    /// Knots along the tooth; none: walls are straight.
    pub across: Option<CubicKnots>,
    /// Largest distance of the cut surface from the walls, mm; of roots only where `roots_mm` is none.
    pub off_mm: f64,
    /// The same of roots, mm.
    pub roots_mm: Option<f64>,
}

/// Walls of a spur gear as it is cut at one place along the tooth.
///
/// # Errors
/// A profile that no walls meet; those of the profile.
pub fn cut_straight(
    gear: &dyn CylindricalGear,
    backend: &dyn Backend,
    wish: &SectionWish,
    watch: &Watch<'_>,
) -> Result<CutWalls> {
    let stage = watch.stage("profile", gear.scene().gear.teeth as usize, "teeth")?;
    let chain_mm = profile_mm(gear, backend, wish, &stage)?;
    stage.finish();
    let round_mm = [&chain_mm[..], &chain_mm[..1]].concat();
    let walls = fitted(&[cut_parts(&chain_mm, gear.scene().gear.module_mm, wish)], wish)?;
    let off_mm = off_mm(&in_plane(&walls, None, 0.0), &divided(&round_mm, CHORD_PIECES));
    Ok(CutWalls { walls, across: None, off_mm, roots_mm: None })
}

/// Walls of a helical gear as it is cut.
///
/// # Errors
/// Flanks or tips that no walls meet; those of the profile.
pub fn cut_helical(
    gear: &dyn CylindricalGear,
    backend: &dyn Backend,
    wish: &SectionWish,
    watch: &Watch<'_>,
) -> Result<CutWalls> {
    let (teeth, half_face_mm) = (gear.scene().gear.teeth, 0.5 * gear.scene().gear.face_width_mm);
    let face_mm = [-half_face_mm, half_face_mm];
    let pairs = (half_face_mm / CUT_ROWS_MM).ceil().max(LEAST_PAIRS) as usize;
    let rows_z_mm = evenly(face_mm, 2 * pairs + 1);
    let stage = watch.stage("profile", teeth as usize, "teeth")?;
    let cut = cut_teeth(gear, backend, [1, teeth], &rows_z_mm, &stage)?;
    stage.finish();
    let parts_of = |row: usize| teeth_parts(&cut.iter().map(|sections| &sections[row]).collect::<Vec<_>>());
    let sections: Vec<Vec<Vec<DVec2>>> = (0..rows_z_mm.len()).into_par_iter().map(parts_of).collect();
    let fitted_z_mm: Vec<f64> = rows_z_mm.iter().copied().step_by(2).collect();
    let spacing_mm = spacing_mm(gear, wish);
    let of_part = |part: usize| -> Result<SolidWall> {
        let even = |parts: &Vec<Vec<DVec2>>| evenly_spaced(&parts[part], spacing_mm);
        let rows_mm: Vec<Vec<DVec2>> = sections.iter().step_by(2).map(even).collect();
        if part % PARTS != PARTS - 1 {
            let rows: Vec<Vec<Vec<DVec2>>> = rows_mm.into_iter().map(|row_mm| vec![row_mm]).collect();
            return Ok(fitted(&rows, wish)?.remove(0));
        }
        let space = (part / PARTS) as u32 + 1;
        averaged(&gear.target_section(space, 0.0, spacing_mm)?.root_mm, &rows_mm, wish)
    };
    let of_sections: Vec<SolidWall> = (0..sections[0].len()).into_par_iter().map(of_part).collect::<Result<_>>()?;
    let mut spans = 1;
    loop {
        let across = CubicKnots::new(&evenly(face_mm, spans + 1));
        let wall = |wall: &SolidWall| SolidWall {
            along: wall.along.clone(),
            rows_mm: along_tooth(&across, &fitted_z_mm, &wall.rows_mm),
        };
        let walls: Vec<SolidWall> = of_sections.par_iter().map(wall).collect();
        let [mut off_mm, mut roots_mm] = [0.0_f64; 2];
        for (&z_mm, parts) in rows_z_mm.iter().zip(&sections) {
            let offs_mm = offs_mm(&in_plane(&walls, Some(&across), z_mm), &divided(&parts.concat(), CHORD_PIECES));
            for (part, of_wall_mm) in offs_mm.into_iter().enumerate() {
                let worst_mm = if part % PARTS == PARTS - 1 { &mut roots_mm } else { &mut off_mm };
                *worst_mm = worst_mm.max(of_wall_mm);
            }
        }
        spans *= 2;
        if off_mm <= wish.tolerance_mm || LEAST_POINTS * spans > pairs {
            return Ok(CutWalls { walls, across: Some(across), off_mm, roots_mm: Some(roots_mm) });
        }
    }
}

/// Parts of a cut section, [`PARTS`] of every tooth. Ends of tip lands and roots are those of the flanks.
fn teeth_parts(teeth: &[&CutTooth]) -> Vec<Vec<DVec2>> {
    let next = teeth.iter().cycle().skip(1);
    let parts = teeth.iter().zip(next).flat_map(|(tooth, next)| {
        let ([_, right], [left_root, left]) = (tooth.right.root_and_flank(), tooth.left.root_and_flank());
        let [next_root, next_right] = next.right.root_and_flank();
        let mut tip_mm = tooth.tip_mm.clone();
        let tips_mm = [right, left].map(|flank_mm| flank_mm[flank_mm.len() - 1]);
        if let [first, .., last] = &mut tip_mm[..] {
            [*first, *last] = tips_mm;
        } else {
            tip_mm = tips_mm.to_vec();
        }
        let backwards = |chain_mm: &[DVec2]| chain_mm.iter().rev().copied().collect::<Vec<_>>();
        let root_mm = [&left[..1], &backwards(left_root), next_root, &next_right[..1]].concat();
        [right.to_vec(), tip_mm, backwards(left), root_mm]
    });
    parts.collect()
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
