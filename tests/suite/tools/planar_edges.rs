//! A shaper cutter whose teeth have two different edges: every dexel gets what the tooth that comes there would leave.

use crate::fixtures::two_edges::{Blades, Regrouped, shaped, stroke_pass, strokes_of};
use gearcut::cut::cpu::{Cpu, blank};
use gearcut::cut::{Backend, BlankCut, BlankOperation};
use gearcut::dexel::{BlankField, Field, Layer};
use gearcut::gear::blank_outline::BlankOutline;
use gearcut::passes::CutPlan;
use gearcut::process::shaping::ShapingJob;
use gearcut::steps::planar::PlanarGear;
use gearcut::terms::Side;
use gearcut::tool::edge::Edge;

fn cut(field: &Field, plan: &CutPlan) -> Layer {
    let mut layer = field.blank_layer();
    let stats = Cpu::default().cut(field, plan, &mut layer).expect("native");
    assert_eq!(stats.unconverged, 0);
    layer
}

/// What some of the cutter's teeth leave of a field, and for every dexel the stroke and the cutter's own tooth.
fn cut_by(job: &ShapingJob, second: &Edge, blades: Blades, field: &Field) -> (Layer, Vec<Option<(usize, u32)>>) {
    let tool = Regrouped::new(&job.cutter, [job.cutter.edge(), second], blades);
    let strokes = strokes_of(&job.finishing().strokes, &tool);
    let layer = cut(field, &CutPlan::new(field, &strokes, &tool));
    let left_by = layer.passes.iter().map(|&pass| (pass != u32::MAX).then(|| stroke_pass(&strokes, &tool, pass)));
    let left_by = left_by.collect();
    (layer, left_by)
}

fn fields(job: &ShapingJob) -> Vec<Field> {
    let flanks = [(3, Side::Left), (9, Side::Right)];
    let flanks = flanks.map(|(tooth, side)| job.flank_field(job.target_flank(tooth, side)));
    flanks.into_iter().chain([job.root_field(4)]).collect()
}

#[test]
fn candidates_equal_brute_force_with_each_tooths_own_edge() {
    let (job, second) = shaped(2);
    for field in fields(&job) {
        let tool = Regrouped::new(&job.cutter, [job.cutter.edge(), &second], Blades::All);
        let strokes = strokes_of(&job.finishing().strokes, &tool);
        let (plan, brute) = (CutPlan::new(&field, &strokes, &tool), CutPlan::brute_force(&field, &strokes, &tool));
        assert!(brute.records.len() > 2 * plan.records.len());
        assert!(cut(&field, &plan) == cut(&field, &brute));
    }
}

#[test]
fn two_edges_leave_the_lower_of_what_each_leaves_alone() {
    let (job, second) = shaped(2);
    let mut left = [0; 2];
    for field in fields(&job) {
        let (both, left_by) = cut_by(&job, &second, Blades::All, &field);
        let alone = [0, 1].map(|edge| cut_by(&job, &second, Blades::Alone(edge), &field));
        for (dexel, left_by) in left_by.into_iter().enumerate() {
            let heights = [0, 1].map(|edge| alone[edge].0.heights_mm[dexel]);
            assert_eq!(both.heights_mm[dexel].to_bits(), heights[0].min(heights[1]).to_bits(), "dexel {dexel}");
            if heights[0] != heights[1] {
                let edge = usize::from(heights[1] < heights[0]);
                assert_eq!(left_by, alone[edge].1[dexel], "dexel {dexel}");
                left[edge] += 1;
            }
        }
    }
    println!("dexels left by each edge: {left:?}");
    assert!(left.iter().all(|&dexels| dexels > 300), "{left:?}");
}

/// A sibling of the tests above: the same teeth with their edges exchanged leave another flank.
#[test]
fn exchanged_edges_are_noticed() {
    let (job, second) = shaped(1);
    for field in fields(&job) {
        let [given, exchanged] = [Blades::All, Blades::Exchanged].map(|blades| cut_by(&job, &second, blades, &field).0);
        let differ = given.heights_mm.iter().zip(&exchanged.heights_mm).filter(|(a, b)| a != b).count();
        assert!(2 * differ > field.len(), "{differ} of {} dexels", field.len());
    }
}

/// Volume of a field by both families of rays, mm3, after some teeth have cut it.
fn cut_blank(job: &ShapingJob, second: &Edge, blades: Blades, field: &mut BlankField, cull: bool) -> BlankCut {
    let tool = Regrouped::new(&job.cutter, [job.cutter.edge(), second], blades);
    let strokes = strokes_of(&job.finishing().strokes, &tool);
    let reach_mm = BlankOutline::new(&job.blank).reach_mm();
    let gear = PlanarGear { tool: &tool, ..job.planar() };
    let teeth = gear.closed_teeth(&strokes, reach_mm);
    assert_eq!(teeth.len(), tool.edges.edges().len());
    let operation =
        BlankOperation { strokes: &strokes, returns: None, tool: &tool, teeth: &teeth, blank_reach_mm: reach_mm, cull };
    blank::cut(field, &operation, &|| true).expect("not stopped")
}

#[test]
fn the_blank_loses_what_each_tooth_takes() {
    let (mut job, second) = shaped(1);
    job.scene.fields.blank_spacing_mm = 0.8;
    job.scene.fields.blank_slice_spacing_mm = 15.0;
    let blank = || job.planar().blank_field().expect("fits");
    let (mut culled, mut all, mut in_turn, mut exchanged) = (blank(), blank(), blank(), blank());
    let cuts = [true, false]
        .map(|cull| cut_blank(&job, &second, Blades::All, if cull { &mut culled } else { &mut all }, cull).removed_mm3);
    assert!(culled == all && cuts[0] == cuts[1]);
    // One kind of teeth after the other leaves the same body.
    for edge in [0, 1] {
        cut_blank(&job, &second, Blades::Alone(edge), &mut in_turn, true);
    }
    let [left, wanted] = [&culled, &in_turn].map(BlankField::volumes_mm3);
    println!("{left:?} and {wanted:?} mm3 are left");
    assert!((0..2).all(|f| (left[f] - wanted[f]).abs() < 1e-6));
    // Alive: with exchanged edges other spaces are the wider ones.
    cut_blank(&job, &second, Blades::Exchanged, &mut exchanged, true);
    assert!(exchanged != culled);
}
