//! A device that reports its problems as values: loss, refused memory, refused calls.
//!
//! Errors are caught in scopes of the calling thread, so flanks cut in parallel do not see each other's. What no scope
//! catches, the loss of the device, is kept and ends every later call.
//!
//! What a device answers comes later: [`Device::tried`] is a future, and [`Device::checked`] waits for it.

use super::adapter::{AdapterFacts, FoundAdapter};
use super::problem::GpuProblem;
use super::waiting::wait;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long a device that refuses a call may finish what it has before the reason is taken as it stands.
const SETTLING: Duration = Duration::from_secs(10);

/// An open device.
pub struct Device {
    /// wgpu's handle.
    pub handle: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The adapter it stands on.
    pub facts: AdapterFacts,
    lost: Arc<Mutex<Option<GpuProblem>>>,
}

impl Device {
    /// Opens a device with all that the adapter allows.
    ///
    /// # Errors
    /// The driver gives none.
    pub async fn open(adapter: &FoundAdapter) -> Result<Self, GpuProblem> {
        let timestamps = adapter.handle.features() & wgpu::Features::TIMESTAMP_QUERY;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("gearcut"),
            required_features: timestamps,
            required_limits: adapter.handle.limits(),
            ..Default::default()
        };
        let opened = adapter.handle.request_device(&descriptor).await;
        let (handle, queue) = opened
            .map_err(|error| GpuProblem::NoDevice { adapter: adapter.facts.name.clone(), reason: error.to_string() })?;
        let lost = Arc::new(Mutex::new(None));
        let keep = |lost: &Arc<Mutex<Option<GpuProblem>>>| {
            let lost = Arc::clone(lost);
            move |problem| {
                lost.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(problem);
            }
        };
        let on_loss = keep(&lost);
        handle.set_device_lost_callback(move |why, message| {
            on_loss(GpuProblem::Lost { reason: format!("{why:?}: {message}").trim_end_matches([':', ' ']).to_owned() });
        });
        let on_stray = keep(&lost);
        handle.on_uncaptured_error(Arc::new(move |error: wgpu::Error| on_stray(error.into())));
        Ok(Self { handle, queue, facts: adapter.facts.clone(), lost })
    }

    /// [`Self::tried`], waiting.
    ///
    /// # Errors
    /// As there.
    pub fn checked<T>(&self, work: impl FnOnce() -> T) -> Result<T, GpuProblem> {
        wait(self.tried(work))
    }

    /// Runs `work` and gives the first error of its calls instead of its result.
    ///
    /// # Errors
    /// The device is lost, memory was refused, a call was refused.
    pub async fn tried<T>(&self, work: impl FnOnce() -> T) -> Result<T, GpuProblem> {
        let filters = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::OutOfMemory];
        let scopes = filters.map(|filter| self.handle.push_error_scope(filter));
        let value = work();
        let mut first = None;
        for scope in scopes.into_iter().rev() {
            let met = scope.pop().await;
            first = first.or(met);
        }
        self.alive()?;
        match first {
            None => Ok(value),
            Some(error) => {
                // A lost device refuses calls before it says that it is lost, which it does once its queue has come to
                // rest.
                let settled = wgpu::PollType::Wait { submission_index: None, timeout: Some(SETTLING) };
                let _ = self.handle.poll(settled);
                self.alive()?;
                Err(error.into())
            }
        }
    }

    /// A buffer that holds nothing yet.
    pub fn empty(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let label = Some(label);
        self.handle.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
    }

    /// Whether the device still works.
    ///
    /// # Errors
    /// The problem that ended it.
    pub fn alive(&self) -> Result<(), GpuProblem> {
        match &*self.lost.lock().unwrap_or_else(PoisonError::into_inner) {
            None => Ok(()),
            Some(problem) => Err(problem.clone()),
        }
    }
}
