//! Rays that the cutter comes over as a whole, against brute force: every ray, every stroke, every blade, each asked
//! whether its polygon holds the ray's ends.

use crate::fixtures::paper::*;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::frame::Rigid2;
use gearcut::passes::planar::strokes::StrokeLaw;
use gearcut::passes::{CutPlan, StrokeSet};
use gearcut::process::shaping::ShapingJob;
use gearcut::steps::planar::{CutField, PlanarGear, PlanarOperation};
use gearcut::terms::Side;
use gearcut::tool::closed_tooth::{ClosedTooth, PlacedScratch};
use gearcut::tool::{CuttingTool, PlanarTool};
use glam::DVec2;

/// The upper place of a ray that is asked, as a share of its record: what the law says.
const UPPER_SHARE: f64 = 0.1;

/// Winding number of a polygon about a point by angles: nothing shared with the crossing test of the code.
fn holds(polygon_mm: &[DVec2], p: DVec2) -> bool {
    let next = polygon_mm.iter().cycle().skip(1);
    let turned: f64 = polygon_mm.iter().zip(next).map(|(a, b)| (*a - p).angle_to(*b - p)).sum();
    turned.abs() > 3.0
}

/// A cutter that stands deep in the gear for one of three strokes.
#[test]
fn rays_inside_of_the_cutter_are_those_of_brute_force() {
    let job = ShapingJob::new(paper_scene(vec![operation("finish", NORMAL, 0.0, 480)])).expect("a gear");
    let cutter = &job.cutter;
    let depths_mm = [92.0, 45.0, 300.0];
    let strokes = StrokeSet::new(0, cutter, StrokeLaw::Frozen, depths_mm.len(), |stroke| {
        Rigid2::new(0.3 + stroke, DVec2::from_angle(2.0) * depths_mm[stroke as usize])
    });
    let gear = PlanarGear { operations: vec![PlanarOperation { name: "deep", strokes: &strokes }], ..job.planar() };
    let polygons: Vec<Vec<DVec2>> = (0..cutter.blade_count())
        .map(|blade| {
            let tooth = ClosedTooth::new(cutter.edges().edge_of(blade), 0.0);
            tooth.placed(&cutter.tool_from_blade(blade), &mut PlacedScratch::default()).nodes_mm().to_vec()
        })
        .collect();
    // Inside of every tooth's nodes lies the body.
    let nodes = polygons.iter().flatten().map(|node| node.length()).filter(|radius| *radius > 1e-6);
    let body_mm = nodes.fold(f64::INFINITY, f64::min);
    let (mut covered, mut lost_without) = (0, 0);
    for tooth in 1..=42 {
        for side in [Side::Left, Side::Right] {
            let mut field = job.flank_field(job.target_flank(tooth, side));
            field.rows_z_mm.truncate(1);
            let CutField { layers, .. } = gear.cut_rows(&Cpu::default(), &field).expect("the native backend");
            let mut expected = field.blank_layer();
            let plan = CutPlan::new(&field, &strokes, cutter);
            Cpu::default().cut(&field, &plan, &mut expected).expect("the native backend");
            for (index, column) in field.columns.iter().enumerate() {
                let [upper, low] =
                    [UPPER_SHARE * column.low_mm, column.low_mm].map(|h| column.origin_mm + h * column.normal);
                let is_covered = (0..strokes.count()).any(|stroke| {
                    let tool_from_work = strokes.poses(stroke)[0].inverse();
                    let [upper, low] = [upper, low].map(|p| tool_from_work.point(p));
                    low.length() < body_mm - low.distance(upper)
                        || polygons.iter().any(|polygon| holds(polygon, upper) && holds(polygon, low))
                });
                if is_covered {
                    covered += 1;
                    lost_without += usize::from(expected.heights_mm[index] > column.low_mm as f32);
                    expected.heights_mm[index] = column.low_mm as f32;
                }
            }
            assert_eq!(layers[0].heights_mm, expected.heights_mm, "tooth {tooth} {}", side.name());
        }
    }
    // The kernels look for entries: without this step whole flanks would look untouched.
    assert!(covered > 1000 && lost_without > 1000, "{covered} covered, {lost_without} of them unseen by the kernel");
}
