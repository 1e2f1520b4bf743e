//! The hob's load in a run: bar charts by tooth, and its findings with `tables/hob_load.csv`.

use crate::findings::{Datum, Quantity, Section, Table, TableColumn};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::process::hobbing::measure::hob_load::{OperationLoad, ToothLoad};
use crate::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};

/// What the load rests on.
const ASSUMPTION: &str = "volume that a tooth takes, as a measure of the work that it does with the specific \
    cutting force the same everywhere; wear follows heat and chip thickness besides, so this is no life";

/// One chart: its file, its title, what it shows, its unit and a tooth's value.
type Chart = (&'static str, &'static str, &'static str, fn(&ToothLoad) -> f64);

const CHARTS: [Chart; 3] = [
    ("volume", "volume taken", "mm³", |load| load.volume_mm3),
    ("thickness", "largest uncut chip thickness", "mm", |load| load.thickness_mm),
    ("travel", "travel in the cut", "m", |load| load.travel_mm * 1e-3),
];

/// Loads of all operations.
pub fn measure(cutter: &HobCutter, blank: &HobbedBlank) -> Vec<OperationLoad> {
    cutter.operations.iter().zip(&blank.chips).map(|(passes, chips)| OperationLoad::of_blank(passes, chips)).collect()
}

/// Bars by hob tooth with the names of their files, operation by operation.
pub fn charts(job: &HobbingJob, loads: &[OperationLoad]) -> Vec<(String, BarChart)> {
    let operations = job.operations.iter().zip(loads);
    let charts = operations.flat_map(|(operation, load)| CHARTS.map(|chart| (&operation.spec.name, load, chart)));
    charts
        .map(|(name, load, (stem, what, unit, value))| {
            let chart = BarChart {
                least_division: 0.0,
                limits: Vec::new(),
                title: format!("{}, {name}: {what} by hob tooth", job.scene.name),
                category_name: "hob tooth, from the entering end".into(),
                categories: labels(job),
                value_name: what.into(),
                unit: unit.into(),
                series: vec![BarSeries {
                    name: name.clone(),
                    values: load.teeth.iter().map(|load| Some(value(load))).collect(),
                }],
            };
            (format!("{name}_{stem}"), chart)
        })
        .collect()
}

/// Numbers of the hob's teeth.
pub fn labels(job: &HobbingJob) -> Vec<String> {
    job.hob.teeth.iter().map(|tooth| tooth.label(job.hob.starts)).collect()
}

/// All operations in one table, its rows in the file alone: the operations' own tables have most of it.
fn table(job: &HobbingJob, loads: &[OperationLoad]) -> Table {
    let missing = "no finite number was computed";
    let columns = vec![
        TableColumn::words("operation", "operation"),
        TableColumn::words("hob_tooth", "hob tooth along the thread, from the entering end"),
        TableColumn::new("axial", "mm", "its place along the hob's axis"),
        TableColumn::new("volume", "mm^3", "volume that it takes").or(missing),
        TableColumn::new("volume_share", "1", "its share of the operation's volume").or("the operation takes nothing"),
        TableColumn::new("largest_thickness", "mm", "its largest uncut chip thickness").or(missing),
        TableColumn::new(
            "travel",
            "mm",
            "travel of its tip through the work while any part of its edge takes material",
        )
        .or(missing),
        TableColumn::new("passes", "passes", "passes that took anything"),
    ];
    let labels = labels(job);
    let rows = job.operations.iter().zip(loads).flat_map(|(operation, of_operation)| {
        let whole_mm3 = of_operation.volume_mm3();
        let labels = &labels;
        of_operation.teeth.iter().enumerate().map(move |(index, tooth)| {
            vec![
                Datum::from(operation.spec.name.as_str()),
                labels[index].as_str().into(),
                job.hob.teeth[index].axial_mm.into(),
                tooth.volume_mm3.into(),
                (tooth.volume_mm3 / whole_mm3).into(),
                tooth.thickness_mm.into(),
                tooth.travel_mm.into(),
                tooth.passes.into(),
            ]
        })
    });
    Table::new("all_teeth", "Load by operation and hob tooth", columns).with_rows(rows).rows_in_file("hob_load")
}

/// What the hob's teeth did over the whole process.
pub fn findings(job: &HobbingJob, loads: &[OperationLoad]) -> Section {
    let gear = &job.scene.gear;
    let length_mm = f64::from(gear.teeth) * gear.face_width_mm / gear.helix_angle_rad.cos();
    let operations = loads.iter().enumerate().map(|(index, load)| of_operation(job, load, index));
    Section::new("hob_load", "Work of the hob's teeth")
        .with("assumption", Quantity::text(ASSUMPTION, "what the load rests on"))
        .with(
            "length_of_teeth",
            Quantity::number(
                length_mm,
                "mm",
                "length of all teeth of the gear, z b / cos(beta): by it workshops count how long a hob lasts (Liu et \
                 al. 2015, Eq. 22, for one gear)",
            ),
        )
        .table(table(job, loads))
        .part(Section::new("operations", "By operation").parts(operations))
}

fn of_operation(job: &HobbingJob, of: &OperationLoad, index: usize) -> Section {
    let labels = labels(job);
    let nothing = "the operation takes nothing";
    let tooth = |found: Option<usize>, definition: &'static str| {
        found.map_or_else(
            || Quantity::undefined("", definition, nothing),
            |tooth| Quantity::text(labels[tooth].clone(), definition),
        )
    };
    let number = |found: Option<f64>, unit: &'static str, definition: &'static str| {
        Quantity::number_or(found, unit, definition, nothing)
    };
    let hardest = of.peak(|load| load.volume_mm3);
    let thickest = of.peak(|load| load.thickness_mm);
    let travel_mm: f64 = of.teeth.iter().map(|load| load.travel_mm).sum();
    let missing = "no finite number was computed";
    let bars = |key, unit, definition| TableColumn::new(key, unit, definition).or(missing).as_bars();
    let columns = vec![
        TableColumn::words("tooth", "hob tooth along the thread, from the entering end"),
        bars("volume", "mm^3", "volume that it takes"),
        bars("thickness", "mm", "its largest uncut chip thickness"),
        bars("travel", "mm", "travel of its tip through the work while any part of its edge takes material"),
    ];
    let rows = of.teeth.iter().zip(&labels).map(|(load, label)| {
        vec![Datum::from(label.as_str()), load.volume_mm3.into(), load.thickness_mm.into(), load.travel_mm.into()]
    });
    let name = &job.operations[index].spec.name;
    Section::new(name, format!("Operation {name}"))
        .with("volume", number(Some(of.volume_mm3()), "mm^3", "volume that all hob teeth take together"))
        .shown(
            "largest_volume",
            "most of a tooth",
            number(hardest.map(|t| of.teeth[t].volume_mm3), "mm^3", "volume of the hob tooth that takes the most"),
        )
        .shown("hardest_working_tooth", "tooth", tooth(hardest, "number of the hob tooth that takes the most"))
        .shown(
            "teeth_in_use",
            "teeth in use",
            Quantity::count(
                of.in_use() as u64,
                "teeth",
                "hob teeth that take at least a hundredth of what the hardest working one takes",
            ),
        )
        .shown(
            "peak_to_mean",
            "peak to mean",
            number(
                of.peak_to_mean(),
                "1",
                "largest volume over the mean of all teeth of the hob; 1 where all work alike",
            ),
        )
        .shown(
            "largest_thickness",
            "thickest chip",
            number(
                thickest.map(|t| of.teeth[t].thickness_mm),
                "mm",
                "largest uncut chip thickness, across the swept surface of the edge",
            ),
        )
        .with("thickest_chip_of_tooth", tooth(thickest, "hob tooth that takes the thickest chip"))
        .with(
            "travel",
            Quantity::number(
                travel_mm,
                "mm",
                "travel of the tips through the work while any part of their edge takes material, all teeth together",
            ),
        )
        .table(Table::new("teeth", "Load by hob tooth", columns).with_rows(rows))
}
