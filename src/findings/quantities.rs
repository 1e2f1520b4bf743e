//! What processes share: the rows of numbers that more than one of them finds, by subject.
//!
//! A number has one row, and so one key, unit and definition, wherever it is: in the headline (the largest or smallest
//! of the gear), in the section of a flank or an operation (of that one), as a column of a table. What only one process
//! finds is listed in its own folder.

pub mod blank;
pub mod cutting;
pub mod flanks;
pub mod inspection;
pub mod program;
pub mod sizes;
pub mod surfaces;
pub mod teeth;
pub mod tool_wear;

use super::row::QuantityGroup;

/// The section with a part for each operation.
pub static OPERATIONS: QuantityGroup = QuantityGroup::of_parts("operations", "Operations");

/// The groups of this table.
pub static SHARED: &[&QuantityGroup] = &[
    &flanks::FLANKS,
    &flanks::STOCK,
    &teeth::TEETH,
    &inspection::QUALITY,
    &inspection::INSPECTION,
    &inspection::CHARTS,
    &inspection::FIGURES,
    &sizes::SIZES,
    &cutting::CUTTING,
    &cutting::AXES,
    &cutting::AXIS_TABLES,
    &tool_wear::TOOL_WEAR,
    &blank::BLANK,
    &blank::DAMAGE,
    &program::PROGRAM,
    &program::MACHINE_ERRORS,
    &program::TURN,
    &surfaces::OVERLAY,
    &surfaces::PARAMETERS,
    &surfaces::CURVES,
];
