//! The cutter's path in one operation, and how fast a depth can grow along it.
//!
//! In: poses that follow each other closely. Out: from a pose and a point of the work, how many poses it takes until
//! the point can stand so much deeper in a cutter tooth.
//!
//! The depth of a point changes by no more than the point moves against the tooth. From one pose to the next that is
//! the turn between the poses times the distance from a pivot, and what the pivot itself slips; over k poses, with the
//! largest turn t, slip s and step w of the pivot from pose to pose, and the distance D from the pivot here,
//!
//! ```text
//! |depth(i + k) - depth(i)| <= k s + t (k D + w k (k - 1) / 2)
//! ```
//!
//! The pivot is the pole of the motion, near the pitch point, so that slips are rounding.

use gearcut_core::frame::Rigid2;
use glam::DVec2;

/// A pole farther from the cutter's axis than so many of its tip radii is no pivot: the poses hardly turn.
const FARTHEST_PIVOT: f64 = 2.0;

/// The cutter's path over one turn and a little before and after, for one operation.
#[derive(Debug)]
pub(super) struct CutterPath {
    pub(super) poses: Vec<Rigid2>,
    /// Between each pose and the next, gear frame.
    pivots_mm: Vec<DVec2>,
    /// Largest turn from pose to pose, as the chord on the unit circle.
    turn: f64,
    /// Largest slip of a pivot.
    slip_mm: f64,
    /// Largest step from pivot to pivot.
    pivot_step_mm: f64,
}

impl CutterPath {
    /// Of poses (gear from cutter) that follow each other closely.
    pub(super) fn new(poses: Vec<Rigid2>, tip_radius_mm: f64) -> Self {
        // Tool-from-gear as complex numbers: p becomes a (p - o).
        let back = |pose: &Rigid2| DVec2::new(pose.rotation.x, -pose.rotation.y);
        let (mut pivots_mm, mut turn, mut slip_mm) = (Vec::new(), 0.0_f64, 0.0_f64);
        for pair in poses.windows(2) {
            let [a, b] = [back(&pair[0]), back(&pair[1])];
            let [from_mm, to_mm] = [pair[0].translation_mm, pair[1].translation_mm];
            let chord = a - b;
            let conjugate = DVec2::new(chord.x, -chord.y);
            let pole_mm = conjugate.rotate(a.rotate(from_mm) - b.rotate(to_mm)) / chord.length_squared();
            let near = pole_mm.distance(from_mm) < FARTHEST_PIVOT * tip_radius_mm;
            let pivot_mm = if near { pole_mm } else { from_mm };
            turn = turn.max(chord.length());
            slip_mm = slip_mm.max(a.rotate(pivot_mm - from_mm).distance(b.rotate(pivot_mm - to_mm)));
            pivots_mm.push(pivot_mm);
        }
        let pivot_step_mm = pivots_mm.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f64::max);
        Self { poses, pivots_mm, turn, slip_mm, pivot_step_mm }
    }

    /// Number of poses, on the same side of pose `index`, up to the first at which the depth of a point can have grown
    /// by more than `gap_mm`.
    pub(super) fn poses_to_gain(&self, index: usize, p: DVec2, gap_mm: f64) -> usize {
        let pivot_mm = [index.saturating_sub(1), index.min(self.pivots_mm.len() - 1)].map(|i| self.pivots_mm[i]);
        let away_mm = pivot_mm[0].distance(p).max(pivot_mm[1].distance(p));
        let quadratic = 0.5 * self.turn * self.pivot_step_mm;
        let linear = self.slip_mm + self.turn * away_mm - quadratic;
        let within = 2.0 * gap_mm / (linear + (linear * linear + 4.0 * quadratic * gap_mm).sqrt());
        within as usize + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process;
    use crate::process::shaping::ShapingJob;
    use gearcut_core::units::TURN_RAD;
    use std::path::Path;

    fn shipped(name: &str) -> ShapingJob {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/shaping/{name}.toml"));
        ShapingJob::new(process::load(&path, &[]).expect("a shipped scene").scene).expect("it can be cut")
    }

    #[test]
    fn no_depth_grows_faster_than_the_bound_says() {
        for name in ["internal_interfering", "fourier_concave", "elliptical_traditional"] {
            let job = shipped(name);
            let operation = &job.operations[0];
            let pose = |phi: f64| operation.linkage.pose(phi, operation.spec.offset_mm);
            let gear = &job.scene.gear;
            let poses_per_turn = f64::from(48 * gear.teeth);
            let at = |index: u32| {
                let pose = pose(f64::from(index) * TURN_RAD / poses_per_turn);
                Rigid2::new(pose.angle_rad, pose.center_mm)
            };
            let path = CutterPath::new((0..48 * gear.teeth).map(at).collect(), job.cutter.tip_radius_mm);
            // Pivots are poles: they do not slip, and stay near each other.
            assert!(path.slip_mm < 1e-9 && path.pivot_step_mm < gear.module_mm, "{name}: {path:?}");
            let mut tightest = f64::INFINITY;
            for at in (400..path.poses.len() - 400).step_by(97) {
                for (i, angle) in [0.0, 0.3, 1.0, 2.0, 3.0, 4.0, 5.0].into_iter().enumerate() {
                    let p = path.pivots_mm[at] + i as f64 * DVec2::from_angle(angle);
                    let on_tool = |index: usize| path.poses[index].inverse().point(p);
                    for gap_mm in [0.001, 0.03, 0.4, 2.0] {
                        let poses = path.poses_to_gain(at, p, gap_mm).min(200);
                        for other in (1..poses).flat_map(|k| [at - k, at + k]) {
                            let moved_mm = on_tool(at).distance(on_tool(other));
                            assert!(moved_mm <= gap_mm, "{name} {at} {p}: {moved_mm} in {poses}");
                        }
                        if poses < 200 {
                            let moved_mm = on_tool(at).distance(on_tool(at + poses));
                            tightest = tightest.min(gap_mm / moved_mm);
                        }
                    }
                }
            }
            // The bound is of use: somewhere points move about as far.
            assert!(tightest < 2.0, "{name}: {tightest}");
        }
    }
}
