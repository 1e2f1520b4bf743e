//! Texture windows on the page: the finished surface open, what earlier operations left folded away.

use super::digits::digits;
use super::measured;
use crate::findings::{self, Findings, unit};
use crate::output::folder::OutputFolder;
use crate::output::ratio_chart::{RatioChart, SkConstruction};
use crate::output::report::texture::{ParameterRow, TextureBlock};
use crate::output::report::{Block, PageSection, PageTable};
use crate::texture;
use gearcut_core::error::{Error, Result};

/// The section; none if no window was evaluated. Pictures are those that the folder holds.
///
/// # Errors
/// A picture cannot be read back.
pub fn section(found: &Findings, folder: &OutputFolder) -> Result<Option<PageSection>> {
    let operations = found.parts("texture");
    let Some((last, earlier)) = operations.split_last() else { return Ok(None) };
    let mut blocks = vec![overview(last, earlier)];
    blocks.extend(profiles(found, last));
    let path = format!("texture.{}", last.key);
    let of_several = found.warnings.iter().filter(|warning| warning.section.as_ref() == Some(&path));
    blocks.extend(of_several.map(|warning| Block::Note(warning.with_signs().text)));
    blocks.extend(shown(last, found, folder)?);
    for operation in earlier {
        blocks.push(Block::Folded(operation.title.clone(), shown(operation, found, folder)?));
    }
    Ok(Some(PageSection {
        id: "texture",
        title: "Surface texture".to_owned(),
        lead: format!(
            "Areal parameters by ISO 25178-2 of windows on flanks after {}: what the tool's motion leaves. Chips, wear \
            and vibration of a real cut come on top. All parameters stand in results.json, the surfaces as X3P, SDF, \
            NPY and CSV beside it.",
            last.key
        ),
        blocks,
    }))
}

/// The windows of an operation, and surfaces measured there.
fn shown(operation: &findings::Section, found: &Findings, folder: &OutputFolder) -> Result<Vec<Block>> {
    let block = |window: &findings::Section| {
        let path = format!("texture.{}.{}", operation.key, window.key);
        let of_window = |section: &String| *section == path || *section == format!("{path}.{}", texture::MEASURED);
        let warnings = found.warnings.iter().filter(|warning| warning.section.as_ref().is_some_and(of_window));
        let warnings = warnings.map(|warning| warning.with_signs().text).collect();
        let mut blocks = vec![Block::Texture(texture_window(window, warnings, folder)?)];
        blocks.extend(measured::blocks(window, folder)?);
        Ok(blocks)
    };
    let blocks: Vec<Vec<Block>> = operation.sections.iter().map(block).collect::<Result<_>>()?;
    Ok(blocks.concat())
}

fn texture_window(window: &findings::Section, warnings: Vec<String>, folder: &OutputFolder) -> Result<TextureBlock> {
    let number = |key: &str| window.number(key).map_or_else(|| "–".to_owned(), |value| digits(value, 4));
    let path = folder.path(format!("{}_relief.png", window.words("files")))?;
    // A window that could not be evaluated has no picture, nor has one whose files are left out.
    let png = match std::fs::read(&path) {
        Ok(png) => Some(png),
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => None,
        Err(reason) => return Err(Error::reading(&path)(reason)),
    };
    let parameters = window.find("parameters").map_or(&[][..], |parameters| &parameters.entries);
    let parameter = |entry: &findings::Entry| {
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
    let um = |symbol: &str| window.number(&format!("parameters.{symbol}"));
    let abbott = window.find("abbott");
    let sk = abbott.and_then(|curve| {
        let from_percent = curve.number("window_percent")?;
        Some(SkConstruction {
            line_um: [curve.number("upper_um")?, curve.number("lower_um")?],
            window_percent: [from_percent, from_percent + 40.0],
            smr1_percent: um("Smrk1")?,
            smr2_percent: um("Smrk2")?,
            spk_um: um("Spk")?,
            svk_um: um("Svk")?,
        })
    });
    let material_ratio = abbott.and_then(|curve| curve.table_of("curve")).map(|table| RatioChart {
        title: "Material ratio curve and the construction of Sk".to_owned(),
        curve: table
            .numbers("ratio")
            .zip(table.numbers("height"))
            .filter_map(|(ratio, z)| Some((ratio?, z?)))
            .collect(),
        sk,
    });
    let material_ratio = material_ratio.filter(|chart| chart.curve.len() > 1);
    Ok(TextureBlock {
        title: format!(
            "Tooth {}, {} flank: {} × {} mm about u {}, v {} mm",
            window.number("tooth").unwrap_or(f64::NAN),
            window.words("flank"),
            number("length_profile"),
            number("length_lead"),
            number("center_profile"),
            number("center_lead")
        ),
        chain: window.words("chain").to_owned(),
        parameters: parameters.iter().map(parameter).collect(),
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
        let value = |symbol: &str| {
            let value = window.number(&format!("parameters.{symbol}"));
            value.map_or_else(|| "–".to_owned(), |value| digits(value, 3))
        };
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
    let operation = found.parts(texture::ROUGHNESS).iter().find(|operation| operation.key == finished.key)?;
    let row = |lines: &findings::Section| {
        let number = |key: &str| lines.number(key).map_or_else(|| "–".to_owned(), |value| digits(value, 3));
        let window = finished.sections.iter().find(|window| window.key == lines.words("window"));
        let sa = window.and_then(|window| window.number("parameters.Sa"));
        let verdict = |key: &str| match lines.words(key) {
            "" => "–".to_owned(),
            words => words.to_owned(),
        };
        vec![
            lines.title.clone(),
            sa.map_or_else(|| "–".to_owned(), |value| digits(value, 3)),
            number("Ra"),
            number("Ra_largest"),
            verdict("Ra_limit"),
            number("Rz"),
            number("Rz_largest"),
            verdict("Rz_limit"),
            number("cutoff"),
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
