//! Cutting forces of the hob's teeth in a run: charts by tooth and over time, findings with `tables/hob_force.csv` and
//! `tables/hob_force_over_time.csv`.

use crate::findings::quantities::blank::OPERATION;
use crate::findings::quantities::cutting::{FORCE_PER_AREA, FORCE_PER_LENGTH, IDLE, LARGEST_FORCE};
use crate::findings::{Place, QuantityRow, Section, Table};
use crate::material::CuttingForce;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::hobbing::measure::hob_force::{OperationForce, PassForce, ToothForce};
use crate::process::hobbing::quantities::{
    ACCURACY, FORCE, HOB_TOOTH, HOB_TURN, LARGEST_EDGE, LARGEST_POWER, LARGEST_SECTION, LAW, MEAN_EDGE, MEAN_FORCE,
    MEAN_POWER, NOTHING, TIME, WORK,
};
use crate::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};

/// How the force of a tooth is defined.
const LAW_OF_FORCE: &str = "K_c times the section of the chip in the rake face plus K_ce times the length of edge in \
    engagement across its motion; means over the travel through a slice of the blank, referred to the hob's tip: \
    moment about the hob's axis over the tip's radius";
/// How far rays know it.
const ACCURACY_OF_RAYS: &str = "of one slice: the length of edge is at most sqrt(2) ray distances off for each stretch \
    of edge that rays of one direction count, and without bias in the mean; the section of a chip 3 mm long and 0.1 mm \
    thick is 17 % off, root mean square, by rays 0.3 mm apart and 5 % by rays 0.15 mm apart; largest values of many \
    slices are therefore too high rather than too low";
/// Curves of single teeth on the chart over time.
const SHOWN_TEETH: usize = 6;
/// N mm in a joule, and W in N mm/s.
const NMM_PER_J: f64 = 1e3;

/// Forces of all operations; none where the scene does not name the material.
pub fn measure(cutter: &HobCutter, blank: &HobbedBlank) -> Vec<OperationForce> {
    let job = cutter.job;
    let Some(material) = job.material else { return Vec::new() };
    let operations = cutter.operations.iter().zip(&job.operations).zip(&blank.in_slices);
    operations
        .map(|((passes, operation), in_slices)| {
            OperationForce::new(passes, &operation.linkage, job.hob.tip_radius_mm, material, in_slices)
        })
        .collect()
}

/// Bars of the largest and the mean force by hob tooth, with the names of their files, operation by operation.
pub fn bars(job: &HobbingJob, forces: &[OperationForce]) -> Vec<(String, BarChart)> {
    let chart = |name: &str, force: &OperationForce| BarChart {
        has_mean: true,
        least_division: 0.0,
        limits: Vec::new(),
        title: format!("{}, {name}: cutting force by hob tooth", job.scene.name),
        category_name: "hob tooth, from the entering end".into(),
        categories: job.hob.labels(),
        value_name: "cutting force, referred to the tip".into(),
        unit: "N".into(),
        series: vec![
            BarSeries {
                name: "largest".to_owned(),
                values: force.teeth.iter().map(|tooth| Some(tooth.peak_n)).collect(),
            },
            BarSeries {
                name: "mean in the cut".to_owned(),
                values: force.teeth.iter().map(ToothForce::mean_n).collect(),
            },
        ],
    };
    let names = job.operations.iter().map(|operation| &operation.spec.name);
    names.zip(forces).map(|(name, force)| (format!("{name}_force"), chart(name, force))).collect()
}

/// Force over time with the names of the files, operation by operation that cuts anything: the largest of any tooth in
/// every turn of the hob, and the teeth with the largest forces.
pub fn over_time(job: &HobbingJob, forces: &[OperationForce]) -> Vec<(String, LineChart)> {
    let labels = job.hob.labels();
    let panel = |value_name: &str, series| Panel {
        value_name: value_name.to_owned(),
        unit: "N".to_owned(),
        series,
        limits: Vec::new(),
        least_division: 0.0,
    };
    let chart = |name: &str, force: &OperationForce| {
        let of_turns = force.passes.chunk_by(|a, b| a.turn == b.turn);
        let largest = of_turns.filter_map(|turn| turn.iter().max_by(|a, b| a.peak_n.total_cmp(&b.peak_n)));
        let mut teeth: Vec<usize> = (0..force.teeth.len()).filter(|&t| force.teeth[t].peak_n > 0.0).collect();
        teeth.sort_by(|&a, &b| force.teeth[b].peak_n.total_cmp(&force.teeth[a].peak_n));
        teeth.truncate(SHOWN_TEETH);
        let points = |passes: &mut dyn Iterator<Item = &PassForce>| passes.map(|p| (p.time_s, p.peak_n)).collect();
        let single = teeth.iter().map(|&tooth| LineSeries {
            name: format!("tooth {}", labels[tooth]),
            points: points(&mut force.passes.iter().filter(|pass| pass.tooth == tooth)),
        });
        LineChart {
            title: format!("{}, {name}: cutting force over time", job.scene.name),
            x_name: "time".to_owned(),
            x_unit: "s".to_owned(),
            panels: vec![
                panel(
                    "largest of any tooth in a turn",
                    vec![LineSeries { name: "all teeth".to_owned(), points: points(&mut largest.into_iter()) }],
                ),
                panel("largest in a turn, by tooth", single.collect()),
            ],
        }
    };
    let names = job.operations.iter().map(|operation| &operation.spec.name);
    let cutting = names.zip(forces).filter(|(_, force)| !force.passes.is_empty());
    cutting.map(|(name, force)| (format!("{name}_force_over_time"), chart(name, force))).collect()
}

/// Forces of all operations; nothing where the scene does not name the material.
pub fn findings(job: &HobbingJob, forces: &[OperationForce]) -> Option<Section> {
    let CuttingForce { per_area_n_per_mm2, per_length_n_per_mm } = job.material?;
    let names = job.operations.iter().map(|operation| operation.spec.name.as_str());
    let operations = names.zip(forces).map(|(name, force)| of_operation(job, name, force));
    let section = FORCE
        .section([
            LAW.of(LAW_OF_FORCE),
            ACCURACY.of(ACCURACY_OF_RAYS),
            FORCE_PER_AREA.of(per_area_n_per_mm2),
            FORCE_PER_LENGTH.of(per_length_n_per_mm),
        ])
        .table(by_tooth(job, forces))
        .table(by_pass(job, forces))
        .part(Section::new("operations", "By operation").parts(operations));
    Some(section)
}

fn of_operation(job: &HobbingJob, name: &str, force: &OperationForce) -> Section {
    let labels = job.hob.labels();
    let largest = |row: &QuantityRow, value: fn(&PassForce) -> f64| {
        let Some(pass) = force.peak(value) else { return row.none(NOTHING) };
        let place = Place::default()
            .and("time_s", pass.time_s)
            .and("hob_turn", pass.turn.max(0) as u64)
            .and("hob_tooth", labels[pass.tooth].clone());
        row.of(value(pass)).at(place)
    };
    let largest_n = match force.peak(|pass| pass.peak_n) {
        Some(_) => largest(&LARGEST_FORCE, |pass| pass.peak_n),
        None => LARGEST_FORCE.none(IDLE),
    };
    let travel_mm: f64 = force.teeth.iter().map(|tooth| tooth.travel_mm).sum();
    Section::new(name, format!("Operation {name}")).entries([
        largest_n.shown(),
        MEAN_FORCE.of_or((travel_mm > 0.0).then(|| force.work_nmm() / travel_mm), NOTHING),
        largest(&LARGEST_SECTION, |pass| pass.section_mm2),
        largest(&LARGEST_EDGE, |pass| pass.edge_mm),
        largest(&LARGEST_POWER, |pass| pass.power_nmm_per_s() / NMM_PER_J),
        MEAN_POWER.of(force.work_nmm() / force.duration_s / NMM_PER_J),
        WORK.of(force.work_nmm() / NMM_PER_J),
    ])
}

/// All operations, tooth by tooth.
fn by_tooth(job: &HobbingJob, forces: &[OperationForce]) -> Table {
    let labels = job.hob.labels();
    let teeth = job.operations.iter().zip(forces).flat_map(|(operation, force)| {
        force.teeth.iter().zip(&labels).map(|(tooth, label)| (operation.spec.name.as_str(), label.as_str(), tooth))
    });
    Table::over("all_teeth", "Force by operation and hob tooth", teeth)
        .column(&OPERATION, |&(operation, ..)| operation)
        .column(&HOB_TOOTH, |&(_, label, _)| label)
        .column(&LARGEST_FORCE, |(.., tooth)| tooth.peak_n)
        .column(&MEAN_FORCE, |(.., tooth)| tooth.mean_n())
        .column(&LARGEST_SECTION, |(.., tooth)| tooth.section_mm2)
        .column(&LARGEST_EDGE, |(.., tooth)| tooth.edge_mm)
        .column(&MEAN_EDGE, |(.., tooth)| tooth.mean_edge_mm)
        .column(&LARGEST_POWER, |(.., tooth)| tooth.power_nmm_per_s / NMM_PER_J)
        .column(&WORK, |(.., tooth)| tooth.work_nmm / NMM_PER_J)
        .in_file("hob_force")
}

/// All operations, pass by pass: thousands of rows, in the file alone.
fn by_pass(job: &HobbingJob, forces: &[OperationForce]) -> Table {
    let labels = job.hob.labels();
    let passes = job
        .operations
        .iter()
        .zip(forces)
        .flat_map(|(operation, force)| force.passes.iter().map(|pass| (operation.spec.name.as_str(), pass)));
    Table::over("over_time", "Force over time", passes)
        .column(&OPERATION, |&(operation, _)| operation)
        .column(&TIME, |(_, pass)| pass.time_s)
        .column(&HOB_TURN, |(_, pass)| pass.turn as f64)
        .column(&HOB_TOOTH, |(_, pass)| labels[pass.tooth].as_str())
        .column(&LARGEST_FORCE, |(_, pass)| pass.peak_n)
        .column(&MEAN_FORCE, |(_, pass)| pass.mean_n())
        .column(&LARGEST_SECTION, |(_, pass)| pass.section_mm2)
        .column(&LARGEST_EDGE, |(_, pass)| pass.edge_mm)
        .rows_in_file("hob_force_over_time")
}
