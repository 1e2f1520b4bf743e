//! Numbers of a measured surface: evaluated as the scene evaluates the window that it was measured in.
//!
//! In: a surface file, the windows of the scene, symbols of ISO 25178-2. Out: numbers by their paths in `results.json`.
//! The window is the one that the file names in its notes (gearcut's own do), the scene's only one, or the one behind
//! `@`. Its F-operator and its filters are applied; lines go through the same chain of profiles. The stated share is
//! the uncertainty of each number, of heights at least that of Sa: what is nearly nothing (Svk of feed marks) is not
//! known any better.
//!
//! Road not taken: heights point by point. Nobody finds a window again to a micrometre, and noise makes other heights
//! in every window of equal numbers.

use super::measured::{MeasuredNumber, MeasuredWish};
use crate::findings::Notice;
use crate::influence::notices::{OtherSize, OtherSpacing};
use crate::job::GearJob;
use crate::measure::topography::{Arguments, Evaluation, Parameter, TextureError};
use crate::number_text::significant;
use crate::output::atomic::file_error;
use crate::output::surface_files::{SurfaceFile, read_surface};
use crate::texture::{Direction, NamedWindow, SURFACE_NOTE, named_windows, of_surface, roughness_path};
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::units::UM_PER_MM;
use std::path::Path;

/// Windows whose lengths differ by less than this share are one: a step at either end of a hundred.
const SAME_LENGTH: f64 = 0.02;
/// Spacings whose ratio is below this are one.
const SAME_SPACING: f64 = 1.25;

/// Numbers of a surface, and a note where it is larger or smaller than its window.
///
/// # Errors
/// A file that is no surface; a window that the scene does not have, or several that it could be; a parameter that the
/// surface does not have; no uncertainty.
pub(super) fn read(gear: &dyn GearJob, name: &str, wish: &MeasuredWish) -> Result<(Vec<MeasuredNumber>, Vec<Notice>)> {
    let (path, window) = match name.rsplit_once('@') {
        Some((path, window)) if !Path::new(name).exists() => (path, Some(window)),
        _ => (name, None),
    };
    let percent = wish.surface_percent.ok_or_else(|| {
        let problem = format!("{path} says no uncertainty of its numbers");
        Refusal::new("--surface-percent", problem, "give the standard uncertainty of Sa and its like, per cent of them")
    })?;
    let file = read_surface(Path::new(path), None).map_err(file_error)?;
    let found = window_of(&named_windows(gear)?, &file, path, window)?;
    let unreadable = |reason: String| Error::Unreadable { path: path.into(), reason };
    let unfit = |why: TextureError| unreadable(why.to_string());
    let (surface, _) = found.window.chain.apply(&file.surface).map_err(unfit)?;
    let evaluation = Evaluation::of(&surface, &Arguments::default());
    let number = |symbol: &String| {
        let way =
            Direction::BOTH.into_iter().find_map(|way| Some((way, symbol.strip_prefix(way.key())?.strip_prefix('.')?)));
        let (quantity, parameter) = match way {
            Some((way, symbol)) => {
                let lines = of_surface(gear, &found.window, &file.surface, way).map_err(unfit)?;
                (format!("{}.{symbol}", roughness_path(&found.path, way)), parameter_of(&lines, symbol)?.clone())
            }
            None => {
                (format!("{}.parameters.{symbol}", found.path), parameter_of(&evaluation.parameters, symbol)?.clone())
            }
        };
        let value = parameter.value.clone().map_err(|why| unreadable(format!("it has no {symbol}: {why}")))?;
        let least = if parameter.unit == "um" { evaluation.value("Sa").unwrap_or_default() } else { 0.0 };
        let uncertainty = 0.01 * percent * value.abs().max(least);
        if uncertainty == 0.0 {
            return Err(unreadable(format!("{symbol} is 0, and so would be its uncertainty")));
        }
        Ok(MeasuredNumber { quantity, value, uncertainty })
    };
    let numbers = wish.symbols.iter().map(number).collect::<Result<Vec<_>>>()?;
    let size_mm = file.surface.size_mm();
    let own_mm = found.window.length_mm();
    let differs = (0..2).any(|k| (size_mm[k] - own_mm[k]).abs() > SAME_LENGTH * own_mm[k]);
    let words = |[x, y]: [f64; 2]| format!("{} x {} mm", significant(x, 3), significant(y, 3));
    let mut notes = Vec::new();
    if differs {
        notes.push(OtherSize { path, size: words(size_mm), window: words(own_mm) }.notice());
    }
    let points_um = [file.surface.dx_um(), file.surface.dy_um()];
    let own_um = found.window.spacing_mm().map(|mm| mm * UM_PER_MM);
    if (0..2).any(|k| !(1.0 / SAME_SPACING..=SAME_SPACING).contains(&(points_um[k] / own_um[k]))) {
        let words = |[x, y]: [f64; 2]| format!("{} x {} um", significant(x, 3), significant(y, 3));
        notes.push(OtherSpacing { path, apart: words(points_um), window: words(own_um) }.notice());
    }
    Ok((numbers, notes))
}

fn parameter_of<'a>(parameters: &'a [Parameter], symbol: &str) -> Result<&'a Parameter, Refusal> {
    parameters.iter().find(|parameter| parameter.symbol == *symbol).ok_or_else(|| {
        let all: Vec<&str> = parameters.iter().map(|of| of.symbol.as_str()).collect();
        let problem =
            format!("`{symbol}` is no parameter of surfaces, nor of lines behind along_profile. or along_tooth.");
        Refusal::new("--surface-numbers", problem, format!("choose among {}", all.join(", ")))
    })
}

/// The window of a surface.
fn window_of(
    windows: &[NamedWindow],
    file: &SurfaceFile,
    path: &str,
    asked: Option<&str>,
) -> Result<NamedWindow, Refusal> {
    let noted = file.notes.iter().find(|(name, _)| name == SURFACE_NOTE).map(|(_, words)| words.as_str());
    let mut fitting: Vec<NamedWindow> = match (asked, noted) {
        (Some(asked), _) => {
            let suits = |window: &&NamedWindow| window.path.strip_prefix("texture.") == Some(asked);
            windows.iter().filter(suits).cloned().collect()
        }
        (None, Some(noted)) => windows.iter().filter(|window| window.words == noted).cloned().collect(),
        (None, None) => Vec::new(),
    };
    if asked.is_none() && fitting.is_empty() && windows.len() == 1 {
        fitting = windows.to_vec();
    }
    match fitting.len() {
        1 => Ok(fitting.remove(0)),
        found => {
            let all: Vec<&str> = windows.iter().map(|window| window.path.trim_start_matches("texture.")).collect();
            let what = match (asked, found) {
                (Some(asked), _) => format!("the scene has no window {asked}"),
                (None, 0) => format!("{path} does not say in which window it was measured"),
                (None, _) => format!("{path} could be of several windows"),
            };
            let way_out = format!("write {path}@WINDOW; the scene has {}", all.join(", "));
            Err(Refusal::new("--measured", what, way_out))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::topography::Surface;
    use crate::process;
    use std::path::PathBuf;

    /// Waves along the profile, over a tilt and a bend that the window's form takes off: Sa = 2 A / pi and Sq =
    /// A / sqrt(2) of a sine.
    #[test]
    fn a_measured_surface_is_evaluated_as_its_window_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("wave.csv");
        let (nx, ny, step_um) = (11, 801, 5.0);
        let height = |i: usize| {
            let (x, y) = ((i % nx) as f64 / nx as f64, (i / nx) as f64 / (ny - 1) as f64);
            0.8 * (std::f64::consts::TAU * 20.0 * y).sin() + 5.0 * x + 30.0 * y + 12.0 * y * y
        };
        let surface = Surface::new(nx, ny, 100.0, step_um, (0..nx * ny).map(height).collect()).expect("a surface");
        let file = SurfaceFile { surface, notes: Vec::new() };
        let csv = crate::output::surface_files::Format::Csv;
        crate::output::surface_files::write_surface(&path, csv, &file).expect("written");
        let scene = "
            [gear]
            module_mm = 3.0
            teeth = 24
            face_width_mm = 20.0
            [tool.shaper_cutter]
            teeth = 20
            [[texture]]
            tooth = 3
            side = \"left\"
            length_profile_mm = 4.0
            length_lead_mm = 1.0
            [[texture]]
            tooth = 3
            side = \"left\"
            operation = \"rough\"
        ";
        let evaluated_symbols = |settings: &[&str], name: String, percent: Option<f64>, symbols: Vec<String>| {
            let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
            let loaded = process::parse(scene, "scene.toml", &PathBuf::new(), &settings).expect("a scene");
            let wish = MeasuredWish { noise_um: None, surface_percent: percent, symbols };
            let mut found = None;
            let prepared = process::prepare(&loaded.scene).expect("a gear");
            let done = prepared.with_gear(&mut |gear| {
                found = Some(read(gear, &name, &wish)?);
                Ok(())
            });
            done.map(|()| found.expect("a gear")).map_err(|error| error.to_string())
        };
        let evaluated = |settings: &[&str], name: String, percent: Option<f64>| {
            evaluated_symbols(settings, name, percent, vec!["Sa".to_owned(), "Sq".to_owned()])
        };
        let name = path.display().to_string();
        let asked = format!("{name}@finish.tooth_03_left");
        let (numbers, notes) = evaluated(&[], asked.clone(), Some(5.0)).expect("a surface");
        assert_eq!(numbers[0].quantity, "texture.finish.tooth_03_left.parameters.Sa");
        let expected = [2.0 / std::f64::consts::PI, 0.5_f64.sqrt()].map(|share| 0.8 * share);
        for (number, expected) in numbers.iter().zip(expected) {
            assert!((number.value / expected - 1.0).abs() < 0.01, "{number:?}, {expected}");
            assert!((number.uncertainty / number.value - 0.05).abs() < 1e-12);
        }
        assert!(notes.iter().any(|of| of.text.contains("100 x 5.00 um apart")), "the file is coarser along the tooth");
        let alike = evaluated(&["texture.0.lead_spacing_um=100"], asked.clone(), Some(5.0)).expect("a surface");
        assert!(alike.1.is_empty());
        // The same without the window's form is the bend.
        let (bent, _) = evaluated(&["texture.0.form=none"], asked.clone(), Some(5.0)).expect("a surface");
        assert!(bent[0].value > 5.0, "{bent:?}");
        let (_, notes) = evaluated(&["texture.0.length_profile_mm=2"], asked.clone(), Some(5.0)).expect("a surface");
        assert!(notes.iter().any(|of| of.text.contains("4.00 mm") && of.text.contains("2.00 mm")));
        // The waves are 200 um long: an S-filter of L lets 2^-(L / 200)^2 of them pass, an L-filter the rest.
        let filtered = |filter: &str| {
            let setting = format!("texture.0.{filter}");
            evaluated(&[&setting], asked.clone(), Some(5.0)).expect("a surface").0[0].value
        };
        // At both ends more passes. The two numbers are sums of the weighted straight line of ISO 16610-21 over the 801
        // points, less their parabola, written out apart from this program.
        let passed = 2_f64.powf(-(250.0_f64 / 200.0).powi(2));
        for (filter, wanted) in [("s_filter_um=250", 0.182_134_83), ("l_filter_um=250", 0.330_868_75)] {
            let value = filtered(filter);
            assert!((value / wanted - 1.0).abs() < 1e-5, "{filter}: {value}, not {wanted}");
            let inside = if filter.starts_with('s') { passed } else { 1.0 - passed };
            assert!((value / (inside * expected[0]) - 1.0).abs() < 0.06, "{filter}: {value}");
        }
        // Lines along the profile: a cut-off of 250 um leaves 1 - 2^-(250 / 200)^2 of the waves.
        let line = |cutoff: &str| {
            let setting = format!("texture.0.cutoff_um={cutoff}");
            let wish_of = vec!["along_profile.Ra".to_owned()];
            evaluated_symbols(&[&setting], asked.clone(), Some(5.0), wish_of).expect("lines").0[0].clone()
        };
        let ra = line("250");
        assert_eq!(ra.quantity, "roughness.finish.tooth_03_left_along_profile.Ra");
        assert!((ra.value / ((1.0 - passed) * expected[0]) - 1.0).abs() < 0.02, "{ra:?}");
        // Two operations: the file does not say which.
        let unsaid = evaluated(&[], name, Some(5.0)).expect_err("two windows");
        assert!(unsaid.contains("finish.tooth_03_left, rough.tooth_03_left"), "{unsaid}");
        assert!(evaluated(&[], asked, None).expect_err("no uncertainty").contains("--surface-percent"));
    }
}
