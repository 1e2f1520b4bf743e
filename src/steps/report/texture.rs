//! Texture windows on the page: all of them on one sheet of tiles, the worst in full, the others folded away, and what
//! earlier operations left folded away with its own sheet.

use super::digits::digits;
use super::measured;
use crate::findings::quantities::surfaces::{OVERLAY, RATIO};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{self, Findings, QuantityRow, unit};
use crate::output::folder::OutputFolder;
use crate::output::inspection_sheet::SheetFigure;
use crate::output::ratio_chart::{RatioChart, SkConstruction};
use crate::output::report::texture::{ParameterRow, TextureBlock};
use crate::output::report::{Block, PageSection, PageTable, Tone};
use crate::scene::Scene;
use crate::steps::inspection::verdict_words;
use crate::steps::report::read_picture;
use crate::texture::quantities::{
    ABBOTT, CENTER_LEAD, CENTER_PROFILE, CHAIN, CURVE_HEIGHT, CUTOFF, DIRECTION, FILES, LENGTH_LEAD, LENGTH_PROFILE,
    LOWER, PARAMETERS, RA, RA_LARGEST, RA_LIMIT, ROUGHNESS, RZ, RZ_LARGEST, RZ_LIMIT, TEXTURE, UPPER, WINDOW_OF_LINES,
    WINDOW_PERCENT,
};
use crate::texture::{self, Direction};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;

/// The section; none if no window was evaluated. Pictures are those that the folder holds.
///
/// # Errors
/// A picture cannot be read back.
pub fn section(found: &Findings, folder: &OutputFolder) -> Result<Option<PageSection>> {
    let operations = found.parts(&TEXTURE);
    let Some((last, earlier)) = operations.split_last() else { return Ok(None) };
    let mut blocks = vec![overview(last, earlier)];
    blocks.extend(profiles(found, last));
    let path = format!("{}.{}", TEXTURE.key, last.key);
    let of_several = found.warnings.iter().filter(|warning| warning.section.as_ref() == Some(&path));
    blocks.extend(of_several.map(|warning| Block::Note(warning.with_signs().text)));
    blocks.extend(sheet(last, folder)?);
    let mut windows: Vec<&findings::Section> = last.sections.iter().collect();
    windows.sort_by(|a, b| mean_height_um(b).total_cmp(&mean_height_um(a)));
    let mut shown = windows.into_iter().map(|window| block(last, window, found, folder));
    blocks.extend(shown.next().transpose()?.into_iter().flatten());
    let others = shown.collect::<Result<Vec<_>>>()?.concat();
    if !others.is_empty() {
        blocks.push(Block::Folded("The other windows in full, the roughest first".to_owned(), others));
    }
    for operation in earlier {
        let windows = operation.sections.iter().map(|window| block(operation, window, found, folder));
        let windows = windows.collect::<Result<Vec<_>>>()?.concat();
        let windows = sheet(operation, folder)?.into_iter().chain(windows).collect();
        blocks.push(Block::Folded(operation.title.clone(), windows));
    }
    let (tone, words) = verdict(found, last);
    let section = PageSection::new(
        "texture",
        "Surface texture",
        format!(
            "Areal parameters by ISO 25178-2 of windows on flanks after {}: marks of the tool's motion, with what the \
            scene says of machine and edge. What it does not say of a real cut comes on top. The window with the \
            largest Sa is shown in full. All parameters are in results.json, the surfaces as X3P beside it.",
            last.key
        ),
        blocks,
    );
    Ok(Some(section.judged(tone, words)))
}

/// A parameter of a window by its symbol.
fn parameter(window: &findings::Section, symbol: &str) -> Option<f64> {
    let entries = &window.group(&PARAMETERS)?.entries;
    entries.iter().find(|entry| entry.key == symbol)?.quantity.value()
}

/// Digits of a number; a dash where there is none.
fn shown(value: Option<f64>, count: u32) -> String {
    value.map_or_else(|| "–".to_owned(), |value| digits(value, count))
}

/// Sa; below all others where there is none.
fn mean_height_um(window: &findings::Section) -> f64 {
    parameter(window, "Sa").unwrap_or(-1.0)
}

/// What the drawing's limits of Ra and Rz say, or how rough the windows are.
fn verdict(found: &Findings, last: &findings::Section) -> (Tone, String) {
    let lines = found.parts(&ROUGHNESS).iter().filter(|operation| operation.key == last.key);
    let lines = lines.flat_map(|operation| &operation.sections);
    let judged: Vec<&str> = lines.flat_map(|of| [&RA_LIMIT, &RZ_LIMIT].map(|row| of.text(row))).collect();
    if judged.contains(&"exceeded") {
        return (Tone::Wrong, "a limit of Ra or Rz is exceeded".to_owned());
    }
    if judged.contains(&"kept") {
        return (Tone::Fine, "limits of Ra and Rz are kept".to_owned());
    }
    let heights = || last.sections.iter().filter_map(|window| parameter(window, "Sa"));
    let count = last.sections.len();
    let windows = if count == 1 { "1 window".to_owned() } else { format!("{count} windows") };
    let words = match (heights().reduce(f64::min), heights().reduce(f64::max)) {
        (Some(low), Some(high)) => format!("{windows}: Sa {} to {} µm", digits(low, 3), digits(high, 3)),
        _ => windows,
    };
    (Tone::Aside, words)
}

/// All windows of an operation on one scale.
fn sheet(operation: &findings::Section, folder: &OutputFolder) -> Result<Option<Block>> {
    let picture = read_picture(folder, &texture::sheet_file(&operation.key))?;
    let words = format!("All windows after {} on one scale", operation.key);
    Ok(picture.map(|png| Block::Picture(words, png)))
}

/// A window, and surfaces measured there.
fn block(
    operation: &findings::Section,
    window: &findings::Section,
    found: &Findings,
    folder: &OutputFolder,
) -> Result<Vec<Block>> {
    let path = format!("{}.{}.{}", TEXTURE.key, operation.key, window.key);
    let of_window = |section: &String| *section == path || *section == format!("{path}.{}", OVERLAY.key);
    let warnings = found.warnings.iter().filter(|warning| warning.section.as_ref().is_some_and(of_window));
    let warnings = warnings.map(|warning| warning.with_signs().text).collect();
    let mut blocks = vec![Block::Texture(texture_window(window, warnings, folder)?)];
    blocks.extend(measured::blocks(window, folder)?);
    Ok(blocks)
}

fn texture_window(window: &findings::Section, warnings: Vec<String>, folder: &OutputFolder) -> Result<TextureBlock> {
    let number = |row: &QuantityRow| shown(window.value(row), 4);
    // A window that could not be evaluated has no picture, nor has one whose files are left out.
    let png = read_picture(folder, &format!("{}_relief.png", window.text(&FILES)))?;
    let parameters = window.group(&PARAMETERS).map_or(&[][..], |parameters| &parameters.entries);
    let row = |entry: &findings::Entry| {
        let quantity = &entry.quantity;
        ParameterRow {
            symbol: entry.key.clone(),
            value: quantity
                .value()
                .map(|value| unit::with_signs(&digits(value, 4), quantity.unit().unwrap_or("1")))
                .ok_or_else(|| quantity.why().unwrap_or("not defined").to_owned()),
            definition: quantity.definition().to_owned(),
        }
    };
    let of = |symbol: &str| parameter(window, symbol);
    let abbott = window.group(&ABBOTT);
    let sk = abbott.and_then(|curve| {
        let from_percent = curve.value(&WINDOW_PERCENT)?;
        Some(SkConstruction {
            line_um: [curve.value(&UPPER)?, curve.value(&LOWER)?],
            window_percent: [from_percent, from_percent + 40.0],
            smr1_percent: of("Smrk1")?,
            smr2_percent: of("Smrk2")?,
            spk_um: of("Spk")?,
            svk_um: of("Svk")?,
        })
    });
    let material_ratio = abbott.and_then(|curve| curve.tables.first()).map(|table| RatioChart {
        title: "Material ratio curve and the construction of Sk".to_owned(),
        curve: table.points(&RATIO, &CURVE_HEIGHT).into_iter().filter(|(_, height)| !height.is_nan()).collect(),
        sk,
    });
    let material_ratio = material_ratio.filter(|chart| chart.curve.len() > 1);
    Ok(TextureBlock {
        title: format!(
            "Tooth {}, {} flank: {} × {} mm about u {}, v {} mm",
            window.value(&TOOTH).unwrap_or(f64::NAN),
            window.text(&FLANK),
            number(&LENGTH_PROFILE),
            number(&LENGTH_LEAD),
            number(&CENTER_PROFILE),
            number(&CENTER_LEAD)
        ),
        chain: window.text(&CHAIN).to_owned(),
        parameters: parameters.iter().map(row).collect(),
        warnings,
        png,
        material_ratio,
    })
}

/// The parameters that are compared first, of all windows side by side: what the last operation left comes first.
fn overview(last: &findings::Section, earlier: &[findings::Section]) -> Block {
    const COMPARED: [(&str, &str); 8] = [
        ("Sa", " [µm]"),
        ("Sq", " [µm]"),
        ("Sz", " [µm]"),
        ("Sk", " [µm]"),
        ("Spk", " [µm]"),
        ("Svk", " [µm]"),
        ("Ssk", ""),
        ("Sku", ""),
    ];
    let row = |operation: &findings::Section, window: &findings::Section| {
        let value = |symbol: &str| shown(parameter(window, symbol), 3);
        let name = format!("{}, {}", window.title, operation.key);
        std::iter::once(name).chain(COMPARED.map(|(symbol, _)| value(symbol))).collect()
    };
    let rows = std::iter::once(last).chain(earlier);
    let rows = rows.flat_map(|operation| operation.sections.iter().map(move |window| row(operation, window)));
    let heads = COMPARED.map(|(symbol, unit)| format!("{symbol}{unit}"));
    Block::Table(PageTable {
        caption: "All windows".to_owned(),
        columns: std::iter::once("Window, after".to_owned()).chain(heads).collect(),
        rows: rows.collect(),
    })
}

/// Ra and Rz of the finished windows along both directions, with their cut-offs, beside Sa.
fn profiles(found: &Findings, finished: &findings::Section) -> Option<Block> {
    let operation = found.parts(&ROUGHNESS).iter().find(|operation| operation.key == finished.key)?;
    let row = |lines: &findings::Section| {
        let number = |row: &QuantityRow| shown(lines.value(row), 3);
        let window = finished.sections.iter().find(|window| window.key == lines.text(&WINDOW_OF_LINES));
        let sa = window.and_then(|window| parameter(window, "Sa"));
        let verdict = |row: &QuantityRow| match lines.text(row) {
            "" => "–".to_owned(),
            words => words.to_owned(),
        };
        vec![
            lines.title.clone(),
            shown(sa, 3),
            number(&RA),
            number(&RA_LARGEST),
            verdict(&RA_LIMIT),
            number(&RZ),
            number(&RZ_LARGEST),
            verdict(&RZ_LIMIT),
            number(&CUTOFF),
        ]
    };
    let columns = ["Lines", "Sa [µm]", "Ra [µm]", "at most", "limit", "Rz [µm]", "at most", "limit", "Cut-off [mm]"]
        .map(str::to_owned);
    Some(Block::Table(PageTable {
        caption: "Roughness of profiles (ISO 21920), mean of three lines".to_owned(),
        columns: columns.to_vec(),
        rows: operation.sections.iter().map(row).collect(),
    }))
}

/// Ra and Rz of what the last operation left as figures of the inspector's sheet, the largest of each side's lines in a
/// direction, and a sentence on their cut-offs; nothing without windows.
pub fn sheet_figures(found: &Findings, scene: &Scene) -> (Vec<SheetFigure>, String) {
    let limits = &scene.measure.limits;
    let finished = found.parts(&TEXTURE).last().map(|operation| operation.key.as_str());
    let operation = found.parts(&ROUGHNESS).iter().find(|operation| Some(operation.key.as_str()) == finished);
    let lines = operation.map_or(&[][..], |operation| &operation.sections);
    if lines.is_empty() {
        return (Vec::new(), String::new());
    }
    let mut figures = Vec::new();
    for direction in Direction::BOTH {
        let along = || lines.iter().filter(|lines| lines.text(&DIRECTION) == direction.words());
        for (sign, largest, judged, limit_um) in
            [("Ra", &RA_LARGEST, &RA_LIMIT, limits.ra_um), ("Rz", &RZ_LARGEST, &RZ_LIMIT, limits.rz_um)]
        {
            let side = |side: Side| {
                let of_side = along().filter(|lines| lines.text(&FLANK) == side.name());
                match of_side.filter_map(|lines| lines.value(largest)).reduce(f64::max) {
                    Some(um) if um < 1e-3 => "< 0.001".to_owned(),
                    largest => shown(largest, 3),
                }
            };
            let verdicts: Vec<&str> =
                along().map(|lines| lines.text(judged)).filter(|words| !words.is_empty()).collect();
            let passes = (!verdicts.is_empty()).then(|| !verdicts.contains(&"exceeded"));
            figures.push(SheetFigure {
                cells: [
                    format!("{sign} {}", direction.words().trim_start_matches("along the ")),
                    side(Side::Left),
                    side(Side::Right),
                    shown(limit_um, 3),
                    "–".to_owned(),
                    verdict_words(passes).to_owned(),
                ],
                fails: passes == Some(false),
            });
        }
    }
    let mut cutoffs: Vec<String> = lines.iter().map(|lines| shown(lines.value(&CUTOFF), 3)).collect();
    cutoffs.sort_unstable();
    cutoffs.dedup();
    let cutoffs = cutoffs.join(", ");
    (figures, format!(" Ra and Rz: the largest of the lines in all finished windows, cut-off {cutoffs} mm."))
}
