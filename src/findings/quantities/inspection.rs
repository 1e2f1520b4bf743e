//! Quantities of the inspection against limits.

use super::flanks::ISO_1328;
use crate::findings::rows;

/// A class finer than no figure.
pub const BEYOND: &str = "a figure is beyond class 11";
/// No figure.
pub const NOT_MEASURED: &str =
    "it was not measured: a flank was not cut completely, is cut away, or does not cross the pitch curve";
/// No figure of a side.
pub const OF_BOTH_SIDES: &str = "it was not measured, or the figure is one of both sides";
/// No tooth of a figure.
pub const OF_ALL_TEETH: &str = "the figure is one of all teeth, or was not measured";
/// No limit.
pub const NO_LIMIT: &str = "no limit was given";

rows! {
    /// Class, and the figure that is nearest to its limit.
    QUALITY: "quality", "Quality", "headline";

    CLASS_REACHED: "class_reached", "",
        "finest flank tolerance class that all figures of the traces keep, and whether all limits are kept; damage \
         beside the traces changes neither; the section inspection has both"
        => source(ISO_1328);
    LARGEST_OF_LIMIT: "largest_of_limit", "%",
        "largest share of its limit that a figure takes; the section inspection has all of them"
        => titled("largest share of a limit");
}

rows! {
    /// Figures against limits.
    INSPECTION: "inspection", "Inspection against limits", "inspection";

    CLASS: "class", "1",
        "finest flank tolerance class that all figures keep; the target is the ideal flank of the last operation, so \
         that \
         the deviations are those of this process by itself"
        => titled("flank tolerance class reached"), source(ISO_1328), shown(), or(&[BEYOND, NOT_MEASURED]);
    VERDICT: "verdict", "", "whether all figures keep their limits: pass or fail; not judged without limits"
        => titled("limits");
}

rows! {
    /// Places of charts: those of an inspection, and those that a gear was measured at.
    CHARTS: "charts", "Places of charts", "columns of inspection_charts.csv, and of the places of a calibration";

    CHART: "chart", "", "profile, helix or pitch; places: loose ones";
    CHART_U: "u", "mm", "arc along the profile from the form point" => or(&[OF_PITCH]);
    CHART_V: "v", "mm", "place along the tooth from the middle of the face" => or(&[OF_PITCH]);
    CHART_DEVIATION: "deviation", "um",
        "normal deviation from the target, of pitch the arc of the pitch curve; positive where material is";
}

/// No place of a pitch.
pub const OF_PITCH: &str = "pitch is taken on the pitch curve, in the middle of the face";

rows! {
    /// The table of figures.
    FIGURES: "figures", "Figures and limits", "columns of inspection.figures";

    FIGURE: "figure", "", "symbol of the figure" => source(ISO_1328);
    NAME: "name", "", "figure in words";
    LEFT: "left", "um", "value of the worst left flank; of both sides together for runout" => or(&[OF_BOTH_SIDES]);
    LEFT_TOOTH: "left_tooth", "1", "tooth of the worst left flank" => or(&[OF_ALL_TEETH]);
    RIGHT: "right", "um", "value of the worst right flank" => or(&[OF_BOTH_SIDES]);
    RIGHT_TOOTH: "right_tooth", "1", "tooth of the worst right flank" => or(&[OF_ALL_TEETH]);
    FIGURE_LIMIT: "limit", "um",
        "limit of the magnitude; on a helical round gear times cos(beta_b), as deviations are taken along the normal"
        => or(&[NO_LIMIT]);
    LIMIT_SOURCE: "source", "", "source of the limit: drawing, or class; none";
    FIGURE_CLASS: "class", "", "finest class that allows the worst value; beyond 11; none where there is no class";
    FIGURE_VERDICT: "verdict", "", "verdict on the figure: pass, fail, not judged";
}
