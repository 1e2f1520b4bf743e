//! Quantities of calibrations: errors fitted to what was measured.

use crate::findings::rows;

/// A shift that nothing tells.
pub const UNIDENTIFIED: &str = "the measured values do not say it: its derivatives are nothing, or those of the others";
/// A shift at the end of its range.
pub const AT_END_OF_RANGE: &str = "the end of its key's range holds it";
/// No chance.
pub const AS_MANY: &str = "as many numbers are fitted as measured";

rows! {
    /// A calibration.
    CALIBRATION: "calibration", "Calibration", "calibration; headline (fit_1, fit_2, ...)";

    FITTED_SHIFT: "fit", "that of the error", "fitted: shift of the error beyond the scene" => or(&[UNIDENTIFIED]);
    CHI_SQUARE: "chi_square", "1", "fitted: sum of the squared residuals over the uncertainties" => symbol("χ²");
    FREEDOM: "freedom", "1", "measured values less fitted ones, and one for each line";
    CHANCE: "chance", "1", "fitted: chance of residuals as large from the uncertainties alone: chi-square"
        => symbol("p"), or(&[AS_MANY]);
}

rows! {
    /// Fitted parameters.
    FITS: "fits", "Fitted parameters", "columns of calibration.fits";

    SHIFT: "shift", "that of the row", "shift beyond the scene" => or(&[UNIDENTIFIED]);
    HALF_WIDTH: "half_width", "that of the row", "half the width of the shift's 95 % interval"
        => or(&[UNIDENTIFIED, AT_END_OF_RANGE]);
}

rows! {
    /// Measured numbers.
    MEASURED_NUMBERS: "numbers", "Measured numbers", "columns of calibration.numbers";

    QUANTITY: "quantity", "", "path in results.json, which says its unit";
    VALUE: "value", "that of the row", "measured: value";
    UNCERTAINTY: "uncertainty", "that of the row", "measured: standard uncertainty of the value";
    PREDICTED: "predicted", "that of the row", "predicted: value of the scene as it is";
    FITTED: "fitted", "that of the row", "fitted: value of the scene with the fitted parameters";
}

rows! {
    /// Measured lines.
    MEASURED_LINES: "lines", "Measured lines", "columns of calibration.lines";

    LINE: "line", "", "line of a chart";
    COUNT: "places", "1", "measured: places on the line";
    RMS: "measured", "um", "measured: root mean square about the mean of the line, or a turn";
    OFF_PREDICTED: "off_predicted", "um", "predicted: root mean square of the line less that of the scene as it is";
    OFF_FITTED: "off_fitted", "um",
        "fitted: root mean square of the line less that of the scene with the fitted parameters";
}

rows! {
    /// Places of measured lines.
    MEASURED_PLACES: "places", "Places of the measured lines", "columns of calibration.places";

    DEVIATION: "measured", "um", "measured: deviation from the mean of its line, or but for a turn";
    DEVIATION_PREDICTED: "predicted", "um", "predicted: that deviation by the scene as it is";
    DEVIATION_FITTED: "fitted", "um", "fitted: that deviation by the scene with the fitted parameters";
}
