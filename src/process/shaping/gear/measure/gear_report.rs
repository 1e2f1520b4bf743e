//! The gear as a whole: allowances and unevenness of every operation, pitch and thickness, root stock, tip lands.
//!
//! In: the job, the flank reports. Out: [`GearReport`].

use super::cmm::CmmReport;
use super::flank_report::FlankReport;
use super::unevenness::{CrossedSurface, ToothAllowance, allowances, crossings, rack_allowance_mm};
use crate::measure::inspection::GearInspection;
use crate::measure::stock::{Stock, stock};
use crate::process::shaping::ShapingJob;
use crate::steps::planar::CutField;
use gearcut_core::dexel::figures::LinesAt;
use gearcut_core::terms::Side;
use std::collections::BTreeSet;

/// Allowances of one operation over the finished gear.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationAllowance {
    /// Index of the operation.
    pub operation: usize,
    /// delta_d tan(alpha), mm.
    pub rack_mm: f64,
    /// In the limit of many strokes.
    pub envelope: Vec<ToothAllowance>,
    /// What the strokes leave.
    pub strokes: Vec<ToothAllowance>,
}

/// Stock in one root.
#[derive(Debug, Clone, PartialEq)]
pub struct RootReport {
    /// Space, after the tooth of this number.
    pub space: u32,
    /// Stock of every operation but the last, on rays long enough.
    pub stock: Vec<Option<Stock>>,
}

/// The gear, measured.
#[derive(Debug)]
pub struct GearReport {
    /// Flanks, in order of teeth, left before right; those of an interrupted run only.
    pub flanks: Vec<FlankReport>,
    /// Roots, in order; empty where no earlier operation leaves stock in them and no mesh needs them.
    pub roots: Vec<RootReport>,
    /// Tip land of each tooth, mm.
    pub tip_lands_mm: Vec<f64>,
    /// Allowances of every operation but the last, if they were wanted.
    pub allowances: Vec<OperationAllowance>,
    /// The same as a coordinate measuring machine finds them, if the scene asks for it.
    pub cmm: Vec<CmmReport>,
    /// Pitch, runout and thickness of what the strokes leave.
    pub inspection: GearInspection,
    /// Flanks on which what some strokes leave has no crossing with the pitch curve that can be found.
    pub unsettled: Vec<(u32, Side)>,
    /// Teeth after which the pitch curve repeats.
    pub period_teeth: u32,
}

impl GearReport {
    /// How many flanks are cut away.
    pub fn lost(&self) -> usize {
        self.flanks.iter().filter(|flank| flank.own.is_lost).count()
    }
}

/// Measures what belongs to the whole gear; `flanks` and `roots` as far as they were cut, allowances where they are
/// wanted.
pub fn measure(
    job: &ShapingJob,
    flanks: Vec<FlankReport>,
    roots: Vec<RootReport>,
    wants_allowances: bool,
) -> GearReport {
    let teeth = job.scene.gear.teeth;
    let last = job.operations.len() - 1;
    let mut unsettled = BTreeSet::new();
    let lost: BTreeSet<(u32, Side)> =
        flanks.iter().filter(|flank| flank.own.is_lost).map(|flank| (flank.tooth, flank.side)).collect();
    // Where a flank is cut away, what strokes leave elsewhere is not its crossing.
    let mut crossings_of = |operation: usize, surface: CrossedSurface| {
        let mut found = crossings(job, operation, surface);
        if surface != CrossedSurface::Envelope {
            for &(tooth, side) in &lost {
                found.teeth[tooth as usize - 1][usize::from(side == Side::Right)] = None;
            }
        }
        unsettled.extend(found.unsettled.into_iter().filter(|flank| !lost.contains(flank)));
        found.teeth
    };
    let finished = crossings_of(last, CrossedSurface::Strokes);
    let earlier = if wants_allowances { 0..last } else { 0..0 };
    let envelope = if earlier.is_empty() { Vec::new() } else { crossings_of(last, CrossedSurface::Envelope) };
    // B and C of every operation: against what finishing alone leaves, cuts that went below it keep their sign. Where
    // it does not reach a flank, that is finished as it is.
    let own = if earlier.is_empty() { Vec::new() } else { crossings_of(last, CrossedSurface::OwnStrokes) };
    let own: Vec<_> = own.iter().zip(&finished).map(|(own, all)| [own[0].or(all[0]), own[1].or(all[1])]).collect();
    let allowances = earlier
        .map(|operation| OperationAllowance {
            operation,
            rack_mm: rack_allowance_mm(job, operation),
            envelope: allowances(&crossings_of(operation, CrossedSurface::Envelope), &envelope),
            strokes: allowances(&crossings_of(operation, CrossedSurface::Strokes), &own),
        })
        .collect();
    let [left, right] = [0, 1].map(|side| finished.iter().map(|tooth| tooth[side]).collect::<Vec<_>>());
    GearReport {
        flanks,
        roots,
        tip_lands_mm: (1..=teeth).map(|tooth| job.target(tooth).tip_land_mm).collect(),
        allowances,
        cmm: Vec::new(),
        inspection: GearInspection::of_crossings(&job.blank, [&left, &right], job.transverse.pressure_angle_rad),
        unsettled: unsettled.into_iter().collect(),
        period_teeth: job.curve.period_teeth(teeth),
    }
}

/// Stock in one root, on rays long enough.
pub fn root_stock(space: u32, cut: &CutField) -> RootReport {
    let columns = cut.columns(LinesAt::default());
    let earlier = 0..columns.operations() - 1;
    RootReport { space, stock: earlier.map(|operation| stock(&cut.field, columns, operation, |_| true)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::deviation::runout;
    use crate::process;
    use crate::process::shaping::scene::model::Shaping;
    use std::path::Path;

    /// A round gear clamped off its axis by e and cut: a probe on the gear's own axis runs out by 2 e, and the left and
    /// right pitch errors swing with it.
    #[test]
    fn a_gear_cut_off_its_axis_runs_out_by_twice_the_eccentricity() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping/circular_m3_z24.toml");
        let mut scene = process::load(&path, &[]).expect("a shipped scene").scene;
        let eccentricity_mm = 0.02;
        Shaping::of_mut(&mut scene).expect("shaping").machine.errors.mounting.eccentricity_mm = eccentricity_mm;
        let job = ShapingJob::new(scene).expect("a gear");
        let cut = crossings(&job, job.operations.len() - 1, CrossedSurface::Strokes).teeth;
        let [left, right] = [0, 1].map(|side| cut.iter().map(|tooth| tooth[side]).collect::<Vec<_>>());
        let alpha = job.transverse.pressure_angle_rad;
        let runout = runout(&job.blank, &left, &right, alpha).expect("all cross");
        // The space after the last tooth is centred on phi = 0, the side that the gear was shifted to, towards the
        // cutter: it is cut deepest, and the probe lies deepest.
        let innermost = runout.radial_mm.iter().copied().fold(f64::INFINITY, f64::min);
        assert_eq!(runout.radial_mm.last(), Some(&innermost));
        // Feed marks of 0.1 um and the second order in e / d are all that may be between.
        assert!((runout.total_mm() - 2.0 * eccentricity_mm).abs() < 2e-4, "{} mm", runout.total_mm());
    }
}
