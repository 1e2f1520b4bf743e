//! Flanks on the visitor's own GPU, by WebGPU.

use crate::flank::WebFlank;
use crate::{Outcome, WebJob, explained, side};
use gearcut::backend::Choice;
use gearcut_gpu::adapter::{AdapterKind, AdapterWish};
use gearcut_gpu::{Deferred, Gpu, GpuOptions, OnGpuFailure};
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// An open device.
#[wasm_bindgen]
pub struct WebGpu {
    gpu: Arc<Gpu>,
}

#[wasm_bindgen]
impl WebGpu {
    /// Opens the device that the browser gives.
    ///
    /// # Errors
    /// There is none, or it does not run the kernels.
    pub async fn open() -> Outcome<Self> {
        let options = GpuOptions { on_failure: OnGpuFailure::Stop, ..GpuOptions::default() };
        Ok(Self { gpu: Arc::new(Gpu::open(AdapterWish::RealFirst, options).await?) })
    }

    /// What it is, as far as the browser says.
    pub fn name(&self) -> String {
        self.gpu.adapter().name.clone()
    }

    /// Whether the processor plays the GPU: the native kernels are faster then.
    pub fn is_software(&self) -> bool {
        self.gpu.adapter().kind == AdapterKind::Software
    }

    /// Gives the device up, as a driver that is reset does.
    pub fn lose(&self) {
        self.gpu.lose_device();
    }

    /// Cuts the part of a flank at these places.
    ///
    /// # Errors
    /// As [`WebJob::flank_part`]; the device is lost, or refuses memory.
    pub async fn flank_part(
        &self,
        job: &WebJob,
        tooth: u32,
        left: bool,
        arcs_mm: Vec<f64>,
        face_mm: Vec<f64>,
    ) -> Outcome<WebFlank> {
        let deferred = Deferred::new(self.gpu.clone());
        let choice = Choice { backend: Box::new(deferred.clone()), why: "asked for".to_owned(), on_trial: false };
        let job = job.job.clone().on(choice);
        let cut = || job.cut_flank_at(tooth, side(left), &arcs_mm, &face_mm);
        let done = match cut() {
            Err(gearcut::Error::Interrupted) => {
                deferred.settle().await?;
                cut()
            }
            done => done,
        };
        Ok(WebFlank(done.map_err(|error| explained(job.scene(), error))?))
    }
}
