//! Programs of the six-axis machine: written and read back, within their contour error, over all slots.

use super::jobs::job;
use gearcut::bevel::five_axis::SixAxes;
use gearcut::process::bevel::axis_program::read;
use gearcut::process::bevel::gcode;
use gearcut::process::bevel::job::index;
use gearcut::process::bevel::motion::SlotMotion;
use glam::DVec3;

#[test]
fn a_program_read_back_moves_the_head_as_the_cradle_does() {
    let job = job("five_linkage_printed", &[]).expect("a gear");
    let operation = job.finishing();
    let text = gcode::text(&job, operation, &[]).expect("wanted").expect("a program");
    let program = read(&text).expect("it reads");
    let motion = SlotMotion { job: &job, operation };
    let end_s = 61.0 * operation.cycle_s() + operation.course.slot_s();
    let last = program.knots[program.knots.len() - 1];
    assert!((last.time_s - end_s).abs() < 1e-3, "{} of {end_s} s", last.time_s);
    // The middle of the blades' circle that is in the work, in the frame of the machine's slides.
    let tip = |cradle_rad: f64| {
        let angle = cradle_rad + job.middle_rad;
        job.head.radius_mm * DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    for slot in [0, 1, 40] {
        for i in 0..=50 {
            let time_s = operation.course.slot_s() * f64::from(i) / 50.0;
            let cradle_rad = motion.cradle_rad(time_s);
            let settled = operation.settings.work_from_tool(cradle_rad);
            let in_tool = job.head.radius_mm * DVec3::new(job.middle_rad.cos(), job.middle_rad.sin(), 0.0);
            let wanted = index(slot, 62).point(job.gear_from_work.point(settled.point(in_tool)));
            let [x, y, z, work_rad, swing_rad] = program.at(f64::from(slot) * operation.cycle_s() + time_s);
            let axes = SixAxes { slides_mm: DVec3::new(x, y, z), work_rad, swing_rad, head_rad: 0.0 };
            let got = job.gear_from_work.point(job.machine.work_from_tool(&axes).point(tip(cradle_rad)));
            // 1 um is asked; times are written with nine digits, which adds nanometres.
            assert!(got.distance(wanted) < 1.01e-3, "slot {slot}, {time_s} s: {:e} mm", got.distance(wanted));
        }
    }
    // Between slots the head is clear of the blank.
    let between = program.at(operation.course.slot_s() + 0.5 * operation.spec.idle_s);
    assert!(motion.positions(0.0)[2] - between[2] > job.blank.outer_addendum_mm + job.blank.outer_dedendum_mm);
}

#[test]
fn programs_with_faults_are_refused_by_line_and_word() {
    let start = "N10 G21 G90 G94\nN20 G0 X1.0 Y2.0 Z3.0 A4.0 B75.0\n";
    for (body, words) in [
        ("N30 G93 G1 X1.0 F2.0\nM30\n", ""),
        ("N30 G93 G1 C5.0 F2.0\nM30\n", "line 3: word `C5.0`: this letter is not read"),
        ("N30 G93 G1 X1.0\nM30\n", "word `F` is missing"),
        ("N30 G1 X1.0 F2.0\nM30\n", "without G93"),
        ("N30 G2 X1.0 F2.0\nM30\n", "arcs are not read"),
        ("N30 G93 G1 X1.0 X2.0 F2.0\nM30\n", "line 3: word `X2.0`: this letter is twice"),
        ("N30 G0 X1.0\nM30\n", "rapid travel"),
        ("N30 G93 G1 X1.0 F2.0\n", "without M30"),
    ] {
        let outcome = read(&format!("{start}{body}"));
        match outcome {
            Ok(program) => assert!(words.is_empty() && program.knots.len() == 2, "{body}"),
            Err(why) => assert!(!words.is_empty() && why.contains(words), "{body}: {why}"),
        }
    }
}
