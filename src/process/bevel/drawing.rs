//! The settings of the cradle machine, drawn: cradle, head and blank seen along the cradle's axis and across it.
//!
//! In: settings, head and blank. Out: an SVG file to scale, with a name and a value at every setting. Lengths that are
//! too short to be seen keep their name and value.
//!
//! **Views.** On the left the viewer looks against the cradle's axis z, x to the right and y up. On the right the
//! viewer looks along y: z to the right, from the head to the work, and x up.

use super::job::BevelJob;
use gearcut_core::bevel::blank::BevelBlank;
use gearcut_core::bevel::cradle::CradleSettings;
use glam::{DMat3, DVec2};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Size of a view, px, and the space round the drawing.
const VIEW_PX: f64 = 430.0;
const MARGIN_PX: f64 = 30.0;
/// Room for the title of a view and for the list of settings, px.
const TITLE_PX: f64 = 40.0;
const LINE_PX: f64 = 19.0;
/// Lengths below this are too short to be drawn, px.
const SHORT_PX: f64 = 5.0;

/// Half of the crown gear's ring that is drawn, rad.
const RING_RAD: f64 = 0.3;

const CRADLE: &str = "#1f4e79";
const HEAD: &str = "#b35c00";
const WORK: &str = "#0a7a3b";
const PLAIN: &str = "#555555";

/// What is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// Settings.
    pub settings: &'a CradleSettings,
    /// The blank.
    pub blank: &'a BevelBlank,
    /// Mean radius of the head, mm.
    pub radius_mm: f64,
}

impl<'a> Drawn<'a> {
    /// The finishing operation of a job.
    pub fn of(job: &'a BevelJob) -> Self {
        Self { settings: &job.finishing().settings, blank: &job.blank, radius_mm: job.head.radius_mm }
    }
}

/// A view: millimetres to pixels.
struct DrawingView {
    origin_px: DVec2,
    px_per_mm: f64,
    out: String,
}

/// The drawing as an SVG file.
pub fn svg(drawn: &Drawn) -> String {
    let entries = entries(drawn);
    let lines = entries.len().div_ceil(2) as f64;
    let [width, height] = [2.0 * VIEW_PX + 3.0 * MARGIN_PX, VIEW_PX + TITLE_PX + LINE_PX * lines + 2.0 * MARGIN_PX];
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"DejaVu Sans, Noto Sans, Helvetica, Arial, sans-serif\" font-size=\"14\">\n\
         <title>Settings of the cradle machine</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n\
         <defs><marker id=\"e\" viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" markerWidth=\"7\" markerHeight=\"7\" \
         orient=\"auto-start-reverse\"><path d=\"M0 1 9 5 0 9z\" fill=\"context-stroke\"/></marker></defs>\n"
    );
    for (x_px, words, drawing) in [
        (MARGIN_PX, "Against the cradle's axis z", along_cradle(drawn)),
        (2.0 * MARGIN_PX + VIEW_PX, "Along y, in the plane of both axes", across(drawn)),
    ] {
        let _ = writeln!(out, "<text x=\"{x_px}\" y=\"{MARGIN_PX}\" font-weight=\"bold\">{words}</text>");
        let _ = writeln!(out, "<g transform=\"translate({x_px} {TITLE_PX})\">\n{drawing}</g>");
    }
    for (i, (colour, words)) in entries.iter().enumerate() {
        let column = f64::from(u8::from(i as f64 >= lines));
        let row = i as f64 - column * lines;
        let (x, y) = (MARGIN_PX + column * (VIEW_PX + MARGIN_PX), TITLE_PX + VIEW_PX + MARGIN_PX + LINE_PX * row);
        let _ = writeln!(out, "<text x=\"{x}\" y=\"{y}\" fill=\"{colour}\">{words}</text>");
    }
    out.push_str("</svg>\n");
    out
}

/// Symbol, name and value of every setting.
fn entries(drawn: &Drawn) -> Vec<(&'static str, String)> {
    let of = drawn.settings;
    let mm = |symbol: &str, name: &str, value: f64| format!("{symbol}  {name}: {value:.4} mm");
    let deg = |symbol: &str, name: &str, rad: f64| format!("{symbol}  {name}: {:.4}°", rad.to_degrees());
    let cradle_angle = if of.plunges() { "cradle angle, at rest" } else { "cradle angle, middle of the roll" };
    let mut entries = vec![
        (CRADLE, mm("S_r", "radial setting", of.radial_setting_mm)),
        (CRADLE, deg("q", cradle_angle, of.cradle_angle_rad)),
        (HEAD, mm("r_c", "mean cutter radius", drawn.radius_mm)),
        (HEAD, mm("X_D", "sliding base, along z", of.sliding_base_mm)),
        (HEAD, mm("X_B", "cross shift, along x", of.cross_shift_mm)),
        (WORK, mm("E_m", "blank offset", of.blank_offset_mm)),
        (WORK, mm("X_p", "machine centre to back", of.center_to_back_mm)),
        (WORK, deg("γ_m", "machine root angle", of.root_angle_rad)),
        (PLAIN, format!("R_a  ratio of roll, work angle A over q: {:.6}", of.roll.ratio)),
        (PLAIN, format!("C, D  modified roll: {}, {}", of.roll.second_order_per_rad, of.roll.third_order_per_rad2)),
    ];
    if !of.tilt.is_none() {
        entries.push((HEAD, deg("i", "tilt of the head", of.tilt.tilt_rad)));
        entries.push((HEAD, deg("j", "swivel, from the line of S_r", of.tilt.swivel_rad)));
    }
    entries
}

/// The paper draws the work at rest and moves the head by E_m and X_B; here the cradle rests, as on the machine, and
/// the work stands at the opposite of both.
fn along_cradle(drawn: &Drawn) -> String {
    let of = drawn.settings;
    let head = of.radial_setting_mm * DVec2::from_angle(of.cradle_angle_rad);
    let apex = DVec2::new(-of.cross_shift_mm, -of.blank_offset_mm);
    let outer_mm = drawn.blank.outer_cone_distance_mm;
    let inner_mm = outer_mm - drawn.blank.face_width_mm;
    let r = drawn.radius_mm;
    let ring = [-RING_RAD, RING_RAD].map(|angle| apex + outer_mm * DVec2::from_angle(angle));
    let ends = [head - r, head + r, apex + outer_mm * DVec2::new(1.1, 0.0), apex];
    let mut view = DrawingView::around(&[&ends[..], &ring].concat());
    view.axes(["x", "y"], 1.15 * outer_mm);
    // The crown gear's ring that the blank rolls on.
    for (radius_mm, dash) in [(inner_mm, "3 3"), (outer_mm, "3 3")] {
        view.arc(apex, radius_mm, [-RING_RAD, RING_RAD], (WORK, 1.2, dash), false);
    }
    view.line(
        [apex - DVec2::new(0.1 * outer_mm, 0.0), apex + DVec2::new(1.1 * outer_mm, 0.0)],
        (WORK, 1.2, "12 4 2 4"),
    );
    view.line([apex + DVec2::new(inner_mm, 0.0), apex + DVec2::new(outer_mm, 0.0)], (WORK, 6.0, ""));
    view.text(apex + DVec2::new(0.5 * (inner_mm + outer_mm), 0.0), DVec2::new(-14.0, 22.0), WORK, "blank");
    view.circle(head, r, (HEAD, 2.0, ""));
    view.dot(head, HEAD);
    view.line([head, head + r * DVec2::from_angle(2.6)], (HEAD, 1.2, ""));
    view.text(head + 0.5 * r * DVec2::from_angle(2.6), DVec2::new(4.0, -6.0), HEAD, "r_c");
    view.line([DVec2::ZERO, head], (CRADLE, 2.0, ""));
    view.text(0.55 * head, DVec2::new(8.0, 4.0), CRADLE, "S_r");
    view.arc(DVec2::ZERO, 0.3 * of.radial_setting_mm, [0.0, of.cradle_angle_rad], (CRADLE, 1.6, ""), true);
    view.text(
        0.36 * of.radial_setting_mm * DVec2::from_angle(0.5 * of.cradle_angle_rad),
        DVec2::new(0.0, 4.0),
        CRADLE,
        "q",
    );
    view.dot(DVec2::ZERO, CRADLE);
    view.text(DVec2::ZERO, DVec2::new(-56.0, 17.0), CRADLE, "cradle");
    view.dimension([DVec2::new(0.55 * inner_mm, 0.0), DVec2::new(0.55 * inner_mm, apex.y)], WORK, "E_m");
    view.dimension([DVec2::new(0.0, apex.y), apex], HEAD, "X_B");
    view.out
}

fn across(drawn: &Drawn) -> String {
    let (of, blank) = (drawn.settings, drawn.blank);
    let (sin, cos) = of.root_angle_rad.sin_cos();
    // Places as (z, x).
    let axis = DVec2::new(sin, cos);
    let apex = of.center_to_back_mm * axis - of.cross_shift_mm * DVec2::Y;
    let towards_head = DVec2::new(-cos, sin);
    let at = |distance_mm: f64, height_mm: f64, side: f64| {
        let place = blank.axial_mm([distance_mm, height_mm]);
        apex + place.x * axis + side * place.y * towards_head
    };
    let [heel, toe] = [blank.outer_cone_distance_mm, blank.outer_cone_distance_mm - blank.face_width_mm];
    let section = |side: f64| {
        [
            at(toe, -blank.dedendum_mm(toe), side),
            at(heel, -blank.dedendum_mm(heel), side),
            at(heel, blank.addendum_mm(heel), side),
            at(toe, blank.addendum_mm(toe), side),
        ]
    };
    let r = drawn.radius_mm;
    let head_x = of.radial_setting_mm * of.cradle_angle_rad.cos();
    let tips = of.sliding_base_mm;
    let depth = 0.35 * r;
    // The head's axis, seen along y.
    let lean = DMat3::from_rotation_z(of.cradle_angle_rad) * of.tilt.rotation().z_axis;
    let middle = DVec2::new(tips, head_x);
    let leaning = |along_mm: f64, out_mm: f64| {
        middle + DVec2::new(lean.z, lean.x).normalize().rotate(DVec2::new(along_mm, out_mm))
    };
    let corners = [leaning(-depth, -r), leaning(0.0, -r), leaning(0.0, r), leaning(-depth, r)];
    let mut places: Vec<DVec2> = section(1.0).into_iter().chain(section(-1.0)).collect();
    places.extend(corners);
    places.extend([DVec2::ZERO, apex + 1.1 * heel * axis]);
    let mut view = DrawingView::around(&places);
    view.axes(["z", "x"], 0.9 * heel);
    view.line([apex - 0.1 * heel * axis, apex + 1.1 * heel * axis], (WORK, 1.2, "12 4 2 4"));
    view.polygon(&corners, HEAD);
    view.line([leaning(-depth - 8.0, 0.0), leaning(8.0, 0.0)], (HEAD, 1.2, "12 4 2 4"));
    view.text(corners[3], DVec2::new(2.0, -6.0), HEAD, "head");
    for side in [1.0, -1.0] {
        view.polygon(&section(side), WORK);
    }
    view.text(section(-1.0)[1], DVec2::new(6.0, 16.0), WORK, "blank");
    view.arc(DVec2::ZERO, 0.45 * heel, [0.25 * TAU, 0.25 * TAU - of.root_angle_rad], (WORK, 1.6, ""), true);
    view.text(0.5 * heel * DVec2::from_angle(0.25 * TAU - 0.5 * of.root_angle_rad), DVec2::new(0.0, 4.0), WORK, "γ_m");
    view.dimension([DVec2::ZERO, of.center_to_back_mm * axis], WORK, "X_p");
    view.dimension([DVec2::new(0.0, 0.6 * toe), DVec2::new(tips, 0.6 * toe)], HEAD, "X_D");
    view.dot(DVec2::ZERO, CRADLE);
    view.text(DVec2::ZERO, DVec2::new(-14.0, 20.0), CRADLE, "machine centre");
    view.out
}

impl DrawingView {
    /// A view that shows all places.
    fn around(places: &[DVec2]) -> Self {
        let low = places.iter().copied().fold(DVec2::splat(f64::INFINITY), DVec2::min);
        let high = places.iter().copied().fold(DVec2::splat(f64::NEG_INFINITY), DVec2::max);
        let px_per_mm = (VIEW_PX - 2.0 * MARGIN_PX) / (high - low).max_element();
        let middle = 0.5 * (low + high);
        let origin_px = DVec2::splat(0.5 * VIEW_PX) - px_per_mm * DVec2::new(middle.x, -middle.y);
        Self { origin_px, px_per_mm, out: String::new() }
    }

    fn px(&self, place: DVec2) -> DVec2 {
        self.origin_px + self.px_per_mm * DVec2::new(place.x, -place.y)
    }

    fn line(&mut self, ends: [DVec2; 2], (colour, width, dash): (&str, f64, &str)) {
        let [a, b] = ends.map(|end| self.px(end));
        let _ = writeln!(
            self.out,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-dasharray=\"{dash}\"/>",
            a.x, a.y, b.x, b.y
        );
    }

    fn axes(&mut self, names: [&str; 2], length_mm: f64) {
        for (direction, name) in [DVec2::X, DVec2::Y].into_iter().zip(names) {
            self.line([-0.15 * length_mm * direction, length_mm * direction], ("#999999", 1.0, ""));
            self.text(length_mm * direction, DVec2::new(5.0, 5.0), "#777777", name);
        }
    }

    fn circle(&mut self, middle: DVec2, radius_mm: f64, (colour, width, dash): (&str, f64, &str)) {
        let at = self.px(middle);
        let _ = writeln!(
            self.out,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{:.1}\" fill=\"{colour}\" fill-opacity=\"0.06\" stroke=\"{colour}\" \
             stroke-width=\"{width}\" stroke-dasharray=\"{dash}\"/>",
            at.x,
            at.y,
            radius_mm * self.px_per_mm
        );
    }

    fn dot(&mut self, place: DVec2, colour: &str) {
        let at = self.px(place);
        let _ = writeln!(self.out, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.5\" fill=\"{colour}\"/>", at.x, at.y);
    }

    /// Arc between two angles, with an arrow where it turns.
    fn arc(
        &mut self,
        middle: DVec2,
        radius_mm: f64,
        angles: [f64; 2],
        (colour, width, dash): (&str, f64, &str),
        arrow: bool,
    ) {
        let [a, b] = angles.map(|angle| self.px(middle + radius_mm * DVec2::from_angle(angle)));
        let radius = radius_mm * self.px_per_mm;
        let sweep = u8::from(angles[1] < angles[0]);
        let marker = if arrow { " marker-end=\"url(#e)\"" } else { "" };
        let _ = writeln!(
            self.out,
            "<path d=\"M{:.1} {:.1}A{radius:.1} {radius:.1} 0 0 {sweep} {:.1} {:.1}\" fill=\"none\" \
             stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dash}\"{marker}/>",
            a.x, a.y, b.x, b.y
        );
    }

    fn polygon(&mut self, places: &[DVec2], colour: &str) {
        let points: Vec<String> =
            places.iter().map(|&place| self.px(place)).map(|at| format!("{:.1},{:.1}", at.x, at.y)).collect();
        let _ = writeln!(
            self.out,
            "<polygon points=\"{}\" fill=\"{colour}\" fill-opacity=\"0.15\" stroke=\"{colour}\" stroke-width=\"1.5\"/>",
            points.join(" ")
        );
    }

    /// Words beside a place, `beside_px` from it.
    fn text(&mut self, place: DVec2, beside_px: DVec2, colour: &str, words: &str) {
        let at = self.px(place) + beside_px;
        let _ = writeln!(self.out, "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">{words}</text>", at.x, at.y);
    }

    /// A length between two places with its name; one that is too short to be seen is left to the list.
    fn dimension(&mut self, ends: [DVec2; 2], colour: &str, name: &str) {
        let [a, b] = ends.map(|end| self.px(end));
        if a.distance(b) < SHORT_PX {
            return;
        }
        let _ = writeln!(
            self.out,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" stroke-width=\"1.8\" \
             marker-start=\"url(#e)\" marker-end=\"url(#e)\"/>",
            a.x, a.y, b.x, b.y
        );
        self.text(0.5 * (ends[0] + ends[1]), DVec2::new(7.0, -5.0), colour, name);
    }
}
