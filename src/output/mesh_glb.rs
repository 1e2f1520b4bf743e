//! Meshes as binary glTF 2.0: one node per flank, root and tip, so that viewers can pick and hide them by name.
//!
//! glTF asks for metres with y up; places stay in mm of the gear frame in the buffers, and the root node turns and scales them. Every part has vertices of its own with smooth normals, because
//! edges between parts are sharp. Colours are vertex colours in linear light, 16 bits (8 would show steps in the dark). Quantities are the attributes `_HEIGHT_UM`, `_STOCK_MM` and `_PASS_ID`; glTF
//! allows no NaN and no 32-bit integers on vertices, so that parts with missing values go without the attribute, and pass ids are floats (exact up to 2^24).

use crate::output::atomic::write_bytes_atomically;
use crate::output::colormap::NO_VALUE;
use crate::output::mesh_file::{FRAME, MeshFile};
use crate::surface::mesh::{Scalar, ScalarValues};
use crate::{Error, Result};
use glam::DVec3;
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Stride, Target, View};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked::Valid, USize64};
use gltf_json::{Accessor, Buffer, Index, Material, Node, Root, Scene};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// Largest whole number up to which f32 holds all whole numbers.
const EXACT_F32: u32 = 1 << 24;

/// Writes a mesh as `.glb`.
///
/// # Errors
/// A mesh whose buffer exceeds what glTF can address (4 GiB), and files that cannot be written.
pub fn write_glb(path: &Path, file: &MeshFile) -> Result<()> {
    let refused = |reason: String| Error::Output { path: path.to_owned(), reason };
    let (root, buffer) = build(file);
    let text = gltf_json::serialize::to_vec(&root).map_err(|error| refused(error.to_string()))?;
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
    stride: usize,
    target: Target,
}

/// The streams, in the order in which they stand in the buffer.
const POSITION: usize = 0;
const NORMAL: usize = 1;
const COLOUR: usize = 2;
const QUANTITY: usize = 3;
const INDEX: usize = 4;

fn build(file: &MeshFile) -> (Root, Vec<u8>) {
    let mesh = file.mesh;
    let colours = file.vertex_colours();
    let stream = |stride, target| Stream { bytes: Vec::new(), stride, target };
    let mut streams = [
        stream(12, Target::ArrayBuffer),
        stream(12, Target::ArrayBuffer),
        stream(8, Target::ArrayBuffer),
        stream(4, Target::ArrayBuffer),
        stream(4, Target::ElementArrayBuffer),
    ];
    let mut root = Root::default();
    let material = root.push(Material {
        name: Some("cut steel".to_owned()),
        pbr_metallic_roughness: gltf_json::material::PbrMetallicRoughness {
            metallic_factor: gltf_json::material::StrengthFactor(0.1),
            roughness_factor: gltf_json::material::StrengthFactor(0.6),
            ..Default::default()
        },
        ..Material::default()
    });
    let mut nodes = Vec::new();
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
        let vectors = |values: &mut dyn Iterator<Item = DVec3>| -> Vec<[f32; 3]> {
            values.map(|v| v.as_vec3().to_array()).collect()
        };
        let positions = vectors(&mut vertices.iter().map(|&v| mesh.positions_mm[v as usize]));
        let normals = vectors(&mut normals.iter().map(|n| n.try_normalize().unwrap_or(DVec3::Z)));
        let count = vertices.len();
        let bounds = |pick: fn(f32, f32) -> f32| {
            positions.iter().copied().reduce(|a, b| std::array::from_fn(|k| pick(a[k], b[k])))
        };
        let mut attributes = BTreeMap::new();
        let place = push(
            &mut root,
            &mut streams,
            POSITION,
            positions.iter().flatten().flat_map(|x| x.to_le_bytes()),
            Layout {
                bounds: [bounds(f32::min), bounds(f32::max)].map(|b| b.map(|b| json!(b))),
                ..layout(count, Type::Vec3)
            },
        );
        attributes.insert(Valid(Semantic::Positions), place);
        let normals = normals.iter().flatten().flat_map(|x| x.to_le_bytes());
        attributes.insert(
            Valid(Semantic::Normals),
            push(&mut root, &mut streams, NORMAL, normals, layout(count, Type::Vec3)),
        );
        let colour = vertices.iter().flat_map(|&v| {
            let [r, g, b] = if part.measured { colours[v as usize] } else { NO_VALUE }.map(linear_u16);
            [r, g, b, u16::MAX]
        });
        let colour_layout = Layout { component: ComponentType::U16, normalized: true, ..layout(count, Type::Vec4) };
        let colour = push(&mut root, &mut streams, COLOUR, colour.flat_map(u16::to_le_bytes), colour_layout);
        attributes.insert(Valid(Semantic::Colors(0)), colour);
        for scalar in mesh.scalars.iter().filter(|_| part.measured) {
            if let Some(values) = finite_values(scalar, &vertices) {
                let bytes = values.into_iter().flat_map(f32::to_le_bytes);
                let place = push(&mut root, &mut streams, QUANTITY, bytes, layout(count, Type::Scalar));
                attributes.insert(Valid(Semantic::Extras(scalar.name.to_uppercase())), place);
            }
        }
        let index_layout = Layout { component: ComponentType::U32, ..layout(indices.len(), Type::Scalar) };
        let indices =
            push(&mut root, &mut streams, INDEX, indices.into_iter().flat_map(u32::to_le_bytes), index_layout);
        let primitive = Primitive {
            attributes,
            extensions: None,
            extras: None,
            indices: Some(indices),
            material: Some(material),
            mode: Valid(Mode::Triangles),
            targets: None,
        };
        let mesh = root.push(gltf_json::Mesh {
            extensions: None,
            extras: None,
            name: Some(part.name.clone()),
            primitives: vec![primitive],
            weights: None,
        });
        nodes.push(root.push(Node { mesh: Some(mesh), name: Some(part.name.clone()), ..Node::default() }));
    }
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let gear = root.push(Node {
        children: Some(nodes),
        name: Some(file.title.to_owned()),
        rotation: Some(gltf_json::scene::UnitQuaternion([-half, 0.0, 0.0, half])),
        scale: Some([1e-3; 3]),
        ..Node::default()
    });
    let scene =
        root.push(Scene { extensions: None, extras: None, name: Some(file.title.to_owned()), nodes: vec![gear] });
    root.scene = Some(scene);
    root.asset.generator = Some(format!("gearcut {}", env!("CARGO_PKG_VERSION")));
    root.asset.extras = extras(file);
    let buffer = join(&mut root, streams);
    (root, buffer)
}

/// How the values of an accessor lie.
struct Layout {
    count: usize,
    kind: Type,
    component: ComponentType,
    normalized: bool,
    bounds: [Option<Value>; 2],
}

fn layout(count: usize, kind: Type) -> Layout {
    Layout { count, kind, component: ComponentType::F32, normalized: false, bounds: [None, None] }
}

/// Appends values to a stream and describes them.
fn push(
    root: &mut Root,
    streams: &mut [Stream],
    stream: usize,
    bytes: impl Iterator<Item = u8>,
    Layout { count, kind, component, normalized, bounds: [min, max] }: Layout,
) -> Index<Accessor> {
    let offset = streams[stream].bytes.len();
    streams[stream].bytes.extend(bytes);
    root.push(Accessor {
        buffer_view: Some(Index::new(stream as u32)),
        byte_offset: Some(USize64::from(offset)),
        count: USize64::from(count),
        component_type: Valid(GenericComponentType(component)),
        extensions: None,
        extras: None,
        type_: Valid(kind),
        min,
        max,
        name: None,
        normalized,
        sparse: None,
    })
}

/// One buffer of all streams, with a view of each.
fn join(root: &mut Root, streams: [Stream; 5]) -> Vec<u8> {
    let total: usize = streams.iter().map(|s| s.bytes.len()).sum();
    let buffer =
        root.push(Buffer { byte_length: USize64::from(total), extensions: None, extras: None, name: None, uri: None });
    let mut bytes = Vec::with_capacity(total);
    for stream in streams {
        root.push(View {
            buffer,
            byte_length: USize64::from(stream.bytes.len()),
            byte_offset: Some(USize64::from(bytes.len())),
            byte_stride: matches!(stream.target, Target::ArrayBuffer).then_some(Stride(stream.stride)),
            extensions: None,
            extras: None,
            name: None,
            target: Some(Valid(stream.target)),
        });
        bytes.extend(stream.bytes);
    }
    bytes
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

fn extras(file: &MeshFile) -> gltf_json::Extras {
    let quantities: Vec<Value> = file
        .mesh
        .scalars
        .iter()
        .map(
            |s| json!({"attribute": format!("_{}", s.name.to_uppercase()), "unit": s.unit, "definition": s.definition}),
        )
        .collect();
    let mut extras = serde_json::Map::new();
    extras.insert("program".to_owned(), json!("gearcut"));
    extras.insert("buffer_unit".to_owned(), json!("mm"));
    extras.insert("frame".to_owned(), json!(FRAME));
    extras.insert("colours".to_owned(), json!(file.colour_words()));
    extras.insert("quantities".to_owned(), json!(quantities));
    extras.extend(file.notes.iter().map(|(name, text)| (name.clone(), json!(text))));
    serde_json::value::to_raw_value(&Value::Object(extras)).ok()
}
