//! Roughness of profiles as findings: a section for each operation, in it one for each window and direction, and what
//! the drawing's limits say of them.

use super::files::stems;
use super::findings::{key_of, quantities};
use super::traces::{Direction, OfLines, Traced};
use super::{Window, WindowTexture};
use crate::findings::notices::{RoughnessLimit, RoughnessNotJudged};
use crate::findings::{Notice, Quantity, Section};
use crate::job::GearJob;
use crate::measure::topography::Parameter;
use crate::measure::topography::parameters::{ParameterRange, of_profiles};
use crate::scene::model::DrawnLimits;

/// Key of the section.
pub const ROUGHNESS: &str = "roughness";

/// Path of the section of a window's lines, from that of the window.
pub fn roughness_path(window: &str, direction: Direction) -> String {
    let rest = window.strip_prefix("texture.").unwrap_or(window);
    format!("{ROUGHNESS}.{rest}_{}", direction.key())
}

/// Parameters with a limit, and where that is.
fn limited(limits: &DrawnLimits) -> [(&'static str, Option<f64>); 2] {
    [("Ra", limits.ra_um), ("Rz", limits.rz_um)]
}

/// Roughness of all windows along profile and tooth, operation by operation.
pub fn roughness(job: &dyn GearJob, textures: &[WindowTexture]) -> Section {
    let stems = stems(job, textures);
    let limits = &job.scene().measure.limits;
    let operations = job.operations();
    let of = |index: usize| {
        let windows = textures.iter().zip(&stems).filter(move |(texture, _)| texture.window.operation == index);
        windows.flat_map(|(texture, stem)| texture.traces.iter().map(move |traced| (&texture.window, stem, traced)))
    };
    let parts = operations.iter().enumerate().filter(|(index, _)| of(*index).next().is_some());
    let parts = parts.map(|(index, (name, _))| {
        let lines = of(index).map(|(window, stem, traced)| section(window, stem, traced, limits));
        Section::new(*name, format!("Left by {name}")).parts(lines)
    });
    Section::new(ROUGHNESS, "Roughness of profiles (ISO 21920)").parts(parts)
}

fn section(window: &Window, stem: &str, traced: &Traced, limits: &DrawnLimits) -> Section {
    let way = traced.direction.words();
    let title = format!("tooth {} {} {way}", window.tooth, window.side.name());
    let section = Section::new(format!("{}_{}", key_of(stem), traced.direction.key()), title)
        .with("tooth", Quantity::count(window.tooth.into(), "1", "tooth, from 1"))
        .with("flank", Quantity::text(window.side.name(), "flank: left or right"))
        .with("direction", Quantity::text(way, "which way the lines run"))
        .with("window", Quantity::text(key_of(stem), "window that the lines cross"));
    let cutoff = "cut-off lambda_c: nesting index of the profile L-filter";
    let chain = "what was done to the lines, step by step";
    let profiles = match &traced.profiles {
        Ok(profiles) => profiles,
        Err(why) => {
            let none = |definition: &'static str, unit| Quantity::undefined(unit, definition, why.clone());
            return section
                .shown("Ra", "Ra", none("arithmetical mean height of the profile, mean of the lines", "um"))
                .shown("Rz", "Rz", none("mean of the heights of the sections, mean of the lines", "um"))
                .shown("cutoff", "cut-off", none(cutoff, "mm"))
                .with("chain", none(chain, "1"));
        }
    };
    let mean = |of: ParameterRange| {
        let definition = format!("{}; mean of the lines", of.mean.definition);
        Parameter { definition, ..of.mean }
    };
    let means: Vec<Parameter> = of_profiles(profiles, &[]).into_iter().map(mean).collect();
    let mut section = section;
    for (symbol, quantity) in quantities(&means) {
        section = match symbol.as_str() {
            "Ra" | "Rz" => section.shown(&symbol, &symbol, quantity),
            _ => section.with(&symbol, quantity),
        };
    }
    for symbol in ["Ra", "Rz"] {
        if let Some(OfLines { largest_um, .. }) = traced.of(symbol) {
            let definition = format!("largest {symbol} of the lines");
            let title = format!("{symbol} at most");
            section =
                section.shown(&format!("{symbol}_largest"), &title, Quantity::number(largest_um, "um", definition));
        }
    }
    let cutoff_mm = profiles.cutoff_um.unwrap_or_default() * 1e-3;
    section = section
        .shown("cutoff", "cut-off", Quantity::number(cutoff_mm, "mm", cutoff))
        .with("evaluation_length", Quantity::number(profiles.evaluation_um * 1e-3, "mm", "evaluation length"))
        .with("lines", Quantity::count(traced.places_mm.len() as u64, "1", "lines, evenly over the window"))
        .with("chain", Quantity::text(profiles.words.join("; "), chain));
    for (symbol, limit) in limited(limits) {
        if let (Some(limit), Some(found)) = (limit, traced.of(symbol)) {
            let kept = if found.largest_um <= limit { "kept" } else { "exceeded" };
            let definition = format!("whether the largest {symbol} of the lines keeps the drawing's {limit} um");
            section = section.with(&format!("{symbol}_limit"), Quantity::text(kept, definition));
        }
    }
    section
}

/// Windows whose roughness exceeds a limit of the drawing, and those of which none is known though it has one.
pub(super) fn judged(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<Notice> {
    let limits = &job.scene().measure.limits;
    let operations = job.operations();
    let finished = operations.len() - 1;
    let mut warnings = Vec::new();
    for (texture, stem) in textures.iter().zip(&stems(job, textures)) {
        let window = &texture.window;
        // The drawing speaks of the finished gear.
        if window.operation != finished {
            continue;
        }
        for traced in &texture.traces {
            let way = traced.direction.words();
            let place = format!("tooth {} {} {way}", window.tooth, window.side.name());
            let section = roughness_path(&stem.replace('/', "."), traced.direction);
            for (symbol, limit) in limited(limits) {
                let Some(limit) = limit else { continue };
                let place = &place;
                let notice = match (traced.of(symbol), &traced.profiles) {
                    (Some(found), _) if found.largest_um <= limit => continue,
                    (Some(found), _) => {
                        let found_um = format!("{:.3}", found.largest_um);
                        RoughnessLimit { symbol, place, found_um, limit_um: limit }.notice()
                    }
                    (None, Err(why)) => RoughnessNotJudged { symbol, place, why }.notice(),
                    (None, Ok(_)) => RoughnessNotJudged { symbol, place, why: "no line has it" }.notice(),
                };
                warnings.push(notice.about(&section));
            }
        }
    }
    warnings
}
