// Takes passes from rays through the blank, in order of time.
//
// One thread per ray, one workgroup per tile. A pass is a closed outline where it stands in one slice: a cutter tooth
// in one stroke, or the section of a hob tooth's sweep. Reads launch, tiles, visits, passes, outlines; rewrites spans
// and rays; adds what every pass removed, in fixed point, so that the sum does not depend on the order of threads;
// keeps the longest material that a return stroke met on a ray of the tile; lists the pieces that were taken, in any
// order, if the host asks for them. A list that has no room says how much it needs, and the host comes back with more.
// Twins: crates/core/src/cut/cpu/blank.rs (derivation there) and blank_sweeps.rs. Adds at most four ulps at the blank's
// radius to an end that its ray meets at 45 degrees or steeper.
//
// An outline is a chain of cubics in runs, whose chords bound what it encloses on a ray. Of a hundred pairs of ray and
// pass a few find material within the bounds; only they go round the pieces of the runs near the ray, with places
// across it: a piece that turns back there is split at its turning point. Neighbours share the bits of their node, so
// that crossings come in pairs in spite of rounding.

@group(0) @binding(0) var<uniform> launch: BlankLaunch;
@group(0) @binding(1) var<storage, read> tiles: array<BlankTile>;
@group(0) @binding(2) var<storage, read> visits: array<u32>;
@group(0) @binding(3) var<storage, read> passes: array<BlankPass>;
@group(0) @binding(4) var<storage, read> outline: array<OutlinePiece>;
@group(0) @binding(5) var<storage, read_write> spans: array<BlankSpan>;
@group(0) @binding(6) var<storage, read_write> rays: array<RayState>;
// Largest list that had no room; most crossings of one outline that had none; spans of all rays (for the way back);
// pieces that were taken. Then one for each tile: bits of the longest material that a return stroke met, mm. Then per
// account and family two, low and high: length removed, in the tile's units.
@group(0) @binding(7) var<storage, read_write> ledger: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> pieces: array<BlankPiece>;

const WORKGROUP_THREADS: u32 = 64u;
// Crossings of one outline with one ray: two as a rule, four at a slanting tooth; more are reported, never left out.
const MOST_CROSSINGS: u32 = 8u;
// Newton steps within a part, each inside its bracket; a step below the last one ends them.
const STEPS: u32 = 12u;
const LAST_STEP: f32 = 1e-6;
// What rounding may move a place along by, mm.
const ALONG_ERROR_MM: f32 = 1e-4;
// Heads of the ledger before those of tiles.
const LEDGER_HEAD: u32 = 4u;

// Axes of the rays: along, across.
fn turned(v: vec2<f32>, shape: BlankPass, family: u32) -> vec2<f32> {
    let x = shape.cos * v.x - shape.sin * v.y;
    let y = shape.sin * v.x + shape.cos * v.y;
    return select(vec2(x, y), vec2(y, x), family == 1u);
}

// Where a piece starts, along and across, from the outline's centre; the one after the last is the first.
fn node(shape: BlankPass, piece: u32, family: u32) -> vec2<f32> {
    let index = select(piece, 0u, piece == shape.piece_count);
    return turned(outline[shape.first_piece + index].node_mm, shape, family);
}

// Pieces of the run that begins at a piece.
fn run_pieces(shape: BlankPass, piece: u32) -> u32 {
    return outline[shape.first_piece + piece].run & 0xffu;
}

// A run beside a ray.
struct Run {
    // Whether it may meet the ray, and between which places then.
    is_near: bool,
    low_mm: f32,
    high_mm: f32,
}

// The run that begins at a piece: no further from its chord than its reach, rounding included.
fn placed_run(shape: BlankPass, first: u32, family: u32, offset_mm: f32) -> Run {
    let start = node(shape, first, family) + vec2(0.0, offset_mm);
    let end = node(shape, first + run_pieces(shape, first), family) + vec2(0.0, offset_mm);
    let reach_mm = bitcast<f32>(outline[shape.first_piece + first].run & 0xffffff00u);
    let is_near = min(start.y, end.y) <= reach_mm && max(start.y, end.y) >= -reach_mm;
    let low_mm = min(start.x, end.x);
    let high_mm = max(start.x, end.x);
    let slope = (end.x - start.x) / select(end.y - start.y, 1e-30, end.y == start.y);
    let at_mm = clamp(start.x - start.y * slope, low_mm, high_mm);
    let along_mm = reach_mm * min(1.0 + abs(slope), 1e6);
    return Run(
        is_near,
        max(at_mm - along_mm, low_mm - reach_mm) - ALONG_ERROR_MM,
        min(at_mm + along_mm, high_mm + reach_mm) + ALONG_ERROR_MM,
    );
}

// Parameter at which the rate of a cubic vanishes, its ends having rates of opposite signs.
fn turning(run: f32, rate_start: f32, rate_end: f32) -> f32 {
    let a = 3.0 * (rate_start + rate_end - 2.0 * run);
    let half_b = 3.0 * run - 2.0 * rate_start - rate_end;
    let root = sqrt(max(half_b * half_b - a * rate_start, 0.0));
    // The root between the ends is the one at which the rate goes over from the first sign to the other: without
    // cancellation in either form.
    let towards = select(-root, root, rate_start < 0.0);
    let alike = (half_b < 0.0) == (towards < 0.0);
    let sum = half_b + towards;
    let difference = towards - half_b;
    let by_sum = -rate_start / select(sum, 1e-30, sum == 0.0);
    let by_difference = difference / select(a, 1e-30, a == 0.0);
    return clamp(select(by_difference, by_sum, alike), 0.0, 1.0);
}

fn cubic(start: f32, run: f32, rate_start: f32, rate_end: f32, t: f32) -> f32 {
    let c2 = 3.0 * run - 2.0 * rate_start - rate_end;
    let c3 = rate_start + rate_end - 2.0 * run;
    return start + t * (rate_start + t * (c2 + t * c3));
}

fn cubic_rate(run: f32, rate_start: f32, rate_end: f32, t: f32) -> f32 {
    let c2 = 3.0 * run - 2.0 * rate_start - rate_end;
    let c3 = rate_start + rate_end - 2.0 * run;
    return rate_start + t * (2.0 * c2 + t * 3.0 * c3);
}

// The crossing of a part of a piece that runs from one side of the ray to the other. Part 0: the whole; 1: up to where
// it turns; 2: from there on.
fn cross_part(shape: BlankPass, piece: u32, part: u32, family: u32, offset_mm: f32, center_mm: f32) -> Crossing {
    let own = outline[shape.first_piece + piece];
    let after = select(piece + 1u, 0u, piece + 1u == shape.piece_count);
    let start = turned(own.node_mm, shape, family);
    let run = turned(outline[shape.first_piece + after].node_mm, shape, family) - start;
    let rate_from = turned(own.rate_start, shape, family);
    let rate_to = turned(own.rate_end, shape, family);
    let across = start.y + offset_mm;
    var ends = vec2(0.0, 1.0);
    if part != 0u {
        let middle = turning(run.y, rate_from.y, rate_to.y);
        ends = select(vec2(middle, 1.0), vec2(0.0, middle), part == 1u);
    }
    let first = cubic(across, run.y, rate_from.y, rate_to.y, ends.x);
    let last = cubic(across, run.y, rate_from.y, rate_to.y, ends.y);
    // Parameters below and above the root.
    var low = select(ends.y, ends.x, last > first);
    var high = select(ends.x, ends.y, last > first);
    let rise = last - first;
    var t = clamp(ends.x - first * (ends.y - ends.x) / select(rise, 1e-30, rise == 0.0), ends.x, ends.y);
    for (var step = 0u; step < STEPS; step++) {
        let residual = cubic(across, run.y, rate_from.y, rate_to.y, t);
        if residual > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let slope = cubic_rate(run.y, rate_from.y, rate_to.y, t);
        let newton = t - residual / select(slope, 1e-30, slope == 0.0);
        let next = select(0.5 * (low + high), newton, (newton - low) * (newton - high) <= 0.0);
        let moved = abs(next - t);
        t = next;
        if moved < LAST_STEP {
            break;
        }
    }
    let tangent = vec2(cubic_rate(run.x, rate_from.x, rate_to.x, t), cubic_rate(run.y, rate_from.y, rate_to.y, t));
    let length = max(sqrt(dot(tangent, tangent)), 1e-30);
    return Crossing(center_mm + cubic(start.x, run.x, rate_from.x, rate_to.x, t), vec2(-tangent.y, tangent.x) / length);
}

// Lists what a pass takes of a span.
fn take_piece(ray: u32, pass_id: u32, span: BlankSpan, entry: Crossing, exit: Crossing) {
    let place = atomicAdd(&ledger[3], 1u);
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

// Adds to a pair of low and high.
fn record_removed(at: u32, units: u32) {
    let before = atomicAdd(&ledger[at], units);
    if before + units < before {
        atomicAdd(&ledger[at + 1u], 1u);
    }
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn blank_rays(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let tile = tiles[group.x];
    if local >= tile.ray_count {
        return;
    }
    let ray = tile.first_ray + local;
    let place = rays[ray].place;
    var count = rays[ray].count;
    if count == NO_ROOM {
        return;
    }
    for (var v = 0u; v < tile.visit_count; v++) {
        let pass_index = visits[tile.first_visit + v];
        let place_of_pass = passes[pass_index].center;
        let center = select(place_of_pass, place_of_pass.yx, tile.family == 1u);
        // Whole units: exact.
        let offset_mm = f32(center.y - place) * launch.mm_per_unit;
        if abs(offset_mm) > launch.reach_mm {
            continue;
        }
        let center_mm = f32(center.x) * launch.mm_per_unit;
        let shape = passes[pass_index];

        // What the outline encloses on the ray lies between these places.
        var low_mm = 1e30;
        var high_mm = -1e30;
        for (var r = 0u; r < shape.piece_count; r += run_pieces(shape, r)) {
            let run = placed_run(shape, r, tile.family, offset_mm);
            if run.is_near {
                low_mm = min(low_mm, run.low_mm);
                high_mm = max(high_mm, run.high_mm);
            }
        }
        let near = met_between(ray, count, center_mm + low_mm, center_mm + high_mm);
        if near.first == near.last {
            continue;
        }

        // Pieces that cross the ray, with their parts.
        var crossed: array<u32, MOST_CROSSINGS>;
        var met = 0u;
        for (var r = 0u; r < shape.piece_count; r += run_pieces(shape, r)) {
            if !placed_run(shape, r, tile.family, offset_mm).is_near {
                continue;
            }
            let run_end = r + run_pieces(shape, r);
            var start = node(shape, r, tile.family).y + offset_mm;
            for (var p = r; p < run_end; p++) {
                let end = node(shape, p + 1u, tile.family).y + offset_mm;
                let start_below = start <= 0.0;
                let end_below = end <= 0.0;
                let own = outline[shape.first_piece + p];
                if start_below != end_below || min(abs(start), abs(end)) <= own.sagitta_mm {
                    let rate_from = turned(own.rate_start, shape, tile.family).y;
                    let rate_to = turned(own.rate_end, shape, tile.family).y;
                    var parts = vec2(0u, 0u);
                    var found = select(0u, 1u, start_below != end_below);
                    if rate_from * rate_to < 0.0 {
                        let run = end - start;
                        let turn = turning(run, rate_from, rate_to);
                        let middle_below = cubic(start, run, rate_from, rate_to, turn) <= 0.0;
                        parts = select(vec2(2u, 2u), vec2(1u, 2u), start_below != middle_below);
                        found = select(0u, 1u, start_below != middle_below) + select(0u, 1u, middle_below != end_below);
                    }
                    for (var k = 0u; k < found; k++) {
                        if met < MOST_CROSSINGS {
                            crossed[met] = 4u * p + select(parts.y, parts.x, k == 0u);
                        }
                        met++;
                    }
                }
                start = end;
            }
        }
        if met > MOST_CROSSINGS {
            atomicMax(&ledger[1], met);
            continue;
        }

        var found: array<Crossing, MOST_CROSSINGS>;
        for (var c = 0u; c < met; c++) {
            let piece = crossed[c] / 4u;
            let crossing = cross_part(shape, piece, crossed[c] % 4u, tile.family, offset_mm, center_mm);
            var at = c;
            while at > 0u && found[at - 1u].along_mm > crossing.along_mm {
                found[at] = found[at - 1u];
                at--;
            }
            found[at] = crossing;
        }
        for (var c = 0u; c + 1u < met; c += 2u) {
            let material = met_between(ray, count, found[c].along_mm, found[c + 1u].along_mm);
            if material.first == material.last {
                continue;
            }
            if shape.account == NO_ACCOUNT {
                if material.length_mm > LEAST_SPAN_MM {
                    atomicMax(&ledger[LEDGER_HEAD + group.x], bitcast<u32>(material.length_mm));
                }
                continue;
            }
            if launch.piece_room > 0u {
                for (var k = material.first; k < material.last; k++) {
                    take_piece(ray, shape.pass_id, spans[slot(ray, k)], found[c], found[c + 1u]);
                }
            }
            let left = cut_out(ray, count, material, found[c], found[c + 1u], shape.pass_id);
            if left.count > launch.capacity {
                atomicMax(&ledger[0], left.count);
                rays[ray].count = NO_ROOM;
                return;
            }
            count = left.count;
            let account = 2u * (2u * shape.account + tile.family);
            record_removed(LEDGER_HEAD + groups.x + account, u32(round(left.removed_mm * tile.units_per_mm)));
        }
    }
    rays[ray].count = count;
}
