//! How much of the returning cutter stands in the work.
//!
//! In: a retracted pose. Out: the area that the cutter has in common with what its operation leaves, mm2.
//!
//! Lines across each cutter tooth are followed in steps of the distance from the nearest surface, which no step can
//! pass; what lies in material is added up. Thin slivers along a flank are as exact as thick ones. Road not taken: the
//! depth along the edge times its length, which counts twice where the overlap is as thick as it is long.

use super::clearance::ReturnRoom;
use gearcut_core::frame::Rigid2;
use glam::DVec2;

/// Distance of the lines, in modules.
const LINE_SPACING_MODULES: f64 = 0.005;
/// Least step along them, mm.
const LEAST_STEP_MM: f64 = 2e-5;
/// Depth at which the search for the deepest pose ends, mm: outside the material steps need not be longer.
const LONGEST_STEP_MM: f64 = 0.1;

impl ReturnRoom {
    /// Area that the retracted cutter has in common with what the operation leaves, mm2; `retracted` is its pose (gear
    /// from cutter) after the stroke at a place, `beyond_mm` says how far a point lies outside the uncut blank,
    /// negative inside.
    pub fn overlap_mm2(&self, place: usize, retracted: &Rigid2, beyond_mm: impl Fn(DVec2) -> f64) -> f64 {
        let edge = self.edge_mm.as_slice();
        let spacing_mm = LINE_SPACING_MODULES * self.module_mm;
        let (low_mm, high_mm) = edge.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), p| (a.min(p.x), b.max(p.x)));
        let lines = ((high_mm - low_mm) / spacing_mm) as usize;
        self.swept
            .tools_from_blades()
            .map(|tool_from_blade| {
                let work_from_blade = retracted.after(&tool_from_blade);
                // Positive outside the material, by at most the distance from it.
                let outside_mm = |x_mm: f64, y_mm: f64| {
                    let p = work_from_blade.point(DVec2::new(x_mm, y_mm));
                    let beyond_mm = beyond_mm(p);
                    if beyond_mm > 0.0 {
                        return beyond_mm;
                    }
                    self.swept.covered_mm(place, &tool_from_blade, p, [LONGEST_STEP_MM; 2])[0].max(beyond_mm)
                };
                // An overlap comes in through the edge.
                if !edge.iter().any(|corner_mm| outside_mm(corner_mm.x, corner_mm.y) < 0.0) {
                    return 0.0;
                }
                let length_mm = |line: usize| {
                    let x_mm = high_mm - (line as f64 + 0.5) * spacing_mm;
                    let half_mm = half_width_mm(edge, x_mm);
                    length_inside_mm(|y_mm| outside_mm(x_mm, y_mm), [-half_mm, half_mm])
                };
                (0..lines).map(length_mm).sum::<f64>() * spacing_mm
            })
            .sum()
    }
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
