//! Quantities of cutting: chips, forces, times, axes, work of the computer.

use crate::findings::rows;

/// No chip.
pub const IDLE: &str = "no pass of the tool meets material";
/// No chips of a stopped run.
pub const STOPPED: &str = "the run was stopped before the whole blank was cut";
/// No forces.
pub const NO_MATERIAL: &str = "the scene names no material: write [material]";
/// No limit of an axis.
pub const NO_LIMITS: &str = "the scene gives no axis limits";

rows! {
    /// Chips, forces, times, axes, work.
    CUTTING: "cutting", "Cutting", "headline (of all operations); operations.<operation>; work";

    LINKAGE: "linkage", "", "linkage of the tool and the work";
    OFFSET: "offset", "mm", "offset of the tool from the depth without profile shift and thickness allowance"
        => symbol("δ_d");
    SHORT_OF_DEPTH: "short_of_depth", "mm",
        "how far the tool stays back from the depth that makes the teeth as drawn: offset less what profile shift and \
         thickness allowance need";
    PASSES: "passes", "passes", "passes of the tool's teeth or blades over all tooth spaces";
    AXIS_MARGIN: "axis_margin", "1", "share of the tightest axis limit that is left, all axes and operations"
        => titled("left of the tightest limit"), or(&[NO_LIMITS]);
    CYCLE_TIME: "cycle_time", "s",
        "time of the operation, in the headline of all: strokes with their returns, or feed or roll with approach, \
         overrun and idle time"
        => titled("cutting time"), symbol("t");
    THICKEST_CHIP: "largest_chip_thickness", "um",
        "largest uncut chip thickness of any pass, from the edge to the surface before it"
        => titled("thickest chip"), symbol("h"), or(&[IDLE, STOPPED]);
    LARGEST_FORCE: "largest_cutting_force", "N",
        "largest cutting force on the tool's tooth or blade, along its way through the work; on a hob referred to the \
         tooth's tip"
        => titled("largest cutting force"), symbol("F_c"), or(&[IDLE, STOPPED, NO_MATERIAL]);
    FORCE_PER_AREA: "force_per_area", "N/mm^2", "K_c of the material: cutting force per area of chip" => symbol("K_c");
    FORCE_PER_LENGTH: "force_per_length", "N/mm",
        "K_ce of the material: cutting force per length of edge that a chip of no thickness would need"
        => symbol("K_ce");
    REMOVED_VOLUME: "removed_volume", "mm^3",
        "volume that the operation removed, in the headline all of them: by the sections of chips times the face width \
         where they are the same all along the tooth, elsewhere by the rays through the blank"
        => titled("removed"), symbol("V"), or(&[STOPPED]);
    REMOVAL_RATE: "removal_rate", "cm^3/min", "removed volume over the cutting time" => symbol("Q"), or(&[STOPPED]);
    CANDIDATES: "candidates", "passes",
        "passes visited per dexel that is cut, of flanks and of each operation; two or three touch it"
        => titled("passes visited per dexel");
}

rows! {
    /// Tables of the axes.
    AXIS_TABLES: "axis_tables", "Tables of the axes", "columns of axes/<operation>.csv, of each axis under its name";

    TIME: "time", "s", "time from the beginning of the operation, of a bevel gear from that of a slot";
    POSITION: "position", "that of the axis", "position of the axis; angles go on beyond a turn";
    SPEED: "speed", "that of the axis", "speed of the axis";
    ACCELERATION: "acceleration", "that of the axis", "acceleration of the axis";
}

rows! {
    /// Peaks of an axis against its limit.
    AXES: "axes", "Peaks of the axes", "operations.<operation>.axes.<axis and order>";

    PEAK: "peak", "that of the axis", "largest magnitude of the axis's speed or acceleration during the operation";
    LIMIT: "limit", "that of the axis", "largest magnitude that the machine allows";
    MARGIN: "margin", "1", "1 - peak / limit";
}
