//! What a cut will take, before anything is cut: dexels, dexels against passes, memory, time.
//!
//! In: the job, and how its process cuts a band of a flank and a share of the blank. Out: lines of `check`. Dexels
//! follow from the lengths of all profiles and the spacings. On the two teeth that differ most, two bands of rows in
//! the middle of the face are cut as a run cuts them: what a row more takes, and what a flank takes however narrow it
//! is, follow from the two, and with them the whole face. The blank is cut in a share. What is drawn and written takes
//! what the stages of a run take elsewhere ([`super::stages`]): pieces of it would say little.
//!
//! Road not taken: rates of one processor for every piece of work (plans, dexels, rays, chips), times the speed of this
//! one. They came to nine hundred lines, and went stale with every change of a kernel.

use super::stages::{self, Costs};
use crate::job::{GearJob, rows_z_mm};
use crate::number_text::{plain, significant};
use crate::output::text::Sheet;
use crate::progress::duration_text;
use gearcut_core::cut::CutStats;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Bytes of a dexel on one surface: height and pass id.
const BYTES_PER_DEXEL: usize = 8;

/// Work of a process from which that of a whole cut follows.
pub struct ForecastSamples<'a> {
    /// The job.
    pub job: &'a dyn GearJob,
    /// What its stages take beside the samples.
    pub costs: &'a Costs<'a>,
    /// Bytes of a dexel beside its surfaces.
    pub ray_bytes: usize,
    /// Rows of the narrow and of the wide band.
    pub rows: [usize; 2],
    /// Of so many columns one is cut.
    pub one_column_in: usize,
    /// Cuts a part of a flank, arcs times places along the tooth, and follows what a run follows on it.
    pub cut_band: &'a dyn Fn(u32, Side, Vec<f64>, Vec<f64>) -> Result<CutStats>,
    /// The whole blank in words, and the bytes that it takes.
    pub blank: (String, f64),
    /// Cuts shares of the blank, and follows shares of its chips; with [`whole_s`] it says what all of that takes.
    pub blank_s: &'a dyn Fn() -> Result<f64>,
}

/// What some rows of flanks took.
#[derive(Default, Clone, Copy)]
struct Band {
    columns: f64,
    seconds: f64,
    evaluations: f64,
}

impl ForecastSamples<'_> {
    /// Prints the forecast.
    ///
    /// # Errors
    /// A flank that the tool does not generate; the backend's.
    pub fn print(&self, sheet: &mut Sheet) -> Result<()> {
        let (job, cores) = (self.job, rayon::current_num_threads());
        let before_s = spent_s();
        let (scene, surfaces) = (job.scene(), job.operations().len());
        let rows_mm = rows_z_mm(scene.gear.face_width_mm, scene.fields.lead_spacing_mm);
        let mut columns = Vec::new();
        for (tooth, side) in super::flanks_of(job) {
            columns.push((job.profile_length_mm(tooth, side)? / scene.fields.profile_spacing_mm).floor() + 1.0);
        }
        let all_columns: f64 = columns.iter().sum();
        let largest = columns.iter().copied().fold(0.0, f64::max) * rows_mm.len() as f64;
        let dexels = all_columns * rows_mm.len() as f64;
        let [narrow, wide] = self.rows.map(|rows| rows.min(rows_mm.len()));
        let [first, second] = [self.band(&rows_mm, narrow)?, self.band(&rows_mm, wide)?];
        let whole = |of: fn(&Band) -> f64| {
            let each = (of(&second) - of(&first)).max(0.0) / (wide - narrow).max(1) as f64;
            (of(&second) + each * (rows_mm.len() - wide) as f64) * all_columns / second.columns
        };
        let (flanks_s, evaluations) = (whole(|band| band.seconds), whole(|band| band.evaluations));
        let blank_s = (self.blank_s)()?;
        let beside_s = before_s + stages::beside_cutting_s(job, self.costs);

        sheet.heading("Cost of the cut (nothing has been cut)");
        sheet.details(|sheet| {
            let fields = format!(
                "{} of at most {:.2} million dexels, {} by {} um; {} million in all",
                columns.len(),
                1e-6 * largest,
                plain(1e3 * scene.fields.profile_spacing_mm),
                plain(1e3 * scene.fields.lead_spacing_mm),
                significant(1e-6 * dexels, 3)
            );
            sheet.line("flank fields", fields);
            let per_dexel = evaluations / (dexels * surfaces as f64);
            let million = significant(1e-6 * evaluations, 3);
            let words = format!("{million} million dexels against passes, {per_dexel:.1} per dexel and operation");
            sheet.line("evaluations", words);
            sheet.line("whole blank", format!("{}; {:.0} MB", self.blank.0, 1e-6 * self.blank.1));
            let bytes = largest * (self.ray_bytes + BYTES_PER_DEXEL * surfaces) as f64 * cores as f64;
            sheet.line("memory", format!("{:.0} MB: one flank at a time on each of {cores} threads", 1e-6 * bytes));
        });
        let [flanks, blank, beside, all] = [flanks_s, blank_s, beside_s, flanks_s + blank_s + beside_s]
            .map(|of_one_core| duration_text(of_one_core / cores as f64));
        let words = format!(
            "some {all} for all of it on {cores} threads of this machine: {flanks} for flanks, {blank} for blank and \
             chips, {beside} to prepare, draw and write"
        );
        sheet.line("time", words);
        Ok(())
    }

    /// So many rows in the middle of the face of a left and a right flank.
    fn band(&self, rows_mm: &[f64], rows: usize) -> Result<Band> {
        let first = (rows_mm.len() - rows) / 2;
        let rows_mm = &rows_mm[first..first + rows];
        let teeth = self.job.teeth_that_differ_most();
        let flanks = [(teeth[0], Side::Left), (teeth[teeth.len() - 1], Side::Right)];
        let mut band = Band::default();
        for (tooth, side) in flanks {
            let arcs_mm = self.job.even_arcs_mm(tooth, side, self.job.scene().fields.profile_spacing_mm)?;
            let arcs_mm: Vec<f64> = arcs_mm.into_iter().step_by(self.one_column_in).collect();
            band.columns += arcs_mm.len() as f64;
            let before_s = spent_s();
            let stats = (self.cut_band)(tooth, side, arcs_mm, rows_mm.to_vec())?;
            band.seconds += spent_s() - before_s;
            band.evaluations += stats.dexel_passes as f64;
        }
        Ok(band)
    }
}

/// An answer to "shall I go on?" that is yes for one piece of work in `every`.
pub fn one_in(every: usize) -> impl Fn() -> bool + Sync {
    let asked = AtomicUsize::new(0);
    move || asked.fetch_add(1, Ordering::Relaxed).is_multiple_of(every)
}

/// What the whole of some work takes, s, of which `work` does a share.
///
/// # Errors
/// Those of `work`.
pub fn whole_s<T>(share: f64, work: impl FnOnce() -> Result<T>) -> Result<f64> {
    let before_s = spent_s();
    work()?;
    Ok((spent_s() - before_s) / share)
}

/// Processor time of this command so far, all threads, s: other programs that run at the same time change it little.
fn spent_s() -> f64 {
    processor_time().as_secs_f64()
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    // Neither is negative.
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// Wall time, where the system has no such clock.
#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn processor_time() -> Duration {
    static START: std::sync::OnceLock<web_time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(web_time::Instant::now).elapsed()
}
