//! Stock is judged on the active flank; where the earlier operation's fillet stands, it is told apart.

use gearcut::cut::cpu::Cpu;
use gearcut::interrupt::Interrupt;
use gearcut::process::load;
use gearcut::process::shaping::{ShapingJob, cut_gear};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::steps::parts::Stages;
use gearcut::texture::windows;
use std::path::Path;

const ROUND: &str = "scenes/shaping/circular_m3_z24.toml";
const COARSE: [&str; 3] =
    ["fields.flank.profile_spacing_um=50", "fields.flank.lead_spacing_um=5000", "fields.chips.spacing_mm=0.5"];

fn job(more: &[&str]) -> ShapingJob {
    let settings: Vec<String> = COARSE.iter().chain(more).map(|&setting| setting.to_owned()).collect();
    let scene = load(Path::new(ROUND), &settings).unwrap_or_else(|problems| panic!("{problems}"));
    ShapingJob::new(scene.scene).expect("a gear")
}

/// A round gear roughed d off has involutes of the same base circle, so that its stock is the same everywhere:
/// a cos(alpha) (inv alpha' - inv alpha) with the centre distance a and cos(alpha') = a cos(alpha) / (a + d). The
/// roughing's fillet leaves a multiple of that at the foot of the flanks.
#[test]
fn the_fillet_of_roughing_rules_no_stock() {
    const OFFSET_MM: f64 = 2.0;
    let job = job(&["operation.rough.offset_mm=2.0"]);
    let progress = Progress::new(ProgressMode::Quiet);
    let gear = cut_gear(&job, Stages::ALL, &Cpu::default(), (&progress, &Interrupt::default()), None).expect("a gear");
    let alpha = job.scene.gear.pressure_angle_rad;
    let center_mm = job.curve.perimeter_mm() / std::f64::consts::TAU + job.cutter.pitch_radius_mm;
    let working = (center_mm * alpha.cos() / (center_mm + OFFSET_MM)).acos();
    let involute = |angle: f64| angle.tan() - angle;
    let even_mm = center_mm * alpha.cos() * (involute(working) - involute(alpha));
    for flank in &gear.report.flanks {
        let active = flank.own.stock[0].expect("stock");
        for value_mm in [active.smallest.value_mm, active.largest.value_mm] {
            assert!((value_mm / even_mm - 1.0).abs() < 0.01, "{value_mm} mm, {even_mm} mm by the closed form");
        }
        let fillet = flank.own.fillet_stock[0].expect("stock in the fillet");
        assert!(fillet.largest.value_mm > 1.5 * even_mm, "{fillet:?}");
        assert!(fillet.largest.arc_mm < active.smallest.arc_mm.min(active.largest.arc_mm));
    }
}

/// Windows show the finished surface, asked for or not, and roughing alone where they name it.
#[test]
fn texture_of_roughing_is_evaluated_where_it_is_asked_for() {
    let operations = |more: &[&str]| {
        let windows = windows(&job(more)).expect("windows");
        windows.iter().map(|window| window.operation).collect::<Vec<_>>()
    };
    assert!(operations(&[]).iter().all(|&operation| operation == 1));
    assert_eq!(operations(&["texture=[{tooth=3,side='left'}]"]), [1]);
    assert_eq!(operations(&["texture=[{tooth=3,side='left',operation='rough'},{tooth=3,side='left'}]"]), [0, 1]);
    let refused = windows(&job(&["texture=[{tooth=3,operation='grind'}]"])).expect_err("no such operation").to_string();
    assert!(refused.contains("texture[0].operation") && refused.contains(r#""rough", "finish""#), "{refused}");
    let job = job(&["texture=[{tooth=3,side='left',operation='rough'},{tooth=3,side='left'}]"]);
    let height_um = |index: usize| {
        let window = &windows(&job).expect("windows")[index];
        let texture = gearcut::texture::cut_window(&job, &Cpu::default(), window).expect("cut");
        let heights = texture.heights.expect("a surface");
        heights.heights_um().iter().sum::<f64>() / heights.heights_um().len() as f64
    };
    let [rough, finish] = [0, 1].map(height_um);
    assert!(rough > 100.0 && finish.abs() < 1.0, "roughing leaves stock: {rough} um, {finish} um");
}
