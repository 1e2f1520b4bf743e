//! `gearcut texture`: parameters of a surface from any instrument or simulation.

mod lines;
mod reading;

use std::path::Path;

use crate::findings::Entry;
use crate::interrupt::Interrupt;
use crate::measure::topography::height_steps::coarse_step_um;
use crate::measure::topography::{Arguments, Chain, Evaluation, Parameter, ProfileTrace, Surface, TextureError};
use crate::number_text::{plain, significant};
use crate::output::surface_files::{SurfaceFile, write_surface};
use crate::output::text::Sheet;
use gearcut_core::Refusal;
use serde_json::{Value, json};

use super::args::TextureArguments;
use super::failure::Failure;
use super::folder::listening;
use super::print;
use lines::Lines;
use reading::{FileFound, Reading};

/// Runs the command.
pub fn run(arguments: &TextureArguments) -> Result<(), Failure> {
    check(arguments)?;
    let saves = reading::saves(arguments)?;
    let file = match reading::reading(arguments)? {
        FileFound::Surface(file) => file,
        FileFound::Profile(file) => return profile(arguments, file),
    };
    // Only files have temporary names that Ctrl-C must not leave; without them it ends the program at once.
    let interrupt = match arguments.save.first() {
        Some(first) => Interrupt::listen().map_err(listening(first))?,
        None => Interrupt::default(),
    };
    for (path, format) in saves {
        let saved = SurfaceFile { surface: file.surface.clone(), notes: file.notes.clone() };
        write_surface(path, format, &saved)?;
        interrupt.check()?;
    }
    let chain = Chain {
        form: arguments.filters.form.form(),
        s_filter_um: arguments.filters.s_filter_um,
        l_filter_um: arguments.filters.l_filter_um,
        robust: arguments.robust,
        crop_um: arguments.crop_um,
    };
    let unsuited = |problem: TextureError| {
        Refusal::new(
            "gearcut texture",
            format!("{}: {problem}", arguments.file.display()),
            "use another form, other nesting indices or a smaller crop",
        )
    };
    let more =
        Arguments { heights_um: arguments.at_height_um.clone(), ratios_percent: arguments.at_ratio_percent.clone() };
    let evaluated = || -> Result<_, Failure> {
        let (surface, words) = chain.apply(&file.surface).map_err(unsuited)?;
        interrupt.check()?;
        let evaluation = Evaluation::of(&surface, &more);
        let lines = lines::evaluated(arguments, &file.surface)?;
        interrupt.check()?;
        Ok((surface, words, evaluation, lines))
    };
    let (surface, words, evaluation, lines) = print::waiting("texture", "surface", evaluated)?;
    if arguments.json {
        let document = document(&arguments.file, &file, &surface, &words, &evaluation, &lines);
        return Ok(print::to_stdout(&format!("{document:#}\n"))?);
    }
    Ok(print::sheet(&sheet(&arguments.file, &file, &surface, &words, &evaluation, &lines))?)
}

/// A file that is a profile: its parameters through the chain of profiles.
fn profile(arguments: &TextureArguments, file: Reading<ProfileTrace>) -> Result<(), Failure> {
    let (count, spacing_um) = (file.surface.heights_um().len(), file.surface.spacing_um());
    let holes = file.surface.heights_um().iter().filter(|z| z.is_nan()).count();
    let lines = lines::of_traces(arguments, "profile".to_owned(), vec![0.0], Ok(vec![file.surface]));
    if arguments.json {
        let document = json!({
            "program": "gearcut",
            "program_version": env!("CARGO_PKG_VERSION"),
            "file": arguments.file.display().to_string(),
            "read": {"points": count, "spacing_um": spacing_um, "holes": holes, "remarks": file.remarks},
            "warnings": file.doubts,
            "profiles": [lines.document()],
        });
        return Ok(print::to_stdout(&format!("{document:#}\n"))?);
    }
    let mut sheet = Sheet::default();
    sheet.heading(&format!("{}", arguments.file.display()));
    sheet.line("points", format!("{count}, {} um apart: a profile", plain(spacing_um)));
    for remark in &file.remarks {
        sheet.line("as read", remark);
    }
    for doubt in &file.doubts {
        sheet.line("warning", doubt);
    }
    lines.write(&mut sheet);
    Ok(print::sheet(&sheet.into_text())?)
}

/// Numbers that no file can make sensible.
fn check(arguments: &TextureArguments) -> Result<(), Refusal> {
    let positive = |name: &str, values: &[f64]| match values.iter().find(|v| !(v.is_finite() && **v > 0.0)) {
        Some(value) => Err(Refusal::new(name, format!("{value} um is not a positive length"), "give a number above 0")),
        None => Ok(()),
    };
    positive("--spacing-um", &arguments.reading.spacing_um)?;
    positive("--s-filter-um", arguments.filters.s_filter_um.as_slice())?;
    positive("--l-filter-um", arguments.filters.l_filter_um.as_slice())?;
    lines::check(arguments)?;
    if !(arguments.crop_um.is_finite() && arguments.crop_um >= 0.0) {
        let problem = format!("{} um is not a margin", arguments.crop_um);
        return Err(Refusal::new("--crop-um", problem, "give 0 or a positive number"));
    }
    if let Some(ratio) = arguments.at_ratio_percent.iter().find(|p| !(0.0..=100.0).contains(*p)) {
        let problem = format!("{ratio} % is no material ratio");
        return Err(Refusal::new("--at-ratio-percent", problem, "give a number from 0 to 100"));
    }
    if let Some(height) = arguments.at_height_um.iter().find(|c| !c.is_finite()) {
        return Err(Refusal::new("--at-height-um", format!("{height} is no height"), "give a number of um"));
    }
    Ok(())
}

/// Parameters as an object.
fn by_symbol(parameters: &[Parameter]) -> serde_json::Map<String, Value> {
    parameters.iter().map(|of| (of.symbol.clone(), json!(Entry::from(of).quantity))).collect()
}

fn document(
    path: &Path,
    file: &Reading<Surface>,
    surface: &Surface,
    chain: &[String],
    evaluation: &Evaluation,
    lines: &[Lines],
) -> Value {
    let lines: Vec<Value> = lines.iter().map(Lines::document).collect();
    let notes: serde_json::Map<String, Value> =
        file.notes.iter().map(|(name, text)| (name.clone(), text.clone().into())).collect();
    json!({
        "program": "gearcut",
        "program_version": env!("CARGO_PKG_VERSION"),
        "file": path.display().to_string(),
        "notes": notes,
        "read": {
            "nx": file.surface.nx(),
            "ny": file.surface.ny(),
            "dx_um": file.surface.dx_um(),
            "dy_um": file.surface.dy_um(),
            "holes": file.surface.holes(),
            "remarks": file.remarks,
        },
        "evaluated": {"nx": surface.nx(), "ny": surface.ny(), "holes": surface.holes()},
        "warnings": warnings(file),
        "angles": "counter-clockwise from +x (along a row) towards +y (from row to row)",
        "chain": chain,
        "parameters": by_symbol(&evaluation.parameters),
        "profiles": lines,
    })
}

fn sheet(
    path: &Path,
    file: &Reading<Surface>,
    surface: &Surface,
    chain: &[String],
    evaluation: &Evaluation,
    lines: &[Lines],
) -> String {
    let mut sheet = Sheet::default();
    let read = &file.surface;
    sheet.heading(&format!("{}", path.display()));
    let [x, y] = read.size_mm();
    sheet.line(
        "points",
        format!("{} x {}, {} x {} um apart", read.nx(), read.ny(), plain(read.dx_um()), plain(read.dy_um())),
    );
    sheet.line("size", format!("{} x {} mm", significant(x, 4), significant(y, 4)));
    if read.holes() > 0 {
        sheet.line("holes", read.holes().to_string());
    }
    for remark in &file.remarks {
        sheet.line("as read", remark);
    }
    for warning in warnings(file) {
        sheet.line("warning", warning);
    }
    for step in chain {
        let (name, what) = step.split_once(": ").unwrap_or((step, ""));
        sheet.line(name, what);
    }
    let [x, y] = surface.size_mm();
    sheet.line("evaluated", format!("{} x {} mm", significant(x, 4), significant(y, 4)));
    let mut family = "";
    let mut rows = Vec::new();
    for parameter in &evaluation.parameters {
        if parameter.family != family {
            flush(&mut sheet, family, &mut rows);
            family = parameter.family;
        }
        rows.push(row(parameter));
    }
    flush(&mut sheet, family, &mut rows);
    for line in lines {
        line.write(&mut sheet);
    }
    sheet.into_text()
}

/// What a reader must know of the heights as they were read.
fn warnings(file: &Reading<Surface>) -> Vec<String> {
    let coarse = |step: f64| {
        format!(
            "heights go in steps of {} um, more than a tenth of their root mean square height: slopes, peaks and the \
             ends of curves are those of the steps",
            significant(step, 3)
        )
    };
    file.doubts.iter().cloned().chain(coarse_step_um(&file.surface).map(coarse)).collect()
}

/// Symbol, value with unit, definition.
fn row(parameter: &Parameter) -> [String; 3] {
    let value = match &parameter.value {
        Ok(value) if parameter.unit == "1" => number(*value),
        Ok(value) => format!("{} {}", number(*value), parameter.unit),
        Err(why) => return [parameter.symbol.clone(), "none".to_owned(), format!("{why} ({})", parameter.definition)],
    };
    [parameter.symbol.clone(), value, parameter.definition.clone()]
}

/// Five digits, with an exponent where a plain number would be mostly zeros.
fn number(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-4 { format!("{value:.4e}") } else { significant(value, 5) }
}

fn flush(sheet: &mut Sheet, family: &str, rows: &mut Vec<[String; 3]>) {
    if !rows.is_empty() {
        sheet.heading(&format!("{family} parameters"));
        table(sheet, rows);
        rows.clear();
    }
}

/// Values to the right, words after them to the left.
fn table(sheet: &mut Sheet, rows: &[[String; 3]]) {
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let (symbols, values) = (width(0), width(1));
    for [symbol, value, words] in rows {
        sheet.words(&format!("{symbol:<symbols$}   {value:>values$}   {words}"));
    }
}
