//! Pits and scratches of a built-up edge on flanks: their numbers against Campbell's theorem, the ram's speed and the
//! chips; the same marks on any grid, in any order, on any number of threads.

use super::machine_errors::{ROUND, job};
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Layer;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::cut::chips::last_chips;
use gearcut::process::shaping::sections::GearPart;
use gearcut::terms::Side;
use std::f64::consts::PI;
use std::path::Path;

const SECTION: &str = "tool.shaper_cutter.built_up_edge";
/// Marks that are dense at all speeds and behind all chips: lambda_0 = 25 /mm2, 2 um deep, 0.06 mm wide, a half of them
/// 0.3 mm long, all in the mean.
const EVERYWHERE: [&str; 9] = [
    "density_per_mm2=25",
    "speeds_m_per_min=[0, 1000]",
    "full_speeds_m_per_min=[0, 1000]",
    "chip_um=1",
    "chip_exponent=0",
    "depth_um=2",
    "width_um=60",
    "scratch_share=0.5",
    "scratch_length_um=300",
];
const FEW: [&str; 1] = ["operation.finish.strokes_per_revolution=480"];

/// The round gear with a built-up edge: the marks above, some of their keys otherwise, and other settings.
fn torn(keys: &[&str], settings: &[&str]) -> ShapingJob {
    let with = |key: &&str| format!("{SECTION}.{key}");
    let own: Vec<String> = EVERYWHERE.iter().chain(keys).map(with).collect();
    job(ROUND, &[&FEW, settings, &own.iter().map(String::as_str).collect::<Vec<_>>()].concat())
}

/// What all operations leave on a part of a flank.
fn layers(job: &ShapingJob, (tooth, side): (u32, Side), arcs_mm: &[f64], rows_mm: &[f64]) -> Vec<Layer> {
    let field = job.field_over(job.target_flank(tooth, side), arcs_mm.iter().copied(), rows_mm.to_vec());
    job.cut_on(&Cpu::default(), GearPart::Flank(tooth, side), field).expect("native").layers
}

/// Places `step` apart.
fn places(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as usize).map(|i| from + step * i as f64).collect()
}

/// Depths of marks, um, flank by flank: teeth and sides, and of each places column by column.
fn depths_um(torn: &ShapingJob, teeth: u32, arcs_mm: &[f64], rows_mm: &[f64]) -> Vec<Vec<f64>> {
    let smooth = job(ROUND, &FEW);
    let flanks = (1..=teeth).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]);
    let of = |flank: (u32, Side)| -> Vec<f64> {
        let [torn, smooth] = [torn, &smooth].map(|job| layers(job, flank, arcs_mm, rows_mm).remove(0).heights_mm);
        smooth.iter().zip(&torn).map(|(smooth, torn)| 1e3 * (f64::from(*smooth) - f64::from(*torn))).collect()
    };
    flanks.map(of).collect()
}

/// Mean of flanks, which are independent, and its standard error.
fn mean_and_error(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let square = values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    [mean, (square / count).sqrt()]
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().sum::<f64>() / values.count() as f64
}

/// pi E(a) E(b), mm2.
const AREA_MM2: f64 = PI * 0.03 * (0.5 * 0.15 + 0.5 * 0.03);

#[test]
fn flanks_are_lowered_as_campbell_has_it() {
    let depths = depths_um(&torn(&[], &[]), 24, &places(0.5, 4.5, 0.05), &places(-8.0, 8.0, 0.1));
    // lambda E(d) pi a b / 2 and lambda E(d^2) pi a b / 3.
    let (lowered_um, variance_um2) = (25.0 * 2.0 * AREA_MM2 / 2.0, 25.0 * 8.0 * AREA_MM2 / 3.0);
    let means = depths.iter().map(|flank| mean(flank.iter().copied()));
    let squares = depths.iter().map(|flank| mean(flank.iter().map(|depth| (depth - lowered_um).powi(2))));
    for (what, [found, error], expected) in
        [("mean", mean_and_error(means), lowered_um), ("variance", mean_and_error(squares), variance_um2)]
    {
        println!("{what}: {found:.5}, by Campbell {expected:.5}, standard error {error:.5}");
        assert!(error < 0.02 * expected && (found - expected).abs() < 3.5 * error, "{what}");
    }
}

/// Stroke of 27 mm, its middle 1.5 mm above that of the face, 300 a minute: v = 424 mm/s sqrt(1 - ((z - 1.5) /
/// 13.5)^2).
fn speed_m_per_min(z_mm: f64) -> f64 {
    0.06 * PI * 27.0 * 5.0 * (1.0 - ((z_mm - 1.5) / 13.5).powi(2)).max(0.0).sqrt()
}

#[test]
fn marks_are_as_dense_as_the_speed_of_the_ram_allows() {
    // Densest from 22 m/min on, none below 20: the ends of the face are free of them.
    let keys = ["speeds_m_per_min=[20, 200]", "full_speeds_m_per_min=[22, 200]"];
    let settings = ["machine.approach_mm=5", "machine.overrun_mm=2"];
    let rows_mm = places(-10.0, 10.0, 0.1);
    let depths = depths_um(&torn(&keys, &settings), 12, &places(0.5, 4.5, 0.05), &rows_mm);
    let share = |z_mm: f64| ((speed_m_per_min(z_mm) - 20.0) / 2.0).clamp(0.0, 1.0);
    // A mark covers places up to 0.3 mm away; weighted with its shape, the mean share there is that of its middle, as
    // far
    // as the share runs straight.
    let (mut bands, mut free) = (0, 0);
    for band in rows_mm.chunks(10) {
        let [low_mm, high_mm] = [band[0], band[band.len() - 1]];
        let rows: Vec<usize> = (0..rows_mm.len()).filter(|&row| (low_mm..=high_mm).contains(&rows_mm[row])).collect();
        let of_flank = |flank: &Vec<f64>| {
            let in_rows = flank.chunks(rows_mm.len()).flat_map(|column| rows.iter().map(|&row| column[row]));
            mean(in_rows.collect::<Vec<_>>().into_iter())
        };
        let [found, error] = mean_and_error(depths.iter().map(of_flank).collect::<Vec<_>>().into_iter());
        if [low_mm - 0.3, high_mm + 0.3].map(speed_m_per_min).iter().all(|&speed| speed < 20.0) {
            free += 1;
            assert_eq!(found, 0.0, "{low_mm} mm");
            continue;
        }
        let expected = 25.0 * 2.0 * AREA_MM2 / 2.0 * mean(band.iter().map(|&z_mm| share(z_mm)));
        println!("{low_mm:.1} to {high_mm:.1} mm: {found:.4} um, expected {expected:.4}, standard error {error:.4}");
        // The bends of the share smear over 0.3 mm: a hundredth of the densest.
        assert!((found - expected).abs() < 4.0 * error + 0.004, "{low_mm} mm");
        bands += 1;
    }
    assert!(bands > 10 && free > 1, "{bands} bands, {free} free");
}

#[test]
fn marks_are_as_dense_as_the_chips_allow() {
    let arcs_mm = places(0.5, 4.5, 0.01);
    for (keys, share) in [
        (["chip_exponent=1", "chip_um=5"], (|h: f64| (h / 5.0).min(1.0)) as fn(f64) -> f64),
        (["chip_exponent=-2", "chip_um=1"], |h: f64| h.recip().powi(2).min(1.0)),
    ] {
        let torn = torn(&keys, &[]);
        // Twenty strokes to a tooth: all teeth are alike, and left and right flanks are not.
        let thickness_um = [Side::Left, Side::Right].map(|side| -> Vec<f64> {
            let field = torn.field_over(torn.target_flank(1, side), arcs_mm.iter().copied(), vec![0.0]);
            last_chips(&torn, &field)[0].thickness_mm.iter().map(|&h| 1e3 * f64::from(h)).collect()
        });
        let of_chips = mean(thickness_um.concat().iter().map(|&h| share(h)));
        assert!((0.05..0.9).contains(&of_chips), "a share that says something: {of_chips}");
        let flat = places(0.5, 4.5, 0.05);
        let depths = depths_um(&torn, 16, &flat, &places(-8.0, 8.0, 0.1));
        let [found, error] = mean_and_error(depths.iter().map(|flank| mean(flank.iter().copied())));
        let expected = 25.0 * 2.0 * AREA_MM2 / 2.0 * of_chips;
        println!("{keys:?}: {found:.4} um, expected {expected:.4}, standard error {error:.4}");
        assert!(error < 0.05 * expected && (found - expected).abs() < 4.0 * error, "{keys:?}");
    }
}

/// Places of two grids that have some of them in common, in another order.
#[test]
fn marks_are_the_same_on_every_grid() {
    let keys = ["density_per_mm2=100", "chip_exponent=1", "chip_um=3"];
    let torn = torn(&keys, &["operation.finish.feed_during_stroke=true"]);
    let flank = (7, Side::Right);
    let (arcs_mm, rows_mm) = (places(1.0, 3.0, 0.02), places(-2.0, 2.0, 0.05));
    let few_arcs_mm: Vec<f64> = arcs_mm.iter().copied().skip(40).step_by(5).rev().collect();
    let few_rows_mm: Vec<f64> = rows_mm.iter().copied().skip(7).step_by(11).collect();
    let [all, few] = [(&arcs_mm, &rows_mm), (&few_arcs_mm, &few_rows_mm)]
        .map(|(arcs_mm, rows_mm)| layers(&torn, flank, arcs_mm, rows_mm).remove(0).heights_mm);
    let smooth = layers(&job(ROUND, &["operation.finish.feed_during_stroke=true", FEW[0]]), flank, &arcs_mm, &rows_mm);
    let (mut compared, mut lower) = (0, 0);
    for (column, arc_mm) in few_arcs_mm.iter().enumerate() {
        for (row, z_mm) in few_rows_mm.iter().enumerate() {
            let [c, r] = [(&arcs_mm, arc_mm), (&rows_mm, z_mm)]
                .map(|(places, place)| places.iter().position(|other| other == place).expect("in both"));
            let at = c * rows_mm.len() + r;
            // The kernel's heights differ in their last bits where rays lie in other tiles.
            let apart_mm = all[at] - few[column * few_rows_mm.len() + row];
            assert!(apart_mm.abs() < 1e-9, "{apart_mm} at {arc_mm} {z_mm}");
            compared += 1;
            lower += usize::from(all[at] < smooth[0].heights_mm[at] - 1e-6);
        }
    }
    assert!(compared == 13 * 7 && lower > 15, "{compared} places, {lower} of them in marks");
}

#[test]
fn without_marks_no_byte_changes() {
    let (arcs_mm, rows_mm) = (places(0.5, 4.5, 0.1), places(-10.0, 10.0, 0.5));
    let flank = (3, Side::Left);
    let smooth = layers(&job(ROUND, &FEW), flank, &arcs_mm, &rows_mm);
    let too_fast = torn(&["speeds_m_per_min=[30, 200]", "full_speeds_m_per_min=[40, 50]"], &[]);
    assert!(layers(&too_fast, flank, &arcs_mm, &rows_mm) == smooth);
    assert!(layers(&torn(&[], &[]), flank, &arcs_mm, &rows_mm) != smooth);
    let plain = job(ROUND, &FEW);
    let field = plain.field_over(plain.target_flank(3, Side::Left), arcs_mm.into_iter(), rows_mm);
    assert!(plain.cut(&Cpu::default(), field).expect("native").layers == smooth);
}

#[test]
fn equal_seeds_make_equal_bytes_on_any_number_of_threads() {
    let on = |threads: usize, seed: &str| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let rounding = ["tool.shaper_cutter.edge_rounding.radius_um=4", "machine.errors.center_distance.noise_um=1"];
        let share = "tool.shaper_cutter.edge_rounding.minimum_chip_share=0.25";
        let settings = [&rounding[..], &[share, seed]].concat();
        let job = torn(&["chip_exponent=1", "chip_um=3"], &settings);
        pool.install(|| layers(&job, (5, Side::Right), &places(0.5, 4.5, 0.05), &places(-9.0, 9.0, 0.2)))
    };
    let first = on(1, "machine.errors.seed=1");
    assert!(first == on(2, "machine.errors.seed=1"));
    assert!(first != on(2, "machine.errors.seed=2"));
}

/// Finishing takes away what roughing tore, but where it does not come the marks of roughing stay.
#[test]
fn marks_stay_until_a_later_operation_cuts() {
    let text = ROUND.replace(
        "[[operation]]",
        "[[operation]]
        name = \"rough\"
        stock_per_flank_mm = 0.1
        strokes_per_revolution = 360
        [operation.infeed.none]
        [[operation]]
        window_deg = [0.0, 120.0]",
    );
    let own: Vec<String> = EVERYWHERE.iter().map(|key| format!("{SECTION}.{key}")).collect();
    let torn = job(&text, &[&FEW[..], &own.iter().map(String::as_str).collect::<Vec<_>>()].concat());
    let smooth = job(&text, &FEW);
    let (arcs_mm, rows_mm) = (places(1.0, 4.0, 0.1), places(-5.0, 5.0, 0.1));
    let depths = |flank: (u32, Side)| {
        let [torn, smooth] = [&torn, &smooth].map(|job| layers(job, flank, &arcs_mm, &rows_mm));
        [0, 1].map(|operation| -> Vec<f32> {
            let pairs = smooth[operation].heights_mm.iter().zip(&torn[operation].heights_mm);
            pairs.map(|(smooth, torn)| smooth - torn).collect()
        })
    };
    let in_marks = |depths: &[f32]| depths.iter().filter(|&&depth| depth > 1e-6).count();
    // Teeth 3 and 20 stand at 45 and 300 deg.
    let [rough, finished] = depths((3, Side::Left));
    assert!(in_marks(&rough) > 300 && in_marks(&finished) > 300, "{} {}", in_marks(&rough), in_marks(&finished));
    let both = rough.iter().zip(&finished).filter(|(a, b)| **a > 1e-6 && **b > 1e-6).count();
    // Independent: the share that both cover is the product of theirs.
    let alone = in_marks(&rough) as f64 / rough.len() as f64;
    assert!((both as f64) < 2.0 * alone * in_marks(&finished) as f64, "{both}");
    let [rough, finished] = depths((20, Side::Left));
    assert!(in_marks(&rough) > 300 && rough == finished);
}

#[test]
fn a_built_up_edge_that_means_nothing_is_refused() {
    for (changed, why) in [
        ("density_per_mm2=0", "0 to 1000"),
        ("depth_um=nan", "0 to 100"),
        ("speeds_m_per_min=[30, 30]", "have no width"),
        ("speeds_m_per_min=[1, 2, 3]", "2 numbers"),
        ("full_speeds_m_per_min=[60, 50]", "do not lie in order"),
        ("full_speeds_m_per_min=[50, 1001]", "0 to 1000"),
        ("scratch_share=1.5", "0 to 1"),
        ("chip_exponent=5", "-4 to 4"),
        ("depth=2", "depth_um"),
    ] {
        let said = said(EVERYWHERE.iter().copied().chain([changed]));
        assert!(said.contains(why), "{changed}: {said}");
    }
    for missing in EVERYWHERE {
        let said = said(EVERYWHERE.iter().copied().filter(|key| *key != missing));
        let name = missing.split('=').next().expect("a name");
        assert!(said.contains(&format!("says nothing without {name}")), "{name}: {said}");
    }
}

/// What is said of a scene with these keys.
fn said<'a>(keys: impl Iterator<Item = &'a str>) -> String {
    let settings: Vec<String> = keys.map(|key| format!("{SECTION}.{key}")).collect();
    let read = gearcut::process::parse(ROUND, "scene.toml", Path::new(""), &settings);
    read.map_or_else(|errors| errors.to_string(), |_| String::new())
}
