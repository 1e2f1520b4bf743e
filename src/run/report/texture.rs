//! Texture windows on the page: the finished surface open, what earlier operations left folded away.

use crate::error::{Error, Result};
use crate::output::folder::OutputFolder;
use crate::output::quantity::Quantity;
use crate::output::report::texture::{Parameter, SkConstruction, TextureWindow};
use crate::output::report::{Block, Section, Table};
use crate::output::results::TextureResults;
use crate::output::text::significant;

/// The section; none if no window was evaluated. Pictures are those that the folder holds.
///
/// # Errors
/// A picture cannot be read back.
pub fn section(windows: &[TextureResults], folder: &OutputFolder) -> Result<Option<Section>> {
    let Some(last) = windows.last().map(|window| &window.operation) else { return Ok(None) };
    let mut blocks = vec![overview(windows, last)];
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
    let number = |quantity: &Quantity| quantity.value().map_or_else(|| "–".to_owned(), |value| digits(value, 4));
    let path = folder.path(format!("{}_relief.png", window.files))?;
    let png = std::fs::read(&path).map_err(Error::reading(&path))?;
    let parameter = |(symbol, quantity): &(String, Quantity)| Parameter {
        symbol: symbol.clone(),
        value: quantity
            .value()
            .map(|value| with_unit(digits(value, 4), quantity.unit().unwrap_or("1")))
            .ok_or_else(|| quantity.why().unwrap_or("not defined").to_owned()),
        definition: quantity.definition().to_owned(),
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

/// The parameters that are compared first, of all windows side by side: what the last operation left stands above.
fn overview(windows: &[TextureResults], last: &str) -> Block {
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
    let row = |window: &TextureResults| {
        let value = |symbol: &str| {
            let value = window.parameters.get(symbol).and_then(Quantity::value);
            value.map_or_else(|| "–".to_owned(), |value| digits(value, 3))
        };
        let name = format!("tooth {} {}, {}", window.tooth, window.flank, window.operation);
        std::iter::once(name).chain(COMPARED.map(|(symbol, _)| value(symbol))).collect()
    };
    let (finished, earlier): (Vec<_>, Vec<_>) = windows.iter().partition(|window| window.operation == last);
    let heads = COMPARED.map(|(symbol, unit)| format!("{symbol}{unit}"));
    Block::Table(Table {
        caption: "All windows".to_owned(),
        columns: std::iter::once("Window, after".to_owned()).chain(heads).collect(),
        rows: finished.into_iter().chain(earlier).map(row).collect(),
    })
}

/// A number with so many digits; as a power of ten where a plain number would be mostly zeros.
fn digits(value: f64, count: u32) -> String {
    let text = if value != 0.0 && value.abs() < 1e-4 {
        let text = format!("{value:.*e}", count as usize - 1);
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let raised = exponent.chars().map(|c| match c {
            '-' => '⁻',
            digit => "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit.to_digit(10).unwrap_or(0) as usize).unwrap_or('⁰'),
        });
        format!("{mantissa} × 10{}", raised.collect::<String>())
    } else {
        significant(value, count)
    };
    text.replace('-', "−")
}

fn with_unit(number: String, unit: &str) -> String {
    match unit {
        "1" => number,
        "deg" => format!("{number}°"),
        unit => format!("{number} {}", unit.replace("um", "µm").replace("^2", "²").replace("^3", "³")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_powers_of_ten() {
        let texts = [0.256_63, -0.001, 3.14e-7, -2e-12, 0.0].map(|value| digits(value, 3));
        assert_eq!(texts, ["0.257", "−0.00100", "3.14 × 10⁻⁷", "−2.00 × 10⁻¹²", "0"]);
        assert_eq!(with_unit("2.00".into(), "um^3/um^2"), "2.00 µm³/µm²");
    }
}
