//! What the stages of a run take, for the time left and for what `check` expects beside the cuts: seconds of processor
//! time, on the paper's gear and on rings, stage by stage.

use crate::steps::stages::Costs;

/// The stages, a tooth, flank, window or picture each.
pub const STAGE_COSTS: Costs = Costs {
    before: &[("chips", 0.035)],
    flank_s: 0.015,
    map_chips_s: 0.035,
    window_s: 0.05,
    picture_s: 1.2,
    root_s: 0.0,
    blank_s: 0.05,
    between_s: 0.013,
};
