//! Keys that scenes of hobbing add to the shared ones.

mod machine;
mod operation;
mod tool;

use crate::scene::keys::{Addition, HELIX, KeySection};

pub(super) use machine::AXES;
pub(in crate::process::hobbing) use tool::PROFILE;
pub(super) use tool::WEAR;

/// Sections of its own.
pub(super) static SECTIONS: &[&[KeySection]] = &[tool::SECTIONS, machine::SECTIONS, operation::SECTIONS];

/// Keys in shared sections.
pub(super) static ADDED: &[&Addition] = &[&HELIX, &operation::ADDED];
