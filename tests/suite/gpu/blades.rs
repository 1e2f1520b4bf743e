//! Tools whose blades differ, and blades along the tool's axis, on the device beside the native backend.

use crate::fixtures::face_mill::{FaceMill, SIDES, cone, even, plane};
use crate::fixtures::parity::{Parity, cut_both, cut_both_in_space, software_gpu, strict};
use crate::fixtures::two_edges::{Blades, Regrouped, shaped, strokes_of};
use crate::tools::spatial_edges::TwoEdgedHob;
use gearcut::cut::Backend;
use gearcut::dexel::SpatialField;
use gearcut::passes::{CutPlan, SweepPlan};
use gearcut::terms::Side;
use gearcut::tool::blade_edges::BladeEdges;

/// What the shaders add at most: for strokes and for sweeps, as with tools of one edge.
const SHAPED_NM: f64 = 1.0;
const SWEPT_NM: f64 = 2.0;

#[test]
fn shaped_flanks_are_cut_alike() {
    let gpu = software_gpu(strict());
    let (job, second) = shaped(2);
    let plan = |blades, field: &_| {
        let tool = Regrouped::new(&job.cutter, [job.cutter.edge(), &second], blades);
        CutPlan::new(field, &strokes_of(&job.finishing().strokes, &tool), &tool)
    };
    for (tooth, side) in [(3, Side::Left), (9, Side::Right)] {
        let field = job.flank_field(job.target_flank(tooth, side));
        let (blank, name) = (field.blank_layer(), format!("tooth {tooth} {}", side.name()));
        let (parity, [native, left, right, got]) =
            cut_both(&gpu, &name, &field, &plan(Blades::All, &field), [&blank; 4]);
        println!("{name}: {parity}");
        assert_eq!(parity.verdict_within(SHAPED_NM), Ok(()), "{name}");
        // Alive: each tooth with the other's edge is seen.
        let mut layer = blank.clone();
        gpu.cut(&field, &plan(Blades::Exchanged, &field), &mut layer).expect("cuts");
        assert!(layer != got);
        let mut parity = Parity::default();
        parity.add("exchanged", field.rows(), &native, &[left, right], &layer);
        assert!(parity.verdict_within(SHAPED_NM).is_err());
    }
}

/// Compares a plan, and sees one whose edges are exchanged.
fn compare(gpu: &dyn Backend, name: &str, field: &SpatialField, [plan, exchanged]: [&SweepPlan; 2]) {
    let (parity, native, shifted, got) = cut_both_in_space(gpu, name, field, plan);
    println!("{name}: {parity}");
    assert_eq!(parity.verdict_within(SWEPT_NM), Ok(()), "{name}");
    let mut layer = field.blank_layer();
    gpu.cut_spatial(field, exchanged, &mut layer).expect("cuts");
    assert!(layer != got);
    let mut parity = Parity::default();
    parity.add("exchanged", field.rows(), &native, &shifted, &layer);
    assert!(parity.verdict_within(SWEPT_NM).is_err(), "{name}");
}

#[test]
fn hobbed_flanks_are_cut_alike() {
    let gpu = software_gpu(strict());
    let hob = TwoEdgedHob::new("p12_patch_spur");
    for (number, field) in hob.fields.iter().enumerate() {
        let [plan, exchanged] = [Blades::All, Blades::Exchanged].map(|blades| {
            let tool = hob.tool(blades);
            SweepPlan::new(field, &hob.passes(&tool))
        });
        compare(&gpu, &format!("field {number}"), field, [&plan, &exchanged]);
    }
}

#[test]
fn face_milled_slots_are_cut_alike() {
    let gpu = software_gpu(strict());
    let head = FaceMill::default();
    let exchanged = head.edges.edges().iter().rev().cloned().collect();
    let exchanged = FaceMill { edges: BladeEdges::in_turn(exchanged), ..FaceMill::default() };
    let heads = [&head, &exchanged];
    let fed = plane(&even(0.02, 5.0, 60), &even(-9.0, 9.0, 130));
    let [plan, exchanged] = heads.map(|head| SweepPlan::new(&fed, &head.passes(2.5, [-30.0, 30.0])));
    compare(&gpu, "fed", &fed, [&plan, &exchanged]);
    for side in SIDES {
        let field = cone(side, &even(0.1, 5.0, 50), &even(-0.3, 0.3, 100));
        let [plan, exchanged] = heads.map(|head| SweepPlan::new(&field, &head.plunging(0.002, [-30.0, 30.0])));
        compare(&gpu, &format!("plunging, side {side}"), &field, [&plan, &exchanged]);
    }
}
