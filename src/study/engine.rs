//! A study at work: cases on all cores, each a row on the disk as soon as it is found.
//!
//! In: a [`Study`]. Out: a folder with `rows.csv`, `columns.csv`, the page of a whole study and the run record. It
//! grows under its final name (`GrowingFolder`): what a kill leaves is rows, and the same command goes on with the
//! cases that are missing. At the end the rows are in the order of their cases, whatever order they were found in.
//!
//! The law: nothing of a row depends on time, threads or machine. What a case refuses is its row; what the machine
//! refuses (a full disk) ends the study.

use super::kept::{CaseOutcome, LAST_HEADS, LAST_WORDS, cells, columns};
use super::map::{self, FlankMap};
use super::page::{self, StudyOf};
use super::pair::{self, PairBase};
use super::plan::{Shard, StudyCommand, StudyPlan};
use super::rows::StudyRows;
use crate::backend::Choice;
use crate::findings::table::table_file;
use crate::findings::{Findings, Notice, TableColumn};
use crate::interrupt::Interrupt;
use crate::output::growing::LineFile;
use crate::output::growing_folder::GrowingFolder;
use crate::process::{self, ProcessJob};
use crate::progress::Progress;
use crate::run::Run;
use crate::scene::{LoadedScene, Scene, SceneErrors};
use crate::steps::parts::Stages;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::{Error, Refusal, Result};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Table of the rows in the folder.
pub const ROWS: &str = "rows";
/// What their columns are.
const COLUMNS: &str = "columns";
/// Cases that may fail one after the other before the study itself is refused.
const MOST_FAILURES: usize = 100;

/// What cases change, settings of all cases included.
#[derive(Debug)]
pub struct StudyBase {
    /// The scene.
    pub scene: LoadedScene,
    /// What pairs have beside it.
    pub pair: Option<PairBase>,
}

/// A study.
pub struct Study<'a> {
    /// What cases change.
    pub base: &'a StudyBase,
    /// What is done with every case.
    pub command: StudyCommand,
    /// The cases.
    pub plan: StudyPlan,
    /// Quantities that are kept, by their paths; `*` is any text without a dot. Those of maps are among them.
    pub keep: Vec<String>,
    /// Maps of flanks that are kept.
    pub maps: Vec<FlankMap>,
    /// Which of the cases are made.
    pub shard: Shard,
    /// What cuts.
    pub choice: &'a Choice,
    /// The base made ready, once a case needs it; none where it cannot be cut itself.
    pub(super) shared: OnceLock<Option<Box<dyn ProcessJob>>>,
}

/// What a study has.
#[derive(Debug)]
pub struct StudyOutcome {
    /// Its folder.
    pub path: PathBuf,
    /// Rows that there are, those of earlier runs included.
    pub rows: u64,
    /// Cases of the shard.
    pub cases: u64,
    /// Rows of cases that failed.
    pub failed: u64,
    /// What must be known of the rows of a whole study.
    pub notices: Vec<Notice>,
}

/// Lines by cases.
type Lines = BTreeMap<u64, String>;

impl Study<'_> {
    /// Makes all cases that the folder does not have yet. Ctrl-C is no error: what is finished stays, and the outcome
    /// has fewer rows than cases.
    ///
    /// # Errors
    /// A kept quantity that cases do not have; a folder of something else; cases that all fail; the machine's.
    pub fn run(&self, out: &Path, (progress, interrupt): (&Progress, &Interrupt)) -> Result<StudyOutcome> {
        let cases: Vec<u64> = (0..self.plan.cases()).filter(|case| self.shard.has(*case)).collect();
        if cases.is_empty() {
            let problem =
                format!("{} cases have no share {} of {}", self.plan.cases(), self.shard.number, self.shard.of);
            return Err(Refusal::new("--shard", problem, "take no more shares than there are cases").into());
        }
        // What is wrong with all cases is said before there is a folder that would go on with it.
        let is_begun = out.join(table_file(ROWS)).exists();
        let begun = if is_begun { None } else { self.begin(&cases, interrupt)? };
        if begun.is_none() && !is_begun {
            return Ok(outcome(out, &Lines::new(), cases.len()));
        }
        let folder = GrowingFolder::open(out, self.record())?;
        let [rows, about] = [ROWS, COLUMNS].map(|name| folder.path().join(table_file(name)));
        let (mut lines, heads) = match (LineFile::read(&rows)?, begun) {
            (Some((heads, lines)), _) => (lines.iter().filter_map(|line| self.known(&heads, line)).collect(), heads),
            (None, Some((lines, kept))) => {
                self.write_columns(&about, &kept)?;
                (lines, self.heads(&kept)?)
            }
            (None, None) => return Err(Error::Output { path: rows, reason: "somebody removed it".to_owned() }),
        };
        let paths = kept_paths(&about)?;
        let file = LineFile::create(&rows, &heads, lines.values())?;
        let missing: Vec<u64> = cases.iter().copied().filter(|case| !lines.contains_key(case)).collect();
        let step = progress.step("cases", missing.len() as u64, self.command.name());
        let found: Vec<Option<(u64, String)>> = missing
            .into_par_iter()
            .with_max_len(1)
            .map(|case| {
                let Some(outcome) = self.outcome_of(case, interrupt)? else { return Ok(None) };
                let line = self.line(case, &outcome, &paths)?;
                file.add(&line)?;
                step.advance(1);
                Ok(Some((case, line)))
            })
            .collect::<Result<_>>()?;
        step.finish();
        lines.extend(found.into_iter().flatten());
        LineFile::create(&rows, &heads, lines.values())?;
        let outcome = outcome(folder.path(), &lines, cases.len());
        if outcome.rows < outcome.cases {
            return Ok(outcome);
        }
        let mut notices = Vec::new();
        let finished = folder.finish(|new| {
            for (name, path) in [(ROWS, &rows), (COLUMNS, &about)] {
                let place = new.path(table_file(name))?;
                std::fs::copy(path, &place).map_err(Error::writing(place))?;
            }
            if self.shard != Shard::WHOLE {
                return Ok(());
            }
            let read = StudyRows::read([&rows, &about], self.plan.parameters().len())?;
            let of = StudyOf { base: &self.base.scene, plan: &self.plan, is_pair: self.base.pair.is_some() };
            notices = page::write(of, &read, new)?;
            Ok(())
        })?;
        Ok(StudyOutcome { path: finished, notices, ..outcome })
    }

    /// The first cases, one after the other, until one has findings, from which the columns of what is kept follow.
    /// Where patterns are kept, they are the first of the whole study: shares have the same columns. Nothing after
    /// Ctrl-C.
    fn begin(&self, cases: &[u64], interrupt: &Interrupt) -> Result<Option<(Lines, Vec<TableColumn>)>> {
        let first: Vec<u64> = if self.keep.iter().any(|path| path.contains('*')) {
            (0..self.plan.cases()).take(MOST_FAILURES).collect()
        } else {
            cases.iter().copied().take(MOST_FAILURES).collect()
        };
        let mut reasons: Vec<(u64, CaseOutcome)> = Vec::new();
        for case in first {
            let Some(outcome) = self.outcome_of(case, interrupt)? else { return Ok(None) };
            let Ok(found) = &outcome else {
                reasons.push((case, outcome));
                continue;
            };
            let kept = columns(found, &self.keep)?;
            let paths: Vec<String> = kept.iter().map(|of| of.key.to_string()).collect();
            let made = reasons.into_iter().chain([(case, outcome)]).filter(|(case, _)| self.shard.has(*case));
            let lines = made.map(|(case, outcome)| Ok((case, self.line(case, &outcome, &paths)?)));
            return Ok(Some((lines.collect::<Result<_>>()?, kept)));
        }
        let why = |(case, outcome): &(u64, CaseOutcome)| Some(format!("case {case}: {}", outcome.as_ref().err()?));
        let problem = format!(
            "the first {} cases all fail; {}",
            reasons.len(),
            reasons.first().and_then(why).unwrap_or_default()
        );
        Err(Refusal::new("study", problem, "change the scene or the values of its parameters").into())
    }

    /// What a case finds, or why it cannot be made; nothing after Ctrl-C.
    fn outcome_of(&self, case: u64, interrupt: &Interrupt) -> Result<Option<CaseOutcome>> {
        if interrupt.is_raised() {
            return Ok(None);
        }
        let found = self.found(case, interrupt);
        // What is broken off may lack flanks, windows or places of maps; the case is made again.
        if interrupt.is_raised() {
            return Ok(None);
        }
        match found {
            Ok(found) => Ok(Some(Ok(found))),
            Err(Error::Interrupted) => Ok(None),
            Err(Error::Scene(errors)) => Ok(Some(Err(in_one_line(errors.as_ref())))),
            // Of a pair it lies in two scenes, or in how they are mounted.
            Err(Error::Refused(refusal)) => Ok(Some(Err(refusal.problem))),
            Err(Error::NotConverged(reason)) => Ok(Some(Err(reason.to_string()))),
            Err(other) => Err(other),
        }
    }

    fn found(&self, case: u64, interrupt: &Interrupt) -> Result<Findings> {
        let settings = self.plan.settings(case);
        let base = &self.base.scene;
        let processor = Cpu::default();
        if let Some(pair) = &self.base.pair {
            let backend = self.choice.untried(&processor);
            return pair::found((base, pair), &settings, backend, interrupt);
        }
        let scene = base.with_settings(&settings, process::table())?;
        let found = match self.command {
            StudyCommand::Axes => process::axis_peaks(&scene.scene),
            StudyCommand::Cut | StudyCommand::Pair => self.prepared(&scene.scene).and_then(|prepared| {
                let run = Run::new(&scene, prepared.as_ref(), self.choice);
                let mut found = run.until(interrupt).stages(Stages::of_paths(&self.keep)).found()?;
                if !self.maps.is_empty() {
                    let backend = self.choice.untried(&processor);
                    prepared.with_gear(&mut |gear| map::add(&mut found, gear, &self.maps, backend))?;
                }
                Ok(found)
            }),
        };
        found.map_err(|error| match error {
            Error::Refused(refusal) => scene.explain(&refusal).into(),
            other => other,
        })
    }

    /// A scene made ready. What it shares with the base, such as targets of teeth, is found once.
    fn prepared(&self, scene: &Scene) -> Result<Box<dyn ProcessJob>> {
        let base = &self.base.scene.scene;
        match self.shared.get_or_init(|| process::prepare(base).ok()) {
            Some(shared) if base.process_name() == scene.process_name() => shared.with_errors_of(scene),
            _ => process::prepare(scene),
        }
    }

    /// A row of an earlier run with its case, if it is whole and of this study.
    fn known(&self, heads: &str, line: &str) -> Option<(u64, String)> {
        let fields = |text: &str| Some(csv_reader(text).records().next()?.ok()?.len());
        let case: u64 = line.split(',').next()?.parse().ok()?;
        let sound = fields(line)? == fields(heads)? && case < self.plan.cases() && self.shard.has(case);
        sound.then(|| (case, line.to_owned()))
    }

    fn line(&self, case: u64, outcome: &CaseOutcome, paths: &[String]) -> Result<String> {
        let values = self.plan.values(case).into_iter().map(|value| value.trim_matches('"').to_owned());
        csv_line([case.to_string()].into_iter().chain(values).chain(cells(outcome, paths)))
    }

    fn heads(&self, kept: &[TableColumn]) -> Result<String> {
        let parameters = self.plan.parameters().iter().map(|of| of.key.clone());
        let kept = kept.iter().map(TableColumn::head);
        let last = LAST_HEADS.into_iter().map(str::to_owned);
        csv_line(["case".to_owned()].into_iter().chain(parameters).chain(kept).chain(last))
    }

    /// What each column is: its head, unit, definition, and of kept quantities the path.
    fn write_columns(&self, path: &Path, kept: &[TableColumn]) -> Result<()> {
        let row =
            |head: &str, [unit, definition]: [&str; 2], path: &str| [head, unit, definition, path].map(str::to_owned);
        let parameter = |key: &str| {
            let known = process::table().of_setting(pair::key_of_scene(key));
            let other = if self.base.pair.is_some() { "option of the pair" } else { "key of the scene" };
            row(key, known.map_or(["", other], |of| [of.unit, of.teach]), "")
        };
        let rows = [row("case", ["1", "number of the case, from 0"], "")]
            .into_iter()
            .chain(self.plan.parameters().iter().map(|of| parameter(&of.key)))
            .chain(
                kept.iter()
                    .map(|of| row(&of.head(), [of.unit.as_deref().unwrap_or_default(), &of.definition], &of.key)),
            )
            .chain(LAST_HEADS.into_iter().zip(LAST_WORDS).map(|(head, words)| row(head, words, "")));
        let heads = csv_line(["column", "unit", "definition", "path"].map(str::to_owned))?;
        let lines = rows.map(csv_line).collect::<Result<Vec<_>>>()?;
        LineFile::create(path, &heads, lines).map(drop)
    }

    /// What the rows of a folder belong to.
    fn record(&self) -> Map<String, Value> {
        let values = |case: u64| json!(self.plan.values(case));
        let cases = self.plan.cases();
        let entries = [
            ("program", json!("gearcut")),
            ("program_version", json!(env!("CARGO_PKG_VERSION"))),
            ("command", json!("study")),
            ("of_every_case", json!(self.command.name())),
            ("parameters", json!(self.plan.parameters().iter().map(|of| &of.key).collect::<Vec<_>>())),
            ("plan", json!(self.plan.checksum())),
            ("cases", json!(cases)),
            ("first_case", values(0)),
            ("last_case", values(cases - 1)),
            ("keep", json!(self.keep)),
            ("shard", json!([self.shard.number, self.shard.of])),
            ("backend", json!(self.choice.backend.name_in_files())),
            ("scene", json!(self.base.scene.resolved_toml())),
        ];
        let pair = self.base.pair.iter().flat_map(|pair| {
            [("mate", json!(pair.mate.resolved_toml())), ("mounting", json!(format!("{:?}", pair.options)))]
        });
        entries.into_iter().chain(pair).map(|(key, value)| (key.to_owned(), value)).collect()
    }
}

/// What there is.
fn outcome(path: &Path, lines: &Lines, cases: usize) -> StudyOutcome {
    let failed = lines.values().filter(|line| !line.trim_end().ends_with(',')).count() as u64;
    StudyOutcome { path: path.to_owned(), rows: lines.len() as u64, cases: cases as u64, failed, notices: Vec::new() }
}

/// Paths of the kept quantities, from the file that says what columns are.
fn kept_paths(about: &Path) -> Result<Vec<String>> {
    let unreadable = |reason: csv::Error| Error::Unreadable { path: about.to_owned(), reason: reason.to_string() };
    let records = csv::Reader::from_path(about).and_then(|mut reader| reader.records().collect::<Result<Vec<_>, _>>());
    let paths = records.map_err(unreadable)?.into_iter().filter_map(|of| Some(of.get(3)?.to_owned()));
    Ok(paths.filter(|path| !path.is_empty()).collect())
}

/// Problems of a scene in one line.
fn in_one_line(errors: &(dyn std::error::Error + Send + Sync + 'static)) -> String {
    match errors.downcast_ref::<SceneErrors>() {
        Some(errors) => errors.problems.iter().map(|of| of.message.as_str()).collect::<Vec<_>>().join("; "),
        None => errors.to_string().replace('\n', " "),
    }
}

fn csv_reader(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes())
}

/// Cells as a line, its end included.
fn csv_line(cells: impl IntoIterator<Item = String>) -> Result<String> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let failed = |reason: String| Error::Output { path: table_file(ROWS).into(), reason };
    writer.write_record(cells).map_err(|reason| failed(reason.to_string()))?;
    let line = writer.into_inner().map_err(|reason| failed(reason.to_string()))?;
    String::from_utf8(line).map_err(|reason| failed(reason.to_string()))
}
