//! Meshes as binary glTF 2.0: one node per flank, root and tip, so that viewers can pick and hide them by name.
//!
//! glTF asks for metres with y up; the gear frame in mm is the root node's, which turns and scales it. Every part has
//! vertices of its own with smooth normals, because edges between parts are sharp. Places are whole numbers of 16 bits
//! (`KHR_mesh_quantization`): the part's lowest corner and so many steps of its longest side over 65,535, which the
//! part's node adds and scales; a flank of 30 mm is off by a quarter of a micrometre at most. Normals are floats:
//! readers that are not told otherwise take whole numbers for what they are, and of normals that is seen. Colours are
//! vertex colours in linear light, 16 bits (8 would show steps in the dark). Quantities are the attributes
//! `_HEIGHT_UM`, `_STOCK_MM` and `_PASS_ID`, not rounded; glTF allows no NaN and no 32-bit integers on vertices, so
//! that parts with missing values go without the attribute, and pass ids are floats (exact up to 2^24).

mod document;

use crate::colormap::NO_VALUE;
use crate::output::atomic::write_bytes_atomically;
use crate::output::mesh_file::{FRAME, MeshFile};
use crate::surface::mesh::{Scalar, ScalarValues};
use document::{
    ARRAY_BUFFER, Accessor, Asset, Buffer, Document, ELEMENT_ARRAY_BUFFER, FLOAT, GltfMesh, GltfNode, GltfScene,
    GltfView, Material, MetallicRoughness, Primitive, QUANTIZATION, UNSIGNED_INT, UNSIGNED_SHORT,
};
use gearcut_core::{Error, Result};
use glam::DVec3;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Largest whole number up to which f32 holds all whole numbers.
const EXACT_F32: u32 = 1 << 24;

/// Writes a mesh as `.glb`.
///
/// # Errors
/// A mesh whose buffer exceeds what glTF can address (4 GiB), and files that cannot be written.
pub fn write_glb(path: &Path, file: &MeshFile) -> Result<()> {
    let refused = |reason: String| Error::Output { path: path.to_owned(), reason };
    let (document, buffer) = build(file);
    let text = serde_json::to_vec(&document).map_err(|error| refused(error.to_string()))?;
    let bytes = container(text, buffer).ok_or_else(|| refused("the mesh is larger than 4 GiB".to_owned()))?;
    write_bytes_atomically(path, &bytes)
}

/// Header and two chunks, each padded to four bytes (glTF 2.0, "GLB File Format Specification").
fn container(mut text: Vec<u8>, mut buffer: Vec<u8>) -> Option<Vec<u8>> {
    text.resize(text.len().next_multiple_of(4), b' ');
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let total = u32::try_from(12 + 8 + text.len() + 8 + buffer.len()).ok()?;
    let mut bytes = Vec::with_capacity(total as usize);
    bytes.extend(b"glTF");
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend(total.to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", buffer)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    Some(bytes)
}

/// One stream of the buffer: all values of one attribute, part after part.
struct Stream {
    bytes: Vec<u8>,
    /// Bytes of a vertex; none for vertex numbers.
    stride: Option<usize>,
}

/// The streams, in the order in which they stand in the buffer.
const POSITION: usize = 0;
const NORMAL: usize = 1;
const COLOUR: usize = 2;
const QUANTITY: usize = 3;
const LONG_INDEX: usize = 4;
const INDEX: usize = 5;
const STREAMS: usize = 6;

/// Steps in the longest side of a part.
const STEPS: f64 = u16::MAX as f64;

/// Streams and the accessors into them.
struct Streams {
    streams: [Stream; STREAMS],
    accessors: Vec<Accessor>,
}

fn build(file: &MeshFile) -> (Document, Vec<u8>) {
    let mesh = file.mesh;
    let colours = file.vertex_colours();
    let stream = |stride| Stream { bytes: Vec::new(), stride };
    // Three components of 16 bits begin on multiples of four bytes.
    let streams = [stream(Some(8)), stream(Some(12)), stream(Some(8)), stream(Some(4)), stream(None), stream(None)];
    let mut values = Streams { streams, accessors: Vec::new() };
    let (mut meshes, mut nodes) = (Vec::new(), Vec::new());
    let mut local = vec![u32::MAX; mesh.positions_mm.len()];
    for part in &mesh.parts {
        // Vertices of the part in the order of their first use.
        let mut vertices: Vec<u32> = Vec::new();
        let mut indices: Vec<u32> = Vec::new();
        let mut normals: Vec<DVec3> = Vec::new();
        for t in part.triangles.clone() {
            let scaled = mesh.scaled_normal(t);
            for vertex in mesh.triangles[t] {
                let place = &mut local[vertex as usize];
                if *place == u32::MAX {
                    *place = vertices.len() as u32;
                    vertices.push(vertex);
                    normals.push(DVec3::ZERO);
                }
                normals[*place as usize] += scaled;
                indices.push(*place);
            }
        }
        for &vertex in &vertices {
            local[vertex as usize] = u32::MAX;
        }
        let places_mm = || vertices.iter().map(|&v| mesh.positions_mm[v as usize]);
        let low_mm = places_mm().reduce(DVec3::min).unwrap_or_default();
        let longest_mm = places_mm().map(|p| (p - low_mm).max_element()).fold(0.0, f64::max);
        let step_mm = if longest_mm > 0.0 { longest_mm / STEPS } else { 1.0 };
        let steps: Vec<DVec3> = places_mm().map(|p| ((p - low_mm) / step_mm).round()).collect();
        let count = vertices.len();
        let bounds = |pick: fn(DVec3, DVec3) -> DVec3| steps.iter().copied().reduce(pick).map(|bound| bound.to_array());
        let position = values.push(
            POSITION,
            steps.iter().flat_map(|p| [p.x, p.y, p.z, 0.0]).flat_map(|x| (x as u16).to_le_bytes()),
            Accessor {
                component_type: UNSIGNED_SHORT,
                min: bounds(DVec3::min),
                max: bounds(DVec3::max),
                ..floats(count, "VEC3")
            },
        );
        let unit = |n: &DVec3| n.try_normalize().unwrap_or(DVec3::Z).as_vec3().to_array();
        let normal =
            values.push(NORMAL, normals.iter().flat_map(unit).flat_map(f32::to_le_bytes), floats(count, "VEC3"));
        let colour = vertices.iter().flat_map(|&v| {
            let [r, g, b] = if part.measured { colours[v as usize] } else { NO_VALUE }.map(linear_u16);
            [r, g, b, u16::MAX]
        });
        let layout = Accessor { component_type: UNSIGNED_SHORT, normalized: true, ..floats(count, "VEC4") };
        let colour = values.push(COLOUR, colour.flat_map(u16::to_le_bytes), layout);
        let mut quantities = Vec::new();
        for scalar in mesh.scalars.iter().filter(|_| part.measured) {
            if let Some(finite) = finite_values(scalar, &vertices) {
                let bytes = finite.into_iter().flat_map(f32::to_le_bytes);
                quantities.push((attribute(scalar), values.push(QUANTITY, bytes, floats(count, "SCALAR"))));
            }
        }
        quantities.sort();
        let layout = |component_type| Accessor { component_type, ..floats(indices.len(), "SCALAR") };
        // The largest number of each kind ends a strip.
        let indices = if u16::try_from(count).is_ok() {
            values.push(INDEX, indices.iter().flat_map(|&i| (i as u16).to_le_bytes()), layout(UNSIGNED_SHORT))
        } else {
            values.push(LONG_INDEX, indices.iter().flat_map(|i| i.to_le_bytes()), layout(UNSIGNED_INT))
        };
        let standard = [("POSITION", position), ("NORMAL", normal), ("COLOR_0", colour)];
        let attributes = quantities.into_iter().chain(standard.map(|(name, place)| (name.to_owned(), place)));
        let attributes = attributes.map(|(name, place)| (name, json!(place))).collect();
        nodes.push(GltfNode {
            mesh: Some(meshes.len()),
            name: part.name.clone(),
            scale: Some([step_mm; 3]),
            translation: Some(low_mm.to_array()),
            ..GltfNode::default()
        });
        meshes.push(GltfMesh { name: part.name.clone(), primitives: [Primitive { attributes, indices, material: 0 }] });
    }
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let gear = nodes.len();
    nodes.push(GltfNode {
        children: (0..gear).collect(),
        name: file.title.to_owned(),
        rotation: Some([-half, 0.0, 0.0, half]),
        scale: Some([1e-3; 3]),
        ..GltfNode::default()
    });
    let (buffer_views, accessors, buffer) = join(values);
    let document = Document {
        accessors,
        asset: Asset {
            extras: extras(file),
            generator: format!("gearcut {}", env!("CARGO_PKG_VERSION")),
            version: "2.0",
        },
        extensions_required: [QUANTIZATION],
        extensions_used: [QUANTIZATION],
        buffers: [Buffer { byte_length: buffer.len() }],
        buffer_views,
        scene: 0,
        materials: [Material {
            alpha_mode: "OPAQUE",
            double_sided: false,
            name: "cut steel",
            pbr_metallic_roughness: MetallicRoughness {
                base_color_factor: [1.0; 4],
                metallic_factor: 0.1,
                roughness_factor: 0.6,
            },
            emissive_factor: [0.0; 3],
        }],
        meshes,
        nodes,
        scenes: [GltfScene { name: file.title.to_owned(), nodes: [gear] }],
    };
    (document, buffer)
}

/// Layout of floats; [`Streams::push`] sets their place.
fn floats(count: usize, kind: &'static str) -> Accessor {
    let (buffer_view, byte_offset) = (0, 0);
    Accessor { buffer_view, byte_offset, count, component_type: FLOAT, kind, min: None, max: None, normalized: false }
}

impl Streams {
    /// Appends values to a stream; gives the number of their accessor.
    fn push(&mut self, stream: usize, bytes: impl Iterator<Item = u8>, layout: Accessor) -> usize {
        let to = &mut self.streams[stream].bytes;
        self.accessors.push(Accessor { buffer_view: stream, byte_offset: to.len(), ..layout });
        to.extend(bytes);
        self.accessors.len() - 1
    }
}

/// A view of each stream that has bytes, and one buffer of all of them.
fn join(Streams { streams, mut accessors }: Streams) -> (Vec<GltfView>, Vec<Accessor>, Vec<u8>) {
    let (mut views, mut bytes) = (Vec::new(), Vec::new());
    let mut numbers = [0; STREAMS];
    for (number, stream) in numbers.iter_mut().zip(streams).filter(|(_, stream)| !stream.bytes.is_empty()) {
        *number = views.len();
        views.push(GltfView {
            buffer: 0,
            byte_length: stream.bytes.len(),
            byte_offset: bytes.len(),
            byte_stride: stream.stride,
            target: if stream.stride.is_some() { ARRAY_BUFFER } else { ELEMENT_ARRAY_BUFFER },
        });
        bytes.extend(stream.bytes);
    }
    for accessor in &mut accessors {
        accessor.buffer_view = numbers[accessor.buffer_view];
    }
    (views, accessors, bytes)
}

/// Name of a quantity's attribute; the standard asks for the underscore.
fn attribute(scalar: &Scalar) -> String {
    format!("_{}", scalar.name.to_uppercase())
}

/// Values of a quantity on some vertices as f32; `None` if one is missing or cannot be told exactly.
fn finite_values(scalar: &Scalar, vertices: &[u32]) -> Option<Vec<f32>> {
    match &scalar.values {
        ScalarValues::F32(values) => {
            vertices.iter().map(|&v| Some(values[v as usize]).filter(|x| x.is_finite())).collect()
        }
        ScalarValues::U32(values) => {
            vertices.iter().map(|&v| Some(values[v as usize]).filter(|&x| x <= EXACT_F32).map(|x| x as f32)).collect()
        }
    }
}

/// sRGB component (IEC 61966-2-1) in linear light.
fn linear_u16(component: u8) -> u16 {
    let c = f64::from(component) / 255.0;
    let linear = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    (linear * f64::from(u16::MAX)).round() as u16
}

fn extras(file: &MeshFile) -> Map<String, Value> {
    let quantity = |s: &Scalar| json!({"attribute": attribute(s), "unit": s.unit, "definition": s.definition});
    let quantities: Vec<Value> = file.mesh.scalars.iter().map(quantity).collect();
    let mut extras = Map::new();
    extras.insert("program".to_owned(), json!("gearcut"));
    extras.insert("buffer_unit".to_owned(), json!("mm"));
    extras.insert("frame".to_owned(), json!(FRAME));
    extras.insert("colours".to_owned(), json!(file.colour_words()));
    extras.insert("quantities".to_owned(), json!(quantities));
    extras.extend(file.notes.iter().map(|(name, text)| (name.clone(), json!(text))));
    extras
}
