//! Quantities of teeth: pitch, runout, thickness, tips.

use super::flanks::ISO_1328;
use crate::findings::rows;

/// No place on the pitch curve.
pub const NOT_CROSSED: &str = "a flank was not cut, is cut away, or does not cross the pitch curve";
/// No thickness.
pub const NO_THICKNESS: &str =
    "no tooth crosses the pitch curve with both flanks, or nothing is left between the flanks";
/// Thickness of few teeth says nothing of the gear.
pub const MOST_GONE: &str = "most teeth are cut away";

rows! {
    /// Pitch, runout and thickness of teeth.
    TEETH: "teeth", "Teeth", "headline (the worst of all teeth); teeth.<tooth>; columns of teeth.all_teeth";

    SINGLE_PITCH: "f_p", "um",
        "single pitch deviation: largest magnitude of f_pi of either flank, arc of the pitch curve"
        => titled("single pitch deviation f_p"), symbol("f_p"), source(ISO_1328), or(&[NOT_CROSSED]);
    TOTAL_PITCH: "F_p", "um", "total cumulative pitch deviation: range of F_pi, the larger one of both flanks"
        => titled("total pitch deviation F_p"), symbol("F_p"), source(ISO_1328), or(&[NOT_CROSSED]);
    RUNOUT: "F_r", "um", "runout: range over all spaces of a probe's place along the pitch curve's normal"
        => titled("runout F_r"), symbol("F_r"), source(ISO_1328), or(&[NOT_CROSSED]);
    FLANK_PITCH: "f_pi", "um", "individual single pitch deviation: arc of the pitch curve from the tooth before, less \
         the mean pitch"
        => titled("single pitch deviation f_pi"), symbol("f_pi"), source(ISO_1328), or(&[NOT_CROSSED]);
    CUMULATIVE_PITCH: "F_pi", "um", "individual cumulative pitch deviation: arc of the pitch curve from tooth 1, less \
         its mean pitches"
        => titled("cumulative pitch deviation F_pi"), symbol("F_pi"), source(ISO_1328), or(&[NOT_CROSSED]);
    PROBE_PLACE: "runout_of_space_after", "um",
        "place of a probe in the space after the tooth along the pitch curve's normal, positive outwards"
        => symbol("r_i"), source(ISO_1328), or(&[NOT_CROSSED]);
    THICKNESS_ARC: "thickness_arc", "mm", "tooth thickness along the pitch curve" => symbol("s_t"), or(&[NOT_CROSSED]);
    THICKNESS_CHORD: "thickness_chord", "mm", "tooth thickness straight between its crossings with the pitch curve"
        => symbol("s_c"), or(&[NOT_CROSSED]);
    TOOTH: "tooth", "1", "number of the tooth, from 1";
    FLANK: "flank", "", "flank of the tooth: left or right";
    SMALLEST_THICKNESS: "smallest_tooth_thickness", "mm", "smallest tooth thickness, arc of the pitch curve"
        => titled("thinnest tooth, arc"), symbol("s_t"), or(&[NO_THICKNESS, MOST_GONE]);
    LARGEST_THICKNESS: "largest_tooth_thickness", "mm", "largest tooth thickness, arc of the pitch curve"
        => titled("thickest tooth, arc"), symbol("s_t"), or(&[NO_THICKNESS, MOST_GONE]);
}
