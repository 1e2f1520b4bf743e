//! Pipelines of the stages that the crate `gearcut-shaders` holds: one for each variant, bindings from the shader
//! itself.

use super::device::Device;
use super::problem::GpuProblem;
use gearcut_shaders::Stage;

/// Pipelines of a stage, one for each variant.
///
/// # Errors
/// The driver refuses the shader.
pub async fn pipelines(device: &Device, stage: &Stage) -> Result<Vec<wgpu::ComputePipeline>, GpuProblem> {
    let made = || {
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
    };
    device.tried(made).await
}
