//! Passes over the rays of a flank, one by one: how low the edge of each comes.
//!
//! In: a job and a field of rays. Out: the passes near it in strict order of time, and for any of them the place at
//! which a ray enters the cutter's tooth, in f64. Which of them are looked at, and what becomes of the surface, is for
//! the callers: the chips that left a flank ([`super::flank`]) and edges that plough ([`super::ploughing`]).

use super::column_group::ColumnGroup;
use super::deciding::ColumnPasses;
use super::near::{Near, passes_near};
use super::phase_heights::PhaseHeights;
use super::segments::{END_OVERLAP_MM, Reaching, SegmentSet, Segments};
use super::shared_segment::{SharedSegment, front};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::edge_polygon::EdgeSide;
use gearcut_core::dexel::field::{Column, Field, NO_PASS};
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::planar::strokes::StrokePath;
use gearcut_core::tool::edge::Edge;
use gearcut_core::tool::{CuttingTool, PlanarTool};
use std::ops::Range;

/// What a ray knows at some moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct RaySurface {
    /// Where the surface stands, mm.
    pub height_mm: f64,
    /// Thickness of the chip that left it, mm; not a number before the first one.
    pub thickness_mm: f64,
    /// Part of the edge that took it.
    pub side: Option<EdgeSide>,
    /// The pass that took it.
    pub pass: u32,
}

impl RaySurface {
    /// A ray that nothing has cut yet.
    pub fn uncut(ray: &Column) -> Self {
        Self { height_mm: ray.blank_mm, thickness_mm: f64::NAN, side: None, pass: NO_PASS }
    }
}

/// Where a ray enters a tooth of the cutter.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeEntry {
    /// Height, mm.
    pub height_mm: f64,
    /// Cosine between ray and edge normal.
    pub cosine: f64,
    /// Part of the edge.
    pub side: EdgeSide,
    /// Place of the segment in the edge.
    pub segment: usize,
}

/// A pass that is looked at.
pub(super) struct Chosen {
    /// Its id.
    pub id: u32,
    operation: usize,
    blade: u32,
    path: StrokePath,
    segments: SegmentSet,
    /// It leaves no ray of the column lower than this.
    lowest: PhaseHeights,
}

/// Passes near a field.
pub(super) struct FieldPasses<'a> {
    job: &'a ShapingJob,
    segments: Segments<'a>,
    /// The blades' own edges, in turn.
    edges: &'a [Edge],
    near: Vec<Near>,
    blades: Vec<Rigid2>,
    /// Phases of all operations, row by row.
    phases: Vec<Vec<f64>>,
    /// How many rows of the field each of those stands for.
    pub copies: usize,
    pairing: Pairing,
}

/// Which rays of a field there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pairing {
    /// In every column one in each row.
    All,
    /// In every column one, in the row of the same number.
    Diagonal,
}

impl<'a> FieldPasses<'a> {
    /// As the cutter's edges are.
    pub fn new(job: &'a ShapingJob, field: &Field, pairing: Pairing) -> Self {
        Self::with_edges(job, field, pairing, job.cutter.edges().edges())
    }

    /// With edges that are smooth along their length.
    pub fn of_smooth_edges(job: &'a ShapingJob, field: &Field, pairing: Pairing) -> Self {
        Self::with_edges(job, field, pairing, std::slice::from_ref(job.cutter.edge()))
    }

    fn with_edges(job: &'a ShapingJob, field: &Field, pairing: Pairing, edges: &'a [Edge]) -> Self {
        let rows_z_mm: &[f64] = if job.planar().rows_are_alike() { &[0.0] } else { &field.rows_z_mm };
        let phases = |&z_mm: &f64| job.operations.iter().map(|o| o.strokes.law.tau(z_mm)).collect();
        Self {
            job,
            segments: Segments::new(job.cutter.edge(), edges),
            edges,
            near: passes_near(job, field),
            blades: (0..job.cutter.blade_count()).map(|b| job.cutter.tool_from_blade(b).inverse()).collect(),
            phases: rows_z_mm.iter().map(phases).collect(),
            copies: if pairing == Pairing::All { field.rows() / rows_z_mm.len() } else { 1 },
            pairing,
        }
    }

    /// Nothing known yet of the passes over a group of columns but which of them lay lowest on the group before.
    pub fn group(&self, columns: &[Column], before: Option<ColumnGroup>) -> ColumnGroup {
        ColumnGroup::new(columns, self.near.len(), before)
    }

    /// The same passes, each changed.
    #[cfg(test)]
    pub fn with_each(mut self, change: impl Fn(&mut Near)) -> Self {
        self.near.iter_mut().for_each(change);
        self
    }

    /// The passes over one column of a group.
    pub fn over<'b>(&'b self, group: &'b mut ColumnGroup, ray: &'b Column) -> ColumnPasses<'b> {
        ColumnPasses::new(&self.segments, &self.near, ray, group)
    }

    /// Rows of a column that differ.
    pub fn rows(&self, column: usize) -> Range<usize> {
        match self.pairing {
            Pairing::Diagonal if self.phases.len() > 1 => column..column + 1,
            _ => 0..self.phases.len(),
        }
    }

    /// How many operations there are.
    pub fn operations(&self) -> usize {
        self.job.operations.len()
    }

    /// Places of an operation's passes among those near the field.
    pub fn of_operation(&self, operation: usize) -> Range<usize> {
        let until = |end: usize| self.near.partition_point(|pass| pass.operation < end);
        until(operation)..until(operation + 1)
    }

    /// Passes ready to be looked at.
    pub fn chosen(&self, reaching: Vec<Reaching>) -> Vec<Chosen> {
        let ready = |reaching: Reaching| {
            let &Near { operation, stroke, blade, .. } = &self.near[reaching.near];
            let strokes = &self.job.operations[operation].strokes;
            let (id, path) = (strokes.pass_id(stroke, blade), strokes.path(stroke));
            Chosen { id, operation, blade, path, segments: reaching.segments, lowest: reaching.lowest }
        };
        reaching.into_iter().map(ready).collect()
    }

    /// Phase of a pass in a row.
    pub fn tau(&self, pass: &Chosen, row: usize) -> f64 {
        self.phases[row][pass.operation]
    }

    /// A pass leaves no ray of its column lower than this in a row.
    pub fn lowest_mm(&self, pass: &Chosen, row: usize) -> f64 {
        pass.lowest.at_mm(self.tau(pass, row))
    }

    /// Whether the axes rest during the strokes of some passes.
    pub fn rest(&self, chosen: &[Chosen]) -> bool {
        chosen.iter().all(|pass| self.job.operations[pass.operation].strokes.law.rests())
    }

    /// Where a ray in a row enters the tooth of a pass first, if that lies lower than `surface_mm`.
    pub fn entry(&self, pass: &Chosen, row: usize, ray: &Column, surface_mm: f64) -> Option<EdgeEntry> {
        if self.lowest_mm(pass, row) >= surface_mm {
            return None;
        }
        self.entry_at(pass, self.tau(pass, row), ray, surface_mm)
    }

    /// The same at a phase of the pass.
    pub fn entry_at(&self, pass: &Chosen, tau: f64, ray: &Column, surface_mm: f64) -> Option<EdgeEntry> {
        let work_from_tool = pass.path.at(tau);
        let blade_from_work = self.blades[pass.blade as usize].after(&work_from_tool.inverse());
        let (origin, direction) = (blade_from_work.point(ray.origin_mm), blade_from_work.direction(ray.normal));
        // Kernels follow rays down to twice their lowest height and record the lowest one there.
        let below_mm = 2.0 * ray.low_mm;
        let mut lowest: Option<EdgeEntry> = None;
        let edge = &self.edges[pass.blade as usize % self.edges.len()];
        for (index, part) in self.segments.of(pass.segments) {
            let segment = &edge.segments[index];
            let SharedSegment { segment_from_blade, .. } = part;
            let (o, n) = (segment_from_blade.point(origin), segment_from_blade.direction(direction));
            if front(segment, o, n, surface_mm).is_some_and(|front| front.residual_mm > 0.0) {
                if part.holds_smooth_tool() {
                    return None;
                }
                continue;
            }
            let [from, to] = [segment.y_range_mm[0] - END_OVERLAP_MM, segment.y_range_mm[1] + END_OVERLAP_MM];
            let Some(hit) = segment.enter(o, n).filter(|hit| (from..=to).contains(&hit.y_mm)) else { continue };
            if hit.height_mm > below_mm && lowest.is_none_or(|lowest| hit.height_mm < lowest.height_mm) {
                let (height_mm, cosine) = (hit.height_mm, hit.normal.dot(n).abs());
                lowest = Some(EdgeEntry { height_mm, cosine, side: EdgeSide::of(segment.name), segment: index });
            }
        }
        lowest.filter(|entry| entry.height_mm < surface_mm)
    }
}
