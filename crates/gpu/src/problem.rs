//! What can go wrong on a device, as values: no call of this backend panics because of a driver, and none returns half
//! a flank.

use std::fmt::Write as _;

/// A device problem, with what the user can do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GpuProblem {
    /// There is nothing to run on.
    #[error(
        "no Vulkan, Metal or DirectX 12 adapter found{}\n  way out: install the graphics driver, or a software adapter \
         (package mesa-vulkan-drivers on Debian and Ubuntu, mesa-vulkan-swrast on Alpine), or use --backend cpu",
        listed(seen)
    )]
    NoAdapter {
        /// Adapters that were there and did not serve, by name.
        seen: Vec<String>,
    },
    /// The adapter gives no device.
    #[error("{adapter} gives no device: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// The driver's reason.
        reason: String,
    },
    /// The device went away during the work: driver reset, unplugged, destroyed.
    #[error("the device was lost: {reason}")]
    Lost {
        /// The driver's reason.
        reason: String,
    },
    /// Memory was refused, by the driver or by the limit set for this backend.
    #[error("out of device memory: {reason}")]
    OutOfMemory {
        /// Who refused what.
        reason: String,
    },
    /// The driver or the validation refused a call: a bug in gearcut or in the driver.
    #[error("refused by the graphics driver's validation (a bug: please report it): {reason}")]
    Invalid {
        /// What the validation said.
        reason: String,
    },
    /// No answer within the time that a batch can take.
    #[error("the device gave no answer for {seconds} s")]
    Silent {
        /// How long it was waited for.
        seconds: u64,
    },
}

fn listed(seen: &[String]) -> String {
    let mut text = String::new();
    if !seen.is_empty() {
        let _ = write!(text, " that serves (there: {})", seen.join(", "));
    }
    text
}

impl From<wgpu::Error> for GpuProblem {
    fn from(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { source } => Self::OutOfMemory { reason: format!("the driver says {source}") },
            wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
                Self::Invalid { reason: description }
            }
        }
    }
}

impl From<GpuProblem> for gearcut_core::Error {
    fn from(problem: GpuProblem) -> Self {
        Self::Device(Box::new(problem))
    }
}
