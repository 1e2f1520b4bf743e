//! A mesh without the vertices that the others can do without.
//!
//! In: a mesh and a distance. Out: the same surface on some of its vertices: every vertex that is left out lies within
//! the distance of the triangles of its part, and its heights and its stock are those between their corners, within the
//! distance and [`STOCK_SHARE`]; what has a value there never borders on what has none. Vertices that stay keep place
//! and values to the last bit. A closed mesh stays closed, and parts keep their triangles apart.
//!
//! Law: a vertex is drawn onto a neighbour (half-edge collapse; Hoppe et al. 1993), which turns the fan round it into
//! one round the neighbour. That keeps the mesh a surface where the only vertices that both know are the third corners
//! of the triangles that vanish (Dey et al. 1999). Triangles remember which vertices have been left out over them, so
//! that errors do not add up. Vertices between parts are drawn along the line between them alone, and count on both
//! sides of it; first the insides of all parts are thinned out, side by side, then the lines between them.
//!
//! Small errors are made before large ones: the distance grows from round to round, which stands for a queue by error.
//! Road not taken: such a queue (Garland and Heckbert 1997). Its order runs through the whole mesh and one thread, and
//! sums of squares bound no distance.

use super::mesh::{Mesh, ScalarValues};
use super::outline::STOCK_SHARE;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
use rayon::prelude::*;

/// Shares of the distance that the rounds may use up.
const ROUNDS: [f64; 5] = [0.1, 0.25, 0.5, 1.0, 1.0];
/// Triangles at a vertex at most: more are needles.
const MOST_IN_FAN: usize = 24;
/// Cosine of the angle by which a triangle may turn.
const TURNED: f64 = 0.5;
/// Height of a triangle over its longest side at least, as a share of it: flatter ones have no direction.
const FLATTEST: f64 = 1e-4;

/// The mesh without what lies within `within_mm` of the rest of it.
pub fn decimated(mesh: &Mesh, within_mm: f64) -> Mesh {
    let values = &VertexValues::new(mesh, within_mm);
    let insides: Vec<Thinned> = mesh
        .parts
        .par_iter()
        .enumerate()
        .map(|(part, of)| {
            let faces = of.triangles.clone().map(|t| ThinnedFace::new(mesh.triangles[t], part)).collect();
            let mut thinned = Thinned::new(values, faces);
            let mut edges = Vec::new();
            let mut is_inside = |vertex: u32| {
                thinned.edges_of(vertex, &mut edges);
                !edges.iter().any(FanEdge::is_line)
            };
            let inside: Vec<bool> = (0..thinned.ids.len() as u32).map(&mut is_inside).collect();
            thinned.thin(&inside);
            thinned
        })
        .collect();
    let faces = insides.into_iter().flat_map(Thinned::into_faces).collect();
    let mut whole = Thinned::new(values, faces);
    let all = vec![true; whole.ids.len()];
    whole.thin(&all);
    whole.into_mesh()
}

/// What a vertex that is left out must be equal to.
struct VertexValues<'a> {
    mesh: &'a Mesh,
    within_mm: f64,
    /// Quantities that are measured, and how far each may be off.
    measured: Vec<(&'a [f32], f64)>,
}

impl<'a> VertexValues<'a> {
    fn new(mesh: &'a Mesh, within_mm: f64) -> Self {
        let measured = mesh.scalars.iter().filter_map(|scalar| match &scalar.values {
            ScalarValues::F32(values) => {
                let share = if scalar.unit == "um" { UM_PER_MM } else { 1.0 / STOCK_SHARE };
                Some((values.as_slice(), share * within_mm))
            }
            ScalarValues::U32(_) => None,
        });
        Self { mesh, within_mm, measured: measured.collect() }
    }

    fn place_mm(&self, id: u32) -> DVec3 {
        self.mesh.positions_mm[id as usize]
    }

    /// Square of the distance of a vertex from a triangle, mm^2, where its values are those of the nearest place.
    fn off_mm2(&self, id: u32, corners: [u32; 3], part: usize) -> Option<f64> {
        let place_mm = self.place_mm(id);
        let shares = nearest(place_mm, corners.map(|corner| self.place_mm(corner)));
        let of = |value: &dyn Fn(u32) -> f64| -> f64 { (0..3).map(|k| shares[k] * value(corners[k])).sum() };
        let measured = if self.mesh.parts[part].measured { self.measured.as_slice() } else { &[] };
        let alike = measured.iter().all(|&(values, within)| {
            let own = values[id as usize];
            if corners.iter().any(|&corner| values[corner as usize].is_nan() != own.is_nan()) {
                return false;
            }
            own.is_nan() || (of(&|corner| f64::from(values[corner as usize])) - f64::from(own)).abs() <= within
        });
        let there_mm: DVec3 = (0..3).map(|k| shares[k] * self.place_mm(corners[k])).sum();
        alike.then(|| there_mm.distance_squared(place_mm))
    }
}

/// A triangle with the vertices that were left out over it.
struct ThinnedFace {
    corners: [u32; 3],
    part: usize,
    over: Vec<u32>,
    is_gone: bool,
}

impl ThinnedFace {
    fn new(corners: [u32; 3], part: usize) -> Self {
        Self { corners, part, over: Vec::new(), is_gone: false }
    }
}

/// Triangles from which vertices are taken. Inside, vertices have numbers of their own.
struct Thinned<'a> {
    values: &'a VertexValues<'a>,
    /// Numbers in the mesh, increasing.
    ids: Vec<u32>,
    faces: Vec<ThinnedFace>,
    /// Triangles round every vertex.
    fans: Vec<Vec<u32>>,
    /// Least error of its own with which a vertex can be drawn onto any neighbour, mm^2: known since its fan last
    /// changed, or none. It spares most vertices all rounds but one.
    least_mm2: Vec<Option<f64>>,
}

/// An edge of a fan, from its vertex.
struct FanEdge {
    to: u32,
    /// Its triangles, and the part of the first.
    faces: u32,
    part: usize,
    /// Whether another triangle is of another part.
    joins: bool,
}

impl FanEdge {
    /// Whether it has not two triangles of one part.
    fn is_line(&self) -> bool {
        self.faces != 2 || self.joins
    }
}

/// A vertex drawn onto a neighbour: triangles that change, with what is then over them.
struct Collapse {
    onto: u32,
    changed: Vec<(u32, [u32; 3], Vec<u32>)>,
}

impl<'a> Thinned<'a> {
    /// Of triangles whose corners and left-out vertices are numbered as in the mesh.
    fn new(values: &'a VertexValues<'a>, mut faces: Vec<ThinnedFace>) -> Self {
        let mut ids: Vec<u32> = faces.iter().flat_map(|face| face.corners).collect();
        ids.sort_unstable();
        ids.dedup();
        let mut fans: Vec<Vec<u32>> = vec![Vec::new(); ids.len()];
        for (index, face) in (0..).zip(&mut faces) {
            face.corners = face.corners.map(|id| ids.partition_point(|&own| own < id) as u32);
            face.corners.iter().for_each(|&corner| fans[corner as usize].push(index));
        }
        let least_mm2 = vec![None; ids.len()];
        Self { values, ids, faces, fans, least_mm2 }
    }

    fn into_faces(self) -> impl Iterator<Item = ThinnedFace> {
        let Self { ids, faces, .. } = self;
        let named =
            move |face: ThinnedFace| ThinnedFace { corners: face.corners.map(|corner| ids[corner as usize]), ..face };
        faces.into_iter().filter(|face| !face.is_gone).map(named)
    }

    /// The mesh of what is left.
    fn into_mesh(self) -> Mesh {
        let mesh = self.values.mesh;
        let kept: Vec<usize> = (0..self.ids.len()).filter(|&v| !self.fans[v].is_empty()).collect();
        let mut numbers = vec![0; self.ids.len()];
        kept.iter().zip(0..).for_each(|(&vertex, number)| numbers[vertex] = number);
        let ids: Vec<usize> = kept.iter().map(|&vertex| self.ids[vertex] as usize).collect();
        let mut thin = Mesh { positions_mm: ids.iter().map(|&id| mesh.positions_mm[id]).collect(), ..Mesh::default() };
        let mut faces = self.faces.iter().filter(|face| !face.is_gone).peekable();
        for (index, part) in mesh.parts.iter().enumerate() {
            let start = thin.triangles.len();
            while let Some(face) = faces.next_if(|face| face.part == index) {
                thin.triangles.push(face.corners.map(|corner| numbers[corner as usize]));
            }
            let mut part = part.clone();
            part.triangles = start..thin.triangles.len();
            thin.parts.push(part);
        }
        for scalar in &mesh.scalars {
            let values = match &scalar.values {
                ScalarValues::F32(values) => ScalarValues::F32(ids.iter().map(|&id| values[id]).collect()),
                ScalarValues::U32(values) => ScalarValues::U32(ids.iter().map(|&id| values[id]).collect()),
            };
            thin.scalars.push(super::mesh::Scalar { values, ..scalar.clone() });
        }
        thin
    }

    /// Draws vertices that may go onto neighbours, round by round.
    fn thin(&mut self, may_go: &[bool]) {
        let mut is_target = vec![false; self.ids.len()];
        let mut edges = Vec::new();
        for share in ROUNDS {
            is_target.fill(false);
            let most_mm2 = (share * self.values.within_mm).powi(2);
            for vertex in (0..self.ids.len()).filter(|&vertex| may_go[vertex]) {
                if is_target[vertex] || self.fans[vertex].is_empty() {
                    continue;
                }
                if let Some(collapse) = self.best(vertex as u32, most_mm2, &mut edges) {
                    is_target[collapse.onto as usize] = true;
                    self.apply(vertex as u32, collapse);
                }
            }
        }
    }

    /// Edges of a vertex's fan, one for each neighbour, into memory that is reused.
    fn edges_of(&self, vertex: u32, into: &mut Vec<FanEdge>) {
        into.clear();
        for face in self.fans[vertex as usize].iter().map(|&face| &self.faces[face as usize]) {
            for to in face.corners.into_iter().filter(|&corner| corner != vertex) {
                match into.iter_mut().find(|edge| edge.to == to) {
                    Some(edge) => {
                        edge.faces += 1;
                        edge.joins |= edge.part != face.part;
                    }
                    None => into.push(FanEdge { to, faces: 1, part: face.part, joins: false }),
                }
            }
        }
    }

    /// The neighbour onto which a vertex is drawn with the least error of its own.
    fn best(&mut self, vertex: u32, most_mm2: f64, edges: &mut Vec<FanEdge>) -> Option<Collapse> {
        if self.least_mm2[vertex as usize].is_some_and(|least_mm2| least_mm2 > most_mm2) {
            return None;
        }
        self.edges_of(vertex, edges);
        let lines = edges.iter().filter(|edge| edge.is_line()).count();
        let mut found: Vec<(f64, u32)> = edges
            .iter()
            .filter(|edge| lines == 0 || lines == 2 && edge.is_line())
            .filter_map(|edge| Some((self.own_error_mm2(vertex, edge.to)?, edge.to)))
            .collect();
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.least_mm2[vertex as usize] = Some(found.first().map_or(f64::INFINITY, |&(least_mm2, _)| least_mm2));
        let near = found.into_iter().take_while(|&(error_mm2, _)| error_mm2 <= most_mm2);
        let sound = near.filter(|&(_, onto)| self.keeps_the_surface(edges, vertex, onto));
        sound.take(2).find_map(|(_, onto)| self.collapse(vertex, onto, most_mm2))
    }

    /// Whether what both vertices know are the third corners of the triangles between them.
    fn keeps_the_surface(&self, edges: &[FanEdge], vertex: u32, onto: u32) -> bool {
        let (own, others) = (&self.fans[vertex as usize], &self.fans[onto as usize]);
        let has = |&&face: &&u32, corner: u32| self.faces[face as usize].corners.contains(&corner);
        let between = own.iter().filter(|face| has(face, onto)).count();
        let is_common = |edge: &&FanEdge| edge.to != onto && others.iter().any(|face| has(&face, edge.to));
        edges.iter().filter(is_common).count() == between && own.len() + others.len() - 2 * between <= MOST_IN_FAN
    }

    /// Triangles of a vertex's fan that stay when it is drawn onto another, with their new corners; none for one that
    /// turns over.
    fn moved(&self, vertex: u32, onto: u32) -> impl Iterator<Item = Option<(u32, [u32; 3])>> {
        let across = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
        let with_corners = self.fans[vertex as usize].iter().map(|&face| (face, self.faces[face as usize].corners));
        let stays = with_corners.filter(move |(_, corners)| !corners.contains(&onto));
        stays.map(move |(face, corners)| {
            let moved = corners.map(|corner| if corner == vertex { onto } else { corner });
            let [stood_mm, at_mm] =
                [corners, moved].map(|of| of.map(|corner| self.values.place_mm(self.ids[corner as usize])));
            let (before, after) = (across(stood_mm), across(at_mm));
            let [a, b, c] = at_mm;
            let longest_mm2 = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            let sound = before.dot(after) > TURNED * before.length() * after.length();
            (sound && after.length() > FLATTEST * longest_mm2).then_some((face, moved))
        })
    }

    /// Square of the distance of a vertex from the triangles that it leaves.
    fn own_error_mm2(&self, vertex: u32, onto: u32) -> Option<f64> {
        let id = self.ids[vertex as usize];
        let mut least_mm2: Option<f64> = None;
        for moved in self.moved(vertex, onto) {
            let (face, corners) = moved?;
            let off_mm2 = self.off_mm2(id, face, corners);
            least_mm2 = least_mm2.into_iter().chain(off_mm2).min_by(f64::total_cmp);
        }
        least_mm2
    }

    fn off_mm2(&self, id: u32, face: u32, corners: [u32; 3]) -> Option<f64> {
        self.values.off_mm2(id, corners.map(|corner| self.ids[corner as usize]), self.faces[face as usize].part)
    }

    /// A vertex drawn onto another; none where something over its fan would be farther off than it may.
    fn collapse(&self, vertex: u32, onto: u32, most_mm2: f64) -> Option<Collapse> {
        let moved = self.moved(vertex, onto);
        let mut changed: Vec<(u32, [u32; 3], Vec<u32>)> =
            moved.map(|moved| moved.map(|(face, corners)| (face, corners, Vec::new()))).collect::<Option<_>>()?;
        let fan = &self.fans[vertex as usize];
        let part = |face: u32| self.faces[face as usize].part;
        let mut parts: Vec<usize> = fan.iter().map(|&face| part(face)).collect();
        parts.sort_unstable();
        parts.dedup();
        for of in parts {
            let over = fan.iter().filter(|&&face| part(face) == of).flat_map(|&face| &self.faces[face as usize].over);
            for &id in over.chain([&self.ids[vertex as usize]]) {
                let near = changed.iter().enumerate().filter(|(_, (face, ..))| part(*face) == of);
                let near =
                    near.filter_map(|(place, (face, corners, _))| Some((self.off_mm2(id, *face, *corners)?, place)));
                let (off_mm2, place) = near.min_by(|a, b| a.0.total_cmp(&b.0))?;
                if off_mm2 > most_mm2 {
                    return None;
                }
                changed[place].2.push(id);
            }
        }
        Some(Collapse { onto, changed })
    }

    fn apply(&mut self, vertex: u32, Collapse { onto, changed }: Collapse) {
        for face in std::mem::take(&mut self.fans[vertex as usize]) {
            let corners = self.faces[face as usize].corners;
            for corner in corners {
                self.least_mm2[corner as usize] = None;
            }
            if !corners.contains(&onto) {
                continue;
            }
            self.faces[face as usize].is_gone = true;
            for corner in corners.into_iter().filter(|&corner| corner != vertex) {
                self.fans[corner as usize].retain(|&other| other != face);
            }
        }
        for (face, corners, over) in changed {
            let face_of = &mut self.faces[face as usize];
            (face_of.corners, face_of.over) = (corners, over);
            self.fans[onto as usize].push(face);
        }
    }
}

/// Shares of the corners of a triangle in its place nearest to a point (Ericson, *Real-Time Collision Detection*, 2005,
/// ch. 5).
fn nearest(point: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let along = |from: DVec3| [ab.dot(point - from), ac.dot(point - from)];
    let ([a1, a2], [b1, b2], [c1, c2]) = (along(a), along(b), along(c));
    if a1 <= 0.0 && a2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    if b1 >= 0.0 && b2 <= b1 {
        return [0.0, 1.0, 0.0];
    }
    if c2 >= 0.0 && c1 <= c2 {
        return [0.0, 0.0, 1.0];
    }
    let of_c = a1 * b2 - b1 * a2;
    if of_c <= 0.0 && a1 >= 0.0 && b1 <= 0.0 {
        let share = a1 / (a1 - b1);
        return [1.0 - share, share, 0.0];
    }
    let of_b = c1 * a2 - a1 * c2;
    if of_b <= 0.0 && a2 >= 0.0 && c2 <= 0.0 {
        let share = a2 / (a2 - c2);
        return [1.0 - share, 0.0, share];
    }
    let of_a = b1 * c2 - c1 * b2;
    if of_a <= 0.0 && b2 >= b1 && c1 >= c2 {
        let share = (b2 - b1) / ((b2 - b1) + (c1 - c2));
        return [0.0, 1.0 - share, share];
    }
    let all = of_a + of_b + of_c;
    [of_a / all, of_b / all, of_c / all]
}

#[cfg(test)]
mod tests {
    use super::super::mesh::{MeshPart, Scalar};
    use super::*;
    use glam::DVec2;

    /// A grid over 8 mm by 6 mm, `step_mm` apart, two parts side by side, with its heights over z = 0.
    fn field(step_mm: f64, height_mm: impl Fn(f64, f64) -> f64, known: impl Fn(f64) -> bool) -> Mesh {
        let [columns, rows] = [8.0, 6.0].map(|side_mm: f64| (side_mm / step_mm).round() as u32 + 1);
        let at = |c: u32, r: u32| DVec2::new(f64::from(c), f64::from(r)) * step_mm;
        let places: Vec<DVec2> = (0..columns).flat_map(|c| (0..rows).map(move |r| at(c, r))).collect();
        let number = |c: u32, r: u32| c * rows + r;
        let quads = (1..columns).flat_map(|c| (1..rows).map(move |r| (c, r)));
        let triangles: Vec<[u32; 3]> = quads
            .flat_map(|(c, r)| {
                let [a, b, d, e] = [number(c - 1, r - 1), number(c, r - 1), number(c, r), number(c - 1, r)];
                [[a, b, d], [a, d, e]]
            })
            .collect();
        let first = 2 * (columns / 2) as usize * (rows - 1) as usize;
        let part = |name: &str, triangles| MeshPart { name: name.to_owned(), triangles, measured: true };
        let um = |p: &DVec2| if known(p.x) { (UM_PER_MM * height_mm(p.x, p.y)) as f32 } else { f32::NAN };
        let heights = ScalarValues::F32(places.iter().map(um).collect());
        Mesh {
            positions_mm: places.iter().map(|p| p.extend(height_mm(p.x, p.y))).collect(),
            parts: vec![part("one", 0..first), part("other", first..triangles.len())],
            triangles,
            scalars: vec![Scalar { name: "height_um", unit: "um", definition: String::new(), values: heights }],
        }
    }

    /// Height of a mesh over a place in the plane, mm, by the triangle above it.
    fn height_over(mesh: &Mesh, place: DVec2) -> f64 {
        let over = (0..mesh.triangles.len()).find_map(|t| {
            let corners = mesh.corners_mm(t);
            let [a, b, c] = corners.map(DVec3::truncate);
            let area = (b - a).perp_dot(c - a);
            let shares = [(c - b).perp_dot(place - b), (a - c).perp_dot(place - c), (b - a).perp_dot(place - a)];
            let shares = shares.map(|share| share / area);
            shares.iter().all(|&share| share > -1e-9).then(|| (0..3).map(|k| shares[k] * corners[k].z).sum())
        });
        over.expect("the mesh covers the plane")
    }

    /// Largest distance along z of a field's vertices from a mesh, mm.
    fn worst_mm(field: &Mesh, mesh: &Mesh) -> f64 {
        let off = field.positions_mm.iter().map(|p| (p.z - height_over(mesh, p.truncate())).abs());
        off.fold(0.0, f64::max)
    }

    #[test]
    fn flat_parts_keep_their_corners_alone() {
        let thin = decimated(&field(0.5, |_, _| 0.0, |_| true), 1e-3);
        assert_eq!((thin.positions_mm.len(), thin.triangles.len()), (6, 4));
        assert_eq!(thin.area_mm2(), 48.0);
        assert_eq!([&thin.parts[0].triangles, &thin.parts[1].triangles], [&(0..2), &(2..4)]);
    }

    /// Waves 2 mm long and 9 um high, as feeds leave them, over a slope: a chord of s misses s^2 / (8 rho).
    #[test]
    fn waves_are_followed_within_the_distance_and_no_finer() {
        let wave = |x: f64, y: f64| 0.0045 * (std::f64::consts::PI * (x + 0.2 * y)).cos() + 0.1 * y;
        let field = field(0.1, wave, |_| true);
        let thin = decimated(&field, 1e-3);
        let worst = worst_mm(&field, &thin);
        // Distances along z are longer than those across a slope of 0.1, by 0.5 %.
        assert!(worst > 3e-4 && worst < 1.006e-3, "{worst}");
        let share = thin.triangles.len() as f64 / field.triangles.len() as f64;
        assert!(share < 0.15, "{share} of {}", field.triangles.len());
        // What stays is what it was.
        let ScalarValues::F32(heights) = &thin.scalars[0].values else { panic!("heights") };
        for (p, um) in thin.positions_mm.iter().zip(heights) {
            assert!(field.positions_mm.contains(p) && *um == (UM_PER_MM * wave(p.x, p.y)) as f32);
        }
        // The check would notice a vertex that is off.
        let mut off = thin.clone();
        off.positions_mm[thin.positions_mm.len() / 2].z += 2.5e-3;
        assert!(worst_mm(&field, &off) > 1.006e-3);
    }

    #[test]
    fn what_has_a_value_never_borders_on_what_has_none() {
        let field = field(0.5, |_, _| 0.0, |x| x < 5.2);
        let thin = decimated(&field, 1e-3);
        let ScalarValues::F32(heights) = &thin.scalars[0].values else { panic!("heights") };
        let mixed = |mesh: &Mesh, heights: &[f32]| {
            let of = |t: &&[u32; 3]| {
                let unknown = t.iter().filter(|&&corner| heights[corner as usize].is_nan()).count();
                unknown == 1 || unknown == 2
            };
            mesh.triangles.iter().filter(of).map(|t| t.map(|c| mesh.positions_mm[c as usize].x)).collect::<Vec<_>>()
        };
        let ScalarValues::F32(all) = &field.scalars[0].values else { panic!("heights") };
        assert!(!mixed(&field, all).is_empty());
        for xs in mixed(&thin, heights) {
            assert!(xs.iter().all(|x| (5.0..=5.5).contains(x)), "{xs:?}");
        }
    }

    /// A closed body of six such sides stays closed and keeps its volume within its area times the distance.
    #[test]
    fn a_closed_body_stays_closed() {
        let count = 24_u32;
        let mut body = Mesh::default();
        // A ball of 10 mm from a cube's sides, vertices shared by place.
        let mut numbers = std::collections::HashMap::new();
        for side in 0..6_usize {
            let start = body.triangles.len();
            let mut number = |i: u32, j: u32| {
                let [u, v] = [i, j].map(|k| 2 * i64::from(k) - i64::from(count));
                let out = if side % 2 == 0 { i64::from(count) } else { -i64::from(count) };
                let mut place = [0_i64; 3];
                (place[side / 2], place[(side / 2 + 1) % 3], place[(side / 2 + 2) % 3]) = (out, u, v);
                *numbers.entry(place).or_insert_with(|| {
                    let point = DVec3::from_array(place.map(|x| x as f64)).normalize() * 10.0;
                    body.positions_mm.push(point);
                    body.positions_mm.len() as u32 - 1
                })
            };
            let mut sides = Vec::new();
            for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
                let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
                sides.extend(if side % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
            }
            body.triangles.extend(sides);
            let name = format!("side_{side}");
            body.parts.push(MeshPart { name, triangles: start..body.triangles.len(), measured: true });
        }
        assert!(body.is_closed());
        let thin = decimated(&body, 0.05);
        assert!(thin.is_closed(), "{:?}", thin.edge_faults());
        assert!(thin.triangles.len() < body.triangles.len() / 4, "{}", thin.triangles.len());
        let missing = body.volume_mm3() - thin.volume_mm3();
        assert!(missing > 0.0 && missing < 0.05 * body.area_mm2(), "{missing} mm^3");
    }
}
