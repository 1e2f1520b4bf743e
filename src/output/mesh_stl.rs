//! Triangles as binary STL: what slicers, CAM and CAD systems open.
//!
//! Layout (3D Systems, 1989): 80 bytes of text, the number of triangles as u32, then per triangle the normal and three
//! corners as f32 and two spare bytes, all little endian. STL knows neither units nor neighbours: the text says mm, and
//! corners are equal bytes wherever triangles meet, so that readers can weld them again.

use crate::output::atomic::write_atomically;
use crate::output::mesh_file::MeshFile;
use gearcut_core::{Error, Result};
use glam::DVec3;
use std::path::Path;

const HEADER_BYTES: usize = 80;

/// Writes a mesh as binary STL.
///
/// # Errors
/// More triangles than the format can count, and files that cannot be written.
pub fn write_stl(path: &Path, file: &MeshFile) -> Result<()> {
    let mesh = file.mesh;
    let count = u32::try_from(mesh.triangles.len())
        .map_err(|error| Error::Output { path: path.to_owned(), reason: error.to_string() })?;
    // A file that begins with "solid" would be taken for text.
    let words = format!("gearcut, mm: {}", file.title);
    let mut header = [b' '; HEADER_BYTES];
    for (place, byte) in header.iter_mut().zip(words.bytes()) {
        *place = if byte.is_ascii() { byte } else { b'?' };
    }
    write_atomically(path, |sink| {
        sink.write_all(&header)?;
        sink.write_all(&count.to_le_bytes())?;
        for triangle in 0..mesh.triangles.len() {
            let normal = mesh.scaled_normal(triangle).normalize_or_zero();
            let [a, b, c] = mesh.corners_mm(triangle);
            let mut record = [0_u8; 50];
            let numbers = [normal, a, b, c].into_iter().flat_map(|v: DVec3| v.to_array());
            for (place, number) in record.chunks_exact_mut(4).zip(numbers) {
                place.copy_from_slice(&(number as f32).to_le_bytes());
            }
            sink.write_all(&record)?;
        }
        Ok(())
    })
}
