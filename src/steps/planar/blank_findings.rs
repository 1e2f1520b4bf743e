//! The whole gear, from rays through the blank: volumes, damage, rubbing.

use super::PlanarGear;
use super::blank_report::BlankReport;
use crate::findings::damage::{self, damage_row, damage_table, gouge_from, pairs};
use crate::findings::notices::NoTarget;
use crate::findings::{Datum, Notice, Quantity, Section, Table, TableColumn};
use crate::measure::damage::{Damage, gouge_mm};
use crate::steps::whole_blank::{self, mean};
use gearcut_core::cut::CutBlank;
use gearcut_core::gear::GearKind;

/// Why there is no target.
const NO_TARGET: &str = "the target's outline is not known in closed form: the cutter's base shapes the tips";

/// The section.
pub fn findings(gear: &PlanarGear, cut: &CutBlank, report: &BlankReport) -> Section {
    let area = |value: Option<f64>, definition: &'static str| Quantity::number_or(value, "mm^2", definition, NO_TARGET);
    let end_face = report.end_face;
    let against_target = |key, title, places: &[Damage], what| {
        if end_face.is_some() { damage_of(key, title, places, what) } else { without_target(key, title, what) }
    };
    let rubbing =
        |stays: bool| -> Vec<Damage> { report.rubbing.iter().filter(|r| r.stays == stays).map(|r| r.damage).collect() };
    let slices = (
        cut.field.slices.len(),
        "transverse sections; one stands for the whole face where all are equal or lie near the middle one",
    );
    let volumes = [report.blank_mm3, report.left_mm3];
    whole_blank::findings(gear.blank.kind(), cut.field.grid.spacing_mm(), slices, volumes, &report.operations)
        .with(
            "end_face_area",
            Quantity::number(
                mean(report.left_mm3) / gear.scene.gear.face_width_mm,
                "mm^2",
                "transverse section that is left, mean over the face",
            ),
        )
        .with(
            "target_end_face_area",
            area(
                end_face.map(|e| e.target_mm2),
                match gear.blank.kind() {
                    GearKind::External => "area of the target's outline less the bore, from the meshing condition",
                    GearKind::Internal => "area of the ring outside the target's outline, from the meshing condition",
                },
            ),
        )
        .with(
            "end_face_area_bound",
            area(
                end_face.map(|e| e.bound_mm2[0].max(e.bound_mm2[1])),
                "how far the section may be off because of the rays' distance: half of it times the travel of the \
                 outline along the rays",
            ),
        )
        .with("gouge_from", gouge_from(gear.scene.gear.module_mm))
        .with(
            "ray_passes_visited",
            pairs(report.stats.visited, "pairs of ray and pass in which the ray crosses the cutter tooth"),
        )
        .with("ray_passes_removing", pairs(report.stats.removing, "those of them that removed material"))
        .table(all_damage(gear, report))
        .part(whole_blank::removed(gear.operations.iter().map(|operation| operation.name), &report.operations))
        .part(against_target(
            "gouges",
            "below the target, last operation",
            &report.gouges,
            "target material that the last operation took",
        ))
        .part(against_target(
            "interference",
            "below the target, earlier operations",
            &report.interference,
            "target material that an earlier operation took",
        ))
        .part(damage_of(
            "rubbing_on_gear",
            "return stroke on the gear",
            &rubbing(true),
            "material that the cutter enters on its way back, on surfaces that stay",
        ))
        .part(damage_of(
            "rubbing_on_stock",
            "return stroke on stock",
            &rubbing(false),
            "material that the cutter enters on its way back, on stock that a later stroke removes",
        ))
}

/// What a reader must know of damage; `flank_mm` is the deepest cut below the target on the rays of flanks.
pub fn warnings(gear: &PlanarGear, report: &BlankReport, flank_mm: f64) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let gouge_mm = gouge_mm(gear.scene.gear.module_mm);
    let name = |operation: usize| gear.operations[operation].name;
    let by = |d: &Damage| format!("stroke {} of operation {}, cutter tooth {}", d.stroke, name(d.operation), d.blade);
    if report.end_face.is_none() {
        warnings.push(NoTarget { why: NO_TARGET }.notice());
    }
    // The rays of flanks do not say which operation it was: the deeper damage of the blank is taken for theirs.
    let depth_mm = |places: &[Damage]| places.iter().map(|d| d.depth_mm).fold(0.0, f64::max);
    let interferes = depth_mm(&report.interference) > depth_mm(&report.gouges);
    for (places, is_deeper) in [(&report.gouges, !interferes), (&report.interference, interferes)] {
        warnings.extend(damage::warning(places, if is_deeper { flank_mm } else { 0.0 }, gouge_mm, by));
    }
    warnings
}

/// Every place of damage and rubbing.
fn all_damage(gear: &PlanarGear, report: &BlankReport) -> Table {
    let row = |kind: &str, d: &Damage| {
        let mut row = damage_row(kind, gear.operations[d.operation].name, d);
        row.extend([Datum::from(d.stroke as u64), d.blade.into()]);
        row
    };
    let gouge_mm = gouge_mm(gear.scene.gear.module_mm);
    let gouges = report.gouges.iter().map(|d| row(damage::kind(d, gouge_mm, "gouge"), d));
    let interference = report.interference.iter().map(|d| row(damage::kind(d, gouge_mm, "interference"), d));
    let rubbing =
        report.rubbing.iter().map(|r| row(if r.stays { "rubbing_on_gear" } else { "rubbing_on_stock" }, &r.damage));
    let pass = [
        TableColumn::new("stroke", "1", "stroke, from 0"),
        TableColumn::new("cutter_tooth", "1", "cutter tooth, from 0"),
    ];
    damage_table(pass, gouges.chain(interference).chain(rubbing))
}

/// Damage where there is no target.
fn without_target(key: &str, title: &str, what: &'static str) -> Section {
    let undefined = |unit: &'static str| Quantity::undefined(unit, what, NO_TARGET);
    Section::new(key, title)
        .shown("places", "sides of teeth", undefined("sides of teeth"))
        .shown("deepest", "deepest", undefined("mm"))
        .with("volume", undefined("mm^3"))
}

fn damage_of(key: &str, title: &str, places: &[Damage], what: &'static str) -> Section {
    damage::damage(key, title, places, what, |place, d| {
        place.and("stroke", d.stroke as u64).and("cutter_tooth", d.blade)
    })
}
