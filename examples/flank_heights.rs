//! Cuts one flank of a gear and plots its normal deviations along the profile in the middle of the face.
//!
//! `cargo run --release --example flank_heights -- [SCENE] [TOOTH] [FOLDER]` writes `flank_heights.csv` and `.svg` into
//! FOLDER (default `out/flank_heights`) and prints the largest deviation of the finishing operation. SCENE is
//! `scenes/shaping/elliptical_normal.toml` by default, TOOTH is 4.

use gearcut::findings::{QuantityRow, Table};
use gearcut::output::line_chart::{LineChart, LineSeries, Panel};
use gearcut::output::table::write_table;
use gearcut::{Flank, Job, Side};
use std::error::Error;
use std::path::{Path, PathBuf};

static FLANK: QuantityRow = QuantityRow::new("flank", "", "flank of the tooth");
static OPERATION: QuantityRow = QuantityRow::new("operation", "", "name of the operation");
static ARC: QuantityRow = QuantityRow::new("arc", "mm", "arc along the profile from the form point");
static DEVIATION: QuantityRow = QuantityRow::new("deviation", "um", "normal deviation from the target");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| "scenes/shaping/elliptical_normal.toml".to_owned());
    let tooth: u32 = arguments.next().map_or(Ok(4), |number| number.parse())?;
    let folder = arguments.next().map_or_else(|| PathBuf::from("out/flank_heights"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;

    let scene = gearcut::load(Path::new(&path), &[])?;
    let job = Job::new(scene)?;
    let flanks = [job.cut_flank(tooth, Side::Left)?, job.cut_flank(tooth, Side::Right)?];

    let middle = |flank: &Flank| flank.face_mm.len() / 2;
    let rows = flanks.iter().flat_map(|flank| {
        flank.operations.iter().enumerate().flat_map(move |(operation, name)| {
            flank.profile(operation, middle(flank)).into_iter().map(move |place| (flank, name, place))
        })
    });
    let table = Table::over("flank_heights", "Deviations along the profile", rows)
        .column(&FLANK, |(flank, ..)| flank.side.name())
        .column(&OPERATION, |(_, name, _)| name.as_str())
        .column(&ARC, |(.., (arc_mm, _))| *arc_mm)
        .column(&DEVIATION, |(.., (_, deviation_um))| *deviation_um);
    write_table(&folder.join("flank_heights.csv"), &table.into())?;

    // One panel for each operation: roughing leaves a thousand times what finishing leaves.
    let panels = flanks[0].operations.iter().enumerate().map(|(operation, name)| Panel {
        value_name: format!("normal deviation after {name}"),
        unit: "µm".to_owned(),
        series: flanks
            .iter()
            .map(|flank| LineSeries {
                name: format!("{} flank", flank.side.name()),
                points: flank.profile(operation, middle(flank)),
            })
            .collect(),
        limits: Vec::new(),
        least_division: 0.0,
    });
    let chart = LineChart {
        title: format!("{}: tooth {tooth} in the middle of the face", job.scene().scene.name),
        x_name: "arc from the form point".to_owned(),
        x_unit: "mm".to_owned(),
        panels: panels.collect(),
    };
    chart.write_svg(&folder.join("flank_heights.svg"))?;

    for flank in &flanks {
        let profile = flank.profile(flank.operations.len() - 1, middle(flank));
        let largest = profile.iter().map(|(_, deviation_um)| deviation_um.abs()).fold(0.0, f64::max);
        println!(
            "tooth {tooth} {}: {} places, at most {largest:.4} um off the target",
            flank.side.name(),
            profile.len()
        );
    }
    println!("written: {}", folder.display());
    Ok(())
}
