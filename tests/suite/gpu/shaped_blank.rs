//! The blank of shaped gears on the GPU beside the native kernel: ends of spans, volumes of every pass, rubbing; lists
//! that grow; and proof that the comparison can fail.

use crate::fixtures::blank_parity::BlankParity;
use crate::fixtures::paper::*;
use crate::fixtures::parity::*;
use crate::fixtures::rings::ring_scene;
use gearcut::cut::Backend;
use gearcut::cut::CutBlank;
use gearcut::cut::cpu::Cpu;
use gearcut::cut::{BlankOperation, Rub};
use gearcut::dexel::BlankField;
use gearcut::frame::Rigid2;
use gearcut::gear::PitchCurveShape;
use gearcut::gear::blank_outline::BlankOutline;
use gearcut::gpu::GpuOptions;
use gearcut::measure::damage::LEAST_DEPTH_MM;
use gearcut::passes::StrokeSet;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;

fn cut(job: &ShapingJob) -> CutBlank {
    job.cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits in memory"), &|| true)
        .expect("the native backend")
        .expect("not stopped")
}

/// How far an end on the GPU may be off the native one, mm: four ulps of f32 at 70 mm.
const GPU_BOUND_MM: f64 = 3e-5;
/// An end that its ray meets at 45 degrees or steeper, where a place is known as well as the ray's coordinates are.
const STEEP: f32 = 0.7;

/// A ring: its material lies outside the outline and inside the rim, the cutter in its hole.
#[test]
fn the_gpu_cuts_a_ring_alike() {
    let shape = PitchCurveShape::Ellipse { order: 2, eccentricity: 0.08, semi_major_axis_mm: None };
    let operations = vec![operation("rough", NORMAL, 0.5, 270), operation("finish", NORMAL, 0.0, 540)];
    let mut scene = ring_scene(shape, 54, 16, operations);
    scene.fields.blank_spacing_mm = 0.6;
    let job = ShapingJob::new(scene).expect("a ring");
    let run = |backend: &dyn Backend, by_mm: f64| {
        let mut grid = job.planar().blank_grid().expect("fits");
        for row in &mut grid.rows {
            row.first_mm += by_mm;
        }
        let field = BlankField::new(grid, &BlankOutline::new(&job.blank));
        job.cut_blank(backend, field, &|| true).expect("both work").expect("not stopped")
    };
    let native = run(&Cpu::default(), 0.0);
    let bound_mm = BlankParity::bound_mm(&native.field);
    let beside = [bound_mm, -bound_mm].map(|by_mm| run(&Cpu::default(), by_mm));
    let gpu = run(&software_gpu(strict()), 0.0);
    let parity = BlankParity::of(&native.field, [&beside[0].field, &beside[1].field], &gpu.field);
    println!("{parity}");
    assert_eq!(parity.verdict(), Ok(()));
    // Tiles that do not fit the device together go one half after the other, and leave the same bytes.
    let parts = run(&software_gpu(GpuOptions { memory_limit_bytes: Some(400_000), ..strict() }), 0.0);
    assert!(parts == gpu, "halves change the result");
    let uncut = job.planar().blank_field().expect("fits");
    assert!(BlankParity::of(&native.field, [&beside[0].field, &beside[1].field], &uncut).verdict().is_err());
}

mod slow {
    use super::*;

    #[test]
    fn the_gpu_leaves_the_same_spans_and_volumes() {
        let mut scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 600), operation("finish", NORMAL, 0.0, 240)]);
        Shaping::of_mut(&mut scene).expect("shaping").operations[1].feed_during_stroke = true;
        scene.fields.blank_spacing_mm = 0.7;
        scene.fields.blank_slice_spacing_mm = 30.0;
        let job = ShapingJob::new(scene).expect("a scene that cuts");
        let native = cut(&job);
        let gpu = software_gpu(strict());
        let reach_mm = BlankOutline::new(&job.blank).reach_mm();
        let run = |rooms: usize, strokes: Option<&StrokeSet>| {
            let mut field = job.planar().blank_field().expect("fits");
            let mut cuts = Vec::new();
            for (index, prepared) in job.operations.iter().enumerate() {
                let strokes = strokes.filter(|_| index == 1).unwrap_or(&prepared.strokes);
                let teeth = job.planar().closed_teeth(strokes, reach_mm);
                let returns = job.return_strokes(index);
                let operation = BlankOperation {
                    strokes,
                    returns: returns.as_ref(),
                    tool: &job.cutter,
                    teeth: &teeth,
                    blank_reach_mm: reach_mm,
                    cull: true,
                };
                cuts.push(
                    gpu.cut_blank_on_device(&mut field, &operation, Some(rooms), &|| true)
                        .expect("a software adapter works")
                        .expect("not stopped"),
                );
            }
            (field, cuts)
        };
        let (field, cuts) = run(8, None);
        let (mut lists, mut others, mut worst_mm, mut ends, mut apart) = (0, 0, 0.0_f64, 0, 0);
        for (ours, theirs) in native.field.slices.iter().zip(&field.slices) {
            for f in 0..2 {
                for (a, b) in ours.rays[f].iter().zip(&theirs.rays[f]) {
                    lists += 1;
                    if a.len() != b.len() {
                        others += 1;
                        continue;
                    }
                    for (a, b) in a.iter().zip(b) {
                        for (a, b) in [(a.low, b.low), (a.high, b.high)] {
                            assert!(b.at_mm.is_finite());
                            if a.normal[f].abs() > STEEP {
                                let off_mm = (a.at_mm - b.at_mm).abs();
                                ends += 1;
                                // A ray that grazes a tip corner within an f32's ulp meets it or not.
                                if off_mm > GPU_BOUND_MM { apart += 1 } else { worst_mm = worst_mm.max(off_mm) }
                            }
                        }
                    }
                }
            }
        }
        let [ours, theirs] = [&native.field, &field].map(BlankField::volumes_mm3);
        let off = [0, 1].map(|f| (theirs[f] / ours[f] - 1.0).abs());
        println!(
            "{ends} steep ends at most {:.1} nm apart, {apart} further; {others} of {lists} lists of other lengths; \
            volumes {off:?} apart",
            1e6 * worst_mm
        );
        assert!(ends > 2000 && 1000 * apart <= ends);
        assert!(1000 * others <= 2 * lists, "lists differ only by slivers of some nanometres");
        assert!(off[0] < 1e-7 && off[1] < 1e-7);
        // What every pass removed, and all of them together.
        for (native, cut) in native.cuts.iter().zip(&cuts) {
            for f in 0..2 {
                let [ours, theirs] = [native, cut].map(|c| c.removed_mm3.iter().map(|p| p[f]).sum::<f64>());
                assert!((theirs / ours - 1.0).abs() < 1e-5, "{ours} and {theirs} mm3");
                let apart = native.removed_mm3.iter().zip(&cut.removed_mm3).map(|(a, b)| (a[f] - b[f]).abs());
                let apart = apart.fold(0.0, f64::max);
                println!("single passes at most {apart:.1e} mm3 apart");
                assert!(apart < 0.05);
            }
        }
        // Return strokes that rub are worked out natively where the device met any: none that counts is missed, none is
        // made up.
        for (native, cut) in native.cuts.iter().zip(&cuts) {
            let deep = native.rubs.iter().filter(|rub| rub.depth_mm > LEAST_DEPTH_MM).count();
            println!("{} rays rub, {deep} of them deep, {} on the GPU", native.rubs.len(), cut.rubs.len());
            let alike = |a: &Rub, b: &Rub| {
                let same = (a.pass, a.slice, a.family) == (b.pass, b.slice, b.family);
                same && a.place_mm.distance(b.place_mm) < 1e-3 && (a.depth_mm - b.depth_mm).abs() < 1e-4
            };
            let all_in = |these: &[Rub], those: &[Rub]| {
                let deep = these.iter().filter(|rub| rub.depth_mm > LEAST_DEPTH_MM);
                deep.clone().all(|rub| those.iter().any(|other| alike(rub, other)))
            };
            assert!(deep > 100 && all_in(&native.rubs, &cut.rubs) && all_in(&cut.rubs, &native.rubs));
        }
        // Lists that begin without room grow, and end the same; one stroke less does not.
        assert!(run(0, None).0 == field);
        let schedule = &job.operations[1].schedule;
        let law = job.operations[1].strokes.law;
        let fewer = StrokeSet::new(job.operations[1].strokes.first_pass, &job.cutter, law, 239, |lambda| {
            let pose = schedule.state(if lambda > 99.5 { lambda + 1.0 } else { lambda }).pose;
            Rigid2::new(pose.angle_rad, pose.center_mm)
        });
        assert!(run(8, Some(&fewer)).0 != field);
    }
}
