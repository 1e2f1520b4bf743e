//! `gearcut compare`: results side by side.

use std::path::{Path, PathBuf};

use gearcut::compare::{Compared, Comparison};
use gearcut::findings::Findings;
use gearcut::output::text::Sheet;
use serde_json::json;

use super::args::CompareArguments;
use super::failure::Failure;
use super::{folder, print};

/// Runs the command.
pub fn run(arguments: &CompareArguments) -> Result<(), Failure> {
    let paths = &arguments.results;
    let read = |path: &PathBuf| -> Result<Compared, Failure> {
        let folder = if path.is_file() { path.parent().unwrap_or(path) } else { path };
        Ok(Compared { name: folder::name_of(path), findings: Findings::read(path)?, folder: folder.to_owned() })
    };
    let results = paths.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    let names: Vec<&str> = results.iter().map(|one| one.name.as_str()).collect();
    let last = &paths[paths.len() - 1];
    let out = arguments.out.clone().unwrap_or_else(|| beside(last, &format!("compare_{}", names.join("_"))));
    let comparison =
        Comparison::new(results).map_err(|reason| gearcut::Error::Unreadable { path: last.clone(), reason })?;
    let (path, ()) = folder::fill(&out, "compare", |output, _| {
        comparison.write(output)?;
        Ok((vec![("results", json!(paths))], ()))
    })?;

    let mut sheet = Sheet::default();
    comparison.print(&mut sheet, print::width());
    Ok(print::sheet(&format!("{}\npage, table and charts are in {}\n", sheet.into_text(), path.display()))?)
}

/// A folder beside the one that holds the results.
fn beside(results: &Path, name: &str) -> PathBuf {
    let folder = if results.is_file() { results.parent().unwrap_or(results) } else { results };
    folder.parent().unwrap_or(Path::new("")).join(name)
}
