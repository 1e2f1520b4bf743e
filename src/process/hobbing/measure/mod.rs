//! What is measured on hobbed gears.

pub mod blank_report;
pub mod engagement;
pub mod flank_report;
pub mod hob_force;
pub mod hob_load;
pub mod hob_wear;
pub mod hoffmeister;
pub mod marks;
pub mod offset_curves;
