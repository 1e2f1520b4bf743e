// Lowers dexels whose rays stand anywhere in space by every sweep that their tile visits.
//
// One thread per group of rows of a column, its lanes (one row on GPUs, four on software adapters:
// `shared/lanes_*.wgsl`); one workgroup row (y) per tile, so that records are read in step. Reads tiles, records, rays;
// lowers heights and passes in place; counts iterations that stopped short. Twin: crates/core/src/cut/cpu/spatial.rs;
// derivation: crates/core/src/passes/spatial/sweep.rs. Adds at most 2 nm to a height.

@group(0) @binding(0) var<storage, read> tiles: array<SpatialTile>;
@group(0) @binding(1) var<storage, read> visits: array<u32>;
@group(0) @binding(2) var<storage, read> records: array<SpatialPass>;
// Six for each group of rows: x, y, z of the origins against the tile's, x, y, z of the directions.
@group(0) @binding(3) var<storage, read> rays: array<Lanes>;
@group(0) @binding(4) var<storage, read_write> heights_mm: array<Lanes>;
@group(0) @binding(5) var<storage, read_write> passes: array<LaneCounts>;
// One for each field.
@group(0) @binding(6) var<storage, read_write> unconverged: array<atomic<u32>>;

// Rake faces turn along the tool's axis (helical gashes).
override TWISTED: bool = false;
// Newton steps at most: four suffice from the tile's middle; a ray that grazes a round halves what is missing with
// every step.
const MAX_STEPS: u32 = 24u;
// Steps below these (100 nm, and a moment that moves the blade by as little) are the last: the error after them is of
// their squares, 0.01 nm where an edge's radius is 0.5 mm.
const LAST_STEP_MM: f32 = 1e-4;
const LAST_STEP_T: f32 = 2e-6;
// Heights are held within this of the start, and moments within a sweep, so that no iterate grows beyond what f32
// holds.
const REACH_MM: f32 = 200.0;
const LARGEST_T: f32 = 1.0;

// A value that depends on height and moment, with its rates over both.
struct Varied {
    value: Lanes,
    over_h: Lanes,
    over_t: Lanes,
}

// Four rays against one record: rows r, q, y of the place (cubic in u) and of the direction (quadratic in u).
struct Path {
    place: array<Lanes, 4>,
    along: array<Lanes, 3>,
}

struct Rays {
    o: array<Lanes, 3>,
    n: array<Lanes, 3>,
}

fn path(record: SpatialPass, row: u32, q: array<Lanes, 3>, n: array<Lanes, 3>) -> Path {
    var out: Path;
    for (var k = 0u; k < 3u; k++) {
        let turn = record.turn[3u * k + row];
        out.place[k] = turn.w + (turn.x * q[0] + turn.y * q[1] + turn.z * q[2]);
        out.along[k] = turn.x * n[0] + turn.y * n[1] + turn.z * n[2];
    }
    out.place[3] = Lanes(record.place_3[row]);
    return out;
}

fn at(path: Path, h: Lanes, u: Lanes, u_t: Lanes) -> Varied {
    let along = path.along[0] + u * (path.along[1] + u * path.along[2]);
    let along_u = path.along[1] + 2.0 * u * path.along[2];
    let place = path.place[0] + u * (path.place[1] + u * (path.place[2] + u * path.place[3]));
    let place_u = path.place[1] + u * (2.0 * path.place[2] + u * (3.0 * path.place[3]));
    return Varied(place + h * along, along, u_t * (place_u + h * along_u));
}

fn mix2(a: f32, p: Varied, b: f32, q: Varied) -> Varied {
    return Varied(a * p.value + b * q.value, a * p.over_h + b * q.over_h, a * p.over_t + b * q.over_t);
}

@compute @workgroup_size(WORKGROUP_THREADS)
fn spatial_flank(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tile = tiles[group.y];
    let in_tile = group.x * WORKGROUP_THREADS + local;
    // Threads beyond the tile's last group repeat it, and write nothing: an early return would part the threads of a
    // wave.
    let at_group = tile.first_group + min(in_tile, tile.group_count - 1u);
    let there = in_tile < tile.group_count;
    var ray: Rays;
    for (var axis = 0u; axis < 3u; axis++) {
        ray.o[axis] = rays[6u * at_group + axis];
        ray.n[axis] = rays[6u * at_group + 3u + axis];
    }
    var best = heights_mm[at_group];
    var best_pass = passes[at_group];
    let low = Lanes(tile.middle.w);
    var unknown = LaneCounts(0u);

    for (var i = 0u; i < tile.visit_count; i++) {
        let record = records[tile.first_record + visits[tile.first_visit + i]];
        let start = record.place_3.w;
        // Against the tile's middle ray, both at the start height.
        var q: array<Lanes, 3>;
        q[0] = ray.o[0] + start * (ray.n[0] - tile.middle.x);
        q[1] = ray.o[1] + start * (ray.n[1] - tile.middle.y);
        q[2] = ray.o[2] + start * (ray.n[2] - tile.middle.z);
        let path_r = path(record, 0u, q, ray.n);
        let path_q = path(record, 1u, q, ray.n);
        let path_y = path(record, 2u, q, ray.n);
        let lowest = 2.0 * low - start;

        var h = Lanes(0.0);
        var t = Lanes(0.0);
        var step_h = Lanes(0.0);
        var falls = LaneFlags(false);
        var rises = LaneCounts(0u);
        var y_last = Lanes(0.0);
        var x_last = Lanes(0.0);
        for (var n = 0u; n < MAX_STEPS; n++) {
            let z = t * t;
            let u = t * (1.0 - z * (1.0 / 3.0 - 0.2 * z));
            let u_t = 1.0 - z + z * z;
            var r = at(path_r, h, u, u_t);
            var s = at(path_q, h, u, u_t);
            let y_blade = at(path_y, h, u, u_t);
            if TWISTED {
                // Turned back by the angle of the rake face at this y.
                let angle = record.twist_rad_per_mm * y_blade.value;
                let w = angle * angle;
                let sine = angle * (1.0 - w / 6.0 * (1.0 - w / 20.0 * (1.0 - w / 42.0)));
                let cosine_less_1 = -0.5 * w * (1.0 - w / 12.0 * (1.0 - w / 30.0));
                let far = r.value + record.radius_mm;
                let r_new = r.value + cosine_less_1 * far + sine * s.value;
                let s_new = s.value + cosine_less_1 * s.value - sine * far;
                let about_h = record.twist_rad_per_mm * y_blade.over_h;
                let about_t = record.twist_rad_per_mm * y_blade.over_t;
                let far_new = r_new + record.radius_mm;
                let r_h = r.over_h + cosine_less_1 * r.over_h + sine * s.over_h + about_h * s_new;
                let r_t = r.over_t + cosine_less_1 * r.over_t + sine * s.over_t + about_t * s_new;
                s = Varied(
                    s_new,
                    s.over_h + cosine_less_1 * s.over_h - sine * r.over_h - about_h * far_new,
                    s.over_t + cosine_less_1 * s.over_t - sine * r.over_t - about_t * far_new,
                );
                r = Varied(r_new, r_h, r_t);
            }
            let rho = Varied(r.value + s.value * t, r.over_h + s.over_h * t, r.over_t + s.over_t * t + s.value);
            let x = mix2(record.cos, rho, record.sin, y_blade);
            let y = mix2(record.cos, y_blade, -record.sin, rho);

            // Residual of the edge and its gradient in the segment's frame.
            var residual: Lanes;
            var g_x = Lanes(1.0);
            var g_y: Lanes;
            if record.is_arc == 1u {
                let m_x = record.curve.x;
                let m_y = record.curve.y;
                let k = record.curve.w;
                let across = x.value * (x.value + 2.0 * m_x);
                let along = y.value * (y.value + 2.0 * m_y);
                residual = k * (across + along + record.curve.z);
                g_x = 2.0 * k * (x.value + m_x);
                g_y = 2.0 * k * (y.value + m_y);
            } else {
                let c = record.curve;
                let c5 = record.curve_5;
                // Beyond its ends the polynomial goes on along its end tangents.
                let inside = clamp(y.value, Lanes(record.y_from_mm), Lanes(record.y_to_mm));
                let slope = c.x
                    + inside * (2.0 * c.y + inside * (3.0 * c.z + inside * (4.0 * c.w + inside * (5.0 * c5))));
                let edge = inside * (c.x + inside * (c.y + inside * (c.z + inside * (c.w + inside * c5))));
                residual = x.value - (edge + (y.value - inside) * slope);
                g_y = -slope;
            }

            let far = r.value + record.radius_mm;
            let half = 1.0 - z;
            let moment = s.value * half - 2.0 * t * far;
            let moment_h = s.over_h * half - 2.0 * t * r.over_h;
            let moment_t = s.over_t * half - 2.0 * t * (s.value + r.over_t) - 2.0 * far;
            let edge_h = g_x * x.over_h + g_y * y.over_h;
            let edge_t = g_x * x.over_t + g_y * y.over_t;
            let determinant = moment_h * edge_t - moment_t * edge_h;
            falls = determinant < Lanes(0.0);
            // Flatter ones graze at less than 0.2 seconds of arc.
            let divisor = select(Lanes(-1.0), min(determinant, Lanes(-1e-4)), falls);
            step_h = select(h - lowest, (moment * edge_t - moment_t * residual) / divisor, falls);
            let step_t = select(
                (moment - moment_h * step_h) / moment_t,
                (moment_h * residual - edge_h * moment) / divisor,
                falls,
            );
            rises += select(LaneCounts(1u), LaneCounts(0u), falls);
            x_last = x.value - (x.over_h * step_h + x.over_t * step_t);
            y_last = y.value - (y.over_h * step_h + y.over_t * step_t);
            h = clamp(h - step_h, Lanes(-REACH_MM), Lanes(REACH_MM));
            t = clamp(t - step_t, Lanes(-LARGEST_T), Lanes(LARGEST_T));
            if all(abs(step_h) < Lanes(LAST_STEP_MM)) && all(abs(step_t) < Lanes(LAST_STEP_T)) {
                break;
            }
        }
        let in_front = LaneFlags(record.is_arc == 0u) | (x_last + record.curve.x > Lanes(0.0));
        let on_segment = (y_last >= Lanes(record.y_from_mm))
            & (y_last <= Lanes(record.y_to_mm))
            & in_front
            & falls
            & (t > Lanes(record.t_from))
            & (t < Lanes(record.t_to));
        let converged = abs(step_h) < Lanes(LAST_STEP_MM);
        let height = start + h;
        let recorded = max(height, low);
        let lower = on_segment & converged & (height > 2.0 * low) & (recorded < best);
        unknown += select(
            LaneCounts(0u),
            LaneCounts(1u),
            on_segment & !converged & (rises < LaneCounts(2u)) & (height < best) & LaneFlags(there),
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
        atomicAdd(&unconverged[tile.field], short);
    }
}
