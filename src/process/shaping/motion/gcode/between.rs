//! Where the axes of a program go between two strokes.
//!
//! In: a program, and how the scene's axes draw the cutter back, where they do. Out: how far the program lies off the
//! straight way from one of its strokes to the next, and where. Law: straight lines lie farthest off at their ends, so
//! that knots are looked at, each against its nearest place on the way. Farther out along the line of centres than the
//! way the cutter is clear of the work, which is no distance; nor is any part of the scene's own drawing back, or what
//! lies where the scene has the cutter at that moment: an infeed may end between two strokes.
//!
//! Road not taken: the scene's own path alone. A stroke left out would move all later ones to other moments, and what
//! lies between them with them; strokes are told one by one already.

use super::program::{AxisProgram, Knot, WHOLE_STROKE};
use crate::process::shaping::linkage::StrokeSchedule;
use crate::process::shaping::motion::returns::RetractionPlan;
use crate::process::shaping::motion::returns::motion::axes_of;
use gearcut_core::gear::GearKind;

/// A cutter may be drawn back this many times as far as the scene does: some two millimetres, in which the law still
/// leads it out of the space.
pub(super) const MOST_TIMES_BACK: f64 = 4.0;

/// Axis positions or their differences, in the order of [`Knot::axes`].
type Axes = [f64; 3];

impl AxisProgram {
    /// Largest displacement of the cutter's edge between two strokes from the straight way from the one to the other,
    /// mm, and the stroke coordinate; `back` where the axes draw the cutter back.
    pub fn between_mm(
        &self,
        schedule: &StrokeSchedule,
        tip_radius_mm: f64,
        back: Option<&RetractionPlan>,
    ) -> (f64, f64) {
        let gear = schedule.linkage().gear();
        let drawn_back = |stroke: usize| {
            let state = schedule.state(stroke as f64);
            let plan = back?;
            let retracted = axes_of(&state, &plan.retracted(schedule.linkage(), &state.pose, state.phi_rad));
            Some(sum(retracted, [state.psi_c_rad, state.psi_b_rad, state.center_distance_mm], -1.0))
        };
        let drawn_back: Vec<Axes> = (0..schedule.count()).map_while(drawn_back).collect();
        let back_at = |stroke: f64| drawn_back.get(stroke as usize).or(drawn_back.last()).copied().unwrap_or_default();
        // Drawn back as far as the scene does, or further.
        let off_the_way_mm = |knot: &Knot, way: &[Knot; 2], back: Axes| {
            [1.0, MOST_TIMES_BACK]
                .map(|times| off_the_way_mm(knot, way, back.map(|axis| times * axis), gear, tip_radius_mm))
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        let own = |stroke: f64| Knot::of(schedule, stroke.min(schedule.count() as f64));
        // The axes go to no further stroke after the last knot.
        let last = (self.last().stroke + WHOLE_STROKE).floor();
        let off_mm = |knot: &Knot, stroke: f64| {
            let way = [stroke, stroke + 1.0].map(|stroke| self.at(stroke.min(last)));
            off_the_way_mm(knot, &way, back_at(stroke))
        };
        let off = self.knots.iter().map(|knot| {
            // A knot on a whole stroke may belong to the way before it or after it.
            let beside = [-WHOLE_STROKE, WHOLE_STROKE].map(|by| (knot.stroke + by).floor().max(0.0));
            let off_the_scene = off_the_way_mm(knot, &[own(knot.stroke); 2], back_at(knot.stroke));
            (beside.map(|stroke| off_mm(knot, stroke)).into_iter().fold(off_the_scene, f64::min), knot.stroke)
        });
        off.fold((0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
    }
}

/// Displacement of a knot from its nearest place on the way from one knot to another, mm.
pub(super) fn off_the_way_mm(
    knot: &Knot,
    [from, to]: &[Knot; 2],
    back: Axes,
    gear: GearKind,
    tip_radius_mm: f64,
) -> f64 {
    let out = gear.tip_sign();
    // Beyond the axis of a ring the cutter comes to the teeth on the other side.
    let clears =
        |of: &Knot| knot.center_distance_mm > 0.0 && out * (knot.center_distance_mm - of.center_distance_mm) > 0.0;
    // Where the cutter is clear, the angles alone say how far it has gone.
    let weights = [tip_radius_mm, tip_radius_mm, if clears(from) && clears(to) { 0.0 } else { 1.0 }];
    let way = sum(to.axes(), from.axes(), -1.0);
    let gone_by = sum(knot.axes(), from.axes(), -1.0);
    let (gone, drawn) = shares(gone_by, way, back, weights);
    let mut nearest = Knot::at(knot.stroke, sum(sum(from.axes(), way, gone), back, drawn));
    if clears(&nearest) {
        nearest.center_distance_mm = knot.center_distance_mm;
    }
    nearest.displacement_mm(knot, gear, tip_radius_mm)
}

/// `a + times b`.
pub(super) fn sum(a: Axes, b: Axes, times: f64) -> Axes {
    std::array::from_fn(|axis| a[axis] + times * b[axis])
}

/// Which shares of two straight ways together lead nearest to a place, lengths of the axes weighted: both between their
/// ends, or one at an end.
fn shares(place: Axes, way: Axes, back: Axes, weights: Axes) -> (f64, f64) {
    let dot = |a: Axes, b: Axes| (0..3).map(|axis| weights[axis] * weights[axis] * a[axis] * b[axis]).sum::<f64>();
    let share =
        |place: Axes, of: Axes| if dot(of, of) > 0.0 { (dot(place, of) / dot(of, of)).clamp(0.0, 1.0) } else { 0.0 };
    let at_ends = [0.0, 1.0]
        .into_iter()
        .flat_map(|end| [(share(sum(place, back, -end), way), end), (end, share(sum(place, way, -end), back))]);
    let determinant = dot(way, way) * dot(back, back) - dot(way, back) * dot(way, back);
    let of = |one: Axes, other: Axes| {
        (dot(place, one) * dot(other, other) - dot(place, other) * dot(one, other)) / determinant
    };
    // Ways in one direction give no number here, and one of them is at an end.
    let inside = Some((of(way, back), of(back, way)));
    let inside = inside.filter(|&(gone, drawn)| [gone, drawn].iter().all(|share| (0.0..=1.0).contains(share)));
    let off2 = |&(gone, drawn): &(f64, f64)| {
        let off = sum(sum(place, way, -gone), back, -drawn);
        dot(off, off)
    };
    at_ends.chain(inside).min_by(|a, b| off2(a).total_cmp(&off2(b))).unwrap_or_default()
}
