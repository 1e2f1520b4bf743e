//! Whether a GPU cuts a scene's own tiles faster than the processor.
//!
//! In: the gear, a GPU's backend. Out: [`BackendTrial`]. Law: patches of its flanks, as many at once as there are
//! threads, go through all operations on either backend, as in a run: plans, launches and what comes back count, and so
//! do cores that wait. The fastest of some rounds is taken: the first one compiles pipelines, and others have the
//! machine too. Flanks decide for the whole run: what else a backend cuts is not tried.
//!
//! Road not taken: rates of known adapters. Drivers, memory and what else runs there decide as much.

use crate::backend::Choice;
use crate::interrupt::Interrupt;
use crate::job::{GearJob, rows_z_mm};
use crate::number_text::significant;
use gearcut_core::cut::Backend;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use rayon::prelude::*;
use web_time::Instant;

/// Columns of a patch in the middle of a profile: two tiles, some tens of milliseconds with all rows.
const COLUMNS: usize = 32;
/// Rounds on either backend.
const ROUNDS: usize = 3;

/// Times of the same patches on both backends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BackendTrial {
    /// Fastest round of the processor, s.
    pub native_s: f64,
    /// Fastest round of the GPU, s.
    pub gpu_s: f64,
    /// What the trial itself took, s.
    pub took_s: f64,
}

impl BackendTrial {
    /// Tries both.
    ///
    /// # Errors
    /// The tool generates no flank; the backend's; Ctrl-C.
    pub fn new(gear: &dyn GearJob, gpu: &dyn Backend, interrupt: &Interrupt) -> Result<Self> {
        let native = Cpu::default();
        let started = Instant::now();
        let mut trial = Self { native_s: f64::INFINITY, gpu_s: f64::INFINITY, took_s: 0.0 };
        for _ in 0..ROUNDS {
            interrupt.check()?;
            trial.gpu_s = trial.gpu_s.min(round_s(gear, gpu)?);
            trial.native_s = trial.native_s.min(round_s(gear, &native)?);
        }
        Ok(Self { took_s: started.elapsed().as_secs_f64(), ..trial })
    }

    /// What a choice on trial comes to, with the reason.
    pub fn settle(&self, choice: Choice) -> Choice {
        let why = format!("{}, {}", choice.why, self.why());
        let backend = if self.takes_gpu() { choice.backend } else { Box::new(Cpu::default()) };
        Choice { backend, why, on_trial: false }
    }

    /// Whether the GPU is worth taking.
    pub fn takes_gpu(&self) -> bool {
        self.gpu_s < self.native_s
    }

    /// Its verdict in words.
    pub fn why(&self) -> String {
        let [gpu_ms, native_ms, took_ms] = [self.gpu_s, self.native_s, self.took_s].map(|s| significant(1e3 * s, 3));
        let verdict = if self.takes_gpu() { "faster" } else { "not faster" };
        format!(
            "{verdict} than the processor on tiles of this scene: {gpu_ms} ms, the processor {native_ms} ms (tried in \
            {took_ms} ms)"
        )
    }
}

/// One round: a patch for each thread, all at once.
fn round_s(gear: &dyn GearJob, backend: &dyn Backend) -> Result<f64> {
    let scene = gear.scene();
    let rows_mm = rows_z_mm(scene.gear.face_width_mm, scene.fields.lead_spacing_mm);
    let teeth = scene.gear.teeth as usize;
    let started = Instant::now();
    (0..rayon::current_num_threads()).into_par_iter().try_for_each(|index| {
        let (tooth, side) = (1 + (index / 2 % teeth) as u32, [Side::Left, Side::Right][index % 2]);
        let arcs_mm = gear.even_arcs_mm(tooth, side, scene.fields.profile_spacing_mm)?;
        let first = arcs_mm.len().saturating_sub(COLUMNS) / 2;
        let arcs_mm = &arcs_mm[first..arcs_mm.len().min(first + COLUMNS)];
        gear.cut_flank(backend, tooth, side, arcs_mm, &rows_mm).map(drop)
    })?;
    Ok(started.elapsed().as_secs_f64())
}
