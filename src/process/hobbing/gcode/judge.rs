//! A program under test against the linkage of its operation.
//!
//! In: a prepared operation with its program. Out: a [`ProgramUnderTest`]. Law: the program is compared at the moments
//! at which one is written, and at its own knots, each with the linkage at the same time and at the same angle of the
//! hob; the nearer of both counts. A program that runs at another speed is thus not far off, its time says so; nor is
//! one whose long blocks leave a billionth of their time.

use super::program::{ContactZone, exact, sample_times_s, shortest_block_s};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::commanded::HobbingCommand;
use crate::process::hobbing::job::PreparedHobbing;
use crate::steps::program_under_test::ProgramUnderTest;
use rayon::prelude::*;

/// The program of an operation against its linkage, if one is cut.
pub fn judged(job: &HobbingJob, operation: &PreparedHobbing) -> Option<ProgramUnderTest> {
    let (program, linkage) = (operation.program.as_ref()?, &operation.linkage);
    let zone = ContactZone::new(job, operation);
    let [own, scene] = [Some(program), None].map(|program| HobbingCommand { linkage, program }.turned_rad());
    let shared = [own[0].max(scene[0]), own[1].min(scene[1])];
    let scene_rad = scene[1] - scene[0];
    let shared_rad = (shared[1] - shared[0]).max(0.0);
    let off_mm = |hob_rad: f64| {
        let [time_s, linkage_s] =
            [operation.commanded().time_at_hob_angle(hob_rad), linkage.time_at_hob_angle(hob_rad)];
        let axes = program.at(time_s);
        let off = [time_s, linkage_s].map(|time_s| zone.displacement_mm(&exact(linkage, time_s), &axes));
        (off[0].min(off[1]), time_s)
    };
    let within = |hob_rad: &f64| *hob_rad >= shared[0] && *hob_rad <= shared[1];
    let samples = sample_times_s(linkage, shortest_block_s(job, linkage)).map(|time_s| exact(linkage, time_s)[0]);
    let knots = program.knots.par_iter().map(|knot| knot.axes[0]);
    let (distance_mm, at_s) = samples
        .chain(knots)
        .filter(within)
        .map(off_mm)
        .reduce(|| (0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst });
    let lasts_s = |of: HobbingCommand| of.time_at_hob_angle(shared[1]) - of.time_at_hob_angle(shared[0]);
    Some(ProgramUnderTest {
        distance_mm,
        at_s,
        missing: 1.0 - shared_rad / scene_rad,
        beyond: (own[1] - own[0] - shared_rad) / scene_rad,
        time_s: [Some(program), None].map(|program| lasts_s(HobbingCommand { linkage, program })),
        exceeded: program.exceeded(&job.limits, &linkage.corners_s()),
    })
}
