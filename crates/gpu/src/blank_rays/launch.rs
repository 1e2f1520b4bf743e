//! Buffers of the kernel, one launch, and the way back.

use crate::context::Gpu;
use crate::device::Device;
use crate::problem::GpuProblem;
use gearcut_shaders::BLANK_RAYS;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// Longest wait for a launch.
const PATIENCE: Duration = Duration::from_secs(600);

impl Gpu {
    /// Sends one launch over so many tiles.
    pub(super) fn launch_blank(&self, bindings: &[&wgpu::Buffer], tiles: usize) -> Result<(), GpuProblem> {
        let device = &self.device;
        let pipeline = &self.blank_rays[0];
        device.checked(|| {
            let entries: Vec<wgpu::BindGroupEntry> = (0..)
                .zip(bindings)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let group = device.handle.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(BLANK_RAYS.name),
                timestamp_writes: None,
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(tiles as u32, 1, 1);
            drop(pass);
            device.queue.submit([encoder.finish()]);
        })?;
        self.log().count(BLANK_RAYS.name, None);
        Ok(())
    }

    /// The first bytes of a buffer, once all that was sent is done.
    pub(crate) fn bring_back<T: bytemuck::Pod>(&self, from: &wgpu::Buffer, bytes: usize) -> Result<Vec<T>, GpuProblem> {
        Ok(bytemuck::pod_collect_to_vec(&self.bring_back_all(&[(from, bytes)])?[0]))
    }

    /// The first bytes of some buffers, once all that was sent is done: one wait for all.
    pub(crate) fn bring_back_all(&self, from: &[(&wgpu::Buffer, usize)]) -> Result<Vec<Vec<u8>>, GpuProblem> {
        let bytes: usize = from.iter().map(|(_, bytes)| bytes).sum();
        if bytes == 0 {
            return Ok(vec![Vec::new(); from.len()]);
        }
        let device = &self.device;
        let (back, submission) = device.checked(|| {
            let back = device.empty("back", bytes as u64, Use::MAP_READ | Use::COPY_DST);
            if self.options.poison_outputs {
                device.queue.write_buffer(&back, 0, &vec![0xFF; bytes]);
            }
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut place = 0;
            for (buffer, bytes) in from {
                encoder.copy_buffer_to_buffer(buffer, 0, &back, place, *bytes as u64);
                place += *bytes as u64;
            }
            let submission = device.queue.submit([encoder.finish()]);
            back.map_async(wgpu::MapMode::Read, .., |_| {});
            (back, submission)
        })?;
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) };
        if device.checked(|| device.handle.poll(wait))?.is_err() {
            return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() });
        }
        let lost = |reason: String| GpuProblem::Lost { reason };
        let view = device.checked(|| back.get_mapped_range(..))?.map_err(|error| lost(error.to_string()))?;
        let mut rest = &view[..];
        Ok(from.iter().map(|(_, bytes)| rest.split_off(..*bytes).unwrap_or_default().to_vec()).collect())
    }
}

/// A buffer with these bytes.
pub fn filled(device: &Device, label: &str, bytes: &[u8], usage: Use) -> Result<wgpu::Buffer, GpuProblem> {
    roomy(device, label, bytes.len(), bytes, usage)
}

/// A buffer of some size that begins with these bytes; an empty binding is not allowed, so it has sixty-four at least.
pub fn roomy(device: &Device, label: &str, size: usize, bytes: &[u8], usage: Use) -> Result<wgpu::Buffer, GpuProblem> {
    device.checked(|| {
        let buffer = device.empty(label, size.max(64) as u64, usage | Use::COPY_DST);
        device.queue.write_buffer(&buffer, 0, bytes);
        buffer
    })
}
