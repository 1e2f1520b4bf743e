//! Rays through the whole blank, and what is found on it, whatever cuts it.

use crate::findings::{Quantity, Section};
use crate::measure::damage::OperationVolume;
use crate::scene::Scene;
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::Refusal;
use gearcut_core::gear::GearKind;
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

/// What begins the section of the whole gear: rays, volumes by both families of rays (mm3), and how well they agree.
pub fn findings(
    kind: GearKind,
    spacing_mm: f64,
    slices: (usize, &'static str),
    [blank_mm3, left_mm3]: [[f64; 2]; 2],
    operations: &[OperationVolume],
) -> Section {
    let uncut = match kind {
        GearKind::External => "volume of the uncut blank less its bore; mean of both families of rays",
        GearKind::Internal => "volume of the uncut ring; mean of both families of rays",
    };
    let volume = |families, definition: &'static str| Quantity::number(mean(families), "mm^3", definition);
    let imbalance = operations.iter().map(OperationVolume::imbalance).fold(0.0, f64::max);
    Section::new("blank", "The whole gear")
        .with("spacing", Quantity::number(spacing_mm, "mm", "distance of the rays through the blank"))
        .with("slices", Quantity::count(slices.0 as u64, "slices", slices.1))
        .shown("blank_volume", "blank", volume(blank_mm3, uncut))
        .shown("left_volume", "left", volume(left_mm3, "volume that is left after the last operation"))
        .with(
            "imbalance",
            Quantity::number(
                imbalance,
                "1",
                "largest difference of an operation between what its passes removed, summed pass by pass, and what is \
                 missing from the rays, relative to it",
            ),
        )
}

/// What each operation removed; names in order.
pub fn removed<'a>(names: impl Iterator<Item = &'a str>, operations: &[OperationVolume]) -> Section {
    let operations = names.zip(operations).map(|(name, of)| {
        let definition = "volume that its passes removed, summed pass by pass";
        let volume = Quantity::number(mean(of.by_passes_mm3), "mm^3", definition);
        Section::new(name, format!("Operation {name}")).shown("removed_volume", "removed", volume)
    });
    Section::new("operations", "Removed by each operation").parts(operations)
}

/// Mean of both families of rays.
pub fn mean([x, y]: [f64; 2]) -> f64 {
    0.5 * (x + y)
}
