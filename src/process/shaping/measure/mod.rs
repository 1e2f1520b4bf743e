//! What is measured on shaped gears.

pub mod blank_report;
pub mod crossing;
pub mod flank_report;
pub mod gear_report;
pub mod stroke_faults;
pub mod unevenness;

pub use blank_report::BlankReport;
pub use flank_report::FlankReport;
pub use gear_report::GearReport;
