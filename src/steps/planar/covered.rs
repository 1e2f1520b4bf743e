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
use gearcut_core::frame::Rigid2;
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::near::near_passes;
use gearcut_core::tool::PlanarTool;
use gearcut_core::tool::closed_tooth::{ClosedTooth, PlacedScratch};
use glam::DVec2;

/// Rays of a field that are asked first.
const PROBES: usize = 9;
/// The upper place, as a share of the record under the target: strokes touch the target, this deep lies a gouge, and
/// inside of thin tips as well.
const UPPER_SHARE: f64 = 0.1;

/// A blade's region, through its body to the tool's axis, as a polygon in the blade frame.
struct BladeRegion {
    /// Its corners, mm.
    outline: Vec<DVec2>,
    /// The box that holds them: most places lie outside of it.
    box_mm: [DVec2; 2],
}

impl BladeRegion {
    fn holds(&self, p: DVec2) -> bool {
        let [low, high] = self.box_mm;
        if p.cmplt(low).any() || p.cmpgt(high).any() {
            return false;
        }
        let before = self.outline.iter().cycle().skip(self.outline.len() - 1);
        let crossed = before
            .zip(&self.outline)
            .filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x));
        crossed.count() % 2 == 1
    }
}

/// Columns of a field that strokes cover, each with a pass that does.
pub fn columns(field: &Field, strokes: &StrokeSet, tool: &dyn PlanarTool) -> Vec<(usize, u32)> {
    let columns = &field.columns;
    let Some(middle) = columns.get(columns.len() / 2) else { return Vec::new() };
    let ends =
        |column: &Column| [UPPER_SHARE * column.low_mm, column.low_mm].map(|h| column.origin_mm + h * column.normal);
    let center_mm = ends(middle)[1];
    let reach_mm = columns.iter().flat_map(ends).map(|end| end.distance(center_mm)).fold(0.0, f64::max);
    let regions: Vec<BladeRegion> = tool
        .edges()
        .edges()
        .iter()
        .map(|edge| {
            let tooth = ClosedTooth::new(edge, 0.0);
            let outline =
                tooth.placed(&Rigid2::new(0.0, DVec2::ZERO), &mut PlacedScratch::default()).nodes_mm().to_vec();
            let nowhere = [DVec2::INFINITY, DVec2::NEG_INFINITY];
            let box_mm = outline.iter().fold(nowhere, |[low, high], node| [low.min(*node), high.max(*node)]);
            BladeRegion { outline, box_mm }
        })
        .collect();
    // Inside of all edges: the body alone.
    let body_mm = regions.iter().flat_map(|region| &region.outline).map(|node| node.length()).filter(|r| *r > 1e-6);
    let body_mm = body_mm.fold(f64::INFINITY, f64::min);
    let near = near_passes(strokes, tool, center_mm, reach_mm);
    let mount_mm = tool.tool_from_blade(0).translation_mm;
    let axes_mm: Vec<(usize, DVec2)> = (0..strokes.count())
        .map(|stroke| (stroke, strokes.poses(stroke)))
        .map(|(stroke, poses)| (stroke, poses[poses.len() / 2].point(mount_mm)))
        .filter(|(_, axis_mm)| axis_mm.distance(center_mm) < body_mm + reach_mm)
        .collect();
    let edges = tool.edges();
    let by = |column: &Column| -> Option<u32> {
        let ends = ends(column);
        let in_body =
            axes_mm.iter().find(|(_, axis_mm)| ends[1].distance(*axis_mm) < body_mm - (ends[1] - ends[0]).length());
        if let Some((stroke, _)) = in_body {
            return Some(strokes.first_pass + (*stroke as u32) * strokes.blades);
        }
        let pass = near.iter().find(|pass| {
            let region = &regions[edges.index_of(pass.blade)];
            ends.iter().all(|end| region.holds(pass.middle().point(*end)))
        })?;
        Some(strokes.first_pass + (pass.stroke as u32) * strokes.blades + pass.blade)
    };
    let step = (columns.len() / (PROBES - 1)).max(1);
    if !columns.iter().step_by(step).chain(columns.last()).any(|column| by(column).is_some()) {
        return Vec::new();
    }
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
