//! Adapters: which are there, what they allow, and which one serves.
//!
//! Real GPUs come first (discrete, integrated, virtual), software adapters such as llvmpipe last. One GPU may be listed
//! under several interfaces (Vulkan and DirectX 12 on Windows).

use super::problem::GpuProblem;
use super::waiting::wait;
use gearcut_shaders::{LARGEST_WORKGROUP, STORAGE_BUFFERS};
use serde::Serialize;
use std::fmt;

/// What an adapter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AdapterKind {
    /// A card with memory of its own.
    Discrete,
    /// Part of the processor.
    Integrated,
    /// A share of a GPU in a virtual machine.
    Virtual,
    /// The driver does not say.
    Unknown,
    /// The processor plays the GPU: llvmpipe, SwiftShader, WARP.
    Software,
}

impl AdapterKind {
    /// A GPU in hardware.
    pub fn is_real(self) -> bool {
        matches!(self, Self::Discrete | Self::Integrated | Self::Virtual)
    }
}

impl fmt::Display for AdapterKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Discrete => "discrete GPU",
            Self::Integrated => "integrated GPU",
            Self::Virtual => "virtual GPU",
            Self::Unknown => "unknown kind",
            Self::Software => "software",
        })
    }
}

/// Adapter as shown to the user.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AdapterFacts {
    /// Name that the driver gives.
    pub name: String,
    /// What it is.
    pub kind: AdapterKind,
    /// Vulkan, Metal or Dx12.
    pub interface: String,
    /// Driver with version.
    pub driver: String,
    /// Largest storage binding in bytes: larger fields are cut in batches.
    pub binding_bytes: u64,
    /// Largest buffer in bytes.
    pub buffer_bytes: u64,
    /// Largest workgroup.
    pub workgroup_threads: u32,
    /// It can time its own work.
    pub timestamps: bool,
    /// What it lacks to run the shaders, if anything.
    pub lacks: Option<String>,
}

impl fmt::Display for AdapterFacts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mib = |bytes: u64| bytes >> 20;
        write!(
            f,
            "{} ({}, {}, {}): binding {} MiB, buffer {} MiB, workgroup {}, timestamps {}",
            self.name,
            self.kind,
            self.interface,
            self.driver,
            mib(self.binding_bytes),
            mib(self.buffer_bytes),
            self.workgroup_threads,
            if self.timestamps { "yes" } else { "no" },
        )?;
        self.lacks.iter().try_for_each(|lacks| write!(f, ", lacks {lacks}"))
    }
}

/// Which adapter is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AdapterWish {
    /// A GPU in hardware.
    Real,
    /// A GPU in hardware, else any other.
    RealFirst,
    /// A software adapter, on purpose: for tests that must mean the same everywhere.
    Software,
}

/// An adapter with its facts.
pub struct FoundAdapter {
    /// wgpu's handle.
    pub handle: wgpu::Adapter,
    /// What it is.
    pub facts: AdapterFacts,
}

/// All adapters, best first.
pub fn adapters() -> Vec<FoundAdapter> {
    wait(all())
}

/// The same for those who may not wait: a browser shows the adapter that it would take, with a name or without.
pub async fn all() -> Vec<FoundAdapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let listed = instance.enumerate_adapters(wgpu::Backends::all()).await;
    let mut found: Vec<FoundAdapter> =
        listed.into_iter().map(|handle| FoundAdapter { facts: facts(&handle), handle }).collect();
    // The sort is stable: among equals the loader's order, which users set in their drivers, stands.
    found.sort_by_key(|a| (a.facts.lacks.is_some(), a.facts.kind, a.facts.interface == "Dx12"));
    found
}

fn facts(adapter: &wgpu::Adapter) -> AdapterFacts {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    let lacks = if limits.max_storage_buffers_per_shader_stage < STORAGE_BUFFERS {
        Some(format!("{STORAGE_BUFFERS} storage buffers in a stage"))
    } else if limits.max_compute_invocations_per_workgroup < LARGEST_WORKGROUP {
        Some(format!("workgroups of {LARGEST_WORKGROUP} threads"))
    } else {
        None
    };
    AdapterFacts {
        name: info.name,
        kind: match info.device_type {
            wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
            wgpu::DeviceType::IntegratedGpu => AdapterKind::Integrated,
            wgpu::DeviceType::VirtualGpu => AdapterKind::Virtual,
            wgpu::DeviceType::Cpu => AdapterKind::Software,
            wgpu::DeviceType::Other => AdapterKind::Unknown,
        },
        interface: format!("{:?}", info.backend),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        binding_bytes: limits.max_storage_buffer_binding_size,
        buffer_bytes: limits.max_buffer_size,
        workgroup_threads: limits.max_compute_invocations_per_workgroup,
        timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        lacks,
    }
}

/// Index of the adapter that serves a wish, best first; `None` if none does.
pub fn pick(adapters: &[AdapterFacts], wish: AdapterWish) -> Option<usize> {
    adapters.iter().position(|a| {
        a.lacks.is_none()
            && match wish {
                AdapterWish::Real => a.kind.is_real(),
                AdapterWish::RealFirst => true,
                AdapterWish::Software => a.kind == AdapterKind::Software,
            }
    })
}

/// The adapter that serves a wish.
///
/// # Errors
/// [`GpuProblem::NoAdapter`] with the names of those that do not.
pub fn choose(wish: AdapterWish) -> Result<FoundAdapter, GpuProblem> {
    wait(chosen(wish))
}

/// The same for those who may not wait.
///
/// # Errors
/// As there.
pub async fn chosen(wish: AdapterWish) -> Result<FoundAdapter, GpuProblem> {
    let mut found = all().await;
    let facts: Vec<AdapterFacts> = found.iter().map(|a| a.facts.clone()).collect();
    match pick(&facts, wish) {
        Some(index) => Ok(found.swap_remove(index)),
        None => Err(GpuProblem::NoAdapter { seen: facts.iter().map(|f| format!("{} ({})", f.name, f.kind)).collect() }),
    }
}
