//! The target's root between two hobbed flanks, section by section: what the rack's tip corners and tip line leave.
//!
//! In: the rack's generation, a space, the rolls at which both flanks' fields begin. Out: points of the root with their
//! normals, from the left flank of the space (low arc) to the right one, equally many in every section, so that
//! sections can be lofted.
//!
//! **Law.** Five pieces: the left flank from where its field begins down to its own form point, the path of the left
//! corner, the tip line, and both again for the right flank. Every piece touches its tool on a normal through the pitch
//! point P (Litvin and Fuentes, Gear Geometry and Applied Theory, 2004, chapter 6); the tip line leaves the curve that
//! runs parallel to the pitch curve, `P - h n`.

use super::rack_generation::RackGeneration;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use glam::DVec2;

/// Chords by which the length of a piece is taken.
const CHORDS: u32 = 48;

/// A point of the root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RackRootPoint {
    /// Arc from the first point, mm.
    pub arc_mm: f64,
    /// Point in its transverse section, gear frame, mm.
    pub point_mm: DVec2,
    /// Unit normal out of the gear in that section.
    pub normal: DVec2,
}

/// A piece of the root over its own parameter from 0 to 1.
type RootPiece<'a> = Box<dyn Fn(f64) -> (DVec2, DVec2) + 'a>;

impl RackGeneration {
    /// Root of a space in the section `z_mm`; `start_rolls_mm` are those at which the fields of its left and right
    /// flank begin, `count` points stand evenly along it, both ends included.
    pub fn root(
        &self,
        blank: &Blank,
        space: i64,
        start_rolls_mm: [f64; 2],
        z_mm: f64,
        count: usize,
    ) -> Vec<RackRootPoint> {
        let [left, right] = [(Side::Left, start_rolls_mm[0]), (Side::Right, start_rolls_mm[1])]
            .map(|(side, start_mm)| self.root_half(blank, space, side, start_mm, z_mm));
        let [from, to] = [left.bottom_arc_mm, right.bottom_arc_mm];
        let bottom: RootPiece = Box::new(move |share| {
            let frame = self.curve.frame(self.curve.phi_at_arc(from + share * (to - from)));
            (frame.point_mm - self.rack.tip_height_mm * frame.normal, frame.normal)
        });
        let [right_flank, right_corner] = right.pieces.map(backwards);
        let [left_flank, left_corner] = left.pieces;
        evenly(&[left_flank, left_corner, bottom, right_corner, right_flank], count)
    }

    /// Flank and corner on one side of a space, from the flank's field down to the tip line.
    fn root_half(&self, blank: &Blank, space: i64, side: Side, start_mm: f64, z_mm: f64) -> RootHalf<'_> {
        let form = self.form_point(blank, space, side, z_mm);
        // A field begins where the flank is whole in all sections, never below the section's own form point but by
        // rounding.
        let end_mm = if side.sign() * (form.roll_mm - start_mm) > 0.0 { form.roll_mm } else { start_mm };
        let bottom_arc_mm = self.corner_bottom_arc_mm(space, side, z_mm);
        let flank: RootPiece = Box::new(move |share| {
            let contact = self.flank_contact(space, side, start_mm + share * (end_mm - start_mm), z_mm);
            (contact.point_mm.truncate(), contact.normal.truncate().normalize())
        });
        let corner: RootPiece = Box::new(move |share| {
            let contact = self.corner_contact(space, side, form.corner_lean * (1.0 - share), z_mm);
            (contact.point_mm, contact.normal)
        });
        RootHalf { pieces: [flank, corner], bottom_arc_mm }
    }
}

/// One side of a root: the rest of its flank, then its corner.
struct RootHalf<'a> {
    pieces: [RootPiece<'a>; 2],
    /// Arc at which the corner is deepest and the tip line takes over.
    bottom_arc_mm: f64,
}

fn backwards(piece: RootPiece<'_>) -> RootPiece<'_> {
    Box::new(move |share| piece(1.0 - share))
}

/// Points evenly along pieces that follow each other.
fn evenly(pieces: &[RootPiece<'_>; 5], count: usize) -> Vec<RackRootPoint> {
    // Length at every chord's end: piece, parameter, length so far.
    let mut ends: Vec<(usize, f64, f64)> = Vec::new();
    let mut length_mm = 0.0;
    for (index, piece) in pieces.iter().enumerate() {
        let mut before = piece(0.0).0;
        ends.push((index, 0.0, length_mm));
        for i in 1..=CHORDS {
            let share = f64::from(i) / f64::from(CHORDS);
            let here = piece(share).0;
            length_mm += here.distance(before);
            before = here;
            ends.push((index, share, length_mm));
        }
    }
    (0..count)
        .map(|i| {
            let arc_mm = length_mm * i as f64 / (count - 1) as f64;
            let after = ends.partition_point(|end| end.2 < arc_mm).clamp(1, ends.len() - 1);
            let ((index, from, low), (next, to, high)) = (ends[after - 1], ends[after]);
            // Between two pieces nothing lies.
            let share =
                if next == index && high > low { from + (to - from) * (arc_mm - low) / (high - low) } else { to };
            let (point_mm, normal) = pieces[next](share);
            RackRootPoint { arc_mm, point_mm, normal }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::hobbing::rack_generation::Rack;
    use gearcut_core::gear::PitchCurve;
    use gearcut_core::gear::PitchCurveShape;
    use std::f64::consts::PI;
    use std::sync::Arc;

    fn generation(shape: &PitchCurveShape, teeth: u32, tip_radius_mm: f64) -> (RackGeneration, Blank) {
        let (beta, module_mm) = (0.25_f64, 4.0 / 0.25_f64.cos());
        let curve = Arc::new(PitchCurve::new(shape, module_mm, teeth).expect("a curve"));
        let rack = Rack {
            transverse_module_mm: module_mm,
            pressure_angle_rad: (20_f64.to_radians().tan() / beta.cos()).atan(),
            half_thickness_mm: 0.25 * PI * module_mm,
            tip_height_mm: 5.0,
            tip_radius_mm,
            helix_angle_rad: beta,
            hand: 1.0,
        };
        let blank = Blank::new(curve.clone(), 4.0).expect("a blank");
        (RackGeneration { curve, rack }, blank)
    }

    /// The root runs from flank to flank without a gap or a step back, its normals stand across it, and its deepest
    /// points are the rack's tip line's: on a round gear the root circle.
    #[test]
    fn a_root_joins_its_flanks_and_lies_on_the_root_circle() {
        for (teeth, tip_radius_mm) in [(40, 0.0), (40, 0.8), (14, 0.8)] {
            let (generation, blank) = generation(&PitchCurveShape::Circle, teeth, tip_radius_mm);
            let z_mm = 7.0;
            let forms = [Side::Left, Side::Right].map(|side| generation.form_point(&blank, 2, side, z_mm));
            assert_eq!(forms[0].undercut, teeth == 14);
            let starts = forms.map(|form| form.roll_mm);
            let root = generation.root(&blank, 2, starts, z_mm, 301);
            for (side, end) in [(Side::Left, root[0]), (Side::Right, root[300])] {
                let start = generation.flank_contact(2, side, starts[usize::from(side == Side::Right)], z_mm);
                assert!(start.point_mm.truncate().distance(end.point_mm) < 1e-9, "{side:?}");
            }
            let step_mm = root[300].arc_mm / 300.0;
            for pair in root.windows(2) {
                let chord = pair[1].point_mm - pair[0].point_mm;
                assert!(chord.length() < 1.02 * step_mm && chord.length() > 0.7 * step_mm, "{chord} of {step_mm}");
                // Counter-clockwise round the gear: outside lies to the right of the chord; at an undercut's edge the
                // surface has a corner.
                assert!(chord.normalize().perp_dot(pair[0].normal) < -0.5, "{pair:?}");
            }
            let circle_mm = 0.5 * generation.curve.perimeter_mm() / PI - 5.0;
            let deepest = root.iter().map(|p| p.point_mm.length()).fold(f64::INFINITY, f64::min);
            assert!((deepest - circle_mm).abs() < 1e-6, "{deepest} not {circle_mm}");
        }
    }

    /// Sections of a helical gear on a round pitch curve are one section, turned.
    #[test]
    fn sections_are_turned_against_each_other() {
        let (generation, blank) = generation(&PitchCurveShape::Circle, 40, 0.8);
        let start = generation.form_point(&blank, 2, Side::Left, 0.0).roll_mm;
        let at = |z_mm: f64| generation.root(&blank, 2, [start, -start], z_mm, 60);
        let radius_mm = 0.5 * generation.curve.perimeter_mm() / PI;
        let turn = DVec2::from_angle(9.0 * 0.25_f64.tan() / radius_mm);
        for (a, b) in at(0.0).iter().zip(at(9.0)) {
            assert!(turn.rotate(a.point_mm).distance(b.point_mm) < 1e-7, "{a:?} {b:?}");
            assert!(turn.rotate(a.normal).distance(b.normal) < 1e-7);
        }
    }
}
