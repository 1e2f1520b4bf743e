//! The transverse section of a cylindrical gear: one contour, pitch curve, stock.
//!
//! In: a gear, and what is wanted of it. Out: [`GearSection`], paths of arcs and lines within the tolerance.
//!
//! The **target** is the envelope of the finishing operation under continuous motion: flanks, fillets, undercut.
//! **As cut** it is what the passes leave in that section, each mark of them: dexels as far apart as in the scene's
//! fields, [`crate::pair_job::outline`]. Marks that are lower than the tolerance do not show; nothing is averaged.
//!
//! Points of the target are so close together that a fillet of a fifth of a module bends by a fortieth of the tolerance
//! between two of them. That and the digits of files is what [`FIT_SHARE`] leaves room for.

use super::arcs::{ArcPath, PathPieces, smooth_parts};
use crate::job::{CylindricalGear, ToothSection};
use crate::measure::round_gear::is_round;
use crate::pair_job::outline::{ToothOutline, cut_flank, cut_root, joined};
use crate::pair_job::watch::WatchedUnits;
use crate::surface::SurfaceGrid;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::gear::Back;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Share of the tolerance that arcs may take; the rest is what the curve may do between two points.
pub const FIT_SHARE: f64 = 0.95;
/// Spacing of points over the root of tolerance times module: arrow heights s^2 / 8 r of fillets of r = m / 5 are then
/// a fortieth of the tolerance.
const SPACING_SHARE: f64 = 0.2;
/// Points of a whole pitch curve at least.
const LEAST_POINTS: f64 = 720.0;

/// Points of a flank as near to the stock's outline lie on it.
const ON_STOCK_MM: f64 = 1e-5;

/// Which profile a section has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProfileSource {
    /// The envelope of the finishing operation.
    Target,
    /// What the passes leave.
    Cut,
}

/// What is wanted of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionWish {
    /// Which profile.
    pub source: ProfileSource,
    /// First and last tooth; `None`: all, as one closed contour.
    pub teeth: Option<[u32; 2]>,
    /// Place along the tooth from the middle of the face, mm.
    pub z_mm: f64,
    /// Largest distance between the paths and the curves, mm.
    pub tolerance_mm: f64,
}

/// A curve of the section.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionCurve {
    /// A circle about the gear's axis: its radius, mm.
    Circle(f64),
    /// Any other one.
    Path(ArcPath),
}

/// Paths of a section; gear frame, mm.
#[derive(Debug, Clone, PartialEq)]
pub struct GearSection {
    /// The profile.
    pub profile: ArcPath,
    /// Lines that a polyline within the same tolerance has.
    pub polyline_count: usize,
    /// The pitch curve, of a sector from its beginning to its end.
    pub pitch_curve: SectionCurve,
    /// The stock's outline over the teeth, on which the tips lie.
    pub tips: SectionCurve,
    /// Bore or rim.
    pub back: Back,
}

impl GearSection {
    /// Section of a gear with the profile of [`profile_mm`].
    pub fn new(gear: &dyn CylindricalGear, chain_mm: &[DVec2], wish: &SectionWish) -> Self {
        let tolerance_mm = FIT_SHARE * wish.tolerance_mm;
        let fitted = |pieces| ArcPath::fit(chain_mm, wish.teeth.is_none(), tolerance_mm, pieces);
        let (blank, curve) = (gear.blank(), gear.curve());
        let points = (curve.perimeter_mm() / spacing_mm(gear, wish)).max(LEAST_POINTS).ceil();
        let [from, to] = curve.toothed_rad();
        let is_closed = curve.sector_rad().is_none();
        let along = |height_mm: f64| {
            if is_round(curve) {
                return SectionCurve::Circle(blank.at_height_mm(0.0, height_mm).length());
            }
            let at = |i: u32| blank.at_height_mm(from + (to - from) * f64::from(i) / points, height_mm);
            let chain_mm: Vec<DVec2> = (0..points as u32 + u32::from(!is_closed)).map(at).collect();
            SectionCurve::Path(ArcPath::fit(&chain_mm, is_closed, tolerance_mm, PathPieces::Arcs))
        };
        Self {
            profile: fitted(PathPieces::Arcs),
            polyline_count: fitted(PathPieces::Lines).count(),
            pitch_curve: along(0.0),
            tips: along(blank.addendum_mm),
            back: blank.back,
        }
    }
}

/// Distance of points along the target, mm.
pub fn spacing_mm(gear: &dyn CylindricalGear, wish: &SectionWish) -> f64 {
    SPACING_SHARE * (wish.tolerance_mm * gear.scene().gear.module_mm).sqrt()
}

/// Points of the profile, counter-clockwise: all round, or from the middle of the root before the first tooth to that
/// behind the last one; `stage` counts teeth.
///
/// # Errors
/// A flank whose target is not known in closed form, or that no pass has reached; the backend's; Ctrl-C.
pub fn profile_mm(
    gear: &dyn CylindricalGear,
    backend: &dyn Backend,
    wish: &SectionWish,
    stage: &WatchedUnits,
) -> Result<Vec<DVec2>> {
    let [first, last] = wish.teeth.unwrap_or([1, gear.scene().gear.teeth]);
    match wish.source {
        ProfileSource::Target => target_profile_mm(gear, [first, last], wish, stage),
        ProfileSource::Cut => cut_profile_mm(gear, backend, [first, last], wish.z_mm, stage),
    }
}

/// The target all round at `z_mm`, points about `spacing_mm` apart, cut at its corners and where flanks end: parts from
/// each such place to the next, counter-clockwise from the form point of the right flank of tooth 1.
///
/// # Errors
/// A flank whose target is not known in closed form; Ctrl-C.
pub fn target_parts_mm(
    gear: &dyn CylindricalGear,
    z_mm: f64,
    spacing_mm: f64,
    stage: &WatchedUnits,
) -> Result<Vec<Vec<DVec2>>> {
    let section = |tooth: u32| {
        let section = gear.target_section(tooth, z_mm, spacing_mm)?;
        stage.count()?;
        Ok(section)
    };
    let sections: Vec<ToothSection> =
        (1..=gear.scene().gear.teeth).into_par_iter().map(section).collect::<Result<_>>()?;
    let next = sections.iter().cycle().skip(1);
    let parts = sections.iter().zip(next).flat_map(|(section, next)| {
        // Ends of the root belong to the flanks.
        let (mut root_mm, tooth_mm) = (section.root_mm.clone(), &section.tooth_mm);
        let last = root_mm.len() - 1;
        (root_mm[0], root_mm[last]) = (tooth_mm[tooth_mm.len() - 1], next.tooth_mm[0]);
        [smooth_parts(tooth_mm, false), smooth_parts(&root_mm, false)].concat()
    });
    Ok(parts.collect())
}

/// The number of a tooth or space from 1 on.
fn counted(gear: &dyn CylindricalGear, number: u32) -> u32 {
    if number == 0 { gear.scene().gear.teeth } else { number }
}

fn target_profile_mm(
    gear: &dyn CylindricalGear,
    [first, last]: [u32; 2],
    wish: &SectionWish,
    stage: &WatchedUnits,
) -> Result<Vec<DVec2>> {
    let section = |tooth: u32| {
        let section = gear.target_section(counted(gear, tooth), wish.z_mm, spacing_mm(gear, wish))?;
        if tooth >= first {
            stage.count()?;
        }
        Ok(section)
    };
    // The root before the first tooth belongs to the tooth before it.
    let sections: Vec<ToothSection> = (first - 1..=last).into_par_iter().map(section).collect::<Result<_>>()?;
    let (before, teeth) = sections.split_first().expect("a tooth before the first");
    let mut chain = before.root_mm[before.root_mm.len() / 2..].to_vec();
    for (tooth, section) in (first..).zip(teeth) {
        let root_mm = &section.root_mm;
        let end = if tooth == last { root_mm.len() / 2 } else { root_mm.len() - 1 };
        chain.extend(&section.tooth_mm);
        chain.extend(&root_mm[..=end]);
    }
    Ok(chain)
}

/// A tooth as the passes leave it in a section.
#[derive(Debug, Clone, PartialEq)]
pub struct CutTooth {
    /// From the middle of the root to the tip.
    pub right: ToothOutline,
    /// Between the tips of both flanks; none on a pointed tooth.
    pub tip_mm: Vec<DVec2>,
    /// From the middle of the root to the tip.
    pub left: ToothOutline,
}

/// Teeth as the passes leave them, tooth after tooth, each in the sections `rows_z_mm`; `stage` counts teeth.
///
/// # Errors
/// A flank that no pass has reached, a root that is not cut through; the backend's; Ctrl-C.
pub fn cut_teeth(
    gear: &dyn CylindricalGear,
    backend: &dyn Backend,
    [first, last]: [u32; 2],
    rows_z_mm: &[f64],
    stage: &WatchedUnits,
) -> Result<Vec<Vec<CutTooth>>> {
    let way_out = "export a section that is cut, or the target: leave --as-cut out";
    let root = |space: u32| cut_root(gear, backend, counted(gear, space), rows_z_mm, way_out);
    let roots: Vec<Vec<Vec<DVec2>>> = (first - 1..=last).into_par_iter().map(root).collect::<Result<_>>()?;
    let tooth = |tooth: u32| {
        let half = |side: Side, space: u32| -> Result<Vec<ToothOutline>> {
            let flanks = cut_flank(gear, backend, tooth, side, rows_z_mm)?;
            let rows = roots[space as usize].iter().zip(&flanks);
            Ok(rows.map(|(root, flank)| joined(root, side, flank)).collect())
        };
        let (right, left) = (half(Side::Right, tooth - first)?, half(Side::Left, tooth + 1 - first)?);
        let tip = gear.tip_surface(backend, tooth)?;
        let section = |((right, left), &z_mm): ((ToothOutline, ToothOutline), &f64)| {
            let row = tip.as_ref().and_then(|grid| topped_mm(grid, z_mm));
            let is_stock = tip.is_some() && row.is_none();
            let [right, left] = [right, left].map(|flank| if is_stock { to_stock(gear, flank) } else { flank });
            let tips_mm = [&right, &left].map(|flank| flank.points_mm[flank.points_mm.len() - 1]);
            let tip_mm = row.or_else(|| tip.as_ref().map(|_| stock_mm(gear, tips_mm))).unwrap_or_default();
            CutTooth { right, tip_mm, left }
        };
        let sections = right.into_iter().zip(left).zip(rows_z_mm).map(section).collect();
        stage.count()?;
        Ok(sections)
    };
    (first..=last).into_par_iter().map(tooth).collect()
}

/// The profile as the passes leave it.
fn cut_profile_mm(
    gear: &dyn CylindricalGear,
    backend: &dyn Backend,
    teeth: [u32; 2],
    z_mm: f64,
    stage: &WatchedUnits,
) -> Result<Vec<DVec2>> {
    let whole = |CutTooth { right, tip_mm, left }: &CutTooth| {
        [&right.points_mm[..], tip_mm, &left.points_mm.iter().rev().copied().collect::<Vec<_>>()].concat()
    };
    Ok(cut_teeth(gear, backend, teeth, &[z_mm], stage)?.concat().iter().flat_map(whole).collect())
}

/// The tip land that a tool which tops the gear leaves; none where it is the stock's own outline.
fn topped_mm(grid: &SurfaceGrid, z_mm: f64) -> Option<Vec<DVec2>> {
    let row = grid.rows_mm.partition_point(|&row_mm| row_mm < z_mm).clamp(1, grid.rows() - 1);
    // Its edges are cut, too, where a flank lies deeper than its target.
    if grid.is_uncut(grid.columns() / 2, row) {
        return None;
    }
    let [below_mm, above_mm] = [row - 1, row].map(|row| grid.rows_mm[row]);
    let share = (z_mm - below_mm) / (above_mm - below_mm);
    let place = |column| grid.position_mm(column, row - 1).lerp(grid.position_mm(column, row), share).truncate();
    Some((0..grid.columns()).map(place).collect())
}

/// A flank as far as the stock's outline: a flank off its target meets it elsewhere than the target does. What lies on
/// the outline is no flank; a flank that ends below it goes on straight.
fn to_stock(gear: &dyn CylindricalGear, mut flank: ToothOutline) -> ToothOutline {
    let blank = gear.blank();
    let below_mm = |point_mm: DVec2| blank.addendum_mm - blank.height(point_mm, point_mm.to_angle()).0;
    let end = |flank: &ToothOutline, back: usize| flank.points_mm[flank.points_mm.len() - back];
    if below_mm(end(&flank, 1)) <= ON_STOCK_MM {
        // One point on it is the corner.
        if flank.points_mm.len() < 4 || below_mm(end(&flank, 2)) > ON_STOCK_MM {
            return flank;
        }
        while flank.points_mm.len() > 3 && below_mm(end(&flank, 1)) <= ON_STOCK_MM {
            flank.points_mm.pop();
            flank.u_mm.pop();
        }
    }
    let [before_mm, last_mm] = [2, 1].map(|back| end(&flank, back));
    let [before, last] = [before_mm, last_mm].map(below_mm);
    if before > last {
        let on_mm = last_mm + (last_mm - before_mm) * last / (before - last);
        flank.u_mm.push(flank.u_mm[flank.u_mm.len() - 1] + last_mm.distance(on_mm));
        flank.points_mm.push(on_mm);
    }
    flank
}

/// The stock's outline between the tips of both flanks.
fn stock_mm(gear: &dyn CylindricalGear, tips_mm: [DVec2; 2]) -> Vec<DVec2> {
    let blank = gear.blank();
    let [from, to] = tips_mm.map(|tip_mm| blank.height(tip_mm, tip_mm.to_angle()).1);
    let width = (to - from).rem_euclid(TURN_RAD);
    // Tips of a whole pitch would be no tips: the flanks have crossed.
    if width > PI {
        return Vec::new();
    }
    let count = (tips_mm[0].distance(tips_mm[1]) / crate::job::TIP_SPACING_MM[0]).ceil().max(1.0);
    (0..=count as u32).map(|i| blank.outline_mm(from + width * f64::from(i) / count)).collect()
}
