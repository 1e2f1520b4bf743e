//! Everything that leaves a run: files, pictures, tables.
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

pub mod atomic;
mod axis;
mod canvas;
mod figure;
pub mod folder;
mod font;
mod heat;
mod letters;
pub mod line_chart;
mod map_cells;
mod plot;
mod raster;
mod relief;
pub mod table;
pub mod text;

cfg_if::cfg_if! {
    // Tests and benchmarks see them, other programs do not.
    if #[cfg(feature = "testing")] {
        pub mod apng;
        pub mod bar_chart;
        pub mod bar_panels;
        pub mod contact_sheet;
        pub mod dot_chart;
        pub mod flank_maps;
        pub mod growing;
        pub mod growing_folder;
        pub mod heat_chart;
        pub mod inspection_sheet;
        pub mod map_png;
        pub mod mesh_file;
        pub mod mesh_glb;
        pub mod mesh_ply;
        pub mod mesh_stl;
        pub mod range_chart;
        pub mod ratio_chart;
        pub mod render_png;
        pub mod report;
        pub mod rolling_picture;
        pub mod strip_chart;
        pub mod summary;
        pub mod vector_page;
    } else {
        pub(crate) mod apng;
        pub(crate) mod bar_chart;
        pub(crate) mod bar_panels;
        pub(crate) mod contact_sheet;
        pub(crate) mod dot_chart;
        pub(crate) mod flank_maps;
        pub(crate) mod growing;
        pub(crate) mod growing_folder;
        pub(crate) mod heat_chart;
        pub(crate) mod inspection_sheet;
        pub(crate) mod map_png;
        pub(crate) mod mesh_file;
        pub(crate) mod mesh_glb;
        pub(crate) mod mesh_ply;
        pub(crate) mod mesh_stl;
        pub(crate) mod range_chart;
        pub(crate) mod ratio_chart;
        pub(crate) mod render_png;
        pub(crate) mod report;
        pub(crate) mod rolling_picture;
        pub(crate) mod strip_chart;
        pub(crate) mod summary;
        pub(crate) mod vector_page;
    }
}

/// Surfaces in files, and the maps that are surfaces too, from the crate of their own.
pub use gearcut_texture::files::{self as surface_files, exr_map, grid};
