//! Shaders as text and as pipelines.
//!
//! A stage's text is its file after the shared ones, joined as they are: no preprocessor stands between the files and
//! what the driver sees. Variants are `override` constants. Bindings come from the shader itself.

use super::adapter::WORKGROUP_THREADS;
use super::device::Device;
use super::problem::GpuProblem;

/// A stage: one shader file, one entry point of the same name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// Name of the file, the entry point, the label and the row in the timings.
    pub name: &'static str,
    /// Whole text.
    pub text: &'static str,
    /// Its bindings in order, by the names that they have there.
    pub bindings: &'static [&'static str],
    /// Constants of every variant that is used.
    pub variants: &'static [&'static [(&'static str, f64)]],
}

/// The planar kernel: strokes that move or rest, edges with or without arcs; [`planar_variant`] finds the one that
/// serves.
pub const PLANAR_FLANK: Stage = Stage {
    name: "planar_flank",
    text: concat!(
        include_str!("../shaders/shared/records.wgsl"),
        include_str!("../shaders/shared/entry.wgsl"),
        include_str!("../shaders/planar_flank.wgsl"),
    ),
    bindings: &["launch", "tiles", "columns", "records", "row_phases", "heights_mm", "passes", "unconverged"],
    variants: &[
        &[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64), ("FROZEN", 0.0), ("ARCS", 0.0)],
        &[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64), ("FROZEN", 0.0), ("ARCS", 1.0)],
        &[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64), ("FROZEN", 1.0), ("ARCS", 0.0)],
        &[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64), ("FROZEN", 1.0), ("ARCS", 1.0)],
    ],
};

/// Place in the variants of [`PLANAR_FLANK`].
pub fn planar_variant(frozen: bool, arcs: bool) -> usize {
    2 * usize::from(frozen) + usize::from(arcs)
}

/// Rays through the blank.
pub const BLANK_RAYS: Stage = Stage {
    name: "blank_rays",
    text: concat!(include_str!("../shaders/shared/blank_records.wgsl"), include_str!("../shaders/blank_rays.wgsl"),),
    bindings: &["launch", "tiles", "passes", "parts", "spans", "counts", "removed", "needs", "pieces"],
    variants: &[&[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64)]],
};

/// The spatial kernel: rake faces that are planes, and helical ones.
pub const SPATIAL_FLANK: Stage = Stage {
    name: "spatial_flank",
    text: concat!(include_str!("../shaders/shared/sweep_records.wgsl"), include_str!("../shaders/spatial_flank.wgsl"),),
    bindings: &["tiles", "records", "cells", "rays", "heights_mm", "passes", "unconverged"],
    variants: &[
        &[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64), ("TWISTED", 0.0)],
        &[("WORKGROUP_THREADS", WORKGROUP_THREADS as f64), ("TWISTED", 1.0)],
    ],
};

/// All stages, for the tests that check every one.
pub const STAGES: &[Stage] = &[PLANAR_FLANK, BLANK_RAYS, SPATIAL_FLANK];

/// Pipelines of a stage, one for each variant.
///
/// # Errors
/// The driver refuses the shader.
pub fn pipelines(device: &Device, stage: &Stage) -> Result<Vec<wgpu::ComputePipeline>, GpuProblem> {
    device.checked(|| {
        let module = device.handle.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(stage.name),
            source: wgpu::ShaderSource::Wgsl(stage.text.into()),
        });
        let pipeline = |constants: &&[(&'static str, f64)]| {
            device.handle.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(stage.name),
                layout: None,
                module: &module,
                entry_point: Some(stage.name),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                cache: None,
            })
        };
        stage.variants.iter().map(pipeline).collect()
    })
}

/// Rows of a quad, the lanes of the planar kernel's vectors.
pub const QUAD_ROWS: usize = 4;
/// Quads that one thread of the planar kernel cuts.
pub const QUADS_PER_THREAD: u32 = 2;
/// Records of a launch of the planar kernel at most.
pub const ROUND_RECORDS: u32 = 512;
/// Rows that one thread of the spatial kernel cuts, as the lanes of its vectors.
pub const SPATIAL_ROWS_PER_THREAD: u32 = 4;

/// Threads of the planar kernel that share the rows of one column.
pub fn threads_per_column(rows: usize) -> usize {
    rows.div_ceil(QUAD_ROWS).div_ceil(QUADS_PER_THREAD as usize)
}
