//! Quantities of a splined shaft in its hub.

use crate::findings::rows;

/// Source of the effective sizes.
pub const ISO_4156: &str = "ISO 4156-1";

rows! {
    /// A shaft in its hub.
    FIT: "fit", "Splined shaft in its hub", "fit";

    SHAFT: "shaft", "", "scene of the part with teeth outside";
    HUB: "hub", "", "scene of the part with teeth inside";
    TEETH: "teeth", "teeth", "teeth of either part" => symbol("z");
    MODULE: "module", "mm", "module" => symbol("m");
    PRESSURE_ANGLE: "pressure_angle", "deg", "pressure angle" => symbol("α");
    PITCH_DIAMETER: "pitch_diameter", "mm", "m z, on which widths are measured" => symbol("D"), shown();
    CLEARANCE: "clearance", "um",
        "what the hub can turn on the shaft along the pitch circle in this position; below 0 the shaft does not go in";
    SMALLEST_CLEARANCE: "smallest_clearance", "um", "smallest clearance over all positions of the hub"
        => titled("in the worst position"), shown();
    LARGEST_CLEARANCE: "largest_clearance", "um", "largest clearance over all positions of the hub"
        => titled("in the best position"), shown();
    EFFECTIVE_CLEARANCE: "effective_clearance", "um",
        "E_v - S_v, what the clearance is in the worst position at least" => symbol("c_v"), source(ISO_4156);
    EFFECTIVE_THICKNESS: "effective_tooth_thickness", "mm",
        "width of the spaces of the perfect hub that the shaft just fits" => symbol("S_v"), source(ISO_4156);
    EFFECTIVE_WIDTH: "effective_space_width", "mm",
        "thickness of the teeth of the perfect shaft that just fits the hub" => symbol("E_v"), source(ISO_4156);
    MEAN_THICKNESS: "tooth_thickness", "mm", "mean thickness of all teeth of the shaft"
        => titled("mean tooth thickness S"), symbol("S"), shown();
    MEAN_WIDTH: "space_width", "mm", "mean width of all spaces of the hub"
        => titled("mean space width E"), symbol("E"), shown();
    TIGHTEST: "smallest_clearance_of_a_tooth", "um", "smallest E - S of a tooth in its space in this position";
    SHAFT_VARIATION: "shaft_variation", "um", "S_v less mean S: pitch, form and waves of the shaft"
        => titled("effective variation of the shaft"), shown();
    HUB_VARIATION: "hub_variation", "um", "mean E less E_v: pitch, form and waves of the hub"
        => titled("effective variation of the hub"), shown();
    ROOT_CLEARANCE_OF_HUB: "root_clearance_of_hub", "mm", "radial clearance of the shaft's tips over the hub's roots"
        => titled("shaft's tips to hub's roots"), shown();
    ROOT_CLEARANCE_OF_SHAFT: "root_clearance_of_shaft", "mm",
        "radial clearance of the hub's tips over the shaft's roots"
        => titled("hub's tips to shaft's roots"), shown();
    FORM_CLEARANCE_OF_HUB: "form_clearance_of_hub", "mm",
        "radial clearance of the shaft's tips over the hub's form circle; below 0 a tip is as high as a fillet"
        => titled("shaft's tips to hub's form circle"), shown();
    FORM_CLEARANCE_OF_SHAFT: "form_clearance_of_shaft", "mm",
        "radial clearance of the hub's tips over the shaft's form circle; below 0 a tip is as low as a fillet"
        => titled("hub's tips to shaft's form circle"), shown();
}

rows! {
    /// Every tooth in its space.
    TOOTH_BY_TOOTH: "tooth_by_tooth", "Every tooth in its space", "columns of fit.tooth_by_tooth";

    TOOTH_OF_SHAFT: "tooth", "1", "tooth of the shaft";
    SPACE: "space", "1", "space of the hub: behind the tooth of this number";
    THICKNESS: "tooth_thickness", "mm", "thickness of the tooth on the pitch circle" => symbol("S");
    WIDTH: "space_width", "mm", "width of the space on the pitch circle" => symbol("E");
    TOOTH_CLEARANCE: "clearance", "um", "E - S of the tooth in its space";
    GAP_OF_RIGHT: "gap_right", "um", "gap of the right flank with the hub midway between its stops";
    GAP_OF_LEFT: "gap_left", "um", "gap of the left flank with the hub midway between its stops";
}
