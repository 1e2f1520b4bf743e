//! Whether a GPU cuts a scene's own tiles faster than the processor, stage by stage.
//!
//! In: the gear, a GPU's backend. Out: [`BackendTrial`]. Law: patches of its flanks, as many at once as there are
//! threads, go through all operations on either backend, as in a run: plans, launches and what comes back count, and so
//! do cores that wait. Where the run cuts the whole blank, some passes go over all of it as well; the faster backend
//! gets the flanks, and the faster one the blank. The fastest of some rounds is taken: the first one compiles
//! pipelines, and others have the machine too.
//!
//! Roads not taken: rates of known adapters; drivers, memory and what else runs there decide as much. A part of the
//! blank with all passes: a device that has few rays at a time is slower than it would be.

use crate::backend::Choice;
use crate::interrupt::Interrupt;
use crate::job::{GearJob, TrialBlank, rows_z_mm};
use crate::number_text::significant;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::cut::{Backend, ByStage};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use rayon::prelude::*;
use web_time::Instant;

/// Columns of a patch in the middle of a profile: two tiles, some tens of milliseconds with all rows.
const COLUMNS: usize = 32;
/// Rounds on either backend.
const ROUNDS: usize = 3;

/// Times of the same work on both backends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageTrial {
    /// Fastest round of the processor, s.
    pub native_s: f64,
    /// Fastest round of the GPU, s.
    pub gpu_s: f64,
}

impl StageTrial {
    fn new(gpu: &dyn Backend, interrupt: &Interrupt, round_s: impl Fn(&dyn Backend) -> Result<f64>) -> Result<Self> {
        let native = Cpu::default();
        let mut trial = Self { native_s: f64::INFINITY, gpu_s: f64::INFINITY };
        for _ in 0..ROUNDS {
            interrupt.check()?;
            trial.gpu_s = trial.gpu_s.min(round_s(gpu)?);
            trial.native_s = trial.native_s.min(round_s(&native)?);
        }
        Ok(trial)
    }

    /// Whether the GPU is worth taking.
    pub fn takes_gpu(&self) -> bool {
        self.gpu_s < self.native_s
    }

    /// Its verdict in words.
    fn why(&self, on: &str) -> String {
        let [gpu_ms, native_ms] = [self.gpu_s, self.native_s].map(|s| significant(1e3 * s, 3));
        let verdict = if self.takes_gpu() { "faster" } else { "not faster" };
        format!("{verdict} than the processor on {on} of this scene: {gpu_ms} ms, the processor {native_ms} ms")
    }
}

/// Times of both backends, stage by stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BackendTrial {
    /// On tiles of flanks.
    pub flanks: StageTrial,
    /// On some passes over the whole blank, where it is cut by itself.
    pub blank: Option<StageTrial>,
    /// What the trial itself took, s.
    pub took_s: f64,
}

impl BackendTrial {
    /// Tries both on flanks, and on the blank where it is `with_blank`.
    ///
    /// # Errors
    /// The tool generates no flank; the backend's; a blank that does not fit in memory; Ctrl-C.
    pub fn new(gear: &dyn GearJob, gpu: &dyn Backend, with_blank: bool, interrupt: &Interrupt) -> Result<Self> {
        let started = Instant::now();
        let flanks = StageTrial::new(gpu, interrupt, |backend| round_s(gear, backend))?;
        let passes = if with_blank { gear.trial_blank()? } else { None };
        let of_blank = |TrialBlank { uncut, cut }: &TrialBlank| {
            StageTrial::new(gpu, interrupt, |backend| {
                let blank = uncut.clone();
                let started = Instant::now();
                cut(backend, blank)?;
                Ok(started.elapsed().as_secs_f64())
            })
        };
        let blank = passes.as_ref().map(of_blank).transpose()?;
        Ok(Self { flanks, blank, took_s: started.elapsed().as_secs_f64() })
    }

    /// What a choice on trial comes to where only flanks are cut, with the reason.
    pub fn settle(&self, choice: Choice) -> Choice {
        let why = format!("{}, {}", choice.why, self.why());
        let backend = if self.flanks.takes_gpu() { choice.backend } else { Box::new(Cpu::default()) };
        Choice { backend, why, on_trial: false }
    }

    /// What cuts each stage of a run.
    pub fn backends<'a>(&self, gpu: &'a dyn Backend, native: &'a dyn Backend) -> ByStage<'a> {
        let faster = |stage: &StageTrial| if stage.takes_gpu() { gpu } else { native };
        ByStage { flanks: faster(&self.flanks), blank: faster(self.blank.as_ref().unwrap_or(&self.flanks)) }
    }

    /// Its verdict in words.
    pub fn why(&self) -> String {
        let mut why = self.flanks.why("tiles");
        if let Some(blank) = &self.blank {
            why = format!("{why}; {}", blank.why("passes over the whole blank"));
        }
        format!("{why} (tried in {} ms)", significant(1e3 * self.took_s, 3))
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
