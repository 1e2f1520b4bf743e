//! `gearcut export`: sections, points and programs of a gear, and its tool, for other people's programs.

use std::path::Path;

use crate::backend::Choice;
use crate::export::drawing::Drawing;
use crate::export::dxf::dxf;
use crate::export::flank_faces::FlankFaces;
use crate::export::points::{self, PointsWish};
use crate::export::qif;
use crate::export::section::{GearSection, ProfileSource, SectionCurve, SectionWish, profile_mm};
use crate::export::solid::GearSolid;
use crate::export::step::{self, StepFile, StepWords};
use crate::export::unit::FileUnit;
use crate::export::wire::{WireProgram, WireWish};
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::number_text::{plain, significant};
use crate::output::atomic::write_bytes_atomically;
use crate::output::text::Sheet;
use crate::pair_job::watch::Watch;
use crate::process;
use crate::scene::Scene;
use gearcut_core::units::UM_PER_MM;
use gearcut_core::{Refusal, Result};

use super::args::{ExportArguments, LengthUnitChoice};
use super::failure::Failure;
use super::{backend, folder, print};

/// Tolerances that are taken, um: below the first the dexels of a cut gear and the tables of tools are the coarser
/// ones, above the last no gear is recognised.
const TOLERANCES_UM: [f64; 2] = [0.01, 1000.0];

/// Runs the command.
pub fn run(arguments: &ExportArguments) -> Result<(), Failure> {
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let wish = wish(arguments, &loaded.scene)?;
    let wire = wire_wish(arguments, &wish)?;
    let mut named: Vec<&Path> = Vec::new();
    for (option, path, ending) in [
        ("--dxf", &arguments.dxf, "dxf"),
        ("--tool-dxf", &arguments.tool_dxf, "dxf"),
        ("--step", &arguments.step, "step"),
        ("--points", &arguments.points, "csv"),
        ("--qif", &arguments.qif, "qif"),
        ("--wire", &arguments.wire, "ngc"),
    ] {
        let Some(path) = path else { continue };
        ends_with(option, path, ending)?;
        if named.contains(&path.as_path()) {
            let problem = format!("{} is the file of another option, too", path.display());
            return Err(Refusal::new(option, problem, "give each its own name").into());
        }
        if !arguments.force && path.exists() {
            let way_out = "choose another name, or let it be replaced with --force";
            return Err(Refusal::new(option, format!("{} exists", path.display()), way_out).into());
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir());
        if let Some(folder) = folder {
            let problem = format!("there is no folder {}", folder.display());
            return Err(Refusal::new(option, problem, "make it, or choose another place").into());
        }
        named.push(path);
    }
    let (choice, progress) = backend::of_few_places(&arguments.compute, false, &loaded.scene)?;
    let interrupt = Interrupt::listen().map_err(folder::listening(&arguments.scene.scene))?;
    let watch = Watch::new(&progress, &interrupt);
    let mut exporter = Exporter { arguments, wish, wire, watch, choice, sheet: Sheet::default() };
    let done = process::prepare(&loaded.scene).and_then(|job| job.with_gear(&mut |gear| exporter.export(gear)));
    done.map_err(|error| Failure::of_scene(&loaded, error))?;
    Ok(print::sheet(&exporter.sheet.into_text())?)
}

/// Writes the files one after the other and says what is in them.
struct Exporter<'a> {
    arguments: &'a ExportArguments,
    wish: SectionWish,
    wire: WireWish,
    watch: Watch<'a>,
    choice: Choice,
    sheet: Sheet,
}

impl Exporter<'_> {
    fn export(&mut self, gear: &dyn GearJob) -> Result<()> {
        let arguments = self.arguments;
        let cylinder = gear.cylindrical();
        let wants_cylinder = [&arguments.dxf, &arguments.tool_dxf, &arguments.wire].into_iter().any(Option::is_some);
        if wants_cylinder && cylinder.is_none() {
            let way_out = "export a shaped or hobbed gear; of a bevel gear there are --step, --points, --qif, and \
                           mesh/ of `gearcut cut`";
            return Err(Refusal::new("gear", "a bevel gear has no transverse section", way_out).into());
        }
        if arguments.points.is_some() || arguments.qif.is_some() {
            self.points(gear)?;
        }
        if let Some(path) = &arguments.step {
            self.step(gear, path)?;
        }
        let Some(gear) = cylinder.filter(|_| wants_cylinder) else { return Ok(()) };
        if let Some(path) = &arguments.tool_dxf {
            self.drawing(path, &Drawing::of_tool(gear, self.wish.tolerance_mm), "")?;
        }
        if arguments.dxf.is_none() && arguments.wire.is_none() {
            return Ok(());
        }
        let teeth = self.teeth(gear);
        let stage = self.watch.stage("profile", (teeth[1] + 1 - teeth[0]) as usize, "teeth")?;
        let chain_mm = profile_mm(gear, self.choice.backend.as_ref(), &self.wish, &stage)?;
        stage.finish();
        if let Some(path) = &arguments.dxf {
            let section = GearSection::new(gear, &chain_mm, &self.wish);
            let more = format!("; a polyline within the same has {} lines", section.polyline_count);
            self.drawing(path, &Drawing::of_gear(gear, &section, &self.wish), &more)?;
        }
        if let Some(path) = &arguments.wire {
            let program = WireProgram::new(gear, &chain_mm, &self.wire)?;
            self.watch.check()?;
            write_bytes_atomically(path, program.text.as_bytes())?;
            let [least_um, most_um] = program.off_mm.map(|mm| significant(mm * UM_PER_MM, 2));
            let [arcs, lines] = [program.path.count() - program.path.lines(), program.path.lines()];
            self.sheet.heading(&path.display().to_string());
            self.sheet.line("path of the wire", format!("{arcs} arcs and {lines} lines"));
            self.sheet.line("read back, off the profile", format!("{least_um} to {most_um} um"));
            if let Some(dwell_mm) = program.dwell_mm {
                let words = format!("{} um, as the wire is round", significant(dwell_mm * UM_PER_MM, 2));
                self.sheet.line("left in the dwell's corners", words);
            }
        }
        Ok(())
    }

    /// First and last tooth.
    fn teeth(&self, gear: &(impl GearJob + ?Sized)) -> [u32; 2] {
        self.wish.teeth.unwrap_or([1, gear.scene().gear.teeth])
    }

    /// The same points as a table and as a QIF document.
    fn points(&mut self, gear: &dyn GearJob) -> Result<()> {
        let (arguments, unit) = (self.arguments, unit(self.arguments));
        let wish = PointsWish { source: self.wish.source, teeth: self.teeth(gear), grid: arguments.grid.0 };
        if arguments.qif.is_some() {
            qif::refuse_many(wish.points())?;
        }
        let stage = self.watch.stage("points", wish.flanks(), "flanks")?;
        let flanks = points::flank_points(gear, self.choice.backend.as_ref(), &wish, &stage)?;
        stage.finish();
        let [profile, lead] = wish.grid;
        let words = format!("{} on {} flanks, {profile} x {lead} each", wish.points(), wish.flanks());
        if let Some(path) = &arguments.points {
            write_bytes_atomically(path, points::csv(&flanks, unit).as_bytes())?;
            self.sheet.heading(&path.display().to_string());
            self.sheet.line("points", words.clone());
        }
        if let Some(path) = &arguments.qif {
            let text = qif::qif(gear, &flanks, wish.grid, unit);
            write_bytes_atomically(path, text.as_bytes())?;
            self.sheet.heading(&path.display().to_string());
            self.sheet.line("points", format!("{words}, {} kB", text.len().div_ceil(1000)));
        }
        Ok(())
    }

    /// The solid of a cylindrical gear, the flanks of another one.
    fn step(&mut self, gear: &dyn GearJob, path: &Path) -> Result<()> {
        let (wish, words) = (&self.wish, StepWords::new(gear, &self.wish));
        let backend = self.choice.backend.as_ref();
        let (what, of, file, off_mm) = if let Some(gear) = gear.cylindrical() {
            let solid = GearSolid::new(gear, backend, wish, &self.watch)?;
            let of = if solid.roots_mm.is_some() { "flanks and tips" } else { "profile" };
            ("solid", of, step::solid::step(&solid, &words), [Some(solid.off_mm), solid.roots_mm])
        } else {
            let flanks = FlankFaces::new(gear, backend, wish, &self.watch)?;
            ("flanks", "flanks", step::flanks::step(&flanks, &words), [Some(flanks.off_mm), None])
        };
        let StepFile { text, faces } = file;
        self.watch.check()?;
        write_bytes_atomically(path, text.as_bytes())?;
        self.sheet.heading(&path.display().to_string());
        self.sheet.line(what, format!("{faces} faces, {} kB", text.len().div_ceil(1000)));
        for (of, off_mm) in [of, "roots"].into_iter().zip(off_mm.into_iter().flatten()) {
            self.sheet.line(&format!("off the {of}"), format!("{} um at most", significant(off_mm * UM_PER_MM, 2)));
        }
        Ok(())
    }

    fn drawing(&mut self, path: &Path, drawing: &Drawing, more: &str) -> Result<()> {
        self.watch.check()?;
        write_bytes_atomically(path, dxf(drawing, unit(self.arguments)).as_bytes())?;
        describe(&mut self.sheet, path, drawing, more);
        Ok(())
    }
}

fn unit(arguments: &ExportArguments) -> FileUnit {
    match arguments.units {
        LengthUnitChoice::Mm => FileUnit::Millimetre,
        LengthUnitChoice::Inch => FileUnit::Inch,
    }
}

/// The narrowest spark gap, um: a length in mm in its place is found by it.
const LEAST_GAP_UM: f64 = 1.0;

/// The wire; programs and solids are in mm.
fn wire_wish(arguments: &ExportArguments, section: &SectionWish) -> Result<WireWish, Refusal> {
    for (path, what) in [(&arguments.wire, "programs of wire erosion"), (&arguments.step, "STEP files")] {
        if path.is_some() && arguments.units == LengthUnitChoice::Inch {
            let way_out = "leave --units out, or write the files in inches with a command of their own";
            return Err(Refusal::new("--units", format!("{what} are in mm"), way_out));
        }
    }
    for (option, value, [least, most]) in [
        ("--wire-diameter-um", arguments.wire_diameter_um, [10.0, 1000.0]),
        ("--gap-um", arguments.gap_um, [0.0, 500.0]),
        ("--lead-mm", arguments.lead_mm, [0.1, 1000.0]),
        ("--feed-mm-per-min", arguments.feed_mm_per_min, [1e-3, 1e3]),
    ] {
        if !(least..=most).contains(&value) {
            let problem = format!("{value} is not {least} to {most}");
            return Err(Refusal::new(option, problem, "give a value in this range"));
        }
    }
    if arguments.gap_um > 0.0 && arguments.gap_um < LEAST_GAP_UM {
        let problem = format!("{} um is no spark gap; one of millimetres?", arguments.gap_um);
        let mm_meant = plain(arguments.gap_um * UM_PER_MM);
        return Err(Refusal::new("--gap-um", problem, format!("give --gap-um {mm_meant} for that, or 0 for none")));
    }
    Ok(WireWish {
        wire_mm: arguments.wire_diameter_um / UM_PER_MM,
        gap_mm: arguments.gap_um / UM_PER_MM,
        lead_mm: arguments.lead_mm,
        feed_mm_per_min: arguments.feed_mm_per_min,
        tolerance_mm: section.tolerance_mm,
    })
}

/// What is asked of the section.
fn wish(arguments: &ExportArguments, scene: &Scene) -> Result<SectionWish, Refusal> {
    let [least, most] = TOLERANCES_UM;
    let um = arguments.tolerance_um;
    if !(least..=most).contains(&um) {
        let problem = format!("{um} um is not {least} to {most} um");
        return Err(Refusal::new("--tolerance-um", problem, "1 um suits wire erosion and grinding, 10 um a laser"));
    }
    let half_mm = 0.5 * scene.gear.face_width_mm;
    if !(-half_mm..=half_mm).contains(&arguments.section_mm) {
        let problem = format!("{} mm lies outside of the face, which ends at {half_mm} mm", arguments.section_mm);
        return Err(Refusal::new("--section-mm", problem, "give a place along the tooth from the middle of the face"));
    }
    let count = scene.gear.teeth;
    let teeth = arguments.teeth.map(|range| range.0);
    if let Some([_, last]) = teeth.filter(|&[_, last]| last > count) {
        let problem = format!("there is no tooth {last}: the gear has {count}");
        return Err(Refusal::new("--teeth", problem, "leave it out for the whole gear"));
    }
    let source = if arguments.as_cut { ProfileSource::Cut } else { ProfileSource::Target };
    Ok(SectionWish { source, teeth, z_mm: arguments.section_mm, tolerance_mm: um / UM_PER_MM })
}

/// With `--force` files are replaced, scenes among them: the name must say that it is an export.
fn ends_with(option: &str, path: &Path, ending: &str) -> Result<(), Refusal> {
    if path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending)) {
        return Ok(());
    }
    let problem = format!("{} does not end with .{ending}", path.display());
    Err(Refusal::new(option, problem, format!("name the file {}", path.with_extension(ending).display())))
}

fn describe(sheet: &mut Sheet, path: &Path, drawing: &Drawing, more: &str) {
    sheet.heading(&path.display().to_string());
    for (i, layer) in drawing.layers.iter().enumerate() {
        let what = match &layer.curve {
            SectionCurve::Circle(radius_mm) => format!("circle of {} mm diameter", plain(2.0 * radius_mm)),
            SectionCurve::Path(path) => {
                let [arcs, lines] = [path.count() - path.lines(), path.lines()];
                let end = if path.is_closed { "closed" } else { "open" };
                format!("{arcs} arcs and {lines} lines, {end}{}", if i == 0 { more } else { "" })
            }
        };
        sheet.line(layer.name, what);
    }
}
