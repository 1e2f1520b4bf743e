//! Quantities of rolling: ratio, transmission error, contact, and the table of all positions.

use crate::findings::rows;

/// No amplitude.
pub const TOO_SHORT: &str = "there are too few positions for a wave so short";
/// No arc on a flank.
pub const NO_FORM_POINT: &str = "nominal flanks have no form point";

rows! {
    /// Ratio of the speeds.
    RATIO: "ratio", "Ratio", "ratio";

    SMALLEST_RATIO: "smallest", "1",
        "smallest ratio r2 / r1 of the speeds of A and B by the pitch curves" => symbol("i");
    LARGEST_RATIO: "largest", "1",
        "largest ratio r2 / r1 of the speeds of A and B by the pitch curves" => symbol("i");
    RATIO_DEVIATION: "largest_deviation", "%",
        "largest deviation of the ratio that the driving flanks achieve, mean between neighbouring positions, from \
         that of the pitch curves";
}

rows! {
    /// Transmission error of B, by the side that drives.
    TRANSMISSION_ERROR: "transmission_error", "Transmission error", "transmission_error.<side>";

    PEAK_TO_PEAK: "peak_to_peak", "arcsec",
        "largest less smallest rotation of B beyond that of the pitch curves" => shown();
    LONG_WAVE_RANGE: "long_wave_peak_to_peak", "arcsec",
        "largest less smallest value of the transmission error's waves longer than two teeth"
        => titled("long wave"), shown();
    MESH_RANGE: "mesh_peak_to_peak", "arcsec",
        "largest less smallest value of the transmission error without its waves longer than two teeth"
        => titled("tooth mesh"), shown();
    MEAN_ERROR: "mean", "arcsec", "mean of the transmission error: a turn of B that no one feels";
    RANGE_AT_PITCH_POINT: "peak_to_peak_at_pitch_point", "um",
        "largest less smallest transmission error times r2, across the line of centres";
    RANGE_NORMAL: "peak_to_peak_normal", "um", "largest less smallest transmission error along the flank's normal";
}

rows! {
    /// Waves of the transmission error.
    WAVES: "waves", "Waves of the transmission error",
        "columns of transmission_error.<side>.waves (those with a name) and .harmonics (all)";

    WAVE: "wave", "", "name of the wave";
    HARMONIC: "harmonic", "1", "waves in a period of the pair";
    ORDER: "order", "1", "waves in a turn of A";
    AMPLITUDE: "amplitude", "arcsec", "half the height of the wave" => or(&[TOO_SHORT]), bars();
    AMPLITUDE_AT_RADIUS: "amplitude_at_mean_radius", "um",
        "half the height of the wave on the circle as long as B's pitch curve" => or(&[TOO_SHORT]);
}

rows! {
    /// Contact, by side.
    CONTACT: "contact", "Contact", "contact.<side>";

    SMALLEST_CONTACT_RATIO: "smallest_contact_ratio", "1",
        "smallest of the transverse contact ratios of all positions: path of contact between the tip curves, of cut \
         flanks within their form points, over the base pitch; of round gears at the distance of the axes, of others \
         at the closing one"
        => symbol("ε_α");
    MEAN_CONTACT_RATIO: "mean_contact_ratio", "1",
        "mean of the transverse contact ratios of all positions" => symbol("ε_α");
    LARGEST_CONTACT_RATIO: "largest_contact_ratio", "1", "largest of the transverse contact ratios of all positions"
        => symbol("ε_α");
    OVERLAP_RATIO: "overlap_ratio", "1",
        "of helical gears: how far the teeth wind along the common face, over the pitch: b sin(β) / (π m_n)"
        => symbol("ε_β");
    TOTAL_CONTACT_RATIO: "total_contact_ratio", "1",
        "of helical gears: smallest transverse contact ratio and overlap ratio together" => symbol("ε_γ");
    MEAN_PAIRS: "mean_pairs", "1", "mean number of pairs of flanks closer than the marking thickness"
        => titled("pairs in contact, mean"), shown();
    FEWEST_PAIRS: "fewest_pairs", "pairs", "smallest number of pairs of flanks closer than the marking thickness";
    EDGE_LIFT: "edge_lift", "um",
        "how far a tip corner or a fillet drives the gears at most beyond flanks, along the flank's normal"
        => titled("lift by edges"), shown();
    EDGE_SHARE: "edge_share", "%", "share of the positions at which a tip corner or a fillet carries";
}

rows! {
    /// Contact of every flank of A.
    CONTACT_BY_TOOTH: "teeth", "Where contact begins and ends on every flank of A", "columns of contact.teeth";

    FLANK_OF_A: "flank", "", "tooth and flank of gear A";
    LOWEST_ON_A: "lowest_on_A", "mm", "lowest contact over the pitch curve of A";
    HIGHEST_ON_A: "highest_on_A", "mm", "highest contact over the pitch curve of A";
    LOWEST_ON_B: "lowest_on_B", "mm", "lowest contact over the pitch curve of B";
    HIGHEST_ON_B: "highest_on_B", "mm", "highest contact over the pitch curve of B";
    START_ON_A: "start_arc_on_A", "mm", "lowest contact on A, arc from the form point; below 0 in the fillet"
        => or(&[NO_FORM_POINT]);
    END_ON_A: "end_arc_on_A", "mm", "highest contact on A, arc from the form point" => or(&[NO_FORM_POINT]);
    START_ON_B: "start_arc_on_B", "mm", "lowest contact on B, arc from the form point; below 0 in the fillet"
        => or(&[NO_FORM_POINT]);
    END_ON_B: "end_arc_on_B", "mm", "highest contact on B, arc from the form point" => or(&[NO_FORM_POINT]);
    IN_CONTACT: "positions_in_contact", "1", "positions at which the flank is within the marking thickness";
    FIRST: "positions_first", "1", "positions at which the flank touches first";
}

rows! {
    /// All positions of a period.
    POSITIONS: "positions", "Every position of a period",
        "columns of transmission_error.positions, the side of the flanks after the key";

    ANGLE_OF_A: "angle_of_A", "deg", "angle of gear A";
    ANGLE_OF_B: "angle_of_B", "deg", "angle of gear B by the pitch curves";
    RATIO_ASKED: "ratio_asked_for", "1", "ratio of the speeds by the pitch curves: r2 / r1";
    RATIO_ACHIEVED: "ratio_achieved", "1",
        "ratio of the speeds by the driving flanks, between neighbouring positions";
    ERROR: "transmission_error", "arcsec",
        "rotation of B beyond that of the pitch curves when this side touches" => curve();
    ERROR_AT_PITCH_POINT: "transmission_error_at_pitch_point", "um",
        "transmission error times r2, across the line of centres";
    LONG_WAVE: "long_wave", "arcsec", "waves of the transmission error longer than two teeth";
    MESH: "mesh", "arcsec", "transmission error without its waves longer than two teeth";
    TOOTH_OF_A: "tooth_of_A", "1", "tooth of A that touches first";
    TOUCHING: "touching", "", "what touches: a flank, or a tip corner or fillet of A or B";
    PAIRS: "pairs", "1", "pairs of flanks within the marking thickness";
    PLAY_ANGLE: "backlash_angle", "arcsec", "play of B while A is held";
    PLAY: "backlash_circumferential", "um", "play across the line of centres at the pitch point" => curve();
    PLAY_TANGENTIAL: "backlash_along_pitch_curves", "um", "play along the pitch curves";
    GAP_RIGHT: "backlash_normal_right", "um", "gap of the right flanks while the left ones touch, along their normal";
    GAP_LEFT: "backlash_normal_left", "um", "gap of the left flanks while the right ones touch, along their normal";
}
