//! A submission as it is put together: buffers, launches, copies.
//!
//! In: fields with their steps. Out: commands that bring back the parts in their order.

use super::parts::{COUNT_BYTES, OutputBuffer, ReturnedPart, ReturnedParts, VALUE_BYTES};
use super::{Before, Input, ReadbackStep, Shipment, Wanted};
use crate::device::Device;
use crate::records::FigureColumn;
use crate::stamps::Stamps;
use wgpu::BufferUsages as Use;

/// A submission as it is put together.
pub struct Sending<'a> {
    /// The device.
    pub device: &'a Device,
    /// Name of the stage.
    pub stage: &'static str,
    /// Whether outputs are filled with ones.
    pub poison: bool,
    /// Commands so far.
    pub encoder: wgpu::CommandEncoder,
    /// Stamps of the first launches.
    pub stamps: Option<Stamps>,
    /// How many of them.
    pub timed: usize,
    /// Launches so far.
    pub launched: usize,
    /// Where parts are copied to.
    pub back: wgpu::Buffer,
    /// Bytes there so far.
    pub place: u64,
}

impl Sending<'_> {
    /// Parts one after the other; where there are none, room for a number, which a binding must have.
    fn buffer(&self, label: &str, parts: &[&[u8]], usage: Use) -> wgpu::Buffer {
        let bytes = parts.iter().map(|part| part.len()).sum::<usize>().max(VALUE_BYTES);
        let buffer = self.device.empty(label, bytes as u64, usage | Use::STORAGE | Use::COPY_DST);
        self.fill(&buffer, parts);
        buffer
    }

    fn fill(&self, buffer: &wgpu::Buffer, parts: &[&[u8]]) {
        let mut place = 0;
        for part in parts {
            self.device.queue.write_buffer(buffer, place, part);
            place += part.len() as u64;
        }
    }

    /// What the device writes.
    fn output(&self, label: &str, bytes: usize) -> wgpu::Buffer {
        let buffer = self.device.empty(label, bytes as u64, Use::STORAGE | Use::COPY_SRC | Use::COPY_DST);
        if self.poison {
            self.device.queue.write_buffer(&buffer, 0, &vec![0xFF; bytes]);
        }
        buffer
    }

    /// Heights and passes.
    fn dexels(&self, bytes: usize) -> [wgpu::Buffer; 2] {
        ["heights", "passes"].map(|label| self.output(label, bytes))
    }

    /// Runs the launches of a step.
    fn run(&mut self, step: &ReadbackStep, rays: Option<&wgpu::Buffer>, outputs: &[&wgpu::Buffer], is_timed: bool) {
        if step.launches.is_empty() {
            return;
        }
        let own: Vec<Option<wgpu::Buffer>> = step
            .inputs
            .iter()
            .map(|input| match input {
                Input::Shared(label, parts) => Some(self.buffer(label, parts, Use::empty())),
                Input::Rays | Input::Tiles => None,
            })
            .collect();
        for launch in &step.launches {
            let tiles = self.buffer("tiles", &[&launch.tiles], Use::empty());
            let inputs = step.inputs.iter().zip(&own).map(|(input, own)| match input {
                Input::Rays => rays.unwrap_or(&tiles),
                Input::Shared(..) | Input::Tiles => own.as_ref().unwrap_or(&tiles),
            });
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(inputs.chain(outputs.iter().copied()))
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let group = self.device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &launch.pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let index = self.launched;
            let timestamp_writes =
                self.stamps.as_ref().filter(|_| is_timed && index < self.timed).map(|stamps| stamps.writes(index));
            self.launched += usize::from(is_timed);
            let label = Some(self.stage);
            let mut pass = self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
            pass.set_pipeline(launch.pipeline);
            pass.set_bind_group(0, &group, &[]);
            let [x, y] = launch.workgroups;
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    /// Copies parts, neighbours at once.
    fn bring<'b>(&mut self, parts: &[ReturnedPart], from: impl Fn(OutputBuffer) -> &'b wgpu::Buffer) {
        for run in parts.chunk_by(|a, b| a.source == b.source && a.bytes.end == b.bytes.start) {
            let (start, end) = (run[0].bytes.start as u64, run[run.len() - 1].bytes.end as u64);
            self.encoder.copy_buffer_to_buffer(from(run[0].source), start, &self.back, self.place, end - start);
            self.place += end - start;
        }
    }

    /// Heights and passes before the first step.
    fn before(&mut self, before: &Before, [heights, passes]: &[wgpu::Buffer; 2]) {
        match before {
            Before::Layers(layers) => {
                let [heights_mm, ids]: [Vec<&[u8]>; 2] = [
                    layers.iter().map(|(heights_mm, _)| bytemuck::cast_slice(heights_mm)).collect(),
                    layers.iter().map(|(_, ids)| bytemuck::cast_slice(ids)).collect(),
                ];
                self.fill(heights, &heights_mm);
                self.fill(passes, &ids);
            }
            Before::Uncut(step) => self.run(step, None, &[heights, passes], false),
        }
    }

    /// Runs all steps and brings back what is wanted.
    pub fn ship(&mut self, shipment: &Shipment, parts: &ReturnedParts) {
        let fields = &shipment.fields;
        let bytes = VALUE_BYTES * fields.iter().map(|share| share.dexels).sum::<usize>();
        let rays = (!shipment.rays.is_empty()).then(|| self.buffer("rays", &shipment.rays, Use::empty()));
        let zeros = vec![0; COUNT_BYTES * fields.len()];
        let counts = self.buffer("counts", &[&zeros], Use::COPY_SRC);
        let mut layers = vec![self.dexels(bytes)];
        self.before(&shipment.before, &layers[0]);
        for (index, (step, parts)) in shipment.steps.iter().zip(&parts.of_steps).enumerate() {
            if shipment.figures.is_some() && index > 0 {
                // Those before stay as they are.
                let next = self.dexels(bytes);
                for (before, next) in layers[index - 1].iter().zip(&next) {
                    self.encoder.copy_buffer_to_buffer(before, 0, next, 0, bytes as u64);
                }
                layers.push(next);
            }
            let [heights, passes] = &layers[layers.len() - 1];
            self.run(step, rays.as_ref(), &[heights, passes, &counts], true);
            self.bring(parts, |source| if source == OutputBuffer::Heights { heights } else { passes });
        }
        let last = &layers[layers.len() - 1];
        if let Some(step) = &shipment.figures {
            let columns =
                fields.iter().map(|share| if let Wanted::Figures { columns, .. } = share.wanted { columns } else { 0 });
            let bytes = size_of::<FigureColumn>() * columns.sum::<usize>();
            for (of_step, parts) in layers.iter().zip(&parts.of_figures) {
                let figures = self.output("figures", bytes);
                self.run(step, None, &[&of_step[0], &of_step[1], &last[0], &last[1], &figures], false);
                self.bring(parts, |_| &figures);
            }
        }
        self.bring(&parts.at_the_end, |source| match source {
            OutputBuffer::Heights => &last[0],
            OutputBuffer::Passes => &last[1],
            OutputBuffer::Figures | OutputBuffer::Counts => &counts,
        });
    }
}
