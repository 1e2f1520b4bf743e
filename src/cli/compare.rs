//! `gearcut compare`: results side by side, or two surfaces of one place.

use std::path::{Path, PathBuf};

use crate::compare::{Compared, Comparison, surfaces as surface_folder};
use crate::findings::Findings;
use crate::measure::topography::Chain;
use crate::output::surface_files::read_surface;
use crate::output::text::Sheet;
use crate::overlay::SurfaceComparison;
use gearcut_core::Refusal;
use serde_json::json;

use super::args::CompareArguments;
use super::failure::Failure;
use super::{folder, print};

/// Runs the command.
pub fn run(arguments: &CompareArguments) -> Result<(), Failure> {
    let paths = &arguments.results;
    let is_surface = |path: &PathBuf| path.is_file() && path.extension().is_none_or(|ending| ending != "json");
    match &paths[..] {
        // A surface beside a path that leads nowhere is an error of that path.
        [a, b] if [a, b].iter().all(|&of| is_surface(of) || !of.exists()) && (a.is_file() || b.is_file()) => {
            return surfaces(arguments, [a, b]);
        }
        _ => refuse_mixed(paths.iter().find(|path| is_surface(path)))?,
    }
    let read = |path: &PathBuf| -> Result<Compared, Failure> {
        let folder = if path.is_file() { path.parent().unwrap_or(path) } else { path };
        Ok(Compared { name: folder::name_of(path), findings: Findings::read(path)?, folder: folder.to_owned() })
    };
    let results = paths.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    let names: Vec<&str> = results.iter().map(|one| one.name.as_str()).collect();
    let last = &paths[paths.len() - 1];
    let out = arguments.out.clone().unwrap_or_else(|| beside(last, &format!("compare_{}", names.join("_"))));
    let comparison =
        Comparison::new(results).map_err(|reason| gearcut_core::Error::Unreadable { path: last.clone(), reason })?;
    let (path, ()) = folder::fill(&out, "compare", |output, _| {
        comparison.write(output)?;
        Ok((vec![("results", json!(paths))], ()))
    })?;

    let mut sheet = Sheet::default();
    comparison.print(&mut sheet, print::width(), arguments.all);
    let more = if arguments.all { "" } else { "; --all prints headline and summary whole" };
    Ok(print::sheet(&format!("{}\npage, table and charts are in {}{more}\n", sheet.into_text(), path.display()))?)
}

/// Results and surfaces are not compared with each other, nor more than two surfaces.
fn refuse_mixed(surface: Option<&PathBuf>) -> Result<(), Refusal> {
    surface.map_or(Ok(()), |path| {
        let problem = format!("{} is a file, but no results.json", path.display());
        Err(Refusal::new("gearcut compare", problem, "give output folders, or two surface files"))
    })
}

/// Compares two surface files.
fn surfaces(arguments: &CompareArguments, paths: [&PathBuf; 2]) -> Result<(), Failure> {
    let chain = Chain {
        s_filter_um: arguments.filters.s_filter_um,
        l_filter_um: arguments.filters.l_filter_um,
        ..Chain::of_form(arguments.filters.form.form())
    };
    for (option, index_um) in [("--s-filter-um", chain.s_filter_um), ("--l-filter-um", chain.l_filter_um)] {
        if let Some(index_um) = index_um.filter(|um| !(um.is_finite() && *um > 0.0)) {
            let problem = format!("{index_um} um is not a positive length");
            return Err(Refusal::new(option, problem, "give a number above 0").into());
        }
    }
    let files = [read_surface(paths[0], None)?, read_surface(paths[1], None)?];
    let stems = paths.map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned());
    let names = if stems[0] == stems[1] { paths.map(|path| path.display().to_string()) } else { stems.clone() };
    let beside = paths[1].parent().unwrap_or(Path::new("")).join(format!("compare_{}_{}", stems[0], stems[1]));
    let out = arguments.out.clone().unwrap_or(beside);
    let comparison = SurfaceComparison::new(names, [&files[0].surface, &files[1].surface], &chain)
        .map_err(|problem| Refusal::new("gearcut compare", problem, "compare two surfaces of one place"))?;
    let (path, ()) = folder::fill(&out, "compare", |output, _| {
        surface_folder::write(&comparison, output)?;
        Ok((vec![("surfaces", json!(paths))], ()))
    })?;
    let mut sheet = Sheet::default();
    surface_folder::print(&comparison, &mut sheet);
    Ok(print::sheet(&format!("{}\npage, table, maps and charts are in {}\n", sheet.into_text(), path.display()))?)
}

/// A folder beside the one that holds the results.
fn beside(results: &Path, name: &str) -> PathBuf {
    let folder = if results.is_file() { results.parent().unwrap_or(results) } else { results };
    folder.parent().unwrap_or(Path::new("")).join(name)
}
