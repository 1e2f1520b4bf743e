//! The blank kernel of hobbing: the sweeps of an operation taken from the blank field in order of time.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`HobSections`]). Out: the field after the operation and what every pass took.
//!
//! Slices go to the cores, each with all its passes in order of time: a sweep is followed into a slice once and laid over the rays of both families. Chips are summed in
//! the order of the slices: same scene, same bytes.

use super::blank::{BlankCut, BlankStats, Scratch, Tile};
use crate::dexel::blank_field::{BlankField, BlankGrid, Slice};
use crate::passes::hob_sections::{HobSections, SweptSection};
use crate::planar_rays::FAMILIES;
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// Rays within 45 degrees of the radial direction tell how thick a chip is: others run along it.
const RADIAL_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// What a pass took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassChip {
    /// Pass id.
    pub pass: u32,
    /// Volume by rays of both families, mm3.
    pub removed_mm3: [f64; 2],
    /// Largest uncut thickness across the swept surface, mm.
    pub thickness_mm: f64,
    /// Way of the tip while anything was taken, mm.
    pub way_mm: f64,
}

/// What an operation did.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepsCut {
    /// As for every process.
    pub cut: BlankCut,
    /// Passes that took anything, in order.
    pub chips: Vec<PassChip>,
}

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
    let nothing = |pass| PassChip { pass, removed_mm3: [0.0; 2], thickness_mm: 0.0, way_mm: 0.0 };
    let mut chips: Vec<PassChip> = passes.clone().map(nothing).collect();
    let mut stats = BlankStats::default();
    for cut in cuts {
        let (of_slice, met) = cut?;
        for chip in of_slice {
            let sum = &mut chips[(chip.pass - passes.start) as usize];
            sum.removed_mm3 = [0, 1].map(|f| sum.removed_mm3[f] + chip.removed_mm3[f]);
            sum.thickness_mm = sum.thickness_mm.max(chip.thickness_mm);
            sum.way_mm += chip.way_mm;
        }
        stats += met;
    }
    let removed_mm3 = chips.iter().map(|chip| chip.removed_mm3).collect();
    chips.retain(|chip| chip.removed_mm3 != [0.0; 2]);
    Some(SweepsCut { cut: BlankCut { removed_mm3, stats, ..BlankCut::default() }, chips })
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
    for pass in 0..sections.len() {
        if !sections.section(pass, grid.leads_mm[index], &mut section) {
            continue;
        }
        let (mut removed_mm3, mut thickness_mm) = ([0.0; 2], 0.0_f64);
        for (f, family) in FAMILIES.into_iter().enumerate() {
            let row = &grid.rows[f];
            let [low, high] = section.across_mm(family).map(|across| row.first_at_or_above(across));
            if low >= high {
                continue;
            }
            let rays = &mut slice.rays[f][low..high];
            let mut tile = Tile { family, row, first: low, rays, slice: index as u32 };
            let removed_mm = tile.take(&section, section.pass, &mut scratch, &mut stats, |across_mm, ends, length_mm| {
                let inner = if ends[0].at_mm.abs() < ends[1].at_mm.abs() { ends[0] } else { ends[1] };
                let place = family.point(inner.at_mm, across_mm);
                if family.along(place).abs() < RADIAL_COSINE * place.length() {
                    return;
                }
                let normal = DVec2::from_array(inner.normal.map(f64::from));
                let cosine = family.along(normal).abs() * section.upright(normal);
                thickness_mm = thickness_mm.max(length_mm * cosine);
            });
            removed_mm3[f] = removed_mm * grid.spacing_mm() * width_mm;
        }
        if removed_mm3 != [0.0; 2] {
            let way_mm = section.way_per_mm * width_mm;
            chips.push(PassChip { pass: section.pass, removed_mm3, thickness_mm, way_mm });
        }
    }
    (chips, stats)
}
