//! Rays in space on the device: composed tile by tile, sent in batches, brought back.
//!
//! In: field, plan of sweeps, layer. Out: the layer lowered. Some rows of a column make a **group**, the lanes of one
//! thread: four on software adapters, one on GPUs; the groups of a tile follow each other, so that a batch is a run of
//! tiles. As in [`super::compose`], everything large is subtracted here in f64: a record counts from the tile's middle
//! ray at its start height on one side, from a base point of the segment near it on the other.
//!
//! A tile's dexels stay on the device while its records come in **rounds**, in their order: what is left does not
//! depend on how they are split.

use super::batches::Allowance;
use super::context::{Gpu, IN_FLIGHT};
use super::edge_cells::EdgeCells;
use super::problem::GpuProblem;
use super::readback::{
    self, Before, InFlight, Input, ReadbackJob, ReadbackStep, Returned, Shipment, StageLaunch, Wanted,
};
use super::sweep_records::{SpatialPass, SpatialTile};
use gearcut_core::dexel::{Layer, SpatialField};
use gearcut_core::passes::SweepPlan;
use gearcut_core::passes::spatial::sweep;
use gearcut_core::passes::spatial::sweep_tile::SweepTile;
use gearcut_core::tool::edge::{Segment, SegmentShape};
use gearcut_shaders::{Rows, WORKGROUP_THREADS, spatial_flank};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Name of the stage.
const NAME: &str = spatial_flank(Rows::Many).name;
/// Bytes of a row of a group: six numbers of its ray; height and pass on the device and on their way back.
const ROW_BYTES: usize = (6 + 2 + 2) * 4;
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
        let (jobs, device_ns) = in_flight.collect(&gpu.device)?;
        let Returned { layers, unconverged: short, .. } = &jobs[0];
        let Layer { heights_mm, passes } = &layers[0];
        for (at, dexel) in lanes(field, &plan.tiles[tiles], gpu.rows.lanes()).enumerate() {
            // Lanes beyond the last row repeat it, values and all.
            result.heights_mm[dexel] = heights_mm[at];
            result.passes[dexel] = passes[at];
        }
        unconverged += u64::from(short[0]);
        gpu.log().count(NAME, device_ns);
        Ok(())
    };
    for tiles in batches(plan, gpu.allowance(), gpu.rows.lanes())? {
        if waiting.len() == IN_FLIGHT {
            collect(waiting.remove(0))?;
        }
        let in_flight = send(gpu, field, plan, layer, &cells, tiles.clone())?;
        waiting.push((tiles, in_flight));
    }
    waiting.into_iter().try_for_each(collect)?;
    Ok((result, unconverged))
}

/// Groups of a tile.
fn groups(tile: &SweepTile, of_rows: usize) -> usize {
    tile.columns.len() * tile.rows.len().div_ceil(of_rows)
}

/// Dexel of every lane of every group of some tiles.
fn lanes<'a>(field: &'a SpatialField, tiles: &'a [SweepTile], of_rows: usize) -> impl Iterator<Item = usize> + 'a {
    tiles.iter().flat_map(move |tile| {
        tile.columns.clone().flat_map(move |column| {
            tile.rows.clone().step_by(of_rows).flat_map(move |first| {
                (first..first + of_rows).map(move |row| field.index(column, row.min(tile.rows.end - 1)))
            })
        })
    })
}

/// Records that fit the device together.
fn records_at_most(Allowance { buffer_bytes, batch_bytes }: Allowance) -> usize {
    buffer_bytes.min(batch_bytes / 2) as usize / size_of::<SpatialPass>()
}

/// Runs of tiles that fit the device together. Their records keep to half of its memory, unless a single tile has more.
fn batches(plan: &SweepPlan, allowance: Allowance, of_rows: usize) -> Result<Vec<Range<usize>>, GpuProblem> {
    let Allowance { buffer_bytes, batch_bytes } = allowance;
    let groups_at_most =
        (buffer_bytes as usize / (6 * of_rows * 4)).min(batch_bytes as usize / 2 / (ROW_BYTES * of_rows));
    let records_at_most = records_at_most(allowance);
    let mut batches: Vec<Range<usize>> = Vec::new();
    let (mut in_groups, mut in_records, mut in_pairs) = (0, 0, 0);
    for (index, tile) in plan.tiles.iter().enumerate() {
        let (groups, records) = (groups(tile, of_rows), tile.records.len());
        if groups > groups_at_most || records_at_most == 0 {
            let reason = format!("a tile of {groups} groups of rays; there is room for {groups_at_most}");
            return Err(GpuProblem::OutOfMemory { reason });
        }
        let pairs = (groups * of_rows * records) as u64;
        let fits = in_groups + groups <= groups_at_most
            && in_records + records <= records_at_most
            && in_pairs + pairs <= LAUNCH_PAIRS;
        match batches.last_mut().filter(|batch| fits && batch.len() < WORKGROUPS) {
            Some(batch) => batch.end = index + 1,
            None => {
                batches.push(index..index + 1);
                (in_groups, in_records, in_pairs) = (0, 0, 0);
            }
        }
        in_groups += groups;
        in_records += records;
        in_pairs += pairs;
    }
    Ok(batches)
}

/// One launch: the next records of the tiles that have any left.
#[derive(Default)]
struct SweepRound {
    tiles: Vec<SpatialTile>,
    records: Vec<SpatialPass>,
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

fn send(
    gpu: &Gpu,
    field: &SpatialField,
    plan: &SweepPlan,
    layer: &Layer,
    cells: &EdgeCells,
    batch: Range<usize>,
) -> Result<InFlight, GpuProblem> {
    let plan_tiles = &plan.tiles[batch];
    let of_rows = gpu.rows.lanes();
    let round_records = records_at_most(gpu.allowance()).min(ROUND_RECORDS);
    let (mut rounds, mut rays) = (Vec::<SweepRound>::new(), Vec::<f32>::new());
    let mut first_group = 0;
    for tile in plan_tiles {
        let middle =
            field.ray((tile.columns.start + tile.columns.end - 1) / 2, (tile.rows.start + tile.rows.end - 1) / 2);
        let middle = middle.normal.as_vec3();
        for (round, records) in plan.records[tile.records.clone()].chunks(round_records).enumerate() {
            rounds.resize_with(rounds.len().max(round + 1), SweepRound::default);
            let SweepRound { tiles, records: composed } = &mut rounds[round];
            tiles.push(SpatialTile {
                middle: middle.extend(field.low_mm as f32).to_array(),
                first_group,
                group_count: groups(tile, of_rows) as u32,
                first_record: composed.len() as u32,
                record_count: records.len() as u32,
            });
            let segment = |record: &sweep::SweepRecord| &plan.segments[record.segment as usize];
            composed.extend(records.iter().map(|r| compose(cells, r, segment(r), middle.as_dvec3())));
        }
        first_group += groups(tile, of_rows) as u32;
        let one = std::slice::from_ref(tile);
        let dexels: Vec<usize> = lanes(field, one, of_rows).collect();
        for group in dexels.chunks_exact(of_rows) {
            for axis in 0..3 {
                let origins = &field.origins_mm()[axis];
                rays.extend(group.iter().map(|&at| (origins[at] - tile.origin_mm[axis]) as f32));
            }
            for axis in 0..3 {
                rays.extend(group.iter().map(|&at| field.normals()[axis][at] as f32));
            }
        }
    }
    let dexels: Vec<usize> = lanes(field, plan_tiles, of_rows).collect();
    let heights_mm: Vec<f32> = dexels.iter().map(|&at| layer.heights_mm[at]).collect();
    let passes: Vec<u32> = dexels.iter().map(|&at| layer.passes[at]).collect();
    let launches: Vec<StageLaunch> = rounds.iter().map(|round| round.launch(gpu)).collect();
    let shared = |label, bytes| Input::Shared { label, bytes, usage: wgpu::BufferUsages::STORAGE };
    let inputs = vec![
        Input::Tiles,
        Input::Records,
        shared("cells", bytemuck::cast_slice(&cells.cells)),
        shared("rays", bytemuck::cast_slice(&rays)),
    ];
    let job = ReadbackJob {
        before: Before::Layer(&heights_mm, &passes),
        steps: vec![ReadbackStep { inputs, launches }],
        wanted: Wanted::Dexels,
    };
    readback::send(
        &gpu.device,
        &Shipment {
            stage: NAME,
            record_usage: wgpu::BufferUsages::STORAGE,
            jobs: &[job],
            poison: gpu.options.poison_outputs,
        },
    )
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
    // A helical rake face is turned back by its angle at the base point's y, to which the angle now refers.
    let turned_back = |v: [f64; 3]| {
        let (sin, cos) = (record.twist_rad_per_mm * base_in_blade.y).sin_cos();
        [cos * v[0] + sin * v[1], cos * v[1] - sin * v[0], v[2]]
    };
    let radius_mm = record.radius_mm + base_in_blade.x;
    let mut turn = record.turn.map(|rows| {
        let columns = [0, 1, 2].map(|column| turned_back([rows[0][column], rows[1][column], rows[2][column]]));
        [0, 1, 2].map(|row| columns.map(|column: [f64; 3]| column[row]))
    });
    if record.twist_rad_per_mm == 0.0 {
        turn = record.turn;
    } else {
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
