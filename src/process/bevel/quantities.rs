//! Quantities that only bevel cutting finds.

pub mod pair;

use crate::findings::quantities::cutting::{IDLE, NO_MATERIAL};
use crate::findings::{QuantityGroup, rows};

/// No slot.
pub const NO_SLOT: &str = "the slot behind tooth 1 was not cut as a whole";
/// No marks.
pub const NO_MARKS: &str = "the head plunges: all blades of a kind sweep the same cone";
/// No place of a flank.
pub const NO_GRID: &str = "a point of the grid was not cut";
/// No setting that explains.
pub const NOTHING_TO_EXPLAIN: &str = "all deviations of the grid are below 0.5 um, or a point of it was not cut";

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[
    &BEVEL_GEAR,
    &SETTINGS,
    &OPERATION,
    &FITS,
    &MARKS,
    &FLANK,
    &GRID,
    &SLOT,
    &POSITION,
    &ERRORS,
    &BLADES,
    &BODY,
    &CHIPS,
    &AXIS_COLUMNS,
    &pair::PAIR,
    &pair::SIDE,
    &pair::PATH,
    &pair::TRENDS,
];

rows! {
    /// What the headline of a bevel gear adds.
    BEVEL_GEAR: "bevel_gear", "A bevel gear", "headline; idle_share in operations.<operation>";

    SLOT_DEPTH: "slot_depth", "mm",
        "depth of the slot behind tooth 1 in the middle of the face, from the face cone, square to the pitch cone"
        => or(&[NO_SLOT]);
    WHOLE_DEPTH: "whole_depth", "mm", "addendum and dedendum of the blank in the middle of the face"
        => titled("whole depth of the blank"), symbol("h"), or(&[NO_SLOT]);
    SLOT_WIDTH: "slot_width", "mm",
        "width of the slot behind tooth 1 on the circle of the pitch cone in the middle of the face"
        => or(&[NO_SLOT]);
    IDLE_SHARE: "idle_share", "1",
        "share of the operation's roll, in the headline of the last one's, in which no point of the target flanks is \
         generated"
        => titled("idle share of the roll");
}

rows! {
    /// Settings as they hold, and what they say of the cutter.
    SETTINGS: "settings", "Settings of the machine", "settings";

    SETTINGS_SOURCE: "settings_source", "", "origin of radial setting, cradle angle and what follows from them";
    RADIAL: "radial_setting", "mm", "distance of the head's axis from the cradle's" => symbol("S_r");
    CRADLE: "cradle_angle", "deg", "cradle angle in the middle of the roll, or where the cradle rests" => symbol("q");
    BLANK_OFFSET: "blank_offset", "mm", "offset of the work's axis from the cradle's" => symbol("E_m");
    SLIDING_BASE: "sliding_base", "mm", "shift along the cradle's axis, offsets of operations included"
        => symbol("X_b");
    CENTER_TO_BACK: "center_to_back", "mm", "advance of the work along its axis, machine centre to back"
        => symbol("X_p");
    ROOT_ANGLE: "root_angle", "deg", "machine root angle" => symbol("gamma_m");
    ROLL_RATIO: "roll_ratio", "1", "work angle per cradle angle; 0 where nothing rolls" => symbol("R_a");
    CUTTER_RADIUS: "cutter_radius", "mm", "mean cutter radius in use" => symbol("r_c");
    RADIUS_SOURCE: "cutter_radius_source", "", "origin of the cutter radius";
    INFERRED_RADIUS: "inferred_radius", "mm", "radius of the circle that the settings lead through the mean point";
    INFERRED_SPIRAL: "inferred_spiral_angle", "deg",
        "spiral angle of that circle at the mean point; positive is right-hand"
        => symbol("beta_m");
    MODIFIED_C: "modified_roll_c", "1/rad", "C of the modified roll; 0 where the roll is even" => symbol("C");
    MODIFIED_D: "modified_roll_d", "1/rad^2", "D of the modified roll; 0 where it is even" => symbol("D");
    INFERRED_RATIO: "inferred_roll_ratio", "1", "roll ratio of a crown gear of these cones";
    TILT: "tilt", "deg", "lean of the head's axis against the cradle's, where there is one" => symbol("i");
    SWIVEL: "swivel", "deg", "direction of that lean, from the line of the radial setting" => symbol("j");
    MISSED_DEPTH: "missed_depth", "mm", "distance of the blades' tips from the blank's roots, middle of the face";
}

rows! {
    /// What an operation of bevel cutting adds.
    OPERATION: "operation", "An operation of bevel cutting", "operations.<operation>";

    ROLL_FROM: "roll_from", "deg", "cradle angle at which a slot begins";
    ROLL_TO: "roll_to", "deg", "cradle angle at which a slot ends";
    PLUNGE_WAY: "plunge_way", "mm", "way of a plunging head along its axis, from clear of the blank to full depth";
    INFEED: "infeed", "mm", "way of a plunging head for each of its turns" => titled("infeed for a turn");
    DWELL: "dwell", "s", "time of a plunging head at full depth";
    SLOT_TIME: "slot_time", "s", "roll or plunge and idle time of one slot" => titled("time for a slot"), shown();
}

rows! {
    /// Polynomials of the axes.
    FITS: "axis_fits", "Polynomials of the axes over one slot's roll", "columns of operations.<operation>.axis_fits";

    AXIS: "axis", "", "letter of the axis";
    ORDER: "order", "1", "order of the polynomial in time from the beginning of the roll, s";
    LARGEST_ERROR: "largest_error", "mm or deg", "largest error of the polynomial over the roll";
}

rows! {
    /// Marks of the blades.
    MARKS: "marks", "Marks of the blades, closed form", "marks.left and marks.right";

    FLANK_BLADES: "blades", "", "kind of the blades that cut the flank: outside or inside";
    FORM: "form", "", "form of the flanks along the tooth";
    MARK_HEIGHT: "height", "um",
        "height of the cone over its envelope half a period of the blades beside the moment of generation, middle of \
         the flank"
        => or(&[NO_MARKS]);
    MARK_SPACING: "spacing", "mm",
        "cradle angle from blade to blade of the kind over the gradient of the moment of generation"
        => or(&[NO_MARKS]);
}

rows! {
    /// Points of inspection.
    GRID: "grid", "Points of inspection", "columns of teeth.grid";

    GRID_COLUMN: "column", "1", "place along the profile, 1 at the root, the last one at the tip";
    GRID_ROW: "row", "1", "place along the tooth, 1 at the toe, the last one at the heel";
    NOMINAL_X: "x", "mm", "x of the nominal point, gear frame: origin in the apex, x through the middle of space 0";
    NOMINAL_Y: "y", "mm", "y of the nominal point, gear frame";
    NOMINAL_Z: "z", "mm", "z of the nominal point, gear frame: along the axis from the back to the apex";
    NORMAL_X: "nx", "1", "x of the unit normal out of the material";
    NORMAL_Y: "ny", "1", "y of the unit normal out of the material";
    NORMAL_Z: "nz", "1", "z of the unit normal out of the material";
    DEVIATION: "deviation", "um", "normal deviation of the point, positive where material is left" => or(&[NO_GRID]);
}

rows! {
    /// The slot along the face.
    SLOT: "slot", "Slot", "columns of slot.along_the_face";

    ALONG: "along", "mm", "place along the tooth from the middle of the face, towards the heel";
    WIDTH: "width", "mm", "width of the slot there, on the circle of the pitch cone" => or(&[NO_SLOT]);
    DEPTH: "depth", "mm", "depth of the slot there, from the face cone, square to the pitch cone" => or(&[NO_SLOT]);
    BLANK_DEPTH: "whole_depth", "mm", "addendum and dedendum of the blank there";
}

rows! {
    /// Position and angles of flanks, apart from their form.
    POSITION: "position", "Thickness, spiral and pressure angle", "position; angles end with the flank";

    THICKNESS: "thickness", "um",
        "excess of both flanks of a tooth along their normals, middle of the grid"
        => shown(), or(&[NO_GRID]);
    SPIRAL: "spiral_angle", "um",
        "deviation of the grid's plane from toe to heel, positive where the heel is higher" => shown(), or(&[NO_GRID]);
    PRESSURE: "pressure_angle", "um",
        "deviation of the grid's plane from root to tip, positive where the tip is higher" => shown(), or(&[NO_GRID]);
}

rows! {
    /// Settings whose errors would explain the deviations of tooth 1.
    ERRORS: "settings_errors", "Errors of settings that would explain the deviations",
        "settings_errors, before the key the flank; columns of settings_errors.left and .right";

    EXPLAINED: "explained", "",
        "settings whose error, each by itself, explains most of the deviations of the grid, and root mean square of \
         the unexplained rest"
        => shown(), or(&[NOTHING_TO_EXPLAIN]);
    SETTING: "setting", "", "name of the setting, by itself";
    SETTING_ERROR: "error", "mm or deg", "error of the setting that explains most; of the ratio of roll a pure number";
    UNEXPLAINED: "unexplained", "um", "root mean square of the unexplained deviations of the grid";
}

rows! {
    /// Flanks by blade.
    BLADES: "blades", "Blades", "columns of blades.blades";

    BLADE: "blade", "1", "number of the blade, from 0";
    BLADE_KIND: "kind", "", "kind of the blade: outside or inside";
    RUNOUT: "runout", "um", "distance of the blade from its place in the head, outwards";
    SHARE: "share", "%", "share of all flanks on which the blade cut last" => bars();
}

rows! {
    /// The whole gear.
    BODY: "blank", "The whole gear", "blank";

    ROWS: "rows", "rows", "cone distances of the rays";
    RIM: "rim", "mm",
        "thickness of the ring under the root cone: an outer module, as the scene does not say what is below";
    POINTED: "pointed", "", "whether neighbouring slots meet in the tips of the teeth";
}

rows! {
    /// Chips of a slot.
    CHIPS: "chips", "Chips of a slot", "chips and chips.operations.<operation>; columns of chips.by_blade and .by_pass";

    SLOT_NUMBER: "slot", "1", "number of the slot, from 0; it follows that tooth";
    SLOT_VOLUME: "slot_volume", "mm^3", "volume taken from a slot, as missing from its rays"
        => titled("a slot"), shown();
    OVERHANG: "overhang", "mm^3",
        "material of the slot that hangs over the lowest cut on its ray, as on undercut teeth; the whole gear is shown \
         without it";
    LAW: "law", "", "law of the cutting force of a blade";
    TAKEN: "volume", "mm^3", "volume that the passes took, of the operation, blade or pass";
    PLUNGE: "plunge_volume", "mm^3",
        "volume of the first revolution of the head, at full depth from the beginning of the roll, in place of the \
         plunge, which is not modelled; thickness, forces and power leave it out";
    TAKING: "passes", "passes", "passes that took anything";
    LARGEST_SECTION: "largest_chip_section", "mm^2", "largest section of a chip in the rake face of a blade"
        => or(&[IDLE]);
    LARGEST_EDGE: "largest_engaged_edge", "mm", "largest length of edge of a blade that takes material at once"
        => or(&[IDLE]);
    LARGEST_POWER: "largest_power", "W", "largest cutting force of a blade times the speed of its tip"
        => symbol("P"), or(&[IDLE]);
    MEAN_POWER: "mean_power", "W", "work of all blades over the time of a slot's motion"
        => titled("mean power while a slot is cut"), shown();
    BLADE_WORK: "work", "J", "work of the blade in the slot" => symbol("W"), or(&[NO_MATERIAL]);
    PASS: "pass", "1", "number of the pass";
    REVOLUTION: "revolution", "1", "revolution of the head in the slot; 0 is in place of the plunge before a roll";
    PASS_ANGLE: "cradle_angle", "deg", "cradle angle while the blade is in the middle of the slot";
    PASS_DEPTH: "depth", "mm",
        "place of the plunging head before full depth while the blade is in the middle of the slot";
    THICKEST_ALONG: "along", "mm",
        "place of the thickest chip along the tooth, from the middle of the face to the heel";
}

rows! {
    /// What the tables of the axes add.
    AXIS_COLUMNS: "axis_columns", "Tables of the axes of bevel cutting", "columns of axes/<operation>.csv";

    CRADLE_ANGLE: "cradle_angle", "deg", "angle of the cradle that the axes make";
}

rows! {
    /// What the table of bevel flanks adds.
    FLANK: "bevel_flank", "A bevel flank", "columns of teeth.flanks";

    CUT_BY: "cut_by", "", "blades that cut the flank: outside or inside";
}
