//! Texture windows in the report: parameters, material ratio curve, and how Sk is constructed on it.
//!
//! In: one [`TextureWindow`] per window, plain numbers as ISO 25178-2 defines them. Out: markup.

use maud::{Markup, html};

use super::plot::{path, px, svg};
use crate::output::axis::{Ticks, round_range};

/// One evaluated window of a flank.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureWindow {
    /// What and where, such as "tooth 3, left flank, 2 x 2 mm about u 3.0, v 0.0 mm".
    pub title: String,
    /// The chain that was applied: form removal, filters.
    pub chain: String,
    /// All parameters.
    pub parameters: Vec<Parameter>,
    /// What limits trust in the numbers.
    pub warnings: Vec<String>,
    /// A picture of the surface as PNG, if there is one.
    pub png: Option<Vec<u8>>,
    /// Areal material ratio curve: ratio in percent, height in um over the mean plane; falling heights.
    pub material_ratio: Vec<(f64, f64)>,
    /// The construction of Sk on that curve.
    pub sk: Option<SkConstruction>,
}

/// A parameter as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Symbol of the standard.
    pub symbol: String,
    /// Value with its unit, or why there is none.
    pub value: Result<String, String>,
    /// What it is.
    pub definition: String,
}

/// Parameters that are shown at once; the rest is folded away.
const FIRST: [&str; 18] = [
    "Sa", "Sq", "Sz", "Sp", "Sv", "Ssk", "Sku", "Sk", "Spk", "Svk", "Smr1", "Smr2", "Sal", "Str", "Std", "Ssw", "Sdq",
    "Sdr",
];

/// Core of the material ratio curve (ISO 25178-2; the least-squares line through the 40 % window of smallest slope).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkConstruction {
    /// Heights of the equivalent line at 0 % and at 100 %, um.
    pub line_um: [f64; 2],
    /// First and last ratio of the 40 % window, percent.
    pub window_percent: [f64; 2],
    /// Smr1, percent.
    pub smr1_percent: f64,
    /// Smr2, percent.
    pub smr2_percent: f64,
    /// Spk, um.
    pub spk_um: f64,
    /// Svk, um.
    pub svk_um: f64,
}

/// One window.
pub fn window(window: &TextureWindow) -> Markup {
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
                @if window.material_ratio.len() > 1 { (material_ratio(window)) }
                (first_parameters(window))
            }
            @if !window.parameters.is_empty() {
                details { summary { "All parameters of this window" } (all_parameters(window).markup()) }
            }
        }
    }
}

/// The best-known parameters, and why some of them do not exist.
fn first_parameters(window: &TextureWindow) -> Markup {
    let first: Vec<&Parameter> =
        FIRST.iter().filter_map(|name| window.parameters.iter().find(|p| p.symbol == *name)).collect();
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
fn all_parameters(window: &TextureWindow) -> super::Table {
    let row = |parameter: &Parameter| match &parameter.value {
        Ok(value) => vec![parameter.symbol.clone(), value.clone(), parameter.definition.clone()],
        Err(why) => {
            vec![parameter.symbol.clone(), "–".to_owned(), format!("{}; none here: {why}", parameter.definition)]
        }
    };
    super::Table {
        caption: "Parameters after the chain".to_owned(),
        columns: ["Symbol", "Value", "Definition"].map(str::to_owned).to_vec(),
        rows: window.parameters.iter().map(row).collect(),
    }
}

/// The curve with the equivalent line, Sk between its ends, and the triangles whose areas are those of peaks and
/// valleys.
fn material_ratio(window: &TextureWindow) -> Markup {
    const WIDTH: f64 = 460.0;
    const LEFT: f64 = 52.0;
    const RIGHT: f64 = 44.0;
    const BOTTOM: f64 = 268.0;
    let triangles = |sk: &SkConstruction| [sk.line_um[0] + sk.spk_um, sk.line_um[1] - sk.svk_um];
    let ends = window.sk.iter().flat_map(|sk| sk.line_um.into_iter().chain(triangles(sk)));
    let heights = window.material_ratio.iter().map(|point| point.1).chain(ends);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    let (low, high) = round_range(low, high);
    let x = |percent: f64| LEFT + percent / 100.0 * (WIDTH - LEFT - RIGHT);
    let y = |height: f64| BOTTOM - (height - low) / (high - low) * (BOTTOM - 10.0);
    let ticks = Ticks::over(low, high, 8);
    let curve: Vec<(f64, f64)> = window.material_ratio.iter().map(|&(ratio, height)| (x(ratio), y(height))).collect();
    let content = html! {
        @for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
            line class="grid" x1=(LEFT) x2=(WIDTH - RIGHT) y1=(px(y(value))) y2=(px(y(value))) {}
            text class="tick end" x=(LEFT - 7.0) y=(px(y(value) + 4.0)) { (label) }
        }
        @for percent in [0.0, 20.0, 40.0, 60.0, 80.0, 100.0] {
            line class="grid" x1=(px(x(percent))) x2=(px(x(percent))) y1="10" y2=(BOTTOM) {}
            text class="tick middle" x=(px(x(percent))) y=(px(BOTTOM + 17.0)) { (percent) }
        }
        @if let Some(sk) = &window.sk {
            @let [top, base] = sk.line_um;
            polygon class="peak" points=(points(&[(x(0.0), y(top)), (x(sk.smr1_percent), y(top)), (x(0.0), y(top + sk.spk_um))])) {}
            polygon class="valley" points=(points(&[(x(100.0), y(base)), (x(sk.smr2_percent), y(base)), (x(100.0), y(base - sk.svk_um))])) {}
            @for (height, percent) in [(top, sk.smr1_percent), (base, sk.smr2_percent)] {
                line class="limit" x1=(px(x(0.0))) x2=(px(x(100.0))) y1=(px(y(height))) y2=(px(y(height))) {}
                line class="limit" x1=(px(x(percent))) x2=(px(x(percent))) y1="10" y2=(BOTTOM) {}
            }
            text class="label" x=(px(x(sk.smr1_percent) + 4.0)) y="24" { "Smr1" }
            text class="label end" x=(px(x(sk.smr2_percent) - 4.0)) y="24" { "Smr2" }
            path class="curve s1" d=(path(&[(x(0.0), y(top)), (x(100.0), y(base))])) {}
            path class="window" d=(path(&sk.window_percent.map(|p| (x(p), y(top + (base - top) * p / 100.0))))) {}
            line class="dimension" x1=(px(x(100.0) + 12.0)) x2=(px(x(100.0) + 12.0)) y1=(px(y(top))) y2=(px(y(base))) {}
            text class="label" x=(px(x(100.0) + 18.0)) y=(px(0.5 * (y(top) + y(base)) + 4.0)) { "Sk" }
            @if sk.spk_um > 0.0 { text class="label" x=(px(x(0.0) + 6.0)) y=(px(y(top + 0.2 * sk.spk_um))) { "Spk" } }
            @if sk.svk_um > 0.0 { text class="label" x=(px(x(100.0) + 6.0)) y=(px(y(base) + 15.0)) { "Svk" } }
        }
        path class="curve s0" d=(path(&curve)) {}
        rect class="frame" x=(LEFT) y="10" width=(WIDTH - LEFT - RIGHT) height=(BOTTOM - 10.0) {}
    };
    html! {
        figure class="chart" {
            figcaption { "Material ratio curve and the construction of Sk" }
            div class="panel-head" {
                span class="panel-name" { "height " span class="unit" { "[" (ticks.unit_text("µm")) "]" } }
                (super::plot::legend(&[
                    ("line s0".to_owned(), "areal material ratio".to_owned()),
                    ("line s1".to_owned(), "equivalent line, 40 % window thick".to_owned()),
                ]))
            }
            (svg(WIDTH, BOTTOM + 26.0, &format!("Material ratio curve of {}", window.title), &content))
            div class="x-name" { "material ratio [%]" }
        }
    }
}

fn points(corners: &[(f64, f64)]) -> String {
    corners.iter().map(|&(x, y)| format!("{},{}", px(x), px(y))).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::report::{Block, Page, Section};

    /// A row of parabolic feed marks of 1 um: the ratio curve is (1 - p)^2, its core line in closed form.
    fn scallops() -> TextureWindow {
        let mean = 1.0 / 3.0;
        let height = |ratio: f64| (1.0 - ratio).powi(2) - mean;
        TextureWindow {
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
            .map(|(symbol, value)| Parameter { symbol: symbol.into(), value, definition: "of parabolic marks".into() })
            .collect(),
            warnings: vec!["fewer than five marks".into()],
            png: None,
            material_ratio: (0..=200).map(|k| f64::from(k) / 200.0).map(|p| (100.0 * p, height(p))).collect(),
            sk: Some(SkConstruction {
                line_um: [0.373_333 - mean, -0.026_667 - mean],
                window_percent: [60.0, 100.0],
                smr1_percent: 38.9,
                smr2_percent: 100.0,
                spk_um: 0.576,
                svk_um: 0.0,
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
            let section = Section {
                id: "texture",
                title: "Texture".into(),
                lead: String::new(),
                blocks: vec![Block::Texture(scallops())],
            };
            let page = Page {
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
