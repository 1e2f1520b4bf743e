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
//! covered. The law holds on the teeth of the cutter. Its root circle between them belongs to no tooth and covers
//! nothing here, so that what it meets is left to the blank field of a run: half a tooth's gap would be taken for a
//! depth where tips of the gear reach it.

use super::swept::Swept;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::linkage::CutterPose;
use crate::process::shaping::tool::edge_polygon::{EdgePolygon, Station};
use gearcut_core::frame::Rigid2;
use glam::DVec2;
use std::collections::VecDeque;

/// Places of the edge are at most this far apart, in modules: 0.06 mm for module 3.
const EDGE_SPACING_MODULES: f64 = 0.02;
/// What a place of the edge at most stands in earlier poses if it touches what they have left, mm.
const CONTACT_MM: f64 = 1e-3;

/// Room round the returning cutter at one stroke: its smallest clearance in mm. Where it is negative, the edge stands
/// in the material by so much; infinite where the whole edge is outside the uncut blank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// From the surfaces that the operation leaves.
    pub surface_mm: f64,
    /// From all material that is there, stock included.
    pub material_mm: f64,
}

impl Clearance {
    /// Of an edge that is nowhere in the blank; every clearance is below.
    pub const ANY: Self = Self { surface_mm: f64::INFINITY, material_mm: f64::INFINITY };
}

/// Clearances of the return strokes of one operation.
#[derive(Debug)]
pub struct ReturnRoom {
    /// What the cutter has covered.
    pub swept: Swept,
    /// Corners of a tooth's edge without the cutter's root beside it, blade frame, mm.
    pub(super) edge_mm: Vec<DVec2>,
    /// Way along the edge to each of them, mm.
    arcs_mm: Vec<f64>,
    /// Places of the same edge with their normals.
    stations: Vec<Station>,
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
        let swept = Swept::new(cutter, teeth, pose, earlier);
        let polygon = EdgePolygon::new(cutter.edge(), EDGE_SPACING_MODULES * module_mm);
        let on_tooth = |point_mm: &DVec2| swept.distance_from_tooth_mm(*point_mm) <= CONTACT_MM;
        let edge_mm: Vec<DVec2> =
            polygon.corners_mm[..=polygon.edge_chords()].iter().copied().filter(on_tooth).collect();
        let mut arc_mm = 0.0;
        let chords = edge_mm.windows(2).map(|chord| chord[0].distance(chord[1]));
        let arcs_mm = std::iter::once(0.0).chain(chords.map(|chord_mm| {
            arc_mm += chord_mm;
            arc_mm
        }));
        let arcs_mm = arcs_mm.collect();
        let stations = polygon.stations.into_iter().filter(|station| on_tooth(&station.point_mm)).collect();
        Self { swept, edge_mm, arcs_mm, stations, module_mm }
    }

    /// Room round the cutter that has gone back from the stroke at a place to `retracted` (gear from cutter);
    /// `beyond_mm` says how far a point lies outside the uncut blank, negative inside. Only clearances below `below`
    /// are looked for; it is what comes out where there is none.
    ///
    /// The clearance rises and falls by no more than one goes along the edge, so that a part of the edge whose middle
    /// has room enough holds no place that is tighter than what was found: the result is that of all corners.
    pub fn at(
        &self,
        place: usize,
        retracted: &Rigid2,
        beyond_mm: impl Fn(DVec2) -> f64,
        below: Clearance,
    ) -> Clearance {
        let blades: Vec<Rigid2> = self.swept.tools_from_blades().collect();
        let work_from_blades: Vec<Rigid2> = blades.iter().map(|blade| retracted.after(blade)).collect();
        let corner = |[blade, corner]: [usize; 2]| work_from_blades[blade].point(self.edge_mm[corner]);
        let mut found = below;
        search(
            blades.len(),
            &self.arcs_mm,
            |at| beyond_mm(corner(at)),
            |at, reach_mm| {
                let enough_mm = [found.surface_mm + reach_mm, found.material_mm + reach_mm];
                let [surface_mm, material_mm] = self.swept.covered_mm(place, &blades[at[0]], corner(at), enough_mm);
                found.surface_mm = found.surface_mm.min(surface_mm);
                found.material_mm = found.material_mm.min(material_mm);
                surface_mm < enough_mm[0] || material_mm < enough_mm[1]
            },
        );
        found
    }

    /// Angles, relative to a direction, of the edge's normals where the stroke at a place has made surface that still
    /// stands: smallest and largest, and no less than those that are `known`. Moving the cutter off along `-n` of these
    /// alone clears everything.
    pub fn contact_normals_rad(
        &self,
        place: usize,
        into_work: DVec2,
        beyond_mm: impl Fn(DVec2) -> f64,
        known: Option<[f64; 2]>,
    ) -> Option<[f64; 2]> {
        let blades: Vec<Rigid2> = self.swept.tools_from_blades().collect();
        let work_from_blades: Vec<Rigid2> = blades.iter().map(|blade| self.swept.pose(place).after(blade)).collect();
        let arcs_mm: Vec<f64> = self.stations.iter().map(|station| station.arc_mm).collect();
        let point = |[blade, at]: [usize; 2]| work_from_blades[blade].point(self.stations[at].point_mm);
        let mut range = known;
        search(
            blades.len(),
            &arcs_mm,
            |at| beyond_mm(point(at)),
            |[blade, station], reach_mm| {
                let normal = work_from_blades[blade].direction(self.stations[station].normal);
                let angle_rad = into_work.angle_to(normal);
                if range.is_some_and(|[low, high]| (low..=high).contains(&angle_rad)) {
                    return true;
                }
                let enough_mm = CONTACT_MM + reach_mm;
                let covered_mm =
                    self.swept.covered_before_mm(place, &blades[blade], point([blade, station]), enough_mm);
                if covered_mm <= CONTACT_MM {
                    let [low, high] = range.unwrap_or([angle_rad; 2]);
                    range = Some([low.min(angle_rad), high.max(angle_rad)]);
                }
                covered_mm < enough_mm
            },
        );
        range
    }
}

/// Looks at the places of an edge, whose arcs are given, on every cutter tooth where they are inside the blank: at the
/// middle of a part first, then at the halves beside it. A place is cutter tooth and number; `outside_mm` says how far
/// it lies outside the blank, negative inside, and rises and falls by no more than one goes along the edge. `look` gets
/// how far the part reaches to either side, mm, and says whether the rest of it is to be looked at.
fn search(
    blades: usize,
    arcs_mm: &[f64],
    outside_mm: impl Fn([usize; 2]) -> f64,
    mut look: impl FnMut([usize; 2], f64) -> bool,
) {
    /// A part of the edge of a tooth, first and last place, and whether all of it is known to be inside.
    struct EdgePart {
        blade: usize,
        first: usize,
        last: usize,
        inside: bool,
    }
    let whole = |blade: usize| EdgePart { blade, first: 0, last: arcs_mm.len() - 1, inside: false };
    let mut parts: VecDeque<EdgePart> = (0..blades).map(whole).collect();
    while let Some(EdgePart { blade, first, last, mut inside }) = parts.pop_front() {
        let middle = first.midpoint(last);
        let reach_mm = (arcs_mm[middle] - arcs_mm[first]).max(arcs_mm[last] - arcs_mm[middle]);
        let outside_mm = if inside { f64::NEG_INFINITY } else { outside_mm([blade, middle]) };
        inside = outside_mm <= -reach_mm;
        let go_on = if outside_mm > 0.0 { outside_mm <= reach_mm } else { look([blade, middle], reach_mm) };
        if !go_on {
            continue;
        }
        if middle > first {
            parts.push_back(EdgePart { blade, first, last: middle - 1, inside });
        }
        if middle < last {
            parts.push_back(EdgePart { blade, first: middle + 1, last, inside });
        }
    }
}
