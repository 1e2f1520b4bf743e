//! The whole gear, from rays through the blank: volumes, damage, rubbing.

use super::PlanarGear;
use super::blank_report::BlankReport;
use crate::findings::damage::{self, DamagePlace, damage_table, pairs};
use crate::findings::notices::NoTarget;
use crate::findings::quantities::blank::{
    AREA_BOUND, CUTTER_TOOTH, GOUGE_FROM, NO_TARGET, SECTION_AREA, STROKE, TARGET_AREA,
};
use crate::findings::{Notice, Section, Table};
use crate::measure::damage::{Damage, gouge_mm};
use crate::steps::whole_blank::{self, mean};
use gearcut_core::cut::CutBlank;

/// The section.
pub fn findings(gear: &PlanarGear, cut: &CutBlank, report: &BlankReport) -> Section {
    let end_face = report.end_face;
    let against_target = |key, title, places: &[Damage]| {
        if end_face.is_some() { damage_of(key, title, places) } else { damage::without_target(key, title) }
    };
    let rubbing =
        |stays: bool| -> Vec<Damage> { report.rubbing.iter().filter(|r| r.stays == stays).map(|r| r.damage).collect() };
    let volumes = [report.blank_mm3, report.left_mm3];
    let names = gear.operations.iter().map(|operation| operation.name);
    whole_blank::findings(cut.field.grid.spacing_mm(), cut.field.slices.len(), volumes, &report.operations)
        .entries([
            SECTION_AREA.of(mean(report.left_mm3) / gear.scene.gear.face_width_mm),
            TARGET_AREA.of_or(end_face.map(|e| e.target_mm2), NO_TARGET),
            AREA_BOUND.of_or(end_face.map(|e| e.bound_mm2[0].max(e.bound_mm2[1])), NO_TARGET),
            GOUGE_FROM.of(gouge_mm(gear.scene.gear.module_mm)),
        ])
        .entries(pairs([report.stats.visited, report.stats.removing]))
        .table(all_damage(gear, report))
        .part(whole_blank::removed(names, &report.operations))
        .part(against_target("gouges", "target material that the last operation took", &report.gouges))
        .part(against_target("interference", "target material that an earlier operation took", &report.interference))
        .part(damage_of("rubbing_on_gear", "return stroke on surfaces that stay", &rubbing(true)))
        .part(damage_of("rubbing_on_stock", "return stroke on stock that a later stroke removes", &rubbing(false)))
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
    let place = |kind, damage: &Damage| DamagePlace {
        kind,
        operation: gear.operations[damage.operation].name,
        damage: *damage,
    };
    let gouge_mm = gouge_mm(gear.scene.gear.module_mm);
    let gouges = report.gouges.iter().map(|d| place(damage::kind(d, gouge_mm, "gouge"), d));
    let interference = report.interference.iter().map(|d| place(damage::kind(d, gouge_mm, "interference"), d));
    let rubbing =
        report.rubbing.iter().map(|r| place(if r.stays { "rubbing_on_gear" } else { "rubbing_on_stock" }, &r.damage));
    damage_table(gouges.chain(interference).chain(rubbing))
        .column(&STROKE, |of| of.damage.stroke)
        .column(&CUTTER_TOOTH, |of| of.damage.blade)
        .in_file("damage")
}

fn damage_of(key: &str, title: &str, places: &[Damage]) -> Section {
    damage::damage(key, title, places, |place, d| place.and("stroke", d.stroke as u64).and("cutter_tooth", d.blade))
}
