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
//!
//! Poses stand `POSES_PER_PITCH` to a pitch, with a parabola through the deepest three. Between poses h = (sin a / 8)
//! (1 / rho + 1 / r_c) ds^2 would be left, 0.1 um at the pitch point for module 3 and 0.4 um towards the tip; the
//! parabola takes most of that away.

use super::tooth_distance::ToothDistance;
use crate::frame::Rigid2;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::edge_polygon::EdgePolygon;
use crate::process::shaping::linkage::CutterPose;
use crate::units::TURN_RAD;
use glam::DVec2;

/// Poses of the cutter while it rolls over one pitch.
pub const POSES_PER_PITCH: usize = 48;
/// Pitches before and after a stroke whose poses can cover what the cutter meets there; a cutter tooth is in the work
/// for less than three on external gears, and internal gears hold it longer.
const REACH_PITCHES: usize = 6;
/// Places of the edge are at most this far apart, in modules: 0.06 mm for module 3.
const EDGE_SPACING_MODULES: f64 = 0.02;

/// Distance of the lines on which an overlap is measured, in modules, and the least step along them, mm.
const LINE_SPACING_MODULES: f64 = 0.005;
const LEAST_STEP_MM: f64 = 2e-5;

/// The cutter's way over one turn and a little before and after, for one operation.
#[derive(Debug)]
struct Way {
    poses: Vec<Rigid2>,
}

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
    cutter_teeth: u32,
    /// Ways of the operation itself and of those before it.
    ways: Vec<Way>,
    distance: ToothDistance,
    polygon: EdgePolygon,
    poses_per_turn: usize,
    module_mm: f64,
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
        let poses_per_turn = POSES_PER_PITCH * teeth as usize;
        let before = (REACH_PITCHES * POSES_PER_PITCH) as f64;
        let way = |pose: &dyn Fn(f64) -> CutterPose| {
            let at = |index: usize| {
                let pose = pose((index as f64 - before) * TURN_RAD / poses_per_turn as f64);
                Rigid2::new(pose.angle_rad, pose.center_mm)
            };
            Way { poses: (0..poses_per_turn + 2 * REACH_PITCHES * POSES_PER_PITCH).map(at).collect() }
        };
        Self {
            cutter_teeth: cutter.teeth,
            ways: std::iter::once(way(pose)).chain(earlier.iter().map(|pose| way(pose))).collect(),
            distance: ToothDistance::new(cutter),
            polygon: EdgePolygon::new(cutter.edge(), EDGE_SPACING_MODULES * module_mm),
            poses_per_turn,
            module_mm,
        }
    }

    /// Number of places in a turn at which [`Self::at`] answers.
    pub fn places(&self) -> usize {
        self.poses_per_turn
    }

    /// Polar angle of a place, rad.
    pub fn phi_rad(&self, place: usize) -> f64 {
        place as f64 * TURN_RAD / self.poses_per_turn as f64
    }

    /// Room round the cutter that has gone back from the stroke at a place to `retracted` (gear from cutter);
    /// `beyond_mm` says how far a point lies outside the uncut blank, negative inside.
    pub fn at(&self, place: usize, retracted: &Rigid2, beyond_mm: impl Fn(DVec2) -> f64) -> Clearance {
        let mut found = Clearance { surface: Room::WIDE, material: Room::WIDE };
        for blade in 0..self.cutter_teeth {
            let tool_from_blade = self.tool_from_blade(blade);
            let work_from_blade = retracted.after(&tool_from_blade);
            for &corner_mm in &self.polygon.corners_mm[..=self.polygon.edge_chords()] {
                let p = work_from_blade.point(corner_mm);
                if beyond_mm(p) > 0.0 {
                    continue;
                }
                // Deeper than the smallest clearance so far, a point says nothing new.
                let enough = [found.surface, found.material].map(|room| room.smallest_mm);
                let [surface_mm, material_mm] = self.covered_mm(place, &tool_from_blade, p, enough);
                found.surface.add(surface_mm, p);
                found.material.add(material_mm, p);
            }
        }
        found
    }

    /// Area that the retracted cutter has in common with what the operation leaves, mm2.
    ///
    /// Lines across each cutter tooth, `LINE_SPACING_MODULES` apart, are followed in steps of the distance from the
    /// nearest surface, which no step can pass; what lies in material is added up. Thin slivers along a flank are as
    /// exact as thick ones.
    pub fn overlap_mm2(&self, place: usize, retracted: &Rigid2, beyond_mm: impl Fn(DVec2) -> f64) -> f64 {
        let edge = &self.polygon.corners_mm[..=self.polygon.edge_chords()];
        let spacing_mm = LINE_SPACING_MODULES * self.module_mm;
        let (low_mm, high_mm) = edge.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), p| (a.min(p.x), b.max(p.x)));
        let lines = ((high_mm - low_mm) / spacing_mm) as usize;
        (0..self.cutter_teeth)
            .map(|blade| {
                let tool_from_blade = self.tool_from_blade(blade);
                let work_from_blade = retracted.after(&tool_from_blade);
                // Positive outside the material, by at most the distance from it.
                let outside_mm = |x_mm: f64, y_mm: f64| {
                    let p = work_from_blade.point(DVec2::new(x_mm, y_mm));
                    let beyond_mm = beyond_mm(p);
                    if beyond_mm > 0.0 {
                        return beyond_mm;
                    }
                    self.covered_mm(place, &tool_from_blade, p, [f64::INFINITY; 2])[0].max(beyond_mm)
                };
                let length_mm = |line: usize| {
                    let x_mm = high_mm - (line as f64 + 0.5) * spacing_mm;
                    let half_mm = half_width_mm(edge, x_mm);
                    length_inside_mm(|y_mm| outside_mm(x_mm, y_mm), [-half_mm, half_mm])
                };
                (0..lines).map(length_mm).sum::<f64>() * spacing_mm
            })
            .sum()
    }

    /// Angles, relative to a direction, of the edge's normals where the stroke at a place has made surface that still
    /// stands: smallest and largest. Moving the cutter off along `-n` of these alone clears everything.
    pub fn contact_normals_rad(
        &self,
        place: usize,
        into_work: DVec2,
        beyond_mm: impl Fn(DVec2) -> f64,
    ) -> Option<[f64; 2]> {
        let pose = &self.ways[0].poses[self.index(place)];
        let mut range: Option<[f64; 2]> = None;
        for blade in 0..self.cutter_teeth {
            let tool_from_blade = self.tool_from_blade(blade);
            let work_from_blade = pose.after(&tool_from_blade);
            for station in &self.polygon.stations {
                let p = work_from_blade.point(station.point_mm);
                if beyond_mm(p) > 0.0 || self.covered_before_mm(place, &tool_from_blade, p) > CONTACT_MM {
                    continue;
                }
                let angle_rad = into_work.angle_to(work_from_blade.direction(station.normal));
                let [low, high] = range.unwrap_or([angle_rad; 2]);
                range = Some([low.min(angle_rad), high.max(angle_rad)]);
            }
        }
        range
    }

    fn tool_from_blade(&self, blade: u32) -> Rigid2 {
        Rigid2::new(TURN_RAD * f64::from(blade) / f64::from(self.cutter_teeth), DVec2::ZERO)
    }

    fn index(&self, place: usize) -> usize {
        place + REACH_PITCHES * POSES_PER_PITCH
    }

    /// How deep a point stands in the pose that covers it deepest: over all poses, and over those up to the stroke. A
    /// depth that is `enough` ends the search.
    fn covered_mm(&self, place: usize, tool_from_blade: &Rigid2, p: DVec2, enough: [f64; 2]) -> [f64; 2] {
        let here = self.index(place);
        let mut past_mm = self.deepest_mm(&self.ways[0], Span::Past(here), tool_from_blade, p, enough[1]);
        past_mm = past_mm.max(self.earlier_mm(here, tool_from_blade, p, enough[1], past_mm));
        if past_mm >= enough[0] {
            return [past_mm; 2];
        }
        let next_mm = self.deepest_mm(&self.ways[0], Span::All(here), tool_from_blade, p, enough[0]);
        [past_mm.max(next_mm), past_mm]
    }

    /// The same over the poses before the stroke, without it.
    fn covered_before_mm(&self, place: usize, tool_from_blade: &Rigid2, p: DVec2) -> f64 {
        let here = self.index(place);
        let past_mm = self.deepest_mm(&self.ways[0], Span::Past(here - 1), tool_from_blade, p, CONTACT_MM);
        past_mm.max(self.earlier_mm(here, tool_from_blade, p, CONTACT_MM, past_mm))
    }

    /// The same over all poses of the earlier operations, unless `so_far_mm` is enough.
    fn earlier_mm(&self, here: usize, tool_from_blade: &Rigid2, p: DVec2, enough_mm: f64, so_far_mm: f64) -> f64 {
        let mut deepest_mm = so_far_mm;
        for way in &self.ways[1..] {
            if deepest_mm >= enough_mm {
                break;
            }
            deepest_mm = deepest_mm.max(self.deepest_mm(way, Span::All(here), tool_from_blade, p, enough_mm));
        }
        deepest_mm
    }

    /// Depth in the deepest pose of a span; the search ends at a depth of `enough_mm`.
    fn deepest_mm(&self, way: &Way, span: Span, tool_from_blade: &Rigid2, p: DVec2, enough_mm: f64) -> f64 {
        let depth = |pose: &Rigid2| {
            let away = p - pose.translation_mm;
            let blade = pose.rotation.rotate(tool_from_blade.rotation);
            -self.distance.at_mm(DVec2::new(blade.x, -blade.y).rotate(away))
        };
        let tip_mm = self.distance.tip_radius_mm;
        let reach = REACH_PITCHES * POSES_PER_PITCH;
        let (here, last) = match span {
            Span::Past(here) => (here, here),
            Span::All(here) => (here, here + reach),
        };
        let (mut deepest_mm, mut at) = (f64::NEG_INFINITY, here);
        // From the stroke outwards: what it has cut itself is found first.
        let order = (here + 1 - reach..=here).rev().chain(here + 1..=last);
        for index in order {
            // No pose covers a point deeper than its tip circle does.
            if tip_mm - p.distance(way.poses[index].translation_mm) <= deepest_mm {
                continue;
            }
            let here_mm = depth(&way.poses[index]);
            if here_mm > deepest_mm {
                (deepest_mm, at) = (here_mm, index);
                if deepest_mm >= enough_mm {
                    return deepest_mm;
                }
            }
        }
        if at == last || at + reach == here + 1 {
            return deepest_mm;
        }
        let around = [&way.poses[at - 1], &way.poses[at], &way.poses[at + 1]];
        let [before_mm, after_mm] = [depth(around[0]), depth(around[2])];
        let bend_mm = 2.0 * deepest_mm - before_mm - after_mm;
        if bend_mm <= 0.0 {
            return deepest_mm;
        }
        depth(&between(around, 0.5 * (after_mm - before_mm) / bend_mm)).max(deepest_mm)
    }
}

/// Poses to look at, round the index of a stroke.
#[derive(Clone, Copy)]
enum Span {
    /// Up to this one.
    Past(usize),
    /// Before and after.
    All(usize),
}

/// Half of the width of a tooth at a place of its centre line, mm.
fn half_width_mm(edge: &[DVec2], x_mm: f64) -> f64 {
    let crossing = |pair: &[DVec2]| {
        let [a, b] = [pair[0], pair[1]];
        let within = (a.x - x_mm) * (b.x - x_mm) <= 0.0 && a.x != b.x;
        within.then(|| (a.y + (b.y - a.y) * (x_mm - a.x) / (b.x - a.x)).abs())
    };
    edge.windows(2).filter_map(crossing).fold(0.0, f64::max)
}

/// Length of a line on which a distance is negative, mm; steps are as long as the distance.
fn length_inside_mm(distance_mm: impl Fn(f64) -> f64, [from_mm, to_mm]: [f64; 2]) -> f64 {
    let (mut at_mm, mut here_mm) = (from_mm, distance_mm(from_mm));
    let mut length_mm = 0.0;
    while at_mm < to_mm {
        let next_at_mm = (at_mm + here_mm.abs().max(LEAST_STEP_MM)).min(to_mm);
        let next_mm = distance_mm(next_at_mm);
        let step_mm = next_at_mm - at_mm;
        length_mm += match (here_mm < 0.0, next_mm < 0.0) {
            (true, true) => step_mm,
            (false, false) => 0.0,
            (true, false) => step_mm * here_mm / (here_mm - next_mm),
            (false, true) => step_mm * next_mm / (next_mm - here_mm),
        };
        (at_mm, here_mm) = (next_at_mm, next_mm);
    }
    length_mm
}

/// The pose a share of a step after the middle one of three, by the parabola through them: 15 nm off at the cutter's
/// tip for steps of 0.02 rad.
fn between(poses: [&Rigid2; 3], share: f64) -> Rigid2 {
    let mix = |of: fn(&Rigid2) -> DVec2| {
        let [a, b, c] = poses.map(of);
        b + 0.5 * share * (c - a + share * (a - 2.0 * b + c))
    };
    Rigid2 { rotation: mix(|pose| pose.rotation).normalize(), translation_mm: mix(|pose| pose.translation_mm) }
}

/// A place of the edge that no earlier pose has covered deeper than this touches what stands.
const CONTACT_MM: f64 = 1e-3;
