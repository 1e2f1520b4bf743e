//! Quantities of a bevel gear and its pinion in contact.

use crate::findings::rows;

/// No contact.
pub const PARTED: &str = "the teeth part there";
/// No ellipse.
pub const AT_EDGE: &str = "the contact is at an edge of the flank";
/// No long axis.
pub const ALONG_LINE: &str = "the flanks touch along a line";
/// No parabola.
pub const TOO_FEW_PLACES: &str = "one pair of teeth carries at fewer than three places in a row";
/// A trend of an angle.
pub const OF_ANGLE: &str = "the error is an angle";
/// A trend of a length.
pub const OF_LENGTH: &str = "the error is a length";

rows! {
    /// The pair as it is mounted.
    PAIR: "pair", "Pair", "pair of a bevel pair";

    GEAR: "gear", "", "scene of the gear";
    PINION: "pinion", "", "scene of the pinion";
    TEETH_OF_GEAR: "teeth_of_gear", "teeth", "number of teeth of the gear" => symbol("z_2");
    TEETH_OF_PINION: "teeth_of_pinion", "teeth", "number of teeth of the pinion" => symbol("z_1");
    OUTER_MODULE: "outer_module", "mm", "outer transverse module" => symbol("m_et");
    SHAFT_ANGLE: "shaft_angle", "deg", "nominal shaft angle" => symbol("Σ");
    HYPOID_OFFSET: "hypoid_offset", "mm", "nominal offset of both axes; 0 of spiral bevel gears" => symbol("a");
    OFFSET_ERROR: "offset_error", "mm", "E: offset of the pinion's axis (ISO 23509: hypoid offset a)" => symbol("E");
    PINION_AXIAL_ERROR: "pinion_axial_error", "mm", "P: pinion away from the apex (mounting distance t_B1)"
        => symbol("P");
    GEAR_AXIAL_ERROR: "gear_axial_error", "mm", "G: gear away from the apex (mounting distance t_B2)" => symbol("G");
    SHAFT_ANGLE_ERROR: "shaft_angle_error", "deg", "error of the shaft angle Sigma";
    MARKING: "marking", "um", "thickness of the marking compound of the ellipses";
}

rows! {
    /// Contact on one side.
    SIDE: "side", "Flanks of one side", "<side> of a bevel pair; headline, their keys before the side";

    MOTION_ERROR: "motion_error", "arcsec",
        "range over a pitch of how far the gear is ahead of a constant ratio, by the teeth that carry; 0 where it is \
         below two millionths of an arc second, the tolerance of the search";
    PARABOLA: "motion_error_parabola", "arcsec",
        "parabola through the motion error of one pair of teeth while it carries: how far it falls from its top to \
         half a pitch beside it, negative where the gear runs behind there in the sense in which these flanks drive"
        => or(&[TOO_FEW_PLACES]);
    CENTER_ALONG: "center_along", "mm",
        "mean place of one pair of teeth over a pitch about the middle of its mesh, along the gear's tooth, from the \
         middle of the face, positive towards the heel"
        => titled("contact along");
    CENTER_HEIGHT: "center_height", "mm", "the same as height over the gear's pitch cone";
    ELLIPSE_LENGTH: "ellipse_length", "mm",
        "length of the contact ellipse in the middle of a pitch, beyond the edges of the flank as well"
        => titled("ellipse"), or(&[ALONG_LINE, AT_EDGE]);
    HALF_LENGTH: "half_length", "mm", "long half axis of the ellipse in the middle of a pitch"
        => or(&[ALONG_LINE, AT_EDGE]);
    HALF_WIDTH: "half_width", "mm", "short half axis of the ellipse in the middle of a pitch"
        => or(&[ALONG_LINE, AT_EDGE]);
}

rows! {
    /// Contact of one pair of teeth.
    PATH: "path", "Contact of one pair of teeth", "columns of <side>.path of a bevel pair";

    PINION_ANGLE: "pinion_angle", "deg",
        "angle of the pinion about the middle of the mesh, growing as the pinion drives these flanks";
    ERROR_AT: "motion_error", "arcsec",
        "how far the gear is ahead of a constant ratio in that sense, one pair of teeth; negative behind"
        => or(&[PARTED]);
    ALONG: "along", "mm", "place along the gear's tooth, from the middle of the face, positive towards the heel"
        => or(&[PARTED]);
    HEIGHT: "height", "mm", "height of the place over the gear's pitch cone" => or(&[PARTED]);
    HALF_LENGTH_AT: "half_length", "mm", "long half axis of the contact ellipse" => or(&[AT_EDGE]);
    HALF_WIDTH_AT: "half_width", "mm", "short half axis of the contact ellipse" => or(&[AT_EDGE]);
}

rows! {
    /// What errors of the mounting do.
    TRENDS: "trends", "What errors of the mounting do", "columns of <side>.trends of a bevel pair";

    ERROR: "error", "", "error of the mounting, Gleason's letter";
    ISO_NAME: "iso_name", "", "name of the error in ISO 23509";
    ADDED: "added", "mm", "what was added to a length" => or(&[OF_ANGLE]);
    TURNED: "turned", "deg", "what was added to an angle" => or(&[OF_LENGTH]);
    ERROR_OF_TREND: "motion_error", "arcsec", "range of the motion error over a pitch" => or(&[PARTED]);
    MOVED_ALONG: "moved_along", "mm", "how far the contact moves along the gear's tooth, towards the heel"
        => or(&[PARTED]);
    MOVED_UP: "moved_up", "mm", "how far the contact moves towards the tip" => or(&[PARTED]);
}
