//! Deviations of the finished gear as a gear inspector knows them: profile and lead traces, pitch, runout, tooth thickness.

use crate::gear::generation::Side;
use crate::job::Job;
use crate::measure::FlankReport;
use crate::measure::deviation::{Trace, TraceDeviation};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::quantity::Place;
use crate::output::report::traces::{TraceColumn, TraceSheet};
use crate::output::report::{Block, KeyNumber, Section};
use crate::output::text::significant;
use crate::run::CutGear;
use crate::units::UM_PER_MM;

/// Teeth that are traced evenly around the gear, as on a measuring machine.
const TRACED_TEETH: u32 = 4;
const SIDES: [(Side, &str); 2] = [(Side::Left, "left flanks"), (Side::Right, "right flanks")];

/// Traces and charts.
pub fn section(job: &Job, cut: &CutGear) -> Section {
    let mut blocks = vec![
        Block::Heading("Profile, in the middle of the face".to_owned()),
        Block::Traces(SIDES.map(|(side, name)| profile_sheet(cut, side, name)).into()),
        Block::Heading("Lead, at the pitch curve".to_owned()),
        Block::Traces(SIDES.map(|(side, name)| lead_sheet(cut, side, name)).into()),
        Block::Note(
            "Four teeth evenly around the gear and those with the largest total deviation of either flank. Heights over the target along its normal; dashed lines bound the evaluated part, the straight line is its mean line. F total, ff form, fH slope deviation, µm."
                .to_owned(),
        ),
        Block::Heading("Pitch, runout, tooth thickness".to_owned()),
    ];
    blocks.extend(pitch_charts(job, cut));
    blocks.push(Block::Note(
        "Pitch and thickness are arcs of the pitch curve in the middle of the face. Runout is the place, along the curve's normal, of a wedge with flanks at the pressure angle in each space; a round gear's F_r. No tolerance class is given: the standard's classes are for round gears."
            .to_owned(),
    ));
    Section {
        id: "deviations",
        title: "Deviations of the finished gear".to_owned(),
        lead: "Against the target: the surface that the last operation would leave with infinitely many strokes and no error.".to_owned(),
        blocks,
    }
}

/// The inspector's three figures.
pub fn key_numbers(cut: &CutGear) -> Vec<KeyNumber> {
    let number = |name: &str, value_mm: Option<f64>, definition: &str, place: Option<Place>| KeyNumber {
        name: name.to_owned(),
        value: value_mm.map_or_else(|| "–".to_owned(), |value| significant(shown_um(value), 3)),
        unit: if value_mm.is_some() { "µm".to_owned() } else { String::new() },
        definition: definition.to_owned(),
        note: if value_mm.is_some() {
            String::new()
        } else {
            "a flank was not cut or does not cross the pitch curve".to_owned()
        },
        place,
    };
    let worst = cut
        .report
        .flanks
        .iter()
        .filter_map(|flank| Some((flank, flank.profile?)))
        .reduce(|best, next| if next.1.total_mm > best.1.total_mm { next } else { best });
    let pitch = |pick: fn(&crate::measure::deviation::PitchDeviations) -> f64| {
        cut.report.pitch.iter().flatten().map(pick).reduce(f64::max)
    };
    vec![
        number(
            "Profile deviation Fα, largest",
            worst.map(|(_, profile)| profile.total_mm),
            "largest range of heights over the target along an evaluated profile, middle of the face",
            worst.map(|(flank, profile)| Place {
                tooth: flank.tooth,
                flank: flank.side.name().into(),
                u_mm: 0.5 * (profile.between_mm[0] + profile.between_mm[1]),
                v_mm: 0.0,
            }),
        ),
        number(
            "Single pitch deviation fp, largest",
            pitch(crate::measure::deviation::PitchDeviations::largest_single_mm),
            "largest single pitch deviation of either flank, arc on the pitch curve",
            None,
        ),
        number(
            "Total pitch deviation Fp",
            pitch(crate::measure::deviation::PitchDeviations::total_mm),
            "range of the cumulative pitch deviations, larger of both flanks",
            None,
        ),
        number(
            "Runout Fr",
            cut.report.runout.as_ref().map(crate::measure::deviation::Runout::total_mm),
            "range of a probe's place along the pitch curve's normal over all spaces",
            None,
        ),
    ]
}

/// Micrometres; what is below a picometre is rounding and shown as zero.
fn shown_um(value_mm: f64) -> f64 {
    if value_mm.abs() < 1e-9 { 0.0 } else { value_mm * UM_PER_MM }
}

/// Flanks of one side to be traced: evenly around, and the teeth with the largest `total`.
fn traced<'a>(cut: &'a CutGear, side: Side, total: impl Fn(&FlankReport) -> Option<f64>) -> Vec<&'a FlankReport> {
    let teeth = cut.report.thickness.len() as u32;
    let mut numbers: Vec<u32> = (0..TRACED_TEETH.min(teeth)).map(|k| 1 + k * teeth / TRACED_TEETH.min(teeth)).collect();
    for of in [Side::Left, Side::Right] {
        let totals =
            cut.report.flanks.iter().filter(|flank| flank.side == of).filter_map(|f| Some((f.tooth, total(f)?)));
        numbers.extend(totals.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|found| found.0));
    }
    numbers.sort_unstable();
    numbers.dedup();
    let flank = |tooth: &u32| cut.report.flanks.iter().find(|f| f.tooth == *tooth && f.side == side);
    numbers.iter().filter_map(flank).collect()
}

fn column(flank: &FlankReport, trace: &Trace, deviation: Option<TraceDeviation>, line: &str) -> TraceColumn {
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

fn profile_sheet(cut: &CutGear, side: Side, name: &str) -> TraceSheet {
    let flanks = traced(cut, side, |flank| flank.profile.map(|p| p.total_mm));
    TraceSheet {
        title: format!("Profile, {name}"),
        place_name: "u from the form point (below) to the tip".to_owned(),
        place_unit: "mm".to_owned(),
        unit: "µm".to_owned(),
        mirrored: side == Side::Left,
        traces: flanks.into_iter().map(|f| column(f, &f.profile_trace, f.profile, "α")).collect(),
    }
}

fn lead_sheet(cut: &CutGear, side: Side, name: &str) -> TraceSheet {
    let flanks = traced(cut, side, |flank| flank.lead.map(|l| l.total_mm));
    TraceSheet {
        title: format!("Lead, {name}"),
        place_name: "v along the tooth".to_owned(),
        place_unit: "mm".to_owned(),
        unit: "µm".to_owned(),
        mirrored: side == Side::Left,
        traces: flanks.into_iter().map(|f| column(f, &f.lead_trace, f.lead, "β")).collect(),
    }
}

fn pitch_charts(job: &Job, cut: &CutGear) -> Vec<Block> {
    let report = &cut.report;
    let teeth = report.thickness.len();
    let categories: Vec<String> = (1..=teeth).map(|tooth| tooth.to_string()).collect();
    let bars = |title: &str, value_name: &str, series: Vec<BarSeries>| {
        Block::Bars(BarChart {
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
        let values = report.pitch[index]
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
                    value_name: value_name.to_owned(),
                    unit: "µm".to_owned(),
                    series,
                    limits: Vec::new(),
                }],
            })
        })
    };
    let cumulative: Vec<LineSeries> = report
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
    let runout: Vec<LineSeries> = report
        .runout
        .iter()
        .map(|r| {
            over_teeth(
                &format!("probe in the space after the tooth, Fr {} µm", significant(shown_um(r.total_mm()), 3)),
                &r.radial_mm,
            )
        })
        .collect();
    let standard_mm = 0.5 * std::f64::consts::PI * job.scene.gear.module_mm;
    let thickness = BarSeries {
        name: "teeth".to_owned(),
        values: report.thickness.iter().map(|t| t.map(|t| shown_um(t.arc_mm - standard_mm))).collect(),
    };
    let mut blocks =
        vec![bars("Single pitch deviation fp", "arc from the tooth before, less π m", vec![single(0), single(1)])];
    blocks.extend(lines("Cumulative pitch deviation", "arc from tooth 1, less its pitches", "tooth", cumulative));
    blocks.extend(lines("Runout", "place of the probe, outwards, about its mean", "tooth", runout));
    blocks.push(bars("Tooth thickness", "arc of the pitch curve, less π m / 2", vec![thickness]));
    blocks
}
