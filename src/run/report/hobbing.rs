//! The page of a hobbed gear: the same sections as a shaped one's, and what hobbing adds: marks, five curves, six axes, the work of the hob's teeth.

use super::deviations::{self, Inspected, Inspection};
use super::{RunWords, facts, key_number, known_first, maps, record, texture, with_signs};
use crate::axes_report::HobbingAxesReport;
use crate::error::Result;
use crate::job::{HobCutter, HobbingJob};
use crate::linkage::hobbing::marks::MarkStep;
use crate::measure::hob_load::OperationLoad;
use crate::measure::marks::{MarkLattice, between_rad};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, Section, Table};
use crate::output::results::TextureResults;
use crate::output::text::{plain, significant};
use crate::run::hobbing::{HobbedGear, headline, load, points, warnings};
use std::f64::consts::PI;

/// The page of a run.
///
/// # Errors
/// No flank is generated on some tooth; a picture of the folder cannot be read back.
pub fn page(
    cutter: &HobCutter,
    gear: &HobbedGear,
    textures: &[TextureResults],
    lattices: &[MarkLattice],
    loads: &[OperationLoad],
    run: &RunWords,
    folder: &OutputFolder,
) -> Result<Page> {
    let job = cutter.job;
    let axes = HobbingAxesReport::of_job(job);
    let mut all_warnings = warnings(job, gear);
    all_warnings.extend(axes.iter().flat_map(HobbingAxesReport::warnings));
    let inspection = inspection(cutter, gear);
    let mut sections = vec![deviations::section(&inspection)];
    sections.extend(five_curves(&job.scene.name, gear));
    sections.push(marks_section(lattices));
    sections.extend(texture::section(textures, folder)?);
    sections.extend(load_section(job, loads));
    sections.push(motion(cutter, &axes));
    sections.push(facts::hobbing_section(job));
    sections.push(record(gear.flanks.len(), &gear.work.stats, gear.work.dexels, run));
    let numbers: Vec<_> = headline(job, gear)
        .iter()
        .map(|(key, quantity)| {
            let name = key.replace('_', " ");
            let mut letters = name.chars();
            let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
            key_number(&(first + letters.as_str()), quantity)
        })
        .collect();
    Ok(Page {
        title: job.scene.name.clone(),
        subtitle: facts::gear_words(&job.scene.gear),
        operations: job
            .operations
            .iter()
            .zip(&axes)
            .map(|(operation, axes)| {
                format!(
                    "{}: {}, hob held back by {} mm, {} mm axial feed per revolution",
                    operation.spec.name,
                    axes.words(),
                    plain(operation.offset_mm),
                    plain(operation.spec.axial_feed_mm_per_revolution)
                )
            })
            .collect(),
        complete: !gear.work.interrupted,
        program: format!("gearcut {}", env!("CARGO_PKG_VERSION")),
        key_numbers: known_first(numbers),
        warnings: with_signs(&all_warnings),
        viewer: Some(maps::viewer(cutter, &gear.maps)?),
        sections,
    })
}

fn inspection<'a>(cutter: &HobCutter, gear: &'a HobbedGear) -> Inspection<'a> {
    let standard_mm = 0.5 * PI * cutter.job.scene.gear.transverse_module_mm();
    let flanks = gear.flanks.iter().map(|flank| Inspected {
        tooth: flank.tooth,
        side: flank.side,
        profile: (&flank.profile_trace, flank.profile),
        profile_middle_mm: 0.5 * flank.length_mm,
        lead: (&flank.helix_trace, flank.helix),
    });
    Inspection {
        flanks: flanks.collect(),
        pitch: &gear.pitch,
        runout: gear.runout.as_ref(),
        thickness_mm: gear.thickness.iter().map(|t| t.map(|t| t.arc_mm - standard_mm)).collect(),
        profile_place: "roll from the pitch point, up to the tip",
        lead_place: "in the middle of the profile",
        lead_name: "Helix",
        target: "the surface that the last operation would leave with infinitely many gashes and an infinitely fine feed",
    }
}

fn five_curves(scene: &str, gear: &HobbedGear) -> Option<Section> {
    Some(Section {
        id: "curves",
        title: "Points on five curves".to_owned(),
        lead: "Where five curves beside the pitch curve cross every flank in the middle of the face, as cut less as meant, as Liu et al. (2015) measured their gear. Every point stands in tables/offset_curves.csv.".to_owned(),
        blocks: vec![Block::Lines(points::chart(scene, gear)?)],
    })
}

fn marks_section(lattices: &[MarkLattice]) -> Section {
    let step = |step: &MarkStep| {
        // Rounded first, so that no zero bears a sign.
        let degrees = |rad: f64| format!("{:.2}", (rad.to_degrees() * 100.0).round() / 100.0 + 0.0).replace('-', "−");
        [format!("{:.3}", step.length_mm()), degrees(step.to_trace_rad()), degrees(step.to_axis_rad)]
    };
    let rows = lattices.iter().flat_map(|lattice| {
        (0..2).map(move |i| {
            let known = &lattice.kinematic[i];
            let seen = lattice.surface.as_ref().ok().map(|steps| steps[i]);
            let none = || ["–"; 3].map(str::to_owned);
            let apart = seen.map_or_else(
                || ["–"; 2].map(str::to_owned),
                |seen| {
                    let length = (seen.length_mm() - known.length_mm()).abs();
                    let angle = between_rad(seen.to_trace_rad(), known.to_trace_rad()).to_degrees();
                    [significant(length, 2), significant(angle, 2)]
                },
            );
            let mut row = vec![format!("tooth {} {}, step {}", lattice.tooth, lattice.side.name(), i + 1)];
            row.extend(step(known));
            row.extend(seen.as_ref().map_or_else(none, step));
            row.extend(apart);
            row
        })
    });
    let columns = [
        "Flank",
        "Kinematics [mm]",
        "to the trace [°]",
        "to the axis [°]",
        "Surface [mm]",
        "to the trace [°]",
        "to the axis [°]",
        "Apart [mm]",
        "Apart [°]",
    ];
    Section {
        id: "marks",
        title: "Cutting marks".to_owned(),
        lead: "The shortest two steps from mark to mark on the flank at the pitch line: from the machine's motion, and independently from the autocorrelation of the heights as cut.".to_owned(),
        blocks: vec![Block::Table(Table {
            caption: "Lattice of cutting marks".to_owned(),
            columns: columns.map(str::to_owned).into(),
            rows: rows.collect(),
        })],
    }
}

/// Nothing where the run was stopped before the whole blank was cut.
fn load_section(job: &HobbingJob, loads: &[OperationLoad]) -> Option<Section> {
    let charts = load::charts(job, loads);
    (!charts.is_empty()).then(|| Section {
        id: "load",
        title: "Work of the hob's teeth".to_owned(),
        lead: format!(
            "What each tooth of the hob does in the whole process, approach and overrun included. The load is the {}.",
            load::ASSUMPTION
        ),
        blocks: charts.into_iter().map(|(_, chart)| Block::Bars(chart)).collect(),
    })
}

fn motion(cutter: &HobCutter, axes: &[HobbingAxesReport]) -> Section {
    let mut blocks = Vec::new();
    for report in axes {
        blocks.push(Block::Heading(format!("{}: {}", report.name(), report.words())));
        let signs = |text: String| text.replace("deg/s^2", "°/s²").replace("deg/s", "°/s").replace("mm/s^2", "mm/s²");
        let mut rows = report.peak_rows().into_iter().map(|row| row.into_iter().map(signs).collect());
        let columns = rows.next().unwrap_or_default();
        blocks.push(Block::Table(Table { caption: "Peaks of the axes".to_owned(), columns, rows: rows.collect() }));
        let mut charts = report.charts(cutter.job).into_iter().map(|(_, chart)| Block::Lines(chart));
        blocks.extend(charts.next());
        blocks.push(Block::Folded("Accelerations, feed path".to_owned(), charts.collect()));
        blocks.extend(report.work_of_teeth(cutter.job).map(Block::Bars));
    }
    Section {
        id: "motion",
        title: "Axis motion".to_owned(),
        lead: "How the linkage moves the machine over one cycle along the pitch curve, and what it asks of the axes."
            .to_owned(),
        blocks,
    }
}
