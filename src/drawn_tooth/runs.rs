//! The smooth runs of a drawn contour: where its corners are, and which of its chords are lines.
//!
//! In: points, and how far arcs may pass beside them. Out: chains without corners, which [`super::biarcs`] fits.
//!
//! Arcs keep to points alone. What points cannot say is decided here: a chain that turns much at one point, or whose
//! points would be too coarse for a curve, has a corner there; a chord much longer than those beside it is a line.
//!
//! Road not taken: the kinds of a drawing's entities. A table has none, and drawings come as polylines.

use super::scattered::{Scattered, turn_rad};
use glam::DVec2;

/// A chain that turns by more than this at a point has a corner there, rad: ten times what points of a round of 0.3 mm
/// turn that are 0.005 mm apart, and less than any corner that is meant.
const CORNER_RAD: f64 = 0.2;
/// Points of a curve are not coarser than this: a chain that leaves the chord over a point's neighbours by more has a
/// corner there, mm. Rounds of 0.3 mm may have points 0.1 mm apart, flanks of 8 mm 0.5 mm.
const COARSEST_MM: f64 = 0.02;
/// So does one that turns by so many times what it turns at the points beside, where it leaves that chord by so many
/// tolerances: lines that meet under a few degrees, such as those of a semi-topping or a protuberance.
const KINK_TURNS: f64 = 3.0;
const KINK_TOLERANCES: f64 = 4.0;
/// A chord so many times as long as those beside it is a line of the drawing, not the way between two points of a
/// curve.
const LINE_LENGTHS: f64 = 5.0;
/// Points that a line is given at most.
const MOST_OF_A_LINE: f64 = 500.0;
/// The chain divided at its corners, with points on its lines; each run begins with the point with which the one before
/// ends. Arcs are to pass beside its points by so much at most.
pub fn smooth(points_mm: &[DVec2], tolerance_mm: f64) -> Vec<Vec<DVec2>> {
    let last = points_mm.len() - 1;
    let turns: Vec<f64> = (0..=last)
        .map(|i| {
            if i == 0 || i == last {
                return 0.0;
            }
            turn_rad(points_mm[i] - points_mm[i - 1], points_mm[i + 1] - points_mm[i]).abs()
        })
        .collect();
    let scattered = Scattered::new(points_mm, tolerance_mm);
    let turns_at_once: Vec<Option<f64>> = (0..=last).map(|i| scattered.turn_rad(i)).collect();
    let is_corner = |i: usize| {
        // Of scattered points the one at which the curve turns most among those beside.
        if let Some(turn) = turns_at_once[i] {
            let is_most = scattered.beside(i).all(|j| j == i || turns_at_once[j].is_none_or(|other| other < turn));
            return turn > CORNER_RAD && is_most;
        }
        let [a, b] = [points_mm[i].distance(points_mm[i - 1]), points_mm[i + 1].distance(points_mm[i])];
        let beside_mm = turns[i] * a * b / (a + b);
        // A neighbour that is a corner says nothing of how smooth the chain is.
        let around = [turns[i - 1], turns[i + 1]].into_iter().filter(|&turn| turn <= CORNER_RAD).fold(0.0, f64::max);
        let is_kink = turns[i] > KINK_TURNS * around && beside_mm > KINK_TOLERANCES * tolerance_mm;
        turns[i] > CORNER_RAD || beside_mm > COARSEST_MM || is_kink
    };
    let corners = (1..last).filter(|&i| is_corner(i));
    let ends: Vec<usize> = [0].into_iter().chain(corners).chain([last]).collect();
    ends.windows(2).map(|pair| with_lines(&points_mm[pair[0]..=pair[1]])).collect()
}

/// A run with points on its lines, as near to each other as those beside: arcs keep to points alone.
fn with_lines(run: &[DVec2]) -> Vec<DVec2> {
    let chord_mm = |i: usize| run[i].distance(run[i + 1]);
    let chords = run.len() - 1;
    let points = (0..chords).flat_map(|i| {
        let beside = [i.checked_sub(1), (i + 1 < chords).then_some(i + 1)].into_iter().flatten();
        let parts = match beside.map(chord_mm).reduce(f64::max) {
            Some(beside_mm) if chord_mm(i) > LINE_LENGTHS * beside_mm => {
                (chord_mm(i) / beside_mm).ceil().min(MOST_OF_A_LINE)
            }
            _ => 1.0,
        };
        (0..parts as u32).map(move |part| run[i].lerp(run[i + 1], f64::from(part) / parts))
    });
    points.chain([run[chords]]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{ContourPlace, DrawnTooth, PartLaw, TeethOn};
    use super::*;

    /// Teeth about x in the blade's frame by their left halves (across, out), from tip to root.
    fn tooth(left: &[[f64; 2]]) -> Vec<DVec2> {
        let left: Vec<DVec2> = left.iter().map(|&[across, out]| DVec2::new(out, across)).collect();
        let right = left.iter().rev().map(|at| DVec2::new(at.x, -at.y));
        right.chain(left.iter().copied()).collect()
    }

    fn beside_mm(p: DVec2, polyline: &[DVec2]) -> f64 {
        let from_chord = |pair: &[DVec2]| {
            let along = pair[1] - pair[0];
            let share = ((p - pair[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            p.distance(pair[0] + share * along)
        };
        polyline.windows(2).map(from_chord).fold(f64::INFINITY, f64::min)
    }

    /// Lines of a drawing remain lines, between two points and beside rounds: no place of the edge leaves them.
    #[test]
    fn lines_of_a_drawing_are_kept() {
        const TOLERANCE_MM: f64 = 1e-3;
        const PLACE: ContourPlace =
            ContourPlace { section: "tool", pitch: TeethOn::Circle { teeth: 20, radius_mm: 20.0 } };
        // Straight flanks with a semi-topping under 9 deg.
        let kinked = tooth(&[[1.2, 21.0], [1.7, 19.4], [2.096_324, 18.6]]);
        // Three bumps of 20 um with lines between.
        let bump = |k: f64| [[1.725 + 0.1 * k, 19.32 - 0.32 * k], [1.74 + 0.1 * k, 19.22 - 0.32 * k]];
        let bumps: Vec<[f64; 2]> = (0..3).flat_map(|k| bump(f64::from(k))).collect();
        let bumpy = tooth(&[&[[1.2, 21.0]][..], &bumps, &[[2.1, 18.0]]].concat());
        // A flank of 1.9 mm beside a round of 0.3 mm with points 5 deg apart.
        let round = (0..=14).map(|i| f64::from(5 * i).to_radians().sin_cos());
        let mut rounded: Vec<[f64; 2]> = round.map(|(sin, cos)| [1.0 + 0.3 * sin, 20.7 + 0.3 * cos]).collect();
        let (sin, cos) = 70_f64.to_radians().sin_cos();
        let last = rounded[rounded.len() - 1];
        rounded.push([last[0] + 1.9 * cos, last[1] - 1.9 * sin]);
        for points in [kinked, bumpy, tooth(&rounded)] {
            let drawn = DrawnTooth::through(&points, PLACE, TOLERANCE_MM).expect("a tooth");
            // An arc of the round is off the chords of its own points by 0.3 um.
            let places =
                drawn.parts.iter().flat_map(|part| (0..=40).map(|i| part.law.at(f64::from(i) / 40.0).point_mm));
            let off_mm = places.map(|at| beside_mm(at, &points)).fold(0.0, f64::max);
            assert!(off_mm < TOLERANCE_MM, "{off_mm} mm: {:#?}", drawn.parts);
            let lines = drawn.parts.iter().filter(|part| matches!(part.law, PartLaw::Line { .. })).count();
            assert!(lines >= 3, "{lines} lines");
        }
    }

    /// Points of a curve that are not too coarse are no corners.
    #[test]
    fn points_of_a_curve_are_one_run() {
        let hollow = (0..=20).map(|i| f64::from(i) / 20.0).map(|share| [1.0 + share * share, 21.0 - 2.0 * share]);
        let points = tooth(&hollow.collect::<Vec<_>>());
        assert_eq!(smooth(&points, 5e-4).len(), 3, "two flanks and a tip");
    }
}
