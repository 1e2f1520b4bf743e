//! How long rolling takes, and how it grows with the positions: the third-order pair with cut flanks.
//!
//! `cargo run --release --example pair_speed [scene] [teeth of the mate]`

use gearcut::cut::cpu::Cpu;
use gearcut::gear::GearKind;
use gearcut::interrupt::Interrupt;
use gearcut::pair::rolling::roll;
use gearcut::pair_job::fit::Fit;
use gearcut::pair_job::flanks::{PairFlanks, made_ready};
use gearcut::pair_job::member;
use gearcut::pair_job::options::PairOptions;
use gearcut::pair_job::watch::Watch;
use gearcut::progress::{Progress, ProgressMode};
use gearcut::scene::Mate;
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "scenes/shaping/elliptical_normal.toml".to_owned());
    let teeth = arguments.next().map_or(Ok(42), |teeth| teeth.parse())?;
    let a = member::read(Path::new(&scene), &[])?;
    let b = member::mate(&a, Mate { teeth, kind: GearKind::External }, &[])?;
    let (scenes, options) = ([&a.scene, &b.scene], PairOptions::default());
    let gears = [&a.scene.gear, &b.scene.gear];
    let started = Instant::now();
    let fit = Fit::new(scenes[0], scenes[1], 0)?;
    let (progress, interrupt) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    let watch = Watch::new(&progress, &interrupt);
    let ready = made_ready(scenes, options.source)?;
    let flanks = PairFlanks::new(&fit, scenes, ready.as_ref(), 1, &Cpu::default(), &watch)?;
    println!("flanks cut in {:.2} s", started.elapsed().as_secs_f64());
    let meshing = flanks.meshing(&fit, gears[0], &options.mounting(&fit, gears)?);
    for positions in [500, 1000, 2000, 4000] {
        let started = Instant::now();
        let period = roll(&meshing, positions, || Ok(()))?;
        let seconds = started.elapsed().as_secs_f64();
        println!(
            "{} positions in {seconds:.2} s: {:.3} ms each",
            period.moments.len(),
            1e3 * seconds / positions as f64
        );
    }
    Ok(())
}
