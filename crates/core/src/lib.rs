//! The ground that gearcut stands on: from pitch curves and cutting edges to dexels that passes are subtracted from.
//!
//! In: a pitch curve, a tool with its blades, poses of the tool over time. Out: what is left on every dexel, and the
//! pass that left it. Nothing here knows files, scenes or a process of manufacture.
//!
//! The modules, from the ground up; each uses only those above it in this list:
//!
//! - [`terms`]: words of gear geometry: side of a tooth, hand of a helix
//! - [`units`]: factors between units
//! - [`frame`]: rigid motions in the plane and in space
//! - [`error`]: errors as values, with a way out
//! - [`math`]: Taylor series, roots, extrema, integrals, splines, rays against closed curves
//! - [`gear`]: the pitch curve, and the blank before cutting
//! - [`tool`]: cutting edges, and where the blades of a tool are
//! - [`dexel`]: rays with the material that is left on them
//! - [`passes`]: one blade's trip through the work, and which passes can matter to which dexels
//! - [`cut`]: backends, and the native one

pub mod cut;
pub mod dexel;
pub mod error;
pub mod frame;
pub mod gear;
pub mod math;
pub mod passes;
pub mod terms;
pub mod tool;
pub mod units;

pub use error::{Error, Refusal, Result};
