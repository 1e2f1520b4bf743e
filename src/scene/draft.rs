//! A draft of a scene: dexels, rays and cells of maps further apart, for numbers within seconds.
//!
//! In: a checked scene. Out: the settings that make it a draft, within the ranges of their keys; what a user sets comes
//! after them and wins.

use super::Scene;
use gearcut_core::units::UM_PER_MM;

/// How much further apart a draft's dexels stand along profiles and teeth, where several cross a feed mark.
const DRAFT_DEXELS: f64 = 8.0;
/// And its rays through the blank and the chips, whose times grow with the square and the cube of that, and the cells
/// of its maps, each of which asks for a chip.
const DRAFT_RAYS: f64 = 4.0;

/// Settings that make the scene a draft, within the ranges of the keys.
pub fn draft_settings(scene: &Scene) -> Vec<String> {
    let fields = &scene.fields;
    let dexels_um = |spacing_mm: f64, most: f64| (DRAFT_DEXELS * UM_PER_MM * spacing_mm).min(most);
    let rays_mm = |spacing_mm: f64, most: f64| (DRAFT_RAYS * spacing_mm).min(most);
    let mut settings = vec![
        ("fields.flank.profile_spacing_um", dexels_um(fields.profile_spacing_mm, 1000.0)),
        ("fields.flank.lead_spacing_um", dexels_um(fields.lead_spacing_mm, 10_000.0)),
        ("fields.blank.spacing_mm", rays_mm(fields.blank_spacing_mm, 10.0)),
        ("fields.blank.slice_spacing_mm", rays_mm(fields.blank_slice_spacing_mm, 1000.0)),
        ("output.map_spacing_mm", rays_mm(scene.output.map_spacing_mm, 10.0)),
    ];
    let own = scene.process.ray_spacings();
    settings.extend(own.into_iter().map(|(key, [spacing_mm, most_mm])| (key, rays_mm(spacing_mm, most_mm))));
    settings.into_iter().map(|(key, value)| format!("{key}={value:?}")).collect()
}
