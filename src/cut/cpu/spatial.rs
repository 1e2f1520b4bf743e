//! The spatial kernel: rays of one tile against the sweeps of its passes.
//!
//! In: rays in space, records ([`SweepRecord`], where the equations are derived), edge segments, the layer so far. Out: lowered heights and the passes that lowered them.
//!
//! Eight rows of a column go together. For each record the ray becomes polynomials in the moment t; Newton's method then solves for the height and the moment
//! together, from the tile's middle root: three or four steps. Rows of a chunk meet nearly the same place of the edge, so its cell of the table is mostly loaded once for
//! all of them.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]
#![expect(clippy::needless_bitwise_bool, reason = "lanes are evaluated without branches, or they would not vectorise")]

use crate::cut::CutStats;
use crate::dexel::SpatialField;
use crate::passes::sweep::{SweepRecord, half_angle};
use crate::passes::sweep_plan::SweepTile;
use crate::tool::edge::{Segment, SegmentShape};
use crate::tool::edge_table::EdgeTable;

/// Rows that go together: an AVX-512 register or two AVX2 registers per quantity; a ray's polynomials alone fill twenty-one.
pub const LANES: usize = 8;
/// Newton steps at most: from the tile's middle root four suffice, more serve rays that graze.
const MAX_STEPS: usize = 16;
/// Steps below these, in mm and in t, are the last: the error after them is of their squares.
const LAST_STEP_MM: f64 = 1e-8;
const LAST_STEP_T: f64 = 1e-8;
/// A last step below this has arrived.
const CONVERGED_MM: f64 = 1e-6;
/// Hits this far beyond a segment's end still count: neighbouring segments then leave no slit for a ray to slip through.
const END_OVERLAP_MM: f64 = 1e-9;
/// Moments further off than this lie outside any sweep.
const LARGEST_T: f64 = 1.0;

type Lanes = [f64; LANES];

/// One tile's work; called through the instruction set dispatch.
pub struct SpatialTileCut<'a> {
    pub field: &'a SpatialField,
    pub tile: &'a SweepTile,
    pub records: &'a [SweepRecord],
    pub segments: &'a [Segment],
    pub heights_mm: &'a mut [f32],
    pub passes: &'a mut [u32],
}

/// Eight rays in the tile's frame: x, y, z.
struct Rays {
    origin: [Lanes; 3],
    normal: [Lanes; 3],
}

/// Eight rays in a record's axes (r, q, y): polynomials in u.
struct Paths {
    place: [[Lanes; 3]; 4],
    along: [[Lanes; 3]; 3],
}

impl pulp::NullaryFnOnce for SpatialTileCut<'_> {
    type Output = CutStats;

    #[inline(always)]
    fn call(self) -> CutStats {
        let Self { field, tile, records, segments, heights_mm, passes } = self;
        let mut stats = CutStats::default();
        for column in tile.columns.clone() {
            for first in tile.rows.clone().step_by(LANES) {
                let there = (tile.rows.end - first).min(LANES);
                let base = field.index(column, first);
                let mut chunk = Chunk::load(field, tile, base, there, heights_mm, passes);
                for record in records {
                    let (unknown, _) = chunk.lower(record, segments, field.low_mm);
                    stats.unconverged += unknown[..there].iter().sum::<u64>();
                }
                chunk.store(base, there, heights_mm, passes);
            }
        }
        stats.dexel_passes = (tile.columns.len() * tile.rows.len() * records.len()) as u64;
        stats
    }
}

/// What one record took from the rays of a ledger.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Taken {
    /// Sum over the rays of the length taken, each weighted by (1 + curvature x height), mm.
    pub length_mm: f64,
    /// Largest thickness taken across the edge's surface, mm.
    pub thickness_mm: f64,
    /// Rays that lost something.
    pub rays: u32,
}

/// One tile's work with a ledger: every record in the order of time, and what each took.
pub struct LedgerCut<'a> {
    pub cut: SpatialTileCut<'a>,
    /// How much rays part as they leave the work, 1 / mm, column by column of the field.
    pub spread_per_mm: &'a [f64],
    /// One entry for each record.
    pub taken: &'a mut [Taken],
}

impl pulp::NullaryFnOnce for LedgerCut<'_> {
    type Output = CutStats;

    #[inline(always)]
    fn call(self) -> CutStats {
        let Self { cut, spread_per_mm, taken } = self;
        let mut stats = CutStats::default();
        for column in cut.tile.columns.clone() {
            let spread = 0.5 * spread_per_mm[column];
            for first in cut.tile.rows.clone().step_by(LANES) {
                let there = (cut.tile.rows.end - first).min(LANES);
                let base = cut.field.index(column, first);
                let mut chunk = Chunk::load(cut.field, cut.tile, base, there, cut.heights_mm, cut.passes);
                for (record, taken) in cut.records.iter().zip(taken.iter_mut()) {
                    let before = chunk.best;
                    let (unknown, cosines) = chunk.lower(record, cut.segments, cut.field.low_mm);
                    stats.unconverged += unknown[..there].iter().sum::<u64>();
                    for l in 0..there {
                        let length = before[l] - chunk.best[l];
                        if length > 0.0 {
                            taken.length_mm += length * (1.0 + spread * (before[l] + chunk.best[l]));
                            taken.thickness_mm = taken.thickness_mm.max(length * cosines[l]);
                            taken.rays += 1;
                        }
                    }
                }
                chunk.store(base, there, cut.heights_mm, cut.passes);
            }
        }
        stats.dexel_passes = (cut.tile.columns.len() * cut.tile.rows.len() * cut.records.len()) as u64;
        stats
    }
}

/// Eight rays with what is left on them.
struct Chunk {
    rays: Rays,
    best: Lanes,
    best_pass: [u32; LANES],
}

impl Chunk {
    #[inline(always)]
    fn load(
        field: &SpatialField,
        tile: &SweepTile,
        base: usize,
        there: usize,
        heights_mm: &[f32],
        passes: &[u32],
    ) -> Self {
        let mut rays = Rays { origin: [[0.0; LANES]; 3], normal: [[0.0; LANES]; 3] };
        let (mut best, mut best_pass) = ([0.0; LANES], [0_u32; LANES]);
        for l in 0..LANES {
            // Lanes beyond the tile's last row repeat it and write nothing.
            let at = base + l.min(there - 1);
            for axis in 0..3 {
                rays.origin[axis][l] = field.origins_mm()[axis][at] - tile.origin_mm[axis];
                rays.normal[axis][l] = field.normals()[axis][at];
            }
            best[l] = f64::from(heights_mm[at]);
            best_pass[l] = passes[at];
        }
        Self { rays, best, best_pass }
    }

    #[inline(always)]
    fn store(&self, base: usize, there: usize, heights_mm: &mut [f32], passes: &mut [u32]) {
        for l in 0..there {
            heights_mm[base + l] = self.best[l] as f32;
            passes[base + l] = self.best_pass[l];
        }
    }

    #[inline(always)]
    fn lower(&mut self, record: &SweepRecord, segments: &[Segment], low_mm: f64) -> ([u64; LANES], Lanes) {
        let segment = &segments[record.segment as usize];
        if record.twist_rad_per_mm == 0.0 {
            lower::<false>(record, segment, &self.rays, low_mm, &mut self.best, &mut self.best_pass)
        } else {
            lower::<true>(record, segment, &self.rays, low_mm, &mut self.best, &mut self.best_pass)
        }
    }
}

#[inline(always)]
fn paths(record: &SweepRecord, rays: &Rays) -> Paths {
    let mut paths = Paths { place: [[[0.0; LANES]; 3]; 4], along: [[[0.0; LANES]; 3]; 3] };
    for k in 0..3 {
        for row in 0..3 {
            let [x, y, z] = record.turn[k][row];
            let from = record.place_mm[k][row];
            for l in 0..LANES {
                paths.place[k][row][l] = from + (x * rays.origin[0][l] + y * rays.origin[1][l] + z * rays.origin[2][l]);
                paths.along[k][row][l] = x * rays.normal[0][l] + y * rays.normal[1][l] + z * rays.normal[2][l];
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

/// Lowers eight heights by one record; gives for every lane whether its root is unknown though it may lie below what is there, and the cosine at which the ray met the edge.
#[inline(always)]
fn lower<const TWISTED: bool>(
    record: &SweepRecord,
    segment: &Segment,
    rays: &Rays,
    low_mm: f64,
    best: &mut Lanes,
    best_pass: &mut [u32; LANES],
) -> ([u64; LANES], Lanes) {
    let paths = paths(record, rays);
    let [y_from, y_to] = segment.y_range_mm;
    let [cos, sin] = segment.blade_from_segment.rotation.to_array();
    let radius = record.radius_mm;
    let lowest = 2.0 * low_mm;
    let (mut h, mut t) = ([record.start_mm; LANES], [0.0; LANES]);
    let (mut step_h, mut step_t, mut falls) = ([0.0; LANES], [0.0; LANES], [false; LANES]);
    let mut cosine = [0.0; LANES];
    let (mut y_last, mut x_last, mut rises) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for _ in 0..MAX_STEPS {
        // The point and its rates over h and t, in (r, q, y).
        let (mut p, mut p_h, mut p_t) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        let (mut u, mut u_t) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            [u[l], u_t[l]] = half_angle(t[l]);
        }
        for row in 0..3 {
            for l in 0..LANES {
                let (c, d) = (&paths.place, &paths.along);
                let along = d[0][row][l] + u[l] * (d[1][row][l] + u[l] * d[2][row][l]);
                let along_u = d[1][row][l] + 2.0 * u[l] * d[2][row][l];
                p_h[row][l] = along;
                p[row][l] =
                    c[0][row][l] + u[l] * (c[1][row][l] + u[l] * (c[2][row][l] + u[l] * c[3][row][l])) + h[l] * along;
                let place_u = c[1][row][l] + u[l] * (2.0 * c[2][row][l] + u[l] * (3.0 * c[3][row][l]));
                p_t[row][l] = u_t[l] * (place_u + h[l] * along_u);
            }
        }
        if TWISTED {
            for l in 0..LANES {
                let twist = record.twist_rad_per_mm;
                let [s, c1] = small_turn(twist * p[2][l]);
                let (r, q) = (p[0][l], p[1][l]);
                let big = r + radius;
                // Turned back by the angle: r stays small, since only (cos - 1) multiplies the radius.
                let (r_new, q_new) = (r + c1 * big + s * q, q + c1 * q - s * big);
                for v in [&mut p_h, &mut p_t] {
                    let (a, b, about) = (v[0][l], v[1][l], twist * v[2][l]);
                    v[0][l] = a + c1 * a + s * b + about * q_new;
                    v[1][l] = b + c1 * b - s * a - about * (r_new + radius);
                }
                (p[0][l], p[1][l]) = (r_new, q_new);
            }
        }
        let (mut x, mut x_h, mut x_t) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut y, mut y_h, mut y_t) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let rho = p[0][l] + p[1][l] * t[l];
            let rho_h = p_h[0][l] + p_h[1][l] * t[l];
            let rho_t = p_t[0][l] + p_t[1][l] * t[l] + p[1][l];
            (x[l], y[l]) = (cos * rho + sin * p[2][l], cos * p[2][l] - sin * rho);
            (x_h[l], y_h[l]) = (cos * rho_h + sin * p_h[2][l], cos * p_h[2][l] - sin * rho_h);
            (x_t[l], y_t[l]) = (cos * rho_t + sin * p_t[2][l], cos * p_t[2][l] - sin * rho_t);
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
            let (q, q_h, q_t) = (p[1][l], p_h[1][l], p_t[1][l]);
            let (big, half, twice) = (radius + p[0][l], 1.0 - t[l] * t[l], 2.0 * t[l]);
            let moment = q * half - twice * big;
            let moment_h = q_h * half - twice * p_h[0][l];
            let moment_t = q_t * half - twice * (q + p_t[0][l]) - 2.0 * big;
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
            largest_h = largest_h.max(step_h[l].abs());
            largest_t = largest_t.max(step_t[l].abs());
        }
        if largest_h < LAST_STEP_MM && largest_t < LAST_STEP_T {
            break;
        }
    }
    let behind = match &segment.shape {
        SegmentShape::Table(_) => f64::NEG_INFINITY,
        SegmentShape::Arc { radius_mm } => -radius_mm,
    };
    let mut unknown = [0; LANES];
    for l in 0..LANES {
        let on_segment = (y_last[l] >= y_from - END_OVERLAP_MM)
            & (y_last[l] <= y_to + END_OVERLAP_MM)
            & (x_last[l] > behind)
            & falls[l]
            & (t[l].abs() < LARGEST_T);
        let converged = step_h[l].abs() < CONVERGED_MM;
        unknown[l] = u64::from(on_segment & !converged & (rises[l] < 2.0) & (h[l] < best[l]));
        let height = h[l].max(low_mm);
        let lower = on_segment & converged & (h[l] > lowest) & (height < best[l]);
        best[l] = if lower { height } else { best[l] };
        best_pass[l] = if lower { record.pass } else { best_pass[l] };
    }
    (unknown, cosine)
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
