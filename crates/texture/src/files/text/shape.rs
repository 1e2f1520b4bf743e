//! What a table of numbers is: a map of heights, positions and heights of a trace, or points of a grid.
//!
//! In: the [`TextTable`], what the lines above it say, what is given beside the file. Out: heights in um with their
//! spacing. Three columns are x, y, z if their places make a grid; two are x, z if the places are equally far apart;
//! one is a trace. Tables of two and three columns are maps only where the file gives a map's spacing, and no unit is
//! taken for granted: what the file and its reader leave open is refused, with what the table was seen to be.

use super::super::bounds::{kept_number, points};
use super::super::content::{Given, MeasuredContent, MeasuredFile};
use super::super::units::LengthUnit;
use super::header::{Length, TextColumn, TextHeader};
use super::table::TextTable;
use crate::error::FileFault;

/// Share of a step by which a printed place may lie beside its place on the grid.
const BESIDE: f64 = 0.01;
/// Share of a grid that must have points: fewer are scattered, not a grid with holes.
const LEAST_FILLED: f64 = 0.5;
/// Share by which a spacing may differ from the one that is given.
const SAME: f64 = 1e-6;
/// Lines from which a rising first column is no accident.
const MANY_LINES: usize = 8;

/// Equal steps of sorted places.
struct EvenSteps {
    start: f64,
    step: f64,
    count: usize,
}

/// Heights with sides and spacing, in the units of the file.
struct TextGrid {
    nx: usize,
    ny: usize,
    spacing: [f64; 2],
    values: Vec<f64>,
    what: String,
    remarks: Vec<String>,
}

/// The surface or trace of a table.
pub(super) fn measured(table: TextTable, header: TextHeader, given: &Given) -> Result<MeasuredFile, FileFault> {
    let columns = table.columns;
    let lines = table.values.len().checked_div(columns).unwrap_or(0);
    if lines == 0 {
        return Err(
            "the file has no row of numbers: heights are lines of numbers with tabulators, semicolons, commas or \
                    blanks between them"
                .into(),
        );
    }
    for (count, found, sides) in [(header.counts[0], columns, "columns"), (header.counts[1], lines, "rows")] {
        if let Some((count, line)) = count.filter(|(count, _)| columns > 3 && *count != found) {
            return Err(format!("line {line} says {count} points, but the table has {found} {sides}").into());
        }
    }
    let is_map = header.own || header.spacing.iter().chain(&header.sides).flatten().count() == 2;
    let coordinates = if is_map { None } else { coordinates(&table, lines, &header)? };
    let mut remarks = table.remarks;
    let (grid, spacing_um) = match coordinates {
        Some(grid) => {
            let unit = header.columns.iter().find(|(column, _)| *column != TextColumn::Z).and_then(|(_, unit)| *unit);
            let unit = agreed("positions", unit.or(header.spacing_unit), given.spacing_unit)?;
            let unit = unit.ok_or_else(|| {
                FileFault::Unsaid(open(&grid.what, "the unit of its positions", "--spacing-unit", &header))
            })?;
            let spacing_um = grid.spacing.map(|step| step * unit.um());
            (grid, spacing_um)
        }
        None => {
            let what = format!("a table of {columns} x {lines} heights");
            let spacing_um = map_spacing(&header, given, &what, [columns, lines])?;
            let (nx, ny, remarks) = (columns, lines, Vec::new());
            (TextGrid { nx, ny, spacing: spacing_um, values: table.values, what, remarks }, spacing_um)
        }
    };
    remarks.extend(grid.remarks);
    if let Some(asked) = given.spacing_um {
        let lines_only = grid.nx.min(grid.ny) == 1;
        for k in 0..if lines_only { 1 } else { 2 } {
            // Positions are printed with few digits.
            if (spacing_um[k] - asked[k]).abs() > BESIDE * asked[k] {
                let [x, y] = spacing_um;
                let [ax, ay] = asked;
                return Err(FileFault::Contradicted(format!(
                    "the file says its points are {x} x {y} um apart, not {ax} x {ay} um"
                )));
            }
        }
    }
    let named = header.columns.iter().find(|(column, _)| *column == TextColumn::Z).and_then(|(_, unit)| *unit);
    if let (Some(a), Some(b)) = (named, header.height_unit)
        && a != b
    {
        return Err(format!("heights are in {a} by the name of their column and in {b} by another line").into());
    }
    let unit = agreed("heights", named.or(header.height_unit), given.height_unit)?;
    let unit =
        unit.ok_or_else(|| FileFault::Unsaid(open(&grid.what, "the unit of its heights", "--height-unit", &header)))?;
    if given.height_unit.is_some() && !header.unclear.is_empty() {
        let lines = header.unclear[..header.unclear.len().min(3)].join("; ");
        remarks.push(format!("heights: {unit}, as given; a unit was not understood in {lines}"));
    }
    let heights = grid.values.into_iter().map(|z| kept_number(z, z * unit.um())).collect();
    let content = MeasuredContent::new(grid.nx, grid.ny, spacing_um[0], spacing_um[1], heights)?;
    Ok(MeasuredFile { content, notes: header.notes, remarks })
}

/// The unit of the file and the one that is given, which must not contradict each other.
fn agreed(what: &str, of_file: Option<LengthUnit>, given: Option<LengthUnit>) -> Result<Option<LengthUnit>, FileFault> {
    match (of_file, given) {
        (Some(of_file), Some(given)) if of_file != given => Err(FileFault::Contradicted(format!(
            "the file says its {what} are in {of_file}, not in {given}: leave the option out"
        ))),
        _ => Ok(of_file.or(given)),
    }
}

/// What the table is, what is not known of it, and how to say it.
fn open(what: &str, missing: &str, option: &str, header: &TextHeader) -> String {
    let key = option.trim_start_matches("--").replace('-', "_");
    let seen = match &header.unclear[..] {
        [] => String::new(),
        lines => format!(" (not understood: {})", lines[..lines.len().min(3)].join("; ")),
    };
    format!(
        "{what}; no line says {missing}{seen}: give it with {option} um (or nm, mm, m), or in a line `# {key} = um`"
    )
}

/// Spacing of a map, um: of the file, else as it is given.
fn map_spacing(header: &TextHeader, given: &Given, what: &str, counts: [usize; 2]) -> Result<[f64; 2], FileFault> {
    let um = |length: Length, points: f64| -> Result<(f64, f64), FileFault> {
        let unit = agreed("spacings", length.unit.or(header.spacing_unit), given.spacing_unit)?;
        let unit =
            unit.ok_or_else(|| FileFault::Unsaid(open(what, "the unit of its spacing", "--spacing-unit", header)))?;
        Ok((length.value * unit.um() / points, length.rounding))
    };
    let mut found = [None, None];
    for axis in 0..2 {
        found[axis] = match (header.spacing[axis], header.sides[axis]) {
            (Some(step), _) => Some(um(step, 1.0)?),
            (None, Some(side)) => Some(um(side, counts[axis] as f64)?),
            (None, None) => None,
        };
    }
    let trace = counts[0].min(counts[1]) == 1;
    let along = usize::from(counts[0] == 1);
    match (found, given.spacing_um) {
        ([Some(x), Some(y)], None) => Ok([x.0, y.0]),
        ([Some((x, rx)), Some((y, ry))], Some([ax, ay])) => {
            // Printed sides have few digits: what is given has more of them.
            let same = |found: f64, asked: f64, rounding: f64| (found - asked).abs() <= (SAME + rounding) * asked;
            if same(x, ax, rx) && same(y, ay, ry) {
                return Ok([ax, ay]);
            }
            Err(FileFault::Contradicted(format!("the file says its points are {x} x {y} um apart, not {ax} x {ay} um")))
        }
        (found, None) if trace && found[along].is_some() => Ok([found[along].expect("there").0; 2]),
        ([None, None], Some(asked)) => Ok(asked),
        ([Some(_), None] | [None, Some(_)], _) => Err(format!(
            "{what}; the file gives the spacing along one axis only: give both in lines `# dx_um = ` and `# dy_um = `"
        )
        .into()),
        ([None, None], None) => {
            Err(FileFault::Unsaid(open(what, "how far its points are apart", "--spacing-um", header).replace(
                "--spacing-um um (or nm, mm, m), or in a line `# spacing_um = um`",
                "--spacing-um, or in lines `# dx_um = ` and `# dy_um = `",
            )))
        }
    }
}

/// Positions and heights, if the table is that.
fn coordinates(table: &TextTable, lines: usize, header: &TextHeader) -> Result<Option<TextGrid>, FileFault> {
    let column = |k: usize| table.values.iter().skip(k).step_by(table.columns).copied().collect::<Vec<f64>>();
    let named: Vec<TextColumn> = header.columns.iter().map(|(column, _)| *column).collect();
    match table.columns {
        2 => {
            if !named.is_empty() && named != [TextColumn::X, TextColumn::Z] {
                return Err("two columns that are not position and height by their names".into());
            }
            let (places, heights) = (column(0), column(1));
            let steps = steps(&places, true).filter(|steps| steps.count == lines);
            let Some(EvenSteps { step, .. }) = steps else {
                return Err(format!(
                    "two columns of {lines} lines whose first are no places at equal distances: a profile must be \
                     resampled at equal distances; a map of two points a row needs lines `# dx_um = ` and `# dy_um = `"
                )
                .into());
            };
            let what =
                format!("two columns whose first rises by {step} from line to line: a profile of {lines} points");
            let spacing = [step; 2];
            Ok(Some(TextGrid {
                nx: lines,
                ny: 1,
                spacing,
                values: heights,
                what,
                remarks: vec!["columns: position and height of a profile".to_owned()],
            }))
        }
        3 => {
            if !named.is_empty() && named != [TextColumn::X, TextColumn::Y, TextColumn::Z] {
                return Err("three columns that are not x, y and height by their names".into());
            }
            grid_of_points([column(0), column(1), column(2)]).map(Some)
        }
        columns if columns > 3 && lines >= MANY_LINES => {
            let rises = |k: usize| steps(&column(k), true).is_some_and(|steps| steps.count == lines);
            if grid_of_points([column(0), column(1), column(2)]).is_ok() {
                return Err(format!(
                    "{columns} columns whose first two are the places of a grid: points with more than their heights; \
                     keep three columns, x, y and z"
                )
                .into());
            }
            if rises(0) && !rises(1) {
                return Err(format!(
                    "{columns} columns whose first rises in equal steps: positions beside heights; keep two columns \
                     for a profile, or leave the positions out for a map"
                )
                .into());
            }
            Ok(None)
        }
        _ => Ok(None),
    }
}

/// Points x, y, z in any order on a grid; places without a point are holes.
fn grid_of_points([x, y, z]: [Vec<f64>; 3]) -> Result<TextGrid, FileFault> {
    let lines = x.len();
    let scattered = || {
        FileFault::Malformed(format!(
            "three columns of {lines} lines, no points of a regular grid: points x, y, z must be resampled on one; a \
             map of three points a row needs lines `# dx_um = ` and `# dy_um = `"
        ))
    };
    let (Some(along_x), Some(along_y)) = (steps(&x, false), steps(&y, false)) else { return Err(scattered()) };
    let (nx, ny) = (along_x.count, along_y.count);
    let Ok(count) = points(nx, ny) else { return Err(scattered()) };
    if (lines as f64) < LEAST_FILLED * count as f64 || lines > count {
        return Err(scattered());
    }
    let index = |steps: &EvenSteps, place: f64| ((place - steps.start) / steps.step).round() as usize;
    let mut values = vec![f64::NAN; count];
    let mut taken = vec![false; count];
    for i in 0..lines {
        let place = index(&along_y, y[i]) * nx + index(&along_x, x[i]);
        if std::mem::replace(&mut taken[place], true) {
            return Err(format!("two lines are the point x {} y {}", x[i], y[i]).into());
        }
        values[place] = z[i];
    }
    let missing = count - lines;
    let mut remarks = vec!["columns: x, y and height of points on a grid; rows follow y upwards".to_owned()];
    if missing > 0 {
        remarks.push(format!("{missing} places of the grid have no line: holes"));
    }
    let (dx, dy) = (along_x.step, along_y.step);
    let what = format!("three columns, x, y and z of {nx} x {ny} points {dx} x {dy} apart");
    Ok(TextGrid { nx, ny, spacing: [dx, dy], values, what, remarks })
}

/// The equal steps of places; `in_order`: each place one step after that before it.
fn steps(places: &[f64], in_order: bool) -> Option<EvenSteps> {
    if places.len() < 2 || places.iter().any(|place| !place.is_finite()) {
        return None;
    }
    let mut sorted = places.to_vec();
    if in_order {
        if places[0] > places[places.len() - 1] {
            return None;
        }
    } else {
        sorted.sort_by(f64::total_cmp);
    }
    let (start, range) = (sorted[0], sorted[sorted.len() - 1] - sorted[0]);
    let least = range * 1e-7;
    let gap = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > least).fold(f64::INFINITY, f64::min);
    if !(gap.is_finite() && range > 0.0) {
        return None;
    }
    // The smallest gap is off by its rounding; the whole range is not.
    let count = (range / gap).round() + 1.0;
    let step = range / (count - 1.0);
    let fits = |place: &f64| {
        let at = (place - start) / step;
        (at - at.round()).abs() <= BESIDE
    };
    let ordered = || sorted.windows(2).all(|pair| ((pair[1] - pair[0]) / step - 1.0).abs() <= 2.0 * BESIDE);
    (count <= 1e7 && sorted.iter().all(fits) && (!in_order || ordered())).then_some(EvenSteps {
        start,
        step,
        count: count as usize,
    })
}
