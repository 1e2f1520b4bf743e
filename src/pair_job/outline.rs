//! Flanks of a gear as cut, in transverse sections: what is rolled.
//!
//! In: a scene, places along the face. Out: for every flank of every section its points from the middle of the root to
//! the tip, with the arc along the profile; gear frame.
//!
//! Points are dexels of the finished gear: nominal points and normals of the target, and the heights that the last
//! operation left, at the scene's spacing along the profile. Roots are cut on rays of their own, closer together: what
//! meets a fillet is a tip corner, and the sag of a chord must stay below a tenth of a micrometre. A root that is not
//! cut through is refused: a ray that stands out of it would touch first.

use glam::DVec2;
use rayon::prelude::*;

use super::generated::{FlankEnds, flank_ends};
use super::watch::WatchedUnits;
use crate::job::{CylindricalGear, GearJob};
use crate::pair::flank_chain::GearFlanks;
use crate::process::ProcessJob;
use crate::steps::view_mesh::ViewMesh;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;

/// Distance of points along a root, modules: at module 3 these are 10 um, and a fillet of 1 mm radius is cut short by
/// 0.01 um. Fillets grow with the module.
const ROOT_SPACING_MODULES: f64 = 1.0 / 300.0;
/// Neighbouring points of a root that stand farther apart than this were not cut, modules: roots have no such steps.
const ROOT_STEP_MODULES: f64 = 0.25;

/// Points are left out where the chain without them passes this near, mm: two nanometres, a hundredth of a scallop. Of
/// 1,600 dexels 5 um apart some 400 are left, and the contact search takes a quarter of the time.
const LEFT_OUT_MM: f64 = 2e-6;

/// A flank with its half of the root, from the root's middle to the tip.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothOutline {
    /// Points, gear frame, mm.
    pub points_mm: Vec<DVec2>,
    /// Arc along the profile from the form point, mm; negative in the root.
    pub u_mm: Vec<f64>,
}

/// A gear in its sections; flanks by tooth modulo their number.
pub type CutSections = Vec<GearFlanks<ToothOutline>>;

/// A cut gear.
#[derive(Debug)]
pub struct GearInSections {
    /// Its sections.
    pub sections: CutSections,
    /// Where the flanks of its target begin and end.
    pub ends: FlankEnds,
    /// Its target, to look at.
    pub view: ViewMesh,
}

/// Cuts the finished flanks and roots of a gear that is made ready in the sections `rows_z_mm`.
///
/// # Errors
/// Geometry that cannot be cut; flanks that no pass has reached; a gear without sections; Ctrl-C.
pub fn cut(
    job: &dyn ProcessJob,
    backend: &dyn Backend,
    rows_z_mm: &[f64],
    stage: &WatchedUnits,
) -> Result<GearInSections> {
    let mut cut = None;
    job.with_gear(&mut |gear| {
        cut = Some(cut_gear(gear, backend, rows_z_mm, stage)?);
        Ok(())
    })?;
    Ok(cut.expect("a job shows its gear"))
}

fn cut_gear(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    rows_z_mm: &[f64],
    stage: &WatchedUnits,
) -> Result<GearInSections> {
    let Some(cylinder) = gear.cylindrical() else {
        let way_out = "give cylindrical gears: shaped or hobbed";
        return Err(Refusal::new("gear", "a pair of gears without a pitch curve cannot be rolled", way_out).into());
    };
    let teeth = gear.scene().gear.teeth;
    let root = |space: u32| -> Result<Vec<Vec<DVec2>>> {
        let space = if space == 0 { teeth } else { space };
        let way_out = "roll other sections with --sections, or nominal flanks with --flanks nominal";
        let root = cut_root(cylinder, backend, space, rows_z_mm, way_out)?;
        stage.count()?;
        Ok(root)
    };
    let roots: Vec<Vec<Vec<DVec2>>> = (0..teeth).into_par_iter().map(root).collect::<Result<_>>()?;
    let flank = |side: Side, tooth: u32| -> Result<Vec<ToothOutline>> {
        let flanks = cut_flank(gear, backend, tooth, side, rows_z_mm)?;
        // The space behind a tooth bears its number.
        let space = if side == Side::Left { tooth % teeth } else { tooth - 1 };
        let joined =
            flanks.into_iter().enumerate().map(|(row, flank)| joined(&roots[space as usize][row], side, &flank));
        let joined = joined.collect();
        stage.count()?;
        Ok(joined)
    };
    let side = |side: Side| -> Result<Vec<Vec<ToothOutline>>> {
        (0..teeth).into_par_iter().map(|label| flank(side, if label == 0 { teeth } else { label })).collect()
    };
    let (right, left) = (side(Side::Right)?, side(Side::Left)?);
    let section = |row: usize| {
        let of = |flanks: &[Vec<ToothOutline>]| flanks.iter().map(|rows| rows[row].clone()).collect();
        GearFlanks { right: of(&right), left: of(&left) }
    };
    let sections = (0..rows_z_mm.len()).map(section).collect();
    Ok(GearInSections { sections, ends: flank_ends(cylinder)?, view: ViewMesh::new(cylinder)? })
}

/// The root after tooth `space`, section by section, from the left flank to the next right one.
///
/// # Errors
/// A root that is not cut through, with `way_out`; the backend's.
pub fn cut_root(
    gear: &dyn CylindricalGear,
    backend: &dyn Backend,
    space: u32,
    rows_z_mm: &[f64],
    way_out: &str,
) -> Result<Vec<Vec<DVec2>>> {
    let module_mm = gear.scene().gear.module_mm;
    let root = gear.cut_root(backend, space, ROOT_SPACING_MODULES * module_mm, rows_z_mm)?;
    for (points, z_mm) in root.iter().zip(rows_z_mm) {
        whole(points, module_mm).map_err(|step_mm| {
            let problem = format!(
                "the root after tooth {space} of {} has a step of {step_mm:.3} mm {z_mm:.3} mm from the middle of the \
                face: it is not cut there",
                gear.scene().name
            );
            Refusal::new("operation", problem, way_out)
        })?;
    }
    Ok(root)
}

/// Whether the points of a root follow each other; else the first step between them that is too far, mm.
fn whole(points_mm: &[DVec2], module_mm: f64) -> std::result::Result<(), f64> {
    let mut steps_mm = points_mm.windows(2).map(|pair| pair[0].distance(pair[1]));
    steps_mm.find(|step_mm| *step_mm > ROOT_STEP_MODULES * module_mm).map_or(Ok(()), Err)
}

/// Points and arcs of a flank from its form point to its tip, section by section.
///
/// # Errors
/// A flank that no pass has reached; the backend's.
pub fn cut_flank(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    tooth: u32,
    side: Side,
    rows_z_mm: &[f64],
) -> Result<Vec<ToothOutline>> {
    let scene = gear.scene();
    let arcs_mm = gear.even_arcs_mm(tooth, side, scene.fields.profile_spacing_mm)?;
    let target = gear.target_points(tooth, side, &arcs_mm, rows_z_mm)?;
    let layers = gear.cut_flank(backend, tooth, side, &arcs_mm, rows_z_mm)?;
    let last = layers.last().ok_or(Error::Interrupted)?;
    let rows = rows_z_mm.len();
    let uncut = last.passes.iter().filter(|&&pass| pass == NO_PASS).count();
    if 2 * uncut > last.passes.len() {
        return Err(Refusal::new(
            "operation",
            format!(
                "no stroke reaches {} of the {} points of the {} flank of tooth {tooth} of {}: it is not finished",
                uncut,
                last.passes.len(),
                side.name(),
                scene.name
            ),
            "leave window_deg out, so that the whole gear is cut",
        )
        .into());
    }
    let profile = |row: usize| {
        // A normal of a helical flank leads out of the section: where it is the surface's own, the section through the
        // surface is so much farther off.
        let point = |(c, ray): (usize, &gearcut_core::dexel::Ray)| {
            let (normal, height_mm) = (ray.normal.truncate(), f64::from(last.heights_mm[c * rows + row]));
            ray.origin_mm.truncate() + height_mm / normal.length_squared() * normal
        };
        ToothOutline { points_mm: target[row].iter().enumerate().map(point).collect(), u_mm: arcs_mm.clone() }
    };
    Ok((0..rows).map(profile).collect())
}

/// A flank behind its half of the root, which runs from the left flank of one tooth to the right one of the next.
///
/// # Panics
/// A flank of fewer than two points.
pub fn joined(root: &[DVec2], side: Side, flank: &ToothOutline) -> ToothOutline {
    let (before, behind) = root.split_at(root.len() / 2);
    let half: Vec<DVec2> = match side {
        Side::Left => before.iter().rev().copied().collect(),
        Side::Right => behind.to_vec(),
    };
    // Where the fillet has cut into the flank both run on past their crossing: the flank's points are kept.
    let (form, next) = (flank.points_mm[0], flank.points_mm[1]);
    let below = half.iter().position(|p| (*p - form).dot(next - form) >= 0.0).unwrap_or(half.len());
    let points_mm = half[..below].to_vec();
    let mut u_mm = vec![0.0; below];
    let mut last = form;
    let mut u = 0.0;
    for i in (0..below).rev() {
        u -= points_mm[i].distance(last);
        last = points_mm[i];
        u_mm[i] = u;
    }
    // The form point stays: the arc counts from it.
    let [root, flank] = [ToothOutline { points_mm, u_mm }, flank.clone()].map(|part| part.thinned(LEFT_OUT_MM));
    ToothOutline { points_mm: [root.points_mm, flank.points_mm].concat(), u_mm: [root.u_mm, flank.u_mm].concat() }
}

impl ToothOutline {
    /// Its half of the root and its flank, which begins with the form point.
    pub fn root_and_flank(&self) -> [&[DVec2]; 2] {
        self.points_mm.split_at(self.u_mm.partition_point(|&u_mm| u_mm < 0.0)).into()
    }

    /// The profile without points that lie nearer than `tolerance_mm` to the chain of the others (Ramer 1972; Douglas
    /// and Peucker 1973).
    fn thinned(&self, tolerance_mm: f64) -> Self {
        let points = &self.points_mm;
        let Some(last) = points.len().checked_sub(1) else { return self.clone() };
        let mut kept = vec![false; points.len()];
        (kept[0], kept[last]) = (true, true);
        let mut open = vec![[0, last]];
        while let Some([from, to]) = open.pop() {
            let along = (points[to] - points[from]).normalize_or_zero();
            let off_mm = |i: &usize| along.perp_dot(points[*i] - points[from]).abs();
            let farthest = (from + 1..to).max_by(|a, b| off_mm(a).total_cmp(&off_mm(b)));
            if let Some(middle) = farthest.filter(|i| off_mm(i) > tolerance_mm) {
                kept[middle] = true;
                open.extend([[from, middle], [middle, to]]);
            }
        }
        let of = |i: usize| kept[i];
        Self {
            points_mm: points.iter().enumerate().filter(|(i, _)| of(*i)).map(|(_, p)| *p).collect(),
            u_mm: self.u_mm.iter().enumerate().filter(|(i, _)| of(*i)).map(|(_, u)| *u).collect(),
        }
    }
}
