//! Texture windows on the page: the finished surface open, what earlier operations left folded away.

use crate::error::{Error, Result};
use crate::output::folder::OutputFolder;
use crate::output::quantity::Quantity;
use crate::output::report::texture::{SkConstruction, TextureWindow};
use crate::output::report::{Block, Section};
use crate::output::results::TextureResults;
use crate::output::text::{plain, significant};

/// The section; none if no window was evaluated. Pictures are those that the folder holds.
///
/// # Errors
/// A picture cannot be read back.
pub fn section(windows: &[TextureResults], folder: &OutputFolder) -> Result<Option<Section>> {
    let Some(last) = windows.last().map(|window| &window.operation) else { return Ok(None) };
    let mut blocks = Vec::new();
    let mut earlier: Vec<(String, Vec<Block>)> = Vec::new();
    for window in windows {
        let block = Block::Texture(shown(window, folder)?);
        if window.operation == *last {
            blocks.push(block);
            continue;
        }
        match earlier.iter_mut().find(|(name, _)| *name == window.operation) {
            Some((_, blocks)) => blocks.push(block),
            None => earlier.push((window.operation.clone(), vec![block])),
        }
    }
    blocks.extend(earlier.into_iter().map(|(name, blocks)| Block::Folded(format!("Left by {name}"), blocks)));
    Ok(Some(Section {
        id: "texture",
        title: "Surface texture".to_owned(),
        lead: format!(
            "Areal parameters by ISO 25178-2 of windows on flanks after {last}: what the tool's motion leaves. Chips, wear and vibration of a real cut come on top. All parameters stand in results.json, the surfaces as X3P, SDF, NPY and CSV beside it."
        ),
        blocks,
    }))
}

fn shown(window: &TextureResults, folder: &OutputFolder) -> Result<TextureWindow> {
    let number = |quantity: &Quantity| quantity.value().map_or_else(|| "–".to_owned(), plain);
    let path = folder.path(format!("{}_relief.png", window.files))?;
    let png = std::fs::read(&path).map_err(Error::reading(&path))?;
    let parameter = |(symbol, quantity): &(String, Quantity)| {
        let value = quantity.value().map_or_else(
            || quantity.why().unwrap_or("not defined").to_owned(),
            |value| {
                let text = significant(value, 4).replace('-', "−");
                let unit = quantity.unit().unwrap_or("").replace("um", "µm");
                if unit == "1" { text } else { format!("{text} {unit}") }
            },
        );
        [symbol.clone(), value, quantity.definition().to_owned()]
    };
    let um = |symbol: &str| window.parameters.get(symbol).and_then(Quantity::value);
    let sk = window.abbott.as_ref().and_then(|curve| {
        Some(SkConstruction {
            line_um: [curve.upper_um, curve.lower_um],
            window_percent: [curve.window_percent, curve.window_percent + 40.0],
            smr1_percent: um("Smr1")?,
            smr2_percent: um("Smr2")?,
            spk_um: um("Spk")?,
            svk_um: um("Svk")?,
        })
    });
    Ok(TextureWindow {
        title: format!(
            "Tooth {}, {} flank: {} × {} mm about u {}, v {} mm",
            window.tooth,
            window.flank,
            number(&window.length_profile),
            number(&window.length_lead),
            number(&window.center_profile),
            number(&window.center_lead)
        ),
        chain: window.chain.join("; "),
        parameters: window.parameters.0.iter().map(parameter).collect(),
        warnings: window.warnings.clone(),
        png: Some(png),
        material_ratio: window.abbott.as_ref().map_or_else(Vec::new, |curve| {
            let last = curve.heights_um.len().saturating_sub(1).max(1) as f64;
            curve.heights_um.iter().enumerate().map(|(i, &height)| (100.0 * i as f64 / last, height)).collect()
        }),
        sk,
    })
}
