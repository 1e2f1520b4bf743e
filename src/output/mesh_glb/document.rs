//! The JSON chunk of a binary glTF 2.0 file: the objects of the standard with the properties that gear meshes need.
//!
//! Names, numbers and defaults are those of "glTF 2.0 Specification" (Khronos 2021), section 5; what is left out has
//! its default. Fields are written in their order here. Road not taken: a crate with all objects of the standard, of
//! which gears need nine; it took 18 s of every build from nothing.

use serde::Serialize;
use serde_json::{Map, Value};

/// Extension that allows whole numbers as places (Khronos, ratified 2020).
pub const QUANTIZATION: &str = "KHR_mesh_quantization";
/// Values of an accessor are 16-bit unsigned.
pub const UNSIGNED_SHORT: u32 = 5123;
/// Values of an accessor are 32-bit unsigned.
pub const UNSIGNED_INT: u32 = 5125;
/// Values of an accessor are 32-bit floats.
pub const FLOAT: u32 = 5126;
/// A view holds attributes of vertices.
pub const ARRAY_BUFFER: u32 = 34962;
/// A view holds vertex numbers.
pub const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The whole chunk.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Document {
    pub accessors: Vec<Accessor>,
    pub asset: Asset,
    pub extensions_required: [&'static str; 1],
    pub extensions_used: [&'static str; 1],
    pub buffers: [Buffer; 1],
    pub buffer_views: Vec<GltfView>,
    /// Number of the scene that viewers show first.
    pub scene: usize,
    pub materials: [Material; 1],
    pub meshes: Vec<GltfMesh>,
    pub nodes: Vec<GltfNode>,
    pub scenes: [GltfScene; 1],
}

/// Some values of a view.
#[derive(Serialize, Clone, Copy)]
#[serde(rename_all = "camelCase")]
pub struct Accessor {
    pub buffer_view: usize,
    /// First byte in the view.
    pub byte_offset: usize,
    pub count: usize,
    pub component_type: u32,
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Smallest components; the standard asks for them where the values are places.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<[f64; 3]>,
    /// Integers that stand for 0 to 1.
    #[serde(skip_serializing_if = "is_false")]
    pub normalized: bool,
}

/// What is known about the whole file.
#[derive(Serialize)]
pub struct Asset {
    pub extras: Map<String, Value>,
    pub generator: String,
    pub version: &'static str,
}

/// The binary chunk.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Buffer {
    pub byte_length: usize,
}

/// A piece of the binary chunk.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct GltfView {
    pub buffer: usize,
    pub byte_length: usize,
    pub byte_offset: usize,
    /// Bytes from vertex to vertex.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub byte_stride: Option<usize>,
    pub target: u32,
}

/// How a surface reflects.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Material {
    pub alpha_mode: &'static str,
    pub double_sided: bool,
    pub name: &'static str,
    pub pbr_metallic_roughness: MetallicRoughness,
    pub emissive_factor: [f32; 3],
}

/// Reflection of a rough metal.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
#[expect(clippy::struct_field_names, reason = "the standard's names")]
pub struct MetallicRoughness {
    pub base_color_factor: [f32; 4],
    pub metallic_factor: f32,
    pub roughness_factor: f32,
}

/// One part of the gear.
#[derive(Serialize)]
pub struct GltfMesh {
    pub name: String,
    pub primitives: [Primitive; 1],
}

/// Triangles with the accessors of their attributes by name.
#[derive(Serialize)]
pub struct Primitive {
    pub attributes: Map<String, Value>,
    pub indices: usize,
    pub material: usize,
}

/// A part in its place, or the gear with all its parts as children.
#[derive(Serialize, Default)]
pub struct GltfNode {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub children: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<usize>,
    pub name: String,
    /// Quaternion x, y, z, w.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f32; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub translation: Option<[f64; 3]>,
}

/// The nodes that viewers show.
#[derive(Serialize)]
pub struct GltfScene {
    pub name: String,
    pub nodes: [usize; 1],
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over references")]
fn is_false(value: &bool) -> bool {
    !value
}
