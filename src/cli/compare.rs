//! `gearcut compare`: two results side by side.

use std::path::{Path, PathBuf};

use gearcut::compare::{Compared, Comparison};
use gearcut::output::results::Results;
use gearcut::output::text::Sheet;
use serde_json::json;

use super::args::CompareArguments;
use super::failure::Failure;
use super::{folder, print};

/// Runs the command.
pub fn run(arguments: &CompareArguments) -> Result<(), Failure> {
    let read = |path: &Path| -> Result<Compared, Failure> {
        Ok(Compared { name: folder::name_of(path), results: Results::read(path)? })
    };
    let (a, b) = (read(&arguments.a)?, read(&arguments.b)?);
    let out = arguments.out.clone().unwrap_or_else(|| beside(&arguments.b, &format!("compare_{}_{}", a.name, b.name)));
    let comparison = Comparison::new(a, b);
    let output = folder::open(&out, "compare")?;
    comparison.write(&output)?;
    let record = [("a", json!(arguments.a)), ("b", json!(arguments.b))];
    let path = folder::finish(output, "compare", record)?;

    let mut sheet = Sheet::default();
    comparison.print(&mut sheet);
    Ok(print::to_stdout(&format!("{}\ntable and charts are in {}\n", sheet.into_text(), path.display()))?)
}

/// A folder beside the one that holds the results.
fn beside(results: &Path, name: &str) -> PathBuf {
    let folder = if results.is_file() { results.parent().unwrap_or(results) } else { results };
    folder.parent().unwrap_or(Path::new("")).join(name)
}
