//! Maps of one flank: what every operation left, as pictures and as EXR for other programs.
//!
//! In: the cut field at dexel spacing. Out: `maps/<operation>/tooth_07_left.{png,exr}` (height over the target) and `allowance/tooth_07_left.{png,exr}` (stock of each earlier operation
//! over the finished surface). Maps have a spacing of their own (the scene's `output.map_spacing_mm`): each value is the dexel nearest to the map's place, not a mean, so that no feed mark is
//! smoothed into a wrong height.

use super::colormap::ColourScale;
use super::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
use super::folder::OutputFolder;
use super::grid::{MapAxis, MapGrid};
use super::map_png::{MapPicture, write_map_png};
use crate::dexel::{Field, Layer, NO_PASS};
use crate::error::Result;
use crate::gear::generation::Side;
use crate::units::UM_PER_MM;

/// What map readers need to know about u and v.
const FRAME: &str = "flank frame: u = arc length along the target profile from the form point to the tip, v = place along the tooth from the middle of the face; heights along the target's outward normal, positive = material left";

/// Maps of one flank on its own grid.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankMaps {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Places.
    pub grid: MapGrid,
    /// Height over the target after each operation, mm; NaN where no pass came.
    pub heights_mm: Vec<Vec<f32>>,
    /// Pass that left it, after each operation.
    pub passes: Vec<Vec<u32>>,
}

impl FlankMaps {
    /// Takes the dexels nearest to the places of a map with `spacing_mm`.
    pub fn sample(tooth: u32, side: Side, field: &Field, layers: &[Layer], spacing_mm: f64) -> Self {
        let rows = field.rows();
        let lengths = [field.columns.last().map_or(0.0, |c| c.arc_mm), field.leads_mm[rows - 1] - field.leads_mm[0]];
        let axis = |name: &str, meaning: &str, start_mm: f64, length_mm: f64| {
            let count = (length_mm / spacing_mm).floor() as usize + 1;
            MapAxis { name: name.into(), meaning: meaning.into(), start_mm, step_mm: spacing_mm, count }
        };
        let grid = MapGrid {
            u: axis("u", "along the profile from the form point", 0.0, lengths[0]),
            v: axis("v", "along the tooth from the middle of the face", field.leads_mm[0], lengths[1]),
        };
        let nearest = |place_mm: f64, places: &mut dyn Iterator<Item = f64>| {
            places
                .enumerate()
                .min_by(|a, b| (a.1 - place_mm).abs().total_cmp(&(b.1 - place_mm).abs()))
                .map_or(0, |(index, _)| index)
        };
        let columns: Vec<usize> = (0..grid.u.count)
            .map(|i| nearest(grid.u.place_mm(i), &mut field.columns.iter().map(|c| c.arc_mm)))
            .collect();
        let leads: Vec<usize> =
            (0..grid.v.count).map(|i| nearest(grid.v.place_mm(i), &mut field.leads_mm.iter().copied())).collect();
        let dexels: Vec<usize> =
            columns.iter().flat_map(|column| leads.iter().map(move |row| column * rows + row)).collect();
        let height = |layer: &Layer, i: usize| if layer.passes[i] == NO_PASS { f32::NAN } else { layer.heights_mm[i] };
        Self {
            tooth,
            side,
            heights_mm: layers.iter().map(|layer| dexels.iter().map(|&i| height(layer, i)).collect()).collect(),
            passes: layers.iter().map(|layer| dexels.iter().map(|&i| layer.passes[i]).collect()).collect(),
            grid,
        }
    }

    /// Stock of an operation over the last one, mm.
    pub fn stock_mm(&self, operation: usize) -> Vec<f32> {
        let last = self.heights_mm.len() - 1;
        self.heights_mm[operation].iter().zip(&self.heights_mm[last]).map(|(a, b)| a - b).collect()
    }

    /// `tooth_07_left`.
    pub fn file_stem(&self) -> String {
        format!("tooth_{:02}_{}", self.tooth, self.side.name())
    }

    /// Writes all maps; `operations` are their names, `notes` go into the EXR headers.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, folder: &OutputFolder, operations: &[String], notes: &[(String, String)]) -> Result<()> {
        let stem = self.file_stem();
        let flank = format!("tooth {}, {} flank", self.tooth, self.side.name());
        for (index, name) in operations.iter().enumerate() {
            let heights_um: Vec<f32> = self.heights_mm[index].iter().map(|h| h * UM_PER_MM as f32).collect();
            let picture = MapPicture {
                title: &format!("{name}: {flank}"),
                quantity: "height over the target",
                unit: "µm",
                grid: &self.grid,
                values: &heights_um,
                scale: ColourScale::sequential_over([heights_um.as_slice()]),
            };
            write_map_png(&folder.path(format!("maps/{name}/{stem}.png"))?, &picture)?;
            let channels = vec![
                channel(
                    "height_mm",
                    "mm",
                    "height over the target along its normal after this operation",
                    Samples::F32(self.heights_mm[index].clone()),
                ),
                channel(
                    "pass_id",
                    "1",
                    "pass that left the surface; 4294967295 where none came",
                    Samples::U32(self.passes[index].clone()),
                ),
            ];
            self.write_exr(&folder.path(format!("maps/{name}/{stem}.exr"))?, channels, notes)?;
        }
        let earlier = &operations[..operations.len() - 1];
        if let Some((index, name)) = earlier.iter().enumerate().next_back() {
            let stock_mm = self.stock_mm(index);
            let picture = MapPicture {
                title: &format!("Stock of {name} over {}: {flank}", operations[operations.len() - 1]),
                quantity: "normal stock",
                unit: "mm",
                grid: &self.grid,
                values: &stock_mm,
                scale: ColourScale::sequential_over([stock_mm.as_slice()]),
            };
            write_map_png(&folder.path(format!("allowance/{stem}.png"))?, &picture)?;
            let mut channels: Vec<MapChannel> = earlier
                .iter()
                .enumerate()
                .map(|(index, name)| {
                    let definition = format!("normal stock of {name} over the last operation");
                    channel(&format!("stock_{name}_mm"), "mm", &definition, Samples::F32(self.stock_mm(index)))
                })
                .collect();
            channels.sort_by(|a, b| a.name.cmp(&b.name));
            self.write_exr(&folder.path(format!("allowance/{stem}.exr"))?, channels, notes)?;
        }
        Ok(())
    }

    fn write_exr(&self, path: &std::path::Path, channels: Vec<MapChannel>, notes: &[(String, String)]) -> Result<()> {
        let map = ExrMap { grid: self.grid.clone(), frame: FRAME.to_owned(), channels, notes: notes.to_vec() };
        write_exr_map(path, &map)
    }
}

fn channel(name: &str, unit: &str, definition: &str, samples: Samples) -> MapChannel {
    MapChannel { name: name.to_owned(), unit: unit.to_owned(), definition: definition.to_owned(), samples }
}
