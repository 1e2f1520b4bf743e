//! The blank field of hobbing on the GPU: sweeps of hob teeth taken from rays in f32.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`SweptSections`]), as
//! [`gearcut_core::cut::cpu::blank_sweeps`]. Out: the field after the operation and what every pass took. The host
//! follows every sweep into every slice in f64 and hands over the cubics of its section, tile by tile in the tile's
//! frame; the shader finds roots and keeps the lists, as in shaping ([`super::blank_rays`]).
//!
//! **Candidates.** Most sweeps go where nothing is left. Passes go to the device in chunks of time; when a chunk is
//! composed, the rays are back from the one before, and tiles are visited only by passes whose bounds meet material
//! that was left then, as on the processor. A pass that is visited for nothing takes nothing: results do not depend on
//! the chunks but for the rounding of lengths.
//!
//! **Chips.** Volume and travel follow from what every pass took of every tile. The thickness needs both surfaces of a
//! chip: the shader lists every piece of material with its ends, old and new, and the host measures between them by the
//! native kernel's own code.
//!
//! The road not taken: sections laid over the rays by the device. It would have to split curves where they turn back
//! across the rays, in f32 and to the same bits for both parts, or lose the pairing of crossings on which the kernel
//! rests.

use super::blank_rays::{PassWork, TakenPiece, Terms, TileDone, TileWork, parts};
use super::context::Gpu;
use super::problem::GpuProblem;
use gearcut_core::cut::BlankStats;
use gearcut_core::cut::cpu::blank_sweeps::block_slices;
use gearcut_core::cut::sweep_chips::{ChipAccumulator, ChipSurfaces, PassChip, SweepsCut};
use gearcut_core::dexel::blank_field::{BlankField, BlankGrid, Slice};
use gearcut_core::dexel::span_table::SpanTable;
use gearcut_core::math::planar_rays::{FAMILIES, Family, RayCrossings};
use gearcut_core::math::ray_reach::{LooseOutline, RayReach};
use gearcut_core::passes::sections::section_band::{InSlice, SectionBand};
use gearcut_core::passes::sections::swept_sections::{SweepHeading, SweptSection, SweptSections};
use gearcut_shaders::WORKGROUP_THREADS;
use rayon::prelude::*;
use std::ops::Range;

/// Passes that are composed together: some turns of the hob. Fewer leave the device waiting for the host, more visit
/// rays for nothing.
const CHUNK_PASSES: usize = 512;
/// Tiles of one submission, of all slices: 65,536 rays fill a large GPU; their lists and parts are some tens of
/// megabytes.
const GROUP_TILES: usize = 1024;
/// Pieces of a launch that there is room for at first, for each span that a ray has room for.
const PIECES_PER_SPAN: usize = 1 << 13;
/// Rays of a tile: one for each thread.
const TILE_RAYS: usize = WORKGROUP_THREADS as usize;

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
        let grid = field.grid.clone();
        let mut slices = field.slices.clone();
        // No ray holds more than the blank is wide.
        let widest_mm = grid.rows.iter().map(|row| row.count as f64 * row.spacing_mm).fold(0.0, f64::max);
        let mut terms = Terms::new(grid.spacing_mm(), widest_mm, first_room);
        terms.piece_room = (PIECES_PER_SPAN * terms.first_room).max(1);
        let block = block_slices(&grid, sections);
        let mut accumulator = ChipAccumulator::new(passes);
        let mut advanced = 0;
        for first in (0..sections.len()).step_by(CHUNK_PASSES) {
            let chunk = first..(first + CHUNK_PASSES).min(sections.len());
            let visits: Vec<Vec<SliceVisits>> = slices
                .par_chunks(block)
                .enumerate()
                .map(|(place, slices)| SliceVisits::of_block(&grid, slices, place * block, sections, chunk.clone()))
                .collect();
            let mut work = Vec::new();
            let mut places = Vec::new();
            let mut headings = Vec::new();
            for (index, (visits, slice)) in visits.into_iter().flatten().zip(&slices).enumerate() {
                headings.push(visits.headings);
                for (f, tiles) in visits.tiles.into_iter().enumerate() {
                    for (tile, passes) in tiles.into_iter().enumerate().filter(|(_, passes)| !passes.is_empty()) {
                        let rays = tile_rays(tile, grid.rows[f].count);
                        places.push(SweptTilePlace { slice: index, family: f, first: rays.start });
                        work.push(TileWork { family: FAMILIES[f], rays: &slice.rays[f][rays], passes });
                    }
                }
            }
            let mut done = Vec::new();
            for group in work.chunks(GROUP_TILES) {
                done.extend(self.run_blank_tiles(group, &mut terms)?);
            }
            drop(work);
            let done: Vec<(SweptTilePlace, TileDone)> = places.into_iter().zip(done).collect();
            let of_slices: Vec<&[(SweptTilePlace, TileDone)]> =
                done.chunk_by(|(a, _), (b, _)| a.slice == b.slice).collect();
            let chips: Vec<Vec<PassChip>> =
                of_slices.into_par_iter().map(|tiles| chips_of_slice(&grid, &headings, tiles)).collect();
            for chip in chips.iter().flatten() {
                accumulator.add(chip);
            }
            for (place, tile) in done {
                let rays = &mut slices[place.slice].rays[place.family][place.first..][..tile.rays.len()];
                for (old, new) in rays.iter_mut().zip(tile.rays) {
                    *old = new;
                }
            }
            // Progress is told in slices, all of which are as far as the passes are.
            while advanced < grid.slices_z_mm.len() * chunk.end / sections.len() {
                advanced += 1;
                if !advance() {
                    return Ok(None);
                }
            }
        }
        field.slices = slices;
        Ok(Some(accumulator.finish(BlankStats::default())))
    }
}

/// Where a tile stands.
struct SweptTilePlace {
    slice: usize,
    family: usize,
    first: usize,
}

fn tile_rays(tile: usize, count: usize) -> Range<usize> {
    tile * TILE_RAYS..((tile + 1) * TILE_RAYS).min(count)
}

/// What some passes, in order of time, may take of one slice.
struct SliceVisits {
    /// Passes that visit any tile.
    headings: Vec<(u32, SweepHeading)>,
    /// Visits of the tiles of both families.
    tiles: [Vec<Vec<PassWork>>; 2],
}

/// Memory that is used over and over.
#[derive(Default)]
struct SliceBuffers {
    band: SectionBand,
    section: SweptSection,
    outline: LooseOutline,
    reach: RayReach,
    crossings: RayCrossings,
    /// Tiles of both families in which a pass may find something.
    near: [Vec<usize>; 2],
}

impl SliceVisits {
    /// Visits of neighbouring slices, the first of them slice `first` of the grid.
    fn of_block(
        grid: &BlankGrid,
        slices: &[Slice],
        first: usize,
        sections: &SweptSections,
        passes: Range<usize>,
    ) -> Vec<Self> {
        let slices_z_mm = &grid.slices_z_mm[first..first + slices.len()];
        let left: Vec<[SpanTable; 2]> =
            slices.iter().map(|slice| [0, 1].map(|f: usize| SpanTable::new(&slice.rays[f]))).collect();
        let no_tiles = |f: usize| (0..grid.rows[f].count.div_ceil(TILE_RAYS)).map(|_| Vec::new()).collect();
        let mut visits: Vec<Self> =
            slices.iter().map(|_| Self { headings: Vec::new(), tiles: [0, 1].map(no_tiles) }).collect();
        let mut memory = SliceBuffers::default();
        for pass in passes {
            if sections.culls()
                && !memory.band.set(sections, pass, [slices_z_mm[0], slices_z_mm[slices_z_mm.len() - 1]])
            {
                continue;
            }
            for ((visits, &z_mm), left) in visits.iter_mut().zip(slices_z_mm).zip(&left) {
                visits.add(grid, sections, pass, z_mm, left, &mut memory);
            }
        }
        visits
    }

    /// Adds a pass where it may meet what is left, culled as natively.
    fn add(
        &mut self,
        grid: &BlankGrid,
        sections: &SweptSections,
        pass: usize,
        z_mm: f64,
        left: &[SpanTable; 2],
        memory: &mut SliceBuffers,
    ) {
        let SliceBuffers { band, section, outline, reach, crossings, near } = memory;
        let mut followed = false;
        if sections.culls() {
            match band.bounds(sections, z_mm, outline, section) {
                InSlice::Nowhere => return,
                InSlice::Within => {}
                InSlice::Followed => followed = true,
            }
        }
        for (f, family) in FAMILIES.into_iter().enumerate() {
            near[f].clear();
            if !sections.culls() {
                near[f].extend(0..self.tiles[f].len());
                continue;
            }
            reach.set(outline, family, &grid.rows[f]);
            for (ray, places_mm) in reach.rays.clone().zip(&reach.places_mm) {
                let tile = ray / TILE_RAYS;
                if near[f].last() != Some(&tile) && left[f].may_hold(ray, *places_mm) {
                    near[f].push(tile);
                }
            }
        }
        if near.iter().all(Vec::is_empty) || (!followed && !sections.section(pass, z_mm, section)) {
            return;
        }
        let mut visiting = false;
        for (f, family) in FAMILIES.into_iter().enumerate() {
            let row = &grid.rows[f];
            for &tile in &near[f] {
                // All rays of the tile: one that is not near must cross the curve in pairs as well.
                let parts = parts(crossings, section, family, row, tile_rays(tile, row.count));
                if !parts.is_empty() {
                    self.tiles[f][tile].push(PassWork { id: section.pass, parts });
                    visiting = true;
                }
            }
        }
        if visiting {
            self.headings.push((section.pass, section.heading));
        }
    }
}

/// Chips of one slice in order of time, from what its tiles came back with.
fn chips_of_slice(
    grid: &BlankGrid,
    headings: &[Vec<(u32, SweepHeading)>],
    tiles: &[(SweptTilePlace, TileDone)],
) -> Vec<PassChip> {
    let slice = tiles[0].0.slice;
    let width_mm = grid.slice_widths_mm()[slice];
    let headings = &headings[slice];
    let mut removed_mm3 = vec![[0.0; 2]; headings.len()];
    let index = |pass: u32| headings.partition_point(|(other, _)| *other < pass);
    let mut pieces: Vec<(&TakenPiece, Family, f64)> = Vec::new();
    for (place, tile) in tiles {
        let (row, family) = (&grid.rows[place.family], FAMILIES[place.family]);
        for &(pass, length_mm) in &tile.removed_mm {
            removed_mm3[index(pass)][place.family] += length_mm * grid.spacing_mm() * width_mm;
        }
        pieces.extend(tile.pieces.iter().map(|piece| (piece, family, row.at_mm(place.first + piece.ray))));
    }
    // Stable: within a pass families and rays stay in their order.
    pieces.sort_by_key(|(piece, _, _)| piece.pass);
    let mut of_passes = pieces.chunk_by(|a, b| a.0.pass == b.0.pass).peekable();
    let mut surfaces = ChipSurfaces::default();
    let mut chips = Vec::new();
    for ((pass, heading), removed_mm3) in headings.iter().zip(removed_mm3) {
        surfaces.clear();
        if let Some(own) = of_passes.next_if(|pieces| pieces[0].0.pass == *pass) {
            for (piece, family, at_mm) in own {
                surfaces.add_piece(*family, *at_mm, &piece.span, *pass);
            }
        }
        if removed_mm3 != [0.0; 2] {
            chips.push(PassChip::of_slice(*pass, heading, removed_mm3, width_mm, &surfaces, grid.spacing_mm()));
        }
    }
    chips
}
