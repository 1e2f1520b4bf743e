//! Which triangle a ray meets first: a tree of boxes over triangles.
//!
//! Binned surface-area heuristic (Wald, 2007), twelve bins per axis, leaves of at most four triangles; triangles by
//! Möller and Trumbore (1997). Everything is f64 and the tree depends on the triangles and nothing else, so that the
//! same mesh gives the same picture.
//!
//! Boxes of an open surface stand on the plane that it leans along (`levelling`).
//!
//! Road not taken: a crate. Those that fit are fast through single precision and SIMD, which this renderer does not
//! need, or bring a second linear algebra along.

use super::levelling::Levelling;
use glam::DVec3;
use rayon::prelude::*;

const BINS: usize = 12;
const LEAF: usize = 4;
/// Nodes over more triangles than this build their halves side by side.
const SIDE_BY_SIDE: usize = 4096;

/// Nodes put aside on a walk at most: the tree is no deeper.
const DEEPEST: usize = 64;
/// Levels that the heuristic splits; those below are halved, which takes one more for every bit of a count of 32.
const BY_HEURISTIC: u32 = 32;

/// Tree over the triangles of a scene.
#[derive(Debug, Default)]
pub struct Bvh {
    levelling: Levelling,
    nodes: Vec<BvhNode>,
    /// Corner and the two edges from it, in the order of the leaves.
    triangles: Vec<[DVec3; 3]>,
    /// Number of the triangle as it was given.
    numbers: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct BvhNode {
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

    fn center(self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    fn half_area(self) -> f64 {
        let d = (self.high - self.low).max(DVec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

impl Bvh {
    /// Tree over triangles given by their corners.
    pub fn new(corners_mm: &[[DVec3; 3]]) -> Self {
        let levelling = Levelling::of(corners_mm);
        let bounds = |corners_mm: &[DVec3; 3]| {
            let [low, high] = levelling.box_mm(corners_mm);
            Bounds { low, high }
        };
        let bounds: Vec<Bounds> = corners_mm.par_iter().map(bounds).collect();
        let mut order: Vec<u32> = (0..corners_mm.len() as u32).collect();
        let mut nodes = Vec::with_capacity(corners_mm.len());
        if !order.is_empty() {
            build(&bounds, &mut order, [0, 0], &mut nodes);
        }
        let triangles = order
            .par_iter()
            .map(|&i| {
                let [a, b, c] = corners_mm[i as usize];
                [a, b - a, c - a]
            })
            .collect();
        Self { levelling, nodes, triangles, numbers: order }
    }

    /// Corner and the two edges from it of every triangle, in the order of the leaves.
    pub fn triangles(&self) -> &[[DVec3; 3]] {
        &self.triangles
    }

    /// Number of a triangle, by its place in the order of the leaves, as it was given.
    pub fn number(&self, index: u32) -> u32 {
        self.numbers[index as usize]
    }

    /// First triangle along a ray, within `limit_mm`; both sides of triangles count.
    #[cfg(feature = "testing")]
    pub fn first(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64) -> Option<Hit> {
        self.walk(origin_mm, direction, limit_mm, false)
    }

    /// Whether anything stands within `limit_mm`.
    pub fn is_blocked(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64) -> bool {
        self.walk(origin_mm, direction, limit_mm, true).is_some()
    }

    fn walk(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64, any: bool) -> Option<Hit> {
        // Never infinite: zero times infinity would lose boxes that the ray runs along.
        let [sheared_mm, sheared_direction] = [origin_mm, direction].map(|v| self.levelling.sheared(v));
        let inverse = sheared_direction.map(|d| if d.abs() < 1e-300 { 1e300 } else { 1.0 / d });
        let mut best: Option<Hit> = None;
        let mut limit_mm = limit_mm;
        // Nodes put aside, with the distance at which the ray enters them.
        let mut stack = [(0_u32, 0.0_f64); DEEPEST];
        let mut depth = 0;
        let mut index = 0;
        if self.nodes.is_empty() || entry(&self.nodes[0], sheared_mm, inverse, limit_mm).is_none() {
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
                let (left, right) = (index + 1, node.link);
                let of_left = entry(&self.nodes[left as usize], sheared_mm, inverse, limit_mm);
                let of_right = entry(&self.nodes[right as usize], sheared_mm, inverse, limit_mm);
                let near = match (of_left, of_right) {
                    (Some(a), Some(b)) => {
                        let (near, far) = if a <= b { (left, (right, b)) } else { (right, (left, a)) };
                        stack[depth] = far;
                        depth += 1;
                        Some(near)
                    }
                    (Some(_), None) => Some(left),
                    (None, Some(_)) => Some(right),
                    (None, None) => None,
                };
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
                let (next, enters_mm) = stack[depth];
                // The limit may have come closer since the node was put aside.
                if enters_mm < limit_mm {
                    index = next;
                    break;
                }
            }
        }
    }
}

/// Adds the nodes over `order[..]`, whose first place in the whole is `first`, in the order of a walk from the left.
/// Large halves are built side by side and joined, which gives the same nodes.
fn build(bounds: &[Bounds], order: &mut [u32], [first, depth]: [u32; 2], nodes: &mut Vec<BvhNode>) {
    let (whole, centers) = order.iter().fold((Bounds::EMPTY, Bounds::EMPTY), |(whole, centers), &i| {
        let (all, center) = (bounds[i as usize], bounds[i as usize].center());
        (whole.with(all), centers.with(Bounds { low: center, high: center }))
    });
    let index = nodes.len();
    nodes.push(BvhNode { low: whole.low, high: whole.high, link: first, count: order.len() as u32 });
    // Splits by the median are taken where the heuristic finds none, and deep down, so that the walker's stack holds.
    if order.len() <= LEAF {
        return;
    }
    let center = |i: u32| bounds[i as usize].center();
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
        Some(middle) if depth < BY_HEURISTIC && middle > small && order.len() - middle > small => middle,
        _ => {
            let extent = centers.high - centers.low;
            let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
            order.sort_unstable_by(|&a, &b| center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b)));
            order.len() / 2
        }
    };
    let side_by_side = order.len() > SIDE_BY_SIDE;
    let (left, right) = order.split_at_mut(middle);
    let half = |order: &mut [u32], first: u32| {
        let mut nodes = Vec::with_capacity(order.len());
        build(bounds, order, [first, depth + 1], &mut nodes);
        nodes
    };
    let link = if side_by_side {
        let (left, right) = rayon::join(|| half(left, first), || half(right, first + middle as u32));
        append(nodes, left);
        let link = nodes.len();
        append(nodes, right);
        link
    } else {
        build(bounds, left, [first, depth + 1], nodes);
        let link = nodes.len();
        build(bounds, right, [first + middle as u32, depth + 1], nodes);
        link
    };
    (nodes[index].link, nodes[index].count) = (link as u32, 0);
}

/// Puts a tree of its own behind other nodes; its inner nodes count from there.
fn append(nodes: &mut Vec<BvhNode>, tree: Vec<BvhNode>) {
    let start = nodes.len() as u32;
    nodes.extend(
        tree.into_iter()
            .map(|node| BvhNode { link: if node.count == 0 { node.link + start } else { node.link }, ..node }),
    );
}

/// Axis and plane of the cheapest split of the bins.
fn best_split(bounds: &[Bounds], order: &[u32], centers: Bounds) -> Option<(usize, f64)> {
    let extent = centers.high - centers.low;
    let mut bins = [[(Bounds::EMPTY, 0_u32); BINS]; 3];
    for &i in order {
        let b = bounds[i as usize];
        let share = (b.center() - centers.low) / extent;
        for axis in (0..3).filter(|&axis| extent[axis] > 0.0) {
            let bin = &mut bins[axis][((share[axis] * BINS as f64) as usize).min(BINS - 1)];
            *bin = (bin.0.with(b), bin.1 + 1);
        }
    }
    let cost = |bins: &[(Bounds, u32)]| {
        let (all, count) = bins.iter().fold((Bounds::EMPTY, 0), |(all, n), (b, k)| (all.with(*b), n + k));
        if count == 0 { 0.0 } else { all.half_area() * f64::from(count) }
    };
    let mut best: Option<(f64, usize, f64)> = None;
    for axis in (0..3).filter(|&axis| extent[axis] > 0.0) {
        for plane in 1..BINS {
            let cost = cost(&bins[axis][..plane]) + cost(&bins[axis][plane..]);
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, centers.low[axis] + extent[axis] * plane as f64 / BINS as f64));
            }
        }
    }
    best.map(|(_, axis, plane)| (axis, plane))
}

/// Distance at which a ray enters a box; `None` if it misses it or enters behind the limit.
#[inline]
fn entry(node: &BvhNode, origin_mm: DVec3, inverse: DVec3, limit_mm: f64) -> Option<f64> {
    let (a, b) = ((node.low - origin_mm) * inverse, (node.high - origin_mm) * inverse);
    let near = a.min(b).max_element().max(0.0);
    // A little further, so that rays in the plane of a flat box do not slip through by rounding.
    let far = a.max(b).min_element() * (1.0 + 1e-12);
    (near <= far && near < limit_mm).then_some(near)
}

/// Distance at which a ray meets a triangle (corner and the two edges from it), and the weights of the edges' ends.
#[inline]
pub fn meet(&[corner, u, v]: &[DVec3; 3], origin_mm: DVec3, direction: DVec3) -> Option<(f64, [f64; 2])> {
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

/// Deterministic numbers in [0, 1).
#[cfg(test)]
pub fn numbers(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// A relief that leans along both directions: strips of triangles, each as long as the whole.
    #[test]
    fn strips_of_a_leaning_relief_are_found_as_by_a_look_at_all() {
        let mut next = numbers(5);
        let mut heights = || -> Vec<f64> { (0..200).map(|_| 0.3 * next()).collect() };
        let ends = [heights(), heights()];
        let corner = |end: usize, strip: usize| {
            let (x, y) = (10.0 * end as f64, 0.05 * strip as f64);
            DVec3::new(x, y, 0.4 * x - 0.7 * y + ends[end][strip])
        };
        let strips = (1..200).flat_map(|i| {
            let [a, b, c, d] = [corner(0, i - 1), corner(1, i - 1), corner(1, i), corner(0, i)];
            [[a, b, c], [a, c, d]]
        });
        let triangles: Vec<[DVec3; 3]> = strips.collect();
        let tree = Bvh::new(&triangles);
        assert!((tree.levelling.lean - DVec3::new(-0.4, 0.7, 0.0)).length() < 0.1);
        let mut met = 0;
        for _ in 0..2000 {
            let origin = DVec3::new(12.0 * next() - 1.0, 12.0 * next() - 1.0, 12.0 * next() - 6.0);
            let direction = DVec3::new(next() - 0.5, next() - 0.5, 0.3 * (next() - 0.5)).normalize();
            let distances = triangles.iter().filter_map(|&[a, b, c]| meet(&[a, b - a, c - a], origin, direction));
            let nearest = distances.map(|(distance, _)| distance).filter(|t| *t > 0.0).min_by(f64::total_cmp);
            assert_eq!(tree.first(origin, direction, f64::INFINITY).map(|hit| hit.distance_mm), nearest);
            met += u32::from(nearest.is_some());
        }
        assert!(met > 200, "{met} rays met a triangle");
    }

    #[test]
    fn halves_built_side_by_side_give_the_same_tree() {
        let mut next = numbers(3);
        let mut point = |scale: f64| DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * scale;
        let triangles: Vec<[DVec3; 3]> = (0..5 * SIDE_BY_SIDE)
            .map(|_| {
                let corner = point(100.0);
                [corner, corner + point(1.0), corner + point(1.0)]
            })
            .collect();
        let tree = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| Bvh::new(&triangles))
        };
        let [one, four] = [1, 4].map(tree);
        assert_eq!(one.numbers, four.numbers);
        let plain = |tree: &Bvh| -> Vec<(DVec3, DVec3, u32, u32)> {
            tree.nodes.iter().map(|n| (n.low, n.high, n.link, n.count)).collect()
        };
        assert_eq!(plain(&one), plain(&four));
        // Leaves lie behind each other and hold every triangle once, and every right child lies behind its parent.
        let leaves = || four.nodes.iter().filter(|node| node.count > 0);
        assert!(leaves().scan(0, |end, n| (*end, *end += n.count).0.eq(&n.link).into()).all(|follows| follows));
        assert_eq!(leaves().map(|n| n.count as usize).sum::<usize>(), triangles.len());
        assert!((0..).zip(&four.nodes).all(|(i, n)| n.count > 0 || n.link > i + 1));
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
