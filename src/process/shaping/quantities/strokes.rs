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

/// A turn has no width of a chip.
pub const TURNS: &str = "a spindle vibrates: its limit depends on where the chip lies";

rows! {
    /// Vibration in a stroke, in the order of the columns; then what holds for the whole operation.
    VIBRATION: "vibration", "Vibration of cutter and work",
        "operations.<operation>.vibration, of the first three keys after largest and mean (over the strokes that cut); \
         these are columns of operations.<operation>.chips.strokes";

    LIMIT_SHARE: "share_of_stability_limit", "1",
        "stiffness of the stroke's chips (force for a thickness) along the coordinate that vibrates, over the least \
         limit of stability 2 ζ (1 + ζ) / C: above 1 waves grow from stroke to stroke"
        => titled("share of the stability limit"), source("Tobias 1965; Altintas 2012, section 4.2"),
           or(&[IDLE_STROKE]);
    LEFT_VIBRATION: "left_flank_vibration", "um",
        "displacement about the deflection, normal to left flanks at the stroke's pitch point, root mean square along \
         the face"
        => titled("vibration on left flanks"), or(&[IDLE_STROKE]);
    RIGHT_VIBRATION: "right_flank_vibration", "um",
        "displacement about the deflection, normal to right flanks at the stroke's pitch point, root mean square along \
         the face"
        => titled("vibration on right flanks"), or(&[IDLE_STROKE]);
    UNSTABLE_STROKES: "unstable_strokes", "strokes", "strokes whose chips are beyond the least limit of stability"
        => titled("strokes beyond the stability limit");
    STABLE_WIDTH: "stable_chip_width", "mm",
        "widest chip square to the coordinate that vibrates with which no wave grows, 2 ζ (1 + ζ) / (C K_n), the same \
         at every speed of the ram"
        => titled("widest stable chip"), symbol("b_lim"), source("Tobias 1965; Altintas 2012, section 4.2"),
           or(&[TURNS]);
    WAVE_LENGTH: "wave_length", "mm",
        "distance of waves along the tooth in the middle of the face: speed of the ram over the natural frequency"
        => titled("length of waves");
}
