//! Quantities of errors and what they do: budgets, diagnoses, calibrations. A definition that begins with "predicted"
//! is of a simulation, one with "fitted" of a number that was chosen to agree with what was measured.

pub mod budget;
pub mod calibration;
pub mod diagnosis;

use crate::findings::{QuantityGroup, rows};

/// The groups of this table.
pub static QUANTITIES: &[&QuantityGroup] = &[
    &PARAMETERS,
    &budget::BUDGET,
    &budget::INFLUENCES,
    &budget::INFLUENCE_MAPS,
    &budget::INFLUENCE_ON_NUMBERS,
    &diagnosis::DIAGNOSIS,
    &diagnosis::SOURCES,
    &diagnosis::STANDING_OUT,
    &diagnosis::RESIDUALS,
    &calibration::CALIBRATION,
    &calibration::FITS,
    &calibration::MEASURED_NUMBERS,
    &calibration::MEASURED_LINES,
    &calibration::MEASURED_PLACES,
];

rows! {
    /// Parameters in the rows of tables.
    PARAMETERS: "parameters", "Errors as parameters", "columns of the tables of budgets, diagnoses and calibrations";

    PARAMETER: "parameter", "", "key of the error, and behind @ which part of it";
    ERROR: "error", "", "error in words";
    UNIT: "unit", "", "unit of the row's numbers";
    KIND: "kind", "", "fitted: a number that was chosen so that it explains the measured values";
}
