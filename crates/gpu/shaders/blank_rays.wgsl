// Takes the passes of a tile from its rays through the blank, in order of time.
//
// One thread per ray, one workgroup per tile. Reads launch, tiles, passes, parts; rewrites spans and their counts; adds
// what every pass removed, in fixed point, so that the sum does not depend on the order of threads; lists the pieces
// that were taken, in any order, if the host asks for them. A list that has no room says how much it needs, and the
// host comes back with more. A pass is a closed curve and nothing else: a cutter tooth's outline in shaping, the
// section of a hob tooth's sweep in hobbing. Twins: crates/core/src/cut/cpu/blank.rs (derivation there),
// crates/core/src/cut/cpu/blank_sweeps.rs. Adds at most 30 nm to an end that its ray meets at 45 degrees or steeper.

@group(0) @binding(0) var<uniform> launch: BlankLaunch;
@group(0) @binding(1) var<storage, read> tiles: array<BlankTile>;
@group(0) @binding(2) var<storage, read> passes: array<BlankPass>;
@group(0) @binding(3) var<storage, read> parts: array<BlankPart>;
@group(0) @binding(4) var<storage, read_write> spans: array<BlankSpan>;
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;
// Per pass of a tile, in launch.units_per_mm: taken by a stroke, met by a return stroke.
@group(0) @binding(6) var<storage, read_write> removed: array<atomic<u32>>;
// Largest list that had no room; whether crossings of one curve had none; pieces that were taken.
@group(0) @binding(7) var<storage, read_write> needs: array<atomic<u32>, 3>;
@group(0) @binding(8) var<storage, read_write> pieces: array<BlankPiece>;

override WORKGROUP_THREADS: u32 = 64u;
// Crossings of one curve with one ray: two as a rule, four at a slanting tooth; more are reported, never left out.
const MOST_CROSSINGS: u32 = 8u;
// Newton steps within a part, each inside its bracket.
const STEPS: u32 = 12u;
// Shorter remnants are rounding, mm: four ulps at 70 mm.
const LEAST_SPAN_MM: f32 = 3e-5;

struct Crossing {
    along_mm: f32,
    normal: vec2<f32>,
}

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
    let base = ray * launch.capacity;
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
            var first = 0u;
            while first < count && spans[base + first].high_mm <= entry.along_mm {
                first++;
            }
            var last = first;
            var length_mm = 0.0;
            while last < count && spans[base + last].low_mm < exit.along_mm {
                // Near numbers: a difference of whole spans would lose the chip among them.
                let span = spans[base + last];
                length_mm += min(span.high_mm, exit.along_mm) - max(span.low_mm, entry.along_mm);
                last++;
            }
            if first == last {
                continue;
            }
            if tooth.returns != 0u {
                if length_mm > LEAST_SPAN_MM {
                    atomicAdd(&removed[tile.first_pass + p], u32(length_mm * launch.units_per_mm));
                }
                continue;
            }
            if launch.piece_room > 0u {
                for (var k = first; k < last; k++) {
                    take_piece(ray, tooth.pass_id, spans[base + k], entry, exit);
                }
            }
            var before = spans[base + first];
            before.high_mm = entry.along_mm;
            before.high_pass = tooth.pass_id;
            before.high_normal = entry.normal;
            var after = spans[base + last - 1u];
            after.low_mm = exit.along_mm;
            after.low_pass = tooth.pass_id;
            after.low_normal = exit.normal;
            let keep_before = before.high_mm - before.low_mm > LEAST_SPAN_MM;
            let keep_after = after.high_mm - after.low_mm > LEAST_SPAN_MM;
            // What is too short to keep is taken as well.
            length_mm += select(max(before.high_mm - before.low_mm, 0.0), 0.0, keep_before);
            length_mm += select(max(after.high_mm - after.low_mm, 0.0), 0.0, keep_after);
            let kept = select(0u, 1u, keep_before) + select(0u, 1u, keep_after);
            let now = count + kept - (last - first);
            if now > launch.capacity {
                atomicMax(&needs[0], now);
                return;
            }
            // Move what follows.
            if now > count {
                for (var k = count; k > last; k--) {
                    spans[base + k] = spans[base + k - 1u];
                }
            } else if now < count {
                for (var k = last; k < count; k++) {
                    spans[base + k - (count - now)] = spans[base + k];
                }
            }
            if keep_before {
                spans[base + first] = before;
            }
            if keep_after {
                spans[base + first + kept - 1u] = after;
            }
            count = now;
            atomicAdd(&removed[tile.first_pass + p], u32(round(length_mm * launch.units_per_mm)));
        }
    }
    counts[ray] = count;
}
