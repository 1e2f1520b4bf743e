//! Programs that draw the cutter back for every return stroke.
//!
//! In: a schedule, its retraction, the moments at which the ram passes the ends of the face. Out: knots, four to a
//! double stroke: the cutting stroke leaves the face below, the cutter is drawn back when the return stroke enters it
//! and still is when it leaves it above, and stands where the next stroke cuts when that one enters the face. Where the
//! feed rests during the strokes, the axes rest between the first two and the last two of these; the feed is then made
//! above the face. Straight lines join the knots, as everywhere in these programs.
//!
//! A whole stroke coordinate is the moment at which the cutting stroke passes the middle of the face.
//!
//! A program under test is judged over the whole way of the ram: from one end of the face to the other where the cutter
//! cuts, and back where it is to be drawn back. Straight lines lie farthest off at their ends, so that both ends of the
//! face are looked at and every knot between them.

use super::between::{MOST_TIMES_BACK, off_the_way_mm, sum};
use super::program::{AxisProgram, Knot};
use crate::process::shaping::linkage::StrokeSchedule;
use crate::process::shaping::motion::returns::RetractionPlan;
use crate::process::shaping::motion::returns::motion::{RamTimes, axes_of};
use crate::scene::Post;

/// Shares of the way through the face at which a cut is compared with the schedule, beside the knots within.
const CUT_SHARES: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// Drawn back by less than this share of what is asked, the cutter drags: of the usual half a millimetre these are the
/// hundredths by which ram and cutter spring forward when the cut ends.
const LEAST_SHARE: f64 = 0.1;

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
        let [before, after] = [ram.next_begins - 1.0, ram.cut_ends];
        let off = (0..schedule.count()).flat_map(|stroke| {
            let at = stroke as f64;
            let places = CUT_SHARES.map(|share| at + share.abs() * if share < 0.0 { before } else { after });
            let moments = places.into_iter().chain(self.knots_between(at + before, at + after));
            // The ram starts in the middle of the face.
            moments.filter(|&moment| moment >= 0.0).map(move |moment| {
                let cuts = Knot::of(schedule, if continuous { moment } else { at });
                (cuts.displacement_mm(&self.rested_at(moment), gear, tip_radius_mm), moment)
            })
        });
        largest(off)
    }

    /// How the axes draw the cutter back while the ram returns through the face.
    pub fn drawn_back(
        &self,
        schedule: &StrokeSchedule,
        tip_radius_mm: f64,
        ram: &RamTimes,
        plan: &RetractionPlan,
        continuous: bool,
    ) -> DrawnBack {
        let gear = schedule.linkage().gear();
        let last = schedule.count() - 1;
        let short = (0..=last.min(self.count() - 1)).flat_map(|stroke| {
            let middle = stroke as f64;
            // What the program is off while it cuts is judged there.
            let off = sum(self.at(middle).axes(), Knot::of(schedule, middle).axes(), -1.0);
            let [from, to] = [ram.return_begins, ram.return_ends].map(|moment| middle + moment);
            [from, to].into_iter().chain(self.knots_between(from, to)).map(move |moment| {
                let state = schedule.state(if continuous { moment } else { middle });
                let here = [state.psi_c_rad, state.psi_b_rad, state.center_distance_mm];
                let back = axes_of(&state, &plan.retracted(schedule.linkage(), &state.pose, state.phi_rad));
                let back = sum(back, here, -1.0);
                // A feed that rests during the cut may be made on the way back.
                let next = if continuous { here } else { Knot::of(schedule, (stroke + 1).min(last) as f64).axes() };
                let at = |axes| Knot::at(moment, axes);
                let way = [here, next].map(|axes| at(sum(axes, back, 1.0)));
                let stands = at(sum(self.rested_at(moment).axes(), off, -1.0));
                let further = back.map(|axis| (MOST_TIMES_BACK - 1.0) * axis);
                // The nearest place by the axes is not quite the nearest of the edge.
                let nearest = off_the_way_mm(&stands, &way, further, gear, tip_radius_mm);
                let short_mm = nearest.min(way[0].displacement_mm(&stands, gear, tip_radius_mm));
                (short_mm, moment, at(here).displacement_mm(&way[0], gear, tip_radius_mm))
            })
        });
        let (short_mm, at, asked_mm) =
            short.fold((0.0, 0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst });
        DrawnBack { short_mm, at, asked_mm }
    }

    /// Moments of knots between two moments.
    fn knots_between(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let first = self.knots.partition_point(|knot| knot.stroke <= from);
        self.knots[first..].iter().map(|knot| knot.stroke).take_while(move |&stroke| stroke < to)
    }

    /// Where the axes stand; after the last knot they rest.
    fn rested_at(&self, moment: f64) -> Knot {
        self.at(moment.min(self.last().stroke))
    }
}

/// How far the cutter is from where it is to be drawn back to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnBack {
    /// Largest displacement of its edge in the work while the ram returns through the face, mm; drawing back further is
    /// none.
    pub short_mm: f64,
    /// Stroke coordinate that has it.
    pub at: f64,
    /// Displacement of the edge there by the whole of the drawing back, mm.
    pub asked_mm: f64,
}

impl DrawnBack {
    /// Whether the cutter drags over the flanks that it has cut, or goes into them.
    pub fn drags(&self) -> bool {
        self.short_mm > (1.0 - LEAST_SHARE) * self.asked_mm
    }
}

fn largest(of: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    of.fold((0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
}
