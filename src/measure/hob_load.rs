//! Load of every hob tooth: what each takes out of the gear over the whole process.
//!
//! In: what every pass took of the blank field (all spaces, the whole face, approach and overrun). Out: for every tooth the volume taken, the largest uncut chip thickness and the way cut.
//!
//! **Volume**: lengths taken from the rays of both families, their mean. **Thickness**: the largest distance of a place of the surface that a pass leaves from the surface that it finds, in a slice, times the cosine between slice
//! and swept surface. Of every place only the ray counts that meets it within 45 degrees of its normal: it gives the distance of both surfaces at its ends, exact where they are straight or circles about one point. Where the
//! other end is no old surface (a tooth that plunges) or lies on another facet, the nearest old place bounds it, the old surface going on along its tangent for half the rays' distance; and a disc about that place has to fit into the chip.
//! Not taken: the way along the normal until the material ends. Thin chips have the same, but for a tooth that plunges it runs across the whole tooth. **Way cut**: for each pass the slices in which it takes anything,
//! each worth the tip's way through the slice's share of the face.
//!
//! **Ledger.** The same volumes by another road, space by space: [`SpaceLedger`] stands rays on the pitch curve along its normals, from under the root to the blank's outline. A hob tooth widens from tip to
//! root, so on such a ray it always takes what lies above its edge: one height per ray is all that is left after each pass, and passes in the order of time give each its own chip. A length
//! dh at height h stands for the area (1 + h / rho) dh ds. No pass is left out, which takes minutes for a whole gear: it is what the loads are tested against.
//!
//! **Load is not life.** The volume taken is a measure of work done, as long as the specific cutting force is taken as constant along the edge; thin chips cost more force per area, and wear
//! follows temperature and thickness besides. Ratios of load say which teeth work and how evenly; they say nothing of hours.

use crate::cut::CutStats;
use crate::cut::cpu::Cpu;
use crate::cut::sweep_chips::PassChip;
use crate::dexel::{Layer, Ray, SpatialField};
use crate::gear::PitchCurve;
use crate::job::HobbingJob;
use crate::passes::{HobTeeth, SweepPlan};
use crate::tool::{CuttingTool, Hob};
use glam::DVec3;

/// Teeth with less than this share of the hardest working tooth's volume are not called in use.
const IN_USE: f64 = 0.01;

/// What a tooth took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ToothLoad {
    /// Volume taken, mm^3.
    pub volume_mm3: f64,
    /// Largest uncut chip thickness, mm.
    pub thickness_mm: f64,
    /// Way of its tip through the work while any part of its edge takes material, mm.
    pub way_mm: f64,
    /// Passes that took anything.
    pub passes: u64,
}

/// Where the ledger's rays stand.
#[derive(Debug, Clone, PartialEq)]
pub struct LedgerGrid {
    /// Transverse slices, gear frame, mm.
    pub slices_mm: Vec<f64>,
    /// Share of the face that each slice stands for, mm.
    pub slice_width_mm: f64,
    /// Distance of the rays along the pitch curve, mm.
    pub spacing_mm: f64,
    /// Lowest and highest height over the pitch curve: below the root, and the blank's outline, mm.
    pub heights_mm: [f64; 2],
}

/// One tooth space with what is left in it.
pub struct SpaceLedger<'a> {
    grid: &'a LedgerGrid,
    field: SpatialField,
    layer: Layer,
    /// Curvature of the pitch curve under each column, 1 / mm.
    spread_per_mm: Vec<f64>,
    step_mm: f64,
}

impl<'a> SpaceLedger<'a> {
    /// The uncut space whose middle crosses the pitch line at the arc `space_arc_mm(z)` in the slice z.
    pub fn new(curve: &PitchCurve, grid: &'a LedgerGrid, pitch_mm: f64, space_arc_mm: impl Fn(f64) -> f64) -> Self {
        let columns = (pitch_mm / grid.spacing_mm).round().max(1.0) as usize;
        let step_mm = pitch_mm / columns as f64;
        let [low_mm, high_mm] = grid.heights_mm;
        let mut spread_per_mm = vec![0.0; columns];
        let field = SpatialField::new(columns, grid.slices_mm.len(), low_mm, |column, row| {
            let z_mm = grid.slices_mm[row];
            let arc_mm = space_arc_mm(z_mm) + step_mm * (column as f64 + 0.5) - 0.5 * pitch_mm;
            let frame = curve.frame(curve.phi_at_arc(arc_mm));
            // The slices of one space lie on a short piece of the curve: the last one's bend stands for all.
            spread_per_mm[column] = frame.curvature_per_mm;
            let ray = Ray {
                origin_mm: DVec3::new(frame.point_mm.x, frame.point_mm.y, z_mm),
                normal: DVec3::new(frame.normal.x, frame.normal.y, 0.0),
            };
            (ray, high_mm)
        });
        Self { grid, layer: field.blank_layer(), field, spread_per_mm, step_mm }
    }

    /// Runs an operation; volumes and thicknesses of all teeth in blade order, and what the kernel met.
    pub fn cut(&mut self, passes: &HobTeeth, hob: &Hob) -> (Vec<ToothLoad>, CutStats) {
        let plan = SweepPlan::brute_force(&self.field, passes, hob.edge());
        let (stats, taken) =
            Cpu::default().cut_with_ledger(&self.field, hob.edge(), &plan, &self.spread_per_mm, &mut self.layer);
        let mut loads = vec![ToothLoad::default(); passes.places.len()];
        let mut last_pass = None;
        for (record, taken) in plan.records.iter().zip(&taken).filter(|(_, taken)| taken.rays > 0) {
            let load = &mut loads[passes.blade_of(record.pass).1 as usize];
            load.volume_mm3 += taken.length_mm * self.step_mm * self.grid.slice_width_mm;
            load.thickness_mm = load.thickness_mm.max(taken.thickness_mm);
            load.passes += u64::from(last_pass != Some(record.pass));
            last_pass = Some(record.pass);
        }
        (loads, stats)
    }
}

/// Loads of one operation.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationLoad {
    /// Teeth in blade order.
    pub teeth: Vec<ToothLoad>,
}

impl OperationLoad {
    /// Loads of the whole process, from what every pass took of the blank field.
    pub fn of_blank(passes: &HobTeeth, chips: &[PassChip]) -> Self {
        let mut teeth = vec![ToothLoad::default(); passes.places.len()];
        for chip in chips {
            let load = &mut teeth[passes.blade_of(chip.pass).1 as usize];
            load.volume_mm3 += 0.5 * (chip.removed_mm3[0] + chip.removed_mm3[1]);
            load.thickness_mm = load.thickness_mm.max(chip.thickness_mm);
            load.way_mm += chip.way_mm;
            load.passes += 1;
        }
        Self { teeth }
    }

    /// Volume of all teeth, mm^3.
    pub fn volume_mm3(&self) -> f64 {
        self.teeth.iter().map(|load| load.volume_mm3).sum()
    }

    /// Index of the tooth with the largest value.
    pub fn peak(&self, value: impl Fn(&ToothLoad) -> f64) -> Option<usize> {
        (0..self.teeth.len()).max_by(|&a, &b| value(&self.teeth[a]).total_cmp(&value(&self.teeth[b])))
    }

    /// Teeth that take at least a hundredth of what the hardest working one takes.
    pub fn in_use(&self) -> usize {
        let peak = self.teeth.iter().map(|load| load.volume_mm3).fold(0.0, f64::max);
        self.teeth.iter().filter(|load| load.volume_mm3 > IN_USE * peak).count()
    }

    /// Largest volume over the mean of all teeth of the hob: 1 where all work alike. Undefined if nothing was cut.
    pub fn peak_to_mean(&self) -> Option<f64> {
        let peak = self.teeth.iter().map(|load| load.volume_mm3).fold(0.0, f64::max);
        (peak > 0.0).then(|| peak * self.teeth.len() as f64 / self.volume_mm3())
    }
}

/// Largest tip chip thickness of axial hobbing after B. Hoffmeister (Über den Verschleiß am Wälzfräser, dissertation, RWTH Aachen 1970), mm:
///
/// `4.9 m z^(9.25e-3 beta - 0.542) e^(-0.015 beta) (r_a0 / m)^(-8.25e-3 beta - 0.225) (i / z0)^-0.877 (f_a / m)^0.511 (a / m)^0.319`
///
/// beta in degrees, i gashes, z0 starts, a depth. Fitted to simulated chips of round gears; the factor for profile shift is left out. **The constants are quoted as
/// they are handed down in the hobbing literature and could not be checked against the dissertation**: a sanity check of the size, not a measure of anything.
pub fn hoffmeister_mm(
    module_mm: f64,
    teeth: f64,
    helix_deg: f64,
    tip_radius_mm: f64,
    gashes_per_start: f64,
    feed_mm: f64,
    depth_mm: f64,
) -> f64 {
    4.9 * module_mm
        * teeth.powf(9.25e-3 * helix_deg - 0.542)
        * (-0.015 * helix_deg).exp()
        * (tip_radius_mm / module_mm).powf(-8.25e-3 * helix_deg - 0.225)
        * gashes_per_start.powf(-0.877)
        * (feed_mm / module_mm).powf(0.511)
        * (depth_mm / module_mm).powf(0.319)
}

/// Hoffmeister's thickness for the largest depth of an operation: from the blank's outline, or from the operation before.
pub fn hoffmeister_of(job: &HobbingJob, operation: usize) -> f64 {
    let gear = &job.scene.gear;
    let offset_mm = job.operations[operation].offset_mm;
    let full_mm = job.blank.addendum_mm + job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
    let depth_mm = match operation.checked_sub(1) {
        None => full_mm - offset_mm,
        Some(before) => job.operations[before].offset_mm - offset_mm,
    };
    hoffmeister_mm(
        gear.module_mm,
        f64::from(gear.teeth),
        gear.helix_angle_rad.to_degrees(),
        job.hob.tip_radius_mm,
        f64::from(job.hob.gashes) / f64::from(job.hob.starts),
        job.operations[operation].spec.axial_feed_mm_per_revolution,
        depth_mm.max(0.0),
    )
}
