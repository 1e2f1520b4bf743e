//! Where blades take more than their slot: into the next tooth, or below the target of their own flanks.
//!
//! In: a job. Out: how deep and where, and warnings with numbers, before anything is cut. A few rays of each flank are
//! cut by the passes of one slot alone.

use super::blank::CellGrid;
use super::job::BevelJob;
use super::notices::{NextTooth, Undercut};
use crate::findings::Notice;
use gearcut_core::cut::Backend as _;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::Result;
use gearcut_core::passes::SweepPlan;
use gearcut_core::terms::Side;

/// Rays along the profile, closer together towards the form point, where undercut is a band some tenths of a millimetre
/// wide, and along the tooth.
const PLACES: [usize; 2] = [24, 16];
/// Blades that go deeper than this are worth a word, mm.
const HIT_MM: f64 = 0.005;

/// The deepest cut below the target of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeepestCut {
    /// How deep, along the target's normal, mm; 0 where nothing goes below it.
    pub depth_mm: f64,
    /// Depth to which rays record cuts, mm: one as deep may be deeper.
    pub floor_mm: f64,
    /// Which flanks.
    pub side: Side,
    /// Arc from the form point in the middle of the face, and place along the tooth, mm.
    pub at_mm: [f64; 2],
}

impl DeepestCut {
    /// How deep, in words.
    fn depth(&self) -> String {
        let at_least = if self.depth_mm < self.floor_mm { "" } else { "at least " };
        format!("{at_least}{:.3}", self.depth_mm)
    }
}

impl BevelJob {
    /// How deep blades go below the flanks of a tooth while slots are cut that stand so many spaces beside its own.
    ///
    /// # Errors
    /// A place that the head does not cut.
    pub fn deepest_cut(&self, side: Side, spaces: &[u32]) -> Result<DeepestCut> {
        let (teeth, own) = (self.blank.teeth, self.space_of(1, side));
        let even = |count: usize, i: usize| i as f64 / (count - 1) as f64;
        let length_mm = self.target_of(side).length_mm();
        let arcs_mm: Vec<f64> = (0..PLACES[0]).map(|i| length_mm * even(PLACES[0], i).powi(2)).collect();
        let rows_mm: Vec<f64> = (0..PLACES[1]).map(|i| self.blank.face_width_mm * (even(PLACES[1], i) - 0.5)).collect();
        let rays = self.rays_over(1, side, arcs_mm, rows_mm)?;
        let mut layer = rays.field.blank_layer();
        for &beside in spaces {
            for operation in 0..self.operations.len() {
                let set = self.slots.of(operation, (own + beside) % teeth);
                Cpu::default().cut_spatial(&rays.field, &SweepPlan::of_near_passes(&rays.field, set), &mut layer)?;
            }
        }
        let floor_mm = f64::from(-rays.field.low_mm as f32);
        let mut deepest = DeepestCut { depth_mm: 0.0, floor_mm, side, at_mm: [0.0; 2] };
        for (i, (&height_mm, &pass)) in layer.heights_mm.iter().zip(&layer.passes).enumerate() {
            let depth_mm = -f64::from(height_mm);
            if pass != NO_PASS && depth_mm > deepest.depth_mm {
                let at_mm = [rays.arcs_mm[i / PLACES[1]], rays.rows_mm[i % PLACES[1]]];
                deepest = DeepestCut { depth_mm, at_mm, ..deepest };
            }
        }
        Ok(deepest)
    }

    /// The same over the flanks of both sides.
    fn deepest_of_sides(&self, spaces: &[u32]) -> Result<DeepestCut> {
        let [left, right] = [Side::Left, Side::Right].map(|side| self.deepest_cut(side, spaces));
        let (left, right) = (left?, right?);
        Ok(if right.depth_mm > left.depth_mm { right } else { left })
    }

    /// A head that hits the next tooth.
    ///
    /// # Errors
    /// A place that the head does not cut.
    pub fn next_tooth_warning(&self) -> Result<Option<Notice>> {
        let deepest = self.deepest_of_sides(&[1, self.blank.teeth - 1])?;
        // A ray that goes through a thin tooth meets the slot beyond it, which its own blades cut: no hit where bounds
        // say that blades stay in their cells.
        let is_hit = deepest.depth_mm > HIT_MM && self.neighbours_may_reach(&CellGrid::of_scene(self)?);
        Ok(is_hit.then(|| {
            let along_mm = format!("{:.1}", deepest.at_mm[1]);
            NextTooth { depth_mm: deepest.depth(), side: deepest.side.name(), along_mm }.notice()
        }))
    }

    /// A flank that its own blades cut away again, as on pinions with few teeth. Blades that
    /// stand out and a machine with errors are meant to leave the target, and are no undercut.
    ///
    /// # Errors
    /// A place that the head does not cut.
    pub fn undercut_warning(&self) -> Result<Option<Notice>> {
        if self.spec.settings.errors.iter().any(|(_, error)| *error != 0.0) {
            return Ok(None);
        }
        let stands_out_mm = self.head.runouts_mm.iter().fold(0.0_f64, |most, runout| most.max(runout.abs()));
        let deepest = self.deepest_of_sides(&[0])?;
        Ok((deepest.depth_mm > HIT_MM + stands_out_mm).then(|| {
            let [arc_mm, along_mm] = deepest.at_mm;
            let undercut = Undercut {
                depth_mm: deepest.depth(),
                side: deepest.side.name(),
                arc_mm: format!("{arc_mm:.2}"),
                along_mm: format!("{:.1}", along_mm.abs()),
                end: if along_mm < 0.0 { "toe" } else { "heel" },
            };
            undercut.notice()
        }))
    }
}
