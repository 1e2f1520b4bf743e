//! The pose of the work over one sweep of a turning tool's tooth, and where points of its edge go through a slice.
//!
//! In: a pass of [`TurningPasses`]. Out: the moment at which an edge point goes through a transverse slice (Newton's
//! method), its place there, and how that place follows the edge point and the slice.
//!
//! The pose is a polynomial of the swept angle, entry by entry, through Chebyshev nodes. The row of z comes first: the
//! moment needs no other, and rows lie side by side so that four entries go through a processor's vector at once. Where
//! the motion has a corner during the sweep, each piece of it has polynomials of its own.
//!
//! A section follows its points one after the other, each from the moment of the one before, so that what is cut does
//! not depend on the processor. Bounds are looked for on eight points at once, from where they would be if the tool did
//! not move along the gear's axis ([`Sweeping::crossings`]).
//!
//! The road not taken: sections by eight points at once. Moments would differ in their last bits, and with them every
//! volume and chip.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use crate::math::roots::bisect;
use crate::passes::spatial::sweep_roots::LANES;
use crate::passes::spatial::turning_passes::{BladePass, TurningPasses};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Powers of a pass's pose over its sweep.
const TERMS: usize = 6;
/// Entries of a row: three of the rotation, one of the translation.
const ROW: usize = 4;
/// Rows of z, x and y.
const ENTRIES: usize = 3 * ROW;
/// Terms of the series of sine and cosine: off by 1e-18 at 1.5 rad.
const SERIES_TERMS: usize = 12;
/// Arcsine by Abramowitz and Stegun (1964), 4.4.45: off by 5e-5 rad, which a step of Newton's
/// method makes 2e-9.
const ARCSINE: [f64; 4] = [1.570_728_8, -0.212_114_4, 0.074_261_0, -0.018_729_3];
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
    /// From rows z, x and y: the place, and how it follows the moment, the distance from the axis and y.
    #[inline(always)]
    fn new([z, x, y]: [[f64; 4]; 3], out: f64) -> Self {
        // The moment moves so that the point stays in the slice.
        let held = |k: usize| {
            let moved = z[k] / z[1];
            DVec2::new(x[k] - x[1] * moved, y[k] - y[1] * moved)
        };
        Self {
            place_mm: DVec2::new(x[0], y[0]),
            over_radius: held(2),
            over_y: held(3),
            over_z: DVec2::new(x[1], y[1]) / z[1],
            out,
        }
    }

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

    /// A row of the pose and its rates over the swept angle.
    #[inline(always)]
    fn row(&self, pose: &Pose, row: usize, swept: f64) -> [[f64; ROW]; 2] {
        let u = swept / self.half_window_rad;
        let entries = row * ROW..(row + 1) * ROW;
        let (mut value, mut rate) = ([0.0; ROW], [0.0; ROW]);
        value.copy_from_slice(&pose[TERMS - 1][entries.clone()]);
        for term in pose[..TERMS - 1].iter().rev() {
            let term = &term[entries.clone()];
            for k in 0..ROW {
                rate[k] = rate[k] * u + value[k];
                value[k] = value[k] * u + term[k];
            }
        }
        [value, rate.map(|rate| rate / self.half_window_rad)]
    }

    /// Values and rates of the whole pose, column by column: head's axes x, y, z and its origin in the work.
    #[inline(always)]
    fn columns(&self, pose: &Pose, swept: f64) -> [[DVec3; ROW]; 2] {
        let [z, x, y] = [0, 1, 2].map(|row| self.row(pose, row, swept));
        [0, 1].map(|k: usize| [0, 1, 2, 3].map(|c: usize| DVec3::new(x[k][c], y[k][c], z[k][c])))
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

    /// Directions of the tool's axis and of the blade out of it at a moment, and the blade's place on that axis, gear
    /// frame.
    #[inline(always)]
    pub fn axis_out_and_centre(&self, swept: f64) -> [DVec3; 3] {
        let [[x, y, z, origin], _] = self.columns(self.pose_at(swept), swept);
        let (sin, cos) = swept.sin_cos();
        [z, cos * x + sin * y, z * self.axial_mm + origin]
    }

    /// How far the slice moves along the blade's travel per mm of its y.
    pub fn lean(&self) -> f64 {
        let [_, along, axis, _] = self.middle_row();
        (axis / along).abs()
    }

    /// Whether the rake face is seen from behind along the gear axis.
    pub fn is_turned_over(&self) -> bool {
        let [[x, _, z, _], _] = self.columns(&self.pose, 0.0);
        x.truncate().perp_dot(self.y_sign * z.truncate()) < 0.0
    }

    /// An edge point in the head, from sine and cosine of its angle to the head's x axis, and its rate over that angle.
    #[inline(always)]
    fn in_head(&self, (sin, cos): (f64, f64), node: DVec2) -> [DVec3; 2] {
        let place = DVec3::new(node.x * cos, node.x * sin, self.axial_mm + self.y_sign * node.y);
        [place, DVec3::new(-node.x * sin, node.x * cos, 0.0)]
    }

    /// How far an edge point is above a slice at a moment, and its rate over the swept angle.
    #[inline(always)]
    fn above_mm(&self, pose: &Pose, swept: f64, [place, turning]: [DVec3; 2], z_mm: f64) -> [f64; 2] {
        let [[x, y, z, shift], rates] = self.row(pose, 0, swept);
        let above = x * place.x + y * place.y + z * place.z + shift - z_mm;
        let rate =
            x * turning.x + y * turning.y + (rates[0] * place.x + rates[1] * place.y + rates[2] * place.z) + rates[3];
        [above, rate]
    }

    /// The same of an edge point.
    #[inline(always)]
    fn node_above_mm(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64, z_mm: f64) -> [f64; 2] {
        let turned = (swept + twist_rad_per_mm * node.y).sin_cos();
        self.above_mm(self.pose_at(swept), swept, self.in_head(turned, node), z_mm)
    }

    /// Moment at which an edge point goes through a slice, from a guess. `None`: at no moment of the sweep, nor a
    /// little beyond its ends.
    ///
    /// Where Newton's method leaves that range or does not settle in it, the range is halved where the point is on
    /// different sides of the slice at its ends. Where it is not, it may still go through twice, if it turns round in
    /// between: the rates at the ends say so, and halving finds the turn, and then the crossing on the guess's side of
    /// it. A blade's travel bends one way during a sweep, so that it turns round once at most: `None` is no failure of
    /// a search.
    #[inline(always)]
    pub fn moment(&self, guess: f64, node: DVec2, twist_rad_per_mm: f64, z_mm: f64) -> Option<f64> {
        let mut swept = guess;
        for _ in 0..MOST_STEPS {
            let [value, rate] = self.node_above_mm(swept, node, twist_rad_per_mm, z_mm);
            let step = value / rate;
            swept -= step;
            if step.abs() < LAST_STEP_RAD {
                return Some(swept);
            }
            // What is not a number is not within it either.
            let is_within = swept.abs() <= self.farthest_rad();
            if !is_within {
                break;
            }
        }
        self.halved_moment(guess, node, twist_rad_per_mm, z_mm)
    }

    /// The same by halving.
    #[cold]
    fn halved_moment(&self, guess: f64, node: DVec2, twist_rad_per_mm: f64, z_mm: f64) -> Option<f64> {
        let [value, rate] =
            [0, 1].map(|k: usize| move |swept: f64| self.node_above_mm(swept, node, twist_rad_per_mm, z_mm)[k]);
        let between = |from: f64, to: f64| {
            let rising = value(to) > 0.0;
            (value(from) * value(to) <= 0.0).then(|| bisect(|swept| (value(swept) < 0.0) == rising, from, to))
        };
        let farthest_rad = self.farthest_rad();
        between(-farthest_rad, farthest_rad).or_else(|| {
            let first = rate(-farthest_rad);
            let turns_round = first * rate(farthest_rad) < 0.0;
            let turn = turns_round.then(|| bisect(|s| rate(s) * first > 0.0, -farthest_rad, farthest_rad))?;
            if guess < turn { between(-farthest_rad, turn) } else { between(turn, farthest_rad) }
        })
    }

    fn farthest_rad(&self) -> f64 {
        self.half_window_rad + BEYOND_SWEEP_RAD
    }

    /// Where eight edge points of a smooth sweep go through a slice. `None`: one of them at no moment.
    #[inline(always)]
    pub fn crossings(
        &self,
        nodes: &[DVec2; LANES],
        twist_rad_per_mm: f64,
        z_mm: f64,
    ) -> Option<[SliceCrossing; LANES]> {
        let farthest_rad = self.farthest_rad();
        let [_, along, axis, middle] = self.middle_row();
        let (mut swept, mut step) = ([0.0; LANES], [0.0; LANES]);
        let (radii_mm, ys_mm) = (nodes.map(|node| node.x), nodes.map(|node| node.y));
        for l in 0..LANES {
            let behind_mm = (z_mm - middle - axis * (self.axial_mm + self.y_sign * ys_mm[l])) / along;
            swept[l] = arcsine(behind_mm / radii_mm[l]) - twist_rad_per_mm * ys_mm[l];
        }
        for _ in 0..MOST_STEPS {
            for l in 0..LANES {
                let at = self.in_head(turn(swept[l] + twist_rad_per_mm * ys_mm[l]), DVec2::new(radii_mm[l], ys_mm[l]));
                let [above, rate] = self.above_mm(&self.pose, swept[l], at, z_mm);
                step[l] = above / rate;
                let to = swept[l] - step[l];
                let to = if to > farthest_rad { farthest_rad } else { to };
                swept[l] = if to < -farthest_rad { -farthest_rad } else { to };
            }
            let mut settled = true;
            for step in &step {
                settled &= step.abs() < LAST_STEP_RAD;
            }
            if settled {
                break;
            }
        }
        for l in 0..LANES {
            let is_found = step[l].abs() < LAST_STEP_RAD && swept[l].abs() < farthest_rad;
            if !is_found {
                swept[l] = self.moment(swept[l], nodes[l], twist_rad_per_mm, z_mm)?;
            }
        }
        // Row by row: the compiler makes vectors of short bodies alone.
        let mut rows = [[[0.0; LANES]; 4]; 3];
        for (row, followed) in rows.iter_mut().enumerate() {
            for l in 0..LANES {
                let node = DVec2::new(radii_mm[l], ys_mm[l]);
                let at = self.in_head(turn(swept[l] + twist_rad_per_mm * node.y), node);
                let [place, over_swept, over_radius, over_y] =
                    self.followed(&self.pose, row, swept[l], node, twist_rad_per_mm, at);
                (followed[0][l], followed[1][l]) = (place, over_swept);
                (followed[2][l], followed[3][l]) = (over_radius, over_y);
            }
        }
        let mut outs = [0.0; LANES];
        for l in 0..LANES {
            outs[l] = turn(swept[l] + twist_rad_per_mm * ys_mm[l]).1;
        }
        Some(std::array::from_fn(|l| SliceCrossing::new(rows.map(|row| row.map(|of| of[l])), outs[l])))
    }

    /// Place in the work of an edge point at a moment.
    pub fn place_mm(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> DVec3 {
        let [[x, y, z, origin], _] = self.columns(self.pose_at(swept), swept);
        let [place, _] = self.in_head((swept + twist_rad_per_mm * node.y).sin_cos(), node);
        x * place.x + y * place.y + z * place.z + origin
    }

    /// The point at its moment, and how its place in the slice follows the edge point.
    #[inline(always)]
    pub fn crossing(&self, swept: f64, node: DVec2, twist_rad_per_mm: f64) -> SliceCrossing {
        let at = self.in_head((swept + twist_rad_per_mm * node.y).sin_cos(), node);
        let pose = self.pose_at(swept);
        let rows = [
            self.followed(pose, 0, swept, node, twist_rad_per_mm, at),
            self.followed(pose, 1, swept, node, twist_rad_per_mm, at),
            self.followed(pose, 2, swept, node, twist_rad_per_mm, at),
        ];
        SliceCrossing::new(rows, at[0].x / node.x)
    }

    /// In a row of the pose: the place of an edge point, and how it follows the moment, the distance from the axis and
    /// y.
    #[inline(always)]
    fn followed(
        &self,
        pose: &Pose,
        row: usize,
        swept: f64,
        node: DVec2,
        twist_rad_per_mm: f64,
        [place, turning]: [DVec3; 2],
    ) -> [f64; 4] {
        let [[x, y, z, origin], [x_rate, y_rate, z_rate, origin_rate]] = self.row(pose, row, swept);
        let along_y = twist_rad_per_mm * turning;
        [
            x * place.x + y * place.y + z * place.z + origin,
            (x_rate * place.x + y_rate * place.y + z_rate * place.z + origin_rate)
                + (x * turning.x + y * turning.y + z * turning.z),
            x * (place.x / node.x) + y * (place.y / node.x),
            x * along_y.x + y * along_y.y + z * self.y_sign,
        ]
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

/// Arcsine, roughly.
#[inline(always)]
fn arcsine(of: f64) -> f64 {
    let x = of.abs().min(1.0);
    let [a, b, c, d] = ARCSINE;
    let angle = FRAC_PI_2 - (1.0 - x).sqrt() * (a + x * (b + x * (c + x * d)));
    if of < 0.0 { -angle } else { angle }
}

/// Sine and cosine of an angle up to 1.5 rad, without a call or a branch.
#[inline(always)]
fn turn(angle: f64) -> (f64, f64) {
    let square = angle * angle;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for k in (0..SERIES_TERMS).rev() {
        sine = sine * square + INVERSE_FACTORIALS[2 * k + 1];
        cosine = cosine * square + INVERSE_FACTORIALS[2 * k];
    }
    (angle * sine, cosine)
}

/// With the signs of the series of sine and cosine.
const INVERSE_FACTORIALS: [f64; 2 * SERIES_TERMS] = {
    let mut terms = [1.0; 2 * SERIES_TERMS];
    let mut k = 2;
    while k < terms.len() {
        terms[k] = -terms[k - 2] / (k * (k - 1)) as f64;
        k += 1;
    }
    terms
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_are_the_functions() {
        for angle in (-150..=150).map(|i| 0.01 * f64::from(i)) {
            let ((sine, cosine), (sin, cos)) = (turn(angle), angle.sin_cos());
            assert!((sine - sin).abs() < 4e-16 && (cosine - cos).abs() < 4e-16, "{angle}");
            assert!((arcsine(sin) - angle).abs() < 7e-5, "{angle}");
        }
    }
}
