//! The gear of a scene, cut where it was measured.
//!
//! In: a scene and measured places. Out: the deviations that its gear has there, for this scene and for others of the
//! same target, and when they are cut. Cuts that are known are not made again ([`crate::influence::known_cuts`]).
//!
//! What is another one in every gear (noise of axes, scatter of the stock, tearing) is left out: the measured gear had
//! another course of it. Noise of the axes counts as noise of the values ([`super::Noise`]).

use crate::influence::gear_grid::turn_um_per_arcsec;
use crate::influence::known_cuts::{KnownCuts, digest};
use crate::influence::measured::{MeasuredPlaces, MeasuredPoint};
use crate::machine_errors::ErrorLayer;
use crate::process::{self, ProcessJob};
use crate::scene::{LoadedScene, Scene};
use gearcut_core::cut::Backend;
use gearcut_core::error::{Refusal, Result};

/// Cuts of a scene and of scenes with other errors.
pub struct MeasuredCuts<'a> {
    /// The scene as it is.
    pub loaded: &'a LoadedScene,
    /// The same, ready to be cut.
    ready: Box<dyn ProcessJob>,
    /// Measured places.
    pub points: &'a [MeasuredPoint],
    places: MeasuredPlaces,
    backend: &'a dyn Backend,
    known: &'a KnownCuts,
    /// What is asked of every cut.
    asked: String,
}

impl<'a> MeasuredCuts<'a> {
    /// Lays measured places on the gear of a scene.
    ///
    /// # Errors
    /// Places that the gear does not have; geometry.
    pub fn new(
        loaded: &'a LoadedScene,
        points: &'a [MeasuredPoint],
        backend: &'a dyn Backend,
        known: &'a KnownCuts,
    ) -> Result<Self> {
        let mut places = None;
        let ready = process::prepare(&loaded.scene)?;
        ready.with_gear(&mut |gear| {
            places = Some(MeasuredPlaces::new(gear, points)?);
            Ok(())
        })?;
        let places = places.expect("a job shows its gear");
        let asked = digest(&("heights", &places.grid, backend.name()));
        Ok(Self { loaded, ready, points, places, backend, known, asked })
    }

    /// Deviations that a scene's gear has at the measured places without what is random, um.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's; places where no pass comes.
    pub fn deviations_um(&self, scene: &Scene) -> Result<Vec<f64>> {
        self.one_gears_um(&without_random(scene))
    }

    /// The same with what is random, as the scene's seed has it.
    ///
    /// # Errors
    /// As for [`Self::deviations_um`].
    pub fn one_gears_um(&self, scene: &Scene) -> Result<Vec<f64>> {
        let cut = || self.places.grid.heights_of_um(self.ready.with_errors_of(scene)?.as_ref(), self.backend);
        let um = self.places.at_points(&self.known.all_of(scene, &self.asked, cut)?);
        if let Some(untouched) = um.iter().position(|um| um.is_nan()) {
            let point = self.points[untouched];
            let problem = format!(
                "no pass comes to u {} mm, v {} mm of tooth {} {}",
                point.u_mm,
                point.v_mm,
                point.tooth,
                point.side.name()
            );
            return Err(Refusal::new("--measured", problem, "leave out places that the scene does not cut").into());
        }
        Ok(um)
    }

    /// When the scene's gear is cut at the measured places, s from the beginning of the first operation.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's.
    pub(super) fn times_s(&self) -> Result<Vec<f64>> {
        let still = self.ready.with_errors_of(&without_random(&self.loaded.scene))?;
        Ok(self.places.nearest(&self.places.grid.times_s(still.as_ref(), self.backend)?))
    }

    /// What a turn of the gear on the measuring machine adds there, um per arc second counter-clockwise.
    pub fn turn_um_per_arcsec(&self) -> Vec<f64> {
        self.places.at_points(&turn_um_per_arcsec(&self.places.grid))
    }
}

/// A scene without what is another one in every gear.
pub(super) fn without_random(scene: &Scene) -> Scene {
    let mut still = scene.clone();
    let kept: Vec<ErrorLayer> = ErrorLayer::ALL.into_iter().filter(|layer| !layer.is_random()).collect();
    still.process.keep_layers(&kept);
    still
}
