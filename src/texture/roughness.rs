//! Roughness of profiles as findings: a section for each operation, in it one for each window and direction, and what
//! the drawing's limits say of them.

use super::files::stems;
use super::findings::key_of;
use super::quantities::{
    CHAIN_OF_LINES, CUTOFF, DIRECTION, EVALUATION_LENGTH, LINES, RA, RA_LARGEST, RA_LIMIT, ROUGHNESS, RZ, RZ_LARGEST,
    RZ_LIMIT, TEXTURE, WINDOW_OF_LINES,
};
use super::traces::{Direction, Traced};
use super::{Window, WindowTexture};
use crate::findings::notices::{RoughnessLimit, RoughnessNotJudged};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Entry, Notice, QuantityRow, Section};
use crate::job::GearJob;
use crate::measure::topography::parameters::{ParameterRange, of_profiles};
use crate::scene::model::DrawnLimits;

/// Path of the section of a window's lines, from that of the window.
pub fn roughness_path(window: &str, direction: Direction) -> String {
    let rest = window.strip_prefix(TEXTURE.key).and_then(|rest| rest.strip_prefix('.')).unwrap_or(window);
    format!("{}.{rest}_{}", ROUGHNESS.key, direction.key())
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
    ROUGHNESS.section([]).parts(parts)
}

fn section(window: &Window, stem: &str, traced: &Traced, limits: &DrawnLimits) -> Section {
    let way = traced.direction.words();
    let title = format!("tooth {} {} {way}", window.tooth, window.side.name());
    let section = Section::new(format!("{}_{}", key_of(stem), traced.direction.key()), title).entries([
        TOOTH.of(window.tooth),
        FLANK.of(window.side.name()),
        DIRECTION.of(way),
        WINDOW_OF_LINES.of(key_of(stem)),
    ]);
    let profiles = match &traced.profiles {
        Ok(profiles) => profiles,
        Err(why) => {
            return section.entries([&RA, &RZ, &CUTOFF, &CHAIN_OF_LINES].map(|row| row.none(why.to_string())));
        }
    };
    let mean = |of: ParameterRange| {
        let row = [&RA, &RZ].into_iter().find(|row| row.key == of.mean.symbol);
        match (row, &of.mean.value) {
            (Some(row), Ok(um)) => row.of(*um),
            (Some(row), Err(why)) => row.none(why.to_string()),
            (None, _) => Entry::from(&of.mean).remarked("; mean of the lines"),
        }
    };
    let largest = |row: &QuantityRow, symbol: &str| Some(row.of(traced.of(symbol)?.largest_um));
    let mut section = section
        .entries(of_profiles(profiles, &[]).into_iter().map(mean))
        .entries([largest(&RA_LARGEST, "Ra"), largest(&RZ_LARGEST, "Rz")].into_iter().flatten())
        .entries([
            CUTOFF.of(profiles.cutoff_um.unwrap_or_default() * 1e-3),
            EVALUATION_LENGTH.of(profiles.evaluation_um * 1e-3),
            LINES.of(traced.places_mm.len()),
            CHAIN_OF_LINES.of(profiles.words.join("; ")),
        ]);
    for ((symbol, limit), row) in limited(limits).into_iter().zip([&RA_LIMIT, &RZ_LIMIT]) {
        if let (Some(limit), Some(found)) = (limit, traced.of(symbol)) {
            let kept = if found.largest_um <= limit { "kept" } else { "exceeded" };
            section = section.entries([row.of(kept).remarked(&format!(" of {limit} um"))]);
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
