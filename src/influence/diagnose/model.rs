//! Influences at measured places: what a diagnosis fits.

use crate::influence::budget::chosen;
use crate::influence::derivative::Influence;
use crate::influence::gear_grid::turn_um_per_arcsec;
use crate::influence::known_cuts::{KnownCuts, digest};
use crate::influence::measured::{MeasuredPlaces, MeasuredPoint};
use crate::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::process;
use crate::scene::error_parameters::ErrorParameter;
use crate::scene::{LoadedScene, Scene};
use gearcut_core::cut::Backend;
use gearcut_core::error::{Error, Refusal, Result};

/// A scene's errors as columns over measured places.
#[derive(Debug, Clone)]
pub struct ErrorModel {
    /// Deviations that the scene's own gear has there, um.
    pub before_um: Vec<f64>,
    /// What a turn of the gear on the measuring machine adds, um per arc second counter-clockwise.
    pub um_per_arcsec: Vec<f64>,
    /// Sources, in the order of the process's tables.
    pub sources: Vec<ModelledSource>,
    /// Parameters that could not be shifted, and why.
    pub refused: Vec<(ErrorParameter, String)>,
    /// Whether all parameters were tried; after Ctrl-C only sources that were tried as a whole are there.
    pub complete: bool,
}

/// A source of errors with its columns.
#[derive(Debug, Clone)]
pub struct ModelledSource {
    /// Its key.
    pub key: String,
    /// Its parameters.
    pub parameters: Vec<ErrorParameter>,
    /// What a unit of each adds at the measured places, um.
    pub um_per_unit: Vec<Vec<f64>>,
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
    /// Influences of the errors with these names (all, if none is given) at measured places; cuts that are known are
    /// not made again.
    ///
    /// # Errors
    /// The size of something random, which has no map of its own; places that the gear does not have; geometry that
    /// cannot be cut; places where no pass came; Ctrl-C before any error was tried.
    pub fn new(
        loaded: &LoadedScene,
        points: &[MeasuredPoint],
        names: &[String],
        backend: &dyn Backend,
        progress: &Progress,
        interrupt: &Interrupt,
        known: &KnownCuts,
    ) -> Result<Self> {
        let parameters = chosen(loaded, names)?;
        if let Some(random) = parameters.iter().find(|parameter| parameter.is_random()) {
            let problem =
                format!("{} is the size of something random, which makes another map in every gear", random.id);
            let way_out = "a diagnosis finds what repeats; `gearcut calibrate` fits it to numbers of texture";
            return Err(Refusal::new("--parameters", problem, way_out).into());
        }
        let mut places = None;
        process::prepare(&loaded.scene)?.with_gear(&mut |gear| {
            places = Some(MeasuredPlaces::new(gear, points)?);
            Ok(())
        })?;
        let places = places.expect("a job shows its gear");
        let asked = digest(&("heights", &places.grid, backend.name()));
        let heights_um = |scene: &Scene| known.all_of(scene, &asked, || places.grid.heights_um(scene, backend));
        let cut_um = heights_um(&loaded.scene)?;
        let before_um = places.at_points(&cut_um);
        if let Some(untouched) = before_um.iter().position(|um| um.is_nan()) {
            let point = points[untouched];
            let problem = format!(
                "no pass comes to u {} mm, v {} mm of tooth {} {}",
                point.u_mm,
                point.v_mm,
                point.tooth,
                point.side.name()
            );
            return Err(Refusal::new("--measured", problem, "leave out places that the scene does not cut").into());
        }
        let um_per_arcsec = places.at_points(&turn_um_per_arcsec(&places.grid));
        let mut model = Self { before_um, um_per_arcsec, sources: Vec::new(), refused: Vec::new(), complete: true };
        let step = progress.step("influence", parameters.len() as u64, "parameters");
        for parameter in parameters {
            if interrupt.is_raised() {
                model.complete = false;
                model.leave_out_source_of(&parameter);
                break;
            }
            match Influence::by(loaded, &cut_um, &parameter, &heights_um) {
                Ok(influence) => model.add(parameter, places.at_points(&influence.um_per_unit)),
                Err(Error::Scene(errors)) => model.refused.push((parameter, errors.to_string())),
                Err(Error::Refused(refusal)) => model.refused.push((parameter, refusal.problem)),
                Err(other) => return Err(other),
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

    fn add(&mut self, parameter: ErrorParameter, um_per_unit: Vec<f64>) {
        let known = self.sources.iter().position(|source| source.key == parameter.source);
        let place = known.unwrap_or_else(|| {
            let key = parameter.source.clone();
            self.sources.push(ModelledSource { key, parameters: Vec::new(), um_per_unit: Vec::new() });
            self.sources.len() - 1
        });
        self.sources[place].parameters.push(parameter);
        self.sources[place].um_per_unit.push(um_per_unit);
    }
}
