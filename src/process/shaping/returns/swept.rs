//! How deep a point stands in what a cutter has covered.
//!
//! In: the poses through which an operation and those before it lead the cutter. Out: the depth of a point of cutter
//! tooth k in that pose which covers it deepest, over the whole turn or up to a stroke; negative where no pose covers
//! it, and then the distance from the nearest.
//!
//! Poses stand [`POSES_PER_PITCH`] to a pitch, and the parabola through the deepest three says where to look once more.
//! Without that h = (sin a / 8) (1 / rho + 1 / r_c) ds^2 would be missing, 0.1 um at the pitch point for module 3 and
//! 0.4 um towards the tip.

use super::tooth_distance::ToothDistance;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::linkage::CutterPose;
use gearcut_core::frame::Rigid2;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;

/// Poses of the cutter while it rolls over one pitch.
pub const POSES_PER_PITCH: usize = 48;
/// Pitches before and after a stroke whose poses can cover what the cutter meets there; a cutter tooth is in the work
/// for less than three on external gears, and internal gears hold it longer.
const REACH_PITCHES: usize = 6;
/// A tooth passes a point once: the depth rises to its largest value and falls. When it has fallen by so many modules,
/// the tooth is leaving.
const LEAVING_MODULES: f64 = 0.5;
/// What a place of the edge at most stands in earlier poses if it touches what they have left, mm.
const CONTACT_MM: f64 = 1e-3;

/// The cutter's way over one turn and a little before and after, for one operation.
#[derive(Debug)]
struct Way {
    poses: Vec<Rigid2>,
}

/// What a cutter covers in an operation and those before it.
#[derive(Debug)]
pub struct Swept {
    cutter_teeth: u32,
    /// Ways of the operation itself and of those before it.
    ways: Vec<Way>,
    distance: ToothDistance,
    poses_per_turn: usize,
    module_mm: f64,
}

impl Swept {
    /// For an operation that leads a cutter through `pose(phi)`, phi unwrapped, after the `earlier` ones; the gear has
    /// `teeth` teeth of `module_mm`.
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
            poses_per_turn,
            module_mm,
        }
    }

    /// Number of places in a turn that a stroke can have.
    pub fn places(&self) -> usize {
        self.poses_per_turn
    }

    /// Polar angle of a place, rad.
    pub fn phi_rad(&self, place: usize) -> f64 {
        place as f64 * TURN_RAD / self.poses_per_turn as f64
    }

    /// Pose of the operation's stroke at a place, gear from cutter.
    pub fn pose(&self, place: usize) -> &Rigid2 {
        &self.ways[0].poses[index(place)]
    }

    /// Places of the cutter's teeth on the cutter.
    pub fn tools_from_blades(&self) -> impl Iterator<Item = Rigid2> {
        let teeth = f64::from(self.cutter_teeth);
        (0..self.cutter_teeth).map(move |blade| Rigid2::new(TURN_RAD * f64::from(blade) / teeth, DVec2::ZERO))
    }

    /// How deep a point stands in the pose that covers it deepest: over all poses, and over those up to the stroke. A
    /// depth that is `enough` ends the search.
    pub fn covered_mm(&self, place: usize, tool_from_blade: &Rigid2, p: DVec2, enough: [f64; 2]) -> [f64; 2] {
        let here = index(place);
        let mut past_mm = self.deepest_mm(&self.ways[0], Span::Past(here), tool_from_blade, p, enough[1]);
        past_mm = past_mm.max(self.earlier_mm(here, tool_from_blade, p, enough[1], past_mm));
        if past_mm >= enough[0] {
            return [past_mm; 2];
        }
        let next_mm = self.deepest_mm(&self.ways[0], Span::All(here), tool_from_blade, p, enough[0]);
        [past_mm.max(next_mm), past_mm]
    }

    /// Whether a point of the edge at its stroke touches surface that this stroke has made: no earlier pose has covered
    /// it.
    pub fn is_contact(&self, place: usize, tool_from_blade: &Rigid2, p: DVec2) -> bool {
        let here = index(place);
        let past_mm = self.deepest_mm(&self.ways[0], Span::Past(here - 1), tool_from_blade, p, CONTACT_MM);
        past_mm.max(self.earlier_mm(here, tool_from_blade, p, CONTACT_MM, past_mm)) <= CONTACT_MM
    }

    /// The depth over all poses of the earlier operations, unless `so_far_mm` is enough.
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
        let leaving_mm = LEAVING_MODULES * self.module_mm;
        // From the stroke outwards: what it has cut itself is found first.
        let ways_out: [&mut dyn Iterator<Item = usize>; 2] =
            [&mut (here + 1 - reach..=here).rev(), &mut (here + 1..=last)];
        for poses in ways_out {
            for index in poses {
                // No pose covers a point deeper than its tip circle does.
                let most_mm = tip_mm - p.distance(way.poses[index].translation_mm);
                if most_mm <= deepest_mm - leaving_mm {
                    break;
                }
                let here_mm = depth(&way.poses[index]);
                if here_mm > deepest_mm {
                    (deepest_mm, at) = (here_mm, index);
                    if deepest_mm >= enough_mm {
                        return deepest_mm;
                    }
                } else if here_mm < deepest_mm - leaving_mm {
                    break;
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

/// Index of the pose of a place.
fn index(place: usize) -> usize {
    place + REACH_PITCHES * POSES_PER_PITCH
}

/// Poses to look at, round the index of a stroke.
#[derive(Clone, Copy)]
enum Span {
    /// Up to this one.
    Past(usize),
    /// Before and after.
    All(usize),
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
