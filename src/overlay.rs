//! Two surfaces of one place, one laid over the other: a measured flank and a simulated one, or two measurements.
//!
//! In: two surfaces with names, and the [`Chain`] of both. Out: [`SurfaceComparison`]: how the second was laid over the
//! first, parameters of both side by side, maps, curves; as words, as findings and as pictures.
//!
//! The second is laid over the first ([`align`]); both then go through the same chain on the points that they share, so
//! that a parameter differs because the surfaces do.

use crate::colormap::ColourScale;
use crate::findings::notices::{InvertedHeights, PoorCorrelation};
use crate::findings::quantities::surfaces::{
    CHAIN_OF_BOTH, CORRELATION, CURVE_OF_FIRST, CURVE_OF_SECOND, CURVES, DIFFERENCE_HIGHEST, DIFFERENCE_LOWEST,
    DIFFERENCE_RMS, FIRST, MIRROR, OF_DIFFERENCE, OF_FIRST, OF_SECOND, OVERLAP, OVERLAY, PARAMETER, PARAMETER_UNIT,
    PARAMETERS, RATIO, SECOND, SHIFT_X, SHIFT_Y, WHAT_IT_IS,
};
use crate::findings::{Notice, Section};
use crate::measure::topography::align::{self, Aligned, SurfaceMarks};
use crate::measure::topography::{Arguments, Chain, Evaluation, Parameter, Surface, TextureError};
use crate::number_text::significant;
use crate::output::atomic::file_error;
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::map_png::{MapPicture, write_map_png};
use crate::output::surface_files::{Format, SurfaceFile, write_surface};
use gearcut_core::error::{Error, Result};
use gearcut_core::units::UM_PER_MM;

/// Correlation below which the surfaces are hardly of one place.
const POOR: f64 = 0.5;
/// Steps of the drawn material ratio curves.
const CURVE_POINTS: u32 = 400;
/// Steps of the curves in findings.
const TABLE_POINTS: u32 = 100;

/// Both surfaces on shared points, and what they have.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceComparison {
    /// Names of both.
    pub names: [String; 2],
    /// How the second was laid over the first.
    pub aligned: Aligned,
    /// After the chain.
    surfaces: [Surface; 2],
    /// What both went through, step by step.
    pub chain: Vec<String>,
    evaluations: [Evaluation; 2],
    difference: Surface,
    marks: [Result<SurfaceMarks, TextureError>; 2],
    /// Phase of the first's marks on the second, deg.
    phase_deg: Result<f64, TextureError>,
}

/// A parameter of both.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedRow {
    /// Symbol of the standard.
    pub symbol: String,
    /// Unit.
    pub unit: &'static str,
    /// Of the first and of the second surface; none where it does not exist.
    pub values: [Option<f64>; 2],
    /// What it is.
    pub definition: String,
}

impl ComparedRow {
    /// Second less first.
    pub fn difference(&self) -> Option<f64> {
        let [a, b] = self.values;
        a.zip(b).map(|(a, b)| b - a)
    }
}

impl SurfaceComparison {
    /// Compares two surfaces, each with the name to show it by.
    ///
    /// # Errors
    /// In words: surfaces that cannot be laid over each other, or a chain that the shared points do not allow.
    pub fn new(names: [String; 2], [first, second]: [&Surface; 2], chain: &Chain) -> Result<Self, TextureError> {
        let aligned = align::aligned(first, second)?;
        let difference = align::difference(&aligned)?;
        let (a, words) = chain.apply(&aligned.first)?;
        let (b, _) = chain.apply(&aligned.second)?;
        let marks = [align::marks(&a), align::marks(&b)];
        let phase_deg = marks[0].clone().and_then(|marks| marks.phase_on_deg(&b));
        let evaluations = [Evaluation::of(&a, &Arguments::default()), Evaluation::of(&b, &Arguments::default())];
        Ok(Self { names, aligned, surfaces: [a, b], chain: words, evaluations, difference, marks, phase_deg })
    }

    /// What was done, and how well the surfaces fit: names with values.
    pub fn facts(&self) -> Vec<[String; 2]> {
        let a = &self.aligned.alignment;
        let [none, x, y, both] = a.by_mirror.map(correlation_text);
        let [mm_x, mm_y] = self.aligned.first.size_mm();
        let [height, slope_x, slope_y] = a.plane;
        let [low, high] = self.difference.ends_um();
        let mut facts = vec![
            fact("mirror", format!("{} (correlation with none {none}, x {x}, y {y}, both {both})", self.mirror())),
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
                    significant(self.difference_um(), 4),
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

    /// Root mean square of the difference, levelled, um.
    fn difference_um(&self) -> f64 {
        let measured = self.difference.heights_um().iter().filter(|z| !z.is_nan());
        let [squares, count] = measured.fold([0.0, 0.0], |[sum, n], z| [sum + z * z, n + 1.0]);
        (squares / count).sqrt()
    }

    /// What is hardly right about the pair.
    pub fn doubts(&self, of: &str) -> Vec<Notice> {
        let a = &self.aligned.alignment;
        let mut doubts = Vec::new();
        if a.correlation < POOR {
            doubts.push(PoorCorrelation { of, correlation: correlation_text(a.correlation) }.notice());
        }
        if align::fits_better(a.inverted, a.by_mirror[0].max(a.correlation)) {
            doubts.push(InvertedHeights { of, correlation: correlation_text(a.inverted) }.notice());
        }
        doubts
    }

    /// Parameters of both surfaces, side by side.
    pub fn rows(&self) -> Vec<ComparedRow> {
        let [a, b] = &self.evaluations;
        let row = |p: &Parameter| ComparedRow {
            symbol: p.symbol.clone(),
            unit: p.unit,
            values: [p.value.as_ref().ok().copied(), b.value(&p.symbol)],
            definition: p.definition.clone(),
        };
        a.parameters.iter().map(row).collect()
    }

    /// Parameters as words, a row of names first.
    pub fn table(&self) -> Vec<Vec<String>> {
        let [first, second] = self.names.clone();
        let head = ["parameter".to_owned(), first, second, "difference".to_owned(), "unit".to_owned()];
        let text = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), |value| significant(value, 5));
        let rows = self.rows().into_iter().map(|row| {
            let [a, b, difference] = [row.values[0], row.values[1], row.difference()].map(text);
            vec![row.symbol, a, b, difference, row.unit.to_owned()]
        });
        std::iter::once(head.to_vec()).chain(rows).collect()
    }

    /// Writes the three maps and the difference as a surface, and gives the maps back with what they show. Files are
    /// `first.png`, `second.png`, `difference.png` and `.x3p`, each name with `stem` before it.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write_maps(&self, folder: &OutputFolder, stem: &str) -> Result<Vec<(String, Vec<u8>)>> {
        let values = |surface: &Surface| surface.heights_um().iter().map(|z| *z as f32).collect::<Vec<f32>>();
        let [first, second] = &self.names;
        let less = format!("{second} less {first}");
        let maps = [values(&self.surfaces[0]), values(&self.surfaces[1]), values(&self.difference)];
        let heights = ColourScale::sequential_over(maps[..2].iter().map(Vec::as_slice));
        let of_difference = ColourScale::diverging_over([maps[2].as_slice()]);
        let shown = [
            ("first", first, heights, "height after the chain"),
            ("second", second, heights, "height after the chain"),
            ("difference", &less, of_difference, "difference, levelled"),
        ];
        let mut pictures = Vec::new();
        // All three are on the same points.
        let grid = grid_of(&self.difference, [("y", "from row to row"), ("x", "along the rows")]);
        for ((name, title, scale, quantity), values) in shown.into_iter().zip(&maps) {
            let missing = "not measured in one of them";
            let picture = MapPicture { title, quantity, unit: "µm", grid: &grid, values, scale, missing };
            let path = folder.path(format!("{stem}{name}.png"))?;
            write_map_png(&path, &picture)?;
            pictures.push((title.clone(), std::fs::read(&path).map_err(Error::reading(&path))?));
        }
        let notes = vec![("quantity".to_owned(), format!("{less}, levelled"))];
        let file = SurfaceFile { surface: self.difference.clone(), notes };
        write_surface(&folder.path(format!("{stem}difference.x3p"))?, Format::X3p, &file).map_err(file_error)?;
        Ok(pictures)
    }

    /// The comparison as findings: how the second was laid over the first, and the parameters of both.
    pub fn section(&self) -> Section {
        let a = &self.aligned.alignment;
        let [low, high] = self.difference.ends_um();
        let parameters = PARAMETERS
            .table(self.rows())
            .column(&PARAMETER, |row| row.symbol.clone())
            .column(&PARAMETER_UNIT, |row| row.unit)
            .column(&OF_FIRST, |row| row.values[0])
            .column(&OF_SECOND, |row| row.values[1])
            .column(&OF_DIFFERENCE, ComparedRow::difference)
            .column(&WHAT_IT_IS, |row| row.definition.clone());
        let [first, second] = [0, 1].map(|k| self.curve(k, TABLE_POINTS));
        let curves = CURVES
            .table(first.into_iter().zip(second))
            .column(&RATIO, |((ratio, _), _)| *ratio)
            .column(&CURVE_OF_FIRST, |((_, height), _)| *height)
            .column(&CURVE_OF_SECOND, |(_, (_, height))| *height);
        OVERLAY
            .section([
                FIRST.of(self.names[0].as_str()),
                SECOND.of(self.names[1].as_str()),
                MIRROR.of(self.mirror()),
                SHIFT_X.of(a.shift_um[0]),
                SHIFT_Y.of(a.shift_um[1]),
                CORRELATION.of(a.correlation),
                OVERLAP.of(100.0 * a.overlap),
                DIFFERENCE_RMS.of(self.difference_um()),
                DIFFERENCE_LOWEST.of(low),
                DIFFERENCE_HIGHEST.of(high),
                CHAIN_OF_BOTH.of(self.chain.join("; ")),
            ])
            .table(parameters)
            .table(curves)
    }

    /// Axes of the second that run the other way.
    fn mirror(&self) -> &'static str {
        match self.aligned.alignment.mirrored {
            [false, false] => "none",
            [true, false] => "second along x",
            [false, true] => "second along y",
            [true, true] => "second along x and y",
        }
    }

    /// Material ratio curve of one of them: ratios, per cent, and heights over the mean, um.
    fn curve(&self, which: usize, points: u32) -> Vec<(f64, f64)> {
        let percent = |k: u32| 100.0 * f64::from(k) / f64::from(points);
        (0..=points).map(percent).map(|p| (p, self.evaluations[which].curve.smc_um(p))).collect()
    }

    /// Both material ratio curves.
    pub fn abbott(&self) -> LineChart {
        let series = [0, 1].map(|k| LineSeries { name: self.names[k].clone(), points: self.curve(k, CURVE_POINTS) });
        chart(
            "Material ratio curves",
            "areal material ratio",
            "%",
            vec![panel("height over the mean", series.to_vec())],
        )
    }

    /// Both along the middle row and the middle column.
    pub fn profiles(&self) -> LineChart {
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

/// The grid of a surface for pictures, y upwards; its axes y and x by name and meaning.
pub fn grid_of(surface: &Surface, [y, x]: [(&str, &str); 2]) -> MapGrid {
    let axis = |(name, meaning): (&str, &str), step_um: f64, count: usize| MapAxis {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        start_mm: 0.0,
        step_mm: step_um / UM_PER_MM,
        count,
    };
    MapGrid { u: axis(y, surface.dy_um(), surface.ny()), v: axis(x, surface.dx_um(), surface.nx()) }
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

/// A correlation as words.
pub fn correlation_text(value: f64) -> String {
    if value.is_finite() { format!("{value:.4}") } else { "none".to_owned() }
}
