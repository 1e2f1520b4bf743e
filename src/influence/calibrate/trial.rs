//! What is cut again and again while keys are fitted: a scene with shifted parameters, and all that was measured of it.
//!
//! In: shifts. Out: predicted values in the order of the measured ones: numbers, then the lines of charts place by
//! place, without what a measuring machine adds to them ([`crate::influence::charts`]). Only what the measured values
//! ask for is cut: texture windows, places of charts, or the whole gear.

use super::Calibrated;
use super::measured::{MeasuredGear, MeasuredNumber};
use crate::backend::Choice;
use crate::influence::charts::LaidCharts;
use crate::influence::derivative::read;
use crate::influence::known_cuts::{KnownCuts, digest};
use crate::influence::numbers::{Numbers, numbers, of_window, texture_numbers};
use crate::interrupt::Interrupt;
use crate::process::{self, ProcessJob};
use crate::progress::ProgressStep;
use crate::scene::LoadedScene;
use crate::scene::error_parameters::{ErrorParameter, Shifted};
use crate::scene::suggest::did_you_mean;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;

/// A scene that is cut with shifted parameters.
pub(super) struct Trial<'a> {
    loaded: &'a LoadedScene,
    parameters: &'a [ErrorParameter],
    measured: &'a MeasuredGear,
    /// Lines of charts, and the scene made ready for them.
    charts: Option<(LaidCharts, Box<dyn ProcessJob>)>,
    /// Flanks of the texture windows, where numbers of them are all that is asked for.
    windows: Option<Vec<(u32, Side)>>,
    /// Measured values, as predicted ones come.
    values: Vec<f64>,
    uncertainties: Vec<f64>,
    choice: &'a Choice,
    known: &'a KnownCuts,
    /// What is asked of every cut.
    asked: String,
    interrupt: &'a Interrupt,
    cuts: &'a ProgressStep<'a>,
}

impl<'a> Trial<'a> {
    /// Everything that stays as it is.
    ///
    /// # Errors
    /// Places that the gear does not have.
    pub fn new(
        loaded: &'a LoadedScene,
        parameters: &'a [ErrorParameter],
        measured: &'a MeasuredGear,
        (choice, known): (&'a Choice, &'a KnownCuts),
        interrupt: &'a Interrupt,
        cuts: &'a ProgressStep<'a>,
    ) -> Result<Self> {
        let mut charts = None;
        if !measured.lines.is_empty() {
            let ready = process::prepare(&loaded.scene)?;
            let mut laid = None;
            ready.with_gear(&mut |gear| {
                laid = Some(LaidCharts::new(gear, &measured.lines)?);
                Ok(())
            })?;
            charts = laid.zip(Some(ready));
        }
        let mut values: Vec<f64> = measured.numbers.iter().map(|number| number.value).collect();
        let mut uncertainties: Vec<f64> = measured.numbers.iter().map(|number| number.uncertainty).collect();
        for (index, line) in measured.lines.iter().enumerate() {
            let um: Vec<f64> = line.points.iter().map(|point| point.deviation_um).collect();
            values.extend(charts.iter().flat_map(|(charts, _): &(LaidCharts, _)| charts.known(index, &um)));
        }
        uncertainties.resize(values.len(), measured.noise_um);
        let windows = measured.numbers.iter().map(|number| flank_of(&number.quantity)).collect();
        let asked = digest(&("measured", measured, choice.backend.name()));
        Ok(Self {
            loaded,
            parameters,
            measured,
            charts,
            windows,
            values,
            uncertainties,
            choice,
            known,
            asked,
            interrupt,
            cuts,
        })
    }

    /// Shifted parameters; `None` where the scene has no word for them.
    pub fn shifted(&self, shifts: &[f64]) -> Option<Shifted<'_>> {
        let mut shifted = Shifted::new(self.loaded);
        let all = self.parameters.iter().zip(shifts).all(|(parameter, &by)| shifted.shift(parameter, by));
        all.then_some(shifted)
    }

    /// Whether the scene may have these shifts: every key stays in its range.
    fn is_scene(&self, shifts: &[f64]) -> bool {
        self.shifted(shifts).is_some_and(|shifted| read(&shifted).is_ok())
    }

    /// Whether a parameter is at the end of its range in the direction of a step.
    pub fn is_at_end(&self, shifts: &[f64], index: usize, step: f64) -> bool {
        let mut further = shifts.to_vec();
        further[index] += AT_END * step;
        step != 0.0 && !self.is_scene(&further)
    }

    /// Shifts as far as the scene may have them on the way from ones that it may have: first parameter by parameter,
    /// then all together, for a size of two parts has one range.
    pub fn within(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let reached: Vec<f64> = (0..from.len())
            .map(|index| {
                let at = |share: f64| {
                    let mut alone = from.to_vec();
                    alone[index] += share * (to[index] - from[index]);
                    alone
                };
                at(furthest(|share| self.is_scene(&at(share))))[index]
            })
            .collect();
        let at = |share: f64| from.iter().zip(&reached).map(|(a, b)| a + share * (b - a)).collect::<Vec<f64>>();
        at(furthest(|share| self.is_scene(&at(share))))
    }

    /// Predicted values; `None` where the scene may not have the shifts, or its gear cannot be cut with them.
    pub fn predicted(&self, shifts: &[f64]) -> Result<Option<Vec<f64>>> {
        self.interrupt.check()?;
        let Some(scene) = self.shifted(shifts).and_then(|shifted| read(&shifted).ok()) else { return Ok(None) };
        let values = match self.known.all_of(&scene.scene, &self.asked, || self.cut(&scene)) {
            // What is refused of the scene as it is no shift can mend.
            Err(Error::Scene(_) | Error::Refused(_)) if shifts.iter().any(|&shift| shift != 0.0) => return Ok(None),
            other => other?,
        };
        self.cuts.advance(1);
        Ok(Some(values))
    }

    /// Cuts what the measured values ask for.
    fn cut(&self, scene: &LoadedScene) -> Result<Vec<f64>> {
        let mut values = Vec::new();
        if !self.measured.numbers.is_empty() {
            let found = match &self.windows {
                Some(flanks) => texture_numbers(scene, flanks, self.choice, self.interrupt)?,
                None => numbers(scene, self.choice, self.interrupt)?,
            };
            for measured in &self.measured.numbers {
                values.push(value_of(&found, measured)?);
            }
        }
        if let Some((charts, ready)) = &self.charts {
            let job = ready.with_errors_of(&scene.scene)?;
            values.extend(charts.predicted_um(job.as_ref(), self.choice.backend.as_ref())?.concat());
        }
        Ok(values)
    }

    /// Residuals over the uncertainties.
    pub fn residuals(&self, predicted: &[f64]) -> Vec<f64> {
        let off = self.values.iter().zip(predicted).map(|(measured, predicted)| measured - predicted);
        off.zip(&self.uncertainties).map(|(off, uncertainty)| off / uncertainty).collect()
    }

    /// Derivatives of the predicted values by one parameter, for a natural step, over the uncertainties.
    pub fn column(&self, shifts: &[f64], here: &[f64], index: usize) -> Result<Vec<f64>> {
        let step = self.parameters[index].step;
        let at = |by: f64| {
            let mut moved = shifts.to_vec();
            moved[index] += by;
            self.predicted(&moved)
        };
        let (above, below) = (at(step)?, at(-step)?);
        if above.is_none() && below.is_none() {
            let ErrorParameter { id, unit, .. } = &self.parameters[index];
            let problem = format!("{id} can be shifted by {step} {unit} to neither side of where it is");
            return Err(Refusal::new("--fit", problem, "leave it out of the fit").into());
        }
        let width = f64::from(u8::from(above.is_some()) + u8::from(below.is_some()));
        let (above, below) = (above.unwrap_or_else(|| here.to_vec()), below.unwrap_or_else(|| here.to_vec()));
        let rows = above.iter().zip(&below).zip(&self.uncertainties);
        Ok(rows.map(|((a, b), uncertainty)| (a - b) / width.max(1.0) / uncertainty).collect())
    }

    /// Values that say anything: of every line one is taken by what the measuring machine adds.
    pub fn count(&self) -> usize {
        self.values.len() - self.measured.lines.len()
    }

    /// Measured values with those that the scene predicts and those of the fitted one.
    pub fn compared(&self, before: &[f64], after: &[f64]) -> Vec<Calibrated> {
        let one = |i: usize| Calibrated { measured: self.values[i], predicted: before[i], fitted: after[i] };
        (0..self.values.len()).map(one).collect()
    }
}

/// A parameter is at the end of its range where it cannot go this share of a step further.
const AT_END: f64 = 1e-3;
/// The end of a range is found to this share of a step: well below [`AT_END`].
const END_FOUND: f64 = 1e-5;

/// The largest share of a step, up to 1, that is allowed; nothing is.
fn furthest(is_allowed: impl Fn(f64) -> bool) -> f64 {
    if is_allowed(1.0) {
        return 1.0;
    }
    let [mut low, mut high] = [0.0, 1.0];
    while high - low > END_FOUND {
        let middle = 0.5 * (low + high);
        if is_allowed(middle) { low = middle } else { high = middle }
    }
    low
}

/// The flank of a texture window by the path of one of its numbers.
fn flank_of(quantity: &str) -> Option<(u32, Side)> {
    let window = of_window(quantity)?.0.split('.').nth(1)?;
    let mut parts = window.strip_prefix("tooth_")?.split('_');
    let tooth = parts.next()?.parse().ok()?;
    let side = parts.next()?;
    [Side::Left, Side::Right].into_iter().find(|known| known.name() == side).map(|side| (tooth, side))
}

fn value_of(found: &Numbers, measured: &MeasuredNumber) -> Result<f64, Refusal> {
    found.get(&measured.quantity).map(|(value, _)| *value).ok_or_else(|| {
        Refusal::new(
            "--measured",
            format!(
                "`{}` is no number of this scene's results{}",
                measured.quantity,
                did_you_mean(found.keys().map(String::as_str), &measured.quantity)
            ),
            "name numbers by their paths in results.json, those of its headline as headline.KEY; `gearcut cut SCENE \
             --only numbers` writes one",
        )
    })
}
