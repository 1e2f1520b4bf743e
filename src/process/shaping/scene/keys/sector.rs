//! Keys of a gear with teeth over a part of the turn.

use crate::scene::keys::{Addition, Default, Key, Kind, Range};

/// In `[gear]`.
pub(super) static ADDED: Addition = Addition {
    path: "gear",
    keys: &[
        Key {
            name: "sector_deg",
            kind: Kind::Pair(Range::closed(-360.0, 720.0)),
            unit: "deg",
            default: Default::LeftOut("teeth all round"),
            example: "[-60.0, 60.0]",
            teach: "Polar angles from which to which a sector has its teeth, the middles of the spaces before the \
                first and behind the last one, at most 340 deg apart. The law of the pitch curve holds between them \
                and need not close; its size is solved so that the teeth fill the sector.",
        },
        Key {
            name: "dwell_radius_mm",
            kind: Kind::Number(Range::above(0.0, 20000.0)),
            unit: "mm",
            default: Default::LeftOut("2.5 modules below the smallest pitch radius of the sector"),
            example: "24.0",
            teach: "Radius of the arc that the stock of a sector has over the rest of the turn, out of the cutter's \
                reach.",
        },
    ],
    groups: &[],
};
