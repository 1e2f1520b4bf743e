//! Load of every hob tooth on the third-order gear: without shift against diagonal, repeating against reciprocating; the table and the chart in docs/hobbing.md.
//!
//! `cargo run --release --example hob_load -- [FOLDER]` writes `hob_load.csv`, `.png` and `.svg` into FOLDER (default `out/hob_load`) and prints the table and the time that each blank took.

use gearcut::cut::cpu::Cpu;
use gearcut::job::{HobCutter, HobbingJob};
use gearcut::measure::hob_load::{OperationLoad, hoffmeister_of};
use gearcut::output::bar_chart::{BarChart, BarSeries};
use gearcut::output::table::{Cell, write_table};
use gearcut::scene::load;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Name, scene and what is set in it.
const CASES: [(&str, &str, &[&str]); 3] = [
    ("without shift", "third_order_plain", &[]),
    ("reciprocating", "third_order_diagonal", &[]),
    ("repeating", "third_order_diagonal", &["operation.finish.linkage.hobbing_diagonal.strategy=repeating"]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out/hob_load".into()));
    std::fs::create_dir_all(&folder)?;
    let (mut series, mut rows, mut labels) = (Vec::new(), Vec::new(), Vec::new());
    for (name, scene, sets) in CASES {
        let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        let path = format!("scenes/hobbing/{scene}.toml");
        let scene = load(Path::new(&path), &sets).map_err(|problems| problems.to_string())?.scene;
        let job = HobbingJob::new(&scene)?;
        let started = Instant::now();
        let cutter = HobCutter::new(&job)?;
        let blank = cutter.cut_blank(&Cpu::default(), job.blank_field()?, &|| true)?.ok_or("stopped")?;
        let load = OperationLoad::of_blank(&cutter.operations[0], &blank.chips[0]);
        let stats = blank.cut.cuts[0].stats;
        labels = job.hob.teeth.iter().map(|tooth| tooth.label(job.hob.starts)).collect();
        let hardest = load.peak(|tooth| tooth.volume_mm3).ok_or("nothing was cut")?;
        let thickest = load.peak(|tooth| tooth.thickness_mm).ok_or("nothing was cut")?;
        let idle_s = job.operations[0].plan.idle_s;
        println!(
            "{name}: {:.0} mm3; tooth {} takes {:.0} mm3, {:.2} of the mean; {} of {} teeth in use; thickest chip {:.3} mm, Hoffmeister {:.3} mm; \
             way {:.1} m; idle {idle_s:.1} s; {} passes took something of {}; {:.1} s, {:?}",
            load.volume_mm3(),
            labels[hardest],
            load.teeth[hardest].volume_mm3,
            load.peak_to_mean().ok_or("nothing was cut")?,
            load.in_use(),
            load.teeth.len(),
            load.teeth[thickest].thickness_mm,
            hoffmeister_of(&job, 0),
            1e-3 * load.teeth.iter().map(|tooth| tooth.way_mm).sum::<f64>(),
            blank.chips[0].len(),
            cutter.operations[0].count(),
            started.elapsed().as_secs_f64(),
            stats
        );
        for (label, tooth) in labels.iter().zip(&load.teeth) {
            rows.push(vec![
                Cell::from(name),
                label.as_str().into(),
                tooth.volume_mm3.into(),
                tooth.thickness_mm.into(),
                tooth.way_mm.into(),
            ]);
        }
        let values = load.teeth.iter().map(|tooth| Some(1e-3 * tooth.volume_mm3)).collect();
        series.push(BarSeries { name: name.into(), values });
    }
    write_table(
        &folder.join("hob_load.csv"),
        &["strategy", "hob_tooth", "volume_mm3", "largest_thickness_mm", "way_mm"],
        rows,
    )?;
    let chart = BarChart {
        title: "Third-order gear: volume that each hob tooth takes".into(),
        category_name: "hob tooth, from the entering end".into(),
        categories: labels,
        value_name: "volume".into(),
        unit: "cm3".into(),
        series,
    };
    chart.write_png(&folder.join("hob_load.png"))?;
    chart.write_svg(&folder.join("hob_load.svg"))?;
    Ok(())
}
