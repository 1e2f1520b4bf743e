//! What every benchmark says about the machine it runs on.
#![allow(dead_code, reason = "each benchmark uses its own part")]

use gearcut::cut::cpu::{Cpu, Vectors};

/// Processor, threads in use, and how busy the machine was when the benchmark began.
pub fn machine() -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(own)))
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let load = std::fs::read_to_string("/proc/loadavg")
        .ok()
        .and_then(|text| text.split_whitespace().next().map(str::to_owned))
        .unwrap_or_else(|| "unknown".to_owned());
    let threads = rayon::current_num_threads();
    format!("{processor}, {threads} threads for gearcut, load average {load} at the start")
}

fn own((_, name): (&str, &str)) -> String {
    name.to_owned()
}

/// The native backend with AVX2, and with AVX-512 where the processor has it.
pub fn backends() -> Vec<Cpu> {
    let mut all: Vec<Cpu> = Cpu::with_vectors(Vectors::Avx2).into_iter().collect();
    let widest = Cpu::default();
    if all.iter().all(|cpu| cpu.instruction_set() != widest.instruction_set()) {
        all.push(widest);
    }
    all
}
