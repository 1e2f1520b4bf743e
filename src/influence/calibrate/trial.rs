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
use crate::output::progress::ProgressStep;
use crate::process::{self, ProcessJob};
use crate::scene::LoadedScene;
use crate::scene::error_parameters::{ErrorParameter, Shifted};
use gearcut_core::error::{Refusal, Result};
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

    /// The scene with shifted parameters; `None` where it has no word for them.
    pub fn shifted(&self, shifts: &[f64]) -> Option<Shifted<'_>> {
        let mut shifted = Shifted::new(self.loaded);
        let all = self.parameters.iter().zip(shifts).all(|(parameter, &by)| shifted.shift(parameter, by));
        all.then_some(shifted)
    }

    /// Predicted values; `None` where the scene has no word for the shifts.
    pub fn predicted(&self, shifts: &[f64]) -> Result<Option<Vec<f64>>> {
        self.interrupt.check()?;
        let Some(shifted) = self.shifted(shifts) else { return Ok(None) };
        let scene = read(&shifted)?;
        let values = self.known.all_of(&scene.scene, &self.asked, || self.cut(&scene))?;
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
            format!("`{}` is no number of this scene's results", measured.quantity),
            "name numbers by their paths in results.json, those of its headline as headline.KEY; `gearcut cut SCENE \
             --only numbers` writes one",
        )
    })
}
