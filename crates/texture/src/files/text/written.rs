//! Heights as text, written: one line per row (y), um, with the fewest digits that read back the same; comment lines
//! above say spacing and notes.
//!
//! ```text
//! # gearcut surface: heights in um, one line per row along x, rows follow y
//! # dx_um = 2
//! # dy_um = 3
//! # notes = {"frame":"..."}
//! -0.9,-0.793,
//! ```

use std::fmt::Write as _;

use super::super::{SurfaceFile, notes_json};

pub(in crate::files) fn encode(file: &SurfaceFile) -> String {
    let surface = &file.surface;
    let mut text = format!(
        "# gearcut surface: heights in um, one line per row along x, rows follow y\n# dx_um = {}\n# dy_um = {}\n",
        surface.dx_um(),
        surface.dy_um()
    );
    if !file.notes.is_empty() {
        let _ = writeln!(text, "# notes = {}", notes_json(&file.notes));
    }
    for y in 0..surface.ny() {
        for (x, z) in surface.row(y).iter().enumerate() {
            if x > 0 {
                text.push(',');
            }
            if !z.is_nan() {
                let _ = write!(text, "{z:?}");
            }
        }
        text.push('\n');
    }
    text
}
