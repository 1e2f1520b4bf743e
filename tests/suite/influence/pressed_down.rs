//! The influence of the share that stays pressed down behind a rounded edge, against a closed form.
//!
//! Strokes leave parabolas e = x^2 k / 2 on a flank, a feed f apart, k being the sum of both curvatures: scallops of
//! the height delta = f^2 k / 8. Where the next stroke would take less than h_min it ploughs, and the share m of what
//! it would have taken stays pressed down. Its depth below the stroke before grows evenly from 0 at the scallop's peak
//! to h_min over the length h_min / (k f), beyond which it cuts. So the mean height falls by m h_min^2 / (2 k f^2) = m
//! h_min^2 / (16 delta), as long as h_min is below 8 delta: no stroke after the next one comes there.

use super::round::{CUTTER_MM, PITCH_MM, backend, loaded};
use gearcut::influence::budget::chosen;
use gearcut::influence::derivative::Influence;
use gearcut::influence::gear_grid::{FlankGrid, GearGrid, evenly};
use gearcut::process;
use gearcut::terms::Side;
use std::f64::consts::TAU;

/// Strokes in a turn: no multiple of the teeth, so that scallops of other flanks lie elsewhere.
const STROKES: u32 = 485;
/// h_min = r k, um.
const RADIUS_UM: f64 = 2.0;
const CHIP_SHARE: f64 = 0.25;
const SECTION: &str = "tool.shaper_cutter.edge_rounding";

/// Height of the scallops on a place of a flank, um: involutes of gear and cutter touch with the radii of their
/// curvature, and contact goes along the gear's by that radius times the angle of a stroke.
fn scallop_um(radius_mm: f64) -> f64 {
    let [sine, cosine] = [20_f64.to_radians().sin(), 20_f64.to_radians().cos()];
    let gear_mm = (radius_mm.powi(2) - (PITCH_MM * cosine).powi(2)).sqrt();
    let cutter_mm = (PITCH_MM + CUTTER_MM) * sine - gear_mm;
    let feed_mm = gear_mm * TAU / f64::from(STROKES);
    1e3 * feed_mm.powi(2) / 8.0 * (1.0 / gear_mm + 1.0 / cutter_mm)
}

#[test]
fn what_stays_pressed_down_lowers_the_mean_by_its_closed_form() {
    let settings = [
        format!("operation.finish.strokes_per_revolution={STROKES}"),
        format!("{SECTION}.radius_um={RADIUS_UM}"),
        format!("{SECTION}.minimum_chip_share={CHIP_SHARE}"),
    ];
    let loaded = loaded(&settings);
    let mut flanks = Vec::new();
    // Away from the first and the last tooth, where the cut ends over its own beginning.
    process::prepare(&loaded.scene)
        .expect("a gear")
        .with_gear(&mut |gear| {
            for (tooth, side) in (6..=13).flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]) {
                let [from_mm, to_mm] = gear.evaluated_profile_mm(tooth, side)?;
                flanks.push(FlankGrid::new(gear, tooth, side, evenly([from_mm + 0.5, to_mm - 0.5], 1500), vec![0.0])?);
            }
            Ok(())
        })
        .expect("flanks");
    let grid = GearGrid { teeth: loaded.scene.gear.teeth, flanks };
    let before_um = grid.heights_um(&loaded.scene, &backend()).expect("cut");
    let parameter = chosen(&loaded, &[format!("{SECTION}.recovery_share")]).expect("a parameter").remove(0);
    let influence = Influence::new(&loaded, &grid, &before_um, &parameter, &backend()).expect("cut");
    let scallops = grid.flanks.iter().flat_map(|flank| &flank.rays);
    let scallops_um: Vec<f64> = scallops.map(|ray| scallop_um(ray.origin_mm.truncate().length())).collect();
    let chip_um = RADIUS_UM * CHIP_SHARE;
    assert!(scallops_um.iter().all(|scallop_um| chip_um < 8.0 * scallop_um));
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / grid.places() as f64;
    let expected_um = -mean(&mut scallops_um.iter().map(|scallop_um| chip_um.powi(2) / (16.0 * scallop_um)));
    let found_um = mean(&mut influence.um_per_unit.iter().copied());
    println!("{found_um} um for {expected_um} um");
    // Flanks end somewhere in a scallop.
    assert!((found_um / expected_um - 1.0).abs() < 0.02, "{found_um} um for {expected_um} um");
    // Planted: scallops of the gear's curvature alone, as if the cutter were a rack.
    let of_rack_um = |ray: &gearcut::dexel::Ray| {
        let gear_mm =
            (ray.origin_mm.truncate().length_squared() - (PITCH_MM * 20_f64.to_radians().cos()).powi(2)).sqrt();
        1e3 * (gear_mm * TAU / f64::from(STROKES)).powi(2) / 8.0 / gear_mm
    };
    let rays = grid.flanks.iter().flat_map(|flank| &flank.rays);
    let planted_um = -mean(&mut rays.map(|ray| chip_um.powi(2) / (16.0 * of_rack_um(ray))));
    assert!((found_um / planted_um - 1.0).abs() > 0.2, "{found_um} um, planted {planted_um} um");
}
