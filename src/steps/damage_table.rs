//! Tables of damage on the blank, alike for all processes but for what names a pass.

use crate::measure::damage::Damage;
use crate::output::table::Cell;

/// Columns of a table of damage; `pass` names what did it, which differs between processes.
pub fn damage_columns(pass: [&'static str; 2]) -> Vec<&'static str> {
    let common = [
        "kind",
        "operation",
        "tooth",
        "side",
        "zone",
        "height_mm",
        "lead_mm",
        "x_mm",
        "y_mm",
        "depth_mm",
        "volume_mm3",
    ];
    common.into_iter().chain(pass).collect()
}

/// Its cells but for the pass.
pub fn damage_cells(kind: &'static str, operation: &str, damage: &Damage) -> Vec<Cell> {
    vec![
        kind.into(),
        operation.into(),
        damage.place.tooth.into(),
        damage.place.side.name().into(),
        damage.place.zone.name().into(),
        damage.place.height_mm.into(),
        damage.z_mm.into(),
        damage.point_mm.x.into(),
        damage.point_mm.y.into(),
        damage.depth_mm.into(),
        damage.volume_mm3.into(),
    ]
}
