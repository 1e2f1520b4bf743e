//! What a splined shaft in its hub has shown: findings, a table tooth by tooth, a chart, the page.

use super::{SplineFit, ToothInSpace};
use crate::findings::{Entry, Findings, Notice, Place, QuantityRow, RESULTS_FILE, Section, Table};
use crate::number_text::significant;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, REPORT_FILE};
use crate::output::table::write_tables;
use crate::pair_job::findings::PROCESS;
use crate::pair_job::notices::NoClearance;
use crate::pair_job::page::{PairRecord, ending};
use crate::pair_job::quantities::spline::{
    CLEARANCE, EFFECTIVE_CLEARANCE, EFFECTIVE_THICKNESS, EFFECTIVE_WIDTH, FIT, FORM_CLEARANCE_OF_HUB,
    FORM_CLEARANCE_OF_SHAFT, GAP_OF_LEFT, GAP_OF_RIGHT, HUB, HUB_VARIATION, LARGEST_CLEARANCE, MEAN_THICKNESS,
    MEAN_WIDTH, MODULE, PITCH_DIAMETER, PRESSURE_ANGLE, ROOT_CLEARANCE_OF_HUB, ROOT_CLEARANCE_OF_SHAFT, SHAFT,
    SHAFT_VARIATION, SMALLEST_CLEARANCE, SPACE, TEETH, THICKNESS, TIGHTEST, TOOTH_BY_TOOTH, TOOTH_CLEARANCE,
    TOOTH_OF_SHAFT, WIDTH,
};
use crate::scene::Scene;
use crate::steps::report::facts::gear_words;
use crate::steps::report::{page_of, quantities};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;

/// Ticks of the chart are so far apart at least, um.
const LEAST_UM: f64 = 0.1;
/// Numbers that are said first, with their titles there.
static HEADLINE: [(&QuantityRow, &str); 5] = [
    (&CLEARANCE, "hub turns on the shaft by"),
    (&EFFECTIVE_CLEARANCE, "effective clearance c_v"),
    (&TIGHTEST, "narrowest tooth in its space"),
    (&EFFECTIVE_THICKNESS, "effective tooth thickness S_v"),
    (&EFFECTIVE_WIDTH, "effective space width E_v"),
];

/// Everything that was found.
pub fn findings(name: &str, scenes: [&Scene; 2], fit: &SplineFit) -> Findings {
    let section = section(scenes, fit);
    let first = |(row, title): &(&QuantityRow, &str)| {
        Some(section.entry_of(row)?.clone().keyed(format!("{}_{}", FIT.key, row.key)).titled(*title))
    };
    let headline: Vec<Entry> = HEADLINE.iter().filter_map(first).collect();
    Findings::new(PROCESS, name, true, headline, interference(fit), vec![section])
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
    let [thickness_mm, width_mm] = fit.effective_mm;
    let [least_mm, most_mm] = fit.positions_mm;
    let tightest = fit.teeth.iter().min_by(|a, b| clearance_mm(a).total_cmp(&clearance_mm(b)));
    let tightest = tightest.copied().unwrap_or(fit.teeth[0]);
    let mean = |of: fn(&ToothInSpace) -> f64| fit.teeth.iter().map(of).sum::<f64>() / fit.teeth.len() as f64;
    let [mean_thickness_mm, mean_width_mm] = [mean(|at| at.thickness_mm), mean(|at| at.width_mm)];
    let gear = &scenes[0].gear;
    FIT.section([
        SHAFT.of(scenes[0].name.as_str()),
        HUB.of(scenes[1].name.as_str()),
        TEETH.of(gear.teeth),
        MODULE.of(gear.module_mm),
        PRESSURE_ANGLE.of(gear.pressure_angle_rad.to_degrees()),
        PITCH_DIAMETER.of(fit.pitch_diameter_mm),
        CLEARANCE.of(UM_PER_MM * fit.clearance_mm),
        SMALLEST_CLEARANCE.of(UM_PER_MM * least_mm),
        LARGEST_CLEARANCE.of(UM_PER_MM * most_mm),
        EFFECTIVE_CLEARANCE.of(UM_PER_MM * (width_mm - thickness_mm)),
        EFFECTIVE_THICKNESS.of(thickness_mm),
        EFFECTIVE_WIDTH.of(width_mm),
        MEAN_THICKNESS.of(mean_thickness_mm),
        MEAN_WIDTH.of(mean_width_mm),
        TIGHTEST.of(UM_PER_MM * clearance_mm(&tightest)).at(Place::default().and("tooth", tightest.tooth)),
        SHAFT_VARIATION.of(UM_PER_MM * (thickness_mm - mean_thickness_mm)),
        HUB_VARIATION.of(UM_PER_MM * (mean_width_mm - width_mm)),
        ROOT_CLEARANCE_OF_HUB.of(fit.root_clearance_mm[0]),
        ROOT_CLEARANCE_OF_SHAFT.of(fit.root_clearance_mm[1]),
        FORM_CLEARANCE_OF_HUB.of(fit.form_clearance_mm[0]),
        FORM_CLEARANCE_OF_SHAFT.of(fit.form_clearance_mm[1]),
    ])
    .table(table(fit))
}

fn table(fit: &SplineFit) -> Table {
    TOOTH_BY_TOOTH
        .table(&fit.teeth)
        .column(&TOOTH_OF_SHAFT, |at| at.tooth)
        .column(&SPACE, |at| at.space)
        .column(&THICKNESS, |at| at.thickness_mm)
        .column(&WIDTH, |at| at.width_mm)
        .column(&TOOTH_CLEARANCE, |at| UM_PER_MM * clearance_mm(at))
        .column(&GAP_OF_RIGHT, |at| UM_PER_MM * at.gaps_mm[0])
        .column(&GAP_OF_LEFT, |at| UM_PER_MM * at.gaps_mm[1])
        .in_file("spline_fit")
}

fn chart(fit: &SplineFit) -> BarChart {
    let series = |name: &str, of: fn(&ToothInSpace) -> f64| BarSeries {
        name: name.to_owned(),
        values: fit.teeth.iter().map(|at| Some(UM_PER_MM * of(at))).collect(),
    };
    BarChart {
        has_mean: true,
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
    let numbers = found.group(&FIT).map(|section| Block::Table(quantities::table(section)));
    let parts = scenes.iter().zip(["The shaft", "The hub"]);
    let page = Page {
        what: "fit of a spline",
        subtitle: "cut flanks, on one axis".to_owned(),
        operations: parts.map(|(scene, role)| format!("{role}: {}. {}", scene.name, gear_words(scene))).collect(),
        done: "all teeth in their spaces",
        sections: std::iter::once(PageSection::new(
            "fit",
            "Fit",
            "What the hub can turn on the shaft, and what every tooth and space lend to it. Gaps count along the \
                 pitch circle; the smallest of each side stop the hub.",
            [Some(Block::Bars(chart)), numbers].into_iter().flatten().collect(),
        ))
        .chain(ending(folder, &format!("cut by {}", record.backend), record)?)
        .collect(),
        ..page_of(found)
    };
    page.write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}
