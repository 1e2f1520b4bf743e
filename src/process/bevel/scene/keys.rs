//! Keys that scenes of bevel gears add to the shared ones.

mod gear;
mod inspection;
mod machine;
mod operation;
mod tool;

use crate::scene::keys::{Addition, KeySection};

pub(super) use machine::AXES;

/// Sections of its own.
pub(super) static SECTIONS: &[&[KeySection]] =
    &[gear::SECTIONS, tool::SECTIONS, machine::SECTIONS, inspection::SECTIONS];

/// Keys in shared sections.
pub(super) static ADDED: &[&Addition] = &[&operation::ADDED];
