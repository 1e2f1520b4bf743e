//! gearcut moves a machine's axes by its linkage model, sweeps every real cutting edge stroke by stroke through dexels
//! of the blank, and measures what is left.
//!
//! As a library it is a few items: a [`LoadedScene`] from [`load`] or [`parse`], a [`Job`] made of it, a [`Flank`] that
//! the job cuts, a [`run::Run`] of the whole job with all its files, and the [`Findings`] of that run. Errors name the
//! key, its value and a way out.
//!
//! # Example
//!
//! A round gear of 24 teeth, shaped with 2,400 strokes a turn. Strokes leave scallops: near the pitch point they are
//! f^2 sin(alpha) (1 / r_c + 1 / r) / 8 high, with the circular feed f and the pitch radii r_c of the cutter and r of
//! the gear.
//!
//! ```
//! use gearcut::Side;
//! use std::path::Path;
//!
//! let text = "
//!     [gear]
//!     module_mm = 3.0
//!     teeth = 24
//!     face_width_mm = 10.0
//!     [tool.shaper_cutter]
//!     teeth = 20
//! ";
//! let scene = gearcut::parse(text, "round.toml", Path::new(""), &[])?;
//! let job = gearcut::Job::new(scene)?;
//! let flank = job.cut_flank(7, Side::Left)?;
//!
//! let finish = flank.operation("finish").expect("the operation of a scene that lists none");
//! let row = flank.face_mm.len() / 2;
//! let mut highest_um = 0.0_f64;
//! for column in 0..flank.arcs_mm.len() {
//!     // None where no stroke came, and the blank's own surface stands.
//!     let Some(point_mm) = flank.point_mm(finish, column, row) else { continue };
//!     if (point_mm.truncate().length() - 36.0).abs() < 0.2 {
//!         highest_um = highest_um.max(flank.deviation_um(finish, column, row).unwrap_or_default());
//!     }
//! }
//!
//! let feed_mm = std::f64::consts::PI * 3.0 * 24.0 / 2400.0;
//! let scallop_um = 1e3 * feed_mm.powi(2) * 20_f64.to_radians().sin() * (1.0 / 30.0 + 1.0 / 36.0) / 8.0;
//! assert!((highest_um / scallop_um - 1.0).abs() < 0.1, "{highest_um} um, {scallop_um} um expected");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The whole gear, with the files that `gearcut cut` writes:
//!
//! ```no_run
//! # use std::path::Path;
//! use gearcut::{Part, Parts};
//!
//! let scene = gearcut::load(Path::new("scenes/shaping/elliptical_normal.toml"), &["gear.teeth=45".to_owned()])?;
//! let job = gearcut::Job::new(scene)?;
//! let done = job.run().only(Parts::of([Part::Maps, Part::Report])).into_folder(Path::new("out/mine"))?;
//! for entry in &done.findings.headline {
//!     let quantity = &entry.quantity;
//!     println!("{}: {:?} {}", entry.title, quantity.value(), quantity.unit().unwrap_or_default());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Three worked programs: `examples/flank_heights.rs` cuts one flank and plots its heights,
//! `examples/scallops_against_strokes.rs` sweeps a parameter, and `examples/read_x3p.rs` of `gearcut-texture`
//! evaluates a measured surface.
//!
//! # Modules
//!
//! What these pages show is for other programs. The remaining modules are the parts of the program and free to change
//! with it; the feature `testing` opens them to its own tests and benchmarks, which ask for it.
//!
//! From the ground up; each uses only those above it in this list:
//!
//! - [`gearcut_core`]: gears, tools, dexels, passes and the native backend
//! - `gearcut_gpu`: the backend on wgpu, left out without the feature `gpu`
//! - [`backend`]: which machine cuts
//! - [`interrupt`]: Ctrl-C as a flag
//! - [`colormap`]: numbers as colours
//! - `wrap`: texts in lines of a width
//! - `number_text`: numbers as text
//! - [`progress`]: what the user sees while the work goes on
//! - `regular_file`: files of others, up to a size
//! - `random`: normal numbers that follow from a key
//! - `machine`: the axes of a machine: kinds, units, motion, limits, peaks
//! - `machine_errors`: from the commanded motion of axes to the actual one
//! - `material`: cutting forces from chip thickness
//! - [`scene`]: the scene file as checked values
//! - `measure`: what is left, in numbers
//! - `surface`: what is left, as triangles and pictures
//! - `gcode`: how programs are written and read
//! - `drawn_tooth`: a tool's tooth that is drawn or measured, and the envelope of its contour
//! - [`findings`]: what a run found, as one tree of quantities and tables
//! - [`output`]: files, charts, tables, reports
//! - `overlay`: two surfaces of one place, one laid over the other
//! - `job`: what the shared steps ask of a job, whatever its process
//! - `texture`: texture windows on flanks
//! - `steps`: steps of a run that all processes share
//! - `process`: a folder for each process: tool, linkage, target, passes, and what only it measures
//! - `pair`: two gears rolling on each other
//! - [`pair_job`]: two scenes rolled on each other, and what is written about it
//! - [`run`]: the order of a whole run
//! - `influence`: what errors of the machine do to a gear, and which errors a measured gear shows
//! - `export`: sections, solids, points and programs for other people's programs
//! - `deviations`: measured points laid on the target
//! - `scatter`: how gears of one scene scatter, layer by layer of errors
//! - [`study`]: many scenes that differ in a few keys, one row of quantities each
//! - `library`: the few items that other programs need
//! - `compare`: results side by side
//! - `bench`: how fast the kernels are on a machine
//! - [`notices`]: the table of all notices, and what a command line denies and allows of them
//! - [`quantities`]: the table of all quantities that results can have
//! - `cli`: the command line, a file a command

// What only commands call is no dead code.
#![cfg_attr(not(feature = "command"), allow(dead_code, unused_imports))]

pub mod backend;
#[cfg(feature = "command")]
mod cli;
pub mod colormap;
pub mod findings;
pub mod interrupt;
pub mod notices;
pub mod output;
pub mod pair_job;
pub mod progress;
pub mod quantities;
pub mod run;
pub mod scene;
pub mod study;

cfg_if::cfg_if! {
    // Tests and benchmarks see them, other programs do not.
    if #[cfg(feature = "testing")] {
        pub mod bench;
        pub mod compare;
        pub mod deviations;
        pub mod drawn_tooth;
        pub mod export;
        pub mod gcode;
        pub mod influence;
        pub mod job;
        pub mod library;
        pub mod machine;
        pub mod machine_errors;
        pub mod material;
        pub mod measure;
        pub mod number_text;
        pub mod overlay;
        pub mod pair;
        pub mod process;
        pub mod random;
        pub mod regular_file;
        pub mod scatter;
        pub mod steps;
        pub mod surface;
        pub mod texture;
        pub mod wrap;
    } else {
        mod bench;
        mod compare;
        mod deviations;
        mod drawn_tooth;
        mod export;
        mod gcode;
        mod influence;
        mod job;
        mod library;
        mod machine;
        mod machine_errors;
        mod material;
        mod measure;
        mod number_text;
        mod overlay;
        mod pair;
        mod process;
        mod random;
        mod regular_file;
        mod scatter;
        mod steps;
        mod surface;
        mod texture;
        mod wrap;
    }
}

pub use findings::Findings;
pub use library::{Flank, Job, PlanarView};
pub use process::{load, parse, table as key_table};
pub use run::{Done, Run};
pub use scene::{LoadedScene, Scene};
pub use steps::parts::{Part, Parts, Stages};

pub use gearcut_core::terms::Side;
pub use gearcut_core::{Error, Refusal, Result};

#[cfg(feature = "testing")]
#[doc(hidden)]
pub use gearcut_core::{bevel, cut, dexel, error, frame, gear, math, passes, terms, tool, units};
#[cfg(all(feature = "gpu", feature = "testing"))]
#[doc(hidden)]
pub use gearcut_gpu as gpu;

/// The `gearcut` command: reads the arguments, runs the command, says with the exit code how it went.
///
/// 0: done. 1: the work was refused or failed, and standard error says why. 2: wrong usage. 3: done, and the verdict is
/// bad. 130: stopped by Ctrl-C.
#[cfg(feature = "command")]
pub fn command() -> std::process::ExitCode {
    cli::run(cli::args::parsed())
}
