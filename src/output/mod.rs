//! Everything that leaves a run: files, pictures, tables, and what the user sees meanwhile.
//!
//! In: finished numbers with their units and names. Out: files that explain themselves.
//! The writers are generic: they know grids, series and words, but compute nothing about gears.
//!
//! | what | where |
//! | --- | --- |
//! | complete or absent: one file, one folder | [`atomic`], [`folder`] |
//! | rows that a stop does not take | `growing` |
//! | tables | [`table`] |
//! | findings for the terminal | `summary` |
//! | text for the terminal | [`text`] |
//! | maps: the grid they lie on, all digits | [`grid`], [`exr_map`] |
//! | pictures of maps: one, all flanks, their colours | `map_png`, `contact_sheet`, `colormap` |
//! | meshes for other programs | `mesh_file`, `mesh_stl`, `mesh_ply`, `mesh_glb` |
//! | drawn bodies, one or many | `render_png`, `apng` |
//! | sections of gears in mesh | `rolling_picture` |
//! | charts, on the page and as SVG files | `bar_chart`, [`line_chart`], `range_chart`, `ratio_chart` |
//! | charts with a scale for each number | `bar_panels`, `strip_chart` |
//! | the report: everything on one page that opens offline | `report` |
//! | progress and Ctrl-C | [`progress`], [`crate::interrupt`] |

#[cfg(not(feature = "testing"))]
pub(crate) mod apng;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod apng;
pub mod atomic;
mod axis;
#[cfg(not(feature = "testing"))]
pub(crate) mod bar_chart;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod bar_chart;
#[cfg(not(feature = "testing"))]
pub(crate) mod bar_panels;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod bar_panels;
mod canvas;
#[cfg(not(feature = "testing"))]
pub(crate) mod contact_sheet;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod contact_sheet;
mod figure;
#[cfg(not(feature = "testing"))]
pub(crate) mod flank_maps;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod flank_maps;
pub mod folder;
mod font;
#[cfg(not(feature = "testing"))]
pub(crate) mod growing;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod growing;
#[cfg(not(feature = "testing"))]
pub(crate) mod growing_folder;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod growing_folder;
mod heat;
#[cfg(not(feature = "testing"))]
pub(crate) mod inspection_sheet;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod inspection_sheet;
mod letters;
pub mod line_chart;
mod map_cells;
#[cfg(not(feature = "testing"))]
pub(crate) mod map_png;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod map_png;
#[cfg(not(feature = "testing"))]
pub(crate) mod mesh_file;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod mesh_file;
#[cfg(not(feature = "testing"))]
pub(crate) mod mesh_glb;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod mesh_glb;
#[cfg(not(feature = "testing"))]
pub(crate) mod mesh_ply;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod mesh_ply;
#[cfg(not(feature = "testing"))]
pub(crate) mod mesh_stl;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod mesh_stl;
mod plot;
pub mod progress;
#[cfg(not(feature = "testing"))]
pub(crate) mod range_chart;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod range_chart;
mod raster;
#[cfg(not(feature = "testing"))]
pub(crate) mod ratio_chart;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod ratio_chart;
mod relief;
#[cfg(not(feature = "testing"))]
pub(crate) mod render_png;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod render_png;
#[cfg(not(feature = "testing"))]
pub(crate) mod report;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod report;
#[cfg(not(feature = "testing"))]
pub(crate) mod rolling_picture;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod rolling_picture;
#[cfg(not(feature = "testing"))]
pub(crate) mod strip_chart;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod strip_chart;
#[cfg(not(feature = "testing"))]
pub(crate) mod summary;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod summary;
pub mod table;
pub mod text;
#[cfg(not(feature = "testing"))]
pub(crate) mod vector_page;
#[cfg(feature = "testing")]
#[doc(hidden)]
pub mod vector_page;

/// Surfaces in files, and the maps that are surfaces too, from the crate of their own.
pub use gearcut_texture::files::{self as surface_files, exr_map, grid};
