//! Cutting force of every hob tooth over time, by the work's material.
//!
//! In: what every pass took of the blank field slice by slice, the hob's motion, the material. Out: force and power of
//! every pass ([`PassForce`]), of every tooth ([`ToothForce`]) and of the operation ([`OperationForce`]).
//!
//! **Law**: that of shaping, element by element of the edge (Altintas, Manufacturing Automation, 2012, section 2.4; see
//! [`crate::material`]): F = K_c A + K_ce L, A the section of the chip in the rake face and L the length of edge in
//! engagement. While a tooth goes through a slice its tip travels s; it takes the volume V there, and its edge sweeps
//! the area S inside the material ([`gearcut_core::cut::sweep_chips`]). A = V / s and L = S / s are the means over that
//! travel.
//!
//! **Referred to the tip.** Elements nearer to the hob's axis travel less than the tip. F is the moment of the cutting
//! forces about the hob's axis over the tip's radius: F s is the work of the pass in the slice, and F times the tip's
//! speed its power. The plain sum of the elements' forces is larger, at most by the tip's radius over that of the
//! innermost place that cuts. Not taken: forces of each element at its own radius. Their sum belongs to no moment and
//! to no power.
//!
//! Rake faces are taken as square to the motion, as axial gashes at zero rake are; gashes across the thread lean by the
//! lead angle, whose cosine is 0.997 at 4.5 deg.

use crate::material::CuttingForce;
use crate::process::hobbing::linkage::HobbingLinkage;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::passes::TurningPasses;

/// Force of one pass of a hob tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassForce {
    /// Turn of the hob.
    pub turn: i64,
    /// Hob tooth, index in blade order.
    pub tooth: usize,
    /// When the tooth points to the work, s.
    pub time_s: f64,
    /// Largest cutting force in any slice, N.
    pub peak_n: f64,
    /// Largest section of the chip, mm2.
    pub section_mm2: f64,
    /// Largest length of edge in engagement, mm.
    pub edge_mm: f64,
    /// Work, N mm.
    pub work_nmm: f64,
    /// Travel of the tip while any part of the edge takes material, mm.
    pub travel_mm: f64,
    /// Speed of the tip, mm/s.
    pub speed_mm_per_s: f64,
}

/// Force of one hob tooth over an operation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ToothForce {
    /// Largest cutting force, N.
    pub peak_n: f64,
    /// Largest section of a chip, mm2.
    pub section_mm2: f64,
    /// Largest length of edge in engagement, mm.
    pub edge_mm: f64,
    /// Area that the edge swept in the material over the travel: the mean length of edge in engagement, mm.
    pub mean_edge_mm: f64,
    /// Work, N mm.
    pub work_nmm: f64,
    /// Travel of the tip in the cut, mm.
    pub travel_mm: f64,
    /// Largest power, N mm/s.
    pub power_nmm_per_s: f64,
}

/// Forces of one operation.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationForce {
    /// Teeth in blade order.
    pub teeth: Vec<ToothForce>,
    /// Passes that took anything, in order of time.
    pub passes: Vec<PassForce>,
    /// Time of the operation, s.
    pub duration_s: f64,
}

impl PassForce {
    /// Mean cutting force over the travel in the cut, N.
    pub fn mean_n(&self) -> f64 {
        self.work_nmm / self.travel_mm
    }

    /// Power at the largest force, N mm/s.
    pub fn power_nmm_per_s(&self) -> f64 {
        self.peak_n * self.speed_mm_per_s
    }
}

impl ToothForce {
    /// Mean cutting force over the travel in the cut, N; `None` where the tooth takes nothing.
    pub fn mean_n(&self) -> Option<f64> {
        (self.travel_mm > 0.0).then(|| self.work_nmm / self.travel_mm)
    }
}

impl OperationForce {
    /// Forces of a hob with this tip radius, from what its passes took slice by slice.
    pub fn new(
        passes: &TurningPasses,
        linkage: &HobbingLinkage,
        tip_radius_mm: f64,
        material: CuttingForce,
        in_slices: &[PassChip],
    ) -> Self {
        let mut of_passes: Vec<Option<PassForce>> = vec![None; passes.count() as usize];
        let mut teeth = vec![ToothForce::default(); passes.places.len()];
        for chip in in_slices {
            let index = chip.pass - passes.first_pass;
            let (turn, blade) = passes.blade_of(chip.pass);
            let tooth = blade as usize;
            let of_pass = of_passes[index as usize].get_or_insert_with(|| {
                let time_s = linkage.time_at_hob_angle(passes.pass(index).tool_angle_rad);
                let speed_mm_per_s = tip_radius_mm * linkage.axes::<2>(time_s).hob_rad.derivative(1);
                PassForce {
                    turn,
                    tooth,
                    time_s,
                    peak_n: 0.0,
                    section_mm2: 0.0,
                    edge_mm: 0.0,
                    work_nmm: 0.0,
                    travel_mm: 0.0,
                    speed_mm_per_s,
                }
            });
            let volume_mm3 = chip.volume_mm3();
            let work_nmm = material.on_chip(volume_mm3, chip.swept_mm2);
            of_pass.peak_n = of_pass.peak_n.max(work_nmm / chip.travel_mm);
            of_pass.section_mm2 = of_pass.section_mm2.max(volume_mm3 / chip.travel_mm);
            of_pass.edge_mm = of_pass.edge_mm.max(chip.swept_mm2 / chip.travel_mm);
            of_pass.work_nmm += work_nmm;
            of_pass.travel_mm += chip.travel_mm;
            teeth[tooth].mean_edge_mm += chip.swept_mm2;
        }
        let of_passes: Vec<PassForce> = of_passes.into_iter().flatten().collect();
        for pass in &of_passes {
            let tooth = &mut teeth[pass.tooth];
            tooth.peak_n = tooth.peak_n.max(pass.peak_n);
            tooth.section_mm2 = tooth.section_mm2.max(pass.section_mm2);
            tooth.edge_mm = tooth.edge_mm.max(pass.edge_mm);
            tooth.work_nmm += pass.work_nmm;
            tooth.travel_mm += pass.travel_mm;
            tooth.power_nmm_per_s = tooth.power_nmm_per_s.max(pass.power_nmm_per_s());
        }
        for tooth in teeth.iter_mut().filter(|tooth| tooth.travel_mm > 0.0) {
            tooth.mean_edge_mm /= tooth.travel_mm;
        }
        Self { teeth, passes: of_passes, duration_s: linkage.end_s() }
    }

    /// Work of all teeth, N mm.
    pub fn work_nmm(&self) -> f64 {
        self.teeth.iter().map(|tooth| tooth.work_nmm).sum()
    }

    /// The pass in which `value` is largest; `None` where nothing is cut.
    pub fn peak(&self, value: impl Fn(&PassForce) -> f64) -> Option<&PassForce> {
        self.passes.iter().max_by(|a, b| value(a).total_cmp(&value(b)))
    }
}
