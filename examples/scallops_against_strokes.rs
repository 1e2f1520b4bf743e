//! Sweeps a parameter: height of the scallops that finishing leaves at the pitch point against strokes per revolution.
//!
//! `cargo run --release --example scallops_against_strokes -- [SCENE]` cuts tooth 1 of a round gear (default
//! `scenes/shaping/circular_m3_z24.toml`) with eight numbers of strokes, and prints a table: circular feed f, the
//! highest scallop near the pitch circle, and the closed form f^2 sin(alpha) (1 / r_c + 1 / R) / 8 with the pitch
//! radii r_c of the cutter and R of the gear.

use gearcut::{Job, Side};
use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

const CUTTER_TEETH: f64 = 20.0;
/// Scallops are looked at so far below and above the pitch circle, mm: far enough for several of the longest ones.
const REACH_MM: f64 = 0.4;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "scenes/shaping/circular_m3_z24.toml".to_owned());
    println!("| strokes | feed mm | scallop um | closed form um |\n| --- | --- | --- | --- |");
    for strokes in [800, 1000, 1200, 1600, 2000, 2400, 3200, 4000] {
        let settings = [
            format!("tool.shaper_cutter.teeth={CUTTER_TEETH}"),
            format!("operation.finish.strokes_per_revolution={strokes}"),
            "fields.flank.profile_spacing_um=2".to_owned(),
        ];
        let scene = Arc::new(gearcut::load(Path::new(&path), &settings)?);
        let gear = &scene.scene.gear;
        let pitch_radius_mm = 0.5 * gear.module_mm * f64::from(gear.teeth);
        let flank = Job::new(Arc::clone(&scene))?.cut_flank(1, Side::Left)?;
        let finish = flank.operation("finish").ok_or("the scene has no operation `finish`")?;
        let middle = flank.face_mm.len() / 2;
        let near_pitch_circle = |&column: &usize| {
            let radius_mm = flank.point_mm(finish, column, middle).map(|point| point.truncate().length());
            radius_mm.is_some_and(|radius_mm| (radius_mm - pitch_radius_mm).abs() < REACH_MM)
        };
        let columns = (0..flank.arcs_mm.len()).filter(near_pitch_circle);
        let highest_um = columns.filter_map(|column| flank.deviation_um(finish, column, middle)).fold(0.0, f64::max);
        let feed_mm = TAU * pitch_radius_mm / f64::from(strokes);
        let cutter_radius_mm = 0.5 * gear.module_mm * CUTTER_TEETH;
        let curvature_per_mm = 1.0 / cutter_radius_mm + 1.0 / pitch_radius_mm;
        let closed_um = 1e3 * feed_mm.powi(2) * gear.pressure_angle_rad.sin() * curvature_per_mm / 8.0;
        println!("| {strokes} | {feed_mm:.4} | {highest_um:.4} | {closed_um:.4} |");
    }
    Ok(())
}
