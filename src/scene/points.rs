//! Points of a pitch curve from a file: a table (CSV) of radii or of a motion ([`motion_table`]), or the curve of a
//! drawing (DXF), closed or of a sector.
//!
//! Tables are read by hand: the two numbers of a line need no quoting rules, and every problem keeps its line and
//! column. The curve of a drawing runs round the origin, the axis of the gear. Vertices of a polyline of lines are
//! taken as points of a smooth curve; arcs, ellipses and splines give a point every [`POINT_DEG`].

use std::path::Path;

use super::build::sector_deg;
use super::drawn_contour;
use super::errors::Problem;
use super::keys::{self, Kind, Range};
use super::motion_table::{self, MovedGear};
use super::problems::Problems;
use super::sources::line_place;
use super::table::KeyTable;
use super::values::{Checked, Held, Values};
use crate::regular_file;
use gearcut_core::gear::GearKind;
use glam::DVec2;
use std::f64::consts::PI;

/// Sections that may name a file.
const SECTIONS: [&str; 2] = ["gear.pitch_curve.table", "gear.pitch_curve.mate.driver.table"];
/// First line of a table that is no comment: of radii, of a motion.
const HEADERS: [&str; 2] = ["phi_deg,radius_mm", "phi_deg,mate_deg"];
/// Angles of a motion, deg: its last row is a turn behind the first.
const MOTION_DEG: [Range; 2] = [Range::below(0.0, 720.0), Range::closed(-1e6, 1e6)];
/// Largest text read, for scenes and tables: a hundred thousand points take 4 MB.
const MOST_BYTES: u64 = 16 << 20;

/// Between points of a drawn curve, deg: near enough to follow it, and so far apart that the last digits of a drawing
/// do not bend the spline.
const POINT_DEG: f64 = 0.5;
/// Largest turn from one line of a polyline to the next, and where arcs and splines meet, deg; beyond are corners.
const LARGEST_TURN_DEG: [f64; 2] = [30.0, 5.0];

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
        let is_drawing = Path::new(&name).extension().is_some_and(|end| end.eq_ignore_ascii_case("dxf"));
        let path = base_dir.join(&name);
        // Names of layers may be in any character set; numbers are not.
        let text = if is_drawing {
            regular_file::read(&path, MOST_BYTES).map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        } else {
            read_text(&path)
        };
        // A driver has teeth all round.
        let is_closed = section != SECTIONS[0] || sector_deg(values).is_none();
        match text {
            Err(why) => problems.add(
                &at,
                format!("cannot read the points file {name}: {why}"),
                "the path is relative to the scene file; the file is a table with the header phi_deg,radius_mm or \
                 phi_deg,mate_deg, or a drawing (.dxf)"
                    .to_owned(),
            ),
            Ok(text) => match if is_drawing {
                drawn(&shown(base_dir, &name), &text, key.kind, is_closed)
            } else {
                parse(&shown(base_dir, &name), &text, key.kind, moved_gear(values, section, is_closed))
            } {
                Ok(points) => {
                    let held = Held { value: Checked::Points(points), at: Some(at) };
                    values.held.insert(keys::join(section, "points_deg_mm"), held);
                }
                Err(problem) => problems.list.push(*problem),
            },
        }
    }
}

/// The gear whose curve the file of a section gives; values that are missing are missed elsewhere.
fn moved_gear(values: &Values, section: &str, is_closed: bool) -> MovedGear {
    let gear = values.view("gear");
    let is_driver = section == SECTIONS[1];
    let teeth =
        if is_driver { values.view("gear.pitch_curve.mate").whole("driver_teeth") } else { gear.whole("teeth") };
    let is_ring = !is_driver && gear.text("kind") == Some("internal");
    let module_mm = gear.number("module_mm").unwrap_or(1.0);
    let helix_rad = gear.rad("helix_angle_deg").unwrap_or_default();
    MovedGear {
        kind: if is_ring { GearKind::Internal } else { GearKind::External },
        perimeter_mm: PI * module_mm / helix_rad.cos() * f64::from(teeth.unwrap_or(1)),
        is_closed,
    }
}

/// The file's path as messages print it: as the scene's own path is written, with a slash on every system.
fn shown(base_dir: &Path, name: &str) -> String {
    let base = base_dir.display().to_string();
    if base.is_empty() || Path::new(name).is_absolute() { name.to_owned() } else { format!("{base}/{name}") }
}

/// The points of `text`; the first problem ends the reading, since a wrong separator spoils every line.
fn parse(name: &str, text: &str, kind: Kind, gear: MovedGear) -> Result<Vec<[f64; 2]>, Box<Problem>> {
    let Kind::Points { angle, radius, fewest, most } = kind else { return Ok(Vec::new()) };
    let refuse = |start: usize, part: &str, message: String| {
        Box::new(Problem {
            place: line_place(name, text, start..start + part.len()),
            message,
            way_out: format!(
                "a points file has the header {} and one point per line, such as 12.5,61.2; # begins a comment",
                HEADERS.join(" or ")
            ),
        })
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut is_motion = None;
    let mut start = 0;
    for whole in text.split_inclusive('\n') {
        let line = whole.split('#').next().unwrap_or_default().trim_end();
        if line.is_empty() {
            start += whole.len();
            continue;
        }
        let Some(is_motion) = is_motion else {
            let Some(found) = HEADERS.iter().position(|header| line.replace(' ', "") == *header) else {
                return Err(refuse(start, line, format!("the header is not {}", HEADERS.join(" or "))));
            };
            is_motion = Some(found == 1);
            start += whole.len();
            continue;
        };
        let Some((first, second)) = line.split_once(',') else {
            return Err(refuse(start, line, "a point is two numbers with a comma between them".to_owned()));
        };
        let mut point = [0.0; 2];
        let second_start = start + first.len() + 1;
        let fields = if is_motion {
            [(first, start, "angle", MOTION_DEG[0], "deg"), (second, second_start, "angle", MOTION_DEG[1], "deg")]
        } else {
            [(first, start, "angle", angle, "deg"), (second, second_start, "radius", radius, "mm")]
        };
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
    let whole = |message: String, way_out: String| {
        Box::new(Problem { place: line_place(name, text, 0..0).without_excerpt(), message, way_out })
    };
    if is_motion == Some(true) {
        return motion_table::points(&points, gear).map_err(|(message, way_out)| whole(message, way_out.to_owned()));
    }
    if points.len() < fewest {
        let way_out = format!("give at least {fewest} points over the whole turn, under the header {}", HEADERS[0]);
        return Err(whole(format!("{} points are too few", points.len()), way_out));
    }
    Ok(points)
}

/// The points of the curve that `text`, a drawing, has round its origin: closed, or open over a sector.
fn drawn(name: &str, text: &str, kind: Kind, is_closed: bool) -> Result<Vec<[f64; 2]>, Box<Problem>> {
    let Kind::Points { radius, fewest, most, .. } = kind else { return Ok(Vec::new()) };
    let contour = drawn_contour::contour(name, text, is_closed)?;
    let refuse = |message: String, way_out: &str| {
        let place = line_place(name, text, 0..0).without_excerpt();
        Err(Box::new(Problem { place, message, way_out: way_out.to_owned() }))
    };
    let mut points = contour.points_mm;
    if !(fewest..=most).contains(&points.len()) {
        let message = format!("the drawn curve has {} points, {fewest} to {most} are allowed", points.len());
        return refuse(message, "draw it as a spline, or with more or fewer points");
    }
    if let Some(mm) = points.iter().map(|at| at.length()).find(|mm| !radius.contains(*mm)) {
        return refuse(
            format!("a radius of the drawn curve, {mm:.4e} mm, is out of range, {radius} mm"),
            "check the unit of the drawing; its origin is the axis of the gear",
        );
    }
    let turns = |points: &[DVec2], i: usize| {
        let next = |i: usize| points[i % points.len()];
        (next(i + 1) - next(i)).angle_to(next(i + 2) - next(i + 1))
    };
    let largest_deg = LARGEST_TURN_DEG[usize::from(contour.is_curved)];
    // Steps from point to point, and turns between two of them.
    let steps = points.len() - usize::from(!is_closed);
    let corners = if is_closed { steps } else { steps.saturating_sub(1) };
    if let Some(corner) = (0..corners).find(|&i| turns(&points, i).abs().to_degrees() > largest_deg) {
        let (at, turn_deg) = (points[(corner + 1) % points.len()], turns(&points, corner).abs().to_degrees());
        return refuse(
            format!("the drawn curve has a corner of {turn_deg:.1} deg at x {:.4}, y {:.4} mm", at.x, at.y),
            "a pitch curve is smooth: draw it as a spline or with arcs that are tangent",
        );
    }
    // Counter-clockwise from the smallest polar angle on.
    if (0..steps).map(|i| points[i].perp_dot(points[(i + 1) % points.len()])).sum::<f64>() < 0.0 {
        points.reverse();
    }
    let step_deg = |i: usize| points[i].angle_to(points[(i + 1) % points.len()]).to_degrees();
    let round_once = "the origin of the drawing is the axis of the gear: the curve runs round it, and every ray from \
        it meets the curve once";
    if let Some(at) = (0..steps).find(|&i| step_deg(i) <= 0.0).map(|i| points[i]) {
        let message = format!("the polar angle does not grow along the drawn curve at x {:.4}, y {:.4} mm", at.x, at.y);
        return refuse(message, round_once);
    }
    let rounds = (0..steps).map(step_deg).sum::<f64>() / 360.0;
    if rounds > 1.5 || (!is_closed && rounds >= 1.0) {
        return refuse(format!("the drawn curve runs {rounds:.0} times round the origin"), round_once);
    }
    if !is_closed {
        return Ok(open_polar(&points, contour.is_curved));
    }
    let polar = |at: &DVec2| [at.y.atan2(at.x).to_degrees().rem_euclid(360.0) % 360.0, at.length()];
    let mut polar: Vec<[f64; 2]> = points.iter().map(polar).collect();
    polar.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if contour.is_curved {
        let end_deg = polar[0][0] + 360.0 - 0.5 * POINT_DEG;
        let mut last_deg = f64::NEG_INFINITY;
        polar.retain(|[deg, _]| {
            let is_kept = *deg >= last_deg + POINT_DEG && *deg < end_deg;
            last_deg = if is_kept { *deg } else { last_deg };
            is_kept
        });
    }
    Ok(polar)
}

/// Polar angles, growing from the first point's on, and radii of the points of an open curve, counter-clockwise.
fn open_polar(points: &[DVec2], is_curved: bool) -> Vec<[f64; 2]> {
    let mut deg = points[0].to_angle().to_degrees();
    let mut polar = vec![[deg, points[0].length()]];
    for pair in points.windows(2) {
        deg += pair[0].angle_to(pair[1]).to_degrees();
        polar.push([deg, pair[1].length()]);
    }
    if is_curved {
        let (mut last_deg, end_deg) = (f64::NEG_INFINITY, deg);
        polar.retain(|[deg, _]| {
            let is_end = *deg == end_deg;
            let is_kept = is_end || (*deg >= last_deg + POINT_DEG && *deg <= end_deg - 0.5 * POINT_DEG);
            last_deg = if is_kept { *deg } else { last_deg };
            is_kept
        });
    }
    polar
}
