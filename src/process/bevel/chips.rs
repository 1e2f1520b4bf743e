//! The ledger of one slot: every pass of every operation in order of time, what it took, how thick, with what force.
//!
//! In: a job, the rays of a slot's cell ([`super::blank`]). Out: [`SlotLedger`]: passes that took anything, and what is
//! left on the rays as several pieces.
//!
//! **A pass on a ray** takes one interval: a blade is convex and its path across a ray nearly straight. The kernel
//! finds where a ray enters the blade from below, and, on the same ray turned round, from above. A blade is open above
//! its edges, where the head's body is: a ray that never enters from above is cleared to the face cone.
//!
//! **Thickness** t of a chip: the length that a ray loses above the new surface, times the cosine of the ray to that
//! surface. **Force** (Altintas, Manufacturing Automation, 2012, section 2.4; see [`crate::material`]): while a blade
//! goes through a row of rays it travels s, takes the volume V, and its edge sweeps the area S in material;
//! F = K_c V / s + K_ce S / s is the mean over that travel. The blade runs along the slot, which leans against the
//! cone's straight lines by the spiral angle psi: s = dR / cos psi; the surface that it leaves goes on along its
//! travel, so that a slope a_x across the slot is one of a_x / cos psi square to the travel.
//!
//! **Revolution 0.** The head stands at full depth when a roll begins: no plunge is modelled. What the first revolution
//! of the head takes is what the plunge would have taken, in one go; such passes have volumes, and their thickness and
//! force say nothing. They are kept apart ([`SlotPass::is_plunge`]). A head that plunges in place of rolling begins
//! clear of the blank: its first revolution takes nothing.
//!
//! The native kernel takes the ledger whatever backend cuts: passes follow one another, and each is too little work for
//! a device. All slots are alike but for the phase of the blades; one stands for all.

use super::blank::CellGrid;
use super::job::BevelJob;
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{Backend, LEAST_CHIP_MM};
use gearcut_core::dexel::intervals::{End, Span, subtract};
use gearcut_core::dexel::{Layer, NO_PASS, Ray, SpatialField};
use gearcut_core::error::{Error, Result};
use gearcut_core::passes::{SweepPlan, TurningPasses};
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// How far over the face cone the ends of blades are looked for, in outer modules: farther up no material is.
const OVER_MODULES: f64 = 0.1;

/// What a pass took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotPass {
    /// Operation.
    pub operation: usize,
    /// Pass id.
    pub pass: u32,
    /// Blade.
    pub blade: u32,
    /// Revolution of the head from the beginning of the slot.
    pub revolution: u32,
    /// Moment at which the blade stands in the middle of the slot: cradle angle, rad, or place before full depth, mm.
    pub moment: f64,
    /// Volume, mm3.
    pub volume_mm3: f64,
    /// Largest thickness, mm, and where along the tooth, mm.
    pub thickness_mm: f64,
    /// Place of the largest thickness along the tooth, mm from the middle of the face.
    pub along_mm: f64,
    /// Largest section of the chip in the rake face, mm2.
    pub section_mm2: f64,
    /// Largest length of edge in engagement, mm.
    pub edge_mm: f64,
    /// Largest cutting force, N; `None` where the scene names no material.
    pub force_n: Option<f64>,
    /// Work, N mm; `None` where the scene names no material.
    pub work_nmm: Option<f64>,
}

impl SlotPass {
    /// Whether it takes what the plunge before a roll would have taken.
    pub fn is_plunge(&self) -> bool {
        self.revolution == 0
    }
}

/// A slot, pass by pass.
#[derive(Debug, Clone, PartialEq)]
pub struct SlotLedger {
    /// Number of the slot.
    pub slot: u32,
    /// Passes that took anything, in order of time.
    pub passes: Vec<SlotPass>,
    /// Volume of the uncut cell, mm3.
    pub blank_mm3: f64,
    /// What is left of it, mm3.
    pub left_mm3: f64,
    /// Material that hangs over the lowest cut on its ray, mm3: undercut teeth.
    pub overhang_mm3: f64,
}

/// Cuts a slot pass by pass; nothing after Ctrl-C.
///
/// # Errors
/// A spiral angle that is not generated; the kernel's.
pub fn measure(
    job: &BevelJob,
    grid: &CellGrid,
    slot: u32,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<SlotLedger>> {
    let step = progress.step("chips of a slot", grid.rows() as u64, "rows");
    let rows = (0..grid.rows()).into_par_iter().map(|row| {
        if interrupt.is_raised() {
            return Ok(None);
        }
        let row = RowLedger::cut(job, grid, slot, row)?;
        step.advance(1);
        Ok(Some(row))
    });
    let Some(rows) = rows.collect::<Result<Option<Vec<RowLedger>>>>()? else { return Ok(None) };
    step.finish();
    let mut ledger = SlotLedger { slot, passes: Vec::new(), blank_mm3: 0.0, left_mm3: 0.0, overhang_mm3: 0.0 };
    let mut passes: BTreeMap<u32, SlotPass> = BTreeMap::new();
    for (row, width_mm) in rows.iter().zip(grid.row_widths_mm()) {
        ledger.blank_mm3 += width_mm * row.blank_mm2;
        ledger.left_mm3 += width_mm * row.left_mm2;
        ledger.overhang_mm3 += width_mm * row.overhang_mm2;
        for chip in &row.chips {
            let sum = passes.entry(chip.pass).or_insert_with(|| of_pass(job, slot, chip));
            let (section_mm2, edge_mm) = (chip.volume_mm2 * row.cos_spiral, chip.swept_mm * row.cos_spiral);
            sum.volume_mm3 += width_mm * chip.volume_mm2;
            sum.section_mm2 = sum.section_mm2.max(section_mm2);
            sum.edge_mm = sum.edge_mm.max(edge_mm);
            if chip.thickness_mm > sum.thickness_mm {
                (sum.thickness_mm, sum.along_mm) = (chip.thickness_mm, row.along_mm);
            }
            if let Some(material) = job.spec.material {
                let force_n = material.on_chip(section_mm2, edge_mm);
                sum.force_n = Some(sum.force_n.unwrap_or(0.0).max(force_n));
                sum.work_nmm = Some(sum.work_nmm.unwrap_or(0.0) + force_n * width_mm / row.cos_spiral);
            }
        }
    }
    ledger.passes = passes.into_values().collect();
    Ok(Some(ledger))
}

/// A pass that has taken nothing yet.
fn of_pass(job: &BevelJob, slot: u32, chip: &RowChip) -> SlotPass {
    let operation = &job.operations[chip.operation];
    let turned_rad = job.slots.turned_in_slot_rad(chip.operation, slot, chip.pass);
    let time_s = turned_rad / operation.spec.head_speed_rad_per_s;
    SlotPass {
        operation: chip.operation,
        pass: chip.pass,
        blade: job.slots.blade_of(chip.pass),
        revolution: (turned_rad / TURN_RAD).max(0.0) as u32,
        moment: operation.course.at(time_s)[0],
        volume_mm3: 0.0,
        thickness_mm: 0.0,
        along_mm: 0.0,
        section_mm2: 0.0,
        edge_mm: 0.0,
        force_n: None,
        work_nmm: None,
    }
}

/// One row of a slot's cell, for each mm of cone distance.
struct RowLedger {
    along_mm: f64,
    cos_spiral: f64,
    chips: Vec<RowChip>,
    blank_mm2: f64,
    left_mm2: f64,
    overhang_mm2: f64,
}

/// What a pass takes from a row.
struct RowChip {
    operation: usize,
    pass: u32,
    /// Volume for each mm of cone distance, mm2.
    volume_mm2: f64,
    /// Area that the edge sweeps in material for each mm of cone distance, mm.
    swept_mm: f64,
    thickness_mm: f64,
}

impl RowLedger {
    fn cut(job: &BevelJob, grid: &CellGrid, slot: u32, row: usize) -> Result<Self> {
        let along_mm = grid.distances_mm[row] - job.blank.mean_cone_distance_mm();
        let spiral_rad = [Side::Left, Side::Right].map(|side| job.target_of(side).row(along_mm)?.spiral_angle_rad());
        let [on_left, on_right] = spiral_rad;
        let cos_spiral = (0.5 * (on_left? + on_right?)).cos();
        let rays = SlotRowRays::new(job, grid, slot, row);
        let end = |at_mm| End { at_mm, pass: NO_PASS, normal: [0.0; 2] };
        let uncut = vec![Span { low: end(grid.low_mm), high: end(rays.top_mm) }];
        let mut left: Vec<Vec<Span>> = vec![uncut; grid.columns];
        let below = |spans: &[Span]| -> f64 {
            spans.iter().map(|span| grid.between_mm2(job, row, [span.low.at_mm, span.high.at_mm])).sum()
        };
        let blank_mm2 = left.iter().map(|spans| below(spans)).sum();
        let mut lowest_mm = vec![rays.top_mm; grid.columns];
        let mut chips = Vec::new();
        // A column's strip as wide as it is on the pitch cone.
        let strip_mm = grid.strip_rad * grid.distances_mm[row] * job.blank.pitch_angle_rad.sin();
        for operation in 0..job.operations.len() {
            let found = rays.passes(job.slots.of(operation, slot), &mut |pass, cuts| {
                let mut chip = RowChip { operation, pass, volume_mm2: 0.0, swept_mm: 0.0, thickness_mm: 0.0 };
                for (column, cut) in cuts.iter().enumerate() {
                    let Some([from_mm, to_mm]) = *cut else { continue };
                    let spans = &mut left[column];
                    lowest_mm[column] = lowest_mm[column].min(from_mm);
                    let over = spans.iter().find(|span| span.low.at_mm <= from_mm && span.high.at_mm > from_mm);
                    let length_mm = over.map_or(0.0, |span| span.high.at_mm.min(to_mm) - from_mm);
                    let before_mm2 = below(spans);
                    let [from, to] = [from_mm, to_mm].map(|at_mm| End { at_mm, pass, normal: [0.0; 2] });
                    if subtract(spans, from, to) == 0.0 {
                        continue;
                    }
                    chip.volume_mm2 += before_mm2 - below(spans);
                    // Square to the travel the slope across the slot is steeper.
                    let stretch = (slope(cuts, column) / (strip_mm * cos_spiral)).hypot(1.0);
                    let thickness_mm = length_mm / stretch;
                    chip.thickness_mm = chip.thickness_mm.max(thickness_mm);
                    if thickness_mm >= LEAST_CHIP_MM {
                        chip.swept_mm += strip_mm * stretch;
                    }
                }
                if chip.volume_mm2 > 0.0 {
                    chips.push(chip);
                }
            });
            found?;
        }
        let left_mm2 = left.iter().map(|spans| below(spans)).sum();
        let over = |(spans, &lowest_mm): (&Vec<Span>, &f64)| -> f64 {
            let over = spans.iter().map(|span| [span.low.at_mm.max(lowest_mm), span.high.at_mm]);
            over.filter(|[from, to]| to > from).map(|ends| grid.between_mm2(job, row, ends)).sum()
        };
        let overhang_mm2 = left.iter().zip(&lowest_mm).map(over).sum();
        Ok(Self { along_mm, cos_spiral, chips, blank_mm2, left_mm2, overhang_mm2 })
    }
}

/// Rise of a pass's surface from a column to the next one: the smaller of both sides', as corners belong to the flatter
/// one; 0 where no neighbour is cut.
fn slope(cuts: &PassCuts, column: usize) -> f64 {
    let low = |i: Option<usize>| i.and_then(|i| cuts.get(i).copied().flatten()).map(|[from_mm, _]| from_mm);
    let Some(here_mm) = low(Some(column)) else { return 0.0 };
    let beside = [low(column.checked_sub(1)), low(Some(column + 1))];
    let rises = beside.into_iter().flatten().map(|there_mm| (there_mm - here_mm).abs());
    rises.reduce(f64::min).unwrap_or(0.0)
}

/// What a pass takes from the rays of a row, ray by ray: heights between which nothing is left, mm.
type PassCuts = [Option<[f64; 2]>];

/// The rays of a row, from below and from above.
struct SlotRowRays {
    /// Upwards from the root cone, downwards from the face cone: one column, rows round the axis.
    fields: [SpatialField; 2],
    top_mm: f64,
}

impl SlotRowRays {
    fn new(job: &BevelJob, grid: &CellGrid, slot: u32, row: usize) -> Self {
        let up = grid.field_of_rows(job, slot, row..row + 1);
        let (_, top_mm) = grid.ray(job, 0, row);
        let over_mm = OVER_MODULES * job.blank.outer_module_mm();
        let down = SpatialField::new(1, grid.columns, -over_mm, |_, column| {
            let ray = up.ray(0, column);
            (Ray { origin_mm: ray.at(top_mm), normal: -ray.normal }, top_mm - grid.low_mm)
        });
        Self { fields: [up, down], top_mm }
    }

    /// Shows every pass of a set, in order, with the interval that it takes on each ray if nothing were cut before.
    fn passes(&self, set: &TurningPasses, visit: &mut dyn FnMut(u32, &PassCuts)) -> Result<()> {
        let [mut up, mut down] = [0, 1].map(|k| PassByPass::new(&self.fields[k], set));
        let mut cuts = vec![None; self.fields[0].len()];
        for pass in set.first_pass..set.end_pass() {
            // What enters no ray from below takes nothing: tips never go below what rays record.
            if !up.cut(pass)? {
                continue;
            }
            down.cut(pass)?;
            for (column, cut) in cuts.iter_mut().enumerate() {
                let at =
                    |of: &PassByPass| (of.layer.passes[column] == pass).then(|| f64::from(of.layer.heights_mm[column]));
                let to_mm = at(&down).map_or(self.top_mm, |depth_mm| self.top_mm - depth_mm.max(0.0));
                *cut = at(&up).filter(|&from_mm| from_mm < to_mm).map(|from_mm| [from_mm, to_mm]);
            }
            visit(pass, &cuts);
        }
        Ok(())
    }
}

/// A field that each pass cuts as if it were the first.
struct PassByPass<'a> {
    field: &'a SpatialField,
    plan: SweepPlan,
    /// Records of every pass, with their tile.
    records: BTreeMap<u32, Vec<(usize, Range<usize>)>>,
    layer: Layer,
}

impl<'a> PassByPass<'a> {
    fn new(field: &'a SpatialField, set: &TurningPasses) -> Self {
        let plan = SweepPlan::of_near_passes(field, set);
        let mut records: BTreeMap<u32, Vec<(usize, Range<usize>)>> = BTreeMap::new();
        for (tile, of_tile) in plan.tiles.iter().enumerate() {
            let mut first = of_tile.records.start;
            for of_pass in plan.records[of_tile.records.clone()].chunk_by(|a, b| a.pass == b.pass) {
                let range = first..first + of_pass.len();
                first = range.end;
                records.entry(of_pass[0].pass).or_default().push((tile, range));
            }
        }
        Self { field, plan, records, layer: field.blank_layer() }
    }

    /// Cuts the uncut field with one pass; whether it has any records here.
    fn cut(&mut self, pass: u32) -> Result<bool, Error> {
        let Some(records) = self.records.get(&pass) else { return Ok(false) };
        self.layer = self.field.blank_layer();
        let mut plan = SweepPlan { segments: self.plan.segments.clone(), ..SweepPlan::default() };
        for (tile, range) in records {
            let first = plan.records.len();
            plan.records.extend_from_slice(&self.plan.records[range.clone()]);
            let mut tile = self.plan.tiles[*tile].clone();
            tile.records = first..plan.records.len();
            plan.tiles.push(tile);
        }
        Cpu::default().cut_spatial(self.field, &plan, &mut self.layer)?;
        Ok(self.layer.passes.contains(&pass))
    }
}
