// Entry of four rays into one segment. Coordinates count from the segment's base point, which lies near the contact:
// they are tenths of a millimetre, so that f32 resolves a hundredth of a nanometre. Derivation:
// crates/core/src/cut/cpu/planar.rs; base points: crates/gpu/src/compose.rs.

// Newton steps at most: two suffice from the tile's middle, a dozen serve rays that graze.
const MAX_STEPS: u32 = 16u;
// A step below this (100 nm) is the last one: the error after it is its square times half the bend of the edge along
// the ray, 0.005 nm where the radius is 1 mm. The residual of a grazing ray is known to some 1e-8 mm, so its steps may
// not shrink much further.
const LAST_STEP_MM: f32 = 1e-4;
// Heights are held within this of the start, so that no iterate grows beyond what f32 holds; rays are far shorter.
const REACH_MM: f32 = 200.0;
// Smallest slope of a residual that is divided by: flatter ones graze at less than 0.2 seconds of arc.
const FLATTEST: f32 = 1e-6;

// Four rays in the segment's frame: place at the start height, and direction.
struct Rays {
    x: vec4<f32>,
    y: vec4<f32>,
    nx: vec4<f32>,
    ny: vec4<f32>,
}

// Heights above the start height, whether each is an entry on the segment, and whether its iteration stopped short.
struct Entries {
    height_mm: vec4<f32>,
    hit: vec4<bool>,
    unconverged: vec4<bool>,
}

// Falling root of x + k nx - U(y + k ny), U the record's polynomial. Where the residual rises, the search goes back to
// `lowest_mm`, counted from the start height, where it falls if there is any entry above at all; a ray that gets there
// twice has passed the bottom of a residual without roots and misses the segment.
fn enter_curve(rays: Rays, record: FlankPass, lowest_mm: f32) -> Entries {
    let c = record.curve;
    let c5 = record.curve_5;
    var k = vec4<f32>(0.0);
    var rate = vec4<f32>(0.0);
    var step = vec4<f32>(0.0);
    var went_back = vec4<bool>(false);
    for (var i = 0u; i < MAX_STEPS; i++) {
        let y = rays.y + k * rays.ny;
        // Beyond its ends the polynomial goes on along its end tangents.
        let t = clamp(y, vec4(record.y_from_mm), vec4(record.y_to_mm));
        let slope = c.x + t * (2.0 * c.y + t * (3.0 * c.z + t * (4.0 * c.w + t * (5.0 * c5))));
        let x = t * (c.x + t * (c.y + t * (c.z + t * (c.w + t * c5)))) + (y - t) * slope;
        rate = rays.nx - slope * rays.ny;
        let divisor = select(rate, vec4(FLATTEST), abs(rate) < vec4(FLATTEST));
        let rises = rate >= vec4(0.0);
        let back = select(k - vec4(lowest_mm), vec4(0.0), went_back);
        step = select((rays.x + k * rays.nx - x) / divisor, back, rises);
        went_back |= rises;
        k = clamp(k - step, vec4(-REACH_MM), vec4(REACH_MM));
        if all(abs(step) < vec4(LAST_STEP_MM)) {
            break;
        }
    }
    let y = rays.y + k * rays.ny;
    let on_segment = (y >= vec4(record.y_from_mm)) & (y <= vec4(record.y_to_mm)) & (rate < vec4(0.0));
    let converged = abs(step) < vec4(LAST_STEP_MM);
    return Entries(k, on_segment & converged, on_segment & !converged);
}

// First root of a circle, without cancellation where the ray points at it: q (q + 2 m) + excess, with m from the centre
// to the base point.
fn enter_arc(rays: Rays, record: FlankPass) -> Entries {
    let m_x = record.curve.x;
    let m_y = record.curve.y;
    let b = rays.nx * (rays.x + m_x) + rays.ny * (rays.y + m_y);
    let c = rays.x * (rays.x + 2.0 * m_x) + rays.y * (rays.y + 2.0 * m_y) + record.curve.z;
    let discriminant = b * b - c;
    let root = sqrt(max(discriminant, vec4(0.0)));
    let towards = b < vec4(0.0);
    let k = select(-b - root, c / select(vec4(1.0), root - b, towards), towards);
    let y = rays.y + k * rays.ny;
    let hit = (discriminant > vec4(0.0))
        & (y >= vec4(record.y_from_mm))
        & (y <= vec4(record.y_to_mm))
        & (rays.x + k * rays.nx + m_x > vec4(0.0));
    return Entries(k, hit, vec4<bool>(false));
}
