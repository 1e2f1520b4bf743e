//! Meshes as binary PLY: places, colours and every quantity by vertex.
//!
//! Layout (G. Turk, 1994): a text header that names the properties, then the vertices and the triangles as
//! little-endian records. Comments say units, frame, definitions and the names of the parts. Colours are sRGB, as PLY
//! viewers take them; quantities are properties of their own name (`height_um`, `stock_mm`, `pass_id`), NaN where there
//! is no value.
//!
//! Road not taken: the part as a property of the triangles. Widely used readers fail on any property beside the list.

use crate::output::atomic::write_atomically;
use crate::output::mesh_file::{FRAME, MeshFile};
use crate::surface::mesh::ScalarValues;
use gearcut_core::Result;
use std::fmt::Write as _;
use std::path::Path;

/// Writes a mesh as binary PLY.
///
/// # Errors
/// Files that cannot be written.
pub fn write_ply(path: &Path, file: &MeshFile) -> Result<()> {
    let mesh = file.mesh;
    let colours = file.vertex_colours();
    write_atomically(path, |sink| {
        sink.write_all(header(file).as_bytes())?;
        let mut record = Vec::new();
        for (vertex, (position, colour)) in mesh.positions_mm.iter().zip(&colours).enumerate() {
            record.clear();
            record.extend(position.to_array().into_iter().flat_map(|x| (x as f32).to_le_bytes()));
            record.extend(colour);
            for scalar in &mesh.scalars {
                match &scalar.values {
                    ScalarValues::F32(values) => record.extend(values[vertex].to_le_bytes()),
                    ScalarValues::U32(values) => record.extend(values[vertex].to_le_bytes()),
                }
            }
            sink.write_all(&record)?;
        }
        for triangle in &mesh.triangles {
            record.clear();
            record.push(3);
            record.extend(triangle.iter().flat_map(|vertex| vertex.to_le_bytes()));
            sink.write_all(&record)?;
        }
        Ok(())
    })
}

fn header(file: &MeshFile) -> String {
    let mesh = file.mesh;
    let mut text = String::from("ply\nformat binary_little_endian 1.0\n");
    let mut line = |words: &str| {
        // A comment ends with its line; notes of several lines become several comments.
        let _never_fails = writeln!(text, "{words}");
    };
    line(&format!("comment gearcut: {}", file.title));
    line(&format!("comment frame: {FRAME}"));
    line(&format!("comment colours: {}", file.colour_words()));
    for scalar in &mesh.scalars {
        line(&format!("comment {} [{}]: {}", scalar.name, scalar.unit, scalar.definition));
    }
    // A part of a gear that is cut away has no triangles.
    for part in mesh.parts.iter().filter(|part| !part.triangles.is_empty()) {
        line(&format!("comment triangles {} to {}: {}", part.triangles.start, part.triangles.end - 1, part.name));
    }
    line(&format!("element vertex {}", mesh.positions_mm.len()));
    for name in ["x", "y", "z"] {
        line(&format!("property float {name}"));
    }
    for name in ["red", "green", "blue"] {
        line(&format!("property uchar {name}"));
    }
    for scalar in &mesh.scalars {
        let kind = match scalar.values {
            ScalarValues::F32(_) => "float",
            ScalarValues::U32(_) => "uint",
        };
        line(&format!("property {kind} {}", scalar.name));
    }
    line(&format!("element face {}", mesh.triangles.len()));
    line("property list uchar int vertex_indices");
    line("end_header");
    text
}
