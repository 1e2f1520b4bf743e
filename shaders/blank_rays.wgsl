// Takes the passes of a tile from its rays through the blank, in order of time.
//
// One thread per ray, one workgroup per tile. Reads launch, tiles, passes, parts; rewrites spans and their counts; adds
// what every pass removed, in fixed point, so that the sum does not depend on the order of threads; lists the pieces
// that were taken, in any order, if the host asks for them. A list that has no room says how much it needs, and the
// host comes back with more. A pass is a closed curve and nothing else: the section of a hob tooth's sweep. Twin:
// crates/core/src/cut/cpu/blank_sweeps.rs. Adds at most four ulps to an end that its ray meets at 45 degrees or
// steeper.

@group(0) @binding(0) var<uniform> launch: BlankLaunch;
@group(0) @binding(1) var<storage, read> tiles: array<BlankTile>;
@group(0) @binding(2) var<storage, read> passes: array<BlankPass>;
@group(0) @binding(3) var<storage, read> parts: array<BlankPart>;
@group(0) @binding(4) var<storage, read_write> spans: array<BlankSpan>;
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;
// Per pass of a tile, in launch.units_per_mm.
@group(0) @binding(6) var<storage, read_write> removed: array<atomic<u32>>;
// Largest list that had no room; whether crossings of one curve had none; pieces that were taken.
@group(0) @binding(7) var<storage, read_write> needs: array<atomic<u32>, 3>;
@group(0) @binding(8) var<storage, read_write> pieces: array<BlankPiece>;

const WORKGROUP_THREADS: u32 = 64u;
// Crossings of one curve with one ray: two as a rule, four at a slanting tooth; more are reported, never left out.
const MOST_CROSSINGS: u32 = 8u;
// Newton steps within a part, each inside its bracket.
const STEPS: u32 = 12u;
fn value(c: vec4<f32>, t: f32) -> f32 {
    return c.x + t * (c.y + t * (c.z + t * c.w));
}

fn rate(c: vec4<f32>, t: f32) -> f32 {
    return c.y + t * (2.0 * c.z + t * 3.0 * c.w);
}

fn cross_part(part: BlankPart, at_mm: f32) -> Crossing {
    let climbs = part.across_end_mm > part.across.x;
    // Parameters below and above the root.
    var low = select(1.0, 0.0, climbs);
    var high = 1.0 - low;
    var t = (at_mm - part.across.x) / (part.across_end_mm - part.across.x);
    for (var step = 0u; step < STEPS; step++) {
        let residual = value(part.across, t) - at_mm;
        if residual > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let slope = rate(part.across, t);
        let newton = t - residual / select(slope, 1e-30, slope == 0.0);
        t = select(0.5 * (low + high), newton, (newton - low) * (newton - high) <= 0.0);
    }
    let tangent = vec2(rate(part.along, t), rate(part.across, t));
    let length = max(sqrt(dot(tangent, tangent)), 1e-30);
    return Crossing(value(part.along, t), vec2(-tangent.y, tangent.x) / length);
}

// Lists what a pass takes of a span.
fn take_piece(ray: u32, pass_id: u32, span: BlankSpan, entry: Crossing, exit: Crossing) {
    let place = atomicAdd(&needs[2], 1u);
    if place >= launch.piece_room {
        return;
    }
    var piece = span;
    if piece.low_mm <= entry.along_mm {
        piece.low_mm = entry.along_mm;
        piece.low_pass = pass_id;
        piece.low_normal = entry.normal;
    }
    if piece.high_mm >= exit.along_mm {
        piece.high_mm = exit.along_mm;
        piece.high_pass = pass_id;
        piece.high_normal = exit.normal;
    }
    pieces[place] = BlankPiece(piece, ray, pass_id);
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn blank_rays(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tile = tiles[group.x];
    if local >= tile.ray_count {
        return;
    }
    let ray = tile.first_ray + local;
    let at_mm = f32(local) * launch.spacing_mm;
    var count = counts[ray];
    for (var p = 0u; p < tile.pass_count; p++) {
        let tooth = passes[tile.first_pass + p];
        var found: array<Crossing, MOST_CROSSINGS>;
        var met = 0u;
        for (var k = 0u; k < tooth.part_count; k++) {
            let part = parts[tooth.first_part + k];
            let from_mm = min(part.across.x, part.across_end_mm);
            let to_mm = max(part.across.x, part.across_end_mm);
            if at_mm < from_mm || at_mm >= to_mm {
                continue;
            }
            if met == MOST_CROSSINGS {
                atomicMax(&needs[1], 1u);
                return;
            }
            let crossing = cross_part(part, at_mm);
            var place = met;
            while place > 0u && found[place - 1u].along_mm > crossing.along_mm {
                found[place] = found[place - 1u];
                place--;
            }
            found[place] = crossing;
            met++;
        }
        for (var c = 0u; c + 1u < met; c += 2u) {
            let entry = found[c];
            let exit = found[c + 1u];
            let material = met_between(ray, count, entry.along_mm, exit.along_mm);
            if material.first == material.last {
                continue;
            }
            if launch.piece_room > 0u {
                for (var k = material.first; k < material.last; k++) {
                    take_piece(ray, tooth.pass_id, spans[slot(ray, k)], entry, exit);
                }
            }
            let left = cut_out(ray, count, material, entry, exit, tooth.pass_id);
            if left.count > launch.capacity {
                atomicMax(&needs[0], left.count);
                return;
            }
            count = left.count;
            atomicAdd(&removed[tile.first_pass + p], u32(round(left.removed_mm * launch.units_per_mm)));
        }
    }
    counts[ray] = count;
}
