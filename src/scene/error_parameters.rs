//! The errors of a scene as parameters, numbers that can be shifted.
//!
//! In: a scene and the tables of its process ([`super::error_sources`]). Out: its [`ErrorParameter`]s, and [`Shifted`]
//! scenes as `--set` arguments. They go through the reader as any other scene, so that nothing can be shifted beyond
//! what a scene may say.
//!
//! An error of some size in some direction is two parameters, its parts along 0 and 90 degrees, and so is a wave, its
//! sine and cosine part. Size and direction are no parameters where the size is 0: every direction is the same there.

mod shifted;

use super::LoadedScene;
use super::error_sources::{ErrorSource, KeyForm, Tried, of_axis};
use super::keys::join;
use super::machine_errors;
use super::values::Held;
use crate::machine::AxisKind;
pub use shifted::Shifted;

/// A number that can be shifted.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorParameter {
    /// Its key, and behind `@` which part of it: `mounting.eccentricity_um@90`.
    pub id: String,
    /// The error that it is a part of: its key without the part.
    pub source: String,
    /// What it is, in words.
    pub title: String,
    /// Its unit.
    pub unit: &'static str,
    /// Natural step, in that unit.
    pub step: f64,
    /// When it is shifted.
    pub tried: Tried,
    /// Section of its keys.
    section: String,
    /// Whether the scene has its key.
    is_there: bool,
    change: Change,
}

impl ErrorParameter {
    /// Whether it is among all errors, where nobody names any.
    pub fn is_usual(&self) -> bool {
        match self.tried {
            Tried::Always => true,
            Tried::WhereItIs => self.is_there,
            Tried::ByName => false,
        }
    }

    /// Whether a name means it: its whole name, its key, or a section of keys. What is not tried always must be meant
    /// by more than a section that holds others.
    pub fn is_meant_by(&self, name: &str) -> bool {
        let rest = self.id.strip_prefix(name);
        let least = match self.tried {
            Tried::Always => "",
            Tried::WhereItIs if self.is_there => "",
            Tried::WhereItIs => &self.section,
            Tried::ByName => &self.source,
        };
        name.starts_with(least) && rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '@', '/']))
    }

    /// Whether it is the size of something random.
    pub fn is_random(&self) -> bool {
        self.tried == Tried::ByName
    }

    /// The same with another step.
    #[must_use]
    pub fn with_step(self, step: f64) -> Self {
        Self { step, ..self }
    }
}

/// What a shift does to the values of a scene; keys are whole paths.
#[derive(Debug, Clone, PartialEq)]
enum Change {
    Number { key: String, least: f64 },
    Missing { key: String },
    Toward { size: String, angle: String, degrees: f64 },
    Wave { waves: String, amplitudes: String, phases: String, at: f64, phase_deg: f64 },
    Lag { key: String },
    Entry { key: String, index: usize, count: usize },
}

/// Parameters of all errors that the scene's process knows. Of lists with an entry for each blade the first one stands
/// for all, unless `whole_lists`.
pub fn error_parameters(loaded: &LoadedScene, whole_lists: bool) -> Vec<ErrorParameter> {
    let process = loaded.scene.process.process();
    let mut found = Vec::new();
    for source in process.errors.iter().copied().flatten() {
        let Some(list) = source.section.strip_suffix("[]") else {
            parameters(loaded, source.section, source.what, source, AxisKind::Linear, whole_lists, &mut found);
            continue;
        };
        for (index, name) in loaded.scene.process.operation_names().into_iter().enumerate() {
            let (section, what) = (format!("{list}.{index}"), format!("{name}: {}", source.what));
            parameters(loaded, &section, &what, source, AxisKind::Linear, whole_lists, &mut found);
        }
    }
    for &(stem, kind) in process.axes {
        let section = machine_errors::path(stem);
        let name = stem.replace('_', " ").replace("center", "centre");
        for source in of_axis(kind) {
            let what = format!("{name}: {}", source.what);
            parameters(loaded, &section, &what, source, kind, whole_lists, &mut found);
        }
    }
    found
}

/// Parameters of one error, whose keys stand in a section.
fn parameters(
    loaded: &LoadedScene,
    section: &str,
    what: &str,
    source: &ErrorSource,
    kind: AxisKind,
    whole_lists: bool,
    found: &mut Vec<ErrorParameter>,
) {
    let view = loaded.values.view(section);
    let is_written = |key: &str| loaded.values.held.get(key).is_some_and(Held::is_written);
    if source.needs.is_some_and(|needed| !is_written(&join(section, needed))) {
        return;
    }
    // A share cannot be shifted beyond 1.
    let step = match source.form {
        KeyForm::Share(name) => source.step.min(1.0 - view.number(name).unwrap_or(0.0)),
        _ => source.step,
    };
    if step <= 0.0 {
        return;
    }
    let mut add = |source_id: String, part: String, title: String, change: Change| {
        found.push(ErrorParameter {
            id: format!("{source_id}{part}"),
            is_there: is_written(&source_id),
            source: source_id,
            title,
            unit: source.unit,
            step,
            tried: source.tried,
            section: section.to_owned(),
            change,
        });
    };
    match source.form {
        KeyForm::Number(name) | KeyForm::Amount(name) | KeyForm::Positive(name) | KeyForm::Share(name) => {
            let key = join(section, name);
            let least = match source.form {
                KeyForm::Number(_) => f64::NEG_INFINITY,
                KeyForm::Positive(_) => f64::MIN_POSITIVE,
                _ => 0.0,
            };
            add(key.clone(), String::new(), what.to_owned(), Change::Number { key, least });
        }
        KeyForm::Missing(name) => {
            let key = join(section, name);
            add(key.clone(), String::new(), what.to_owned(), Change::Missing { key });
        }
        KeyForm::Vector { size, angle } => {
            for degrees in [0.0, 90.0] {
                let (size, angle) = (join(section, size), join(section, angle));
                let title = format!("{what}, {degrees} deg");
                add(size.clone(), format!("@{degrees}"), title, Change::Toward { size, angle, degrees });
            }
        }
        KeyForm::Waves { natural } => {
            let (unit, _) = machine_errors::unit(kind);
            let name = machine_errors::waves(kind);
            let (waves, amplitudes) = (join(section, name), join(section, &format!("periodic_amplitudes_{unit}")));
            let mut places = view.numbers(name).unwrap_or_default().to_vec();
            places.extend(natural);
            places.sort_by(f64::total_cmp);
            places.dedup();
            for at in places {
                for (phase_deg, part) in [(0.0, "sine"), (90.0, "cosine")] {
                    let title = match kind {
                        AxisKind::Rotary => format!("{what} {at} {part}"),
                        AxisKind::Linear => format!("{what} {at} mm {part}"),
                    };
                    let change = Change::Wave {
                        waves: waves.clone(),
                        amplitudes: amplitudes.clone(),
                        phases: join(section, "periodic_phases_deg"),
                        at,
                        phase_deg,
                    };
                    add(format!("{amplitudes}@{at}"), format!("/{phase_deg}"), title, change);
                }
            }
        }
        KeyForm::Lag => {
            let key = join(section, "velocity_gain_per_s");
            add(key.clone(), String::new(), what.to_owned(), Change::Lag { key });
        }
        KeyForm::Entries { list, count } => {
            let key = join(section, list);
            // A list may have more entries than that: one for each gash of each thread.
            let written = view.numbers(list).map_or(0, <[f64]>::len);
            let count = (view.whole(count).unwrap_or(0) as usize).max(written);
            for index in 0..if whole_lists { count } else { count.min(1) } {
                let change = Change::Entry { key: key.clone(), index, count };
                add(key.clone(), format!("@{}", index + 1), format!("{what} {}", index + 1), change);
            }
        }
    }
}
