//! The whole gear, from rays through the blank: volumes, damage, rubbing, strokes.

use super::PlanarGear;
use super::blank_report::BlankReport;
use crate::cut::CutBlank;
use crate::findings::damage::pairs;
use crate::findings::{Quantity, Section};
use crate::measure::damage::{Damage, OperationVolume};

/// What is counted.
const STROKE_FAULTS: &str = "strokes that are missing, did not cut or were made twice, told from what each stroke \
                             removed; operations whose chips are smaller than ten cells of the grid are not judged";
/// Why there is no target.
const NO_TARGET: &str = "the target's outline is not known in closed form: the cutter's base shapes the tips";

/// The section.
pub fn findings(gear: &PlanarGear, cut: &CutBlank, report: &BlankReport) -> Section {
    let mean = |families: [f64; 2]| 0.5 * (families[0] + families[1]);
    let volume = |families: [f64; 2], definition: &'static str| Quantity::number(mean(families), "mm3", definition);
    let area = |value: Option<f64>, definition: &'static str| Quantity::number_or(value, "mm2", definition, NO_TARGET);
    let end_face = report.end_face;
    let against_target = |key, title, places: &[Damage], what| {
        if end_face.is_some() { damage(key, title, places, what) } else { unjudged(key, title, what) }
    };
    let imbalance = report.operations.iter().map(OperationVolume::imbalance).fold(0.0, f64::max);
    let rubbing =
        |stays: bool| -> Vec<Damage> { report.rubbing.iter().filter(|r| r.stays == stays).map(|r| r.damage).collect() };
    let faults = if report.strokes_judged.contains(&true) {
        Quantity::count(report.stroke_faults.len() as u64, "strokes", STROKE_FAULTS)
    } else {
        Quantity::undefined("strokes", STROKE_FAULTS, "no operation takes chips as large as ten cells of the grid")
    };
    let operations = gear.operations.iter().zip(&report.operations).map(|(operation, removed)| {
        let name = operation.name;
        let volume = volume(removed.by_passes_mm3, "volume that its passes removed, summed pass by pass");
        Section::new(name, format!("Operation {name}")).shown("removed_volume", "removed", volume)
    });
    let unjudged = "gouges and interference are not judged";
    Section::new("blank", "The whole gear")
        .with("spacing", Quantity::number(cut.field.grid.spacing_mm(), "mm", "distance of the rays through the blank"))
        .with(
            "slices",
            Quantity::count(
                cut.field.slices.len() as u64,
                "slices",
                "transverse sections; one stands for the whole face where all are equal",
            ),
        )
        .shown(
            "blank_volume",
            "blank",
            volume(report.blank_mm3, "volume of the uncut blank less its bore; mean of both families of rays"),
        )
        .shown("left_volume", "left", volume(report.left_mm3, "volume that is left after the last operation"))
        .with(
            "imbalance",
            Quantity::number(
                imbalance,
                "1",
                "largest difference of an operation between what its passes removed, summed pass by pass, and what is \
                 missing from the rays, relative to it",
            ),
        )
        .with(
            "end_face_area",
            Quantity::number(
                mean(report.left_mm3) / gear.scene.gear.face_width_mm,
                "mm2",
                "transverse section that is left, mean over the face",
            ),
        )
        .with(
            "target_end_face_area",
            area(
                end_face.map(|e| e.target_mm2),
                "area of the target's outline less the bore, from the meshing condition",
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
        .shown("stroke_faults", "faulty strokes", faults)
        .with(
            "ray_passes_visited",
            pairs(report.stats.visited, "pairs of ray and pass in which the ray crosses the cutter tooth"),
        )
        .with("ray_passes_removing", pairs(report.stats.removing, "those of them that removed material"))
        .part(Section::new("operations", "Removed by each operation").parts(operations))
        .part(against_target("gouges", "gouges", &report.gouges, "target material that the last operation took"))
        .part(against_target(
            "interference",
            "interference",
            &report.interference,
            "target material that an earlier operation took",
        ))
        .part(damage(
            "rubbing_on_gear",
            "return stroke on the gear",
            &rubbing(true),
            "material that the cutter enters on its way back, on surfaces that stay",
        ))
        .part(damage(
            "rubbing_on_stock",
            "return stroke on stock",
            &rubbing(false),
            "material that the cutter enters on its way back, on stock that a later stroke removes",
        ))
        .warning(end_face.is_none().then(|| format!("{unjudged}: {NO_TARGET}")))
}

/// Damage where there is no target.
fn unjudged(key: &str, title: &str, what: &'static str) -> Section {
    let undefined = |unit: &'static str| Quantity::undefined(unit, what, NO_TARGET);
    Section::new(key, title)
        .shown("places", "sides of teeth", undefined("sides of teeth"))
        .shown("deepest", "deepest", undefined("mm"))
        .with("volume", undefined("mm3"))
}

fn damage(key: &str, title: &str, places: &[Damage], what: &'static str) -> Section {
    crate::findings::damage::damage(key, title, places, what, |place, d| {
        place.and("stroke", d.stroke as u64).and("cutter_tooth", d.blade)
    })
}
