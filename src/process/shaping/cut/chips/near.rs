//! Passes near a field of rays, and how the blade moves during each of them.
//!
//! In: the job and a field. Out: its passes in order of time, with the poses at which the blade's edge is looked at.
//!
//! **The law.** Where the axes rest during a stroke, a guide or a wobble shifts the cutter by micrometres on its way
//! along the face and does not turn it. Such a pass **drifts**: it has one pose, in the middle of the face, and what it
//! is shifted by at both ends. One look at the edge then answers for all phases, as for a frozen stroke
//! ([`super::shared_segment`]). Every other stroke that moves has its pose at each phase. Bounds take its way from
//! phase to phase for a parabola. Noise of the axes makes cubics of it: what these leave parabolas by widens all
//! bounds.

use crate::process::shaping::{PreparedOperation, ShapingJob};
use gearcut_core::dexel::field::{Column, Field};
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::planar::near::{MAX_PHASES, NearPass, PhasePoses, near_passes};
use glam::DVec2;

/// One pass that comes near the field.
pub(super) struct Near {
    pub operation: usize,
    pub stroke: usize,
    pub blade: u32,
    /// Poses of the work in the blade frame at which the edge is looked at: both ends and the middle of the blade's
    /// travel along the face, or the middle alone.
    pub poses: PhasePoses,
    /// Shifts of the work against the one pose at the phases, in the blade frame, mm, if the pass drifts.
    pub drift_mm: Option<[DVec2; MAX_PHASES]>,
    /// How far the blade moves meanwhile at most, mm.
    pub travel_mm: f64,
    /// How far it leaves parabolas through its places at the phases, mm: as noise of the axes lets it.
    pub wander_mm: f64,
}

impl Near {
    /// A pass near a field that lies within `reach_mm` of `center_mm`.
    fn new(operation: usize, pass: &NearPass, center_mm: DVec2, reach_mm: f64) -> Self {
        let middle = *pass.middle();
        let shift_mm = |pose: &Rigid2| pose.point(center_mm) - middle.point(center_mm);
        let turn_mm = |pose: &Rigid2| (pose.rotation - middle.rotation).length() * reach_mm;
        let motion_mm = |pose: &Rigid2| shift_mm(pose).length() + turn_mm(pose);
        let NearPass { stroke, blade, blade_from_work: poses, wander_mm } = *pass;
        let travel_mm = poses.iter().map(motion_mm).fold(0.0, f64::max) + wander_mm;
        let drift_mm = poses.looks().1.into_inner().ok();
        let poses = if drift_mm.is_some() { PhasePoses::frozen(middle) } else { poses };
        Self { operation, stroke, blade, poses, drift_mm, travel_mm, wander_mm }
    }

    /// A column's ray in the blade frame, from its first point on, where the edge is looked at: once or at each phase.
    pub fn looks<'a>(&'a self, ray: &'a Column) -> impl Iterator<Item = [DVec2; 2]> + 'a {
        self.poses.iter().map(|pose| [pose.point(ray.origin_mm), pose.direction(ray.normal)])
    }
}

/// All passes of all operations near a field, in order of time.
pub(super) fn passes_near(job: &ShapingJob, field: &Field) -> Vec<Near> {
    let (center_mm, reach_mm) = Field::circle(&field.columns);
    let of_operation = |(operation, prepared): (usize, &PreparedOperation)| -> Vec<Near> {
        let strokes = &prepared.strokes;
        let near = near_passes(strokes, &job.cutter, center_mm, reach_mm);
        near.iter().map(|pass| Near::new(operation, pass, center_mm, reach_mm)).collect()
    };
    job.operations.iter().enumerate().flat_map(of_operation).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::deciding::{ColumnPasses, deciding};
    use super::super::flank::{in_every_row, last_chips_of};
    use super::super::rays::{FieldPasses, Pairing};
    use super::super::segments::Segments;
    use super::super::shared_segment::Beside;
    use super::*;
    use crate::process::load;
    use gearcut_core::terms::Side;
    use std::path::Path;

    /// Guide and wobble shift the cutter by micrometres along the face, with a bow.
    pub const GUIDED: [&str; 3] = [
        "machine.errors.guide.tangential_um_per_100mm=25",
        "machine.errors.guide.radial_bow_um=2",
        "mounting.wobble_um_per_100mm=10",
    ];

    /// Axes move at random meanwhile, which turns the cutter as well.
    pub const NOISY: [&str; 3] = [
        "machine.errors.work.noise_arcsec=1",
        "machine.errors.work.noise_bandwidth_hz=2",
        "machine.errors.center_distance.noise_um=1",
    ];

    /// The paper's gear.
    pub fn job(settings: &[&str]) -> ShapingJob {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &settings).expect("the shipped scene");
        ShapingJob::new(scene.scene).expect("the shipped gear")
    }

    fn field(job: &ShapingJob, tooth: u32, side: Side) -> Field {
        let field = job.flank_field(job.target_flank(tooth, side));
        let columns: Vec<usize> = (0..field.columns.len()).step_by(31).collect();
        let last = field.rows() - 1;
        field.at([&columns, &[0, last / 6, last / 2, 5 * last / 6, last]])
    }

    /// Chips that differ, as bits, from those of all passes, and all; of passes that are changed before.
    fn differing(job: &ShapingJob, change: impl Fn(&mut Near) + Copy) -> [usize; 2] {
        let (mut differing, mut all) = (0, 0);
        for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
            let field = field(job, tooth, side);
            let passes = FieldPasses::of_smooth_edges(job, &field, Pairing::All).with_each(change);
            let chosen = last_chips_of(&passes, &field, deciding, in_every_row, |_, _| true);
            let of_all = |column: &mut ColumnPasses, end| column.all(0..end);
            let of_all = last_chips_of(&passes, &field, of_all, in_every_row, |_, _| true);
            for (chosen, of_all) in chosen.iter().zip(&of_all) {
                let thickness = chosen.thickness_mm.iter().zip(&of_all.thickness_mm);
                let pairs = thickness.zip(chosen.passes.iter().zip(&of_all.passes));
                differing += pairs.filter(|((a, b), (p, q))| a.to_bits() != b.to_bits() || p != q).count();
                all += chosen.passes.len();
            }
        }
        [differing, all]
    }

    #[test]
    fn one_look_leaves_the_chips_of_all_passes() {
        for settings in [&GUIDED[..], &NOISY, &[]] {
            let [differing, all] = differing(&job(settings), |_| ());
            assert!(differing == 0 && all > 80, "{settings:?}: {differing} of {all}");
        }
    }

    /// Planted: bounds know of parabolas alone.
    #[test]
    fn noise_that_is_taken_for_a_parabola_loses_chips() {
        let [differing, all] = differing(&job(&NOISY), |pass| pass.wander_mm = 0.0);
        assert!(differing > 4, "{differing} of {all}");
    }

    /// Planted: what passes are shifted by is forgotten, or has the wrong sign.
    #[test]
    fn a_shift_that_is_wrong_loses_chips() {
        let job = job(&GUIDED);
        let forgotten = differing(&job, |pass| pass.drift_mm = None);
        let turned = differing(&job, |pass| pass.drift_mm = pass.drift_mm.map(|mm| mm.map(|mm| -mm)));
        println!("forgotten: {forgotten:?}, turned: {turned:?}");
        for [differing, all] in [forgotten, turned] {
            assert!(40 * differing > all, "{differing} of {all}");
        }
    }

    /// Bounds from one look against those from a look at each phase.
    #[test]
    fn a_pass_that_drifts_has_the_bounds_of_one_that_moves() {
        let job = job(&GUIDED);
        let field = field(&job, 4, Side::Left);
        let segments = Segments::new(job.cutter.edge(), std::slice::from_ref(job.cutter.edge()));
        let (mut compared, mut worst_mm) = (0, 0.0_f64);
        for drifting in passes_near(&job, &field) {
            let drift_mm = drifting.drift_mm.expect("a pass that drifts");
            let [pose] = drifting.poses[..] else { panic!("{} poses", drifting.poses.len()) };
            let shifted = |shift_mm| Rigid2 { translation_mm: pose.translation_mm + shift_mm, ..pose };
            let poses = PhasePoses::moving(drift_mm.map(shifted));
            let moving = Near { poses, drift_mm: None, ..drifting };
            for ray in &field.columns {
                let set = segments.meeting(&drifting, ray, 0.0);
                let bounds = |pass: &Near| segments.reaching(0, pass, ray, set);
                let [one, three] = [&drifting, &moving].map(bounds);
                assert_eq!(one.is_some(), three.is_some());
                let Some((one, three)) = one.zip(three) else { continue };
                // What surely enters is no miss.
                let is_sure = one.highest.0.iter().any(|height_mm| height_mm.is_finite());
                assert!(!(is_sure && segments.misses(&drifting, ray, one.segments, Beside::ALONE)));
                for (one, three) in [(one.lowest, three.lowest), (one.highest, three.highest)] {
                    let both = one.0.into_iter().zip(three.0).filter(|(_, three)| three.is_finite());
                    worst_mm = both.map(|(one, three)| (one - three).abs()).fold(worst_mm, f64::max);
                }
                compared += 1;
            }
        }
        println!("{compared} bounds, {worst_mm:.1e} mm");
        assert!(compared > 1000 && worst_mm < 1e-7, "{compared} bounds, {worst_mm} mm");
    }
}
