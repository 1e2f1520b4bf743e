//! The pose of the work over one sweep of a turning tool's tooth, and where points of its edge go through a slice.
//!
//! In: a pass of [`TurningPasses`]. Out: the moment at which an edge point goes through a transverse slice (Newton's
//! method), its place there, and how that place follows the edge point and the slice.
//!
//! The pose is a polynomial of the swept angle, entry by entry, through Chebyshev nodes. The row of z comes first: the
//! moment needs no other, and rows lie side by side so that four entries go through a processor's vector at once. Where
//! the motion has a corner during the sweep, each piece of it has polynomials of its own.

use crate::math::convergence::{Step, iterate};
use crate::math::roots::bisect;
use crate::passes::spatial::turning_passes::{BladePass, TurningPasses};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// Powers of a pass's pose over its sweep.
const TERMS: usize = 6;
/// Entries of a row: three of the rotation, one of the translation.
const ROW: usize = 4;
/// Rows of z, x and y.
const ENTRIES: usize = 3 * ROW;
/// Steps to the moment at most, and the last one, rad: the error after it is of its square.
const MOST_STEPS: u32 = 20;
const LAST_STEP_RAD: f64 = 1e-6;
/// Half the shortest piece of a sweep that is fitted, rad.
const SHORTEST_RAD: f64 = 0.25;
/// Moments are looked for beyond the ends of the sweep by this angle, rad: a hob's 60 degrees become 1.25 rad. A pass
/// is dropped from a slice where an end of a piece has no moment within it. It has one: only points of the edge are
/// asked for that stand at most as far round as the tip does at the sweep's end if the work rests
/// (`SweptSections::reached`), and there a radian of the blade is half the tip's radius along its travel. So the angle
/// answers for a tenth of that radius, 6 mm on a usual hob, which the work moves along the blade's travel in a sixth of
/// a turn: its feed there is hundredths of a millimetre. Brute force over all passes shares this number; the flank
/// kernel does not, and what is left is compared with it in `tests/suite/hobbing/blank.rs`.
const BEYOND_SWEEP_RAD: f64 = 0.2028;

/// A pass with its pose as polynomials of the swept angle.
pub(super) struct Sweeping {
    pub pass: u32,
    /// Number of the blade's edge.
    pub edge: usize,
    axial_mm: f64,
    y_sign: f64,
    half_window_rad: f64,
    /// In the middle of the sweep; everywhere, if the motion has no corner during it.
    pose: Pose,
    /// Before and after corners: swept angles at which each begins and ends.
    beside: Vec<([f64; 2], Pose)>,
}

/// `work_from_head` in powers of delta / [`TurningPasses::half_window_rad`].
type Pose = [[f64; ENTRIES]; TERMS];

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
    pub fn new(set: &TurningPasses, pass: &BladePass) -> Self {
        let (place, pieces) = (set.place(pass), set.pieces(pass));
        let mut beside: Vec<([f64; 2], Pose)> = pieces
            .map(|piece| {
                let [a, b] = set.motion.piece_rad(piece).map(|angle_rad| set.turn * (angle_rad - pass.tool_angle_rad));
                let from_to = [a.min(b), a.max(b)];
                let within = from_to.map(|swept| swept.clamp(-set.half_window_rad, set.half_window_rad));
                (from_to, polynomials(set, pass, piece, within))
            })
            .collect();
        let middle = beside.iter().position(|([from, to], _)| *from <= 0.0 && 0.0 <= *to).unwrap_or(0);
        let pose = beside.swap_remove(middle).1;
        Self {
            pass: pass.pass,
            edge: set.edges.index_of(place.blade),
            axial_mm: place.axial_mm,
            y_sign: place.y_sign,
            half_window_rad: set.half_window_rad,
            pose,
            beside,
        }
    }

    /// Whether one set of polynomials holds for the whole sweep.
    pub fn is_smooth(&self) -> bool {
        self.beside.is_empty()
    }

    fn pose_at(&self, swept: f64) -> &Pose {
        let held = |([from, to], _): &&([f64; 2], Pose)| *from <= swept && swept <= *to;
        self.beside.iter().find(held).map_or(&self.pose, |(_, pose)| pose)
    }

    /// Values of the first entries of the pose, and their rates over the swept angle.
    fn entries<const N: usize>(&self, swept: f64) -> [[f64; N]; 2] {
        let u = swept / self.half_window_rad;
        let mut value = [0.0; N];
        let pose = self.pose_at(swept);
        value.copy_from_slice(&pose[TERMS - 1][..N]);
        let mut rate = [0.0; N];
        for term in pose[..TERMS - 1].iter().rev() {
            for k in 0..N {
                rate[k] = rate[k] * u + value[k];
                value[k] = value[k] * u + term[k];
            }
        }
        [value, rate.map(|rate| rate / self.half_window_rad)]
    }

    /// Values and rates of the whole pose, column by column: head's axes x, y, z and its origin in the work.
    fn columns(&self, swept: f64) -> [[DVec3; ROW]; 2] {
        self.entries::<ENTRIES>(swept).map(|e| [0, 1, 2, 3].map(|c| DVec3::new(e[ROW + c], e[2 * ROW + c], e[c])))
    }

    /// How far the slice lies from the blade's axis in the direction in which the blade moves in the middle of its
    /// sweep, mm.
    pub fn behind_mm(&self, z_mm: f64) -> f64 {
        let [_, along, axis, middle] = self.middle_row();
        (z_mm - middle - axis * self.axial_mm) / along
    }

    /// Row of z in the middle of the sweep.
    fn middle_row(&self) -> [f64; ROW] {
        [0, 1, 2, 3].map(|c: usize| self.pose[0][c])
    }

    /// Travel of the blade per mm of the gear's axis in the middle of its sweep.
    pub fn travel_per_mm(&self) -> f64 {
        self.middle_row()[1].abs().recip()
    }

    /// Directions of the tool's axis and of the blade out of it at a moment, gear frame.
    pub fn axis_and_out(&self, swept: f64) -> [DVec3; 2] {
        let [[x, y, z, _], _] = self.columns(swept);
        let (sin, cos) = swept.sin_cos();
        [z, cos * x + sin * y]
    }

    /// How far the slice moves along the blade's travel per mm of its y.
    pub fn lean(&self) -> f64 {
        let [_, along, axis, _] = self.middle_row();
        (axis / along).abs()
    }

    /// Whether the rake face is seen from behind along the gear axis.
    pub fn is_turned_over(&self) -> bool {
        let [[x, _, z, _], _] = self.columns(0.0);
        x.truncate().perp_dot(self.y_sign * z.truncate()) < 0.0
    }

    fn in_head(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> [DVec3; 2] {
        let (sin, cos) = (swept + twist_rad_per_mm * node.y).sin_cos();
        let place = DVec3::new(node.x * cos, node.x * sin, self.axial_mm + self.y_sign * node.y);
        [place, DVec3::new(-node.x * sin, node.x * cos, 0.0)]
    }

    /// Moment at which an edge point goes through a slice, from a guess. `None`: at no moment of the sweep, nor a
    /// little beyond its ends.
    ///
    /// Where Newton's method leaves that range or does not settle in it, the range is halved where the point is on
    /// different sides of the slice at its ends. Where it is not, it may still go through twice, if it turns round in
    /// between: the rates at the ends say so, and halving finds the turn, and then the crossing on the guess's side of
    /// it. A blade's travel bends one way during a sweep, so that it turns round once at most: `None` is no failure of
    /// a search.
    pub fn moment(&self, guess: f64, node: DVec2, twist_rad_per_mm: f64, z_mm: f64) -> Option<f64> {
        let value_and_rate = |swept: f64| {
            let [[x, y, z, shift], rates] = self.entries::<ROW>(swept);
            let [place, turning] = self.in_head(swept, node, twist_rad_per_mm);
            let value = x * place.x + y * place.y + z * place.z + shift - z_mm;
            let rate = x * turning.x
                + y * turning.y
                + (rates[0] * place.x + rates[1] * place.y + rates[2] * place.z)
                + rates[3];
            [value, rate]
        };
        let farthest_rad = self.half_window_rad + BEYOND_SWEEP_RAD;
        let moment = iterate("an edge point's moment in a slice", guess, MOST_STEPS, |swept| {
            let [value, rate] = value_and_rate(swept);
            let step = value / rate;
            let to = swept - step;
            if step.abs() < LAST_STEP_RAD {
                ControlFlow::Break(Some(to))
            } else if to.abs() > farthest_rad {
                ControlFlow::Break(None)
            } else {
                ControlFlow::Continue(Step { to, residual: value })
            }
        });
        if let Ok(Some(moment)) = moment {
            return Some(moment);
        }
        let value = |swept: f64| value_and_rate(swept)[0];
        let between = |from: f64, to: f64| {
            let rising = value(to) > 0.0;
            (value(from) * value(to) <= 0.0).then(|| bisect(|swept| (value(swept) < 0.0) == rising, from, to))
        };
        between(-farthest_rad, farthest_rad).or_else(|| {
            let rate = |swept: f64| value_and_rate(swept)[1];
            let first = rate(-farthest_rad);
            let turns_round = first * rate(farthest_rad) < 0.0;
            let turn = turns_round.then(|| bisect(|s| rate(s) * first > 0.0, -farthest_rad, farthest_rad))?;
            if guess < turn { between(-farthest_rad, turn) } else { between(turn, farthest_rad) }
        })
    }

    /// Place in the work of an edge point at a moment.
    pub fn place_mm(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> DVec3 {
        let [[x, y, z, origin], _] = self.columns(swept);
        let [place, _] = self.in_head(swept, node, twist_rad_per_mm);
        x * place.x + y * place.y + z * place.z + origin
    }

    /// The point at its moment, and how its place in the slice follows the edge point.
    pub fn crossing(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> SliceCrossing {
        let [axes, rates] = self.columns(swept);
        let [place, turning] = self.in_head(swept, node, twist_rad_per_mm);
        let turned = |v: DVec3, [x, y, z, _]: [DVec3; ROW]| x * v.x + y * v.y + z * v.z;
        let place_mm = turned(place, axes) + axes[3];
        let over_swept = turned(place, rates) + rates[3] + turned(turning, axes);
        let out = DVec3::new(place.x, place.y, 0.0) / node.x;
        let over_radius = turned(out, axes);
        let over_y = turned(twist_rad_per_mm * turning + DVec3::new(0.0, 0.0, self.y_sign), axes);
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

/// Through the poses of a piece at Chebyshev nodes of swept angles from `from` to `to`: in powers of the angle over
/// the whole sweep.
fn polynomials(set: &TurningPasses, pass: &BladePass, piece: u32, [from, to]: [f64; 2]) -> Pose {
    // A short piece would be known from too little: the piece's law goes on beyond its ends.
    let half = (0.5 * (to - from)).max(SHORTEST_RAD);
    let middle = 0.5 * (from + to);
    let mut of_piece = [[0.0; ENTRIES]; TERMS];
    // Nodes and polynomials over the piece, then powers.
    for node in 0..TERMS {
        let angle = PI * (node as f64 + 0.5) / TERMS as f64;
        let swept = middle + half * angle.cos();
        let work_from_head = set.motion.head_from_work_on(piece, pass.tool_angle_rad + set.turn * swept).inverse();
        let (turn, shift) = (work_from_head.rotation, work_from_head.translation_mm);
        let row = |r: usize| [turn.x_axis[r], turn.y_axis[r], turn.z_axis[r], shift[r]];
        let entries = [row(2), row(0), row(1)];
        for (k, powers) in CHEBYSHEV.iter().enumerate() {
            let weight = (k as f64 * angle).cos() * if k == 0 { 1.0 } else { 2.0 } / TERMS as f64;
            for (term, power) in of_piece.iter_mut().zip(powers) {
                for (coefficient, value) in term.iter_mut().zip(entries.as_flattened()) {
                    *coefficient += weight * power * value;
                }
            }
        }
    }
    if middle == 0.0 && half == set.half_window_rad {
        return of_piece;
    }
    // The piece's own angle is a linear function of that of the whole sweep.
    let (scale, offset) = (set.half_window_rad / half, -middle / half);
    let mut pose = [[0.0; ENTRIES]; TERMS];
    for term in of_piece.iter().rev() {
        for k in (0..TERMS).rev() {
            for entry in 0..ENTRIES {
                let raised = if k > 0 { scale * pose[k - 1][entry] } else { term[entry] };
                pose[k][entry] = offset * pose[k][entry] + raised;
            }
        }
    }
    pose
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
