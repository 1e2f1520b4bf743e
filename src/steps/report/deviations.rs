//! Deviations of the finished gear as a gear inspector knows them: profile and lead traces, pitch, runout, tooth
//! thickness.

mod charts;

use super::facts::gear_words;
use super::texture;
use crate::findings::Findings;
use crate::findings::quantities::sizes::SIZES;
use crate::findings::table::table_file;
use crate::measure::deviation::{Trace, TraceDeviation};
use crate::measure::flank_tolerance::InspectionFigure;
use crate::measure::inspection::{GearInspection, InspectedFlank, TracedLines};
use crate::measure::verdict::{GearVerdict, JudgedFigure, LimitSource};
use crate::number_text::significant;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::folder::OutputFolder;
use crate::output::inspection_sheet::{InspectionSheet, SheetFigure};
use crate::output::line_chart::{Limit, LineChart, LineSeries, Panel};
use crate::output::report::traces::{TraceColumn, TraceFigure, TraceSheet};
use crate::output::report::{Block, PageSection, PageTable, Tone};
use crate::output::vector_page::VectorPage;
use crate::scene::Scene;
use crate::steps::inspection::{NO_SIZE, class_words, size_rows, verdict_words};
use crate::wrap::wrapped;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Teeth that are traced evenly around the gear, as on a measuring machine.
const TRACED_TEETH: u32 = 4;
/// Smallest distance of two ticks on charts of deviations, µm: less would make rounding look like a fault.
const LEAST_DIVISION_UM: f64 = 1.0;
/// Letters of a line of notes on the inspector's sheet: at half their size each they take the page's width.
const NOTE_LETTERS: usize = 150;
/// Total, form and slope deviation of profile and helix.
const PROFILE: [InspectionFigure; 3] =
    [InspectionFigure::ProfileTotal, InspectionFigure::ProfileForm, InspectionFigure::ProfileSlope];
const HELIX: [InspectionFigure; 3] =
    [InspectionFigure::HelixTotal, InspectionFigure::HelixForm, InspectionFigure::HelixSlope];
const SIDES: [(Side, &str); 2] = [(Side::Left, "left flanks"), (Side::Right, "right flanks")];

/// A flank with its traces.
struct TracedFlank<'a> {
    tooth: u32,
    side: Side,
    /// Where both traces run.
    lines: &'a TracedLines,
    /// Profile in the middle of the face, and its deviations.
    profile: (&'a Trace, Option<TraceDeviation>),
    /// Line along the tooth, and its deviations.
    lead: (&'a Trace, Option<TraceDeviation>),
}

/// What a gear inspector has found on a gear.
pub struct Inspection<'a> {
    /// Flanks in order of teeth.
    flanks: Vec<TracedFlank<'a>>,
    gear: &'a GearInspection,
    /// Thickness of each tooth less half a pitch with shift and allowance, arcs of the pitch curve, mm.
    thickness_mm: Vec<Option<f64>>,
    words: InspectionWords,
    verdict: &'a GearVerdict,
}

/// What a process says of its traces.
pub struct InspectionWords {
    /// What profiles stand over.
    pub profile_place: &'static str,
    /// Where the lines along the tooth run.
    pub lead_place: &'static str,
    /// What deviations along the tooth are called.
    pub lead_name: &'static str,
    /// What the finished gear is compared with.
    pub target: &'static str,
}

impl<'a> Inspection<'a> {
    /// Of flanks in order of teeth; `standard_mm` is half a pitch with shift and allowance, arc of the pitch curve.
    pub fn new<Own>(
        flanks: &'a [InspectedFlank<Own>],
        gear: &'a GearInspection,
        standard_mm: f64,
        words: InspectionWords,
        verdict: &'a GearVerdict,
    ) -> Self {
        let inspected = |flank: &'a InspectedFlank<Own>| TracedFlank {
            tooth: flank.tooth,
            side: flank.side,
            lines: &flank.lines,
            profile: (&flank.profile_trace, flank.profile),
            lead: (&flank.lead_trace, flank.lead),
        };
        let thickness_mm = gear.thickness.iter().map(|t| t.map(|t| t.arc_mm - standard_mm)).collect();
        Self { flanks: flanks.iter().map(inspected).collect(), gear, thickness_mm, words, verdict }
    }

    /// Limit of a figure's magnitude, um.
    fn limit_um(&self, figure: InspectionFigure) -> Option<f64> {
        self.verdict.of(figure).limit.map(|limit| limit.0)
    }

    /// The limits that the gear is judged by, in a sentence.
    fn held_against(&self) -> String {
        let mut sources: Vec<LimitSource> = Vec::new();
        for (_, source) in self.verdict.figures.iter().filter_map(|judged| judged.limit) {
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
        let sources: Vec<String> = sources.into_iter().map(LimitSource::words).collect();
        let class = match (self.verdict.class(), &self.verdict.no_class) {
            (None, Some(why)) => format!("no class: {why}"),
            (class, _) => format!("class reached: {}", class_words(class)),
        };
        match (sources.is_empty(), self.verdict.passes()) {
            (true, _) => format!("No limits of deviations were given; {class}."),
            (false, passes) => format!("{}: {}; {class}.", sources.join(", "), verdict_words(passes)),
        }
    }
}

/// The inspector's sheet on one page; `sizes` are name, sign and value of the sizes of a round gear.
fn sheet(
    inspection: &Inspection,
    title: &str,
    subtitle: &str,
    sizes: Vec<[String; 3]>,
    notes: Vec<String>,
    roughness: Vec<SheetFigure>,
) -> InspectionSheet {
    let um = |values: &[f64]| values.iter().map(|&mm| shown_um(mm)).collect::<Vec<_>>();
    let pitch = &inspection.gear.pitch;
    let of_pitch = |pick: fn(&crate::measure::deviation::PitchDeviations) -> &[f64]| {
        [0, 1].map(|side| pitch[side].as_ref().map_or_else(Vec::new, |pitch| um(pick(pitch))))
    };
    let verdict = inspection.verdict;
    InspectionSheet {
        title: title.to_owned(),
        subtitle: subtitle.to_owned(),
        program: format!("gearcut {}", env!("CARGO_PKG_VERSION")),
        sizes,
        profiles: SIDES.map(|(side, name)| profile_sheet(inspection, side, name)),
        helices: SIDES.map(|(side, name)| lead_sheet(inspection, side, name)),
        single_pitch_um: of_pitch(|pitch| &pitch.single_mm),
        cumulative_pitch_um: of_pitch(|pitch| &pitch.cumulative_mm),
        single_pitch_limit_um: inspection.limit_um(InspectionFigure::SinglePitch),
        runout_um: inspection.gear.runout.as_ref().map_or_else(Vec::new, |runout| um(&runout.radial_mm)),
        figures: verdict.figures.iter().map(sheet_figure).chain(roughness).collect(),
        verdict: inspection.held_against(),
        fails: verdict.passes() == Some(false),
        notes,
    }
}

/// Writes the lines of the inspector's sheet as `inspection_charts.csv`, if there is a folder: what `gearcut diagnose`
/// and `calibrate` read.
///
/// # Errors
/// The file cannot be written.
pub fn write_charts(inspection: &Inspection, folder: &OutputFolder) -> Result<()> {
    if folder.is_nowhere() {
        return Ok(());
    }
    charts::write(inspection, &folder.path(table_file("inspection_charts"))?)
}

/// The inspector's sheet.
pub fn inspection_page(inspection: &Inspection, scene: &Scene, found: &Findings) -> VectorPage {
    let mut sizes = found.group(&SIZES).map_or_else(Vec::new, size_rows);
    // A reason is wider than its column: it stands below, once.
    let mut reasons: Vec<(String, String)> = Vec::new();
    for [_, sign, value] in &mut sizes {
        let Some(why) = value.strip_prefix(NO_SIZE).map(str::to_owned) else { continue };
        "none".clone_into(value);
        match reasons.iter_mut().find(|(_, known)| *known == why) {
            Some((signs, _)) => *signs = format!("{signs}, {sign}"),
            None => reasons.push((sign.clone(), why)),
        }
    }
    let (roughness, cutoffs) = texture::sheet_figures(found, scene);
    let mut notes = vec![
        format!("Deviations of the surface as cut from {}.", inspection.words.target),
        "Profile and helix along the flank's normal, in the middle; dashed: the evaluated part. Pitch: arcs of the \
         pitch curve from the mean pitch."
            .to_owned(),
        format!("The table has the worst tooth of each side.{cutoffs}"),
    ];
    if scene.gear.helix_angle_rad != 0.0 && inspection.verdict.no_class.is_none() {
        notes.push("Limits of profile and helix are those of the transverse section times cos βb.".to_owned());
    }
    notes.extend(reasons.iter().flat_map(|(signs, why)| wrapped(&format!("No {signs}: {why}."), NOTE_LETTERS)));
    sheet(inspection, &scene.name, &gear_words(scene), sizes, notes, roughness).page()
}

/// Writes the inspector's sheet as `inspection.svg` and `inspection.pdf`.
///
/// # Errors
/// Files that cannot be written.
pub fn write_sheet(page: &VectorPage, folder: &OutputFolder) -> Result<()> {
    page.write(&folder.path("inspection.svg")?, &folder.path("inspection.pdf")?)
}

fn sheet_figure(judged: &JudgedFigure) -> SheetFigure {
    let side = |index: usize| {
        judged
            .sides
            .iter()
            .find(|figure| figure.side.map_or(index == 0, |side| side == SIDES[index].0))
            .map_or_else(|| "–".to_owned(), |figure| significant(shown_um(figure.value_um / UM_PER_MM), 3))
    };
    SheetFigure {
        cells: [
            judged.figure.sign().to_owned(),
            side(0).replace('-', "−"),
            side(1).replace('-', "−"),
            judged.limit.map_or_else(|| "–".to_owned(), |limit| significant(limit.0, 3)),
            class_words(judged.class),
            verdict_words(judged.passes()).to_owned(),
        ],
        fails: judged.passes() == Some(false),
    }
}

/// Traces and charts.
pub fn section(inspection: &Inspection) -> PageSection {
    let mut blocks = vec![
        Block::Heading("Profile, in the middle of the face".to_owned()),
        Block::Traces(SIDES.map(|(side, name)| profile_sheet(inspection, side, name)).into()),
        Block::Heading(format!("{}, {}", inspection.words.lead_name, inspection.words.lead_place)),
        Block::Traces(SIDES.map(|(side, name)| lead_sheet(inspection, side, name)).into()),
        Block::Note(
            "Four teeth evenly around the gear and those with the largest total deviation of either flank. Normal \
            deviations; dashed lines bound the evaluated part, the straight line is its mean \
            line. F total, ff form, fH slope deviation, µm; ≤ the limit, where one was given."
                .to_owned(),
        ),
        Block::Heading("Pitch, runout, tooth thickness".to_owned()),
    ];
    blocks.extend(pitch_charts(inspection));
    blocks.push(Block::Note(
        "Pitch and thickness are arcs of the pitch curve in the middle of the face. Runout is the place, along the \
        curve's normal, of a probe that touches both flanks of a space there; a round gear's Fr."
            .to_owned(),
    ));
    blocks.push(Block::Heading("Figures and limits".to_owned()));
    blocks.push(Block::Table(PageTable {
        caption: "The sheet of one page: inspection.pdf beside this file.".to_owned(),
        columns: ["Figure", "Left [µm]", "Right [µm]", "Limit [µm]", "Class", "Verdict"].map(str::to_owned).into(),
        rows: inspection.verdict.figures.iter().map(|judged| sheet_figure(judged).cells.into()).collect(),
    }));
    let tone = match inspection.verdict.passes() {
        Some(true) => Tone::Fine,
        Some(false) => Tone::Wrong,
        None => Tone::Open,
    };
    PageSection::new(
        "deviations",
        "Deviations",
        format!("The finished gear against the target: {}.", inspection.words.target),
        blocks,
    )
    .judged(tone, inspection.held_against())
}

/// Micrometres; what is below a picometre is rounding and shown as zero.
fn shown_um(value_mm: f64) -> f64 {
    if value_mm.abs() < 1e-9 { 0.0 } else { value_mm * UM_PER_MM }
}

/// Flanks of one side to be traced: evenly around, and the teeth with the largest `total`.
fn traced<'a>(
    inspection: &'a Inspection,
    side: Side,
    total: impl Fn(&TracedFlank) -> Option<f64>,
) -> Vec<&'a TracedFlank<'a>> {
    let teeth = inspection.thickness_mm.len() as u32;
    let mut numbers: Vec<u32> = (0..TRACED_TEETH.min(teeth)).map(|k| 1 + k * teeth / TRACED_TEETH.min(teeth)).collect();
    for of in [Side::Left, Side::Right] {
        let totals =
            inspection.flanks.iter().filter(|flank| flank.side == of).filter_map(|f| Some((f.tooth, total(f)?)));
        numbers.extend(totals.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|found| found.0));
    }
    numbers.sort_unstable();
    numbers.dedup();
    let flank = |tooth: &u32| inspection.flanks.iter().find(|f| f.tooth == *tooth && f.side == side);
    numbers.iter().filter_map(flank).collect()
}

fn column(
    inspection: &Inspection,
    flank: &TracedFlank,
    (trace, deviation): (&Trace, Option<TraceDeviation>),
    [total, form, slope]: [InspectionFigure; 3],
) -> TraceColumn {
    let um = |value: f64| value * UM_PER_MM;
    let figure = |figure: InspectionFigure, value: Option<f64>| TraceFigure {
        name: figure.sign().to_owned(),
        value: value.map(shown_um),
        limit: inspection.limit_um(figure),
    };
    TraceColumn {
        label: format!("tooth {}", flank.tooth),
        points: trace.places_mm.iter().copied().zip(trace.heights_mm.iter().copied().map(um)).collect(),
        mean_line: deviation.map(|d| [0, 1].map(|end| (d.between_mm[end], um(d.mean_line_mm[end])))),
        figures: vec![
            figure(total, deviation.map(|d| d.total_mm)),
            figure(form, deviation.map(|d| d.form_mm)),
            figure(slope, deviation.map(|d| d.slope_mm)),
        ],
    }
}

fn profile_sheet(inspection: &Inspection, side: Side, name: &str) -> TraceSheet {
    let flanks = traced(inspection, side, |flank| flank.profile.1.map(|p| p.total_mm));
    TraceSheet {
        title: format!("Profile, {name}"),
        place_name: inspection.words.profile_place.to_owned(),
        place_unit: "mm".to_owned(),
        unit: "µm".to_owned(),
        mirrored: side == Side::Left,
        traces: flanks.into_iter().map(|f| column(inspection, f, f.profile, PROFILE)).collect(),
    }
}

fn lead_sheet(inspection: &Inspection, side: Side, name: &str) -> TraceSheet {
    let flanks = traced(inspection, side, |flank| flank.lead.1.map(|l| l.total_mm));
    TraceSheet {
        title: format!("{}, {name}", inspection.words.lead_name),
        place_name: "v along the tooth".to_owned(),
        place_unit: "mm".to_owned(),
        unit: "µm".to_owned(),
        mirrored: side == Side::Left,
        traces: flanks.into_iter().map(|f| column(inspection, f, f.lead, HELIX)).collect(),
    }
}

/// The limit of a range, behind its value.
fn limit_words(inspection: &Inspection, figure: InspectionFigure) -> String {
    inspection.limit_um(figure).map_or_else(String::new, |um| format!(" (limit {} µm)", significant(um, 3)))
}

fn pitch_charts(inspection: &Inspection) -> Vec<Block> {
    let teeth = inspection.thickness_mm.len();
    let categories: Vec<String> = (1..=teeth).map(|tooth| tooth.to_string()).collect();
    let bars = |title: &str, value_name: &str, series: Vec<BarSeries>, limit_um: Option<f64>| {
        let limit = |name: &str, value: f64| Limit { name: name.to_owned(), value };
        Block::Bars(BarChart {
            has_mean: true,
            limits: limit_um.map_or_else(Vec::new, |um| vec![limit("limit", um), limit("limit", -um)]),
            least_division: LEAST_DIVISION_UM,
            title: title.to_owned(),
            category_name: "tooth".to_owned(),
            categories: categories.clone(),
            value_name: value_name.to_owned(),
            unit: "µm".to_owned(),
            series,
        })
    };
    let missing = || vec![None; teeth];
    let single = |index: usize| {
        let values = inspection.gear.pitch[index]
            .as_ref()
            .map_or_else(missing, |p| p.single_mm.iter().map(|&f| Some(shown_um(f))).collect());
        BarSeries { name: SIDES[index].1.to_owned(), values }
    };
    let over_teeth = |name: &str, values_mm: &[f64]| LineSeries {
        name: name.to_owned(),
        points: (1_u32..).map(f64::from).zip(values_mm.iter().map(|&value| shown_um(value))).collect(),
    };
    let lines = |title: &str, value_name: &str, x_name: &str, series: Vec<LineSeries>| {
        (!series.is_empty()).then(|| {
            Block::Lines(LineChart {
                title: title.to_owned(),
                x_name: x_name.to_owned(),
                x_unit: "1".to_owned(),
                panels: vec![Panel {
                    least_division: LEAST_DIVISION_UM,
                    value_name: value_name.to_owned(),
                    unit: "µm".to_owned(),
                    series,
                    limits: Vec::new(),
                }],
            })
        })
    };
    let cumulative: Vec<LineSeries> = inspection
        .gear
        .pitch
        .iter()
        .zip(SIDES)
        .filter_map(|(pitch, (_, name))| {
            let pitch = pitch.as_ref()?;
            Some(over_teeth(
                &format!(
                    "{name}, Fp {} µm{}",
                    significant(shown_um(pitch.total_mm()), 3),
                    limit_words(inspection, InspectionFigure::TotalPitch)
                ),
                &pitch.cumulative_mm,
            ))
        })
        .collect();
    let runout: Vec<LineSeries> = inspection
        .gear
        .runout
        .iter()
        .map(|r| {
            over_teeth(
                &format!(
                    "probe in the space after the tooth, Fr {} µm{}",
                    significant(shown_um(r.total_mm()), 3),
                    limit_words(inspection, InspectionFigure::Runout)
                ),
                &r.radial_mm,
            )
        })
        .collect();
    let thickness = BarSeries {
        name: "teeth".to_owned(),
        values: inspection.thickness_mm.iter().map(|t| t.map(shown_um)).collect(),
    };
    let single_limit_um = inspection.limit_um(InspectionFigure::SinglePitch);
    let mut blocks = vec![bars(
        "Single pitch deviation fp",
        "arc from the tooth before, less the mean pitch",
        vec![single(0), single(1)],
        single_limit_um,
    )];
    blocks.extend(lines("Cumulative pitch deviation", "arc from tooth 1, less its mean pitches", "tooth", cumulative));
    blocks.extend(lines("Runout", "place of the probe, outwards, about its mean", "tooth", runout));
    blocks.push(bars(
        "Tooth thickness",
        "arc of the pitch curve, less π m / 2 with shift and allowance",
        vec![thickness],
        None,
    ));
    blocks
}
