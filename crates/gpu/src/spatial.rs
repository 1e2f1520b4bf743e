//! Rays in space on the device: composed tile by tile, sent in batches, brought back.
//!
//! In: fields with the passes that run over them, or one plan of sweeps over a layer. Out: what is left. Some rows of a
//! column make a **group**, the lanes of one thread: four on software adapters, one on GPUs; the groups of a tile
//! follow each other. All plans of a field have the same tiles, so that rays and dexels lie there once, through all
//! operations ([`super::in_flight`]); a field that does not fit goes plan by plan in batches, which are runs of tiles.
//! As in [`super::compose`], everything large is subtracted here in f64: a record counts from the tile's middle ray at
//! its start height on one side, from a base point of the segment near it on the other.
//!
//! A tile's records come in **rounds**, in their order: what is left does not depend on how they are split.

use super::batches::Allowance;
use super::context::{Gpu, IN_FLIGHT};
use super::edge_cells::EdgeCells;
use super::in_flight::WholeField;
use super::problem::GpuProblem;
use super::readback::{Before, InFlight, Input, ReadbackJob, ReadbackStep, Returned, StageLaunch, Wanted};
use super::sweep_records::{SpatialPass, SpatialTile};
use super::waiting::wait;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{CutLayers, CutStats, SweptField};
use gearcut_core::dexel::{Layer, SpatialField};
use gearcut_core::error::Error;
use gearcut_core::passes::SweepPlan;
use gearcut_core::passes::spatial::sweep;
use gearcut_core::passes::spatial::sweep_tile::SweepTile;
use gearcut_core::tool::edge::{Segment, SegmentShape};
use gearcut_shaders::{Rows, WORKGROUP_THREADS, spatial_flank};
use glam::{DVec2, DVec3};
use std::ops::Range;
use wgpu::BufferUsages as Use;

/// Bytes of a row of a group: six numbers of its ray; height and pass on the device and on their way back.
const ROW_BYTES: usize = (6 + 2 + 2) * 4;
/// Bytes of a dexel on its way back: height and pass.
const DEXEL_BYTES: usize = 8;
/// (Dexel, pass) pairs of a launch at most: as for planar fields; a pair costs a few times as much.
const LAUNCH_PAIRS: u64 = 1 << 27;
/// Workgroups in one dimension: what every WebGPU device has.
const WORKGROUPS: usize = 65535;
/// Records of a tile in one launch at most: each takes up to 34 iterations of a thread's loops, of which llvmpipe ends
/// all after 65,535 without a word. Candidates are a few dozen; a tile with more goes through in rounds.
const ROUND_RECORDS: usize = 1024;

/// Heights and passes of the whole field, the layer untouched.
pub fn cut_on_device(
    gpu: &Gpu,
    field: &SpatialField,
    plan: &SweepPlan,
    layer: &Layer,
) -> Result<(Layer, u64), GpuProblem> {
    gpu.device.alive()?;
    let cells = EdgeCells::new(&plan.segments);
    let mut result = layer.clone();
    let mut unconverged = 0;
    let mut waiting: Vec<(Range<usize>, InFlight)> = Vec::new();
    let mut collect = |(tiles, in_flight): (Range<usize>, InFlight)| -> Result<(), GpuProblem> {
        let (jobs, device_ns) = wait(in_flight.collect(&gpu.device))?;
        let Returned { layers, unconverged: short, .. } = &jobs[0];
        spread(field, &plan.tiles[tiles], gpu.rows.lanes(), &layers[0], &mut result);
        unconverged += u64::from(short[0]);
        gpu.log().count(SweptField::STAGE, device_ns);
        Ok(())
    };
    for tiles in batches(&plan.tiles, gpu.allowance(), gpu.rows.lanes())? {
        if waiting.len() == IN_FLIGHT {
            collect(waiting.remove(0))?;
        }
        let dexels = TileDexels::new(field, &plan.tiles[tiles.clone()], gpu.rows.lanes(), layer);
        let step = SweptStep::compose(gpu, field, plan, &cells, tiles.clone());
        let in_flight = gpu.send_jobs::<SweptField>(&[dexels.job(vec![step.step(gpu)])])?;
        waiting.push((tiles, in_flight));
    }
    waiting.into_iter().try_for_each(collect)?;
    Ok((result, unconverged))
}

impl WholeField for SweptField<'_> {
    type Inputs = SweptInputs;
    const STAGE: &'static str = spatial_flank(Rows::Many).name;
    const RECORD_USAGE: Use = Use::STORAGE;

    fn compose(&self, gpu: &Gpu) -> Option<SweptInputs> {
        let Self { field, operations, .. } = self;
        let of_rows = gpu.rows.lanes();
        let mut inputs = SweptInputs::default();
        for set in operations.iter().flatten() {
            let plan = SweepPlan::in_tiles(field, set);
            let whole = batches(&plan.tiles, gpu.allowance(), of_rows).ok()?;
            if whole.len() != 1 || plan.records.len() > records_at_most(gpu.allowance()) {
                return None;
            }
            let cells = EdgeCells::new(&plan.segments);
            inputs.steps.push(SweptStep::compose(gpu, field, &plan, &cells, whole[0].clone()));
            inputs.dexel_passes += plan.tile_passes();
            if inputs.tiles.is_empty() {
                inputs.dexels = TileDexels::new(field, &plan.tiles, of_rows, &field.blank_layer());
                inputs.tiles = plan.tiles;
            }
        }
        Some(inputs)
    }

    fn bytes(inputs: &SweptInputs) -> u64 {
        let records = inputs.steps.iter().flat_map(|step| &step.rounds).map(|round| round.records.len());
        let dexels = inputs.dexels.heights_mm.len();
        (dexels * (ROW_BYTES + DEXEL_BYTES * inputs.steps.len()) + records.sum::<usize>() * size_of::<SpatialPass>())
            as u64
    }

    fn job<'a>(inputs: &'a SweptInputs, gpu: &'a Gpu) -> ReadbackJob<'a> {
        inputs.dexels.job(inputs.steps.iter().map(|step| step.step(gpu)).collect())
    }

    fn layers(&self, inputs: SweptInputs, left: Returned) -> CutLayers {
        let field = &self.field;
        let stats = CutStats {
            dexels: (field.len() * inputs.steps.len()) as u64,
            dexel_passes: inputs.dexel_passes,
            unconverged: left.unconverged.iter().map(|&of_step| u64::from(of_step)).sum(),
        };
        // Every set is a step; an operation ends with its last one.
        let mut last = 0;
        let ends = self.operations.iter().map(|sets| {
            last += sets.len();
            last - 1
        });
        let layer = |step: usize| {
            let mut layer = Layer { heights_mm: vec![0.0; field.len()], passes: vec![0; field.len()] };
            spread(field, &inputs.tiles, inputs.dexels.of_rows, &left.layers[step], &mut layer);
            layer
        };
        CutLayers { layers: ends.map(layer).collect(), figures: None, stats }
    }

    fn cut_in_batches(&self, gpu: &Gpu) -> Result<CutLayers, Error> {
        self.cut_in_turn(gpu, |set| [SweepPlan::in_tiles(&self.field, set)])
    }

    fn cut_natively(&self, native: Cpu) -> Result<CutLayers, Error> {
        self.cut_in_turn(&native, |set| self.by.plans(&self.field, set))
    }
}

/// Puts dexels in the order of tiles where they belong in the field.
fn spread(field: &SpatialField, tiles: &[SweepTile], of_rows: usize, from: &Layer, to: &mut Layer) {
    for (group, (_, dexels)) in group_dexels(field, tiles, of_rows).enumerate() {
        let lanes = group * of_rows..group * of_rows + dexels.len();
        to.heights_mm[dexels.clone()].copy_from_slice(&from.heights_mm[lanes.clone()]);
        to.passes[dexels].copy_from_slice(&from.passes[lanes]);
    }
}

/// Groups of a tile.
fn groups(tile: &SweepTile, of_rows: usize) -> usize {
    tile.columns.len() * tile.rows.len().div_ceil(of_rows)
}

/// Dexels of every group of some tiles: fewer than lanes where rows end.
fn group_dexels<'a>(
    field: &'a SpatialField,
    tiles: &'a [SweepTile],
    of_rows: usize,
) -> impl Iterator<Item = (&'a SweepTile, Range<usize>)> + 'a {
    tiles.iter().flat_map(move |tile| {
        tile.columns.clone().flat_map(move |column| {
            let end = field.index(column, tile.rows.end - 1) + 1;
            let from = field.index(column, tile.rows.start);
            (from..end).step_by(of_rows).map(move |first| (tile, first..end.min(first + of_rows)))
        })
    })
}

/// Adds the lanes of a group; those beyond the last row repeat it.
fn extend_lanes<T: Copy>(lanes: &mut Vec<T>, own: impl ExactSizeIterator<Item = T>, of_rows: usize) {
    let end = lanes.len() + of_rows;
    lanes.extend(own);
    if let Some(&last) = lanes.last() {
        lanes.resize(end, last);
    }
}

/// Records that fit the device together.
fn records_at_most(Allowance { buffer_bytes, batch_bytes }: Allowance) -> usize {
    buffer_bytes.min(batch_bytes / 2) as usize / size_of::<SpatialPass>()
}

/// Runs of tiles whose dexels fit the device together.
fn batches(tiles: &[SweepTile], allowance: Allowance, of_rows: usize) -> Result<Vec<Range<usize>>, GpuProblem> {
    let Allowance { buffer_bytes, batch_bytes } = allowance;
    let groups_at_most =
        (buffer_bytes as usize / (6 * of_rows * 4)).min(batch_bytes as usize / 2 / (ROW_BYTES * of_rows));
    let records_at_most = records_at_most(allowance);
    let mut batches: Vec<Range<usize>> = Vec::new();
    let (mut in_groups, mut in_records) = (0, 0);
    for (index, tile) in tiles.iter().enumerate() {
        let (groups, records) = (groups(tile, of_rows), tile.records.len());
        if groups > groups_at_most || records_at_most == 0 {
            let reason = format!("a tile of {groups} groups of rays; there is room for {groups_at_most}");
            return Err(GpuProblem::OutOfMemory { reason });
        }
        let fits = in_groups + groups <= groups_at_most && in_records + records <= records_at_most;
        match batches.last_mut().filter(|_| fits) {
            Some(batch) => batch.end = index + 1,
            None => {
                batches.push(index..index + 1);
                (in_groups, in_records) = (0, 0);
            }
        }
        in_groups += groups;
        in_records += records;
    }
    Ok(batches)
}

/// What the device needs of a field that it takes whole.
#[derive(Default)]
pub(crate) struct SweptInputs {
    /// Tiles of the plans, which all have the same.
    tiles: Vec<SweepTile>,
    dexels: TileDexels,
    /// One for each set of passes.
    steps: Vec<SweptStep>,
    /// (Dexel, pass) pairs.
    dexel_passes: u64,
}

/// Rays and dexels of some tiles, lane after lane.
#[derive(Default)]
struct TileDexels {
    of_rows: usize,
    /// Six numbers for each row of a group, component by component.
    rays: Vec<f32>,
    heights_mm: Vec<f32>,
    passes: Vec<u32>,
}

impl TileDexels {
    fn new(field: &SpatialField, tiles: &[SweepTile], of_rows: usize, layer: &Layer) -> Self {
        let lanes = of_rows * tiles.iter().map(|tile| groups(tile, of_rows)).sum::<usize>();
        let mut rays = Vec::with_capacity(6 * lanes);
        let (mut heights_mm, mut passes) = (Vec::with_capacity(lanes), Vec::with_capacity(lanes));
        for (tile, dexels) in group_dexels(field, tiles, of_rows) {
            for (origins, from_mm) in field.origins_mm().iter().zip(tile.origin_mm.to_array()) {
                let against = origins[dexels.clone()].iter().map(|at_mm| (at_mm - from_mm) as f32);
                extend_lanes(&mut rays, against, of_rows);
            }
            for normals in field.normals() {
                extend_lanes(&mut rays, normals[dexels.clone()].iter().map(|&along| along as f32), of_rows);
            }
            extend_lanes(&mut heights_mm, layer.heights_mm[dexels.clone()].iter().copied(), of_rows);
            extend_lanes(&mut passes, layer.passes[dexels].iter().copied(), of_rows);
        }
        Self { of_rows, rays, heights_mm, passes }
    }

    fn job<'a>(&'a self, steps: Vec<ReadbackStep<'a>>) -> ReadbackJob<'a> {
        let before = Before::Layer(&self.heights_mm, &self.passes);
        ReadbackJob { before, rays: bytemuck::cast_slice(&self.rays), steps, wanted: Wanted::Dexels }
    }
}

/// One launch: the next records of tiles that have any left.
#[derive(Default)]
struct SweepRound {
    tiles: Vec<SpatialTile>,
    records: Vec<SpatialPass>,
    /// (Dexel, pass) pairs.
    pairs: u64,
}

impl SweepRound {
    fn launch<'a>(&'a self, gpu: &'a Gpu) -> StageLaunch<'a> {
        let twisted = self.records.iter().any(|record| record.twist_rad_per_mm != 0.0);
        let widest = self.tiles.iter().map(|tile| tile.group_count).max().unwrap_or(0);
        StageLaunch {
            pipeline: &gpu.spatial_flank[usize::from(twisted)],
            tiles: bytemuck::cast_slice(&self.tiles),
            records: bytemuck::cast_slice(&self.records),
            workgroups: [widest.div_ceil(WORKGROUP_THREADS), self.tiles.len() as u32],
        }
    }
}

/// What a plan needs over some tiles, composed.
struct SweptStep {
    cells: Vec<[f32; 4]>,
    rounds: Vec<SweepRound>,
}

impl SweptStep {
    fn compose(gpu: &Gpu, field: &SpatialField, plan: &SweepPlan, cells: &EdgeCells, tiles: Range<usize>) -> Self {
        let of_rows = gpu.rows.lanes();
        let round_records = records_at_most(gpu.allowance()).min(ROUND_RECORDS);
        // Launches that have the first records of tiles, those that have the next ones, and so on.
        let mut rounds: Vec<Vec<SweepRound>> = Vec::new();
        let mut first_group = 0;
        for tile in &plan.tiles[tiles] {
            let [column, row] = tile.middle();
            let middle = field.ray(column, row).normal.as_vec3();
            let group_count = groups(tile, of_rows) as u32;
            for (round, records) in plan.records[tile.records.clone()].chunks(round_records).enumerate() {
                rounds.resize_with(rounds.len().max(round + 1), Vec::new);
                let pairs = u64::from(group_count) * (of_rows * records.len()) as u64;
                let launches = &mut rounds[round];
                let has_room =
                    |launch: &SweepRound| launch.tiles.len() < WORKGROUPS && launch.pairs + pairs <= LAUNCH_PAIRS;
                if !launches.last().is_some_and(has_room) {
                    launches.push(SweepRound::default());
                }
                let last = launches.len() - 1;
                let launch = &mut launches[last];
                launch.pairs += pairs;
                launch.tiles.push(SpatialTile {
                    middle: middle.extend(field.low_mm as f32).to_array(),
                    first_group,
                    group_count,
                    first_record: launch.records.len() as u32,
                    record_count: records.len() as u32,
                });
                let composed = |record: &sweep::SweepRecord| {
                    compose(cells, record, &plan.segments[record.segment as usize], middle.as_dvec3())
                };
                launch.records.extend(records.iter().map(composed));
            }
            first_group += group_count;
        }
        Self { cells: cells.cells.clone(), rounds: rounds.into_iter().flatten().collect() }
    }

    fn step<'a>(&'a self, gpu: &'a Gpu) -> ReadbackStep<'a> {
        let cells = Input::Shared { label: "cells", bytes: bytemuck::cast_slice(&self.cells), usage: Use::STORAGE };
        ReadbackStep {
            launches: self.rounds.iter().map(|round| round.launch(gpu)).collect(),
            inputs: vec![Input::Tiles, Input::Records, cells, Input::Rays],
        }
    }
}

/// A record for the shader; `middle` is the direction of the tile's middle ray as the shader has it.
fn compose(cells: &EdgeCells, record: &sweep::SweepRecord, segment: &Segment, middle: DVec3) -> SpatialPass {
    let start_mm = f64::from(record.start.height_mm[0] as f32);
    let (mut place, axes) = (record.place_mm, segment.blade_from_segment.rotation);
    for (place, turn) in place.iter_mut().zip(&record.turn) {
        for (value, row) in place.iter_mut().zip(turn) {
            *value += start_mm * DVec3::from_array(*row).dot(middle);
        }
    }
    let in_segment = DVec2::new(axes.x, -axes.y).rotate(DVec2::new(place[0][0], place[0][2]));
    let base = cells.base(record.segment as usize, segment, in_segment);
    let base_in_blade = axes.rotate(base.point);
    place[0][0] -= base_in_blade.x;
    place[0][2] -= base_in_blade.y;
    let radius_mm = record.radius_mm + base_in_blade.x;
    let mut turn = record.turn;
    if record.twist_rad_per_mm != 0.0 {
        // A helical rake face is turned back by its angle at the base point's y, to which the angle now refers.
        let (sin, cos) = (record.twist_rad_per_mm * base_in_blade.y).sin_cos();
        let turned_back = |v: [f64; 3]| [cos * v[0] + sin * v[1], cos * v[1] - sin * v[0], v[2]];
        turn = turn.map(|rows| {
            let columns = [0, 1, 2].map(|column| turned_back([rows[0][column], rows[1][column], rows[2][column]]));
            [0, 1, 2].map(|row| columns.map(|column: [f64; 3]| column[row]))
        });
        place[0][0] += radius_mm;
        place = place.map(turned_back);
        place[0][0] -= radius_mm;
    }
    let row = |k: usize, r: usize| {
        let [x, y, z] = turn[k][r];
        [x, y, z, place[k][r]].map(|c| c as f32)
    };
    SpatialPass {
        turn: std::array::from_fn(|i| row(i / 3, i % 3)),
        place_3: [place[3][0], place[3][1], place[3][2], start_mm].map(|c| c as f32),
        radius_mm: radius_mm as f32,
        twist_rad_per_mm: record.twist_rad_per_mm as f32,
        cos: axes.x as f32,
        sin: axes.y as f32,
        y_from_mm: base.y_range_mm[0],
        y_to_mm: base.y_range_mm[1],
        base_x_mm: base.x_mm,
        base_y_mm: base.y_mm,
        arc_excess_mm2: base.arc_excess_mm2,
        arc_half_curvature: match &segment.shape {
            SegmentShape::Table(_) => 0.0,
            SegmentShape::Arc { radius_mm } => (0.5 / radius_mm) as f32,
        },
        cells_per_mm: base.cells_per_mm,
        cell_width_mm: base.cell_width_mm,
        first_cell: base.first_cell,
        last_cell: base.last_cell,
        base_cell: base.cell,
        pass_id: record.pass,
        t_from: record.t_range[0] as f32,
        t_to: record.t_range[1] as f32,
        unused: [0; 2],
    }
}
