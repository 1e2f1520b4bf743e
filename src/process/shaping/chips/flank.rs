//! The chip with which every place of a flank got its surface.
//!
//! In: the job and a field of rays on a flank (few of them: those of a map). Out, after each operation: uncut chip
//! thickness, the part of the cutter's edge that took it, and the pass.
//!
//! **Definition.** Every pass that touches a ray is taken in strict order of time, over all operations so far. A pass
//! that lies lower than all before it lowers the surface; the material between is solid, for no earlier pass has
//! reached it. Its length along the ray times the cosine between ray and edge normal is the thickness across the chip:
//! where the edge runs parallel to the surface that it finds, as it does within milliradians from stroke to stroke, the
//! distance between them. The last pass that lowers the surface leaves it. Where it is the first pass of all, the chip
//! reaches to the blank's surface or to the end of the ray, half a pitch out.
//!
//! The candidates that suffice for heights do not do here: the pass before the last one may lie above it on a whole
//! tile, and be culled. So passes are chosen column by column (`deciding`). Heights are f64 throughout: on
//! finished flanks the edge goes through the contact, chips are thinner than a micrometre, and the ledger's sections,
//! good to a tenth of a micrometre, would not see them. Away from the contact by t strokes, passes stand c t^2 over the
//! target (c is four times the height of a scallop, t at most a half on the surface that is left), so thickness runs
//! from 0 at one end of a facet through c in its middle to 2 c at the other.

use super::deciding::{
    ColumnPasses, END_OVERLAP_MM, Near, Reaching, SegmentSet, Segments, deciding, passes_near, residual_mm,
};
use crate::measure::LastChips;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::edge_polygon::EdgeSide;
use gearcut_core::dexel::field::{Column, Field, NO_PASS};
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::planar::strokes::StrokePath;
use gearcut_core::tool::{CuttingTool, PlanarTool};

/// Part of the edge as maps have it: 0 for none.
pub fn side_code(side: Option<EdgeSide>) -> u32 {
    side.map_or(0, |side| side as u32 + 1)
}

/// What a ray knows at some moment.
#[derive(Debug, Clone, Copy)]
struct RaySurface {
    height_mm: f64,
    thickness_mm: f64,
    side: Option<EdgeSide>,
    pass: u32,
}

/// Chips that left the surface after each operation, in their order.
pub fn last_chips(job: &ShapingJob, field: &Field) -> Vec<LastChips> {
    last_chips_of(job, field, deciding)
}

/// The same of those passes that `choose` takes of a column's, up to one of them.
fn last_chips_of(
    job: &ShapingJob,
    field: &Field,
    choose: impl Fn(&mut ColumnPasses, usize) -> Vec<Reaching>,
) -> Vec<LastChips> {
    let rows_z_mm: &[f64] = if job.planar().rows_are_alike() { &[0.0] } else { &field.rows_z_mm };
    let segments = Segments::new(job.cutter.edge());
    let blades: Vec<Rigid2> = (0..job.cutter.blade_count()).map(|b| job.cutter.tool_from_blade(b).inverse()).collect();
    let near = passes_near(job, field);
    // Phases of all operations, row by row.
    let phases: Vec<Vec<f64>> =
        rows_z_mm.iter().map(|&z_mm| job.operations.iter().map(|o| o.strokes.law.tau(z_mm)).collect()).collect();
    let mut after: Vec<Vec<RaySurface>> = vec![Vec::new(); job.operations.len()];
    for ray in &field.columns {
        let mut column = ColumnPasses::new(&segments, &near, ray);
        for (operation, after) in after.iter_mut().enumerate() {
            let so_far = near.partition_point(|pass| pass.operation <= operation);
            let path = |chosen: Reaching| {
                let pass = &near[chosen.near];
                (chosen, pass, job.operations[pass.operation].strokes.path(pass.stroke))
            };
            let chosen: Vec<(Reaching, &Near, StrokePath)> =
                choose(&mut column, so_far).into_iter().map(path).collect();
            for phases in &phases {
                let mut surface =
                    RaySurface { height_mm: ray.blank_mm, thickness_mm: f64::NAN, side: None, pass: NO_PASS };
                for (chosen, pass, path) in &chosen {
                    let work_from_tool = path.at(phases[pass.operation]);
                    let blade_from_work = blades[pass.blade as usize].after(&work_from_tool.inverse());
                    let id = job.operations[pass.operation].strokes.pass_id(pass.stroke, pass.blade);
                    segments.lower(&mut surface, &blade_from_work, ray, id, chosen.segments);
                }
                after.push(surface);
            }
        }
    }
    let copies = field.rows() / rows_z_mm.len();
    after.into_iter().map(|surfaces| last_chips_on(&surfaces, copies)).collect()
}

/// What the surfaces of a section say, repeated on as many rows.
fn last_chips_on(surfaces: &[RaySurface], copies: usize) -> LastChips {
    let all = || surfaces.iter().flat_map(|surface| std::iter::repeat_n(surface, copies));
    LastChips {
        thickness_mm: all().map(|s| s.thickness_mm as f32).collect(),
        sides: all().map(|s| side_code(s.side)).collect(),
        passes: all().map(|s| s.pass).collect(),
    }
}

impl Segments<'_> {
    /// Takes one pass from a ray.
    fn lower(&self, surface: &mut RaySurface, blade_from_work: &Rigid2, ray: &Column, pass: u32, set: SegmentSet) {
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        // Kernels follow rays down to twice their lowest height and record the lowest one there.
        let below_mm = 2.0 * ray.low_mm;
        let mut lowest: Option<(f64, f64, EdgeSide)> = None;
        for (segment, segment_from_blade) in self.of(set) {
            let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
            if residual_mm(segment, o, n, surface.height_mm).is_some_and(|residual_mm| residual_mm > 0.0) {
                continue;
            }
            let [from, to] = [segment.y_range_mm[0] - END_OVERLAP_MM, segment.y_range_mm[1] + END_OVERLAP_MM];
            let Some(hit) = segment.enter(o, n).filter(|hit| (from..=to).contains(&hit.y_mm)) else { continue };
            if hit.height_mm > below_mm && lowest.is_none_or(|(h, ..)| hit.height_mm < h) {
                lowest = Some((hit.height_mm, hit.normal.dot(n).abs(), EdgeSide::of(segment.name)));
            }
        }
        let Some((height_mm, cosine, side)) = lowest else { return };
        let height_mm = height_mm.max(ray.low_mm);
        if height_mm < surface.height_mm {
            let thickness_mm = (surface.height_mm - height_mm) * cosine;
            *surface = RaySurface { height_mm, thickness_mm, side: Some(side), pass };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use crate::process::shaping::scene::model::Shaping;
    use gearcut_core::terms::Side;
    use std::path::Path;

    #[test]
    fn the_passes_that_decide_leave_the_chips_of_all() {
        let mut scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("the shipped scene").scene;
        for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
            operation.feed_during_stroke = true;
        }
        let job = ShapingJob::new(scene).expect("the shipped gear");
        let (mut all, mut kept) = (0, 0);
        for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
            let field = job.flank_field(job.target_flank(tooth, side));
            let columns: Vec<usize> = (0..field.columns.len()).step_by(31).collect();
            let field = field.at([&columns, &[0, 100, 300, 500, 600]]);
            let chosen = last_chips(&job, &field);
            let of_all = last_chips_of(&job, &field, |column, so_far| column.all(so_far));
            for (chosen, of_all) in chosen.iter().zip(&of_all) {
                let bits = |chips: &LastChips| chips.thickness_mm.iter().map(|h| h.to_bits()).collect::<Vec<_>>();
                assert_eq!((&chosen.passes, bits(chosen)), (&of_all.passes, bits(of_all)));
            }
            let counted = std::cell::Cell::new([0, 0]);
            last_chips_of(&job, &field, |column, so_far| {
                let deciding = deciding(column, so_far);
                let [a, k] = counted.get();
                counted.set([a + column.all(so_far).len(), k + deciding.len()]);
                deciding
            });
            let [a, k] = counted.get();
            (all, kept) = (all + a, kept + k);
        }
        println!("{kept} of {all} passes decide");
        assert!(20 * kept < all, "{kept} of {all}");
    }
}
