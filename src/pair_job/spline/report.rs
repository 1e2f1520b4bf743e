//! What a splined shaft in its hub has shown: findings, a table tooth by tooth, a chart, the page.

use super::{SplineFit, ToothInSpace};
use crate::findings::{Datum, Entry, Findings, Notice, Place, Quantity, RESULTS_FILE, Section, Table, TableColumn};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, REPORT_FILE};
use crate::output::table::write_tables;
use crate::output::text::significant;
use crate::pair_job::findings::PROCESS;
use crate::pair_job::notices::NoClearance;
use crate::pair_job::page::{PairRecord, ending};
use crate::scene::Scene;
use crate::steps::report::facts::gear_words;
use crate::steps::report::quantities;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// Ticks of the chart are so far apart at least, um.
const LEAST_UM: f64 = 0.1;
/// Numbers that are said first.
const HEADLINE: [(&str, &str); 5] = [
    ("clearance", "hub turns on the shaft by"),
    ("effective_clearance", "effective clearance c_v"),
    ("smallest_clearance_of_a_tooth", "narrowest tooth in its space"),
    ("effective_tooth_thickness", "effective tooth thickness S_v"),
    ("effective_space_width", "effective space width E_v"),
];

/// Everything that was found.
pub fn findings(name: &str, scenes: [&Scene; 2], fit: &SplineFit) -> Findings {
    let sections = vec![section(scenes, fit)];
    let mut found = Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: PROCESS.to_owned(),
        scene: name.to_owned(),
        complete: true,
        headline: Vec::new(),
        warnings: interference(fit).into_iter().collect(),
        sections,
    };
    let entry = |(key, title): (&str, &str)| {
        let quantity = found.find("fit")?.quantity(key)?.clone();
        Some(Entry::headline(&format!("fit_{key}"), title, quantity))
    };
    found.headline = HEADLINE.into_iter().filter_map(entry).collect();
    found
}

/// Why the parts do not go together.
fn interference(fit: &SplineFit) -> Option<Notice> {
    let missing_um = -UM_PER_MM * fit.clearance_mm;
    (missing_um > 0.0).then(|| {
        let tightest = fit.teeth.iter().min_by(|a, b| clearance_mm(a).total_cmp(&clearance_mm(b)));
        let where_it_is = tightest.map_or_else(String::new, |at| {
            format!(
                "; tooth {} in space {} has {} um",
                at.tooth,
                at.space,
                significant(UM_PER_MM * clearance_mm(at), 3)
            )
        });
        NoClearance { missing_um: significant(missing_um, 3), place: where_it_is }.notice()
    })
}

fn clearance_mm(tooth: &ToothInSpace) -> f64 {
    tooth.width_mm - tooth.thickness_mm
}

fn section(scenes: [&Scene; 2], fit: &SplineFit) -> Section {
    let um = |mm: f64, definition: &'static str| Quantity::number(UM_PER_MM * mm, "um", definition);
    let mm = |mm: f64, definition: &'static str| Quantity::number(mm, "mm", definition);
    let [thickness_mm, width_mm] = fit.effective_mm;
    let [least_mm, most_mm] = fit.positions_mm;
    let tightest = fit.teeth.iter().min_by(|a, b| clearance_mm(a).total_cmp(&clearance_mm(b)));
    let tightest = tightest.copied().unwrap_or(fit.teeth[0]);
    let place = Place::default().and("tooth", tightest.tooth);
    let mean = |of: fn(&ToothInSpace) -> f64| fit.teeth.iter().map(of).sum::<f64>() / fit.teeth.len() as f64;
    let gear = &scenes[0].gear;
    Section::new("fit", "Splined shaft in its hub")
        .with("shaft", Quantity::text(scenes[0].name.clone(), "the part with teeth outside"))
        .with("hub", Quantity::text(scenes[1].name.clone(), "the part with teeth inside"))
        .with("teeth", Quantity::count(gear.teeth.into(), "teeth", "teeth of either part"))
        .with("module", mm(gear.module_mm, "module"))
        .with("pressure_angle", Quantity::number(gear.pressure_angle_rad.to_degrees(), "deg", "pressure angle"))
        .shown("pitch_diameter", "pitch diameter", mm(fit.pitch_diameter_mm, "m z, on which widths are measured"))
        .with(
            "clearance",
            um(
                fit.clearance_mm,
                "what the hub can turn on the shaft along the pitch circle in this position; below 0 the shaft does \
                 not go in",
            ),
        )
        .shown(
            "smallest_clearance",
            "in the worst position",
            um(least_mm, "the smallest over all positions of the hub"),
        )
        .shown("largest_clearance", "in the best position", um(most_mm, "the largest over all positions of the hub"))
        .with(
            "effective_clearance",
            um(width_mm - thickness_mm, "E_v - S_v, what is left of it in the worst position at least (ISO 4156-1)"),
        )
        .with(
            "effective_tooth_thickness",
            mm(thickness_mm, "S_v: width of the spaces of the perfect hub that the shaft just fits"),
        )
        .with(
            "effective_space_width",
            mm(width_mm, "E_v: thickness of the teeth of the perfect shaft that just fits the hub"),
        )
        .shown("tooth_thickness", "mean tooth thickness S", mm(mean(|at| at.thickness_mm), "mean of all teeth"))
        .shown("space_width", "mean space width E", mm(mean(|at| at.width_mm), "mean of all spaces"))
        .with(
            "smallest_clearance_of_a_tooth",
            um(clearance_mm(&tightest), "smallest E - S of a tooth in its space in this position").at(place),
        )
        .shown(
            "shaft_variation",
            "effective variation of the shaft",
            um(thickness_mm - mean(|at| at.thickness_mm), "S_v less mean S: pitch, form and waves of the shaft"),
        )
        .shown(
            "hub_variation",
            "effective variation of the hub",
            um(mean(|at| at.width_mm) - width_mm, "mean E less E_v: pitch, form and waves of the hub"),
        )
        .shown("root_clearance_of_hub", "shaft's tips to hub's roots", mm(fit.root_clearance_mm[0], "radial clearance"))
        .shown(
            "root_clearance_of_shaft",
            "hub's tips to shaft's roots",
            mm(fit.root_clearance_mm[1], "radial clearance"),
        )
        .shown(
            "form_clearance_of_hub",
            "shaft's tips to hub's form circle",
            mm(fit.form_clearance_mm[0], "radial; below 0 a tip is as high as a fillet"),
        )
        .shown(
            "form_clearance_of_shaft",
            "hub's tips to shaft's form circle",
            mm(fit.form_clearance_mm[1], "radial; below 0 a tip is as low as a fillet"),
        )
        .table(table(fit))
}

fn table(fit: &SplineFit) -> Table {
    let columns = vec![
        TableColumn::new("tooth", "1", "tooth of the shaft"),
        TableColumn::new("space", "1", "space of the hub: behind the tooth of this number"),
        TableColumn::new("tooth_thickness", "mm", "S on the pitch circle"),
        TableColumn::new("space_width", "mm", "E on the pitch circle"),
        TableColumn::new("clearance", "um", "E - S"),
        TableColumn::new("gap_right", "um", "gap of the right flank with the hub midway between its stops"),
        TableColumn::new("gap_left", "um", "gap of the left flank with the hub midway between its stops"),
    ];
    let row = |at: &ToothInSpace| -> Vec<Datum> {
        let [right_mm, left_mm] = at.gaps_mm;
        let um = [clearance_mm(at), right_mm, left_mm].map(|mm| Datum::from(UM_PER_MM * mm));
        let counts = [at.tooth, at.space].map(|number| Datum::from(u64::from(number)));
        [counts.to_vec(), vec![at.thickness_mm.into(), at.width_mm.into()], um.to_vec()].concat()
    };
    Table::new("tooth_by_tooth", "Every tooth in its space", columns)
        .with_rows(fit.teeth.iter().map(row))
        .in_file("spline_fit")
}

fn chart(fit: &SplineFit) -> BarChart {
    let series = |name: &str, of: fn(&ToothInSpace) -> f64| BarSeries {
        name: name.to_owned(),
        values: fit.teeth.iter().map(|at| Some(UM_PER_MM * of(at))).collect(),
    };
    BarChart {
        title: "Gaps of every tooth in its space, the hub midway between its stops".to_owned(),
        category_name: "tooth of the shaft".to_owned(),
        categories: fit.teeth.iter().map(|at| at.tooth.to_string()).collect(),
        value_name: "gap along the pitch circle".to_owned(),
        unit: "µm".to_owned(),
        least_division: LEAST_UM,
        limits: Vec::new(),
        series: vec![series("right flank", |at| at.gaps_mm[0]), series("left flank", |at| at.gaps_mm[1])],
    }
}

/// Writes results, table, chart and page.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    scenes: [&Scene; 2],
    fit: &SplineFit,
    found: &Findings,
    folder: &OutputFolder,
    record: &PairRecord,
) -> Result<()> {
    write_tables(found, folder)?;
    let chart = chart(fit);
    chart.write_svg(&folder.path("pictures/spline_fit.svg")?)?;
    let numbers = found.find("fit").map(|section| Block::Table(quantities::table(section)));
    let parts = scenes.iter().zip(["The shaft", "The hub"]);
    let page = Page {
        what: "fit of a spline",
        title: found.scene.clone(),
        subtitle: "cut flanks, on one axis".to_owned(),
        operations: parts.map(|(scene, role)| format!("{role}: {}. {}", scene.name, gear_words(&scene.gear))).collect(),
        complete: true,
        done: "all teeth in their spaces",
        program: format!("gearcut {}", found.program_version),
        key_numbers: found.headline.iter().map(quantities::key_number).collect(),
        warnings: found.warnings.iter().map(Notice::with_signs).collect(),
        viewer: None,
        sections: std::iter::once(PageSection::new(
            "fit",
            "Fit",
            "What the hub can turn on the shaft, and what every tooth and space lend to it. Gaps count along the \
                 pitch circle; the smallest of each side stop the hub.",
            [Some(Block::Bars(chart)), numbers].into_iter().flatten().collect(),
        ))
        .chain(ending(folder, &format!("cut by {}", record.backend), record)?)
        .collect(),
    };
    page.write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}
