//! Quantities of studies: what parameters do to kept quantities.

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[&STUDY, &MAP];

/// No height on a map.
pub const NO_PASS_THERE: &str = "no pass came to the place";
/// No total share.
pub const NO_TOTAL: &str =
    "the quantity is the same in all cases, or no cases differ in this parameter alone: the design is no sobol_pairs";
/// No share.
pub const NO_SHARE: &str = "the quantity is the same in all cases, or no value of the parameter comes again";

rows! {
    /// What a study found.
    STUDY: "study", "Study", "headline; columns of the tables of study";

    CASES: "cases", "cases", "cases of the study";
    FAILED: "failed_cases", "cases", "cases that could not be made; the rows say why" => titled("failed");
    CASE: "case", "1", "number of the case, from 0";
    QUANTITY: "quantity", "", "kept quantity, by its path in results.json";
    FIRST_ORDER: "first_order_share", "%",
        "share of the quantity's variance over all cases that the parameter makes alone; exact of a whole grid, else \
         below 0 by chance"
        => titled("share of the variance"), symbol("S_i"), source("Sobol 1993"), or(&[NO_SHARE]);
    FIRST_ORDER_LOW: "first_order_low", "%", "lower end of the share's 95 % interval" => or(&[NO_SHARE]);
    FIRST_ORDER_HIGH: "first_order_high", "%", "upper end of the share's 95 % interval" => or(&[NO_SHARE]);
    TOTAL: "total_share", "%",
        "share of the quantity's variance that the parameter makes alone and together with others"
        => titled("total share of the variance"), symbol("S_Ti"), source("Sobol 1993, estimated after Jansen 1999"),
        or(&[NO_TOTAL]);
    TOTAL_LOW: "total_low", "%", "lower end of the total share's 95 % interval" => or(&[NO_TOTAL]);
    TOTAL_HIGH: "total_high", "%", "upper end of the total share's 95 % interval" => or(&[NO_TOTAL]);
    SWING: "swing", "that of the row", "largest less smallest mean of the quantity along the parameter";
    AT: "at", "", "value of the parameter, or the mean of several neighbouring ones";
    MEAN: "mean", "that of the row", "mean of the quantity there";
    PART_CASES: "part_cases", "cases", "cases with that value, or with those";
    TIME: "time", "s", "the first kept quantity that is a time";
    VALUE: "value", "that of the row", "kept quantity of a case that no other case betters in time and size together";
    MISSING_CASES: "missing_cases", "cases", "cases without a value of the quantity for the reason of the row";
    WHY: "why", "", "reason for which there is no value";
}

rows! {
    /// Maps that a study keeps.
    MAP: "map", "Maps of flanks", "map.tooth_<tooth>_<flank> of the cases of a study, under the numbers of the places";

    MAP_HEIGHT: "height", "um",
        "normal deviation of the finished flank from its target; places evenly over the evaluated part of the profile \
         and over the face without a twentieth at either end"
        => or(&[NO_PASS_THERE]);
}
