//! Buffers of the kernel, and the way back.

use crate::context::Gpu;
use crate::device::Device;
use crate::problem::GpuProblem;
use std::time::Duration;
use wgpu::BufferUsages as Use;

/// Longest wait for a submission.
const PATIENCE: Duration = Duration::from_secs(600);

/// Bytes on their way back.
pub struct Returning {
    back: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    sizes: Vec<usize>,
}

impl Gpu {
    /// Sends commands, and the first bytes of some buffers back once they are done.
    pub(super) fn send_back(
        &self,
        mut commands: Vec<wgpu::CommandBuffer>,
        from: &[(&wgpu::Buffer, usize)],
    ) -> Result<Returning, GpuProblem> {
        let device = &self.device;
        let sizes: Vec<usize> = from.iter().map(|(_, bytes)| *bytes).collect();
        let bytes: usize = sizes.iter().sum();
        device.checked(|| {
            let back = device.empty("back", bytes as u64, Use::MAP_READ | Use::COPY_DST);
            if self.options.poison_outputs {
                device.queue.write_buffer(&back, 0, &vec![0xFF; bytes]);
            }
            let mut encoder = device.handle.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut place = 0;
            for (buffer, bytes) in from.iter().filter(|(_, bytes)| *bytes > 0) {
                encoder.copy_buffer_to_buffer(buffer, 0, &back, place, *bytes as u64);
                place += *bytes as u64;
            }
            commands.push(encoder.finish());
            let submission = device.queue.submit(commands);
            back.map_async(wgpu::MapMode::Read, .., |_| {});
            Returning { back, submission, sizes }
        })
    }

    /// Waits for them, buffer by buffer.
    pub(super) fn collect_back(&self, returning: Returning) -> Result<Vec<Vec<u8>>, GpuProblem> {
        let Returning { back, submission, sizes } = returning;
        let device = &self.device;
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) };
        if device.checked(|| device.handle.poll(wait))?.is_err() {
            return Err(GpuProblem::Silent { seconds: PATIENCE.as_secs() });
        }
        let lost = |reason: String| GpuProblem::Lost { reason };
        let view = device.checked(|| back.get_mapped_range(..))?.map_err(|error| lost(error.to_string()))?;
        let mut rest = &view[..];
        Ok(sizes.iter().map(|bytes| rest.split_off(..*bytes).unwrap_or_default().to_vec()).collect())
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
