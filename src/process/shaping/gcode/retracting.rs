//! Programs that draw the cutter back for every return stroke.
//!
//! In: a schedule, its retraction, the moments at which the ram passes the ends of the face. Out: knots, four to a
//! double stroke: the cutting stroke leaves the face below, the cutter is drawn back when the return stroke enters it
//! and still is when it leaves it above, and stands where the next stroke cuts when that one enters the face. Where the
//! feed rests during the strokes, the axes rest between the first two and the last two of these; the feed is then made
//! above the face. Straight lines join the knots, as everywhere in these programs.
//!
//! A whole stroke coordinate is the moment at which the cutting stroke passes the middle of the face.

use super::program::{AxisProgram, Knot};
use crate::process::shaping::linkage::StrokeSchedule;
use crate::process::shaping::returns::RetractionPlan;
use crate::process::shaping::returns::motion::{RamTimes, axes_of};
use crate::scene::Post;

/// Shares of the way through the face at which a moving cut is compared with the schedule.
const CUT_SHARES: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];

impl AxisProgram {
    /// The strokes of a schedule with their return strokes, rounded as they will be written for `contour_error_mm`;
    /// with `continuous` the feed goes on during the strokes.
    pub fn retracting(
        schedule: &StrokeSchedule,
        plan: &RetractionPlan,
        ram: &RamTimes,
        tip_radius_mm: f64,
        contour_error_mm: f64,
        continuous: bool,
        post: Post,
    ) -> Self {
        let cut = |stroke: usize, moment: f64| {
            let knot = Knot::of(schedule, if continuous { moment } else { stroke as f64 });
            Knot { stroke: moment, ..knot }
        };
        let back = |stroke: usize, moment: f64| {
            let state = schedule.state(if continuous { moment } else { stroke as f64 });
            let retracted = plan.retracted(schedule.linkage(), &state.pose, state.phi_rad);
            let [psi_c_rad, psi_b_rad, center_distance_mm] = axes_of(&state, &retracted);
            Knot { stroke: moment, psi_c_rad, psi_b_rad, center_distance_mm }
        };
        let last = schedule.count() - 1;
        let mut knots = vec![cut(0, 0.0)];
        for stroke in 0..=last {
            let at = |moment: f64| stroke as f64 + moment;
            knots.extend([
                cut(stroke, at(ram.cut_ends)),
                back(stroke, at(ram.return_begins)),
                back(stroke, at(ram.return_ends)),
            ]);
            if stroke < last {
                knots.push(cut(stroke + 1, at(ram.next_begins)));
            }
        }
        let reach_mm = knots.iter().map(|knot| knot.center_distance_mm).fold(0.0, f64::max) + tip_radius_mm;
        let digits = post.digits(contour_error_mm, reach_mm);
        let knots = knots.iter().map(|knot| knot.rounded(digits)).collect();
        // The ram stops where the last return stroke ends.
        let runs_on = ram.top - ram.return_ends;
        Self { double_strokes_per_minute: 60.0 / schedule.time_s(1.0), knots, runs_on }
    }

    /// Largest displacement from a schedule while the cutter is in the work, mm, and the stroke coordinate.
    pub fn cut_error_mm(
        &self,
        schedule: &StrokeSchedule,
        tip_radius_mm: f64,
        ram: &RamTimes,
        continuous: bool,
    ) -> (f64, f64) {
        let gear = schedule.linkage().gear();
        let last = (schedule.count() - 1) as f64;
        let shares = if continuous { &CUT_SHARES[..] } else { &[0.0] };
        let [before, after] = [1.0 - ram.next_begins, ram.cut_ends];
        (0..schedule.count())
            .flat_map(|stroke| {
                let moment = move |share: f64| stroke as f64 + share * if share < 0.0 { before } else { after };
                shares.iter().map(move |&share| moment(share).clamp(0.0, last))
            })
            .map(|moment| (Knot::of(schedule, moment).displacement_mm(&self.at(moment), gear, tip_radius_mm), moment))
            .fold((0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
    }
}
