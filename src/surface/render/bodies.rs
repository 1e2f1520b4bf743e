//! What is drawn: bodies with a look, made ready for rays.
//!
//! In: meshes. Out: [`Shape`], one tree over all triangles with normals at their corners; and with a look for each body
//! [`Bodies`], what a ray finds where it meets one. Pictures that colour the same bodies differently share their shape.
//!
//! Normals at a corner are the mean, weighted by angles, of the triangles round it that lean less than `CREASE_RAD`
//! against this one: flanks look smooth, edges stay sharp, whatever the mesh.

use super::bvh::{Bvh, Hit};
use crate::colormap::ColourScale;
use crate::surface::Mesh;
use crate::surface::mesh::ScalarValues;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::LazyLock;

/// Triangles that lean more than this against each other meet at an edge: 30 degrees, between the turn of a fillet per
/// 0.1 mm and the corner at a tip.
const CREASE_RAD: f64 = std::f64::consts::FRAC_PI_6;

/// How a body looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Appearance {
    /// One colour, linear light, with a highlight of this strength.
    Plain {
        /// Red, green, blue; 0 to 1.
        colour: [f64; 3],
        /// 0: matt like clay; 1: polished steel.
        gloss: f64,
    },
    /// Coloured by a quantity of the mesh.
    Scalar {
        /// Name of the quantity.
        name: &'static str,
        /// Its colours.
        scale: ColourScale,
    },
}

/// Clay.
pub const CLAY: Appearance = Appearance::Plain { colour: [0.50, 0.475, 0.44], gloss: 0.05 };
/// Steel of a tool.
pub const STEEL: Appearance = Appearance::Plain { colour: [0.30, 0.36, 0.44], gloss: 0.6 };

/// Bodies ready for rays, without colours.
pub struct Shape<'a> {
    meshes: Vec<&'a Mesh>,
    /// First triangle of each body in the tree.
    starts: Vec<usize>,
    tree: Bvh,
    /// Normals at the corners of every triangle.
    normals: Vec<[DVec3; 3]>,
    /// Diagonal of the box round everything, mm.
    size_mm: f64,
}

impl<'a> Shape<'a> {
    /// Makes bodies ready.
    pub fn new(meshes: Vec<&'a Mesh>) -> Self {
        let mut starts = Vec::with_capacity(meshes.len());
        let (mut corners, mut normals) = (Vec::new(), Vec::new());
        for mesh in &meshes {
            starts.push(corners.len());
            corners.extend((0..mesh.triangles.len()).map(|t| mesh.corners_mm(t)));
            normals.extend(corner_normals(mesh));
        }
        let bounds = meshes.iter().filter_map(|mesh| mesh.bounds_mm());
        let size_mm =
            bounds.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).map_or(1.0, |[low, high]| low.distance(high));
        Self { meshes, starts, tree: Bvh::new(&corners), normals, size_mm }
    }
}

/// Bodies ready to be drawn.
pub struct Bodies<'a> {
    shape: &'a Shape<'a>,
    bodies: Vec<Body<'a>>,
}

/// A body's look, with the values that it shows.
struct Body<'a> {
    look: Appearance,
    values: Option<&'a ScalarValues>,
    passes: Option<&'a [u32]>,
}

/// What a ray finds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyHit {
    /// Distance along the ray, mm.
    pub distance_mm: f64,
    /// Smooth unit normal, on the side from which the ray meets the triangle; at the rim of a round body it may lean
    /// away from the ray.
    pub normal: DVec3,
    /// Unit normal of the triangle, towards the ray's origin.
    pub flat: DVec3,
    /// Colour in linear light.
    pub colour: [f64; 3],
    /// Strength of highlights.
    pub gloss: f64,
    /// Value of the quantity that colours show, in the unit of its scale; NaN where there is none.
    pub value: f32,
    /// Pass that left the nearest vertex, if the mesh knows.
    pub pass: Option<u32>,
}

impl<'a> Bodies<'a> {
    /// Bodies with a look for each.
    pub fn new(shape: &'a Shape<'a>, looks: Vec<Appearance>) -> Self {
        let body = |(mesh, look): (&&'a Mesh, Appearance)| {
            let values = |name: &str| mesh.scalar(name).map(|scalar| &scalar.values);
            let shown = if let Appearance::Scalar { name, .. } = look { values(name) } else { None };
            let passes = match values("pass_id") {
                Some(ScalarValues::U32(passes)) => Some(passes.as_slice()),
                _ => None,
            };
            Body { look, values: shown, passes }
        };
        Self { shape, bodies: shape.meshes.iter().zip(looks).map(body).collect() }
    }

    /// Diagonal of the box round everything, mm.
    pub fn size_mm(&self) -> f64 {
        self.shape.size_mm
    }

    /// The tree over their triangles.
    pub fn tree(&self) -> &'a Bvh {
        &self.shape.tree
    }

    /// Whether anything stands within `limit_mm` of a place.
    pub fn is_blocked(&self, origin_mm: DVec3, direction: DVec3, limit_mm: f64) -> bool {
        self.shape.tree.is_blocked(origin_mm, direction, limit_mm)
    }

    /// What a ray of this direction finds where it meets a triangle.
    pub fn found(&self, hit: &Hit, direction: DVec3) -> BodyHit {
        let global = hit.triangle as usize;
        let shape = self.shape;
        let index = shape.starts.partition_point(|&start| start <= global) - 1;
        let (mesh, body) = (shape.meshes[index], &self.bodies[index]);
        let triangle = global - shape.starts[index];
        let [b, c] = hit.weights;
        let weights = [1.0 - b - c, b, c];
        let [n0, n1, n2] = shape.normals[global];
        let outward = mesh.scaled_normal(triangle).normalize_or_zero();
        let sense = if outward.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        let flat = sense * outward;
        let normal = weights[0] * n0 + weights[1] * n1 + weights[2] * n2;
        let normal = normal.try_normalize().map_or(flat, |normal| sense * normal);
        let vertices = mesh.triangles[triangle].map(|v| v as usize);
        let nearest = vertices[(0..3).max_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0)];
        let part = mesh.parts.partition_point(|part| part.triangles.end <= triangle);
        let measured = mesh.parts.get(part).is_none_or(|part| part.measured);
        let pass = body.passes.filter(|_| measured).map(|passes| passes[nearest]);
        let (colour, gloss, value) = match body.look {
            Appearance::Plain { colour, gloss } => (colour, gloss, f32::NAN),
            Appearance::Scalar { scale, .. } => {
                let value = match body.values.filter(|_| measured) {
                    Some(ScalarValues::F32(values)) => {
                        let sum: f64 = (0..3).map(|k| weights[k] * f64::from(values[vertices[k]])).sum();
                        sum as f32
                    }
                    // Identifiers have no values in between.
                    Some(ScalarValues::U32(values)) if values[nearest] != u32::MAX => values[nearest] as f32,
                    _ => f32::NAN,
                };
                let colour = if value.is_nan() { BARE } else { scale.colour(value).map(linear) };
                (colour, 0.05, value)
            }
        };
        BodyHit { distance_mm: hit.distance_mm, normal, flat, colour, gloss, value, pass }
    }
}

/// Where a coloured body has no value: light clay, which no scale contains.
pub(super) const BARE: [f64; 3] = [0.45, 0.44, 0.42];

/// sRGB component (IEC 61966-2-1) to linear light, 0 to 1.
fn linear(component: u8) -> f64 {
    static LIGHT: LazyLock<[f64; 256]> = LazyLock::new(|| {
        std::array::from_fn(|component| {
            let c = component as f64 / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        })
    });
    LIGHT[usize::from(component)]
}

fn corner_normals(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let crease_cos = CREASE_RAD.cos();
    let flat: Vec<DVec3> = (0..mesh.triangles.len()).map(|t| mesh.scaled_normal(t).normalize_or_zero()).collect();
    // Triangles round every vertex, with the angle they take there: counted, summed up, filled in.
    let mut starts = vec![0_u32; mesh.positions_mm.len() + 1];
    for vertex in mesh.triangles.iter().flatten() {
        starts[*vertex as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let angles = |t: usize| -> [f64; 3] {
        let corners = mesh.corners_mm(t);
        [0, 1, 2].map(|k| (corners[(k + 1) % 3] - corners[k]).angle_between(corners[(k + 2) % 3] - corners[k]))
    };
    let angles: Vec<[f64; 3]> = (0..mesh.triangles.len()).into_par_iter().map(angles).collect();
    let mut next = starts.clone();
    let mut round = vec![(0_u32, 0.0_f64); mesh.triangles.len() * 3];
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for (vertex, angle) in triangle.iter().zip(angles[t]) {
            let place = &mut next[*vertex as usize];
            round[*place as usize] = (t as u32, angle);
            *place += 1;
        }
    }
    let normal_at = |t: usize, vertex: u32| {
        let around = &round[starts[vertex as usize] as usize..starts[vertex as usize + 1] as usize];
        let sum: DVec3 = around
            .iter()
            .filter(|(other, angle)| angle.is_finite() && flat[*other as usize].dot(flat[t]) > crease_cos)
            .map(|(other, angle)| *angle * flat[*other as usize])
            .sum();
        sum.try_normalize().unwrap_or(flat[t])
    };
    mesh.triangles.par_iter().enumerate().map(|(t, triangle)| triangle.map(|vertex| normal_at(t, vertex))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Prism over a regular polygon with a part of its own at the top.
    fn prism(corners: u32) -> Mesh {
        let ring = |z: f64| {
            (0..corners).map(move |i| {
                let a = TAU * f64::from(i) / f64::from(corners);
                DVec3::new(10.0 * a.cos(), 10.0 * a.sin(), z)
            })
        };
        let n = corners;
        let sides = (0..n).flat_map(|i| {
            let j = (i + 1) % n;
            [[i, j, n + j], [i, n + j, n + i]]
        });
        let top = (1..n - 1).map(|i| [n, n + i, n + i + 1]);
        Mesh {
            positions_mm: ring(0.0).chain(ring(5.0)).collect(),
            triangles: sides.chain(top).collect(),
            ..Mesh::default()
        }
    }

    #[test]
    fn round_walls_are_smooth_and_edges_are_sharp() {
        let mesh = prism(64);
        let normals = corner_normals(&mesh);
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for (k, vertex) in triangle.iter().enumerate() {
                let place = mesh.positions_mm[*vertex as usize];
                let expected = if t < 128 { place.truncate().normalize().extend(0.0) } else { DVec3::Z };
                assert!(normals[t][k].distance(expected) < 1e-12, "triangle {t}: {:?}", normals[t][k]);
            }
        }
        // Of a box, every face is flat.
        let cube = prism(4);
        for (t, normals) in corner_normals(&cube).iter().enumerate() {
            assert!(normals.iter().all(|n| n.distance(cube.scaled_normal(t).normalize()) < 1e-12));
        }
    }

    #[test]
    fn rays_find_values_normals_and_passes() {
        let mut mesh = prism(64);
        let heights: Vec<f32> = mesh.positions_mm.iter().map(|p| p.z as f32).collect();
        mesh.scalars.push(crate::surface::flanks::height_scalar(heights));
        mesh.scalars.push(crate::surface::flanks::pass_scalar((0..128).collect()));
        let scale = ColourScale::Sequential { low: 0.0, high: 10.0 };
        let shape = Shape::new(vec![&mesh]);
        let bodies = Bodies::new(&shape, vec![Appearance::Scalar { name: "height_um", scale }]);
        let first = |origin_mm| bodies.tree().first(origin_mm, DVec3::NEG_X, f64::INFINITY);
        let hit = first(DVec3::new(30.0, 0.0, 2.0)).expect("meets the wall");
        let found = bodies.found(&hit, DVec3::NEG_X);
        assert!((found.distance_mm - 20.0).abs() < 1e-9);
        assert!((found.value - 2.0).abs() < 1e-5);
        assert!(found.normal.distance(DVec3::X) < 1e-9);
        assert_eq!(found.pass, Some(0));
        assert!(bodies.is_blocked(DVec3::ZERO, DVec3::X, 10.5) && !bodies.is_blocked(DVec3::ZERO, DVec3::X, 9.5));
        assert_eq!(first(DVec3::new(30.0, 0.0, 6.0)), None);
    }
}
