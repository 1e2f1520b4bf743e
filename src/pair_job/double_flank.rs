//! Double-flank rolling: the centre distance without play, against the mate and against masters.
//!
//! In: the pair. Out: variations of the centre distance over a turn, with the composite deviations that double-flank
//! testers report: F_i" over the whole turn, f_i" the largest within one pitch (ISO 1328-2 for round gears; a
//! non-circular gear is rolled at the distances that its pitch curve asks for, and the deviation from them counts).

use std::sync::Arc;

use rayon::prelude::*;

use super::watch::{TIGHT, Watch, WatchedUnits};
use crate::pair::assembly::Meshing;
use crate::pair::double_flank::{Master, TightMesh, against_mate};
use crate::pair::flank_chain::{FlankChain, GearFlanks};
use crate::pair::pitch_pair::{PairTeeth, PitchPair};
use crate::pair::rolling::turns_of_period;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::{GearKind, PitchCurve, PitchCurveShape};
use gearcut_core::units::UM_PER_MM;

/// Places in a pitch: enough to see a pitch's own variation.
const PLACES_PER_PITCH: u32 = 8;
/// Most places of a period that are looked at.
const MOST_PLACES: u32 = 1200;
/// Teeth of a master: no undercut, and of a size that testers have.
pub const MASTER_TEETH: u32 = 30;

/// What rolling in tight mesh has found; else why there is none.
pub type Tight = std::result::Result<DoubleFlank, String>;

/// Variation of the centre distance.
#[derive(Debug, Clone, PartialEq)]
pub struct DoubleFlank {
    /// Angle of the gear since the first place, over all turns, rad, and tight less nominal centre distance, um.
    pub variation_rad_um: Vec<[f64; 2]>,
    places_per_pitch: usize,
}

impl DoubleFlank {
    fn new(variation_rad_um: Vec<[f64; 2]>, pitches: u32) -> Self {
        let places_per_pitch = (variation_rad_um.len() / pitches as usize).max(1);
        Self { variation_rad_um, places_per_pitch }
    }

    /// Largest less smallest value, um.
    pub fn total_um(&self) -> f64 {
        range_um(self.variation_rad_um.iter())
    }

    /// The largest variation within one pitch, um.
    pub fn in_a_pitch_um(&self) -> f64 {
        let n = self.variation_rad_um.len();
        let from =
            |first: usize| range_um((0..=self.places_per_pitch).map(|k| &self.variation_rad_um[(first + k) % n]));
        (0..n).map(from).fold(0.0, f64::max)
    }

    /// The mean, um: how far teeth that are thinner than nominal let the axes come together.
    pub fn mean_um(&self) -> f64 {
        self.variation_rad_um.iter().map(|[_, um]| um).sum::<f64>() / self.variation_rad_um.len() as f64
    }
}

fn range_um<'a>(values: impl Iterator<Item = &'a [f64; 2]>) -> f64 {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), [_, um]| (low.min(*um), high.max(*um)));
    high - low
}

/// Pitches over which both gears are looked at in tight mesh.
pub fn pitches(pitch: &PitchPair) -> u32 {
    let [driver, driven] = pitch.teeth().count;
    (turns_of_period([driver, driven]) * driver).min(MOST_PLACES / PLACES_PER_PITCH)
}

/// Both gears in tight mesh over their period, or over its first 1,200 places where it has more.
///
/// # Errors
/// Ctrl-C.
pub fn with_mate(meshing: &Meshing, watch: &Watch) -> Result<Tight> {
    let pitch = &meshing.pitch;
    let pitches = pitches(pitch);
    let curve = pitch.curve();
    let stage = watch.stage(TIGHT, (pitches * PLACES_PER_PITCH) as usize, "places")?;
    around(pitches, stage, |share| {
        let phi_rad = curve.phi_at_arc(share * f64::from(pitches) * pitch.pitch_mm());
        Ok((phi_rad, against_mate(meshing, phi_rad)?))
    })
}

/// A gear against a round master of 30 teeth, work angles even along its pitch curve; flanks by tooth, in the gear's
/// own frame, moved by its eccentricity. A ring is not rolled: a master of this size may not go into it.
///
/// # Errors
/// No master for these teeth; Ctrl-C.
pub fn with_master(
    curve: &PitchCurve,
    flanks: &GearFlanks<FlankChain>,
    kind: GearKind,
    teeth: &PairTeeth,
    addendum_mm: f64,
    stage: &str,
    watch: &Watch,
) -> Result<Tight> {
    if kind == GearKind::Internal {
        return Ok(Err("a ring is not rolled with a master".to_owned()));
    }
    let round = Arc::new(PitchCurve::new(&PitchCurveShape::Circle, teeth.module_mm, MASTER_TEETH)?);
    let masters = PairTeeth { count: [MASTER_TEETH; 2], driven: GearKind::External, ..*teeth };
    let master = Master::new(&PitchPair::closing(round, masters)?, addendum_mm)?;
    let count = flanks.right.len() as u32;
    let stage = watch.stage(stage, (count * PLACES_PER_PITCH) as usize, "places")?;
    around(count, stage, |share| {
        let phi_rad = curve.phi_at_arc(share * curve.perimeter_mm());
        Ok((phi_rad, master.against(curve, flanks, teeth.module_mm, phi_rad)?))
    })
}

/// All places; a place without a tight mesh leaves the others without a range.
fn around(
    pitches: u32,
    stage: WatchedUnits,
    at: impl Fn(f64) -> Result<(f64, TightMesh), Refusal> + Sync,
) -> Result<Tight> {
    let places = pitches * PLACES_PER_PITCH;
    let one = |i: u32| -> Result<_> {
        let found = at(f64::from(i) / f64::from(places));
        stage.count()?;
        Ok(found.map(|(phi_rad, tight)| [phi_rad, UM_PER_MM * tight.distance_error_mm]))
    };
    let found: Vec<_> = (0..places).into_par_iter().map(one).collect::<Result<_>>()?;
    stage.finish();
    // Of several places without a tight mesh the first one is named, whichever thread found it.
    let variation: std::result::Result<_, Refusal> = found.into_iter().collect();
    Ok(variation.map(|variation| DoubleFlank::new(variation, pitches)).map_err(|nowhere| nowhere.problem))
}
