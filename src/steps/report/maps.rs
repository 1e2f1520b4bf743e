//! The gear and its maps for the page's viewer.

use crate::colormap::ColourScale;
use crate::error::Result;
use crate::job::GearJob;
use crate::output::flank_maps::FlankMaps;
use crate::output::report::viewer::{Thinning, Viewer, ViewerFlank, ViewerQuantity};
use crate::steps::map_operations;
use crate::steps::sheets;
use crate::steps::view_mesh::ViewMesh;
use crate::units::UM_PER_MM;

/// Mesh of the target, and on it: stock of every earlier operation, deviation and height of the finished surface.
///
/// # Errors
/// No flank is generated on some tooth.
pub fn viewer(job: &dyn GearJob, maps: &[FlankMaps]) -> Result<Viewer> {
    let mesh = ViewMesh::new(job)?;
    let flanks = mesh.flanks.into_iter().map(|flank| {
        let map = maps.iter().find(|map| map.tooth == flank.tooth && map.side == flank.side);
        let leads = &flank.leads_mm;
        ViewerFlank {
            tooth: flank.tooth,
            side: flank.side.name().to_owned(),
            grid: map.map(|map| map.grid.clone()),
            places_mm: flank
                .arcs_mm
                .iter()
                .flat_map(|&arc| leads.iter().map(move |&lead| [arc as f32, lead as f32]))
                .collect(),
            triangles: flank.triangles,
        }
    });
    Ok(Viewer { flanks: flanks.collect(), quantities: quantities(job, maps), body: mesh.body })
}

fn quantities(job: &dyn GearJob, maps: &[FlankMaps]) -> Vec<ViewerQuantity> {
    let operations = map_operations(job);
    let last = operations.len() - 1;
    let finishing = &operations[last].name;
    let over = |values: &dyn Fn(&FlankMaps) -> Vec<f32>| maps.iter().map(values).collect::<Vec<_>>();
    let um = |values: &[f32]| values.iter().map(|value| value * UM_PER_MM as f32).collect::<Vec<_>>();
    let mut quantities: Vec<ViewerQuantity> = operations[..last]
        .iter()
        .enumerate()
        .map(|(index, operation)| ViewerQuantity {
            name: format!("Stock of {} for {finishing}", operation.name),
            definition: format!("What {} leaves over the finished surface, along the target's normal.", operation.name),
            unit: "mm".to_owned(),
            scale: operation.stock_scale,
            thinning: Thinning::Middle,
            values: over(&|map| map.stock_mm(index)),
        })
        .collect();
    // The last of the earlier operations is what finishing meets: it comes first.
    quantities.reverse();
    quantities.push(ViewerQuantity {
        name: format!("Deviation after {finishing}"),
        definition: "Mean height of each cell over the target: what remains when the feed marks are averaged. Red: \
            material left; blue: cut too deep."
            .to_owned(),
        unit: "µm".to_owned(),
        scale: sheets::deviation_scale(maps),
        thinning: Thinning::Mean,
        values: over(&|map| um(&map.deviation_mm)),
    });
    let heights = over(&|map| um(&map.highest_mm[last]));
    quantities.push(ViewerQuantity {
        name: format!("Height after {finishing}"),
        definition: "Highest place of each cell over the target, feed marks included.".to_owned(),
        unit: "µm".to_owned(),
        scale: ColourScale::heights_over(heights.iter().map(Vec::as_slice)),
        thinning: Thinning::Highest,
        values: heights,
    });
    quantities
}
