//! Where the cutter's teeth of one space come: passes of other teeth that stay out of there change none of its chips.
//!
//! In: the closed polygon of a tooth, its poses in a section. Out: the region that some passes sweep, and whether
//! another pass comes into it.
//!
//! **The law.** A chip of a space is what one of its own teeth finds inside its polygon; where it ends inside, it ends
//! on what passes before left there. A pass that comes nowhere into the polygons of all own passes leaves that as it
//! is, and chips are the same without it, bit for bit (test in `ledger`). Of the passes near a space two
//! thirds are those of the teeth that cut the next spaces, on the other side of a tooth of the gear.
//!
//! The region is kept in strips along the direction out of the gear, from the deepest place up to where material ends:
//! in each strip the interval across that holds all own polygons. Polygons are coarse, and intervals wider by what that
//! leaves out.

use crate::process::shaping::tool::edge_polygon::EdgePolygon;
use gearcut_core::frame::Rigid2;
use glam::DVec2;

/// Height of a strip, mm. It decides about time alone.
const STRIP_MM: f64 = 0.25;
/// Corners that lie this near to a chord are left out, mm. It decides about time alone.
const OFF_MM: f64 = 0.01;
/// Places this near count as one, mm: more than rounding, and than the shortest material that sections keep.
const ROUNDING_MM: f64 = 1e-4;

/// A tooth's polygon with few corners.
#[derive(Debug)]
pub(super) struct CoarseTooth {
    /// Corners of a closed polygon, blade frame.
    corners_mm: Vec<DVec2>,
    /// How far the tooth's own polygon departs from it at most, mm.
    off_mm: f64,
}

impl CoarseTooth {
    /// Leaves out corners that lie near the chord between those before and after them.
    pub(super) fn new(polygon: &EdgePolygon) -> Self {
        let corners = &polygon.corners_mm;
        let off_mm = |from: usize, to: usize| {
            let chord = (corners[to] - corners[from]).normalize_or_zero();
            let between = corners[from + 1..to].iter();
            between.map(|&p| chord.perp_dot(p - corners[from]).abs()).fold(0.0, f64::max)
        };
        let mut kept = vec![0];
        let mut from = 0;
        while from + 1 < corners.len() {
            let mut to = from + 1;
            while to + 1 < corners.len() && off_mm(from, to + 1) <= OFF_MM {
                to += 1;
            }
            kept.push(to);
            from = to;
        }
        Self { corners_mm: kept.into_iter().map(|corner| corners[corner]).collect(), off_mm: OFF_MM }
    }
}

/// An interval across the direction out of the gear, mm; empty while its ends are the wrong way round.
type Across = [f64; 2];

const EMPTY: Across = [f64::INFINITY, f64::NEG_INFINITY];

/// The region that passes sweep, strip by strip.
#[derive(Debug)]
pub(super) struct SweptRegion<'a> {
    tooth: &'a CoarseTooth,
    /// Out of the gear, section frame.
    out: DVec2,
    /// Where material ends, along `out`, mm.
    top_mm: f64,
    /// What polygons are taken wider by, mm.
    margin_mm: f64,
    /// Where the first strip begins, along `out`, mm.
    low_mm: f64,
    strips: Vec<Across>,
}

impl<'a> SweptRegion<'a> {
    /// Swept by a tooth at some poses. Material ends at `top_mm` along `out`; passes may stand elsewhere by as much as
    /// `room_mm`.
    pub(super) fn new<'p>(
        tooth: &'a CoarseTooth,
        out: DVec2,
        top_mm: f64,
        room_mm: f64,
        section_from_blade: impl Iterator<Item = &'p Rigid2> + Clone,
    ) -> Self {
        let margin_mm = tooth.off_mm + room_mm + ROUNDING_MM;
        let depths_mm = section_from_blade
            .clone()
            .flat_map(|pose| tooth.corners_mm.iter().map(move |&corner| pose.point(corner).dot(out)));
        let low_mm = depths_mm.fold(top_mm, f64::min) - margin_mm;
        let count = ((top_mm - low_mm + 2.0 * margin_mm) / STRIP_MM).ceil() as usize;
        let mut region = Self { tooth, out, top_mm, margin_mm, low_mm, strips: vec![EMPTY; count] };
        let mut of_pass = Vec::new();
        for pose in section_from_blade {
            region.lay(pose, &mut of_pass);
            for (all, one) in region.strips.iter_mut().zip(&of_pass) {
                *all = [all[0].min(one[0]), all[1].max(one[1])];
            }
        }
        region
    }

    /// Whether a tooth at a pose may come into the region; `scratch` is overwritten.
    pub(super) fn is_entered_by(&self, section_from_blade: &Rigid2, scratch: &mut Vec<Across>) -> bool {
        self.lay(section_from_blade, scratch);
        self.strips.iter().zip(scratch.iter()).any(|(own, other)| own[0] <= other[1] && other[0] <= own[1])
    }

    /// The interval across that holds a tooth, in each strip.
    fn lay(&self, section_from_blade: &Rigid2, strips: &mut Vec<Across>) {
        strips.clear();
        strips.resize(self.strips.len(), EMPTY);
        let Some(&last) = self.tooth.corners_mm.last() else { return };
        let placed = |corner: DVec2| {
            let p = section_from_blade.point(corner);
            DVec2::new(p.dot(self.out), p.perp_dot(self.out))
        };
        let mut a = placed(last);
        for &corner in &self.tooth.corners_mm {
            let b = placed(corner);
            self.lay_chord(a, b, strips);
            a = b;
        }
    }

    /// Widens the strips' intervals by a chord, between places along and across `out`.
    fn lay_chord(&self, a: DVec2, b: DVec2, strips: &mut [Across]) {
        let (low, high) = if a.x <= b.x { (a, b) } else { (b, a) };
        let from_mm = low.x - self.margin_mm;
        let to_mm = (high.x + self.margin_mm).min(self.top_mm + self.margin_mm);
        if to_mm < from_mm || to_mm < self.low_mm {
            return;
        }
        let strip_of = |along_mm: f64| ((along_mm - self.low_mm) / STRIP_MM).max(0.0) as usize;
        let across_per_mm = (high.y - low.y) / (high.x - low.x).max(f64::MIN_POSITIVE);
        let across_mm = |along_mm: f64| low.y + (along_mm.clamp(low.x, high.x) - low.x) * across_per_mm;
        let last = strip_of(to_mm).min(strips.len() - 1);
        for (strip, across) in strips.iter_mut().enumerate().take(last + 1).skip(strip_of(from_mm)) {
            let begin_mm = self.low_mm + strip as f64 * STRIP_MM;
            // A chord within the margin of a strip counts in it, with all that is so near.
            let ends = [begin_mm - self.margin_mm, begin_mm + STRIP_MM + self.margin_mm].map(across_mm);
            across[0] = across[0].min(ends[0].min(ends[1]) - self.margin_mm);
            across[1] = across[1].max(ends[0].max(ends[1]) + self.margin_mm);
        }
    }
}
