//! Quantities of layers of errors and of gears of many seeds.

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[&NUMBERS_OF_GEARS, &LAYERS, &GEARS, &TOLERANCES];

/// No number of a gear.
pub const NONE: &str = "no pass came to a place that it needs, or a single operation cuts the gear";

const ISO_25178: &str = "ISO 25178-2";

rows! {
    /// Numbers of a gear that only scatter looks at; those of profile and helix are those of a flank.
    NUMBERS_OF_GEARS: "numbers", "Numbers of gears that are compared",
        "headline (of all gears); columns of layers.cases, scatter.spread and scatter.seeds, beside those of a flank";

    SA: "Sa", "um", "arithmetical mean height of the window" => symbol("Sa"), source(ISO_25178), or(&[NONE]);
    SQ: "Sq", "um", "root mean square height of the window" => symbol("Sq"), source(ISO_25178), or(&[NONE]);
    SK: "Sk", "um", "core height of the window" => symbol("Sk"), source(ISO_25178), or(&[NONE]);
    SPK: "Spk", "um", "reduced peak height of the window" => symbol("Spk"), source(ISO_25178), or(&[NONE]);
    SVK: "Svk", "um", "reduced valley depth of the window" => symbol("Svk"), source(ISO_25178), or(&[NONE]);
    SIDE_SINGLE_PITCH: "f_p", "um", "largest single pitch deviation of the flank's side"
        => symbol("f_p"), or(&[NONE]);
    SIDE_TOTAL_PITCH: "F_p", "um", "total cumulative pitch deviation of the flank's side"
        => symbol("F_p"), or(&[NONE]);
    UNEVENNESS: "unevenness", "%",
        "largest difference of the first operation's stock left and right of a tooth, over the mean of both"
        => or(&[NONE]);
    FIRST_CAUSE: "first_cause_of_Sa", "",
        "layer of errors without which Sa would be smallest; of two and fewer, the one that makes most of it alone"
        => titled("first cause of Sa");
}

rows! {
    /// Layers of errors.
    LAYERS: "layers", "Layers of errors", "columns of layers.cases";

    KEPT: "layers", "", "which layers of errors are on";
}

rows! {
    /// Gears of many seeds.
    GEARS: "scatter", "Gears of many seeds", "scatter; columns of its tables";

    COUNT: "gears", "gears", "gears over which median and interval are taken, seeds from 1";
    SHARE: "share", "%", "share of the gears whose number is smaller (Hyndman and Fan, type 7)";
    SEED: "seed", "1", "seed of the gear; those beyond the number of gears are of an earlier run";
}

/// The gear with some layers on.
pub static CASES: QuantityGroup = QuantityGroup::of_parts("cases", "Layers of errors");
/// Median and interval of all gears.
pub static SPREAD: QuantityGroup = QuantityGroup::of_parts("spread", "Median and interval of the gears");

rows! {
    /// What differs from gear to gear.
    TOLERANCES: "tolerances", "What differs from gear to gear", "columns of scatter.tolerances and .drawn";

    KEY: "key", "", "key of the scene; its name says the unit";
    LOW: "low", "that of the row", "smallest value, in the key's unit";
    HIGH: "high", "that of the row", "largest value, in the key's unit";
    VALUE: "value", "that of the row",
        "value in this gear, in the key's unit: as likely as any other within the limits";
}
