//! The tables of a pair: every position, every tooth, the centre distance in tight mesh.

use super::ARCSEC_PER_RAD;
use crate::findings::{Datum, Table, TableColumn};
use crate::pair_job::double_flank::DoubleFlank;
use crate::pair_job::fit::SIDES;
use crate::pair_job::rolled::RolledPair;
use crate::pair_job::teeth::{ToothContact, edge};
use gearcut_core::units::UM_PER_MM;

/// One row for every position of the period.
pub(super) fn rolling(rolled: &RolledPair) -> Table {
    let column = |key: String, unit, definition| TableColumn::new(key, unit, definition);
    let mut columns = vec![
        TableColumn::new("angle_of_A", "deg", "angle of gear A"),
        TableColumn::new("angle_of_B", "deg", "angle of gear B that the pitch curves ask for"),
        TableColumn::new("ratio_asked_for", "1", "r2 / r1"),
        TableColumn::new(
            "ratio_achieved",
            "1",
            "ratio of the speeds by the driving flanks, between neighbouring positions",
        ),
    ];
    for side in SIDES {
        let key = |name: &str| format!("{name}_{}", side.name());
        columns.extend([
            column(
                key("transmission_error"),
                "arcsec",
                "rotation of B beyond the one asked for when this side touches",
            )
            .as_curve(),
            column(key("transmission_error_at_pitch_point"), "um", "the same times r2, across the line of centres"),
            column(key("long_wave"), "arcsec", "its waves longer than two teeth"),
            column(key("mesh"), "arcsec", "the rest of it"),
            column(key("tooth_of_A"), "1", "tooth of A that touches first"),
            TableColumn { unit: None, ..column(key("touching"), "1", "flank, or a tip corner or fillet of A or B") },
            column(key("pairs"), "1", "pairs of flanks within the marking thickness"),
        ]);
    }
    columns.extend([
        TableColumn::new("backlash_angle", "arcsec", "play of B while A is held"),
        TableColumn::new("backlash_circumferential", "um", "play across the line of centres at the pitch point")
            .as_curve(),
        TableColumn::new("backlash_along_pitch_curves", "um", "play along the pitch curves"),
        TableColumn::new(
            "backlash_normal_right",
            "um",
            "gap of the right flanks while the left ones touch, along their normal",
        ),
        TableColumn::new(
            "backlash_normal_left",
            "um",
            "gap of the left flanks while the right ones touch, along their normal",
        ),
    ]);
    let rows = rolled.period.moments.iter().enumerate().map(|(i, moment)| {
        let pitch = &moment.pitch;
        let mut row: Vec<Datum> = [pitch.phi_1_rad.to_degrees(), pitch.phi_2_rad.to_degrees()].map(Datum::from).into();
        row.extend(rolled.ratios[i].map(Datum::from));
        for (at, side) in SIDES.into_iter().enumerate() {
            let (touch, error) = (moment.side(side), &rolled.errors[at]);
            let arcsec = |rad: f64| Datum::from(ARCSEC_PER_RAD * rad);
            row.extend([
                arcsec(error.total_rad[i]),
                Datum::from(UM_PER_MM * error.total_rad[i] * pitch.radius_mm[1]),
                arcsec(error.long_wave_rad[i]),
                arcsec(error.mesh_rad[i]),
                Datum::from(rolled.tooth_of_a(touch.acting.tooth)),
                Datum::from(edge(&rolled.flanks, side, &touch.acting).map_or("flank", |edge| edge.name())),
                Datum::from(u64::from(rolled.pairs[at][i])),
            ]);
        }
        let play = &rolled.backlash[i];
        row.push(Datum::from(ARCSEC_PER_RAD * play.angle_rad));
        let lengths_mm = [play.circumferential_mm, play.tangential_mm, play.normal_right_mm, play.normal_left_mm];
        row.extend(lengths_mm.map(|mm| Datum::from(UM_PER_MM * mm)));
        row
    });
    Table::new("positions", "Every position of a period", columns).with_rows(rows).rows_in_file("rolling")
}

/// One row for every flank of gear A.
pub(super) fn teeth(rolled: &RolledPair) -> Table {
    let nominal = "nominal flanks have no form point";
    let columns = vec![
        TableColumn::words("flank", "tooth and flank of gear A"),
        TableColumn::new("lowest_on_A", "mm", "lowest contact over the pitch curve of A"),
        TableColumn::new("highest_on_A", "mm", "highest contact over the pitch curve of A"),
        TableColumn::new("lowest_on_B", "mm", "lowest contact over the pitch curve of B"),
        TableColumn::new("highest_on_B", "mm", "highest contact over the pitch curve of B"),
        TableColumn::new("start_arc_on_A", "mm", "lowest contact on A, arc from the form point; below 0 in the fillet")
            .or(nominal),
        TableColumn::new("end_arc_on_A", "mm", "highest contact on A, arc from the form point").or(nominal),
        TableColumn::new("start_arc_on_B", "mm", "lowest contact on B, arc from the form point; below 0 in the fillet")
            .or(nominal),
        TableColumn::new("end_arc_on_B", "mm", "highest contact on B, arc from the form point").or(nominal),
        TableColumn::new("positions_in_contact", "1", "positions at which it is within the marking thickness"),
        TableColumn::new("positions_first", "1", "positions at which it touches first"),
    ];
    let row = |contact: &ToothContact| {
        let mut row = vec![Datum::Word(format!("{} {}", contact.tooth, contact.side.name()))];
        row.extend(contact.heights_mm.iter().chain(&contact.arcs_mm).flatten().map(|mm| Datum::from(*mm)));
        row.extend(contact.moments.map(|count| Datum::from(u64::from(count))));
        row
    };
    let rows = rolled.teeth.iter().flatten().map(row);
    Table::new("teeth", "Where contact begins and ends on every flank of A", columns)
        .with_rows(rows)
        .rows_in_file("contact_by_tooth")
}

/// The centre distance in tight mesh.
pub(super) fn double_flank(key: &str, found: &DoubleFlank) -> Table {
    let columns = vec![
        TableColumn::new("angle", "deg", "angle of gear A with its mate; polar angle of the gear with a master"),
        TableColumn::new("variation", "um", "tight less nominal centre distance"),
    ];
    let rows = found.variation_rad_um.iter().map(|[rad, um]| vec![rad.to_degrees().into(), (*um).into()]);
    Table::new("variation", "Centre distance in tight mesh", columns)
        .with_rows(rows)
        .rows_in_file(&format!("double_flank_{key}"))
}
