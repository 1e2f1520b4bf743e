//! What sweeps of a turning tool take from the whole blank: volume, thickness and travel, pass by pass, whatever
//! backend cut it.
//!
//! In: the material that a pass takes from each ray of a slice, with the ends that it found and those that it left
//! (`ChipSurfaces`). Out: its share in that slice, summed over slices ([`PassChip`]).

use crate::cut::{BlankCut, BlankStats};
use crate::dexel::intervals::{End, Span};
use crate::math::planar_rays::Family;
use crate::passes::sections::swept_sections::SweepHeading;
use glam::DVec2;
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::ops::Range;

/// What a pass took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassChip {
    /// Pass id.
    pub pass: u32,
    /// Volume by rays of both families, mm3.
    pub removed_mm3: [f64; 2],
    /// Uncut chip thickness: the largest distance of a place of the swept surface from the surface before, mm.
    pub thickness_mm: f64,
    /// Travel of the tip while anything was taken, mm.
    pub travel_mm: f64,
}

/// What an operation did.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepsCut {
    /// As for every process.
    pub cut: BlankCut,
    /// Passes that took anything, in order.
    pub chips: Vec<PassChip>,
}

/// Sums the chips of an operation while they come in, slice by slice.
pub struct ChipAccumulator {
    first_pass: u32,
    chips: Vec<PassChip>,
}

impl ChipAccumulator {
    /// For passes with the ids `passes`.
    pub fn new(passes: Range<u32>) -> Self {
        let nothing = |pass| PassChip { pass, removed_mm3: [0.0; 2], thickness_mm: 0.0, travel_mm: 0.0 };
        Self { first_pass: passes.start, chips: passes.map(nothing).collect() }
    }

    /// Adds a chip of one slice.
    pub fn add(&mut self, chip: &PassChip) {
        let sum = &mut self.chips[(chip.pass - self.first_pass) as usize];
        sum.removed_mm3 = [0, 1].map(|f| sum.removed_mm3[f] + chip.removed_mm3[f]);
        sum.thickness_mm = sum.thickness_mm.max(chip.thickness_mm);
        sum.travel_mm += chip.travel_mm;
    }

    /// What the operation did.
    pub fn finish(mut self, stats: BlankStats) -> SweepsCut {
        let removed_mm3 = self.chips.iter().map(|chip| chip.removed_mm3).collect();
        self.chips.retain(|chip| chip.removed_mm3 != [0.0; 2]);
        SweepsCut { cut: BlankCut { removed_mm3, stats, ..BlankCut::default() }, chips: self.chips }
    }
}

impl PassChip {
    /// What a pass took of a slice of the face.
    pub fn of_slice(
        pass: u32,
        heading: &SweepHeading,
        removed_mm3: [f64; 2],
        width_mm: f64,
        surfaces: &ChipSurfaces,
        spacing_mm: f64,
    ) -> Self {
        // Half a disc about the thickest place is all chip, or a quarter at a corner: a bound where rays are too far
        // apart to meet the old surface beside them.
        let area_mm2 = removed_mm3[0].min(removed_mm3[1]) / width_mm;
        let thickness_mm = surfaces.thickness_mm(heading, spacing_mm).min((4.0 * area_mm2 / PI).sqrt());
        Self { pass, removed_mm3, thickness_mm, travel_mm: heading.travel_per_mm * width_mm }
    }
}

/// The surfaces of one chip in one slice, as rays meet them.
#[derive(Default)]
pub struct ChipSurfaces {
    /// Places of the old surface, left by earlier passes or the blank's own, with their normals.
    old: Vec<[DVec2; 2]>,
    /// Places of the new one.
    new: Vec<NewPlace>,
}

/// A place of the new surface.
struct NewPlace {
    at: DVec2,
    normal: DVec2,
    /// How far the old surface at the other end of the chip on the same ray lies from it; where this pass left that end
    /// as well, how wide the tool is there, mm.
    across_mm: f64,
}

/// Distance of the old surface from a place of the new one, from the normals (new, old) where a ray `length_mm` long
/// crosses both: to the old tangent, exact for a straight trace, or between two circles about one point, exact for
/// these; the smaller one.
fn between_mm(family: Family, length_mm: f64, normals: [DVec2; 2]) -> f64 {
    let [new, old] = normals.map(|normal| normal * family.along(normal).signum());
    length_mm * family.along(old).min(family.along(new + old) / (1.0 + new.dot(old)))
}

impl ChipSurfaces {
    /// No chip.
    pub fn clear(&mut self) {
        self.old.clear();
        self.new.clear();
    }

    /// What a cut takes from one ray.
    pub fn add(&mut self, family: Family, across_mm: f64, spans: &[Span], [from, to]: [End; 2]) {
        let first = spans.partition_point(|span| span.high.at_mm <= from.at_mm);
        for span in spans[first..].iter().take_while(|span| span.low.at_mm < to.at_mm) {
            let low = if span.low.at_mm > from.at_mm { span.low } else { from };
            let high = if span.high.at_mm < to.at_mm { span.high } else { to };
            self.add_piece(family, across_mm, &Span { low, high }, from.pass);
        }
    }

    /// Material that a pass takes from one ray; ends that it leaves bear its id.
    pub fn add_piece(&mut self, family: Family, across_mm: f64, piece: &Span, pass: u32) {
        let length_mm = piece.high.at_mm - piece.low.at_mm;
        let ends = [&piece.low, &piece.high];
        let normals = ends.map(|end| DVec2::from_array(end.normal.map(f64::from)));
        for side in 0..2 {
            let (at, normal) = (family.point(ends[side].at_mm, across_mm), normals[side]);
            if ends[side].pass != pass {
                self.old.push([at, normal]);
            } else if family.along(normal).abs() >= FRAC_1_SQRT_2 {
                let across_mm = if ends[1 - side].pass == pass {
                    length_mm
                } else {
                    between_mm(family, length_mm, [normal, normals[1 - side]])
                };
                self.new.push(NewPlace { at, normal, across_mm });
            }
        }
    }

    /// Largest distance of a place of the new surface from the old one, across the swept surface; the old one between
    /// its places, `spacing_mm` apart, goes on along its tangents.
    fn thickness_mm(&self, heading: &SweepHeading, spacing_mm: f64) -> f64 {
        self.new.iter().fold(0.0, |largest_mm, place| {
            let upright = heading.upright(place.normal);
            let bound_mm = place.across_mm * upright;
            if bound_mm <= largest_mm {
                return largest_mm;
            }
            let squared = self.old.iter().map(|&[old, normal]| {
                let apart = place.at - old;
                let beside_mm = (normal.perp_dot(apart).abs() - 0.5 * spacing_mm).max(0.0);
                normal.dot(apart).powi(2) + beside_mm * beside_mm
            });
            bound_mm.min(squared.fold(f64::INFINITY, f64::min).sqrt() * upright).max(largest_mm)
        })
    }
}
