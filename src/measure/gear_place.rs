//! Names for places on the gear: tooth, side, zone, height over the pitch curve.

use crate::gear::generation::Side;
use crate::job::Job;
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
    /// Place of a point of the gear frame. Tooth j fills the arcs of the pitch curve from (j - 1) to j pitches, its left side the upper half.
    pub fn of(job: &Job, point_mm: DVec2) -> Self {
        let (height_mm, phi_rad) = job.blank.height(point_mm, point_mm.to_angle());
        let teeth = job.scene.gear.teeth;
        let pitches = job.curve.arc_mm(phi_rad) / job.curve.perimeter_mm() * f64::from(teeth);
        let tooth = pitches.floor();
        let module_mm = job.scene.gear.module_mm;
        let zone = match height_mm {
            h if h < -module_mm => Zone::Root,
            h if h < 0.999 * job.blank.addendum_mm => Zone::Flank,
            _ => Zone::Tip,
        };
        Self {
            tooth: (tooth as i64).rem_euclid(i64::from(teeth)) as u32 + 1,
            side: if pitches - tooth < 0.5 { Side::Right } else { Side::Left },
            zone,
            height_mm,
        }
    }
}
