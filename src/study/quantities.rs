//! Quantities of studies: what parameters do to kept quantities.

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[&STUDY];

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
        "share of the quantity's variance over all cases that the parameter makes alone; below 0 by chance"
        => titled("share of the variance"), symbol("S_i"), source("Sobol 1993"), or(&[NO_SHARE]);
    FIRST_ORDER_LOW: "first_order_low", "%", "lower end of the share's 95 % interval" => or(&[NO_SHARE]);
    FIRST_ORDER_HIGH: "first_order_high", "%", "upper end of the share's 95 % interval" => or(&[NO_SHARE]);
    SWING: "swing", "that of the row", "largest less smallest mean of the quantity along the parameter";
    AT: "at", "", "value of the parameter, or the mean of several neighbouring ones";
    MEAN: "mean", "that of the row", "mean of the quantity there";
    PART_CASES: "part_cases", "cases", "cases with that value, or with those";
    TIME: "time", "s", "the first kept quantity that is a time";
    VALUE: "value", "that of the row", "kept quantity of a case that no other case betters in time and size together";
}
