//! Charts of chips over the work angle, and maps of uncut chip thickness.
//!
//! Out, per operation: `chips/<operation>_load.svg` and `_chips.svg` (line charts),
//! `chips/<operation>_thickness_by_stroke.{png,exr}` and `_thickness_by_space.{png,exr}`.

use crate::colormap::ColourScale;
use crate::number_text::significant;
use crate::output::atomic::file_error;
use crate::output::exr_map::{ExrMap, MapChannel, write_exr_map};
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::map_png::{MapPicture, write_map_png};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, ThicknessMap};
use crate::process::shaping::report::chip_charts::{charts, shown_end};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// Writes charts and maps of all operations; `notes` go into the EXR headers.
///
/// # Errors
/// Files that cannot be written.
pub fn write(job: &ShapingJob, ledger: &ChipLedger, folder: &OutputFolder, notes: &[(String, String)]) -> Result<()> {
    for (index, operation) in job.operations.iter().enumerate() {
        let name = &operation.spec.name;
        for (what, chart) in charts(job, ledger, index) {
            chart.write_svg(&folder.path(format!("chips/{name}_{what}.svg"))?)?;
        }
        let chips = &ledger.operations[index];
        let feed_mm = operation.schedule.circular_feed_mm_per_stroke();
        let of = if operation.program.is_some() { " of the scene's own strokes" } else { "" };
        let by_stroke = MapAxis {
            name: "feed".into(),
            meaning: format!("mean arc of pitch curve{of}; one stroke is {} mm", significant(feed_mm, 4)),
            start_mm: 0.5 * (chips.by_stroke.per_row - 1.0) * feed_mm,
            step_mm: chips.by_stroke.per_row * feed_mm,
            count: chips.by_stroke.rows,
        };
        let pitch_mm = std::f64::consts::PI * job.transverse.module_mm;
        let by_space = MapAxis {
            name: "space".into(),
            meaning: format!("mean arc of pitch curve; space j is at j times {} mm", significant(pitch_mm, 4)),
            start_mm: f64::from(*job.spaces().start()) * pitch_mm,
            step_mm: pitch_mm,
            count: chips.by_space.rows,
        };
        for (what, axis, map) in [("stroke", by_stroke, &chips.by_stroke), ("space", by_space, &chips.by_space)] {
            let stem = format!("chips/{name}_thickness_by_{what}");
            let title = format!("{name}: uncut chip thickness by tooth {what} and place of the edge");
            let title = if what == "stroke" { title.replace("tooth stroke", "stroke") } else { title };
            write_map(ledger, map, axis, &title, &stem, folder, notes)?;
        }
    }
    Ok(())
}

fn write_map(
    ledger: &ChipLedger,
    map: &ThicknessMap,
    rows: MapAxis,
    title: &str,
    stem: &str,
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    // Stations are nearly, not quite, evenly spaced: every place of the map takes the one nearest to it.
    let stations = &ledger.stations;
    let half_mm = stations.iter().map(|s| s.arc_mm).fold(0.0, f64::max);
    let count = 2 * (half_mm / ledger.spacing_mm).floor() as usize + 1;
    let edge = MapAxis {
        name: "edge".into(),
        meaning: "along the cutter tooth's edge from the middle of its tip, left flank positive".into(),
        start_mm: -((count / 2) as f64) * ledger.spacing_mm,
        step_mm: ledger.spacing_mm,
        count,
    };
    let nearest: Vec<usize> = (0..count)
        .map(|i| {
            let at_mm = edge.place_mm(i);
            let after = stations.partition_point(|s| s.arc_mm < at_mm).min(stations.len() - 1);
            let before = after.saturating_sub(1);
            if at_mm - stations[before].arc_mm < stations[after].arc_mm - at_mm { before } else { after }
        })
        .collect();
    let thickness_mm: Vec<f32> = map
        .thickness_mm
        .chunks(stations.len())
        .flat_map(|row| nearest.iter().map(|&station| if row[station] > 0.0 { row[station] } else { f32::NAN }))
        .collect();
    let grid = MapGrid { u: rows, v: edge };
    let um: Vec<f32> = thickness_mm.iter().map(|h| h * UM_PER_MM as f32).collect();
    let mut high = shown_end(um.iter().filter(|h| h.is_finite()).map(|&h| f64::from(h)));
    if !high.is_finite() {
        high = um.iter().copied().filter(|h| h.is_finite()).fold(1.0, f32::max).into();
    }
    let picture = MapPicture {
        missing: "no chip here",
        title,
        quantity: "uncut chip thickness, largest of cell",
        unit: "µm",
        grid: &grid,
        values: &um,
        scale: ColourScale::Sequential { low: 0.0, high: high as f32 },
    };
    write_map_png(&folder.path(format!("{stem}.png"))?, &picture)?;
    let channels = vec![MapChannel::coarse_lengths_mm(
        "thickness_mm",
        "largest uncut chip thickness of all cutter teeth; NaN where nothing is cut",
        &thickness_mm,
    )];
    let frame =
        "edge frame of a cutter tooth: v = arc along the edge from the middle of the tip, left flank positive; \
        u = feed"
            .to_owned();
    let map = ExrMap { grid, frame, channels, notes: notes.to_vec() };
    write_exr_map(&folder.path(format!("{stem}.exr"))?, &map).map_err(file_error)
}
