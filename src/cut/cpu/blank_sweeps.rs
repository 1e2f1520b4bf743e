//! The blank kernel of hobbing: the sweeps of an operation taken from the blank field in order of time.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`HobSections`]). Out: the field after the operation and what every pass took.
//!
//! Slices go to the cores, each with all its passes in order of time: a sweep is followed into a slice once and laid over the rays of both families. Chips are summed in
//! the order of the slices: same scene, same bytes.

use super::blank::{BlankCut, BlankStats, Scratch, Tile};
use crate::dexel::blank_field::{BlankField, BlankGrid, Slice};
use crate::dexel::intervals::{self, End, Span};
use crate::passes::hob_sections::{HobSections, SweptSection};
use crate::planar_rays::{FAMILIES, Family, RayCrossings};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::ops::Range;

/// What a pass took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassChip {
    /// Pass id.
    pub pass: u32,
    /// Volume by rays of both families, mm3.
    pub removed_mm3: [f64; 2],
    /// Uncut chip thickness: the largest distance of a place of the swept surface from the surface before, mm.
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
            // Half a disc about the thickest place is all chip, or a quarter at a corner: a bound where rays are too far apart to meet the old surface beside them.
            let area_mm2 = removed_mm3[0].min(removed_mm3[1]) / width_mm;
            let thickness_mm = surfaces.thickness_mm(&section, grid.spacing_mm()).min((4.0 * area_mm2 / PI).sqrt());
            let way_mm = section.way_per_mm * width_mm;
            chips.push(PassChip { pass: section.pass, removed_mm3, thickness_mm, way_mm });
        }
    }
    (chips, stats)
}

/// The surfaces of one chip in one slice, as rays meet them.
#[derive(Default)]
struct ChipSurfaces {
    /// Places of the old surface, left by earlier passes or the blank's own, with their normals.
    old: Vec<[DVec2; 2]>,
    /// Places of the new one.
    new: Vec<NewPlace>,
}

/// A place of the new surface.
struct NewPlace {
    at: DVec2,
    normal: DVec2,
    /// How far the old surface at the other end of the chip on the same ray lies from it; where this pass left that end as well, how wide the tool is there, mm.
    across_mm: f64,
}

/// Distance of the old surface from a place of the new one, from the normals (new, old) where a ray `length_mm` long crosses both: to the old tangent, exact for a straight trace, or between two circles about
/// one point, exact for these; the smaller one.
fn between_mm(family: Family, length_mm: f64, normals: [DVec2; 2]) -> f64 {
    let [new, old] = normals.map(|normal| normal * family.along(normal).signum());
    length_mm * family.along(old).min(family.along(new + old) / (1.0 + new.dot(old)))
}

impl ChipSurfaces {
    fn clear(&mut self) {
        self.old.clear();
        self.new.clear();
    }

    /// What a cut takes from one ray.
    fn add(&mut self, family: Family, across_mm: f64, spans: &[Span], [from, to]: [End; 2]) {
        let place = |end: &End| family.point(end.at_mm, across_mm);
        let normal = |end: &End| DVec2::from_array(end.normal.map(f64::from));
        let first = spans.partition_point(|span| span.high.at_mm <= from.at_mm);
        for span in spans[first..].iter().take_while(|span| span.low.at_mm < to.at_mm) {
            let is_old = [span.low.at_mm > from.at_mm, span.high.at_mm < to.at_mm];
            let ends = [if is_old[0] { &span.low } else { &from }, if is_old[1] { &span.high } else { &to }];
            let length_mm = ends[1].at_mm - ends[0].at_mm;
            for side in 0..2 {
                let (end, other) = (ends[side], ends[1 - side]);
                if is_old[side] {
                    self.old.push([place(end), normal(end)]);
                } else if family.along(normal(end)).abs() >= FRAC_1_SQRT_2 {
                    let across_mm = if is_old[1 - side] {
                        between_mm(family, length_mm, [normal(end), normal(other)])
                    } else {
                        length_mm
                    };
                    self.new.push(NewPlace { at: place(end), normal: normal(end), across_mm });
                }
            }
        }
    }

    /// Largest distance of a place of the new surface from the old one, across the swept surface; the old one between its places, `spacing_mm` apart, goes on along its tangents.
    fn thickness_mm(&self, section: &SweptSection, spacing_mm: f64) -> f64 {
        self.new.iter().fold(0.0, |largest_mm, place| {
            let upright = section.upright(place.normal);
            let bound_mm = place.across_mm * upright;
            if bound_mm <= largest_mm {
                return largest_mm;
            }
            let squared = self.old.iter().map(|&[old, normal]| {
                let way = place.at - old;
                let beside_mm = (normal.perp_dot(way).abs() - 0.5 * spacing_mm).max(0.0);
                normal.dot(way).powi(2) + beside_mm * beside_mm
            });
            bound_mm.min(squared.fold(f64::INFINITY, f64::min).sqrt() * upright).max(largest_mm)
        })
    }
}
