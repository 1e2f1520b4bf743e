//! The blank field of hobbing on the GPU: sweeps of hob teeth taken from rays in f32.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`SweptSections`]), as
//! [`gearcut_core::cut::cpu::blank_sweeps`]. Out: the field after the operation and what every pass took. The host
//! follows every sweep into every slice in f64 and hands over its section once, from the section's own centre; the
//! shader lays it over the rays of all tiles that it visits, as cutter teeth in shaping ([`super::blank_rays`]).
//!
//! **Candidates.** Most sweeps go where nothing is left. Passes go to the device in chunks of time, while the lists of
//! all rays stay there; every chunk brings back the pieces of material that it took, and tiles are visited only by
//! passes whose bounds meet material that was left then, as on the processor. A pass that is visited for nothing takes
//! nothing: results do not depend on the chunks. The lists themselves come back once, at the end.
//!
//! **Chips.** Volume and travel follow from what every pass took of every slice. The thickness needs both surfaces of a
//! chip: a piece has both ends, old and new, and the host measures between them by the native kernel's own code.

mod left;
mod visits;

use super::blank_rays::{CutOutcome, PackedRays, RayLists, RayPasses, RaysCut, list_bytes, unit_mm, units};
use super::blank_records::{BlankPass, BlankPiece, BlankTile};
use super::context::Gpu;
use super::problem::GpuProblem;
use gearcut_core::cut::BlankStats;
use gearcut_core::cut::cpu::blank_sweeps::block_slices;
use gearcut_core::cut::sweep_chips::{ChipAccumulator, PassChip, SweepsCut};
use gearcut_core::dexel::blank_field::{BlankField, BlankGrid, Slice};
use gearcut_core::math::planar_rays::FAMILIES;
use gearcut_core::passes::sections::swept_sections::{SweepHeading, SweptSections};
use left::{SliceLeft, chips_of_slice};
use rayon::prelude::*;
use std::ops::Range;
use visits::{SliceVisits, VisitSearch, tile_rays};

/// Passes that are composed together: some turns of the hob. Fewer leave the device waiting for the host, more visit
/// rays for nothing.
const CHUNK_PASSES: usize = 512;
/// Spans that a ray has room for at first, beside those it has: a ray through a gear of 35 teeth meets six.
const FIRST_ROOM: usize = 8;
/// Pieces of a launch that there is room for at first, for each span that a ray has room for.
const PIECES_PER_SPAN: usize = 1 << 13;
/// Units of the ledger in a millimetre: a quarter of a nanometre each.
const UNITS_PER_MM: f64 = (1 << 22) as f64;

impl Gpu {
    /// Runs an operation whose passes have the ids `passes`; `first_room` spans are reserved beside those that a ray
    /// has, pieces in proportion, and more when they are needed. `advance` is called as often as there are slices and
    /// says whether to go on; `None`: stopped.
    ///
    /// # Errors
    /// The device fails, or a ray crosses one section more than eight times; the field is then as it was.
    pub fn cut_blank_sweeps_on_device(
        &self,
        field: &mut BlankField,
        sections: &SweptSections,
        passes: Range<u32>,
        first_room: Option<usize>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<SweepsCut>, GpuProblem> {
        self.device.alive()?;
        let first_room = first_room.unwrap_or(FIRST_ROOM);
        let mut run = SweepRun {
            gpu: self,
            grid: &field.grid,
            sections,
            mm_per_unit: unit_mm(farthest_mm(&field.grid, sections)),
            first_room,
            piece_room: (PIECES_PER_SPAN * first_room).max(1),
            accumulator: ChipAccumulator::new(passes),
        };
        let mut slices = Vec::with_capacity(field.slices.len());
        let mut waiting: Vec<Range<usize>> = std::iter::once(0..field.slices.len()).collect();
        while let Some(some) = waiting.pop() {
            match run.cut_slices(&field.slices[some.clone()], some.clone(), advance)? {
                SlicesCut::Stopped => return Ok(None),
                SlicesCut::Done(left) => slices.extend(left),
                SlicesCut::NoRoom { .. } if some.len() > 1 => {
                    let middle = some.start.midpoint(some.end);
                    waiting.extend([middle..some.end, some.start..middle]);
                }
                SlicesCut::NoRoom { bytes, limit } => {
                    let reason = format!("lists of the rays of one slice need {bytes} of {limit} bytes");
                    return Err(GpuProblem::OutOfMemory { reason });
                }
            }
        }
        let cut = run.accumulator.finish(BlankStats::default());
        field.slices = slices;
        Ok(Some(cut))
    }
}

/// The farthest place of a ray, or of a section that reaches one, mm.
fn farthest_mm(grid: &BlankGrid, sections: &SweptSections) -> f64 {
    let ends_mm = grid.rows.iter().flat_map(|row| [row.first_mm, row.at_mm(row.count)]);
    ends_mm.map(f64::abs).fold(0.0, f64::max) + sections.reach_mm()
}

/// An operation while it runs.
struct SweepRun<'a> {
    gpu: &'a Gpu,
    grid: &'a BlankGrid,
    sections: &'a SweptSections,
    /// Unit of places, mm.
    mm_per_unit: f64,
    /// Spans that a ray has room for at first, beside those it has.
    first_room: usize,
    /// Pieces of a launch that there is room for.
    piece_room: usize,
    accumulator: ChipAccumulator,
}

/// How slices ended.
enum SlicesCut {
    Done(Vec<Slice>),
    Stopped,
    /// Their lists do not fit the device together.
    NoRoom {
        bytes: u64,
        limit: u64,
    },
}

impl SweepRun<'_> {
    /// Runs all passes over neighbouring slices.
    fn cut_slices(
        &mut self,
        slices: &[Slice],
        places: Range<usize>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<SlicesCut, GpuProblem> {
        let (gpu, grid, sections) = (self.gpu, self.grid, self.sections);
        let mut lists = PackedRays::default();
        for slice in slices {
            for (f, family) in FAMILIES.into_iter().enumerate() {
                for (index, ray) in slice.rays[f].iter().enumerate() {
                    lists.push(ray, family, units(grid.rows[f].at_mm(index), self.mm_per_unit));
                }
            }
        }
        let limits = gpu.allowance();
        // Lists in slots, what they were before, and on their way.
        let limit = limits.buffer_bytes.min(limits.batch_bytes / 3);
        let mut room = lists.longest() + self.first_room;
        let rays = lists.rays.len();
        let bytes = |room: usize| list_bytes(rays, room);
        if bytes(room) > limit {
            return Ok(SlicesCut::NoRoom { bytes: bytes(room), limit });
        }
        let mut on_device = RayLists::new(gpu, &lists, room, true)?;
        let mut left: Vec<SliceLeft> = slices.par_iter().map(SliceLeft::new).collect();
        let (mut expected, mut advanced) = (0, 0);
        for first in (0..sections.len()).step_by(CHUNK_PASSES) {
            let chunk = first..(first + CHUNK_PASSES).min(sections.len());
            let mut composed = self.compose(&left, places.start, chunk.clone());
            let cut = loop {
                composed.work.piece_room = self.piece_room;
                let sent = on_device.send(&composed.tiles, &composed.work, expected)?;
                let (spans, pieces) = match on_device.collect(sent)? {
                    CutOutcome::Done(cut) => break cut,
                    CutOutcome::NeedsRoom { spans, pieces } => (spans, pieces),
                };
                on_device.take_back()?;
                if pieces > 0 {
                    self.piece_room = pieces.max(2 * self.piece_room);
                }
                if spans > 0 {
                    lists = on_device.all()?;
                    room = spans.max(2 * room);
                    if bytes(room) > limit {
                        return Ok(SlicesCut::NoRoom { bytes: bytes(room), limit });
                    }
                    on_device = RayLists::new(gpu, &lists, room, true)?;
                }
            };
            expected = cut.pieces.len() + cut.pieces.len() / 4;
            self.take(&mut left, &composed, cut);
            // Progress is told in slices, all of which are as far as the passes are.
            while advanced < slices.len() * chunk.end / sections.len() {
                advanced += 1;
                if !advance() {
                    return Ok(SlicesCut::Stopped);
                }
            }
        }
        let lists = on_device.all()?;
        let rows = &grid.rows;
        let cut = (0..slices.len()).into_par_iter().map(|slice| {
            let of_family = |f: usize| {
                let first = slice * self.rays_of_slice() + f * rows[0].count;
                (first..first + rows[f].count)
                    .map(|ray| lists.list(ray, FAMILIES[f]))
                    .collect::<Result<_, GpuProblem>>()
            };
            Ok(Slice { rays: [of_family(0)?, of_family(1)?] })
        });
        Ok(SlicesCut::Done(cut.collect::<Result<_, GpuProblem>>()?))
    }

    fn rays_of_slice(&self) -> usize {
        self.grid.rows.iter().map(|row| row.count).sum()
    }

    /// Passes of a chunk where they may meet what is left; the first of the slices is slice `first` of the grid.
    fn compose(&self, left: &[SliceLeft], first: usize, chunk: Range<usize>) -> ComposedChunk {
        let (grid, sections) = (self.grid, self.sections);
        let search = VisitSearch { grid, sections, mm_per_unit: self.mm_per_unit };
        let block = block_slices(grid, sections);
        let visits: Vec<Vec<SliceVisits>> = left
            .par_chunks(block)
            .enumerate()
            .map(|(place, left)| search.of_block(left, first + place * block, chunk.clone()))
            .collect();
        let mut composed =
            ComposedChunk { tiles: Vec::new(), work: RayPasses::default(), first_slice: first, headings: Vec::new() };
        let work = &mut composed.work;
        work.mm_per_unit = self.mm_per_unit as f32;
        let mut reach_mm = 0.0_f64;
        for (slice, visits) in visits.into_iter().flatten().enumerate() {
            let (first_pass, first_piece) = (work.passes.len() as u32, work.outline.len() as u32);
            for (f, tiles) in visits.tiles.iter().enumerate() {
                let first_ray = slice * self.rays_of_slice() + f * grid.rows[0].count;
                for (tile, visits) in tiles.iter().enumerate().filter(|(_, visits)| !visits.is_empty()) {
                    let visits: Vec<u32> = visits.iter().map(|pass| first_pass + pass).collect();
                    let rays = tile_rays(tile, grid.rows[f].count);
                    let rays = first_ray + rays.start..first_ray + rays.end;
                    composed.tiles.push(work.tile(rays, f, UNITS_PER_MM, &visits));
                }
            }
            work.passes.extend(visits.passes.iter().enumerate().map(|(index, pass)| BlankPass {
                first_piece: first_piece + pass.first_piece,
                account: first_pass + index as u32,
                ..*pass
            }));
            work.outline.extend(visits.outline);
            reach_mm = reach_mm.max(visits.reach_mm);
            composed.headings.push(visits.headings);
        }
        work.accounts = work.passes.len();
        work.reach_mm = (reach_mm as f32).next_up();
        composed
    }

    /// Takes over what a chunk did: chips, and what is left where.
    fn take(&mut self, left: &mut [SliceLeft], composed: &ComposedChunk, mut cut: RaysCut) {
        let rays_of_slice = self.rays_of_slice();
        let slice_of = |piece: &BlankPiece| piece.ray as usize / rays_of_slice;
        // Threads list their pieces as they come.
        cut.pieces.par_sort_unstable_by(|a, b| {
            let place = |piece: &BlankPiece| (slice_of(piece), piece.pass_id, piece.ray);
            place(a).cmp(&place(b)).then(a.span.low_mm.total_cmp(&b.span.low_mm))
        });
        let (mut pieces, mut removed) = (&cut.pieces[..], &cut.removed[..]);
        let of_slices: Vec<(&[BlankPiece], &[[u64; 2]])> = composed
            .headings
            .iter()
            .enumerate()
            .map(|(slice, headings)| {
                let (own, others) = pieces.split_at(pieces.partition_point(|piece| slice_of(piece) == slice));
                let (sums, rest) = removed.split_at(headings.len());
                (pieces, removed) = (others, rest);
                (own, sums)
            })
            .collect();
        let grid = self.grid;
        let widths_mm = grid.slice_widths_mm();
        let chips: Vec<Vec<PassChip>> = left
            .par_iter_mut()
            .zip(of_slices)
            .zip(&composed.headings)
            .enumerate()
            .map(|(slice, ((left, (pieces, removed)), headings))| {
                let first_ray = slice * rays_of_slice;
                left.take(pieces, first_ray, grid.rows[0].count);
                chips_of_slice(grid, widths_mm[composed.first_slice + slice], headings, removed, pieces, first_ray)
            })
            .collect();
        chips.iter().flatten().for_each(|chip| self.accumulator.add(chip));
    }
}

/// Passes of a chunk over the tiles of some slices.
struct ComposedChunk {
    tiles: Vec<BlankTile>,
    work: RayPasses,
    /// First of the slices in the grid.
    first_slice: usize,
    /// Passes of every slice, in the order of their accounts.
    headings: Vec<Vec<(u32, SweepHeading)>>,
}
