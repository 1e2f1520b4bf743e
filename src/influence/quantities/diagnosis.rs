//! Quantities of diagnoses: errors of the machine that explain measured flanks, and the unexplained rest.

use crate::findings::rows;

/// No interval.
pub const NO_INTERVAL: &str = "no interval holds while deviations are left that neither noise nor an error \
    explains, or before the fit has settled";
/// No size.
pub const NO_SIZE: &str = "other errors explain all of it";
/// No turn.
pub const NO_TURN: &str = "no measured place shows a turn";
/// No share.
pub const NOTHING_DEVIATES: &str = "nothing deviates";

rows! {
    /// A diagnosis.
    DIAGNOSIS: "diagnosis", "Diagnosis", "diagnosis; headline";

    NAMED: "sources", "sources", "fitted: errors that explain more than noise would" => titled("sources named");
    EXPLAINED: "explained", "%",
        "fitted: share of the squared deviations, beside those of the scene and a turn, that the named sources take \
         away"
        => or(&[NOTHING_DEVIATES]);
    RESIDUAL: "residual", "um", "fitted: root mean square of the residuals" => titled("left over");
    UNEXPLAINED: "unexplained", "um",
        "fitted: root mean square of what is left beyond the noise of values and axes; 0 where noise makes as much in \
         more than 1 of 1000 gears";
    POINTS: "points", "places", "measured places";
    NOISE: "noise", "um", "stated standard deviation of every measured value on its own";
    AXES_NOISE: "axes_noise", "um",
        "standard deviation of what the scene's noise of its axes does at the measured places, root mean square";
    TURN: "turn", "arcsec", "fitted: turn of the gear on the measuring machine, counter-clockwise" => or(&[NO_TURN]);
    TURN_LOW: "turn_low", "arcsec", "fitted: lower end of the turn's 95 % interval" => or(&[NO_TURN, NO_INTERVAL]);
    TURN_HIGH: "turn_high", "arcsec", "fitted: upper end of the turn's 95 % interval" => or(&[NO_TURN, NO_INTERVAL]);
    FREEDOM: "freedom", "1", "measured values less fitted numbers";
    CHANCE: "chance", "1",
        "chance of as much by noise alone: chi-square of the residuals over that of values and axes" => symbol("p");
    ROUNDS: "rounds", "1", "fitted: how often the gear was cut with the sizes found so far, until they moved no more";
    BENT: "bent", "places",
        "measured places that the first fit went without, where the heights bend by more than the noise within a \
         natural step of an error; all others have them";
}

rows! {
    /// What is named.
    SOURCES: "sources", "Errors that explain the measured flanks", "columns of diagnosis.sources";

    SIZE: "size", "that of the row", "size of the error beyond that of the scene" => or(&[NO_SIZE]);
    LOW: "low", "that of the row",
        "lower end of the 95 % interval of the size, over all sets of sources that explain the deviations about as well"
        => or(&[NO_SIZE, NO_INTERVAL]);
    HIGH: "high", "that of the row", "upper end of that interval" => or(&[NO_SIZE, NO_INTERVAL]);
    HALF_IF_RIGHT: "half_if_right", "that of the row",
        "half the width of the 95 % interval if exactly the named sources are there" => or(&[NO_SIZE, NO_INTERVAL]);
    SURE: "sure", "%",
        "weight of the sets of sources with this one, of all that explain the deviations about as well"
        => or(&[NO_INTERVAL]);
    ALONE: "alone", "%",
        "share of the squared deviations that no other named source explains, all components of the source together";
    SAME_AS: "same_as", "", "sources that would explain as much in its place";
}

rows! {
    /// What differs from the rest.
    STANDING_OUT: "standing_out", "What differs from the rest of the gear", "columns of diagnosis.standing_out";

    SHAPE: "shape", "", "what differs: a tooth, bent profiles, a step along the face";
    KIND_OF_SHAPE: "kind", "", "fitted: beside the errors of the machine";
    ON_LEFT: "left", "um", "size on left flanks: normal deviation, crown or rise" => or(&[NO_SIZE]);
    ON_RIGHT: "right", "um", "size on right flanks: normal deviation, crown or rise" => or(&[NO_SIZE]);
}

rows! {
    /// Every measured place.
    RESIDUALS: "residuals", "What is left over", "columns of diagnosis.residuals";

    MEASURED: "measured", "um", "measured normal deviation";
    OF_SCENE: "predicted", "um", "predicted: normal deviation of the scene's own gear";
    LEFT: "residual", "um", "fitted: measured less that of the gear with the fitted errors, turned";
}
