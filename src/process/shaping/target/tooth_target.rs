//! Targets of all teeth, each found once: both flanks, where they cross the pitch curve, the tip land.
//!
//! In: the finishing operation's generation, the blank. Out: a [`ToothTarget`] for every tooth. Dexels, windows,
//! outlines, meshes and reports all ask for places on the same flanks.
//!
//! A tooth whose flanks cross below the blank's outline is **pointed**: its flanks end where they meet, at the height
//! over the pitch curve at which the tip land has shrunk to nothing.
//!
//! Some kilobytes stay in memory for each tooth. Road not taken: to find a flank again for whoever asks. It takes a
//! thousand contacts, and a run asks a dozen times.

use crate::measure::crossing::Crossing;
use crate::process::shaping::target::TargetFlank;
use crate::process::shaping::target::generation::Generation;
use crate::process::shaping::target::tip_relief::TipRelief;
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::math::roots::try_halve;
use gearcut_core::terms::Side;
use rayon::prelude::*;
use std::sync::Arc;

/// A tip land narrower than this is a point, mm.
const POINTED_MM: f64 = 1e-3;

/// Target of one tooth.
#[derive(Debug, Clone)]
pub struct ToothTarget {
    left: TargetFlank,
    right: TargetFlank,
    pitch_crossings: [Option<Crossing>; 2],
    /// Tip land: from the left flank's tip to the right one's along the outline's direction, mm.
    pub tip_land_mm: f64,
}

impl ToothTarget {
    /// Targets of the teeth 1 to `teeth`, in order.
    ///
    /// # Errors
    /// The first tooth on which the cutter generates no flank, or which is pointed below the pitch curve.
    pub fn of_all(generation: &Arc<Generation>, blank: &Blank, teeth: u32) -> Result<Vec<Self>, Refusal> {
        let found: Vec<Result<Self, Refusal>> =
            (1..=teeth).into_par_iter().map(|tooth| Self::shifted(generation, blank, tooth, 0.0)).collect();
        // In order of teeth: whichever thread was first, the same tooth is blamed.
        found.into_iter().collect()
    }

    /// Target of a tooth that stands `shift` pitches further along the pitch curve.
    ///
    /// # Errors
    /// As for [`Self::of_all`].
    pub fn shifted(generation: &Arc<Generation>, blank: &Blank, tooth: u32, shift: f64) -> Result<Self, Refusal> {
        let up_to = |height_mm: Option<f64>| -> Result<(TargetFlank, TargetFlank, f64), Refusal> {
            let flank = |side| TargetFlank::as_generated(generation, blank, tooth, side, shift, height_mm);
            let (left, right) = (flank(Side::Left)?, flank(Side::Right)?);
            let tip_land_mm = tip_land_mm(blank, &left, &right);
            Ok((left, right, tip_land_mm))
        };
        let whole = up_to(None)?;
        let (left, right, tip_land_mm) = if whole.2 > 0.0 {
            whole
        } else {
            let wider = |height_mm: f64| Ok::<bool, Refusal>(up_to(Some(height_mm))?.2 > POINTED_MM);
            let [pointed_mm, _] = try_halve(wider, 0.0, blank.addendum_mm, 40)?;
            if pointed_mm == 0.0 {
                let drawn = generation.cutter.drawn().map(|drawn| drawn.place.file_key());
                let (key, way_out) = if let Some(file) = &drawn {
                    let way_out = "have the tooth drawn thinner, or without the notch that runs into its other flank";
                    (file.as_str(), way_out)
                } else {
                    let way_out = "use a larger module, a cutter with less profile shift, or a smaller thickness \
                                   allowance";
                    ("gear.tooth_thickness_allowance_mm", way_out)
                };
                return Err(Refusal::new(
                    key,
                    format!("tooth {tooth}: its flanks meet below the pitch curve"),
                    way_out,
                ));
            }
            up_to(Some(pointed_mm))?
        };
        // Undercut is found once the tips are: it ends flanks at their foot and leaves the tip land.
        let (left, right) = (left.whole_part(blank)?, right.whole_part(blank)?);
        let pitch_crossings = [&left, &right].map(|flank| flank.pitch_crossing(blank));
        Ok(Self { left, right, pitch_crossings, tip_land_mm })
    }

    /// One of its flanks.
    pub fn flank(&self, side: Side) -> &TargetFlank {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// Where one of them crosses the pitch curve; `None` where its involute does not reach the curve.
    pub fn pitch_crossing(&self, side: Side) -> Option<Crossing> {
        self.pitch_crossings[usize::from(side == Side::Right)]
    }
}

/// Negative if the flanks have crossed. Behind the end of a cutter's involute the tip lies where its base leaves it.
fn tip_land_mm(blank: &Blank, left: &TargetFlank, right: &TargetFlank) -> f64 {
    let tip = |flank: &TargetFlank| {
        let end = flank.at_arc(flank.length_mm());
        (TipRelief::new(flank, blank).map_or(end.point_mm, |relief| relief.at(1.0)), end.phi_rad)
    };
    let ((l, l_rad), (r, r_rad)) = (tip(left), tip(right));
    let foot_rad = blank.height(0.5 * (l + r), 0.5 * (l_rad + r_rad)).1;
    (l - r).dot(blank.curve().frame(foot_rad).tangent)
}
