//! `gearcut export`: what its files hold, read back as text, against the curves themselves.
//!
//! Paths of the files are compared with the target sampled a hundred times finer than the fit had it, both ways, and
//! with the involute in closed form.

mod measured_points;
mod points;
mod qif;
mod sections;
mod solids;
mod wire;
mod wire_centre;

use crate::fixtures::command::gearcut;
use glam::DVec2;
use std::f64::consts::TAU;

const TOLERANCE_MM: f64 = 1e-3;

/// A line or an arc of a file.
#[derive(Debug, Clone, Copy)]
struct FilePiece {
    start: DVec2,
    end: DVec2,
    bulge: f64,
}

impl FilePiece {
    fn centre(&self) -> DVec2 {
        let chord = self.end - self.start;
        0.5 * (self.start + self.end) + (1.0 - self.bulge.powi(2)) / (4.0 * self.bulge) * chord.perp()
    }

    /// Place at a share of the piece.
    fn at(&self, share: f64) -> DVec2 {
        if self.bulge == 0.0 {
            return self.start.lerp(self.end, share);
        }
        let centre = self.centre();
        centre + DVec2::from_angle(4.0 * self.bulge.atan() * share).rotate(self.start - centre)
    }

    fn distance_mm(&self, p: DVec2) -> f64 {
        let ends_mm = p.distance(self.start).min(p.distance(self.end));
        if self.bulge == 0.0 {
            return distance_from_line_mm([self.start, self.end], p);
        }
        let centre = self.centre();
        let turned = (self.start - centre).angle_to(p - centre) * self.bulge.signum();
        let on_it = turned.rem_euclid(TAU) <= 4.0 * self.bulge.abs().atan();
        if on_it { (p.distance(centre) - self.start.distance(centre)).abs() } else { ends_mm }
    }
}

fn distance_from_line_mm([a, b]: [DVec2; 2], p: DVec2) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + share * along)
}

/// Polyline of a layer: whether it is closed, and its pieces.
fn polyline(dxf: &str, layer: &str) -> (bool, Vec<FilePiece>) {
    let lines: Vec<&str> = dxf.lines().map(str::trim).collect();
    let groups: Vec<[&str; 2]> = lines.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let begins = |i: &usize| groups[*i] == ["0", "LWPOLYLINE"];
    let own =
        |i: &usize| groups[i + 1..].iter().take_while(|group| group[0] != "0").any(|group| *group == ["8", layer]);
    let start = (0..groups.len()).filter(begins).find(own).unwrap_or_else(|| panic!("no polyline on {layer}"));
    let entity: Vec<[&str; 2]> = groups[start + 1..].iter().take_while(|group| group[0] != "0").copied().collect();
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let mut vertices: Vec<(DVec2, f64)> = Vec::new();
    for [code, value] in &entity {
        match *code {
            "10" => vertices.push((DVec2::new(number(value), 0.0), 0.0)),
            "20" => vertices.last_mut().expect("x comes first").0.y = number(value),
            "42" => vertices.last_mut().expect("the vertex comes first").1 = number(value),
            _ => {}
        }
    }
    let is_closed = entity.contains(&["70", "1"]);
    let count = vertices.len() - usize::from(!is_closed);
    let piece = |i: usize| {
        let ((start, bulge), (end, _)) = (vertices[i], vertices[(i + 1) % vertices.len()]);
        FilePiece { start, end, bulge }
    };
    (is_closed, (0..count).map(piece).collect())
}

/// Distance from a path, the pieces near to the point looked at alone.
fn from_path_mm(pieces: &[FilePiece], p: DVec2) -> f64 {
    pieces.iter().map(|piece| piece.distance_mm(p)).fold(f64::INFINITY, f64::min)
}

fn export(scene: &str, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("section.dxf");
    let file = path.to_str().expect("UTF-8");
    gearcut(&[&["export", scene, "--quiet", "--dxf", file], arguments].concat()).done();
    std::fs::read_to_string(path).expect("it was written")
}
