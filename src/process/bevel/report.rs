//! The page of a bevel gear: slot, grid deviations, marks, blades, six axes.

use super::axes_report::BevelAxesReport;
use super::blank::CutCells;
use super::body::beside_flanks;
use super::check::gear_words;
use super::drawing::{self, Drawn};
use super::findings::whole::{ChipCharts, page_words};
use super::gear::BevelGear;
use super::job::BevelJob;
use super::measure::BevelReport;
use super::net;
use super::quantities::{
    BLADES, BODY, CHIPS, ERRORS, FLANK_BLADES, FORM, IDLE_SHARE, LAW, MARK_HEIGHT, MARK_SPACING, MARKS, POSITION,
    SETTINGS, SLOT_DEPTH, SLOT_WIDTH,
};
use crate::findings::quantities::blank::{BLANK_VOLUME, LEFT_VOLUME};
use crate::findings::quantities::cutting::{CYCLE_TIME, LINKAGE, OFFSET};
use crate::findings::{self, Findings, QuantityRow};
use crate::job::rows_z_mm;
use crate::number_text::{from_full_depth, plain, significant};
use crate::output::folder::OutputFolder;
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::report::{Block, Page, PageSection, PageTable, Tone};
use crate::steps;
use crate::steps::axes;
use crate::steps::report::facts::table;
use crate::steps::report::quantities::{self, value_and_unit};
use crate::steps::report::{PageGear, RunWords, files, headline_words, machine_errors, record, texture};
use crate::steps::view_mesh::{ViewFlank, ViewMesh};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use rayon::prelude::*;

/// Distance of the rows of the flanks that the page shows, mm: chords a hundredth of a millimetre off the spiral.
const VIEW_ROW_MM: f64 = 3.0;
/// Distance of the columns of roots and tip lands that it shows, mm.
const VIEW_COLUMN_MM: f64 = 0.4;
/// Smallest distance of two ticks on charts of deviations, um.
const LEAST_DIVISION_UM: f64 = 1.0;

/// The page of a run.
///
/// # Errors
/// A place that the roll does not generate; a picture of the folder cannot be read back.
pub fn page(
    job: &BevelJob,
    gear: &BevelGear,
    found: &Findings,
    (whole, charts): (Option<&CutCells>, ChipCharts),
    motion: &[BevelAxesReport],
    run: &RunWords,
    folder: &OutputFolder,
) -> Result<Page> {
    let mut sections = vec![deviations(job, gear, found), slot(gear, found), blades(job, found)];
    sections.extend(machine_errors::section(found));
    sections.extend(chips(job, found, charts));
    sections.extend(texture::section(found, folder)?);
    sections.push(axes::section(motion, found, "How the six-axis machine moves while one slot is cut.", "Axis speeds"));
    sections.push(setup(job, found));
    sections.push(files::section(folder)?);
    sections.push(record(gear.flanks.len(), &gear.work, run));
    let operation = |operation: &findings::Section| {
        let offset = operation.value(&OFFSET).map_or_else(|| "–".to_owned(), from_full_depth);
        format!("{}: {}, head {offset}", operation.key, operation.text(&LINKAGE))
    };
    let page_gear = PageGear { words: gear_words(job), mesh: mesh(job, whole)? };
    Ok(steps::report::page(job, page_gear, found, &gear.maps, operation, sections))
}

/// Nothing where the run was stopped before.
fn chips(job: &BevelJob, found: &Findings, (bars, lines): ChipCharts) -> Option<PageSection> {
    let blank = found.group(&BODY)?;
    let number = |row: &QuantityRow| blank.value(row).map_or_else(|| "–".to_owned(), |value| significant(value, 5));
    let mut blocks: Vec<Block> = lines.into_iter().map(|(_, chart)| Block::Lines(chart)).collect();
    blocks.extend(bars.into_iter().map(|(_, chart)| Block::Bars(chart)));
    if let Some(law) = found.group(&CHIPS).map(|chips| chips.text(&LAW)).filter(|law| !law.is_empty()) {
        blocks.push(Block::Note(format!("Cutting force: {law}.")));
    }
    Some(PageSection::new(
        "chips",
        "Chips and blades",
        format!(
            "What the passes take from the slot behind tooth 1, in order of time. The whole ring has {} mm³ of the {} \
            mm³ of its blank left. {}",
            number(&LEFT_VOLUME),
            number(&BLANK_VOLUME),
            page_words(job)
        ),
        blocks,
    )
    .judged(Tone::Aside, headline_words(found, &[&IDLE_SHARE, &CYCLE_TIME])))
}

/// All target flanks, and what is between them as it was cut.
fn mesh(job: &BevelJob, whole: Option<&CutCells>) -> Result<ViewMesh> {
    let rows_mm = rows_z_mm(job.blank.face_width_mm, VIEW_ROW_MM);
    let flanks: Vec<(u32, Side)> = steps::flanks_of(job);
    let flanks = flanks
        .into_par_iter()
        .map(|(tooth, side)| ViewFlank::of_target(job, tooth, side, rows_mm.clone()))
        .collect::<Result<_>>()?;
    let body = whole.map(|whole| beside_flanks(job, whole, VIEW_COLUMN_MM)).transpose()?;
    Ok(ViewMesh { flanks, body: body.unwrap_or_default() })
}

/// The net of the flanks with the largest deviations, what is apart from their form, and lines along the tooth.
fn deviations(job: &BevelJob, gear: &BevelGear, found: &Findings) -> PageSection {
    let mut blocks = Vec::new();
    for side in [Side::Left, Side::Right] {
        let range = |flank: &BevelReport| {
            let values = flank.own.grid.iter().filter_map(|point| point.deviation_mm);
            values.map(f64::abs).fold(0.0, f64::max)
        };
        let flanks = gear.flanks.iter().filter(|flank| flank.side == side);
        let Some(worst) = flanks.max_by(|a, b| range(a).total_cmp(&range(b))) else { continue };
        let words = format!("Tooth {}, {} flank ({})", worst.tooth, side.name(), job.kind_of(side).flank());
        let title = format!("{words}: deviations over the grid, that of its middle taken away");
        blocks.extend(net::svg(worst, &title).map(|svg| Block::Drawing(title, svg)));
        blocks.push(Block::Lines(traces(worst, &words)));
    }
    blocks.insert(0, Block::Table(positions(found)));
    blocks.extend(found.group(&ERRORS).map(|errors| Block::Table(quantities::table(errors))));
    blocks.push(Block::Note(
        "Deviations along the target's normal, positive where material is left; dashed the target. All flanks with \
        points, normals and deviations are in tables/grid.csv."
            .to_owned(),
    ));
    PageSection::new(
        "deviations",
        "Deviations",
        "The finished gear against the surface that the last operation would leave with infinitely many blades, \
            on each side the flank with the largest deviation of the grid.",
        blocks,
    )
}

/// Thickness, spiral and pressure angle error, means of all teeth.
fn positions(found: &Findings) -> PageTable {
    let section = found.group(&POSITION);
    let entries = section.into_iter().flat_map(|section| &section.entries);
    let rows = entries.map(|entry| {
        let (value, unit) = value_and_unit(&entry.quantity);
        vec![entry.title.clone(), format!("{value} {unit}"), entry.quantity.definition().to_owned()]
    });
    PageTable {
        caption: "Apart from the form, means of all teeth".to_owned(),
        columns: ["Error", "Value", "Definition"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

fn traces(flank: &BevelReport, words: &str) -> LineChart {
    let panel = |name: &str, trace: &crate::measure::deviation::Trace| {
        let points = trace.places_mm.iter().zip(&trace.heights_mm).map(|(&x, &mm)| (x, mm * UM_PER_MM)).collect();
        Panel {
            value_name: name.to_owned(),
            unit: "µm".to_owned(),
            series: vec![LineSeries { name: name.to_owned(), points }],
            limits: Vec::new(),
            least_division: LEAST_DIVISION_UM,
        }
    };
    LineChart {
        title: format!("{words}: along the tooth, middle of the profile"),
        x_name: "v from the middle of the face, towards the heel".to_owned(),
        x_unit: "mm".to_owned(),
        panels: vec![panel("deviation", &flank.lead_trace)],
    }
}

fn slot(gear: &BevelGear, found: &Findings) -> PageSection {
    let series = |name: &str, value: &dyn Fn(&super::measure::SlotRow) -> Option<f64>| LineSeries {
        name: name.to_owned(),
        points: gear.slot.iter().filter_map(|row| Some((row.along_mm, value(row)?))).collect(),
    };
    let panel = |name: &str, series: Vec<LineSeries>| Panel {
        value_name: name.to_owned(),
        unit: "mm".to_owned(),
        series,
        limits: Vec::new(),
        least_division: 0.0,
    };
    let chart = LineChart {
        title: "Slot behind tooth 1".to_owned(),
        x_name: "v from the middle of the face, towards the heel".to_owned(),
        x_unit: "mm".to_owned(),
        panels: vec![
            panel("width on the pitch cone", vec![series("width", &|row| row.width_mm)]),
            panel(
                "depth",
                vec![series("as cut", &|row| row.depth_mm), series("of the blank", &|row| Some(row.whole_depth_mm))],
            ),
        ],
    };
    let drawn = !gear.slot.is_empty();
    PageSection::new(
        "slot",
        "Slot",
        "Width and depth along the face, as cut.",
        if drawn { vec![Block::Lines(chart)] } else { Vec::new() },
    )
    .judged(Tone::Aside, headline_words(found, &[&SLOT_DEPTH, &SLOT_WIDTH]))
}

fn blades(job: &BevelJob, found: &Findings) -> PageSection {
    let rows = found.group(&MARKS).into_iter().flat_map(|marks| &marks.sections).map(|side| {
        let number = |row: &QuantityRow| side.value(row).map_or_else(|| "–".to_owned(), |value| significant(value, 3));
        vec![
            side.title.clone(),
            side.text(&FLANK_BLADES).to_owned(),
            side.text(&FORM).to_owned(),
            number(&MARK_HEIGHT),
            number(&MARK_SPACING),
        ]
    });
    let marks = PageTable {
        caption: "Marks in the middle of the flank, closed form".to_owned(),
        columns: ["Flanks", "Blades", "Form", "Height [µm]", "Apart [mm]"].map(str::to_owned).into(),
        rows: rows.collect(),
    };
    let by_blade = found.group(&BLADES).and_then(|section| section.tables.first());
    let mut blocks = vec![Block::Table(marks)];
    blocks.extend(by_blade.map(|table| {
        Block::Table(PageTable {
            caption: "Share of all flanks that each blade has left last".to_owned(),
            columns: ["Blade", "Kind", "Runout [µm]", "Share [%]"].map(str::to_owned).into(),
            rows: table
                .rows()
                .map(|row| {
                    let number =
                        |cell: usize| row[cell].number().map_or_else(String::new, |value| significant(value, 3));
                    vec![row[0].name(), row[1].name(), number(2), number(3)]
                })
                .collect(),
        })
    }));
    let words = if job.finishing().settings.plunges() {
        "At full depth all blades of a kind sweep the same cone: between two of them no ridge stays."
    } else {
        "Blades of one kind follow each other while the cradle rolls; between two of them a ridge stays."
    };
    PageSection::new("blades", "Blades and their marks", words, blocks).judged(Tone::Aside, "marks by blade")
}

fn setup(job: &BevelJob, found: &Findings) -> PageSection {
    let settings = found.group(&SETTINGS);
    let rows = settings.map_or_else(Vec::new, |section| {
        let value = |entry: &findings::Entry| {
            let quantity = &entry.quantity;
            match (quantity.value(), quantity.words()) {
                (Some(value), _) => {
                    let unit = quantity.unit().map_or("", |unit| if unit == "1" { "" } else { unit });
                    format!("{} {unit}", significant(value, 7)).trim_end().replace('-', "−")
                }
                (None, words) => words.unwrap_or("–").to_owned(),
            }
        };
        section.entries.iter().map(|entry| (entry.title.as_str(), value(entry))).collect()
    });
    let blank = &job.blank;
    let deg = |rad: f64| format!("{:.4}°", rad.to_degrees());
    let gear = table(
        "Blank",
        vec![
            ("Teeth", blank.teeth.to_string()),
            (
                "Pitch, face, root angle",
                [blank.pitch_angle_rad, blank.face_angle_rad, blank.root_angle_rad].map(deg).join(", "),
            ),
            ("Outer cone distance", format!("{:.4} mm", blank.outer_cone_distance_mm)),
            ("Face width", format!("{} mm", plain(blank.face_width_mm))),
            (
                "Outer addendum, dedendum",
                format!("{} mm, {} mm", plain(blank.outer_addendum_mm), plain(blank.outer_dedendum_mm)),
            ),
        ],
    );
    let blocks = vec![
        Block::Drawing("Settings of the cradle machine, to scale".to_owned(), drawing::svg(&Drawn::of(job))),
        gear,
        table("Settings", rows),
    ];
    PageSection::new("setup", "What was cut, and how", "", blocks).judged(Tone::Aside, "blank, settings")
}
