//! Where the centre of a wire runs beside a profile.
//!
//! In: the profile as a closed chain, the distance of the wire's centre from it, and how far the wire may come nearer.
//! Out: the centre's path, closed.
//!
//! **Law.** The chain moved aside, with arcs round corners that are sharp on the wire's side. Where the profile is more
//! hollow than the wire, both sides of the hollow move across each other: what lies between is nearer to the profile
//! than the wire may come. It is left out, and the path turns where both sides cross. So the wire leaves material in
//! hollows and never cuts into the gear; how much it leaves is what [`super::wire`] looks at.
//!
//! Road not taken: a refusal of every place that comes too near. Marks of a cut profile are hollows of no radius at
//! their feet, however low they are, and so are the corners of a sector's dwell.

use crate::measure::target_outline::TargetOutline;
use glam::DVec2;

/// A chain turns by more than this at corners, rad; round them the wire goes in steps of at most so much.
const CORNER_RAD: f64 = 0.2;
const CORNER_STEP_RAD: f64 = 0.04;
/// Points of either side of a hollow that are looked at beyond those that are too near: the sides cross a little before
/// a point is as near as the tolerance.
const POINTS_BEYOND: usize = 8;

/// The closed path of the centre `offset_mm` beside a chain in the air, from the place beside the chain's first point
/// on. No place of it is nearer to the profile than `nearest_mm`; none where the first one would be.
pub fn centre_path(chain_mm: &[DVec2], outline: &TargetOutline, offset_mm: f64, nearest_mm: f64) -> Option<Vec<DVec2>> {
    let moved = offset_chain(chain_mm, outline.back().kind.tip_sign() * offset_mm);
    let is_clear = |p: &DVec2| outline.distance_mm(*p, 2.0 * offset_mm).is_none_or(|far| far >= nearest_mm);
    let clear: Vec<bool> = moved.iter().map(is_clear).collect();
    if !clear[0] {
        return None;
    }
    let closed = [&moved[..], &moved[..1]].concat();
    let mut path: Vec<DVec2> = Vec::with_capacity(closed.len());
    // The first point of `closed` that is not in the path yet, and the first one that the path may be cut back to.
    let (mut next, mut kept) = (0, 0);
    while next < closed.len() {
        if clear[next % moved.len()] {
            path.push(closed[next]);
            next += 1;
            continue;
        }
        let end = (next..closed.len()).find(|&i| clear[i % moved.len()]).unwrap_or(closed.len() - 1);
        let before = POINTS_BEYOND.min(path.len() - kept);
        let one: Vec<DVec2> = [&path[path.len() - before..], &closed[next..end]].concat();
        let last = (end + POINTS_BEYOND).min(closed.len());
        let other = &closed[next..last];
        let Some((i, j, at_mm)) = crossing(&one, other, before, is_clear) else {
            next = end;
            kept = path.len();
            continue;
        };
        path.truncate(path.len() - before + (i + 1).min(before));
        path.push(at_mm);
        kept = path.len() - 1;
        next += j + 1;
    }
    Some(path)
}

/// Where a chain first crosses another one, which goes on with it from its point `shared` on, at a place that is clear:
/// the segments of both, and the place.
fn crossing(
    one: &[DVec2],
    other: &[DVec2],
    shared: usize,
    is_clear: impl Fn(&DVec2) -> bool,
) -> Option<(usize, usize, DVec2)> {
    for (i, ends) in one.windows(2).enumerate() {
        // Segment i of the one is segment i - shared of the other; the next one begins where it ends.
        let first = (i + 2).saturating_sub(shared);
        for j in (first..other.len().saturating_sub(1)).rev() {
            if let Some(at_mm) = meeting([ends[0], ends[1]], [other[j], other[j + 1]]).filter(&is_clear) {
                return Some((i, j, at_mm));
            }
        }
    }
    None
}

/// Where two segments cross.
fn meeting([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let (along, across) = (b - a, d - c);
    let turn = along.perp_dot(across);
    let share = (c - a).perp_dot(across) / turn;
    let other = (c - a).perp_dot(along) / turn;
    let inside = |share: f64| (0.0..=1.0).contains(&share);
    (inside(share) && inside(other)).then(|| a + share * along)
}

/// The closed chain moved aside to its right by `right_mm`, with arcs round corners that are sharp on that side.
fn offset_chain(chain: &[DVec2], right_mm: f64) -> Vec<DVec2> {
    let count = chain.len();
    let mut moved = Vec::with_capacity(count);
    for (i, &point) in chain.iter().enumerate() {
        let before = (point - chain[(i + count - 1) % count]).normalize_or_zero();
        let after = (chain[(i + 1) % count] - point).normalize_or_zero();
        let turn = before.angle_to(after);
        let aside = |along: DVec2| -right_mm * along.perp();
        if turn.abs() <= CORNER_RAD {
            moved.push(point + aside((before + after).normalize_or_zero()));
            continue;
        }
        // A corner that is hollow on the wire's side gives both ends; what lies between is too near.
        let steps = if turn * right_mm > 0.0 { (turn.abs() / CORNER_STEP_RAD).ceil() as u32 } else { 1 };
        moved.extend((0..=steps).map(|step| {
            let along = DVec2::from_angle(turn * f64::from(step) / f64::from(steps)).rotate(before);
            point + aside(along)
        }));
    }
    moved
}
