//! Units: everything inside is mm, rad, s and mm/s unless a name says otherwise (`_um`, `_deg`, `_nm`).

/// Micrometres in a millimetre.
pub const UM_PER_MM: f64 = 1e3;
/// Whole turn in radians.
pub const TURN_RAD: f64 = std::f64::consts::TAU;
