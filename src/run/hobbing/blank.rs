//! The blank field's part of a hobbing run: cut, report, results, table of damage, mesh.

use super::results::value;
use crate::cut::Backend;
use crate::error::Result;
use crate::job::{HobCutter, HobbedBlank};
use crate::measure::blank_report::{Damage, LEAST_DEPTH_MM, OperationVolume};
use crate::measure::hobbed_blank::{self, HobbedBlankReport};
use crate::output::colormap::ColourScale;
use crate::output::folder::OutputFolder;
use crate::output::interrupt::Interrupt;
use crate::output::mesh_file::MeshFile;
use crate::output::mesh_ply::write_ply;
use crate::output::progress::Progress;
use crate::output::quantity::Quantity;
use crate::output::table::{Cell, write_table};
use crate::run::blank::{damage_cells, damage_columns, pairs};
use crate::surface::BlankMesh;
use serde_json::{Value, json};

/// The cut blank and what it says.
#[derive(Debug)]
pub struct WholeBlank {
    /// Rays and chips.
    pub blank: HobbedBlank,
    /// Volumes, sections, damage.
    pub report: HobbedBlankReport,
}

/// Cuts the blank; nothing after Ctrl-C.
///
/// # Errors
/// A field that does not fit in memory; the backend's.
pub fn cut(
    cutter: &HobCutter,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<WholeBlank>> {
    let field = cutter.job.blank_field()?;
    let steps = (field.slices.len() * cutter.operations.len()) as u64;
    let step = progress.step("cut the whole blank", steps, "slices");
    let advance = || {
        step.advance(1);
        !interrupt.is_raised()
    };
    let Some(blank) = cutter.cut_blank(backend, field, &advance)? else { return Ok(None) };
    step.finish();
    let report = hobbed_blank::measure(cutter, &blank.cut);
    Ok(Some(WholeBlank { blank, report }))
}

/// Writes `tables/damage.csv` and `mesh/blank.ply`.
///
/// # Errors
/// Files that cannot be written.
pub fn write(cutter: &HobCutter, whole: &WholeBlank, folder: &OutputFolder) -> Result<()> {
    let row = |kind: &'static str, d: &Damage| -> Vec<Cell> {
        let mut cells = damage_cells(kind, &cutter.job.operations[d.operation].spec.name, d);
        cells.extend([(d.stroke as u32).into(), hob_tooth(cutter, d).as_str().into()]);
        cells
    };
    let gouges = whole.report.gouges.iter().map(|d| row("gouge", d));
    let rows: Vec<Vec<Cell>> = gouges.chain(whole.report.interference.iter().map(|d| row("interference", d))).collect();
    write_table(&folder.path("tables/damage.csv")?, &damage_columns(["hob_turn", "hob_tooth"]), rows)?;
    let passes = cutter.operations.last().map_or(0, crate::passes::HobTeeth::end_pass);
    let mesh = BlankMesh::new(&whole.blank.cut.field, None).mesh;
    let title = format!("gear of {}, from rays through the blank", cutter.job.scene.name);
    let colour = ("pass_id", ColourScale::Sequential { low: 0.0, high: passes as f32 });
    write_ply(&folder.path("mesh/blank.ply")?, &MeshFile { mesh: &mesh, title: &title, colour, notes: &[] })
}

fn hob_tooth(cutter: &HobCutter, damage: &Damage) -> String {
    let hob = &cutter.job.hob;
    hob.teeth[damage.blade as usize].label(hob.starts)
}

/// Its part of `results.json`.
///
/// # Errors
/// Quantities that cannot be written.
pub fn results(cutter: &HobCutter, whole: &WholeBlank) -> Result<Value> {
    let report = &whole.report;
    let grid = &whole.blank.cut.field.grid;
    let mean = |families: [f64; 2]| 0.5 * (families[0] + families[1]);
    let number = |of: f64, unit: &'static str, definition: &'static str| value(&Quantity::number(of, unit, definition));
    let imbalance = report.operations.iter().map(OperationVolume::imbalance).fold(0.0, f64::max);
    let operations = cutter
        .job
        .operations
        .iter()
        .zip(&report.operations)
        .map(|(operation, removed)| {
            let volume =
                number(mean(removed.by_passes_mm3), "mm3", "volume that its passes removed, summed pass by pass")?;
            Ok(json!({ "name": operation.spec.name, "removed_volume": volume }))
        })
        .collect::<Result<Vec<Value>>>()?;
    let section = &report.section;
    Ok(json!({
        "spacing": number(grid.spacing_mm(), "mm", "distance of the rays through the blank")?,
        "slices": value(&Quantity::count(grid.leads_mm.len() as u64, "slices", "transverse sections, both end faces among them"))?,
        "blank_volume": number(mean(report.blank_mm3), "mm3", "volume of the uncut blank less its bore; mean of both families of rays")?,
        "left_volume": number(mean(report.left_mm3), "mm3", "volume that is left after the last operation")?,
        "operations": operations,
        "imbalance": number(imbalance, "1", "largest difference of an operation between what its passes removed, summed pass by pass, and what is missing from the rays, relative to it")?,
        "section_area": number(mean(section.cut_mm2), "mm2", "transverse section that is left, mean over the face")?,
        "target_section_area": number(section.target_mm2, "mm2", "area of the target's section less the bore, from the rack's meshing condition, mean over the slices")?,
        "section_area_bound": number(section.bound_mm2[0].max(section.bound_mm2[1]), "mm2", "how far the section may be off because of the rays' distance: half of it times the way of the outline along the rays")?,
        "gouges": damage(cutter, &report.gouges, "target material that the last operation took")?,
        "interference": damage(cutter, &report.interference, "target material that an earlier operation took")?,
        "ray_passes_visited": value(&pairs(report.stats.visited, "pairs of ray and pass in which the ray crosses the sweep of the hob tooth"))?,
        "ray_passes_removing": value(&pairs(report.stats.removing, "those of them that removed material"))?,
    }))
}

fn damage(cutter: &HobCutter, places: &[Damage], what: &'static str) -> Result<Value> {
    let deepest = places.iter().max_by(|a, b| a.depth_mm.total_cmp(&b.depth_mm));
    let none = format!("there is none deeper than {LEAST_DEPTH_MM} mm");
    let place = deepest.map_or_else(
        || Quantity::undefined("", "where it is deepest", none.clone()),
        |d| {
            let text = format!(
                "tooth {} {}, {}, {:.3} mm over the pitch curve, {:.2} mm from the middle of the face, hob turn {}, hob tooth {}",
                d.place.tooth,
                d.place.side.name(),
                d.place.zone.name(),
                d.place.height_mm,
                d.lead_mm,
                d.stroke,
                hob_tooth(cutter, d)
            );
            Quantity::text(text, "where it is deepest")
        },
    );
    Ok(json!({
        "places": value(&Quantity::count(places.len() as u64, "sides of teeth", format!("{what}, deeper than {LEAST_DEPTH_MM} mm")))?,
        "deepest": value(&Quantity::number_or(deepest.map(|d| d.depth_mm), "mm", "largest depth along the normal", none.clone()))?,
        "place": value(&place)?,
        "volume": value(&Quantity::number(places.iter().map(|d| d.volume_mm3).fold(0.0, |sum, mm3| sum + mm3), "mm3", "volume, all places together"))?,
    }))
}
