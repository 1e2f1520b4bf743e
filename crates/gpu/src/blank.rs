//! The blank field of shaping on the GPU: strokes taken from rays in f32.
//!
//! In: a [`BlankField`], an operation, as [`gearcut_core::cut::cpu::blank`]. Out: the field after it and what every
//! pass removed. The host places every tooth in f64 and hands over its pose alone; outlines go to the device once.
//! Tiles of all slices and both families are cut in one submission ([`super::blank_strokes`]), a few thousand at a
//! time.
//!
//! **Places.** A tooth's centre and the rays lie tens of millimetres from the axis, where an f32 resolves nanometres.
//! Both go over as whole units, so that their difference is exact; the outline counts from the tooth's centre and is
//! millimetres in size. Along the rays coordinates reach the blank's radius: 8 nm at 70 mm.
//!
//! Return strokes go through the shader in their turn: they take nothing and tell the longest material that they meet
//! on a ray of each tile. Where and how deep a stroke rubs is worked out natively, on the tiles that met any.

use super::blank_strokes::StrokeWork;
use super::context::Gpu;
use super::problem::GpuProblem;
use super::stroke_records::{OutlinePiece, StrokePass, StrokeTile};
use gearcut_core::cut::cpu::blank::rubs_of_tile;
use gearcut_core::cut::{BlankCut, BlankOperation, Rub};
use gearcut_core::dexel::BlankField;
use gearcut_core::frame::Rigid2;
use gearcut_core::math::planar_rays::{ClosedCurve, FAMILIES, Piece, RayRow};
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
/// Bits of places across: their differences stay below 2^31.
const PLACE_BITS: f64 = 29.0;
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
    records: Vec<StrokePass>,
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
        let mm_per_unit = unit_mm(operation, &grid.rows);
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
            let (mut first_visit, mut first_ray) = (0, 0);
            let mut tiles = Vec::with_capacity(chunk.len());
            for (tile, visits) in chunk.iter().zip(&visits) {
                let units_per_mm = UNITS_PER_MM * widths_mm[tile.slice] / widest_mm;
                tiles.push(StrokeTile {
                    first_visit,
                    visit_count: visits.len() as u32,
                    first_ray,
                    ray_count: tile.rays.len() as u32,
                    family: tile.family as u32,
                    units_per_mm: units_per_mm as f32,
                    padding_1: 0,
                    padding_2: 0,
                });
                first_visit += visits.len() as u32;
                first_ray += tile.rays.len() as u32;
            }
            let material = chunk
                .iter()
                .map(|tile| (FAMILIES[tile.family], &after.slices[tile.slice].rays[tile.family][tile.rays.clone()]));
            let places = chunk.iter().flat_map(|tile| {
                let row = grid.rows[tile.family];
                tile.rays.clone().map(move |ray| units(row.at_mm(ray), mm_per_unit))
            });
            let mut work = StrokeWork::new(tiles, material, places);
            work.visits = visits.concat();
            work.passes = placed.iter().flat_map(|slice| &slice.records).copied().collect();
            work.outline.clone_from(&outlines.pieces);
            work.mm_per_unit = mm_per_unit as f32;
            work.reach_mm = outlines.reach_mm as f32;
            work.pass_ids = set.first_pass..set.end_pass();
            let done = self.run_strokes(&work, &mut capacity_beside)?;
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

/// Unit of places: the power of two by which the farthest ray and the farthest centre of a tooth in the blank's reach
/// are some 2^29.
fn unit_mm(operation: &BlankOperation, rows: &[RayRow; 2]) -> f64 {
    let teeth_mm = operation.teeth.iter().map(|tooth| tooth.reach_mm).fold(0.0, f64::max);
    let rays_mm = rows.iter().flat_map(|row| [row.first_mm, row.at_mm(row.count)]).map(f64::abs).fold(0.0, f64::max);
    let farthest_mm = rays_mm.max(operation.blank_reach_mm + teeth_mm);
    (farthest_mm.log2().ceil() - PLACE_BITS).exp2()
}

fn units(at_mm: f64, mm_per_unit: f64) -> i32 {
    (at_mm / mm_per_unit).round() as i32
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
            let count = curve.pieces().len();
            pieces.extend(curve.pieces().iter().enumerate().map(|(index, piece)| {
                let node_mm = curve.node_mm(index);
                let rates = if piece.law == Piece::STRAIGHT {
                    [curve.node_mm((index + 1) % count) - node_mm; 2]
                } else {
                    let [start, end] = piece.range;
                    piece.range.map(|at| curve.place(piece.law, at)[1] * (end - start))
                };
                let pair = |v: DVec2| v.as_vec2().to_array();
                OutlinePiece {
                    node_mm: pair(node_mm - tooth.center_mm),
                    rate_start: pair(rates[0]),
                    rate_end: pair(rates[1]),
                    sagitta_mm: piece.sagitta_mm as f32,
                    padding: 0,
                }
            }));
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
                StrokePass {
                    cos: rotation.x,
                    sin: rotation.y,
                    center: pass.center_mm.to_array().map(|at_mm| units(at_mm, mm_per_unit)),
                    first_piece: pieces.start,
                    piece_count: pieces.end - pieces.start,
                    pass_id: set.pass_id(stroke as usize, pass.blade),
                    returns: u32::from(returning),
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
