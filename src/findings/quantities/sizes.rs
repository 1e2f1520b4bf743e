//! Sizes of a round gear, as its drawing has them.

use crate::findings::rows;

/// Source of the sizes.
pub const ISO_21771: &str = "ISO 21771:2007";
/// No rack in a ring.
pub const NO_RACK: &str = "no rack runs in a ring: name measure.profile_start_height_mm";
/// No vernier in a ring.
pub const NO_VERNIER: &str = "no vernier fits into a ring";

rows! {
    /// Sizes of a round gear.
    SIZES: "round_gear", "Sizes of the round gear", "round_gear";

    REFERENCE_DIAMETER: "reference_diameter", "mm", "reference diameter: number of teeth times the transverse module"
        => symbol("d"), source(ISO_21771);
    BASE_DIAMETER: "base_diameter", "mm", "diameter of the circle from which the involute unrolls"
        => symbol("d_b"), source(ISO_21771);
    TIP_DIAMETER: "tip_diameter", "mm", "tip diameter of the blank" => symbol("d_a"), source(ISO_21771);
    ROOT_DIAMETER: "root_diameter", "mm", "root diameter that the tip of the finishing tool generates"
        => symbol("d_f"), source(ISO_21771);
    FORM_DIAMETER: "form_diameter", "mm", "diameter at which the involute begins, middle of the face"
        => symbol("d_Ff"), source(ISO_21771);
    TIP_FORM_DIAMETER: "tip_form_diameter", "mm", "diameter at which the involute ends, middle of the face"
        => symbol("d_Fa"), source(ISO_21771);
    ACTIVE_DIAMETER: "active_diameter", "mm",
        "start of the active profile: by measure.profile_start_height_mm, else with a rack as mate; no external mate \
         of \
         this rack begins lower"
        => symbol("d_Nf"), source(ISO_21771), or(&[NO_RACK]);
    ACTIVE_TIP_DIAMETER: "active_tip_diameter", "mm",
        "end of the active profile: by measure.profile_end_height_mm, else the end of the involute"
        => symbol("d_Na"), source(ISO_21771);
    PROFILE_SHIFT: "profile_shift", "1", "profile shift over the normal module" => symbol("x"), source(ISO_21771);
    GENERATING_SHIFT: "generating_profile_shift", "1",
        "generating profile shift of the target's thickness on the reference circle, allowance and offset of the last \
         operation included"
        => symbol("x_E"), source(ISO_21771);
    TIP_CLEARANCE: "tip_clearance", "mm",
        "distance from the root of this gear to the tip of a mate of the same rack and opposite shift, without backlash"
        => symbol("c"), source(ISO_21771);
    THICKNESS: "thickness", "mm", "thickness of the target's teeth, transverse arc of the reference circle"
        => symbol("s_t"), source(ISO_21771);
    CHORDAL_THICKNESS: "chordal_thickness", "mm",
        "chord of a tooth of the target at the reference circle, normal section"
        => symbol("s_c"), source(ISO_21771), or(&[NO_VERNIER]);
    CHORDAL_HEIGHT: "chordal_height", "mm", "height of the tip circle over the middle of that chord, normal section"
        => symbol("h_c"), source(ISO_21771), or(&[NO_VERNIER]);
    BALL_DIAMETER: "ball_diameter", "mm", "diameter of the balls or pins of the dimension over two of them"
        => symbol("D_M"), source(ISO_21771);
    SPAN_TEETH: "span_teeth", "1", "teeth of the span, or spaces in a ring" => symbol("k"), source(ISO_21771);
    SPAN: "span", "mm", "span of the target over k teeth, or across k spaces in a ring"
        => symbol("W_k"), source(ISO_21771);
    OVER_BALLS: "over_balls", "mm",
        "dimension of the target over two balls in opposite spaces, between them in a ring, or in those nearest to it"
        => symbol("M_d"), source(ISO_21771);
    THICKNESS_AS_CUT: "thickness_as_cut", "mm", "mean thickness of all teeth as cut, middle of the face"
        => symbol("s_t"), source(ISO_21771);
    GENERATING_SHIFT_AS_CUT: "generating_profile_shift_as_cut", "1",
        "generating profile shift of the mean thickness as cut"
        => symbol("x_E"), source(ISO_21771);
    SPAN_AS_CUT: "span_as_cut", "mm", "span of the mean thickness as cut; feed marks where it touches are not in it"
        => symbol("W_k"), source(ISO_21771);
    OVER_BALLS_AS_CUT: "over_balls_as_cut", "mm",
        "dimension over balls, in a ring between them, of the mean thickness as cut, without feed marks"
        => symbol("M_d"), source(ISO_21771);
}
