//! Texture of windows as findings: a section for each operation, in it one for each window.

use super::files::{named, stems, stems_of};
use super::quantities::{
    ABBOTT, CENTER_LEAD, CENTER_PROFILE, CHAIN, CURVE_HEIGHT, FILES, LENGTH_LEAD, LENGTH_PROFILE, LOWER,
    MARKS_ALONG_PROFILE, MARKS_ALONG_TOOTH, PARAMETERS, SPACING_LEAD, SPACING_PROFILE, TEXTURE, UPPER, WINDOW_PERCENT,
};
use super::{SampledWindow, Window, WindowNote, WindowTexture, chart, laid_over};
use crate::findings::quantities::surfaces::RATIO;
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Entry, Notice, Section, Table};
use crate::job::GearJob;
use crate::measure::topography::{Evaluation, Parameter};
use gearcut_core::units::UM_PER_MM;

/// Intervals of the curve in the table.
const CURVE_INTERVALS: u32 = 200;
/// Parameters that are read first: of the height and of the core.
const FIRST: [&str; 6] = ["Sa", "Sq", "Sz", "Sk", "Spk", "Svk"];

/// Texture of all windows, operation by operation.
pub fn findings(job: &dyn GearJob, textures: &[WindowTexture]) -> Section {
    let stems = stems(job, textures);
    let of = |index: usize| textures.iter().zip(&stems).filter(move |(texture, _)| texture.window.operation == index);
    let operations = job.operations();
    let parts =
        operations.iter().enumerate().filter(|(index, _)| of(*index).next().is_some()).map(|(index, (name, _))| {
            Section::new(*name, format!("Left by {name}")).parts(of(index).map(|(texture, stem)| window(texture, stem)))
        });
    TEXTURE.section([]).parts(parts)
}

/// What a reader must know before trusting the numbers of windows and their cut tells: a sentence for all windows of an
/// operation that it is true of, about the window's section where it is one.
pub(super) fn noted(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<Notice> {
    let stems = stems(job, textures);
    let noted = textures.iter().zip(&stems).flat_map(|(texture, stem)| {
        let of = StemmedWindow { window: &texture.window, stem };
        texture.notes().into_iter().map(move |note| (of, note))
    });
    told(job, noted)
}

/// The same as far as marks tell it, which are known before anything is cut.
pub fn foreseen(job: &dyn GearJob, windows: &[SampledWindow]) -> Vec<Notice> {
    let stems = stems_of(job, &windows.iter().map(|sampled| named(&sampled.window)).collect::<Vec<_>>());
    let noted = windows.iter().zip(&stems).flat_map(|(sampled, stem)| {
        let of = StemmedWindow { window: &sampled.window, stem };
        sampled.marks.notes().into_iter().map(move |note| (of, note))
    });
    told(job, noted)
}

/// A window with the stem of its files.
#[derive(Clone, Copy)]
struct StemmedWindow<'a> {
    window: &'a Window,
    stem: &'a str,
}

/// Notes as warnings, those of one operation that are alike together.
fn told<'a>(job: &dyn GearJob, noted: impl Iterator<Item = (StemmedWindow<'a>, WindowNote)>) -> Vec<Notice> {
    let mut groups: Vec<Vec<(StemmedWindow, WindowNote)>> = Vec::new();
    for (of, note) in noted {
        let alike = |group: &&mut Vec<(StemmedWindow, WindowNote)>| {
            group[0].0.window.operation == of.window.operation && group[0].1.is_like(&note)
        };
        match groups.iter_mut().find(alike) {
            Some(group) => group.push((of, note)),
            None => groups.push(vec![(of, note)]),
        }
    }
    let operations = job.operations();
    let told = |group: Vec<(StemmedWindow, WindowNote)>| {
        let operation = operations[group[0].0.window.operation].0;
        let notes: Vec<&WindowNote> = group.iter().map(|(_, note)| note).collect();
        let names = group.iter().map(|(of, _)| format!("{} {}", of.window.tooth, of.window.side.name()));
        let names = names.collect::<Vec<_>>().join(", ");
        let section = match group.as_slice() {
            [(of, _)] => format!("{}.{operation}.{}", TEXTURE.key, key_of(of.stem)),
            _ => format!("{}.{operation}", TEXTURE.key),
        };
        notes[0].notice(&notes, &format!("texture of tooth {names} after {operation}: ")).about(section)
    };
    groups.into_iter().map(told).collect()
}

/// Key of a window's section: the last part of its stem.
pub(super) fn key_of(stem: &str) -> &str {
    stem.rsplit('/').next().unwrap_or(stem)
}

fn window(texture: &WindowTexture, stem: &str) -> Section {
    let window = &texture.window;
    let (center, length, spacing) = (window.center_mm(), window.length_mm(), window.spacing_mm());
    let section = Section::new(key_of(stem), format!("tooth {} {}", window.tooth, window.side.name())).entries([
        TOOTH.of(window.tooth),
        FLANK.of(window.side.name()),
        CENTER_PROFILE.of(center[1]),
        CENTER_LEAD.of(center[0]),
        LENGTH_PROFILE.of(length[1]),
        LENGTH_LEAD.of(length[0]),
        SPACING_PROFILE.of(spacing[1] * UM_PER_MM),
        SPACING_LEAD.of(spacing[0] * UM_PER_MM),
        MARKS_ALONG_PROFILE.of(texture.marks[1]),
        MARKS_ALONG_TOOTH.of(texture.marks[0]),
        FILES.of(stem),
    ]);
    let section = match &texture.evaluated {
        Ok(evaluated) => section
            .entries([CHAIN.of(evaluated.chain.join("; "))])
            .part(parameters(&evaluated.evaluation))
            .part(material_ratio(&evaluated.evaluation)),
        Err(why) => section.entries([CHAIN.none(why.to_string())]),
    };
    section.parts(texture.overlaid.as_ref().map(laid_over::section))
}

fn parameters(evaluation: &Evaluation) -> Section {
    let entry = |of: &Parameter| {
        let entry = Entry::from(of);
        if FIRST.contains(&of.symbol.as_str()) { entry.shown() } else { entry }
    };
    PARAMETERS.section(evaluation.parameters.iter().map(entry))
}

/// The material ratio curve with the construction of the Sk family, for drawing.
fn material_ratio(evaluation: &Evaluation) -> Section {
    let core = &evaluation.core;
    let curve = Table::over(
        "curve",
        "Heights at equally spaced areal material ratios",
        chart::points(&evaluation.curve, CURVE_INTERVALS),
    );
    let curve = curve.column(&RATIO, |(ratio, _)| *ratio).column(&CURVE_HEIGHT, |(_, height)| *height);
    ABBOTT
        .section([WINDOW_PERCENT.of(core.window_percent), UPPER.of(core.upper_um), LOWER.of(core.lower_um)])
        .table(curve)
}
