//! Maps of one flank: what every operation left, as pictures and as EXR for other programs.
//!
//! In: the cut field at dexel spacing. Out: EXR of every flank and, of those that the scene wants (`GearMaps::drawn`),
//! pictures:
//!
//! | what | where |
//! | --- | --- |
//! | normal deviation after each operation | `maps/<operation>/tooth_07_left.{png,exr}` |
//! | pass that left the finished surface | `maps/<last operation>/tooth_07_left_pass.png` |
//! | uncut chip thickness of the last cut, part of the edge | `maps/<last operation>/tooth_07_left_chip.png` |
//! | stock of each earlier operation over the finished surface | `allowance/tooth_07_left.{png,exr}` |
//! | deviation of the finished flank | `deviation/tooth_07_left.{png,exr}` |
//!
//! Pass, chip thickness and part of the edge are channels of every EXR under `maps/`.
//!
//! Maps have a spacing of their own (the scene's `output.map_spacing_mm`), wider than facets. In EXR files stock,
//! height and pass id are those of the dexel nearest to the map's place. Pictures show values of whole cells,
//! because single dexels would make moire of the feed marks: the **highest** dexel, so that no mark is lost; the
//! **mean** stock and deviation, because an error of form or position is what remains when the marks are averaged; and
//! the **latest** pass. The chip is, in EXR files and pictures alike, that at the **thick end** of the longest mark in
//! a cell (`chip_places`: over all dexels of a cell the thickest would take longer than the cut).

use super::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
use super::folder::OutputFolder;
use super::grid::{MapAxis, MapGrid};
use super::map_cells::{Cell, cells_along};
use super::map_png::{MapPicture, write_map_png};
use crate::colormap::ColourScale;
use crate::measure::LastChips;
use crate::measure::chip_places::{ChipPlaces, chip_columns, each_once};
use crate::output::atomic::file_error;
use gearcut_core::dexel::{Layer, NO_PASS};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// What map readers need to know about u and v.
const FRAME: &str = "flank frame: u = arc length along the target profile from the form point to the tip, v = place \
    along the tooth from the middle of the face; heights along the target's outward normal, positive = material left";

/// Why a cell of a flank has no value.
pub const NO_PASS_CAME: &str = "no pass came here";

/// Quantiles between which chips are told apart: the places that a first stroke cut whole tooth spaces from would hide
/// all others.
pub const CHIPS_SHOWN: [f64; 2] = [0.0, 0.95];

/// What maps and sheets of chips show.
pub const CHIP_QUANTITY: &str = "uncut chip thickness, thick end of marks";

/// Maps of one flank on its own grid.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankMaps {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Places.
    pub grid: MapGrid,
    /// Normal deviation after each operation, mm; NaN where no pass came.
    pub heights_mm: Vec<Vec<f32>>,
    /// Height of the highest dexel of each cell, mm; NaN where no pass came.
    pub highest_mm: Vec<Vec<f32>>,
    /// Mean height of each cell after each operation, mm; NaN where no pass came.
    pub mean_mm: Vec<Vec<f32>>,
    /// Pass that left it, after each operation.
    pub passes: Vec<Vec<u32>>,
    /// Arcs along the profile between which the values after each operation are those of the flank, mm: below lies the
    /// fillet, which is deep or thick for reasons of its own.
    pub evaluated_mm: Vec<[f64; 2]>,
    /// Latest pass of each cell after the last operation; NaN where none came. As f32, ids are exact up to 16 million.
    pub latest_pass: Vec<f32>,
    /// Columns of dexels whose chips are followed, for each place along u, and the row for each place along v.
    chip_columns: Vec<Vec<usize>>,
    chip_rows: Vec<usize>,
    /// The thickest chip of each cell after each operation; empty where they are not known.
    pub chips: Vec<LastChips>,
}

impl FlankMaps {
    /// Of values after an operation those of cells that are evaluated as a whole; all of them where none is.
    pub fn evaluated<'a>(&self, values: &'a [f32], operation: usize) -> &'a [f32] {
        let Some([from_mm, to_mm]) = self.evaluated_mm.get(operation) else { return values };
        let (u, along) = (&self.grid.u, self.grid.v.count);
        let inside = |row: &usize| {
            let middle_mm = u.start_mm + *row as f64 * u.step_mm;
            middle_mm - 0.5 * u.step_mm >= *from_mm && middle_mm + 0.5 * u.step_mm <= *to_mm
        };
        let rows: Vec<usize> = (0..u.count).filter(inside).collect();
        match (rows.first(), rows.last()) {
            (Some(first), Some(last)) => &values[first * along..(last + 1) * along],
            _ => values,
        }
    }

    /// Takes the dexels nearest to the places of a map with `spacing_mm`; dexels stand at `arcs_mm` along the profile
    /// and `rows_z_mm` along the tooth. All of the profile is the flank's, until somebody knows better.
    pub fn sample(
        tooth: u32,
        side: Side,
        [arcs_mm, rows_z_mm]: [&[f64]; 2],
        layers: &[Layer],
        spacing_mm: f64,
    ) -> Self {
        let rows = rows_z_mm.len();
        let lengths = [arcs_mm.last().copied().unwrap_or(0.0), rows_z_mm[rows - 1] - rows_z_mm[0]];
        let axis = |name: &str, meaning: &str, start_mm: f64, length_mm: f64| {
            let count = (length_mm / spacing_mm).floor() as usize + 1;
            MapAxis { name: name.into(), meaning: meaning.into(), start_mm, step_mm: spacing_mm, count }
        };
        let grid = MapGrid {
            u: axis("u", "along the profile from the form point", 0.0, lengths[0]),
            v: axis("v", "along the tooth from the middle of the face", rows_z_mm[0], lengths[1]),
        };
        let (columns, rows_of_cells) = (cells_along(&grid.u, arcs_mm), cells_along(&grid.v, rows_z_mm));
        let dexels: Vec<usize> = columns
            .iter()
            .flat_map(|(column, _)| rows_of_cells.iter().map(move |(row, _)| column * rows + row))
            .collect();
        let all_cells =
            || columns.iter().flat_map(|(_, across)| rows_of_cells.iter().map(move |(_, along)| (across, along)));
        let cells: Vec<Vec<Cell>> = layers
            .iter()
            .map(|layer| all_cells().map(|(across, along)| Cell::of(layer, rows, across, along)).collect())
            .collect();
        let of_cells = |value: fn(&Cell) -> f32| -> Vec<Vec<f32>> {
            cells.iter().map(|cells| cells.iter().map(value).collect()).collect()
        };
        let mean_mm = of_cells(|cell| cell.mean_mm);
        let height = |layer: &Layer, i: usize| if layer.passes[i] == NO_PASS { f32::NAN } else { layer.heights_mm[i] };
        Self {
            tooth,
            side,
            heights_mm: layers.iter().map(|layer| dexels.iter().map(|&i| height(layer, i)).collect()).collect(),
            highest_mm: of_cells(|cell| cell.highest_mm),
            mean_mm,
            evaluated_mm: vec![[0.0, lengths[0]]; layers.len()],
            latest_pass: of_cells(|cell| cell.latest_pass).pop().unwrap_or_default(),
            passes: layers.iter().map(|layer| dexels.iter().map(|&i| layer.passes[i]).collect()).collect(),
            chip_columns: columns.iter().map(|(_, cell)| chip_columns(cell)).collect(),
            chip_rows: rows_of_cells.iter().map(|(nearest, _)| *nearest).collect(),
            chips: Vec::new(),
            grid,
        }
    }

    /// Dexels of the field whose chips [`take_chips`](Self::take_chips) wants; `layers` are those of the maps.
    pub fn chip_places(&self, layers: &[Layer], field_rows: usize) -> ChipPlaces {
        ChipPlaces::thickest(layers, field_rows, &self.chip_columns, &self.chip_rows)
    }

    /// Takes the chips that left the surface of those dexels after each operation: the one that is known of each cell.
    pub fn take_chips(&mut self, operations: &[LastChips]) {
        let followed = each_once(&self.chip_rows);
        let rows = followed.len();
        let row_of_cells: Vec<usize> = self.chip_rows.iter().map(|row| followed.partition_point(|r| r < row)).collect();
        let of_cells = |chips: &LastChips| {
            let mut thickest = LastChips::with_capacity(self.chip_columns.len() * row_of_cells.len());
            let mut first = 0;
            for columns in &self.chip_columns {
                for &row in &row_of_cells {
                    let cell = (first..first + columns.len()).map(|column| column * rows + row);
                    // NaN is thinner than any chip; of equals the first is taken.
                    let thickness = |index: usize| Some(chips.thickness_mm[index]).filter(|mm| !mm.is_nan());
                    let found = cell.reduce(|a, b| if thickness(b) > thickness(a) { b } else { a }).unwrap_or(0);
                    thickest.thickness_mm.push(chips.thickness_mm[found]);
                    thickest.sides.push(chips.sides[found]);
                    thickest.passes.push(chips.passes[found]);
                }
                first += columns.len();
            }
            thickest
        };
        self.chips = operations.iter().map(of_cells).collect();
    }

    /// Mean height of each cell after the last operation, mm; NaN where no pass came.
    pub fn deviation_mm(&self) -> &[f32] {
        self.mean_mm.last().map_or(&[], Vec::as_slice)
    }

    /// Stock of an operation over the last one, mm.
    pub fn stock_mm(&self, operation: usize) -> Vec<f32> {
        let last = self.heights_mm.len() - 1;
        self.heights_mm[operation].iter().zip(&self.heights_mm[last]).map(|(a, b)| a - b).collect()
    }

    /// Mean stock of each cell of an operation over the last one, mm.
    pub fn mean_stock_mm(&self, operation: usize) -> Vec<f32> {
        self.mean_mm[operation].iter().zip(self.deviation_mm()).map(|(a, b)| a - b).collect()
    }

    /// `tooth_07_left`.
    pub fn file_stem(&self) -> String {
        format!("tooth_{:02}_{}", self.tooth, self.side.name())
    }

    /// Writes the EXR files; `operations` are their names, `notes` go into the headers, but for the scene itself: it
    /// would be a third of each file and is in run.json, under the same SHA-256.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, folder: &OutputFolder, operations: &[String], notes: &[(String, String)]) -> Result<()> {
        let stem = self.file_stem();
        for (index, name) in operations.iter().enumerate() {
            let mut channels = vec![
                MapChannel::lengths_mm("height_mm", "normal deviation after this operation", &self.heights_mm[index]),
                MapChannel::lengths_mm(
                    "highest_mm",
                    "normal deviation of the highest dexel of the cell",
                    &self.highest_mm[index],
                ),
                ids("pass_id", "pass that left the surface; 4294967295 where none came", self.passes[index].clone()),
            ];
            if let Some(chips) = self.chips.get(index) {
                channels.push(MapChannel::coarse_lengths_mm(
                    "chip_thickness_mm",
                    "uncut chip thickness, the largest of four dexels across the cell: solid material before the edge \
                    along the target's normal, times the cosine to the edge's normal; NaN where none came",
                    &chips.thickness_mm,
                ));
                channels.push(ids(
                    "edge_part",
                    "part of the cutter's edge that took it: 0 none, 1 right flank, 2 tip with its corners, 3 left \
                    flank",
                    chips.sides.iter().copied().map(u32::from).collect(),
                ));
            }
            self.write_exr(&folder.path(format!("maps/{name}/{stem}.exr"))?, channels, notes)?;
        }
        let earlier = &operations[..operations.len() - 1];
        if !earlier.is_empty() {
            let stock = |(index, name): (usize, &String)| {
                let definition = format!("normal stock of {name} over the last operation");
                MapChannel::lengths_mm(&format!("stock_{name}_mm"), &definition, &self.stock_mm(index))
            };
            let channels = earlier.iter().enumerate().map(stock).collect();
            self.write_exr(&folder.path(format!("allowance/{stem}.exr"))?, channels, notes)?;
        }
        let definition = "mean normal deviation of the cell's dexels after the last operation";
        let channel = MapChannel::lengths_mm("deviation_mm", definition, self.deviation_mm());
        self.write_exr(&folder.path(format!("deviation/{stem}.exr"))?, vec![channel], notes)
    }

    /// Draws the maps of this flank by themselves. The colours of the stock before the last operation (mm) and of
    /// deviations (µm) are those of all flanks, so that they can be compared.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn draw(
        &self,
        folder: &OutputFolder,
        operations: &[String],
        stock_scale: Option<ColourScale>,
        deviation_scale: ColourScale,
    ) -> Result<()> {
        let stem = self.file_stem();
        let flank = format!("tooth {}, {} flank", self.tooth, self.side.name());
        let um = |mm: &[f32]| -> Vec<f32> { mm.iter().map(|h| h * UM_PER_MM as f32).collect() };
        let picture = |path: String, title: String, [quantity, unit]: [&str; 2], values: &[f32], scale| {
            let grid = &self.grid;
            let picture = MapPicture { title: &title, quantity, unit, grid, values, scale, missing: NO_PASS_CAME };
            write_map_png(&folder.path(path)?, &picture)
        };
        for (index, (name, highest_mm)) in operations.iter().zip(&self.highest_mm).enumerate() {
            let heights_um = um(highest_mm);
            let scale = ColourScale::heights_over([self.evaluated(&heights_um, index)]);
            let shown = ["normal deviation, highest of cell", "µm"];
            picture(format!("maps/{name}/{stem}.png"), format!("{name}: {flank}"), shown, &heights_um, scale)?;
        }
        let Some((name, earlier)) = operations.split_last() else { return Ok(()) };
        let passes = ColourScale::sequential_over([self.latest_pass.as_slice()]);
        picture(
            format!("maps/{name}/{stem}_pass.png"),
            format!("{name}: {flank}, the pass that left each place"),
            ["latest pass of cell, in the order of time", "1"],
            &self.latest_pass,
            passes,
        )?;
        if let Some(chips) = self.chips.get(earlier.len()) {
            let thickness_um = um(&chips.thickness_mm);
            picture(
                format!("maps/{name}/{stem}_chip.png"),
                format!("{name}: {flank}, the chip that left each place"),
                [CHIP_QUANTITY, "µm"],
                &thickness_um,
                ColourScale::between_quantiles([thickness_um.as_slice()], CHIPS_SHOWN),
            )?;
        }
        if let Some((before, scale)) = earlier.last().zip(stock_scale) {
            picture(
                format!("allowance/{stem}.png"),
                format!("Stock of {before} over {name}: {flank}"),
                ["normal stock, mean of cell", "mm"],
                &self.mean_stock_mm(earlier.len() - 1),
                scale,
            )?;
        }
        picture(
            format!("deviation/{stem}.png"),
            format!("Deviation after {name}: {flank}"),
            ["mean normal deviation of cell", "µm"],
            &um(self.deviation_mm()),
            deviation_scale,
        )
    }

    fn write_exr(
        &self,
        path: &std::path::Path,
        mut channels: Vec<MapChannel>,
        notes: &[(String, String)],
    ) -> Result<()> {
        channels.sort_by(|a, b| a.name.cmp(&b.name));
        let notes = notes.iter().filter(|(name, _)| name != "scene").cloned().collect();
        let map = ExrMap { grid: self.grid.clone(), frame: FRAME.to_owned(), channels, notes };
        write_exr_map(path, &map).map_err(file_error)
    }
}

fn ids(name: &str, definition: &str, ids: Vec<u32>) -> MapChannel {
    let samples = Samples::U32(ids);
    MapChannel { name: name.to_owned(), unit: "1".to_owned(), definition: definition.to_owned(), samples }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::chip_places::CHIPS_OF_A_CELL;
    use gearcut_core::dexel::{Column, Field};
    use glam::DVec2;

    /// Twenty columns of dexels to a cell; chips grow over every facet of eight and begin anew. The nearest dexel alone
    /// would show their phase.
    #[test]
    fn a_cell_keeps_its_thickest_chip_whatever_the_phase_of_the_marks() {
        let column = |i: u32| Column {
            arc_mm: f64::from(i) * 0.005,
            origin_mm: DVec2::ZERO,
            normal: DVec2::X,
            low_mm: -1.0,
            blank_mm: 1.0,
        };
        let field = Field { columns: (0..200).map(column).collect(), rows_z_mm: vec![0.0, 0.1] };
        let mut layer = field.blank_layer();
        for (index, pass) in layer.passes.iter_mut().enumerate() {
            *pass = (index / 2 * 10 / 83) as u32;
        }
        let layers = [layer];
        let mut maps = FlankMaps::sample(1, Side::Left, [&field.arcs_mm(), &field.rows_z_mm], &layers, 0.1);
        let places = maps.chip_places(&layers, 2);
        let (columns, rows) = (&places.columns, &places.rows);
        assert!(columns.is_sorted() && columns.len() <= CHIPS_OF_A_CELL * maps.grid.u.count);
        let thickness = |column: usize| ((column * 10) % 83) as f32;
        let mut chips = LastChips::none(columns.len() * rows.len());
        for (index, &column) in columns.iter().enumerate() {
            for row in (0..rows.len()).filter(|&row| places.wants(0, [index, row])) {
                let at = index * rows.len() + row;
                (chips.thickness_mm[at], chips.sides[at], chips.passes[at]) = (thickness(column), column as u8, 7);
            }
        }
        maps.take_chips(&[chips]);
        let (cells, nearest) = (&maps.chips[0].thickness_mm, (0..10).map(|cell| thickness(20 * cell)));
        assert_eq!(cells.len(), maps.grid.u.count * maps.grid.v.count);
        let whole = cells.chunks(rows.len()).skip(1).take(8);
        assert!(whole.clone().all(|cell| cell[0] >= 0.7 * 82.0 && cell[0] == cell[1]), "{cells:?}");
        assert!(nearest.fold(f32::INFINITY, f32::min) < 10.0, "a test that the nearest dexel fails");
        // The part of the edge is that of the dexel that has it.
        assert!(maps.chips[0].sides.iter().zip(cells).all(|(&column, &mm)| thickness(usize::from(column)) == mm));
    }

    /// Cells of four dexels, one of them untouched: the highest keeps the mark, the mean takes it with its share.
    #[test]
    fn a_cell_keeps_its_highest_dexel_and_its_mean() {
        let column = |i: u32| Column {
            arc_mm: f64::from(i) * 0.05,
            origin_mm: DVec2::ZERO,
            normal: DVec2::X,
            low_mm: -1.0,
            blank_mm: 1.0,
        };
        let field = Field { columns: (0..4).map(column).collect(), rows_z_mm: vec![-0.05, 0.0, 0.05, 0.1] };
        let mut layer = field.blank_layer();
        for index in 0..16 {
            (layer.heights_mm[index], layer.passes[index]) = (index as f32, 7);
        }
        layer.passes[5] = NO_PASS;
        layer.passes[9] = 8;
        let maps = FlankMaps::sample(1, Side::Left, [&field.arcs_mm(), &field.rows_z_mm], &[layer], 0.1);
        assert_eq!((maps.grid.u.count, maps.grid.v.count), (2, 2));
        // The cell at u 0.1, v -0.05 holds the columns at 0.05 (half way, upper cell) and 0.1, and the first row:
        // dexels 4 and 8.
        assert_eq!(maps.highest_mm[0][2], 8.0);
        assert_eq!(maps.deviation_mm()[2], 6.0);
        // The cell at u 0.1, v 0.05 holds rows 1 and 2 of both columns: 5 (untouched), 6, 9, 10.
        assert_eq!(maps.highest_mm[0][3], 10.0);
        assert_eq!((maps.latest_pass[2], maps.latest_pass[3]), (7.0, 8.0));
        assert_eq!((maps.mean_mm[0][2], maps.mean_stock_mm(0)[2]), (6.0, 0.0));
        assert!((maps.deviation_mm()[3] - 25.0 / 3.0).abs() < 1e-6);
    }
}
