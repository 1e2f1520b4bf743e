//! What a drawn tooth leaves of a space: points, what of them are flanks and root, and all spaces of a generation.
//!
//! In: what [`super::drawn`] finds. Out: [`SpaceProfile`], kept space by space in [`DrawnSpaces`].

use crate::process::shaping::tool::drawn::DrawnTooth;
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::tool::edge::SegmentName;
use glam::DVec2;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Points nearer than this are one, mm.
pub(super) const SAME_MM: f64 = 1e-9;

/// A flank that has lost less is not undercut, mm: rounding where parts meet.
const LEAST_UNDERCUT_MM: f64 = 1e-6;

/// A point of the envelope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvelopePoint {
    /// Parameter of the linkage, rad.
    pub phi_rad: f64,
    /// Point, gear frame, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear.
    pub normal: DVec2,
    /// Part of the drawn tooth that touches there.
    pub part: usize,
}

impl EnvelopePoint {
    /// Whether it is one with another point. A corner is two points, one with either normal.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.point_mm.distance(other.point_mm) < SAME_MM && self.normal.distance(other.normal) < SAME_MM
    }
}

/// The envelope of one space, without what is cut away.
#[derive(Debug, Clone)]
pub struct SpaceProfile {
    /// From the cutter's right root to its left root, as far as the blank reaches, and one point beyond at either end.
    pub(super) points: Vec<EnvelopePoint>,
    /// What was cut away: loops by the crossing that replaces them.
    pub(super) loops: Vec<Vec<EnvelopePoint>>,
    /// Index of the last point of the right flank and of the first one of the left flank.
    pub(super) flanks: [usize; 2],
}

/// Spaces of one generation, each found once.
#[derive(Debug)]
pub struct DrawnSpaces {
    pub(super) blank: Blank,
    found: Mutex<BTreeMap<i64, Result<Arc<SpaceProfile>, Refusal>>>,
}

impl DrawnSpaces {
    /// None so far; of a gear from this blank.
    pub fn new(blank: Blank) -> Self {
        Self { blank, found: Mutex::default() }
    }

    /// A space that is known already, or as it is found.
    ///
    /// # Errors
    /// Why it is not found.
    pub(super) fn known_or(
        &self,
        space: i64,
        find: impl FnOnce() -> Result<SpaceProfile, Refusal>,
    ) -> Result<Arc<SpaceProfile>, Refusal> {
        let known = self.found.lock().unwrap_or_else(PoisonError::into_inner).get(&space).cloned();
        known.unwrap_or_else(|| {
            let found = find().map(Arc::new);
            self.found.lock().unwrap_or_else(PoisonError::into_inner).insert(space, found.clone());
            found
        })
    }
}

impl SpaceProfile {
    /// Points of the root, from the cutter's right flank to its left one.
    pub fn root(&self) -> &[EnvelopePoint] {
        let [right, left] = self.flanks;
        &self.points[right.min(left)..=left.max(right)]
    }

    /// Points of one flank from where it begins towards the tip: that of the cutter's left flank or right one.
    pub fn flank(&self, is_left: bool) -> Vec<EnvelopePoint> {
        let [right, left] = self.flanks;
        if is_left { self.points[left..].to_vec() } else { self.points[..=right].iter().rev().copied().collect() }
    }

    /// How deep the root lies under what was cut away of a flank, mm, if something was.
    pub fn undercut_mm(&self, is_left: bool, tooth: &DrawnTooth) -> Option<f64> {
        let name = if is_left { SegmentName::FlankLeft } else { SegmentName::FlankRight };
        let root = self.root();
        let over_mm =
            |of: &EnvelopePoint| root.iter().map(|at| at.point_mm.distance(of.point_mm)).fold(f64::INFINITY, f64::min);
        let [right, left] = self.flanks;
        let begins = self.points[if is_left { left } else { right }].point_mm;
        let is_there = |lost: &&Vec<EnvelopePoint>| lost[0].point_mm.distance(begins) < SAME_MM;
        let depth_mm = |lost: &Vec<EnvelopePoint>| {
            // From where the flank is crossed down to the cusp, behind which the envelope turns back into the air.
            let flank = lost[1..].iter().filter(|at| tooth.parts[at.part].name == name);
            let mut flank: Vec<&EnvelopePoint> = flank.collect();
            if is_left {
                flank.reverse();
            }
            let way = |pair: &[&EnvelopePoint]| (pair[1].point_mm - pair[0].point_mm).dot(pair[0].normal.perp());
            let first = flank.windows(2).next().map_or(0.0, way);
            let down = flank.windows(2).take_while(|pair| way(pair) * first > 0.0);
            down.map(|pair| over_mm(pair[0])).fold(0.0, f64::max)
        };
        self.loops.iter().filter(is_there).map(depth_mm).reduce(f64::max).filter(|mm| *mm > LEAST_UNDERCUT_MM)
    }
}
