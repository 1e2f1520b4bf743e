//! What one stroke takes away: the sum over the cutter teeth that cut in it.

use super::oblique::ElementForce;
use crate::process::shaping::tool::edge_polygon::{EdgeSide, Station};
use gearcut_core::cut::LEAST_CHIP_MM;
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::sections::swept_sections::EDGE_PLACES;
use glam::DVec2;

/// A side of the edge takes part in a chip when it is in contact over at least this share of the module.
const SIDE_CONTACT_MODULES: f64 = 0.02;

/// A place of the edge in a chip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlaceContact {
    /// Length of edge in contact, mm.
    pub length_mm: f64,
    /// The same times the uncut chip thickness, mm^2.
    pub thick_mm2: f64,
}

/// Chip of one cutter tooth in one stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothChip {
    /// Operation, from 0.
    pub operation: usize,
    /// Stroke, from 0.
    pub stroke: u32,
    /// Cutter tooth, from 0.
    pub blade: u32,
    /// Tooth space, from 1; space j lies after tooth j.
    pub space: u32,
    /// Area in the transverse plane, mm^2.
    pub area_mm2: f64,
    /// Length of edge in contact: right, tip, left, mm.
    pub contact_mm: [f64; 3],
    /// The same by places of wear.
    pub edge: [PlaceContact; EDGE_PLACES],
    /// Largest uncut chip thickness: right, tip, left, mm; on flanks, where the corner of the tip is further away than
    /// that.
    pub thickest_mm: [f64; 3],
    /// Cutting force along the stroke, N.
    pub cutting_n: f64,
    /// Force on the tool in the transverse plane, gear frame, N.
    pub side_force_n: DVec2,
    /// Torque of the force on the work about the work axis, N mm, counter-clockwise.
    pub work_torque_nmm: f64,
    /// Torque of the force on the tool about the cutter axis, N mm, counter-clockwise.
    pub cutter_torque_nmm: f64,
}

/// Everything one stroke cuts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrokeChips {
    /// Cutter teeth that cut.
    pub chips: u32,
    /// Chips on two sides of the edge: tip and one flank, or both flanks.
    pub two_flank: u32,
    /// Chips on all three sides.
    pub three_flank: u32,
    /// Space of the largest chip, from 1; 0: the stroke is idle.
    pub space: u32,
    /// Cutter tooth of the largest chip, from 0.
    pub blade: u32,
    /// Area of all chips in the transverse plane, mm^2.
    pub area_mm2: f64,
    /// Area of the largest chip, mm^2.
    pub largest_mm2: f64,
    /// Length of edge in contact: right, tip, left, mm.
    pub contact_mm: [f64; 3],
    /// Largest uncut chip thickness: right, tip, left, mm.
    pub thickest_mm: [f64; 3],
    /// Cutting force along the stroke, N.
    pub cutting_n: f64,
    /// Force on the tool along the line of centres, away from the work axis, N.
    pub radial_n: f64,
    /// Force on the tool at right angles to the line of centres, towards larger work angles, N.
    pub tangential_n: f64,
    /// Torque on the work spindle, N mm, counter-clockwise.
    pub work_torque_nmm: f64,
    /// Torque on the cutter spindle, N mm, counter-clockwise.
    pub cutter_torque_nmm: f64,
}

/// Where a tooth stands when it cuts.
#[derive(Debug, Clone, Copy)]
pub struct StrokePose {
    /// Pose of the blade in the gear frame, mounting errors of the work included.
    pub work_from_blade: Rigid2,
    /// Cutter axis in the same frame, mm.
    pub cutter_axis_mm: DVec2,
    /// Work spindle axis in the same frame, mm.
    pub work_axis_mm: DVec2,
}

impl ToothChip {
    /// Adds up the edge elements of a pass.
    pub fn measure(&mut self, stations: &[Station], forces: &[ElementForce], thickness_mm: &[f64], stand: &StrokePose) {
        for ((station, force), &thickness_mm) in stations.iter().zip(forces).zip(thickness_mm) {
            if thickness_mm < LEAST_CHIP_MM {
                continue;
            }
            let side = station.side as usize;
            self.contact_mm[side] += station.length_mm;
            let place = &mut self.edge[station.wear_place];
            place.length_mm += station.length_mm;
            place.thick_mm2 += station.length_mm * thickness_mm;
            // Beside a corner the old surface is reached round it: a flank would show the thickness of the tip.
            if station.side == EdgeSide::Tip || thickness_mm.max(station.length_mm) < station.to_corner_mm {
                self.thickest_mm[side] = self.thickest_mm[side].max(thickness_mm);
            }
            let [cutting_n, normal_n, along_n] = force.on_element(thickness_mm, station.length_mm);
            // The work pushes the tool back along the edge's outward normal, and along an inclined edge.
            let normal = stand.work_from_blade.direction(station.normal);
            let on_tool = along_n * normal.perp() - normal_n * normal;
            let point = stand.work_from_blade.point(station.point_mm);
            self.cutting_n += cutting_n;
            self.side_force_n += on_tool;
            self.work_torque_nmm -= (point - stand.work_axis_mm).perp_dot(on_tool);
            self.cutter_torque_nmm += (point - stand.cutter_axis_mm).perp_dot(on_tool);
        }
    }

    /// Number of sides of the edge that take part.
    pub fn sides(&self, module_mm: f64) -> usize {
        EdgeSide::ALL.iter().filter(|&&side| self.contact_mm[side as usize] >= SIDE_CONTACT_MODULES * module_mm).count()
    }
}

impl StrokeChips {
    /// Adds the chip of one cutter tooth; `center_mm` is the cutter axis from the work axis, gear frame.
    pub fn add(&mut self, chip: &ToothChip, module_mm: f64, center_mm: DVec2) {
        self.chips += 1;
        match chip.sides(module_mm) {
            2 => self.two_flank += 1,
            3 => self.three_flank += 1,
            _ => {}
        }
        if chip.area_mm2 > self.largest_mm2 {
            (self.largest_mm2, self.space, self.blade) = (chip.area_mm2, chip.space, chip.blade);
        }
        self.area_mm2 += chip.area_mm2;
        for side in 0..3 {
            self.contact_mm[side] += chip.contact_mm[side];
            self.thickest_mm[side] = self.thickest_mm[side].max(chip.thickest_mm[side]);
        }
        let out = center_mm.normalize_or_zero();
        self.cutting_n += chip.cutting_n;
        self.radial_n += chip.side_force_n.dot(out);
        self.tangential_n += chip.side_force_n.dot(out.perp());
        self.work_torque_nmm += chip.work_torque_nmm;
        self.cutter_torque_nmm += chip.cutter_torque_nmm;
    }

    /// Largest uncut chip thickness on any side, mm.
    pub fn thickest_anywhere_mm(&self) -> f64 {
        self.thickest_mm.into_iter().fold(0.0, f64::max)
    }

    /// Length of edge in contact, mm.
    pub fn contact_length_mm(&self) -> f64 {
        self.contact_mm.iter().sum()
    }

    /// Whether nothing is cut.
    pub fn is_idle(&self) -> bool {
        self.chips == 0
    }
}
