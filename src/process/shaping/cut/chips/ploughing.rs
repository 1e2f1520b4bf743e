//! Surfaces under rounded edges: which strokes cut a place, and what is left of those that plough.
//!
//! In: a job, a field of rays, the edge's rounding. Out: the surface on every ray after each operation, and the chip
//! that left it. Every pass that touches a ray is taken in strict order of time by the law of
//! [`crate::process::shaping::tool::edge_rounding`]. The surface depends on that order, so that the kernels, which keep
//! the lowest of all passes, cannot find it.
//!
//! **Which passes are looked at.** A chip wipes out what was before it: after a pass that cuts, the surface is its
//! edge, whatever stood there. So passes are followed from a bound B on: those of which it is proved that they stay
//! above B on the whole column are left out, and the surface before the first of the others is known only to lie above
//! B. A pass that would cut even a surface at B surely cuts; from there on everything is known, and nothing that was
//! left out reaches down to it. If a pass comes below B that a surface at B would not be thick enough for, B was too
//! low: a higher one is tried, up to the surface that the operation found, which is known. No bound on the edge's
//! inclination is needed, and none of the passes' upper bounds is trusted: what they say only chooses the first B.
//!
//! Road not taken: one list of passes for all operations. The surface that an operation finds is known ray by ray.

use super::column_group::ColumnGroup;
use super::deciding::ColumnPasses;
use super::phase_heights::PhaseHeights;
use super::rays::{Chosen, FieldPasses, Pairing, RaySurface};
use super::segments::Reaching;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::scene::model::EdgeRounding;
use crate::process::shaping::tool::edge_rounding::Meeting;
use gearcut_core::cut::CutStats;
use gearcut_core::dexel::field::{Column, Field, Layer};
use rayon::prelude::*;
use std::ops::Range;

/// Surfaces of a field.
pub(super) struct Ploughed {
    /// After each operation: column by column, and of each the rows that differ.
    pub after: Vec<Vec<RaySurface>>,
    /// How many rows of the field each of those stands for.
    pub copies: usize,
    /// Passes that were looked at, ray by ray.
    pub looks: u64,
}

/// Follows all passes over a field.
pub(super) fn surfaces(job: &ShapingJob, field: &Field, pairing: Pairing, rounding: &EdgeRounding) -> Ploughed {
    surfaces_of(job, field, pairing, rounding, &NEEDED)
}

/// What every operation leaves on a field, as the kernels' layers are.
pub fn layers(job: &ShapingJob, field: &Field, rounding: &EdgeRounding) -> (Vec<Layer>, CutStats) {
    let Ploughed { after, copies, looks } = surfaces(job, field, Pairing::All, rounding);
    let rays = after.first().map_or(0, Vec::len);
    let layer = |surfaces: Vec<RaySurface>| {
        let heights_mm = surfaces.iter().map(|surface| surface.height_mm as f32).collect();
        Layer { heights_mm, passes: surfaces.iter().map(|surface| surface.pass).collect() }.repeated(copies)
    };
    let stats = CutStats { dexels: rays as u64, dexel_passes: looks, unconverged: 0 };
    (after.into_iter().map(layer).collect(), stats)
}

/// Which passes are followed.
struct PassChoice {
    /// The first bound, from what is surely left and the thickness of the thinnest chip, mm.
    first_bound_mm: fn(f64, f64) -> f64,
    /// Those of an operation's passes that may come below a bound.
    passes: fn(&mut ColumnPasses, Range<usize>, f64) -> Vec<Reaching>,
}

/// Those that are needed.
const NEEDED: PassChoice = PassChoice {
    first_bound_mm: |left_mm, chip_mm| left_mm + chip_mm,
    passes: |column, passes, bound_mm| column.reaching_below(passes, PhaseHeights::even(bound_mm)),
};

/// The same with other passes.
fn surfaces_of(
    job: &ShapingJob,
    field: &Field,
    pairing: Pairing,
    rounding: &EdgeRounding,
    choice: &PassChoice,
) -> Ploughed {
    let passes = FieldPasses::new(job, field, pairing);
    let of_column = |group: &mut ColumnGroup, index: usize, ray: &Column| {
        let mut column = passes.over(group, ray);
        let places = passes.rows(index);
        let mut rows = vec![RaySurface::uncut(ray); places.len()];
        let (mut after, mut looks) = (Vec::new(), 0);
        for operation in 0..job.operations.len() {
            let of_operation = passes.of_operation(operation);
            let highest_mm = rows.iter().map(|row| row.height_mm).fold(f64::NEG_INFINITY, f64::max);
            let left_mm = column.surely_left_by(of_operation.clone(), PhaseHeights::even(highest_mm)).highest_mm();
            let mut bound_mm = (choice.first_bound_mm)(left_mm, rounding.minimum_chip_mm());
            rows = loop {
                bound_mm = bound_mm.min(highest_mm);
                let chosen = passes.chosen((choice.passes)(&mut column, of_operation.clone(), bound_mm));
                looks += (chosen.len() * rows.len()) as u64;
                let follow = |(row, found): (usize, &RaySurface)| {
                    follow(&passes, &chosen, (row, ray), *found, bound_mm, rounding)
                };
                match places.clone().zip(&rows).map(follow).collect::<Result<Vec<_>, TooLow>>() {
                    Ok(rows) => break rows,
                    Err(TooLow { needed_mm }) => bound_mm = needed_mm.max(bound_mm + (bound_mm - left_mm)),
                }
            };
            after.push(rows.clone());
        }
        (after, looks)
    };
    let of_group = |&(first, columns): &(usize, &[Column])| {
        let mut group = passes.group(columns, None);
        (first..).zip(columns).map(|(index, ray)| of_column(&mut group, index, ray)).collect::<Vec<_>>()
    };
    let groups = ColumnGroup::groups(&field.columns);
    let columns: Vec<(Vec<Vec<RaySurface>>, u64)> = groups.par_iter().flat_map_iter(of_group).collect();
    let mut ploughed = Ploughed { after: vec![Vec::new(); job.operations.len()], copies: passes.copies, looks: 0 };
    for (of_operations, looks) in columns {
        ploughed.looks += looks;
        for (after, rows) in ploughed.after.iter_mut().zip(of_operations) {
            after.extend(rows);
        }
    }
    ploughed
}

/// A bound from which a surface cannot be followed.
struct TooLow {
    /// One from which this would not have happened, mm.
    needed_mm: f64,
}

/// Follows passes over one ray from the surface that the operation found, or from any that lies above the bound.
fn follow(
    passes: &FieldPasses,
    chosen: &[Chosen],
    (row, ray): (usize, &Column),
    found: RaySurface,
    bound_mm: f64,
    rounding: &EdgeRounding,
) -> Result<RaySurface, TooLow> {
    let is_known = found.height_mm <= bound_mm;
    // Of a surface above the bound neither height nor chip is known.
    let mut known = is_known.then_some(found);
    for pass in chosen {
        let surface_mm = known.map_or(bound_mm, |surface| surface.height_mm);
        let Some(entry) = passes.entry(pass, row, ray, surface_mm) else { continue };
        let height_mm = entry.height_mm.max(ray.low_mm);
        match (rounding.meet(surface_mm, entry.height_mm, entry.cosine), &mut known) {
            (Meeting::Cuts(thickness_mm), Some(surface)) if height_mm < surface.height_mm => {
                *surface = RaySurface { height_mm, thickness_mm, side: Some(entry.side), pass: pass.id };
            }
            (Meeting::Cuts(_), None) => {
                known = Some(RaySurface { height_mm, thickness_mm: f64::NAN, side: Some(entry.side), pass: pass.id });
            }
            (Meeting::Ploughs(left_mm), Some(surface)) => surface.height_mm = left_mm.max(ray.low_mm),
            (Meeting::Ploughs(_), None) => {
                return Err(TooLow { needed_mm: entry.height_mm + rounding.minimum_chip_mm() / entry.cosine });
            }
            (Meeting::Cuts(_), Some(_)) => {}
        }
    }
    // The chip that left the surface is asked for as well.
    let told = known.filter(|surface| is_known || !surface.thickness_mm.is_nan());
    told.ok_or(TooLow { needed_mm: bound_mm })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use gearcut_core::terms::Side;
    use std::path::Path;

    fn job(scene: &str, settings: &[&str]) -> ShapingJob {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        ShapingJob::new(load(Path::new(scene), &settings).expect("a shipped scene").scene).expect("a gear")
    }

    /// Brute force: all passes, from the surface that the operation found.
    const ALL: PassChoice =
        PassChoice { first_bound_mm: |_, _| f64::INFINITY, passes: |column, passes, _| column.all(passes) };

    /// How many surfaces differ, as bits, from those of all passes; and how many passes were looked at.
    fn compared(job: &ShapingJob, rounding: &EdgeRounding, choice: &PassChoice) -> (usize, [u64; 2]) {
        let (mut differing, mut looked) = (0, [0, 0]);
        for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
            let field = job.flank_field(job.target_flank(tooth, side));
            let columns: Vec<usize> = (0..field.columns.len()).step_by(41).collect();
            let last = field.rows() - 1;
            let field = field.at([&columns, &[0, last / 3, last]]);
            let [chosen, of_all] =
                [choice, &ALL].map(|choice| surfaces_of(job, &field, Pairing::All, rounding, choice));
            let bits = |of: &Ploughed| -> Vec<(u64, u64, u32)> {
                let surfaces = of.after.iter().flatten();
                surfaces.map(|s| (s.height_mm.to_bits(), s.thickness_mm.to_bits(), s.pass)).collect()
            };
            differing += bits(&chosen).iter().zip(&bits(&of_all)).filter(|(a, b)| a != b).count();
            looked = [looked[0] + chosen.looks, looked[1] + of_all.looks];
        }
        (differing, looked)
    }

    const PAPER: &str = "scenes/shaping/elliptical_traditional.toml";

    #[test]
    fn the_passes_that_are_followed_leave_the_surfaces_of_all() {
        let rounding = |chip_um: f64, recovery_share| EdgeRounding {
            radius_mm: 4e-3 * chip_um,
            minimum_chip_share: 0.25,
            recovery_share,
        };
        let few = ["operation.rough.strokes_per_revolution=420", "operation.finish.strokes_per_revolution=1260"];
        let feed = ["operation.rough.feed_during_stroke=true", "operation.finish.feed_during_stroke=true"];
        let turns = ["operation.finish.overlap_deg=200", "machine.errors.center_distance.noise_um=2"];
        let paper = job(PAPER, &few);
        // Strokes whose chips stay below the thinnest one for a dozen strokes before and after the contact.
        let dense = job(PAPER, &["operation.rough.strokes_per_revolution=420"]);
        let going = job(PAPER, &[few, feed].concat());
        let noisy = job(PAPER, &[few, turns].concat());
        let edge = "tool.shaper_cutter.edge_roughness";
        let rough = [format!("{edge}.rq_um=0.3"), format!("{edge}.correlation_length_um=25")];
        let rough = job(PAPER, &[&few[..], &rough.each_ref().map(String::as_str)].concat());
        for (name, job, chip_um, recovery) in [
            ("paper", &paper, 0.001, 1.0),
            ("paper", &paper, 0.1, 1.0),
            ("paper", &paper, 1.5, 1.0),
            ("paper", &paper, 1.5, 0.6),
            ("dense", &dense, 1.5, 1.0),
            ("dense", &dense, 4.0, 0.9),
            ("feed", &going, 0.1, 1.0),
            ("feed", &going, 1.5, 0.9),
            ("noise", &noisy, 0.5, 1.0),
            ("noise", &noisy, 2.0, 0.8),
            ("rough edges", &rough, 0.1, 1.0),
            ("rough edges", &rough, 1.0, 0.7),
        ] {
            let (differing, [few, all]) = compared(job, &rounding(chip_um, recovery), &NEEDED);
            println!("{name}, {chip_um} um: {few} of {all} looks");
            assert_eq!(differing, 0, "{name}, {chip_um} um, {recovery}");
            assert!(few < all, "{name}: {few} of {all}");
        }
    }

    /// A pass in five is forgotten: the comparison above would see it.
    #[test]
    fn a_pass_that_is_forgotten_is_noticed() {
        let job = job(PAPER, &["operation.finish.strokes_per_revolution=1260"]);
        let rounding = EdgeRounding { radius_mm: 0.005, minimum_chip_share: 0.3, recovery_share: 1.0 };
        let forgetful = PassChoice {
            passes: |column, passes, bound_mm| {
                let below = column.reaching_below(passes, PhaseHeights::even(bound_mm)).into_iter();
                below.filter(|pass| pass.near % 5 != 0).collect()
            },
            ..NEEDED
        };
        let (differing, _) = compared(&job, &rounding, &forgetful);
        assert!(differing > 10, "{differing}");
    }
}
