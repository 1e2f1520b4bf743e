//! Influences at measured places: what a diagnosis fits.
//!
//! In: cuts at the measured places and the names of the errors that are tried. Out: [`ErrorModel`]: the deviations of a
//! gear with some sizes of the errors, and what a unit of each adds there. At first the sizes are 0: the scene's own
//! gear. [`ErrorModel::moved_to`] cuts it with the sizes that were found, and takes the influences of these anew.

use super::cuts::MeasuredCuts;
use super::shapes::StandingOut;
use crate::influence::budget::chosen;
use crate::influence::derivative::{Influence, read, refusal};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::scene::error_parameters::{ErrorParameter, Shifted};
use crate::scene::{LoadedScene, Scene};
use gearcut_core::error::{Error, Refusal, Result};

/// A scene's errors as columns over measured places.
#[derive(Debug, Clone)]
pub struct ErrorModel {
    /// Deviations that the scene's own gear has there, um.
    pub before_um: Vec<f64>,
    /// Deviations of the gear with the sizes at which the errors are linear, um.
    pub here_um: Vec<f64>,
    /// What a turn of the gear on the measuring machine adds, um per arc second counter-clockwise.
    pub um_per_arcsec: Vec<f64>,
    /// What stands out of the gear and is fitted beside all sources.
    pub standing_out: Vec<StandingOut>,
    /// Sources, in the order of the process's tables.
    pub sources: Vec<ModelledSource>,
    /// Parameters that could not be shifted, and why.
    pub refused: Vec<(ErrorParameter, String)>,
    /// Whether all parameters were tried; after Ctrl-C only sources that were tried as a whole are there.
    pub complete: bool,
}

/// The errors with these names, all if none is given.
///
/// # Errors
/// No error has the name; the size of something random, which has no map of its own.
pub fn tried(loaded: &LoadedScene, names: &[String]) -> Result<Vec<ErrorParameter>> {
    let parameters = chosen(loaded, names)?;
    if let Some(random) = parameters.iter().find(|parameter| parameter.is_random()) {
        let problem = format!("{} is the size of something random, which makes another map in every gear", random.id);
        let way_out = "a diagnosis finds what repeats; `gearcut calibrate` fits it to numbers of texture";
        return Err(Refusal::new("--parameters", problem, way_out).into());
    }
    Ok(parameters)
}

/// A source of errors with its columns.
#[derive(Debug, Clone)]
pub struct ModelledSource {
    /// Its key.
    pub key: String,
    /// Its parameters.
    pub parameters: Vec<ErrorParameter>,
    /// Sizes about which they are linear, beyond those of the scene.
    pub sizes: Vec<f64>,
    /// What a unit of each adds at the measured places, um.
    pub um_per_unit: Vec<Vec<f64>>,
    /// How far both sides of a natural step about the scene are off a straight line at each place, um: the largest of
    /// its parameters.
    pub bends_um: Vec<f64>,
}

impl ModelledSource {
    /// What it is: the title of its parameters without their parts.
    pub fn title(&self) -> String {
        let first = &self.parameters[0].title;
        let cut = [", 0 deg", ", 90 deg", " sine", " cosine"].into_iter().find_map(|part| first.strip_suffix(part));
        cut.unwrap_or(first).to_owned()
    }
}

impl ErrorModel {
    /// Influences of the errors with these names (all, if none is given) at measured places.
    ///
    /// # Errors
    /// The size of something random, which has no map of its own; geometry that cannot be cut; places where no pass
    /// came; Ctrl-C before any error was tried.
    pub fn new(cuts: &MeasuredCuts, names: &[String], progress: &Progress, interrupt: &Interrupt) -> Result<Self> {
        let parameters = tried(cuts.loaded, names)?;
        let before_um = cuts.deviations_um(&cuts.loaded.scene)?;
        let mut model = Self {
            here_um: before_um.clone(),
            before_um,
            um_per_arcsec: cuts.turn_um_per_arcsec(),
            standing_out: Vec::new(),
            sources: Vec::new(),
            refused: Vec::new(),
            complete: true,
        };
        let step = progress.step("influence", parameters.len() as u64, "parameters");
        for parameter in parameters {
            if interrupt.is_raised() {
                model.complete = false;
                model.leave_out_source_of(&parameter);
                break;
            }
            match Influence::by(cuts.loaded, &model.before_um, &parameter, &|scene| cuts.deviations_um(scene)) {
                Ok(influence) => model.add(influence),
                Err(error) => model.refused.push((parameter, refusal(error)?)),
            }
            step.advance(1);
        }
        step.finish();
        if !model.complete && model.sources.is_empty() {
            return Err(Error::Interrupted);
        }
        Ok(model)
    }

    /// Takes a source away of which not all parameters were tried.
    fn leave_out_source_of(&mut self, untried: &ErrorParameter) {
        self.sources.retain(|source| source.key != untried.source);
    }

    fn add(&mut self, influence: Influence) {
        let known = self.sources.iter().position(|source| source.key == influence.parameter.source);
        let place = known.unwrap_or_else(|| {
            let (key, bends_um) = (influence.parameter.source.clone(), vec![0.0; influence.bends_um.len()]);
            let (parameters, sizes, um_per_unit) = (Vec::new(), Vec::new(), Vec::new());
            self.sources.push(ModelledSource { key, parameters, sizes, um_per_unit, bends_um });
            self.sources.len() - 1
        });
        let source = &mut self.sources[place];
        for (most, bend) in source.bends_um.iter_mut().zip(&influence.bends_um) {
            *most = most.max(bend.abs() * influence.parameter.step);
        }
        source.sizes.push(0.0);
        source.parameters.push(influence.parameter);
        source.um_per_unit.push(influence.um_per_unit);
    }

    /// The model about a gear that is cut with other sizes, source by source as in [`Self::sources`]. Influences of
    /// those that are not 0 are taken there; the others are those of `self`, the model about the scene. `None` where
    /// the scene has no word for the sizes.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's; Ctrl-C.
    pub fn moved_to(&self, cuts: &MeasuredCuts, sizes: &[Vec<f64>], interrupt: &Interrupt) -> Result<Option<Self>> {
        interrupt.check()?;
        let Some(there) = self.scene_with(cuts, sizes)? else { return Ok(None) };
        let mut moved = self.clone();
        if sizes.iter().flatten().all(|&size| size == 0.0) {
            return Ok(Some(moved));
        }
        moved.here_um = cuts.deviations_um(&there.scene)?;
        for (source, sizes) in moved.sources.iter_mut().zip(sizes) {
            if sizes.iter().all(|&size| size == 0.0) {
                continue;
            }
            source.sizes.clone_from(sizes);
            for (parameter, um_per_unit) in source.parameters.iter().zip(&mut source.um_per_unit) {
                interrupt.check()?;
                let deviations_um = |scene: &Scene| cuts.deviations_um(scene);
                match Influence::by(&there, &moved.here_um, parameter, &deviations_um) {
                    Ok(influence) => *um_per_unit = influence.um_per_unit,
                    // At the end of what a scene may say: the influence is that about the scene.
                    Err(Error::Scene(_) | Error::Refused(_)) => {}
                    Err(other) => return Err(other),
                }
            }
        }
        Ok(Some(moved))
    }

    /// What every fit has, um per unit: a turn, and what stands out.
    pub(super) fn always(&self) -> impl Iterator<Item = &[f64]> {
        let standing_out = self.standing_out.iter().flat_map(|of| &of.um_per_um);
        std::iter::once(&self.um_per_arcsec).chain(standing_out).map(Vec::as_slice)
    }

    /// Whether the scene has a word for these sizes.
    pub fn can_have(&self, cuts: &MeasuredCuts, sizes: &[Vec<f64>]) -> bool {
        matches!(self.scene_with(cuts, sizes), Ok(Some(_)))
    }

    /// The scene with these sizes; `None` where it has no word for them.
    fn scene_with(&self, cuts: &MeasuredCuts, sizes: &[Vec<f64>]) -> Result<Option<LoadedScene>> {
        let mut shifted = Shifted::new(cuts.loaded);
        for (source, sizes) in self.sources.iter().zip(sizes) {
            if !source.parameters.iter().zip(sizes).all(|(parameter, &size)| shifted.shift(parameter, size)) {
                return Ok(None);
            }
        }
        match read(&shifted) {
            Err(Error::Scene(_)) => Ok(None),
            other => other.map(Some),
        }
    }

    /// Places where a natural step of any error makes a bend of more than this to both sides.
    pub fn bent_places(&self, more_than_um: f64) -> Vec<usize> {
        let bent = |&place: &usize| self.sources.iter().any(|source| source.bends_um[place] > more_than_um);
        (0..self.here_um.len()).filter(bent).collect()
    }

    /// What deviations would be without any error, if all were linear from here on, um.
    pub fn without_errors_um(&self) -> Vec<f64> {
        let mut um = self.here_um.clone();
        for source in &self.sources {
            for (column, size) in source.um_per_unit.iter().zip(&source.sizes) {
                um.iter_mut().zip(column).for_each(|(um, per_unit)| *um -= size * per_unit);
            }
        }
        um
    }
}
