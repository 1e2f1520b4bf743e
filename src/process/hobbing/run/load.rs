//! The hob's load in a run: bar charts by tooth, and its findings with `tables/hob_load.csv`.

use crate::findings::quantities::blank::OPERATION;
use crate::findings::quantities::cutting::{IDLE, THICKEST_CHIP};
use crate::findings::{Section, Table};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::process::hobbing::measure::hob_load::{OperationLoad, ToothLoad};
use crate::process::hobbing::quantities::{
    ASSUMPTION, AXIAL, HARDEST_TOOTH, HOB_TOOTH, LARGEST_VOLUME, LENGTH_OF_TEETH, LOAD, LOAD_VOLUME, NOTHING,
    PEAK_TO_MEAN, TEETH_IN_USE, THICKEST_OF_TOOTH, TOOTH_PASSES, TOOTH_THICKNESS, TRAVEL, VOLUME_SHARE,
};
use crate::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};
use gearcut_core::units::UM_PER_MM;

/// What the load rests on.
const ASSUMPTION_OF_LOAD: &str = "volume that a tooth takes, as a measure of the work that it does with the specific \
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
                has_mean: true,
                least_division: 0.0,
                limits: Vec::new(),
                title: format!("{}, {name}: {what} by hob tooth", job.scene.name),
                category_name: "hob tooth, from the entering end".into(),
                categories: job.hob.labels(),
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

/// All operations in one table, its rows in the file alone: the operations' own tables have most of it.
fn table(job: &HobbingJob, loads: &[OperationLoad]) -> Table {
    let labels = job.hob.labels();
    let teeth = job.operations.iter().zip(loads).flat_map(|(operation, of)| {
        of.teeth.iter().enumerate().map(move |(index, tooth)| (operation.spec.name.as_str(), of, index, tooth))
    });
    Table::over("all_teeth", "Load by operation and hob tooth", teeth)
        .column(&OPERATION, |&(operation, ..)| operation)
        .column(&HOB_TOOTH, |&(_, _, index, _)| labels[index].as_str())
        .column(&AXIAL, |&(_, _, index, _)| job.hob.teeth[index].axial_mm)
        .column(&LOAD_VOLUME, |(.., tooth)| tooth.volume_mm3)
        .column(&VOLUME_SHARE, |(_, of, _, tooth)| tooth.volume_mm3 / of.volume_mm3())
        .column(&TOOTH_THICKNESS, |(.., tooth)| tooth.thickness_mm)
        .column(&TRAVEL, |(.., tooth)| tooth.travel_mm)
        .column(&TOOTH_PASSES, |(.., tooth)| tooth.passes)
        .rows_in_file("hob_load")
}

/// What the hob's teeth did over the whole process.
pub fn findings(job: &HobbingJob, loads: &[OperationLoad]) -> Section {
    let gear = &job.scene.gear;
    let length_mm = f64::from(gear.teeth) * gear.face_width_mm / gear.helix_angle_rad.cos();
    let operations = loads.iter().enumerate().map(|(index, load)| of_operation(job, load, index));
    LOAD.section([ASSUMPTION.of(ASSUMPTION_OF_LOAD), LENGTH_OF_TEETH.of(length_mm)])
        .table(table(job, loads))
        .part(Section::new("operations", "By operation").parts(operations))
}

fn of_operation(job: &HobbingJob, of: &OperationLoad, index: usize) -> Section {
    let labels = job.hob.labels();
    let hardest = of.peak(|load| load.volume_mm3);
    let thickest = of.peak(|load| load.thickness_mm);
    let name = &job.operations[index].spec.name;
    let teeth = Table::over("teeth", "Load by hob tooth", of.teeth.iter().zip(&labels))
        .column(&HOB_TOOTH, |(_, label)| label.as_str())
        .column(&LOAD_VOLUME, |(load, _)| load.volume_mm3)
        .column(&TOOTH_THICKNESS, |(load, _)| load.thickness_mm)
        .column(&TRAVEL, |(load, _)| load.travel_mm);
    Section::new(name, format!("Operation {name}"))
        .entries([
            LOAD_VOLUME.of(of.volume_mm3()),
            LARGEST_VOLUME.of_or(hardest.map(|t| of.teeth[t].volume_mm3), NOTHING),
            HARDEST_TOOTH.of_or(hardest.map(|t| labels[t].as_str()), NOTHING),
            TEETH_IN_USE.of(of.in_use()),
            PEAK_TO_MEAN.of_or(of.peak_to_mean(), NOTHING),
            THICKEST_CHIP.of_or(thickest.map(|t| of.teeth[t].thickness_mm * UM_PER_MM), IDLE).shown(),
            THICKEST_OF_TOOTH.of_or(thickest.map(|t| labels[t].as_str()), NOTHING),
            TRAVEL.of(of.teeth.iter().map(|load| load.travel_mm).sum::<f64>()),
        ])
        .table(teeth)
}
