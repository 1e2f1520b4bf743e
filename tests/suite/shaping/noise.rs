//! What axes do at random comes out on flanks as worked out by hand.
//!
//! Where noise is small against facets, the place at which a stroke touches the target is left by that stroke alone:
//! its neighbours stand off there by four times the height of the ridge between them. On a round gear the normal at a
//! contact lies along the line of action wherever the contact is, so that a centre distance too large by a leaves
//! h = a sin(alpha), and a work angle too large by delta h = s r cos(alpha) delta. Both hold ray for ray, and so the
//! variance of the heights is that of the axis times sin^2(alpha) or (r cos(alpha))^2.

use super::machine_errors::{ALPHA_RAD, ARCSEC_RAD, PITCH_MM, ROUND, job};
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::Layer;
use gearcut::process::shaping::ShapingJob;
use gearcut::random::Draws;
use gearcut::terms::Side;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::Path;

const STROKES: f64 = 10_000.0;
const FINE: &str = "operation.finish.strokes_per_revolution=10000";

/// Strokes that touch a flank in its middle part, and where along it.
pub(super) fn contacts(job: &ShapingJob, tooth: u32, side: Side) -> Vec<(f64, i64)> {
    let flank = job.target_flank(tooth, side);
    let linkage = &job.finishing().linkage;
    let stroke = |arc_mm: f64| linkage.axes(flank.at_arc(arc_mm).phi_rad, 0.0).psi_c_rad.value() / TAU * STROKES;
    let ends = [0.15, 0.85].map(|share| share * flank.length_mm());
    let [from, to] = ends.map(stroke);
    let mut found: Vec<(f64, i64)> = (from.min(to).ceil() as i64..=from.max(to).floor() as i64)
        .map(|wanted| {
            let [mut low, mut high] = ends;
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (stroke(middle) < wanted as f64) == (from < to) { low = middle } else { high = middle }
            }
            (low, wanted)
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

fn heights(job: &ShapingJob, sound: &ShapingJob, tooth: u32, side: Side, arcs_mm: &[f64]) -> Vec<f64> {
    let field = sound.field_over(sound.target_flank(tooth, side), arcs_mm.iter().copied(), vec![0.0]);
    let layers = job.cut(&Cpu::default(), field).expect("native").layers;
    layers[0].heights_mm.iter().map(|&height| f64::from(height)).collect()
}

/// Where strokes touch the flanks of a side: tooth, arcs, strokes.
type Touched = Vec<(u32, Vec<f64>, Vec<i64>)>;

/// All flanks of a side of a gear without noise.
fn touched(sound: &ShapingJob, side: Side) -> Touched {
    let of_tooth = |tooth| {
        let (arcs_mm, strokes) = contacts(sound, tooth, side).into_iter().unzip();
        (tooth, arcs_mm, strokes)
    };
    (1..=24).map(of_tooth).collect()
}

/// Heights and what is expected of them, on all flanks of a side.
fn pairs(
    [sound, noisy]: [&ShapingJob; 2],
    (side, touched): (Side, &Touched),
    expected: impl Fn(i64) -> f64,
) -> Vec<[f64; 2]> {
    let mut pairs = Vec::new();
    for (tooth, arcs_mm, strokes) in touched {
        for (height, stroke) in heights(noisy, sound, *tooth, side, arcs_mm).into_iter().zip(strokes) {
            pairs.push([height, expected(stroke.rem_euclid(STROKES as i64))]);
        }
    }
    pairs
}

fn variance(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    values.map(|value| (value - mean).powi(2)).sum::<f64>() / count
}

/// Seeds whose gears are taken together. Of n independent numbers the variance scatters by sqrt(2 / n); three times
/// that is 1 % of 180,000. Strokes that touch two flanks of a side count once: 10,000 of each gear.
const SEEDS: u32 = 20;

#[test]
fn white_noise_of_an_axis_is_found_on_the_flank_stroke_by_stroke() {
    // Half a nanometre of the centre distance; as much on the pitch circle from the work spindle. Ridges are higher.
    let (distance_mm, work_arcsec) = (5e-7, 5e-7 / PITCH_MM / ARCSEC_RAD);
    let distance = format!("machine.errors.center_distance.noise_um={}", 1e3 * distance_mm);
    let work = format!("machine.errors.work.noise_arcsec={work_arcsec}");
    let sound = job(ROUND, &[FINE]);
    let [left, right] = [Side::Left, Side::Right].map(|side| touched(&sound, side));
    let noisy = |setting: &str| -> Vec<ShapingJob> {
        let seeds = (1..=SEEDS).map(|seed| format!("machine.errors.seed={seed}"));
        seeds.map(|seed| job(ROUND, &[FINE, &seed, setting])).collect()
    };
    let [distance, work] = [&distance, &work].map(|setting| noisy(setting));
    for (name, noisy, axis, gain, side, touched) in [
        ("centre distance", &distance, 2, ALPHA_RAD.sin(), Side::Left, &left),
        ("work spindle, left flanks", &work, 0, ALPHA_RAD.cos(), Side::Left, &left),
        ("work spindle, right flanks", &work, 0, -ALPHA_RAD.cos(), Side::Right, &right),
    ] {
        let pairs: Vec<[f64; 2]> = (1..=SEEDS)
            .zip(noisy)
            .flat_map(|(seed, noisy)| {
                let number = |stroke: i64| Draws::new(seed, axis).normal([stroke, 0]);
                pairs([&sound, noisy], (side, touched), |stroke| gain * distance_mm * number(stroke))
            })
            .collect();
        let strokes: BTreeSet<i64> = touched.iter().flat_map(|(.., strokes)| strokes).copied().collect();
        assert!(SEEDS as usize * strokes.len() > 180_000, "{} strokes of a gear", strokes.len());
        let found = variance(pairs.iter().map(|pair| pair[0]));
        let of_draws = variance(pairs.iter().map(|pair| pair[1]));
        let by_hand = (gain * distance_mm).powi(2);
        let worst = pairs.iter().map(|[height, expected]| (height - expected).abs()).fold(0.0, f64::max);
        println!(
            "{name}: {} contacts, variance {:.5} of that by hand, {:.5} of that of the drawn strokes, worst {:.2e} \
            mm",
            pairs.len(),
            found / by_hand,
            found / of_draws,
            worst
        );
        assert!((found / of_draws - 1.0).abs() < 0.01, "{name}");
        assert!((found / by_hand - 1.0).abs() < 0.01, "{name}");
        // Planted: a deviation that is 1.5 % larger.
        assert!((found / by_hand / 1.015_f64.powi(2) - 1.0).abs() > 0.01, "{name}");
    }
}

fn layers(settings: &[&str], threads: usize) -> Vec<Layer> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let job = job(ROUND, settings);
        job.cut(&Cpu::default(), job.flank_field(job.target_flank(5, Side::Right))).expect("native").layers
    })
}

#[test]
fn equal_seeds_make_equal_bytes_and_other_seeds_other_surfaces() {
    let noise = [
        "operation.finish.feed_during_stroke=true",
        "operation.finish.strokes_per_revolution=700",
        "fields.flank.lead_spacing_um=4000",
        "machine.errors.work.noise_arcsec=5",
        "machine.errors.cutter.noise_arcsec=3",
        "machine.errors.cutter.noise_bandwidth_hz=2",
    ];
    let with = |seed: &'static str| [&noise[..], &[seed]].concat();
    let first = layers(&with("machine.errors.seed=1"), 1);
    assert!(first == layers(&with("machine.errors.seed=1"), 2));
    assert!(first != layers(&with("machine.errors.seed=2"), 2));
}

#[test]
fn scatter_of_stock_stands_on_the_flank_and_in_the_chip() {
    let rough = "
    [[operation]]
    name = \"rough\"
    strokes_per_revolution = 10000
    stock_per_flank_mm = 0.2
    stock_scatter_um = 0.002
    feed_during_stroke = false
    [[operation]]";
    let scene = |scatter: &str| ROUND.replacen("[[operation]]", &rough.replace("0.002", scatter), 1);
    let (even, scattered) = (job(&scene("0"), &[FINE]), job(&scene("0.002"), &[FINE]));
    let stock = |job: &ShapingJob| {
        let tooth = 5;
        // Above the fillet that roughing leaves.
        let least_mm = 0.45 * even.target_flank(tooth, Side::Left).length_mm();
        let arcs_mm: Vec<f64> = contacts(&even, tooth, Side::Left).into_iter().map(|(arc_mm, _)| arc_mm).collect();
        let arcs_mm: Vec<f64> = arcs_mm.into_iter().filter(|&arc_mm| arc_mm > least_mm).collect();
        let field = even.field_over(even.target_flank(tooth, Side::Left), arcs_mm.iter().copied(), vec![0.0]);
        let layers = job.cut(&Cpu::default(), field).expect("native").layers;
        let thickness = layers[0].heights_mm.iter().zip(&layers[1].heights_mm);
        thickness.map(|(rough, fine)| f64::from(rough - fine)).collect::<Vec<f64>>()
    };
    let distance_mm = 66.0 + even.operations[0].spec.offset_mm;
    let (even, scattered) = (stock(&even), stock(&scattered));
    let changes: Vec<f64> = even.iter().zip(&scattered).map(|(even, scattered)| scattered - even).collect();
    let mean = even.iter().sum::<f64>() / even.len() as f64;
    println!(
        "{} places, stock {mean:.5} mm, variance {:.3} of that by hand",
        changes.len(),
        variance(changes.iter().copied()) / 4e-12
    );
    // Involutes at a distance of a' instead of a = 66 mm, the teeth turned as before: half the backlash of a pair.
    let inv = |angle: f64| angle.tan() - angle;
    let working = (66.0 * ALPHA_RAD.cos() / distance_mm).acos();
    let by_hand_mm = 66.0 * ALPHA_RAD.cos() * (inv(working) - inv(ALPHA_RAD));
    assert!((by_hand_mm - 0.2).abs() < 1e-9, "{by_hand_mm} mm at {distance_mm} mm");
    assert!((mean - by_hand_mm).abs() < 2e-5, "stock of {mean} mm for {by_hand_mm}");
    // The radial shift acts at the working pressure angle. Of 300 strokes: sqrt(2 / 300) = 8 %, three times that.
    let gain = (working.sin() / ALPHA_RAD.sin()).powi(2);
    assert!(changes.len() > 200 && (variance(changes.iter().copied()) / 4e-12 / gain - 1.0).abs() < 0.25);
}

#[test]
fn noise_that_means_nothing_is_refused() {
    const HOB: &str = "
        [gear]
        module_mm = 3.0
        teeth = 24
        face_width_mm = 20.0
        [tool.hob]
        reference_diameter_mm = 80.0
        gashes = 12
        [[operation]]
        name = \"finish\"
        hob_speed_per_minute = 200.0
        axial_feed_mm_per_revolution = 2.0
    ";
    for (scene, setting, why) in [
        (ROUND, "machine.errors.work.noise_arcsec=-1", "0 to 3600"),
        (ROUND, "machine.errors.work.noise_arcsec=nan", "0 to 3600"),
        (ROUND, "machine.errors.center_distance.noise_um=1e9", "0 to 1000"),
        (ROUND, "machine.errors.center_distance.noise_bandwidth_hz=0", "0.000001 to 1000000"),
        (ROUND, "machine.errors.center_distance.noise_bandwidth_hz=1", "says nothing without noise_um"),
        (ROUND, "machine.errors.seed=-1", "whole number, 0 to 4294967295"),
        (ROUND, "machine.errors.seed=0.5", "whole number"),
        (ROUND, "operation.finish.stock_scatter_um=-1", "0 to 1000"),
        (ROUND, "operation.finish.stock_scatter_length_mm=5", "says nothing without stock_scatter_um"),
        (ROUND, "tool.shaper_cutter.edge_roughness.rq_um=1", "says nothing without correlation_length_um"),
        (ROUND, "tool.shaper_cutter.edge_roughness.correlation_length_um=1", "3 to 1000"),
        (HOB, "machine.errors.work.noise_arcsec=1", "a hob is in the work all the time"),
        (HOB, "tool.shaper_cutter.edge_roughness.rq_um=1", "tool"),
    ] {
        let read = gearcut::process::parse(scene, "scene.toml", Path::new(""), &[setting.to_owned()]);
        let said = read.map_or_else(|errors| errors.to_string(), |_| String::new());
        assert!(said.contains(why), "{setting}: {said}");
    }
}
