//! Quantities that only hobbing finds.

use crate::findings::quantities::cutting::STOPPED;
use crate::findings::quantities::tool_wear::NO_RANGE;
use crate::findings::{QuantityGroup, rows};

/// A texture window that names no heights.
pub const NOT_NAMED: &str = "not named: 5 % of the profile are left out";
/// A number that could not be computed.
pub const NOT_FINITE: &str = "no finite number was computed";
/// A hob whose tooth is drawn.
pub const DRAWN_TOOTH: &str = "the hob's tooth is drawn: its marks follow no law of straight racks";
/// An operation without chips.
pub const NOTHING: &str = "the operation or the tooth takes nothing";
/// A point of a curve that was not cut.
pub const NOT_CUT_THERE: &str = "the flank was not cut there";
/// Too few points.
pub const TOO_FEW: &str = "fewer than two points were cut";
/// A hob that cannot be shifted from gear to gear.
pub const NO_ROOM: &str =
    "a tooth at an end of the hob works, so that loads would not move along, or the hob is too short to be shifted";
/// A step that its section explains.
pub const SECTION_SAYS: &str = "the section of its step has the reason";

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] =
    &[&HOBBED_GEAR, &EVALUATED, &OPERATION, &LOAD, &FORCE, &HOB_SHIFT, &POINTS, &ERRORS, &MARKS, &FLANK, &AXIS_COLUMNS];

rows! {
    /// What the headline of a hobbed gear adds.
    HOBBED_GEAR: "hobbed_gear", "A hobbed gear", "headline";

    HOFFMEISTER: "thickest_chip_by_hoffmeister", "um",
        "thickest chip of the first operation by the formula of Hoffmeister, fitted to standard racks on round gears"
        => titled("by Hoffmeister's formula"), source("Hoffmeister 1970");
    SHIFT_ROOM: "shift_room", "mm",
        "length of the hob beyond what full contact with finished flanks takes: by so much it can be shifted and still \
         generate them; the zone ahead, where its teeth rough the blank out, is longer and not counted"
        => titled("left to shift by");
    SHIFT_RANGE: "shift_range", "mm", "range of the hob's middle along its axis while it cuts, last operation"
        => titled("range of the shift");
    FEED_MARK: "feed_mark_closed_form", "um",
        "highest ridge between two feeds of the last operation, f^2 / (8 cos^2 beta) (Q_TT - Q_Tc^2 / Q_cc), Q the gap \
         of one gash, T the tooth trace, c the row of gashes"
        => titled("feed mark, closed form"), symbol("δ_x"), or(&[DRAWN_TOOTH]);
    GENERATING_MARK: "generating_mark_closed_form", "um",
        "arc per gash squared times sin(alpha_t) cos(beta_b) / (8 rho) where the pitch curve bends most"
        => titled("generating mark, closed form"), symbol("δ_y"), or(&[DRAWN_TOOTH]);
}

rows! {
    /// Ends of the evaluated profile that the scene names.
    EVALUATED: "measure", "Evaluated profile", "measure";

    PROFILE_START: "profile_start_height", "mm",
        "lower end of the evaluated profile, as height over the pitch curve along its normal in the middle of the \
         face; heights and profile deviations are those inside of it"
        => or(&[NOT_NAMED]);
    PROFILE_END: "profile_end_height", "mm", "upper end of the evaluated profile, as height over the pitch curve"
        => or(&[NOT_NAMED]);
}

rows! {
    /// What an operation of hobbing adds.
    OPERATION: "operation", "An operation of hobbing", "operations.<operation>";

    AXIAL_FEED: "axial_feed", "mm", "feed along the gear's axis in the time of one cycle" => symbol("f_a");
    IDLE_TIME: "idle_time", "s", "time in which the hob does not cut" => titled("idle"), shown();
}

rows! {
    /// Load of the hob's teeth.
    LOAD: "hob_load", "Work of the hob's teeth",
        "hob_load and hob_load.operations.<operation>; columns of their tables; hob_load_peak_to_mean in headline";

    ASSUMPTION: "assumption", "", "law of the load";
    LENGTH_OF_TEETH: "length_of_teeth", "mm",
        "length of all teeth of the gear, z b / cos(beta): workshops count by it how long a hob lasts"
        => source("Liu et al. 2015, Eq. 22, for one gear");
    LOAD_VOLUME: "volume", "mm^3", "volume that all hob teeth take together, as a column of the row's tooth"
        => or(&[NOT_FINITE]), bars();
    LARGEST_VOLUME: "largest_volume", "mm^3", "volume of the hob tooth that takes the most"
        => titled("most of a tooth"), shown(), or(&[NOTHING]);
    HARDEST_TOOTH: "hardest_working_tooth", "", "number of the hob tooth that takes the most"
        => titled("tooth"), shown(), or(&[NOTHING]);
    TEETH_IN_USE: "teeth_in_use", "teeth",
        "hob teeth that take at least a hundredth of the hardest working one's volume"
        => shown();
    PEAK_TO_MEAN: "hob_load_peak_to_mean", "times",
        "largest volume of a hob tooth over the mean of all teeth of the hob; 1 where all work alike"
        => titled("peak to mean"), shown(), or(&[NOTHING, STOPPED]);
    THICKEST_OF_TOOTH: "thickest_chip_of_tooth", "", "hob tooth that takes the thickest chip" => or(&[NOTHING]);
    TRAVEL: "travel", "mm",
        "travel of the tips through the work while any part of their edge takes material: of all teeth, as a column of \
         the row's tooth"
        => or(&[NOT_FINITE]), bars();
    HOB_TOOTH: "hob_tooth", "", "hob tooth along the thread, from the entering end";
    AXIAL: "axial", "mm", "place of the tooth along the hob's axis";
    VOLUME_SHARE: "volume_share", "1", "share of the operation's volume that the tooth takes" => or(&[NOTHING]);
    TOOTH_THICKNESS: "thickness", "mm",
        "largest uncut chip thickness of the hob tooth, across the swept surface of its edge"
        => titled("largest chip thickness"), or(&[NOT_FINITE]), bars();
    TOOTH_PASSES: "passes", "passes", "passes of the tooth that took anything";
    HOB_TURN: "hob_turn", "1", "turn of the hob" => or(&[NOT_FINITE]);
}

rows! {
    /// Forces of the hob's teeth.
    FORCE: "hob_force", "Cutting forces of the hob's teeth",
        "hob_force and hob_force.operations.<operation>; columns of their tables, of the row's tooth or pass";

    LAW: "law", "", "law of the cutting force of a hob tooth";
    ACCURACY: "accuracy", "", "accuracy of forces from rays through the blank";
    MEAN_FORCE: "mean_force", "N", "work over the travel in the cut: mean force of a cutting tooth, referred to the tip"
        => titled("mean force of a tooth"), shown(), or(&[NOTHING]);
    LARGEST_SECTION: "largest_chip_section", "mm^2", "largest section of a chip in the rake face, referred to the tip"
        => or(&[NOTHING, NOT_FINITE]);
    LARGEST_EDGE: "largest_engaged_edge", "mm",
        "largest length of edge of a hob tooth that takes material at once, across its motion, referred to the tip"
        => or(&[NOTHING, NOT_FINITE]);
    MEAN_EDGE: "mean_engaged_edge", "mm", "mean length of edge that takes material, over the travel in the cut"
        => or(&[NOT_FINITE]);
    LARGEST_POWER: "largest_power", "W", "largest cutting force of a pass times the speed of the hob's tip in it"
        => titled("largest power of a tooth"), symbol("P"), shown(), or(&[NOTHING, NOT_FINITE]);
    MEAN_POWER: "mean_power", "W",
        "work of all hob teeth over the time of the operation, approach, overrun and idle travel included";
    WORK: "work", "J", "work of the hob teeth" => symbol("W"), or(&[NOT_FINITE]);
    TIME: "time", "s", "time at which the hob tooth points to the work" => or(&[NOT_FINITE]);
}

rows! {
    /// The hob shifted between gears.
    HOB_SHIFT: "hob_shift", "The hob shifted between gears",
        "tool_wear of a hob; columns of its tables, of the row's shift";

    SHIFT: "shift", "mm",
        "way that the hob is shifted along its axis after every gear, of a quarter, a half and whole distances of its \
         teeth: the one that lasts longest, as a column that of the row"
        => titled("shift after every gear that lasts longest"), or(&[NO_ROOM]);
    SHIFT_TO: "shift_to", "", "end of the hob to which it is shifted after every gear: entering or leaving"
        => or(&[NO_ROOM]);
    SHIFT_RETURN: "shift_return", "",
        "what follows at the end of the hob's room: repeating, back to the first place, or reciprocating, the other way"
        => or(&[NO_ROOM]);
    SHIFT_PLACES: "shift_places", "places", "places that the hob takes, the first one included";
    SHIFT_GEARS: "shift_gears", "gears", "gears before the limit with that shift"
        => titled("gears with that shift"), or(&[NO_ROOM]);
    SHIFT_GEARS_FROM: "shift_gears_from", "gears", "fewest gears with that shift, through the ranges of the constants"
        => or(&[NO_RANGE, NO_ROOM]);
    SHIFT_GEARS_TO: "shift_gears_to", "gears", "most gears with that shift, through the ranges of the constants"
        => or(&[NO_RANGE, NO_ROOM]);
}

rows! {
    /// Points on five curves.
    POINTS: "offset_curves", "Points on five curves", "offset_curves; columns of offset_curves.all_points";

    COUNT: "points", "points", "crossings of five curves beside the pitch curve with all flanks, middle of the face"
        => source("Liu et al. 2015");
    ON_FILLETS: "points_on_fillets", "points", "crossings whose target is the fillet of the hob's tip corner";
    CURVE_OFFSET: "curve_offset", "mm", "distance of the curve from the pitch curve, positive outwards";
    CROSSED: "target", "", "part of the tooth that the curve crosses there: flank or fillet";
    TARGET_X: "target_x", "mm", "x of the crossing in the gear frame, as meant";
    TARGET_Y: "target_y", "mm", "y of the crossing in the gear frame, as meant";
    CUT_X: "x", "mm", "x of the crossing in the gear frame, as cut" => or(&[NOT_CUT_THERE]);
    CUT_Y: "y", "mm", "y of the crossing in the gear frame, as cut" => or(&[NOT_CUT_THERE]);
    ERROR_X: "error_x", "um", "x of the gear frame, as cut less as meant" => or(&[NOT_CUT_THERE]);
    ERROR_Y: "error_y", "um", "y of the gear frame, as cut less as meant" => or(&[NOT_CUT_THERE]);
    ERROR_ALONG: "error_along_curve", "um", "distance along the offset curve, positive where material is left"
        => or(&[NOT_CUT_THERE]);
}

rows! {
    /// Spread of their errors.
    ERRORS: "errors", "Errors of points on five curves",
        "offset_curves.error_x, .error_y and .error_along_curve; columns of their frequencies";

    MEAN_ERROR: "mean", "um", "mean of the errors that the section names" => or(&[TOO_FEW]);
    SIGMA: "sigma", "um", "standard deviation of the errors about their mean" => symbol("σ"), or(&[TOO_FEW]);
    INTERVAL: "interval", "um", "width of an interval of the errors; the middle one is centred on zero"
        => or(&[TOO_FEW]);
    MEDIAN: "median", "um", "middle of an interval of the errors";
    FREQUENCY: "frequency", "points", "points whose error lies in the interval";
}

rows! {
    /// Lattice of cutting marks.
    MARKS: "marks", "Cutting marks: steps from mark to mark",
        "marks.<flank>.<step>.kinematic, .surface and .difference; columns of marks.steps, their keys after the \
         section's";

    LENGTH: "length", "mm",
        "length on the flank at the pitch line of a shortest step from mark to mark, by the source that the \
         section names"
        => or(&[SECTION_SAYS]);
    TO_TRACE: "angle_to_trace", "deg",
        "angle of the step to the tooth trace; in the difference without its sign" => or(&[SECTION_SAYS]);
    TO_AXIS: "angle_to_axis", "deg", "angle of the step to the gear's axis" => or(&[SECTION_SAYS]);
    ROLL: "roll", "mm", "roll of the step, from the machine's motion" => or(&[SECTION_SAYS]);
    AXIAL_STEP: "axial", "mm", "the step along the gear's axis, from the machine's motion" => or(&[SECTION_SAYS]);
    STEP: "step", "1", "number of the step: 1 the shortest, 2 the next one";
}

/// Steps from the machine's motion.
pub static KINEMATIC: QuantityGroup = QuantityGroup::of_parts("kinematic", "from the machine's motion");
/// Steps on the surface as cut.
pub static SURFACE: QuantityGroup =
    QuantityGroup::of_parts("surface", "from the autocorrelation of the heights as cut");
/// Steps on the surface less those of the motion.
pub static DIFFERENCE: QuantityGroup = QuantityGroup::of_parts("difference", "surface less kinematics");

rows! {
    /// What the tables of the axes add.
    AXIS_COLUMNS: "axis_columns", "Tables of a hobbing machine's axes", "columns of axes/<operation>.csv";

    POLAR_ANGLE: "polar_angle", "deg", "polar angle of the pitch point on the gear" => symbol("φ");
}

rows! {
    /// What the table of hobbed flanks adds.
    FLANK: "hobbed_flank", "A hobbed flank", "columns of teeth.flanks";

    IS_UNDERCUT: "undercut", "", "whether the hob's tip corner has undercut the flank in any section: yes or no";
}
