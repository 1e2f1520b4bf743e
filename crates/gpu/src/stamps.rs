//! Times at which launches begin and end, by the device's own clock.
//!
//! In: launches. Out: the time between each one's stamps, which come back with its results.

use super::device::Device;
use wgpu::BufferUsages as Use;

/// Bytes of the stamps of one launch.
pub const STAMP_BYTES: usize = 16;

/// Time between the stamps of launches as they come back, ns.
pub fn device_ns(device: &Device, stamps: &[u8]) -> f64 {
    let stamps: Vec<u64> = stamps.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
    let ticks: u64 = stamps.chunks_exact(2).map(|s| s[1].saturating_sub(s[0])).sum();
    ticks as f64 * f64::from(device.queue.get_timestamp_period())
}

/// Times at which launches begin and end.
pub struct Stamps {
    queries: wgpu::QuerySet,
    /// Where [`Self::resolve`] puts them.
    pub resolved: wgpu::Buffer,
}

impl Stamps {
    /// Stamps of so many launches.
    pub fn new(device: &Device, rounds: usize) -> Self {
        let queries = device.handle.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("stamps"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * rounds as u32,
        });
        let resolved = device.empty("stamps", (STAMP_BYTES * rounds) as u64, Use::QUERY_RESOLVE | Use::COPY_SRC);
        Self { queries, resolved }
    }

    /// What a launch writes.
    pub fn writes(&self, round: usize) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * round as u32),
            end_of_pass_write_index: Some(2 * round as u32 + 1),
        }
    }

    /// Makes the stamps readable.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder, rounds: usize) {
        encoder.resolve_query_set(&self.queries, 0..2 * rounds as u32, &self.resolved, 0);
    }

    /// Brings them back behind other bytes.
    pub fn bring_back(&self, encoder: &mut wgpu::CommandEncoder, back: &wgpu::Buffer, offset: u64, rounds: usize) {
        self.resolve(encoder, rounds);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, back, offset, (STAMP_BYTES * rounds) as u64);
    }
}
