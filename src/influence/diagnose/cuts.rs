//! The gear of a scene, cut where it was measured.
//!
//! In: a scene and measured places. Out: the deviations that its gear has there, for this scene and for others of the
//! same target. Cuts that are known are not made again ([`crate::influence::known_cuts`]).

use crate::influence::gear_grid::turn_um_per_arcsec;
use crate::influence::known_cuts::{KnownCuts, digest};
use crate::influence::measured::{MeasuredPlaces, MeasuredPoint};
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

    /// Deviations that a scene's gear has at the measured places, um.
    ///
    /// # Errors
    /// Geometry that cannot be cut; the backend's; places where no pass comes.
    pub fn deviations_um(&self, scene: &Scene) -> Result<Vec<f64>> {
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

    /// What a turn of the gear on the measuring machine adds there, um per arc second counter-clockwise.
    pub fn turn_um_per_arcsec(&self) -> Vec<f64> {
        self.places.at_points(&turn_um_per_arcsec(&self.places.grid))
    }
}
