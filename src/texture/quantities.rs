//! Quantities of texture windows; parameters of surfaces and profiles have their definitions in
//! [`crate::measure::topography`].

use crate::findings::quantities::surfaces::NO_HEIGHT;
use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[&TEXTURE, &WINDOW, &ABBOTT, &ROUGHNESS];

rows! {
    /// Windows of all operations.
    TEXTURE: "texture", "Surface texture (ISO 25178-2)", "texture.<operation>.<window>, the place of the window";

    CENTER_PROFILE: "center_profile", "mm",
        "middle of the window as arc along the profile from the start of the involute, in the section in the middle of \
         the face";
    CENTER_LEAD: "center_lead", "mm", "middle of the window along the tooth from the middle of the face";
    LENGTH_PROFILE: "length_profile", "mm", "length of the window along the profile";
    LENGTH_LEAD: "length_lead", "mm", "length of the window along the tooth";
    SPACING_PROFILE: "spacing_profile", "um", "distance of points along the profile, uniform in arc length";
    SPACING_LEAD: "spacing_lead", "um", "distance of points along the tooth";
    FILES: "files", "", "files of the window without their endings, in the output folder";
}

rows! {
    /// What is in a window.
    WINDOW: "window", "Marks in a window", "texture.<operation>.<window>";

    MARKS_ALONG_PROFILE: "marks_along_profile", "marks",
        "facets that follow each other along the profile in the middle of the window";
    MARKS_ALONG_TOOTH: "marks_along_tooth", "marks",
        "facets that follow each other along the tooth in the middle of the window; 0: the axes rest during strokes, \
         marks run along the tooth without end";
    CHAIN: "chain", "", "what was done before the evaluation, step by step";
}

/// Parameters of a window, under the symbols of the standard.
pub static PARAMETERS: QuantityGroup = QuantityGroup {
    key: "parameters",
    title: "Parameters",
    place: "texture.<operation>.<window>.parameters",
    rows: &[],
};

rows! {
    /// Material ratio curve with the construction of the Sk family.
    ABBOTT: "abbott", "Material ratio curve", "texture.<operation>.<window>.abbott; columns of its curve";

    WINDOW_PERCENT: "window_percent", "%", "where the 40 % window of the construction begins";
    UPPER: "upper_um", "um", "equivalent line at 0 %, by least squares in the 40 % window";
    LOWER: "lower_um", "um", "equivalent line at 100 %, by least squares in the 40 % window";
    CURVE_HEIGHT: "height", "um", "height over the mean plane at the areal material ratio" => or(&[NO_HEIGHT]);
}

rows! {
    /// Roughness of the lines across a window; its other parameters have the symbols of ISO 21920-2.
    ROUGHNESS: "roughness", "Roughness of profiles (ISO 21920)", "roughness.<operation>.<window and direction>";

    DIRECTION: "direction", "", "which way the lines run";
    WINDOW_OF_LINES: "window", "", "window that the lines cross";
    RA: "Ra", "um", "arithmetical mean height of the profile, mean of the lines"
        => titled("Ra"), symbol("Ra"), source(ISO_21920), shown();
    RZ: "Rz", "um", "mean of the heights of the sections, mean of the lines"
        => titled("Rz"), symbol("Rz"), source(ISO_21920), shown();
    RA_LARGEST: "Ra_largest", "um", "largest Ra of the lines" => titled("Ra at most"), shown();
    RZ_LARGEST: "Rz_largest", "um", "largest Rz of the lines" => titled("Rz at most"), shown();
    CUTOFF: "cutoff", "mm", "cut-off: nesting index of the profile L-filter"
        => titled("cut-off"), symbol("λ_c"), source(ISO_21920), shown();
    EVALUATION_LENGTH: "evaluation_length", "mm", "evaluation length" => symbol("l_e"), source(ISO_21920);
    LINES: "lines", "1", "lines, evenly over the window";
    CHAIN_OF_LINES: "chain", "", "what was done to the lines, step by step";
    RA_LIMIT: "Ra_limit", "", "whether the largest Ra of the lines keeps the drawing's limit";
    RZ_LIMIT: "Rz_limit", "", "whether the largest Rz of the lines keeps the drawing's limit";
}

/// Standard of the parameters of profiles.
const ISO_21920: &str = "ISO 21920-2";
