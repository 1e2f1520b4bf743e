//! The GPU backend: f32 in local frames through wgpu, on any Vulkan, Metal or DirectX 12 adapter, without a window.
//!
//! In: field, plan, layer, as every backend. Out: heights within a nanometre of the native ones wherever these
//! are stable, and the passes that left them. Everything far away is subtracted in f64 on the host ([`compose`]);
//! fields of any size go through in [`batches`]; the host composes one batch while the device works on the one before.
//! Nothing is written to the layer before all batches are back, so a device that fails loses nothing: the flank is cut
//! again natively, or the run stops, as the user chose.
//!
//! The modules, from the ground up; each uses only those above it in this list:
//!
//! - `problem`: what can go wrong on a device, as values
//! - [`waiting`]: where this crate waits
//! - [`adapter`]: which adapters are there, and which one serves
//! - `device`: a device that reports its problems
//! - `pipeline`: pipelines of the stages that the crate `gearcut-shaders` holds
//! - `stamps`: when launches begin and end
//! - [`records`]: what the shaders of shaped flanks read and write, byte for byte
//! - `readback`: fields sent, cut and brought back
//! - `launches`: launches over tiles of many fields
//! - [`sweep_records`]: what the shader of hobbed flanks reads
//! - [`near_edge`]: the piece of an edge that a tile can meet, as one polynomial
//! - [`compose`]: from the plan's f64 records to f32 records
//! - [`batches`]: fields of any size in batches
//! - `context`: the device, its pipelines, and what it has met
//! - `in_flight`: fields that the device takes whole, some at a time
//! - `planar_steps`: what plans need over columns
//! - `planar`: flanks cut by strokes
//! - `sweep_compose`: from the plan's f64 sweeps to f32 records
//! - `tile_dexels`: rays and dexels in the order of tiles
//! - `swept_steps`: what plans of sweeps need over tiles
//! - `spatial`: flanks cut by sweeps
//! - [`blank_records`]: what the shaders of the blank read and write
//! - `blank_rays`: rays of the blank on the device, and launches of the kernel that cuts them
//! - `blank`: the blank of shaping
//! - `blank_sweeps`: the blank of hobbing
//! - `backend`: the backend as the program sees it
//! - `deferred`: the backend for those who may not wait

pub mod adapter;
mod backend;
pub mod batches;
mod blank;
mod blank_rays;
pub mod blank_records;
mod blank_sweeps;
pub mod compose;
mod context;
mod deferred;
mod device;
mod in_flight;
mod launches;
pub mod near_edge;
mod pipeline;
mod planar;
mod planar_steps;
mod problem;
mod readback;
pub mod records;
mod spatial;
mod stamps;
mod sweep_compose;
pub mod sweep_records;
mod swept_steps;
mod tile_dexels;
pub mod waiting;

pub use context::{Gpu, GpuOptions, OnGpuFailure};
pub use deferred::Deferred;
pub use gearcut_shaders as shaders;
pub use problem::GpuProblem;
