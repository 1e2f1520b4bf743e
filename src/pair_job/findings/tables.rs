//! The tables of a pair: every position, every tooth, the centre distance in tight mesh.

use super::ARCSEC_PER_RAD;
use crate::findings::{QuantityRow, Table};
use crate::pair_job::double_flank::DoubleFlank;
use crate::pair_job::fit::SIDES;
use crate::pair_job::quantities::{
    ANGLE, ANGLE_OF_A, ANGLE_OF_B, CONTACT_BY_TOOTH, END_ON_A, END_ON_B, ERROR, ERROR_AT_PITCH_POINT, FIRST,
    FLANK_OF_A, GAP_LEFT, GAP_RIGHT, HIGHEST_ON_A, HIGHEST_ON_B, IN_CONTACT, LONG_WAVE, LOWEST_ON_A, LOWEST_ON_B, MESH,
    PAIRS, PLAY, PLAY_ANGLE, PLAY_TANGENTIAL, POSITIONS, RATIO_ACHIEVED, RATIO_ASKED, START_ON_A, START_ON_B,
    TOOTH_OF_A, TOUCHING, VARIATION,
};
use crate::pair_job::rolled::RolledPair;
use crate::pair_job::teeth::edge;
use gearcut_core::units::UM_PER_MM;

/// One row for every position of the period.
pub(super) fn rolling(rolled: &RolledPair) -> Table {
    let moments = &rolled.period.moments;
    let mut table = POSITIONS
        .table(0..moments.len())
        .column(&ANGLE_OF_A, |&i| moments[i].pitch.phi_1_rad.to_degrees())
        .column(&ANGLE_OF_B, |&i| moments[i].pitch.phi_2_rad.to_degrees())
        .column(&RATIO_ASKED, |&i| rolled.ratios[i][0])
        .column(&RATIO_ACHIEVED, |&i| rolled.ratios[i][1]);
    for (side, (error, pairs)) in SIDES.into_iter().zip(rolled.errors.iter().zip(&rolled.pairs)) {
        let of_side = |row: &QuantityRow| row.as_column().keyed(format!("{}_{}", row.key, side.name()));
        let acting = |i: usize| &moments[i].side(side).acting;
        let touching = |i: usize| edge(&rolled.flanks, side, acting(i)).map_or("flank", |edge| edge.name());
        table = table
            .column(of_side(&ERROR), |&i| ARCSEC_PER_RAD * error.total_rad[i])
            .column(of_side(&ERROR_AT_PITCH_POINT), |&i| UM_PER_MM * error.total_rad[i] * moments[i].pitch.radius_mm[1])
            .column(of_side(&LONG_WAVE), |&i| ARCSEC_PER_RAD * error.long_wave_rad[i])
            .column(of_side(&MESH), |&i| ARCSEC_PER_RAD * error.mesh_rad[i])
            .column(of_side(&TOOTH_OF_A), |&i| rolled.tooth_of_a(acting(i).tooth))
            .column(of_side(&TOUCHING), |&i| touching(i))
            .column(of_side(&PAIRS), |&i| pairs[i]);
    }
    let play = &rolled.backlash;
    table = table
        .column(&PLAY_ANGLE, |&i| ARCSEC_PER_RAD * play[i].angle_rad)
        .column(&PLAY, |&i| UM_PER_MM * play[i].circumferential_mm)
        .column(&PLAY_TANGENTIAL, |&i| UM_PER_MM * play[i].tangential_mm);
    if rolled.fit.no_involutes().is_some() {
        return table.rows_in_file("rolling");
    }
    table
        .column(&GAP_RIGHT, |&i| UM_PER_MM * play[i].normal_right_mm)
        .column(&GAP_LEFT, |&i| UM_PER_MM * play[i].normal_left_mm)
        .rows_in_file("rolling")
}

/// One row for every flank of gear A.
pub(super) fn teeth(rolled: &RolledPair) -> Table {
    CONTACT_BY_TOOTH
        .table(rolled.teeth.iter().flatten())
        .column(&FLANK_OF_A, |of| format!("{} {}", of.tooth, of.side.name()))
        .column(&LOWEST_ON_A, |of| of.heights_mm[0][0])
        .column(&HIGHEST_ON_A, |of| of.heights_mm[0][1])
        .column(&LOWEST_ON_B, |of| of.heights_mm[1][0])
        .column(&HIGHEST_ON_B, |of| of.heights_mm[1][1])
        .column(&START_ON_A, |of| of.arcs_mm[0][0])
        .column(&END_ON_A, |of| of.arcs_mm[0][1])
        .column(&START_ON_B, |of| of.arcs_mm[1][0])
        .column(&END_ON_B, |of| of.arcs_mm[1][1])
        .column(&IN_CONTACT, |of| of.moments[0])
        .column(&FIRST, |of| of.moments[1])
        .rows_in_file("contact_by_tooth")
}

/// The centre distance in tight mesh.
pub(super) fn double_flank(key: &str, found: &DoubleFlank) -> Table {
    Table::over("variation", "Centre distance in tight mesh", &found.variation_rad_um)
        .column(&ANGLE, |[rad, _]| rad.to_degrees())
        .column(&VARIATION, |[_, um]| *um)
        .rows_in_file(&format!("double_flank_{key}"))
}
