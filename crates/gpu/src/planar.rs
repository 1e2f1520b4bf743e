//! Flanks cut by strokes: plans in turn over whole fields, or batches of columns where a field is too large for that.
//!
//! In: fields with their plans. Out: what each plan leaves, or figures of it. Dexels of a field are made on the device,
//! and all its plans run over them there ([`crate::in_flight`]).

use crate::batches::{self, Allowance, Batch};
use crate::context::{Gpu, IN_FLIGHT};
use crate::in_flight::WholeField;
use crate::launches::WORKGROUPS;
use crate::planar_steps::{self, PlanarStep};
use crate::problem::GpuProblem;
use crate::readback::{Before, FieldShare, InFlight, Input, ReadbackStep, Returned, Shipment, StageLaunch, Wanted};
use crate::records::{FigureColumn, FlankField};
use crate::waiting::wait;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{CutLayers, CutStats, PlannedField, cut_in_turn};
use gearcut_core::dexel::figures::{FieldFigures, LinesAt};
use gearcut_core::dexel::{Field, Layer};
use gearcut_core::error::Error;
use gearcut_core::passes::CutPlan;
use gearcut_shaders::{QUAD_ROWS, Rows, WORKGROUP_THREADS, planar_flank};

/// Name of the stage.
const STAGE: &str = planar_flank(Rows::Many).name;
/// Bytes of a dexel: height and pass.
const DEXEL_BYTES: usize = 8;

impl WholeField for PlannedField {
    type Inputs = FieldInputs;

    /// It fits if its dexels do through all plans, and every plan is one batch.
    fn compose(&self, gpu: &Gpu) -> Option<FieldInputs> {
        let Allowance { buffer_bytes, batch_bytes } = gpu.allowance();
        let bytes = held_bytes(self);
        let fits = self.field.columns.len() <= WORKGROUPS && bytes <= buffer_bytes && 2 * bytes <= batch_bytes;
        if fits { FieldInputs::compose(gpu, self, bytes) } else { None }
    }

    fn bytes(inputs: &FieldInputs) -> [u64; 2] {
        let heights = (4 * QUAD_ROWS) as u64 * u64::from(inputs.quads());
        let records = inputs.steps.iter().map(|step| step.record_bytes() as u64);
        [inputs.dexel_bytes + records.clone().sum::<u64>(), records.fold(heights, u64::max)]
    }

    fn shipment<'a>(fields: &[&'a FieldInputs], gpu: &'a Gpu) -> Shipment<'a> {
        shipment(fields, gpu)
    }

    fn layers(&self, _: FieldInputs, left: Returned) -> CutLayers {
        cut_layers(self, left)
    }

    fn cut_in_batches(&self, gpu: &Gpu) -> Result<CutLayers, Error> {
        cut_in_turn(gpu, self, |_, _| ())
    }

    fn cut_natively(&self, native: Cpu) -> Result<CutLayers, Error> {
        cut_in_turn(&native, self, |_, _| ())
    }
}

impl Gpu {
    /// Heights and passes of a field of any size, the layer untouched.
    pub(crate) fn cut_on_device(
        &self,
        field: &Field,
        plan: &CutPlan,
        layer: &Layer,
    ) -> Result<(Layer, CutStats), GpuProblem> {
        self.device.alive()?;
        let (rows, padded) = (field.rows(), batches::padded(field.rows()));
        let mut result = layer.clone();
        let mut unconverged = 0;
        let mut waiting: Vec<(Batch, InFlight)> = Vec::new();
        let mut collect = |(batch, in_flight): (Batch, InFlight)| -> Result<(), GpuProblem> {
            let left = wait(self.collect(in_flight))?;
            let Returned { layers, unconverged: short, .. } = &left[0];
            let Layer { heights_mm, passes } = &layers[0];
            for (index, column) in batch.columns.enumerate() {
                let (dexels, there) = (column * rows..(column + 1) * rows, index * padded..index * padded + rows);
                result.heights_mm[dexels.clone()].copy_from_slice(&heights_mm[there.clone()]);
                result.passes[dexels].copy_from_slice(&passes[there]);
            }
            unconverged += u64::from(*short);
            Ok(())
        };
        for batch in batches::batches(plan, self.allowance(), self.rows)? {
            if waiting.len() == IN_FLIGHT {
                collect(waiting.remove(0))?;
            }
            let step = [PlanarStep::compose(self, field, plan, &batch)];
            let dexels = batch.columns.start * rows..batch.columns.end * rows;
            let heights_mm = padded_columns(&layer.heights_mm[dexels.clone()], rows);
            let passes = padded_columns(&layer.passes[dexels], rows);
            let in_flight = wait(self.send(&Shipment {
                stage: STAGE,
                fields: vec![FieldShare { dexels: heights_mm.len(), steps: 1, wanted: Wanted::Dexels }],
                before: Before::Layers(vec![(&heights_mm, &passes)]),
                rays: Vec::new(),
                steps: planar_steps::steps(self, &[(0, &step)]),
                figures: None,
            }))?;
            waiting.push((batch, in_flight));
        }
        waiting.into_iter().try_for_each(collect)?;
        Ok((result, CutStats { dexels: field.len() as u64, dexel_passes: plan.dexel_passes(), unconverged }))
    }
}

/// Lines of a field of which figures come back, where these are fewer bytes than the dexels.
fn figures_at(planned: &PlannedField) -> Option<LinesAt> {
    planned.lines.filter(|_| DEXEL_BYTES * planned.field.rows() > size_of::<FigureColumn>())
}

/// Bytes of the dexels of a field that are kept on the device.
fn held_bytes(planned: &PlannedField) -> u64 {
    let PlannedField { field, plans, .. } = planned;
    let layers = if figures_at(planned).is_some() { plans.len() } else { plans.len() + 1 };
    (DEXEL_BYTES * batches::padded(field.rows()) * field.columns.len() * layers) as u64
}

/// What is left of a field.
fn cut_layers(planned: &PlannedField, left: Returned) -> CutLayers {
    let PlannedField { field, plans, .. } = planned;
    let stats = CutStats {
        dexels: (field.len() * plans.len()) as u64,
        dexel_passes: plans.iter().map(CutPlan::dexel_passes).sum(),
        unconverged: u64::from(left.unconverged),
    };
    let rows = field.rows();
    let mut layers: Vec<Layer> = left.layers.into_iter().map(|layer| unpadded(layer, rows)).collect();
    if left.figures.is_empty() {
        return CutLayers { layers, figures: None, stats };
    }
    let last = left.figures.len() - 1;
    let profile = Layer {
        heights_mm: left.figures[last].iter().map(|column| column.profile_mm).collect(),
        passes: left.figures[last].iter().map(|column| column.profile_pass).collect(),
    };
    let figures = FieldFigures {
        heights: left.figures.iter().map(|columns| columns.iter().map(|of| of.heights(rows)).collect()).collect(),
        stock: left.figures[..last].iter().map(|columns| columns.iter().map(|of| of.stock(rows)).collect()).collect(),
        profile,
        along: layers.swap_remove(0),
    };
    CutLayers { layers: Vec::new(), figures: Some(figures), stats }
}

/// Columns one after the other, each filled up to whole quads with its last value.
fn padded_columns<T: Copy>(values: &[T], rows: usize) -> Vec<T> {
    let mut columns = Vec::with_capacity(values.len() / rows * batches::padded(rows));
    for column in values.chunks_exact(rows) {
        columns.extend_from_slice(column);
        columns.extend(std::iter::repeat_n(column[rows - 1], batches::padded(rows) - rows));
    }
    columns
}

/// A layer without the rows that fill up quads.
fn unpadded(left: Layer, rows: usize) -> Layer {
    let padded = batches::padded(rows);
    if padded == rows {
        return left;
    }
    Layer {
        heights_mm: left.heights_mm.chunks_exact(padded).flat_map(|column| &column[..rows]).copied().collect(),
        passes: left.passes.chunks_exact(padded).flat_map(|column| &column[..rows]).copied().collect(),
    }
}

/// What a field needs that the device takes whole, composed.
pub(crate) struct FieldInputs {
    /// Bytes of its dexels through all plans.
    dexel_bytes: u64,
    /// The field by itself.
    shape: FlankField,
    /// Height of every column before the first plan.
    blank_mm: Vec<f32>,
    /// Lowest height that every column records.
    low_mm: Vec<f32>,
    steps: Vec<PlanarStep>,
    /// Lines of which figures come back; nothing: all dexels do.
    lines: Option<LinesAt>,
}

impl FieldInputs {
    fn compose(gpu: &Gpu, planned: &PlannedField, dexel_bytes: u64) -> Option<Self> {
        let PlannedField { field, plans, .. } = planned;
        let whole = |plan| batches::batches(plan, gpu.allowance(), gpu.rows).ok().filter(|all| all.len() == 1);
        let whole: Vec<Vec<Batch>> = plans.iter().map(whole).collect::<Option<_>>()?;
        let steps = plans.iter().zip(&whole).map(|(plan, whole)| PlanarStep::compose(gpu, field, plan, &whole[0]));
        let lines = figures_at(planned);
        Some(Self {
            dexel_bytes,
            shape: FlankField {
                first_column: 0,
                column_count: field.columns.len() as u32,
                first_quad: 0,
                quads: field.rows().div_ceil(QUAD_ROWS) as u32,
                rows: field.rows() as u32,
                profile_row: lines.map_or(0, |lines| lines.row as u32),
            },
            blank_mm: field.columns.iter().map(|column| column.blank_mm as f32).collect(),
            low_mm: field.columns.iter().map(|column| column.low_mm as f32).collect(),
            steps: steps.collect(),
            lines,
        })
    }

    fn quads(&self) -> u32 {
        self.shape.column_count * self.shape.quads
    }

    fn share(&self) -> FieldShare {
        let column = self.shape.quads as usize * QUAD_ROWS;
        let wanted = self.lines.map_or(Wanted::Dexels, |lines| Wanted::Figures {
            columns: self.blank_mm.len(),
            along: lines.column * column..(lines.column + 1) * column,
        });
        FieldShare { dexels: column * self.blank_mm.len(), steps: self.steps.len(), wanted }
    }
}

/// Fields together, from the uncut dexels on.
fn shipment<'a>(fields: &[&'a FieldInputs], gpu: &'a Gpu) -> Shipment<'a> {
    let mut first_quad = 0;
    let placed: Vec<(u32, &FieldInputs)> = fields
        .iter()
        .map(|&inputs| {
            let first = first_quad;
            first_quad += inputs.quads();
            (first, inputs)
        })
        .collect();
    let measured: Vec<(u32, &FieldInputs)> =
        placed.iter().filter(|(_, inputs)| inputs.lines.is_some()).copied().collect();
    let steps: Vec<(u32, &[PlanarStep])> =
        placed.iter().map(|&(first_quad, inputs)| (first_quad, inputs.steps.as_slice())).collect();
    let uncut = |field: &FlankField| (field.column_count * field.quads).div_ceil(WORKGROUP_THREADS);
    let figures = || {
        let low_mm = measured.iter().map(|(_, inputs)| bytemuck::cast_slice(&inputs.low_mm)).collect();
        of_columns(&gpu.flank_figures[0], &measured, ("low", low_mm), |field| field.column_count)
    };
    let blank_mm = placed.iter().map(|(_, inputs)| bytemuck::cast_slice(&inputs.blank_mm)).collect();
    Shipment {
        stage: STAGE,
        fields: fields.iter().map(|inputs| inputs.share()).collect(),
        before: Before::Uncut(of_columns(&gpu.planar_uncut[0], &placed, ("blank", blank_mm), uncut)),
        rays: Vec::new(),
        steps: planar_steps::steps(gpu, &steps),
        figures: (!measured.is_empty()).then(figures),
    }
}

/// One launch over all columns of some fields, which have their first quads, with a number for each column.
fn of_columns<'a>(
    pipeline: &'a wgpu::ComputePipeline,
    fields: &[(u32, &'a FieldInputs)],
    (label, numbers): (&'static str, Vec<&'a [u8]>),
    workgroups: impl Fn(&FlankField) -> u32,
) -> ReadbackStep<'a> {
    let mut first_column = 0;
    let shapes = fields.iter().map(|&(first_quad, inputs)| {
        let placed = FlankField { first_column, first_quad, ..inputs.shape };
        first_column += placed.column_count;
        placed
    });
    let shapes: Vec<FlankField> = shapes.collect();
    let launch = StageLaunch {
        pipeline,
        workgroups: [shapes.iter().map(workgroups).max().unwrap_or(0), shapes.len() as u32],
        tiles: bytemuck::cast_slice(&shapes).to_vec(),
    };
    ReadbackStep { inputs: vec![Input::Tiles, Input::Shared(label, numbers)], launches: vec![launch] }
}
