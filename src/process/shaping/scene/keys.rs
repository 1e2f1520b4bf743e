//! Keys that scenes of shaping add to the shared ones.

mod chips;
mod cmm;
mod machine;
mod operation;
mod output;
mod sector;
mod tool;

use crate::scene::keys::{Addition, HELIX, KeySection};

pub(super) use chips::LARGEST_CHIP_SPACING_MM;
pub(super) use cmm::CMM;
pub(super) use machine::{AXES, VIBRATION_KEYS, VIBRATION_PATH};
pub(in crate::process::shaping) use tool::PROFILE;
pub(super) use tool::{BUILT_UP_EDGE, BUILT_UP_EDGE_KEYS, EDGE_ROUGHNESS, EDGE_ROUNDING, GRINDING, WEAR};

/// Sections of its own.
pub(super) static SECTIONS: &[&[KeySection]] =
    &[tool::SECTIONS, machine::SECTIONS, operation::SECTIONS, chips::SECTIONS, cmm::SECTIONS];

/// Keys in shared sections.
pub(super) static ADDED: &[&Addition] =
    &[&chips::ADDED, &machine::ADDED, &operation::ADDED, &output::ADDED, &sector::ADDED, &HELIX];
