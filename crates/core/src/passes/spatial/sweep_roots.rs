//! Where eight rays meet the sweep of one segment: Newton's method for all of them at once.
//!
//! In: a record ([`SweepRecord`], where the equations are derived), its segment, eight rays, the heights and moments to
//! start from. Out: the heights and moments at which the rays enter the segment or its continuation. The native kernel
//! cuts with it, and planning samples with it: both see the same surface.
//!
//! The rays become polynomials in u first. Each step then solves both linearised equations. Where the edge's residual
//! rises along a ray, the ray runs out of the tool: it goes back to its lowest height and tries once more.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]

use super::sweep::{LARGEST_T, SweepRecord, half_angle};
use crate::dexel::SpatialField;
use crate::tool::edge::{Segment, SegmentShape};
use crate::tool::edge_table::EdgeTable;
use glam::DVec3;

/// Rays that go together: an AVX-512 register or two AVX2 registers per quantity; a ray's polynomials alone fill
/// twenty-one.
pub const LANES: usize = 8;
/// Newton steps at most: two or three suffice; a ray that grazes a round halves what is missing with every step.
const MAX_STEPS: usize = 32;
/// A ray that misses a round goes back to its lowest height again and again; one that enters does so once, and one that
/// runs out of the tool settles there. A sample is not known of a ray that has gone back this often, and its candidate
/// is kept unless its box is clear of the rays.
const MOST_RISES: f64 = 4.0;

/// One quantity of eight rays.
pub type Lanes = [f64; LANES];

/// Eight rays in the frame of a tile: x, y, z.
pub struct Rays {
    origin: [Lanes; 3],
    normal: [Lanes; 3],
}

/// Where eight rays enter a segment's sweep or its continuation.
pub struct Roots {
    /// Heights, mm.
    pub height_mm: Lanes,
    /// Moments.
    pub t: Lanes,
    /// Place in the segment's frame, x, mm.
    pub x_mm: Lanes,
    /// Place in the segment's frame, y, mm.
    pub y_mm: Lanes,
    /// How fast each ray runs into the segment, against the edge's unit normal; negative where it runs out.
    pub cosine: Lanes,
    /// Last steps of the heights, mm.
    pub step_mm: Lanes,
    /// Whether the edge's residual falls along the ray at the end: it runs into the tool.
    pub falls: [bool; LANES],
    /// How often it did not on the way.
    pub rises: Lanes,
}

/// Eight rays in a record's axes (r, q, y): polynomials in u.
struct Paths {
    place: [[Lanes; 3]; 4],
    along: [[Lanes; 3]; 3],
}

impl Rays {
    /// Rays of a field that follow each other in a column, from a dexel on, in a frame with its origin at `origin_mm`,
    /// gear frame, mm.
    #[inline(always)]
    pub fn following(field: &SpatialField, origin_mm: DVec3, first: usize) -> Self {
        let mut rays = Self { origin: [[0.0; LANES]; 3], normal: [[0.0; LANES]; 3] };
        for axis in 0..3 {
            let from = &field.origins_mm()[axis][first..first + LANES];
            rays.origin[axis].iter_mut().zip(from).for_each(|(to, from)| *to = from - origin_mm[axis]);
            rays.normal[axis].copy_from_slice(&field.normals()[axis][first..first + LANES]);
        }
        rays
    }

    /// Some rays of a field (indices of dexels) in a frame with its origin at `origin_mm`, gear frame, mm.
    #[inline(always)]
    pub fn new(field: &SpatialField, origin_mm: DVec3, at: [usize; LANES]) -> Self {
        let mut rays = Self { origin: [[0.0; LANES]; 3], normal: [[0.0; LANES]; 3] };
        for (l, at) in at.into_iter().enumerate() {
            for axis in 0..3 {
                rays.origin[axis][l] = field.origins_mm()[axis][at] - origin_mm[axis];
                rays.normal[axis][l] = field.normals()[axis][at];
            }
        }
        rays
    }
}

impl SweepRecord {
    /// Entries of eight rays (in the record's frame) into the segment or its continuation, from starting heights and
    /// moments; no root below `lowest_mm` is looked for where the first search runs out of the tool. Steps below
    /// `last_step` (in mm, and in t) are the last: the error after them is of their squares.
    #[inline(always)]
    pub fn roots(&self, segment: &Segment, rays: &Rays, start: [&Lanes; 2], lowest_mm: f64, last_step: f64) -> Roots {
        self.roots_of(&paths(self, rays), segment, start, lowest_mm, [last_step, f64::INFINITY])
    }

    /// The same from starting heights alone: one step finds the moments. Rays that run out of the tool again and again
    /// are not waited for.
    #[inline(always)]
    pub fn roots_from(
        &self,
        segment: &Segment,
        rays: &Rays,
        start_mm: &Lanes,
        lowest_mm: f64,
        last_step: f64,
    ) -> Roots {
        let paths = paths(self, rays);
        let start_t = places(self, &paths, start_mm, 1, 0.0)[0];
        self.roots_of(&paths, segment, [start_mm, &start_t], lowest_mm, [last_step, MOST_RISES])
    }

    #[inline(always)]
    fn roots_of(&self, paths: &Paths, segment: &Segment, start: [&Lanes; 2], lowest_mm: f64, ends: [f64; 2]) -> Roots {
        if self.twist_rad_per_mm == 0.0 {
            roots::<false>(self, segment, paths, start, lowest_mm, ends)
        } else {
            roots::<true>(self, segment, paths, start, lowest_mm, ends)
        }
    }

    /// Moments, distances from the tool's axis less the segment's, and places along the blade's y less the segment's,
    /// of eight points (of the rays, at these heights), after steps of at most this number down to one of `last_t`, and
    /// the last steps of the moments. A step gains as many digits as the tool turns faster than the work; whoever needs
    /// the places themselves looks at the last one.
    #[inline(always)]
    pub fn places<const HEIGHTS: usize>(
        &self,
        rays: &Rays,
        heights_mm: &[f64; HEIGHTS],
        steps: usize,
        last_t: f64,
    ) -> [[Lanes; 4]; HEIGHTS] {
        let paths = paths(self, rays);
        let mut all = [[[0.0; LANES]; 4]; HEIGHTS];
        for (at_height, &height_mm) in all.iter_mut().zip(heights_mm) {
            *at_height = places(self, &paths, &[height_mm; LANES], steps, last_t);
        }
        all
    }
}

#[inline(always)]
fn places(record: &SweepRecord, paths: &Paths, height_mm: &Lanes, steps: usize, last_t: f64) -> [Lanes; 4] {
    if record.twist_rad_per_mm == 0.0 {
        places_of::<false>(record, paths, height_mm, steps, last_t)
    } else {
        places_of::<true>(record, paths, height_mm, steps, last_t)
    }
}

#[inline(always)]
fn places_of<const TWISTED: bool>(
    record: &SweepRecord,
    paths: &Paths,
    height_mm: &Lanes,
    steps: usize,
    last_t: f64,
) -> [Lanes; 4] {
    let (mut t, mut rho, mut y) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    let mut step_t = [0.0; LANES];
    for _ in 0..steps {
        for l in 0..LANES {
            let (c, d) = (&paths.place, &paths.along);
            let [u, _] = half_angle(t[l]);
            let at = |row: usize| {
                c[0][row][l]
                    + u * (c[1][row][l] + u * (c[2][row][l] + u * c[3][row][l]))
                    + height_mm[l] * (d[0][row][l] + u * (d[1][row][l] + u * d[2][row][l]))
            };
            let (r, mut q, along) = (at(0), at(1), at(2));
            let mut big = r + record.radius_mm;
            // Nine divisions, which would be most of a step.
            if TWISTED {
                let [s, c1] = small_turn(record.twist_rad_per_mm * along);
                (big, q) = (big + c1 * big + s * q, q + c1 * q - s * big);
            }
            let distance = (big * big + q * q).sqrt();
            let next = q / (big + distance);
            step_t[l] = next - t[l];
            t[l] = next;
            rho[l] = distance - record.radius_mm;
            y[l] = along;
        }
        if step_t.iter().fold(0.0, |largest: f64, step| largest.max(step.abs())) < last_t {
            break;
        }
    }
    [t, rho, y, step_t]
}

#[inline(always)]
fn roots<const TWISTED: bool>(
    record: &SweepRecord,
    segment: &Segment,
    paths: &Paths,
    start: [&Lanes; 2],
    lowest: f64,
    [last_step, most_rises]: [f64; 2],
) -> Roots {
    let [cos, sin] = segment.blade_from_segment.rotation.to_array();
    let radius = record.radius_mm;
    let [mut h, mut t] = start.map(|lanes| *lanes);
    let (mut step_h, mut step_t, mut falls) = ([0.0; LANES], [0.0; LANES], [false; LANES]);
    let mut cosine = [0.0; LANES];
    let (mut y_last, mut x_last, mut rises) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for _ in 0..MAX_STEPS {
        // What the second part needs: distance from the axis, q and the place in the segment's frame, with their rates
        // over h and t.
        let (mut r, mut r_h, mut r_t) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut q, mut q_h, mut q_t) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut x, mut x_h, mut x_t) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut y, mut y_h, mut y_t) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let (h, t) = (h[l], t[l]);
            let [u, u_t] = half_angle(t);
            // The point and its rates, in (r, q, y).
            let (mut p, mut p_h, mut p_t) = ([0.0; 3], [0.0; 3], [0.0; 3]);
            for row in 0..3 {
                let (c, d) = (&paths.place, &paths.along);
                let along = d[0][row][l] + u * (d[1][row][l] + u * d[2][row][l]);
                let along_u = d[1][row][l] + 2.0 * u * d[2][row][l];
                p_h[row] = along;
                p[row] = c[0][row][l] + u * (c[1][row][l] + u * (c[2][row][l] + u * c[3][row][l])) + h * along;
                let place_u = c[1][row][l] + u * (2.0 * c[2][row][l] + u * (3.0 * c[3][row][l]));
                p_t[row] = u_t * (place_u + h * along_u);
            }
            if TWISTED {
                let twist = record.twist_rad_per_mm;
                let [s, c1] = small_turn(twist * p[2]);
                let big = p[0] + radius;
                // Turned back by the angle: r stays small, since only (cos - 1) multiplies the radius.
                let (r_new, q_new) = (p[0] + c1 * big + s * p[1], p[1] + c1 * p[1] - s * big);
                for v in [&mut p_h, &mut p_t] {
                    let (a, b, about) = (v[0], v[1], twist * v[2]);
                    v[0] = a + c1 * a + s * b + about * q_new;
                    v[1] = b + c1 * b - s * a - about * (r_new + radius);
                }
                (p[0], p[1]) = (r_new, q_new);
            }
            let rho = p[0] + p[1] * t;
            let rho_h = p_h[0] + p_h[1] * t;
            let rho_t = p_t[0] + p_t[1] * t + p[1];
            (x[l], y[l]) = (cos * rho + sin * p[2], cos * p[2] - sin * rho);
            (x_h[l], y_h[l]) = (cos * rho_h + sin * p_h[2], cos * p_h[2] - sin * rho_h);
            (x_t[l], y_t[l]) = (cos * rho_t + sin * p_t[2], cos * p_t[2] - sin * rho_t);
            (r[l], r_h[l], r_t[l]) = (p[0], p_h[0], p_t[0]);
            (q[l], q_h[l], q_t[l]) = (p[1], p_h[1], p_t[1]);
        }
        let (mut edge, mut g_x, mut g_y) = ([0.0; LANES], [1.0; LANES], [0.0; LANES]);
        match &segment.shape {
            SegmentShape::Table(table) => on_table(table, &x, &y, &mut edge, &mut g_y),
            SegmentShape::Arc { radius_mm } => {
                let k = 0.5 / radius_mm;
                for l in 0..LANES {
                    edge[l] = x[l] + k * (x[l] * x[l] + y[l] * y[l]);
                    g_x[l] = 1.0 + 2.0 * k * x[l];
                    g_y[l] = 2.0 * k * y[l];
                }
            }
        }
        let (mut largest_h, mut largest_t) = (0.0_f64, 0.0_f64);
        for l in 0..LANES {
            let (big, half, twice) = (radius + r[l], 1.0 - t[l] * t[l], 2.0 * t[l]);
            let moment = q[l] * half - twice * big;
            let moment_h = q_h[l] * half - twice * r_h[l];
            let moment_t = q_t[l] * half - twice * (q[l] + r_t[l]) - 2.0 * big;
            let edge_h = g_x[l] * x_h[l] + g_y[l] * y_h[l];
            let edge_t = g_x[l] * x_t[l] + g_y[l] * y_t[l];
            // Negative where the edge's residual falls along the ray, since moment_t is negative.
            let determinant = moment_h * edge_t - moment_t * edge_h;
            falls[l] = determinant < 0.0;
            // moment_t is negative: the residual falls by this per mm of the ray, against the length of its gradient.
            cosine[l] = determinant / moment_t / (g_x[l] * g_x[l] + g_y[l] * g_y[l]).sqrt();
            let inverse = 1.0 / if falls[l] { determinant } else { -1.0 };
            let newton_h = (moment * edge_t - moment_t * edge[l]) * inverse;
            let newton_t = (moment_h * edge[l] - edge_h * moment) * inverse;
            // A lane that finds itself where the residual rises goes back to the lowest height.
            step_h[l] = if falls[l] { newton_h } else { h[l] - lowest };
            step_t[l] = if falls[l] { newton_t } else { (moment - moment_h * step_h[l]) / moment_t };
            rises[l] += if falls[l] { 0.0 } else { 1.0 };
            h[l] -= step_h[l];
            t[l] = (t[l] - step_t[l]).clamp(-LARGEST_T, LARGEST_T);
            x_last[l] = x[l] - (x_h[l] * step_h[l] + x_t[l] * step_t[l]);
            y_last[l] = y[l] - (y_h[l] * step_h[l] + y_t[l] * step_t[l]);
        }
        for l in 0..LANES {
            let waited_for = if rises[l] < most_rises { 1.0 } else { 0.0 };
            largest_h = largest_h.max(waited_for * step_h[l].abs());
            largest_t = largest_t.max(waited_for * step_t[l].abs());
        }
        if largest_h < last_step && largest_t < last_step {
            break;
        }
    }
    Roots { height_mm: h, t, x_mm: x_last, y_mm: y_last, cosine, step_mm: step_h, falls, rises }
}

#[inline(always)]
fn paths(record: &SweepRecord, rays: &Rays) -> Paths {
    let mut paths = Paths { place: [[[0.0; LANES]; 3]; 4], along: [[[0.0; LANES]; 3]; 3] };
    // Lanes outermost in all these loops: a long body is made into vectors as it stands, a short one is unrolled first
    // and then torn.
    for l in 0..LANES {
        let [o, n] = [&rays.origin, &rays.normal].map(|v| [v[0][l], v[1][l], v[2][l]]);
        for k in 0..3 {
            for row in 0..3 {
                let [x, y, z] = record.turn[k][row];
                paths.place[k][row][l] = record.place_mm[k][row] + (x * o[0] + y * o[1] + z * o[2]);
                paths.along[k][row][l] = x * n[0] + y * n[1] + z * n[2];
            }
        }
    }
    for row in 0..3 {
        paths.place[3][row] = [record.place_mm[3][row]; LANES];
    }
    paths
}

/// Sine and cosine less 1 of small angles: eight correct digits are kept at half a radian, sixteen below a tenth.
#[inline(always)]
fn small_turn(angle: f64) -> [f64; 2] {
    let s = angle * angle;
    [
        angle * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0)))),
        -0.5 * s * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0)))),
    ]
}

/// Residual x - U(y) and its rate over y.
#[inline(always)]
fn on_table(table: &EdgeTable, x: &Lanes, y: &Lanes, edge: &mut Lanes, g_y: &mut Lanes) {
    let (y_start, y_end) = (table.y_start_mm, table.y_end_mm());
    let width = 1.0 / table.cells_per_mm;
    let last_cell = (table.cells.len() - 1) as f64;
    let (mut inside, mut cell) = ([0.0; LANES], [0.0; LANES]);
    for l in 0..LANES {
        inside[l] = y[l].max(y_start).min(y_end);
        cell[l] = ((inside[l] - y_start) * table.cells_per_mm).floor().min(last_cell);
    }
    let mut same = true;
    for l in 1..LANES {
        same &= cell[l] == cell[0];
    }
    if same {
        let c = table.cells[cell[0] as usize];
        for l in 0..LANES {
            (edge[l], g_y[l]) = table_terms(&c, inside[l] - y_start - cell[l] * width, y[l] - inside[l], x[l]);
        }
    } else {
        for l in 0..LANES {
            let c = table.cells[cell[l] as usize];
            (edge[l], g_y[l]) = table_terms(&c, inside[l] - y_start - cell[l] * width, y[l] - inside[l], x[l]);
        }
    }
}

#[inline(always)]
fn table_terms(c: &[f64; 4], at: f64, beyond: f64, x: f64) -> (f64, f64) {
    let slope = c[1] + at * (2.0 * c[2] + at * (3.0 * c[3]));
    (x - (c[0] + at * (c[1] + at * (c[2] + at * c[3])) + beyond * slope), -slope)
}
