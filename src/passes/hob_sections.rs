//! A hob tooth's sweep where it crosses a transverse slice of the work: a closed curve, as a cutter tooth's outline is in shaping.
//!
//! In: the passes of an operation, the blade's edge, a slice. Out: for each pass a [`SweptSection`] that rays along x and y are laid on.
//!
//! **The law.** A point of the work is removed when it lies inside the blade's edge at the moment at which the rake face holds it. Place in the rake face and moment are coordinates of space, one to one
//! as long as the blade moves across the slice; so what a sweep removes of the plane z = const is the tooth's region itself, every point put where it stands when it goes through that plane, and its border is
//! the edge, point by point: for the edge point (rho, y) the moment delta is the root of
//!
//! `z(work_from_head(delta) (rho cos(delta + twist y), rho sin(delta + twist y), z0 + y)) = z_slice`.
//!
//! No ray is searched for several moments: a ray that a sweep meets more than once crosses this curve more than twice. The curve is a chain of cubics with the true points
//! and directions at their ends, less than 20 nm off between them (tested against the equations of [`super::sweep`]).
//!
//! **Behind the blank.** Edge points that go through the slice nearer to the hob's axis, seen from the work, than half the tip radius are left out, as everywhere ([`SWEEP_RAD`]); the curve is closed
//! there through the hob's body.
//!
//! The road not taken: rays against segments with two unknowns each, as flanks are cut. Rays of a slice lie side by side, and one walk along the outline finds the crossings of all of them.

use super::hob_teeth::{BladePass, HobTeeth, SWEEP_RAD};
use crate::planar_rays::{ClosedCurve, Family, Piece};
use crate::tool::edge::{Edge, Segment};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Longest piece of the edge, as a share of the distance of its tip from the axis: a cubic over it misses some nanometres where the sweep leaves the work.
const PIECE_SHARE: f64 = 0.03;
/// Largest turn of the edge within a piece, rad.
const PIECE_TURN_RAD: f64 = 0.1;
/// Powers of a pass's pose over its sweep.
const TERMS: usize = 6;
/// Rotation, column by column, and translation.
const ENTRIES: usize = 12;
/// Steps to the moment at most, and the last one, rad: the error after it is of its square.
const MOST_STEPS: usize = 20;
const LAST_STEP_RAD: f64 = 1e-6;
/// A section is looked for up to this angle: a little beyond the sweep, where the outline is closed.
const LARGEST_ANGLE_RAD: f64 = 1.25;
/// Height of slices that one section tells about, as a share of the distance of the edge's tip from the axis.
const BAND_SHARE: f64 = 0.03;
/// Distance of the places along the face at which passes are judged beforehand, mm.
const JUDGED_EVERY_MM: f64 = 5.0;

/// The passes of an operation, ready to be cut at any height.
pub struct HobSections {
    /// Ends of the pieces in the rake face: distance from the axis and y.
    pub(super) nodes_mm: Vec<DVec2>,
    /// Directions at both ends of every piece, per piece.
    pub(super) rates_mm: Vec<[DVec2; 2]>,
    /// Passes that may reach the blank, in order of time.
    pub(super) passes: Vec<Sweeping>,
    /// Radius of the tip, mm.
    pub(super) tip_mm: f64,
    /// Largest distance of an edge point from the middle of its blade, mm.
    widest_mm: f64,
    twist_rad_per_mm: f64,
    /// Longest piece of the edge, mm.
    pub(super) longest_mm: f64,
    /// Whether passes are held against what is left before they are followed to a slice; otherwise every pass visits every ray: what refusals are proved against.
    refuses: bool,
    /// Share of the slack that outlines get when they are held against what is left: 1. Less refuses passes that matter; tests plant it.
    pub slack_share: f64,
}

/// A pass with its pose as polynomials of the swept angle.
pub(super) struct Sweeping {
    pass: u32,
    axial_mm: f64,
    y_sign: f64,
    /// `work_from_head` in powers of delta / [`SWEEP_RAD`].
    pose: [[f64; ENTRIES]; TERMS],
}

/// What the edge leaves of one sweep in one slice.
#[derive(Debug, Clone, Default)]
pub struct SweptSection {
    /// Pass id.
    pub pass: u32,
    pieces: Vec<Piece>,
    nodes_mm: Vec<DVec2>,
    /// Derivatives over the piece's parameter, 0 to 1, at its ends.
    rates_mm: Vec<[DVec2; 2]>,
    /// Way of the tip per mm along the gear's axis, where it crosses the slice.
    pub way_per_mm: f64,
    /// Directions of the tool's axis and of the tip out of it there, gear frame.
    axis_and_out: [DVec3; 2],
}

impl HobSections {
    /// Passes of an operation for a blank within `reach_mm` of the gear axis, over the face; all of them, wherever they are, if not `cull`.
    pub fn new(set: &HobTeeth, edge: &Edge, reach_mm: f64, face_width_mm: f64, cull: bool) -> Self {
        let tip_mm = edge.segments.iter().flat_map(|s| s.y_range_mm.map(|y| place(s, y)[0].x)).fold(0.0, f64::max);
        let longest_mm = PIECE_SHARE * tip_mm;
        let (mut nodes_mm, mut rates_mm) = edge_pieces(edge, longest_mm);
        let passes: Vec<Sweeping> =
            (0..set.count()).into_par_iter().map(|i| Sweeping::new(set, &set.pass(i))).collect();
        // Seen along the gear axis the rake face may show its other side: inside is on the left there too.
        if passes.first().is_some_and(Sweeping::is_turned_over) {
            nodes_mm.reverse();
            rates_mm.reverse();
            for rates in &mut rates_mm {
                *rates = [-rates[1], -rates[0]];
            }
        }
        let widest_mm = nodes_mm.iter().map(|node| node.y.abs()).fold(0.0, f64::max);
        let twist_rad_per_mm = set.rake_twist_rad_per_mm;
        let mut sections = Self {
            nodes_mm,
            rates_mm,
            passes,
            tip_mm,
            widest_mm,
            twist_rad_per_mm,
            longest_mm,
            refuses: cull,
            slack_share: 1.0,
        };
        if cull {
            let tooth_mm = 2.0 * edge.reach_mm;
            let places = (face_width_mm / JUDGED_EVERY_MM).ceil().max(1.0);
            let passes = std::mem::take(&mut sections.passes);
            sections.passes = passes
                .into_par_iter()
                .filter(|pass| {
                    (0..=places as u32).any(|i| {
                        let z_mm = face_width_mm * (f64::from(i) / places - 0.5);
                        // Between the places the section moves aside by less than they are apart.
                        let reach_mm = reach_mm + tooth_mm + JUDGED_EVERY_MM;
                        sections.tip_at(pass, z_mm, JUDGED_EVERY_MM).is_some_and(|tip| tip.length() <= reach_mm)
                    })
                })
                .collect();
        }
        sections
    }

    /// Number of passes that are looked at.
    pub fn len(&self) -> usize {
        self.passes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.passes.is_empty()
    }

    /// Whether passes are held against what is left before they are followed to a slice.
    pub fn refuses(&self) -> bool {
        self.refuses
    }

    /// Height of slices that one section tells enough about, mm: outlines get some hundredths of a millimetre of slack at most, a few micrometres in the middle of a sweep.
    pub fn band_mm(&self) -> f64 {
        BAND_SHARE * self.tip_mm
    }

    /// Half the way along the hob's circumference direction that the tip goes through before it is behind the blank, mm.
    fn half_way_mm(&self) -> f64 {
        self.tip_mm * SWEEP_RAD.sin()
    }

    /// Where the middle of the tip crosses a slice, or would at the end of its sweep if it comes within `slack_mm` of it.
    fn tip_at(&self, pass: &Sweeping, z_mm: f64, slack_mm: f64) -> Option<DVec2> {
        let behind = pass.behind_mm(z_mm);
        if behind.abs() > self.half_way_mm() + slack_mm {
            return None;
        }
        let swept = (behind / self.tip_mm).clamp(-0.86, 0.86).asin();
        let [place, _] = pass.at(swept, DVec2::new(self.tip_mm, 0.0), self.twist_rad_per_mm);
        Some(place.truncate())
    }

    /// Section of pass `index` at a place along the face, into memory that is reused. `false`: the pass does not cross the slice where the blank may be.
    pub fn section(&self, index: usize, z_mm: f64, into: &mut SweptSection) -> bool {
        let pass = &self.passes[index];
        let behind_mm = pass.behind_mm(z_mm);
        let Some(reached) = self.reached(pass, behind_mm) else { return false };
        let tip = (behind_mm / self.tip_mm).asin();
        into.pass = pass.pass;
        into.way_per_mm = pass.way_per_mm() / tip.cos();
        into.axis_and_out = pass.axis_and_out(tip);
        into.pieces.clear();
        into.nodes_mm.clear();
        into.rates_mm.clear();
        let (first, last) = (*reached.nodes.start(), *reached.nodes.end());
        let mut inner_mm = [DVec2::ZERO; 2];
        let found = self.walk(pass, z_mm, behind_mm, reached.nodes.clone(), |index, node, crossing| {
            if index > first {
                let end = crossing.rate(self.rates_mm[index - 1][1]);
                if let Some(rates) = into.rates_mm.last_mut() {
                    rates[1] = end;
                }
            }
            if index < last {
                into.rates_mm.push([crossing.rate(self.rates_mm[index][0]), DVec2::ZERO]);
            }
            if index == first || index == last {
                inner_mm[usize::from(index == last)] = crossing.inner_mm(node, reached.least_mm);
            }
            into.nodes_mm.push(crossing.place_mm);
        });
        if !found {
            return false;
        }
        for (index, rates) in into.rates_mm.iter().enumerate() {
            let sagitta_mm = sagitta_mm([into.nodes_mm[index], into.nodes_mm[index + 1]], rates);
            into.pieces.push(Piece { law: index as u32, range: [0.0, 1.0], sagitta_mm });
        }
        // Through the hob's body, behind the blank.
        into.nodes_mm.extend(inner_mm.into_iter().rev());
        into.pieces.extend([Piece { law: Piece::STRAIGHT, range: [0.0, 1.0], sagitta_mm: 0.0 }; 3]);
        true
    }

    /// Which part of the edge may meet the blank in a slice that lies so far behind the middle of a sweep. `None`: no part.
    pub(super) fn reached(&self, pass: &Sweeping, behind_mm: f64) -> Option<ReachedEdge> {
        if behind_mm.abs() >= self.half_way_mm() {
            return None;
        }
        // Nearer to the axis than this the edge is behind the blank, or never in this slice.
        let least_mm = (behind_mm.abs() + pass.lean() * self.widest_mm).hypot(SWEEP_RAD.cos() * self.tip_mm);
        let reaches = |node: &DVec2| node.x >= least_mm;
        let first = self.nodes_mm.iter().position(reaches)?;
        let last = self.nodes_mm.iter().rposition(reaches)?;
        (first < last).then_some(ReachedEdge { nodes: first..=last, least_mm })
    }

    /// Follows ends of pieces to the moments at which they go through a slice: `visit` gets the index, the point of the edge and its crossing. `false`: one of them has no such moment.
    pub(super) fn walk(
        &self,
        pass: &Sweeping,
        z_mm: f64,
        behind_mm: f64,
        nodes: RangeInclusive<usize>,
        mut visit: impl FnMut(usize, DVec2, &SliceCrossing),
    ) -> bool {
        let mut swept = (behind_mm / self.nodes_mm[*nodes.start()].x).clamp(-1.0, 1.0).asin();
        for index in nodes {
            let node = self.nodes_mm[index];
            let Some(at) = pass.moment(swept, node, self.twist_rad_per_mm, z_mm) else { return false };
            swept = at;
            visit(index, node, &pass.crossing(swept, node, self.twist_rad_per_mm));
        }
        true
    }
}

/// Part of the edge that may meet the blank in a slice.
pub(super) struct ReachedEdge {
    /// Ends of pieces.
    pub nodes: RangeInclusive<usize>,
    /// The curve is closed at this distance from the tool's axis, mm.
    pub least_mm: f64,
}

/// Largest distance of a piece from its chord, from the rates over its parameter at both ends: a cubic stays within the polygon of its control points.
pub(super) fn sagitta_mm(nodes_mm: [DVec2; 2], rates_mm: &[DVec2; 2]) -> f64 {
    let across = (nodes_mm[1] - nodes_mm[0]).normalize_or_zero();
    across.perp_dot(rates_mm[0]).abs().max(across.perp_dot(rates_mm[1]).abs()) / 3.0 + 1e-9
}

impl SweptSection {
    /// Range of the section across the rays of a family, mm.
    pub fn across_mm(&self, family: Family) -> [f64; 2] {
        let slack = self.pieces.iter().map(|piece| piece.sagitta_mm).fold(0.0, f64::max);
        let range = self.nodes_mm.iter().map(|&node| family.across(node));
        range.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v - slack), b.max(v + slack)])
    }
}

impl SweptSection {
    /// Cosine between the slice and the normal of the swept surface where its trace has the normal `trace`: the blade moves along the circumference, so that normal is a mean of the tool's axis and of
    /// the direction out of it. The work's own motion, some hundredths of the blade's, is left out.
    pub fn upright(&self, trace: DVec2) -> f64 {
        let [axis, out] = self.axis_and_out;
        let (along, outward) = (trace.perp_dot(out.truncate()), -trace.perp_dot(axis.truncate()));
        let normal = along * axis + outward * out;
        normal.truncate().length() / normal.length()
    }
}

impl ClosedCurve for SweptSection {
    fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    fn node_mm(&self, index: usize) -> DVec2 {
        self.nodes_mm[index]
    }

    fn place(&self, law: u32, share: f64) -> [DVec2; 2] {
        let (start, end) = (self.nodes_mm[law as usize], self.nodes_mm[law as usize + 1]);
        let [from, to] = self.rates_mm[law as usize];
        let run = end - start;
        let (square, cube) = (3.0 * run - 2.0 * from - to, from + to - 2.0 * run);
        [start + share * (from + share * (square + share * cube)), from + share * (2.0 * square + 3.0 * share * cube)]
    }

    fn tangents(&self, index: usize) -> [DVec2; 2] {
        self.rates_mm[index]
    }
}

/// Where an edge point crosses a slice, with how the place follows the edge point.
pub(super) struct SliceCrossing {
    pub place_mm: DVec2,
    /// Per mm of distance from the axis, and per mm of y.
    pub over_radius: DVec2,
    over_y: DVec2,
    /// Per mm of the slice's own place.
    pub over_z: DVec2,
    /// Cosine of the angle between the blade, here and now, and the head's x axis.
    pub out: f64,
}

impl SliceCrossing {
    /// How the place follows an edge point that moves.
    pub fn rate(&self, edge_rate: DVec2) -> DVec2 {
        edge_rate.x * self.over_radius + edge_rate.y * self.over_y
    }

    /// Where the section is closed: on, along the radius of the tool, to a smaller one.
    pub fn inner_mm(&self, node: DVec2, radius_mm: f64) -> DVec2 {
        self.place_mm - (node.x - radius_mm) * self.over_radius
    }
}

impl Sweeping {
    fn new(set: &HobTeeth, pass: &BladePass) -> Self {
        let place = set.place(pass);
        let mut pose = [[0.0; ENTRIES]; TERMS];
        // Chebyshev nodes and polynomials over the sweep, then powers.
        for node in 0..TERMS {
            let angle = PI * (node as f64 + 0.5) / TERMS as f64;
            let swept = SWEEP_RAD * angle.cos();
            let work_from_head = set.motion.head_from_work(pass.tool_angle_rad + set.turn * swept).inverse();
            let mut entries = [0.0; ENTRIES];
            entries[..9].copy_from_slice(&work_from_head.rotation.to_cols_array());
            entries[9..].copy_from_slice(&work_from_head.translation_mm.to_array());
            for (k, powers) in CHEBYSHEV.iter().enumerate() {
                let weight = (k as f64 * angle).cos() * if k == 0 { 1.0 } else { 2.0 } / TERMS as f64;
                for (term, power) in pose.iter_mut().zip(powers) {
                    for (coefficient, value) in term.iter_mut().zip(&entries) {
                        *coefficient += weight * power * value;
                    }
                }
            }
        }
        Self { pass: pass.pass, axial_mm: place.axial_mm, y_sign: place.y_sign, pose }
    }

    /// Values and rates over the swept angle of some entries of the pose.
    fn entries<const N: usize>(&self, swept: f64, which: [usize; N]) -> [[f64; 2]; N] {
        let u = swept / SWEEP_RAD;
        which.map(|entry| {
            let (mut value, mut rate) = (self.pose[TERMS - 1][entry], 0.0);
            for term in self.pose[..TERMS - 1].iter().rev() {
                rate = rate * u + value;
                value = value * u + term[entry];
            }
            [value, rate / SWEEP_RAD]
        })
    }

    /// How far the slice lies from the blade's axis in the direction in which the blade moves in the middle of its sweep, mm.
    pub fn behind_mm(&self, z_mm: f64) -> f64 {
        let [[along, _], [axis, _], [middle, _]] = self.entries(0.0, [5, 8, 11]);
        (z_mm - middle - axis * self.axial_mm) / along
    }

    /// Way of the blade per mm of the gear's axis in the middle of its sweep.
    pub fn way_per_mm(&self) -> f64 {
        let [[along, _]] = self.entries(0.0, [5]);
        along.abs().recip()
    }

    /// Directions of the tool's axis and of the blade out of it at a moment, gear frame.
    fn axis_and_out(&self, swept: f64) -> [DVec3; 2] {
        let [a, b, c, d, e, f, g, h, i] = self.entries(swept, [0, 1, 2, 3, 4, 5, 6, 7, 8]).map(|[value, _]| value);
        let (sin, cos) = swept.sin_cos();
        [DVec3::new(g, h, i), cos * DVec3::new(a, b, c) + sin * DVec3::new(d, e, f)]
    }

    /// How far the slice moves along the blade's way per mm of its y.
    fn lean(&self) -> f64 {
        let [[along, _], [axis, _]] = self.entries(0.0, [5, 8]);
        (axis / along).abs()
    }

    /// Whether the rake face is seen from behind along the gear axis.
    fn is_turned_over(&self) -> bool {
        let turn = self.entries(0.0, [0, 1, 6, 7]).map(|[value, _]| value);
        DVec2::new(turn[0], turn[1]).perp_dot(self.y_sign * DVec2::new(turn[2], turn[3])) < 0.0
    }

    fn in_head(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> [DVec3; 2] {
        let (sin, cos) = (swept + twist_rad_per_mm * node.y).sin_cos();
        let place = DVec3::new(node.x * cos, node.x * sin, self.axial_mm + self.y_sign * node.y);
        [place, DVec3::new(-node.x * sin, node.x * cos, 0.0)]
    }

    /// Moment at which an edge point goes through a slice, from a guess.
    fn moment(&self, guess: f64, node: DVec2, twist_rad_per_mm: f64, z_mm: f64) -> Option<f64> {
        let mut swept = guess;
        for _ in 0..MOST_STEPS {
            let [x, y, z, shift] = self.entries(swept, [2, 5, 8, 11]);
            let [place, turning] = self.in_head(swept, node, twist_rad_per_mm);
            let value = x[0] * place.x + y[0] * place.y + z[0] * place.z + shift[0] - z_mm;
            let rate =
                x[0] * turning.x + y[0] * turning.y + (x[1] * place.x + y[1] * place.y + z[1] * place.z) + shift[1];
            let step = value / rate;
            swept -= step;
            if step.abs() < LAST_STEP_RAD {
                return Some(swept);
            }
            if step.is_nan() || swept.abs() > LARGEST_ANGLE_RAD {
                return None;
            }
        }
        None
    }

    /// Place in the work and its rate over the swept angle.
    fn at(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> [DVec3; 2] {
        let e = self.entries(swept, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
        let [place, turning] = self.in_head(swept, node, twist_rad_per_mm);
        let column = |k: usize, part: usize| DVec3::new(e[k][part], e[k + 1][part], e[k + 2][part]);
        let turned = |v: DVec3, part: usize| column(0, part) * v.x + column(3, part) * v.y + column(6, part) * v.z;
        [turned(place, 0) + column(9, 0), turned(place, 1) + column(9, 1) + turned(turning, 0)]
    }

    /// The point at its moment, and how its place in the slice follows the edge point.
    fn crossing(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> SliceCrossing {
        let e = self.entries(swept, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
        let [place, turning] = self.in_head(swept, node, twist_rad_per_mm);
        let column = |k: usize, part: usize| DVec3::new(e[k][part], e[k + 1][part], e[k + 2][part]);
        let turned = |v: DVec3, part: usize| column(0, part) * v.x + column(3, part) * v.y + column(6, part) * v.z;
        let place_mm = turned(place, 0) + column(9, 0);
        let over_swept = turned(place, 1) + column(9, 1) + turned(turning, 0);
        let out = DVec3::new(place.x, place.y, 0.0) / node.x;
        let over_radius = turned(out, 0);
        let over_y = turned(twist_rad_per_mm * turning + DVec3::new(0.0, 0.0, self.y_sign), 0);
        // The moment moves so that the point stays in the slice.
        let held = |v: DVec3| (v - over_swept * (v.z / over_swept.z)).truncate();
        SliceCrossing {
            place_mm: place_mm.truncate(),
            over_radius: held(over_radius),
            over_y: held(over_y),
            over_z: over_swept.truncate() / over_swept.z,
            out: out.x,
        }
    }
}

/// Chebyshev polynomials in powers.
const CHEBYSHEV: [[f64; TERMS]; TERMS] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [-1.0, 0.0, 2.0, 0.0, 0.0, 0.0],
    [0.0, -3.0, 0.0, 4.0, 0.0, 0.0],
    [1.0, 0.0, -8.0, 0.0, 8.0, 0.0],
    [0.0, 5.0, 0.0, -20.0, 0.0, 16.0],
];

/// Ends of the pieces of an edge in the blade frame, and the directions at both ends of each over a parameter from 0 to 1.
fn edge_pieces(edge: &Edge, longest_mm: f64) -> (Vec<DVec2>, Vec<[DVec2; 2]>) {
    let (mut nodes_mm, mut rates_mm) = (Vec::new(), Vec::new());
    for segment in &edge.segments {
        let [from, to] = segment.y_range_mm;
        let turn = (segment.x_and_slope(from)[1].atan() - segment.x_and_slope(to)[1].atan()).abs();
        let count = ((to - from) / longest_mm).max(turn / PIECE_TURN_RAD).ceil().max(1.0);
        let step = (to - from) / count;
        for piece in 0..count as usize {
            let ends = [piece, piece + 1].map(|i| place(segment, from + step * i as f64));
            nodes_mm.push(ends[0][0]);
            rates_mm.push(ends.map(|[_, rate]| step * rate));
        }
    }
    if let Some(last) = edge.segments.last() {
        nodes_mm.push(place(last, last.y_range_mm[1])[0]);
    }
    (nodes_mm, rates_mm)
}

/// Point and derivative over y of a segment, blade frame.
fn place(segment: &Segment, y_mm: f64) -> [DVec2; 2] {
    let [x, slope] = segment.x_and_slope(y_mm);
    let frame = &segment.blade_from_segment;
    [frame.point(DVec2::new(x, y_mm)), frame.direction(DVec2::new(slope, 1.0))]
}
