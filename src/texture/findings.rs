//! Texture of windows as findings: a section for each operation, in it one for each window.

use super::files::{named, stems, stems_of};
use super::{SampledWindow, Window, WindowNote, WindowTexture, chart, laid_over};
use crate::findings::{Datum, Notice, Quantity, Section, Table, TableColumn};
use crate::job::GearJob;
use crate::measure::topography::{Evaluation, Parameter};
use gearcut_core::units::UM_PER_MM;

/// Intervals of the curve in the table.
const CURVE_INTERVALS: u32 = 200;
/// Parameters that are read first: of the height and of the core.
const FIRST: [&str; 6] = ["Sa", "Sq", "Sz", "Sk", "Spk", "Svk"];
const CHAIN: &str = "what was done before the evaluation, step by step";

/// Parameters as quantities by symbol.
pub fn quantities(parameters: &[Parameter]) -> Vec<(String, Quantity)> {
    let quantity = |p: &Parameter| match &p.value {
        Ok(value) => Quantity::number(*value, p.unit, p.definition.clone()),
        Err(why) => Quantity::undefined(p.unit, p.definition.clone(), why.clone()),
    };
    parameters.iter().map(|p| (p.symbol.clone(), quantity(p))).collect()
}

/// Texture of all windows, operation by operation.
pub fn findings(job: &dyn GearJob, textures: &[WindowTexture]) -> Section {
    let stems = stems(job, textures);
    let of = |index: usize| textures.iter().zip(&stems).filter(move |(texture, _)| texture.window.operation == index);
    let operations = job.operations();
    let parts =
        operations.iter().enumerate().filter(|(index, _)| of(*index).next().is_some()).map(|(index, (name, _))| {
            Section::new(*name, format!("Left by {name}")).parts(of(index).map(|(texture, stem)| window(texture, stem)))
        });
    Section::new("texture", "Surface texture (ISO 25178-2)").parts(parts)
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
            [(of, _)] => format!("texture.{operation}.{}", key_of(of.stem)),
            _ => format!("texture.{operation}"),
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
    let mm = |value: f64, definition: &'static str| Quantity::number(value, "mm", definition);
    let um = |value: f64, definition: &'static str| Quantity::number(value * UM_PER_MM, "um", definition);
    let marks = |count: usize, definition: &'static str| Quantity::count(count as u64, "marks", definition);
    let section = Section::new(key_of(stem), format!("tooth {} {}", window.tooth, window.side.name()))
        .with("tooth", Quantity::count(window.tooth.into(), "1", "tooth, from 1"))
        .with("flank", Quantity::text(window.side.name(), "flank: left or right"))
        .with(
            "center_profile",
            mm(
                center[1],
                "middle of the window as arc along the profile from the start of the involute, in the section in the \
                 middle of the face",
            ),
        )
        .with("center_lead", mm(center[0], "middle of the window along the tooth from the middle of the face"))
        .with("length_profile", mm(length[1], "length of the window along the profile"))
        .with("length_lead", mm(length[0], "length of the window along the tooth"))
        .with("spacing_profile", um(spacing[1], "distance of points along the profile, uniform in arc length"))
        .with("spacing_lead", um(spacing[0], "distance of points along the tooth"))
        .with(
            "marks_along_profile",
            marks(texture.marks[1], "facets that follow each other along the profile in the middle of the window"),
        )
        .with(
            "marks_along_tooth",
            marks(
                texture.marks[0],
                "facets that follow each other along the tooth in the middle of the window; 0: the axes rest during \
                 strokes, marks run along the tooth without end",
            ),
        )
        .with("files", Quantity::text(stem, "files of the window without their endings, in the output folder"));
    let section = match &texture.evaluated {
        Ok(evaluated) => section
            .with("chain", Quantity::text(evaluated.chain.join("; "), CHAIN))
            .part(parameters(&evaluated.evaluation))
            .part(material_ratio(&evaluated.evaluation)),
        Err(reason) => section.with("chain", Quantity::undefined("1", CHAIN, reason.clone())),
    };
    section.parts(texture.overlaid.as_ref().map(laid_over::section))
}

fn parameters(evaluation: &Evaluation) -> Section {
    let section = Section::new("parameters", "Parameters");
    quantities(&evaluation.parameters).into_iter().fold(section, |section, (symbol, quantity)| {
        if FIRST.contains(&symbol.as_str()) {
            section.shown(&symbol, &symbol, quantity)
        } else {
            section.with(&symbol, quantity)
        }
    })
}

/// The material ratio curve with the construction of the Sk family, for drawing.
fn material_ratio(evaluation: &Evaluation) -> Section {
    let core = &evaluation.core;
    let columns = vec![
        TableColumn::new("ratio", "%", "areal material ratio"),
        TableColumn::new("height", "um", "height over the mean plane").or("the curve has no height there"),
    ];
    let points = chart::points(&evaluation.curve, CURVE_INTERVALS).into_iter();
    let rows = points.map(|(ratio, height)| vec![Datum::from(ratio), height.into()]);
    Section::new("abbott", "Material ratio curve")
        .with("window_percent", Quantity::number(core.window_percent, "%", "where the 40 % window begins"))
        .with(
            "upper_um",
            Quantity::number(core.upper_um, "um", "equivalent line at 0 %, by least squares in the 40 % window"),
        )
        .with(
            "lower_um",
            Quantity::number(core.lower_um, "um", "equivalent line at 100 %, by least squares in the 40 % window"),
        )
        .table(Table::new("curve", "Heights at equally spaced areal material ratios", columns).with_rows(rows))
}
