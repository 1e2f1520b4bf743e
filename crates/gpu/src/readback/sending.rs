//! A submission as it is put together: buffers, launches, copies.
//!
//! In: jobs. Out: commands, and the place of everything that comes back, in the order in which it is read.

use super::{Before, Input, ReadbackJob, ReadbackStep, Shipment, Wanted};
use crate::device::Device;
use crate::stamps::Stamps;
use std::ops::Range;
use wgpu::BufferUsages as Use;

/// A submission as it is put together.
pub(super) struct Sending<'a> {
    pub(super) device: &'a Device,
    pub(super) shipment: &'a Shipment<'a>,
    pub(super) encoder: wgpu::CommandEncoder,
    pub(super) stamps: Option<Stamps>,
    pub(super) timed: usize,
    pub(super) launched: usize,
    pub(super) back: wgpu::Buffer,
    pub(super) place: u64,
}

impl Sending<'_> {
    fn buffer(&self, label: &str, bytes: &[u8], usage: Use) -> wgpu::Buffer {
        let buffer = self.device.empty(label, bytes.len() as u64, usage | Use::COPY_DST);
        self.device.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// What the device writes.
    fn output(&self, label: &str, bytes: usize) -> wgpu::Buffer {
        let buffer = self.device.empty(label, bytes as u64, Use::STORAGE | Use::COPY_SRC | Use::COPY_DST);
        if self.shipment.poison {
            self.device.queue.write_buffer(&buffer, 0, &vec![0xFF; bytes]);
        }
        buffer
    }

    /// Heights and passes.
    fn dexels(&self, bytes: usize) -> [wgpu::Buffer; 2] {
        ["heights", "passes"].map(|label| self.output(label, bytes))
    }

    fn shared(&self, inputs: &[Input]) -> Vec<Option<wgpu::Buffer>> {
        let own = inputs.iter().map(|input| match *input {
            Input::Shared { label, bytes, usage } => Some(self.buffer(label, bytes, usage)),
            Input::Rays | Input::Tiles | Input::Records => None,
        });
        own.collect()
    }

    fn run(&mut self, pipeline: &wgpu::ComputePipeline, buffers: &[&wgpu::Buffer], [x, y]: [u32; 2], is_timed: bool) {
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let group = self.device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let index = self.launched;
        let timestamp_writes =
            self.stamps.as_ref().filter(|_| is_timed && index < self.timed).map(|stamps| stamps.writes(index));
        self.launched += usize::from(is_timed);
        let label = Some(self.shipment.stage);
        let mut pass = self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(x, y, 1);
    }

    fn bring(&mut self, from: &wgpu::Buffer, bytes: Range<usize>) {
        let size = bytes.len() as u64;
        self.encoder.copy_buffer_to_buffer(from, bytes.start as u64, &self.back, self.place, size);
        self.place += size;
    }

    /// Heights and passes before the first step.
    fn before(&mut self, before: &Before) -> [wgpu::Buffer; 2] {
        let [heights, passes] = self.dexels(before.bytes());
        match before {
            Before::Layer(heights_mm, ids) => {
                self.device.queue.write_buffer(&heights, 0, bytemuck::cast_slice(heights_mm));
                self.device.queue.write_buffer(&passes, 0, bytemuck::cast_slice(ids));
            }
            Before::Uncut { pipeline, inputs, workgroups, .. } => {
                let own = self.shared(inputs);
                let buffers: Vec<&wgpu::Buffer> = own.iter().flatten().chain([&heights, &passes]).collect();
                self.run(pipeline, &buffers, *workgroups, false);
            }
        }
        [heights, passes]
    }

    /// Runs the launches of a step; gives its count of iterations that stopped short.
    fn step(
        &mut self,
        step: &ReadbackStep,
        rays: Option<&wgpu::Buffer>,
        [heights, passes]: &[wgpu::Buffer; 2],
    ) -> wgpu::Buffer {
        let own = self.shared(&step.inputs);
        let unconverged = self.buffer("unconverged", bytemuck::bytes_of(&0_u32), Use::STORAGE | Use::COPY_SRC);
        for launch in &step.launches {
            let tiles = self.buffer("tiles", launch.tiles, Use::STORAGE);
            let records = self.buffer("records", launch.records, self.shipment.record_usage);
            let inputs = step.inputs.iter().zip(&own).map(|(input, own)| match (input, own, rays) {
                (Input::Records, ..) => &records,
                (Input::Rays, _, Some(rays)) => rays,
                (_, Some(own), _) => own,
                (_, None, _) => &tiles,
            });
            let buffers: Vec<&wgpu::Buffer> = inputs.chain([heights, passes, &unconverged]).collect();
            self.run(launch.pipeline, &buffers, launch.workgroups, true);
        }
        unconverged
    }

    /// Runs a job and brings back what is wanted of it.
    pub(super) fn job(&mut self, job: &ReadbackJob) {
        let bytes = job.before.bytes();
        let rays = (!job.rays.is_empty()).then(|| self.buffer("rays", job.rays, Use::STORAGE));
        let mut dexels = vec![self.before(&job.before)];
        for (index, step) in job.steps.iter().enumerate() {
            if matches!(job.wanted, Wanted::Figures(_)) && index > 0 {
                // Those before stay as they are.
                let next = self.dexels(bytes);
                for (before, next) in dexels[index - 1].iter().zip(&next) {
                    self.encoder.copy_buffer_to_buffer(before, 0, next, 0, bytes as u64);
                }
                dexels.push(next);
            }
            let now = &dexels[dexels.len() - 1];
            let unconverged = self.step(step, rays.as_ref(), now);
            if let Wanted::Dexels = job.wanted {
                for of in now {
                    self.bring(of, 0..bytes);
                }
            }
            self.bring(&unconverged, 0..size_of::<u32>());
        }
        if let Wanted::Figures(inputs) = &job.wanted {
            let last = &dexels[dexels.len() - 1];
            for of_step in &dexels {
                let (own, figures) = (self.shared(&inputs.inputs), self.output("figures", inputs.bytes()));
                let buffers: Vec<&wgpu::Buffer> =
                    own.iter().flatten().chain(of_step).chain(last).chain([&figures]).collect();
                self.run(inputs.pipeline, &buffers, [inputs.columns, 1], false);
                self.bring(&figures, 0..inputs.bytes());
            }
            for of in last {
                self.bring(of, inputs.along.clone());
            }
        }
        self.place = self.place.next_multiple_of(8);
    }
}
