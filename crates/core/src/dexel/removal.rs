//! When the material of a blank goes: for every node of the grid the pass that first takes it, and between two nodes
//! the place where the surface rests.
//!
//! In: an uncut [`BlankField`], then every cut of every pass as the native kernels show it
//! ([`crate::cut::WatchCuts`]). Out: [`Removal`], from which the section after any pass follows: a node is material
//! until its pass, and where one of two neighbours is material, the surface lies between them at the edge's end.
//!
//! The law: a cut is a closed interval on a ray. A node goes with the earliest pass whose cuts cover it. Between a node
//! that is gone and its neighbour that is not, the surface is the furthest end of the cuts that came over the first; it
//! moves until the second goes. Of its places the one is kept at which it rests longest, counted in passes: the
//! finished surface where the second node stays, usually the blank's where the first was never material, and what an
//! operation leaves for the next one, all to half a step of [`EDGE_STEPS`]. In between it is off by less than the
//! grid's spacing. Material and gaps thinner than the spacing, between two nodes, are not seen.
//!
//! Road not taken: all spans after every pass. They are a hundred times as much, for steps that no picture shows.

use super::NO_PASS;
use super::blank_field::{BlankField, BlankGrid, RayMaterial};
use super::intervals::{End, contains};
use crate::math::planar_rays::{FAMILIES, Family, RayRow};
use std::sync::{Mutex, PoisonError};

/// Steps in which the place of a surface between two nodes is kept: of rays 0.25 mm apart 4 µm, far below a pixel.
pub const EDGE_STEPS: u8 = 63;
/// Steps by which places differ where the surface rests for less than this share of all passes: a seventh of the
/// spacing, to keep few bytes.
const PASSING: (u8, f64) = (9, 0.03);

/// Node outside of the blank; other values are one more than the pass that takes the node.
const OUTSIDE: u32 = 0;

/// What is known so far, while passes cut.
#[derive(Debug)]
pub struct RemovalWatch {
    grid: BlankGrid,
    /// Slices, families, rays. A ray belongs to one core at a time, so that its lock is free.
    slices: Vec<[Vec<Mutex<WatchedRay>>; 2]>,
}

/// Nodes and edges of a ray.
#[derive(Debug)]
struct WatchedRay {
    /// When the nodes go.
    nodes: Vec<u32>,
    /// How far cuts have come over the edge behind each node, from the node and from the next one, in steps.
    reached: Vec<[u8; 2]>,
    /// How they came there, in order of time.
    moves: Vec<SurfaceMove>,
}

/// The surface on an edge moves.
#[derive(Debug, Clone, Copy)]
struct SurfaceMove {
    /// Edge, by the node before it.
    edge: usize,
    /// 0 where it comes from that node, 1 from the next one.
    from: usize,
    /// Steps from that node.
    steps: u8,
    /// When, as of nodes.
    time: u32,
}

/// Where a surface rests, and since when or how long.
#[derive(Debug, Clone, Copy, Default)]
struct Rest {
    time: u32,
    steps: u8,
}

/// When the nodes of a slice go and where the surface rests between them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Removal {
    /// Row by row along x: `None` outside of the blank, otherwise the pass that first takes the node, [`NO_PASS`] where
    /// none does.
    pub nodes: Vec<Option<u32>>,
    /// In the order of the nodes: where the surface rests on the edge from a node to the next one along x and along y,
    /// in steps from the node; 0 where both go together.
    pub edges: [Vec<u8>; 2],
}

impl RemovalWatch {
    /// The uncut blank.
    pub fn new(field: &BlankField) -> Self {
        let grid = field.grid.clone();
        let rays = |family: Family, rays: &[RayMaterial]| {
            let along = along(&grid, family);
            rays.iter().map(|spans| Mutex::new(WatchedRay::new(spans, along))).collect()
        };
        let slices = field.slices.iter().map(|slice| FAMILIES.map(|family| rays(family, &slice.rays[family as usize])));
        Self { slices: slices.collect(), grid }
    }

    /// Takes a cut: what [`crate::cut::WatchCuts`] is shown.
    pub fn note(&self, slice: usize, family: Family, ray: usize, [from, to]: [End; 2]) {
        let along = along(&self.grid, family);
        let ray = &self.slices[slice][family as usize][ray];
        let mut ray = ray.lock().unwrap_or_else(PoisonError::into_inner);
        let time = from.pass + 1;
        let first = along.first_at_or_above(from.at_mm);
        for node in (first..along.count).take_while(|&node| along.at_mm(node) <= to.at_mm) {
            ray.nodes[node] = ray.nodes[node].min(time);
        }
        ray.end(along, to.at_mm, 0, time);
        ray.end(along, from.at_mm, 1, time);
    }

    /// What was found, slice by slice.
    pub fn finish(self) -> Vec<Removal> {
        let rows = self.grid.rows[0].count;
        let removal = |[x, y]: [Vec<Mutex<WatchedRay>>; 2]| {
            let [x, y] = [x, y].map(|rays| {
                let rays = rays.into_iter().map(|ray| ray.into_inner().unwrap_or_else(PoisonError::into_inner));
                rays.collect::<Vec<WatchedRay>>()
            });
            let last = x.iter().flat_map(|ray| &ray.nodes).copied().filter(|&time| time != NO_PASS).max();
            let passes = last.unwrap_or_default();
            let [along_x, along_y] = [&x, &y].map(|rays| rays.iter().map(|ray| ray.rests(passes)).collect::<Vec<_>>());
            let by_rows = (0..rows).flat_map(|row| along_y.iter().map(move |ray| ray[row]));
            let nodes = x.iter().flat_map(|ray| &ray.nodes).map(|&node| match node {
                OUTSIDE => None,
                NO_PASS => Some(NO_PASS),
                time => Some(time - 1),
            });
            Removal { nodes: nodes.collect(), edges: [along_x.concat(), by_rows.collect()] }
        };
        self.slices.into_iter().map(removal).collect()
    }
}

/// Nodes along the rays of a family.
fn along(grid: &BlankGrid, family: Family) -> &RayRow {
    &grid.rows[1 - family as usize]
}

impl WatchedRay {
    fn new(spans: &RayMaterial, along: &RayRow) -> Self {
        let node = |node| if contains(spans, along.at_mm(node)) { NO_PASS } else { OUTSIDE };
        let nodes = (0..along.count).map(node).collect();
        let mut ray = Self { nodes, reached: vec![[0; 2]; along.count], moves: Vec::new() };
        for span in spans {
            ray.end(along, span.low.at_mm, 0, OUTSIDE);
            ray.end(along, span.high.at_mm, 1, OUTSIDE);
        }
        ray
    }

    /// An end of material: what lies before it (`from` 0) or behind it (1) is gone.
    fn end(&mut self, along: &RayRow, at_mm: f64, from: usize, time: u32) {
        let place = (at_mm - along.first_mm) / along.spacing_mm;
        if place < 0.0 || place >= (along.count - 1) as f64 {
            return;
        }
        let edge = place as usize;
        let share = place - edge as f64;
        let steps = (f64::from(EDGE_STEPS) * if from == 0 { share } else { 1.0 - share }).round() as u8;
        let reached = &mut self.reached[edge][from];
        if steps > *reached {
            *reached = steps;
            self.moves.push(SurfaceMove { edge, from, steps, time });
        }
    }

    /// Where the surface rests longest on the edges behind the nodes, in steps from these; of so many passes.
    fn rests(&self, passes: u32) -> Vec<u8> {
        let times = |edge: usize| [self.nodes[edge], self.nodes[(edge + 1).min(self.nodes.len() - 1)]];
        // Since when the surface rests where, and its longest rest so far, between the times at which the nodes go.
        let mut edges = vec![(Rest::default(), Rest::default()); self.nodes.len()];
        let end = |edge: usize, (now, longest): &mut (Rest, Rest), until: u32| {
            let [here, next] = times(edge);
            let (first, second) = (here.min(next), here.max(next));
            let lasts = until.min(second).saturating_sub(now.time.max(first));
            if lasts > longest.time {
                *longest = Rest { time: lasts, ..*now };
            }
        };
        for &SurfaceMove { edge, from, steps, time } in &self.moves {
            let [here, next] = times(edge);
            if from == usize::from(here > next) {
                end(edge, &mut edges[edge], time);
                edges[edge].0 = Rest { time, steps };
            }
        }
        let (coarse, share) = PASSING;
        let place = |(edge, rests): (usize, &mut (Rest, Rest))| {
            end(edge, rests, NO_PASS);
            let Rest { time: lasts, steps } = rests.1;
            let passes_by = f64::from(lasts) < share * f64::from(passes);
            let steps = if passes_by { (steps + coarse / 2) / coarse * coarse } else { steps };
            match times(edge) {
                [here, next] if here < next => steps,
                [here, next] if here > next => EDGE_STEPS - steps,
                _ => 0,
            }
        };
        edges.iter_mut().enumerate().map(place).collect()
    }
}
