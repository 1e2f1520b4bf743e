//! Study files: TOML that names a scene, the keys that differ, and what is kept.
//!
//! In: the path of a file. Out: [`StudyFile`]. Unknown names are refused with their line, and paths in the file are
//! those beside it.

use super::engine::{Study, StudyBase};
use super::map::FlankMap;
use super::pair::PairBase;
use super::parameter::{NormalValues, ParameterValues, StudyParameter, ValueRange};
use super::plan::{SampleDesign, Shard, StudyCommand, StudyPlan};
use crate::backend::Choice;
use crate::process;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;
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
    /// The gear that the scene's is rolled with, of pairs alone.
    pub mate: Option<PathBuf>,
    /// Whether cases are drafts.
    pub draft: bool,
    /// Settings of all cases.
    pub settings: Vec<String>,
    /// Quantities that are kept.
    pub keep: Vec<String>,
    /// Maps of flanks that are kept.
    pub maps: Vec<FlankMap>,
    /// The cases.
    pub plan: StudyPlan,
}

impl StudyFile {
    /// What cases change.
    ///
    /// # Errors
    /// All problems of the scenes; a command and keys that do not belong together.
    pub fn base(&self) -> Result<StudyBase> {
        let load = if self.draft { process::load_draft } else { process::load };
        let refuse = |problem: &str, way_out: &str| Err(Refusal::new("study", problem, way_out).into());
        match (&self.mate, self.command) {
            (None, StudyCommand::Pair) => {
                return refuse("a pair is a gear and its mate", "give the scene of the mate: mate = \"mate.toml\"");
            }
            (Some(_), StudyCommand::Cut | StudyCommand::Axes) => {
                return refuse("a mate belongs to pairs", "take command = \"pair\", or leave the mate out");
            }
            _ => {}
        }
        if self.command != StudyCommand::Cut && !self.maps.is_empty() {
            return refuse("a map is cut", "take command = \"cut\", or leave [[map]] out");
        }
        let Some(mate) = &self.mate else {
            return Ok(StudyBase { scene: load(&self.scene, &self.settings)?, pair: None });
        };
        let [own, of_mate, of_pair] = super::pair::parted(&self.settings);
        let pair = PairBase { mate: load(mate, &of_mate)?, options: super::pair::options(&of_pair)? };
        Ok(StudyBase { scene: load(&self.scene, &own)?, pair: Some(pair) })
    }

    /// A share of the study, with its base.
    pub fn study<'a>(self, base: &'a StudyBase, shard: Shard, choice: &'a Choice) -> Study<'a> {
        let Self { command, mut keep, maps, plan, .. } = self;
        keep.extend(maps.iter().flat_map(|map| map.paths()));
        Study { base, command, plan, keep, maps, shard, choice, shared: OnceLock::new() }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyDocument {
    study: StudyHead,
    #[serde(default)]
    parameter: Vec<ParameterTable>,
    #[serde(default)]
    map: Vec<MapTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyHead {
    scene: PathBuf,
    #[serde(default)]
    command: StudyCommand,
    mate: Option<PathBuf>,
    #[serde(default)]
    draft: bool,
    #[serde(default)]
    settings: Vec<String>,
    #[serde(default)]
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MapTable {
    tooth: u32,
    flank: FlankWord,
    #[serde(default = "one")]
    columns: usize,
    #[serde(default = "one")]
    rows: usize,
}

fn one() -> usize {
    1
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FlankWord {
    Left,
    Right,
}

impl From<FlankWord> for Side {
    fn from(word: FlankWord) -> Self {
        match word {
            FlankWord::Left => Self::Left,
            FlankWord::Right => Self::Right,
        }
    }
}

/// Reads a study; `most` is the largest number of cases.
///
/// # Errors
/// A file that cannot be read or is none of a study; parameters that are none.
pub fn read(path: &Path, most: u64) -> Result<StudyFile> {
    let text = std::fs::read_to_string(path).map_err(Error::reading(path))?;
    let unreadable = |reason: String| Error::Unreadable { path: path.to_owned(), reason };
    let document: StudyDocument = toml::from_str(&text).map_err(|wrong| unreadable(wrong.to_string()))?;
    let StudyHead { scene, command, mate, draft, settings, keep, samples, design, seed } = document.study;
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
    let map = |MapTable { tooth, flank, columns, rows }: MapTable| {
        FlankMap::new(tooth, flank.into(), [columns, rows]).map_err(|why| {
            let way_out = "write tooth, flank = \"left\" or \"right\", columns and rows";
            Refusal::new("map", format!("{}: [[map]] of tooth {tooth}: {why}", path.display()), way_out)
        })
    };
    let maps = document.map.into_iter().map(map).collect::<Result<Vec<_>, Refusal>>()?;
    let beside = |scene: PathBuf| path.parent().unwrap_or(Path::new("")).join(scene);
    let (scene, mate) = (beside(scene), mate.map(beside));
    Ok(StudyFile { scene, command, mate, draft, settings, keep, maps, plan })
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
