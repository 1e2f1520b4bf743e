//! The numbers of a gear that are compared: texture, profile and helix of one flank, pitch and evenness of all.
//!
//! In: a scene and a flank. Out: [`NUMBERS`] in their order; none where a number does not exist.
//!
//! The window of texture is 0.25 mm long in both directions in the middle of the evaluated profile and of the face;
//! its form is taken off by a polynomial of second order. Profile and helix are lines through that place. Pitch and
//! stock are taken in the middle of the face where flanks cross the pitch curve, as by `gearcut cut`.
//!
//! Road not taken: means over a part of the profile, as a ball would feel them. A row would not be what a cut finds.

use super::FlankWish;
use super::quantities::{SA, SIDE_SINGLE_PITCH, SIDE_TOTAL_PITCH, SK, SPK, SQ, SVK, UNEVENNESS};
use crate::findings::QuantityRow;
use crate::findings::quantities::flanks::{F_ALPHA, F_BETA, F_F_ALPHA, F_H_ALPHA, F_H_BETA};
use crate::influence::gear_grid::FlankGrid;
use crate::job::{GearJob, rows_z_mm};
use crate::measure::deviation::{PitchDeviations, Trace};
use crate::measure::topography::Form;
use crate::output::growing::RowValues;
use crate::process::ProcessJob;
use crate::scene::Scene;
use crate::scene::model::{TextureFilters, TextureWindow, WindowSides};
use crate::texture::{cut_window, windows};
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{Layer, NO_PASS};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;

/// Length of the window, mm.
const WINDOW_MM: f64 = 0.25;
/// Points of the window along the profile, 2.5 um apart, and along the tooth, where marks of shaping run straight.
const WINDOW_STEPS: [f64; 2] = [100.0, 10.0];
/// Distance of points on profiles, mm.
const PROFILE_STEP_MM: f64 = 0.01;
/// Distance of points on helices, mm; their ends leave out 5 % of the face.
const HELIX_STEP_MM: f64 = 0.5;
const HELIX_SHARE: f64 = 0.9;

/// All of them, in order.
pub static NUMBERS: [&QuantityRow; 13] = [
    &SA,
    &SQ,
    &SK,
    &SPK,
    &SVK,
    &F_ALPHA,
    &F_H_ALPHA,
    &F_F_ALPHA,
    &F_BETA,
    &F_H_BETA,
    &SIDE_SINGLE_PITCH,
    &SIDE_TOTAL_PITCH,
    &UNEVENNESS,
];

/// A gear's values of [`NUMBERS`].
pub type Values = RowValues;

/// Cuts what is needed of a gear and measures it; `like` is the job of a scene with other errors.
///
/// # Errors
/// A tooth that the gear does not have; geometry; the backend.
pub fn measure(scene: &Scene, like: &dyn ProcessJob, flank: FlankWish, backend: &dyn Backend) -> Result<Values> {
    if !(1..=scene.gear.teeth).contains(&flank.tooth) {
        let problem = format!("there is no tooth {}, the gear has {}", flank.tooth, scene.gear.teeth);
        return Err(Refusal::new("--tooth", problem, "take a tooth from 1 to the number of teeth").into());
    }
    let mut scene = scene.clone();
    scene.textures = vec![TextureWindow {
        tooth: flank.tooth,
        sides: if flank.side == Side::Left { WindowSides::Left } else { WindowSides::Right },
        operation: None,
        center_profile_mm: None,
        center_lead_mm: 0.0,
        length_profile_mm: Some(WINDOW_MM),
        length_lead_mm: Some(WINDOW_MM),
        profile_spacing_mm: Some(WINDOW_MM / WINDOW_STEPS[0]),
        lead_spacing_mm: Some(WINDOW_MM / WINDOW_STEPS[1]),
        form: Form::Poly2,
        filters: TextureFilters::default(),
        measured: None,
    }];
    let mut values = Values::new();
    like.with_errors_of(&scene)?.with_gear(&mut |gear| {
        values = of_gear(gear, flank, backend)?;
        Ok(())
    })?;
    Ok(values)
}

fn of_gear(gear: &dyn GearJob, flank: FlankWish, backend: &dyn Backend) -> Result<Values> {
    let mut values = texture(gear, backend)?;
    let FlankWish { tooth, side } = flank;
    let [from_mm, to_mm] = gear.evaluated_profile_mm(tooth, side)?;
    let steps = ((to_mm - from_mm) / PROFILE_STEP_MM).ceil().max(2.0);
    let arcs_mm: Vec<f64> = (0..=steps as usize).map(|i| from_mm + (to_mm - from_mm) * i as f64 / steps).collect();
    let layers = gear.cut_flank(backend, tooth, side, &arcs_mm, &[0.0])?;
    let rolls_mm = gear.rolls_mm(tooth, side, &arcs_mm)?;
    let ends_mm = [rolls_mm[0], rolls_mm[rolls_mm.len() - 1]];
    let profile = Trace { places_mm: rolls_mm, heights_mm: heights_mm(last(&layers)) }.deviation(ends_mm);
    values.extend([
        profile.map(|of| of.total_mm * UM_PER_MM),
        profile.map(|of| of.slope_mm * UM_PER_MM),
        profile.map(|of| of.form_mm * UM_PER_MM),
    ]);
    let rows_mm = rows_z_mm(HELIX_SHARE * gear.scene().gear.face_width_mm, HELIX_STEP_MM);
    let layers = gear.cut_flank(backend, tooth, side, &[0.5 * (from_mm + to_mm)], &rows_mm)?;
    let ends_mm = [rows_mm[0], rows_mm[rows_mm.len() - 1]];
    let helix = Trace { places_mm: rows_mm, heights_mm: heights_mm(last(&layers)) }.deviation(ends_mm);
    values.extend([helix.map(|of| of.total_mm * UM_PER_MM), helix.map(|of| of.slope_mm * UM_PER_MM)]);
    values.extend(of_all_teeth(gear, side, backend)?);
    Ok(values)
}

fn last(layers: &[Layer]) -> &Layer {
    layers.last().expect("a job has at least one operation")
}

/// Heights of a layer, mm; not a number where no pass came.
fn heights_mm(layer: &Layer) -> Vec<f64> {
    let heights = layer.heights_mm.iter().zip(&layer.passes);
    heights.map(|(&height, &pass)| if pass == NO_PASS { f64::NAN } else { f64::from(height) }).collect()
}

fn texture(gear: &dyn GearJob, backend: &dyn Backend) -> Result<Values> {
    let window = windows(gear)?.remove(0);
    let texture = cut_window(gear, backend, &window)?;
    let evaluated = texture.evaluated.as_ref().ok();
    let value = |symbol: &str| {
        let parameters = &evaluated?.evaluation.parameters;
        parameters.iter().find(|parameter| parameter.symbol == symbol)?.value.as_ref().ok().copied()
    };
    Ok(["Sa", "Sq", "Sk", "Spk", "Svk"].map(value).to_vec())
}

/// Single and total pitch deviation, unevenness.
fn of_all_teeth(gear: &dyn GearJob, side: Side, backend: &dyn Backend) -> Result<[Option<f64>; 3]> {
    let teeth = gear.scene().gear.teeth;
    // Heights of the first operation and of the last one on the pitch curve, and where the flank lies along it.
    let of_side = |side: Side| -> Result<Vec<([f64; 2], f64)>> {
        let place = |tooth: u32| {
            let FlankGrid { arcs_mm, along_per_height, .. } = FlankGrid::of_pitch(gear, tooth, side)?;
            let layers = gear.cut_flank(backend, tooth, side, &arcs_mm, &[0.0])?;
            let heights_mm = [&layers[0], last(&layers)].map(|layer| heights_mm(layer)[0]);
            Ok((heights_mm, along_per_height * heights_mm[1]))
        };
        (1..=teeth).map(place).collect()
    };
    let own = of_side(side)?;
    let places_mm: Vec<f64> = own.iter().map(|(_, along_mm)| *along_mm).collect();
    let pitch = PitchDeviations::of_places(&places_mm);
    let known = |value: f64| value.is_finite().then_some(value);
    let pitches = [pitch.largest_single_mm(), pitch.total_mm()].map(|mm| known(mm * UM_PER_MM));
    let uneven = if gear.operations().len() > 1 {
        let other = of_side(if side == Side::Left { Side::Right } else { Side::Left })?;
        let stock = |([rough, finished], _): &([f64; 2], f64)| rough - finished;
        let percents = own.iter().zip(&other).map(|(own, other)| {
            let (a, b) = (stock(own), stock(other));
            if a + b > 0.0 { 200.0 * (a - b).abs() / (a + b) } else { f64::NAN }
        });
        // One tooth without stock makes the number meaningless.
        percents.reduce(|a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }).and_then(known)
    } else {
        None
    };
    Ok([pitches[0], pitches[1], uneven])
}
