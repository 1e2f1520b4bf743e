//! What is left, in numbers: stock between operations, crossings with the pitch curve and unevenness, deviations, scallops, thickness.
//!
//! In: cut fields and the job. Out: plain values in mm and percent; `run` gives them names, units and definitions in the results.

pub mod blank_report;
pub mod chips;
pub mod crossing;
pub mod deviation;
pub mod engagement;
pub mod flank_report;
pub mod gear_place;
pub mod gear_report;
pub mod hob_load;
pub mod hobbed_blank;
pub mod hobbed_report;
pub mod marks;
pub mod offset_curves;
pub mod scallop;
pub mod stock;
pub mod stroke_faults;
pub mod topography;
pub mod unevenness;

pub use blank_report::BlankReport;
pub use flank_report::FlankReport;
pub use gear_report::GearReport;
