use gearcut::cut::Backend;
use gearcut::tool::CuttingTool;
use gearcut::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let loaded = scene::load(std::path::Path::new(&args[1]), &args[2..]).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1)
    });
    let job = job::Job::new(loaded.scene).unwrap();
    let g = job.target_generation();
    let (mut tf, mut tp, mut tc, mut tm, mut n, mut d) = (0.0, 0.0, 0.0, 0.0, 0u64, 0u64);
    let cpu = cut::cpu::Cpu::default();
    println!("{}", cpu.name());
    for tooth in [1, 3, 5, 8, 12] {
        let t = std::time::Instant::now();
        let flank = job.target_flank(&g, tooth, gear::generation::Side::Left).unwrap();
        let field = job.flank_field(&flank);
        tf += t.elapsed().as_secs_f64();
        let mut layers = vec![];
        let mut layer = field.blank_layer();
        for op in &job.operations {
            let t = std::time::Instant::now();
            let plan = passes::CutPlan::new(&field, &op.strokes, &job.cutter);
            tp += t.elapsed().as_secs_f64();
            let t = std::time::Instant::now();
            let s = cpu.cut(&field, job.cutter.edge(), &plan, &mut layer).unwrap();
            tc += t.elapsed().as_secs_f64();
            n += s.dexel_passes;
            d += field.len() as u64;
            layers.push(layer.clone());
        }
        let t = std::time::Instant::now();
        let cut = job::CutFlank { field, layers, stats: Default::default() };
        std::hint::black_box(measure::flank_report::measure(&job, &flank, &cut));
        tm += t.elapsed().as_secs_f64();
    }
    println!(
        "field {tf:.3} plan {tp:.3} cut {tc:.3} measure {tm:.3} per dexel-pass {:.2} ns, dexels {d} passes {n}",
        tc / n as f64 * 1e9
    );
}
