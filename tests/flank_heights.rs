//! Heights that the native kernel leaves, against closed forms.
mod common;
use common::*;
use gearcut::cut::cpu::Cpu;
use gearcut::gear::generation::Side;
use gearcut::job::Job;

#[test]
fn quick_look() {
    let t0 = std::time::Instant::now();
    let mut scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 4200), operation("finish", NORMAL, 0.0, 4200)]);
    for feed in [false, true] {
        for op in &mut scene.operations {
            op.feed_during_stroke = feed;
        }
        let job = Job::new(scene.clone()).unwrap();
        println!("prepare {:?}", t0.elapsed());
        let generation = job.target_generation();
        for tooth in [1, 8] {
            let t = std::time::Instant::now();
            let flank = job.target_flank(&generation, tooth, Side::Left).unwrap();
            let field = job.flank_field(&flank);
            println!("field {:?} {} x {} length {}", t.elapsed(), field.columns.len(), field.rows(), flank.length_mm());
            for op in &job.operations {
                let t = std::time::Instant::now();
                let plan = gearcut::passes::CutPlan::new(&field, &op.strokes, &job.cutter);
                println!(
                    "plan {:?} records {} per dexel {}",
                    t.elapsed(),
                    plan.records.len(),
                    plan.dexel_passes() as f64 / field.len() as f64
                );
            }
            let t = std::time::Instant::now();
            let cut = job.cut(&Cpu::default(), field).unwrap();
            println!("cut {:?} {:?}", t.elapsed(), cut.stats);
            for layer in &cut.layers {
                let rows = cut.field.rows();
                let h: Vec<f32> =
                    (0..cut.field.columns.len()).step_by(60).map(|c| layer.column(c, rows)[rows / 2] * 1e3).collect();
                println!("{h:?}");
            }
        }
    }
}
#[test]
fn look_state() {
    let scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 4200)]);
    let job = Job::new(scene).unwrap();
    for l in [-0.2, -0.1, 0.0, 0.1, 1.0] {
        println!("{l} {:?}", job.operations[0].schedule.state(l));
    }
    let t = std::time::Instant::now();
    let mut s = 0.0;
    for i in 0..4200 {
        s += job.operations[0].schedule.state(f64::from(i) + 0.1).psi_b_rad;
    }
    println!("{:?} {s}", t.elapsed());
}
