//! The blank field against itself (candidates, balance), against closed forms, and against polygon clipping.

mod common;

use common::*;
use gearcut::dexel::intervals;
use gearcut::job::{CutBlank, Job};

fn cut(job: &Job) -> CutBlank {
    job.cut_blank(&|| true).expect("fits in memory").expect("not stopped")
}

#[test]
fn probe() {
    let scene = paper_scene(vec![operation("rough", NORMAL, 2.0, 4200), operation("finish", NORMAL, 0.0, 4200)]);
    let job = Job::new(scene).unwrap();
    let started = std::time::Instant::now();
    let cut = cut(&job);
    println!("{:?} blank {:?} left {:?}", started.elapsed(), cut.blank_mm3, cut.left_mm3);
    for c in &cut.cuts {
        let sum = c.removed_mm3.iter().fold([0.0; 2], |s, r| [s[0] + r[0], s[1] + r[1]]);
        println!("{:?} removed {sum:?} rubs {}", c.stats, c.rubs.len());
        let worst = c.rubs.iter().map(|r| r.depth_mm).fold(0.0, f64::max);
        println!("worst rub {worst}");
    }
    println!("bytes {} spans {}", cut.field.bytes(), cut.field.spans());
    let t = std::time::Instant::now();
    let target = job.target_outline(0.02).unwrap();
    println!("target {:?} points {}", t.elapsed(), target.points_mm().len());
    let bore = std::f64::consts::PI * 100.0;
    println!("area {} vs {:?}", target.area_mm2() - bore, cut.field.areas_mm2());
    let mut worst = [0.0_f64; 2];
    let mut hist = [0usize; 8];
    for (f, family) in gearcut::planar_rays::FAMILIES.into_iter().enumerate() {
        let row = cut.field.grid.rows[f];
        for (i, ray) in cut.field.slices[0].rays[f].iter().enumerate() {
            for s in ray {
                for e in [s.low, s.high] {
                    if e.pass != u32::MAX {
                        let p = family.point(e.at_mm, row.at_mm(i));
                        let d = target.distance_mm(p, 3.0).unwrap();
                        if d < worst[0] {
                            worst[0] = d;
                            println!("low {d:e} at {p} normal {:?}", e.normal);
                        }
                        if d > worst[1] {
                            worst[1] = d;
                            println!("high {d:e} at {p} normal {:?}", e.normal);
                        }
                        hist[((d.abs() * 1e6).log10().max(0.0) as usize).min(7)] += 1;
                    }
                }
            }
        }
    }
    println!("{worst:?} {hist:?}");
    let ordered = cut
        .field
        .slices
        .iter()
        .flat_map(|s| &s.rays)
        .flatten()
        .all(|r| r.windows(2).all(|w| w[0].high.at_mm < w[1].low.at_mm));
    assert!(ordered);
    let _ = intervals::LEAST_SPAN_MM;
}
