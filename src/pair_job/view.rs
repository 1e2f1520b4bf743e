//! Both gears in the page's 3D view: A with its contact pattern on the flanks, B without, and how they turn.
//!
//! In: a pair of cut gears. Out: what the viewer draws; nothing of nominal flanks, which belong to no body.
//!
//! The bodies are the targets, sampled coarsely: what a pair feels is shown by colours, not by the shape. Gears are
//! turned as their right flanks drive; that they sit some micrometres off their axes is not seen.

use super::pictures::pattern;
use super::rolled::RolledPair;
use crate::colormap::ColourScale;
use crate::number_text::plain;
use crate::output::grid::MapGrid;
use crate::output::report::viewer::{Thinning, Viewer, ViewerMate, ViewerQuantity};
use crate::pair::pitch_pair::Member;
use crate::steps::report::maps::viewer_flank;
use crate::steps::view_mesh::ViewMesh;
use crate::surface::triangles::Triangles;

/// Places of the roll in each pitch.
const PLACES_PER_PITCH: usize = 6;

/// What the viewer draws.
pub fn viewer(rolled: &RolledPair, marking_um: f64) -> Option<Viewer> {
    let [a, b] = rolled.flanks.views.clone()?;
    let (grids, values): (Vec<MapGrid>, Vec<Vec<f32>>) = a
        .flanks
        .iter()
        .map(|flank| pattern(rolled, Member::Driver, flank.side, i64::from(flank.tooth), marking_um))
        .unzip();
    // Whole flanks: a cell more at either end.
    // Whole flanks: from cell to cell and one more at either end.
    let evaluated_mm = grids.iter().map(|MapGrid { u, .. }| [u.start_mm - u.step_mm, u.place_mm(u.count)]).collect();
    Some(Viewer {
        flanks: a.flanks.into_iter().zip(grids).map(|(flank, grid)| viewer_flank(flank, Some(grid))).collect(),
        quantities: vec![ViewerQuantity {
            evaluated_mm,
            name: "Contact pattern of gear A".to_owned(),
            definition: format!(
                "Smallest gap to gear B while the flank's side drives. Grey: it stays farther away than the marking of \
                 {} µm.",
                plain(marking_um)
            ),
            unit: "µm".to_owned(),
            scale: ColourScale::Sequential { low: 0.0, high: marking_um as f32 },
            thinning: Thinning::Middle,
            values,
        }],
        body: a.body,
        mate: Some(ViewerMate {
            triangles: whole(b),
            axis_mm: rolled.meshing.axis_2_mm().to_array(),
            turned_deg: turned_deg(rolled),
        }),
        strokes: None,
    })
}

/// A gear as one body.
fn whole(mesh: ViewMesh) -> Triangles {
    let mut all = mesh.body;
    for flank in mesh.flanks {
        let first = all.positions_mm.len() as u32;
        all.positions_mm.extend(flank.triangles.positions_mm);
        all.normals.extend(flank.triangles.normals);
        all.indices.extend(flank.triangles.indices.iter().map(|index| index + first));
    }
    all
}

/// How far both gears are turned over the first turn of A.
fn turned_deg(rolled: &RolledPair) -> Vec<[f64; 2]> {
    let period = &rolled.period;
    let in_a_turn = period.moments.len() / period.turns as usize;
    let step = (in_a_turn / (PLACES_PER_PITCH * period.teeth as usize)).max(1);
    // Ten thousandths of a degree: a tenth of a micrometre at 60 mm.
    let short = |rad: f64| (rad.to_degrees() * 1e4).round() / 1e4;
    let at = |moment: &crate::pair::assembly::Moment| {
        let angle_2 = rolled.fit.turn_rad + rolled.fit.pitch.sign() * (moment.pitch.phi_2_rad + moment.right.error_rad);
        [short(-moment.pitch.phi_1_rad), short(angle_2)]
    };
    period.moments[..in_a_turn].iter().step_by(step).map(at).collect()
}
