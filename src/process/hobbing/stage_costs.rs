//! What the stages of a run take, for the time left and for what `check` expects beside the cuts: seconds of processor
//! time, on a round gear and on one of third order, stage by stage.

use crate::steps::stages::Costs;

/// The stages, a tooth, flank, window or picture each.
pub const STAGE_COSTS: Costs = Costs {
    before: &[("marks", 0.01)],
    flank_s: 0.35,
    map_chips_s: 0.0,
    window_s: 0.3,
    picture_s: 1.8,
    root_s: 0.29,
    blank_s: 0.45,
    between_s: 0.05,
};
