//! Columns of comparisons.

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[&COMPARISON, &COMPARED_SURFACES];

/// No difference and no ratio.
pub const NOT_OF_BOTH: &str = "one of both has no such number";

rows! {
    /// Results side by side.
    COMPARISON: "comparison", "Results side by side", "columns of comparison.csv; its first row has the names";

    PATH: "quantity", "", "path of the quantity in results.json; its key in headline";
    UNIT: "unit", "", "unit of the quantity";
    VALUE_OF_RESULT: "value", "", "value of the result whose letter is the key";
    DIFFERENCE_TO_FIRST: "difference", "that of the row",
        "value of the result less that of the first" => or(&[NOT_OF_BOTH]);
    RATIO_TO_FIRST: "ratio", "1", "value of the result over that of the first" => or(&[NOT_OF_BOTH]);
    DEFINITION: "definition", "", "definition of the quantity";
    FIGURE_OF_FLANK: "figure", "um", "figure of ISO 1328-1 of the worst flank, with its sign" => shown();
}

rows! {
    /// Parameters of two surfaces side by side.
    COMPARED_SURFACES: "surfaces", "Surfaces side by side",
        "columns of comparison.csv of two surfaces, beside their parameters";

    LESS: "second_less_first", "that of the row",
        "value of the second surface less that of the first" => or(&[NOT_OF_BOTH]);
    OVER: "second_over_first", "1", "value of the second surface over that of the first" => or(&[NOT_OF_BOTH]);
}
