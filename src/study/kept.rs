//! What a study keeps of a case: quantities by their paths in `results.json`, and words on how it went.
//!
//! In: findings, or the reason why there are none. Out: cells of a row. A key alone is one of the headline; a path is
//! that below `sections`, such as `operations.finish.axes.work_speed.peak`.

use crate::findings::{Findings, Quantity, Severity, TableColumn};
use crate::scene::suggest::did_you_mean;
use gearcut_core::error::Refusal;

/// Cells behind the quantities of a row.
pub const LAST_HEADS: [&str; 4] = ["faults", "warnings", "notices", "error"];

/// The quantity at a path.
fn quantity<'a>(found: &'a Findings, path: &str) -> Option<&'a Quantity> {
    match path.rsplit_once('.') {
        None => found.headline(path),
        Some((section, key)) => found.at_path(section)?.quantity(key),
    }
}

/// Paths of all quantities.
fn paths(found: &Findings) -> Vec<String> {
    let mut paths: Vec<String> = found.headline.iter().map(|entry| entry.key.clone()).collect();
    found.walk(&mut |path, section| paths.extend(section.entries.iter().map(|entry| format!("{path}.{}", entry.key))));
    paths
}

/// The columns of kept quantities, known from the findings of a case.
///
/// # Errors
/// A path that these findings do not have.
pub fn columns(found: &Findings, keep: &[String]) -> Result<Vec<TableColumn>, Refusal> {
    let column = |path: &String| {
        let Some(of) = quantity(found, path) else {
            let (paths, last) = (paths(found), path.rsplit('.').next().unwrap_or(path));
            // Who knows the key and not the section is told the section.
            let same = paths.iter().find(|known| known.rsplit('.').next() == Some(last));
            let hint = match same {
                Some(same) => format!("; did you mean {same}?"),
                None => did_you_mean(paths.iter().map(String::as_str), path),
            };
            let problem = format!("`{path}` is no quantity of these cases{hint}");
            let way_out = "take keys of the headline, or paths below `sections` of results.json: docs/quantities.md";
            return Err(Refusal::new("keep", problem, way_out));
        };
        Ok(TableColumn {
            key: path.clone().into(),
            title: path.clone().into(),
            unit: of.unit().map(|unit| unit.to_owned().into()),
            definition: of.definition().to_owned().into(),
            why: None,
            chart: None,
        })
    };
    keep.iter().map(column).collect()
}

/// A value as it stands in a file: a number by the shortest text that reads back as the same.
fn text(of: &Quantity) -> String {
    match (of.whole(), of.value()) {
        (Some(count), _) => count.to_string(),
        (None, Some(value)) => format!("{value:?}"),
        (None, None) => of.words().unwrap_or_default().to_owned(),
    }
}

/// How a case went.
pub type CaseOutcome = Result<Findings, String>;

/// Cells of the kept quantities and of how it went, as they stand in a file; a quantity that is not there is empty.
pub fn cells(outcome: &CaseOutcome, keep: &[String]) -> Vec<String> {
    let empty = String::new;
    match outcome {
        Ok(found) => {
            let cell = |path: &String| quantity(found, path).map_or_else(empty, text);
            let count = |severity| found.warnings.iter().filter(|of| of.severity == severity).count().to_string();
            let ids: Vec<&str> = found.warnings.iter().map(|notice| &*notice.id).collect();
            let last = [count(Severity::Fault), count(Severity::Warning), ids.join(" "), empty()];
            keep.iter().map(cell).chain(last).collect()
        }
        Err(reason) => keep.iter().map(|_| empty()).chain([empty(), empty(), empty(), reason.clone()]).collect(),
    }
}
