//! What scenes of hobbing may say that others may not.

use super::SceneProcess;
use crate::scene::build;

/// Hobbing with five and six axes.
pub(super) static HOBBING: SceneProcess = SceneProcess {
    name: "hobbing",
    tool: "hob",
    tool_words: "a hob",
    needed: "the module, the number of teeth and the hob's size",
    default_linkage: "hobbing",
    own: &[
        "tool.hob",
        "machine.hobbing_limits",
        "operation[].hob_speed_per_minute",
        "operation[].axial_feed_mm_per_revolution",
        "operation[].feed_direction",
        "operation[].approach",
        "operation[].radial_feed_mm_per_revolution",
        "operation[].approach_mm",
        "operation[].overrun_mm",
        "operation[].head_angle_deg",
        "operation[].shift_start_mm",
        "operation[].ridge_tolerance_um",
        "operation[].linkage.hobbing",
        "operation[].linkage.hobbing_diagonal",
    ],
    build: build::hobbing::hobbing,
};
