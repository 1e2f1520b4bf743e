//! Quantities of the inspection against limits.

use super::flanks::ISO_1328;
use crate::findings::rows;

rows! {
    /// Class, and the figure that is nearest to its limit.
    INSPECTION: "quality", "Quality", "headline";

    CLASS_REACHED: "class_reached", "",
        "finest flank tolerance class that all figures keep, and whether all limits are kept; the section inspection \
         has both"
        => source(ISO_1328);
    LARGEST_OF_LIMIT: "largest_of_limit", "%",
        "largest share of its limit that a figure takes; the section inspection has all of them"
        => titled("largest share of a limit");
}
