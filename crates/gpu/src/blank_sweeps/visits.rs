//! Where passes of a hob may find anything: the visits of tiles, with the sections that visit them.
//!
//! In: passes in order of time, what is left of neighbouring slices. Out: for every slice the sections that may meet
//! what is left there, culled as natively, as outlines about their own centres; and which tiles they visit.

use super::left::SliceLeft;
use crate::blank_rays::{outline_pieces, units};
use crate::blank_records::{BlankPass, OutlinePiece};
use gearcut_core::dexel::blank_field::BlankGrid;
use gearcut_core::math::planar_rays::{ClosedCurve, FAMILIES};
use gearcut_core::math::ray_reach::{LooseOutline, RayReach};
use gearcut_core::passes::sections::section_band::{InSlice, SectionBand};
use gearcut_core::passes::sections::swept_sections::{SweepHeading, SweptSection, SweptSections};
use gearcut_shaders::WORKGROUP_THREADS;
use glam::DVec2;
use std::ops::Range;

/// Rays of a tile: one for each thread.
const TILE_RAYS: usize = WORKGROUP_THREADS as usize;

/// Passes and slices that are looked at.
#[derive(Clone, Copy)]
pub(super) struct VisitSearch<'a> {
    pub(super) grid: &'a BlankGrid,
    pub(super) sections: &'a SweptSections,
    /// Unit of places, mm.
    pub(super) mm_per_unit: f64,
}

impl VisitSearch<'_> {
    /// Visits of neighbouring slices, the first of them slice `first` of the grid.
    pub(super) fn of_block(&self, left: &[SliceLeft], first: usize, passes: Range<usize>) -> Vec<SliceVisits> {
        let Self { grid, sections, mm_per_unit } = *self;
        let slices_z_mm = &grid.slices_z_mm[first..first + left.len()];
        let mut visits: Vec<SliceVisits> = left.iter().map(|_| SliceVisits::new(grid)).collect();
        let mut memory = SliceBuffers::default();
        for pass in passes {
            if sections.culls()
                && !memory.band.set(sections, pass, [slices_z_mm[0], slices_z_mm[slices_z_mm.len() - 1]])
            {
                continue;
            }
            for ((visits, &z_mm), left) in visits.iter_mut().zip(slices_z_mm).zip(left) {
                if self.reaches(pass, z_mm, left, &mut memory) {
                    visits.add(&memory, mm_per_unit);
                }
            }
        }
        visits
    }

    /// Whether a pass may meet what is left in a slice, culled as natively; its section and the tiles are then in the
    /// memory.
    fn reaches(&self, pass: usize, z_mm: f64, left: &SliceLeft, memory: &mut SliceBuffers) -> bool {
        let Self { grid, sections, .. } = *self;
        let SliceBuffers { band, section, outline, reach, near } = memory;
        let mut followed = false;
        if sections.culls() {
            match band.bounds(sections, z_mm, outline, section) {
                InSlice::Nowhere => return false,
                InSlice::Within => {}
                InSlice::Followed => followed = true,
            }
        }
        for (f, family) in FAMILIES.into_iter().enumerate() {
            near[f].clear();
            if !sections.culls() {
                near[f].extend(0..grid.rows[f].count.div_ceil(TILE_RAYS));
                continue;
            }
            reach.set(outline, family, &grid.rows[f]);
            left.tables[f].held(reach, &mut near[f]);
            near[f].iter_mut().for_each(|ray| *ray /= TILE_RAYS);
            near[f].dedup();
        }
        !near.iter().all(Vec::is_empty) && (followed || sections.section(pass, z_mm, section))
    }
}

/// Rays of a tile of a family with so many rays.
pub(super) fn tile_rays(tile: usize, count: usize) -> Range<usize> {
    tile * TILE_RAYS..((tile + 1) * TILE_RAYS).min(count)
}

/// What some passes, in order of time, may take of one slice.
pub(super) struct SliceVisits {
    /// Passes that visit any tile.
    pub(super) headings: Vec<(u32, SweepHeading)>,
    /// The same for the kernel; pieces of their outlines count from those of this slice.
    pub(super) passes: Vec<BlankPass>,
    pub(super) outline: Vec<OutlinePiece>,
    /// How far from their centres outlines reach, mm.
    pub(super) reach_mm: f64,
    /// Visits of the tiles of both families.
    pub(super) tiles: [Vec<Vec<u32>>; 2],
}

/// Memory that is used over and over.
#[derive(Default)]
struct SliceBuffers {
    band: SectionBand,
    section: SweptSection,
    outline: LooseOutline,
    reach: RayReach,
    /// Tiles of both families in which a pass may find something.
    near: [Vec<usize>; 2],
}

impl SliceVisits {
    fn new(grid: &BlankGrid) -> Self {
        let no_tiles = |f: usize| vec![Vec::new(); grid.rows[f].count.div_ceil(TILE_RAYS)];
        Self {
            headings: Vec::new(),
            passes: Vec::new(),
            outline: Vec::new(),
            reach_mm: 0.0,
            tiles: [0, 1].map(no_tiles),
        }
    }

    /// Adds the section in the memory, over its tiles.
    fn add(&mut self, SliceBuffers { section, near, .. }: &SliceBuffers, mm_per_unit: f64) {
        let nodes_mm = || (0..section.pieces().len()).map(|index| section.node_mm(index));
        let (low_mm, high_mm) = nodes_mm()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), node| (low.min(node), high.max(node)));
        let center = (0.5 * (low_mm + high_mm)).to_array().map(|at_mm| units(at_mm, mm_per_unit));
        let center_mm = mm_per_unit * DVec2::from_array(center.map(f64::from));
        let sagitta_mm = section.pieces().iter().map(|piece| piece.sagitta_mm).fold(0.0, f64::max);
        let farthest_mm = nodes_mm().map(|node| node.distance(center_mm)).fold(0.0, f64::max);
        self.reach_mm = self.reach_mm.max(farthest_mm + sagitta_mm);
        let (index, first_piece) = (self.passes.len() as u32, self.outline.len() as u32);
        self.outline.extend(outline_pieces(section, center_mm));
        self.passes.push(BlankPass {
            cos: 1.0,
            sin: 0.0,
            center,
            first_piece,
            piece_count: self.outline.len() as u32 - first_piece,
            pass_id: section.pass,
            account: 0,
        });
        self.headings.push((section.pass, section.heading));
        for (tiles, near) in self.tiles.iter_mut().zip(near) {
            for &tile in near {
                tiles[tile].push(index);
            }
        }
    }
}
