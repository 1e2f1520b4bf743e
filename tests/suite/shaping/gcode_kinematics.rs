//! X, C and B of shaping programs against kinematics written out here from nothing but the pitch curve: a sign or a
//! phase that is wrong in writer and reader alike shows.
//!
//! Seen from above, from where the ram comes, the cutter's axis stands in the direction +x from the work's. The work
//! turns clockwise and the cutter counter-clockwise, as two wheels that roll on each other must. The law: the cutter's
//! pitch circle rolls without slip on the pitch curve, so the arc from the pitch point to cutter tooth 0 is the arc of
//! the pitch curve from the polar angle 0 to the pitch point. On a circle this is the ratio of the teeth; on an ellipse
//! the arc is summed by Simpson's rule, and the work angle inverted by bisection.

use crate::fixtures::paper::*;
use gearcut::gear::PitchCurveShape;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::axes_report::programs;
use gearcut::process::shaping::scene::model::Linkage;
use gearcut::scene::model::Scene;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

const CUTTER_TEETH: f64 = 20.0;
const CUTTER_PITCH_RADIUS_MM: f64 = 30.0;
const STROKES: u32 = 420;
/// Written angles are rounded to less than this at the contour error asked below, deg and mm.
const ROUNDING: f64 = 1e-4;

/// One position of a program: stroke, X in mm, C and B in degrees.
#[derive(Debug, Clone, Copy)]
struct Position {
    stroke: f64,
    x_mm: f64,
    c_deg: f64,
    b_deg: f64,
}

/// Positions of a program, word by word: S over F is the number of strokes of a block.
fn positions(program: &str) -> Vec<Position> {
    let mut found = Vec::new();
    let (mut stroke, mut per_minute) = (0.0, 0.0);
    for line in program.lines().filter(|line| line.starts_with('N')) {
        let word = |letter: char| -> Option<f64> {
            let word = line.split(' ').find(|word| word.starts_with(letter))?;
            Some(word[1..].parse().expect("a number"))
        };
        per_minute = word('S').unwrap_or(per_minute);
        if let (Some(x_mm), Some(c_deg), Some(b_deg)) = (word('X'), word('C'), word('B')) {
            stroke += word('F').map_or(0.0, |f| per_minute / f);
            found.push(Position { stroke, x_mm, c_deg, b_deg });
        }
    }
    found
}

fn program(mut scene: Scene) -> Vec<Position> {
    scene.output.gcode_contour_error_mm = 1e-4;
    let job = ShapingJob::new(scene).expect("a gear");
    let text = programs::text(&job, &job.operations[0], &[]).expect("wanted").expect("written");
    let positions = positions(&text);
    let last = positions.last().expect("positions").stroke;
    assert!((last - f64::from(STROKES - 1)).abs() < 1e-5, "stroke {last}");
    positions
}

/// Asserts a position, X, C and B.
#[track_caller]
fn at(position: &Position, [x_mm, c_deg, b_deg]: [f64; 3]) {
    let apart = [position.x_mm - x_mm, position.c_deg - c_deg, position.b_deg - b_deg];
    assert!(apart.iter().all(|off| off.abs() < ROUNDING), "{position:?}: by hand {x_mm} mm, {c_deg} deg, {b_deg} deg");
}

#[test]
fn a_round_gear_and_its_cutter_turn_against_each_other_by_the_ratio_of_their_teeth() {
    for offset_mm in [0.0, 2.0] {
        let mut scene = paper_scene(vec![operation("cut", NORMAL, offset_mm, STROKES)]);
        (scene.gear.pitch_curve, scene.gear.teeth) = (PitchCurveShape::Circle, 24);
        let positions = program(scene);
        assert!(positions.len() > 1);
        for position in &positions {
            let turn_deg = 360.0 * position.stroke / f64::from(STROKES);
            at(position, [36.0 + CUTTER_PITCH_RADIUS_MM + offset_mm, -turn_deg, turn_deg * 24.0 / CUTTER_TEETH]);
        }
    }
}

/// The ellipse of third order of the paper, in polar coordinates about its centre of rotation.
struct Ellipse {
    /// Arcs at even steps of the polar angle, by Simpson's rule.
    arcs_mm: Vec<f64>,
}

impl Ellipse {
    const STEPS: usize = 60_000;
    const STEP_RAD: f64 = 2.5 * PI / Self::STEPS as f64;

    /// Radius and its derivative, mm and mm/rad: a (1 - k2) / (1 - k cos 3 phi).
    fn radius_mm(phi: f64) -> [f64; 2] {
        let (a, k) = (61.11, 0.1348);
        let (sin, cos) = (3.0 * phi).sin_cos();
        let below = 1.0 - k * cos;
        let r = a * (1.0 - k * k) / below;
        [r, -r * 3.0 * k * sin / below]
    }

    fn new() -> Self {
        let speed = |phi: f64| {
            let [r, slope] = Self::radius_mm(phi);
            (r * r + slope * slope).sqrt()
        };
        let mut arcs_mm = vec![0.0];
        for i in 0..Self::STEPS {
            let from = i as f64 * Self::STEP_RAD;
            let piece = speed(from) + 4.0 * speed(from + 0.5 * Self::STEP_RAD) + speed(from + Self::STEP_RAD);
            arcs_mm.push(arcs_mm[i] + piece * Self::STEP_RAD / 6.0);
        }
        Self { arcs_mm }
    }

    fn arc_mm(&self, phi: f64) -> f64 {
        let place = phi / Self::STEP_RAD;
        let i = (place as usize).min(Self::STEPS - 1);
        self.arcs_mm[i] + (place - i as f64) * (self.arcs_mm[i + 1] - self.arcs_mm[i])
    }

    /// Pitch point and unit normal out of the gear, gear frame.
    fn point_and_normal(phi: f64) -> [DVec2; 2] {
        let [r, slope] = Self::radius_mm(phi);
        let out = DVec2::from_angle(phi);
        let tangent = (slope * out + r * out.perp()).normalize();
        [r * out, -tangent.perp()]
    }

    /// The cutter's axis when it touches at `phi`, backed off along the normal, and where its tooth 0 points: gear
    /// frame.
    fn cutter(&self, phi: f64, offset_mm: f64) -> (DVec2, f64) {
        let [point, normal] = Self::point_and_normal(phi);
        // Counter-clockwise round the gear, the cutter rolls counter-clockwise: tooth 0 is ahead of the contact by the
        // arc that has passed it.
        let ahead_rad = self.arc_mm(phi) / CUTTER_PITCH_RADIUS_MM;
        (point + (CUTTER_PITCH_RADIUS_MM + offset_mm) * normal, (-normal).to_angle() + ahead_rad)
    }

    /// X, C and B when the work has turned by `psi_c`: a linkage moves the cutter back along the normal or along the
    /// line of centres.
    fn axes(&self, psi_c: f64, linkage: Linkage, offset_mm: f64) -> [f64; 3] {
        let along_normal_mm = if linkage == NORMAL { offset_mm } else { 0.0 };
        // Unwrapped: the axis never leaves its pitch point by a quarter of a turn.
        let lead = |phi: f64| {
            let ahead = DVec2::from_angle(-phi).rotate(self.cutter(phi, along_normal_mm).0).to_angle();
            phi + ahead - psi_c
        };
        let (mut low, mut high) = ((psi_c - 0.5).max(0.0), psi_c + 0.5);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if lead(middle) < 0.0 { low = middle } else { high = middle }
        }
        let (axis, tooth_rad) = self.cutter(low, along_normal_mm);
        let x_mm = axis.length() + offset_mm - along_normal_mm;
        // The machine holds the cutter's axis at +x: everything turns back by psi_c. B0 points at the work, at -x.
        let b_rad = tooth_rad - psi_c - PI;
        [x_mm, -psi_c.to_degrees(), b_rad.to_degrees()]
    }
}

#[test]
fn an_ellipse_and_its_cutter_roll_on_each_other() {
    let ellipse = Ellipse::new();
    // The paper's size closes to what its five digits allow: 42 teeth of module 3.
    assert!((ellipse.arc_mm(TAU) - 42.0 * 3.0 * PI).abs() < 2e-4, "{}", ellipse.arc_mm(TAU));
    for (linkage, offset_mm) in [(NORMAL, 0.0), (NORMAL, 2.0), (TRADITIONAL, 2.0)] {
        let positions = program(paper_scene(vec![operation("cut", linkage, offset_mm, STROKES)]));
        assert!(positions.len() > 100, "{}", positions.len());
        let mut turned_deg: f64 = 0.0;
        for position in &positions {
            let psi_c = TAU * position.stroke.round() / f64::from(STROKES);
            let [x_mm, c_deg, mut b_deg] = ellipse.axes(psi_c, linkage, offset_mm);
            // The direction of the normal is known but for whole turns; the cutter turns by less than one between
            // blocks.
            b_deg += 360.0 * ((turned_deg - b_deg) / 360.0).round();
            turned_deg = b_deg;
            at(position, [x_mm, c_deg, b_deg]);
        }
        // 42 teeth against 20, but for the last stroke.
        assert!((turned_deg - 756.0 * f64::from(STROKES - 1) / f64::from(STROKES)).abs() < 5.0, "{turned_deg}");
    }
}
