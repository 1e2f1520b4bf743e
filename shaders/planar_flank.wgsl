// Lowers the dexels of a field by every pass that their tile visits.
//
// One thread per four or eight rows of a column; one workgroup row (y) per tile, so that records are read in step.
// Reads tiles, columns, records, row phases; lowers heights and passes in place; counts iterations that stopped short.
// Twin: crates/core/src/cut/cpu/planar.rs (derivation there). Adds at most 1 nm to a height, of which the rounding to
// f32 is a part.

@group(0) @binding(0) var<storage, read> tiles: array<FlankTile>;
@group(0) @binding(1) var<storage, read> columns: array<FlankColumn>;
@group(0) @binding(2) var<storage, read> records: array<FlankPass>;
// Phase tau of a column's rows in fours, field by field.
@group(0) @binding(3) var<storage, read> row_phases: array<vec4<f32>>;
// Rows in fours; columns follow each other, each filled up to whole fours.
@group(0) @binding(4) var<storage, read_write> heights_mm: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> passes: array<vec4<u32>>;
// Two for each field, of which the first counts iterations that stopped short.
@group(0) @binding(6) var<storage, read_write> counts: array<atomic<u32>>;

// Threads of a workgroup: one wave on every GPU, and the host's number.
const WORKGROUP_THREADS: u32 = 64u;
// All strokes are frozen: the cubics are their constants.
override FROZEN: bool = false;
// Some of the records are arcs: software adapters pay for both ways of entering whichever is taken.
override ARCS: bool = true;
// Quads of four rows that a thread cuts, one or two. On a software adapter a record is read once for both, and while
// one waits for a division the other goes on; on a GPU other waves do that, as long as registers leave room for them.
override QUADS_PER_THREAD: u32 = 2u;

// A column's ray in a record's segment: coefficients of tau^0 to tau^3.
struct RayCubics {
    x: vec4<f32>,
    y: vec4<f32>,
    nx: vec4<f32>,
    ny: vec4<f32>,
}

// Four rows of a column.
struct Quad {
    at: u32,
    there: bool,
    row_there: vec4<bool>,
    tau: vec4<f32>,
    best: vec4<f32>,
    pass_id: vec4<u32>,
    unknown: vec4<u32>,
}

fn cubic(c: vec4<f32>, tau: vec4<f32>) -> vec4<f32> {
    if FROZEN {
        return vec4(c.x);
    }
    return c.x + tau * (c.y + tau * (c.z + tau * c.w));
}

fn quad(tile: FlankTile, column: u32, index: u32, column_there: bool) -> Quad {
    // Quads beyond the last repeat it, and are not written.
    let in_column = min(index, tile.quads - 1u);
    let at = tile.first_quad + column * tile.quads + in_column;
    let there = column_there & (index < tile.quads);
    let row_there = (vec4(4u * index) + vec4(0u, 1u, 2u, 3u) < vec4(tile.rows)) & vec4(there);
    let tau = row_phases[tile.first_phase + in_column];
    return Quad(at, there, row_there, tau, heights_mm[at], passes[at], vec4(0u));
}

fn lowered(quad: Quad, ray: RayCubics, record: FlankPass, low_mm: f32) -> Quad {
    let rays =
        Rays(cubic(ray.x, quad.tau), cubic(ray.y, quad.tau), cubic(ray.nx, quad.tau), cubic(ray.ny, quad.tau));
    var entries: Entries;
    if ARCS && record.is_arc == 1u {
        entries = enter_arc(rays, record);
    } else {
        entries = enter_curve(rays, record, 2.0 * low_mm - record.start_mm);
    }
    let low = vec4(low_mm);
    let h = record.start_mm + entries.height_mm;
    let recorded = max(h, low);
    let lower = entries.hit & (h > 2.0 * low) & (recorded < quad.best);
    let unknown = entries.unconverged & (h < quad.best) & quad.row_there;
    return Quad(
        quad.at,
        quad.there,
        quad.row_there,
        quad.tau,
        select(quad.best, recorded, lower),
        select(quad.pass_id, vec4(record.pass_id), lower),
        quad.unknown + select(vec4(0u), vec4(1u), unknown),
    );
}

fn keep(quad: Quad) {
    if quad.there {
        heights_mm[quad.at] = quad.best;
        passes[quad.at] = quad.pass_id;
    }
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn planar_flank(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tile = tiles[group.y];
    let thread = group.x * WORKGROUP_THREADS + local;
    let thread_of_column = thread % tile.threads_per_column;
    // Threads beyond the tile's last column repeat it, and write nothing: an early return would part the threads of a
    // wave.
    let column_there = thread / tile.threads_per_column < tile.column_count;
    let column_in_tile = min(thread / tile.threads_per_column, tile.column_count - 1u);
    let column = columns[tile.first_column + column_in_tile];
    // Neighbouring threads take neighbouring quads.
    var first = quad(tile, column_in_tile, thread_of_column, column_there);
    var second: Quad;
    if QUADS_PER_THREAD == 2u {
        second = quad(tile, column_in_tile, thread_of_column + tile.threads_per_column, column_there);
    }

    for (var i = 0u; i < tile.record_count; i++) {
        let record = records[tile.first_record + i];
        // Against the tile's middle ray, both at the start height.
        let q = column.offset_mm + record.start_mm * column.normal_change;
        let ray = RayCubics(
            record.x_mm + (record.cos * q.x - record.sin * q.y),
            record.y_mm + (record.sin * q.x + record.cos * q.y),
            record.cos * column.normal.x - record.sin * column.normal.y,
            record.sin * column.normal.x + record.cos * column.normal.y,
        );
        first = lowered(first, ray, record, column.low_mm);
        if QUADS_PER_THREAD == 2u {
            second = lowered(second, ray, record, column.low_mm);
        }
    }

    keep(first);
    if QUADS_PER_THREAD == 2u {
        keep(second);
    }
    let unknown = first.unknown + second.unknown;
    let short = unknown.x + unknown.y + unknown.z + unknown.w;
    if short > 0u {
        atomicAdd(&counts[2u * tile.field], short);
    }
}
