//! Quantities that only shaping finds.

pub mod axes;
pub mod returns;
pub mod ring;
pub mod strokes;

use crate::findings::quantities::cutting::IDLE;
use crate::findings::quantities::flanks::{BELOW_RANGE, LAST, NO_FLANK_REACHED, NOT_CUT, SINGLE};
use crate::findings::{QuantityGroup, rows};

/// No first stroke at full depth.
pub const NO_ENTRY: &str = "the cutter is fed in, or its first stroke meets nothing";
/// No clearance, no tips.
pub const NO_FLANK: &str = "no flank was cut";
/// No cusp.
pub const NO_CUSP: &str =
    "no cusp between facets of three dexels and more was met: the dexels are too coarse for the feed";
/// No cusp on a flank.
pub const NO_CUSP_HERE: &str = "no cusp between facets of three dexels and more was met";
/// No cut below the target.
pub const NOTHING_BELOW: &str = "nothing is cut more than a nanometre below the target";
/// No undercut.
pub const SOUND: &str = "the flank is not undercut";
/// No crossing of a surface with the pitch curve.
pub const NO_CROSSING: &str = "a surface does not cross the pitch curve with its involute, or the flank is cut away";
/// Nothing that the scene's own strokes alone tell.
pub const OTHER_STROKES: &str =
    "the limit of many strokes and the offset are known of the scene's own strokes alone, and a program cuts others";
/// No offset.
pub const NO_OFFSET: &str = "the operation has no offset over the last one";
/// No witness mark.
pub const NO_WITNESS: &str =
    "on no evaluated profile do facets of three dexels and more meet that are more than half a turn apart";
/// No allowance.
pub const NO_ALLOWANCE: &str = "no tooth has an allowance on both flanks";

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[
    &SHAPED_GEAR,
    &SHAPED_FLANK,
    &ALLOWANCE,
    &MEASURED_ALLOWANCE,
    &CMM_TEETH,
    &OPERATION,
    &CHIPS,
    &STROKES_OF_PROGRAM,
    &strokes::STROKE_CHIPS,
    &strokes::DEFLECTION,
    &strokes::VIBRATION,
    &axes::AXIS_COLUMNS,
    &axes::RELIEF,
    &axes::RETRACTION,
    &returns::RETURN_STROKES,
    &returns::RETURN_PLACES,
    &ring::RING,
    &ring::RING_TEETH,
];

rows! {
    /// What the headline of a shaped gear adds.
    SHAPED_GEAR: "shaped_gear", "A shaped gear", "headline";

    TIP_LAND: "tip_land", "mm", "width of the tip between the flanks of a tooth; in the headline the narrowest"
        => titled("narrowest tip land"), symbol("s_a"), or(&[NO_FLANK, NOT_CUT]);
    POINTED_TEETH: "pointed_teeth", "teeth", "teeth that are pointed below the blank's outline";
    SCALLOP: "scallop_height", "um",
        "height of the highest cusp on the evaluated profile over the line that touches its two facets, mid-face"
        => titled("highest scallop"), or(&[NO_CUSP, NO_CUSP_HERE, BELOW_RANGE, NOT_CUT]);
    WITNESS_MARK: "witness_mark", "um",
        "largest step where finishing strokes meet that are more than half a turn apart, mid-face: height of the later \
         facet over the earlier, negative where it is deeper"
        => or(&[NO_WITNESS, BELOW_RANGE, NOT_CUT]);
    RELIEF_RATIO: "relief_ratio", "1",
        "smallest clearance of the cutter's relief on the return stroke, as a share of that of a round gear"
        => titled("relief over a round gear's"), or(&[NO_FLANK]);
    UNEVENNESS_MAX: "unevenness_max", "%", "largest |AB - CD| over the mean of AB and CD, all teeth, as cut"
        => titled("largest unevenness"), or(&[SINGLE, NO_ALLOWANCE]);
    UNEVENNESS_MEAN: "unevenness_mean", "%", "mean over the teeth of |AB - CD| over the mean of AB and CD, as cut"
        => titled("mean unevenness"), or(&[SINGLE, NO_ALLOWANCE]);
}

rows! {
    /// Chips of an operation, and of all in the headline.
    CHIPS: "chips", "Chips and cutting forces", "headline (of all operations); operations.<operation>.chips";

    LARGEST_SECTION: "largest_chip_section", "mm^2", "largest section of all chips of a stroke, in the transverse plane"
        => symbol("A"), or(&[IDLE]);
    ENTRY_SECTION: "entry_chip_section", "mm^2",
        "section of a first stroke at full depth without infeed: whole tooth spaces at once, as no machine cuts; the \
         largest values leave it out"
        => or(&[NO_ENTRY]);
    ENTRY_FORCE: "entry_cutting_force", "N",
        "cutting force of a first stroke at full depth without infeed, an upper bound: where chips of several sides \
         meet they count twice, up to 1.8 times K_c A and the edge's part; the largest values leave it out"
        => titled("first stroke at full depth"), or(&[NO_ENTRY]);
    WORK_TORQUE: "largest_work_torque", "N m", "largest torque of the cut on the work spindle, without its sign"
        => or(&[IDLE]);
    CUTTER_TORQUE: "largest_cutter_torque", "N m", "largest torque of the cut on the cutter spindle, without its sign"
        => or(&[IDLE]);
    MEDIAN_SECTION: "median_section", "mm^2", "section of all chips of a stroke: median over the strokes that cut"
        => or(&[IDLE]);
    MEDIAN_FORCE: "median_force", "N", "cutting force along the stroke: median over the strokes that cut"
        => or(&[IDLE]);
    LARGEST_POWER: "largest_power", "W",
        "largest cutting force times the ram's largest speed, pi times stroke length times double strokes per time"
        => symbol("P"), or(&[IDLE]);
    IDLE_STROKES: "idle_strokes", "strokes", "strokes in which no cutter tooth meets material";
    TWO_FLANK_CHIPS: "two_flank_chips", "chips",
        "chips that form on two sides of a cutter tooth's edge at once (tip and flank, or both flanks)";
    THREE_FLANK_CHIPS: "three_flank_chips", "chips", "chips that form on tip and both flanks of a cutter tooth at once";
}

rows! {
    /// What the section of a shaped flank adds.
    SHAPED_FLANK: "shaped_flank", "A shaped flank",
        "teeth.<tooth>.<flank>; columns of teeth.flanks; period_teeth in teeth";

    FLANK_START: "start", "", "what begins the flank" => or(&[BELOW_RANGE, NOT_CUT]);
    UNDERCUT: "undercut", "um", "depth of the path of the cutter's tip corner below the flank, under its start"
        => or(&[SOUND, BELOW_RANGE, NOT_CUT]);
    TIP_HEIGHT: "tip_height", "mm", "height over the pitch curve at which the flank ends"
        => or(&[BELOW_RANGE, NOT_CUT]);
    FLANK_END: "end", "", "what ends the flank" => or(&[BELOW_RANGE, NOT_CUT]);
    BELOW_TARGET: "deepest_below_target", "um", "deepest cut below the target anywhere on the flank, negative"
        => or(&[NOTHING_BELOW, BELOW_RANGE, NOT_CUT]);
    SCALLOP_AT_PITCH_CURVE: "scallop_at_pitch_curve", "um", "height of the cusp nearest to the pitch curve, mid-face"
        => or(&[NO_CUSP_HERE, BELOW_RANGE, NOT_CUT]);
    BELOW_RANGE_DEXELS: "below_range_dexels", "dexels", "dexels cut deeper than their rays record";
    PERIOD_TEETH: "period_teeth", "teeth",
        "teeth after which the pitch curve repeats: the first period of tables and charts";
}

rows! {
    /// Allowances on the pitch curve.
    ALLOWANCE: "allowance", "Allowance on the pitch curve", "columns of operations.<operation>.allowance";

    A_X: "A_x", "mm", "x of A in the gear frame: left flank after this operation, on the pitch curve"
        => or(&[NO_CROSSING]);
    A_Y: "A_y", "mm", "y of A" => or(&[NO_CROSSING]);
    B_X: "B_x", "mm", "x of B in the gear frame: finished left flank on the pitch curve" => or(&[NO_CROSSING]);
    B_Y: "B_y", "mm", "y of B" => or(&[NO_CROSSING]);
    C_X: "C_x", "mm", "x of C in the gear frame: finished right flank on the pitch curve" => or(&[NO_CROSSING]);
    C_Y: "C_y", "mm", "y of C" => or(&[NO_CROSSING]);
    D_X: "D_x", "mm", "x of D in the gear frame: right flank after this operation, on the pitch curve"
        => or(&[NO_CROSSING]);
    D_Y: "D_y", "mm", "y of D" => or(&[NO_CROSSING]);
    AB: "AB", "mm",
        "chord from A (after this operation) to B (after finishing alone), left flank, on the pitch curve; negative \
         where A lies inside the finished tooth"
        => or(&[NO_CROSSING]);
    CD: "CD", "mm",
        "chord from C (after finishing alone) to D (after this operation), right flank, on the pitch curve; negative \
         where D lies inside the finished tooth"
        => or(&[NO_CROSSING]);
    UNEVENNESS: "unevenness_mean_denominator", "%", "|AB - CD| over the mean of AB and CD"
        => titled("unevenness"), or(&[NO_CROSSING]), bars();
    UNEVENNESS_RACK: "unevenness_rack_denominator", "%", "|AB - CD| over delta_d tan(alpha)"
        => or(&[NO_CROSSING, NO_OFFSET, OTHER_STROKES]);
    ENVELOPE_AB: "envelope_AB", "mm", "AB in the limit of many strokes" => or(&[NO_CROSSING, OTHER_STROKES]);
    ENVELOPE_CD: "envelope_CD", "mm", "CD in the limit of many strokes" => or(&[NO_CROSSING, OTHER_STROKES]);
    ENVELOPE_UNEVENNESS: "envelope_unevenness_mean_denominator", "%",
        "|AB - CD| over the mean of AB and CD in the limit of many strokes"
        => or(&[NO_CROSSING, OTHER_STROKES]);
}

rows! {
    /// Allowances as a coordinate measuring machine finds them.
    MEASURED_ALLOWANCE: "cmm", "Allowance as a coordinate measuring machine finds it", "operations.<operation>.cmm";

    CMM_MAX: "unevenness_max", "%",
        "largest |AB - CD| over the mean of AB and CD, all teeth, by probe and points alone"
        => titled("largest unevenness by probe and points"), or(&[NO_ALLOWANCE]);
    CMM_MEAN: "unevenness_mean", "%", "mean over the teeth of the same"
        => titled("mean unevenness by probe and points"), or(&[NO_ALLOWANCE]);
    CMM_MAX_MEDIAN: "unevenness_max_median", "%", "median of the largest unevenness over measurements by chance"
        => or(&[NO_ALLOWANCE]);
    CMM_MAX_LOW: "unevenness_max_low", "%",
        "lower end of the interval that holds 95 % of the largest unevenness over measurements by chance"
        => or(&[NO_ALLOWANCE]);
    CMM_MAX_HIGH: "unevenness_max_high", "%",
        "upper end of the interval that holds 95 % of the largest unevenness over measurements by chance"
        => or(&[NO_ALLOWANCE]);
    CMM_MEAN_MEDIAN: "unevenness_mean_median", "%", "median of the mean unevenness over measurements by chance"
        => titled("mean unevenness, as measured"), shown(), or(&[NO_ALLOWANCE]);
    CMM_MEAN_LOW: "unevenness_mean_low", "%",
        "lower end of the interval that holds 95 % of the mean unevenness over measurements by chance"
        => titled("low end of 95 %"), shown(), or(&[NO_ALLOWANCE]);
    CMM_MEAN_HIGH: "unevenness_mean_high", "%",
        "upper end of the interval that holds 95 % of the mean unevenness over measurements by chance"
        => titled("high end of 95 %"), shown(), or(&[NO_ALLOWANCE]);
    CMM_DEVIATION: "allowance_deviation", "um",
        "standard deviation of AB and CD over measurements by chance, root mean square of the teeth"
        => or(&[NO_ALLOWANCE]);
}

rows! {
    /// The same tooth by tooth.
    CMM_TEETH: "cmm_teeth", "Allowance of each tooth by probe and points",
        "columns of operations.<operation>.cmm.teeth";

    CMM_AB: "measured_AB", "mm", "AB by probe and points, without chance" => or(&[NO_CROSSING]);
    CMM_CD: "measured_CD", "mm", "CD by probe and points, without chance" => or(&[NO_CROSSING]);
}

/// Unevenness of an operation by each definition.
pub static SPREADS: QuantityGroup = QuantityGroup::of_parts("unevenness", "Unevenness of the allowance");
/// Stock of each tooth after an operation.
pub static STOCK_OF_TEETH: QuantityGroup = QuantityGroup::of_parts("teeth", "Stock of each tooth");

rows! {
    /// What an operation of shaping adds.
    OPERATION: "operation", "An operation of shaping", "operations.<operation> and its unevenness";

    STROKES: "strokes", "strokes", "strokes of the operation, plunging ones included";
    LARGEST_SPEED: "largest_cutting_speed", "m/min",
        "largest speed of the ram on its crank, pi times stroke length times double strokes per time; the stroke is \
         approach, face and overrun"
        => symbol("v_c");
    MEAN_SPEED: "mean_cutting_speed", "m/min",
        "mean speed of the cutting stroke, 2 times stroke length times double strokes per time";
    CIRCULAR_FEED: "circular_feed", "mm per stroke", "mean arc of the pitch curve per double stroke" => symbol("f_c");
    SPREAD_MAX: "max", "%", "largest |AB - CD| of a tooth over what the section names"
        => shown(), or(&[LAST, NO_FLANK_REACHED]);
    SPREAD_MEAN: "mean", "%", "mean over the teeth of |AB - CD| over what the section names"
        => shown(), or(&[LAST, NO_FLANK_REACHED]);
}

rows! {
    /// What a program of strokes adds.
    STROKES_OF_PROGRAM: "program_strokes", "A program of strokes under test", "operations.<operation>.program";

    SHORT_OF_DRAWN_BACK: "short_of_drawn_back", "um",
        "largest displacement of the cutter's edge while the ram returns through the face from where the scene has it \
         drawn back to; drawn back further is none";
    DISTANCE_BETWEEN: "largest_distance_between_strokes", "um",
        "largest displacement of the cutter's edge between two strokes from the straight way from the one to the \
         other; drawing back is none";
    MISSING_STROKES: "missing_strokes", "strokes", "strokes of the scene that the program does not make"
        => titled("missing"), shown();
    DOUBLED_STROKES: "doubled_strokes", "strokes", "strokes of the program that repeat one before"
        => titled("made twice"), shown();
    STROKES_OFF: "strokes_off", "strokes", "strokes of the program that are none of the scene's"
        => titled("none of the scene's"), shown();
    STROKES_PER_MINUTE: "strokes_per_minute", "1/min", "S of the program: double strokes per minute";
    SCENE_STROKES_PER_MINUTE: "asked_strokes_per_minute", "1/min", "double strokes per minute of the scene";
}
