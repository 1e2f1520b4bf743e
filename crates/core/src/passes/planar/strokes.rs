//! The strokes of one operation as poses of the cutter, ready for the dexels.
//!
//! The planar kernel needs the cutter's pose at every place along the tooth. While a stroke goes through the face the
//! rotary feed may go on; what the cutter does is smooth in the **phase** of the stroke (time), not in the place along
//! the tooth (the crank makes that relation steep near the ends of the stroke). So each row of a field has a phase tau
//! in [-1, 1], each stroke has poses at Chebyshev nodes of tau, and everything made of them is a cubic in tau. A frozen
//! stroke is the constant. Where a guide leads the cutter aside along the tooth, tau follows the place itself while the
//! axes rest; with a crank the guide's shift is the cubic in tau: on usual strokes a slope within half a per cent, a
//! bow within 4 %.
//!
//! Law of the ram: z = z_m + (L/2) cos(theta), L = approach + face + overrun, theta from 0 to pi during the cut, half
//! of a double stroke's time; so a place z is reached at theta = arccos(2 (z - z_m) / L). The stroke's own moment is
//! the one when the middle of the face is cut.

use crate::frame::Rigid2;
use crate::tool::PlanarTool;
use arrayvec::ArrayVec;
use glam::DVec2;
use std::ops::Range;

/// Nodes of the cubic in tau (Chebyshev of the first kind on [-1, 1]).
pub const NODES: [f64; 4] =
    [-0.923_879_532_511_286_7, -0.382_683_432_365_089_8, 0.382_683_432_365_089_8, 0.923_879_532_511_286_7];

/// How places along the tooth become phases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StrokeLaw {
    /// The pose of the stroke's own moment holds for its whole length.
    Frozen,
    /// The feed rests during a stroke, but the cutter stands elsewhere at other heights: led aside by the guide of the
    /// ram, or by what the axes do at random meanwhile.
    Guided {
        /// Half of the face width, mm: tau = 1 is at its lower end.
        half_face_mm: f64,
    },
    /// Crank: the feed goes on.
    Crank {
        /// Stroke length L, mm.
        length_mm: f64,
        /// Middle of the stroke relative to the middle of the face, mm.
        middle_mm: f64,
        /// Half of the share of a double stroke that the face takes: tau = 1 is this much of a stroke after the middle
        /// of the face.
        half_share: f64,
    },
}

impl StrokeLaw {
    /// Crank law for a face of `face_width_mm` entered at its upper end (positive z).
    pub fn crank(face_width_mm: f64, approach_mm: f64, overrun_mm: f64) -> Self {
        let length_mm = approach_mm + face_width_mm + overrun_mm;
        let middle_mm = 0.5 * (approach_mm - overrun_mm);
        let angle = |z_mm: f64| (2.0 * (z_mm - middle_mm) / length_mm).clamp(-1.0, 1.0).acos();
        let at = |z_mm: f64| (angle(z_mm) - angle(0.0)) / std::f64::consts::TAU;
        let half_share = at(-0.5 * face_width_mm).abs().max(at(0.5 * face_width_mm).abs());
        Self::Crank { length_mm, middle_mm, half_share }
    }

    /// Phase tau in [-1, 1] at a place along the tooth.
    pub fn tau(&self, z_mm: f64) -> f64 {
        match *self {
            Self::Frozen => 0.0,
            Self::Guided { half_face_mm } => -z_mm / half_face_mm,
            Self::Crank { length_mm, middle_mm, half_share } => {
                let angle = |z_mm: f64| (2.0 * (z_mm - middle_mm) / length_mm).clamp(-1.0, 1.0).acos();
                (angle(z_mm) - angle(0.0)) / std::f64::consts::TAU / half_share
            }
        }
    }

    /// Place along the tooth at a phase, mm; the middle of the face where all places are alike.
    pub fn z_mm(&self, tau: f64) -> f64 {
        match *self {
            Self::Frozen => 0.0,
            Self::Guided { half_face_mm } => -tau * half_face_mm,
            Self::Crank { length_mm, middle_mm, half_share } => {
                let middle = (-2.0 * middle_mm / length_mm).clamp(-1.0, 1.0).acos();
                middle_mm + 0.5 * length_mm * (middle + tau * half_share * std::f64::consts::TAU).cos()
            }
        }
    }

    /// Whether the axes rest while the cutter is in the work.
    pub fn rests(&self) -> bool {
        !matches!(self, Self::Crank { .. })
    }

    /// Fraction of a double stroke between the stroke's own moment and phase tau.
    pub fn stroke_share(&self, tau: f64) -> f64 {
        match *self {
            Self::Frozen | Self::Guided { .. } => 0.0,
            Self::Crank { half_share, .. } => tau * half_share,
        }
    }

    /// Fraction of a double stroke from the stroke's own moment to the one at which the return stroke passes the same
    /// place again; 0 where the axes rest. The ram is there at theta and at 2 pi - theta.
    pub fn return_share(&self, tau: f64) -> f64 {
        match *self {
            Self::Frozen | Self::Guided { .. } => 0.0,
            Self::Crank { length_mm, middle_mm, .. } => {
                1.0 - (-2.0 * middle_mm / length_mm).clamp(-1.0, 1.0).acos() / std::f64::consts::PI
                    - self.stroke_share(tau)
            }
        }
    }
}

/// Poses of all strokes of an operation.
#[derive(Debug, Clone)]
pub struct StrokeSet {
    /// Id of the first pass; pass ids grow with time, blade by blade within a stroke.
    pub first_pass: u32,
    /// Blades of the tool.
    pub blades: u32,
    /// Phase law.
    pub law: StrokeLaw,
    /// `work_from_tool` of every stroke at the nodes: one pose when frozen, else one for each of [`NODES`].
    poses: Vec<Rigid2>,
    /// The paths through them.
    paths: Vec<StrokePath>,
    /// No point of the tool lies further from its axis, mm.
    tool_reach_mm: f64,
    /// See [`Self::bend_mm`].
    bend_mm: f64,
}

impl StrokeSet {
    /// Strokes 0 to `count` - 1; `work_from_tool(lambda)` gives the pose at any real stroke number.
    pub fn new(
        first_pass: u32,
        tool: &dyn PlanarTool,
        law: StrokeLaw,
        count: usize,
        mut work_from_tool: impl FnMut(f64) -> Rigid2,
    ) -> Self {
        Self::along_guide(first_pass, tool, law, count, |lambda, _| work_from_tool(lambda))
    }

    /// The same where the pose is another one at every place along the tooth: `work_from_tool(lambda, z_mm)`.
    pub fn along_guide(
        first_pass: u32,
        tool: &dyn PlanarTool,
        law: StrokeLaw,
        count: usize,
        work_from_tool: impl FnMut(f64, f64) -> Rigid2,
    ) -> Self {
        Self::at_shares(first_pass, tool, law, count, |tau| law.stroke_share(tau), work_from_tool)
    }

    /// The way back after each of those strokes: poses at the moments when the ram passes the same places again.
    pub fn returning(
        first_pass: u32,
        tool: &dyn PlanarTool,
        law: StrokeLaw,
        count: usize,
        work_from_tool: impl FnMut(f64, f64) -> Rigid2,
    ) -> Self {
        Self::at_shares(first_pass, tool, law, count, |tau| law.return_share(tau), work_from_tool)
    }

    /// The same strokes with the tool elsewhere: `displaced(stroke, work_from_tool)` for every pose of every stroke.
    #[must_use]
    pub fn displaced(&self, displaced: impl Fn(usize, &Rigid2) -> Rigid2) -> Self {
        let nodes = self.phases().len();
        let poses = self.poses.iter().enumerate().map(|(index, pose)| displaced(index / nodes, pose));
        Self::of_poses(poses.collect(), self)
    }

    /// Some of those strokes.
    #[must_use]
    pub fn some(&self, strokes: Range<usize>) -> Self {
        let (nodes, first_pass) = (self.phases().len(), self.pass_id(strokes.start, 0));
        let poses = self.poses[strokes.start * nodes..strokes.end * nodes].to_vec();
        Self { first_pass, ..Self::of_poses(poses, self) }
    }

    /// Other poses of the same strokes.
    fn of_poses(poses: Vec<Rigid2>, &Self { first_pass, blades, law, tool_reach_mm, .. }: &Self) -> Self {
        let paths: Vec<StrokePath> = poses.chunks(Self::node_phases(law).len()).map(StrokePath::through).collect();
        let bend_mm = paths.iter().map(|path| path.bend_mm(tool_reach_mm)).fold(0.0, f64::max);
        Self { first_pass, blades, law, poses, paths, tool_reach_mm, bend_mm }
    }

    fn at_shares(
        first_pass: u32,
        tool: &dyn PlanarTool,
        law: StrokeLaw,
        count: usize,
        share: impl Fn(f64) -> f64,
        mut work_from_tool: impl FnMut(f64, f64) -> Rigid2,
    ) -> Self {
        let nodes: Vec<[f64; 2]> = Self::node_phases(law).iter().map(|&tau| [share(tau), law.z_mm(tau)]).collect();
        let moments =
            (0..count).flat_map(|stroke| nodes.iter().map(move |[share, z_mm]| (stroke as f64 + share, *z_mm)));
        let poses = moments.map(|(lambda, z_mm)| work_from_tool(lambda, z_mm)).collect();
        let edges = tool.edges();
        let blade_reach_mm = |blade: u32| {
            let edge = edges.edge_of(blade);
            tool.tool_from_blade(blade).point(edge.center_mm).length() + edge.reach_mm
        };
        let tool_reach_mm = (0..tool.blade_count()).map(blade_reach_mm).fold(0.0, f64::max);
        let none = Self {
            first_pass,
            blades: tool.blade_count(),
            law,
            poses: Vec::new(),
            paths: Vec::new(),
            tool_reach_mm,
            bend_mm: 0.0,
        };
        Self::of_poses(poses, &none)
    }

    fn node_phases(law: StrokeLaw) -> &'static [f64] {
        match law {
            StrokeLaw::Frozen => &[0.0],
            StrokeLaw::Guided { .. } | StrokeLaw::Crank { .. } => &NODES,
        }
    }

    /// Phases of the poses that [`Self::poses`] gives.
    pub fn phases(&self) -> &'static [f64] {
        Self::node_phases(self.law)
    }

    /// Number of strokes.
    pub fn count(&self) -> usize {
        self.poses.len() / self.phases().len()
    }

    /// Poses of one stroke at [`Self::phases`].
    pub fn poses(&self, stroke: usize) -> &[Rigid2] {
        let nodes = self.phases().len();
        &self.poses[stroke * nodes..(stroke + 1) * nodes]
    }

    /// How the pose of one stroke runs with the phase: the cubics through its nodes.
    pub fn path(&self, stroke: usize) -> StrokePath {
        self.paths[stroke]
    }

    /// Largest second derivative of the path of any point of the tool in the work with respect to the phase, over all
    /// strokes, mm: over a step of h the path leaves its chord by h^2 / 8 of this at most.
    pub fn bend_mm(&self) -> f64 {
        self.bend_mm
    }

    /// Pose of one stroke at phase `tau`.
    pub fn pose_at(&self, stroke: usize, tau: f64) -> Rigid2 {
        self.path(stroke).at(tau)
    }

    /// Id of a pass.
    pub fn pass_id(&self, stroke: usize, blade: u32) -> u32 {
        self.first_pass + stroke as u32 * self.blades + blade
    }

    /// Stroke and blade of a pass id of this set.
    pub fn stroke_and_blade(&self, pass: u32) -> (usize, u32) {
        let local = pass - self.first_pass;
        ((local / self.blades) as usize, local % self.blades)
    }

    /// Id after the last pass.
    pub fn end_pass(&self) -> u32 {
        self.first_pass + self.count() as u32 * self.blades
    }
}

/// Monomial coefficients of the polynomial through values at the nodes: a cubic for four values, a constant for one.
pub fn cubic_through(values: &[f64]) -> [f64; 4] {
    if let [value] = values {
        return [*value, 0.0, 0.0, 0.0];
    }
    // Chebyshev coefficients by the discrete cosine sum over the first-kind nodes, then T0..T3 written out in powers.
    let mut chebyshev = [0.0; 4];
    for (k, coefficient) in chebyshev.iter_mut().enumerate() {
        let sum: f64 = CHEBYSHEV[k].iter().zip(values).map(|(polynomial, value)| value * polynomial).sum();
        *coefficient = sum * if k == 0 { 0.25 } else { 0.5 };
    }
    let [c0, c1, c2, c3] = chebyshev;
    [c0 - c2, c1 - 3.0 * c3, 2.0 * c2, 4.0 * c3]
}

/// The pose of a stroke as cubics in the phase: both entries of the rotation, both of the translation.
#[derive(Debug, Clone, Copy)]
pub struct StrokePath([[f64; 4]; 4]);

impl StrokePath {
    /// Through poses at the nodes; the one pose of a frozen stroke.
    pub fn through(poses: &[Rigid2]) -> Self {
        let entry =
            |pick: fn(&Rigid2) -> f64| cubic_through(&poses.iter().map(pick).collect::<ArrayVec<_, { NODES.len() }>>());
        Self([
            entry(|p| p.rotation.x),
            entry(|p| p.rotation.y),
            entry(|p| p.translation_mm.x),
            entry(|p| p.translation_mm.y),
        ])
    }

    /// Largest second derivative between phases -1 and 1 of the path of a point within `reach_mm` of the tool's axis.
    fn bend_mm(&self, reach_mm: f64) -> f64 {
        let [c, s, x, y] = self.0.map(|[.., square, cube]| 2.0 * square.abs() + 6.0 * cube.abs());
        x.hypot(y) + reach_mm * c.hypot(s)
    }

    /// How far a point within `reach_mm` of the tool's axis may leave the parabola through its places at tau = -1, 0
    /// and 1, mm: a cubic leaves it by c (tau^3 - tau), 0.385 c at most.
    pub fn beyond_parabola_mm(&self, reach_mm: f64) -> f64 {
        let [cos, sin, x_mm, y_mm] = self.0.map(|entry| entry[3]);
        0.385 * (x_mm.hypot(y_mm) + reach_mm * cos.hypot(sin))
    }

    /// Pose at a phase.
    pub fn at(&self, tau: f64) -> Rigid2 {
        let [c, s, x, y] = self.0.map(|e| e[0] + tau * (e[1] + tau * (e[2] + tau * e[3])));
        Rigid2 { rotation: DVec2::new(c, s), translation_mm: DVec2::new(x, y) }
    }
}

/// Chebyshev polynomials T0 to T3 at the nodes: every pose of every sweep that planning looks at asks for them.
const CHEBYSHEV: [[f64; NODES.len()]; NODES.len()] = {
    let mut at_nodes = [[1.0; NODES.len()]; NODES.len()];
    let mut node = 0;
    while node < NODES.len() {
        let x = NODES[node];
        at_nodes[1][node] = x;
        at_nodes[2][node] = 2.0 * x * x - 1.0;
        at_nodes[3][node] = x * (4.0 * x * x - 3.0);
        node += 1;
    }
    at_nodes
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_pass_through_their_nodes() {
        let cubic = |t: f64| 0.3 - 2.0 * t + 0.7 * t * t + 1.1 * t * t * t;
        let [a, b, c, d] = cubic_through(&NODES.map(cubic));
        for t in [-1.0, -0.2, 0.0, 0.9] {
            assert!((a + t * (b + t * (c + t * d)) - cubic(t)).abs() < 1e-15);
        }
        assert_eq!(cubic_through(&[7.0]), [7.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn the_crank_reaches_the_face_ends_at_most_at_unit_phase() {
        let law = StrokeLaw::crank(30.0, 5.0, 2.0);
        let (top, bottom) = (law.tau(15.0), law.tau(-15.0));
        assert!(top < 0.0 && bottom > 0.0, "the cut runs from the upper end down");
        assert!((top.abs().max(bottom.abs()) - 1.0).abs() < 1e-15);
        assert_eq!(law.tau(0.0), 0.0);
        // A quarter of a double stroke separates the middle of the stroke from its ends.
        assert!(law.stroke_share(1.0) < 0.25);
    }

    #[test]
    fn phases_lead_back_to_their_places() {
        for law in [StrokeLaw::crank(30.0, 5.0, 2.0), StrokeLaw::Guided { half_face_mm: 15.0 }] {
            for z_mm in [-15.0, -3.0, 0.0, 14.0] {
                assert!((law.z_mm(law.tau(z_mm)) - z_mm).abs() < 1e-12, "{law:?} at {z_mm} mm");
            }
        }
    }
}
