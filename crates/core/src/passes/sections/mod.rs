//! Sweeps where they cross transverse slices of the work: closed curves that rays of the blank are laid over.

pub mod section_band;
mod swept_pose;
pub mod swept_sections;
