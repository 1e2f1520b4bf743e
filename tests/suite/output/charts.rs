//! Charts: PNG and SVG of the same drawing, complete, equal each time; SVG well-formed.
//!
//! With `GEARCUT_KEEP=folder` the pictures are kept there for a look.

use std::path::{Path, PathBuf};

use gearcut::output::bar_chart::{BarChart, BarSeries};
use gearcut::output::line_chart::{Limit, LineChart, LineSeries, Panel};
use image::RgbImage;

/// Folder for the pictures of one test, and what removes it again.
fn album() -> (PathBuf, Option<tempfile::TempDir>) {
    if let Some(folder) = std::env::var_os("GEARCUT_KEEP") {
        std::fs::create_dir_all(&folder).expect("the folder to keep pictures in");
        return (folder.into(), None);
    }
    let vanishes = tempfile::tempdir().expect("a folder for the test");
    (vanishes.path().to_owned(), Some(vanishes))
}

/// 42 teeth, two linkages; tooth 5 has no value under the second.
fn bars() -> BarChart {
    let values = |level: f64, swing: f64| -> Vec<Option<f64>> {
        (0..42).map(|k| Some(level + swing * (f64::from(k) * 0.9).sin())).collect()
    };
    let mut second = values(0.05, 0.02);
    second[4] = None;
    BarChart {
        least_division: 0.0,
        title: "Unevenness of the finishing allowance".into(),
        category_name: "tooth".into(),
        categories: (1..=42).map(|tooth| tooth.to_string()).collect(),
        value_name: "unevenness, mean denominator".into(),
        unit: "%".into(),
        series: vec![
            BarSeries { name: "traditional linkage".into(), values: values(0.23, 0.12) },
            BarSeries { name: "normal linkage".into(), values: second },
        ],
    }
}

fn lines() -> LineChart {
    let curve = |name: &str, value: fn(f64) -> f64| LineSeries {
        name: name.into(),
        points: (0..=20_000).map(|k| f64::from(k) * 0.018).map(|x_deg| (x_deg, value(x_deg.to_radians()))).collect(),
    };
    let panel = |value_name: &str, unit: &str, series, limits| Panel {
        least_division: 0.0,
        value_name: value_name.into(),
        unit: unit.into(),
        series,
        limits,
    };
    let limit = |name: &str, value| Limit { name: name.into(), value };
    LineChart {
        title: "Axes during finishing, normal linkage".into(),
        x_name: "work angle".into(),
        x_unit: "°".into(),
        panels: vec![
            panel(
                "position",
                "mm",
                vec![
                    curve("X, centre distance", |x| 91.0 + 6.0 * (3.0 * x).cos()),
                    curve("Y, shift", |x| 4.0 * (3.0 * x).sin()),
                ],
                vec![],
            ),
            panel(
                "velocity",
                "mm/s",
                vec![curve("X", |x| -18.0 * (3.0 * x).sin()), curve("Y", |x| 12.0 * (3.0 * x).cos())],
                vec![limit("limit", 25.0), limit("rapid", 500.0)],
            ),
            panel(
                "jerk",
                "mm/s³",
                vec![curve("X", |x| if x > 3.0 && x < 3.3 { f64::NAN } else { 2.4e6 * (9.0 * x).sin() })],
                vec![],
            ),
        ],
    }
}

fn pixels(path: &Path) -> RgbImage {
    image::open(path).expect("a PNG").into_rgb8()
}

/// A clipped label touches the border of the picture.
fn assert_white_edge(image: &RgbImage) {
    let (width, height) = image.dimensions();
    let on_edge = |x: u32, y: u32| x < 3 || y < 3 || x + 3 >= width || y + 3 >= height;
    let stray = image.enumerate_pixels().find(|(x, y, pixel)| on_edge(*x, *y) && pixel.0 != [255; 3]);
    assert!(stray.is_none(), "ink at the picture's edge: {stray:?}");
}

fn share(image: &RgbImage, colour: [u8; 3]) -> f64 {
    image.pixels().filter(|pixel| pixel.0 == colour).count() as f64 / f64::from(image.width() * image.height())
}

/// Whether tags are closed in the order they were opened, attributes are quoted, and no bare `<` or `&` stands in
/// texts.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "a bare > in {text:?}");
        let end = start + rest[start..].find('>').expect("each tag ends");
        let tag = &rest[start + 1..end];
        assert_eq!(tag.matches('"').count() % 2, 0, "quotes in {tag}");
        let name = |tag: &str| tag.split(['/', ' ', '\n']).find(|part| !part.is_empty()).unwrap_or("").to_owned();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name(closed)), "closing tag");
        } else if !tag.ends_with('/') && !tag.starts_with(['?', '!']) {
            open.push(name(tag));
        }
        rest = &rest[end + 1..];
    }
    assert_eq!(open, Vec::<String>::new(), "tags left open");
    for (place, _) in svg.match_indices('&') {
        let entity = &svg[place..svg.len().min(place + 6)];
        assert!(["&lt;", "&gt;", "&amp;"].iter().any(|known| entity.starts_with(known)), "a bare & in {entity:?}");
    }
}

#[test]
fn bar_charts_show_their_series_and_keep_their_labels() {
    let (folder, _vanishes) = album();
    let (png, svg) = (folder.join("bars.png"), folder.join("bars.svg"));
    bars().write_png(&png).expect("a sound chart");
    bars().write_svg(&svg).expect("a sound chart");
    let image = pixels(&png);
    assert_white_edge(&image);
    let (first, second) = (share(&image, [0, 114, 178]), share(&image, [213, 94, 0]));
    assert!(first > 0.1 && second > 0.02 && second < first, "shares {first}, {second}");
    let text = std::fs::read_to_string(&svg).expect("just written");
    assert_well_formed(&text);
    for words in ["Unevenness of the finishing allowance", "tooth", "[%]", "normal linkage, mean 0.0", "sans-serif"] {
        assert!(text.contains(words), "no {words:?} in the SVG");
    }
    assert!(text.starts_with(&format!("<svg width=\"{}\" height=\"{}\" viewBox=", image.width(), image.height())));
}

#[test]
fn line_charts_show_panels_limits_and_units() {
    let (folder, _vanishes) = album();
    let (png, svg) = (folder.join("lines.png"), folder.join("lines.svg"));
    lines().write_png(&png).expect("a sound chart");
    lines().write_svg(&svg).expect("a sound chart");
    let image = pixels(&png);
    assert_white_edge(&image);
    let text = std::fs::read_to_string(&svg).expect("just written");
    assert_well_formed(&text);
    for words in
        ["work angle [°]", "position [mm]", "[10⁶ mm/s³]", "limit 25.0 mm/s", "rapid 500 mm/s, outside the panel"]
    {
        assert!(text.contains(words), "no {words:?} in the SVG");
    }
    assert!(text.len() < 400_000, "20 001 points per curve were to be thinned: {} bytes", text.len());
}

#[test]
fn the_same_chart_gives_the_same_bytes() {
    let (folder, _vanishes) = album();
    let path = folder.join("again.png");
    let mut earlier = None;
    for _ in 0..2 {
        lines().write_png(&path).expect("a sound chart");
        let bytes = std::fs::read(&path).expect("just written");
        assert!(earlier.is_none_or(|earlier| earlier == bytes), "the same chart gave other bytes");
        earlier = Some(bytes);
    }
}

#[test]
fn words_with_signs_of_xml_are_escaped_and_long_legends_wrap() {
    let (folder, _vanishes) = album();
    let mut chart = bars();
    chart.title = "a < b & c > d, Ångström, δ_d ≤ 2 µm".into();
    chart.categories = (0..42).map(|k| format!("tooth {k}")).collect();
    chart.series = (0..7)
        .map(|k| BarSeries {
            name: format!("series {k} with quite a long name"),
            values: (0..42).map(|j| Some(f64::from(j - 20) * 1e-3 * f64::from(k + 1))).collect(),
        })
        .collect();
    let (png, svg) = (folder.join("many_bars.png"), folder.join("many_bars.svg"));
    chart.write_png(&png).expect("seven series");
    chart.write_svg(&svg).expect("seven series");
    assert_white_edge(&pixels(&png));
    assert_well_formed(&std::fs::read_to_string(&svg).expect("just written"));
}

#[test]
fn charts_without_values_are_drawn_and_wrong_ones_refused() {
    let (folder, _vanishes) = album();
    let path = folder.join("empty.png");
    let mut chart = bars();
    chart.series.iter_mut().for_each(|series| series.values.fill(None));
    chart.write_png(&path).expect("axes without bars");
    assert_white_edge(&pixels(&path));
    chart.series[1].values.pop();
    let message = chart.write_png(&folder.join("wrong.png")).expect_err("41 values").to_string();
    assert!(message.contains("wrong.png") && message.contains("41 values for 42 categories"), "{message}");
    let mut chart = lines();
    chart.panels[2].series[0].points.clear();
    chart.write_png(&path).expect("an empty panel");
    chart.panels[1].series.clear();
    assert!(chart.write_svg(&folder.join("wrong.svg")).is_err());
    assert!(!folder.join("wrong.svg").exists());
}
