//! The contour of one tooth from a file: a table (CSV), or the open curve of a drawing (DXF).
//!
//! In: a file. Out: its points with the tooth along x, from the right root over the tip to the left root, mm. In the
//! file the tooth is upright: x across it, y out along its centre line, from the cutter's axis or from the hob's pitch
//! line. What is no tooth of this tool is refused with its place.

use super::{ContourPlace, TeethOn};
use crate::regular_file;
use crate::scene::drawn_contour;
use gearcut_core::error::Refusal;
use glam::DVec2;
use std::f64::consts::PI;
use std::path::Path;

/// Largest file read: a hundred thousand lines.
const MOST_BYTES: u64 = 16 << 20;
/// Layer of the tooth in a drawing.
const LAYER: &str = "TOOTH";
/// Points of a contour: fewer are no tooth, more take long to compare with each other.
const FEWEST_POINTS: usize = 4;
const MOST_POINTS: usize = 5000;
/// Points nearer than this to the one before are the same one, mm.
const SAME_MM: f64 = 1e-6;
/// A point may lie this far beyond the middle of the space between two teeth, as a share of half a pitch: rounding of
/// the file.
const BEYOND: f64 = 1e-4;

/// A file with a contour.
pub struct ContourFile<'a> {
    path: &'a Path,
    place: ContourPlace,
}

/// Where y is counted from.
fn y_words(place: ContourPlace) -> &'static str {
    match place.pitch {
        TeethOn::Circle { .. } => "y from the cutter's axis outwards",
        TeethOn::Line { .. } => "y from the hob's pitch line outwards",
    }
}

impl ContourFile<'_> {
    fn refuse<T>(&self, problem: &str, way_out: &str) -> Result<T, Refusal> {
        Err(Refusal::new(&self.place.file_key(), format!("{}: {problem}", self.path.display()), way_out))
    }

    /// The points as the file has them.
    fn points(&self) -> Result<Vec<DVec2>, Refusal> {
        let is_drawing = self.path.extension().is_some_and(|end| end.eq_ignore_ascii_case("dxf"));
        let bytes = regular_file::read(self.path, MOST_BYTES).or_else(|why| {
            let way_out = "the path is relative to the scene file; the file is a table with the header x_mm,y_mm, or \
                a drawing (.dxf)";
            self.refuse(&format!("it cannot be read: {why}"), way_out)
        })?;
        let text = String::from_utf8_lossy(&bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        if is_drawing {
            let name = self.path.display().to_string();
            let contour = drawn_contour::open_contour(&name, text, LAYER);
            return Ok(contour
                .map_err(|problem| {
                    let place = format!("{}: {}", problem.place, problem.message);
                    Refusal::new(&self.place.file_key(), place, problem.way_out.clone())
                })?
                .points_mm);
        }
        self.table(text)
    }

    fn table(&self, text: &str) -> Result<Vec<DVec2>, Refusal> {
        let way_out = format!(
            "write a table with the header x_mm,y_mm and one point in each line, such as 1.25,31.7; x runs across the \
            tooth, {}; # begins a comment",
            y_words(self.place)
        );
        let mut unit_mm = None;
        let mut points = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default().trim();
            let at = |problem: &str| self.refuse(&format!("line {}: {problem}", index + 1), &way_out);
            if line.is_empty() {
                continue;
            }
            let Some(unit) = unit_mm else {
                unit_mm = Some(match line.replace(' ', "").as_str() {
                    "x_mm,y_mm" => 1.0,
                    "x_um,y_um" => 1e-3,
                    "x_in,y_in" => 25.4,
                    _ => return at(&format!("the header `{line}` is not x_mm,y_mm (or _um, _in)")),
                });
                continue;
            };
            let numbers: Vec<f64> = line.split(',').filter_map(|text| text.trim().parse().ok()).collect();
            match numbers[..] {
                [x, y] if x.is_finite() && y.is_finite() => points.push(unit * DVec2::new(x, y)),
                _ => return at(&format!("`{line}` is not two numbers with a comma between them")),
            }
        }
        Ok(points)
    }
}

/// Points of one tooth, along x.
///
/// # Errors
/// A file that cannot be read, a contour that crosses itself, that is no tooth of this tool or of another size.
pub fn read(path: &Path, place: ContourPlace) -> Result<Vec<DVec2>, Refusal> {
    let file = ContourFile { path, place };
    let mut points = file.points()?;
    points.dedup_by(|later, kept| later.distance(*kept) < SAME_MM);
    if !(FEWEST_POINTS..=MOST_POINTS).contains(&points.len()) {
        let problem = format!("it has {} points, and {FEWEST_POINTS} to {MOST_POINTS} are taken", points.len());
        return file.refuse(&problem, "give the whole tooth, a point every 0.02 to 0.1 mm");
    }
    // Upright on paper, along x here.
    let mut points: Vec<DVec2> = points.into_iter().map(|at| DVec2::new(at.y, -at.x)).collect();
    if points[0].y > points[points.len() - 1].y {
        points.reverse();
    }
    let said = |at: DVec2| format!("x {:.4}, y {:.4} mm", -at.y, at.x);
    let frame = format!(
        "x runs across the tooth and {}: the contour leads from the root on one side of x = 0 over the tip to the root \
        on the other side",
        y_words(place)
    );
    if let Some(&at) = points.iter().find(|&&at| is_beyond(place, at)) {
        let tool = match place.pitch {
            TeethOn::Circle { teeth, .. } => {
                format!("a cutter with {teeth} teeth, {:.3} deg", (PI / f64::from(teeth)).to_degrees())
            }
            TeethOn::Line { pitch_mm } => format!("a hob of pitch {pitch_mm:.4} mm, {:.4} mm", 0.5 * pitch_mm),
        };
        let problem = format!("the point {} does not lie on a tooth of {tool} to either side of x = 0", said(at));
        return file.refuse(&problem, &frame);
    }
    let [first, last] = [points[0], points[points.len() - 1]];
    if first.y >= 0.0 || last.y <= 0.0 {
        let problem =
            format!("it leads from {} to {}, not from one side of x = 0 to the other", said(first), said(last));
        return file.refuse(&problem, &frame);
    }
    let ends_mm = place.out_mm(first).max(place.out_mm(last));
    let top_mm = points.iter().map(|&at| place.out_mm(at)).fold(f64::NEG_INFINITY, f64::max);
    let (pitch_mm, from, pitch, look_at) = match place.pitch {
        TeethOn::Circle { radius_mm, .. } => (
            radius_mm,
            "off the axis",
            format!("the cutter's pitch circle of {radius_mm:.3} mm and its roots lie within"),
            "check the unit of the file, gear.module_mm and tool.shaper_cutter.teeth",
        ),
        TeethOn::Line { .. } => (
            0.0,
            "over y = 0",
            "the hob's pitch line, y = 0, and its roots lie under it".to_owned(),
            "count y from the pitch line, not from the hob's axis, and check the unit of the file and gear.module_mm",
        ),
    };
    if ends_mm >= pitch_mm || top_mm <= pitch_mm {
        let problem =
            format!("it leads from {ends_mm:.3} mm to {top_mm:.3} mm {from}, but a tooth reaches over {pitch}");
        return file.refuse(&problem, look_at);
    }
    if let Some(at) = crossing(&points) {
        return file.refuse(&format!("the contour crosses itself at {}", said(at)), "take the loop out of the contour");
    }
    Ok(points)
}

/// Whether a point lies beyond the middles of the spaces beside the tooth.
fn is_beyond(place: ContourPlace, at: DVec2) -> bool {
    match place.pitch {
        TeethOn::Circle { teeth, .. } => at.x <= 0.0 || at.to_angle().abs() > PI / f64::from(teeth) * (1.0 + BEYOND),
        TeethOn::Line { pitch_mm } => at.y.abs() > 0.5 * pitch_mm * (1.0 + BEYOND),
    }
}

/// The first place at which a chain of points crosses itself.
fn crossing(points: &[DVec2]) -> Option<DVec2> {
    let chords: Vec<[DVec2; 2]> = points.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    chords.iter().enumerate().find_map(|(i, chord)| {
        chords[i + 1..].iter().skip(1).find_map(|other| meet(chord, other).map(|share| chord[0].lerp(chord[1], share)))
    })
}

/// The share of a chord at which it crosses another one.
pub fn meet(&[a, b]: &[DVec2; 2], &[c, d]: &[DVec2; 2]) -> Option<f64> {
    if a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any() {
        return None;
    }
    let (along, other) = (b - a, d - c);
    let across = along.perp_dot(other);
    let share = (c - a).perp_dot(other) / across;
    let share_of_other = (c - a).perp_dot(along) / across;
    ((0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&share_of_other)).then_some(share)
}
