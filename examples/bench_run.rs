use gearcut::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let loaded = scene::load(std::path::Path::new(&args[1]), &args[2..]).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1)
    });
    let t = std::time::Instant::now();
    let job = job::Job::new(loaded.scene).unwrap();
    println!("prepare {:?}", t.elapsed());
    let progress = output::progress::Progress::new(output::progress::ProgressMode::Quiet);
    let interrupt = output::interrupt::Interrupt::listen().unwrap();
    let r = run::cut_gear(&job, &cut::cpu::Cpu::default(), &progress, &interrupt, None).unwrap();
    println!(
        "total {:?} elapsed {:?} dexels {} passes {} per dexel {:.2} unconv {}",
        t.elapsed(),
        r.elapsed,
        r.dexels,
        r.stats.dexel_passes,
        r.stats.dexel_passes as f64 / r.dexels as f64,
        r.stats.unconverged
    );
    let mut lo = f64::MAX;
    let mut hi = 0.0f64;
    for f in &r.report.flanks {
        if let Some(Some(s)) = f.stock.first() {
            lo = lo.min(s.smallest.value_mm);
            hi = hi.max(s.largest.value_mm);
        }
    }
    println!("stock {lo} {hi}");
    for f in r.report.flanks.iter().take(6) {
        println!("{f:?}");
    }
    println!("{:?}", r.report.roots.iter().take(3).collect::<Vec<_>>());
    for a in &r.report.allowances {
        println!(
            "{:?} {:?}",
            measure::unevenness::summarise(a.envelope.iter().take(14).map(|t| t.unevenness_mean_percent())),
            measure::unevenness::summarise(a.strokes.iter().take(14).map(|t| t.unevenness_mean_percent()))
        );
    }
}
