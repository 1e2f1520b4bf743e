//! Quantities of the axes while they shape: tables, clearance of the return stroke, retraction by the axes.

use crate::findings::rows;

/// No cost without limits.
pub const NO_LIMITS: &str = "machine.limits says nothing of the axes' speeds and accelerations";
/// No cost without time.
pub const NO_TIME: &str =
    "the ram does not leave the face at both ends: machine.approach_mm or machine.overrun_mm is zero";

rows! {
    /// What the tables of the axes add.
    AXIS_COLUMNS: "axis_columns", "Tables of a shaper's axes",
        "columns of axes/<operation>.csv; under a program scene_ is before what the scene's own strokes have, and \
         return_ before positions of the axes on the way back";

    OFFSET_AT: "offset", "mm",
        "offset of the cutter at the stroke from the depth without profile shift and thickness allowance"
        => symbol("δ_d");
    PHI: "phi", "deg", "polar angle of the pitch point at the stroke" => symbol("φ");
    LEFT_RELIEF: "left_relief_share_of_circular", "1",
        "clearance of left flanks when the cutter backs off, over that of a circular gear";
    RIGHT_RELIEF: "right_relief_share_of_circular", "1",
        "clearance of right flanks when the cutter backs off, over that of a circular gear";
    NORMAL_TO_CENTRES: "normal_to_line_of_centres", "deg",
        "angle from the normal of the pitch curve to the line of centres" => symbol("β");
    RETRACTION_LAW: "retraction", "", "which way the cutter is drawn back after the stroke, in the words of the key";
    SCENE_POSITION: "scene", "that of the axis", "position of the axis in the scene's own stroke"
        => or(&["the scene has no such stroke"]);
    RETURN_POSITION: "return", "that of the axis", "position of the axis on the way back after the stroke";
}

rows! {
    /// Clearance of the return stroke to first order.
    RELIEF: "relief", "Clearance on the return stroke", "operations.<operation>.relief";

    SMALLEST_RATIO: "smallest_ratio", "1",
        "smallest relief clearance of a flank divided by that of a circular gear, back-off times sin(alpha)";
    SMALLEST_CLEARANCE: "smallest_clearance", "um",
        "smallest clearance of a flank on the return stroke along its normal, to first order in the back-off; the \
         survey of return strokes has the distance of the edges themselves";
    LARGEST_BETA: "largest_beta", "deg",
        "largest angle between the line of centres and the normal of the pitch curve in a turn" => symbol("β");
}

rows! {
    /// Retraction by the axes.
    RETRACTION: "retraction", "Retraction by the axes",
        "operations.<operation>.retraction, its direction as in return_strokes; travel, speed and acceleration after \
         the name of the axis";

    BACK_OFF: "back_off", "mm", "how far the cutter's axis is drawn back";
    TURNED_STROKES: "turned_strokes", "strokes", "strokes after which the cutter is turned as well";
    TILT: "tilt", "deg",
        "angle from the normal of the pitch curve to the retraction, in the direction of growing phi";
    SMALLEST_TILT: "smallest_tilt", "deg", "smallest angle from the normal of the pitch curve that clears";
    LARGEST_TILT: "largest_tilt", "deg", "largest angle from the normal of the pitch curve that clears";
    TRAVEL: "travel", "that of the axis", "largest travel of the axis for the retraction, from rest to rest"
        => or(&[NO_TIME]);
    RETRACTION_SPEED: "speed", "that of the axis", "largest speed of the axis for the retraction, from rest to rest"
        => or(&[NO_TIME]);
    RETRACTION_ACCELERATION: "acceleration", "that of the axis",
        "largest acceleration of the axis for the retraction, from rest to rest"
        => or(&[NO_TIME]);
    TIME_OUTSIDE: "time_outside_face", "s", "time of the ram outside the face, shorter end";
    SLOWDOWN: "slowdown", "1", "factor by which double strokes have to last longer so that the axes keep their limits"
        => or(&[NO_LIMITS, NO_TIME]);
    STROKES_IN_TIME: "strokes_per_minute", "1/min", "double strokes that leave the axes their time for the retraction"
        => or(&[NO_LIMITS, NO_TIME]);
    ADDED_TIME: "added_time", "s", "time that slower double strokes add to the operation"
        => or(&[NO_LIMITS, NO_TIME]);
}
