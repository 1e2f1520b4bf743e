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
    /// Name, value with its unit, definition of each parameter.
    pub parameters: Vec<[String; 3]>,
    /// What limits trust in the numbers.
    pub warnings: Vec<String>,
    /// A picture of the surface as PNG, if there is one.
    pub png: Option<Vec<u8>>,
    /// Areal material ratio curve: ratio in percent, height in um over the mean plane; falling heights.
    pub material_ratio: Vec<(f64, f64)>,
    /// The construction of Sk on that curve.
    pub sk: Option<SkConstruction>,
}

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
            div class="texture-body" {
                @if let Some(png) = &window.png {
                    figure class="chart" {
                        figcaption { "Surface" }
                        img alt=(format!("Surface of {}", window.title)) src=(super::data_url("image/png", png));
                    }
                }
                @if window.material_ratio.len() > 1 { (material_ratio(window)) }
                div class="table" {
                    table {
                        thead { tr { th { "Parameter" } th class="number" { "Value" } } }
                        tbody {
                            @for [name, value, definition] in &window.parameters {
                                tr title=(definition) { th scope="row" { (name) } td class="number" { (value) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The curve with the equivalent line, Sk between its ends, and the triangles whose areas are those of peaks and valleys.
fn material_ratio(window: &TextureWindow) -> Markup {
    const WIDTH: f64 = 460.0;
    const LEFT: f64 = 52.0;
    const RIGHT: f64 = 44.0;
    const BOTTOM: f64 = 268.0;
    let heights = window.material_ratio.iter().map(|point| point.1).chain(window.sk.iter().flat_map(|sk| sk.line_um));
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
                line class="limit" x1=(px(x(percent))) x2=(px(x(percent))) y1=(px(y(height))) y2=(BOTTOM) {}
            }
            text class="label end" x=(px(x(sk.smr1_percent) - 4.0)) y=(px(BOTTOM - 6.0)) { "Smr1" }
            text class="label" x=(px((x(sk.smr2_percent) + 4.0).min(WIDTH - RIGHT))) y=(px(BOTTOM - 6.0)) { "Smr2" }
            path class="curve s1" d=(path(&[(x(0.0), y(top)), (x(100.0), y(base))])) {}
            path class="window" d=(path(&sk.window_percent.map(|p| (x(p), y(top + (base - top) * p / 100.0))))) {}
            line class="dimension" x1=(px(x(100.0) + 12.0)) x2=(px(x(100.0) + 12.0)) y1=(px(y(top))) y2=(px(y(base))) {}
            text class="label" x=(px(x(100.0) + 18.0)) y=(px(0.5 * (y(top) + y(base)) + 4.0)) { "Sk" }
            @if sk.spk_um > 0.0 { text class="label" x=(px(x(0.0) + 6.0)) y=(px(y(top + sk.spk_um) + 12.0)) { "Spk" } }
            @if sk.svk_um > 0.0 { text class="label end" x=(px(x(100.0) - 6.0)) y=(px(y(base - sk.svk_um) - 4.0)) { "Svk" } }
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
            (svg(WIDTH, BOTTOM + 26.0, &format!("Material ratio curve of {}", window.title), content))
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

    #[test]
    fn the_construction_is_drawn_where_the_numbers_say() {
        let window = TextureWindow {
            title: "tooth 3 <left>".into(),
            chain: "plane removed; no filter".into(),
            parameters: vec![["Sk".into(), "0.40 µm".into(), "core height".into()]],
            warnings: vec!["fewer than five marks".into()],
            png: None,
            material_ratio: (0..=100).map(|p| (f64::from(p), 0.5 - 0.01 * f64::from(p))).collect(),
            sk: Some(SkConstruction {
                line_um: [0.5, -0.5],
                window_percent: [30.0, 70.0],
                smr1_percent: 10.0,
                smr2_percent: 90.0,
                spk_um: 0.1,
                svk_um: 0.0,
            }),
        };
        let text = super::window(&window).into_string();
        assert!(text.contains("tooth 3 &lt;left&gt;") && text.contains("fewer than five marks"));
        assert!(text.contains(">Spk<") && !text.contains(">Svk<"), "no valley, no name for it");
        // Sk is measured between the line's ends: y(0.5) and y(-0.5) on axes from -0.6 to 0.6.
        let sheet = material_ratio(&window).into_string();
        assert!(sheet.contains(r#"class="dimension""#) && sheet.contains(">Sk<"), "{sheet}");
    }
}
