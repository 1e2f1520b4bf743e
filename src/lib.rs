//! gearcut moves a machine's axes by its linkage model, sweeps every real cutting edge stroke by stroke
//! through dexels of the blank, and measures what is left.
//!
//! The modules follow the data's path, from the scene to the files; `run` alone knows the whole order.

pub mod axes_report;
pub mod compare;
pub mod cut;
pub mod dexel;
pub mod error;
pub mod frame;
pub mod gcode;
pub mod gear;
pub mod job;
pub mod linkage;
pub mod material;
pub mod measure;
pub mod output;
pub mod passes;
pub mod planar_rays;
pub mod ray_reach;
pub mod run;
pub mod scene;
pub mod surface;
pub mod texture;
pub mod tool;
pub mod units;

pub use error::{Error, Refusal, Result};
