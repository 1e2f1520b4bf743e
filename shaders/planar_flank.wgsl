// Lowers the dexels of a field by every pass that their tile visits.
//
// One thread per four rows of a column; one workgroup row (y) per tile, so that records are read in step. Reads launch,
// tiles, columns, records, cells, row phases; lowers heights and passes in place; counts iterations that stopped short.
// Twin: src/cut/cpu/planar.rs (derivation there). Adds at most 1 nm to a height, of which the rounding to f32 is a
// part.

@group(0) @binding(0) var<uniform> launch: Launch;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> columns: array<Column>;
@group(0) @binding(3) var<storage, read> records: array<PassRecord>;
// Coefficients of x = c0 + t (c1 + t (c2 + t c3)), all segments after each other.
@group(0) @binding(4) var<storage, read> cells: array<vec4<f32>>;
// Phase tau of every row.
@group(0) @binding(5) var<storage, read> row_phases: array<f32>;
@group(0) @binding(6) var<storage, read_write> heights_mm: array<f32>;
@group(0) @binding(7) var<storage, read_write> passes: array<u32>;
@group(0) @binding(8) var<storage, read_write> unconverged: atomic<u32>;

// Threads of a workgroup: one wave on every GPU, and the host's number.
override WORKGROUP_THREADS: u32 = 64u;
// All strokes are frozen: the cubics are their constants.
override FROZEN: bool = false;
// Rows of a thread, the lanes of its vectors: they hide the latency of division and table.
const ROWS_PER_THREAD: u32 = 4u;

fn cubic(c: vec4<f32>, tau: vec4<f32>) -> vec4<f32> {
    if FROZEN {
        return vec4(c.x);
    }
    return c.x + tau * (c.y + tau * (c.z + tau * c.w));
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn planar_flank(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tile = tiles[group.y];
    let thread = group.x * WORKGROUP_THREADS + local;
    let column_in_tile = thread / launch.threads_per_column;
    // Threads beyond the tile's last column repeat it, and write nothing: an early return would part the threads of a
    // wave.
    let column_index = tile.first_column + min(column_in_tile, tile.column_count - 1u);
    let column = columns[column_index];
    // Rows of one thread lie apart by the number of threads, so that neighbouring threads touch neighbouring rows.
    let rows = vec4(thread % launch.threads_per_column) + vec4(0u, 1u, 2u, 3u) * launch.threads_per_column;
    let there = (rows < vec4(launch.rows)) & vec4(column_in_tile < tile.column_count);
    // Lanes beyond the last row repeat it, and write nothing.
    let row = min(rows, vec4(launch.rows - 1u));
    let at = vec4(column_index * launch.rows) + row;
    let tau = vec4(row_phases[row.x], row_phases[row.y], row_phases[row.z], row_phases[row.w]);
    var best = vec4(heights_mm[at.x], heights_mm[at.y], heights_mm[at.z], heights_mm[at.w]);
    var best_pass = vec4(passes[at.x], passes[at.y], passes[at.z], passes[at.w]);
    let low = vec4(column.low_mm);
    var unknown = vec4(0u);

    for (var i = 0u; i < tile.record_count; i++) {
        let record = records[tile.first_record + i];
        // Against the tile's middle ray, both at the start height.
        let q = column.offset_mm + record.start_mm * column.normal_change;
        let c = cubic(record.cos, tau);
        let s = cubic(record.sin, tau);
        let rays = Rays(
            cubic(record.x_mm, tau) + (c * q.x - s * q.y),
            cubic(record.y_mm, tau) + (s * q.x + c * q.y),
            c * column.normal.x - s * column.normal.y,
            s * column.normal.x + c * column.normal.y,
        );
        var entries: Entries;
        if record.cells_per_mm > 0.0 {
            entries = enter_table(rays, record);
        } else {
            entries = enter_arc(rays, record);
        }
        let h = record.start_mm + entries.height_mm;
        let recorded = max(h, low);
        let lower = entries.hit & (h > 2.0 * low) & (recorded < best);
        unknown += select(vec4(0u), vec4(1u), entries.unconverged & (h < best) & there);
        best = select(best, recorded, lower);
        best_pass = select(best_pass, vec4(record.pass_id), lower);
    }

    for (var lane = 0u; lane < ROWS_PER_THREAD; lane++) {
        if there[lane] {
            heights_mm[at[lane]] = best[lane];
            passes[at[lane]] = best_pass[lane];
        }
    }
    let short = unknown.x + unknown.y + unknown.z + unknown.w;
    if short > 0u {
        atomicAdd(&unconverged, short);
    }
}
