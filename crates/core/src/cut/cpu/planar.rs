//! The planar kernel: rays of one tile against the segments of its passes.
//!
//! In: columns of rays, records ([`PassRecord`]), edge segments, the phase tau of every row, the layer so far. Out:
//! lowered heights and the passes that lowered them.
//!
//! For a ray and a pass, the place in the segment's frame is `x0 + h nx`, `y0 + h ny` with all four cubics in tau. The
//! entry into the tool is the falling root of `f(h) = x0 + h nx - U(y0 + h ny)`; Newton's method starts at the tile's
//! middle root, some hundred nanometres to micrometres away, and needs two steps. Sixteen rows of a column go together.
//! They meet the edge within a micrometre of each other, nearly always in the same cell of its table, whose four
//! coefficients are then loaded once; when they straddle a cell's end, each row loads its own. Both compute the same
//! numbers. Of a field with a single row in the middle of the stroke sixteen columns go together instead, each with the
//! steps that it would take alone.

#![expect(
    clippy::inline_always,
    reason = "the instruction set of the dispatching function holds only for what is inlined into it"
)]
#![expect(clippy::needless_bitwise_bool, reason = "lanes are evaluated without branches, or they would not vectorise")]

use crate::cut::CutStats;
use crate::dexel::Column;
use crate::passes::PassRecord;
use crate::tool::edge::{Segment, SegmentShape};
use crate::tool::edge_table::EdgeTable;
use glam::DVec2;

/// Rows that go together: two AVX-512 registers or four AVX2 registers per quantity hide the latency of the division.
const LANES: usize = 16;
/// Newton steps at most; from the tile's middle two suffice, a dozen serve rays that graze.
const MAX_STEPS: usize = 16;
/// A step below this (10 nm) is the last one: the error after it is its square times half the bend of the edge along
/// the ray, 5e-11 mm where the radius is 1 mm.
const LAST_STEP_MM: f64 = 1e-5;
/// Hits this far beyond a segment's end still count: neighbouring segments then leave no slit for a ray to slip
/// through.
const END_OVERLAP_MM: f64 = 1e-9;

/// One tile's work; called through the instruction set dispatch.
pub struct TileCut<'a> {
    pub columns: &'a [Column],
    pub origin_mm: DVec2,
    pub records: &'a [PassRecord],
    pub segments: &'a [Segment],
    pub row_phases: &'a [f64],
    pub heights_mm: &'a mut [f32],
    pub passes: &'a mut [u32],
}

type RowLanes = [f64; LANES];

/// A column's ray in the segment's frame: cubics in tau.
#[derive(Clone, Copy)]
struct RayCubics {
    x0: [f64; 4],
    y0: [f64; 4],
    nx: [f64; 4],
    ny: [f64; 4],
}

/// Rays of sixteen rows in the segment's frame.
struct RowRays {
    x0: RowLanes,
    y0: RowLanes,
    nx: RowLanes,
    ny: RowLanes,
}

/// Heights of sixteen rows, and whether each is an entry on the segment, converged.
struct Entries {
    h: RowLanes,
    hit: [bool; LANES],
    unconverged: [bool; LANES],
}

impl pulp::NullaryFnOnce for TileCut<'_> {
    type Output = CutStats;

    #[inline(always)]
    fn call(self) -> CutStats {
        let rows = self.row_phases.len();
        if *self.row_phases == [0.0] {
            return self.columns_at_once();
        }
        let mut stats = CutStats::default();
        // Rows padded to whole chunks by repeating the last phase, so that every chunk has the same shape.
        let chunks = rows.div_ceil(LANES);
        let last = self.row_phases.last().copied().unwrap_or(0.0);
        let mut phases = vec![[last; LANES]; chunks];
        phases.as_flattened_mut()[..rows].copy_from_slice(self.row_phases);
        let mut best = vec![[0.0; LANES]; chunks];
        let mut best_pass = vec![[0_u32; LANES]; chunks];

        for (index, column) in self.columns.iter().enumerate() {
            let dexels = index * rows..(index + 1) * rows;
            for (b, &h) in best.as_flattened_mut().iter_mut().zip(&self.heights_mm[dexels.clone()]) {
                *b = f64::from(h);
            }
            best_pass.as_flattened_mut()[..rows].copy_from_slice(&self.passes[dexels.clone()]);
            for record in self.records {
                let segment = &self.segments[record.segment as usize];
                let ray = ray_cubics(record, column.origin_mm - self.origin_mm, column.normal);
                for (chunk, ((tau, best), best_pass)) in phases.iter().zip(&mut best).zip(&mut best_pass).enumerate() {
                    let rays = rays_at(&ray, tau);
                    let entries = match &segment.shape {
                        SegmentShape::Table(table) => enter_table::<false>(
                            table,
                            segment.y_range_mm,
                            &rays,
                            record.start_mm,
                            &[2.0 * column.low_mm; LANES],
                        ),
                        SegmentShape::Arc { radius_mm } => enter_arc(*radius_mm, segment.y_range_mm, &rays),
                    };
                    stats.unconverged += keep_lowest(
                        &entries,
                        rows - LANES * chunk,
                        &[column.low_mm; LANES],
                        record.pass,
                        best,
                        best_pass,
                    );
                }
            }
            stats.dexel_passes += (self.records.len() * rows) as u64;
            for (h, &b) in self.heights_mm[dexels.clone()].iter_mut().zip(best.as_flattened()) {
                *h = b as f32;
            }
            self.passes[dexels].copy_from_slice(&best_pass.as_flattened()[..rows]);
        }
        stats
    }
}

impl TileCut<'_> {
    /// The same at the phase 0 alone, where cubics are their first coefficients, for sixteen columns at a time; the
    /// last lanes repeat the last column.
    #[inline(always)]
    fn columns_at_once(self) -> CutStats {
        let mut stats = CutStats::default();
        for start in (0..self.columns.len()).step_by(LANES) {
            let count = LANES.min(self.columns.len() - start);
            let columns: [&Column; LANES] = std::array::from_fn(|l| &self.columns[start + l.min(count - 1)]);
            let of = |pick: fn(&Column) -> f64| -> RowLanes { columns.map(pick) };
            let [n_x, n_y] = [of(|column| column.normal.x), of(|column| column.normal.y)];
            let o_x = of(|column| column.origin_mm.x).map(|x| x - self.origin_mm.x);
            let o_y = of(|column| column.origin_mm.y).map(|y| y - self.origin_mm.y);
            let low_mm = of(|column| column.low_mm);
            let lowest_mm = low_mm.map(|low_mm| 2.0 * low_mm);
            let mut best: RowLanes = std::array::from_fn(|l| f64::from(self.heights_mm[start + l.min(count - 1)]));
            let mut best_pass: [u32; LANES] = std::array::from_fn(|l| self.passes[start + l.min(count - 1)]);
            for record in self.records {
                let segment = &self.segments[record.segment as usize];
                let ([c, s], [x, y]) = ([record.cos[0], record.sin[0]], [record.x_mm[0], record.y_mm[0]]);
                let mut rays = RowRays { x0: [0.0; LANES], y0: [0.0; LANES], nx: [0.0; LANES], ny: [0.0; LANES] };
                for l in 0..LANES {
                    rays.x0[l] = x + (c * o_x[l] - s * o_y[l]);
                    rays.y0[l] = y + (s * o_x[l] + c * o_y[l]);
                    rays.nx[l] = c * n_x[l] - s * n_y[l];
                    rays.ny[l] = s * n_x[l] + c * n_y[l];
                }
                let entries = match &segment.shape {
                    SegmentShape::Table(table) => {
                        enter_table::<true>(table, segment.y_range_mm, &rays, record.start_mm, &lowest_mm)
                    }
                    SegmentShape::Arc { radius_mm } => enter_arc(*radius_mm, segment.y_range_mm, &rays),
                };
                stats.unconverged += keep_lowest(&entries, count, &low_mm, record.pass, &mut best, &mut best_pass);
            }
            stats.dexel_passes += (self.records.len() * count) as u64;
            for l in 0..count {
                self.heights_mm[start + l] = best[l] as f32;
                self.passes[start + l] = best_pass[l];
            }
        }
        stats
    }
}

#[inline(always)]
fn ray_cubics(record: &PassRecord, o: DVec2, n: DVec2) -> RayCubics {
    let mut ray = RayCubics { x0: record.x_mm, y0: record.y_mm, nx: [0.0; 4], ny: [0.0; 4] };
    for k in 0..4 {
        let (c, s) = (record.cos[k], record.sin[k]);
        ray.x0[k] += c * o.x - s * o.y;
        ray.y0[k] += s * o.x + c * o.y;
        ray.nx[k] = c * n.x - s * n.y;
        ray.ny[k] = s * n.x + c * n.y;
    }
    ray
}

#[inline(always)]
fn rays_at(ray: &RayCubics, tau: &RowLanes) -> RowRays {
    let at = |c: &[f64; 4]| {
        let mut value = [0.0; LANES];
        for l in 0..LANES {
            value[l] = c[0] + tau[l] * (c[1] + tau[l] * (c[2] + tau[l] * c[3]));
        }
        value
    };
    RowRays { x0: at(&ray.x0), y0: at(&ray.y0), nx: at(&ray.nx), ny: at(&ray.ny) }
}

/// Newton's method. The residual of a convex segment is convex in h: from any place where it falls the iteration runs
/// to the entry, from the left without overshooting. A lane that finds itself where the residual rises goes back to
/// `lowest_mm`, where it falls if there is any entry above at all; one that gets there twice has passed the bottom of a
/// residual without roots: its ray misses the segment. Lanes go on until all have converged, or stay where they have
/// done so if they are to be what they would be `ALONE`.
#[inline(always)]
fn enter_table<const ALONE: bool>(
    table: &EdgeTable,
    [y_from, y_to]: [f64; 2],
    rays: &RowRays,
    start_mm: f64,
    lowest_mm: &RowLanes,
) -> Entries {
    let (y_start, y_end) = (table.y_start_mm, table.y_end_mm());
    let width = 1.0 / table.cells_per_mm;
    let last_cell = (table.cells.len() - 1) as f64;
    let mut h = [start_mm; LANES];
    let (mut y, mut rate, mut rises) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    let mut step = [f64::INFINITY; LANES];
    for _ in 0..MAX_STEPS {
        let (mut inside, mut cell) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            y[l] = rays.y0[l] + h[l] * rays.ny[l];
            inside[l] = y[l].max(y_start).min(y_end);
            cell[l] = ((inside[l] - y_start) * table.cells_per_mm).floor().min(last_cell);
        }
        let first = cell[0];
        let mut apart = [0.0; LANES];
        for l in 0..LANES {
            apart[l] = cell[l] - first;
        }
        let same = all_below(&apart, 0.5);
        let (mut residual, before) = ([0.0; LANES], (step, rate));
        if same {
            let c = table.cells[first as usize];
            for l in 0..LANES {
                (residual[l], rate[l]) = newton_terms(&c, cell[l], width, y_start, inside[l], y[l], h[l], rays, l);
            }
        } else {
            for l in 0..LANES {
                let c = table.cells[cell[l] as usize];
                (residual[l], rate[l]) = newton_terms(&c, cell[l], width, y_start, inside[l], y[l], h[l], rays, l);
            }
        }
        for l in 0..LANES {
            let newton = residual[l] / rate[l];
            let next = if rate[l] < 0.0 { newton } else { h[l] - lowest_mm[l] };
            let rests = ALONE & (before.0[l].abs() < LAST_STEP_MM);
            step[l] = if rests { before.0[l] } else { next };
            rises[l] += if rests | (rate[l] < 0.0) { 0.0 } else { 1.0 };
            rate[l] = if rests { before.1[l] } else { rate[l] };
            h[l] -= if rests { 0.0 } else { next };
        }
        if all_below(&step, LAST_STEP_MM) {
            break;
        }
    }
    let mut entries = Entries { h, hit: [false; LANES], unconverged: [false; LANES] };
    for l in 0..LANES {
        let on_segment = (rays.y0[l] + h[l] * rays.ny[l] >= y_from - END_OVERLAP_MM)
            & (rays.y0[l] + h[l] * rays.ny[l] <= y_to + END_OVERLAP_MM)
            & (rate[l] < 0.0);
        let converged = step[l].abs() < LAST_STEP_MM;
        entries.hit[l] = on_segment & converged;
        entries.unconverged[l] = on_segment & !converged & (rises[l] < 2.0);
    }
    entries
}

/// All lanes are smaller in magnitude than the limit: one comparison of vectors, where a largest value would be sought
/// lane after lane.
#[inline(always)]
fn all_below(lanes: &RowLanes, limit: f64) -> bool {
    let mut below = true;
    for lane in lanes {
        below &= lane.abs() < limit;
    }
    below
}

/// Residual and its rate along the ray for one lane.
#[inline(always)]
#[expect(
    clippy::too_many_arguments,
    reason = "one lane of the structure of arrays above; bundling it would hide what varies"
)]
fn newton_terms(
    c: &[f64; 4],
    cell: f64,
    width: f64,
    y_start: f64,
    inside: f64,
    y: f64,
    h: f64,
    rays: &RowRays,
    l: usize,
) -> (f64, f64) {
    let t = inside - y_start - cell * width;
    let slope = c[1] + t * (2.0 * c[2] + t * (3.0 * c[3]));
    let x = c[0] + t * (c[1] + t * (c[2] + t * c[3])) + (y - inside) * slope;
    (rays.x0[l] + h * rays.nx[l] - x, rays.nx[l] - slope * rays.ny[l])
}

#[inline(always)]
fn enter_arc(radius_mm: f64, [y_from, y_to]: [f64; 2], rays: &RowRays) -> Entries {
    let mut entries = Entries { h: [0.0; LANES], hit: [false; LANES], unconverged: [false; LANES] };
    for l in 0..LANES {
        let (x0, y0, nx, ny) = (rays.x0[l], rays.y0[l], rays.nx[l], rays.ny[l]);
        let b = nx * (x0 + radius_mm) + ny * y0;
        let c = x0 * x0 + y0 * y0 + 2.0 * radius_mm * x0;
        let discriminant = b * b - c;
        let root = discriminant.max(0.0).sqrt();
        // The first of the two roots, without cancellation when the ray points at the arc.
        let h = if b < 0.0 { c / (root - b) } else { -b - root };
        let y = y0 + h * ny;
        entries.h[l] = h;
        entries.hit[l] = (discriminant > 0.0)
            & (y >= y_from - END_OVERLAP_MM)
            & (y <= y_to + END_OVERLAP_MM)
            & (x0 + h * nx + radius_mm > 0.0);
    }
    entries
}

/// Lowers the heights and gives the number of lanes, of so many that are `there`, whose root is unknown though it may
/// lie below what is there (from the left Newton's method climbs towards the entry, so iterates above the height that
/// is there do no harm); a cut deeper than the ray records is put at its lowest height, far deeper ones belong to the
/// other side of the tooth.
#[inline(always)]
fn keep_lowest(
    entries: &Entries,
    there: usize,
    low_mm: &RowLanes,
    pass: u32,
    best: &mut RowLanes,
    best_pass: &mut [u32; LANES],
) -> u64 {
    let mut unknown = 0;
    for l in 0..LANES {
        unknown += u64::from(entries.unconverged[l] & (entries.h[l] < best[l]) & (l < there));
        let h = entries.h[l].max(low_mm[l]);
        let lower = entries.hit[l] & (entries.h[l] > 2.0 * low_mm[l]) & (h < best[l]);
        best[l] = if lower { h } else { best[l] };
        best_pass[l] = if lower { pass } else { best_pass[l] };
    }
    unknown
}
