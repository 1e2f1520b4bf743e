//! What every mesh file says about itself: what it is, in which unit and frame, and what its colours mean.

use crate::colormap::ColourScale;
use crate::surface::Mesh;
use crate::surface::mesh::{Scalar, ScalarValues};

/// Frame and unit of all mesh files.
pub const FRAME: &str = "gear frame in mm: x through the space at phi = 0, y counter-clockwise from it, z along the \
    tooth from the middle of the face";

/// A mesh on its way to a file.
#[derive(Debug, Clone, Copy)]
pub struct MeshFile<'a> {
    /// The triangles.
    pub mesh: &'a Mesh,
    /// What it is, in a few words: "gear of elliptical_normal".
    pub title: &'a str,
    /// Quantity that the vertices are coloured by, one of the mesh's, and its colours.
    pub colour: (&'a str, ColourScale),
    /// Further texts by name, such as `scene` and `run`.
    pub notes: &'a [(String, String)],
}

impl MeshFile<'_> {
    /// sRGB colour of every vertex; grey where the quantity has no value.
    pub fn vertex_colours(&self) -> Vec<[u8; 3]> {
        let (name, scale) = self.colour;
        match self.mesh.scalar(name) {
            Some(Scalar { values: ScalarValues::F32(values), .. }) => values.iter().map(|&v| scale.colour(v)).collect(),
            Some(Scalar { values: ScalarValues::U32(values), .. }) => {
                values.iter().map(|&v| scale.colour(v as f32)).collect()
            }
            None => vec![scale.colour(f32::NAN); self.mesh.positions_mm.len()],
        }
    }

    /// The quantity that colours show, in words: `stock_mm from 0 to 1.4 mm (viridis, dark to light)`.
    pub fn colour_words(&self) -> String {
        let (name, scale) = self.colour;
        let (low, high) = scale.ends();
        let unit = self.mesh.scalar(name).map_or("", |scalar| scalar.unit);
        let map = match scale {
            ColourScale::Sequential { .. } => "viridis, dark to light",
            ColourScale::Diverging { .. } => "blue through white to red",
        };
        format!("{name} from {low} to {high} {unit} ({map}); grey where there is none")
    }
}
