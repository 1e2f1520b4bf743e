//! The whole gear and the chips of a slot: volumes, thickness, forces, by operation, blade and pass.

use crate::findings::quantities::blank::{BLANK_VOLUME, IMBALANCE, LEFT_VOLUME, OPERATION, SPACING};
use crate::findings::quantities::cutting::{
    FORCE_PER_AREA, FORCE_PER_LENGTH, IDLE, LARGEST_FORCE, NO_MATERIAL, REMOVED_VOLUME, THICKEST_CHIP,
};
use crate::findings::{Place, QuantityRow, Section, Table};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::bevel::blank::{CutCells, RIM_MODULES};
use crate::process::bevel::chips::{SlotLedger, SlotPass};
use crate::process::bevel::job::BevelJob;
use crate::process::bevel::quantities::{
    BLADE, BLADE_KIND, BLADE_WORK, BODY, CHIPS, LARGEST_EDGE, LARGEST_POWER, LARGEST_SECTION, LAW, MEAN_POWER,
    OVERHANG, PASS, PASS_ANGLE, PASS_DEPTH, PLUNGE, POINTED, REVOLUTION, RIM, ROWS, SLOT_NUMBER, SLOT_VOLUME, TAKEN,
    TAKING, THICKEST_ALONG,
};
use gearcut_core::bevel::face_mill::{BladeKind, FaceMill};
use gearcut_core::units::UM_PER_MM;

/// How the force of a blade is defined.
const LAW_OF_FORCE: &str = "K_c times the section of the chip in the rake face plus K_ce times the length of edge in \
    engagement; means over the blade's travel through a row of rays";
/// N mm in a joule.
const NMM_PER_J: f64 = 1e3;

/// How the moment of a pass is told.
struct MomentWords {
    row: &'static QuantityRow,
    /// Name and unit on charts.
    axis: [&'static str; 2],
    /// Name among places.
    place: &'static str,
    /// What the head does meanwhile.
    way: &'static str,
    scale: f64,
}

impl MomentWords {
    fn of(job: &BevelJob) -> Self {
        if job.finishing().settings.plunges() {
            let axis = ["place of the head before full depth", "mm"];
            Self { row: &PASS_DEPTH, axis, place: "depth_mm", way: "plunge", scale: 1.0 }
        } else {
            let axis = ["cradle angle", "°"];
            Self { row: &PASS_ANGLE, axis, place: "cradle_angle_deg", way: "roll", scale: 1_f64.to_degrees() }
        }
    }
}

/// The blank: rays, volumes.
pub(super) fn blank(job: &BevelJob, whole: &CutCells) -> Section {
    let grid = &whole.grid;
    let mut before_mm3 = whole.blank_mm3;
    let operations = job.operations.iter().zip(&whole.left_mm3).map(|(operation, &left_mm3)| {
        let removed_mm3 = before_mm3 - left_mm3;
        before_mm3 = left_mm3;
        let name = &operation.spec.name;
        Section::new(name, format!("Operation {name}")).entries([REMOVED_VOLUME.of(removed_mm3).shown()])
    });
    let operations: Vec<Section> = operations.collect();
    let spacing_mm = grid.strip_rad * job.blank.outer_cone_distance_mm * job.blank.pitch_angle_rad.sin();
    BODY.section([
        SPACING.of(spacing_mm),
        ROWS.of(grid.rows()),
        RIM.of(-grid.low_mm),
        BLANK_VOLUME.of(whole.blank_mm3),
        LEFT_VOLUME.of(whole.left_mm3.last().copied().unwrap_or(whole.blank_mm3)),
        POINTED.of(if whole.neighbours_reach { "yes" } else { "no" }),
    ])
    .part(Section::new("operations", "Removed by each operation").parts(operations))
}

/// What the passes of a slot took.
pub(super) fn chips(job: &BevelJob, ledger: &SlotLedger) -> Section {
    let by_passes_mm3: f64 = ledger.passes.iter().map(|pass| pass.volume_mm3).sum();
    let removed_mm3 = ledger.blank_mm3 - ledger.left_mm3;
    let law = job.spec.material.into_iter().flat_map(|material| {
        [
            LAW.of(LAW_OF_FORCE),
            FORCE_PER_AREA.of(material.per_area_n_per_mm2),
            FORCE_PER_LENGTH.of(material.per_length_n_per_mm),
        ]
    });
    let operations = (0..job.operations.len()).map(|operation| of_operation(job, ledger, operation));
    CHIPS
        .section([
            SLOT_NUMBER.of(ledger.slot),
            SLOT_VOLUME.of(removed_mm3),
            IMBALANCE.of((by_passes_mm3 - removed_mm3).abs() / removed_mm3.max(f64::MIN_POSITIVE)),
            OVERHANG.of(ledger.overhang_mm3),
        ])
        .entries(law)
        .part(Section::new("operations", "By operation").parts(operations))
        .table(by_blade(job, ledger))
        .table(by_pass(job, ledger))
}

/// Where the largest value of a pass is.
pub(super) fn place(job: &BevelJob, pass: &SlotPass) -> Place {
    let words = MomentWords::of(job);
    Place::default()
        .and("blade", u64::from(pass.blade))
        .and(words.place, words.scale * pass.moment)
        .and("v_mm", pass.along_mm)
}

fn of_operation(job: &BevelJob, ledger: &SlotLedger, operation: usize) -> Section {
    let of_operation = || ledger.passes.iter().filter(move |pass| pass.operation == operation);
    let plunge_mm3: f64 = of_operation().filter(|pass| pass.is_plunge()).map(|pass| pass.volume_mm3).sum();
    let passes: Vec<&SlotPass> = of_operation().filter(|pass| !pass.is_plunge()).collect();
    let largest = |row: &QuantityRow, value: &dyn Fn(&SlotPass) -> f64| {
        let found = passes.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
        found.map_or_else(|| row.none(IDLE), |pass| row.of(value(pass)).at(place(job, pass)))
    };
    let of = &job.operations[operation];
    let name = &of.spec.name;
    let section = Section::new(name, format!("Operation {name}")).entries([
        TAKEN.of(of_operation().map(|pass| pass.volume_mm3).sum::<f64>()),
        TAKING.of(passes.len()),
        largest(&THICKEST_CHIP, &|pass| pass.thickness_mm * UM_PER_MM).shown(),
        largest(&LARGEST_SECTION, &|pass| pass.section_mm2),
        largest(&LARGEST_EDGE, &|pass| pass.edge_mm),
    ]);
    let section = section.entries((!of.settings.plunges()).then(|| PLUNGE.of(plunge_mm3)));
    if job.spec.material.is_none() {
        return section.entries([LARGEST_FORCE.none(NO_MATERIAL)]);
    }
    let speed_mm_per_s = of.spec.head_speed_rad_per_s * job.head.radius_mm;
    let work_nmm: f64 = passes.iter().filter_map(|pass| pass.work_nmm).sum();
    let force = |pass: &SlotPass| pass.force_n.unwrap_or_default();
    section.entries([
        largest(&LARGEST_FORCE, &force).shown(),
        largest(&LARGEST_POWER, &|pass| force(pass) * speed_mm_per_s / NMM_PER_J),
        MEAN_POWER.of(work_nmm / of.course.slot_s() / NMM_PER_J),
    ])
}

/// Sums over the passes of a blade.
#[derive(Clone, Copy, Default)]
struct OfBlade {
    volume_mm3: f64,
    thickness_mm: f64,
    force_n: f64,
    work_nmm: f64,
}

fn of_blades(job: &BevelJob, ledger: &SlotLedger, operation: usize) -> Vec<OfBlade> {
    let mut blades = vec![OfBlade::default(); job.head.blades() as usize];
    for pass in ledger.passes.iter().filter(|pass| pass.operation == operation && !pass.is_plunge()) {
        let blade = &mut blades[pass.blade as usize];
        blade.volume_mm3 += pass.volume_mm3;
        blade.thickness_mm = blade.thickness_mm.max(pass.thickness_mm);
        blade.force_n = blade.force_n.max(pass.force_n.unwrap_or_default());
        blade.work_nmm += pass.work_nmm.unwrap_or_default();
    }
    blades
}

fn by_blade(job: &BevelJob, ledger: &SlotLedger) -> Table {
    let known = job.spec.material.is_some();
    let blades = job.operations.iter().enumerate().flat_map(|(index, operation)| {
        let blades = of_blades(job, ledger, index).into_iter().zip(0_u32..);
        blades.map(move |(of, blade)| (operation.spec.name.as_str(), blade, of))
    });
    Table::over("by_blade", "Chips by blade, but for the first revolution of the head", blades)
        .column(&OPERATION, |&(operation, ..)| operation)
        .column(&BLADE, |&(_, blade, _)| blade)
        .column(&BLADE_KIND, |&(_, blade, _)| FaceMill::kind_of(blade).name())
        .column(&TAKEN, |(.., of)| of.volume_mm3)
        .column(&THICKEST_CHIP, |(.., of)| of.thickness_mm * UM_PER_MM)
        .column(&LARGEST_FORCE, |(.., of)| known.then_some(of.force_n))
        .column(&BLADE_WORK, |(.., of)| known.then_some(of.work_nmm / NMM_PER_J))
        .in_file("chips_by_blade")
}

fn by_pass(job: &BevelJob, ledger: &SlotLedger) -> Table {
    let words = MomentWords::of(job);
    Table::over("by_pass", "Chips by pass", &ledger.passes)
        .column(&OPERATION, |pass| job.operations[pass.operation].spec.name.as_str())
        .column(&PASS, |pass| pass.pass)
        .column(&BLADE, |pass| pass.blade)
        .column(&REVOLUTION, |pass| pass.revolution)
        .column(words.row, |pass| words.scale * pass.moment)
        .column(&TAKEN, |pass| pass.volume_mm3)
        .column(&THICKEST_CHIP, |pass| pass.thickness_mm * UM_PER_MM)
        .column(&THICKEST_ALONG, |pass| pass.along_mm)
        .column(&LARGEST_SECTION, |pass| pass.section_mm2)
        .column(&LARGEST_EDGE, |pass| pass.edge_mm)
        .column(&LARGEST_FORCE, |pass| pass.force_n)
        .rows_in_file("chips_by_pass")
}

/// Charts of the chips, with the names of their files.
pub type ChipCharts = (Vec<(String, BarChart)>, Vec<(String, LineChart)>);

/// Volume by blade, and thickness and force over the roll or plunge of every operation, with the names of their files.
pub fn charts(job: &BevelJob, ledger: &SlotLedger) -> ChipCharts {
    let words = MomentWords::of(job);
    let (mut bars, mut lines) = (Vec::new(), Vec::new());
    for (index, operation) in job.operations.iter().enumerate() {
        let name = &operation.spec.name;
        let blades = of_blades(job, ledger, index);
        bars.push((
            format!("{name}_chips_by_blade"),
            BarChart {
                has_mean: true,
                least_division: 0.0,
                limits: Vec::new(),
                title: format!("{name}: volume of a slot by blade"),
                category_name: "blade; outside blades have even numbers".to_owned(),
                categories: (0..blades.len()).map(|blade| blade.to_string()).collect(),
                value_name: "volume taken from a slot".to_owned(),
                unit: "mm³".to_owned(),
                series: vec![BarSeries {
                    name: name.clone(),
                    values: blades.iter().map(|blade| Some(blade.volume_mm3)).collect(),
                }],
            },
        ));
        let series = |value: &dyn Fn(&SlotPass) -> f64| {
            BladeKind::BOTH.map(|kind| LineSeries {
                name: format!("{} blades", kind.name()),
                points: ledger
                    .passes
                    .iter()
                    .filter(|pass| pass.operation == index && FaceMill::kind_of(pass.blade) == kind)
                    .filter(|pass| !pass.is_plunge())
                    .map(|pass| (words.scale * pass.moment, value(pass)))
                    .collect(),
            })
        };
        let panel = |value_name: &str, unit: &str, value: &dyn Fn(&SlotPass) -> f64| Panel {
            value_name: value_name.to_owned(),
            unit: unit.to_owned(),
            series: series(value).into(),
            limits: Vec::new(),
            least_division: 0.0,
        };
        let mut panels = vec![
            panel("volume of a pass", "mm³", &|pass| pass.volume_mm3),
            panel("thickest chip of a pass", "µm", &|pass| pass.thickness_mm * UM_PER_MM),
        ];
        if job.spec.material.is_some() {
            panels.push(panel("largest force of a pass", "N", &|pass| pass.force_n.unwrap_or_default()));
        }
        lines.push((
            format!("{name}_chips_over_{}", words.way),
            LineChart {
                title: format!("{name}: chips of a slot over the {}", words.way),
                x_name: words.axis[0].to_owned(),
                x_unit: words.axis[1].to_owned(),
                panels,
            },
        ));
    }
    (bars, lines)
}

/// The rim and the plunge in words, for the page.
pub fn page_words(job: &BevelJob) -> String {
    let plunge = if job.finishing().settings.plunges() {
        "The head plunges from clear of the blank to full depth and stays there."
    } else {
        "The head is at full depth when a roll begins; its first revolution takes what a plunge would and is \
         left out of the charts."
    };
    format!("The body is the toothed ring: it ends {RIM_MODULES} outer module under the root cone. {plunge}")
}
