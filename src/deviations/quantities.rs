//! Quantities of measured points on a target.

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[&DEVIATIONS, &FLANK_DEVIATIONS, &POINT_DEVIATIONS];

rows! {
    /// Measured points as a whole.
    DEVIATIONS: "deviations", "Measured points on the target", "deviations; headline";

    POINTS: "points", "points", "measured points of the file";
    ON_FLANKS: "on_flanks", "points",
        "points that lie on a flank from its form point to its tip, on the normal and within half a module of the \
         target; the rest are roots, tips and bodies" => titled("points on flanks");
    FITTED_POINTS: "fitted_points", "points",
        "points by which the gear was aligned: those on the evaluated parts of profiles and face";
    RMS: "rms", "um", "root mean square of the normal deviations of all points on flanks";
    MEAN: "mean", "um", "mean of these deviations, positive where material is left: teeth that are too thick";
    HIGHEST: "highest", "um", "largest of these deviations, outside of the target";
    DEEPEST: "deepest", "um", "smallest of these deviations, inside of the target where negative";
    ALIGNED_TURN: "turn", "deg", "fitted: turn of the points about the gear's axis, counter-clockwise, onto the target";
    SHIFT_X: "shift_x", "um", "fitted: shift of the points along x, after the turn";
    SHIFT_Y: "shift_y", "um", "fitted: shift of the points along y, after the turn";
    SHIFT_Z: "shift_z", "um", "fitted: shift of the points along the axis, after the turn";
    TILT_X: "tilt_x", "arcsec", "fitted: tilt of the points about x";
    TILT_Y: "tilt_y", "arcsec", "fitted: tilt of the points about y";
}

rows! {
    /// A flank.
    FLANK_DEVIATIONS: "flanks", "Deviations by flank", "columns of deviations.flanks";

    POINTS_OF: "points", "points", "points on the flank";
    MEAN_OF: "mean", "um", "mean normal deviation of the flank: its place on the circumference, beside its form";
    RMS_OF: "rms", "um", "root mean square of its deviations from that mean";
    DEEPEST_OF: "deepest", "um", "smallest normal deviation";
    HIGHEST_OF: "highest", "um", "largest normal deviation";
}

rows! {
    /// A point.
    POINT_DEVIATIONS: "places", "Deviation of every point", "columns of tables/deviations.csv";

    DEVIATION: "deviation", "um", "normal deviation of the point from the target, positive outside of the material";
    X: "x", "mm", "place of the point in the gear's frame, the axis being z";
    Y: "y", "mm", "place of the point in the gear's frame";
    Z: "z", "mm", "place of the point along the axis from the middle of the face";
}
