//! Choices of a build without the feature `gpu`: the processor.

use super::{Choice, OnFailure, native};
use gearcut_core::cut::Backend;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::{Error, Result};
use std::fmt;

/// Why there is no GPU.
const NONE: &str = "this gearcut was built without its GPU backend";
/// How to get one.
const WAY_OUT: &str = "build it without --no-default-features";

#[derive(Debug, thiserror::Error)]
#[error("{NONE}\n  way out: {WAY_OUT}, or use --backend cpu")]
struct NoGpuBackend;

/// Never a GPU.
///
/// # Errors
/// Always.
pub(super) fn gpu(_: OnFailure) -> Result<Choice> {
    Err(Error::Device(Box::new(NoGpuBackend)))
}

/// The processor.
pub(super) fn any(_: OnFailure) -> Choice {
    native(format!("auto: {NONE}"))
}

/// Never a driver.
pub fn drivers_asked() -> bool {
    false
}

/// What `gearcut devices` shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Devices {
    /// The processor's backend.
    pub native: String,
}

/// The processor with its name: all whose kernels can be timed.
pub fn bench_machines() -> Vec<(String, Box<dyn Backend>)> {
    let native = Cpu::default();
    vec![(native.name(), Box::new(native))]
}

/// The processor.
pub fn devices() -> Devices {
    Devices { native: Cpu::default().name() }
}

impl fmt::Display for Devices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let native = &self.native;
        writeln!(f, "gpu   {NONE}\n  way out: {WAY_OUT}")?;
        write!(f, "cpu   {native}\n--backend auto takes {native}: {NONE}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BackendWish, choose};
    use super::*;

    #[test]
    fn a_gpu_is_refused_with_a_way_out_and_auto_takes_the_processor() {
        let refused = choose(BackendWish::Gpu, OnFailure::Stop).err().expect("there is no GPU backend").to_string();
        assert!(refused.contains(NONE) && refused.contains("way out: build it without --no-default-features"));
        let choice = choose(BackendWish::Auto, OnFailure::Stop).expect("the processor is always there");
        assert_eq!((choice.backend.name(), choice.why), (Cpu::default().name(), format!("auto: {NONE}")));
        let told = devices().to_string();
        assert!(told.contains(WAY_OUT) && told.ends_with(NONE), "{told}");
    }
}
