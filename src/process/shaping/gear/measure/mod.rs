//! What is measured on shaped gears.

pub mod below_finished;
pub mod closing;
pub mod cmm;
pub mod crossing;
pub mod cutter_wear;
pub mod flank_deflection;
pub mod flank_report;
pub mod gear_report;
mod thin_tips;
pub mod unevenness;

pub use flank_report::FlankReport;
pub use gear_report::GearReport;
