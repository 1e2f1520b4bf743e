//! Charts as files: SVG that an XML reader takes, complete, drawn to scale, equal each time.
//!
//! With `GEARCUT_KEEP=folder` the files are kept there for a look.

use std::path::{Path, PathBuf};

use gearcut::output::bar_chart::{BarChart, BarSeries};
use gearcut::output::line_chart::{Limit, LineChart, LineSeries, Panel};
use gearcut::output::ratio_chart::{RatioChart, SkConstruction};
use roxmltree::{Document, Node};

/// Folder for the files of one test, and what removes it again.
fn album() -> (PathBuf, Option<tempfile::TempDir>) {
    if let Some(folder) = std::env::var_os("GEARCUT_KEEP") {
        std::fs::create_dir_all(&folder).expect("the folder to keep charts in");
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
    let mut second = values(0.05, 0.2);
    second[4] = None;
    BarChart {
        has_mean: true,
        least_division: 0.0,
        limits: Vec::new(),
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

/// Parabolic feed marks of 1 um: the ratio curve is (1 - p)^2.
fn ratio() -> RatioChart {
    RatioChart {
        title: "Material ratio of finish: tooth 3, left flank".into(),
        curve: (0..=200).map(|k| f64::from(k) / 200.0).map(|p| (100.0 * p, (1.0 - p).powi(2) - 1.0 / 3.0)).collect(),
        sk: Some(SkConstruction {
            line_um: [0.04, -0.36],
            window_percent: [60.0, 100.0],
            smr1_percent: 38.9,
            smr2_percent: 100.0,
            spk_um: 0.576,
            svk_um: 0.0,
        }),
    }
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).expect("just written")
}

fn elements<'a>(of: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    of.descendants().filter(move |node| node.has_tag_name(("http://www.w3.org/2000/svg", name)))
}

fn number(node: Node, attribute: &str) -> f64 {
    node.attribute(attribute).and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{attribute} of {node:?}"))
}

fn class<'a>(node: Node<'a, 'a>) -> &'a str {
    node.attribute("class").unwrap_or_default()
}

/// The file explains itself, and nothing that it draws leaves it.
fn assert_complete(text: &str, title: &str) {
    let document = Document::parse(text).expect("well-formed XML");
    let root = document.root_element();
    assert_eq!((root.tag_name().name(), root.attribute("role")), ("svg", Some("img")));
    let (width, height) = (number(root, "width"), number(root, "height"));
    assert_eq!(root.attribute("viewBox"), Some(format!("0 0 {width} {height}").as_str()));
    let spoken: Vec<_> = root.attribute("aria-labelledby").unwrap_or_default().split(' ').collect();
    let ids: Vec<_> = root.children().filter_map(|node| node.attribute("id")).collect();
    assert_eq!(spoken, ids);
    let said = |name| root.children().find(|node: &Node| node.has_tag_name(("http://www.w3.org/2000/svg", name)));
    assert_eq!(said("title").and_then(|node| node.text()), Some(title));
    assert!(said("desc").and_then(|node| node.text()).is_some_and(|words| words.len() > 20));
    // White below everything; no colour that a reader's own style could turn.
    let ground = elements(root, "rect").next().expect("a ground");
    assert_eq!(ground.attribute("fill"), Some("#ffffff"));
    assert_eq!((number(ground, "width"), number(ground, "height")), (width, height));
    assert!(!text.contains("var(") && !text.contains("prefers-color-scheme"), "colours are fixed");
    for node in root.descendants().filter(Node::is_element) {
        let shift = node
            .ancestors()
            .filter_map(|above| above.attribute("transform"))
            .map(|shift| shift.trim_start_matches("translate(").trim_end_matches(')').split_once(' ').expect("x and y"))
            .map(|(x, y)| (x.parse::<f64>().expect("x"), y.parse::<f64>().expect("y")))
            .fold((0.0, 0.0), |sum, shift| (sum.0 + shift.0, sum.1 + shift.1));
        for (attributes, shift, most) in [(["x", "x1", "x2"], shift.0, width), (["y", "y1", "y2"], shift.1, height)] {
            for attribute in attributes.into_iter().filter(|name| node.attribute(*name).is_some()) {
                let place = shift + number(node, attribute);
                assert!(place > 2.0 && place < most - 2.0, "{attribute} = {place} of {node:?}");
            }
        }
        if node.has_tag_name(("http://www.w3.org/2000/svg", "text")) {
            // Letters of a sans serif are half an em wide on the average.
            let em = node.attribute("font-size").map_or(12.5, |size| size.parse().expect("a size"));
            let words_px = 0.5 * em * node.text().expect("words").chars().count() as f64;
            let x = shift.0 + number(node, "x");
            let part = [("end", 1.0), ("middle", 0.5)].iter().find(|(word, _)| class(node).contains(word));
            let start = x - part.map_or(0.0, |(_, part)| part * words_px);
            assert!(start > 0.0 && start + words_px < width, "{start} to {} of {node:?}", start + words_px);
        }
    }
}

/// Pixels from the top at which values lie, from the labels of a value axis: slope and place of zero.
fn scale(drawing: Node) -> (f64, f64) {
    let labels: Vec<(f64, f64)> = elements(drawing, "text")
        .filter(|node| class(*node) == "tick end")
        .map(|node| {
            (node.text().expect("a label").replace('–', "-").parse().expect("a number"), number(node, "y") - 4.0)
        })
        .collect();
    let (first, last) = (labels[0], labels[labels.len() - 1]);
    let slope = (last.1 - first.1) / (last.0 - first.0);
    (slope, first.1 - slope * first.0)
}

#[test]
fn bars_are_as_long_as_their_values() {
    let (folder, _vanishes) = album();
    let path = folder.join("bars.svg");
    let chart = bars();
    chart.write_svg(&path).expect("a sound chart");
    let text = read(&path);
    assert_complete(&text, &chart.title);
    for words in [">tooth<", "unevenness, mean denominator [%]", "traditional linkage, mean 0.2", "sans-serif"] {
        assert!(text.contains(words), "no {words:?} in the SVG");
    }
    let document = Document::parse(&text).expect("well-formed XML");
    let drawing = elements(document.root_element(), "g").next().expect("a drawing");
    let (slope, zero) = scale(drawing);
    let groups: Vec<_> = elements(drawing, "g").filter(|node| class(*node).starts_with("bars")).collect();
    assert_eq!(groups.len(), 2);
    for (group, series) in groups.iter().zip(&chart.series) {
        let values: Vec<f64> = series.values.iter().flatten().copied().collect();
        let drawn: Vec<_> = elements(*group, "rect").collect();
        assert_eq!(drawn.len(), values.len(), "a bar for each value");
        for (bar, value) in drawn.into_iter().zip(values) {
            let (top, bottom) = (number(bar, "y"), number(bar, "y") + number(bar, "height"));
            let ends = [zero.min(zero + slope * value), zero.max(zero + slope * value)];
            // Coordinates, also those of the labels, are tenths of a pixel.
            assert!((top - ends[0]).abs() < 0.3 && (bottom - ends[1]).abs() < 0.3, "{top} to {bottom} for {value}");
        }
    }
}

#[test]
fn line_charts_show_panels_limits_and_units() {
    let (folder, _vanishes) = album();
    let path = folder.join("lines.svg");
    let chart = lines();
    chart.write_svg(&path).expect("a sound chart");
    let text = read(&path);
    assert_complete(&text, &chart.title);
    for words in
        ["work angle [°]", "position [mm]", "[10⁶ mm/s³]", "limit 25.0 mm/s", "rapid 500 mm/s, outside the panel"]
    {
        assert!(text.contains(words), "no {words:?} in the SVG");
    }
    assert!(text.len() < 400_000, "20 001 points per curve were to be thinned: {} bytes", text.len());
    let document = Document::parse(&text).expect("well-formed XML");
    let panels: Vec<_> = elements(document.root_element(), "g").collect();
    let count = |panel: usize, name: &str| panels[panel].descendants().filter(|node| class(*node) == name).count();
    assert_eq!([0, 1, 2].map(|panel| count(panel, "limit")), [0, 1, 0], "the far limit is named, not drawn");
    // The velocity of X goes from 18 to -18 mm/s.
    let (slope, zero) = scale(panels[1]);
    let curve = panels[1].descendants().find(|node| class(*node) == "curve s0").expect("a curve");
    let heights = curve.attribute("d").expect("a path").split(['M', 'L']).filter_map(|point| point.split_once(' '));
    let heights: Vec<f64> = heights.map(|(_, y)| y.parse().expect("a number")).collect();
    for (found, value) in
        [(heights.iter().copied().fold(f64::MAX, f64::min), 18.0), (heights.iter().copied().fold(0.0, f64::max), -18.0)]
    {
        assert!((found - (zero + slope * value)).abs() < 0.3, "{value} at {found}");
    }
    // Where values are missing the pen is lifted.
    let gap = panels[2].descendants().find(|node| class(*node) == "curve s0").expect("a curve");
    assert_eq!(gap.attribute("d").expect("a path").matches('M').count(), 2);
}

#[test]
fn the_ratio_curve_has_its_construction_and_its_numbers() {
    let (folder, _vanishes) = album();
    let path = folder.join("ratio.svg");
    ratio().write_svg(&path).expect("a sound chart");
    let text = read(&path);
    assert_complete(&text, &ratio().title);
    for words in
        ["material ratio [%]", "height [µm]", "Sk 0.4000 µm", "Spk 0.5760 µm on Smrk1 38.90 %", "Svk 0.0000 µm"]
    {
        assert!(text.contains(words), "no {words:?} in the SVG");
    }
}

#[test]
fn the_same_chart_gives_the_same_bytes() {
    let (folder, _vanishes) = album();
    let path = folder.join("again.svg");
    lines().write_svg(&path).expect("a sound chart");
    let earlier = read(&path);
    lines().write_svg(&path).expect("a sound chart");
    assert!(earlier == read(&path), "the same chart gave other bytes");
    let mut other = lines();
    other.panels[0].series[0].points[7].1 += 1.0;
    other.write_svg(&path).expect("a sound chart");
    assert!(earlier != read(&path), "another chart gave the same bytes");
}

#[test]
fn words_with_signs_of_xml_are_escaped_and_long_legends_wrap() {
    let (folder, _vanishes) = album();
    let mut chart = bars();
    chart.title = "a < b & c > d, \"Ångström\", δ_d ≤ 2 µm".into();
    chart.categories = (0..42).map(|k| format!("tooth {k}")).collect();
    chart.series = (0..7)
        .map(|k| BarSeries {
            name: format!("series {k} with quite a long name"),
            values: (0..42).map(|j| Some(f64::from(j - 20) * 1e-3 * f64::from(k + 1))).collect(),
        })
        .collect();
    let path = folder.join("many_bars.svg");
    chart.write_svg(&path).expect("seven series");
    assert_complete(&read(&path), &chart.title);
    // A name of a file may hold anything; XML may not.
    let mut chart = lines();
    chart.title = "bell \u{7}".into();
    let path = folder.join("bell.svg");
    chart.write_svg(&path).expect("a strange title");
    assert_complete(&read(&path), "bell \u{fffd}");
}

#[test]
fn charts_without_values_are_drawn_and_wrong_ones_refused() {
    let (folder, _vanishes) = album();
    let path = folder.join("empty.svg");
    let mut chart = bars();
    chart.series.iter_mut().for_each(|series| series.values.fill(None));
    chart.write_svg(&path).expect("axes without bars");
    assert_complete(&read(&path), &chart.title);
    chart.series[1].values.pop();
    let message = chart.write_svg(&folder.join("wrong.svg")).expect_err("41 values").to_string();
    assert!(message.contains("wrong.svg") && message.contains("41 values for 42 categories"), "{message}");
    let mut chart = lines();
    chart.panels[2].series[0].points.clear();
    chart.write_svg(&path).expect("an empty panel");
    chart.panels[1].series.clear();
    assert!(chart.write_svg(&folder.join("wrong.svg")).is_err());
    assert!(!folder.join("wrong.svg").exists());
}
