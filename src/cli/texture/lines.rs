//! Lines of `gearcut texture`: profile parameters through the chain of profiles.
//!
//! In: the surface as it was read; the profile options. Out: [`Lines`] for each `--line`, and one for `--lines`, as
//! words and as JSON. Limits of a drawing are judged by the largest value of the lines: no value may be above the limit
//! unless the drawing says otherwise (the default of ISO 21920-1, from memory).

use crate::measure::topography::line_form::LineForm;
use crate::measure::topography::parameters::{ParameterRange, of_profiles};
use crate::measure::topography::profile_chain::{CutOff, ProfileChain, ProfileKind, Profiles, ShortFilter};
use crate::measure::topography::{ProfileTrace, Surface, TextureError};
use crate::number_text::plain;
use crate::output::text::Sheet;
use gearcut_core::Refusal;
use serde_json::{Value, json};

use super::super::args::{LineArguments, LineFormChoice, ProfileChoice, TextureArguments};
use super::{by_symbol, number, row, table};

/// One line, or several with mean and range.
pub(super) struct Lines {
    title: String,
    places_um: Vec<f64>,
    found: Result<(Profiles, Vec<ParameterRange>), TextureError>,
    limits: Vec<(&'static str, f64)>,
}

/// Options that no line can make sensible.
pub(super) fn check(arguments: &TextureArguments) -> Result<(), Refusal> {
    let LineArguments { line, lines, cutoff_um, section_um, ra_limit_um, rz_limit_um, .. } = &arguments.lines;
    let any = !line.is_empty() || !lines.is_empty();
    let above_zero = [
        ("--cutoff-um", cutoff_um),
        ("--section-um", section_um),
        ("--ra-limit-um", ra_limit_um),
        ("--rz-limit-um", rz_limit_um),
    ];
    let of = |name: &str, value: f64, way_out: &str| Err(Refusal::new(name, format!("{value} um cannot be"), way_out));
    for (name, value) in above_zero {
        if let Some(value) = value.filter(|um| !(um.is_finite() && *um > 0.0)) {
            return of(name, value, "give a number above 0");
        }
    }
    let LineArguments { lambda_s_um, run_in_um, bridge_um, .. } = &arguments.lines;
    for (name, value) in [("--lambda-s-um", lambda_s_um), ("--run-in-um", run_in_um), ("--bridge-um", bridge_um)] {
        if let Some(value) = value.filter(|um| !(um.is_finite() && *um >= 0.0)) {
            return of(name, value, "give 0 or a positive number");
        }
    }
    let needless = |name: &str, problem: &str, way_out: &str| Err(Refusal::new(name, problem.to_owned(), way_out));
    if arguments.robust && arguments.filters.l_filter_um.is_none() && !any {
        return needless("--robust", "there is no L-filter that it could be of", "give --l-filter-um or --lines");
    }
    if arguments.lines.profile != ProfileChoice::R && (ra_limit_um.is_some() || rz_limit_um.is_some()) {
        return needless("--profile", "limits of Ra and Rz are judged on roughness", "use --profile r, or no limit");
    }
    if arguments.lines.profile == ProfileChoice::P && cutoff_um.is_some() {
        return needless("--cutoff-um", "a primary profile has no cut-off", "leave it out, or use --profile r or w");
    }
    Ok(())
}

/// The lines that were asked for.
///
/// # Errors
/// A line that cannot be read as one or lies beside the surface.
pub(super) fn evaluated(arguments: &TextureArguments, surface: &Surface) -> Result<Vec<Lines>, Refusal> {
    let wished = &arguments.lines;
    let lines_at = |title: String, across: char, indices: &[usize]| {
        let trace =
            |&i: &usize| if across == 'y' { ProfileTrace::row(surface, i) } else { ProfileTrace::column(surface, i) };
        let traces = indices.iter().map(trace).collect::<Result<Vec<ProfileTrace>, TextureError>>();
        let step_um = if across == 'y' { surface.dy_um() } else { surface.dx_um() };
        let places_um = indices.iter().map(|&i| i as f64 * step_um).collect();
        of_traces(arguments, title, places_um, traces)
    };
    let along = |across: char| if across == 'y' { 'x' } else { 'y' };
    let mut all = Vec::new();
    for wish in &wished.line {
        let (across, index, place_um) = place(wish, surface)?;
        all.push(lines_at(
            format!("profile along {} at {across} = {} um", along(across), plain(place_um)),
            across,
            &[index],
        ));
    }
    if let [across, count] = wished.lines.as_slice() {
        let (across, indices) = spread(across, count, surface)?;
        all.push(lines_at(format!("{} profiles along {}", indices.len(), along(across)), across, &indices));
    }
    Ok(all)
}

/// Traces with the places that they were taken at.
pub(super) fn of_traces(
    arguments: &TextureArguments,
    title: String,
    places_um: Vec<f64>,
    traces: Result<Vec<ProfileTrace>, TextureError>,
) -> Lines {
    let found = traces.and_then(|traces| chain(arguments).evaluate(&traces)).map(|profiles| {
        let spread = of_profiles(&profiles, &arguments.at_height_um);
        (profiles, spread)
    });
    let limits = [("Ra", arguments.lines.ra_limit_um), ("Rz", arguments.lines.rz_limit_um)];
    let limits = limits.into_iter().filter_map(|(name, um)| Some((name, um?))).collect();
    Lines { title, places_um, found, limits }
}

fn chain(arguments: &TextureArguments) -> ProfileChain {
    let wished = &arguments.lines;
    let cutoff = match (wished.cutoff_um.or(arguments.filters.l_filter_um), wished.ra_limit_um, wished.rz_limit_um) {
        (Some(um), ..) => CutOff::Um(um),
        (None, Some(ra), _) => CutOff::OfRaLimit(ra),
        (None, None, Some(rz)) => CutOff::OfRzLimit(rz),
        (None, None, None) => CutOff::Estimated,
    };
    ProfileChain {
        kind: match wished.profile {
            ProfileChoice::R => ProfileKind::Roughness,
            ProfileChoice::W => ProfileKind::Waviness,
            ProfileChoice::P => ProfileKind::Primary,
        },
        form: match wished.line_form {
            LineFormChoice::None => LineForm::None,
            LineFormChoice::Line => LineForm::Line,
            LineFormChoice::Arc => LineForm::Arc,
            LineFormChoice::Poly2 => LineForm::Polynomial(2),
            LineFormChoice::Poly3 => LineForm::Polynomial(3),
            LineFormChoice::Poly4 => LineForm::Polynomial(4),
            LineFormChoice::Poly5 => LineForm::Polynomial(5),
        },
        s_filter: match wished.lambda_s_um {
            None => ShortFilter::OfClass,
            Some(0.0) => ShortFilter::None,
            Some(um) => ShortFilter::Um(um),
        },
        cutoff,
        robust: arguments.robust,
        section_um: wished.section_um,
        sections: wished.sections.map(usize::from),
        run_in_um: wished.run_in_um,
        bridge_um: wished.bridge_um,
    }
}

/// Number of rows (across y) or columns (across x), and their distance, um.
fn across_of(axis: &str, surface: &Surface) -> Option<(char, usize, f64)> {
    match axis {
        "y" => Some(('y', surface.ny(), surface.dy_um())),
        "x" => Some(('x', surface.nx(), surface.dx_um())),
        _ => None,
    }
}

/// Row or column of `y=UM` or `x=UM`, and where it is, um.
fn place(wish: &str, surface: &Surface) -> Result<(char, usize, f64), Refusal> {
    let refuse = |problem: String| Refusal::new("--line", problem, "write y=UM for a row or x=UM for a column");
    let (axis, place) = wish.split_once('=').ok_or_else(|| refuse(format!("`{wish}` names no line")))?;
    let place_um: f64 = place.parse().map_err(|_| refuse(format!("`{place}` is not a number of um")))?;
    let (across, count, spacing_um) =
        across_of(axis, surface).ok_or_else(|| refuse(format!("`{axis}` is neither x nor y")))?;
    let index = (place_um / spacing_um).round();
    if !(index >= 0.0 && index < count as f64) {
        let end_um = spacing_um * (count - 1) as f64;
        return Err(refuse(format!("{axis} = {place_um} um lies outside the surface, 0 to {end_um} um")));
    }
    Ok((across, index as usize, index * spacing_um))
}

/// Rows or columns in the middles of so many equal parts of the surface.
fn spread(axis: &str, count: &str, surface: &Surface) -> Result<(char, Vec<usize>), Refusal> {
    let refuse = |problem: String| {
        Refusal::new("--lines", problem, "write y N for N rows or x N for N columns, as in --lines y 5")
    };
    let (across, all, _) = across_of(axis, surface).ok_or_else(|| refuse(format!("`{axis}` is neither x nor y")))?;
    let lines = count.parse().ok().filter(|lines| (2..=all).contains(lines));
    let lines: usize = lines
        .ok_or_else(|| refuse(format!("`{count}` is no number of lines from 2 to {all}, which the surface has")))?;
    Ok((across, (0..lines).map(|i| (2 * i + 1) * all / (2 * lines)).collect()))
}

impl Lines {
    /// Largest value of a parameter over the lines.
    fn largest(&self, symbol: &str) -> Option<f64> {
        let (_, spread) = self.found.as_ref().ok()?;
        spread.iter().find(|of| of.mean.symbol == symbol)?.range.map(|[_, high]| high)
    }

    /// As JSON.
    pub(super) fn document(&self) -> Value {
        let mut document = json!({"line": self.title, "at_um": self.places_um});
        let (profiles, spread) = match &self.found {
            Ok(found) => found,
            Err(why) => {
                document["parameters"] = Value::Null;
                document["why"] = why.to_string().into();
                return document;
            }
        };
        let means: Vec<_> = spread.iter().map(|of| of.mean.clone()).collect();
        document["chain"] = json!(profiles.words);
        document["cutoff_um"] = json!(profiles.cutoff_um);
        document["evaluation_length_um"] = json!(profiles.evaluation_um);
        document["parameters"] = json!(by_symbol(&means));
        if self.places_um.len() > 1 {
            let ranges = spread.iter().map(|of| (of.mean.symbol.clone(), json!(of.range)));
            document["ranges"] = Value::Object(ranges.collect());
            let missing = self.missing(profiles).map(|(place_um, why)| json!({"at_um": place_um, "why": why}));
            document["lines_without_parameters"] = missing.collect();
        }
        if !self.limits.is_empty() {
            let judged = |&(symbol, limit): &(&str, f64)| {
                let largest = self.largest(symbol);
                let kept = largest.map(|largest| largest <= limit);
                (symbol.to_owned(), json!({"limit_um": limit, "largest_um": largest, "kept": kept}))
            };
            document["limits"] = Value::Object(self.limits.iter().map(judged).collect());
        }
        document
    }

    /// Lines that have no parameters, and why.
    fn missing<'a>(&'a self, profiles: &'a Profiles) -> impl Iterator<Item = (f64, String)> {
        let lines = self.places_um.iter().zip(&profiles.lines);
        lines.filter_map(|(place_um, line)| Some((*place_um, line.as_ref().err()?.to_string())))
    }

    /// As words.
    pub(super) fn write(&self, sheet: &mut Sheet) {
        sheet.heading(&self.title);
        let (profiles, spread) = match &self.found {
            Ok(found) => found,
            Err(why) => return sheet.line("none", why.to_string()),
        };
        if self.places_um.len() > 1 {
            let places: Vec<String> = self.places_um.iter().map(|um| plain(*um)).collect();
            sheet.line("at", format!("{} um", places.join(", ")));
        }
        for words in &profiles.words {
            let (name, what) = words.split_once(": ").unwrap_or((words, ""));
            sheet.line(name, what);
        }
        for (place_um, why) in self.missing(profiles) {
            sheet.line("left out", format!("the line at {} um: {why}", plain(place_um)));
        }
        for (symbol, limit) in &self.limits {
            let verdict = match self.largest(symbol) {
                Some(largest) if largest <= *limit => format!("kept: largest {} um", number(largest)),
                Some(largest) => format!("exceeded: largest {} um", number(largest)),
                None => "not judged: no line has it".to_owned(),
            };
            sheet.line(&format!("limit {symbol} {} um", plain(*limit)), verdict);
        }
        let rows = spread.iter().map(|of| {
            let [symbol, value, words] = row(&of.mean);
            let range = of.range.filter(|_| self.places_um.len() > 1);
            let range = range.map(|[low, high]| format!("{} to {}; ", number(low), number(high))).unwrap_or_default();
            [symbol, value, format!("{range}{words}")]
        });
        table(sheet, &rows.collect::<Vec<_>>());
    }
}
