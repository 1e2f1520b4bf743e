//! Load of every hob tooth: what each takes out of the gear over the whole process.
//!
//! In: what every pass took of the blank field (all spaces, the whole face, approach and overrun). Out: for every tooth
//! the volume taken, the largest uncut chip thickness and the travel in the cut.
//!
//! **Volume**: lengths taken from the rays of both families, their mean. **Thickness**: the largest distance of a place
//! of the surface that a pass leaves from the surface that it finds, in a slice, times the cosine between slice and
//! swept surface. Of every place only the ray counts that meets it within 45 degrees of its normal: it gives the
//! distance of both surfaces at its ends, exact where they are straight or circles about one point. Where the other end
//! is no old surface (a tooth that plunges) or lies on another facet, the nearest old place bounds it, the old surface
//! going on along its tangent for half the rays' distance; and a disc about that place has to fit into the chip. Not
//! taken: the path along the normal until the material ends. Thin chips have the same, but for a tooth that plunges it
//! runs across the whole tooth. **Travel in the cut**: for each pass the slices in which it takes anything, each worth
//! the tip's travel through the slice's share of the face.
//!
//! **Load is not life.** The volume taken is a measure of work done, as long as the specific cutting force is taken as
//! constant along the edge; thin chips cost more force per area, and wear follows temperature and thickness besides.
//! Ratios of load say which teeth work and how evenly; they say nothing of hours.

use crate::process::hobbing::Hob;
use crate::process::hobbing::hob::HobEnd;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::passes::TurningPasses;

/// Teeth with less than this share of the hardest working tooth's volume are not called in use.
const IN_USE: f64 = 0.01;
/// A tooth at an end of the hob takes the share of teeth that are not there if its thickest chip is so many times that
/// of the tooth beside it: a choice. From tooth to tooth inside the hob chips differ by tenths.
const OVER_ITS_NEIGHBOUR: f64 = 2.0;

/// What a tooth took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ToothLoad {
    /// Volume taken, mm^3.
    pub volume_mm3: f64,
    /// Largest uncut chip thickness, mm.
    pub thickness_mm: f64,
    /// Travel of its tip through the work while any part of its edge takes material, mm.
    pub travel_mm: f64,
    /// Passes that took anything.
    pub passes: u64,
}

/// Loads of one operation.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationLoad {
    /// Teeth in blade order.
    pub teeth: Vec<ToothLoad>,
}

impl OperationLoad {
    /// Loads of the whole process, from what every pass took of the blank field.
    pub fn of_blank(passes: &TurningPasses, chips: &[PassChip]) -> Self {
        let mut teeth = vec![ToothLoad::default(); passes.places.len()];
        for chip in chips {
            let load = &mut teeth[passes.blade_of(chip.pass).1 as usize];
            load.volume_mm3 += chip.volume_mm3();
            load.thickness_mm = load.thickness_mm.max(chip.thickness_mm);
            load.travel_mm += chip.travel_mm;
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

    /// The end of the hob at which a tooth takes the share of teeth that are not there, if it does.
    pub fn end_that_is_missed(&self, hob: &Hob, tooth: usize) -> Option<HobEnd> {
        let (end, beside) = hob.end_at(tooth)?;
        let [own_mm, beside_mm] = [tooth, beside].map(|of| self.teeth[of].thickness_mm);
        (own_mm > OVER_ITS_NEIGHBOUR * beside_mm).then_some(end)
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
