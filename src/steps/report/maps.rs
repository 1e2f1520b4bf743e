//! The gear and its maps for the page's viewer.

use crate::job::GearJob;
use crate::number_text::significant;
use crate::output::flank_maps::FlankMaps;
use crate::output::grid::MapGrid;
use crate::output::report::viewer::{Thinning, Viewer, ViewerFlank, ViewerQuantity};
use crate::steps::gear_maps::{GearMaps, finished_heights_um, um};
use crate::steps::operation_names;
use crate::steps::report::averaged::averaged;
use crate::steps::view_mesh::{ViewFlank, ViewMesh};

/// What the view shows in grey.
const GREY: &str = "Grey: no value, because no pass came there; roots, tips and end faces have none.";

/// How far the colours reach.
const COLOURS: &str = "Colours span what is evaluated; beyond it they stay at their ends.";

/// Mesh of the target, and on it: stock of every earlier operation, deviation and height of the finished surface.
pub fn viewer(job: &dyn GearJob, mesh: ViewMesh, maps: &GearMaps) -> Viewer {
    let flanks = mesh.flanks.into_iter().map(|flank| {
        let map = maps.flanks.iter().find(|map| map.tooth == flank.tooth && map.side == flank.side);
        viewer_flank(flank, map.map(|map| map.grid.clone()))
    });
    Viewer { flanks: flanks.collect(), quantities: quantities(job, maps), body: mesh.body, mate: None, strokes: None }
}

/// A flank of the mesh with the grid of its map.
pub fn viewer_flank(flank: ViewFlank, grid: Option<MapGrid>) -> ViewerFlank {
    let rows_mm = &flank.rows_mm;
    ViewerFlank {
        tooth: flank.tooth,
        side: flank.side.name().to_owned(),
        grid,
        places_mm: flank
            .arcs_mm
            .iter()
            .flat_map(|&arc| rows_mm.iter().map(move |&row| [arc as f32, row as f32]))
            .collect(),
        triangles: flank.triangles,
    }
}

/// Deviations of the finished surface averaged over one mark, µm.
fn without_marks_um(map: &FlankMaps, spacing_mm: [f64; 2]) -> Vec<f32> {
    let axes = [&map.grid.u, &map.grid.v];
    let cells = [0, 1].map(|k| spacing_mm[k] / axes[k].step_mm);
    um(&averaged(map.deviation_mm(), axes.map(|axis| axis.count), cells))
}

fn quantities(job: &dyn GearJob, maps: &GearMaps) -> Vec<ViewerQuantity> {
    let operations = operation_names(job);
    let last = operations.len() - 1;
    let finishing = &operations[last];
    let over = |values: &dyn Fn(&FlankMaps) -> Vec<f32>| maps.flanks.iter().map(values).collect::<Vec<_>>();
    let evaluated_mm =
        |operation: usize| maps.flanks.iter().map(|map| map.evaluated_mm[operation]).collect::<Vec<[f64; 2]>>();
    let mut quantities: Vec<ViewerQuantity> = operations[..last]
        .iter()
        .enumerate()
        .map(|(index, operation)| ViewerQuantity {
            name: format!("Stock of {operation} for {finishing}"),
            definition: format!(
                "Stock of {operation} over the finished surface, along the target's normal, mean of each cell. \
                 {COLOURS} {GREY}"
            ),
            unit: "mm".to_owned(),
            scale: maps.stock_scales[index],
            thinning: Thinning::Mean,
            evaluated_mm: evaluated_mm(index),
            values: over(&|map| map.mean_stock_mm(index)),
        })
        .collect();
    // The last of the earlier operations is what finishing meets: it comes first.
    quantities.reverse();
    quantities.extend(job.mark_spacing_mm().map(|spacing_mm| {
        let values: Vec<Vec<f32>> = over(&|map| without_marks_um(map, spacing_mm));
        let [mark, feed] = spacing_mm.map(|mm| significant(mm, 3));
        ViewerQuantity {
            name: "Deviation without marks".to_owned(),
            definition: format!(
                "Mean normal deviation over one generating mark along the profile, {mark} mm, and one feed along the \
                 tooth, {feed} mm: form and position, and the mean height of the marks, which only add material. Red: \
                 material left; blue: cut too deep. {COLOURS} {GREY}"
            ),
            unit: "µm".to_owned(),
            scale: maps.deviation_scale,
            thinning: Thinning::Mean,
            evaluated_mm: evaluated_mm(last),
            values,
        }
    }));
    quantities.push(ViewerQuantity {
        name: format!("Deviation after {finishing}"),
        definition: format!(
            "Mean normal deviation of each cell; marks wider than a cell are seen. Red: material left; blue: cut too \
             deep. {COLOURS} {GREY}"
        ),
        unit: "µm".to_owned(),
        scale: maps.deviation_scale,
        thinning: Thinning::Mean,
        evaluated_mm: evaluated_mm(last),
        values: over(&|map| um(map.deviation_mm())),
    });
    quantities.push(ViewerQuantity {
        name: format!("Height after {finishing}"),
        definition: format!(
            "Normal deviation of the highest place of each cell, feed marks included. {COLOURS} {GREY}"
        ),
        unit: "µm".to_owned(),
        scale: maps.height_scale,
        thinning: Thinning::Highest,
        evaluated_mm: evaluated_mm(last),
        values: over(&finished_heights_um),
    });
    quantities
}
