//! Deviations of a bevel flank as gear inspection draws them: the net over the grid, and what is apart from its form.
//!
//! In: the grid of a cut flank. Out: [`Position`], the plane that lies nearest to the deviations, as thickness, spiral
//! and pressure angle error; and the net as a drawing, the deviation in its middle taken away, since that is thickness.
//!
//! **Law.** Deviations d along the normals over x along the tooth, from the middle of the face towards the heel, and y
//! along the profile, from its middle towards the tip: least squares of `d = d_0 + s x + p y`. s is the spiral angle's
//! error, p the pressure angle's, as angles of the flank; over the grid's length and height they are the deviations
//! that inspection prints.

use super::measure::BevelReport;
use crate::number_text::significant;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::fmt::Write as _;

/// Size of the drawing, px: the flank is drawn in it as a plane seen askew, deviations go straight up.
const WIDTH_PX: f64 = 900.0;
const HEIGHT_PX: f64 = 430.0;
const MARGIN_PX: f64 = 60.0;
/// How far the tip line is pushed to the right and up, and how high the largest deviation is drawn, px.
const TIP_PX: DVec2 = DVec2::new(110.0, -150.0);
const LARGEST_PX: f64 = 70.0;
/// On a finer scale a perfect flank would look faulty, um.
const LEAST_UM: f64 = 1.0;

/// Where a point of the grid is drawn, by row and column.
type Place<'a> = &'a dyn Fn(usize, usize) -> DVec2;

/// What is apart from a flank's form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Deviation in the middle of the grid's plane, mm: half the thickness, as far as this flank has it.
    pub middle_mm: f64,
    /// Deviation along the tooth per length, rad, positive where the heel is higher.
    pub spiral_rad: f64,
    /// Deviation along the profile per length, rad, positive where the tip is higher.
    pub pressure_rad: f64,
    /// Length and height of the grid, mm.
    pub size_mm: [f64; 2],
}

impl Position {
    /// Of a flank all of whose grid was cut.
    pub fn of(flank: &BevelReport) -> Option<Self> {
        let [shares, along_mm] = &flank.own.grid_places;
        let deviations: Vec<f64> = flank.own.grid.iter().map(|point| point.deviation_mm).collect::<Option<_>>()?;
        let columns = shares.len();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let profile_mm: Vec<f64> = shares.iter().map(|share| share * flank.length_mm).collect();
        let [x0, y0] = [mean(along_mm), mean(&profile_mm)];
        // The grid is a product of places, so that both slopes are found by themselves.
        let slope = |offset: &dyn Fn(usize) -> f64| {
            let [mut product, mut square] = [0.0; 2];
            for (i, deviation) in deviations.iter().enumerate() {
                product += offset(i) * deviation;
                square += offset(i).powi(2);
            }
            product / square
        };
        let range = |values: &[f64]| values[values.len() - 1] - values[0];
        Some(Self {
            middle_mm: mean(&deviations),
            spiral_rad: slope(&|i| along_mm[i / columns] - x0),
            pressure_rad: slope(&|i| profile_mm[i % columns] - y0),
            size_mm: [range(along_mm), range(&profile_mm)],
        })
    }

    /// Spiral and pressure angle error as deviations over the grid, mm.
    pub fn over_grid_mm(&self) -> [f64; 2] {
        [self.spiral_rad * self.size_mm[0], self.pressure_rad * self.size_mm[1]]
    }
}

/// The net as an SVG file; nothing where a point was not cut.
pub fn svg(flank: &BevelReport, title: &str) -> Option<String> {
    let middle_mm = Position::of(flank)?.middle_mm;
    let [shares, along_mm] = &flank.own.grid_places;
    let [columns, rows] = [shares.len(), along_mm.len()];
    let um = |row: usize, column: usize| {
        UM_PER_MM * (flank.own.grid[row * columns + column].deviation_mm.unwrap_or(middle_mm) - middle_mm)
    };
    let all = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let largest_um = all().map(|(row, column)| um(row, column).abs()).fold(LEAST_UM, f64::max);
    let px_per_um = LARGEST_PX / largest_um;
    let width_px = WIDTH_PX - 2.0 * MARGIN_PX - TIP_PX.x;
    let share = |values: &[f64], i: usize| (values[i] - values[0]) / (values[values.len() - 1] - values[0]);
    let root = DVec2::new(MARGIN_PX, HEIGHT_PX - MARGIN_PX - 70.0);
    let plane = |row: usize, column: usize| {
        root + DVec2::new(share(along_mm, row) * width_px, 0.0) + share(shares, column) * TIP_PX
    };
    let raised = |row: usize, column: usize| plane(row, column) - DVec2::new(0.0, px_per_um * um(row, column));
    let line = |places: &mut dyn Iterator<Item = DVec2>| {
        places.map(|p| format!("{:.1},{:.1}", p.x, p.y)).collect::<Vec<_>>().join(" ")
    };
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH_PX} {HEIGHT_PX}\" width=\"{WIDTH_PX}\" \
         height=\"{HEIGHT_PX}\" font-family=\"DejaVu Sans, Noto Sans, Helvetica, Arial, sans-serif\" \
         font-size=\"14\">\n<title>{title}</title>\n\
         <rect width=\"{WIDTH_PX}\" height=\"{HEIGHT_PX}\" fill=\"#ffffff\"/>\n"
    );
    for (place, looks) in [
        (&plane as Place, "fill=\"none\" stroke=\"#9aa0a6\" stroke-dasharray=\"4 3\""),
        (&raised as Place, "fill=\"none\" stroke=\"#1f4e79\" stroke-width=\"1.8\""),
    ] {
        let along = (0..columns).map(|column| line(&mut (0..rows).map(|row| place(row, column))));
        let across = (0..rows).map(|row| line(&mut (0..columns).map(|column| place(row, column))));
        for points in along.chain(across) {
            let _ = writeln!(out, "<polyline points=\"{points}\" {looks}/>");
        }
    }
    for (row, column) in all() {
        let [from, to] = [plane(row, column), raised(row, column)];
        let colour = if um(row, column) < 0.0 { "#1f4e79" } else { "#b3261e" };
        let _ = writeln!(
            out,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{colour}\" stroke-width=\"2.4\"/>",
            from.x, from.y, to.x, to.y
        );
    }
    let bar_um = 10_f64.powf(largest_um.log10().floor());
    // A hundredth of the bar is as fine as it is read.
    let decimals = (2.0 - bar_um.log10().round()).max(0.0) as usize;
    let last = [rows - 1, columns - 1];
    for (row, column, anchor, down) in
        [(0, 0, "end", 14.0), (last[0], 0, "start", 14.0), (0, last[1], "end", -6.0), (last[0], last[1], "start", -6.0)]
    {
        let at = plane(row, column);
        let value = format!("{:.decimals$}", um(row, column)).replace('-', "−");
        let x_px = at.x + if anchor == "end" { -8.0 } else { 8.0 };
        let _ = writeln!(out, "<text x=\"{x_px:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{value}</text>", at.y + down);
    }
    let below = HEIGHT_PX - 20.0;
    for (x_px, words) in [
        (root.x, "toe, root"),
        (root.x + width_px - 60.0, "heel, root"),
        (root.x + TIP_PX.x + 0.5 * width_px, "corners in µm"),
    ] {
        let _ = writeln!(out, "<text x=\"{x_px:.1}\" y=\"{below:.1}\" fill=\"#555555\">{words}</text>");
    }
    let (x_px, top_px) = (WIDTH_PX - 40.0, HEIGHT_PX - 40.0 - px_per_um * bar_um);
    let _ = writeln!(
        out,
        "<line x1=\"{x_px}\" y1=\"{}\" x2=\"{x_px}\" y2=\"{top_px:.1}\" stroke=\"#000000\" stroke-width=\"3\"/>\n\
         <text x=\"{}\" y=\"{}\" text-anchor=\"end\">{} µm</text>\n</svg>",
        HEIGHT_PX - 40.0,
        x_px - 6.0,
        HEIGHT_PX - 40.0,
        significant(bar_um, 2)
    );
    Some(out)
}
