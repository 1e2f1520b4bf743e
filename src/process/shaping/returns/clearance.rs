//! Room between the returning cutter and the work.
//!
//! In: the poses through which an operation and those before it lead the cutter, and a retracted pose. Out:
//! [`Clearance`]: how far the edge of the retracted cutter stays from the surfaces that the operation leaves, and from
//! the stock that its later strokes take away.
//!
//! Law: material is what no pose of the cutter has covered. A point p of the retracted edge, on cutter tooth k, lies
//! from it by the depth at which it stands in the pose that covers it deepest,
//!
//! ```text
//! c(p) = max over poses of -distance(p, tooth k in that pose)
//! ```
//!
//! which is the distance along the surface's normal, because the surface is the envelope of these poses; where c is
//! negative the edge stands in material by -c. Over all poses of the turn this is the surface that the operation
//! leaves; over those up to the stroke it is what stands there when the cutter returns, stock included. Nothing here
//! knows the gear's teeth: internal and external gears, tips that the cutter's base relieves and undercut are all
//! covered.

use super::swept::Swept;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::edge_polygon::EdgePolygon;
use crate::process::shaping::linkage::CutterPose;
use gearcut_core::frame::Rigid2;
use glam::DVec2;

/// Places of the edge are at most this far apart, in modules: 0.06 mm for module 3.
const EDGE_SPACING_MODULES: f64 = 0.02;

/// Room round the returning cutter at one stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// From the surfaces that the operation leaves.
    pub surface: Room,
    /// From all material that is there, stock included.
    pub material: Room,
}

/// Smallest distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Room {
    /// Smallest clearance, mm; negative: the edge stands in the material by so much.
    pub smallest_mm: f64,
    /// Where, gear frame.
    pub place_mm: DVec2,
}

impl Room {
    const WIDE: Self = Self { smallest_mm: f64::INFINITY, place_mm: DVec2::ZERO };

    fn add(&mut self, clearance_mm: f64, place_mm: DVec2) {
        if clearance_mm < self.smallest_mm {
            (self.smallest_mm, self.place_mm) = (clearance_mm, place_mm);
        }
    }
}

/// Clearances of the return strokes of one operation.
#[derive(Debug)]
pub struct ReturnRoom {
    /// What the cutter has covered.
    pub swept: Swept,
    pub(super) polygon: EdgePolygon,
    pub(super) module_mm: f64,
}

impl ReturnRoom {
    /// For an operation that leads a cutter through `pose(phi)`, phi unwrapped, after the `earlier` ones; the gear has
    /// `teeth` teeth.
    pub fn new(
        cutter: &ShaperCutter,
        teeth: u32,
        module_mm: f64,
        pose: &dyn Fn(f64) -> CutterPose,
        earlier: &[&dyn Fn(f64) -> CutterPose],
    ) -> Self {
        Self {
            swept: Swept::new(cutter, teeth, module_mm, pose, earlier),
            polygon: EdgePolygon::new(cutter.edge(), EDGE_SPACING_MODULES * module_mm),
            module_mm,
        }
    }

    /// Room round the cutter that has gone back from the stroke at a place to `retracted` (gear from cutter);
    /// `beyond_mm` says how far a point lies outside the uncut blank, negative inside.
    pub fn at(&self, place: usize, retracted: &Rigid2, beyond_mm: impl Fn(DVec2) -> f64) -> Clearance {
        let mut found = Clearance { surface: Room::WIDE, material: Room::WIDE };
        for tool_from_blade in self.swept.tools_from_blades() {
            let work_from_blade = retracted.after(&tool_from_blade);
            for &corner_mm in &self.polygon.corners_mm[..=self.polygon.edge_chords()] {
                let p = work_from_blade.point(corner_mm);
                if beyond_mm(p) > 0.0 {
                    continue;
                }
                // Deeper than the smallest clearance so far, a point says nothing new.
                let enough = [found.surface, found.material].map(|room| room.smallest_mm);
                let [surface_mm, material_mm] = self.swept.covered_mm(place, &tool_from_blade, p, enough);
                found.surface.add(surface_mm, p);
                found.material.add(material_mm, p);
            }
        }
        found
    }

    /// Angles, relative to a direction, of the edge's normals where the stroke at a place has made surface that still
    /// stands: smallest and largest. Moving the cutter off along `-n` of these alone clears everything.
    pub fn contact_normals_rad(
        &self,
        place: usize,
        into_work: DVec2,
        beyond_mm: impl Fn(DVec2) -> f64,
    ) -> Option<[f64; 2]> {
        let pose = self.swept.pose(place);
        let mut range: Option<[f64; 2]> = None;
        for tool_from_blade in self.swept.tools_from_blades() {
            let work_from_blade = pose.after(&tool_from_blade);
            for station in &self.polygon.stations {
                let p = work_from_blade.point(station.point_mm);
                if beyond_mm(p) > 0.0 || !self.swept.is_contact(place, &tool_from_blade, p) {
                    continue;
                }
                let angle_rad = into_work.angle_to(work_from_blade.direction(station.normal));
                let [low, high] = range.unwrap_or([angle_rad; 2]);
                range = Some([low.min(angle_rad), high.max(angle_rad)]);
            }
        }
        range
    }
}
