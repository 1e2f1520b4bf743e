//! What can be typed, and the help that teaches it: one example per command, what it writes, in which units.

mod errors;
mod export;
mod pairs;
mod parsed;
mod reading;
mod shared;
mod studies;
mod texture;

use std::path::PathBuf;

use crate::process::PROCESSES;
use crate::steps::parts::Parts;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};

pub use errors::{
    BudgetArguments, CalibrateArguments, DeviationsArguments, DiagnoseArguments, FitChoice, FlankSide, ScatterArguments,
};
pub use export::{ExportArguments, LengthUnitChoice};
pub use pairs::{ContactArguments, FlankChoice, PairArguments};
pub use parsed::parsed;
pub use reading::{AxisChoice, ReadingArguments};
pub use shared::{BackendChoice, ComputeArguments, GpuFailureChoice, RunArguments, SceneArguments, VerdictArguments};
pub use studies::{CasesArguments, StudyArguments, SweepArguments};
pub use texture::{FilterArguments, LineArguments, LineFormChoice, ProfileChoice, TextureArguments};

/// The whole command line.
#[derive(Debug, Parser)]
#[command(
    name = "gearcut",
    version,
    about = "Cuts gears, non-circular ones above all, on this computer before anyone cuts them in steel, and measures \
        their flanks.",
    after_help = "First steps:\n  \
        gearcut new shaping --out my_gear.toml               a commented scene\n  \
        gearcut check scenes/shaping/circular_m3_z24.toml    what it means\n  \
        gearcut cut scenes/shaping/circular_m3_z24.toml      cut and measure it\n\n\
        Exit codes: 0 done; 1 refused or failed, with the reason; 2 wrong usage; 3 done and written, but the verdict \
        is bad (a fault; pair: a tip cuts into the mate); 130 stopped by Ctrl-C."
)]
pub struct CommandLine {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Cut a scene and measure the gear.
    #[command(after_help = "Example:\n  \
        gearcut cut scenes/shaping/elliptical_normal.toml \\\n      \
        --set operation.rough.offset_mm=1.5\n  \
        gearcut cut scenes/shaping/elliptical_normal.toml --draft\n  \
        gearcut cut scenes/shaping/elliptical_normal.toml --only numbers,report\n\n\
        Writes a folder (out/<scene> unless --out or the scene says otherwise): results.json with every \
        number, its unit and its definition; run.json to repeat the run; tables as CSV (mm, um, deg in \
        the column names); maps of every flank as EXR (mm) and PNG (um); the gear as a closed mesh in STL, \
        PLY and glTF (mm); pictures; axis tables and charts. An existing folder is replaced only if \
        gearcut wrote it, and only after the new one is complete. The summary goes to standard output, \
        progress to standard error.")]
    Cut(CutArguments),
    /// Show what a scene means: pitch curve, teeth, axes, relief, warnings, cost. Cuts nothing.
    #[command(after_help = "Example:\n  \
        gearcut check scenes/shaping/elliptical_normal.toml --set gear.teeth=45\n\n\
        Prints lengths in mm or um, angles in deg, speeds in deg/s and mm/s; writes no files.")]
    Check(CheckArguments),
    /// Write the axis positions of every stroke, with charts.
    #[command(after_help = "Example:\n  \
        gearcut axes scenes/shaping/elliptical_normal.toml --out out/axes_of_my_gear\n\n\
        Writes a folder (out/<scene>_axes unless --out is given): axes/<operation>.csv with one row per \
        stroke (s, deg, mm, deg/s, mm/s, deg/s^2, mm/s^2), <operation>.ngc (G-code in straight lines, \
        or for a control by output.post, see docs/gcode.md), and charts of positions, velocities, \
        accelerations and relief clearance over the work angle as SVG. Prints the peaks against the \
        machine's limits.")]
    Axes(AxesArguments),
    /// Put results side by side.
    #[command(after_help = "Example:\n  \
        gearcut compare out/elliptical_traditional out/elliptical_normal\n  \
        gearcut compare out/third_order_plain out/third_order_diagonal \\\n      \
        --out out/load_of_the_hob\n\n\
        Takes 2 to 7 results; the others are compared with the first, those of another process in the numbers that \
        both have. Writes a folder \
        (compare_<A>_<B>... beside the last one unless --out is given): comparison.csv with every number \
        of all results under its path in results.json, with unit and definition, its difference to the \
        first and its ratio to the first (2 means twice as much); and bar charts as SVG. \
        Shaped gears: unevenness of the allowance by tooth (%), in one chart (first period of the pitch \
        curve, and all teeth) and each on its own scale.\n\
        Hobbed gears: what each tooth of the hob does over the whole process: volume (mm^3), largest \
        uncut chip thickness (mm), travel in the cut (mm).\n\
        Load is no life: wear follows heat and chip thickness besides. Prints what changed most; with --all \
        headline and summary.")]
    Compare(CompareArguments),
    /// Evaluate the texture of a surface, measured or cut: ISO 25178-2 and ISO 21920-2 parameters.
    #[command(after_help = "Example:\n  \
        gearcut texture out/elliptical_normal/texture/finish/tooth_03_left.x3p\n  \
        gearcut texture measured.sdf --form plane --s-filter-um 8 --l-filter-um 800 \\\n      \
        --crop-um 400\n  \
        gearcut texture heights.npy --spacing-um 2 5 --line y=500 --json\n  \
        gearcut texture measured.sur --save measured.x3p\n\n\
        Reads X3P, SDF, SUR, GWY, text, NPY and gearcut's EXR maps, surfaces and profiles; heights become um \
        whatever the file counts in. What text does not say of its units and spacing is given with \
        --height-unit, --spacing-unit and --spacing-um; nothing is guessed. NPY is in um unless the file beside it \
        or --height-unit says otherwise. \
        The chain is applied in this order and printed beside the numbers: form, S-filter, L-filter, \
        crop. Holes are left out where a parameter allows it. A value that does not exist is printed as \
        none with the reason (null in JSON).\n\
        Angles count counter-clockwise from +x (along a row) towards +y (from row to row). Writes no \
        files but those named by --save.")]
    Texture(Box<TextureArguments>),
    /// List what can compute here.
    #[command(after_help = "Example:\n  gearcut devices\n  gearcut devices --bench")]
    Devices(DevicesArguments),
    /// Print the JSON Schema of scene files, for editors that complete and check TOML.
    #[command(after_help = "Example:\n  gearcut schema > scene.schema.json")]
    Schema,
    /// Write a commented scene to start from.
    #[command(after_help = "Example:\n  gearcut new shaping --out my_gear.toml\n\n\
        The scene has every key with its unit, its range and its default. An existing file is never replaced.")]
    New(NewArguments),
    /// Write the scene of the gear that runs with a scene's gear.
    #[command(after_help = "Example:\n  \
        gearcut mate scenes/shaping/internal_pair_driver.toml --teeth 102 \\\n      \
        --internal --out ring.toml\n  \
        gearcut mate scenes/shaping/elliptical_normal.toml --teeth 28 --out mate.toml\n\n\
        The mate's pitch curve follows from the driver's: equal arcs on both, r2 = a - r1 outside and a + r1 in a \
        ring; the distance of the axes a (mm) is solved so that the curve closes. Tool, machine and operations \
        are the driver's. Prints the scene, or writes it with --out and prints a; an existing file is never \
        replaced.")]
    Mate(MateArguments),
    /// Write a gear for other programs: its section as DXF, a STEP solid, wire erosion, points as CSV or QIF; its tool.
    #[command(after_help = "Example:\n  \
        gearcut export scenes/shaping/elliptical_normal.toml --dxf gear.dxf\n  \
        gearcut export scenes/shaping/elliptical_normal.toml --dxf tooth.dxf \\\n      \
        --teeth 3..4 --as-cut\n  \
        gearcut export scenes/hobbing/circular_spur.toml --tool-dxf hob.dxf \\\n      \
        --tolerance-um 0.5\n  \
        gearcut export scenes/shaping/elliptical_normal.toml --step gear.step\n  \
        gearcut export scenes/shaping/circular_m3_z24.toml --wire gear.ngc \\\n      \
        --wire-diameter-um 200\n  \
        gearcut export scenes/hobbing/circular_helical.toml --points nominal.csv \\\n      \
        --teeth 1..4 --grid 9x5\n  \
        gearcut export scenes/hobbing/circular_helical.toml --qif cut.qif \\\n      \
        --teeth 1..4 --as-cut\n\n\
        The section of a cylindrical gear, external or a ring, round or not: the profile with its fillets as one \
        closed polyline of arcs and lines, the pitch curve, the stock, bore or rim, each on a layer of its name. The \
        target is the tool's envelope under continuous motion; as cut has every mark. Corners stay corners. Lengths \
        in mm or inch, as the file says; programs and solids in mm.\n\n\
        A STEP file is the whole gear as one closed solid of smooth faces: flanks, fillets, tip lands, ends, bore or \
        rim; spur and helical. As cut it is the section with its marks, swept straight.\n\n\
        A program of wire erosion is read back and judged before it is written; a profile that the wire cannot follow \
        is refused. Points are tooth, flank, u and v (arc along the profile from the form point, place along the \
        tooth), x y z and normal, as cut with the deviation in um; a QIF document has the same points as features and, \
        as cut, as results. See docs/exchange.md.")]
    Export(ExportArguments),
    /// Roll two gears on each other without load: ratio, transmission error, backlash, contact, interference.
    #[command(after_help = "Example:\n  \
        gearcut pair scenes/shaping/elliptical_normal.toml --mate 42\n  \
        gearcut pair scenes/shaping/internal_pair_driver.toml \\\n      \
        scenes/shaping/internal_pair_ring.toml\n  \
        gearcut pair scenes/shaping/circular_m3_z24.toml --mate 36 --flanks nominal \\\n      \
        --center-distance-error-um 20\n  \
        gearcut pair out/elliptical_normal out/my_mate --eccentricity-b-um 15 \\\n      \
        --parallelism-in-plane-um 10\n\n\
        A drives, B is driven. Each is a scene or a folder of results; --mate solves B from A. The gears must belong \
        together: one module, pitch curves that close on each other (0.1 module is allowed between them). \
        Their flanks are cut in the sections that are rolled, with every stroke; --flanks nominal takes targets \
        without strokes and fillets. A ring is always gear B.\n\n\
        Transmission error is B's rotation less that of the pitch curves (arcsec), and times r2 (um). \
        Right flanks drive when the angle of A grows; left ones are the back flanks.\n\n\
        Writes a folder (out/<A>_with_<B> unless --out is given): results.json, tables/rolling.csv with a row for \
        every position, tables/contact_by_tooth.csv, harmonics, double-flank rolling. See docs/pair.md.")]
    Pair(PairArguments),
    /// Bring a bevel gear and its pinion into contact without load: motion error, contact path and ellipses.
    #[command(after_help = "Example:\n  \
        gearcut contact scenes/bevel/five_linkage_corrected.toml \\\n      \
        scenes/bevel/five_linkage_pinion.toml \\\n      \
        scenes/bevel/five_linkage_pinion_concave.toml\n  \
        gearcut contact scenes/bevel/crown_gear.toml scenes/bevel/crown_pinion.toml \\\n      \
        --e-um 50 --g-um -30\n\n\
        The flanks that the heads' cones generate touch; marks of blades are left out. Gear and pinion have a \
        face-mill head, one module and opposite hands of spiral; the shaft angle is the sum of their pitch angles. A \
        pinion that is finished side by side has two scenes: the second one cuts its concave flanks.\n\n\
        Errors of the mounting have Gleason's letters: E offset of the pinion's axis, P pinion and G gear away from \
        the apex, Sigma shaft angle. Beside the mounting of the command, 50 um and 0.05 deg of each are tried in both \
        directions: how far the contact moves, and what the motion error becomes.\n\n\
        Writes a folder (out/<GEAR>_with_<PINION> unless --out is given): report.html, results.json, \
        tables/contact_*.csv, tables/trends_*.csv, pictures/motion_error.svg, pictures/bearing_*.svg. \
        See docs/bevel.md.")]
    Contact(ContactArguments),
    /// Cut many gears of a scene with errors: how their numbers scatter, and which layer of errors makes how much.
    #[command(after_help = "Example:\n  \
        gearcut scatter scenes/shaping/noise.toml\n  \
        gearcut scatter scenes/shaping/noise.toml --tooth 3 --side right --seeds 50 \\\n      \
        --out out/noise\n  \
        gearcut scatter scenes/shaping/noise.toml \\\n      \
        --tolerance mounting.eccentricity_um=0..10\n\n\
        Layers of errors are axes, guide, mounting, tool, noise, stock, edge, ploughing, tearing and deflection, as \
        far as the scene has them. One flank is cut with none of them, with each alone, with all, and with all but \
        each; then as many gears as there are seeds (machine.errors.seed = 1, 2, ...), the cutter being the same. \
        Keys that are given a tolerance have another value in each of these gears, anywhere between the limits.\n\n\
        Texture is that of a window of 0.25 mm in the middle of the flank, profile and helix are lines through it; \
        pitch is taken on all teeth from the mean deviation over 0.25 mm of profile there. Heights in um.\n\n\
        Writes a folder (out/<scene>_scatter unless --out is given): layers.csv, seeds.csv with a row for every gear, \
        scatter.csv with median, 5 % and 95 % of each number. A row is written as soon as its gear is done: after a \
        kill or Ctrl-C the same command goes on. See docs/errors.md.")]
    Scatter(ScatterArguments),
    /// Make many scenes that differ in a few keys, one row of quantities each.
    #[command(after_help = "Example:\n  \
        gearcut study studies/finishing_feed.toml\n  \
        gearcut study studies/axes_of_ovals.toml --shard 2/8\n\n\
        Writes a folder (out/<study>_study unless --out is given) that grows while it runs: rows.csv with a row for \
        every case, its parameters and the quantities that the study keeps, units in the heads; columns.csv with \
        unit and definition of every column. A case that cannot be made is a row with the reason. After Ctrl-C or a \
        kill the same command goes on with the cases that are missing. Shares of the cases go to folders of their own; \
        their rows together are those of the whole. The file: docs/studies.md.")]
    Study(StudyArguments),
    /// Make a scene with many values of some keys, one row of quantities each: a study without a file.
    #[command(after_help = "Example:\n  \
        gearcut sweep scenes/shaping/circular_m3_z24.toml \\\n      \
        --draft --grid tool.shaper_cutter.teeth=20,26,34 \\\n      \
        --range 'operation.finish.strokes_per_revolution=600..4800/4 log' --keep scallop_height,F_alpha\n\n\
        Writes what `gearcut study` writes, to out/<scene>_study. Of several keys every combination is a case; those \
        of --grid come first, and the last one changes fastest.")]
    Sweep(SweepArguments),
    /// Rank the errors of the machine: which micrometre or arc second costs what on the gear.
    #[command(after_help = "Example:\n  \
        gearcut budget scenes/shaping/circular_m3_z24.toml\n  \
        gearcut budget scenes/shaping/machine_errors.toml \\\n      \
        --parameters mounting,machine.errors.work\n  \
        gearcut budget scenes/hobbing/circular_spur.toml --flanks 1-left,1-right\n\n\
        Shifts every error that the scene's process knows by a natural step to both sides, cuts the gear on few \
        places, and takes the differences: what the error alone makes of an otherwise ideal gear, in um. Half the \
        step tells whether twice the error does twice as much. Shaped gears take seconds, hobbed ones many minutes, \
        or seconds with one tooth in --flanks; Ctrl-C keeps what is finished.\n\n\
        Writes a folder (out/<scene>_budget unless --out is given): report.html, results.json, budget.csv with every \
        figure per unit of each error, tables/influence_maps.csv with the derivative of every height. \
        See docs/budget.md.")]
    Budget(BudgetArguments),
    /// Lay measured points of a gear on its target: the normal deviation of each.
    #[command(after_help = "Example:\n  \
        gearcut deviations scenes/shaping/circular_m3_z24.toml --measured points.csv\n  \
        gearcut deviations my.toml --measured section.dxf --fit centre --layer SCAN\n\n\
        A CSV has a row for each point: x_mm, y_mm, z_mm (or x_in and so on, x_um, x_cm, x_m), and where they are \
        known tooth (from 1, counter-clockwise) and flank (left or right). The axis is z, and z = 0 the middle of the \
        face. A drawing (DXF) is that of a section: vertices of its polylines, and places on its arcs and splines.\n\n\
        The points are moved as a rigid body until the squares of the deviations on the evaluated flanks have the \
        least sum. What is moved is no deviation any more: with --fit centre an eccentricity is gone.\n\n\
        Writes a folder (out/<scene>_deviations unless --out is given): report.html, results.json, \
        tables/deviations.csv, which `gearcut diagnose` and `gearcut calibrate` read, tables/flanks.csv. \
        See docs/exchange.md.")]
    Deviations(DeviationsArguments),
    /// Find the machine errors that explain a measured gear, and the unexplained rest.
    #[command(after_help = "Example:\n  \
        gearcut diagnose scenes/shaping/circular_m3_z24.toml --measured gear.csv \\\n      \
        --noise-um 0.5\n  \
        gearcut diagnose my.toml --measured gear.csv --noise-um 0.5 \\\n      \
        --parameters mounting,machine.errors.guide\n\n\
        The CSV has a row for each measured place: tooth (from 1, counter-clockwise), flank (left or right), u_mm \
        (arc along the profile from the form point), v_mm (along the tooth from the middle of the face), deviation_um \
        (normal to the target, positive where material is). The noise is the standard deviation of each value.\n\n\
        Fits the influences of errors to the deviations from the scene's own gear, and names those that explain more \
        than noise would, with 95 % intervals; names those that cannot be separated, and whether the unexplained rest \
        exceeds the noise. A turn of the gear on the measuring machine is always fitted along.\n\n\
        Writes a folder (out/<scene>_diagnosis unless --out is given): report.html, results.json, tables/sources.csv, \
        tables/residuals.csv. See docs/budget.md.")]
    Diagnose(DiagnoseArguments),
    /// Fit errors of the machine to what was measured on a gear: numbers, surfaces, inspection charts.
    #[command(after_help = "Example:\n  \
        gearcut calibrate my.toml --measured numbers.csv \\\n      \
        --fit mounting.eccentricity_um,machine.errors.guide\n  \
        gearcut calibrate my.toml --measured out/my/inspection_charts.csv \\\n      \
        --noise-um 0.3 --fit mounting\n  \
        gearcut calibrate my.toml --measured flank.x3p --surface-percent 5 \\\n      \
        --fit machine.errors.work.noise_arcsec\n\n\
        A CSV of numbers has a row for each: quantity (its path in results.json, such as headline.F_r; \
        headline.KEY for the headline), value (in the unit that it has there), uncertainty (standard). Charts and \
        figures are read as `gearcut cut` writes them (inspection_charts.csv, tables/inspection.csv), places as \
        `gearcut diagnose` reads them. A surface belongs to a [[texture]] window of the scene: the one that its notes \
        name, the only one, or FILE@finish.tooth_03_left.\n\n\
        Cuts again and again, some ten times for each parameter: whole gears for numbers (minutes), windows or places \
        alone where nothing else was measured. Prints shifts with 95 % intervals, which of them the measured values \
        cannot identify, and the --set arguments of the fitted scene. Ctrl-C keeps the rounds that are done.\n\n\
        Writes a folder (out/<scene>_calibration unless --out is given): report.html, results.json, tables/fits.csv, \
        tables/numbers.csv, tables/lines.csv, tables/places.csv. See docs/budget.md.")]
    Calibrate(CalibrateArguments),
}

/// Arguments of `devices`.
#[derive(Debug, Args)]
pub struct DevicesArguments {
    /// Time every kernel on the processor and on every adapter, on two small gears: under a minute for each.
    #[arg(long)]
    pub bench: bool,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Print everything: tables along the curve, peaks of the axes, what the cost is made of.
    #[arg(long)]
    pub verbose: bool,
    /// What makes the verdict bad.
    #[command(flatten)]
    pub verdict: VerdictArguments,
}

/// Arguments of `cut`.
#[derive(Debug, Args)]
pub struct CutArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Folder to write [default: out/<scene>, or out/<scene>_draft and out/<scene>_part with --draft and --only].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Backend, progress and verdict.
    #[command(flatten)]
    pub run: RunArguments,
    /// What happens to a flank whose GPU is lost or runs out of memory.
    #[arg(long, value_enum, default_value_t = GpuFailureChoice::Redo)]
    pub on_gpu_failure: GpuFailureChoice,
    /// Write these parts and the numbers, nothing else: numbers, maps, pictures, meshes, texture, chips, axes, report.
    #[arg(long, value_name = "PARTS", value_delimiter = ',', value_parser = part_names())]
    pub only: Vec<String>,
    /// Cut on dexels eight times, rays and cells of maps four times as far apart, and write numbers and report alone
    /// (see --only).
    #[arg(long)]
    pub draft: bool,
    /// Draw N pictures, 2 to 5000, of the cut as it happens (frames/*.png, and all of them in frames/cut.apng).
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=5000))]
    pub frames: Option<u32>,
    /// Print every section of the findings, not only what a screen holds.
    #[arg(long)]
    pub verbose: bool,
    /// Report progress on standard error as one JSON object per line, and print results.json instead of the summary.
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
}

/// Words that `--only` takes.
fn part_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Parts::all().names())
}

/// Arguments of `axes`.
#[derive(Debug, Args)]
pub struct AxesArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Folder to write [default: out/<scene>_axes].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Show no progress and no summary.
    #[arg(long)]
    pub quiet: bool,
    /// What makes the verdict bad.
    #[command(flatten)]
    pub verdict: VerdictArguments,
}

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Output folders of the runs (or their results.json), first the one that the others are compared with; or two
    /// surface files of one place, the second laid over the first.
    #[arg(required = true, num_args = 2..=crate::compare::MOST_RESULTS, value_name = "RESULTS")]
    pub results: Vec<PathBuf>,
    /// What is taken off surfaces, on the points that both have.
    #[command(flatten)]
    pub filters: FilterArguments,
    /// Folder to write [default: compare_<A>_<B>... beside the last one].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print every number of headline and summary, not the eight that changed most alone.
    #[arg(long)]
    pub all: bool,
}

/// Arguments of `mate`.
#[derive(Debug, Args)]
pub struct MateArguments {
    /// The driver's scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Number of teeth of the mate; its turn must be a whole number of the driver's repeats.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=2000))]
    pub teeth: u32,
    /// The mate is a ring with internal teeth.
    #[arg(long)]
    pub internal: bool,
    /// File to write [default: standard output].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// What the scene is for.
    #[arg(value_parser = PossibleValuesParser::new(PROCESSES.iter().map(|process| process.scene.name)))]
    pub process: String,
    /// File to write [default: standard output].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
