//! The blank kernel: strokes of an operation taken from the blank field in order of time.
//!
//! In: a [`BlankField`], the strokes, the closed teeth of the cutter. Out: the field after the operation, the volume
//! that every pass removed, and where the return strokes rub.
//!
//! A tile is some neighbouring rays of one family in one slice. It takes its candidate passes in order of time: the
//! tooth's outline is placed in the work once, [`RayCrossings`] lays it over the rays, and rays whose crossings cannot
//! reach material are left alone before anything is solved. What a ray is left with does not depend on tiles, threads
//! or candidates, and the volumes are summed in the order of the tiles: same scene, same bytes.
//!
//! After each stroke the cutter goes back, drawn off by the relief motion; if return poses are given, material that
//! their teeth would enter is reported, and left where it is.

use crate::cut::{BlankCut, BlankOperation, BlankStats, Rub, WatchCuts};
use crate::dexel::blank_field::{BlankField, RayMaterial};
use crate::dexel::intervals::{self, End, Span};
use crate::frame::Rigid2;
use crate::math::planar_rays::{ClosedCurve, CurveCrossing, FAMILIES, Family, RayCrossings, RayRow};
use crate::passes::planar::blank_candidates::{PlacedPass, passes_at, reaching_strip};
use crate::tool::closed_tooth::PlacedScratch;
use rayon::prelude::*;

/// Rays of a tile: a cutter tooth of module 3 at 0.1 mm covers one or two tiles.
pub const TILE_RAYS: usize = 64;

/// Rays that meet an edge at least this steeply (cosine to its normal) tell how deep it lies: every edge is met so by
/// one of the two families.
const STEEP: f64 = 0.7;

/// One tile's share of a [`BlankCut`].
#[derive(Default)]
struct RayTileCut {
    removed_mm: Vec<(u32, f64)>,
    rubs: Vec<Rub>,
    stats: BlankStats,
}

/// Steps that [`cut`] reports for a field: tiles in all slices.
pub fn steps(field: &BlankField) -> u64 {
    let tiles: usize = field.grid.rows.iter().map(|row| row.count.div_ceil(TILE_RAYS)).sum();
    (tiles * field.slices.len()) as u64
}

/// Runs an operation; `advance` is called after every tile and says whether to go on. `None`: stopped.
pub fn cut(
    field: &mut BlankField,
    operation: &BlankOperation,
    advance: &(dyn Fn() -> bool + Sync),
) -> Option<BlankCut> {
    cut_watched(field, operation, advance, &|_, _, _, _| {})
}

/// The same, every cut shown to `watch`.
pub fn cut_watched(
    field: &mut BlankField,
    operation: &BlankOperation,
    advance: &(dyn Fn() -> bool + Sync),
    watch: &WatchCuts,
) -> Option<BlankCut> {
    let set = operation.strokes;
    let grid = field.grid.clone();
    let mut result =
        BlankCut { removed_mm3: vec![[0.0; 2]; (set.end_pass() - set.first_pass) as usize], ..BlankCut::default() };
    for ((index, slice), width_mm) in field.slices.iter_mut().enumerate().zip(grid.slice_widths_mm()) {
        let tau = set.law.tau(grid.slices_z_mm[index]);
        let reach_mm = if operation.cull { operation.blank_reach_mm } else { f64::INFINITY };
        let place = |set| passes_at(set, tau, operation.tool, operation.teeth, reach_mm);
        let passes = place(set);
        let returns = operation.returns.map(place).unwrap_or_default();
        let tiles = slice.rays.iter_mut().zip(FAMILIES).zip(&grid.rows).flat_map(|((rays, family), row)| {
            rays.chunks_mut(TILE_RAYS).enumerate().map(move |(tile, rays)| RayTile {
                family,
                row,
                first: tile * TILE_RAYS,
                rays,
                slice: index as u32,
            })
        });
        let tiles: Vec<RayTile> = tiles.collect();
        let area_per_length = grid.spacing_mm() * width_mm;
        let cuts: Vec<(Family, Option<RayTileCut>)> = tiles
            .into_par_iter()
            .map(|tile| {
                (tile.family, advance().then(|| tile.cut(operation, [&passes, &returns], area_per_length, watch)))
            })
            .collect();
        for (family, cut) in cuts {
            let cut = cut?;
            for (pass, length_mm) in cut.removed_mm {
                result.removed_mm3[(pass - set.first_pass) as usize][family as usize] += length_mm * area_per_length;
            }
            result.rubs.extend(cut.rubs);
            result.stats += cut.stats;
        }
    }
    Some(result)
}

/// Where the return strokes rub on one tile of a slice, its strokes taken from a copy: for backends that know that
/// something rubs there and not where.
pub fn rubs_of_tile(
    field: &BlankField,
    [slice, family, first]: [usize; 3],
    count: usize,
    operation: &BlankOperation,
    passes_and_returns: [&[PlacedPass]; 2],
) -> Vec<Rub> {
    let grid = &field.grid;
    let mut rays = field.slices[slice].rays[family][first..first + count].to_vec();
    let (row, family) = (&grid.rows[family], FAMILIES[family]);
    let tile = RayTile { family, row, first, rays: &mut rays, slice: slice as u32 };
    let volume_per_length = grid.spacing_mm() * grid.slice_widths_mm()[slice];
    tile.cut(operation, passes_and_returns, volume_per_length, &|_, _, _, _| {}).rubs
}

/// Neighbouring rays of one family in one slice.
pub(super) struct RayTile<'a> {
    pub family: Family,
    pub row: &'a RayRow,
    pub first: usize,
    pub rays: &'a mut [RayMaterial],
    pub slice: u32,
}

/// Scratch memory of a tile.
#[derive(Default)]
pub(super) struct Scratch {
    crossings: RayCrossings,
    found: Vec<CurveCrossing>,
    cuts: Vec<(usize, End, End)>,
}

impl RayTile<'_> {
    fn cut(
        mut self,
        operation: &BlankOperation,
        [passes, returns]: [&[PlacedPass]; 2],
        volume_per_length: f64,
        watch: &WatchCuts,
    ) -> RayTileCut {
        let strip = if operation.cull {
            [self.row.at_mm(self.first), self.row.at_mm(self.first + self.rays.len() - 1)]
        } else {
            [f64::NEG_INFINITY, f64::INFINITY]
        };
        let (slice, family) = (self.slice as usize, self.family);
        let (mut scratch, mut placed) = (Scratch::default(), PlacedScratch::default());
        let mut done = RayTileCut::default();
        let mut returns = reaching_strip(returns, operation.teeth, self.family, strip).peekable();
        // The stroke that a return stroke follows, with the same cutter tooth.
        let stroke_of = |back: &PlacedPass| {
            let found = passes.binary_search_by_key(&(back.stroke, back.blade), |pass| (pass.stroke, pass.blade));
            found.ok().map(|index| &passes[index])
        };
        for pass in reaching_strip(passes, operation.teeth, self.family, strip) {
            while let Some(back) = returns.next_if(|back| back.stroke < pass.stroke) {
                let tooth = operation.teeth[back.edge].placed(&back.work_from_blade, &mut placed);
                let id = operation.strokes.pass_id(back.stroke as usize, back.blade);
                let motion = (&back.work_from_blade, stroke_of(back).map(|stroke| &stroke.work_from_blade));
                self.check_return(&tooth, id, motion, volume_per_length, &mut scratch, &mut done);
            }
            let tooth = operation.teeth[pass.edge].placed(&pass.work_from_blade, &mut placed);
            let id = operation.strokes.pass_id(pass.stroke as usize, pass.blade);
            let shown = |ray, _: &[Span], ends| watch(slice, family, ray, ends);
            let removed_mm = self.take(&tooth, id, &mut scratch, &mut done.stats, |_| true, shown);
            if removed_mm > 0.0 {
                done.removed_mm.push((id, removed_mm));
            }
        }
        for back in returns {
            let tooth = operation.teeth[back.edge].placed(&back.work_from_blade, &mut placed);
            let id = operation.strokes.pass_id(back.stroke as usize, back.blade);
            let motion = (&back.work_from_blade, stroke_of(back).map(|stroke| &stroke.work_from_blade));
            self.check_return(&tooth, id, motion, volume_per_length, &mut scratch, &mut done);
        }
        done
    }

    /// Calls `act` with every ray that the curve crosses near material, the crossings solved; `wanted` is asked first,
    /// ray by ray in their order.
    fn visit(
        &self,
        curve: &impl ClosedCurve,
        scratch: &mut Scratch,
        stats: &mut BlankStats,
        mut wanted: impl FnMut(usize) -> bool,
        mut act: impl FnMut(usize, f64, &[CurveCrossing]),
    ) {
        scratch.crossings.lay(curve, self.family, self.row, self.first..self.first + self.rays.len());
        for ray in scratch.crossings.touched() {
            if !wanted(ray) || !scratch.crossings.crosses(ray) {
                continue;
            }
            stats.visited += 1;
            let at_mm = self.row.at_mm(ray);
            let [low, high] = scratch.crossings.bounds_mm(ray, at_mm);
            if !intervals::overlaps(&self.rays[ray - self.first], low, high) {
                continue;
            }
            stats.solved += 1;
            scratch.crossings.solve(curve, self.family, ray, at_mm, &mut scratch.found);
            act(ray - self.first, at_mm, &scratch.found);
        }
    }

    /// Takes what lies inside a curve from the rays that are wanted, as they are asked about in their order; gives the
    /// length removed, mm. `chip` is shown each ray before: its number, its spans, the ends of the cut.
    pub fn take(
        &mut self,
        curve: &impl ClosedCurve,
        pass: u32,
        scratch: &mut Scratch,
        stats: &mut BlankStats,
        wanted: impl FnMut(usize) -> bool,
        mut chip: impl FnMut(usize, &[Span], [End; 2]),
    ) -> f64 {
        let mut removed_mm = 0.0;
        let mut cuts = std::mem::take(&mut scratch.cuts);
        self.visit(curve, scratch, stats, wanted, |ray, _, crossings| {
            for [from, to] in crossings.as_chunks::<2>().0 {
                let [from, to] =
                    [from, to].map(|c| End { at_mm: c.at_mm, pass, normal: (-c.outward()).as_vec2().to_array() });
                cuts.push((ray, from, to));
            }
        });
        for (ray, from, to) in cuts.drain(..) {
            chip(self.first + ray, &self.rays[ray], [from, to]);
            let length_mm = intervals::subtract(&mut self.rays[ray], from, to);
            if length_mm > 0.0 {
                removed_mm += length_mm;
                stats.removing += 1;
            }
        }
        scratch.cuts = cuts;
        removed_mm
    }

    fn check_return(
        &self,
        tooth: &impl ClosedCurve,
        pass: u32,
        (work_from_edge, at_stroke): (&Rigid2, Option<&Rigid2>),
        volume_per_length: f64,
        scratch: &mut Scratch,
        done: &mut RayTileCut,
    ) {
        let mut uncounted = BlankStats::default();
        let family = self.family;
        let edge_from_work = work_from_edge.inverse();
        let rubs = &mut done.rubs;
        self.visit(
            tooth,
            scratch,
            &mut uncounted,
            |_| true,
            |ray, at_mm, crossings| {
                for [from, to] in crossings.as_chunks::<2>().0 {
                    // Each piece of material by itself: a tooth between two of them enters both, and neither by the
                    // sum.
                    for span in &self.rays[ray] {
                        let (low_mm, high_mm) = (span.low.at_mm.max(from.at_mm), span.high.at_mm.min(to.at_mm));
                        let length_mm = high_mm - low_mm;
                        if length_mm <= intervals::LEAST_SPAN_MM {
                            continue;
                        }
                        // Along the edge's normal the material is at most as thick as this; rays that graze say little
                        // and leave the depth to the other family. Nor can the edge enter deeper than it has moved
                        // along its normal since it cut there: a ray may run along a thin sliver.
                        let ends = [(from, span.low.at_mm < from.at_mm), (to, span.high.at_mm > to.at_mm)];
                        let steep = |c: &CurveCrossing| family.along(c.outward()).abs();
                        let moved_mm = |c: &CurveCrossing| {
                            // A tooth that met nothing on its way down has no stroke here.
                            let Some(at_stroke) = at_stroke else { return f64::INFINITY };
                            let place_mm = family.point(c.at_mm, at_mm);
                            let before_mm = at_stroke.point(edge_from_work.point(place_mm));
                            (place_mm - before_mm).dot(c.outward()).max(0.0)
                        };
                        let inside = ends.iter().filter(|(c, inside)| *inside && steep(c) >= STEEP);
                        let depth = inside.map(|(c, _)| moved_mm(c).min(length_mm * steep(c))).reduce(f64::min);
                        rubs.push(Rub {
                            pass,
                            slice: self.slice,
                            place_mm: family.point(0.5 * (low_mm + high_mm), at_mm),
                            depth_mm: depth.unwrap_or(0.0),
                            volume_mm3: length_mm * volume_per_length,
                            family,
                        });
                    }
                }
            },
        );
    }
}
