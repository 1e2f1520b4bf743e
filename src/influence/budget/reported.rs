//! What errors do to every number that a cut reports.
//!
//! In: a scene, a parameter, the scene's numbers. Out: by how much each number changes upwards and downwards. The two
//! differ where a number has a kink: a pitch deviation of an ideal gear grows with an eccentricity of either sign.

use crate::backend::Choice;
use crate::influence::derivative::read;
use crate::influence::known_cuts::{KnownCuts, digest};
use crate::influence::numbers::{Numbers, numbers};
use crate::interrupt::Interrupt;
use crate::output::growing::RowValues;
use crate::scene::LoadedScene;
use crate::scene::error_parameters::{ErrorParameter, Shifted};
use gearcut_core::error::Result;

/// Changes below this share of a number are rounding.
const ROUNDING: f64 = 1e-9;

/// What a parameter does to a number.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportedInfluence {
    /// Name of the parameter.
    pub parameter: String,
    /// Path of the number: `headline.KEY`, or that of `results.json`.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Its value in the scene as it is.
    pub value: f64,
    /// What it gains per unit of the parameter from there upwards; `None` where it vanishes.
    pub upwards: Option<f64>,
    /// What it gains per unit from below to there; `None` also where the scene has no word for less.
    pub downwards: Option<f64>,
}

/// Influences of a parameter on all numbers that change.
///
/// # Errors
/// The scene refuses the shifted value; geometry; the backend's; files; Ctrl-C.
pub fn reported(
    loaded: &LoadedScene,
    parameter: &ErrorParameter,
    before: &Numbers,
    (choice, known): (&Choice, &KnownCuts),
    interrupt: &Interrupt,
) -> Result<Vec<ReportedInfluence>> {
    let asked = digest(&("numbers", before.keys().collect::<Vec<_>>(), choice.backend.name()));
    // The numbers that the scene has, in their order, with the parameter shifted.
    let at = |by: f64| -> Result<Option<RowValues>> {
        let mut shifted = Shifted::new(loaded);
        if !shifted.shift(parameter, by) {
            return Ok(None);
        }
        let there = read(&shifted)?;
        let cut = || {
            let found = numbers(&there, choice, interrupt)?;
            Ok(before.keys().map(|path| Some(found.get(path)?.0)).collect())
        };
        known.of(&there.scene, &asked, cut).map(Some)
    };
    let (above, below) = (at(parameter.step)?, at(-parameter.step)?);
    let slope = |other: &Option<RowValues>, place: usize, value: f64, by: f64| {
        let change = other.as_ref()?[place]? - value;
        Some(if change.abs() > ROUNDING * value.abs().max(1.0) { change / by } else { 0.0 })
    };
    let influences = before.iter().enumerate().map(|(place, (path, (value, unit)))| ReportedInfluence {
        parameter: parameter.id.clone(),
        quantity: path.clone(),
        unit: unit.clone(),
        value: *value,
        upwards: slope(&above, place, *value, parameter.step),
        downwards: slope(&below, place, *value, -parameter.step),
    });
    let moves = |of: &ReportedInfluence| [of.upwards, of.downwards].into_iter().flatten().any(|slope| slope != 0.0);
    Ok(influences.filter(moves).collect())
}
