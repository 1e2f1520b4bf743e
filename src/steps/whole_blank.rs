//! Rays through the whole blank, and what is found on it, whatever cuts it.

use crate::findings::Section;
use crate::findings::quantities::blank::{BLANK, BLANK_VOLUME, IMBALANCE, LEFT_VOLUME, SLICES, SPACING};
use crate::findings::quantities::cutting::REMOVED_VOLUME;
use crate::measure::damage::OperationVolume;
use crate::scene::Scene;
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::Refusal;
use gearcut_core::gear::blank::Blank;
use gearcut_core::gear::blank_outline::BlankOutline;

/// Where rays through a blank stand at the scene's spacing; one slice if all sections are `alike`.
///
/// # Errors
/// A field that does not fit in memory.
pub fn grid(scene: &Scene, blank: &Blank, alike: bool) -> Result<BlankGrid, Refusal> {
    grid_within(scene, blank, &BlankOutline::new(blank), alike)
}

/// The uncut blank on that grid.
///
/// # Errors
/// A field that does not fit in memory.
pub fn field(scene: &Scene, blank: &Blank, alike: bool) -> Result<BlankField, Refusal> {
    let outline = BlankOutline::new(blank);
    let grid = grid_within(scene, blank, &outline, alike)?;
    Ok(BlankField::new(grid, &outline))
}

fn grid_within(scene: &Scene, blank: &Blank, outline: &BlankOutline, alike: bool) -> Result<BlankGrid, Refusal> {
    let fields = &scene.fields;
    let slice_spacing_mm = (!alike).then_some(fields.blank_slice_spacing_mm);
    BlankGrid::new(blank, outline, scene.gear.face_width_mm, fields.blank_spacing_mm, slice_spacing_mm)
}

/// What begins the section of the whole gear: distance of the rays (mm), slices, volumes by both families of rays
/// (mm3), and how well they agree.
pub fn findings(
    spacing_mm: f64,
    slices: usize,
    [blank_mm3, left_mm3]: [[f64; 2]; 2],
    operations: &[OperationVolume],
) -> Section {
    BLANK.section([
        SPACING.of(spacing_mm),
        SLICES.of(slices),
        BLANK_VOLUME.of(mean(blank_mm3)),
        LEFT_VOLUME.of(mean(left_mm3)),
        IMBALANCE.of(operations.iter().map(OperationVolume::imbalance).fold(0.0, f64::max)),
    ])
}

/// What each operation removed; names in order.
pub fn removed<'a>(names: impl Iterator<Item = &'a str>, operations: &[OperationVolume]) -> Section {
    let operations = names.zip(operations).map(|(name, of)| {
        Section::new(name, format!("Operation {name}")).entries([REMOVED_VOLUME.of(mean(of.by_passes_mm3)).shown()])
    });
    Section::new("operations", "Removed by each operation").parts(operations)
}

/// Mean of both families of rays.
pub fn mean([x, y]: [f64; 2]) -> f64 {
    0.5 * (x + y)
}
