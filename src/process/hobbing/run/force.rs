//! Cutting forces of the hob's teeth in a run: charts by tooth and over time, findings with `tables/hob_force.csv` and
//! `tables/hob_force_over_time.csv`.

use super::load::labels;
use crate::findings::{Datum, Place, Quantity, Section, Table, TableColumn};
use crate::material::CuttingForce;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::hobbing::measure::hob_force::{OperationForce, PassForce, ToothForce};
use crate::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};

/// How the force of a tooth is defined.
const LAW: &str = "K_c times the section of the chip in the rake face plus K_ce times the length of edge in engagement \
    across its motion; means over the travel through a slice of the blank, referred to the hob's tip: moment about the \
    hob's axis over the tip's radius";
/// How far rays know it.
const ACCURACY: &str = "of one slice: the length of edge is at most sqrt(2) ray distances off for each stretch of edge \
    that rays of one direction count, and without bias in the mean; the section of a chip 3 mm long and 0.1 mm thick \
    is 17 % off, root mean square, by rays 0.3 mm apart and 5 % by rays 0.15 mm apart; largest values of many \
    slices are therefore too high rather than too low";
/// Curves of single teeth on the chart over time.
const SHOWN_TEETH: usize = 6;
const NOTHING: &str = "the tooth takes nothing";
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
        least_division: 0.0,
        limits: Vec::new(),
        title: format!("{}, {name}: cutting force by hob tooth", job.scene.name),
        category_name: "hob tooth, from the entering end".into(),
        categories: labels(job),
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
    let labels = labels(job);
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
    Some(
        Section::new("hob_force", "Cutting forces of the hob's teeth")
            .with("law", Quantity::text(LAW, "how the cutting force of a hob tooth is defined"))
            .with("accuracy", Quantity::text(ACCURACY, "how far the blank's rays know forces"))
            .with(
                "force_per_area",
                Quantity::number(per_area_n_per_mm2, "N/mm^2", "K_c of the material: cutting force per area of chip"),
            )
            .with(
                "force_per_length",
                Quantity::number(
                    per_length_n_per_mm,
                    "N/mm",
                    "K_ce of the material: cutting force per length of edge that a chip of no thickness would need",
                ),
            )
            .table(by_tooth(job, forces))
            .table(by_pass(job, forces))
            .part(Section::new("operations", "By operation").parts(operations)),
    )
}

fn of_operation(job: &HobbingJob, name: &str, force: &OperationForce) -> Section {
    let labels = labels(job);
    let nothing = "the operation takes nothing";
    let largest = |unit: &'static str, definition: &'static str, value: &dyn Fn(&PassForce) -> f64| {
        let Some(pass) = force.peak(value) else { return Quantity::undefined(unit, definition, nothing) };
        let place = Place::default()
            .and("time_s", pass.time_s)
            .and("hob_turn", pass.turn.max(0) as u64)
            .and("hob_tooth", labels[pass.tooth].clone());
        Quantity::number(value(pass), unit, definition).at(place)
    };
    let travel_mm: f64 = force.teeth.iter().map(|tooth| tooth.travel_mm).sum();
    let mean_n = (travel_mm > 0.0).then(|| force.work_nmm() / travel_mm);
    Section::new(name, format!("Operation {name}"))
        .shown(
            "largest_force",
            "largest force of a tooth",
            largest("N", "largest cutting force of a hob tooth, referred to the tip", &|pass| pass.peak_n),
        )
        .shown(
            "mean_force",
            "mean force of a tooth",
            Quantity::number_or(
                mean_n,
                "N",
                "work of all hob teeth over their travel in the cut: mean force of a cutting tooth, referred to the \
                 tip",
                nothing,
            ),
        )
        .with(
            "largest_section",
            largest("mm^2", "largest section of a chip in the rake face, referred to the tip", &|pass| {
                pass.section_mm2
            }),
        )
        .with(
            "largest_engaged_edge",
            largest(
                "mm",
                "largest length of edge of a hob tooth that takes material at once, across its motion, referred to the \
                tip",
                &|pass| pass.edge_mm,
            ),
        )
        .shown(
            "largest_power",
            "largest power of a tooth",
            largest("W", "largest cutting force of a pass times the speed of the hob's tip in it", &|pass| {
                pass.power_nmm_per_s() / NMM_PER_J
            }),
        )
        .with(
            "mean_power",
            Quantity::number(
                force.work_nmm() / force.duration_s / NMM_PER_J,
                "W",
                "work of all hob teeth over the time of the operation, approach, overrun and idle travel included",
            ),
        )
        .with("work", Quantity::number(force.work_nmm() / NMM_PER_J, "J", "work of all hob teeth"))
}

/// All operations, tooth by tooth.
fn by_tooth(job: &HobbingJob, forces: &[OperationForce]) -> Table {
    let missing = "no finite number was computed";
    let number = |key, unit, definition| TableColumn::new(key, unit, definition).or(missing);
    let columns = vec![
        TableColumn::words("operation", "operation"),
        TableColumn::words("hob_tooth", "hob tooth along the thread, from the entering end"),
        number("largest_force", "N", "its largest cutting force, referred to the tip"),
        TableColumn::new("mean_force", "N", "its mean cutting force over its travel in the cut, referred to the tip")
            .or(NOTHING),
        number("largest_section", "mm^2", "its largest section of a chip"),
        number("largest_engaged_edge", "mm", "largest length of its edge that takes material at once"),
        number("mean_engaged_edge", "mm", "mean length of its edge that takes material, over its travel in the cut"),
        number("largest_power", "W", "its largest cutting force in a pass times the speed of the tip"),
        number("work", "J", "its work"),
    ];
    let labels = labels(job);
    let rows = job.operations.iter().zip(forces).flat_map(|(operation, force)| {
        force.teeth.iter().zip(&labels).map(|(tooth, label)| {
            vec![
                Datum::from(operation.spec.name.as_str()),
                label.as_str().into(),
                tooth.peak_n.into(),
                tooth.mean_n().into(),
                tooth.section_mm2.into(),
                tooth.edge_mm.into(),
                tooth.mean_edge_mm.into(),
                (tooth.power_nmm_per_s / NMM_PER_J).into(),
                (tooth.work_nmm / NMM_PER_J).into(),
            ]
        })
    });
    Table::new("all_teeth", "Force by operation and hob tooth", columns).with_rows(rows).in_file("hob_force")
}

/// All operations, pass by pass: thousands of rows, in the file alone.
fn by_pass(job: &HobbingJob, forces: &[OperationForce]) -> Table {
    let missing = "no finite number was computed";
    let number = |key, unit, definition| TableColumn::new(key, unit, definition).or(missing);
    let columns = vec![
        TableColumn::words("operation", "operation"),
        number("time", "s", "when the hob tooth points to the work"),
        number("hob_turn", "1", "turn of the hob"),
        TableColumn::words("hob_tooth", "hob tooth along the thread, from the entering end"),
        number("largest_force", "N", "largest cutting force in the pass, referred to the tip"),
        number("mean_force", "N", "mean cutting force over the travel in the cut, referred to the tip"),
        number("largest_section", "mm^2", "largest section of the chip"),
        number("largest_engaged_edge", "mm", "largest length of edge that takes material at once"),
    ];
    let labels = labels(job);
    let rows = job.operations.iter().zip(forces).flat_map(|(operation, force)| {
        force.passes.iter().map(|pass| {
            vec![
                Datum::from(operation.spec.name.as_str()),
                pass.time_s.into(),
                (pass.turn as f64).into(),
                labels[pass.tooth].as_str().into(),
                pass.peak_n.into(),
                pass.mean_n().into(),
                pass.section_mm2.into(),
                pass.edge_mm.into(),
            ]
        })
    });
    Table::new("over_time", "Force over time", columns).with_rows(rows).rows_in_file("hob_force_over_time")
}
