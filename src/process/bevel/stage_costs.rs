//! What the stages of a run take, for the time left and for what `check` expects beside the cuts: seconds of processor
//! time, on a pinion and on a hypoid gear, stage by stage.

use crate::steps::stages::Costs;

/// The stages, a tooth, flank, window or picture each.
pub const STAGE_COSTS: Costs = Costs {
    before: &[],
    flank_s: 0.2,
    map_chips_s: 0.0,
    window_s: 0.14,
    picture_s: 1.6,
    root_s: 0.0,
    blank_s: 0.25,
    between_s: 0.01,
};
