//! Keys of the operations: speeds, roll or plunge, idle time.

use crate::scene::keys::{Addition, Default, Key, Kind, Range};

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
        Key {
            name: "roll_speed_deg_per_s",
            kind: Kind::Number(Range::closed(0.001, 90.0)),
            unit: "deg/s",
            default: Default::Derived("2 where the cradle rolls"),
            example: "2.0",
            teach: "Speed of the cradle while it rolls; with the head's speed it spaces the marks of the blades.",
        },
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
        Key {
            name: "infeed_mm_per_revolution",
            kind: Kind::Number(Range::closed(1e-4, 10.0)),
            unit: "mm per revolution",
            default: Default::Derived("0.02 outer modules for each blade where roll_ratio is 0"),
            example: "0.5",
            teach: "Plunge feed where nothing rolls: way of the sliding base for each turn of the head. The way begins \
                one and a half turns before the plane of the tips can meet the blank, and ends at full depth.",
        },
        Key {
            name: "dwell_revolutions",
            kind: Kind::Number(Range::closed(1.0, 1000.0)),
            unit: "",
            default: Default::Derived("1.5 where roll_ratio is 0"),
            example: "1.5",
            teach: "Revolutions of the head at full depth after a plunge: in one and a half every blade passes the \
                whole slot.",
        },
        Key::number(
            "idle_s",
            "s",
            Range::closed(0.001, 3600.0),
            4.0,
            "4.0",
            "Time between two slots: the head withdraws, a cradle that has rolled goes back, the work is indexed.",
        ),
    ],
    groups: &[],
};
