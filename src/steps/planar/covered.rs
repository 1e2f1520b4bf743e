//! Rays that a stroke covers as a whole: the tool's body, or a blade that passes right through a tooth.
//!
//! In: a field, an operation's strokes, the tool. Out: these rays; a layer with them at their lowest height. Law:
//! kernels look for the place where a ray enters an edge, within the depth that it records; where the tool has come
//! over the whole record there is no such place, and the target would seem untouched. A ray is covered if its low end
//! and a place close under the target lie in the tool at the same stroke, in one blade closed through the tool's body;
//! or if its low end lies in the body alone, which comes nowhere near it while the tool cuts as it should: what still
//! stands above is cut off from the gear.
//!
//! No stroke of a sound program does that, so a few rays of a field are asked first, and all of them only where one is
//! covered. A gouge narrower than the distance of those, deeper than the record and without an entry is not seen.

use gearcut_core::dexel::{Column, Field, Layer};
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::near::{NearPass, near_passes};
use gearcut_core::tool::PlanarTool;
use glam::DVec2;

/// Rays of a field that are asked first.
const PROBES: usize = 9;
/// The upper place, as a share of the record under the target: strokes touch the target, this deep lies a gouge, and
/// inside of thin tips as well.
const UPPER_SHARE: f64 = 0.1;

/// Columns of a field that strokes cover, each with a pass that does.
pub fn columns(field: &Field, strokes: &StrokeSet, tool: &dyn PlanarTool) -> Vec<(usize, u32)> {
    let columns = &field.columns;
    let Some(middle) = columns.get(columns.len() / 2) else { return Vec::new() };
    let ends =
        |column: &Column| [UPPER_SHARE * column.low_mm, column.low_mm].map(|h| column.origin_mm + h * column.normal);
    let center_mm = ends(middle)[1];
    let reach_mm = columns.iter().flat_map(ends).map(|end| end.distance(center_mm)).fold(0.0, f64::max);
    let (edges, teeth) = (tool.edges(), tool.edges().outlines());
    // Inside of all edges: the body alone.
    let body_mm = teeth.iter().flat_map(|tooth| &tooth.corners_mm).map(|node| node.length()).filter(|r| *r > 1e-6);
    let body_mm = body_mm.fold(f64::INFINITY, f64::min);
    let near = near_passes(strokes, tool, center_mm, reach_mm);
    let mount_mm = tool.tool_from_blade(0).translation_mm;
    let axes_mm: Vec<(usize, DVec2)> = (0..strokes.count())
        .map(|stroke| (stroke, strokes.poses(stroke)))
        .map(|(stroke, poses)| (stroke, poses[poses.len() / 2].point(mount_mm)))
        .filter(|(_, axis_mm)| axis_mm.distance(center_mm) < body_mm + reach_mm)
        .collect();
    let in_body = |ends: &[DVec2; 2]| {
        let depth_mm = ends[1].distance(ends[0]);
        axes_mm.iter().find(|(_, axis_mm)| ends[1].distance(*axis_mm) < body_mm - depth_mm).map(|(stroke, _)| *stroke)
    };
    let in_tooth = |pass: &NearPass, ends: &[DVec2; 2]| {
        let tooth = &teeth[edges.index_of(pass.blade)];
        // Hardly a tooth comes near the low end.
        ends.iter().rev().all(|end| tooth.holds(pass.middle().point(*end)))
    };
    let step = (columns.len() / (PROBES - 1)).max(1);
    let probes: Vec<[DVec2; 2]> = columns.iter().step_by(step).chain(columns.last()).map(ends).collect();
    let is_covered = probes.iter().any(|ends| in_body(ends).is_some())
        || near.iter().any(|pass| probes.iter().any(|ends| in_tooth(pass, ends)));
    if !is_covered {
        return Vec::new();
    }
    let by = |column: &Column| -> Option<u32> {
        let ends = ends(column);
        if let Some(stroke) = in_body(&ends) {
            return Some(strokes.first_pass + (stroke as u32) * strokes.blades);
        }
        let pass = near.iter().find(|pass| in_tooth(pass, &ends))?;
        Some(strokes.first_pass + (pass.stroke as u32) * strokes.blades + pass.blade)
    };
    columns.iter().enumerate().filter_map(|(index, column)| Some((index, by(column)?))).collect()
}

/// Puts covered columns at their lowest height.
pub fn lower(field: &Field, covered: &[(usize, u32)], layer: &mut Layer) {
    let rows = field.rows();
    for &(index, pass) in covered {
        let low_mm = field.columns[index].low_mm as f32;
        for dexel in index * rows..(index + 1) * rows {
            if layer.heights_mm[dexel] > low_mm {
                (layer.heights_mm[dexel], layer.passes[dexel]) = (low_mm, pass);
            }
        }
    }
}
