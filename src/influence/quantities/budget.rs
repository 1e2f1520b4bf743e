//! Quantities of budgets: what each error alone makes of an ideal gear.

use crate::findings::rows;

/// No figure of few flanks.
pub const NEEDS_ALL: &str = "pitch and thickness need all flanks";
/// No share of nothing.
pub const NO_INFLUENCE: &str = "it has no influence";
/// One direction.
pub const UPWARDS: &str = "it is shifted upwards only";
/// No place of a map.
pub const NO_PASS_CAME: &str = "no pass came there";
/// A number that is not there.
pub const VANISHES: &str = "the number vanishes there";
/// A scene that is not there.
pub const NO_WORD: &str = "the scene has no value below";

rows! {
    /// A budget.
    BUDGET: "budget", "Error budget", "budget; headline (rank_1 to rank_4)";

    SHIFTED: "parameters", "parameters", "parameters that were shifted";
    WHOLE_FLANKS: "whole_flanks", "flanks",
        "flanks that are cut on many places; without a wish of all flanks the pitch curve as well";
    LARGEST_OF_STEP: "rank", "um", "predicted: largest normal deviation that a natural step of the error makes";
}

rows! {
    /// Influence of every parameter.
    INFLUENCES: "influences", "Influence of every parameter",
        "columns of budget.influences, those for a unit of the error under their key and um_per_unit";

    STEP: "step", "that of the row", "natural step of the parameter; it is shifted by as much to both sides";
    PER_STEP: "per_step", "um", "predicted: largest normal deviation for the natural step";
    LARGEST: "largest", "that of the row",
        "predicted: largest normal deviation anywhere on the flanks, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    PROFILE: "F_alpha", "that of the row", "predicted: largest profile deviation F_alpha, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    PROFILE_SLOPE: "f_H_alpha", "that of the row",
        "predicted: profile slope deviation f_H_alpha of the largest size, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    HELIX: "F_beta", "that of the row",
        "predicted: largest helix deviation F_beta, um for a unit of the error" => or(&[NEEDS_ALL]);
    HELIX_SLOPE: "f_H_beta", "that of the row",
        "predicted: helix slope deviation f_H_beta of the largest size, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    SINGLE_PITCH: "f_p", "that of the row",
        "predicted: single pitch deviation f_p of the largest size, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    TOTAL_PITCH: "F_p", "that of the row", "predicted: total cumulative pitch deviation F_p, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    THICKNESS: "thickness", "that of the row",
        "predicted: what the mean tooth becomes thicker along the circle, um for a unit of the error"
        => or(&[NEEDS_ALL]);
    HALF_STEP: "half_step", "%", "largest difference from what half the step gives, of the largest influence"
        => or(&[NO_INFLUENCE]);
    BEND: "bend", "%", "largest difference of both directions from their mean, of the largest influence"
        => or(&[NO_INFLUENCE, UPWARDS]);
    COURSE: "course", "", "linear; bent; upwards only: the scene has no value below";
}

rows! {
    /// Maps of influence.
    INFLUENCE_MAPS: "maps", "Influence maps",
        "columns of budget.maps, of each parameter under its key with _ for . and @";

    U: "u", "mm", "arc along the profile from the form point to the place";
    V: "v", "mm", "distance of the place along the tooth from the middle of the face";
    PER_UNIT: "per_unit", "um per unit", "predicted: normal deviation for a unit of the error" => or(&[NO_PASS_CAME]);
}

rows! {
    /// Influence on reported numbers.
    INFLUENCE_ON_NUMBERS: "numbers", "Influence on every reported number", "columns of budget.numbers";

    QUANTITY: "quantity", "", "path of the number in results.json; headline.KEY for those of its headline";
    UNIT_OF_NUMBER: "unit", "", "unit of the number; derivatives are for one unit of the error";
    VALUE: "value", "that of the row", "predicted: number of the scene as it is";
    DERIVATIVE: "derivative", "that of the row",
        "predicted: what the number gains for a unit of the error, both directions"
        => or(&[VANISHES, NO_WORD]);
    UPWARDS_OF: "upwards", "that of the row",
        "predicted: what the number gains for a unit of the error, upwards from the scene"
        => or(&[VANISHES]);
    DOWNWARDS_OF: "downwards", "that of the row",
        "predicted: what the number gains for a unit of the error, from below to the scene"
        => or(&[VANISHES, NO_WORD]);
}
