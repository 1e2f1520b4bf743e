//! The material ratio curve with the construction of Sk on it: the equivalent line, Sk between its ends, and the
//! triangles whose areas are those of peaks and valleys.
//!
//! In: the curve and the numbers of its core as ISO 25178-2 defines them. Out: the chart, on a page or as an SVG file.

use std::path::Path;

use maud::{Markup, html};

use crate::output::axis::{number_text, round_range};
use crate::output::figure::{Figure, LegendEntry, Name, Plot, Sample};
use crate::output::plot::{LABELS_PX, PlotFrame, path, px};
use gearcut_core::Result;

/// A material ratio curve.
#[derive(Debug, Clone, PartialEq)]
pub struct RatioChart {
    /// What is shown.
    pub title: String,
    /// Areal material ratio in percent, height in um over the mean plane; falling heights.
    pub curve: Vec<(f64, f64)>,
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
    /// Smrk1, percent.
    pub smr1_percent: f64,
    /// Smrk2, percent.
    pub smr2_percent: f64,
    /// Spk, um.
    pub spk_um: f64,
    /// Svk, um.
    pub svk_um: f64,
}

impl SkConstruction {
    /// Height of the equivalent line, um.
    fn line_at_um(&self, percent: f64) -> f64 {
        self.line_um[0] + (self.line_um[1] - self.line_um[0]) * percent / 100.0
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let um = |value: f64| format!("{} µm", number_text(value, 4));
        let percent = |value: f64| format!("{value:.2} %");
        let sk = um(self.line_um[0] - self.line_um[1]);
        vec![
            LegendEntry { sample: Sample::Line(1), words: format!("equivalent line, Sk {sk}, 40 % window thick") },
            LegendEntry {
                sample: Sample::Area(1),
                words: format!("Spk {} on Smrk1 {}", um(self.spk_um), percent(self.smr1_percent)),
            },
            LegendEntry {
                sample: Sample::Area(2),
                words: format!("Svk {} on 100 % − Smrk2, Smrk2 {}", um(self.svk_um), percent(self.smr2_percent)),
            },
        ]
    }
}

const WIDTH_PX: f64 = 460.0;
const FRAME_WIDTH_PX: f64 = 364.0;
const LEFT_PX: f64 = 52.0;
const TOP_PX: f64 = 10.0;
const BOTTOM_PX: f64 = 268.0;

impl RatioChart {
    /// Writes the chart as SVG.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write_svg(&self, path: &Path) -> Result<()> {
        self.figure().write_svg(path, None)
    }

    /// Heights at the bottom and the top.
    fn range(&self) -> (f64, f64) {
        let ends = self.sk.iter().flat_map(|sk| {
            let [top, base] = sk.line_um;
            [top, base, top + sk.spk_um, base - sk.svk_um]
        });
        let heights = self.curve.iter().map(|point| point.1).chain(ends);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
        round_range(low, high)
    }

    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let frame = PlotFrame {
            left: LEFT_PX,
            right: LEFT_PX + FRAME_WIDTH_PX,
            top: TOP_PX,
            bottom: BOTTOM_PX,
            range: self.range(),
        };
        let curve: Vec<(f64, f64)> = self.curve.iter().map(|&(ratio, height)| (x_px(ratio), frame.y(height))).collect();
        let drawing = html! {
            (frame.value_axis())
            @for percent in [0_u8, 20, 40, 60, 80, 100] {
                (frame.upright("grid", x_px(percent.into())))
                (frame.label_below(x_px(percent.into()), &percent.to_string()))
            }
            @if let Some(sk) = &self.sk { (construction(sk, &frame)) }
            path class="curve s0" d=(path(&curve)) {}
            (frame.outline())
        };
        let mut legend = vec![LegendEntry { sample: Sample::Line(0), words: "areal material ratio".to_owned() }];
        legend.extend(self.sk.iter().flat_map(SkConstruction::legend));
        Figure {
            title: &self.title,
            plots: vec![Plot {
                name: Name::new("height", frame.ticks().unit_text("µm")),
                legend,
                size_px: (WIDTH_PX, frame.bottom + LABELS_PX),
                drawing,
            }],
            x_name: Name::new("material ratio", "%".to_owned()),
        }
    }
}

fn x_px(percent: f64) -> f64 {
    LEFT_PX + percent / 100.0 * FRAME_WIDTH_PX
}

/// Lines, triangles and names of the construction.
fn construction(sk: &SkConstruction, frame: &PlotFrame) -> Markup {
    let (x, y) = (x_px, |height: f64| frame.y(height));
    let [top, base] = sk.line_um;
    let beside = x(100.0) + 12.0;
    html! {
        polygon class="area s1"
            points=(points(&[(x(0.0), y(top)), (x(sk.smr1_percent), y(top)), (x(0.0), y(top + sk.spk_um))])) {}
        polygon class="area s2"
            points=(points(&[(x(100.0), y(base)), (x(sk.smr2_percent), y(base)), (x(100.0), y(base - sk.svk_um))])) {}
        @for (height, percent) in [(top, sk.smr1_percent), (base, sk.smr2_percent)] {
            (frame.across("limit", height))
            (frame.upright("limit", x(percent)))
        }
        text class="label" x=(px(x(sk.smr1_percent) + 4.0)) y="24" { "Smrk1" }
        text class="label end" x=(px(x(sk.smr2_percent) - 4.0)) y="24" { "Smrk2" }
        path class="curve s1" d=(path(&[0.0, 100.0].map(|p| (x(p), y(sk.line_at_um(p)))))) {}
        path class="window s1" d=(path(&sk.window_percent.map(|p| (x(p), y(sk.line_at_um(p)))))) {}
        line class="dimension" x1=(px(beside)) x2=(px(beside)) y1=(px(y(top))) y2=(px(y(base))) {}
        text class="label" x=(px(beside + 6.0)) y=(px(0.5 * (y(top) + y(base)) + 4.0)) { "Sk" }
        @if sk.spk_um > 0.0 { text class="label" x=(px(x(0.0) + 6.0)) y=(px(y(top + 0.2 * sk.spk_um))) { "Spk" } }
        @if sk.svk_um > 0.0 { text class="label" x=(px(x(100.0) + 6.0)) y=(px(y(base) + 15.0)) { "Svk" } }
    }
}

fn points(corners: &[(f64, f64)]) -> String {
    corners.iter().map(|&(x, y)| format!("{},{}", px(x), px(y))).collect::<Vec<_>>().join(" ")
}
