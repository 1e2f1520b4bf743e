//! What sweeps of a turning tool take from the whole blank: volume, thickness, travel and the area that the edge
//! sweeps, pass by pass, whatever backend cut it.
//!
//! In: the material that a pass takes from each ray of a slice, with the ends that it found and those that it left
//! (`ChipSurfaces`). Out: its share in that slice, and the sum over slices ([`PassChip`]).
//!
//! **Engaged edge.** A place of the edge takes material where the border of its section in a slice lies inside of what
//! is left there: the ray that meets the border has its new end at it. The length of these parts of the border, over
//! the cosine between slice and swept surface and times the slice's width, is the area that the edge sweeps in
//! material; over the tip's travel it is the length of edge in engagement, measured across its motion.
//!
//! A ray of distance d stands for the length d / cos of border that it meets under that angle to its normal. Only rays
//! within 45 degrees of the normal count, so that each place of the border is counted by one of the two families. The
//! mean over all places of the grid is then the length itself, without bias (Crofton's law for parallel lines), and a
//! stretch of border that one family counts is at most one ray, sqrt(2) d of length, off.
//!
//! The road not taken: parameters of the edge at both ends of each engaged stretch. Rays know places, not parameters,
//! and on the GPU they come back as places alone.

use crate::cut::{BlankCut, BlankStats, LEAST_CHIP_MM};
use crate::dexel::intervals::{End, Span};
use crate::math::planar_rays::Family;
use crate::passes::sections::swept_sections::{EDGE_PLACES, SweepHeading};
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
    /// Area that the edge swept inside the material, measured across its motion, mm2.
    pub swept_mm2: f64,
    /// The same by places along the edge, with the thickness of the chip there.
    pub edge: [EdgeWork; EDGE_PLACES],
}

impl PassChip {
    /// Volume, the mean of both families, mm3.
    pub fn volume_mm3(&self) -> f64 {
        0.5 * (self.removed_mm3[0] + self.removed_mm3[1])
    }
}

/// What a place of the edge did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeWork {
    /// Area that it swept inside the material, mm2; half the memory of the rest, because there are many.
    pub swept_mm2: f32,
    /// The same times the uncut chip thickness, mm3: their ratio is the mean thickness.
    pub thick_mm3: f32,
}

/// What an operation did.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepsCut {
    /// As for every process.
    pub cut: BlankCut,
    /// Passes that took anything, in order.
    pub chips: Vec<PassChip>,
    /// The same slice by slice, in no order of time.
    pub in_slices: Vec<PassChip>,
}

/// Sums the chips of an operation while they come in, slice by slice.
pub struct ChipAccumulator {
    first_pass: u32,
    chips: Vec<PassChip>,
    in_slices: Vec<PassChip>,
}

impl ChipAccumulator {
    /// For passes with the ids `passes`.
    pub fn new(passes: Range<u32>) -> Self {
        let nothing = |pass| PassChip {
            pass,
            removed_mm3: [0.0; 2],
            thickness_mm: 0.0,
            travel_mm: 0.0,
            swept_mm2: 0.0,
            edge: [EdgeWork::default(); EDGE_PLACES],
        };
        Self { first_pass: passes.start, chips: passes.map(nothing).collect(), in_slices: Vec::new() }
    }

    /// Adds a chip of one slice.
    pub fn add(&mut self, chip: &PassChip) {
        let sum = &mut self.chips[(chip.pass - self.first_pass) as usize];
        sum.removed_mm3 = [0, 1].map(|f| sum.removed_mm3[f] + chip.removed_mm3[f]);
        sum.thickness_mm = sum.thickness_mm.max(chip.thickness_mm);
        sum.travel_mm += chip.travel_mm;
        sum.swept_mm2 += chip.swept_mm2;
        for (sum, work) in sum.edge.iter_mut().zip(&chip.edge) {
            sum.swept_mm2 += work.swept_mm2;
            sum.thick_mm3 += work.thick_mm3;
        }
        self.in_slices.push(*chip);
    }

    /// What the operation did.
    pub fn finish(mut self, stats: BlankStats) -> SweepsCut {
        let removed_mm3 = self.chips.iter().map(|chip| chip.removed_mm3).collect();
        self.chips.retain(|chip| chip.removed_mm3 != [0.0; 2]);
        SweepsCut {
            cut: BlankCut { removed_mm3, stats, ..BlankCut::default() },
            chips: self.chips,
            in_slices: self.in_slices,
        }
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
        let swept_mm2 = surfaces.swept_per_mm(heading, spacing_mm) * width_mm;
        let travel_mm = heading.travel_per_mm * width_mm;
        let edge = surfaces.edge_work(heading, spacing_mm, width_mm, thickness_mm);
        Self { pass, removed_mm3, thickness_mm, travel_mm, swept_mm2, edge }
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
    /// Cosine between its ray and its normal.
    facing: f64,
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
        let facing = normals.map(|normal| family.along(normal).abs());
        for side in 0..2 {
            let (at, normal) = (family.point(ends[side].at_mm, across_mm), normals[side]);
            if ends[side].pass != pass {
                self.old.push([at, normal]);
            } else if facing[side] >= FRAC_1_SQRT_2 {
                let across_mm = if ends[1 - side].pass == pass {
                    length_mm
                } else {
                    between_mm(family, length_mm, [normal, normals[1 - side]])
                };
                self.new.push(NewPlace { at, normal, facing: facing[side], across_mm });
            }
        }
    }

    /// Area that the edge sweeps in the material per mm along the gear's axis, mm2 per mm.
    fn swept_per_mm(&self, heading: &SweepHeading, spacing_mm: f64) -> f64 {
        let places = self.new.iter().map(|place| (place, heading.upright(place.normal)));
        let engaged = places.filter(|(place, upright)| place.across_mm * upright >= LEAST_CHIP_MM);
        engaged.map(|(place, upright)| spacing_mm / (place.facing * upright)).sum()
    }

    /// What the places of the edge did in a slice `width_mm` wide. No place took more than `thickest_mm`: where a tooth
    /// plunges, rays across it have no old surface at their other end.
    fn edge_work(
        &self,
        heading: &SweepHeading,
        spacing_mm: f64,
        width_mm: f64,
        thickest_mm: f64,
    ) -> [EdgeWork; EDGE_PLACES] {
        let mut work = [EdgeWork::default(); EDGE_PLACES];
        for place in &self.new {
            let upright = heading.upright(place.normal);
            let thickness_mm = place.across_mm * upright;
            if thickness_mm >= LEAST_CHIP_MM {
                let swept_mm2 = spacing_mm / (place.facing * upright) * width_mm;
                let of_place = &mut work[heading.edge_place(place.at, place.normal)];
                of_place.swept_mm2 += swept_mm2 as f32;
                of_place.thick_mm3 += (swept_mm2 * thickness_mm.min(thickest_mm)) as f32;
            }
        }
        work
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dexel::NO_PASS;
    use crate::math::planar_rays::FAMILIES;
    use crate::passes::sections::swept_sections::FLANK_PLACES;
    use glam::DVec3;

    const PASS: u32 = 7;

    /// A straight slot of this width and depth, turned by an angle, as rays of both families meet it; `at` shifts the
    /// grid, in rays. With the area that both families take in the mean, mm2.
    fn slot([width_mm, depth_mm]: [f64; 2], angle_rad: f64, spacing_mm: f64, at: DVec2) -> (ChipSurfaces, f64) {
        let along = DVec2::from_angle(angle_rad);
        let up = along.perp();
        // Half planes that the slot is the intersection of: normal, distance, whether the tool leaves that side.
        let sides =
            [(along, 0.5 * width_mm, true), (-along, 0.5 * width_mm, true), (-up, depth_mm, true), (up, 0.0, false)];
        let (mut surfaces, mut area_mm2) = (ChipSurfaces::default(), 0.0);
        for family in FAMILIES {
            let rays = (4.0 * width_mm.max(depth_mm) / spacing_mm) as i32;
            for ray in -rays..=rays {
                let across_mm = (f64::from(ray) + family.across(at)) * spacing_mm;
                let (mut low, mut high) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
                for (index, (normal, distance_mm, _)) in sides.iter().enumerate() {
                    let (slope, origin) = (family.along(*normal), family.point(0.0, across_mm).dot(*normal));
                    let crossing = (distance_mm - origin) / slope;
                    if slope < 0.0 && crossing > low.0 {
                        low = (crossing, index);
                    } else if slope > 0.0 && crossing < high.0 {
                        high = (crossing, index);
                    }
                }
                if low.0 < high.0 {
                    let [low, high] = [low, high].map(|(at_mm, side)| {
                        let (normal, _, left) = sides[side];
                        // Ends that the tool leaves bear the normal of what is left: into the slot.
                        End {
                            at_mm,
                            pass: if left { PASS } else { NO_PASS },
                            normal: if left { -normal } else { normal }.as_vec2().to_array(),
                        }
                    });
                    surfaces.add_piece(family, across_mm, &Span { low, high }, PASS);
                    area_mm2 += 0.5 * spacing_mm * (high.at_mm - low.at_mm);
                }
            }
        }
        (surfaces, area_mm2)
    }

    /// A blade that moves along the gear's axis: every surface stands upright.
    fn upright() -> SweepHeading {
        SweepHeading {
            travel_per_mm: 1.0,
            axis_and_out: [DVec3::X, DVec3::Y],
            centre_mm: -20.0 * DVec3::Y,
            tip_and_depth_mm: [20.0, 4.0],
        }
    }

    /// Grids shifted against the slot, and the slot turned, over the unit square by the golden ratio.
    fn places() -> impl Iterator<Item = (f64, DVec2)> {
        (1..=400).map(|i| {
            let at = |step: f64| (f64::from(i) * step).fract();
            (std::f64::consts::TAU * at(0.618_034), DVec2::new(at(0.754_878), at(0.569_840)))
        })
    }

    /// The edge is engaged at the bottom and on both sides: w + 2 h.
    #[test]
    fn engaged_edge_of_a_straight_slot_is_its_width_and_both_sides() {
        let (slot_mm, length_mm) = ([2.0, 1.3], 2.0 + 2.0 * 1.3);
        for spacing_mm in [0.3, 0.15, 0.075] {
            let found: Vec<f64> = places()
                .map(|(angle, at)| slot(slot_mm, angle, spacing_mm, at).0.swept_per_mm(&upright(), spacing_mm))
                .collect();
            let worst = found.iter().map(|mm| (mm - length_mm).abs()).fold(0.0, f64::max);
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            println!(
                "rays {spacing_mm} mm apart: {mean:.4} mm in the mean, worst {worst:.4} mm off, of {length_mm} mm"
            );
            // Three stretches, each a ray off at most; the mean has no bias.
            assert!(worst <= 3.0 * std::f64::consts::SQRT_2 * spacing_mm, "{worst} at {spacing_mm}");
            assert!((mean / length_mm - 1.0).abs() < 0.004, "{mean} at {spacing_mm}");
        }
    }

    /// What a tooth 2 mm wide that plunges so deep does at its places, its quarters of a flank 1 mm high: area swept,
    /// and thickness under the tip; means over 400 places of the slot.
    fn work_of_a_slot(depth_mm: f64) -> ([f64; EDGE_PLACES], f64) {
        let spacing_mm = 0.075;
        let mut mean_mm = [0.0; EDGE_PLACES];
        let mut under_tip_mm = 0.0;
        for (angle, at) in places() {
            let (axis, out) = (DVec2::from_angle(angle), -DVec2::from_angle(angle).perp());
            let heading = SweepHeading {
                travel_per_mm: 1.0,
                axis_and_out: [axis.extend(0.0), out.extend(0.0)],
                centre_mm: ((depth_mm - 20.0) * out).extend(0.0),
                tip_and_depth_mm: [20.0, 4.0],
            };
            let slot = slot([2.0, depth_mm], angle, spacing_mm, at).0;
            let work = slot.edge_work(&heading, spacing_mm, 1.0, depth_mm);
            let area_mm2: f64 = work.iter().map(|place| f64::from(place.swept_mm2)).sum();
            assert!((area_mm2 - slot.swept_per_mm(&heading, spacing_mm)).abs() < 1e-5, "{area_mm2}");
            for (mean_mm, place) in mean_mm.iter_mut().zip(&work) {
                *mean_mm += f64::from(place.swept_mm2) / 400.0;
            }
            under_tip_mm += f64::from(work[FLANK_PLACES].thick_mm3 / work[FLANK_PLACES].swept_mm2) / 400.0;
        }
        (mean_mm, under_tip_mm)
    }

    /// 1.3 mm deep the tip works over 2 mm, the quarter beside it over 1 mm, the next one over 0.3 mm, on both flanks.
    /// Of the depth over the tip rays up to 45 degrees off the normal see less near the walls, through which they
    /// leave: at most depth / (2 * 2 mm) times the mean tangent of those angles, 4 / pi ln sqrt(2) = 0.441.
    #[test]
    fn work_along_the_edge_of_a_straight_slot_is_where_the_slot_is() {
        let (mean_mm, under_tip_mm) = work_of_a_slot(1.3);
        // Rays at angles of 45 degrees and more count nothing twice; the mean over 400 places has 1 % of noise.
        for (found, meant) in mean_mm.iter().zip([0.0, 0.0, 0.3, 1.0, 2.0, 1.0, 0.3, 0.0, 0.0]) {
            assert!((found - meant).abs() < 0.02, "{mean_mm:?}");
        }
        let seen = |depth_mm: f64| 1.0 - 0.441 * depth_mm / 4.0;
        assert!(under_tip_mm / 1.3 > seen(1.3) && under_tip_mm < 1.3, "{under_tip_mm}");
        let thin_mm = work_of_a_slot(0.1).1;
        assert!((thin_mm / 0.1 - seen(0.1)).abs() < 0.02, "{thin_mm}");
    }

    /// Rays along a thin chip meet it by chance: its area spreads, by less the nearer they stand, about w h.
    #[test]
    fn section_of_a_thin_slot_spreads_about_its_area() {
        let slot_mm = [3.0, 0.1];
        let spread = |spacing_mm: f64| {
            let found: Vec<f64> = places()
                .map(|(angle, at)| slot(slot_mm, angle, spacing_mm, at).1 / (slot_mm[0] * slot_mm[1]) - 1.0)
                .collect();
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            let square = found.iter().map(|off| off * off).sum::<f64>() / found.len() as f64;
            println!("rays {spacing_mm} mm apart: {mean:.4} off in the mean, {:.4} root mean square", square.sqrt());
            assert!(mean.abs() < 0.02);
            square.sqrt()
        };
        let [coarse, fine] = [0.3, 0.15].map(spread);
        assert!(coarse < 0.2 && fine < 0.5 * coarse, "{coarse}, {fine}");
    }

    #[test]
    fn what_is_thinner_than_a_chip_engages_nothing() {
        let of = |depth_mm: f64| slot([2.0, depth_mm], 0.3, 0.1, DVec2::ZERO).0.swept_per_mm(&upright(), 0.1);
        assert_eq!(of(0.5 * LEAST_CHIP_MM), 0.0);
        assert!(of(2.0 * LEAST_CHIP_MM) > 1.5);
    }
}
