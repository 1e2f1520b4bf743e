//! A diagnosis by gears that are really cut with the errors it finds.
//!
//! In: cuts at the measured places, measured deviations and their noise. Out: [`Diagnosis`], and the model about the
//! gear that it found.
//!
//! **Law.** Gauss and Newton's method, with the choice of sources in every round: influences about the scene's gear
//! choose sources and sizes; the gear is cut with these, and so are both sides of a natural step of each named
//! parameter; about that gear all sources are chosen again. What was named for the wrong reason falls away then: a gear
//! that is cut with the right errors leaves noise, and noise names nothing. It ends where a round names the same
//! sources and moves no size by more than a share of its interval.
//!
//! Where the cut ends over its own beginning, the deeper of two strokes remains. A height is bent there as a knee, and
//! a difference over both sides of it is the mean of two slopes. The first fit goes without places that bend by more
//! than the noise; all later ones have them, for they start from heights that were cut.
//!
//! Where that leaves deviations unexplained, what stands out of the gear is looked for (`standing_out`), and the fit is
//! made again beside it.
//!
//! Road not taken: a damped step as calibrations have it. The choice of sources is no smooth function of the sizes, and
//! rounds that do not settle are said to the reader.

use super::{Diagnosis, ErrorModel, LinearFit, MeasuredCuts, Noise, Without, standing_out};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use gearcut_core::error::{Error, Result};

/// Most rounds of cuts; two or three are usual. A choice that goes round in a circle ends here.
const MOST_ROUNDS: usize = 12;
/// Sizes have settled where a round moves them by less than this share of half the interval of the named set.
const SETTLED: f64 = 0.1;

/// Explains measured deviations, um, at the places of `cuts`, by the errors with these names (all, if none is given),
/// with their noise.
///
/// # Errors
/// Those of [`ErrorModel::new`]; fewer places than parameters.
pub fn diagnose(
    cuts: &MeasuredCuts,
    measured_um: &[f64],
    noise: &Noise,
    names: &[String],
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<(ErrorModel, Diagnosis)> {
    let scene = ErrorModel::new(cuts, names, progress, interrupt)?;
    let explain = |scene: &ErrorModel| {
        let step = progress.step("fit", MOST_ROUNDS as u64, "rounds at most");
        let found = scene.explain(cuts, measured_um, noise, interrupt, &|| step.advance(1));
        step.finish();
        found
    };
    let (model, found) = explain(&scene)?;
    if found.unexplained_um == 0.0 || !model.complete {
        return Ok((model, found));
    }
    let standing_out = standing_out::find(&scene, cuts.points, measured_um, noise);
    if standing_out.is_empty() {
        return Ok((model, found));
    }
    explain(&ErrorModel { standing_out, ..scene.clone() })
}

impl ErrorModel {
    /// Explains measured deviations; `self` is the model about the scene. After Ctrl-C the diagnosis is that of the
    /// rounds that are done. `round_done` is called after each.
    ///
    /// # Errors
    /// Fewer places than parameters; geometry that cannot be cut; the backend's.
    pub fn explain(
        &self,
        cuts: &MeasuredCuts,
        measured_um: &[f64],
        noise: &Noise,
        interrupt: &Interrupt,
        round_done: &dyn Fn(),
    ) -> Result<(Self, Diagnosis)> {
        let mut bent = self.bent_places(noise.value_um);
        if 2 * bent.len() > measured_um.len() {
            bent.clear();
        }
        let first = bent.len();
        let mut without = Without { sources: Vec::new(), places: bent };
        let mut model = self.clone();
        let mut found = LinearFit::new(&model, measured_um, noise, &without).diagnosis()?;
        for round in 1..=MOST_ROUNDS {
            let sizes = found.sizes(&model);
            match self.moved_to(cuts, &sizes, interrupt) {
                Ok(Some(moved)) => {
                    model = moved;
                    without.places.clear();
                }
                // A negative amount: the source is none.
                Ok(None) => {
                    let before = without.sources.len();
                    without.sources.extend(self.unsayable(cuts, &sizes));
                    if without.sources.len() == before {
                        break;
                    }
                }
                Err(Error::Interrupted) => {
                    model.complete = false;
                    break;
                }
                // A gear that cannot be cut: sizes beyond all reason, which have not settled.
                Err(Error::Scene(_) | Error::Refused(_)) => break,
                Err(other) => return Err(other),
            }
            let last = found;
            found = LinearFit::new(&model, measured_um, noise, &without).diagnosis()?;
            found.rounds = round;
            found.bent = first;
            found.settled = without.places.is_empty() && found.is_as(&last, &model);
            round_done();
            if found.settled {
                break;
            }
        }
        Ok((model, found))
    }

    /// Sources of which the scene has no word for the sizes.
    fn unsayable(&self, cuts: &MeasuredCuts, sizes: &[Vec<f64>]) -> Vec<usize> {
        let alone = |source: usize| {
            let own = |(other, sizes): (usize, &Vec<f64>)| {
                if other == source { sizes.clone() } else { vec![0.0; sizes.len()] }
            };
            sizes.iter().enumerate().map(own).collect::<Vec<_>>()
        };
        (0..sizes.len()).filter(|&source| !self.can_have(cuts, &alone(source))).collect()
    }
}

impl Diagnosis {
    /// Sizes of all parameters, source by source; 0 where it names none.
    fn sizes(&self, model: &ErrorModel) -> Vec<Vec<f64>> {
        let mut sizes: Vec<Vec<f64>> = model.sources.iter().map(|source| vec![0.0; source.parameters.len()]).collect();
        for named in &self.named {
            for (size, fitted) in sizes[named.source].iter_mut().zip(&named.fitted) {
                *size = fitted.map_or(0.0, |fitted| fitted.size);
            }
        }
        sizes
    }

    /// Whether another one names the same sources, about whose sizes `model` is, and within what intervals hide.
    fn is_as(&self, other: &Self, model: &ErrorModel) -> bool {
        let names = |of: &Self| {
            let mut names: Vec<usize> = of.named.iter().map(|named| named.source).collect();
            names.sort_unstable();
            names
        };
        let still = self.named.iter().all(|named| {
            let moved = named.fitted.iter().zip(&model.sources[named.source].sizes);
            moved
                .filter_map(|(fitted, before)| fitted.map(|of| (of.size - before).abs() <= SETTLED * of.half_if_right))
                .all(|still| still)
        });
        names(self) == names(other) && still
    }
}
