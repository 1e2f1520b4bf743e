//! The blank field of shaping on the GPU: strokes taken from rays in f32.
//!
//! In: a [`BlankField`], an operation, as [`gearcut_core::cut::cpu::blank`]. Out: the field after it and what every
//! pass removed. The host places every tooth in f64 and hands over its pose alone; outlines go to the device once.
//! Tiles of all slices and both families are cut in one submission ([`super::blank_rays`]), a few thousand at a time;
//! tiles that do not fit the device together go one half after the other.
//!
//! **Places.** A tooth's centre and the rays lie tens of millimetres from the axis, where an f32 resolves nanometres.
//! Both go over as whole units, so that their difference is exact; the outline counts from the tooth's centre and is
//! millimetres in size. Along the rays coordinates reach the blank's radius: 8 nm at 70 mm.
//!
//! Return strokes go through the shader in their turn: they take nothing and tell the longest material that they meet
//! on a ray of each tile. Where and how deep a stroke rubs is worked out natively, on the tiles that met any.

use super::blank_rays::{CutOutcome, PackedRays, RayLists, RayPasses, list_bytes, outline_pieces, unit_mm, units};
use super::blank_records::{BlankPass, BlankTile, NO_ACCOUNT, OutlinePiece};
use super::context::Gpu;
use super::problem::GpuProblem;
use gearcut_core::cut::cpu::blank::rubs_of_tile;
use gearcut_core::cut::{BlankCut, BlankOperation, Rub};
use gearcut_core::dexel::BlankField;
use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::frame::Rigid2;
use gearcut_core::math::planar_rays::{FAMILIES, Family, RayRow};
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::blank_candidates::{PlacedPass, passes_at};
use gearcut_core::tool::closed_tooth::{ClosedTooth, PlacedScratch};
use gearcut_shaders::WORKGROUP_THREADS;
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// Tiles of one submission at most: they fill the largest GPU, and Ctrl-C is heard between submissions.
const MOST_TILES: usize = 2048;
/// Spans that a ray has room for at first, beside those it has: as many as a ray meets teeth of a gear of a hundred.
/// Room costs memory of the device alone; a list without it costs all tiles of the submission a second time.
const FIRST_ROOM: usize = 24;
/// Material that a return stroke may meet on a ray unnoticed, mm: half the depth at which reports speak of rubbing, a
/// dozen times what f32 may be off.
const UNNOTICED_MM: f32 = 5e-4;
/// Units of the ledger in a millimetre: a quarter of a nanometre each.
const UNITS_PER_MM: f64 = (1 << 22) as f64;
/// Rays of a tile: one for each thread.
const TILE_RAYS: usize = WORKGROUP_THREADS as usize;

/// Rays of one tile of the field.
#[derive(Clone)]
struct TilePlace {
    slice: usize,
    family: usize,
    rays: Range<usize>,
}

/// Passes of one slice, in f64 and as records.
struct SlicePasses {
    passes: Vec<PlacedPass>,
    returns: Vec<PlacedPass>,
    /// Centre and reach of every record, in the order of time.
    circles: Vec<(DVec2, f64)>,
    records: Vec<BlankPass>,
}

impl Gpu {
    /// Runs an operation over the blank field; `first_room` spans are reserved beside those that a ray has, and more
    /// when they are needed. `advance` is called for every tile and says whether to go on; `None`: stopped.
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
        let widths_mm = grid.slice_widths_mm();
        let widest_mm = widths_mm.iter().copied().fold(0.0, f64::max);
        let outlines = Outlines::new(operation.teeth);
        let mm_per_unit = unit_mm(farthest_mm(operation, &grid.rows));
        let mut after = field.clone();
        let mut removed = vec![[0_u64; 2]; (set.end_pass() - set.first_pass) as usize];
        let mut rubs = Vec::new();
        let mut capacity_beside = first_room.unwrap_or(FIRST_ROOM);
        for chunk in chunks(&grid.slices_z_mm, &grid.rows) {
            let slices = chunk[0].slice..chunk[chunk.len() - 1].slice + 1;
            let placed: Vec<SlicePasses> = slices
                .clone()
                .into_par_iter()
                .map(|slice| SlicePasses::new(operation, &outlines, grid.slices_z_mm[slice], mm_per_unit))
                .collect();
            let first_record: Vec<u32> = placed
                .iter()
                .scan(0, |next, slice| Some(std::mem::replace(next, *next + slice.records.len() as u32)))
                .collect();
            let visits: Vec<Vec<u32>> = chunk
                .par_iter()
                .map(|tile| {
                    let slice = tile.slice - slices.start;
                    placed[slice].visits(tile, &grid.rows[tile.family], first_record[slice])
                })
                .collect();
            let mut work = RayPasses {
                passes: placed.iter().flat_map(|slice| &slice.records).copied().collect(),
                outline: outlines.pieces.clone(),
                mm_per_unit: mm_per_unit as f32,
                reach_mm: outlines.reach_mm as f32,
                accounts: removed.len(),
                ..RayPasses::default()
            };
            let (mut tiles, mut lists) = (Vec::with_capacity(chunk.len()), PackedRays::default());
            for (tile, visits) in chunk.iter().zip(&visits) {
                let units_per_mm = UNITS_PER_MM * widths_mm[tile.slice] / widest_mm;
                let first = lists.rays.len();
                tiles.push(work.tile(first..first + tile.rays.len(), tile.family, units_per_mm, visits));
                let rays = &after.slices[tile.slice].rays[tile.family];
                for ray in tile.rays.clone() {
                    let place = units(grid.rows[tile.family].at_mm(ray), mm_per_unit);
                    lists.push(&rays[ray], FAMILIES[tile.family], place);
                }
            }
            let families: Vec<Family> = chunk.iter().map(|tile| FAMILIES[tile.family]).collect();
            let done = self.run_strokes(&tiles, &families, &lists, &work, &mut capacity_beside)?;
            for (sum, taken) in removed.iter_mut().zip(&done.removed) {
                *sum = [0, 1].map(|f| sum[f] + taken[f]);
            }
            let rubbing: Vec<&TilePlace> = chunk
                .iter()
                .zip(&done.longest_met_mm)
                .filter(|(_, met)| **met > UNNOTICED_MM)
                .map(|(t, _)| t)
                .collect();
            let found: Vec<Vec<Rub>> = rubbing
                .par_iter()
                .map(|tile| {
                    let slice = &placed[tile.slice - slices.start];
                    let place = [tile.slice, tile.family, tile.rays.start];
                    rubs_of_tile(field, place, tile.rays.len(), operation, [&slice.passes, &slice.returns])
                })
                .collect();
            rubs.extend(found.into_iter().flatten());
            let mut lists = done.rays.into_iter();
            for tile in &chunk {
                let rays = &mut after.slices[tile.slice].rays[tile.family][tile.rays.clone()];
                rays.iter_mut().zip(lists.by_ref()).for_each(|(ray, list)| *ray = list);
            }
            if !chunk.iter().all(|_| advance()) {
                return Ok(None);
            }
        }
        *field = after;
        let mm3_per_unit = grid.spacing_mm() * widest_mm / UNITS_PER_MM;
        let removed_mm3 = removed.into_iter().map(|units| units.map(|units| units as f64 * mm3_per_unit)).collect();
        Ok(Some(BlankCut { removed_mm3, rubs, ..BlankCut::default() }))
    }

    /// Runs tiles with all their passes; `room` is what a ray has for more spans than it has, and grows where that is
    /// not enough.
    fn run_strokes(
        &self,
        tiles: &[BlankTile],
        families: &[Family],
        lists: &PackedRays,
        work: &RayPasses,
        room: &mut usize,
    ) -> Result<StrokesDone, GpuProblem> {
        let mut done =
            StrokesDone { rays: Vec::new(), removed: vec![[0; 2]; work.accounts], longest_met_mm: Vec::new() };
        let limits = self.allowance();
        // Lists in slots, and on their way.
        let limit = limits.buffer_bytes.min(limits.batch_bytes / 2);
        let mut waiting: Vec<Range<usize>> = std::iter::once(0..tiles.len()).collect();
        while let Some(some) = waiting.pop() {
            let (first, last) = (tiles[some.start].first_ray, &tiles[some.end - 1]);
            let own = lists.part(first as usize..(last.first_ray + last.ray_count) as usize);
            let longest = own.longest();
            let capacity = (longest + *room).max(1);
            let bytes = list_bytes(own.rays.len(), capacity);
            if bytes > limit && some.len() > 1 {
                let middle = some.start.midpoint(some.end);
                waiting.extend([middle..some.end, some.start..middle]);
                continue;
            }
            if bytes > limit {
                let rays = own.rays.len();
                let reason = format!("lists of {capacity} spans for {rays} rays need {bytes} of {limit} bytes");
                return Err(GpuProblem::OutOfMemory { reason });
            }
            let own_tiles: Vec<BlankTile> = tiles[some.clone()]
                .iter()
                .map(|tile| BlankTile { first_ray: tile.first_ray - first, ..*tile })
                .collect();
            let mut on_device = RayLists::new(self, &own, capacity, false)?;
            let sent = on_device.send(&own_tiles, work, 0)?;
            match on_device.collect(sent)? {
                CutOutcome::Done(cut) => {
                    done.longest_met_mm.extend(cut.longest_met_mm);
                    for (sum, taken) in done.removed.iter_mut().zip(&cut.removed) {
                        *sum = [0, 1].map(|f| sum[f] + taken[f]);
                    }
                    let left = on_device.all()?;
                    for (tile, family) in own_tiles.iter().zip(&families[some]) {
                        let rays = tile.first_ray as usize..(tile.first_ray + tile.ray_count) as usize;
                        done.rays
                            .extend(rays.map(|ray| left.list(ray, *family)).collect::<Result<Vec<_>, GpuProblem>>()?);
                    }
                }
                CutOutcome::NeedsRoom { spans, .. } => {
                    *room = (spans - longest).max(2 * *room);
                    waiting.push(some);
                }
            }
        }
        Ok(done)
    }
}

/// What tiles came back with.
struct StrokesDone {
    /// What is left, ray by ray.
    rays: Vec<RayMaterial>,
    /// What every pass removed by both families, in the tiles' units.
    removed: Vec<[u64; 2]>,
    /// Longest material that a return stroke met on a ray of each tile, mm.
    longest_met_mm: Vec<f32>,
}

/// Tiles of all slices in their order, as many at a time as one submission takes.
fn chunks(slices_z_mm: &[f64], rows: &[RayRow; 2]) -> Vec<Vec<TilePlace>> {
    let tiles: Vec<TilePlace> = (0..slices_z_mm.len())
        .flat_map(|slice| {
            rows.iter().enumerate().flat_map(move |(family, row)| {
                (0..row.count).step_by(TILE_RAYS).map(move |first| TilePlace {
                    slice,
                    family,
                    rays: first..(first + TILE_RAYS).min(row.count),
                })
            })
        })
        .collect();
    tiles.chunks(MOST_TILES).map(<[TilePlace]>::to_vec).collect()
}

/// The farthest ray or centre of a tooth in the blank's reach.
fn farthest_mm(operation: &BlankOperation, rows: &[RayRow; 2]) -> f64 {
    let teeth_mm = operation.teeth.iter().map(|tooth| tooth.reach_mm).fold(0.0, f64::max);
    let rays_mm = rows.iter().flat_map(|row| [row.first_mm, row.at_mm(row.count)]).map(f64::abs).fold(0.0, f64::max);
    rays_mm.max(operation.blank_reach_mm + teeth_mm)
}

/// Outlines of all teeth of a cutter, from the centres of their edges.
struct Outlines {
    pieces: Vec<OutlinePiece>,
    /// Pieces of every tooth.
    of_tooth: Vec<Range<u32>>,
    reach_mm: f64,
}

impl Outlines {
    fn new(teeth: &[ClosedTooth]) -> Self {
        let (mut pieces, mut of_tooth) = (Vec::new(), Vec::new());
        let mut scratch = PlacedScratch::default();
        for tooth in teeth {
            let curve = tooth.placed(&Rigid2::new(0.0, DVec2::ZERO), &mut scratch);
            let first = pieces.len() as u32;
            pieces.extend(outline_pieces(&curve, tooth.center_mm));
            of_tooth.push(first..pieces.len() as u32);
        }
        let reach_mm = teeth.iter().map(|tooth| tooth.reach_mm).fold(0.0, f64::max);
        Self { pieces, of_tooth, reach_mm }
    }
}

impl SlicePasses {
    fn new(operation: &BlankOperation, outlines: &Outlines, z_mm: f64, mm_per_unit: f64) -> Self {
        let set = operation.strokes;
        let place = |strokes: &StrokeSet| {
            passes_at(strokes, set.law.tau(z_mm), operation.tool, operation.teeth, operation.blank_reach_mm)
        };
        let (passes, returns) = (place(set), operation.returns.map(place).unwrap_or_default());
        let mut order: Vec<(u32, bool, &PlacedPass)> = passes
            .iter()
            .map(|pass| (pass.stroke, false, pass))
            .chain(returns.iter().map(|pass| (pass.stroke, true, pass)))
            .collect();
        // Stable: cutter teeth stay in their order; a stroke goes back before the next one comes.
        order.sort_by_key(|&(stroke, returning, _)| (stroke, returning));
        let circles = order.iter().map(|(_, _, p)| (p.center_mm, operation.teeth[p.edge].reach_mm)).collect();
        let records = order
            .iter()
            .map(|&(stroke, returning, pass)| {
                let pieces = &outlines.of_tooth[pass.edge];
                let rotation = pass.work_from_blade.rotation.as_vec2();
                let pass_id = set.pass_id(stroke as usize, pass.blade);
                BlankPass {
                    cos: rotation.x,
                    sin: rotation.y,
                    center: pass.center_mm.to_array().map(|at_mm| units(at_mm, mm_per_unit)),
                    first_piece: pieces.start,
                    piece_count: pieces.end - pieces.start,
                    pass_id,
                    account: if returning { NO_ACCOUNT } else { pass_id - set.first_pass },
                }
            })
            .collect();
        drop(order);
        Self { passes, returns, circles, records }
    }

    /// Records whose circles reach the strip of a tile's rays, as places among all of a launch.
    fn visits(&self, tile: &TilePlace, row: &RayRow, first_record: u32) -> Vec<u32> {
        let [low_mm, high_mm] = [tile.rays.start, tile.rays.end - 1].map(|ray| row.at_mm(ray));
        let family = FAMILIES[tile.family];
        let reaches = |(center_mm, reach_mm): &(DVec2, f64)| {
            let across = family.across(*center_mm);
            across + reach_mm >= low_mm && across - reach_mm <= high_mm
        };
        (first_record..).zip(&self.circles).filter(|(_, circle)| reaches(circle)).map(|(index, _)| index).collect()
    }
}
