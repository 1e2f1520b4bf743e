//! How deep a point stands in what a cutter has covered.
//!
//! In: the poses through which an operation and those before it lead the cutter. Out: the depth of a point of cutter
//! tooth k in that pose which covers it deepest, over the whole turn or up to a stroke; negative where no pose covers
//! it, and then the distance from the nearest.
//!
//! Poses stand [`POSES_PER_PITCH`] to a pitch, and the parabola through the deepest three says where to look once more.
//! Without that h = (sin a / 8) (1 / rho + 1 / r_c) ds^2 would be missing, 0.1 um at the pitch point for module 3 and
//! 0.4 um towards the tip.
//!
//! Poses that cannot come up to the deepest so far are passed over, by the bound that is derived in `path.rs`.

use super::path::CutterPath;
use super::tooth_distance::ToothDistance;
use crate::process::shaping::ShaperCutter;
use crate::process::shaping::linkage::CutterPose;
use gearcut_core::frame::Rigid2;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use std::ops::RangeInclusive;

/// Poses of the cutter while it rolls over one pitch.
pub const POSES_PER_PITCH: usize = 48;
/// Poses before and after a stroke that can cover what the cutter meets there: six pitches. A cutter tooth is in the
/// work for less than three on external gears, and internal gears hold it longer.
const REACH: usize = 6 * POSES_PER_PITCH;

/// What a cutter covers in an operation and those before it.
#[derive(Debug)]
pub struct Swept {
    cutter_teeth: u32,
    /// Ways of the operation itself and of those before it.
    paths: Vec<CutterPath>,
    distance: ToothDistance,
    poses_per_turn: usize,
}

impl Swept {
    /// For an operation that leads a cutter through `pose(phi)`, phi unwrapped, after the `earlier` ones; the gear has
    /// `teeth` teeth.
    pub fn new(
        cutter: &ShaperCutter,
        teeth: u32,
        pose: &dyn Fn(f64) -> CutterPose,
        earlier: &[&dyn Fn(f64) -> CutterPose],
    ) -> Self {
        let poses_per_turn = POSES_PER_PITCH * teeth as usize;
        let before = REACH as f64;
        let path = |pose: &dyn Fn(f64) -> CutterPose| {
            let at = |index: usize| {
                let pose = pose((index as f64 - before) * TURN_RAD / poses_per_turn as f64);
                Rigid2::new(pose.angle_rad, pose.center_mm)
            };
            let poses = (0..poses_per_turn + 2 * REACH).map(at).collect();
            CutterPath::new(poses, cutter.tip_radius_mm)
        };
        Self {
            cutter_teeth: cutter.teeth,
            paths: std::iter::once(path(pose)).chain(earlier.iter().map(|pose| path(pose))).collect(),
            distance: ToothDistance::new(cutter),
            poses_per_turn,
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
        &self.paths[0].poses[index(place)]
    }

    /// Places of the cutter's teeth on the cutter.
    pub fn tools_from_blades(&self) -> impl Iterator<Item = Rigid2> {
        let teeth = f64::from(self.cutter_teeth);
        (0..self.cutter_teeth).map(move |blade| Rigid2::new(TURN_RAD * f64::from(blade) / teeth, DVec2::ZERO))
    }

    /// How far a point of a blade's frame lies from the tooth, mm; negative inside.
    pub fn distance_from_tooth_mm(&self, point_mm: DVec2) -> f64 {
        self.distance.at_mm(point_mm)
    }

    /// How deep a point stands in the pose that covers it deepest: over all poses, and over those up to the stroke. A
    /// depth that is `enough` ends the search.
    pub fn covered_mm(&self, place: usize, tool_from_blade: &Rigid2, p: DVec2, enough: [f64; 2]) -> [f64; 2] {
        let (here, own) = (index(place), &self.paths[0]);
        let probe = SeenPoint { distance: &self.distance, blade: tool_from_blade.rotation, p };
        let mut deepest = Deepest { depth_mm: f64::NEG_INFINITY, at: here };
        // From the stroke outwards: what it has cut itself is found first.
        let left = probe.walk(own, Poses::until(here), &mut deepest, enough[1]);
        let past_mm = probe.between_poses_mm(own, deepest, &(first(here)..=here), enough[1]);
        let past_mm = self.earlier_mm(here, &probe, past_mm, enough[1]);
        if past_mm >= enough[0] {
            return [past_mm; 2];
        }
        for poses in [Poses::after(here), left] {
            probe.walk(own, poses, &mut deepest, enough[0]);
        }
        let all_mm = probe.between_poses_mm(own, deepest, &(first(here)..=here + REACH), enough[0]);
        [all_mm.max(past_mm), past_mm]
    }

    /// How deep a point stands in the pose before the stroke that covers it deepest. A depth that is `enough` ends the
    /// search.
    pub fn covered_before_mm(&self, place: usize, tool_from_blade: &Rigid2, p: DVec2, enough_mm: f64) -> f64 {
        let (before, own) = (index(place) - 1, &self.paths[0]);
        let probe = SeenPoint { distance: &self.distance, blade: tool_from_blade.rotation, p };
        let mut deepest = Deepest { depth_mm: f64::NEG_INFINITY, at: before };
        probe.walk(own, Poses::until(before), &mut deepest, enough_mm);
        let past_mm = probe.between_poses_mm(own, deepest, &(first(before)..=before), enough_mm);
        self.earlier_mm(before, &probe, past_mm, enough_mm)
    }

    /// The depth over all poses of the earlier operations where it is more than `deepest_mm`, unless that is enough.
    fn earlier_mm(&self, here: usize, probe: &SeenPoint, mut deepest_mm: f64, enough_mm: f64) -> f64 {
        for path in &self.paths[1..] {
            if deepest_mm >= enough_mm {
                break;
            }
            let mut deepest = Deepest { depth_mm: f64::NEG_INFINITY, at: here };
            for poses in [Poses::until(here), Poses::after(here)] {
                probe.walk(path, poses, &mut deepest, enough_mm);
            }
            let all = first(here)..=here + REACH;
            deepest_mm = deepest_mm.max(probe.between_poses_mm(path, deepest, &all, enough_mm));
        }
        deepest_mm
    }
}

/// A point of the work, seen from one cutter tooth.
struct SeenPoint<'a> {
    distance: &'a ToothDistance,
    /// Direction of the tooth on the cutter.
    blade: DVec2,
    p: DVec2,
}

/// The deepest pose so far.
#[derive(Clone, Copy)]
struct Deepest {
    depth_mm: f64,
    /// Its index; the end of a span as long as there is none.
    at: usize,
}

/// Poses to look at, outwards from a stroke.
#[derive(Clone, Copy)]
struct Poses {
    next: usize,
    left: usize,
    backwards: bool,
}

impl Poses {
    fn until(here: usize) -> Self {
        Self { next: here, left: REACH, backwards: true }
    }

    fn after(here: usize) -> Self {
        Self { next: here + 1, left: REACH, backwards: false }
    }

    fn pass(&mut self, poses: usize) {
        let poses = poses.min(self.left);
        self.left -= poses;
        self.next = if self.backwards { self.next.saturating_sub(poses) } else { self.next + poses };
    }
}

impl SeenPoint<'_> {
    fn depth_mm(&self, pose: &Rigid2) -> f64 {
        let blade = pose.rotation.rotate(self.blade);
        -self.distance.at_mm(DVec2::new(blade.x, -blade.y).rotate(self.p - pose.translation_mm))
    }

    /// Looks for deeper poses until one is deep enough; gives those that are left.
    fn walk(&self, path: &CutterPath, mut poses: Poses, deepest: &mut Deepest, enough_mm: f64) -> Poses {
        while poses.left > 0 && deepest.depth_mm < enough_mm {
            let pose = &path.poses[poses.next];
            // No pose covers a point deeper than its tip circle does.
            let most_mm = self.distance.tip_radius_mm - self.p.distance(pose.translation_mm);
            let depth_mm = if most_mm > deepest.depth_mm { self.depth_mm(pose) } else { most_mm };
            if depth_mm > deepest.depth_mm {
                *deepest = Deepest { depth_mm, at: poses.next };
                poses.pass(1);
            } else {
                poses.pass(path.poses_to_gain(poses.next, self.p, deepest.depth_mm - depth_mm));
            }
        }
        poses
    }

    /// The depth where it is largest, between poses, from pose to pose of a span; as it is where that is enough.
    fn between_poses_mm(
        &self,
        path: &CutterPath,
        deepest: Deepest,
        span: &RangeInclusive<usize>,
        enough_mm: f64,
    ) -> f64 {
        let Deepest { depth_mm, at } = deepest;
        if depth_mm >= enough_mm || at <= *span.start() || at >= *span.end() {
            return depth_mm;
        }
        let around = [&path.poses[at - 1], &path.poses[at], &path.poses[at + 1]];
        let [before_mm, after_mm] = [around[0], around[2]].map(|pose| self.depth_mm(pose));
        let bend_mm = 2.0 * depth_mm - before_mm - after_mm;
        if bend_mm <= 0.0 {
            return depth_mm;
        }
        self.depth_mm(&between(around, 0.5 * (after_mm - before_mm) / bend_mm)).max(depth_mm)
    }
}

/// Index of the pose of a place.
fn index(place: usize) -> usize {
    place + REACH
}

/// Index of the first pose to look at from that of a stroke.
fn first(here: usize) -> usize {
    here + 1 - REACH
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process;
    use crate::process::shaping::ShapingJob;
    use std::path::Path;

    fn shipped(name: &str) -> ShapingJob {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/shaping/{name}.toml"));
        ShapingJob::new(process::load(&path, &[]).expect("a shipped scene").scene).expect("it can be cut")
    }

    /// The depth with every pose looked at, and the parabola through the deepest three.
    fn deepest_of_all_mm(
        swept: &Swept,
        path: &CutterPath,
        poses: std::ops::Range<usize>,
        blade: &Rigid2,
        p: DVec2,
    ) -> f64 {
        let depth = |pose: &Rigid2| -swept.distance.at_mm(pose.after(blade).inverse().point(p));
        let depths: Vec<f64> = path.poses[poses.clone()].iter().map(depth).collect();
        let at = (0..depths.len()).max_by(|&a, &b| depths[a].total_cmp(&depths[b])).expect("poses");
        let bend_mm =
            if at == 0 || at + 1 == depths.len() { 0.0 } else { 2.0 * depths[at] - depths[at - 1] - depths[at + 1] };
        if bend_mm <= 0.0 {
            return depths[at];
        }
        let around = [-1, 0, 1].map(|off: isize| &path.poses[(poses.start + at).wrapping_add_signed(off)]);
        depth(&between(around, 0.5 * (depths[at + 1] - depths[at - 1]) / bend_mm)).max(depths[at])
    }

    #[test]
    fn poses_that_are_passed_over_cover_nothing_deeper() {
        for name in ["internal_interfering", "fourier_concave", "circular_m3_z24"] {
            let job = shipped(name);
            let [rough, finish] = [0, 1].map(|i| {
                let operation = &job.operations[i];
                move |phi: f64| operation.linkage.pose(phi, operation.spec.offset_mm)
            });
            let gear = &job.scene.gear;
            let swept = Swept::new(&job.cutter, gear.teeth, &finish, &[&rough]);
            let (mut looked_at, mut inside) = (0, 0);
            for place in (0..swept.places()).step_by(331) {
                let (here, pose) = (index(place), *swept.pose(place));
                for blade in swept.tools_from_blades() {
                    for i in 0..70 {
                        // All over the tooth, and beside it.
                        let on_tooth = DVec2::new(
                            swept.distance.tip_radius_mm - 0.33 * f64::from(i % 10) + 0.2,
                            0.7 * (f64::from(i / 10) - 3.1),
                        );
                        let p = pose.after(&blade).point(on_tooth);
                        let past = first(here)..here + 1;
                        let all = first(here)..here + REACH + 1;
                        let rough_mm = deepest_of_all_mm(&swept, &swept.paths[1], all.clone(), &blade, p);
                        let past_mm = deepest_of_all_mm(&swept, &swept.paths[0], past, &blade, p).max(rough_mm);
                        let all_mm = deepest_of_all_mm(&swept, &swept.paths[0], all, &blade, p).max(past_mm);
                        let found = swept.covered_mm(place, &blade, p, [f64::INFINITY; 2]);
                        for (found, expected) in found.into_iter().zip([all_mm, past_mm]) {
                            let off_mm = found - expected;
                            assert!(off_mm.abs() < 1e-9, "{name} {place} {p}: {found} for {expected}");
                        }
                        (looked_at, inside) = (looked_at + 1, inside + usize::from(all_mm > 0.0));
                    }
                }
            }
            assert!(looked_at > 1000 && 2 * inside < 3 * looked_at, "{name}: {looked_at}, {inside} inside");
        }
    }
}
