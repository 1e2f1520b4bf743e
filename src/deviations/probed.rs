//! Measured points as people have them: a table of coordinates (CSV), or the curves of a drawing (DXF).
//!
//! Columns of a table are `x_mm`, `y_mm`, `z_mm`, and where they are known `tooth` and `flank`; `_um`, `_cm`, `_m` and
//! `_in` are the same in other units. A drawing is that of a transverse section; it says its own unit.

use crate::influence::measured_table::{FirstLine, MeasuredRow, MeasuredTable};
use crate::regular_file;
use crate::scene::drawn_contour;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;
use glam::DVec3;
use std::path::Path;

/// Largest drawing, bytes.
const LARGEST_DRAWING: u64 = 1 << 26;
/// Coordinates beyond this are no gear's, mm.
const LARGEST_MM: f64 = 1e5;
/// Units of columns with their lengths, mm, and the names of the columns.
const UNITS: [(f64, [&str; 5]); 5] = [
    (1.0, ["x_mm", "y_mm", "z_mm", "tooth", "flank"]),
    (25.4, ["x_in", "y_in", "z_in", "tooth", "flank"]),
    (1e-3, ["x_um", "y_um", "z_um", "tooth", "flank"]),
    (10.0, ["x_cm", "y_cm", "z_cm", "tooth", "flank"]),
    (1e3, ["x_m", "y_m", "z_m", "tooth", "flank"]),
];

/// A measured point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbedPoint {
    /// Where it is, in the frame of who measured it.
    pub place_mm: DVec3,
    /// The flank that it belongs to, where the file says so.
    pub flank: Option<(u32, Side)>,
}

/// Where the points of a drawing are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnSection<'a> {
    /// Their layer; none where the drawing has one.
    pub layer: Option<&'a str>,
    /// Their section: place along the tooth from the middle of the face, mm.
    pub z_mm: f64,
}

/// Reads measured points, those of a drawing in this section.
///
/// # Errors
/// A file that cannot be read; columns that are missing or without a unit; cells that are no coordinates; a layer for a
/// file that is no drawing.
pub fn read(path: &Path, section: DrawnSection<'_>) -> Result<Vec<ProbedPoint>> {
    if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("dxf")) {
        return drawn(path, section);
    }
    if section.layer.is_some() {
        let problem = format!("{} is no drawing and has no layers", path.display());
        return Err(Refusal::new("--layer", problem, "leave it out, or give a drawing (.dxf)").into());
    }
    let known: Vec<&str> = UNITS.iter().map(|(_, names)| names[0]).chain(["x", "X"]).collect();
    let heads = match FirstLine::of(path, &known)? {
        FirstLine::Columns(heads) => heads,
        FirstLine::Numbers => Vec::new(),
    };
    let Some(&(unit_mm, names)) = UNITS.iter().find(|(_, names)| heads.iter().any(|head| head == names[0])) else {
        let reason = "its first line does not say the unit of its coordinates; write x_mm,y_mm,z_mm there, or x_in, \
                      x_um, x_cm or x_m and so on, and tooth,flank where they are known"
            .to_owned();
        return Err(Error::Unreadable { path: path.to_owned(), reason });
    };
    let table = MeasuredTable::read(path, names, &["tooth", "flank"])?;
    let point = |row: &MeasuredRow<5>| -> Result<ProbedPoint> {
        let [x, y, z] = [0, 1, 2].map(|column| row.number_within(column, LARGEST_MM / unit_mm));
        let is_named = !(row.cell(3).is_empty() && row.cell(4).is_empty());
        let flank = is_named.then(|| row.flank([3, 4])).transpose()?;
        Ok(ProbedPoint { place_mm: unit_mm * DVec3::new(x?, y?, z?), flank })
    };
    table.rows.iter().map(point).collect()
}

fn drawn(path: &Path, section: DrawnSection<'_>) -> Result<Vec<ProbedPoint>> {
    let bytes = regular_file::read(path, LARGEST_DRAWING)
        .map_err(|reason| Error::Unreadable { path: path.to_owned(), reason })?;
    let text = String::from_utf8_lossy(&bytes);
    let points =
        drawn_contour::points_of_curves(&path.display().to_string(), &text, section.layer).map_err(|problem| {
            let place = format!("{}: {}", problem.place, problem.message);
            Refusal::new("--measured", place, problem.way_out.clone())
        })?;
    Ok(points.into_iter().map(|at| ProbedPoint { place_mm: at.extend(section.z_mm), flank: None }).collect())
}
