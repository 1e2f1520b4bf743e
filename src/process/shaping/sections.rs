//! Transverse sections of the target at any height, and rays on them.
//!
//! In: a job, a part of its gear, a height. Out: points, columns of rays, fields in space. Sections of a spur gear are
//! all alike; those of a helical one follow from its [`Helix`]: on a circle the section in the middle of the face,
//! turned; on other pitch curves the envelope of teeth that lie further along the curve. Places along a profile are
//! counted as in the middle of the face; where sections differ in length they are shares of it.
//!
//! Heights of helical flanks are taken along the flank's own normal in space, as on hobbed gears: the transverse height
//! times cos(beta_b), exactly so as long as what is left is an involute helicoid too. Roots and tips keep their normals
//! in the section.

use super::helix::Helix;
use super::job::ShapingJob;
use super::target::TargetFlank;
use super::target::fillet::Fillet;
use super::target::tooth_target::ToothTarget;
use crate::job::ToothSection;
use crate::steps::planar::ProfilePoint;
use gearcut_core::dexel::{Column, Field, PlacedRays, Ray, RayGrid, SpatialField};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use glam::{DVec2, DVec3};
use std::borrow::Cow;

/// A part of the gear's surface that rays lie on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GearPart {
    /// Flank of a tooth (1 to z).
    Flank(u32, Side),
    /// Root of the space after a tooth, as points about so far apart, mm.
    Root(u32, f64),
    /// Tip land of a tooth.
    Tip(u32),
}

/// Rays of a part of the gear in space.
#[derive(Debug)]
pub enum ShapedRays {
    /// One profile in all sections.
    Straight(Field),
    /// A profile in each.
    Helical(PlacedRays),
}

/// A target flank in one section.
#[derive(Debug)]
pub struct SectionFlank<'a> {
    flank: Cow<'a, TargetFlank>,
    /// Turn of the section; none where it is not turned.
    turn: Option<DVec2>,
    /// Its length over that in the middle of the face.
    stretch: f64,
}

impl SectionFlank<'_> {
    /// Point and normal in the section at an arc of the profile in the middle of the face, mm.
    pub fn at_arc(&self, arc_mm: f64) -> ProfilePoint {
        let contact = self.flank.at_arc(arc_mm * self.stretch);
        let point =
            ProfilePoint { arc_mm, point_mm: contact.point_mm, normal: contact.normal, phi_rad: contact.phi_rad };
        self.turn.map_or(point, |turn| turned(&point, turn))
    }
}

fn turned(point: &ProfilePoint, turn: DVec2) -> ProfilePoint {
    ProfilePoint {
        point_mm: turn.rotate(point.point_mm),
        normal: turn.rotate(point.normal),
        phi_rad: point.phi_rad + turn.to_angle(),
        ..*point
    }
}

impl ShapingJob {
    /// Target of a tooth (1 to z) whose sections are no turned ones, at a height.
    fn tooth_at(&self, helix: &Helix, tooth: u32, z_mm: f64) -> Result<ToothTarget, Refusal> {
        ToothTarget::shifted(self.target_generation(), &self.blank, tooth, helix.pitches(z_mm))
    }

    /// Target flank of a tooth (1 to z) at a height.
    ///
    /// # Errors
    /// A section in which the cutter generates no flank.
    pub fn flank_in_section(&self, tooth: u32, side: Side, z_mm: f64) -> Result<SectionFlank<'_>, Refusal> {
        let middle = self.target_flank(tooth, side);
        let as_it_is = |turn| SectionFlank { flank: Cow::Borrowed(middle), turn, stretch: 1.0 };
        let Some(helix) = &self.helix else { return Ok(as_it_is(None)) };
        if let Some(turn) = helix.turn_rad(z_mm) {
            return Ok(as_it_is(Some(DVec2::from_angle(turn))));
        }
        let flank = self.tooth_at(helix, tooth, z_mm)?.flank(side).clone();
        let stretch = flank.length_mm() / middle.length_mm();
        Ok(SectionFlank { flank: Cow::Owned(flank), turn: None, stretch })
    }

    /// Target root of the space after a tooth at a height: as many points as in the middle of the face, where they
    /// stand about `spacing_mm` apart.
    ///
    /// # Errors
    /// A section in which the cutter generates no flank.
    pub fn root_in_section(&self, space: u32, spacing_mm: f64, z_mm: f64) -> Result<Vec<ProfilePoint>, Refusal> {
        let Some(helix) = &self.helix else { return Ok(self.target_root(space, spacing_mm)) };
        if let Some(turn) = helix.turn_rad(z_mm) {
            let turn = DVec2::from_angle(turn);
            return Ok(self.target_root(space, spacing_mm).iter().map(|point| turned(point, turn)).collect());
        }
        let (fillet, ends) = self.fillet_at(helix, space, z_mm)?;
        let middle = self.target_fillets(space);
        Ok(middle.iter().flat_map(|(of, of_ends)| fillet.points_like(ends, (of, *of_ends), spacing_mm)).collect())
    }

    fn fillet_at(&self, helix: &Helix, space: u32, z_mm: f64) -> Result<(Fillet<'_>, [f64; 2]), Refusal> {
        let teeth = self.scene.gear.teeth;
        let fillet = Fillet::new(self.target_generation(), f64::from(space) + helix.pitches(z_mm));
        let before = if space == 0 { teeth } else { space };
        let of = |tooth, side| {
            let undercut = self.tooth_at(helix, tooth, z_mm)?.flank(side).undercut;
            Ok::<_, Refusal>(undercut.map(|undercut| undercut.fillet_at))
        };
        let ends =
            [of(before, Side::Left)?.unwrap_or(0.0), of(space % teeth + 1, Side::Right)?.unwrap_or(fillet.end())];
        Ok((fillet, ends))
    }

    /// Polar angles of the feet of both ends of a tooth's tip land at a height: on the right flank, on the left one.
    pub(super) fn tip_feet(&self, tooth: u32, z_mm: f64) -> Result<[f64; 2], Refusal> {
        let foot = |side| {
            let tip = self.flank_in_section(tooth, side, z_mm)?.at_arc(self.target_flank(tooth, side).length_mm());
            Ok(self.blank.height(tip.point_mm, tip.phi_rad).1)
        };
        Ok([foot(Side::Right)?, foot(Side::Left)?])
    }

    /// Columns of a field at a height, from those in the middle of the face.
    pub(super) fn columns_in_section(&self, part: GearPart, middle: &Field, z_mm: f64) -> Result<Vec<Column>, Refusal> {
        let columns = &middle.columns;
        let Some(helix) = &self.helix else { return Ok(columns.clone()) };
        if let Some(turn) = helix.turn_rad(z_mm) {
            let turn = DVec2::from_angle(turn);
            let turned =
                |of: &Column| Column { origin_mm: turn.rotate(of.origin_mm), normal: turn.rotate(of.normal), ..*of };
            return Ok(columns.iter().map(turned).collect());
        }
        let planar = self.planar();
        let own = match part {
            GearPart::Flank(tooth, side) => {
                let flank = self.flank_in_section(tooth, side, z_mm)?;
                let points = columns.iter().map(|column| flank.at_arc(column.arc_mm));
                planar.flank_field(points, vec![z_mm]).columns
            }
            GearPart::Root(space, spacing_mm) => {
                planar.root_field(&self.root_in_section(space, spacing_mm, z_mm)?).columns
            }
            GearPart::Tip(tooth) => planar.tip_columns(self.tip_feet(tooth, z_mm)?, columns.len()),
        };
        let alike = own.into_iter().zip(columns);
        Ok(alike.map(|(own, middle)| Column { arc_mm: middle.arc_mm, low_mm: middle.low_mm, ..own }).collect())
    }

    /// Rays of a field in space, whose heights on flanks are taken along normals in space.
    ///
    /// # Errors
    /// A section in which the cutter generates no flank.
    pub fn in_space(&self, part: GearPart, middle: Field) -> Result<ShapedRays, Refusal> {
        let Some(helix) = &self.helix else { return Ok(ShapedRays::Straight(middle)) };
        let rows: Vec<Vec<Column>> = middle
            .rows_z_mm
            .iter()
            .map(|&z_mm| self.columns_in_section(part, &middle, z_mm))
            .collect::<Result<_, _>>()?;
        let low_mm = middle.columns.first().map_or(0.0, |column| column.low_mm);
        let ray = |column: usize, row: usize| {
            let Column { origin_mm, normal, blank_mm, .. } = rows[row][column];
            let (normal, blank_mm) = match part {
                GearPart::Flank(_, side) => (helix.flank_normal(side, normal), blank_mm * helix.cos_base_helix()),
                _ => (normal.extend(0.0), blank_mm),
            };
            (Ray { origin_mm: origin_mm.extend(middle.rows_z_mm[row]), normal }, blank_mm)
        };
        Ok(ShapedRays::Helical(PlacedRays {
            field: SpatialField::new(middle.columns.len(), middle.rows(), low_mm, ray),
            arcs_mm: middle.arcs_mm(),
            rows_z_mm: middle.rows_z_mm,
        }))
    }

    /// The target round a tooth at a height, points about `spacing_mm` apart.
    ///
    /// # Errors
    /// A tip that the cutter's base shapes: its outline is not known in closed form.
    pub fn tooth_in_section(&self, tooth: u32, z_mm: f64, spacing_mm: f64) -> Result<ToothSection, Refusal> {
        let Some(helix) = &self.helix else { return self.tooth_section(tooth, spacing_mm) };
        if let Some(turn) = helix.turn_rad(z_mm) {
            let turn = DVec2::from_angle(turn);
            let ToothSection { tooth_mm, root_mm } = self.tooth_section(tooth, spacing_mm)?;
            let [tooth_mm, root_mm] =
                [tooth_mm, root_mm].map(|points| points.into_iter().map(|point| turn.rotate(point)).collect());
            return Ok(ToothSection { tooth_mm, root_mm });
        }
        let target = self.tooth_at(helix, tooth, z_mm)?;
        let (fillet, ends) = self.fillet_at(helix, tooth, z_mm)?;
        let flanks = [Side::Right, Side::Left].map(|side| target.flank(side));
        self.section_of(flanks, &[fillet.chain_mm(ends, spacing_mm)], tooth, spacing_mm)
    }
}

impl RayGrid for ShapedRays {
    fn arcs_mm(&self) -> Vec<f64> {
        match self {
            Self::Straight(rays) => rays.arcs_mm(),
            Self::Helical(rays) => rays.arcs_mm(),
        }
    }

    fn rows_mm(&self) -> &[f64] {
        match self {
            Self::Straight(rays) => rays.rows_mm(),
            Self::Helical(rays) => rays.rows_mm(),
        }
    }

    fn point_mm(&self, column: usize, row: usize, height_mm: f64) -> DVec3 {
        match self {
            Self::Straight(rays) => rays.point_mm(column, row, height_mm),
            Self::Helical(rays) => rays.point_mm(column, row, height_mm),
        }
    }

    fn normal(&self, column: usize, row: usize) -> DVec3 {
        match self {
            Self::Straight(rays) => rays.normal(column, row),
            Self::Helical(rays) => rays.normal(column, row),
        }
    }

    fn is_straight(&self) -> bool {
        matches!(self, Self::Straight(_))
    }
}
