//! Quantities of single strokes: chips, forces, deflections.

use crate::findings::rows;

/// No chip of a stroke.
pub const IDLE_STROKE: &str = "the stroke is idle";

rows! {
    /// Chips of every stroke.
    STROKE_CHIPS: "strokes", "Chips of every stroke", "columns of operations.<operation>.chips.strokes";

    TIME: "time", "s", "time from the operation's first stroke";
    WORK_ANGLE: "work_angle", "deg", "angle of the work" => symbol("ψ_c");
    CUTTING_TEETH: "chips", "chips", "cutter teeth that cut in the stroke";
    SPACE: "space", "1", "space of the largest chip; space j lies after tooth j" => or(&[IDLE_STROKE]);
    SECTION: "section", "mm^2", "section of all chips of the stroke, in the transverse plane" => symbol("A");
    VOLUME: "volume", "mm^3", "section of all chips of the stroke times the face width" => symbol("V");
    LARGEST_CHIP: "largest_chip_section", "mm^2", "section of the largest chip of the stroke";
    CONTACT_RIGHT: "contact_right", "mm", "length of right flank in contact";
    CONTACT_TIP: "contact_tip", "mm", "length of tip in contact";
    CONTACT_LEFT: "contact_left", "mm", "length of left flank in contact";
    MEAN_THICKNESS: "mean_thickness", "um", "section of all chips of the stroke over the length of edge in contact"
        => or(&[IDLE_STROKE]);
    THICKEST_RIGHT: "largest_thickness_right", "um", "largest uncut chip thickness on right flanks";
    THICKEST_TIP: "largest_thickness_tip", "um", "largest uncut chip thickness on tips";
    THICKEST_LEFT: "largest_thickness_left", "um", "largest uncut chip thickness on left flanks";
    FORCE: "cutting_force", "N", "cutting force along the stroke" => symbol("F_c");
    RADIAL_FORCE: "radial_force", "N", "force on the tool along the line of centres, away from the work axis";
    TANGENTIAL_FORCE: "tangential_force", "N",
        "force on the tool across the line of centres, towards larger work angles";
    WORK_TORQUE_OF_STROKE: "work_torque", "N m", "torque on the work spindle, counter-clockwise";
    CUTTER_TORQUE_OF_STROKE: "cutter_torque", "N m", "torque on the cutter spindle, counter-clockwise";
    RATE: "removal_rate", "cm^3/min", "volume of double strokes like this one over their time" => symbol("Q");
}

rows! {
    /// Deflection in a stroke, in the order of the columns.
    DEFLECTION: "deflection", "Deflection of cutter and work",
        "operations.<operation>.deflection, keys after largest (with its sign) and mean (over the strokes that cut); \
         columns of operations.<operation>.chips.strokes";

    RADIAL: "radial_deflection", "um", "shift of the cutter along the line of centres, away from the work axis"
        => titled("radial"), or(&[IDLE_STROKE]);
    TANGENTIAL: "tangential_deflection", "um",
        "shift of the cutter across the line of centres, towards larger work angles"
        => titled("tangential"), or(&[IDLE_STROKE]);
    CUTTER_TURN: "cutter_turn", "urad", "turn of the cutter, counter-clockwise"
        => titled("cutter spindle"), or(&[IDLE_STROKE]);
    WORK_TURN: "work_turn", "urad", "turn of the work, counter-clockwise" => titled("work spindle"), or(&[IDLE_STROKE]);
    LEFT_FLANK: "left_flank_deflection", "um",
        "material left on left flanks at the stroke's pitch point, along their normal"
        => titled("left flanks"), or(&[IDLE_STROKE]);
    RIGHT_FLANK: "right_flank_deflection", "um",
        "material left on right flanks at the stroke's pitch point, along their normal"
        => titled("right flanks"), or(&[IDLE_STROKE]);
}
