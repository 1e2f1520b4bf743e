//! Keys of the operations: speeds, roll, idle time.

use crate::scene::keys::{Addition, Key, Range};

/// Keys of `[[operation]]`.
pub(super) static ADDED: Addition = Addition {
    path: "operation[]",
    keys: &[
        Key::number(
            "head_speed_per_minute",
            "1/min",
            Range::closed(0.1, 5000.0),
            150.0,
            "150.0",
            "Speed of the head against the cradle.",
        ),
        Key::number(
            "roll_speed_deg_per_s",
            "deg/s",
            Range::closed(0.001, 90.0),
            2.0,
            "2.0",
            "Speed of the cradle while it rolls; with the head's speed it spaces the marks of the blades.",
        ),
        Key::optional(
            "roll_from_deg",
            "deg",
            Range::closed(-360.0, 360.0),
            "what the flanks need and 3 deg more",
            "40.0",
            "Cradle angle at which the roll of a slot begins.",
        ),
        Key::optional(
            "roll_to_deg",
            "deg",
            Range::closed(-360.0, 360.0),
            "what the flanks need and 3 deg more",
            "75.0",
            "Cradle angle at which the roll of a slot ends.",
        ),
        Key::number(
            "idle_s",
            "s",
            Range::closed(0.001, 3600.0),
            4.0,
            "4.0",
            "Time between two slots: the head withdraws, the cradle rolls back, the work is indexed.",
        ),
    ],
    groups: &[],
};
