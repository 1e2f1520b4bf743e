//! Surface texture: areal parameters of ISO 25178-2, profile parameters of ISO 21920-2, and the files that instruments
//! write surfaces to.
//!
//! A surface does not say what was cut or measured: a flank of a gear, a ground shaft or a lens mould. Heights and
//! spacing are in um, angles in degrees.
//!
//! In: a [`Surface`], measured or cut, and a [`Chain`] of form removal, filters and crop. Out: [`Evaluation`], the full
//! set with units, definitions and, where a value does not exist, the reason.
//!
//! The modules, from the ground up; each uses only those above it in this list:
//!
//! - `text`: words out of a file, fit to print
//! - `error`: errors as values, with the file and the reason
//! - `disk_steps`: the steps on the disk by which files come to be, where tests may refuse them
//! - [`atomic`]: files that are complete or absent
//! - [`surface`]: heights on a grid with holes
//! - `columns`: lines read as columns
//! - [`height_steps`]: how coarse the steps of an instrument's heights are
//! - [`form`]: the F-operator
//! - [`gaussian`]: S- and L-filter
//! - [`chain`]: form removal, filters and crop, one after the other
//! - [`height`]: Sa Sq Ssk Sku Sp Sv Sz
//! - [`hybrid`]: Sdq Sdr
//! - `sorting`: heights sorted downwards, or single ones of them
//! - [`ratio`]: Smr Smc Sdc Sxp Vm Vv Vmp Vmc Vvc Vvv
//! - [`core`]: Sk Spk Svk Smrk1 Smrk2 Spkx Svkx Sak1 Sak2
//! - [`probability`]: Spq Svq Smq
//! - [`trace`]: a line of heights, its holes bridged
//! - [`line_form`]: the form of a line
//! - [`line_filter`]: profile S- and L-filter
//! - `elements`: profile elements and their spacing
//! - [`profile`]: Ra Rq Rsk Rku Rt Rp Rv Rz Rzx Rdq RSm Rk Rpk Rvk Rmrk1 Rmrk2 Rmr
//! - [`setting_class`]: cut-offs of ISO 21920-3
//! - [`profile_chain`]: from traced lines to P-, W- and R-parameters
//! - `spectrum`: Fourier transforms of a surface
//! - `direction`: Std
//! - [`spatial`]: Sal Str Ssw, and Std with them
//! - `watershed`: hills and their pruning
//! - [`features`]: Spd Spc Sha Svd Svc Sda S10z S5p S5v
//! - [`parameters`]: all of them, with units and definitions
//! - [`prepare`]: masks, outliers, filled holes, replicas turned back, before a chain
//! - [`align`]: two surfaces laid over each other, and their marks
//! - [`files`]: X3P, SDF, SUR, NPY, CSV and EXR maps, read and written; GWY and other text, read
//!
//! # Example
//!
//! Waves of amplitude 0.5 um, 85 um long and oblique, on a tilted plane. The plane goes, waves shorter than 10 um and
//! longer than 800 um go, half of an L-filter is left out at every side, and what is left has the numbers of a sine: Sa
//! = 2 A / pi, Sk = 1.775 A. The S-filter lets the waves pass with 2^-(10/85)^2 = 0.990.
//!
//! ```
//! use gearcut_texture::{Arguments, Chain, Evaluation, Form, Surface};
//! use std::f64::consts::{PI, TAU};
//!
//! let (nx, ny, dx_um, dy_um) = (1001, 201, 2.0, 5.0);
//! let place_um = |i: usize| ((i % nx) as f64 * dx_um, (i / nx) as f64 * dy_um);
//! let wave_um = |x: f64, y: f64| 0.5 * (TAU * (x / 100.0 + y / 163.0)).sin();
//! let heights_um = (0..nx * ny).map(place_um).map(|(x, y)| wave_um(x, y) + 0.01 * x - 0.02 * y);
//! let measured = Surface::new(nx, ny, dx_um, dy_um, heights_um.collect())?;
//!
//! let (s_filter_um, l_filter_um) = (Some(10.0), Some(800.0));
//! let chain = Chain { s_filter_um, l_filter_um, crop_um: 400.0, ..Chain::of_form(Form::Plane) };
//! let (surface, steps) = chain.apply(&measured)?;
//! let evaluation = Evaluation::of(&surface, &Arguments::default());
//! let (sa, sk) = (evaluation.value("Sa").unwrap(), evaluation.value("Sk").unwrap());
//! println!("{}\nSa {sa:.4} um, Sk {sk:.4} um", steps.join("\n"));
//!
//! let amplitude_um = 0.5 * 2_f64.powf(-10.0 * 10.0 * (100.0_f64.powi(-2) + 163.0_f64.powi(-2)));
//! assert!((sa / (2.0 / PI * amplitude_um) - 1.0).abs() < 0.01);
//! assert!((sk / (1.775 * amplitude_um) - 1.0).abs() < 0.01);
//! # Ok::<(), gearcut_texture::TextureError>(())
//! ```
//!
//! Roughness along a line, by the chain of profiles: 0.8 mm leaves 1 - 2^-(0.8/4)^2 = 2.7 % of a wave of 4 mm, and all
//! of one of 0.1 mm. The mean of |sin| is 2 / pi.
//!
//! ```
//! use gearcut_texture::profile_chain::{CutOff, ProfileChain};
//! use gearcut_texture::{ProfileTrace, parameters::of_profiles};
//! use std::f64::consts::{PI, TAU};
//!
//! let wave_um = |x: f64, length: f64| (TAU * x / length).sin();
//! let heights_um = (0..1201).map(|i| f64::from(i) * 5.0).map(|x| 0.5 * wave_um(x, 100.0) + wave_um(x, 4000.0));
//! let trace = ProfileTrace::new(heights_um.collect(), 5.0)?;
//! let profiles = ProfileChain { cutoff: CutOff::Um(800.0), ..ProfileChain::default() }.evaluate(&[trace])?;
//! let ra = &of_profiles(&profiles, &[])[0].mean;
//! println!("{}\n{} {:.3} um", profiles.words.join("\n"), ra.symbol, ra.value.clone()?);
//! assert!((ra.value.clone()? / (2.0 / PI * 0.5) - 1.0).abs() < 0.01);
//! # Ok::<(), gearcut_texture::TextureError>(())
//! ```
//!
//! A file instead of heights: [`files::read_surface`]; `examples/read_x3p.rs` evaluates one.
//!
//! # Errors
//!
//! Files that cannot be used are an [`Error`] that names them, with a [`FileFault`]. What a surface or a step does not
//! allow is a [`TextureError`], and so is the reason of a parameter that does not exist; printed it is a sentence with
//! a way out. Heights beyond [`surface::LARGEST_HEIGHT_UM`] are refused, so that no sum overflows.
//!
//! # Holes
//!
//! Holes are left out of sums and curves, count as the edge of the map for hills, and keep Std and Ssw from being
//! defined; the autocorrelation divides by the pairs that were measured.

pub mod align;
pub mod atomic;
pub mod chain;
mod columns;
pub mod core;
mod direction;
#[doc(hidden)]
pub mod disk_steps;
mod elements;
mod error;
pub mod features;
pub mod files;
pub mod form;
pub mod gaussian;
pub mod height;
pub mod height_steps;
pub mod hybrid;
pub mod line_filter;
pub mod line_form;
pub mod parameters;
pub mod prepare;
pub mod probability;
pub mod profile;
pub mod profile_chain;
pub mod ratio;
pub mod setting_class;
mod sorting;
pub mod spatial;
mod spectrum;
pub mod surface;
mod text;
pub mod trace;
mod watershed;

pub use chain::Chain;
pub use error::{Error, FileFault, Result, TextureError};
pub use form::Form;
pub use parameters::{Arguments, Evaluation, Parameter};
pub use profile::Profile;
pub use profile_chain::{ProfileChain, Profiles};
pub use surface::Surface;
pub use trace::ProfileTrace;
