//! Roughness of both flanks of tooth 3 of the paper's gear against the circular feed: the table and the chart in
//! docs/texture.md.
//!
//! `cargo run --release --example roughness_against_feed -- [FOLDER]` writes `roughness_against_feed.csv` and `.svg`
//! into FOLDER (default `out/roughness`) and prints the table. Rough and finishing cut take the same feed; the rough
//! one stands 2 mm off, along the normal or along the line of centres. Three windows: 4 mm in the middle of the
//! flank, 2 mm about the pitch curve, and the whole flank, on which the cusps' height itself changes.

use gearcut::cut::cpu::Cpu;
use gearcut::findings::{QuantityRow, Table};
use gearcut::measure::topography::Form;
use gearcut::output::line_chart::{LineChart, LineSeries, Panel};
use gearcut::output::table::write_table;
use gearcut::process::load;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::{Feed, Shaping};
use gearcut::scene::model::{TextureFilters, TextureWindow, WindowSides};
use gearcut::terms::Side;
use gearcut::texture::{cut_window, windows};
use std::error::Error;
use std::path::{Path, PathBuf};

const FEEDS_MM: [f64; 9] = [0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0];
/// Length of the windows along the profile, mm: in the middle of the flank, about the pitch curve.
const LENGTHS_MM: [f64; 2] = [4.0, 2.0];
const SYMBOLS: [&str; 5] = ["Sa", "Sq", "Sk", "Spk", "Svk"];

static WINDOW: QuantityRow = QuantityRow::new("window", "", "window on the flank");
static SURFACE: QuantityRow = QuantityRow::new("surface", "", "operation and linkage");
static FLANK: QuantityRow = QuantityRow::new("flank", "", "flank of tooth 3");
static FEED: QuantityRow = QuantityRow::new("feed_mm_per_stroke", "1", "circular feed per double stroke, mm");
static STROKES: QuantityRow = QuantityRow::new("strokes_per_revolution", "1", "double strokes per revolution");
static MARKS: QuantityRow = QuantityRow::new("marks", "1", "facets along the profile in the window");
static PARAMETER: QuantityRow = QuantityRow::new("parameter", "um", "parameter of ISO 25178-2");

/// What one operation left on one flank at one feed.
struct Row {
    window: &'static str,
    surface: String,
    side: Side,
    feed_mm: f64,
    strokes: usize,
    values_um: [f64; 5],
    marks: usize,
}

fn measured(scene: &str, feed: Feed, rows: &mut Vec<Row>) -> Result<(), Box<dyn Error>> {
    let path = format!("scenes/shaping/{scene}.toml");
    let mut scene = load(Path::new(&path), &[]).map_err(|problems| problems.to_string())?.scene;
    for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
        operation.feed = feed;
    }
    let window = |sides, center_profile_mm, length_profile_mm| TextureWindow {
        tooth: 3,
        sides,
        operation: None,
        center_profile_mm,
        center_lead_mm: 0.0,
        length_profile_mm,
        length_lead_mm: Some(1.0),
        profile_spacing_mm: Some(0.002),
        lead_spacing_mm: Some(0.1),
        form: Form::Poly2,
        filters: TextureFilters::default(),
        measured: None,
    };
    let probe = ShapingJob::new(scene.clone())?;
    let mut about_pitch_curve = Vec::new();
    let mut whole = Vec::new();
    for (side, sides) in [(Side::Left, WindowSides::Left), (Side::Right, WindowSides::Right)] {
        let flank = probe.target_flank(3, side);
        let crossing_mm = flank.at_height(&probe.blank, 0.0).map(|(arc_mm, _)| arc_mm);
        about_pitch_curve.push(window(sides, crossing_mm, Some(LENGTHS_MM[1])));
        whole.push(window(sides, Some(0.5 * flank.length_mm()), Some(flank.length_mm())));
    }
    let windows_of_all =
        [vec![window(WindowSides::Both, None, Some(LENGTHS_MM[0]))], about_pitch_curve, whole].concat();
    // Roughing and finishing of each.
    let names: Vec<String> = probe.operations.iter().map(|operation| operation.spec.name.clone()).collect();
    scene.textures = windows_of_all
        .iter()
        .flat_map(|window| names.iter().map(|name| TextureWindow { operation: Some(name.clone()), ..window.clone() }))
        .collect();
    let job = ShapingJob::new(scene)?;
    for (index, window) in windows(&job)?.into_iter().enumerate() {
        let texture = cut_window(&job, &Cpu::default(), &window)?;
        let operation = &job.operations[window.operation];
        let evaluated = texture.evaluated?;
        let linkage = if path.contains("traditional") { "traditional" } else { "normal" };
        rows.push(Row {
            // Both sides after both operations.
            window: ["middle", "pitch curve", "whole"][index / 4],
            surface: format!("{}, {linkage}", operation.spec.name),
            side: window.side,
            feed_mm: job.curve.perimeter_mm() / operation.schedule.count() as f64,
            strokes: operation.schedule.count(),
            values_um: SYMBOLS.map(|symbol| evaluated.evaluation.value(symbol).unwrap_or(f64::NAN)),
            marks: texture.marks[1],
        });
    }
    Ok(())
}

fn panel(rows: &[Row], surfaces: &[&str], index: usize) -> Panel {
    let series = surfaces.iter().flat_map(|surface| [(surface, Side::Left), (surface, Side::Right)]);
    Panel {
        least_division: 0.0,
        value_name: SYMBOLS[index].to_owned(),
        unit: "µm".to_owned(),
        series: series
            .map(|(surface, side)| LineSeries {
                name: format!("{surface}, {} flank", side.name()),
                points: rows
                    .iter()
                    .filter(|row| row.window == "middle" && row.surface == *surface && row.side == side)
                    .map(|row| (row.feed_mm, row.values_um[index]))
                    .collect(),
            })
            .collect(),
        limits: Vec::new(),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(|| PathBuf::from("out/roughness"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let mut rows = Vec::new();
    let feeds = FEEDS_MM.map(Feed::CircularMmPerStroke);
    for feed in feeds.into_iter().chain([Feed::StrokesPerRevolution(360)]) {
        for scene in ["elliptical_normal", "elliptical_traditional"] {
            measured(scene, feed, &mut rows)?;
        }
    }
    rows.sort_by(|a, b| {
        (a.window, &a.surface, a.side).cmp(&(b.window, &b.surface, b.side)).then(a.feed_mm.total_cmp(&b.feed_mm))
    });
    let mut table = Table::over("roughness_against_feed", "Roughness against feed", &rows)
        .column(&WINDOW, |row| row.window)
        .column(&SURFACE, |row| row.surface.as_str())
        .column(&FLANK, |row| row.side.name())
        .column(&FEED, |row| row.feed_mm)
        .column(&STROKES, |row| row.strokes)
        .column(&MARKS, |row| row.marks);
    for (place, symbol) in SYMBOLS.into_iter().enumerate() {
        table = table.column(PARAMETER.as_column().keyed(symbol), |row| row.values_um[place]);
    }
    write_table(&folder.join("roughness_against_feed.csv"), &table.into())?;
    println!("| window | surface | flank | feed mm | strokes | marks | Sa | Sq | Sk | Spk | Svk um |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for row in &rows {
        let values = row.values_um.map(|value| format!("{value:.4}")).join(" | ");
        let (window, surface, side) = (row.window, &row.surface, row.side.name());
        println!("| {window} | {surface} | {side} | {:.3} | {} | {} | {values} |", row.feed_mm, row.strokes, row.marks);
    }
    let finished = ["finish, normal"];
    let chart = LineChart {
        title: "Roughness of tooth 3 against circular feed: paper's gear, both linkages finish alike".to_owned(),
        x_name: "circular feed per double stroke".to_owned(),
        x_unit: "mm".to_owned(),
        panels: vec![
            panel(&rows, &finished, 0),
            panel(&rows, &finished, 2),
            panel(&rows, &finished, 3),
            panel(&rows, &finished, 4),
            panel(&rows, &["rough, normal", "rough, traditional"], 0),
        ],
    };
    chart.write_svg(&folder.join("roughness_against_feed.svg"))?;
    Ok(())
}
