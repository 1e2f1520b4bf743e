//! The chip ledger against closed forms, against the blank field and against polygon clipping.

mod common;

use common::*;
use gearcut::job::Job;
use gearcut::measure::chips::ChipLedger;

fn ledger(job: &Job) -> ChipLedger {
    ChipLedger::new(job, &|| true).expect("not stopped")
}

#[test]
fn probe() {
    for n in [4200] {
        let scene = paper_scene(vec![operation("rough", NORMAL, 2.0, n), operation("finish", NORMAL, 0.0, n)]);
        let job = Job::new(scene).unwrap();
        let blank = job.cut_blank(&|| true).unwrap().unwrap();
        for spacing in [0.05, 0.05] {
            let t = std::time::Instant::now();
            let l = ledger(&job);
            println!("N {n} spacing {spacing} time {:?}", t.elapsed());
            for (i, op) in l.operations.iter().enumerate() {
                let removed = blank.cuts[i].removed_mm3.iter().fold([0.0; 2], |s, r| [s[0] + r[0], s[1] + r[1]]);
                let v = l.area_mm2(i) * 30.0;
                println!("  ledger {v:.3} blank {removed:?} share {:.2e}", v / (0.5 * (removed[0] + removed[1])) - 1.0);
                let (s, m) = op.largest(|s| s.area_mm2).unwrap();
                println!("  idle {} largest {s}: {m:?}", op.idle());
                let mid = &op.strokes[n as usize / 2];
                println!("  mid {mid:?}");
                for s in &op.strokes[n as usize / 2..n as usize / 2 + 6] {
                    println!(
                        "    {:.5} contact {:?} thick {:?} F {:.1}",
                        s.area_mm2, s.contact_mm, s.thickest_mm, s.cutting_n
                    );
                }
            }
        }
    }
}
