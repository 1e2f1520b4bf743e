//! What scenes of shaping may say that others may not.

use super::SceneProcess;
use crate::scene::build;

/// Shaping with a pinion cutter.
pub(super) static SHAPING: SceneProcess = SceneProcess {
    name: "shaping",
    tool: "shaper_cutter",
    tool_words: "a shaper cutter",
    needed: "the module and the numbers of teeth",
    default_linkage: "shaping_normal",
    own: &[
        "tool.shaper_cutter",
        "machine.double_strokes_per_minute",
        "machine.approach_mm",
        "machine.overrun_mm",
        "machine.back_off_mm",
        "machine.work_eccentricity_um",
        "machine.work_eccentricity_angle_deg",
        "machine.limits",
        "operation[].strokes_per_revolution",
        "operation[].circular_feed_mm_per_stroke",
        "operation[].stroke_spacing",
        "operation[].window_deg",
        "operation[].revolutions",
        "operation[].overlap_deg",
        "operation[].feed_during_stroke",
        "operation[].infeed",
        "operation[].linkage.shaping_traditional",
        "operation[].linkage.shaping_normal",
        "material",
        "fields.chips",
        "measure",
    ],
    build: build::shaping,
};
