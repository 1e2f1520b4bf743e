// What is left on a ray of the blank, and what a pass takes of it. The stage that joins this has `spans` and, in
// `launch`, how many rays there are and for how many spans each has room. Lists lie slot by slot: neighbouring threads
// read neighbouring places.

// Shorter remnants are rounding, mm: four ulps at 70 mm.
const LEAST_SPAN_MM: f32 = 3e-5;

// Where a ray crosses the curve of a pass.
struct Crossing {
    along_mm: f32,
    normal: vec2<f32>,
}

// Spans first to last - 1 reach into a stretch of the ray, by so much in all.
struct Met {
    first: u32,
    last: u32,
    length_mm: f32,
}

// A list after a cut: its length, or what it would need if that is more than there is room for, and what was removed.
struct Left {
    count: u32,
    removed_mm: f32,
}

fn slot(ray: u32, index: u32) -> u32 {
    return index * launch.rays + ray;
}

fn met_between(ray: u32, count: u32, from_mm: f32, to_mm: f32) -> Met {
    var first = 0u;
    while first < count && spans[slot(ray, first)].high_mm <= from_mm {
        first++;
    }
    var last = first;
    var length_mm = 0.0;
    while last < count && spans[slot(ray, last)].low_mm < to_mm {
        // Near numbers: a difference of whole spans would lose the chip among them.
        let span = spans[slot(ray, last)];
        length_mm += min(span.high_mm, to_mm) - max(span.low_mm, from_mm);
        last++;
    }
    return Met(first, last, length_mm);
}

// Takes what lies between two crossings; `met` is what lies there, and something does.
fn cut_out(ray: u32, count: u32, met: Met, entry: Crossing, exit: Crossing, pass_id: u32) -> Left {
    var before = spans[slot(ray, met.first)];
    before.high_mm = entry.along_mm;
    before.high_pass = pass_id;
    before.high_normal = entry.normal;
    var after = spans[slot(ray, met.last - 1u)];
    after.low_mm = exit.along_mm;
    after.low_pass = pass_id;
    after.low_normal = exit.normal;
    let keep_before = before.high_mm - before.low_mm > LEAST_SPAN_MM;
    let keep_after = after.high_mm - after.low_mm > LEAST_SPAN_MM;
    // What is too short to keep is taken as well.
    var removed_mm = met.length_mm;
    removed_mm += select(max(before.high_mm - before.low_mm, 0.0), 0.0, keep_before);
    removed_mm += select(max(after.high_mm - after.low_mm, 0.0), 0.0, keep_after);
    let kept = select(0u, 1u, keep_before) + select(0u, 1u, keep_after);
    let now = count + kept - (met.last - met.first);
    if now > launch.capacity {
        return Left(now, removed_mm);
    }
    // Move what follows.
    if now > count {
        for (var k = count; k > met.last; k--) {
            spans[slot(ray, k)] = spans[slot(ray, k - 1u)];
        }
    } else if now < count {
        for (var k = met.last; k < count; k++) {
            spans[slot(ray, k - (count - now))] = spans[slot(ray, k)];
        }
    }
    if keep_before {
        spans[slot(ray, met.first)] = before;
    }
    if keep_after {
        spans[slot(ray, met.first + kept - 1u)] = after;
    }
    return Left(now, removed_mm);
}
