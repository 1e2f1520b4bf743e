//! What is left, in numbers: stock between operations, crossings with the pitch curve and unevenness, deviations,
//! scallops, thickness.
//!
//! In: cut fields and the job. Out: plain values in mm and percent; the findings of each process give them names,
//! units and definitions.

pub mod chip_places;
pub mod crossing;
pub mod cut_grid;
pub mod damage;
pub mod deviation;
pub mod flank_tolerance;
pub mod gear_place;
pub mod inspection;
pub mod last_chips;
pub mod round_gear;
pub mod scallop;
pub mod stock;
pub mod target_outline;
pub mod thickness;
pub mod tool_wear;
pub mod verdict;

/// Surface texture, from the crate of its own.
pub use gearcut_texture as topography;
pub use last_chips::LastChips;
