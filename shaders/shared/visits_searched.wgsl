// A part of a patch visits those of the patch's records that nine of its rays do not rule out.
//
// The law is that of crates/core/src/passes/spatial/sweep_bounds.rs with bounds of heights instead of their
// differences: between nine rays, first, middle and last column by first, middle and last row, a smooth function leaves
// its values by no more than its second differences say. The lowest height that a sweep can have is held against the
// height that the surface left is below everywhere: that of the dexels so far, or the highest one of a sweep that surely
// enters all rays through its own segment. What the rays do not decide is visited. A workgroup is one part; its threads
// are nine rays by fourteen records at a time.

// The records of a patch are searched; otherwise the host has listed those to visit, as for software adapters.
override SEARCHED: bool = false;

const SIDE: u32 = 3u;
const RAYS: u32 = 9u;
const TOGETHER: u32 = WORKGROUP_THREADS / RAYS;
// Records that a launch visits at most: the host's number.
const ROUND_RECORDS: u32 = 1024u;
// Fewer records cost less than their samples.
const FEW_RECORDS: u32 = 6u;
// Safety on second differences; how far heights rise over the highest of nine, as a share of their range; the least
// cosine of a sure entry, and that of a ray that runs out of the tool; how far below the floor all is clear, as a share
// of the range and as a length: all as natively.
const BEND_SAFETY: f32 = 1.5;
const UPPER_SHARE: f32 = 2.0;
const GRAZING_COSINE: f32 = 0.1;
const LEAVING_COSINE: f32 = 0.05;
const FLOOR_SHARE: f32 = 0.2;
const FLOOR_MM: f32 = 1e-3;
// No root further away is one.
const FARTHEST_MM: f32 = 150.0;
// A ray that has gone back to the floor this often is not waited for.
const MOST_RISES: u32 = 4u;
// Heights are computed to 2 nm, places along an edge to some 10 nm.
const MARGIN_MM: f32 = 1e-5;
const END_MARGIN_MM: f32 = 1e-4;
const HIGHEST_MM: f32 = 3e38;

// One entry: height and place along the segment; whether it is sure, or the ray has run out of the tool.
struct Sample {
    height_mm: f32,
    y_mm: f32,
    is_sure: bool,
    is_out: bool,
}

var<workgroup> samples: array<Sample, WORKGROUP_THREADS>;
// The lowest height that a record can have on the part.
var<workgroup> lower_mm: array<f32, ROUND_RECORDS>;
// In the order of unsigned numbers: the highest dexel, and a height that the surface left is below everywhere.
var<workgroup> highest_dexel: atomic<u32>;
var<workgroup> upper: atomic<u32>;

// Bits of a number that order as the number does.
fn ordered(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return select(bits | 0x80000000u, ~bits, (bits & 0x80000000u) != 0u);
}

fn from_ordered(bits: u32) -> f32 {
    return bitcast<f32>(select(~bits, bits & 0x7fffffffu, (bits & 0x80000000u) != 0u));
}

// First, middle or last of some lines.
fn line(which: u32, count: u32) -> u32 {
    return (which * (count - 1u)) / 2u;
}

// Weights of three values on such lines whose sum is how far a function of second degree leaves straight lines between
// them.
fn bend_weights(count: u32) -> vec3<f32> {
    if count <= 2u {
        return vec3<f32>(0.0);
    }
    let a = f32(line(1u, count));
    let b = f32(count - 1u) - a;
    let far = max(a, b);
    let scale = 0.25 * far * far / (a + b);
    return vec3<f32>(scale / a, -scale * (1.0 / a + 1.0 / b), scale / b);
}

fn bend(values: array<f32, RAYS>, across: vec3<f32>, along: vec3<f32>) -> f32 {
    var v = values;
    var most_across = 0.0;
    var most_along = 0.0;
    for (var i = 0u; i < SIDE; i++) {
        most_across = max(most_across, abs(dot(across, vec3<f32>(v[i], v[SIDE + i], v[2u * SIDE + i]))));
        most_along = max(most_along, abs(dot(along, vec3<f32>(v[SIDE * i], v[SIDE * i + 1u], v[SIDE * i + 2u]))));
    }
    return most_across + most_along;
}

fn sampled(record: SpatialPass, ray: Rays, tile: SpatialTile) -> Sample {
    let found = entry(record, ray, tile.middle.xyz, 2.0 * tile.middle.w, MOST_RISES);
    let arrived = abs(found.step_h) < LAST_STEP_MM;
    let height_mm = record.place_3.w + found.h;
    let in_front = record.is_arc == 0u || found.x + record.curve.x > 0.0;
    let is_sure = found.falls
        && arrived
        && in_front
        && abs(found.t) < LARGEST_T
        && abs(found.h) < FARTHEST_MM
        && found.cosine >= GRAZING_COSINE;
    return Sample(height_mm, found.y, is_sure, !found.falls && arrived && found.cosine < -LEAVING_COSINE);
}

// Lower bound of a record from its nine samples, and the upper bound of all.
fn bounded(record: SpatialPass, first: u32, low: f32, across: vec3<f32>, along: vec3<f32>) -> f32 {
    var heights: array<f32, RAYS>;
    var places: array<f32, RAYS>;
    var lowest = vec2<f32>(HIGHEST_MM);
    var highest = vec2<f32>(-HIGHEST_MM);
    var are_sure = true;
    var are_out = true;
    for (var i = 0u; i < RAYS; i++) {
        let sample = samples[first + i];
        heights[i] = sample.height_mm;
        places[i] = sample.y_mm;
        lowest = min(lowest, vec2<f32>(sample.height_mm, sample.y_mm));
        highest = max(highest, vec2<f32>(sample.height_mm, sample.y_mm));
        are_sure = are_sure && sample.is_sure;
        are_out = are_out && sample.is_out;
    }
    if are_out {
        return HIGHEST_MM;
    }
    // Where a sweep ends within the part rays may miss it.
    if !are_sure || record.t_from > -LARGEST_T || record.t_to < LARGEST_T {
        return -HIGHEST_MM;
    }
    let range_mm = highest.x - lowest.x;
    if lowest.x <= 2.0 * low {
        return select(-HIGHEST_MM, HIGHEST_MM, highest.x < 2.0 * low - FLOOR_SHARE * range_mm - FLOOR_MM);
    }
    let off_mm = BEND_SAFETY * bend(places, across, along) + END_MARGIN_MM;
    if lowest.y - off_mm > record.y_to_mm || highest.y + off_mm < record.y_from_mm {
        return HIGHEST_MM;
    }
    let bend_mm = BEND_SAFETY * bend(heights, across, along);
    if lowest.y - off_mm > record.y_from_mm && highest.y + off_mm < record.y_to_mm {
        atomicMin(&upper, ordered(highest.x + max(bend_mm, UPPER_SHARE * range_mm)));
    }
    return lowest.x - bend_mm - MARGIN_MM;
}

// A height that the part is left below everywhere; records that cannot come lower are clear of it.
fn search(tile: SpatialTile, best: f32, local: u32) -> f32 {
    if !SEARCHED || tile.visit_count <= FEW_RECORDS {
        return HIGHEST_MM;
    }
    if local == 0u {
        atomicStore(&highest_dexel, 0u);
        atomicStore(&upper, ordered(HIGHEST_MM));
    }
    workgroupBarrier();
    atomicMax(&highest_dexel, ordered(best));
    let columns = tile.group_count / tile.rows;
    let across = bend_weights(columns);
    let along = bend_weights(tile.rows);
    let which = local % RAYS;
    let in_part = line(which / SIDE, columns) * tile.rows + line(which % SIDE, tile.rows);
    let ray = ray_of(tile.first_group + in_part);
    for (var first = 0u; first < tile.visit_count; first += TOGETHER) {
        let own = first + local / RAYS;
        if local < TOGETHER * RAYS && own < tile.visit_count {
            samples[local] = sampled(records[visit(tile, own)], ray, tile);
        }
        workgroupBarrier();
        let evaluated = first + local;
        if local < TOGETHER && evaluated < tile.visit_count {
            let record = records[visit(tile, evaluated)];
            lower_mm[evaluated] = bounded(record, RAYS * local, tile.middle.w, across, along);
        }
        workgroupBarrier();
    }
    // What is lower than rays record is recorded at that height, by whichever pass comes first.
    return max(min(from_ordered(atomicLoad(&upper)), from_ordered(atomicLoad(&highest_dexel))), tile.middle.w);
}

// Whether a record cannot lower a part that is left below this height.
fn is_clear(i: u32, below_mm: f32) -> bool {
    return SEARCHED && lower_mm[i] > below_mm;
}

// Record of a visit.
fn visit(tile: SpatialTile, i: u32) -> u32 {
    if SEARCHED {
        return tile.first_record + i;
    }
    return tile.first_record + visits[tile.first_visit + i];
}

fn count_visits(tile: SpatialTile, visited: u32) {
    if SEARCHED {
        atomicAdd(&counts[2u * tile.field + 1u], tile.group_count * visited);
    }
}
