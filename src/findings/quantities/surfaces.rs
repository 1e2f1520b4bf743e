//! Quantities of two surfaces of one place, the second laid over the first.

use crate::findings::rows;

/// No height of a curve.
pub const NO_HEIGHT: &str = "the curve has no height there";
/// A parameter that one of the surfaces does not have.
pub const NO_PARAMETER: &str = "the parameter does not exist on this surface";

rows! {
    /// A surface over another.
    OVERLAY: "measured", "Measured over cut", "texture.<operation>.<window>.measured";

    FIRST: "first", "", "surface that keeps its place";
    SECOND: "second", "", "surface that is laid over it";
    MIRROR: "mirror", "", "axes of the second that run the other way";
    SHIFT_X: "shift_x", "um", "place of the second's first point along x of the first";
    SHIFT_Y: "shift_y", "um", "place of the second's first point along y of the first";
    CORRELATION: "correlation", "1", "correlation of the heights of both on the points that they share, planes off";
    OVERLAP: "overlap", "%", "shared points, of the smaller surface's";
    DIFFERENCE_RMS: "difference_rms", "um", "root mean square of second less first, levelled";
    DIFFERENCE_LOWEST: "difference_lowest", "um", "lowest value of second less first, levelled";
    DIFFERENCE_HIGHEST: "difference_highest", "um", "highest value of second less first, levelled";
    CHAIN_OF_BOTH: "chain", "", "what both went through before their parameters";
}

rows! {
    /// Parameters of both.
    PARAMETERS: "parameters", "Parameters on shared points",
        "columns of texture.<operation>.<window>.measured.parameters";

    PARAMETER: "parameter", "", "symbol of ISO 25178-2";
    PARAMETER_UNIT: "unit", "", "unit of the parameter's values";
    OF_FIRST: "first", "that of the row", "parameter of the first surface" => or(&[NO_PARAMETER]);
    OF_SECOND: "second", "that of the row", "parameter of the second surface" => or(&[NO_PARAMETER]);
    OF_DIFFERENCE: "difference", "that of the row", "parameter of the second surface less that of the first"
        => or(&[NO_PARAMETER]);
    WHAT_IT_IS: "definition", "", "definition of the parameter";
}

rows! {
    /// Material ratio curves of both.
    CURVES: "curves", "Material ratio curves of both", "columns of texture.<operation>.<window>.measured.curves";

    RATIO: "ratio", "%", "areal material ratio";
    CURVE_OF_FIRST: "first", "um", "height of the first surface over its mean" => or(&[NO_HEIGHT]);
    CURVE_OF_SECOND: "second", "um", "height of the second surface over its mean" => or(&[NO_HEIGHT]);
}
