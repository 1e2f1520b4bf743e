//! The blank field's part of a run: cut, report, results, table.

use crate::cut::Backend;
use crate::cut::cpu::blank;
use crate::error::Result;
use crate::gear::generation::Side;
use crate::job::{CutBlank, Job};
use crate::measure::blank_report::{self, BlankReport, Damage, LEAST_DEPTH_MM};
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::output::quantity::Quantity;
use crate::output::results::{BlankOperationResults, BlankResults, DamageResults};
use crate::output::table::{Cell, write_table};

/// Distance of the target outline's points: chords of a fillet then miss about 60 nm, a fifteenth of the least depth that is reported.
const TARGET_SPACING_MM: f64 = 0.02;
/// What is counted.
const STROKE_FAULTS: &str = "strokes that are missing, did not cut or were made twice, told from what each stroke removed; operations whose chips are smaller than ten cells of the grid are not judged";
/// Why there is no target.
const NO_TARGET: &str = "the target's outline is not known in closed form: the cutter's base shapes the tips";

/// The cut blank and what it says; nothing after Ctrl-C.
///
/// # Errors
/// A field that does not fit in memory; the backend's.
pub(super) fn cut(
    job: &Job,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<(CutBlank, BlankReport)>> {
    let field = job.blank_field()?;
    let step = progress.step("cut the whole blank", blank::steps(&field) * job.operations.len() as u64, "tiles");
    let advance = || {
        step.advance(1);
        !interrupt.is_raised()
    };
    let Some(cut) = job.cut_blank(backend, field, &advance)? else { return Ok(None) };
    step.finish();
    let target = job.target_outline(TARGET_SPACING_MM).ok();
    let report = blank_report::measure(job, &cut, target.as_ref());
    Ok(Some((cut, report)))
}

/// Names, units and definitions.
pub(super) fn results(job: &Job, cut: &CutBlank, report: &BlankReport) -> BlankResults {
    let mean = |families: [f64; 2]| 0.5 * (families[0] + families[1]);
    let volume = |families: [f64; 2], definition: &'static str| Quantity::number(mean(families), "mm3", definition);
    let area = |value: Option<f64>, definition: &'static str| Quantity::number_or(value, "mm2", definition, NO_TARGET);
    let end_face = report.end_face;
    let against_target =
        |places: &[Damage], what| if end_face.is_some() { damage(places, what) } else { unjudged(what) };
    let imbalance = report.operations.iter().map(blank_report::OperationVolume::imbalance).fold(0.0, f64::max);
    let rubbing =
        |stays: bool| -> Vec<Damage> { report.rubbing.iter().filter(|r| r.stays == stays).map(|r| r.damage).collect() };
    BlankResults {
        spacing: Quantity::number(cut.field.grid.spacing_mm(), "mm", "distance of the rays through the blank"),
        slices: Quantity::count(
            cut.field.slices.len() as u64,
            "slices",
            "transverse sections; one stands for the whole face where all are equal",
        ),
        blank_volume: volume(
            report.blank_mm3,
            "volume of the uncut blank less its bore; mean of both families of rays",
        ),
        left_volume: volume(report.left_mm3, "volume that is left after the last operation"),
        operations: job
            .operations
            .iter()
            .zip(&report.operations)
            .map(|(operation, removed)| BlankOperationResults {
                name: operation.spec.name.clone(),
                removed_volume: volume(removed.by_passes_mm3, "volume that its passes removed, summed pass by pass"),
            })
            .collect(),
        imbalance: Quantity::number(
            imbalance,
            "1",
            "largest difference of an operation between what its passes removed, summed pass by pass, and what is missing from the rays, relative to it",
        ),
        end_face_area: Quantity::number(
            mean(report.left_mm3) / job.scene.gear.face_width_mm,
            "mm2",
            "transverse section that is left, mean over the face",
        ),
        target_end_face_area: area(
            end_face.map(|e| e.target_mm2),
            "area of the target's outline less the bore, from the meshing condition",
        ),
        end_face_area_bound: area(
            end_face.map(|e| e.bound_mm2[0].max(e.bound_mm2[1])),
            "how far the section may be off because of the rays' distance: half of it times the way of the outline along the rays",
        ),
        gouges: against_target(&report.gouges, "target material that the last operation took"),
        interference: against_target(&report.interference, "target material that an earlier operation took"),
        rubbing_on_gear: damage(
            &rubbing(true),
            "material that the cutter enters on its way back, on surfaces that stay",
        ),
        rubbing_on_stock: damage(
            &rubbing(false),
            "material that the cutter enters on its way back, on stock that a later stroke removes",
        ),
        stroke_faults: if report.strokes_judged.contains(&true) {
            Quantity::count(report.stroke_faults.len() as u64, "strokes", STROKE_FAULTS)
        } else {
            Quantity::undefined("strokes", STROKE_FAULTS, "no operation takes chips as large as ten cells of the grid")
        },
        ray_passes_visited: pairs(
            report.stats.visited,
            "pairs of ray and pass in which the ray crosses the cutter tooth",
        ),
        ray_passes_removing: pairs(report.stats.removing, "those of them that removed material"),
    }
}

/// Work that the native backend counts.
pub(super) fn pairs(count: u64, definition: &'static str) -> Quantity {
    if count > 0 {
        Quantity::count(count, "pairs", definition)
    } else {
        Quantity::undefined("pairs", definition, "the GPU does not count them")
    }
}

/// Damage where there is no target.
fn unjudged(what: &'static str) -> DamageResults {
    let undefined = |unit: &'static str| Quantity::undefined(unit, what, NO_TARGET);
    DamageResults {
        places: undefined("sides of teeth"),
        deepest: undefined("mm"),
        place: undefined(""),
        volume: undefined("mm3"),
    }
}

fn damage(places: &[Damage], what: &'static str) -> DamageResults {
    let deepest = places.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm));
    let none = format!("there is none deeper than {LEAST_DEPTH_MM} mm");
    DamageResults {
        places: Quantity::count(places.len() as u64, "sides of teeth", format!("{what}, deeper than {LEAST_DEPTH_MM} mm")),
        deepest: Quantity::number_or(deepest.map(|d| d.depth_mm), "mm", "largest depth along the normal", none.clone()),
        place: deepest.map_or_else(
            || Quantity::undefined("", "where it is deepest", none.clone()),
            |d| {
                let (tooth, side, zone) = (d.place.tooth, d.place.side.name(), d.place.zone.name());
                let (height, stroke) = (d.place.height_mm, d.stroke);
                let text = format!(
                    "tooth {tooth} {side}, {zone}, {height:.3} mm over the pitch curve, stroke {stroke}, cutter tooth {}",
                    d.blade
                );
                Quantity::text(text, "where it is deepest")
            },
        ),
        volume: Quantity::number(places.iter().map(|d| d.volume_mm3).sum(), "mm3", "volume, all places together"),
    }
}

/// `tables/damage.csv`: every place of damage, rubbing and every fault of a stroke.
///
/// # Errors
/// A table that cannot be written.
pub(super) fn write_table_of_damage(job: &Job, report: &BlankReport, folder: &OutputFolder) -> Result<()> {
    let row = |kind: &'static str, d: &Damage| -> Vec<Cell> {
        let mut cells = damage_cells(kind, &job.operations[d.operation].spec.name, d);
        cells.extend([(d.stroke as u32).into(), d.blade.into()]);
        cells
    };
    let gouges = report.gouges.iter().map(|d| row("gouge", d));
    let interference = report.interference.iter().map(|d| row("interference", d));
    let rubbing =
        report.rubbing.iter().map(|r| row(if r.stays { "rubbing_on_gear" } else { "rubbing_on_stock" }, &r.damage));
    let strokes = report.stroke_faults.iter().map(|f| {
        let none = || Cell::from(None::<f64>);
        let mut cells: Vec<Cell> = vec![
            f.fault.kind.name().into(),
            job.operations[f.operation].spec.name.as_str().into(),
            f.space.into(),
            Side::Left.name().into(),
            "space behind the tooth".into(),
        ];
        cells.extend((0..6).map(|_| none()));
        cells.push((f.fault.stroke as u32).into());
        cells.push(none());
        cells
    });
    let rows: Vec<Vec<Cell>> = gouges.chain(interference).chain(rubbing).chain(strokes).collect();
    write_table(&folder.path("tables/damage.csv")?, &damage_columns(["stroke", "cutter_tooth"]), rows)
}

/// Columns of a table of damage; `pass` names what did it, which differs between processes.
pub(super) fn damage_columns(pass: [&'static str; 2]) -> Vec<&'static str> {
    let common = [
        "kind",
        "operation",
        "tooth",
        "side",
        "zone",
        "height_mm",
        "lead_mm",
        "x_mm",
        "y_mm",
        "depth_mm",
        "volume_mm3",
    ];
    common.into_iter().chain(pass).collect()
}

/// Its cells but for the pass.
pub(super) fn damage_cells(kind: &'static str, operation: &str, damage: &Damage) -> Vec<Cell> {
    vec![
        kind.into(),
        operation.into(),
        damage.place.tooth.into(),
        damage.place.side.name().into(),
        damage.place.zone.name().into(),
        damage.place.height_mm.into(),
        damage.lead_mm.into(),
        damage.point_mm.x.into(),
        damage.point_mm.y.into(),
        damage.depth_mm.into(),
        damage.volume_mm3.into(),
    ]
}
