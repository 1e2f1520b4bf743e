//! What the page's viewer draws: the gear's triangles and the maps of all flanks, packed.
//!
//! In: meshes and values on grids. Out: one JSON document (names, units, sizes, offsets) and one block of bytes, zlib
//! over little-endian arrays, in base64.
//!
//! Values become whole numbers of 16 bits between the smallest and the largest of their quantity (0: no value): a step
//! is 1/65534 of the range, far finer than a colour. High and low bytes are kept apart, which halves what zlib leaves.
//! Maps with more than [`CELLS_PER_QUANTITY`] cells in all are thinned by a whole factor: the page stays small whatever
//! the gear; the EXR maps beside it keep every cell.

pub mod work;

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use gearcut_core::frame::Rigid3;
use glam::DQuat;
use serde_json::{Value, json};

use crate::colormap::{ColourScale, tables};
use crate::output::grid::{MapAxis, MapGrid};
use crate::surface::triangles::Triangles;
use work::ViewerWork;

/// Cells of one quantity over all flanks; three quantities that zlib cannot shrink stay below 3 MB in base64.
pub const CELLS_PER_QUANTITY: usize = 350_000;
/// Cells along one axis of a map, so that maps fit the textures of every graphics card.
const CELLS_PER_AXIS: usize = 1000;

/// Everything that the viewer shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewer {
    /// The flanks, in order of teeth.
    pub flanks: Vec<ViewerFlank>,
    /// What can be shown on them; at least one.
    pub quantities: Vec<ViewerQuantity>,
    /// The rest of the gear.
    pub body: Triangles,
    /// A gear that rolls with it.
    pub mate: Option<ViewerMate>,
    /// The tool that made it, stroke by stroke or pass by pass.
    pub strokes: Option<ViewerStrokes>,
}

/// A tool and where it is at every stroke, or at every pass of its teeth, with what that takes.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewerStrokes {
    /// The tool in its own frame; normals are the viewer's affair.
    pub tool: Triangles,
    /// `stroke` or `pass`.
    pub noun: &'static str,
    /// Operations in order, with their numbers of strokes.
    pub operations: Vec<(String, usize)>,
    /// What a stroke takes, in words with `{0}` to `{3}` for [`ViewerStroke::taken`].
    pub words: &'static str,
    /// Names that the last value is a place of, from 0; empty: it is a number.
    pub names: Vec<String>,
    /// Of each of these names what it is of [`Self::tool`], to be marked where it takes something: the first of its
    /// corners among all indices, and how many it has. Empty: nothing is marked.
    pub parts: Vec<[usize; 2]>,
    /// Strokes in order of time; very many are thinned.
    pub strokes: Vec<ViewerStroke>,
    /// The work as they leave it.
    pub work: ViewerWork,
}

/// One stroke, or one pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewerStroke {
    /// Operation and number among its own.
    pub place: [usize; 2],
    /// Pose of the tool in the gear frame, mm.
    pub gear_from_tool: Rigid3,
    /// What it takes; nothing where the first value is 0.
    pub taken: [f64; 4],
}

/// Columns of a stroke on the page: place, position, quaternion, what it takes.
const COLUMNS: usize = 13;

impl ViewerStroke {
    fn values(&self) -> [f32; COLUMNS] {
        let place = self.place.map(|place| place as f64);
        let position = self.gear_from_tool.translation_mm.to_array();
        let turn = DQuat::from_mat3(&self.gear_from_tool.rotation).to_array();
        let mut values = place.into_iter().chain(position).chain(turn).chain(self.taken);
        std::array::from_fn(|_| values.next().unwrap_or_default() as f32)
    }
}

/// A second gear, without maps, and how both turn while they roll.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewerMate {
    /// All of it, in its own frame.
    pub triangles: Triangles,
    /// Its axis, mm; that of the first gear is the origin.
    pub axis_mm: [f64; 2],
    /// How far both gears are turned counter-clockwise at every place of the roll, deg.
    pub turned_deg: Vec<[f64; 2]>,
}

/// A flank of the viewer.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewerFlank {
    /// Tooth, from 1.
    pub tooth: u32,
    /// `left` or `right`.
    pub side: String,
    /// Grid of its values; `None` for a flank that was not cut (the run was stopped).
    pub grid: Option<MapGrid>,
    /// Its triangles.
    pub triangles: Triangles,
    /// Place (u, v) of each corner, mm.
    pub places_mm: Vec<[f32; 2]>,
}

/// A quantity with its values on all flanks that have a grid, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewerQuantity {
    /// Name, such as "stock after rough".
    pub name: String,
    /// What it is, in a sentence.
    pub definition: String,
    /// Unit.
    pub unit: String,
    /// Colours.
    pub scale: ColourScale,
    /// How a cell stands for several.
    pub thinning: Thinning,
    /// Arcs along the profile that smallest, mean and largest value are taken between, mm, for each of these flanks.
    pub evaluated_mm: Vec<[f64; 2]>,
    /// Values; NaN where there is none.
    pub values: Vec<Vec<f32>>,
}

/// The value of a cell that stands for several.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Thinning {
    /// That of the middle one.
    Middle,
    /// The largest.
    Highest,
    /// Their mean.
    Mean,
}

/// The viewer's two parts in the page.
#[derive(Debug, Clone, PartialEq)]
pub struct Packed {
    /// The JSON document.
    pub description: Value,
    /// The block, base64.
    pub block: String,
}

/// Arrays one after another, each on a multiple of four bytes.
#[derive(Default)]
struct Arrays {
    bytes: Vec<u8>,
}

impl Arrays {
    fn add(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        let at = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        at
    }

    fn add_f32<'a>(&mut self, values: impl IntoIterator<Item = &'a f32>) -> usize {
        self.add(values.into_iter().flat_map(|value| value.to_le_bytes()))
    }

    fn add_u32(&mut self, values: impl IntoIterator<Item = u32>) -> usize {
        self.add(values.into_iter().flat_map(u32::to_le_bytes))
    }

    fn packed(self) -> String {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        let written = encoder.write_all(&self.bytes).and_then(|()| encoder.finish());
        STANDARD.encode(written.expect("memory takes all bytes"))
    }
}

impl Viewer {
    /// Packs everything.
    pub fn packed(&self) -> Packed {
        let mut block = Arrays::default();
        let grids: Vec<&MapGrid> = self.flanks.iter().filter_map(|flank| flank.grid.as_ref()).collect();
        let factor = thinning_factor(&grids);
        let thin: Vec<MapGrid> = grids.iter().map(|grid| thinned_grid(grid, factor)).collect();

        let (mut corners, mut first_cell, mut cut) = (0, 0, 0);
        let mut flanks = Vec::new();
        let mut mesh = Triangles::default();
        let mut places: Vec<[f32; 2]> = Vec::new();
        for flank in &self.flanks {
            let grid = flank.grid.is_some().then(|| &thin[cut]);
            let map = grid.map(|grid| {
                let axis = |axis: &MapAxis| json!({"start": axis.start_mm, "step": axis.step_mm, "count": axis.count});
                json!({"index": cut, "first": first_cell, "u": axis(&grid.u), "v": axis(&grid.v)})
            });
            if let Some(grid) = grid {
                first_cell += grid.count();
                cut += 1;
            }
            let count = flank.triangles.positions_mm.len();
            flanks.push(json!({"tooth": flank.tooth, "side": flank.side, "map": map, "corners": [corners, count]}));
            mesh.positions_mm.extend_from_slice(&flank.triangles.positions_mm);
            mesh.normals.extend_from_slice(&flank.triangles.normals);
            mesh.indices.extend(flank.triangles.indices.iter().map(|index| index + corners as u32));
            places.extend_from_slice(&flank.places_mm);
            corners += count;
        }
        let quantities: Vec<Value> = self
            .quantities
            .iter()
            .map(|quantity| {
                let values: Vec<f32> = quantity
                    .values
                    .iter()
                    .zip(&grids)
                    .zip(&thin)
                    .flat_map(|((values, grid), thin)| thinned_values(values, grid, thin, factor, quantity.thinning))
                    .collect();
                let (low, high) = values
                    .iter()
                    .filter(|value| value.is_finite())
                    .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
                let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
                let whole: Vec<u16> = values.iter().map(|&value| whole_number(value, low, high)).collect();
                let at =
                    block.add(whole.iter().map(|w| w.to_be_bytes()[0]).chain(whole.iter().map(|w| w.to_be_bytes()[1])));
                let (scale_low, scale_high) = quantity.scale.ends();
                json!({
                    "name": quantity.name,
                    "definition": quantity.definition,
                    "unit": quantity.unit,
                    "low": low,
                    "high": high,
                    "scale": [scale_low, scale_high],
                    "evaluated": quantity.evaluated_mm,
                    "colours": usize::from(matches!(quantity.scale, ColourScale::Diverging { .. })),
                    "at": at,
                })
            })
            .collect();
        let triangles = |block: &mut Arrays, mesh: &Triangles| {
            json!({
                "corners": mesh.positions_mm.len(),
                "positions": block.add_f32(mesh.positions_mm.as_flattened()),
                "normals": block.add_f32(mesh.normals.as_flattened()),
                "triangles": mesh.indices.len() / 3,
                "indices": block.add_u32(mesh.indices.iter().copied()),
            })
        };
        let mut flank_mesh = triangles(&mut block, &mesh);
        flank_mesh["places"] = block.add_f32(places.as_flattened()).into();
        let body_mesh = triangles(&mut block, &self.body);
        let mate = self.mate.as_ref().map(|mate| {
            let mesh = triangles(&mut block, &mate.triangles);
            json!({"mesh": mesh, "axis": mate.axis_mm, "turned": mate.turned_deg})
        });
        let strokes = self.strokes.as_ref().map(|of| {
            let tool = triangles(&mut block, &of.tool);
            // Column by column: neighbours are alike, which zlib likes.
            let values: Vec<[f32; COLUMNS]> = of.strokes.iter().map(ViewerStroke::values).collect();
            let columns: Vec<f32> = (0..COLUMNS).flat_map(|column| values.iter().map(move |row| row[column])).collect();
            json!({
                "tool": tool,
                "noun": of.noun,
                "words": of.words,
                "names": of.names,
                "parts": of.parts,
                "operations": of.operations,
                "count": values.len(),
                "at": block.add_f32(&columns),
                "work": of.work.packed(&mut block),
            })
        });
        let colours = block.add(tables().as_flattened().as_flattened().iter().copied());
        let description = json!({
            "cells": first_cell,
            "flanks": flanks,
            "quantities": quantities,
            "flank_mesh": flank_mesh,
            "body_mesh": body_mesh,
            "mate": mate,
            "strokes": strokes,
            "colours": colours,
            "bytes": block.bytes.len(),
        });
        Packed { description, block: block.packed() }
    }
}

/// Smallest whole factor that brings all maps within their bounds.
fn thinning_factor(grids: &[&MapGrid]) -> usize {
    let fits = |factor: usize| {
        let counts = grids.iter().map(|grid| [grid.u.count.div_ceil(factor), grid.v.count.div_ceil(factor)]);
        counts.clone().map(|[u, v]| u * v).sum::<usize>() <= CELLS_PER_QUANTITY
            && counts.flatten().all(|count| count <= CELLS_PER_AXIS)
    };
    // Maps have fewer cells than this along an axis: one cell per map is always reached.
    (1..1 << 20).find(|&factor| fits(factor)).unwrap_or(1 << 20)
}

fn thinned_grid(grid: &MapGrid, factor: usize) -> MapGrid {
    let axis = |axis: &MapAxis| MapAxis {
        start_mm: axis.start_mm + 0.5 * (factor - 1) as f64 * axis.step_mm,
        step_mm: axis.step_mm * factor as f64,
        count: axis.count.div_ceil(factor),
        ..axis.clone()
    };
    MapGrid { u: axis(&grid.u), v: axis(&grid.v) }
}

fn thinned_values(values: &[f32], grid: &MapGrid, thin: &MapGrid, factor: usize, thinning: Thinning) -> Vec<f32> {
    let cell = |u: usize, v: usize| {
        let (u_from, v_from) = (u * factor, v * factor);
        let (u_to, v_to) = ((u_from + factor).min(grid.u.count), (v_from + factor).min(grid.v.count));
        let at = |u: usize, v: usize| values[u * grid.v.count + v];
        let all = (u_from..u_to).flat_map(move |u| (v_from..v_to).map(move |v| at(u, v)));
        match thinning {
            Thinning::Middle => at((u_from + u_to - 1) / 2, (v_from + v_to - 1) / 2),
            Thinning::Highest => all.fold(f32::NAN, f32::max),
            Thinning::Mean => {
                let (sum, count) =
                    all.filter(|value| !value.is_nan()).fold((0.0, 0_u32), |(s, n), x| (s + f64::from(x), n + 1));
                (sum / f64::from(count)) as f32
            }
        }
    };
    (0..thin.u.count).flat_map(|u| (0..thin.v.count).map(move |v| (u, v))).map(|(u, v)| cell(u, v)).collect()
}

/// 1 to 65535 over the range, 0 for no value.
fn whole_number(value: f32, low: f32, high: f32) -> u16 {
    if value.is_nan() {
        return 0;
    }
    let share = f64::from(value - low) / f64::from(high - low);
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    (1.0 + (share * 65534.0).round()) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read as _;

    fn grid(u: usize, v: usize) -> MapGrid {
        let axis = |count| MapAxis { name: "u".into(), meaning: String::new(), start_mm: 0.0, step_mm: 0.1, count };
        MapGrid { u: axis(u), v: axis(v) }
    }

    fn viewer(u: usize, v: usize, flanks: u32, value: impl Fn(usize) -> f32) -> Viewer {
        let flank = |tooth| ViewerFlank {
            tooth,
            side: "left".into(),
            grid: Some(grid(u, v)),
            triangles: Triangles {
                positions_mm: vec![[1.0, 2.0, 3.0]; 3],
                normals: vec![[0.0; 3]; 3],
                indices: vec![0, 1, 2],
                ..Triangles::default()
            },
            places_mm: vec![[0.0; 2]; 3],
        };
        Viewer {
            flanks: (1..=flanks).map(flank).collect(),
            quantities: vec![ViewerQuantity {
                name: "stock".into(),
                definition: "what is left".into(),
                unit: "mm".into(),
                scale: ColourScale::Sequential { low: 0.0, high: 1.0 },
                thinning: Thinning::Highest,
                evaluated_mm: (0..flanks).map(|_| [0.0, 1.0]).collect(),
                values: (0..flanks).map(|_| (0..u * v).map(&value).collect()).collect(),
            }],
            body: Triangles::default(),
            mate: None,
            strokes: None,
        }
    }

    #[test]
    fn values_come_back_within_half_a_step() {
        let value = |i: usize| if i == 5 { f32::NAN } else { (i as f32 * 0.37).sin() };
        let packed = viewer(8, 9, 2, value).packed();
        let mut bytes = Vec::new();
        let zlib = STANDARD.decode(&packed.block).expect("base64");
        ZlibDecoder::new(zlib.as_slice()).read_to_end(&mut bytes).expect("zlib");
        assert_eq!(packed.description["bytes"], bytes.len());
        let quantity = &packed.description["quantities"][0];
        let (low, high) = (quantity["low"].as_f64().expect("a number"), quantity["high"].as_f64().expect("a number"));
        let cells = packed.description["cells"].as_u64().expect("a count") as usize;
        let at = quantity["at"].as_u64().expect("an offset") as usize;
        for i in 0..cells {
            let whole = u16::from_be_bytes([bytes[at + i], bytes[at + cells + i]]);
            let expected = value(i % 72);
            if expected.is_nan() {
                assert_eq!(whole, 0);
            } else {
                let back = low + (f64::from(whole) - 1.0) / 65534.0 * (high - low);
                assert!((back - f64::from(expected)).abs() <= 0.6 * (high - low) / 65534.0, "cell {i}");
            }
        }
    }

    /// The worst gear for the packer: noise on many large flanks.
    #[test]
    fn the_page_stays_small_whatever_the_gear() {
        let noise = |i: usize| ((i as f32 * 12.9898).sin() * 43758.547).fract();
        let packed = viewer(150, 600, 100, noise).packed();
        assert!(packed.description["cells"].as_u64().expect("a count") as usize <= CELLS_PER_QUANTITY);
        assert!(packed.block.len() < 1_000_000, "{} bytes", packed.block.len());
        let thin = &packed.description["flanks"][0]["map"];
        // 9,000,000 cells need a factor of 6; the first cell then stands in the middle of six.
        assert_eq!((thin["u"]["count"].as_u64(), thin["v"]["count"].as_u64()), (Some(25), Some(100)));
        assert!((thin["u"]["start"].as_f64().expect("a place") - 0.25).abs() < 1e-12);
    }

    #[test]
    fn thinning_keeps_what_each_quantity_needs() {
        let (full, values) = (grid(3, 3), [1.0, 2.0, 9.0, 3.0, 4.0, f32::NAN, 5.0, 6.0, 7.0]);
        let thin = thinned_grid(&full, 2);
        assert_eq!(thinned_values(&values, &full, &thin, 2, Thinning::Highest), [4.0, 9.0, 6.0, 7.0]);
        assert_eq!(thinned_values(&values, &full, &thin, 2, Thinning::Mean), [2.5, 9.0, 5.5, 7.0]);
        assert_eq!(thinned_values(&values, &full, &thin, 2, Thinning::Middle), [1.0, 9.0, 5.0, 7.0]);
    }
}
