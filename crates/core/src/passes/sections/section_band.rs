//! One pass in neighbouring slices. Its section in the middle slice says where its sections in the others can be: well
//! enough to cull it there, at a tenth of the cost of following it.
//!
//! In: a pass, a range of slices ([`SweptSections`]). Out: in each of them a polygon and how far the true section may
//! lie from it ([`LooseOutline`]).
//!
//! **The law.** As the slice's place z moves, an edge point goes through it at another moment, in another place: P(z) =
//! P + z P' + error. The blade's point stands at depth rho cos(delta) towards the work and b = rho sin(delta) along its
//! travel. The depth therefore bends with the travel by d2/db2 sqrt(rho^2 - b^2) = -1 / (rho cos^3(delta)). The work
//! turns slower than the tool by the number of its teeth, which adds some hundredths of that. With w, the travel per mm
//! of z, the error is w^2 z^2 / (2 rho cos^3(delta)); the tolerance is twice as large. Arrow heights of pieces, and the
//! direction in which the section is closed, change with the third derivative: by a tenth of the error for pieces as
//! long as they are here. The tolerance has that on top.
//!
//! The factor 2 answers for the hundredths left out. It is no bound proved for every machine: true sections are
//! compared with it (`tests/suite/hobbing/blank.rs`: they use less than nine tenths of their tolerance), and what is
//! left is compared with all passes on all rays.
//!
//! The roads not taken: sections in two slices and straight lines between their points are as good and cost another
//! section. The second derivative itself would spare the tolerance, some micrometres; few passes miss what is left by
//! so little.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use crate::math::ray_reach::LooseOutline;
use crate::passes::sections::swept_sections::{SweptSection, SweptSections, sagitta_mm};
use glam::DVec2;
use pulp::Arch;

/// How much of a piece's length counts as travel on top of the slice's distance: third derivatives. Found by trial, no
/// proof. Too small, a pass is culled in a slice where it would have taken up to the missing micrometres of tolerance.
/// `tests/suite/hobbing/blank.rs` compares true sections with it, and what is left with all passes on all rays, which
/// know no bands; and it plants a tolerance that is too small.
const PIECE_WEIGHT: f64 = 0.1;
/// Share of its arrow height that a piece may gain over the band; found and compared likewise.
const SAGITTA_GAIN: f64 = 0.1;
/// Error of places through rounding at most, mm.
const ROUNDING_MM: f64 = 1e-9;

/// A pass near a slice.
#[derive(Debug, Default)]
pub struct SectionBand {
    pass: usize,
    z_mm: f64,
    /// Travel along the tool's circumference per mm of z.
    travel_per_mm: f64,
    /// Index of the first of the nodes.
    first: usize,
    nodes: Vec<BandNode>,
    /// Of the piece that begins at the node, mm.
    sagittas_mm: Vec<f64>,
}

#[derive(Debug)]
struct BandNode {
    radius_mm: f64,
    place_mm: DVec2,
    over_z: DVec2,
    over_radius: DVec2,
    /// Bend of the travel in the plane, 1/mm: 1 / (rho cos^3(delta)).
    bend_per_mm: f64,
}

/// What a band knows about a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InSlice {
    /// The pass does not cross it where the blank may be.
    Nowhere,
    /// It lies within the outline.
    Within,
    /// Neighbours do not tell: it has to be followed there.
    Followed,
}

impl SectionBand {
    /// Takes over pass `index`; slices are asked for within `z_range_mm`. `false`: the pass crosses none of them where
    /// the blank may be.
    pub fn set(&mut self, sections: &SweptSections, index: usize, z_range_mm: [f64; 2]) -> bool {
        Arch::new().dispatch(BandToSet { band: self, sections, index, z_range_mm })
    }

    #[inline(always)]
    fn set_lanes(&mut self, sections: &SweptSections, index: usize, z_range_mm: [f64; 2]) -> bool {
        let pass = &sections.passes[index];
        let outline = sections.outline_of(pass);
        let ends_mm = z_range_mm.map(|z_mm| pass.behind_mm(z_mm));
        let nearest_mm = if ends_mm[0] * ends_mm[1] <= 0.0 { 0.0 } else { ends_mm[0].abs().min(ends_mm[1].abs()) };
        let Some(reached) = sections.reached(pass, nearest_mm) else { return false };
        self.pass = index;
        self.nodes.clear();
        self.sagittas_mm.clear();
        // A slice alone is not guessed from itself, nor one from another across a corner of the motion.
        if z_range_mm[0] >= z_range_mm[1] || !pass.is_smooth() {
            return true;
        }
        self.z_mm = 0.5 * (z_range_mm[0] + z_range_mm[1]);
        self.travel_per_mm = pass.travel_per_mm();
        self.first = *reached.nodes.start();
        let mut rate_mm = DVec2::ZERO;
        let found = sections.walk_abreast(pass, self.z_mm, reached.nodes, |index, node, crossing| {
            if let Some(before) = self.nodes.last() {
                let end_rate_mm = crossing.rate(outline.rates_mm[index - 1][1]);
                self.sagittas_mm.push(sagitta_mm([before.place_mm, crossing.place_mm], &[rate_mm, end_rate_mm]));
            }
            rate_mm = outline.rates_mm.get(index).map_or(DVec2::ZERO, |rates| crossing.rate(rates[0]));
            self.nodes.push(BandNode {
                radius_mm: node.x,
                place_mm: crossing.place_mm,
                over_z: crossing.over_z,
                over_radius: crossing.over_radius,
                bend_per_mm: (node.x * crossing.out.powi(3)).recip(),
            });
        });
        if !found {
            self.nodes.clear();
        }
        true
    }

    /// Bounds of the pass in a slice: the outline from its neighbours, or else its section there with that section's
    /// chords; into memory that is reused.
    pub fn bounds(
        &self,
        sections: &SweptSections,
        z_mm: f64,
        outline: &mut LooseOutline,
        section: &mut SweptSection,
    ) -> InSlice {
        let found = self.outline(sections, z_mm, outline);
        if found != InSlice::Followed {
            return found;
        }
        if !sections.section(self.pass, z_mm, section) {
            return InSlice::Nowhere;
        }
        outline.set_chords(section);
        found
    }

    /// Outline in a slice as the neighbours tell it; none where the pass must be followed, into memory that is reused.
    pub fn outline(&self, sections: &SweptSections, z_mm: f64, into: &mut LooseOutline) -> InSlice {
        let pass = &sections.passes[self.pass];
        let behind_mm = pass.behind_mm(z_mm);
        let Some(reached) = sections.reached(pass, behind_mm) else { return InSlice::Nowhere };
        if self.nodes.is_empty() {
            return InSlice::Followed;
        }
        let z_mm = z_mm - self.z_mm;
        let travel_mm = (self.travel_per_mm * z_mm).abs();
        let (share, longest_mm) = (sections.tolerance_share, sections.outline_of(pass).longest_mm);
        let tolerance_mm =
            |node: &BandNode| share * travel_mm * (travel_mm + PIECE_WEIGHT * longest_mm) * node.bend_per_mm;
        let place_mm = |node: &BandNode| node.place_mm + z_mm * node.over_z;
        let (first, last) = (reached.nodes.start() - self.first, reached.nodes.end() - self.first);
        let nodes = &self.nodes[first..=last];
        into.corners_mm.clear();
        into.tolerances_mm.clear();
        into.corners_mm.extend(nodes.iter().map(place_mm));
        let sagittas_mm = &self.sagittas_mm[first..last];
        into.tolerances_mm.extend(nodes.windows(2).zip(sagittas_mm).map(|(ends, sagitta_mm)| {
            tolerance_mm(&ends[0]).max(tolerance_mm(&ends[1])) + (1.0 + SAGITTA_GAIN) * sagitta_mm
        }));
        // Through the tool's body, behind the blank: the direction along the radius turns with the slice's place as its
        // derivative over the travel does, at most by the bend.
        let closing = [nodes.len() - 1, 0].map(|end| {
            let node = &nodes[end];
            let inward_mm = node.radius_mm - reached.least_mm;
            let turned_mm = 2.0 * travel_mm * inward_mm * node.bend_per_mm;
            (place_mm(node) - inward_mm * node.over_radius, tolerance_mm(node) + turned_mm + ROUNDING_MM)
        });
        into.corners_mm.extend(closing.map(|(place_mm, _)| place_mm));
        into.tolerances_mm.extend([closing[0].1, closing[0].1.max(closing[1].1), closing[1].1]);
        InSlice::Within
    }
}

/// A band about to be set, called through the instruction set dispatch.
struct BandToSet<'a> {
    band: &'a mut SectionBand,
    sections: &'a SweptSections,
    index: usize,
    z_range_mm: [f64; 2],
}

impl pulp::NullaryFnOnce for BandToSet<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.band.set_lanes(self.sections, self.index, self.z_range_mm)
    }
}
