//! The whole gear and the chips of a slot: volumes, thickness, forces, by operation, blade and pass.

use crate::findings::{Datum, Place, Quantity, Section, Table, TableColumn};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::process::bevel::blank::{CutCells, RIM_MODULES};
use crate::process::bevel::chips::{SlotLedger, SlotPass};
use crate::process::bevel::job::BevelJob;
use gearcut_core::bevel::face_mill::{BladeKind, FaceMill};
use gearcut_core::units::UM_PER_MM;

/// How the force of a blade is defined.
const LAW: &str = "K_c times the section of the chip in the rake face plus K_ce times the length of edge in \
    engagement; means over the blade's travel through a row of rays";
const NOTHING: &str = "the operation takes nothing";
const NO_MATERIAL: &str = "the scene names no material: write [material]";
/// N mm in a joule.
const NMM_PER_J: f64 = 1e3;

/// The blank: rays, volumes.
pub(super) fn blank(job: &BevelJob, whole: &CutCells) -> Section {
    let grid = &whole.grid;
    let number = |value: f64, unit: &'static str, definition: &'static str| Quantity::number(value, unit, definition);
    let mut before_mm3 = whole.blank_mm3;
    let operations = job.operations.iter().zip(&whole.left_mm3).map(|(operation, &left_mm3)| {
        let removed_mm3 = before_mm3 - left_mm3;
        before_mm3 = left_mm3;
        let name = &operation.spec.name;
        let definition = "volume of the ring that it took from all slots, as missing from the rays";
        Section::new(name, format!("Operation {name}")).shown(
            "removed_volume",
            "removed",
            number(removed_mm3, "mm^3", definition),
        )
    });
    let operations: Vec<Section> = operations.collect();
    Section::new("blank", "The whole gear")
        .with(
            "spacing",
            number(
                grid.strip_rad * job.blank.outer_cone_distance_mm * job.blank.pitch_angle_rad.sin(),
                "mm",
                "distance of the rays round the axis, on the pitch circle of the heel",
            ),
        )
        .with("rows", Quantity::count(grid.rows() as u64, "rows", "cone distances at which rays stand"))
        .with(
            "rim",
            number(
                -grid.low_mm,
                "mm",
                "how thick the ring is under the root cone: an outer module, as the scene does not say what is below",
            ),
        )
        .shown(
            "blank_volume",
            "blank",
            number(
                whole.blank_mm3,
                "mm^3",
                "volume of the uncut ring, from the face cone to the rim's thickness under the root cone",
            ),
        )
        .shown(
            "left_volume",
            "left",
            number(
                whole.left_mm3.last().copied().unwrap_or(whole.blank_mm3),
                "mm^3",
                "volume of the ring that is left after the last operation",
            ),
        )
        .with(
            "pointed",
            Quantity::text(
                if whole.neighbours_reach { "yes" } else { "no" },
                "whether neighbouring slots meet in the tips of the teeth",
            ),
        )
        .part(Section::new("operations", "Removed by each operation").parts(operations))
}

/// What the passes of a slot took.
pub(super) fn chips(job: &BevelJob, ledger: &SlotLedger) -> Section {
    let number = |value: f64, unit: &'static str, definition: &'static str| Quantity::number(value, unit, definition);
    let by_passes_mm3: f64 = ledger.passes.iter().map(|pass| pass.volume_mm3).sum();
    let removed_mm3 = ledger.blank_mm3 - ledger.left_mm3;
    let mut section = Section::new("chips", "Chips of a slot")
        .with("slot", Quantity::count(u64::from(ledger.slot), "1", "number of the slot, from 0; it follows that tooth"))
        .shown(
            "slot_volume",
            "a slot",
            number(removed_mm3, "mm^3", "volume taken from a slot, as missing from its rays"),
        )
        .with(
            "imbalance",
            number(
                (by_passes_mm3 - removed_mm3).abs() / removed_mm3.max(f64::MIN_POSITIVE),
                "1",
                "difference of what its passes took, pass by pass, from what is missing, relative to it",
            ),
        )
        .with(
            "overhang",
            number(
                ledger.overhang_mm3,
                "mm^3",
                "material of the slot that hangs over the lowest cut on its ray, as on undercut teeth; the whole gear \
                is shown without it",
            ),
        );
    if let Some(material) = job.spec.material {
        section = section
            .with("law", Quantity::text(LAW, "how the cutting force of a blade is defined"))
            .with(
                "force_per_area",
                number(material.per_area_n_per_mm2, "N/mm^2", "K_c: cutting force per area of chip"),
            )
            .with(
                "force_per_length",
                number(
                    material.per_length_n_per_mm,
                    "N/mm",
                    "K_ce: cutting force per length of edge that a chip of no thickness would need",
                ),
            );
    }
    let operations = (0..job.operations.len()).map(|operation| of_operation(job, ledger, operation));
    section
        .part(Section::new("operations", "By operation").parts(operations))
        .table(by_blade(job, ledger))
        .table(by_pass(job, ledger))
}

fn of_operation(job: &BevelJob, ledger: &SlotLedger, operation: usize) -> Section {
    let of_operation = || ledger.passes.iter().filter(move |pass| pass.operation == operation);
    let plunge_mm3 = of_operation().filter(|pass| pass.is_plunge()).map(|pass| pass.volume_mm3).sum();
    let passes: Vec<&SlotPass> = of_operation().filter(|pass| !pass.is_plunge()).collect();
    let place = |pass: &SlotPass| {
        Place::default()
            .and("blade", u64::from(pass.blade))
            .and("cradle_angle_deg", pass.cradle_rad.to_degrees())
            .and("v_mm", pass.along_mm)
    };
    let largest = |unit: &'static str, definition: &'static str, value: &dyn Fn(&SlotPass) -> f64| {
        let found = passes.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
        found.map_or_else(
            || Quantity::undefined(unit, definition, NOTHING),
            |pass| Quantity::number(value(pass), unit, definition).at(place(pass)),
        )
    };
    let of = &job.operations[operation];
    let name = &of.spec.name;
    let section = Section::new(name, format!("Operation {name}"))
        .with(
            "volume",
            Quantity::number(of_operation().map(|pass| pass.volume_mm3).sum(), "mm^3", "volume that its passes took"),
        )
        .with(
            "plunge_volume",
            Quantity::number(
                plunge_mm3,
                "mm^3",
                "part of it that the first revolution of the head takes, at full depth from the beginning of the roll: \
                 what the plunge would take, which is not modelled; thickness, forces and power leave it out",
            ),
        )
        .with("passes", Quantity::count(passes.len() as u64, "passes", "passes that took anything"))
        .shown(
            "largest_thickness",
            "thickest chip",
            largest("um", "largest uncut chip thickness, square to the surface that the blade leaves", &|pass| {
                pass.thickness_mm * UM_PER_MM
            }),
        )
        .with(
            "largest_section",
            largest("mm^2", "largest section of a chip in the rake face", &|pass| pass.section_mm2),
        )
        .with(
            "largest_engaged_edge",
            largest("mm", "largest length of edge that takes material at once", &|pass| pass.edge_mm),
        );
    if job.spec.material.is_none() {
        return section
            .with("largest_force", Quantity::undefined("N", "largest cutting force of a blade", NO_MATERIAL));
    }
    let speed_mm_per_s = of.spec.head_speed_rad_per_s * job.head.radius_mm;
    let work_nmm: f64 = passes.iter().filter_map(|pass| pass.work_nmm).sum();
    let force = |pass: &SlotPass| pass.force_n.unwrap_or_default();
    section
        .shown("largest_force", "largest force of a blade", largest("N", "largest cutting force of a blade", &force))
        .with(
            "largest_power",
            largest("W", "largest cutting force of a blade times the speed of its tip", &|pass| {
                force(pass) * speed_mm_per_s / NMM_PER_J
            }),
        )
        .shown(
            "mean_power",
            "mean power while a slot is rolled",
            Quantity::number(work_nmm / of.roll_s() / NMM_PER_J, "W", "work of all blades over the time of the roll"),
        )
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
    let columns = vec![
        TableColumn::words("operation", "operation"),
        TableColumn::new("blade", "1", "number of the blade, from 0"),
        TableColumn::words("kind", "outside or inside"),
        TableColumn::new(
            "volume",
            "mm^3",
            "volume that it took from the slot, but for the first revolution of the head",
        ),
        TableColumn::new("thickness", "um", "its thickest chip after that"),
        TableColumn::new("force", "N", "its largest cutting force").or(NO_MATERIAL),
        TableColumn::new("work", "J", "its work").or(NO_MATERIAL),
    ];
    let known = job.spec.material.is_some();
    let rows = job.operations.iter().enumerate().flat_map(|(index, operation)| {
        let name = operation.spec.name.as_str();
        of_blades(job, ledger, index).into_iter().zip(0_u32..).map(move |(of, blade)| {
            vec![
                Datum::from(name),
                blade.into(),
                FaceMill::kind_of(blade).name().into(),
                of.volume_mm3.into(),
                (of.thickness_mm * UM_PER_MM).into(),
                known.then_some(of.force_n).into(),
                known.then_some(of.work_nmm / NMM_PER_J).into(),
            ]
        })
    });
    Table::new("by_blade", "Chips by blade", columns).with_rows(rows).in_file("chips_by_blade")
}

fn by_pass(job: &BevelJob, ledger: &SlotLedger) -> Table {
    let columns = vec![
        TableColumn::words("operation", "operation"),
        TableColumn::new("pass", "1", "number of the pass"),
        TableColumn::new("blade", "1", "number of the blade, from 0"),
        TableColumn::new("revolution", "1", "revolution of the head in the roll; 0 takes what the plunge would take"),
        TableColumn::new("cradle_angle", "deg", "cradle angle while the blade is in the middle of the slot"),
        TableColumn::new("volume", "mm^3", "volume that it took"),
        TableColumn::new("thickness", "um", "its thickest chip"),
        TableColumn::new("along", "mm", "where that is along the tooth, from the middle of the face to the heel"),
        TableColumn::new("section", "mm^2", "largest section of its chip in the rake face"),
        TableColumn::new("engaged_edge", "mm", "largest length of its edge that takes material at once"),
        TableColumn::new("force", "N", "its largest cutting force").or(NO_MATERIAL),
    ];
    let rows = ledger.passes.iter().map(|pass| {
        vec![
            Datum::from(job.operations[pass.operation].spec.name.as_str()),
            pass.pass.into(),
            pass.blade.into(),
            pass.revolution.into(),
            pass.cradle_rad.to_degrees().into(),
            pass.volume_mm3.into(),
            (pass.thickness_mm * UM_PER_MM).into(),
            pass.along_mm.into(),
            pass.section_mm2.into(),
            pass.edge_mm.into(),
            pass.force_n.into(),
        ]
    });
    Table::new("by_pass", "Chips by pass", columns).with_rows(rows).rows_in_file("chips_by_pass")
}

/// Charts of the chips, with the names of their files.
pub type ChipCharts = (Vec<(String, BarChart)>, Vec<(String, LineChart)>);

/// Volume by blade, and thickness and force over the roll of every operation, with the names of their files.
pub fn charts(job: &BevelJob, ledger: &SlotLedger) -> ChipCharts {
    let (mut bars, mut lines) = (Vec::new(), Vec::new());
    for (index, operation) in job.operations.iter().enumerate() {
        let name = &operation.spec.name;
        let blades = of_blades(job, ledger, index);
        bars.push((
            format!("{name}_chips_by_blade"),
            BarChart {
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
                    .map(|pass| (pass.cradle_rad.to_degrees(), value(pass)))
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
            format!("{name}_chips_over_roll"),
            LineChart {
                title: format!("{name}: chips of a slot over the roll"),
                x_name: "cradle angle".to_owned(),
                x_unit: "°".to_owned(),
                panels,
            },
        ));
    }
    (bars, lines)
}

/// The rim and the plunge in words, for the page.
pub fn page_words() -> String {
    format!(
        "The body is the toothed ring: it ends {RIM_MODULES} outer module under the root cone. The head stands at full \
         depth when a roll begins; what its first revolution takes stands for the plunge and is left out of the charts."
    )
}
