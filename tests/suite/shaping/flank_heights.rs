//! What the native kernel leaves on flanks: against closed forms, against brute force, across instruction sets.

use crate::fixtures::paper::*;
use gearcut::cut::Backend;
use gearcut::cut::cpu::{Cpu, Vectors};
use gearcut::dexel::Field;
use gearcut::passes::CutPlan;
use gearcut::process::shaping::ShapingJob;
use gearcut::scene::model::*;
use gearcut::steps::planar::CutField;
use gearcut::terms::Side;

fn coarse_rows(mut scene: Scene) -> Scene {
    scene.fields.lead_spacing_mm = 30.0 / 8.0;
    scene
}

#[test]
fn heights_are_within_a_fiftieth_of_a_nanometre_of_the_closed_form() {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 720)]);
    scene.fields.lead_spacing_mm = 30.0;
    scene.fields.profile_spacing_mm = 0.02;
    let job = ShapingJob::new(scene).expect("the paper's gear");
    let (mut worst_nm, mut compared) = (0.0_f64, 0);
    for (tooth, side) in [(2, Side::Left), (5, Side::Right), (8, Side::Left), (9, Side::Right)] {
        let flank = job.target_flank(tooth, side);
        let cut = job.cut(&Cpu::default(), job.flank_field(flank)).expect("the native backend");
        let set = &job.finishing().strokes;
        for (index, column) in cut.field.columns.iter().enumerate() {
            let height = f64::from(cut.layers[0].column(index, cut.field.rows())[0]);
            // Away from the form point, where the tip corner also cuts, and from the cutter's base circle, where its
            // straight base does.
            if index < 4 || flank.at_arc(column.arc_mm).roll < 0.08 {
                continue;
            }
            let exact = (0..set.count())
                .filter(|&stroke| {
                    job.finishing().schedule.state(stroke as f64).pose.center_mm.distance(column.origin_mm) < 34.0
                })
                .flat_map(|stroke| (0..20).map(move |blade| (stroke, blade)))
                .filter_map(|(stroke, blade)| {
                    involute_height_mm(&job, stroke, blade, side.sign(), column.origin_mm, column.normal)
                })
                .map(|[h, _]| h)
                .filter(|h| *h > -1.5)
                .fold(f64::INFINITY, f64::min);
            worst_nm = worst_nm.max((height - exact).abs() * 1e6);
            compared += 1;
        }
    }
    assert!(compared > 800, "{compared} columns compared");
    // 0.015 nm are found: half an ulp of f32 at heights of some tenths of a millimetre.
    assert!(worst_nm < 0.02, "worst difference {worst_nm:.4} nm");
    println!("{compared} columns, worst difference {worst_nm:.4} nm");
}

/// Cuts a field by one operation's plan and gives heights (as bits) and passes.
fn cut_bits(field: &Field, plan: &CutPlan, backend: Cpu) -> (Vec<u32>, Vec<u32>) {
    let mut layer = field.blank_layer();
    backend.cut(field, plan, &mut layer).expect("native");
    (layer.heights_mm.iter().map(|h| h.to_bits()).collect(), layer.passes)
}

#[test]
fn candidates_equal_brute_force_bit_for_bit() {
    let mut checked = 0;
    for feed_during_stroke in [false, true] {
        for linkage in [NORMAL, TRADITIONAL] {
            let mut operations = vec![operation("rough", linkage, 2.0, 4200), operation("finish", NORMAL, 0.0, 4200)];
            for op in &mut operations {
                op.feed_during_stroke = feed_during_stroke;
            }
            let job = ShapingJob::new(coarse_rows(paper_scene(operations))).expect("the paper's gear");
            for (tooth, side) in
                [(1, Side::Left), (1, Side::Right), (7, Side::Left), (8, Side::Right), (14, Side::Left)]
            {
                let flank = job.target_flank(tooth, side);
                let field = job.flank_field(flank);
                for op in &job.operations {
                    checked += compare_with_brute_force(&job, &field, op);
                }
            }
            let root = job.root_field(7);
            checked += compare_with_brute_force(&job, &root, &job.operations[0]);
        }
    }
    println!("{checked} tiles equal brute force");
    assert!(checked >= 64);
}

#[test]
fn candidates_equal_brute_force_where_facets_are_wide_and_shaved() {
    // Facets of few strokes meet at steep crests, and strokes of a second turn shave slivers off them: narrower than
    // the cells in which passes are compared.
    let mut operations = vec![operation("rough", TRADITIONAL, 0.3, 150), operation("finish", NORMAL, 0.0, 97)];
    operations[1].revolutions = 3;
    operations[1].overlap_rad = 0.37;
    for feed_during_stroke in [false, true] {
        for op in &mut operations {
            op.feed_during_stroke = feed_during_stroke;
        }
        let job = ShapingJob::new(coarse_rows(paper_scene(operations.clone()))).expect("the paper's gear");
        for (tooth, side) in [(3, Side::Left), (9, Side::Right)] {
            let flank = job.target_flank(tooth, side);
            let field = job.flank_field(flank);
            for op in &job.operations {
                compare_whole_field(&job, &field, op);
            }
        }
    }
}

/// Compares a whole field with brute force.
pub(super) fn compare_whole_field(job: &ShapingJob, field: &Field, op: &gearcut::process::shaping::PreparedOperation) {
    let plan = CutPlan::new(field, &op.strokes, &job.cutter);
    let brute = CutPlan::brute_force(field, &op.strokes, &job.cutter);
    assert!(brute.records.len() > 2 * plan.records.len());
    let (expected, got) = (cut_bits(field, &brute, Cpu::default()), cut_bits(field, &plan, Cpu::default()));
    let differing = expected.0.iter().zip(&got.0).filter(|(a, b)| a != b).count();
    assert_eq!(differing, 0, "{differing} heights differ");
    assert_eq!(expected.1, got.1, "passes differ");
}

#[test]
fn rows_that_are_alike_are_what_cutting_each_of_them_gives() {
    let operations = vec![operation("rough", TRADITIONAL, 2.0, 360), operation("finish", NORMAL, 0.0, 360)];
    let job = ShapingJob::new(coarse_rows(paper_scene(operations))).expect("the paper's gear");
    let field = job.flank_field(job.target_flank(5, Side::Left));
    let CutField { layers, stats, .. } = job.planar().cut_rows(&Cpu::default(), &field).expect("native");
    let once = job.cut(&Cpu::default(), field).expect("native");
    assert!(once.layers == layers);
    assert_eq!(stats.dexels, 9 * once.stats.dexels);
}

/// Compares some tiles of a field (evenly spread, and those with the longest lists); gives how many.
fn compare_with_brute_force(
    job: &ShapingJob,
    field: &Field,
    op: &gearcut::process::shaping::PreparedOperation,
) -> usize {
    let plan = CutPlan::new(field, &op.strokes, &job.cutter);
    let mut tiles: Vec<usize> = (0..plan.tiles.len()).step_by(plan.tiles.len().div_ceil(3)).collect();
    tiles.extend((0..plan.tiles.len()).max_by_key(|&t| plan.tiles[t].records.len()));
    for &tile in &tiles {
        let part = Field { columns: field.columns[plan.tiles[tile].columns.clone()].to_vec(), ..field.clone() };
        // The brute force of one tile's columns, and the whole plan's records for them.
        let brute = CutPlan::brute_force(&part, &op.strokes, &job.cutter);
        let chosen = CutPlan {
            tiles: vec![gearcut::passes::Tile {
                columns: 0..part.columns.len(),
                origin_mm: plan.tiles[tile].origin_mm,
                records: plan.tiles[tile].records.clone(),
            }],
            ..plan.clone()
        };
        let cpu = Cpu::default();
        assert!(brute.records.len() > chosen.tiles[0].records.len());
        let (expected, expected_passes) = cut_bits(&part, &brute, cpu);
        let (got, passes) = cut_bits(&part, &chosen, cpu);
        let differing = expected.iter().zip(&got).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "tile {tile} of {}: {differing} heights differ", plan.tiles.len());
        assert_eq!(expected_passes, passes, "tile {tile}: passes differ");
    }
    tiles.len()
}

#[test]
fn a_missing_pass_is_noticed() {
    let job =
        ShapingJob::new(coarse_rows(paper_scene(vec![operation("finish", NORMAL, 0.0, 4200)]))).expect("the gear");
    let flank = job.target_flank(7, Side::Left);
    let field = job.flank_field(flank);
    let plan = CutPlan::new(&field, &job.finishing().strokes, &job.cutter);
    let cpu = Cpu::default();
    let (all, passes) = cut_bits(&field, &plan, cpu);
    let lost = passes[passes.len() / 2];
    let mut without = plan.clone();
    for record in &mut without.records {
        if record.pass == lost {
            // Lifted off by a micrometre in its own frame: the pass no longer reaches the flank.
            record.x_mm[0] += 1e-3;
        }
    }
    let (lifted, _) = cut_bits(&field, &without, cpu);
    assert_ne!(all, lifted);
}

#[test]
fn all_instruction_sets_give_the_same_bytes() {
    for feed_during_stroke in [true, false] {
        let mut op = operation("finish", NORMAL, 0.0, 1000);
        op.feed_during_stroke = feed_during_stroke;
        let mut scene = paper_scene(vec![op]);
        scene.fields = Fields { profile_spacing_mm: 0.02, lead_spacing_mm: 0.5, ..scene.fields };
        let job = ShapingJob::new(scene).expect("the gear");
        let mut field = job.flank_field(job.target_flank(3, Side::Right));
        if !feed_during_stroke {
            // Columns of a single row go together.
            field.rows_z_mm = vec![0.0];
        }
        let plan = CutPlan::new(&field, &job.finishing().strokes, &job.cutter);
        let widest = cut_bits(&field, &plan, Cpu::default());
        for vectors in [Vectors::Baseline, Vectors::Avx2] {
            let Some(cpu) = Cpu::with_vectors(vectors) else { continue };
            assert!(cut_bits(&field, &plan, cpu) == widest, "{} differs from the widest", cpu.instruction_set());
        }
    }
}
