//! The whole gear in `results.json`: volumes, damage, rubbing, strokes.

use serde::{Deserialize, Serialize};

use crate::output::quantity::Quantity;

/// What the rays through the whole blank say.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlankResults {
    /// Distance of the rays.
    pub spacing: Quantity,
    /// Transverse slices; one stands for the face where all sections are equal.
    pub slices: Quantity,
    /// Volume of the uncut blank.
    pub blank_volume: Quantity,
    /// Volume that is left.
    pub left_volume: Quantity,
    /// Operations in order.
    pub operations: Vec<BlankOperationResults>,
    /// Largest difference between what passes removed and what is missing, relative to it.
    pub imbalance: Quantity,
    /// Transverse section that is left, mean over the face.
    pub end_face_area: Quantity,
    /// Area of the target's outline.
    pub target_end_face_area: Quantity,
    /// How far the section may be off because of the rays' distance.
    pub end_face_area_bound: Quantity,
    /// Target material that the last operation took.
    pub gouges: DamageResults,
    /// Target material that an earlier operation took.
    pub interference: DamageResults,
    /// Return strokes on surfaces that stay.
    pub rubbing_on_gear: DamageResults,
    /// Return strokes on stock that is still to be removed.
    pub rubbing_on_stock: DamageResults,
    /// Strokes that are missing, did not cut or were made twice.
    pub stroke_faults: Quantity,
    /// Pairs of ray and pass in which the ray crosses the tooth.
    pub ray_passes_visited: Quantity,
    /// Those that removed material.
    pub ray_passes_removing: Quantity,
}

/// Volume that an operation removed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlankOperationResults {
    /// Name in the scene.
    pub name: String,
    /// The volume.
    pub removed_volume: Quantity,
}

/// Damage or rubbing, all places together; each of them stands in `tables/damage.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DamageResults {
    /// Sides of teeth with some.
    pub places: Quantity,
    /// Largest depth along the normal.
    pub deepest: Quantity,
    /// Tooth and side of the largest depth.
    pub place: Quantity,
    /// Volume.
    pub volume: Quantity,
}
