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
    let ordered = cut.field.slices.iter().flat_map(|s| &s.rays).flatten().all(|r| r.windows(2).all(|w| w[0].high.at_mm < w[1].low.at_mm));
    assert!(ordered);
    let _ = intervals::LEAST_SPAN_MM;
}
