//! What stands out of a gear and is no error of a machine: single teeth, steps along the face, hollow profiles.
//!
//! In: a model, measured deviations and their noise. Out: [`StandingOut`]s, which the model fits beside all sources.
//!
//! **Law.** Everything that could stand out at the measured places ([`StandingShape`]) is chosen among the sources,
//! by the same law (`selection`): what explains most comes first, and leaves where others have made it idle. What is
//! left of it stands out by a multiple of what then remains unexplained, and of single teeth there are few, or else
//! none is singled out.
//!
//! Road not taken: medians of neighbouring teeth. An eccentric gear of twelve teeth has no neighbours that are alike.

use super::fit::LinearFit;
use super::selection::Selection;
use super::shapes::{StandingOut, StandingShape};
use super::{ErrorModel, Noise, Without};
use crate::influence::gear_grid::evenly;
use crate::influence::measured::MeasuredPoint;
use gearcut_core::terms::Side;
use std::collections::{BTreeMap, BTreeSet};

/// Most places along the face at which a step is looked for.
const MOST_STEPS: usize = 32;
/// Places that a flank needs at least along its profile for a bend, and along the face for a step.
const LEAST_PLACES: usize = 5;
/// What stands out is larger than this many times the root mean square of what is left unexplained with it.
const STANDS_OUT: f64 = 3.0;
/// Of this share of the measured teeth at most single ones are spoken of.
const MOST_SINGLE: f64 = 0.25;

/// Everything that could stand out at these places.
fn shapes(points: &[MeasuredPoint]) -> Vec<StandingShape> {
    let teeth: BTreeSet<u32> = points.iter().map(|point| point.tooth).collect();
    let places = |of: fn(&MeasuredPoint) -> f64, tooth: Option<u32>| {
        let own = points.iter().filter(|point| tooth.is_none_or(|tooth| tooth == point.tooth));
        let mut places: Vec<f64> = own.map(of).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    };
    let mut found: Vec<StandingShape> = teeth.iter().map(|&tooth| StandingShape::Tooth(tooth)).collect();
    for tooth in std::iter::once(None).chain(teeth.iter().copied().map(Some)) {
        if places(|point| point.u_mm, tooth).len() >= LEAST_PLACES {
            found.push(StandingShape::Profile(tooth));
        }
        let along_mm = places(|point| point.v_mm, tooth);
        if along_mm.len() >= LEAST_PLACES {
            // Two places at least on either side: one alone is no step.
            let between: Vec<f64> =
                along_mm[1..along_mm.len() - 1].windows(2).map(|of| 0.5 * (of[0] + of[1])).collect();
            let last = between.len() - 1;
            let mut taken: Vec<usize> = evenly([0.0, last as f64], MOST_STEPS.min(between.len()))
                .into_iter()
                .map(|place| place.round() as usize)
                .collect();
            taken.dedup();
            found.extend(taken.into_iter().map(|place| StandingShape::Step(tooth, between[place])));
        }
    }
    found
}

/// Ends of the measured profile of every flank, mm.
type Ends = BTreeMap<(u32, Side), [f64; 2]>;

fn ends_mm(points: &[MeasuredPoint]) -> Ends {
    let mut ends = Ends::new();
    for point in points {
        let [low, high] = ends.entry((point.tooth, point.side)).or_insert([point.u_mm; 2]);
        (*low, *high) = (low.min(point.u_mm), high.max(point.u_mm));
    }
    ends
}

fn laid(shape: StandingShape, points: &[MeasuredPoint], ends_mm: &Ends) -> StandingOut {
    let um_on = |side: Side| {
        let um = |point: &MeasuredPoint| {
            if point.side == side { shape.um_at(point, ends_mm[&(point.tooth, side)]) } else { 0.0 }
        };
        points.iter().map(um).collect()
    };
    StandingOut { shape, um_per_um: [Side::Left, Side::Right].map(um_on) }
}

/// What stands out of measured deviations, um, beside all that the sources of a model about its scene explain.
pub(super) fn find(
    model: &ErrorModel,
    points: &[MeasuredPoint],
    measured_um: &[f64],
    noise: &Noise,
) -> Vec<StandingOut> {
    let without = Without::default();
    let fit = LinearFit::new(model, measured_um, noise, &without);
    let ends_mm = ends_mm(points);
    let all: Vec<StandingOut> = shapes(points).into_iter().map(|shape| laid(shape, points, &ends_mm)).collect();
    let own = fit.selection();
    let (sources, _) = fit.candidates_and_hidden();
    let over_noise = |um: &Vec<f64>| {
        let mut column = noise.over(um, |_| true);
        // Nothing of it is held (`free`).
        column.resize(own.off.len(), 0.0);
        column
    };
    let shaped = all.iter().map(|of| of.um_per_um.iter().map(over_noise).collect());
    let columns: Vec<Vec<Vec<f64>>> = own.columns.iter().cloned().chain(shaped).collect();
    let selection = Selection { columns: &columns, ..own };
    // Sources come first, then what may stand out.
    let first = own.columns.len();
    let candidates: Vec<usize> = sources.into_iter().chain(first..columns.len()).collect();
    let chosen = selection.select(&candidates);
    let basis = selection.basis(&chosen);
    let solution = basis.solve(selection.off);
    let left_um = noise.value_um * (solution.chi_square / solution.freedom.max(1) as f64).sqrt();
    let is_tooth = |i: usize| matches!(all[i - first].shape, StandingShape::Tooth(_));
    let own: Vec<usize> = chosen.iter().copied().filter(|&i| i >= first).collect();
    let teeth: BTreeSet<u32> = points.iter().map(|point| point.tooth).collect();
    let single = own.iter().filter(|&&i| is_tooth(i)).count();
    let are_single = single as f64 <= MOST_SINGLE * teeth.len() as f64;
    let stands_out = |i: usize| {
        let others: Vec<usize> = chosen.iter().copied().filter(|&other| other != i).collect();
        // What nothing else explains of it, root mean square over its own places.
        let gain = selection.left(&others) - solution.chi_square;
        let places = all[i - first].um_per_um.iter().flatten().filter(|um| **um != 0.0).count();
        noise.value_um * (gain / places as f64).sqrt() > STANDS_OUT * left_um && (are_single || !is_tooth(i))
    };
    let mut kept: Vec<usize> = own.into_iter().filter(|&i| stands_out(i)).collect();
    kept.sort_unstable();
    kept.into_iter().map(|i| all[i - first].clone()).collect()
}
