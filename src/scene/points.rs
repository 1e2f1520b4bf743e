//! Points of a pitch curve from a CSV file, checked as those written in the scene.
//!
//! Read by hand: the two numbers of a line need no quoting rules, and every problem keeps its line and column.

use std::path::Path;

use super::errors::Problem;
use super::keys::{self, Kind};
use super::problems::Problems;
use super::sources::line_place;
use super::table::KeyTable;
use super::values::{Checked, Held, Values};
use crate::regular_file;

/// Sections that may name a file.
const SECTIONS: [&str; 2] = ["gear.pitch_curve.table", "gear.pitch_curve.mate.driver.table"];
/// First line of the table that is no comment.
const HEADER: &str = "phi_deg,radius_mm";
/// Largest text read, for scenes and tables: a hundred thousand points take 4 MB.
const MOST_BYTES: u64 = 16 << 20;

/// The text of a file, or why there is none.
pub(super) fn read_text(path: &Path) -> Result<String, String> {
    let bytes = regular_file::read(path, MOST_BYTES)?;
    let text = String::from_utf8(bytes).map_err(|error| format!("it is not UTF-8 text: {}", error.utf8_error()))?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// Reads the file that the scene names, if it names one, and puts its points among the values.
pub(super) fn read_points(values: &mut Values, table: &KeyTable, base_dir: &Path, problems: &mut Problems<'_>) {
    for section in SECTIONS {
        let Some(name) = values.view(section).text("file").map(str::to_owned) else { continue };
        let at = values.place_of(&keys::join(section, "file"));
        let Some(key) = table.section(section).and_then(|section| section.key("points_deg_mm")) else { continue };
        match read_text(&base_dir.join(&name)) {
            Err(why) => problems.add(
                &at,
                format!("cannot read the points file {name}: {why}"),
                "the path is relative to the scene file; the file has the header phi_deg,radius_mm".to_owned(),
            ),
            Ok(text) => match parse(&shown(base_dir, &name), &text, key.kind) {
                Ok(points) => {
                    let held = Held { value: Checked::Points(points), at: Some(at) };
                    values.held.insert(keys::join(section, "points_deg_mm"), held);
                }
                Err(problem) => problems.list.push(*problem),
            },
        }
    }
}

/// The file's path as messages print it: as the scene's own path is written, with a slash on every system.
fn shown(base_dir: &Path, name: &str) -> String {
    let base = base_dir.display().to_string();
    if base.is_empty() || Path::new(name).is_absolute() { name.to_owned() } else { format!("{base}/{name}") }
}

/// The points of `text`; the first problem ends the reading, since a wrong separator spoils every line.
fn parse(name: &str, text: &str, kind: Kind) -> Result<Vec<[f64; 2]>, Box<Problem>> {
    let Kind::Points { angle, radius, fewest, most } = kind else { return Ok(Vec::new()) };
    let refuse = |start: usize, part: &str, message: String| {
        Box::new(Problem {
            place: line_place(name, text, start..start + part.len()),
            message,
            way_out: format!(
                "a points file has the header {HEADER} and one point per line, such as 12.5,61.2; # begins a comment"
            ),
        })
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut header_seen = false;
    let mut start = 0;
    for whole in text.split_inclusive('\n') {
        let line = whole.split('#').next().unwrap_or_default().trim_end();
        if line.is_empty() {
            start += whole.len();
            continue;
        }
        if !header_seen {
            if line.replace(' ', "") != HEADER {
                return Err(refuse(start, line, format!("the header is not {HEADER}")));
            }
            header_seen = true;
            start += whole.len();
            continue;
        }
        let Some((first, second)) = line.split_once(',') else {
            return Err(refuse(start, line, "a point is two numbers with a comma between them".to_owned()));
        };
        let mut point = [0.0; 2];
        let fields = [(first, start, "angle", angle, "deg"), (second, start + first.len() + 1, "radius", radius, "mm")];
        for (slot, (field, field_start, what, range, unit)) in point.iter_mut().zip(fields) {
            let number = field.trim().parse::<f64>().ok().filter(|&number| range.contains(number));
            *slot = number.ok_or_else(|| {
                refuse(
                    field_start,
                    field,
                    format!("the {what} `{}` is not a number in range, {range} {unit}", field.trim()),
                )
            })?;
        }
        if let Some([last, _]) = points.last().filter(|last| point[0] <= last[0]) {
            return Err(refuse(start, first, format!("angle {} does not increase after {last}", point[0])));
        }
        points.push(point);
        if points.len() > most {
            return Err(refuse(start, line, format!("more than {most} points")));
        }
        start += whole.len();
    }
    if points.len() < fewest {
        let place = line_place(name, text, 0..0).without_excerpt();
        let way_out = format!("give at least {fewest} points over the whole turn, under the header {HEADER}");
        return Err(Box::new(Problem { place, message: format!("{} points are too few", points.len()), way_out }));
    }
    Ok(points)
}
