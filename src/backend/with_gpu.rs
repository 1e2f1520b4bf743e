//! Choices of a build with the backend on wgpu.

use super::{Choice, OnFailure, native};
use gearcut_core::cut::Backend;
use gearcut_core::cut::cpu::Cpu;
use gearcut_gpu::adapter::{self, AdapterFacts, AdapterWish, FoundAdapter};
use gearcut_gpu::{Gpu, GpuOptions, GpuProblem, OnGpuFailure};
use serde::Serialize;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

fn options(on_failure: OnFailure) -> GpuOptions {
    let on_failure = match on_failure {
        OnFailure::RedoNatively => OnGpuFailure::RedoNatively,
        OnFailure::Stop => OnGpuFailure::Stop,
    };
    GpuOptions { on_failure, ..GpuOptions::default() }
}

/// A GPU, or what stands in for one.
///
/// # Errors
/// There is none, or it does not work.
pub(super) fn gpu(on_failure: OnFailure) -> gearcut_core::error::Result<Choice> {
    ASKED.store(true, Ordering::SeqCst);
    let found = adapter::choose(AdapterWish::RealFirst)?;
    let why = if found.facts.kind.is_real() {
        "chosen by --backend gpu".into()
    } else {
        format!("chosen by --backend gpu; no real GPU is there, {} takes its place", found.facts.name)
    };
    Ok(Choice { backend: Box::new(Gpu::on(&found, options(on_failure))?), why, on_trial: false })
}

/// How long the drivers of all adapters may take to say what they are and to open the one that is taken: ten times what
/// they take on a cold start.
const PATIENCE: Duration = Duration::from_secs(10);

/// Whether drivers were asked.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether drivers were asked: one that hangs, now or at the process's end, must not keep that from coming.
pub fn drivers_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// All adapters, best first.
fn adapters() -> Vec<FoundAdapter> {
    ASKED.store(true, Ordering::SeqCst);
    adapter::adapters()
}

/// A real GPU, else the processor; a driver that hangs is none.
pub(super) fn any(on_failure: OnFailure) -> Choice {
    match in_time(PATIENCE, move || answered(on_failure)) {
        Ok(choice) => choice,
        Err(why) => native(format!("auto: {why}; `--backend gpu` waits for it")),
    }
}

/// What work on a thread of its own gives within that time; it goes on alone where it takes longer.
fn in_time<T: Send + 'static>(patience: Duration, work: impl FnOnce() -> T + Send + 'static) -> Result<T, String> {
    let (answer, wait) = mpsc::channel();
    let started = thread::Builder::new().name("drivers".to_owned()).spawn(move || {
        let _nobody_waits = answer.send(work());
    });
    started.map_err(|reason| format!("the system starts no thread for the graphics driver: {reason}"))?;
    wait.recv_timeout(patience).map_err(|failed| match failed {
        RecvTimeoutError::Timeout => {
            format!("the graphics driver did not answer within {} s", patience.as_secs_f64())
        }
        RecvTimeoutError::Disconnected => "the graphics driver failed".to_owned(),
    })
}

fn answered(on_failure: OnFailure) -> Choice {
    let found = adapters();
    let facts: Vec<AdapterFacts> = found.iter().map(|a| a.facts.clone()).collect();
    match auto(&facts) {
        (Some(index), why) => on_real_gpu(&found[index], options(on_failure), why),
        (None, why) => native(why),
    }
}

/// A real GPU that does not open, because of its driver, is no reason to fail when anything will do.
fn on_real_gpu(found: &FoundAdapter, options: GpuOptions, why: String) -> Choice {
    match Gpu::on(found, options) {
        Ok(gpu) => Choice { backend: Box::new(gpu), why, on_trial: true },
        Err(problem) => native(format!("auto: {problem}")),
    }
}

/// What auto takes of these adapters, and why; `None`: the processor.
fn auto(adapters: &[AdapterFacts]) -> (Option<usize>, String) {
    let taken = adapter::pick(adapters, AdapterWish::Real);
    let why = match (taken, adapters.first()) {
        (Some(index), _) => format!("auto: {} ({})", adapters[index].name, adapters[index].kind),
        (None, Some(first)) => format!("auto: no real GPU, only {} ({})", first.name, first.kind),
        (None, None) => "auto: no Vulkan, Metal or DirectX 12 adapter".into(),
    };
    (taken, why)
}

/// What `gearcut devices` shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Devices {
    /// Adapters, best first.
    pub adapters: Vec<AdapterFacts>,
    /// The processor's backend.
    pub native: String,
    /// Index of the adapter that auto takes; nothing: the processor.
    pub auto_takes: Option<usize>,
    /// Why.
    pub auto_why: String,
}

/// The processor and every adapter that opens, each with its name: all whose kernels can be timed. Drivers that hang
/// have none.
pub fn bench_machines() -> Vec<(String, Box<dyn Backend>)> {
    let native = Cpu::default();
    let mut machines: Vec<(String, Box<dyn Backend>)> = vec![(native.name(), Box::new(native))];
    for found in in_time(PATIENCE, adapters).unwrap_or_default().iter().filter(|found| found.facts.lacks.is_none()) {
        if let Ok(gpu) = Gpu::on(found, options(OnFailure::Stop)) {
            machines.push((found.facts.name.clone(), Box::new(gpu)));
        }
    }
    machines
}

/// Looks for adapters; of drivers that hang it says so.
pub fn devices() -> Devices {
    let found = in_time(PATIENCE, || adapters().into_iter().map(|found| found.facts).collect::<Vec<_>>());
    let (adapters, failed) = found.map_or_else(|why| (Vec::new(), Some(why)), |adapters| (adapters, None));
    let (auto_takes, why) = auto(&adapters);
    let auto_why = failed.unwrap_or(why);
    Devices { adapters, native: Cpu::default().name(), auto_takes, auto_why }
}

impl fmt::Display for Devices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for adapter in &self.adapters {
            writeln!(f, "gpu   {adapter}")?;
        }
        if self.adapters.is_empty() {
            writeln!(f, "gpu   {}", GpuProblem::NoAdapter { seen: Vec::new() })?;
        }
        writeln!(f, "cpu   {}", self.native)?;
        let why = self.auto_why.trim_start_matches("auto: ");
        match self.auto_takes {
            Some(_) => write!(f, "--backend auto takes {why} if it is faster than the processor on tiles of the scene"),
            None => write!(f, "--backend auto takes {}: {why}", self.native),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_gpu::adapter::AdapterKind;

    fn adapter(name: &str, kind: AdapterKind) -> AdapterFacts {
        AdapterFacts {
            name: name.into(),
            kind,
            interface: "Vulkan".into(),
            driver: String::new(),
            binding_bytes: 1 << 27,
            buffer_bytes: 1 << 31,
            workgroup_threads: 1024,
            timestamps: true,
            lacks: None,
        }
    }

    #[test]
    fn a_driver_that_hangs_or_fails_is_left_alone() {
        let patience = Duration::from_millis(50);
        let hung = in_time(patience, || thread::sleep(Duration::from_secs(3600)));
        assert_eq!(hung, Err("the graphics driver did not answer within 0.05 s".to_owned()));
        let failed: Result<(), String> = in_time(Duration::from_secs(60), || panic!("planted"));
        assert_eq!(failed, Err("the graphics driver failed".to_owned()));
        assert_eq!(in_time(Duration::from_secs(60), || 7), Ok(7));
        let _listed = devices();
        assert!(drivers_asked(), "a driver may hang at the process's end");
    }

    #[test]
    fn auto_takes_real_gpus_and_never_software() {
        let software = adapter("llvmpipe", AdapterKind::Software);
        let mut old = adapter("old card", AdapterKind::Discrete);
        old.lacks = Some("8 storage buffers in a stage".into());
        let card = adapter("card", AdapterKind::Integrated);
        assert_eq!(auto(&[]).0, None);
        assert_eq!(auto(std::slice::from_ref(&software)), (None, "auto: no real GPU, only llvmpipe (software)".into()));
        assert_eq!(auto(&[old.clone(), software.clone()]).0, None);
        assert_eq!(auto(&[old, card, software]), (Some(1), "auto: card (integrated GPU)".into()));
    }

    #[test]
    fn the_list_says_what_auto_does_and_how_to_get_an_adapter() {
        let empty =
            Devices { adapters: Vec::new(), native: "cpu".into(), auto_takes: None, auto_why: "auto: nothing".into() };
        let text = empty.to_string();
        assert!(text.contains("mesa-vulkan-drivers") && text.ends_with("--backend auto takes cpu: nothing"), "{text}");
    }
}
