//! Two surfaces of one place side by side: a measured flank and a simulated one, or two measurements.
//!
//! In: two surfaces with names, and the [`Chain`] of both. Out: [`SurfaceComparison`], which prints itself and writes
//! into a folder:
//!
//! | file | what |
//! | --- | --- |
//! | `report.html` | all of it on one page |
//! | `comparison.csv` | every parameter of both, their difference and ratio, with unit and definition |
//! | `first.png`, `second.png` | heights on the points that both have, to one scale |
//! | `difference.png`, `.x3p` | second less first, levelled |
//! | `abbott.svg` | both material ratio curves |
//! | `profiles.svg` | both along the middle row and the middle column |
//!
//! The second is laid over the first ([`align`]); both then go through the same chain on the points that they share, so
//! that a parameter differs because the surfaces do.

mod page;

use super::maps::grid_of;
use crate::colormap::ColourScale;
use crate::findings::Datum;
use crate::measure::topography::align::{self, Aligned, SurfaceMarks};
use crate::measure::topography::{Arguments, Chain, Evaluation, Surface};
use crate::output::atomic::file_error;
use crate::output::folder::OutputFolder;
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::map_png::{MapPicture, write_map_png};
use crate::output::report::REPORT_FILE;
use crate::output::surface_files::{Format, SurfaceFile, write_surface};
use crate::output::table::write_table;
use crate::output::text::{Sheet, significant};
use gearcut_core::error::{Error, Result};
use gearcut_core::units::UM_PER_MM;

/// Correlation below which the surfaces are hardly of one place.
const POOR: f64 = 0.5;
/// Steps of the drawn material ratio curves.
const CURVE_POINTS: u32 = 400;

/// Both surfaces on shared points, and what they have.
#[derive(Debug, Clone)]
pub struct SurfaceComparison {
    names: [String; 2],
    aligned: Aligned,
    /// After the chain.
    surfaces: [Surface; 2],
    chain: Vec<String>,
    evaluations: [Evaluation; 2],
    difference: Surface,
    marks: [Result<SurfaceMarks, String>; 2],
    /// Phase of the first's marks on the second, deg.
    phase_deg: Result<f64, String>,
}

/// A parameter of both.
struct ComparedRow {
    symbol: String,
    unit: &'static str,
    values: [Option<f64>; 2],
    definition: String,
}

impl SurfaceComparison {
    /// Compares two surfaces, each with the name to show it by.
    ///
    /// # Errors
    /// In words: surfaces that cannot be laid over each other, or a chain that the shared points do not allow.
    pub fn new(names: [String; 2], [first, second]: [&Surface; 2], chain: &Chain) -> Result<Self, String> {
        let aligned = align::aligned(first, second)?;
        let difference = align::difference(&aligned)?;
        let (a, words) = chain.apply(&aligned.first)?;
        let (b, _) = chain.apply(&aligned.second)?;
        let marks = [align::marks(&a), align::marks(&b)];
        let phase_deg = marks[0].clone().and_then(|marks| marks.phase_on_deg(&b));
        let evaluations = [Evaluation::of(&a, &Arguments::default()), Evaluation::of(&b, &Arguments::default())];
        Ok(Self { names, aligned, surfaces: [a, b], chain: words, evaluations, difference, marks, phase_deg })
    }

    /// Writes files and page.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, folder: &OutputFolder) -> Result<()> {
        let columns = ["parameter", "unit", "first", "second", "second_less_first", "second_over_first", "definition"];
        let rows = self.rows().into_iter().map(|row| {
            let [a, b] = row.values;
            let both = a.zip(b);
            let ratio = both.filter(|(a, _)| *a != 0.0).map(|(a, b)| b / a);
            let [symbol, unit, definition] = [row.symbol.as_str(), row.unit, row.definition.as_str()].map(Datum::from);
            let [a, b, less, over] = [a, b, both.map(|(a, b)| b - a), ratio].map(Datum::from);
            [symbol, unit, a, b, less, over, definition]
        });
        write_table(&folder.path("comparison.csv")?, &columns, rows)?;
        let pictures = self.write_maps(folder)?;
        let (abbott, profiles) = (self.abbott(), self.profiles());
        abbott.write_svg(&folder.path("abbott.svg")?)?;
        profiles.write_svg(&folder.path("profiles.svg")?)?;
        let of = format!("{} less {}, levelled", self.names[1], self.names[0]);
        let file = SurfaceFile { surface: self.difference.clone(), notes: vec![("quantity".to_owned(), of)] };
        write_surface(&folder.path("difference.x3p")?, Format::X3p, &file).map_err(file_error)?;
        self.page(pictures, abbott, profiles).write(&folder.path(REPORT_FILE)?)
    }

    /// Prints alignment, marks and parameters.
    pub fn print(&self, sheet: &mut Sheet) {
        let [first, second] = &self.names;
        sheet.heading(&format!("{first} and {second}"));
        for [name, value] in self.facts() {
            sheet.line(&name, value);
        }
        for doubt in self.doubts() {
            sheet.line("doubt", doubt);
        }
        sheet.heading("Parameters on the points that both have");
        sheet.table(&self.table());
    }

    /// What was done, and how well the surfaces fit: names with values.
    fn facts(&self) -> Vec<[String; 2]> {
        let a = &self.aligned.alignment;
        let mirror = match a.mirrored {
            [false, false] => "none",
            [true, false] => "second along x",
            [false, true] => "second along y",
            [true, true] => "second along x and y",
        };
        let [none, x, y, both] = a.by_mirror.map(correlation_text);
        let [mm_x, mm_y] = self.aligned.first.size_mm();
        let [height, slope_x, slope_y] = a.plane;
        let rest = &self.difference;
        let [low, high, squares, count] = rest
            .heights_um()
            .iter()
            .filter(|z| !z.is_nan())
            .fold([f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0], |[l, h, s, n], z| {
                [l.min(*z), h.max(*z), s + z * z, n + 1.0]
            });
        let mut facts = vec![
            fact("mirror", format!("{mirror} (correlation with none {none}, x {x}, y {y}, both {both})")),
            fact(
                "shift",
                format!(
                    "the second's first point lies at x {} um, y {} um of the first",
                    significant(a.shift_um[0], 5),
                    significant(a.shift_um[1], 5)
                ),
            ),
            fact(
                "plane",
                format!(
                    "{} um, {} um/mm along x, {} um/mm along y added to the second",
                    significant(height, 4),
                    significant(slope_x, 4),
                    significant(slope_y, 4)
                ),
            ),
            fact("correlation", correlation_text(a.correlation)),
            fact(
                "shared",
                format!(
                    "{} x {} points, {} x {} mm, {:.0} % of the smaller surface",
                    self.aligned.first.nx(),
                    self.aligned.first.ny(),
                    significant(mm_x, 4),
                    significant(mm_y, 4),
                    100.0 * a.overlap
                ),
            ),
            fact(
                "difference",
                format!(
                    "root mean square {} um, {} to {} um",
                    significant((squares / count).sqrt(), 4),
                    significant(low, 4),
                    significant(high, 4)
                ),
            ),
        ];
        for (name, marks) in self.names.iter().zip(&self.marks) {
            facts.push(fact(
                "marks",
                match marks {
                    Ok(marks) => format!(
                        "{name}: pitch {} um across {} deg, amplitude {} um",
                        significant(marks.pitch_um, 5),
                        significant(marks.direction_deg, 4),
                        significant(marks.amplitude_um, 4)
                    ),
                    Err(why) => format!("{name}: none, {why}"),
                },
            ));
        }
        if let (Ok(phase), Ok(marks)) = (&self.phase_deg, &self.marks[0]) {
            let [x, y] = a.shift_um;
            let pitches = marks.frequency[0] * x + marks.frequency[1] * y;
            facts.push(fact(
                "phase",
                format!(
                    "the second's marks come {} um later ({} deg); its shift is {} pitches across the marks",
                    significant(-phase / 360.0 * marks.pitch_um, 4),
                    significant(-phase, 4),
                    significant(pitches, 5)
                ),
            ));
        }
        facts.extend(self.chain.iter().map(|step| {
            let (name, what) = step.split_once(": ").unwrap_or((step, ""));
            fact(name, what.to_owned())
        }));
        facts
    }

    /// What is hardly right about the pair.
    fn doubts(&self) -> Vec<String> {
        let a = &self.aligned.alignment;
        let mut doubts = Vec::new();
        if a.correlation < POOR {
            doubts.push(format!(
                "a correlation of {} is poor: are these surfaces of one place?",
                correlation_text(a.correlation)
            ));
        }
        if align::fits_better(a.inverted, a.by_mirror[0].max(a.correlation)) {
            doubts.push(format!(
                "with its heights inverted the second correlates with {}: is one of them a replica? \
                 `gearcut texture FILE --invert --save ...` turns it back",
                correlation_text(a.inverted)
            ));
        }
        doubts
    }

    fn rows(&self) -> Vec<ComparedRow> {
        let [a, b] = &self.evaluations;
        let row = |p: &crate::measure::topography::Parameter| ComparedRow {
            symbol: p.symbol.clone(),
            unit: p.unit,
            values: [p.value.as_ref().ok().copied(), b.value(&p.symbol)],
            definition: p.definition.clone(),
        };
        a.parameters.iter().map(row).collect()
    }

    /// Parameters as printed, a row of names first.
    fn table(&self) -> Vec<Vec<String>> {
        let [first, second] = self.names.clone();
        let head = ["parameter".to_owned(), first, second, "difference".to_owned(), "unit".to_owned()];
        let text = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), |value| significant(value, 5));
        let rows = self.rows().into_iter().map(|row| {
            let [a, b] = row.values;
            let difference = a.zip(b).map(|(a, b)| b - a);
            vec![row.symbol, text(a), text(b), text(difference), row.unit.to_owned()]
        });
        std::iter::once(head.to_vec()).chain(rows).collect()
    }

    /// Writes the three maps and gives them back with what they show.
    fn write_maps(&self, folder: &OutputFolder) -> Result<Vec<(String, Vec<u8>)>> {
        let values = |surface: &Surface| surface.heights_um().iter().map(|z| *z as f32).collect::<Vec<f32>>();
        let maps = [values(&self.surfaces[0]), values(&self.surfaces[1])];
        let heights = ColourScale::sequential_over(maps.iter().map(Vec::as_slice));
        let difference = values(&self.difference);
        let [first, second] = &self.names;
        let of_difference = ColourScale::diverging_over([difference.as_slice()]);
        let mut pictures = Vec::new();
        for (file, title, surface, values, scale, quantity) in [
            ("first.png", first.clone(), &self.surfaces[0], &maps[0], heights, "height after the chain"),
            ("second.png", second.clone(), &self.surfaces[1], &maps[1], heights, "height after the chain"),
            (
                "difference.png",
                format!("{second} less {first}"),
                &self.difference,
                &difference,
                of_difference,
                "difference, levelled",
            ),
        ] {
            let grid = grid_of(surface, [("y", "from row to row"), ("x", "along the rows")]);
            let picture = MapPicture {
                title: &title,
                quantity,
                unit: "µm",
                grid: &grid,
                values,
                scale,
                missing: "not measured in one of them",
            };
            let path = folder.path(file)?;
            write_map_png(&path, &picture)?;
            pictures.push((title.clone(), std::fs::read(&path).map_err(Error::reading(&path))?));
        }
        Ok(pictures)
    }

    /// Both material ratio curves.
    fn abbott(&self) -> LineChart {
        let series = self.names.iter().zip(&self.evaluations).map(|(name, evaluation)| {
            let percent = |k: u32| 100.0 * f64::from(k) / f64::from(CURVE_POINTS);
            let points = (0..=CURVE_POINTS).map(|k| (percent(k), evaluation.curve.smc_um(percent(k)))).collect();
            LineSeries { name: name.clone(), points }
        });
        chart(
            "Material ratio curves",
            "areal material ratio",
            "%",
            vec![panel("height over the mean", series.collect())],
        )
    }

    /// Both along the middle row and the middle column.
    fn profiles(&self) -> LineChart {
        let line = |along_x: bool| {
            let series = self.names.iter().zip(&self.surfaces).map(|(name, surface)| {
                let (heights, step_um) = if along_x {
                    (surface.row(surface.ny() / 2).to_vec(), surface.dx_um())
                } else {
                    (surface.column(surface.nx() / 2), surface.dy_um())
                };
                let place_mm = |i: usize| i as f64 * step_um / UM_PER_MM;
                LineSeries {
                    name: name.clone(),
                    points: heights.iter().enumerate().map(|(i, z)| (place_mm(i), *z)).collect(),
                }
            });
            panel(if along_x { "along the middle row" } else { "along the middle column" }, series.collect())
        };
        chart("Profiles after the chain", "place", "mm", vec![line(true), line(false)])
    }
}

fn chart(title: &str, x_name: &str, x_unit: &str, panels: Vec<Panel>) -> LineChart {
    LineChart { title: title.to_owned(), x_name: x_name.to_owned(), x_unit: x_unit.to_owned(), panels }
}

fn panel(value_name: &str, series: Vec<LineSeries>) -> Panel {
    Panel { value_name: value_name.to_owned(), unit: "µm".to_owned(), series, limits: Vec::new(), least_division: 0.0 }
}

fn fact(name: &str, value: String) -> [String; 2] {
    [name.to_owned(), value]
}

fn correlation_text(value: f64) -> String {
    if value.is_finite() { format!("{value:.4}") } else { "none".to_owned() }
}
