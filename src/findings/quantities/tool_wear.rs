//! Quantities of the wear of a tool's teeth.

use crate::findings::rows;

/// A place or a tool without chips.
pub const NO_CHIPS: &str = "nothing was cut there";
/// A constant without a range.
pub const NO_RANGE: &str = "no range of a constant is named, and none is fitted";

rows! {
    /// Wear of the tool's teeth.
    TOOL_WEAR: "tool_wear", "Wear of the tool's teeth",
        "tool_wear; columns of its tables, of the row's tooth or place of the edge";

    WEAR_LAW: "law", "", "law of the wear";
    UNKNOWN: "not_known", "", "what the wear does not know";
    WEAR_LIMIT: "limit", "mm", "width VB of the worn flank at which the tool is reground" => symbol("VB_lim");
    LIFE: "life", "m", "length of cut after which an edge is worn to the limit by chips of the reference thickness at \
        the reference speed"
        => titled("length of cut that an edge lasts"), symbol("L_1"), source("Taylor 1907");
    LIFE_SOURCE: "life_source", "", "where the length of cut that an edge lasts comes from";
    LIFE_FROM: "life_from", "m", "smallest length of cut that an edge lasts, through the ranges of the constants"
        => or(&[NO_RANGE]);
    LIFE_TO: "life_to", "m", "largest length of cut that an edge lasts, through the ranges of the constants"
        => or(&[NO_RANGE]);
    EXPONENT: "thickness_exponent", "1", "power of the chip thickness with which life falls" => symbol("x");
    EXPONENT_FROM: "thickness_exponent_from", "1", "smallest power of the chip thickness that is taken for possible"
        => or(&[NO_RANGE]);
    EXPONENT_TO: "thickness_exponent_to", "1", "largest power of the chip thickness that is taken for possible"
        => or(&[NO_RANGE]);
    THICKNESS: "reference_thickness", "um", "chip thickness for which the length of cut holds" => symbol("h_1");
    SPEED: "reference_speed", "m/min", "cutting speed for which the length of cut holds" => symbol("v_1");
    TAYLOR: "taylor_exponent", "1", "exponent of the time in Taylor's law" => symbol("n"), source("Taylor 1907");
    GEARS: "gears_to_limit", "gears", "gears until the first place of an edge is worn to the limit, the tool not moved \
        between them"
        => shown(), or(&[NO_CHIPS]);
    GEARS_FROM: "gears_to_limit_from", "gears", "fewest gears to the limit, through the ranges of the constants"
        => or(&[NO_RANGE]);
    GEARS_TO: "gears_to_limit_to", "gears", "most gears to the limit, through the ranges of the constants"
        => or(&[NO_RANGE]);
    FIRST_TOOTH: "first_tooth", "", "tool tooth that is worn to the limit first" => shown();
    FIRST_PLACE: "first_place", "",
        "place of its edge: the tip, or a quarter of the depth of a flank, 1 next to the tip; flanks of a hob by the \
         end that they face, entering or leaving, those of a shaper cutter as right and left";
    MEAN_THICKNESS: "mean_thickness", "um",
        "mean chip thickness over the length of cut: at the place that wears first, as a column at the row's place"
        => or(&[NO_CHIPS]);
    WORN_TEETH: "worn_teeth", "teeth", "teeth with a tenth of the limit or more when the first one has all of it";
    WORN_BAND: "worn_band", "", "first and last tooth with a tenth of the limit or more";
    EVEN_TEETH: "even_teeth", "teeth",
        "teeth with nine tenths of the limit or more when the first one has all of it";
    EVEN_BAND: "even_band", "", "first and last tooth with nine tenths of the limit or more";
    GEARS_IF_EVEN: "gears_if_even", "gears",
        "gears to the limit if all teeth wore alike: no shift of a hob lasts longer, and a shaper cutter lasts as \
         long where it is set on by a tooth after every gear";
    CUTTER_TOOTH: "cutter_tooth", "1", "number of the shaper cutter's tooth, from 0";
    WEAR: "wear", "um", "width VB of the worn flank when the first place of an edge has reached the limit: of a tooth \
        where it has the most, or at the row's place"
        => symbol("VB"), or(&[NO_CHIPS]), bars();
    WEAR_FROM: "wear_from", "um", "smallest wear, through the ranges of the constants" => or(&[NO_RANGE]);
    WEAR_TO: "wear_to", "um", "largest wear, through the ranges of the constants" => or(&[NO_RANGE]);
    WEAR_PER_GEAR: "wear_per_gear", "um", "width VB that one gear adds to the tooth where it has the most"
        => or(&[NO_CHIPS]);
    EDGE_PLACE: "edge_place", "",
        "place of the edge: the tip, or a quarter of the depth of a flank, 1 next to the tip; of a tooth the one that \
         wears most"
        => or(&[NO_CHIPS]);
}
