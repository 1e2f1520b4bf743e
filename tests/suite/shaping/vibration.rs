//! A cutter that vibrates: what it leaves on flanks against the displacements of its strokes, a mass that cannot keep
//! still against the deflection, waves beyond the limit of stability, and masses that are refused. The limit itself is
//! compared with its closed form beside the law.

use super::deflection::{ROUND, with};
use super::machine_errors::job;
use gearcut::cut::cpu::Cpu;
use gearcut::machine_errors::Deflection;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::chips::as_cut;
use gearcut::process::shaping::findings::deflection::chatter;
use gearcut::terms::Side;
use glam::DVec2;

/// The mass on the tangential spring.
fn mass(hz: f64, damping_ratio: f64, um_per_kn: f64) -> Vec<String> {
    vec![
        "machine.vibration.coordinate=\"tangential\"".to_owned(),
        format!("machine.vibration.natural_frequency_hz={hz}"),
        format!("machine.vibration.damping_ratio={damping_ratio}"),
        format!("machine.compliance.tool_tangential_um_per_kn={um_per_kn}"),
    ]
}

/// The gear deflected alone, and as it is cut.
fn both(settings: &[String], more: &[&str]) -> [ShapingJob; 2] {
    let settings: Vec<&str> = with(&settings.iter().map(String::as_str).collect::<Vec<_>>(), more);
    let cut = |settings: &[&str]| as_cut(&job(ROUND, settings), &|| true).expect("it settles").expect("not stopped");
    let spring: Vec<&str> = settings.iter().copied().filter(|key| !key.starts_with("machine.vibration")).collect();
    [cut(&spring), cut(&settings)]
}

/// Largest root mean square over the face of all strokes, um; share of the strokes beyond the limit.
fn largest(job: &ShapingJob) -> (f64, f64) {
    let strokes = &job.operations[0].vibration.as_ref().expect("it vibrates").strokes;
    let rms = strokes.iter().map(|of| 1e3 * of.rms).fold(0.0, f64::max);
    (rms, strokes.iter().filter(|of| of.share_of_limit > 1.0).count() as f64 / strokes.len() as f64)
}

/// A place that the same stroke leaves with and without vibration differs by what the stroke is displaced there along
/// the flank's normal.
#[test]
fn flanks_follow_the_vibration_of_their_strokes_row_by_row() {
    let [still, shaken] = both(&mass(90.0, 0.08, 8.0), &["fields.chips.spacing_mm=0.1"]);
    let (of_still, of_shaken) = (&still.operations[0], &shaken.operations[0]);
    let vibration = of_shaken.vibration.as_ref().expect("it vibrates");
    let rows_z_mm = vec![9.5, 4.0, 1.0, -3.5, -9.0];
    // Heights found, those expected there, and those expected 3 mm further along the tooth.
    let mut found: Vec<[f64; 3]> = Vec::new();
    let mut seen = 0;
    for (tooth, side) in [(9, Side::Right), (12, Side::Left), (15, Side::Left), (21, Side::Right)] {
        let flank = still.target_flank(tooth, side);
        let arcs: Vec<f64> = (1..20).map(|i| 0.05 * f64::from(i) * flank.length_mm()).collect();
        let cut = |job: &ShapingJob| {
            let field = still.field_over(flank, arcs.iter().copied(), rows_z_mm.clone());
            job.cut(&Cpu::default(), field).expect("native").layers.pop().expect("an operation")
        };
        let [a, b] = [cut(&still), cut(&shaken)];
        for (column, &arc_mm) in arcs.iter().enumerate() {
            for (row, &z_mm) in rows_z_mm.iter().enumerate() {
                let (place, contact) = (column * rows_z_mm.len() + row, flank.at_arc(arc_mm));
                seen += 1;
                if a.passes[place] != b.passes[place] || a.heights_mm[place].abs() > 0.05 {
                    // Another stroke, or stock that this gear keeps.
                    continue;
                }
                let (stroke, _) = of_still.strokes.stroke_and_blade(a.passes[place]);
                let axis_mm = still.pose_in_section(of_still, stroke, z_mm).translation_mm;
                let moves = Deflection::moves(contact.point_mm, contact.normal, DVec2::ZERO, axis_mm);
                let expected = |z_mm: f64| moves.dot(vibration.at(stroke, z_mm).coordinates());
                let change = f64::from(b.heights_mm[place]) - f64::from(a.heights_mm[place]);
                found.push([change, expected(z_mm), expected(z_mm - 3.0)]);
            }
        }
    }
    assert!(3 * found.len() > seen, "{} of {seen} places are left by the same stroke", found.len());
    let um = |of: usize| found.iter().map(|found| 1e3 * (found[0] - found[of]).abs()).fold(0.0, f64::max);
    let largest_um = found.iter().map(|found| 1e3 * found[0].abs()).fold(0.0, f64::max);
    println!("{} of {seen} places, up to {largest_um:.3} um, within {:.4} um", found.len(), um(1));
    assert!(largest_um > 0.3 && um(1) < 0.01 * largest_um, "{} of {largest_um} um", um(1));
    // The comparison can fail.
    assert!(um(2) > 0.3 * largest_um, "3 mm further along the tooth: {} um", um(2));
}

/// A quick mass with much damping follows the balance but for the entry; a soft one with little damping cuts beyond the
/// limit of stability and its waves grow.
#[test]
fn waves_grow_beyond_the_limit_and_die_below_it() {
    let coarse = ["fields.chips.spacing_mm=0.1"];
    let [_, calm] = both(&mass(3000.0, 0.7, 4.0), &coarse);
    let vibration = calm.operations[0].vibration.as_ref().expect("it vibrates");
    let (strokes, deflections) = (0..calm.operations[0].count(), &calm.operations[0].deflections);
    let most = |of: &dyn Fn(usize) -> f64| strokes.clone().map(of).fold(0.0, f64::max);
    let deflected_um = most(&|stroke| 1e3 * deflections[stroke].tangential_mm.abs());
    let middle_um = most(&|stroke| 1e3 * vibration.at(stroke, 0.0).tangential_mm.abs());
    let entry_um = most(&|stroke| 1e3 * vibration.at(stroke, 10.0).tangential_mm.abs());
    println!(
        "{deflected_um:.2} um deflected; vibration {entry_um:.2} um at the entry, {middle_um:.6} um in the middle"
    );
    assert!(deflected_um > 2.0 && (entry_um / deflected_um - 1.0).abs() < 1e-3, "the cutter enters undeflected");
    assert!(middle_um < 1e-3 * deflected_um, "{middle_um} um");
    assert_eq!(largest(&calm).1, 0.0, "no stroke beyond the limit");
    let jobs = [0.5, 0.02].map(|ratio| both(&mass(400.0, ratio, 2.0), &coarse)[1].clone());
    let [quiet, loud] = [0, 1].map(|i| largest(&jobs[i]));
    // The run says so, with the strokes and the size.
    let [none, said] = jobs.each_ref().map(chatter);
    let strokes = jobs[1].operations[0].vibration.as_ref().expect("it vibrates").strokes.iter();
    let beyond = format!("operation finish: {} of ", strokes.filter(|of| of.share_of_limit > 1.0).count());
    assert!(none.is_empty() && said.len() == 1 && said[0].text.starts_with(&beyond), "{none:?} {said:?}");
    println!("damping 0.5: {quiet:?}; 0.02: {loud:?}");
    assert!(quiet.1 == 0.0 && loud.1 > 0.1, "{quiet:?} {loud:?}");
    assert!(loud.0 > 2.0 * quiet.0, "{quiet:?} {loud:?}");
}

/// What vibrates by more than a tenth of the module cuts no gear.
#[test]
fn vibrations_of_a_tenth_of_the_module_are_refused() {
    let settings = with(&["fields.chips.spacing_mm=0.1"], &[]);
    let all = mass(2000.0, 1e-3, 60.0);
    let settings = with(&settings, &all.iter().map(String::as_str).collect::<Vec<_>>());
    let refusal = as_cut(&job(ROUND, &settings), &|| true).expect_err("far beyond the limit").to_string();
    assert!(refusal.starts_with("`machine.vibration`: operation finish, stroke "), "{refusal}");
    assert!(refusal.contains("more than a tenth of the module"), "{refusal}");
}
