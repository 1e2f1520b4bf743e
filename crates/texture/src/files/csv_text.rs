//! Heights as text: one line per row (y), um, with the fewest digits that read back the same; comment lines above say
//! spacing and notes.
//!
//! ```text
//! # gearcut surface
//! # dx_um = 2
//! # dy_um = 3
//! # notes = {"frame":"..."}
//! -0.9,-0.793,
//! ```
//!
//! Read: commas, semicolons, tabs or blanks between heights; an empty cell, `nan`, `bad` or `---` is a hole; lines that
//! begin with `#` are comments, of which `dx_um`, `dy_um` and `notes` count.

use std::fmt::Write as _;

use super::bounds::{MOST_POINTS, height};
use super::{SpacingUm, SurfaceFile, notes_json, notes_of};
use crate::surface::Surface;
use crate::text::quoted;

pub(super) fn encode(file: &SurfaceFile) -> String {
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

pub(super) fn decode(bytes: &[u8], spacing_um: Option<SpacingUm>) -> Result<SurfaceFile, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "the file is no text".to_owned())?;
    let (mut dx, mut dy, mut notes) = (None, None, Vec::new());
    let (mut heights, mut nx, mut ny) = (Vec::new(), 0, 0);
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let number = index + 1;
        if let Some(comment) = line.strip_prefix('#') {
            let (key, value) = comment.split_once('=').unwrap_or((comment, ""));
            match key.trim() {
                "dx_um" => dx = Some(spacing(value, number)?),
                "dy_um" => dy = Some(spacing(value, number)?),
                "notes" => notes = notes_of(value),
                _ => {}
            }
            continue;
        }
        if line.trim().is_empty() {
            continue;
        }
        let before = heights.len();
        for cell in cells(line) {
            if heights.len() == MOST_POINTS {
                return Err(format!("line {number}: more than {MOST_POINTS} heights: crop or thin the surface"));
            }
            heights.push(match cell.trim() {
                "" | "---" => f64::NAN,
                word if word.eq_ignore_ascii_case("bad") => f64::NAN,
                word => height(word).map_err(|reason| format!("line {number}: {reason} in um"))?,
            });
        }
        let count = heights.len() - before;
        if ny > 0 && count != nx {
            return Err(format!("line {number} has {count} heights, the first row has {nx}"));
        }
        (nx, ny) = (count, ny + 1);
    }
    let Some([dx_um, dy_um]) = dx.zip(dy).map(|(dx, dy)| [dx, dy]).or(spacing_um) else {
        return Err("the file does not say how far its points are apart; give it with --spacing-um".to_owned());
    };
    Ok(SurfaceFile { surface: Surface::new(nx, ny, dx_um, dy_um, heights)?, notes })
}

fn spacing(value: &str, line: usize) -> Result<f64, String> {
    value.trim().parse().map_err(|_| format!("line {line}: `{}` is not a spacing in um", quoted(value.trim())))
}

/// Cells of a line by whatever stands between them.
fn cells(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    match [',', ';', '\t'].into_iter().find(|&c| line.contains(c)) {
        Some(separator) => Box::new(line.split(separator)),
        None => Box::new(line.split_whitespace()),
    }
}
