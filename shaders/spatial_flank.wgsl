// Lowers dexels whose rays lie anywhere in space by every sweep that their part of a tile visits.
//
// One thread per group of rows of a column, its lanes (one row on GPUs, four on software adapters:
// `shared/lanes_*.wgsl`); one workgroup row (y) per part, so that records are read in step. Which records a part visits
// is listed by the host, or searched here (`shared/visits_*.wgsl`). Reads tiles, records, rays; lowers heights and
// passes in place; counts iterations that stopped short, and visits where they were searched. Twin:
// crates/core/src/cut/cpu/spatial.rs; derivation: crates/core/src/passes/spatial/sweep.rs. Adds at most 2 nm to a
// height.

@group(0) @binding(0) var<storage, read> tiles: array<SpatialTile>;
@group(0) @binding(1) var<storage, read> visits: array<u32>;
@group(0) @binding(2) var<storage, read> records: array<SpatialPass>;
// Six for each group of rows: x, y, z of the origins against the tile's, x, y, z of the directions.
@group(0) @binding(3) var<storage, read> rays: array<Lanes>;
@group(0) @binding(4) var<storage, read_write> heights_mm: array<Lanes>;
@group(0) @binding(5) var<storage, read_write> passes: array<LaneCounts>;
// Two for each field: iterations that stopped short, and (dexel, record) pairs where the device searches them.
@group(0) @binding(6) var<storage, read_write> counts: array<atomic<u32>>;

fn ray_of(group: u32) -> Rays {
    var ray: Rays;
    for (var axis = 0u; axis < 3u; axis++) {
        ray.o[axis] = rays[6u * group + axis];
        ray.n[axis] = rays[6u * group + 3u + axis];
    }
    return ray;
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn spatial_flank(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tile = tiles[group.y];
    let in_tile = group.x * WORKGROUP_THREADS + local;
    // Threads beyond the tile's last group repeat it, and write nothing: an early return would part the threads of a
    // wave.
    let at_group = tile.first_group + min(in_tile, tile.group_count - 1u);
    let there = in_tile < tile.group_count;
    let ray = ray_of(at_group);
    var best = heights_mm[at_group];
    var best_pass = passes[at_group];
    let low = Lanes(tile.middle.w);
    var unknown = LaneCounts(0u);

    let below_mm = search(tile, best, local);
    var visited = 0u;
    for (var i = 0u; i < tile.visit_count; i++) {
        if is_clear(i, below_mm) {
            continue;
        }
        visited++;
        let record = records[visit(tile, i)];
        let found = entry(record, ray, tile.middle.xyz, 2.0 * low, MAX_STEPS);
        let in_front = LaneFlags(record.is_arc == 0u) | (found.x + record.curve.x > Lanes(0.0));
        let on_segment = (found.y >= Lanes(record.y_from_mm))
            & (found.y <= Lanes(record.y_to_mm))
            & in_front
            & found.falls
            & (found.t > Lanes(record.t_from))
            & (found.t < Lanes(record.t_to));
        let converged = abs(found.step_h) < Lanes(LAST_STEP_MM);
        let height = record.place_3.w + found.h;
        let recorded = max(height, low);
        let lower = on_segment & converged & (height > 2.0 * low) & (recorded < best);
        unknown += select(
            LaneCounts(0u),
            LaneCounts(1u),
            on_segment & !converged & (found.rises < LaneCounts(2u)) & (height < best) & LaneFlags(there),
        );
        best = select(best, recorded, lower);
        best_pass = select(best_pass, LaneCounts(record.pass_id), lower);
    }

    if there {
        heights_mm[at_group] = best;
        passes[at_group] = best_pass;
    }
    let short = counted(unknown);
    if short > 0u {
        atomicAdd(&counts[2u * tile.field], short);
    }
    if local == 0u {
        count_visits(tile, visited);
    }
}
