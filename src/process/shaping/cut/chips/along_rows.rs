//! Chips in the rows of a column, from the courses of its passes along the face.
//!
//! In: the passes that can decide on a column's last chip, and the rows that are asked for. Out: what they leave in
//! these rows, but for those that need a look of their own.
//!
//! **The law.** Where the axes rest during strokes, a pass moves along the face by what guide, wobble and noise make of
//! it: micrometres, as a cubic in the phase ([`gearcut_core::passes::planar::strokes`]). The height at which its edge
//! enters a ray is a cubic as well, nearly: over micrometres an edge bends by a nanometre. So each pass is looked at
//! where that cubic has its nodes, and at both ends of the face: there a cubic misses what is of fourth or fifth degree
//! by as much as anywhere. Rows take heights and cosines from the cubics, pass by pass in order of time.
//!
//! **The bound.** A cubic that misses an end by more than [`MISSED_MM`] is not used; twice that is allowed for between
//! nodes. In a row where two passes, or a pass and the blank, come so close that this could change which one lies
//! lower, and where a pass may matter that has no cubic (it comes to other segments of the edge, or misses the ray in a
//! part of the face), nothing is said. So passes and parts of the edge are those of a look in every row, and
//! thicknesses are the same within a nanometre.

use super::rays::{Chosen, EdgeEntry, FieldPasses, RaySurface};
use crate::process::shaping::tool::edge_polygon::EdgeSide;
use gearcut_core::dexel::field::Column;
use gearcut_core::passes::planar::strokes::{NODES, cubic_through};

/// A cubic may miss the heights at the ends of the face by so much, mm: a twentieth of a nanometre.
const MISSED_MM: f64 = 5e-8;
/// The same for cosines: of a chip of two millimetres a tenth of a nanometre.
const MISSED_COSINE: f64 = 5e-8;
/// Two passes that come closer than this, mm, might change places: each may be off by twice [`MISSED_MM`].
const CLOSE_MM: f64 = 4.0 * MISSED_MM;

/// A pass over a ray, as cubics in the phase.
struct SmoothCourse {
    height_mm: [f64; 4],
    cosine: [f64; 4],
    side: EdgeSide,
}

/// What looks at a pass show.
enum PassAlongRows {
    /// It does not come to the ray.
    Nowhere,
    /// It comes with one segment of its edge, all along the face.
    Smooth(SmoothCourse),
    /// Neither.
    Uneven,
}

/// What is known of a row so far.
#[derive(Clone)]
struct RowSurface {
    surface_mm: f64,
    /// Where it stood before the last pass.
    before_mm: f64,
    /// The last pass that lowered it.
    last: Option<usize>,
    /// Whether another one comes so close to it that it might be the last one.
    is_close: bool,
}

fn cubic_at([c0, c1, c2, c3]: &[f64; 4], tau: f64) -> f64 {
    c0 + tau * (c1 + tau * (c2 + tau * c3))
}

/// Looks at a pass over a ray.
fn seen(passes: &FieldPasses, pass: &Chosen, ray: &Column) -> PassAlongRows {
    let at = |tau: f64| passes.entry_at(pass, tau, ray, ray.blank_mm);
    let (nodes, ends) = (NODES.map(at), [-1.0, 1.0].map(|tau| (tau, at(tau))));
    if nodes.iter().chain(ends.iter().map(|(_, end)| end)).all(Option::is_none) {
        return PassAlongRows::Nowhere;
    }
    let [Some(first), Some(second), Some(third), Some(fourth)] = nodes else { return PassAlongRows::Uneven };
    let nodes = [first, second, third, fourth];
    // Kernels record the lowest height of a ray for all that is below it.
    let is_like_first = |entry: &EdgeEntry| entry.segment == first.segment && entry.height_mm > ray.low_mm;
    let height_mm = cubic_through(&nodes.map(|entry| entry.height_mm));
    let cosine = cubic_through(&nodes.map(|entry| entry.cosine));
    let is_met = |(tau, end): (f64, Option<EdgeEntry>)| {
        end.is_some_and(|end| {
            is_like_first(&end)
                && (cubic_at(&height_mm, tau) - end.height_mm).abs() <= MISSED_MM
                && (cubic_at(&cosine, tau) - end.cosine).abs() <= MISSED_COSINE
        })
    };
    if nodes.iter().all(is_like_first) && ends.into_iter().all(is_met) {
        PassAlongRows::Smooth(SmoothCourse { height_mm, cosine, side: first.side })
    } else {
        PassAlongRows::Uneven
    }
}

/// What passes leave on a ray in some rows; `None` where a look at the row itself must say it.
pub(super) fn surfaces(
    passes: &FieldPasses,
    chosen: &[Chosen],
    ray: &Column,
    rows: &[usize],
) -> Vec<Option<RaySurface>> {
    let uncut = RowSurface { surface_mm: ray.blank_mm, before_mm: ray.blank_mm, last: None, is_close: false };
    let mut found = vec![uncut; rows.len()];
    let looks: Vec<PassAlongRows> = chosen.iter().map(|pass| seen(passes, pass, ray)).collect();
    for (index, (pass, look)) in chosen.iter().zip(&looks).enumerate() {
        let PassAlongRows::Smooth(course) = look else { continue };
        for (found, &row) in found.iter_mut().zip(rows) {
            let height_mm = cubic_at(&course.height_mm, passes.tau(pass, row));
            let lowered_mm = found.surface_mm - height_mm;
            if lowered_mm > 0.0 {
                let before_mm = found.surface_mm;
                let is_close = lowered_mm < CLOSE_MM;
                *found = RowSurface { surface_mm: height_mm, before_mm, last: Some(index), is_close };
            } else {
                found.is_close |= lowered_mm > -CLOSE_MM;
            }
        }
    }
    for (pass, _) in chosen.iter().zip(&looks).filter(|(_, look)| matches!(look, PassAlongRows::Uneven)) {
        for (found, &row) in found.iter_mut().zip(rows) {
            // Below the surface that the last chip was cut from it might be that surface, or the last one itself.
            found.is_close |= passes.lowest_mm(pass, row) < found.before_mm + CLOSE_MM;
        }
    }
    let told = |(found, &row): (RowSurface, &usize)| {
        if found.is_close {
            return None;
        }
        let last = found.last.map(|index| (&chosen[index], &looks[index]));
        let Some((pass, PassAlongRows::Smooth(course))) = last else { return Some(RaySurface::uncut(ray)) };
        let thickness_mm = (found.before_mm - found.surface_mm) * cubic_at(&course.cosine, passes.tau(pass, row));
        Some(RaySurface { height_mm: found.surface_mm, thickness_mm, side: Some(course.side), pass: pass.id })
    };
    found.into_iter().zip(rows).map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::super::deciding::deciding;
    use super::super::flank::{in_every_row, in_rows, last_chips_of};
    use super::super::near::tests::{GUIDED, NOISY, job};
    use super::super::rays::Pairing;
    use super::*;
    use crate::measure::LastChips;
    use gearcut_core::terms::Side;

    /// Rays whose pass or side differs from that of a look in every row, those that are thicker or thinner by more than
    /// a nanometre, and all.
    fn differing(
        settings: &[&str],
        follow: fn(&FieldPasses, &[Chosen], &Column, &[usize]) -> Vec<RaySurface>,
    ) -> [usize; 3] {
        let job = job(settings);
        let (mut others, mut off, mut all, mut worst_mm) = (0, 0, 0, 0.0_f64);
        for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
            let field = job.flank_field(job.target_flank(tooth, side));
            let columns: Vec<usize> = (0..field.columns.len()).step_by(29).collect();
            let rows: Vec<usize> = (0..field.rows()).step_by(7).collect();
            let field = field.at([&columns, &rows]);
            let passes = FieldPasses::of_smooth_edges(&job, &field, Pairing::All);
            let chips = |follow| -> Vec<LastChips> { last_chips_of(&passes, &field, deciding, follow, |_, _| true) };
            for (told, looked) in chips(follow).iter().zip(&chips(in_every_row)) {
                for ray in 0..looked.passes.len() {
                    let is_other = told.passes[ray] != looked.passes[ray] || told.sides[ray] != looked.sides[ray];
                    others += usize::from(is_other);
                    let [told_mm, looked_mm] = [told, looked].map(|chips| f64::from(chips.thickness_mm[ray]));
                    let off_mm = (told_mm - looked_mm).abs();
                    // Beside a thick chip the last digit of the number that keeps it.
                    off += usize::from(off_mm > 1e-6 + looked_mm * f64::from(f32::EPSILON));
                    worst_mm = worst_mm.max(off_mm);
                    all += 1;
                }
            }
        }
        println!("{settings:?}: {others} and {off} of {all}, {worst_mm:.1e} mm");
        [others, off, all]
    }

    #[test]
    fn chips_along_rows_are_those_of_a_look_in_every_row() {
        for settings in [&GUIDED[..], &NOISY, &[GUIDED, NOISY].concat()] {
            let [others, off, all] = differing(settings, in_rows);
            assert!(others == 0 && off == 0 && all > 5000, "{settings:?}: {others} and {off} of {all}");
        }
    }

    #[test]
    fn few_rows_need_a_look() {
        let [untold, _, all] = differing(&GUIDED, |passes, chosen, ray, rows| {
            let told = surfaces(passes, chosen, ray, rows).into_iter();
            told.map(|told| told.unwrap_or_else(|| RaySurface::uncut(ray))).collect()
        });
        assert!(5 * untold < all, "{untold} of {all}");
    }

    /// Planted: a row in ten is looked at, and the rows up to the next one take its chip without a look at passes.
    #[test]
    fn rows_that_take_the_chips_of_others_are_noticed() {
        let [others, off, all] = differing(&GUIDED, |passes, chosen, ray, rows| {
            let nodes: Vec<usize> = rows.iter().copied().step_by(10).collect();
            let at_nodes = in_every_row(passes, chosen, ray, &nodes);
            (0..rows.len()).map(|row| at_nodes[row / 10]).collect()
        });
        assert!(others > 40 && 20 * off > all, "{others} and {off} of {all}");
    }
}
