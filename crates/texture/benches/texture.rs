//! Time of the full texture parameter set of a 2048 x 2048 map, family by family.
//!
//! `cargo bench -p gearcut-texture` prints a table; `tests/interop/run --bench` runs surfalize on the same map in the
//! same run and prints the ratio for every parameter. `-- --json --map FILE` is what it calls: the map goes to FILE as
//! NPY, the times go to standard output as JSON. The best of five rounds counts.

use gearcut_texture::core::Core;
use gearcut_texture::features::Features;
use gearcut_texture::files::{Format, SurfaceFile, write_surface};
use gearcut_texture::height::Heights;
use gearcut_texture::hybrid::{sdq, sdr};
use gearcut_texture::ratio::{MaterialRatio, smc_um, smr_percent};
use gearcut_texture::spatial::{correlation_lengths, ssw_um, std_deg};
use gearcut_texture::{Arguments, Evaluation, Surface};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

const SIDE: usize = 2048;
const ROUNDS: u32 = 5;

/// Feed marks, waves of many lengths and directions, and noise: nothing periodic in the window, hills of all sizes.
fn map() -> Surface {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let waves: Vec<[f64; 4]> = (0..24)
        .map(|_| {
            let (angle, length) = (std::f64::consts::TAU * random(), 20.0 * 20_f64.powf(random()));
            let k = std::f64::consts::TAU / length;
            [k * angle.cos(), k * angle.sin(), std::f64::consts::TAU * random(), 0.002 * length.sqrt()]
        })
        .collect();
    let heights = (0..SIDE * SIDE)
        .map(|i| {
            let (x, y) = ((i % SIDE) as f64, (i / SIDE) as f64);
            let along = (y + 0.03 * x) / 123.4;
            let mark = 0.6 * (along - along.round()).powi(2);
            let rough: f64 = waves.iter().map(|[kx, ky, phase, a]| a * (kx * x + ky * y + phase).cos()).sum();
            mark + rough + 0.004 * (random() - 0.5)
        })
        .collect();
    Surface::new(SIDE, SIDE, 1.0, 1.0, heights).expect("a map")
}

fn best_ms<T>(mut work: impl FnMut() -> T) -> f64 {
    let mut once = || {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..ROUNDS).map(|_| once()).fold(f64::INFINITY, f64::min)
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let surface = map();
    let heights = Heights::of(&surface);
    // Every row is what a parameter of the family costs alone, centring and sorting included.
    let rows = [
        ("height", best_ms(|| Heights::of(&surface))),
        ("gradient", best_ms(|| sdq(&surface))),
        ("area", best_ms(|| sdr(&surface))),
        ("ratio", best_ms(|| smr_percent(&surface, 0.0))),
        ("height at a ratio", best_ms(|| smc_um(&surface, [10.0]))),
        ("heights at two", best_ms(|| smc_um(&surface, [10.0, 80.0]))),
        ("core", best_ms(|| Core::of(&MaterialRatio::of(&surface)))),
        ("volume", best_ms(|| MaterialRatio::of(&surface).material_um(80.0))),
        ("correlation", best_ms(|| correlation_lengths(&surface))),
        ("direction", best_ms(|| std_deg(&surface))),
        ("wavelength", best_ms(|| ssw_um(&surface))),
        ("feature", best_ms(|| Features::of(&surface, heights.sp + heights.sv))),
        ("all", best_ms(|| Evaluation::of(&surface, &Arguments::default()))),
    ];
    if let Some(at) = arguments.iter().position(|a| a == "--map") {
        let file = SurfaceFile { surface, notes: Vec::new() };
        write_surface(Path::new(&arguments[at + 1]), Format::Npy, &file).expect("the map is written");
    }
    if arguments.iter().any(|a| a == "--json") {
        let fields: Vec<String> = rows.iter().map(|(name, ms)| format!("\"{name}\": {ms:.3}")).collect();
        println!("{{{}}}", fields.join(", "));
        return;
    }
    println!("{SIDE} x {SIDE} points, {} threads, best of {ROUNDS}", rayon::current_num_threads());
    for (name, ms) in rows {
        println!("{name:18} {ms:9.1} ms");
    }
}
