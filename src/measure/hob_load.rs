//! Load of every hob tooth: what each takes out of the gear's spaces over a whole operation.
//!
//! In: the passes of an operation, the pitch curve, the hob. Out: for every tooth the area taken out of transverse slices of the spaces and the largest uncut chip thickness.
//!
//! **Ledger.** Rays stand on the pitch curve along its normals, from under the root to the blank's outline, side by side over one pitch. A hob tooth widens from tip to root, so on
//! such a ray it always takes what lies above its edge: one height per ray is all that is left after each pass, and passes in the order of time give each its own chip. A length
//! dh at height h stands for the area (1 + h / rho) dh ds. No candidate is left out: what a pruned pass would have taken would be booked on another.
//!
//! **Thickness** is the length taken from a ray times the cosine between ray and the edge's swept surface: across the chip where it is thin against the edge's curvature.
//!
//! **Load is not life.** The area taken is a measure of work done, as long as the specific cutting force is taken as constant along the edge; thin chips cost more force per area, and wear
//! follows temperature and thickness besides. Ratios of load say which teeth work and how evenly; they say nothing of hours.

use crate::cut::CutStats;
use crate::cut::cpu::Cpu;
use crate::dexel::{Ray, SpatialField};
use crate::gear::PitchCurve;
use crate::passes::{HobTeeth, SweepPlan};
use crate::tool::edge::Edge;
use glam::DVec3;

/// What a tooth took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ToothLoad {
    /// Area taken, summed over all slices, mm^2.
    pub area_mm2: f64,
    /// Largest uncut chip thickness, mm.
    pub thickness_mm: f64,
    /// Passes that took anything.
    pub passes: u64,
}

/// Where the ledger's rays stand.
#[derive(Debug, Clone, PartialEq)]
pub struct LedgerGrid {
    /// Transverse slices, gear frame, mm.
    pub slices_mm: Vec<f64>,
    /// Distance of the rays along the pitch curve, mm.
    pub spacing_mm: f64,
    /// Lowest and highest height over the pitch curve: below the root, and the blank's outline, mm.
    pub heights_mm: [f64; 2],
}

/// Loads of all teeth in blade order over one space, and what the kernel met. The space's middle crosses the pitch line at the arc `space_arc_mm(z)` in the slice z.
pub fn of_space(
    curve: &PitchCurve,
    passes: &HobTeeth,
    edge: &Edge,
    grid: &LedgerGrid,
    pitch_mm: f64,
    space_arc_mm: impl Fn(f64) -> f64,
) -> (Vec<ToothLoad>, CutStats) {
    let columns = (pitch_mm / grid.spacing_mm).round().max(1.0) as usize;
    let step_mm = pitch_mm / columns as f64;
    let [low_mm, high_mm] = grid.heights_mm;
    let mut spread = vec![0.0; columns];
    let field = SpatialField::new(columns, grid.slices_mm.len(), low_mm, |column, row| {
        let z_mm = grid.slices_mm[row];
        let arc_mm = space_arc_mm(z_mm) + step_mm * (column as f64 + 0.5) - 0.5 * pitch_mm;
        let frame = curve.frame(curve.phi_at_arc(arc_mm));
        // The slices of one space lie on a short piece of the curve: the last one's bend stands for all.
        spread[column] = frame.curvature_per_mm;
        let ray = Ray {
            origin_mm: DVec3::new(frame.point_mm.x, frame.point_mm.y, z_mm),
            normal: DVec3::new(frame.normal.x, frame.normal.y, 0.0),
        };
        (ray, high_mm)
    });
    let plan = SweepPlan::brute_force(&field, passes, edge);
    let mut layer = field.blank_layer();
    let (stats, taken) = Cpu::default().cut_with_ledger(&field, edge, &plan, &spread, &mut layer);
    let mut loads = vec![ToothLoad::default(); passes.places.len()];
    let mut last_pass = None;
    for (record, taken) in plan.records.iter().zip(&taken).filter(|(_, taken)| taken.rays > 0) {
        let load = &mut loads[passes.blade_of(record.pass).1 as usize];
        load.area_mm2 += taken.length_mm * step_mm;
        load.thickness_mm = load.thickness_mm.max(taken.thickness_mm);
        load.passes += u64::from(last_pass != Some(record.pass));
        last_pass = Some(record.pass);
    }
    (loads, stats)
}

/// Largest load over the mean of the teeth that carry at least a hundredth of it, and the number of these teeth.
pub fn peak_to_mean(loads: &[ToothLoad]) -> Option<(f64, usize)> {
    let peak = loads.iter().map(|load| load.area_mm2).fold(0.0, f64::max);
    let in_use: Vec<f64> = loads.iter().map(|l| l.area_mm2).filter(|&area| area > 0.01 * peak).collect();
    (peak > 0.0).then(|| (peak * in_use.len() as f64 / in_use.iter().sum::<f64>(), in_use.len()))
}

/// Largest tip chip thickness of axial hobbing by Hoffmeister's formula (B. Hoffmeister, Über den Verschleiß am Wälzfräser, dissertation, RWTH Aachen 1970), mm:
///
/// `4.9 m z^(9.25e-3 beta - 0.542) e^(-0.015 beta) (r_a0 / m)^(-8.25e-3 beta - 0.225) (i / z0)^-0.877 (f_a / m)^0.511 (a / m)^0.319`
///
/// beta in degrees, i gashes, z0 starts, a depth. Fitted to simulated chips of round gears without profile shift: a sanity check, some ten per cent wide.
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
