//! Quantities of two gears that roll on each other.

mod rolling;
pub mod spline;

pub use rolling::*;

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[
    &PAIR,
    &RATIO,
    &TRANSMISSION_ERROR,
    &WAVES,
    &BACKLASH,
    &CONTACT,
    &CONTACT_BY_TOOTH,
    &INTERFERENCE,
    &DOUBLE_FLANK,
    &CENTER_DISTANCE,
    &POSITIONS,
    &spline::FIT,
    &spline::TOOTH_BY_TOOTH,
];

rows! {
    /// The pair as it is mounted.
    PAIR: "pair", "The pair", "pair";

    GEAR_A: "gear_A", "", "scene of gear A, the driver";
    GEAR_B: "gear_B", "", "scene of gear B, driven";
    KIND: "kind", "", "whether gear B is external or a ring";
    TEETH_A: "teeth_A", "teeth", "teeth of gear A" => symbol("z_1");
    TEETH_B: "teeth_B", "teeth", "teeth of gear B" => symbol("z_2");
    MODULE: "module", "mm", "transverse module" => symbol("m_t");
    PRESSURE_ANGLE: "pressure_angle", "deg", "transverse pressure angle" => symbol("α_t");
    WORKING_PRESSURE_ANGLE: "working_pressure_angle", "deg",
        "transverse pressure angle on the pitch curves that roll on each other" => symbol("α_wt");
    FLANKS_ROLLED: "flanks", "", "whether flanks as cut or nominal ones are rolled";
    DISTANCE: "center_distance", "mm", "distance of the axes at which the gears are rolled"
        => titled("centre distance"), symbol("a"), shown();
    CLOSING_DISTANCE: "closing_center_distance", "mm",
        "distance of the axes at which the pitch curves roll on each other: of round gears that of their profile \
         shifts, or the one that is named";
    DISTANCE_ERROR: "center_distance_error", "um", "what is added to the distance at which the pitch curves roll";
    ECCENTRICITY_A: "eccentricity_A", "um", "distance from gear A's axis of rotation to the origin of its pitch curve";
    ECCENTRICITY_ANGLE_A: "eccentricity_angle_A", "deg", "polar angle of that eccentricity in gear A";
    ECCENTRICITY_B: "eccentricity_B", "um", "distance from gear B's axis of rotation to the origin of its pitch curve";
    ECCENTRICITY_ANGLE_B: "eccentricity_angle_B", "deg", "polar angle of that eccentricity in gear B";
    IN_PLANE: "in_plane_deviation", "um", "distance of the axes over the face, in their plane, beyond parallel ones";
    OUT_OF_PLANE: "out_of_plane_deviation", "um",
        "distance of the axes over the face, across their plane, beyond parallel ones";
    MISFIT: "misfit", "um",
        "largest distance of gear B's own pitch curve from the mate's that closes with gear A";
    TURNS: "turns", "turns", "turns of gear A in a period of the pair";
    COUNT_OF_POSITIONS: "positions", "positions", "positions in a period, even over the teeth";
    SECTIONS: "sections", "sections", "transverse sections that are rolled";
    MARKING: "marking_thickness", "um", "thickness of the marking compound";
}

rows! {
    /// Play of B.
    BACKLASH: "backlash", "Backlash", "backlash";

    SMALLEST_BACKLASH: "smallest", "um",
        "smallest play of B, across the line of centres at the pitch point of the closing centre distance: its angle \
         times r2 there; below 0 it jams";
    LARGEST_BACKLASH: "largest", "um", "largest play of B, across the line of centres at the pitch point" => shown();
    MEAN_BACKLASH: "mean", "um", "mean of the circumferential play" => shown();
    SMALLEST_TANGENTIAL: "smallest_along_pitch_curves", "um", "smallest play along the pitch curves" => symbol("j_t");
    SMALLEST_NORMAL: "smallest_normal", "um",
        "smallest gap of one side's flanks, along their normal, while the other side touches"
        => titled("smallest normal to flanks"), symbol("j_n"), shown();
    SMALLEST_ANGLE: "smallest_angle", "arcsec", "smallest angle that B can turn while A is held";
}

rows! {
    /// Tight mesh.
    DOUBLE_FLANK: "double_flank", "Double-flank rolling",
        "double_flank.mate, .master_A and .master_B; columns of their variation";

    TIGHT_RANGE: "total", "um", "largest less smallest tight centre distance in a turn, less the nominal one"
        => titled("F_i\""), symbol("F_i\""), shown();
    TIGHT_STEP: "in_a_pitch", "um", "largest variation of the tight centre distance within one pitch"
        => titled("f_i\""), symbol("f_i\""), shown();
    TIGHT_MEAN: "mean", "um", "mean of the tight less the nominal centre distance";
    TIGHT_LARGEST: "largest", "um", "largest tight less nominal centre distance";
    ANGLE: "angle", "deg", "angle of gear A with its mate; polar angle of the gear with a master";
    VARIATION: "variation", "um", "tight less nominal centre distance";
}

/// Gear A with gear B in tight mesh.
pub static MATE: QuantityGroup = QuantityGroup::of_parts("mate", "A with B");
/// Either gear with a master.
pub static MASTERS: [QuantityGroup; 2] =
    [QuantityGroup::of_parts("master_A", "A with a master"), QuantityGroup::of_parts("master_B", "B with a master")];

rows! {
    /// Ten micrometres of centre distance.
    CENTER_DISTANCE: "center_distance", "What the centre distance does", "center_distance";

    CHANGE_OF_ERROR: "transmission_error", "arcsec",
        "largest change of the driving flanks' transmission error when the axes are moved 10 um further apart";
    RANGE_OF_CHANGE: "transmission_error_range", "arcsec",
        "largest less smallest change of the transmission error by those 10 um: 0 between involutes on round gears"
        => titled("10 um: change of error, range"), shown();
    LEAST_MORE_PLAY: "smallest_backlash_change", "um",
        "smallest change of the circumferential backlash by those 10 um"
        => titled("10 um: more backlash, least"), shown();
    MOST_MORE_PLAY: "largest_backlash_change", "um",
        "largest change of the circumferential backlash by those 10 um"
        => titled("10 um: more backlash, most"), shown();
}

rows! {
    /// Tips in the mate.
    INTERFERENCE: "interference", "Interference", "interference";

    DEEPEST_TIP: "deepest", "um",
        "deepest place of a tip corner in the material of its mate, where the pitch curves want both gears"
        => or(&[NO_FILLETS, CLEAR]);
    TIP_CLEARANCE: "clearance", "um",
        "smallest distance of tip corners from flanks and fillets of their mate, where the pitch curves want both gears"
        => or(&[NO_FILLETS, INSIDE]);
    IN_A: "in_A", "um", "deepest place of a tip corner of B in the material of A"
        => titled("tip of B in A"), or(&[NO_FILLETS, CLEAR]);
    IN_B: "in_B", "um", "deepest place of a tip corner of A in the material of B"
        => titled("tip of A in B"), or(&[NO_FILLETS, CLEAR]);
    CLEAR_OF_A: "clear_of_A", "um", "smallest distance of B's tip corners from flanks and fillets of A"
        => titled("tip of B clear of A by"), or(&[NO_FILLETS, INSIDE]);
    CLEAR_OF_B: "clear_of_B", "um", "smallest distance of A's tip corners from flanks and fillets of B"
        => titled("tip of A clear of B by"), or(&[NO_FILLETS, INSIDE]);
}

/// No tip corner is looked at.
pub const NO_FILLETS: &str = "nominal flanks have no fillets: roll cut ones";
/// No depth.
pub const CLEAR: &str = "tips stay clear";
/// No clearance.
pub const INSIDE: &str = "a tip is in the material";
