//! Rays in space on the device: composed tile by tile, sent in batches, brought back.
//!
//! In: fields with the passes that run over them, or one plan of sweeps over a layer. Out: what is left. All plans of a
//! field have the same tiles, so that rays and dexels lie there once, through all operations ([`super::in_flight`]); a
//! field that does not fit goes plan by plan in batches, which are runs of tiles.

use super::batches::Allowance;
use super::context::{Gpu, IN_FLIGHT};
use super::in_flight::WholeField;
use super::problem::GpuProblem;
use super::readback::{Before, FieldShare, InFlight, Returned, Shipment, Wanted};
use super::sweep_records::SpatialPass;
use super::swept_steps::{self, SweptStep};
use super::tile_dexels::{TileDexels, groups, spread};
use super::waiting::wait;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{CutLayers, CutStats, SweptField};
use gearcut_core::dexel::{Layer, SpatialField};
use gearcut_core::error::Error;
use gearcut_core::passes::spatial::sweep_tile::SweepTile;
use gearcut_core::passes::{SweepPlan, TurningPasses};
use gearcut_shaders::{Rows, spatial_flank};
use std::ops::Range;

/// Name of the stage.
const STAGE: &str = spatial_flank(Rows::Many).name;
/// Bytes of a row of a group: six numbers of its ray; height and pass on the device and on their way back.
const ROW_BYTES: usize = (6 + 2 + 2) * 4;
/// Bytes of a dexel on its way back: height and pass.
const DEXEL_BYTES: usize = 8;

/// Heights and passes of the whole field, the layer untouched.
pub fn cut_on_device(
    gpu: &Gpu,
    field: &SpatialField,
    plan: &SweepPlan,
    layer: &Layer,
) -> Result<(Layer, CutStats), GpuProblem> {
    gpu.device.alive()?;
    let mut result = layer.clone();
    let mut stats = CutStats { dexels: field.len() as u64, ..CutStats::default() };
    let (mut unconverged, mut searched) = (0, 0);
    let mut waiting: Vec<(Range<usize>, InFlight)> = Vec::new();
    let mut collect = |(tiles, in_flight): (Range<usize>, InFlight)| -> Result<(), GpuProblem> {
        let left = wait(gpu.collect(in_flight))?;
        let Returned { layers, unconverged: short, visited, .. } = &left[0];
        spread(field, &plan.tiles[tiles], gpu.rows.lanes(), &layers[0], &mut result);
        unconverged += u64::from(*short);
        searched += u64::from(*visited);
        Ok(())
    };
    for tiles in batches(&plan.tiles, gpu.allowance(), gpu.rows.lanes())? {
        if waiting.len() == IN_FLIGHT {
            collect(waiting.remove(0))?;
        }
        let dexels = TileDexels::new(field, &plan.tiles[tiles.clone()], gpu.rows.lanes(), layer);
        let step = [SweptStep::compose(gpu, field, plan, tiles.clone())];
        stats.dexel_passes += step[0].dexel_passes;
        let in_flight = wait(gpu.send(&shipment(gpu, &[(&dexels, &step)])))?;
        waiting.push((tiles, in_flight));
    }
    waiting.into_iter().try_for_each(collect)?;
    Ok((result, CutStats { unconverged, dexel_passes: stats.dexel_passes + searched, ..stats }))
}

impl WholeField for SweptField<'_> {
    type Inputs = SweptInputs;

    fn compose(&self, gpu: &Gpu) -> Option<SweptInputs> {
        let Self { field, operations, .. } = self;
        let of_rows = gpu.rows.lanes();
        let mut inputs = SweptInputs { of_rows, ..SweptInputs::default() };
        for set in operations.iter().flatten() {
            let plan = plan(gpu, field, set);
            let whole = batches(&plan.tiles, gpu.allowance(), of_rows).ok()?;
            if whole.len() != 1 || plan.records.len() > records_at_most(gpu.allowance()) {
                return None;
            }
            let step = SweptStep::compose(gpu, field, &plan, whole[0].clone());
            inputs.dexel_passes += step.dexel_passes;
            inputs.steps.push(step);
            if inputs.tiles.is_empty() {
                inputs.dexels = TileDexels::new(field, &plan.tiles, of_rows, &field.blank_layer());
                inputs.tiles = plan.tiles;
            }
        }
        Some(inputs)
    }

    fn bytes(inputs: &SweptInputs) -> [u64; 2] {
        let dexels = inputs.dexels.heights_mm.len() * (ROW_BYTES + DEXEL_BYTES * inputs.steps.len());
        let rays = size_of_val(inputs.dexels.rays.as_slice()) as u64;
        let records = inputs.steps.iter().map(|step| step.record_bytes() as u64);
        [dexels as u64 + records.clone().sum::<u64>(), records.fold(rays, u64::max)]
    }

    fn shipment<'a>(fields: &[&'a SweptInputs], gpu: &'a Gpu) -> Shipment<'a> {
        let fields: Vec<_> = fields.iter().map(|inputs| (&inputs.dexels, inputs.steps.as_slice())).collect();
        shipment(gpu, &fields)
    }

    fn layers(&self, inputs: SweptInputs, left: Returned) -> CutLayers {
        let field = &self.field;
        let stats = CutStats {
            dexels: (field.len() * inputs.steps.len()) as u64,
            dexel_passes: inputs.dexel_passes + u64::from(left.visited),
            unconverged: u64::from(left.unconverged),
        };
        // Every set is a step; an operation ends with its last one.
        let mut last = 0;
        let ends = self.operations.iter().map(|sets| {
            last += sets.len();
            last - 1
        });
        let layer = |step: usize| {
            let mut layer = Layer { heights_mm: vec![0.0; field.len()], passes: vec![0; field.len()] };
            spread(field, &inputs.tiles, inputs.of_rows, &left.layers[step], &mut layer);
            layer
        };
        CutLayers { layers: ends.map(layer).collect(), figures: None, stats }
    }

    fn cut_in_batches(&self, gpu: &Gpu) -> Result<CutLayers, Error> {
        self.cut_in_turn(gpu, |set| [plan(gpu, &self.field, set)])
    }

    fn cut_natively(&self, native: Cpu) -> Result<CutLayers, Error> {
        self.cut_in_turn(&native, |set| self.by.plans(&self.field, set))
    }
}

/// Plan that serves a device: a GPU searches the cells of patches itself; a software adapter would take longer than the
/// host.
fn plan(gpu: &Gpu, field: &SpatialField, set: &TurningPasses) -> SweepPlan {
    match gpu.rows {
        Rows::Few => SweepPlan::in_patches(field, set),
        Rows::Many => SweepPlan::in_cells(field, set),
    }
}

/// Fields together, with what they have before the first step.
fn shipment<'a>(gpu: &'a Gpu, fields: &[(&'a TileDexels, &'a [SweptStep])]) -> Shipment<'a> {
    let mut first_lane = 0;
    let placed = fields.iter().map(|&(dexels, steps)| {
        let first_group = (first_lane / gpu.rows.lanes()) as u32;
        first_lane += dexels.heights_mm.len();
        (first_group, steps)
    });
    let placed: Vec<(u32, &[SweptStep])> = placed.collect();
    let share = |&(dexels, steps): &(&TileDexels, &[SweptStep])| FieldShare {
        dexels: dexels.heights_mm.len(),
        steps: steps.len(),
        wanted: Wanted::Dexels,
    };
    Shipment {
        stage: STAGE,
        fields: fields.iter().map(share).collect(),
        before: Before::Layers(fields.iter().map(|(of, _)| (of.heights_mm.as_slice(), of.passes.as_slice())).collect()),
        rays: fields.iter().map(|(of, _)| bytemuck::cast_slice(&of.rays)).collect(),
        steps: swept_steps::steps(gpu, &placed),
        figures: None,
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
    /// Rows of a group.
    of_rows: usize,
    /// Tiles of the plans, which all have the same.
    tiles: Vec<SweepTile>,
    dexels: TileDexels,
    /// One for each set of passes.
    steps: Vec<SweptStep>,
    /// (Dexel, pass) pairs, but for those that the device counts.
    dexel_passes: u64,
}
