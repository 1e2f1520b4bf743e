//! Deviations of the finished gear as a gear inspector knows them: profile and lead traces, pitch, runout, tooth
//! thickness.

use crate::measure::deviation::{Trace, TraceDeviation};
use crate::measure::inspection::{GearInspection, InspectedFlank};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::report::traces::{TraceColumn, TraceSheet};
use crate::output::report::{Block, PageSection};
use crate::output::text::significant;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Teeth that are traced evenly around the gear, as on a measuring machine.
const TRACED_TEETH: u32 = 4;
/// Smallest distance of two ticks on charts of deviations, µm: less would make rounding look like a fault.
const LEAST_DIVISION_UM: f64 = 1.0;
const SIDES: [(Side, &str); 2] = [(Side::Left, "left flanks"), (Side::Right, "right flanks")];

/// A flank with its traces.
struct Inspected<'a> {
    tooth: u32,
    side: Side,
    /// Profile in the middle of the face, and its deviations.
    profile: (&'a Trace, Option<TraceDeviation>),
    /// Line along the tooth, and its deviations.
    lead: (&'a Trace, Option<TraceDeviation>),
}

/// What a gear inspector has found on a gear.
pub struct Inspection<'a> {
    /// Flanks in order of teeth.
    flanks: Vec<Inspected<'a>>,
    gear: &'a GearInspection,
    /// Thickness of each tooth less half a pitch, arcs of the pitch curve, mm.
    thickness_mm: Vec<Option<f64>>,
    words: InspectionWords,
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
    /// Of flanks in order of teeth; `standard_mm` is half a pitch, arc of the pitch curve.
    pub fn new<Own>(
        flanks: &'a [InspectedFlank<Own>],
        gear: &'a GearInspection,
        standard_mm: f64,
        words: InspectionWords,
    ) -> Self {
        let inspected = |flank: &'a InspectedFlank<Own>| Inspected {
            tooth: flank.tooth,
            side: flank.side,
            profile: (&flank.profile_trace, flank.profile),
            lead: (&flank.lead_trace, flank.lead),
        };
        let thickness_mm = gear.thickness.iter().map(|t| t.map(|t| t.arc_mm - standard_mm)).collect();
        Self { flanks: flanks.iter().map(inspected).collect(), gear, thickness_mm, words }
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
            line. F total, ff form, fH slope deviation, µm."
                .to_owned(),
        ),
        Block::Heading("Pitch, runout, tooth thickness".to_owned()),
    ];
    blocks.extend(pitch_charts(inspection));
    blocks.push(Block::Note(
        "Pitch and thickness are arcs of the pitch curve in the middle of the face. Runout is the place, along the \
        curve's normal, of a probe that touches both flanks of a space there; a round gear's Fr. No tolerance class is \
        given: the standard's classes are for round gears."
            .to_owned(),
    ));
    PageSection {
        id: "deviations",
        title: "Deviations".to_owned(),
        lead: format!("The finished gear against the target: {}.", inspection.words.target),
        blocks,
    }
}

/// Micrometres; what is below a picometre is rounding and shown as zero.
fn shown_um(value_mm: f64) -> f64 {
    if value_mm.abs() < 1e-9 { 0.0 } else { value_mm * UM_PER_MM }
}

/// Flanks of one side to be traced: evenly around, and the teeth with the largest `total`.
fn traced<'a>(
    inspection: &'a Inspection,
    side: Side,
    total: impl Fn(&Inspected) -> Option<f64>,
) -> Vec<&'a Inspected<'a>> {
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

fn column(flank: &Inspected, (trace, deviation): (&Trace, Option<TraceDeviation>), line: &str) -> TraceColumn {
    let um = |value: f64| value * UM_PER_MM;
    let figure = |name: &str, value: Option<f64>| (format!("{name}{line}"), value.map(shown_um));
    TraceColumn {
        label: format!("tooth {}", flank.tooth),
        points: trace.places_mm.iter().copied().zip(trace.heights_mm.iter().copied().map(um)).collect(),
        mean_line: deviation.map(|d| [0, 1].map(|end| (d.between_mm[end], um(d.mean_line_mm[end])))),
        figures: vec![
            figure("F", deviation.map(|d| d.total_mm)),
            figure("ff", deviation.map(|d| d.form_mm)),
            figure("fH", deviation.map(|d| d.slope_mm)),
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
        traces: flanks.into_iter().map(|f| column(f, f.profile, "α")).collect(),
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
        traces: flanks.into_iter().map(|f| column(f, f.lead, "β")).collect(),
    }
}

fn pitch_charts(inspection: &Inspection) -> Vec<Block> {
    let teeth = inspection.thickness_mm.len();
    let categories: Vec<String> = (1..=teeth).map(|tooth| tooth.to_string()).collect();
    let bars = |title: &str, value_name: &str, series: Vec<BarSeries>| {
        Block::Bars(BarChart {
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
                &format!("{name}, Fp {} µm", significant(shown_um(pitch.total_mm()), 3)),
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
                &format!("probe in the space after the tooth, Fr {} µm", significant(shown_um(r.total_mm()), 3)),
                &r.radial_mm,
            )
        })
        .collect();
    let thickness = BarSeries {
        name: "teeth".to_owned(),
        values: inspection.thickness_mm.iter().map(|t| t.map(shown_um)).collect(),
    };
    let mut blocks =
        vec![bars("Single pitch deviation fp", "arc from the tooth before, less π m", vec![single(0), single(1)])];
    blocks.extend(lines("Cumulative pitch deviation", "arc from tooth 1, less its pitches", "tooth", cumulative));
    blocks.extend(lines("Runout", "place of the probe, outwards, about its mean", "tooth", runout));
    blocks.push(bars("Tooth thickness", "arc of the pitch curve, less π m / 2", vec![thickness]));
    blocks
}
