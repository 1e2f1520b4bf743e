//! Quantities of the cutter in a ring, known before cutting.

use crate::findings::rows;

/// No radius, and no largest cutter.
pub const NOT_CURVED: &str = "the pitch curve is not curved towards the axis there";
/// No condition of undercut.
pub const STRAIGHT: &str = "the pitch curve is straight there";
/// No depth of the tips.
pub const NO_RELIEF: &str = "the cutter's base does not shape the tip, or does not reach it";
/// Nothing is known of the corners.
pub const NO_OUTLINE: &str = "the target's outline is not known";
/// No largest cutter.
pub const NO_CUTTER: &str = "tips or rolling allow no such cutter, or tips lie inside the base circle";
/// No flank ends early.
pub const REACHED: &str = "the involute reaches the tip on all flanks";

rows! {
    /// What the cutter can do in the ring, each with its advice.
    RING: "ring", "What the cutter can do in the ring", "ring";

    ROLLING_TEETH: "rolling_teeth", "teeth", "most cutter teeth whose pitch circle rolls everywhere"
        => titled("largest cutter that rolls");
    CLEARING_TEETH: "clearing_teeth", "teeth",
        "most cutter teeth whose tip corners come clear of the tips beside their space"
        => titled("largest cutter that clears"), or(&[NO_CUTTER]);
    RADIAL_TEETH: "radial_teeth", "teeth",
        "most cutter teeth that go in along the line of centres without trimming the tips"
        => titled("largest for radial infeed"), or(&[NO_CUTTER]);
    SMALLEST_RADIUS: "smallest_radius_of_curvature", "mm", "smallest radius of curvature of the pitch curve";
    UNDERCUT: "undercut_flanks", "flanks", "flanks whose beginning the cutter's tip cuts away" => titled("undercut");
    HIGHEST_START: "highest_start", "mm",
        "height over the pitch curve of the highest start of a generated flank, negative towards the root";
    PRINTED_LEFT: "printed_undercut_left", "mm^2",
        "left side of the printed condition of undercut, that of an external gear of the smallest radius of curvature";
    PRINTED_RIGHT: "printed_undercut_right", "mm^2", "right side of that condition";
    INVOLUTE_HEIGHT: "involute_height", "mm",
        "lowest end of a flank that the cutter's involute generates, height over the pitch curve"
        => titled("involute of the cutter"), or(&[REACHED]);
    TIP_RELIEF: "tip_relief", "um",
        "largest depth of a tip behind the conjugate flank, which the cutter's base has shaped"
        => titled("tips set back"), or(&[NO_RELIEF]);
    CORNER_CLEARANCE: "tip_corner_clearance", "mm",
        "smallest distance of a tip corner of the cutter from the teeth beside its space, on its way in or out; minus \
         the depth where it cuts into them"
        => titled("tip corners"), or(&[NO_OUTLINE]);
    TRIMMING: "trimming", "um",
        "largest depth of a tip corner of the cutter in the ring's teeth during the strokes of an infeed"
        => titled("trimmed on the way in"), or(&[NO_OUTLINE]);
    MODULE_LIMIT: "module_limit", "mm",
        "module at which the pitch circle of a cutter of so many teeth no longer rolls on this pitch curve"
        => titled("limit of the module");
    PRINTED_MODULE_LIMIT: "printed_module_limit", "mm",
        "module up to which the printed condition of undercut holds";
}

rows! {
    /// The same tooth by tooth.
    RING_TEETH: "teeth", "What the cutter can do, tooth by tooth over one period of the pitch curve",
        "columns of ring.teeth";

    PHI: "phi", "deg", "polar angle of the middle of the tooth on the pitch curve";
    RADIUS: "radius_of_curvature", "mm", "radius of curvature of the pitch curve" => or(&[NOT_CURVED]);
    ROLLING_TEETH_AT: "rolling_teeth", "1", "most cutter teeth whose pitch circle rolls there" => or(&[NOT_CURVED]);
    ROLLING_SHARE: "rolling_share", "%",
        "pitch radius of the cutter over the radius of curvature, and module over its limit" => or(&[NOT_CURVED]);
    START_LEFT: "start_left", "mm", "height over the pitch curve at which the generated left flank begins";
    START_RIGHT: "start_right", "mm", "height over the pitch curve at which the generated right flank begins";
    PRINTED_UNDERCUT: "printed_undercut", "%",
        "left side of the printed condition of undercut over its right side: it holds to 100" => or(&[STRAIGHT]);
    INVOLUTE_LEFT: "involute_left", "mm", "height over the pitch curve at which the generated left flank ends";
    INVOLUTE_RIGHT: "involute_right", "mm", "height over the pitch curve at which the generated right flank ends";
    TIP_RELIEF_LEFT: "tip_relief_left", "um", "depth of the left tip behind the conjugate flank" => or(&[NO_RELIEF]);
    TIP_RELIEF_RIGHT: "tip_relief_right", "um", "depth of the right tip behind the conjugate flank"
        => or(&[NO_RELIEF]);
    CORNERS_IN: "corners_in", "mm",
        "smallest distance of the tip corners from the teeth on their way into the space after the tooth"
        => or(&[NO_OUTLINE]);
    CORNERS_OUT: "corners_out", "mm",
        "smallest distance of the tip corners from the teeth on their way out of the space after the tooth"
        => or(&[NO_OUTLINE]);
    ROLLING_MODULE: "rolling_module", "mm", "module at which the cutter no longer rolls there" => or(&[NOT_CURVED]);
    PRINTED_MODULE: "printed_module", "mm", "module up to which the printed condition of undercut holds there"
        => or(&[STRAIGHT]);
}
