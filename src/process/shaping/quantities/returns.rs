//! Quantities of return strokes, known before cutting.

use crate::findings::rows;

/// No clearance.
pub const NOWHERE_NEAR: &str = "the edge is outside the uncut blank on its way back";
/// No direction to offer.
pub const NO_OFFER: &str = "none is needed, none clears all of it, or the cutter is tilted already";
/// No cost.
pub const NO_COST: &str = "no direction is offered, or machine.limits does not say what the axes can do";

rows! {
    /// Return strokes of an operation.
    RETURN_STROKES: "return_strokes", "Return strokes", "operations.<operation>.return_strokes";

    DIRECTION: "direction", "", "which way the cutter is drawn back for the return stroke";
    RETRACTION_ANGLE: "retraction_angle", "deg",
        "largest angle between the line of centres and the normal of the pitch curve at the strokes";
    CLEARANCE: "smallest_clearance", "um",
        "smallest distance of the returning edge from the surfaces after the operation, negative inside"
        => or(&[NOWHERE_NEAR]);
    OVERLAP: "overlap", "mm^2",
        "area that the returning cutter has in common with the teeth where it lies deepest in them, in their \
         transverse section; elsewhere it may lie less deep and have more in common";
    DEPTH_IN_STOCK: "depth_in_stock", "mm",
        "largest depth of the returning edge in material, stock included; 0 where it is clear"
        => titled("rubs on stock");
    CLEARING_TILT: "clearing_tilt", "deg",
        "direction that clears all material, from the normal of the pitch curve" => or(&[NO_OFFER]);
    SMALLEST_CLEARING_TILT: "smallest_clearing_tilt", "deg",
        "smallest angle from the normal of the pitch curve that clears all material" => or(&[NO_OFFER]);
    LARGEST_CLEARING_TILT: "largest_clearing_tilt", "deg",
        "largest angle from the normal of the pitch curve that clears all material" => or(&[NO_OFFER]);
    CLEARING_SLOWDOWN: "clearing_slowdown", "1",
        "factor by which double strokes would have to last longer with the direction that clears" => or(&[NO_COST]);
    CLEARING_STROKES: "clearing_strokes_per_minute", "1/min",
        "double strokes that give the axes their time with the direction that clears" => or(&[NO_COST]);
}

rows! {
    /// Return strokes along the pitch curve.
    RETURN_PLACES: "places", "Return strokes over one period of the pitch curve",
        "columns of operations.<operation>.return_strokes.places";

    PHI: "phi", "deg", "polar angle of the pitch point";
    ANGLE_AT: "retraction_angle", "deg",
        "angle from the normal of the pitch curve to the line of centres, positive where the radius grows with phi";
    CUTTER: "cutter", "", "whether the cutter is turned on its way back";
    CLEARANCE_AT: "clearance", "um", "distance of the edge from the surfaces that stay, negative inside"
        => or(&[NOWHERE_NEAR]);
    DEPTH_AT: "depth_in_stock", "um", "depth of the edge in material, stock included";
}
