//! gearcut moves a machine's axes by its linkage model, sweeps every real cutting edge stroke by stroke through dexels
//! of the blank, and measures what is left.
//!
//! The modules, from the ground up; each uses only those above it in this list:
//!
//! - [`gearcut_core`]: gears, tools, dexels, passes and the native backend; its modules are re-exported here
//! - `gearcut_gpu` as `gpu`: the backend on wgpu, left out without the feature `gpu`
//! - [`backend`]: which machine cuts
//! - [`interrupt`]: Ctrl-C as a flag
//! - [`colormap`]: numbers as colours
//! - [`machine`]: the axes of a machine: kinds, units, motion, limits, peaks
//! - [`material`]: cutting forces from chip thickness
//! - [`scene`]: the scene file as checked values
//! - [`measure`]: what is left, in numbers
//! - [`surface`]: what is left, as triangles and pictures
//! - [`gcode`]: how programs are spelled and read
//! - [`findings`]: what a run found, as one tree of quantities and tables
//! - [`output`]: files, charts, tables, reports
//! - [`job`]: what the shared steps ask of a job, whatever its process
//! - [`texture`]: texture windows on flanks
//! - [`steps`]: steps of a run that all processes share
//! - [`process`]: a folder for each process: tool, linkage, target, passes, and what only it measures
//! - [`pair`]: two gears rolling on each other
//! - [`run`]: the order of a whole run
//! - [`compare`]: results side by side

pub mod backend;
pub mod colormap;
pub mod compare;
pub mod findings;
pub mod gcode;
pub mod interrupt;
pub mod job;
pub mod machine;
pub mod material;
pub mod measure;
pub mod output;
pub mod pair;
pub mod process;
pub mod run;
pub mod scene;
pub mod steps;
pub mod surface;
pub mod texture;

pub use gearcut_core::{Error, Refusal, Result, cut, dexel, error, frame, gear, math, passes, terms, tool, units};
#[cfg(feature = "gpu")]
pub use gearcut_gpu as gpu;
