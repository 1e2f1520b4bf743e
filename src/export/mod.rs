//! `gearcut export`: what other people's programs take of a gear, in their own formats.
//!
//! In: a scene made ready. Out: files that CAD, wire erosion, laser and measuring machines read.
//!
//! | module | what |
//! | --- | --- |
//! | [`arcs`] | a dense chain of points as few arcs and lines |
//! | [`section`] | profile, pitch curve and stock of a transverse section as such paths |
//! | [`drawing`] | layers of paths, with what is said about them |
//! | [`dxf`] | the drawing as a DXF file |
//! | [`b_spline`] | cubic B-splines through points |
//! | [`walls`] | smooth walls through sections |
//! | [`cut_walls`] | the same as the passes leave them |
//! | [`solid`] | the gear as a solid of such walls |
//! | [`flank_faces`] | flanks as such faces, where a gear is no swept section |
//! | [`step`] | solid or flanks as a STEP file |
//! | [`cut_heights`] | heights of a cut flank, where strokes reach |
//! | [`points`] | points of flanks with their normals, as CSV |
//! | [`qif`] | the same points as a QIF document |
//! | [`wire_centre`] | where the centre of a wire runs beside a profile |
//! | [`wire`] | programs of wire erosion |
//! | [`mod@unit`] | units of length, and how numbers are written |

pub mod arcs;
pub mod b_spline;
pub mod cut_heights;
pub mod cut_walls;
pub mod drawing;
pub mod dxf;
pub mod flank_faces;
pub mod points;
pub mod qif;
pub mod section;
pub mod solid;
pub mod step;
pub mod unit;
pub mod walls;
pub mod wire;
pub mod wire_centre;
