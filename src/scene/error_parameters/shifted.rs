//! Values of a scene with some of its error parameters shifted.

use super::{Change, ErrorParameter};
use crate::scene::LoadedScene;
use crate::scene::SceneErrors;
use crate::scene::table::KeyTable;
use crate::scene::values::Checked;
use crate::scene::write::value_text;
use glam::DVec2;
use std::collections::BTreeMap;

/// Milliseconds in a second.
const MS_PER_S: f64 = 1000.0;

/// A scene with shifted parameters.
#[derive(Debug, Clone)]
pub struct Shifted<'a> {
    loaded: &'a LoadedScene,
    changed: BTreeMap<String, Checked>,
}

impl<'a> Shifted<'a> {
    /// Nothing shifted.
    pub fn new(loaded: &'a LoadedScene) -> Self {
        Self { loaded, changed: BTreeMap::new() }
    }

    /// Shifts a parameter further; `false`, and nothing is shifted, where the scene has no word for the value: amounts
    /// and lags below zero.
    #[must_use]
    pub fn shift(&mut self, parameter: &ErrorParameter, by: f64) -> bool {
        if by == 0.0 {
            return true;
        }
        match &parameter.change {
            Change::Number { key, least } => {
                let value = self.number(key).unwrap_or(0.0) + by;
                if value < *least {
                    return false;
                }
                self.put(key, Checked::Number(value));
            }
            Change::Missing { key } => {
                let value = self.number(key).unwrap_or(1.0) - by;
                if value > 1.0 {
                    return false;
                }
                self.put(key, Checked::Number(value));
            }
            Change::Toward { size, angle, degrees } => {
                let direction = |degrees: f64| DVec2::from_angle(degrees.to_radians());
                let before = self.number(size).unwrap_or(0.0) * direction(self.number(angle).unwrap_or(0.0));
                let after = before + by * direction(*degrees);
                self.put(size, Checked::Number(after.length()));
                self.put(angle, Checked::Number(after.to_angle().to_degrees()));
            }
            Change::Wave { waves, amplitudes, phases, at, phase_deg } => {
                // A wave of its own beside those that are there; phases may have been left out.
                let count = self.numbers(waves).len();
                for (key, value) in [(waves, *at), (amplitudes, by), (phases, *phase_deg)] {
                    let mut numbers = self.numbers(key);
                    numbers.resize(count, 0.0);
                    numbers.push(value);
                    self.put(key, Checked::Numbers(numbers));
                }
            }
            Change::Lag { key } => {
                let lag_ms = self.number(key).map_or(0.0, |gain_per_s| MS_PER_S / gain_per_s) + by;
                if lag_ms <= 0.0 {
                    return false;
                }
                self.put(key, Checked::Number(MS_PER_S / lag_ms));
            }
            Change::Entry { key, index, count } => {
                let mut numbers = self.numbers(key);
                numbers.resize(*count, 0.0);
                numbers[*index] += by;
                self.put(key, Checked::Numbers(numbers));
            }
        }
        true
    }

    /// The shifted values as `--set` arguments.
    pub fn settings(&self) -> Vec<String> {
        self.changed.iter().map(|(key, value)| format!("{key}={}", value_text(value))).collect()
    }

    /// The shifted scene, read anew.
    ///
    /// # Errors
    /// A value that the scene may not have.
    pub fn read(&self, table: &KeyTable) -> Result<LoadedScene, SceneErrors> {
        self.loaded.with_settings(&self.settings(), table)
    }

    fn checked(&self, key: &str) -> Option<&Checked> {
        self.changed.get(key).or_else(|| self.loaded.values.held.get(key).map(|held| &held.value))
    }

    fn number(&self, key: &str) -> Option<f64> {
        if let Some(Checked::Number(number)) = self.checked(key) { Some(*number) } else { None }
    }

    fn numbers(&self, key: &str) -> Vec<f64> {
        if let Some(Checked::Numbers(numbers)) = self.checked(key) { numbers.clone() } else { Vec::new() }
    }

    fn put(&mut self, key: &str, value: Checked) {
        self.changed.insert(key.to_owned(), value);
    }
}
