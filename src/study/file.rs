//! Study files: TOML that names a scene, the keys that differ, and what is kept.
//!
//! In: the path of a file. Out: [`StudyFile`]. Unknown names are refused with their line, and paths in the file are
//! those beside it.

use super::engine::Study;
use super::parameter::{NormalValues, ParameterValues, StudyParameter, ValueRange};
use super::plan::{SampleDesign, Shard, StudyCommand, StudyPlan};
use crate::backend::Choice;
use crate::process;
use crate::scene::{LoadedScene, SceneErrors};
use gearcut_core::error::{Error, Refusal, Result};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use toml::Value;

/// A study as its file says it.
#[derive(Debug)]
pub struct StudyFile {
    /// The scene that cases change.
    pub scene: PathBuf,
    /// What is done with every case.
    pub command: StudyCommand,
    /// Whether cases are drafts.
    pub draft: bool,
    /// Settings of all cases.
    pub settings: Vec<String>,
    /// Quantities that are kept.
    pub keep: Vec<String>,
    /// The cases.
    pub plan: StudyPlan,
}

impl StudyFile {
    /// The scene that cases change.
    ///
    /// # Errors
    /// All problems of the scene.
    pub fn base(&self) -> Result<LoadedScene, SceneErrors> {
        let load = if self.draft { process::load_draft } else { process::load };
        load(&self.scene, &self.settings)
    }

    /// A share of the study, with its base.
    pub fn study<'a>(self, base: &'a LoadedScene, shard: Shard, choice: &'a Choice) -> Study<'a> {
        let Self { command, keep, plan, .. } = self;
        Study { base, command, plan, keep, shard, choice, shared: OnceLock::new() }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyDocument {
    study: StudyHead,
    #[serde(default)]
    parameter: Vec<ParameterTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyHead {
    scene: PathBuf,
    #[serde(default)]
    command: StudyCommand,
    #[serde(default)]
    draft: bool,
    #[serde(default)]
    settings: Vec<String>,
    keep: Vec<String>,
    samples: Option<u32>,
    #[serde(default)]
    design: SampleDesign,
    #[serde(default)]
    seed: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterTable {
    key: String,
    values: Option<Vec<Value>>,
    range: Option<[Value; 2]>,
    normal: Option<[f64; 2]>,
    count: Option<u32>,
    #[serde(default)]
    log: bool,
}

/// Reads a study; `most` is the largest number of cases.
///
/// # Errors
/// A file that cannot be read or is none of a study; parameters that are none.
pub fn read(path: &Path, most: u64) -> Result<StudyFile> {
    let text = std::fs::read_to_string(path).map_err(Error::reading(path))?;
    let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
    let document: StudyDocument = toml::from_str(&text).map_err(|wrong| unreadable(wrong.to_string()))?;
    let StudyHead { scene, command, draft, settings, keep, samples, design, seed } = document.study;
    let parameter = |table: ParameterTable| {
        let key = table.key.clone();
        let refuse = |why: String| {
            let way_out = "write values = [...], range = [first, last] with count = n or samples in [study], or \
                normal = [mean, deviation] with samples";
            Refusal::new("parameter", format!("{}: parameter `{key}`: {why}", path.display()), way_out)
        };
        choice(table).map(|choice| StudyParameter { key: key.clone(), choice }).map_err(refuse)
    };
    let parameters = document.parameter.into_iter().map(parameter).collect::<Result<Vec<_>, Refusal>>()?;
    let plan = StudyPlan::new(parameters, (samples, design, seed), most)?;
    let scene = path.parent().unwrap_or(Path::new("")).join(scene);
    Ok(StudyFile { scene, command, draft, settings, keep, plan })
}

fn choice(table: ParameterTable) -> Result<ParameterValues, String> {
    let ParameterTable { values, range, normal, count, log, .. } = table;
    if let Some(normal) = normal {
        return match (values, range, count, log) {
            (None, None, None, false) => Ok(ParameterValues::Normal(NormalValues::new(normal)?)),
            _ => Err("normal excludes values, range, count and log".to_owned()),
        };
    }
    match (values, range) {
        (Some(values), None) if count.is_none() && !log => {
            if values.is_empty() {
                Err("it has no values".to_owned())
            } else {
                Ok(ParameterValues::Values(values.iter().map(text_of).collect()))
            }
        }
        (None, Some(ends)) => {
            let whole = ends.iter().all(Value::is_integer);
            let number = |end: &Value| match end {
                Value::Integer(number) => Ok(*number as f64),
                Value::Float(number) => Ok(*number),
                other => Err(format!("{} is no number", text_of(other))),
            };
            let range = ValueRange::new([number(&ends[0])?, number(&ends[1])?], log, whole)?;
            count.map_or(Ok(ParameterValues::Between(range)), |count| Ok(ParameterValues::Values(range.values(count)?)))
        }
        (Some(_), None) => Err("count and log belong to a range".to_owned()),
        (Some(_), Some(_)) => Err("it has values and a range".to_owned()),
        (None, None) => Err("it has no values, no range and no normal distribution".to_owned()),
    }
}

/// A value as the text of TOML on one line.
fn text_of(value: &Value) -> String {
    match value {
        Value::String(text) => serde_json::json!(text).to_string(),
        Value::Integer(number) => number.to_string(),
        // Debug writes every number so that it reads back as the same.
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(is) => is.to_string(),
        Value::Datetime(time) => time.to_string(),
        Value::Array(list) => format!("[{}]", list.iter().map(text_of).collect::<Vec<_>>().join(", ")),
        Value::Table(table) => {
            let entries = table.iter().map(|(key, value)| format!("{} = {}", serde_json::json!(key), text_of(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}

/// Folder of a study's results, or of one of its shards.
pub fn folder_of(name: &str, shard: Shard) -> PathBuf {
    let whole = PathBuf::from("out").join(name);
    if shard == Shard::WHOLE { whole } else { whole.join(format!("shard_{}_of_{}", shard.number, shard.of)) }
}
