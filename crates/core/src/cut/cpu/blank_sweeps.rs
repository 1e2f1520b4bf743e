//! The blank kernel of hobbing: the sweeps of an operation taken from the blank field in order of time.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`SweptSections`]). Out: the field after the operation
//! and what every pass took.
//!
//! Some neighbouring slices go to a core together, with all passes in order of time. Most passes go where nothing is
//! left: one section in the middle of the slices tells where a pass may be in each of them ([`SectionBand`]), and that
//! is compared with what is left there ([`RayReach`], [`SpanTable`]). Only a pass that may find something is followed
//! into the slice and laid over those rays, of both families, near which it may. What a slice is left with does not
//! depend on the others, and chips are summed in the order of the slices: same scene, same bytes.
//! `tests/suite/hobbing/blank.rs` compares spans, marks and chips with those of all passes on all rays, bit for bit,
//! and plants a culling that is wrong.

use super::blank::{RayTile, Scratch};
use crate::cut::sweep_chips::{ChipAccumulator, ChipSurfaces, PassChip, SweepsCut};
use crate::cut::{BlankStats, WatchCuts};
use crate::dexel::blank_field::{BlankField, BlankGrid, Slice};
use crate::dexel::span_table::SpanTable;
use crate::math::planar_rays::FAMILIES;
use crate::math::ray_reach::{LooseOutline, RayReach};
use crate::passes::sections::section_band::{InSlice, SectionBand};
use crate::passes::sections::swept_sections::{SweptSection, SweptSections};
use rayon::prelude::*;
use std::ops::Range;

/// Most slices that are cut together.
const BLOCK_SLICES: usize = 8;

/// Runs an operation whose passes have the ids `passes`; `advance` is called as often as there are slices and says
/// whether to go on. `None`: stopped.
pub fn cut(
    field: &mut BlankField,
    sections: &SweptSections,
    passes: Range<u32>,
    advance: &(dyn Fn() -> bool + Sync),
) -> Option<SweepsCut> {
    cut_watched(field, sections, passes, advance, &|_, _, _, _| {})
}

/// The same, every cut shown to `watch`.
pub fn cut_watched(
    field: &mut BlankField,
    sections: &SweptSections,
    passes: Range<u32>,
    advance: &(dyn Fn() -> bool + Sync),
    watch: &WatchCuts,
) -> Option<SweepsCut> {
    let grid = &field.grid;
    let block = block_slices(grid, sections);
    let widths_mm = grid.slice_widths_mm();
    let blocks: Vec<Vec<(Vec<PassChip>, BlankStats)>> = field
        .slices
        .par_chunks_mut(block)
        .enumerate()
        .map(|(place, slices)| {
            let cuts = slices.iter_mut().enumerate().map(|(i, slice)| SliceCut {
                index: (place * block + i) as u32,
                z_mm: grid.slices_z_mm[place * block + i],
                width_mm: widths_mm[place * block + i],
                left: [0, 1].map(|f: usize| SpanTable::new(&slice.rays[f])),
                slice,
                chips: Vec::new(),
                stats: BlankStats::default(),
            });
            cut_block(grid, cuts.collect(), sections, advance, watch)
        })
        .collect::<Option<_>>()?;
    let mut accumulator = ChipAccumulator::new(passes);
    let mut stats = BlankStats::default();
    for (of_slice, met) in blocks.into_iter().flatten() {
        for chip in &of_slice {
            accumulator.add(chip);
        }
        stats += met;
    }
    Some(accumulator.finish(stats))
}

/// Slices that are cut together: as many as a section in their middle tells about.
pub fn block_slices(grid: &BlankGrid, sections: &SweptSections) -> usize {
    let spacing_mm = grid.slice_spacing_mm();
    ((sections.band_mm() / spacing_mm) as usize + 1).min(BLOCK_SLICES)
}

/// A slice while it is cut.
struct SliceCut<'a> {
    slice: &'a mut Slice,
    index: u32,
    z_mm: f64,
    width_mm: f64,
    /// What is left on the rays of both families, at a glance.
    left: [SpanTable; 2],
    chips: Vec<PassChip>,
    stats: BlankStats,
}

/// Memory that is used over and over.
#[derive(Default)]
struct SweepBuffers {
    band: SectionBand,
    section: SweptSection,
    outline: LooseOutline,
    reach: RayReach,
    /// Rays of both families on which a pass may find something.
    near: [Vec<usize>; 2],
    tile: Scratch,
    surfaces: ChipSurfaces,
}

/// Neighbouring slices with all passes in order of time. `advance` is called as often as there are slices, whenever
/// another such share of the passes is done.
fn cut_block(
    grid: &BlankGrid,
    mut slices: Vec<SliceCut>,
    sections: &SweptSections,
    advance: &(dyn Fn() -> bool + Sync),
    watch: &WatchCuts,
) -> Option<Vec<(Vec<PassChip>, BlankStats)>> {
    let mut memory = SweepBuffers::default();
    let z_range_mm = [slices[0].z_mm, slices[slices.len() - 1].z_mm];
    let shares = slices.len();
    for share in 0..shares {
        for pass in sections.len() * share / shares..sections.len() * (share + 1) / shares {
            if !sections.culls() || memory.band.set(sections, pass, z_range_mm) {
                for slice in &mut slices {
                    slice.cut(grid, sections, pass, &mut memory, watch);
                }
            }
        }
        if !advance() {
            return None;
        }
    }
    Some(slices.into_iter().map(|slice| (slice.chips, slice.stats)).collect())
}

impl SliceCut<'_> {
    fn cut(
        &mut self,
        grid: &BlankGrid,
        sections: &SweptSections,
        pass: usize,
        memory: &mut SweepBuffers,
        watch: &WatchCuts,
    ) {
        let index = self.index as usize;
        let SweepBuffers { band, section, outline, reach, near, tile: scratch, surfaces } = memory;
        let mut followed = false;
        if sections.culls() {
            match band.bounds(sections, self.z_mm, outline, section) {
                InSlice::Nowhere => return,
                InSlice::Within => {}
                InSlice::Followed => followed = true,
            }
            for (f, family) in FAMILIES.into_iter().enumerate() {
                reach.set(outline, family, &grid.rows[f]);
                self.stats.visited += reach.rays.len() as u64;
                self.left[f].held(reach, &mut near[f]);
            }
            if near.iter().all(Vec::is_empty) {
                return;
            }
        } else {
            for (near, row) in near.iter_mut().zip(&grid.rows) {
                near.clear();
                near.extend(0..row.count);
            }
        }
        if !followed && !sections.section(pass, self.z_mm, section) {
            return;
        }
        let mut removed_mm3 = [0.0; 2];
        surfaces.clear();
        for (f, family) in FAMILIES.into_iter().enumerate() {
            let (Some(&first), Some(&last)) = (near[f].first(), near[f].last()) else { continue };
            let rays = &mut self.slice.rays[f][first..=last];
            let row = &grid.rows[f];
            let mut tile = RayTile { family, row, first, rays, slice: self.index };
            let mut met = BlankStats::default();
            let mut next = near[f].iter().copied().peekable();
            let wanted = |ray: usize| {
                while next.next_if(|near| *near < ray).is_some() {}
                next.peek() == Some(&ray)
            };
            let removed_mm = tile.take(section, section.pass, scratch, &mut met, wanted, |ray, spans, cut| {
                watch(index, family, ray, cut);
                surfaces.add(family, row.at_mm(ray), spans, cut);
            });
            if sections.culls() {
                // Counted above, when they were compared with what is left.
                met.visited = 0;
            }
            self.stats += met;
            removed_mm3[f] = removed_mm * grid.spacing_mm() * self.width_mm;
            for &ray in &near[f] {
                self.left[f].renew(ray, &self.slice.rays[f][ray]);
            }
        }
        if removed_mm3 != [0.0; 2] {
            let spacing_mm = grid.spacing_mm();
            let chip =
                PassChip::of_slice(section.pass, &section.heading, removed_mm3, self.width_mm, surfaces, spacing_mm);
            self.chips.push(chip);
        }
    }
}
