//! Names for places on the gear: tooth, side, zone, height over the pitch curve.

use crate::scene::model::Gear;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use glam::DVec2;

/// Part of a tooth's height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Zone {
    /// Deeper than a module below the pitch curve: the root and its fillets.
    Root,
    /// Within a module of the pitch curve.
    Flank,
    /// Higher: the tip.
    Tip,
}

/// A place on the gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearPlace {
    /// Tooth, from 1; roots belong to the nearer tooth.
    pub tooth: u32,
    /// Its nearer side.
    pub side: Side,
    /// Part of its height.
    pub zone: Zone,
    /// Height over the pitch curve along its normal, mm.
    pub height_mm: f64,
}

impl Zone {
    /// `root`, `flank` or `tip`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Root => "root",
            Self::Flank => "flank",
            Self::Tip => "tip",
        }
    }
}

impl GearPlace {
    /// Place of a point of a section in which the teeth stand `turned_mm` further along the pitch curve. Tooth j fills
    /// the arcs of the pitch curve from (j - 1) to j pitches, its left side the upper half.
    pub fn in_section(blank: &Blank, gear: &Gear, point_mm: DVec2, turned_mm: f64) -> Self {
        let (height_mm, phi_rad) = blank.height(point_mm, point_mm.to_angle());
        let teeth = gear.teeth;
        let curve = blank.curve();
        let per_turn = f64::from(curve.pitches());
        let pitches = (curve.arc_mm(phi_rad) - turned_mm) / curve.perimeter_mm() * per_turn;
        let tooth = pitches.floor();
        let zone = match height_mm {
            h if h < -gear.module_mm => Zone::Root,
            h if h < 0.999 * blank.addendum_mm => Zone::Flank,
            _ => Zone::Tip,
        };
        Self {
            // On the dwell of a sector the last tooth.
            tooth: (tooth.rem_euclid(per_turn) as u32).min(teeth - 1) + 1,
            side: if pitches - tooth < 0.5 { Side::Right } else { Side::Left },
            zone,
            height_mm,
        }
    }
}
