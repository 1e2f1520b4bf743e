// Where the rays of a thread enter the sweep of one segment, or its continuation: Newton's method for height and moment
// at once. Twin: crates/core/src/passes/spatial/sweep_roots.rs.

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

// Entries, and what the last step says about them.
struct Entry {
    // Above the record's start.
    h: Lanes,
    t: Lanes,
    // In the segment's frame, from its base point.
    x: Lanes,
    y: Lanes,
    step_h: Lanes,
    // The edge's residual falls along the ray: it runs into the tool.
    falls: LaneFlags,
    // How often it did not on the way.
    rises: LaneCounts,
    // How fast the ray runs into the segment, against the edge's unit normal; negative where it runs out.
    cosine: Lanes,
}

// `middle` is the direction of the tile's middle ray. A ray that runs out of the tool goes back to the height `floor`;
// one that has gone back this often is not waited for.
fn entry(record: SpatialPass, ray: Rays, middle: vec3<f32>, floor: Lanes, most_rises: u32) -> Entry {
    let start = record.place_3.w;
    // Against the tile's middle ray, both at the start height.
    var q: array<Lanes, 3>;
    q[0] = ray.o[0] + start * (ray.n[0] - middle.x);
    q[1] = ray.o[1] + start * (ray.n[1] - middle.y);
    q[2] = ray.o[2] + start * (ray.n[2] - middle.z);
    let path_r = path(record, 0u, q, ray.n);
    let path_q = path(record, 1u, q, ray.n);
    let path_y = path(record, 2u, q, ray.n);
    let lowest = floor - start;

    var h = Lanes(0.0);
    var t = Lanes(0.0);
    var step_h = Lanes(0.0);
    var falls = LaneFlags(false);
    var rises = LaneCounts(0u);
    var cosine = Lanes(0.0);
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
        cosine = determinant / moment_t * inverseSqrt(g_x * g_x + g_y * g_y);
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
        let arrived = (abs(step_h) < Lanes(LAST_STEP_MM)) & (abs(step_t) < Lanes(LAST_STEP_T));
        if all(arrived | (rises >= LaneCounts(most_rises))) {
            break;
        }
    }
    return Entry(h, t, x_last, y_last, step_h, falls, rises, cosine);
}
