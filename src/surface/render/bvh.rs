//! Which triangle a ray meets first: a tree of boxes over triangles.
//!
//! Binned surface-area heuristic (Wald, 2007), twelve bins per axis, leaves of at most four triangles; triangles by Möller and Trumbore (1997). Everything is f64 and the tree depends on the triangles
//! and nothing else, so that the same mesh gives the same picture.
//!
//! Road not taken: a crate. Those that fit are fast through single precision and SIMD, which this renderer does not need, or bring a second linear algebra along.

use glam::DVec3;

const BINS: usize = 12;
const LEAF: usize = 4;

/// Tree over the triangles of a scene.
#[derive(Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// Corner and the two edges from it, in the order of the leaves.
    triangles: Vec<[DVec3; 3]>,
    /// Number of the triangle as it was given.
    numbers: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// First triangle of a leaf, or the right child (the left one follows its parent).
    link: u32,
    /// Triangles of a leaf; 0 on inner nodes.
    count: u32,
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance along the ray's direction, mm for unit directions.
    pub distance_mm: f64,
    /// Number of the triangle.
    pub triangle: u32,
    /// Weights of the second and third corner.
    pub weights: [f64; 2],
}

#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn half_area(self) -> f64 {
        let d = (self.high - self.low).max(DVec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

impl Bvh {
    /// Tree over triangles given by their corners.
    pub fn new(corners_mm: &[[DVec3; 3]]) -> Self {
        let bounds: Vec<Bounds> =
            corners_mm.iter().map(|[a, b, c]| Bounds { low: a.min(*b).min(*c), high: a.max(*b).max(*c) }).collect();
        let mut order: Vec<u32> = (0..corners_mm.len() as u32).collect();
        let mut nodes = Vec::with_capacity(corners_mm.len());
        if !order.is_empty() {
            build(&bounds, &mut order, 0, &mut nodes);
        }
        let triangles = order
            .iter()
            .map(|&i| {
                let [a, b, c] = corners_mm[i as usize];
                [a, b - a, c - a]
            })
            .collect();
        Self { nodes, triangles, numbers: order }
    }

    /// First triangle along a ray, within `limit_mm`; both sides of triangles count.
    pub fn first(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64) -> Option<Hit> {
        self.walk(origin_mm, direction, limit_mm, false)
    }

    /// Whether anything stands within `limit_mm`.
    pub fn is_blocked(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64) -> bool {
        self.walk(origin_mm, direction, limit_mm, true).is_some()
    }

    fn walk(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64, any: bool) -> Option<Hit> {
        // Never infinite: zero times infinity would lose boxes that the ray runs along.
        let inverse = direction.map(|d| if d.abs() < 1e-300 { 1e300 } else { 1.0 / d });
        let mut best: Option<Hit> = None;
        let mut limit_mm = limit_mm;
        let mut stack = [0_u32; 64];
        let mut depth = 0;
        let mut index = 0;
        if self.nodes.is_empty() || entry(&self.nodes[0], origin_mm, inverse, limit_mm).is_none() {
            return None;
        }
        loop {
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for i in node.link..node.link + node.count {
                    if let Some((distance_mm, weights)) = meet(&self.triangles[i as usize], origin_mm, direction)
                        && distance_mm > 0.0
                        && distance_mm < limit_mm
                    {
                        limit_mm = distance_mm;
                        best = Some(Hit { distance_mm, triangle: self.numbers[i as usize], weights });
                        if any {
                            return best;
                        }
                    }
                }
            } else {
                let children = [index + 1, node.link];
                let entries = children.map(|c| entry(&self.nodes[c as usize], origin_mm, inverse, limit_mm));
                let (near, far) = match entries {
                    [Some(a), Some(b)] if a <= b => (Some(children[0]), Some(children[1])),
                    [Some(_), Some(_)] => (Some(children[1]), Some(children[0])),
                    [Some(_), None] => (Some(children[0]), None),
                    [None, Some(_)] => (Some(children[1]), None),
                    [None, None] => (None, None),
                };
                if let Some(far) = far {
                    stack[depth] = far;
                    depth += 1;
                }
                if let Some(near) = near {
                    index = near;
                    continue;
                }
            }
            loop {
                if depth == 0 {
                    return best;
                }
                depth -= 1;
                index = stack[depth];
                // The limit may have come closer since the node was put aside.
                if entry(&self.nodes[index as usize], origin_mm, inverse, limit_mm).is_some() {
                    break;
                }
            }
        }
    }
}

/// Builds the node over `order[..]`, whose first place in the whole is `first`; returns its index.
fn build(bounds: &[Bounds], order: &mut [u32], first: u32, nodes: &mut Vec<Node>) -> u32 {
    let whole = order.iter().fold(Bounds::EMPTY, |all, &i| all.with(bounds[i as usize]));
    let index = nodes.len();
    nodes.push(Node { low: whole.low, high: whole.high, link: first, count: order.len() as u32 });
    // Depth stays below the walker's stack: splits by the median are taken where the heuristic finds none.
    if order.len() <= LEAF {
        return index as u32;
    }
    let center = |i: u32| 0.5 * (bounds[i as usize].low + bounds[i as usize].high);
    let centers = order.iter().fold(Bounds::EMPTY, |all, &i| all.with(Bounds { low: center(i), high: center(i) }));
    let split = best_split(bounds, order, centers).map(|(axis, plane)| {
        let mut middle = 0;
        for k in 0..order.len() {
            if center(order[k])[axis] < plane {
                order.swap(k, middle);
                middle += 1;
            }
        }
        middle
    });
    let small = order.len() / 16;
    let middle = match split {
        Some(middle) if middle > small && order.len() - middle > small => middle,
        _ => {
            let extent = centers.high - centers.low;
            let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
            order.sort_unstable_by(|&a, &b| center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b)));
            order.len() / 2
        }
    };
    let (left, right) = order.split_at_mut(middle);
    build(bounds, left, first, nodes);
    let link = build(bounds, right, first + middle as u32, nodes);
    nodes[index].link = link;
    nodes[index].count = 0;
    index as u32
}

/// Axis and plane of the cheapest split of the bins.
fn best_split(bounds: &[Bounds], order: &[u32], centers: Bounds) -> Option<(usize, f64)> {
    let mut best: Option<(f64, usize, f64)> = None;
    for axis in 0..3 {
        let (low, width) = (centers.low[axis], centers.high[axis] - centers.low[axis]);
        if width <= 0.0 {
            continue;
        }
        let mut bins = [(Bounds::EMPTY, 0_u32); BINS];
        for &i in order {
            let b = bounds[i as usize];
            let share = (0.5 * (b.low[axis] + b.high[axis]) - low) / width;
            let bin = &mut bins[((share * BINS as f64) as usize).min(BINS - 1)];
            *bin = (bin.0.with(b), bin.1 + 1);
        }
        let cost = |bins: &[(Bounds, u32)]| {
            let (all, count) = bins.iter().fold((Bounds::EMPTY, 0), |(all, n), (b, k)| (all.with(*b), n + k));
            if count == 0 { 0.0 } else { all.half_area() * f64::from(count) }
        };
        for plane in 1..BINS {
            let cost = cost(&bins[..plane]) + cost(&bins[plane..]);
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, low + width * plane as f64 / BINS as f64));
            }
        }
    }
    best.map(|(_, axis, plane)| (axis, plane))
}

/// Distance at which a ray enters a box; `None` if it misses it or enters behind the limit.
fn entry(node: &Node, origin_mm: DVec3, inverse: DVec3, limit_mm: f64) -> Option<f64> {
    let (a, b) = ((node.low - origin_mm) * inverse, (node.high - origin_mm) * inverse);
    let near = a.min(b).max_element().max(0.0);
    // A little further, so that rays in the plane of a flat box do not slip through by rounding.
    let far = a.max(b).min_element() * (1.0 + 1e-12);
    (near <= far && near < limit_mm).then_some(near)
}

fn meet(&[corner, u, v]: &[DVec3; 3], origin_mm: DVec3, direction: DVec3) -> Option<(f64, [f64; 2])> {
    let p = direction.cross(v);
    let determinant = u.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let t = origin_mm - corner;
    let a = t.dot(p) / determinant;
    if !(0.0..=1.0).contains(&a) {
        return None;
    }
    let q = t.cross(u);
    let b = direction.dot(q) / determinant;
    (b >= 0.0 && a + b <= 1.0).then(|| (v.dot(q) / determinant, [a, b]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deterministic numbers in [0, 1).
    fn numbers(seed: u32) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        }
    }

    #[test]
    fn the_tree_finds_what_a_look_at_all_triangles_finds() {
        let mut next = numbers(7);
        let mut point = |scale: f64| DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * scale;
        let triangles: Vec<[DVec3; 3]> = (0..700)
            .map(|_| {
                let corner = point(100.0);
                [corner, corner + point(9.0), corner + point(30.0)]
            })
            .collect();
        let tree = Bvh::new(&triangles);
        let mut met = 0;
        for _ in 0..2000 {
            let (origin, direction) = (point(160.0), point(1.0).normalize());
            let brute = triangles
                .iter()
                .enumerate()
                .filter_map(|(i, &[a, b, c])| {
                    meet(&[a, b - a, c - a], origin, direction).filter(|(t, _)| *t > 0.0).map(|(t, _)| (t, i as u32))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let found = tree.first(origin, direction, f64::INFINITY).map(|hit| (hit.distance_mm, hit.triangle));
            assert_eq!(found, brute);
            assert_eq!(tree.is_blocked(origin, direction, f64::INFINITY), brute.is_some());
            if let Some((distance, _)) = brute {
                met += 1;
                assert!(!tree.is_blocked(origin, direction, distance));
            }
        }
        assert!(met > 200, "{met} rays met a triangle");
        assert_eq!(Bvh::new(&[]).first(DVec3::ZERO, DVec3::X, 1.0), None);
    }

    #[test]
    fn rays_along_the_axes_meet_flat_boxes() {
        let square =
            [[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)], [DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]];
        let tree = Bvh::new(&square);
        for (x, y) in [(0.3, 0.2), (0.2, 0.3), (0.999, 0.0), (0.5, 0.5)] {
            let hit = tree.first(DVec3::new(x, y, 5.0), DVec3::NEG_Z, 100.0).expect("meets the square");
            assert_eq!(hit.distance_mm, 5.0);
        }
    }
}
