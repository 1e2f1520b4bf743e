//! The blank field of shaping on the GPU: strokes taken from rays in f32.
//!
//! In: a [`BlankField`], an operation, as [`gearcut_core::cut::cpu::blank`]. Out: the field after it and what every
//! pass removed. The host places every tooth in f64, splits its outline where it turns back across the rays, and hands
//! over each part as a pair of cubics; the shader finds roots and keeps the lists ([`super::blank_rays`]). Along the
//! rays coordinates reach the blank's radius, where an f32 resolves 8 nm at 70 mm; across them they start at the tile.
//!
//! Return strokes go through the shader in their turn: they take nothing and add up the material that they meet. Where
//! and how deep a stroke rubs is worked out natively, on the few tiles that met any.

use super::adapter::WORKGROUP_THREADS;
use super::blank_rays::{PassWork, Terms, TileDone, TileWork, parts};
use super::context::Gpu;
use super::problem::GpuProblem;
use gearcut_core::cut::cpu::blank::rubs_of_tile;
use gearcut_core::cut::{BlankCut, BlankOperation};
use gearcut_core::dexel::BlankField;
use gearcut_core::math::planar_rays::{FAMILIES, Family, RayCrossings, RayRow};
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::blank_candidates::{PlacedPass, passes_at, reaching_strip};
use gearcut_core::tool::closed_tooth::PlacedScratch;
use rayon::prelude::*;
use std::ops::Range;

/// Tiles of one submission: enough to fill a large GPU with their rays, few enough that their parts stay tens of
/// megabytes.
const GROUP_TILES: usize = 16;
/// Material that the return strokes of a tile may meet unnoticed, mm along its rays: half the depth at which reports
/// speak of rubbing, a dozen times what f32 may be off.
const UNNOTICED_MM: f64 = 5e-4;

impl Gpu {
    /// Runs an operation over the blank field; `first_room` spans are reserved beside those that a ray has, and more
    /// when they are needed. `advance` is called after every tile and says whether to go on; `None`: stopped.
    ///
    /// # Errors
    /// The device fails, or a ray crosses one tooth more than eight times; the field is then as it was.
    pub fn cut_blank_on_device(
        &self,
        field: &mut BlankField,
        operation: &BlankOperation,
        first_room: Option<usize>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<BlankCut>, GpuProblem> {
        self.device.alive()?;
        let set = operation.strokes;
        let grid = field.grid.clone();
        let mut result =
            BlankCut { removed_mm3: vec![[0.0; 2]; (set.end_pass() - set.first_pass) as usize], ..BlankCut::default() };
        let mut after = field.clone();
        let widths_mm = grid.slice_widths_mm();
        // A ray lies in the tooth over its whole height at most.
        let reach_mm = operation.teeth.iter().map(|tooth| tooth.reach_mm).fold(0.0, f64::max);
        let mut terms = Terms::new(grid.spacing_mm(), 2.02 * reach_mm, first_room);
        for (slice, z_mm) in grid.slices_z_mm.iter().enumerate() {
            let place = |strokes: &StrokeSet| {
                passes_at(strokes, set.law.tau(*z_mm), operation.tool, operation.teeth, operation.blank_reach_mm)
            };
            let (passes, returns) = (place(set), operation.returns.map(place).unwrap_or_default());
            let volume_per_length = grid.spacing_mm() * widths_mm[slice];
            for (f, family) in FAMILIES.into_iter().enumerate() {
                let row = grid.rows[f];
                let firsts: Vec<usize> = (0..row.count).step_by(WORKGROUP_THREADS as usize).collect();
                for group in firsts.chunks(GROUP_TILES) {
                    let rays = &mut after.slices[slice].rays[f];
                    let work: Vec<TileWork> = group
                        .par_iter()
                        .map(|&first| {
                            let tile = first..(first + WORKGROUP_THREADS as usize).min(row.count);
                            let passes = compose(operation, [&passes, &returns], family, &row, tile.clone());
                            TileWork { family, rays: &rays[tile], passes }
                        })
                        .collect();
                    let done = self.run_blank_tiles(&work, &mut terms)?;
                    for (pass, length_mm) in done.iter().flat_map(|tile| &tile.removed_mm) {
                        result.removed_mm3[(pass - set.first_pass) as usize][f] += length_mm * volume_per_length;
                    }
                    let rubbing: Vec<(&usize, &TileDone)> =
                        group.iter().zip(&done).filter(|(_, tile)| tile.met_mm > UNNOTICED_MM).collect();
                    let rubs = rubbing.par_iter().map(|(first, tile)| {
                        rubs_of_tile(field, [slice, f, **first], tile.rays.len(), operation, [&passes, &returns])
                    });
                    result.rubs.extend(rubs.collect::<Vec<_>>().concat());
                    for (first, tile) in group.iter().zip(done) {
                        rays[*first..][..tile.rays.len()].clone_from_slice(&tile.rays);
                    }
                    if !group.iter().all(|_| advance()) {
                        return Ok(None);
                    }
                }
            }
        }
        *field = after;
        Ok(Some(result))
    }
}

/// Strokes and return strokes of a tile as parts, in order of time.
fn compose(
    operation: &BlankOperation,
    [passes, returns]: [&[PlacedPass]; 2],
    family: Family,
    row: &RayRow,
    rays: Range<usize>,
) -> Vec<PassWork> {
    let strip = [row.at_mm(rays.start), row.at_mm(rays.end - 1)];
    let (mut placed, mut crossings) = (PlacedScratch::default(), RayCrossings::default());
    let reaching = |passes, returning| {
        reaching_strip(passes, operation.teeth, family, strip).map(move |pass| (pass.stroke, returning, pass))
    };
    let mut order: Vec<(u32, bool, &PlacedPass)> = reaching(passes, false).chain(reaching(returns, true)).collect();
    // Stable: cutter teeth stay in their order; a stroke goes back before the next one comes.
    order.sort_by_key(|&(stroke, returning, _)| (stroke, returning));
    order
        .into_iter()
        .filter_map(|(stroke, returns, pass)| {
            let tooth = operation.teeth[pass.edge].placed(&pass.work_from_blade, &mut placed);
            let parts = parts(&mut crossings, &tooth, family, row, rays.clone());
            let id = operation.strokes.pass_id(stroke as usize, pass.blade);
            (!parts.is_empty()).then_some(PassWork { id, returns, parts })
        })
        .collect()
}
