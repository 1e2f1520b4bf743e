//! Keys that scenes of shaping add to the shared ones.

mod machine;
mod material;
mod measure;
mod operation;
mod output;
mod tool;

use crate::scene::keys::{Addition, KeySection};

pub(super) use measure::LARGEST_CHIP_SPACING_MM;

/// Sections of its own.
pub(super) static SECTIONS: &[&[KeySection]] =
    &[material::SECTIONS, tool::SECTIONS, machine::SECTIONS, operation::SECTIONS, measure::SECTIONS];

/// Keys in shared sections.
pub(super) static ADDED: &[&Addition] = &[&machine::ADDED, &operation::ADDED, &output::ADDED];
