//! Tables of a cut bevel gear: flanks, points of inspection, the slot, blades.

use super::{TRACE, UNTOUCHED};
use crate::findings::{Datum, Section, Table, TableColumn};
use crate::process::bevel::gear::BevelGear;
use crate::process::bevel::job::BevelJob;
use crate::process::bevel::measure::FlankHeights;
use gearcut_core::bevel::face_mill::FaceMill;
use gearcut_core::units::UM_PER_MM;

/// Every flank: what rough cuts left, deviations, traces.
pub(super) fn flanks(job: &BevelJob, gear: &BevelGear) -> Table {
    let um = |key: &'static str, definition: &'static str, why: &'static str| {
        TableColumn::new(key, "um", definition).or(why)
    };
    let mut columns = vec![
        TableColumn::new("tooth", "1", "number of the tooth, from 1"),
        TableColumn::words("flank", "flank: left or right"),
        TableColumn::words("blades", "blades that cut it: outside or inside"),
        TableColumn::new("profile_length", "mm", "length of the profile in the middle of the face"),
    ];
    for operation in &job.operations[..job.operations.len() - 1] {
        let key = format!("{}_mean_stock", operation.spec.name);
        columns.push(TableColumn::new(key, "mm", "mean stock over the finished surface").or(UNTOUCHED));
    }
    columns.extend([
        um("lowest", "lowest normal deviation", UNTOUCHED),
        um("highest", "highest normal deviation", UNTOUCHED),
        um("mean", "mean normal deviation", UNTOUCHED),
        um("rms", "root mean square about the mean", UNTOUCHED),
        um("profile_total", "range along the profile in the middle of the face", TRACE),
        um("lead_total", "range along the tooth in the middle of the profile", TRACE),
    ]);
    let rows = gear.flanks.iter().map(|flank| {
        let mut row: Vec<Datum> = vec![
            flank.tooth.into(),
            flank.side.name().into(),
            job.kind_of(flank.side).name().into(),
            flank.length_mm.into(),
        ];
        row.extend(flank.own.stock.iter().map(|stock| Datum::from(stock.map(|stock| stock.mean_mm))));
        let height = |of: fn(&FlankHeights) -> f64| Datum::from(flank.own.finished.as_ref().map(|h| of(h) * UM_PER_MM));
        row.extend([height(|h| h.range_mm[0]), height(|h| h.range_mm[1]), height(|h| h.mean_mm), height(|h| h.rms_mm)]);
        row.extend([&flank.profile, &flank.lead].map(|d| Datum::from(d.as_ref().map(|d| d.total_mm * UM_PER_MM))));
        row
    });
    Table::new("flanks", "Finished flanks", columns).with_rows(rows).in_file("flanks")
}

/// Points, normals and deviations as coordinate measuring machines take them.
pub(super) fn grid(job: &BevelJob, gear: &BevelGear) -> Table {
    let axis = |key: &'static str, definition: &'static str| TableColumn::new(key, "mm", definition);
    let normal = |key: &'static str| TableColumn::new(key, "1", "component of the unit normal out of the material");
    let columns = vec![
        TableColumn::new("tooth", "1", "number of the tooth, from 1"),
        TableColumn::words("flank", "flank: left or right"),
        TableColumn::new("column", "1", "place along the profile, 1 at the root, the last one at the tip"),
        TableColumn::new("row", "1", "place along the tooth, 1 at the toe, the last one at the heel"),
        axis("x", "nominal point, gear frame: origin in the apex, x through the middle of space 0"),
        axis("y", "nominal point, gear frame"),
        axis("z", "nominal point, gear frame: along the axis from the back to the apex"),
        normal("nx"),
        normal("ny"),
        normal("nz"),
        TableColumn::new("deviation", "um", "normal deviation, positive where material is left")
            .or("no pass reached the point"),
    ];
    let rows = gear.flanks.iter().flat_map(|flank| {
        flank.own.grid.iter().map(|point| {
            let mut row: Vec<Datum> =
                vec![flank.tooth.into(), flank.side.name().into(), point.place[0].into(), point.place[1].into()];
            row.extend(point.target.origin_mm.to_array().map(Datum::from));
            row.extend(point.target.normal.to_array().map(Datum::from));
            row.push(Datum::from(point.deviation_mm.map(|mm| mm * UM_PER_MM)));
            row
        })
    });
    let [along_profile, along_tooth] = job.spec.grid;
    let title = format!("Points of inspection, {along_profile} by {along_tooth} on every flank");
    Table::new("grid", &title, columns).with_rows(rows).rows_in_file("grid")
}

/// The slot behind tooth 1 along the face.
pub(super) fn slot(gear: &BevelGear) -> Section {
    let columns = vec![
        TableColumn::new("along", "mm", "place along the tooth from the middle of the face, towards the heel"),
        TableColumn::new("width", "mm", "width of the slot on the circle of the pitch cone").or(TRACE),
        TableColumn::new("depth", "mm", "depth from the face cone, square to the pitch cone").or(TRACE),
        TableColumn::new("whole_depth", "mm", "addendum and dedendum of the blank"),
    ];
    let rows = gear
        .slot
        .iter()
        .map(|row| vec![row.along_mm.into(), row.width_mm.into(), row.depth_mm.into(), row.whole_depth_mm.into()]);
    let table = Table::new("along_the_face", "Slot behind tooth 1 along the face", columns).with_rows(rows);
    Section::new("slot", "Slot").table(table.in_file("slot"))
}

/// How much of the flanks each blade has left.
pub(super) fn blades(job: &BevelJob, gear: &BevelGear) -> Section {
    let columns = vec![
        TableColumn::new("blade", "1", "number of the blade, from 0"),
        TableColumn::words("kind", "outside or inside"),
        TableColumn::new("runout", "um", "how far it stands out in radius"),
        TableColumn::new("share", "%", "share of all flanks that it has left last").as_bars(),
    ];
    let all: u64 = gear.flanks.iter().flat_map(|flank| &flank.own.left_by_blade).sum();
    let rows = (0..job.head.blades()).map(|blade| {
        let own: u64 = gear.flanks.iter().map(|flank| flank.own.left_by_blade[blade as usize]).sum();
        vec![
            Datum::from(blade),
            FaceMill::kind_of(blade).name().into(),
            (job.head.runouts_mm[blade as usize] * UM_PER_MM).into(),
            (100.0 * own as f64 / all.max(1) as f64).into(),
        ]
    });
    let table = Table::new("blades", "Flanks by blade", columns).with_rows(rows).in_file("blades");
    Section::new("blades", "Blades").table(table)
}
