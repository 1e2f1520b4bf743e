//! What a unit of an error adds to the heights of a gear: central differences of simulated cuts.
//!
//! In: a scene, places on its flanks, a parameter. Out: [`Influence`]: (h(p + s) - h(p - s)) / 2 s at every place, and
//! two checks: the same with half the step, and how much h bends between both sides. Where the scene has no word for p
//! - s (backlash below 0) the difference is taken forwards.

use crate::process;
use crate::scene::error_parameters::{ErrorParameter, Shifted};
use crate::scene::{LoadedScene, Scene, SceneErrors};
use gearcut_core::error::{Error, Result};

/// Differences up to this share of the largest influence are no matter: marks of strokes and the second order of
/// errors of usual size stay below.
const LINEAR_SHARE: f64 = 0.02;
/// Nor are differences of heights up to this, um: marks of strokes that come to stand elsewhere.
const LINEAR_UM: f64 = 0.05;

/// Heights of a scene's gear, um.
pub type HeightsOf<'a> = dyn Fn(&Scene) -> Result<Vec<f64>> + 'a;

/// The influence of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Influence {
    /// The parameter.
    pub parameter: ErrorParameter,
    /// What a unit of it adds at every place, um.
    pub um_per_unit: Vec<f64>,
    /// Whether the scene can only shift it upwards.
    pub upwards_only: bool,
    /// Largest difference from what half the step gives, um per unit; 0 until it is asked for.
    pub half_step_um: f64,
    /// Bend (h(p + s) - 2 h(p) + h(p - s)) / 2 s at every place, um per unit: how far both sides of the step are off a
    /// straight line; 0 where it is shifted upwards only.
    pub bends_um: Vec<f64>,
}

impl Influence {
    /// The influence of a parameter on a scene whose gear has the heights `before_um`.
    ///
    /// # Errors
    /// The scene refuses the shifted value; geometry; the backend's.
    #[cfg(feature = "testing")]
    pub fn new(
        loaded: &LoadedScene,
        grid: &super::gear_grid::GearGrid,
        before_um: &[f64],
        parameter: &ErrorParameter,
        backend: &dyn gearcut_core::cut::Backend,
    ) -> Result<Self> {
        let ready = process::prepare(&loaded.scene)?;
        let heights_um = |scene: &Scene| grid.heights_of_um(ready.with_errors_of(scene)?.as_ref(), backend);
        Self::by(loaded, before_um, parameter, &heights_um)
    }

    /// The same where `heights_um` gives the heights of a scene's gear.
    ///
    /// # Errors
    /// The scene refuses the shifted value; those of `heights_um`.
    pub fn by(
        loaded: &LoadedScene,
        before_um: &[f64],
        parameter: &ErrorParameter,
        heights_um: &HeightsOf,
    ) -> Result<Self> {
        let step = parameter.step;
        let above = shifted_um(loaded, parameter, step, heights_um)?.unwrap_or_default();
        let half_step_um = 0.0;
        let parameter = parameter.clone();
        let Some(below) = shifted_um(loaded, &parameter, -step, heights_um)? else {
            let um_per_unit = above.iter().zip(before_um).map(|(a, b)| (a - b) / step).collect();
            let bends_um = vec![0.0; above.len()];
            return Ok(Self { parameter, um_per_unit, upwards_only: true, half_step_um, bends_um });
        };
        let um_per_unit = above.iter().zip(&below).map(|(a, b)| 0.5 * (a - b) / step).collect();
        let bends = above.iter().zip(before_um).zip(&below).map(|((a, now), b)| 0.5 * (a - 2.0 * now + b) / step);
        Ok(Self { parameter, um_per_unit, upwards_only: false, half_step_um, bends_um: bends.collect() })
    }

    /// The same, compared with what half the step gives.
    ///
    /// # Errors
    /// The scene refuses the shifted value; those of `heights_um`.
    pub fn checked(self, loaded: &LoadedScene, before_um: &[f64], heights_um: &HeightsOf) -> Result<Self> {
        let halved = self.parameter.clone().with_step(0.5 * self.parameter.step);
        let half = Self::by(loaded, before_um, &halved, heights_um)?;
        let half_step_um = largest(self.um_per_unit.iter().zip(&half.um_per_unit).map(|(a, b)| a - b));
        Ok(Self { half_step_um, ..self })
    }

    /// Largest influence, um per unit.
    pub fn largest_um(&self) -> f64 {
        largest(self.um_per_unit.iter().copied())
    }

    /// Largest bend, um per unit.
    pub fn bend_um(&self) -> f64 {
        largest(self.bends_um.iter().copied())
    }

    /// Whether twice the error does twice as much: neither half the step nor the other side says otherwise.
    pub fn is_linear(&self) -> bool {
        let allowed_um = (LINEAR_SHARE * self.largest_um()).max(LINEAR_UM / self.parameter.step);
        self.half_step_um <= allowed_um && self.bend_um() <= allowed_um
    }
}

/// Heights with a parameter shifted, um; `None` where the scene has no word for it.
fn shifted_um(
    loaded: &LoadedScene,
    parameter: &ErrorParameter,
    by: f64,
    heights_um: &HeightsOf,
) -> Result<Option<Vec<f64>>> {
    let mut shifted = Shifted::new(loaded);
    if !shifted.shift(parameter, by) {
        return Ok(None);
    }
    heights_um(&read(&shifted)?.scene).map(Some)
}

/// The shifted scene; what it refuses is an error of the work.
///
/// # Errors
/// A value that the scene may not have.
pub fn read(shifted: &Shifted) -> Result<LoadedScene> {
    shifted.read(process::table()).map_err(|errors| Error::Scene(Box::new(errors)))
}

/// Largest size of the values that there are.
pub fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).filter(|value| value.is_finite()).fold(0.0, f64::max)
}

/// Why a scene or its gear is refused, in the words of the first problem alone.
///
/// # Errors
/// What is no refusal.
pub fn refusal(error: Error) -> Result<String> {
    match error {
        Error::Scene(errors) => Ok(match errors.downcast_ref::<SceneErrors>() {
            Some(SceneErrors { problems }) => problems.first().map_or_else(String::new, |first| first.message.clone()),
            None => errors.to_string(),
        }),
        Error::Refused(refusal) => Ok(refusal.problem),
        other => Err(other),
    }
}
