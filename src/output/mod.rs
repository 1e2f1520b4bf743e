//! Everything that leaves a run: files, pictures, tables, and what the user sees meanwhile.
//!
//! In: finished numbers with their units and names. Out: files that explain themselves.
//! The writers are generic: they know grids, series and words, but compute nothing about gears.
//!
//! | what | where |
//! | --- | --- |
//! | complete or absent: one file, one folder | [`atomic`], [`folder`] |
//! | rows that a stop does not take | [`growing`] |
//! | tables | [`table`] |
//! | findings for the terminal | [`summary`] |
//! | text for the terminal | [`text`] |
//! | maps: the grid they lie on, all digits | [`grid`], [`exr_map`] |
//! | pictures of maps: one, all flanks, their colours | [`map_png`], [`contact_sheet`], [`crate::colormap`] |
//! | meshes for other programs | [`mesh_file`], [`mesh_stl`], [`mesh_ply`], [`mesh_glb`] |
//! | drawn bodies, one or many | [`render_png`], [`apng`] |
//! | sections of gears in mesh | [`rolling_picture`] |
//! | charts, on the page and as SVG files | [`bar_chart`], [`line_chart`], [`range_chart`], [`ratio_chart`] |
//! | charts with a scale for each number | [`bar_panels`], [`strip_chart`] |
//! | the report: everything on one page that opens offline | [`report`] |
//! | progress and Ctrl-C | [`progress`], [`crate::interrupt`] |

#[doc(hidden)]
pub mod apng;
#[doc(hidden)]
pub mod atomic;
mod axis;
#[doc(hidden)]
pub mod bar_chart;
#[doc(hidden)]
pub mod bar_panels;
mod canvas;
#[doc(hidden)]
pub mod contact_sheet;
mod figure;
#[doc(hidden)]
pub mod flank_maps;
#[doc(hidden)]
pub mod folder;
mod font;
#[doc(hidden)]
pub mod growing;
#[doc(hidden)]
pub mod growing_folder;
mod heat;
#[doc(hidden)]
pub mod inspection_sheet;
mod letters;
pub mod line_chart;
mod map_cells;
#[doc(hidden)]
pub mod map_png;
#[doc(hidden)]
pub mod mesh_file;
#[doc(hidden)]
pub mod mesh_glb;
#[doc(hidden)]
pub mod mesh_ply;
#[doc(hidden)]
pub mod mesh_stl;
mod plot;
pub mod progress;
#[doc(hidden)]
pub mod range_chart;
mod raster;
#[doc(hidden)]
pub mod ratio_chart;
mod relief;
#[doc(hidden)]
pub mod render_png;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod rolling_picture;
#[doc(hidden)]
pub mod strip_chart;
#[doc(hidden)]
pub mod summary;
pub mod table;
#[doc(hidden)]
pub mod text;
#[doc(hidden)]
pub mod vector_page;

/// Surfaces in files, and the maps that are surfaces too, from the crate of their own.
pub use gearcut_texture::files::{self as surface_files, exr_map, grid};
