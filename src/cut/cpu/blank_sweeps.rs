//! The blank kernel of hobbing: the sweeps of an operation taken from the blank field in order of time.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`HobSections`]). Out: the field after the operation and what every pass took.
//!
//! Slices go to the cores, each with all its passes in order of time: a sweep is followed into a slice once and laid over the rays of both families. Chips are summed in
//! the order of the slices: same scene, same bytes.

use super::blank::{BlankStats, Scratch, Tile};
use crate::cut::sweep_chips::{ChipBooks, ChipSurfaces, PassChip, SweepsCut};
use crate::dexel::blank_field::{BlankField, BlankGrid, Slice};
use crate::dexel::intervals;
use crate::passes::hob_sections::{HobSections, SweptSection};
use crate::planar_rays::{FAMILIES, RayCrossings};
use rayon::prelude::*;
use std::ops::Range;

/// Runs an operation whose passes have the ids `passes`; `advance` is called after every slice and says whether to go on. `None`: stopped.
pub fn cut(
    field: &mut BlankField,
    sections: &HobSections,
    passes: Range<u32>,
    advance: &(dyn Fn() -> bool + Sync),
) -> Option<SweepsCut> {
    let grid = &field.grid;
    let cuts: Vec<Option<(Vec<PassChip>, BlankStats)>> = field
        .slices
        .par_iter_mut()
        .zip(grid.slice_widths_mm())
        .enumerate()
        .map(|(index, (slice, width_mm))| {
            let cut = cut_slice(grid, slice, index, width_mm, sections);
            advance().then_some(cut)
        })
        .collect();
    let mut books = ChipBooks::new(passes);
    let mut stats = BlankStats::default();
    for cut in cuts {
        let (of_slice, met) = cut?;
        for chip in &of_slice {
            books.enter(chip);
        }
        stats += met;
    }
    Some(books.close(stats))
}

/// Chips of one slice in order of time.
fn cut_slice(
    grid: &BlankGrid,
    slice: &mut Slice,
    index: usize,
    width_mm: f64,
    sections: &HobSections,
) -> (Vec<PassChip>, BlankStats) {
    let (mut chips, mut stats) = (Vec::new(), BlankStats::default());
    let (mut scratch, mut section) = (Scratch::default(), SweptSection::default());
    let (mut surfaces, mut reach_mm) = (ChipSurfaces::default(), Vec::new());
    for pass in 0..sections.len() {
        if !sections.section(pass, grid.leads_mm[index], &mut section) {
            continue;
        }
        let mut removed_mm3 = [0.0; 2];
        surfaces.clear();
        for (f, family) in FAMILIES.into_iter().enumerate() {
            let row = &grid.rows[f];
            let [low, high] = section.across_mm(family).map(|across| row.first_at_or_above(across));
            if low >= high {
                continue;
            }
            // Most passes go where nothing is left: bounds of all rays come first, and only the rays between the first and the last one near material are laid on the curve.
            RayCrossings::reach_mm(&section, family, row, low..high, &mut reach_mm);
            let rays = &slice.rays[f];
            let near = |ray: &usize| {
                let [from, to] = reach_mm[ray - low];
                from <= to && intervals::overlaps(&rays[*ray], from, to)
            };
            stats.visited += (high - low) as u64;
            let Some(first) = (low..high).find(near) else { continue };
            let last = (first..high).rev().find(near).unwrap_or(first);
            let rays = &mut slice.rays[f][first..=last];
            let mut tile = Tile { family, row, first, rays, slice: index as u32 };
            // Rays are counted above.
            let mut met = BlankStats::default();
            let removed_mm = tile.take(&section, section.pass, &mut scratch, &mut met, |across_mm, spans, cut| {
                surfaces.add(family, across_mm, spans, cut);
            });
            stats.solved += met.solved;
            stats.removing += met.removing;
            removed_mm3[f] = removed_mm * grid.spacing_mm() * width_mm;
        }
        if removed_mm3 != [0.0; 2] {
            chips.push(PassChip::of_slice(
                section.pass,
                &section.heading,
                removed_mm3,
                width_mm,
                &surfaces,
                grid.spacing_mm(),
            ));
        }
    }
    (chips, stats)
}
