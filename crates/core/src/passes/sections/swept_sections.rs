//! A turning tool's sweep where it crosses a transverse slice of the work: a closed curve, as a cutter tooth's outline
//! is in shaping.
//!
//! In: the passes of an operation with the edges of their blades, a slice. Out: for each pass a [`SweptSection`] that
//! rays along x and y are laid on.
//!
//! **The law.** A point of the work is removed when it lies inside the blade's edge at the moment at which the rake
//! face holds it. Place in the rake face and moment are coordinates of space, one to one as long as the blade moves
//! across the slice; so what a sweep removes of the plane z = const is the tooth's region itself, every point put where
//! it stands when it goes through that plane, and its border is the edge, point by point: for the edge point (rho, y)
//! the moment delta is the root of
//!
//! `z(work_from_head(delta) (rho cos(delta + twist y), rho sin(delta + twist y), z0 + y)) = z_slice`.
//!
//! No ray is searched for several moments: a ray that a sweep meets more than once crosses this curve more than twice.
//! The curve is a chain of cubics with the true points and directions at their ends, less than 20 nm off between them
//! (tested against the equations of [`crate::passes::spatial::sweep`]).
//!
//! **Behind the blank.** Edge points that go through the slice nearer to the tool's axis, seen from the work, than the
//! end of a sweep (a hob: half the tip radius) are left out, as everywhere ([`TurningPasses::half_window_rad`]); the
//! curve is closed there through the tool's body.
//!
//! The road not taken: rays against segments with two unknowns each, as flanks are cut. Rays of a slice lie side by
//! side, and one walk along the outline finds the crossings of all of them.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::swept_pose::{SliceCrossing, Sweeping};
use crate::error::Refusal;
use crate::math::planar_rays::{ClosedCurve, Family, Piece};
use crate::passes::spatial::sweep_roots::LANES;
use crate::passes::spatial::turning_passes::{BladePass, TurningPasses};
use crate::tool::edge::{Edge, Segment};
use glam::{DVec2, DVec3};
use pulp::Arch;
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Longest piece of the edge, as a share of the distance of its tip from the axis: a cubic over it misses some
/// nanometres where the sweep leaves the work.
const PIECE_SHARE: f64 = 0.03;
/// Largest turn of the edge within a piece, rad.
const PIECE_TURN_RAD: f64 = 0.1;
/// Places of a flank of an edge, each a quarter of the tooth's depth, 0.6 modules on a usual hob: a choice
/// between wear that is smeared out and places that few rays meet.
pub const FLANK_PLACES: usize = 4;
/// Places of an edge: those of one flank, the tip (wherever the edge's normal is within 45 degrees of the way out of
/// the tool), those of the other.
pub const EDGE_PLACES: usize = 2 * FLANK_PLACES + 1;
/// Steps in which a piece of the edge is counted to its places: pieces are 2 mm long at most on a hob of 140 mm.
const LENGTH_STEPS: f64 = 64.0;
/// Height of slices that one section tells about, as a share of the distance of the edge's tip from the axis.
const BAND_SHARE: f64 = 0.03;
/// Distance of the places along the face at which passes are culled beforehand, mm. Every slice is within half of it of
/// such a place. A hob that is not tilted goes through a slice at 60 degrees to its own middle at most
/// ([`TurningPasses::half_window_rad`]), so that its section moves aside by tan 60 degrees = 1.73 mm per mm: 4.3 mm,
/// less than the whole distance, which is what the cull allows for. For tilted hobs there is no proof; what is left is
/// compared with all passes in `tests/suite/hobbing/blank.rs`.
const CULLED_EVERY_MM: f64 = 5.0;

/// The passes of an operation, ready to be cut at any height.
pub struct SweptSections {
    /// Outlines of the edges.
    outlines: Vec<EdgeOutline>,
    /// Passes that may reach the blank, in order of time.
    pub(super) passes: Vec<Sweeping>,
    twist_rad_per_mm: f64,
    half_window_rad: f64,
    /// Whether passes are compared with what is left before they are followed to a slice; otherwise every pass visits
    /// every ray: what culling is compared with.
    culls: bool,
    /// Share of the tolerance that outlines get when they are compared with what is left: 1. Less culls passes that
    /// matter; tests plant it.
    pub tolerance_share: f64,
}

/// An edge in its rake face as a chain of pieces.
#[expect(clippy::struct_field_names, reason = "all of it is lengths, and says so")]
pub(super) struct EdgeOutline {
    /// Ends of the pieces: distance from the axis and y.
    nodes_mm: Vec<DVec2>,
    /// Directions at both ends of every piece, per piece.
    pub rates_mm: Vec<[DVec2; 2]>,
    /// Radius of the tip, mm.
    tip_mm: f64,
    /// Depth of the tooth under its tip, mm.
    depth_mm: f64,
    /// Largest distance of an edge point from the middle of its blade, mm.
    widest_mm: f64,
    /// Longest piece, mm.
    pub longest_mm: f64,
}

impl EdgeOutline {
    fn new(edge: &Edge) -> Self {
        let tip_mm = edge.segments.iter().flat_map(|s| s.y_range_mm.map(|y| place(s, y)[0].x)).fold(0.0, f64::max);
        let longest_mm = PIECE_SHARE * tip_mm;
        let (nodes_mm, rates_mm) = edge_pieces(edge, longest_mm);
        let widest_mm = nodes_mm.iter().map(|node| node.y.abs()).fold(0.0, f64::max);
        let depth_mm = nodes_mm.iter().map(|node| tip_mm - node.x).fold(0.0, f64::max);
        Self { nodes_mm, rates_mm, tip_mm, depth_mm, widest_mm, longest_mm }
    }

    /// The same chain the other way round.
    fn reversed(mut self) -> Self {
        self.nodes_mm.reverse();
        self.rates_mm.reverse();
        for rates in &mut self.rates_mm {
            *rates = [-rates[1], -rates[0]];
        }
        self
    }
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
    /// How the blade goes through the slice.
    pub heading: SweepHeading,
}

/// How a blade goes through a slice where its tip crosses it.
#[derive(Debug, Clone, Copy, Default)]
pub struct SweepHeading {
    /// Travel of the tip per mm along the gear's axis.
    pub travel_per_mm: f64,
    /// Directions of the tool's axis and of the tip out of it, gear frame.
    pub(crate) axis_and_out: [DVec3; 2],
    /// The blade's place on the tool's axis, gear frame, from the slice, mm.
    pub(crate) centre_mm: DVec3,
    /// Radius of the tip, and depth of the tooth under it, mm.
    pub(crate) tip_and_depth_mm: [f64; 2],
}

impl SweptSections {
    /// The `wanted` passes of an operation for a blank within `reach_mm` of the gear axis, over the face; all of them,
    /// wherever they are, if not `cull`.
    ///
    /// # Errors
    /// Blades that do not look away from the tool's axis: sections are closed towards it, through the tool's body.
    pub fn new(
        wanted: impl Fn(&BladePass) -> bool + Sync,
        set: &TurningPasses,
        reach_mm: f64,
        face_width_mm: f64,
        cull: bool,
    ) -> Result<Self, Refusal> {
        if let Some(place) = set.places.iter().find(|place| place.looks != DVec2::X || place.radial_mm != 0.0) {
            return Err(Refusal::new(
                "tool",
                format!("blade {} does not look straight away from the tool's axis", place.blade),
                "cut its flanks alone; rays through the whole blank take hobs",
            ));
        }
        let mut outlines: Vec<EdgeOutline> = set.edges.edges().iter().map(EdgeOutline::new).collect();
        let some = (0..set.count()).into_par_iter().map(|i| set.pass(i)).filter(|pass| wanted(pass));
        let passes: Vec<Sweeping> = some.map(|pass| Sweeping::new(set, &pass)).collect();
        // Seen along the gear axis the rake face may show its other side: inside is on the left there too.
        if passes.first().is_some_and(Sweeping::is_turned_over) {
            outlines = outlines.into_iter().map(EdgeOutline::reversed).collect();
        }
        let twist_rad_per_mm = set.rake_twist_rad_per_mm;
        let mut sections = Self {
            outlines,
            passes,
            twist_rad_per_mm,
            half_window_rad: set.half_window_rad,
            culls: cull,
            tolerance_share: 1.0,
        };
        if cull {
            let tooth_mm = 2.0 * set.edges.largest_reach_mm();
            let places = (face_width_mm / CULLED_EVERY_MM).ceil().max(1.0);
            let passes = std::mem::take(&mut sections.passes);
            sections.passes = passes
                .into_par_iter()
                .filter(|pass| {
                    (0..=places as u32).any(|i| {
                        let z_mm = face_width_mm * (f64::from(i) / places - 0.5);
                        // Between the places the section moves aside by less than they are apart; the tip stands for
                        // its whole tooth.
                        let reach_mm = reach_mm + tooth_mm + CULLED_EVERY_MM;
                        sections.tip_at(pass, z_mm, CULLED_EVERY_MM).is_some_and(|tip| tip.length() <= reach_mm)
                    })
                })
                .collect();
        }
        Ok(sections)
    }

    /// Number of passes that are looked at.
    pub fn len(&self) -> usize {
        self.passes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.passes.is_empty()
    }

    /// Whether passes are compared with what is left before they are followed to a slice.
    pub fn culls(&self) -> bool {
        self.culls
    }

    /// Height of slices that one section tells enough about, mm: outlines get some hundredths of a millimetre of
    /// tolerance at most, a few micrometres in the middle of a sweep.
    pub fn band_mm(&self) -> f64 {
        BAND_SHARE * self.outlines.iter().map(|outline| outline.tip_mm).fold(f64::INFINITY, f64::min)
    }

    /// No place of a section lies farther than this from its middle, mm: sections lie within the tool's tips.
    pub fn reach_mm(&self) -> f64 {
        self.outlines.iter().map(|outline| 2.0 * outline.tip_mm).fold(0.0, f64::max)
    }

    /// Outline of the edge of a pass's blade.
    pub(super) fn outline_of(&self, pass: &Sweeping) -> &EdgeOutline {
        &self.outlines[pass.edge]
    }

    /// Ids of the passes whose tip comes within `reach_mm` of the gear's axis in the slice at `z_mm`, in order of time.
    pub fn ids_through(&self, z_mm: f64, reach_mm: f64) -> Vec<u32> {
        let comes_near = |pass: &&Sweeping| self.tip_at(pass, z_mm, 0.0).is_some_and(|tip| tip.length() <= reach_mm);
        self.passes.iter().filter(comes_near).map(|pass| pass.pass).collect()
    }

    /// Half the travel along the tool's circumference direction that the tip goes through before it is behind the
    /// blank, mm.
    fn half_travel_mm(&self, outline: &EdgeOutline) -> f64 {
        outline.tip_mm * self.half_window_rad.sin()
    }

    /// Where the middle of the tip crosses a slice, or would at the end of its sweep if it comes within `tolerance_mm`
    /// of it.
    fn tip_at(&self, pass: &Sweeping, z_mm: f64, tolerance_mm: f64) -> Option<DVec2> {
        let (outline, behind) = (self.outline_of(pass), pass.behind_mm(z_mm));
        if behind.abs() > self.half_travel_mm(outline) + tolerance_mm {
            return None;
        }
        let farthest = self.half_window_rad.sin();
        let swept = (behind / outline.tip_mm).clamp(-farthest, farthest).asin();
        Some(pass.place_mm(swept, DVec2::new(outline.tip_mm, 0.0), self.twist_rad_per_mm).truncate())
    }

    /// Section of pass `index` at a place along the face, into memory that is reused. `false`: the pass does not cross
    /// the slice where the blank may be.
    pub fn section(&self, index: usize, z_mm: f64, into: &mut SweptSection) -> bool {
        Arch::new().dispatch(Following { sections: self, index, z_mm, into })
    }

    #[inline(always)]
    fn follow(&self, index: usize, z_mm: f64, into: &mut SweptSection) -> bool {
        let pass = &self.passes[index];
        let behind_mm = pass.behind_mm(z_mm);
        let Some(reached) = self.reached(pass, behind_mm) else { return false };
        let outline = self.outline_of(pass);
        let tip = (behind_mm / outline.tip_mm).asin();
        let [axis, out, centre_mm] = pass.axis_out_and_centre(tip);
        into.pass = pass.pass;
        into.heading = SweepHeading {
            travel_per_mm: pass.travel_per_mm() / tip.cos(),
            axis_and_out: [axis, out],
            centre_mm: centre_mm - z_mm * DVec3::Z,
            tip_and_depth_mm: [outline.tip_mm, outline.depth_mm],
        };
        into.pieces.clear();
        into.nodes_mm.clear();
        into.rates_mm.clear();
        let (first, last) = (*reached.nodes.start(), *reached.nodes.end());
        let mut inner_mm = [DVec2::ZERO; 2];
        let found = self.walk(pass, z_mm, behind_mm, reached.nodes.clone(), |index, node, crossing| {
            if index > first {
                let end = crossing.rate(outline.rates_mm[index - 1][1]);
                if let Some(rates) = into.rates_mm.last_mut() {
                    rates[1] = end;
                }
            }
            if index < last {
                into.rates_mm.push([crossing.rate(outline.rates_mm[index][0]), DVec2::ZERO]);
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
        // Through the tool's body, behind the blank.
        into.nodes_mm.extend(inner_mm.into_iter().rev());
        into.pieces.extend([Piece { law: Piece::STRAIGHT, range: [0.0, 1.0], sagitta_mm: 0.0 }; 3]);
        true
    }

    /// Which part of the edge may meet the blank in a slice that lies so far behind the middle of a sweep. `None`: no
    /// part.
    pub(super) fn reached(&self, pass: &Sweeping, behind_mm: f64) -> Option<ReachedEdge> {
        let outline = self.outline_of(pass);
        if behind_mm.abs() >= self.half_travel_mm(outline) {
            return None;
        }
        // Nearer to the axis than this the edge is behind the blank, or never in this slice.
        let least_mm =
            (behind_mm.abs() + pass.lean() * outline.widest_mm).hypot(self.half_window_rad.cos() * outline.tip_mm);
        let reaches = |node: &DVec2| node.x >= least_mm;
        let first = outline.nodes_mm.iter().position(reaches)?;
        let last = outline.nodes_mm.iter().rposition(reaches)?;
        (first < last).then_some(ReachedEdge { nodes: first..=last, least_mm })
    }

    /// Follows ends of pieces to the moments at which they go through a slice, each from the one before: `visit` gets
    /// the index, the point of the edge and its crossing. `false`: one of them has no such moment.
    #[inline(always)]
    fn walk(
        &self,
        pass: &Sweeping,
        z_mm: f64,
        behind_mm: f64,
        nodes: RangeInclusive<usize>,
        mut visit: impl FnMut(usize, DVec2, &SliceCrossing),
    ) -> bool {
        let nodes_mm = &self.outline_of(pass).nodes_mm;
        let mut swept = (behind_mm / nodes_mm[*nodes.start()].x).clamp(-1.0, 1.0).asin();
        for index in nodes {
            let node = nodes_mm[index];
            let Some(at) = pass.moment(swept, node, self.twist_rad_per_mm, z_mm) else { return false };
            swept = at;
            visit(index, node, &pass.crossing(swept, node, self.twist_rad_per_mm));
        }
        true
    }

    /// The same of a smooth pass, eight ends at once; places are the same but for rounding.
    #[inline(always)]
    pub(super) fn walk_abreast(
        &self,
        pass: &Sweeping,
        z_mm: f64,
        nodes: RangeInclusive<usize>,
        mut visit: impl FnMut(usize, DVec2, &SliceCrossing),
    ) -> bool {
        let (first, last) = nodes.into_inner();
        let nodes_mm = &self.outline_of(pass).nodes_mm;
        for start in (first..=last).step_by(LANES) {
            // Lanes beyond the last end repeat it.
            let lanes: [DVec2; LANES] = std::array::from_fn(|l| nodes_mm[(start + l).min(last)]);
            let Some(crossings) = pass.crossings(&lanes, self.twist_rad_per_mm, z_mm) else { return false };
            for (l, crossing) in crossings.iter().enumerate().take(last + 1 - start) {
                visit(start + l, lanes[l], crossing);
            }
        }
        true
    }
}

/// A section on its way, called through the instruction set dispatch.
struct Following<'a> {
    sections: &'a SweptSections,
    index: usize,
    z_mm: f64,
    into: &'a mut SweptSection,
}

impl pulp::NullaryFnOnce for Following<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.sections.follow(self.index, self.z_mm, self.into)
    }
}

/// Part of the edge that may meet the blank in a slice.
pub(super) struct ReachedEdge {
    /// Ends of pieces.
    pub nodes: RangeInclusive<usize>,
    /// The curve is closed at this distance from the tool's axis, mm.
    pub least_mm: f64,
}

/// Largest distance of a piece from its chord, from the rates over its parameter at both ends: a cubic stays within the
/// polygon of its control points.
#[inline(always)]
pub(super) fn sagitta_mm(nodes_mm: [DVec2; 2], rates_mm: &[DVec2; 2]) -> f64 {
    let across = (nodes_mm[1] - nodes_mm[0]).normalize_or_zero();
    across.perp_dot(rates_mm[0]).abs().max(across.perp_dot(rates_mm[1]).abs()) / 3.0 + 1e-9
}

impl SweptSection {
    /// The curve by chords, so many in each of its pieces, mm.
    pub fn outline_mm(&self, chords: u32) -> Vec<DVec2> {
        let share = |chord: u32| f64::from(chord) / f64::from(chords);
        let of_piece = |law: u32| (0..chords).map(move |chord| self.place(law, share(chord))[0]);
        let cut = (0..self.rates_mm.len() as u32).flat_map(of_piece);
        cut.chain(self.nodes_mm[self.rates_mm.len()..].iter().copied()).collect()
    }

    /// Range of the section across the rays of a family, mm.
    pub fn across_mm(&self, family: Family) -> [f64; 2] {
        let tolerance = self.pieces.iter().map(|piece| piece.sagitta_mm).fold(0.0, f64::max);
        let range = self.nodes_mm.iter().map(|&node| family.across(node));
        range.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v - tolerance), b.max(v + tolerance)])
    }
}

impl SweepHeading {
    /// Cosine between the slice and the normal of the swept surface where its trace has the normal `trace`: the blade
    /// moves along the circumference, so that normal is a mean of the tool's axis and of the direction out of it. The
    /// work's own motion, some hundredths of the blade's, is left out.
    pub fn upright(&self, trace: DVec2) -> f64 {
        let [axis, out] = self.axis_and_out;
        let (along, outward) = (trace.perp_dot(out.truncate()), -trace.perp_dot(axis.truncate()));
        let normal = along * axis + outward * out;
        normal.truncate().length() / normal.length()
    }

    /// Where on the edge a place of the slice was cut, whose swept surface has the trace's normal `trace`: a number
    /// below [`EDGE_PLACES`]. The distance from the tool's axis says how far under the tip; the work's own motion while
    /// the edge goes through the slice, along the tool's axis, hardly changes it.
    pub fn edge_place(&self, at: DVec2, trace: DVec2) -> usize {
        let [axis, out] = self.axis_and_out;
        let (along, outward) = (trace.perp_dot(out.truncate()), -trace.perp_dot(axis.truncate()));
        let from_centre = at.extend(0.0) - self.centre_mm;
        let radius_mm = from_centre.reject_from_normalized(axis).length();
        let [tip_mm, depth_mm] = self.tip_and_depth_mm;
        // Which flank: on which side of its middle the blade was there.
        edge_place((tip_mm - radius_mm) / depth_mm, outward.abs() >= along.abs(), from_centre.dot(axis) > 0.0)
    }
}

/// The place of the edge at a share of the tooth's depth: the tip, or one of [`FLANK_PLACES`] of equal depth on a
/// flank; 0 is the deepest one of the flank towards the tool's +z, numbers go on over the tip.
fn edge_place(share_of_depth: f64, is_tip: bool, towards_z: bool) -> usize {
    // Root lands look out of the tool as well.
    if is_tip && share_of_depth < 0.5 {
        return FLANK_PLACES;
    }
    let under = ((share_of_depth.max(0.0) * FLANK_PLACES as f64) as usize).min(FLANK_PLACES - 1);
    if towards_z { FLANK_PLACES - 1 - under } else { FLANK_PLACES + 1 + under }
}

/// Length of every place of an edge ([`SweepHeading::edge_place`]), mm.
pub fn edge_place_lengths_mm(edge: &Edge) -> [f64; EDGE_PLACES] {
    let outline = EdgeOutline::new(edge);
    let mut lengths_mm = [0.0; EDGE_PLACES];
    for ends in outline.nodes_mm.windows(2) {
        let run = (ends[1] - ends[0]) / LENGTH_STEPS;
        // The blade's y runs against the tool's z.
        for step in 0..LENGTH_STEPS as u32 {
            let middle = ends[0] + (f64::from(step) + 0.5) * run;
            let share = (outline.tip_mm - middle.x) / outline.depth_mm;
            lengths_mm[edge_place(share, run.y.abs() >= run.x.abs(), middle.y < 0.0)] += run.length();
        }
    }
    lengths_mm
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

/// Ends of the pieces of an edge in the blade frame, and the directions at both ends of each over a parameter from 0 to
/// 1.
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
