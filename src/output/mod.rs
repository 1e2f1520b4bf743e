//! Everything that leaves a run: files, pictures, tables, and what the user sees meanwhile.
//!
//! In: finished numbers with their units and names. Out: files that explain themselves.
//! The writers are generic: they know grids, series and words, but compute nothing about gears.
//!
//! | what | where |
//! | --- | --- |
//! | complete or absent: one file, one folder | [`atomic`], [`folder`] |
//! | values with unit and definition, tables | [`quantity`], [`table`] |
//! | the layout of `results.json` | [`results`] |
//! | text for the terminal | [`text`] |
//! | maps: the grid they lie on, all digits | [`grid`], [`exr_map`] |
//! | pictures of maps: one, all flanks, their colours | [`map_png`], [`contact_sheet`], [`colormap`] |
//! | meshes for other programs | [`mesh_file`], [`mesh_stl`], [`mesh_ply`], [`mesh_glb`] |
//! | drawn bodies, one or many | [`render_png`], [`apng`] |
//! | charts: grouped bars, panels of curves | [`bar_chart`], [`line_chart`] |
//! | the report: everything on one page that opens offline | [`report`] |
//! | progress and Ctrl-C | [`progress`], [`interrupt`] |

pub mod apng;
pub mod atomic;
mod axis;
pub mod bar_chart;
mod canvas;
mod charts;
pub mod colormap;
pub mod contact_sheet;
mod exr_header;
pub mod exr_map;
pub mod flank_maps;
pub mod folder;
mod font;
pub mod grid;
mod heat;
pub mod interrupt;
pub mod line_chart;
pub mod map_png;
pub mod mesh_file;
pub mod mesh_glb;
pub mod mesh_ply;
pub mod mesh_stl;
pub mod progress;
pub mod quantity;
mod raster;
mod relief;
pub mod render_png;
pub mod report;
pub mod results;
pub mod surface_files;
pub mod table;
pub mod text;
