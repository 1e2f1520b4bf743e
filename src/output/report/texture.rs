//! Texture windows in the report: parameters, material ratio curve, and how Sk is constructed on it.
//!
//! In: one [`TextureBlock`] per window, plain numbers as ISO 25178-2 defines them. Out: markup.

use super::table::PageTable;
use maud::{Markup, html};

use crate::output::ratio_chart::RatioChart;

/// One evaluated window of a flank.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureBlock {
    /// What and where, such as "tooth 3, left flank, 2 x 2 mm about u 3.0, v 0.0 mm".
    pub title: String,
    /// The chain that was applied: form removal, filters.
    pub chain: String,
    /// All parameters.
    pub parameters: Vec<ParameterRow>,
    /// What limits trust in the numbers.
    pub warnings: Vec<String>,
    /// A picture of the surface as PNG, if there is one.
    pub png: Option<Vec<u8>>,
    /// The material ratio curve, if there is one.
    pub material_ratio: Option<RatioChart>,
}

/// A parameter as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterRow {
    /// Symbol of the standard.
    pub symbol: String,
    /// Value with its unit, or why there is none.
    pub value: Result<String, String>,
    /// What it is.
    pub definition: String,
}

/// Parameters that are shown at once; the rest is folded away.
const FIRST: [&str; 18] = [
    "Sa", "Sq", "Sz", "Sp", "Sv", "Ssk", "Sku", "Sk", "Spk", "Svk", "Smrk1", "Smrk2", "Sal", "Str", "Std", "Ssw",
    "Sdq", "Sdr",
];

/// One window.
pub fn window(window: &TextureBlock) -> Markup {
    html! {
        article class="texture" {
            h3 { (window.title) }
            p class="note" { (window.chain) }
            @for warning in &window.warnings { p class="warning" { (warning) } }
            @if let Some(png) = &window.png {
                figure class="chart" {
                    figcaption { "Surface" }
                    // A picture keeps its own white ground and, on a narrow screen, its size: its words stay readable.
                    div class="picture" tabindex="0" role="group" aria-label=(format!("Surface of {}", window.title)) {
                        img alt=(format!("Surface of {}", window.title)) src=(super::data_url("image/png", png));
                    }
                }
            }
            div class="texture-body" {
                @if let Some(chart) = &window.material_ratio { (chart.figure().html()) }
                (first_parameters(window))
            }
            @if !window.parameters.is_empty() {
                details { summary { "All parameters of this window" } (all_parameters(window).markup()) }
            }
        }
    }
}

/// The best-known parameters.
pub(super) fn first(window: &TextureBlock) -> Vec<&ParameterRow> {
    FIRST.iter().filter_map(|name| window.parameters.iter().find(|p| p.symbol == *name)).collect()
}

/// The best-known parameters, and why some of them do not exist.
fn first_parameters(window: &TextureBlock) -> Markup {
    let first = first(window);
    // One reason often holds for several parameters.
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for parameter in &first {
        let Err(why) = &parameter.value else { continue };
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, symbols)) => symbols.push(&parameter.symbol),
            None => reasons.push((why, vec![&parameter.symbol])),
        }
    }
    html! {
        div class="first-parameters" {
            dl {
                @for parameter in &first {
                    div title=(parameter.definition) {
                        dt { (parameter.symbol) }
                        dd { (parameter.value.as_deref().unwrap_or("–")) }
                    }
                }
            }
            @for (reason, symbols) in &reasons { p class="note" { "No " (symbols.join(", ")) ": " (reason) "." } }
        }
    }
}

/// Every parameter with its definition, or with the reason why it does not exist.
fn all_parameters(window: &TextureBlock) -> PageTable {
    let row = |parameter: &ParameterRow| match &parameter.value {
        Ok(value) => vec![parameter.symbol.clone(), value.clone(), parameter.definition.clone()],
        Err(why) => {
            vec![parameter.symbol.clone(), "–".to_owned(), format!("{}; none here: {why}", parameter.definition)]
        }
    };
    PageTable {
        caption: "Parameters after the chain".to_owned(),
        columns: ["Symbol", "Value", "Definition"].map(str::to_owned).to_vec(),
        rows: window.parameters.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::ratio_chart::SkConstruction;
    use crate::output::report::{Block, Page, PageSection};

    /// A row of parabolic feed marks of 1 um: the ratio curve is (1 - p)^2, its core line in closed form.
    fn scallops() -> TextureBlock {
        let mean = 1.0 / 3.0;
        let height = |ratio: f64| (1.0 - ratio).powi(2) - mean;
        TextureBlock {
            title: "tooth 3, <left> flank".into(),
            chain: "plane removed; no filter".into(),
            parameters: [
                ("Sa", "0.257 µm"),
                ("Sq", "0.298 µm"),
                ("Sk", "0.400 µm"),
                ("Spk", "0.576 µm"),
                ("Svk", "0 µm"),
            ]
            .map(|(symbol, value)| (symbol, Ok(value.to_owned())))
            .into_iter()
            .chain([("Str", Err("as along <feed> marks".to_owned()))])
            .map(|(symbol, value)| ParameterRow {
                symbol: symbol.into(),
                value,
                definition: "of parabolic marks".into(),
            })
            .collect(),
            warnings: vec!["fewer than five marks".into()],
            png: None,
            material_ratio: Some(RatioChart {
                title: "Material ratio curve and the construction of Sk".into(),
                curve: (0..=200).map(|k| f64::from(k) / 200.0).map(|p| (100.0 * p, height(p))).collect(),
                sk: Some(SkConstruction {
                    line_um: [0.373_333 - mean, -0.026_667 - mean],
                    window_percent: [60.0, 100.0],
                    smr1_percent: 38.9,
                    smr2_percent: 100.0,
                    spk_um: 0.576,
                    svk_um: 0.0,
                }),
            }),
        }
    }

    /// With `GEARCUT_KEEP=folder` a page with the window is kept there for a look.
    #[test]
    fn the_construction_is_drawn_where_the_numbers_say() {
        let text = window(&scallops()).into_string();
        assert!(text.contains("tooth 3, &lt;left&gt; flank") && text.contains("fewer than five marks"));
        assert!(text.contains("No Str: as along &lt;feed&gt; marks."), "the reason stands beside the numbers");
        assert!(text.contains(">Sk<") && text.contains(">Spk<") && !text.contains(">Svk</text>"), "no valley, no name");
        // The equivalent line runs over the whole width, from 0 % at the left to 100 % at the right of the frame.
        assert!(text.contains(r#"class="curve s1" d="M52 "#), "{text}");
        assert!(text.contains(r#"class="dimension""#));
        if let Some(folder) = std::env::var_os("GEARCUT_KEEP") {
            let section = PageSection::new("texture", "Texture", "", vec![Block::Texture(scallops())]);
            let page = Page {
                what: "cutting report",
                done: "all flanks cut",
                title: "texture".into(),
                subtitle: String::new(),
                operations: Vec::new(),
                complete: true,
                program: "gearcut".into(),
                key_numbers: Vec::new(),
                warnings: Vec::new(),
                viewer: None,
                sections: vec![section],
            };
            page.write(&std::path::Path::new(&folder).join("texture.html")).expect("a folder to keep pages in");
        }
    }
}
