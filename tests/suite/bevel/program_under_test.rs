//! Programs of the six-axis machine under test: read back they cut the same flanks in every slot, and a wrong one is
//! told.

use super::jobs::job;
use gearcut::cut::cpu::Cpu;
use gearcut::findings::Severity;
use gearcut::process::bevel::BevelJob;
use gearcut::process::bevel::axes_report::BevelAxesReport;
use gearcut::process::bevel::gcode;
use gearcut::steps::axes::AxesOfOperation as _;
use gearcut::terms::Side;

const FAST: &str = "operation.finish.roll_speed_deg_per_s=20";

fn cut_by(program: &str) -> BevelJob {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), program).expect("written");
    let under_test = format!("operation.finish.program='{}'", file.path().display());
    job("five_linkage_printed", &[FAST, &under_test]).expect("judged, not refused")
}

/// Heights on a few rays of flanks in slots early and late, mm.
fn heights(job: &BevelJob) -> Vec<f64> {
    let mut heights = Vec::new();
    for (tooth, side) in [(1, Side::Left), (41, Side::Right)] {
        let length_mm = job.target_of(side).length_mm();
        let arcs_mm = (1..5).map(|i| length_mm * f64::from(i) / 5.0).collect();
        let rays = job.rays_over(tooth, side, arcs_mm, vec![-6.0, 0.3, 7.0]).expect("rays");
        let (layers, _) = job.cut_field(&Cpu::default(), job.space_of(tooth, side), &rays.field).expect("cuts");
        heights.extend(layers.last().expect("an operation").heights_mm.iter().map(|&height| f64::from(height)));
    }
    heights
}

#[test]
fn a_program_read_back_cuts_the_same_flanks_and_a_wrong_one_is_told() {
    let own = job("five_linkage_printed", &[FAST]).expect("a gear");
    let program = gcode::text(&own, own.finishing(), &[]).expect("wanted").expect("written");
    let direct = heights(&own);
    let against = |under_test: &BevelJob| -> Vec<f64> {
        heights(under_test).iter().zip(&direct).map(|(of_program, own)| of_program - own).collect()
    };
    let under_test = cut_by(&program);
    let worst_mm = against(&under_test).into_iter().map(f64::abs).fold(0.0, f64::max);
    let report = &BevelAxesReport::of_job(&under_test)[0];
    println!("flanks {worst_mm:.2e} mm off, {:?}", report.program());
    // 1 um is asked.
    assert!(worst_mm < 1.01e-3, "{worst_mm:e} mm");
    assert!(report.own_warnings().is_empty(), "{:?}", report.own_warnings());

    // The head 50 um further in, in every block: no flank is left as high as it was.
    let deep: String = program
        .lines()
        .map(|line| match line.split_once(" Z") {
            Some((before, after)) if line.starts_with('N') => {
                let (z, rest) = after.split_once(' ').expect("more words");
                format!("{before} Z{:.7} {rest}\n", z.parse::<f64>().expect("a number") + 0.05)
            }
            _ => format!("{line}\n"),
        })
        .collect();
    let deeper = cut_by(&deep);
    let off = against(&deeper);
    assert!(off.iter().all(|&mm| (-0.05..-0.005).contains(&mm)), "{off:?}");
    let told = BevelAxesReport::of_job(&deeper)[0].own_warnings();
    assert!(told[0].severity == Severity::Fault && told[0].text.contains("um off the scene's own motion"), "{told:?}");

    // Half of the slots.
    let slots = program.lines().collect::<Vec<_>>();
    let blocks = slots.iter().filter(|line| line.contains(" G1 ")).count();
    let mut block = 0;
    let half: Vec<&str> = slots
        .iter()
        .filter(|line| {
            block += usize::from(line.contains(" G1 "));
            !line.contains(" G1 ") || block <= blocks / 2
        })
        .copied()
        .collect();
    let told = BevelAxesReport::of_job(&cut_by(&half.join("\n")))[0].own_warnings();
    assert!(told.iter().any(|of| of.severity == Severity::Fault && of.text.contains("leaves out")), "{told:?}");
}
