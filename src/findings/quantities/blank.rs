//! Quantities of the whole blank: volumes, and damage to the target.

use crate::findings::rows;

/// No damage; the depth is that of `measure::damage::LEAST_DEPTH_MM`.
pub const NO_DAMAGE: &str = "there is none deeper than 0.001 mm";
/// No outline to hold sections against.
pub const NO_TARGET: &str = "the target's outline is not known in closed form: the cutter's base shapes the tips";
/// No count of pairs.
pub const NOT_COUNTED: &str = "the GPU does not count them";
/// A stroke has no place.
pub const NO_PLACE: &str = "a stroke has no place on the gear";

rows! {
    /// The whole blank.
    BLANK: "blank", "The whole gear", "blank";

    SPACING: "spacing", "mm", "distance of the rays through the blank; of a bevel gear on the pitch circle of the heel";
    SLICES: "slices", "slices",
        "transverse sections of rays; one is enough where all are equal or lie near the middle one";
    BLANK_VOLUME: "blank_volume", "mm^3",
        "volume of the uncut blank less its bore, of a ring or a bevel gear of the ring alone; mean of both families \
         of \
         rays"
        => titled("blank"), shown();
    LEFT_VOLUME: "left_volume", "mm^3", "volume after the last operation" => titled("left"), shown();
    IMBALANCE: "imbalance", "1",
        "largest difference between what the passes of an operation removed, summed pass by pass, and what is missing \
         from the rays, relative to it";
    SECTION_AREA: "section_area", "mm^2", "transverse section after the last operation, mean over the face";
    TARGET_AREA: "target_section_area", "mm^2",
        "area of the target's section less the bore, of a ring outside its outline, from the meshing condition"
        => or(&[NO_TARGET]);
    AREA_BOUND: "section_area_bound", "mm^2",
        "bound of the section's error from the distance of the rays: half of it times the travel of the outline along \
         the rays"
        => or(&[NO_TARGET]);
    GOUGE_FROM: "gouge_from", "mm",
        "depth from which on a cut below the target is a gouge and no deviation: form deviation that ISO 1328-1:2013 \
         allows a profile in class 8";
    PAIRS_VISITED: "ray_passes_visited", "pairs", "pairs of ray and pass in which the ray crosses the tool's tooth"
        => or(&[NOT_COUNTED]);
    PAIRS_REMOVING: "ray_passes_removing", "pairs", "pairs of ray and pass that removed material"
        => or(&[NOT_COUNTED]);
}

rows! {
    /// Damage of one kind.
    DAMAGE: "damage", "Damage", "blank.gouges, .interference, .rubbing_on_gear and .rubbing_on_stock; columns of \
     blank.damage";

    PLACES: "places", "sides of teeth", "sides of teeth with damage of the section's kind, deeper than 0.001 mm"
        => titled("sides of teeth"), shown(), or(&[NO_TARGET]);
    DEEPEST: "deepest", "mm",
        "largest depth along the normal; at its place the height over the pitch curve and the distance z from the \
         middle of the face"
        => shown(), or(&[NO_DAMAGE, NO_TARGET]);
    VOLUME: "volume", "mm^3", "volume of the damage, all places of the section's kind together" => or(&[NO_TARGET]);
    KIND: "kind", "", "kind of the damage: a deviation, a gouge, interference, rubbing on the way back";
    OPERATION: "operation", "", "name of the operation";
    SIDE: "side", "", "side of the tooth: left or right";
    ZONE: "zone", "", "part of the side";
    HEIGHT: "height", "mm", "height of the deepest place over the pitch curve, along its normal" => or(&[NO_PLACE]);
    Z: "z", "mm", "z of the deepest place in the gear frame, from the middle of the face" => or(&[NO_PLACE]);
    X: "x", "mm", "x of the deepest place in the gear frame" => or(&[NO_PLACE]);
    Y: "y", "mm", "y of the deepest place in the gear frame" => or(&[NO_PLACE]);
    DEPTH: "depth", "mm", "largest depth of the place along the normal" => or(&[NO_PLACE]);
    STROKE: "stroke", "1", "number of the stroke, from 0";
    CUTTER_TOOTH: "cutter_tooth", "1", "number of the cutter tooth, of several that of the largest chip, from 0"
        => or(&["the stroke is idle"]);
    VOLUME_OF_PLACE: "volume_of_place", "mm^3", "volume of the damage at the place" => or(&[NO_PLACE]);
}
