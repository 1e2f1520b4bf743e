//! The blank kernel of hobbing: the sweeps of an operation taken from the blank field in order of time.
//!
//! In: a [`BlankField`], the passes as sections in its slices ([`HobSections`]). Out: the field after the operation and what every pass took.
//!
//! Slices go to the cores, each with all its passes in order of time: a sweep is followed into a slice once and laid over the rays of both families. Chips are summed in
//! the order of the slices: same scene, same bytes.

use super::blank::{BlankCut, BlankStats, Scratch, Tile};
use crate::dexel::blank_field::{BlankField, BlankGrid, Slice};
use crate::dexel::intervals::{self, End, Span};
use crate::passes::hob_sections::{HobSections, SweepHeading, SweptSection};
use crate::planar_rays::{FAMILIES, Family, RayCrossings};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

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

/// Chips of an operation while they come in, slice by slice.
pub(in crate::cut) struct ChipBooks {
    first_pass: u32,
    chips: Vec<PassChip>,
}

impl ChipBooks {
    /// For passes with the ids `passes`.
    pub fn new(passes: Range<u32>) -> Self {
        let nothing = |pass| PassChip { pass, removed_mm3: [0.0; 2], thickness_mm: 0.0, way_mm: 0.0 };
        Self { first_pass: passes.start, chips: passes.map(nothing).collect() }
    }

    /// Adds a chip of one slice.
    pub fn enter(&mut self, chip: &PassChip) {
        let sum = &mut self.chips[(chip.pass - self.first_pass) as usize];
        sum.removed_mm3 = [0, 1].map(|f| sum.removed_mm3[f] + chip.removed_mm3[f]);
        sum.thickness_mm = sum.thickness_mm.max(chip.thickness_mm);
        sum.way_mm += chip.way_mm;
    }

    /// What the operation did.
    pub fn close(mut self, stats: BlankStats) -> SweepsCut {
        let removed_mm3 = self.chips.iter().map(|chip| chip.removed_mm3).collect();
        self.chips.retain(|chip| chip.removed_mm3 != [0.0; 2]);
        SweepsCut { cut: BlankCut { removed_mm3, stats, ..BlankCut::default() }, chips: self.chips }
    }
}

impl PassChip {
    /// What a pass took of a slice of the face.
    pub(in crate::cut) fn of_slice(
        pass: u32,
        heading: &SweepHeading,
        removed_mm3: [f64; 2],
        width_mm: f64,
        surfaces: &ChipSurfaces,
    ) -> Self {
        // Around a place that far from the old surface the chip holds a quarter of a disc at least: where it is thinner than the rays are apart, single rays run along it and tell nothing.
        let area_mm2 = removed_mm3[0].min(removed_mm3[1]) / width_mm;
        let thickness_mm = surfaces.thickness_mm(heading).min((4.0 * area_mm2 / PI).sqrt());
        Self { pass, removed_mm3, thickness_mm, way_mm: heading.way_per_mm * width_mm }
    }
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
            chips.push(PassChip::of_slice(section.pass, &section.heading, removed_mm3, width_mm, &surfaces));
        }
    }
    (chips, stats)
}

/// Points of the surfaces of one chip in one slice, with their normals.
#[derive(Default)]
pub(in crate::cut) struct ChipSurfaces {
    /// Left by earlier passes, or the blank's own.
    old: Vec<[DVec2; 2]>,
    /// Left by this one.
    new: Vec<[DVec2; 2]>,
}

impl ChipSurfaces {
    /// No chip.
    pub fn clear(&mut self) {
        self.old.clear();
        self.new.clear();
    }

    /// What a cut takes from one ray.
    fn add(&mut self, family: Family, across_mm: f64, spans: &[Span], [from, to]: [End; 2]) {
        let first = spans.partition_point(|span| span.high.at_mm <= from.at_mm);
        for span in spans[first..].iter().take_while(|span| span.low.at_mm < to.at_mm) {
            let low = if span.low.at_mm > from.at_mm { span.low } else { from };
            let high = if span.high.at_mm < to.at_mm { span.high } else { to };
            self.add_piece(family, across_mm, &Span { low, high }, from.pass);
        }
    }

    /// Material that a pass takes from one ray; ends that it leaves bear its id.
    pub fn add_piece(&mut self, family: Family, across_mm: f64, piece: &Span, pass: u32) {
        for end in [&piece.low, &piece.high] {
            let place = [family.point(end.at_mm, across_mm), DVec2::from_array(end.normal.map(f64::from))];
            if end.pass == pass { self.new.push(place) } else { self.old.push(place) }
        }
    }

    /// Second largest distance of points of the new surface from the tangents at the nearest points of the old one, across the swept surface: what one ray alone sees is a corner.
    fn thickness_mm(&self, heading: &SweepHeading) -> f64 {
        let thickness = self.new.iter().filter_map(|[at, normal]| {
            let distance = |old: &[DVec2; 2]| old[0].distance_squared(*at);
            let nearest = self.old.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            Some((nearest[0] - *at).dot(nearest[1]).abs() * heading.upright(*normal))
        });
        let largest = thickness.fold([0.0_f64; 2], |[first, second], mm| [first.max(mm), second.max(mm.min(first))]);
        largest[1]
    }
}
