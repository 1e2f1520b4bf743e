//! Flanks and teeth side by side: `tables/flanks.csv`, `tables/teeth.csv`.
//!
//! In: the sections of operations and teeth. Their quantities become rows, so that every number is made once; the rows
//! stand in the files alone, since `results.json` has them in the sections.

use crate::findings::{Quantity, Section, Table, TableColumn};
use crate::process::shaping::measure::FlankReport;

/// Keys of columns, and where their quantities stand in the section of a finished flank.
const FORM: [(&str, &str); 3] =
    [("start_of_involute", "start_of_involute"), ("tip_height", "tip"), ("profile_length", "length")];
const MEASURED: [(&str, &str); 9] = [
    ("lowest", "smallest_height"),
    ("highest", "largest_height"),
    ("F_alpha", "profile.total"),
    ("f_f_alpha", "profile.form"),
    ("f_H_alpha", "profile.slope"),
    ("F_beta", "lead.total"),
    ("f_f_beta", "lead.form"),
    ("f_H_beta", "lead.slope"),
    ("largest_scallop", "largest_scallop"),
];
/// The same of a finished tooth.
const TOOTH: [(&str, &str); 8] = [
    ("thickness_arc", "thickness_arc"),
    ("thickness_chord", "thickness_chord"),
    ("tip_land", "tip_land"),
    ("left_single_pitch", "left.single_pitch"),
    ("left_cumulative_pitch", "left.cumulative_pitch"),
    ("right_single_pitch", "right.single_pitch"),
    ("right_cumulative_pitch", "right.cumulative_pitch"),
    ("runout_of_space_after", "runout_of_space_after"),
];

/// All flanks that were cut: what `earlier` operations left on them, and how they are finished.
pub fn flanks(cut: &[FlankReport], earlier: &[Section], teeth: &[Section]) -> Table {
    let names = vec![number_of_tooth(), TableColumn::words("flank", "flank: left or right")];
    let rows = cut.iter().map(|flank| {
        let (tooth, side) = (&teeth[flank.tooth as usize - 1], flank.side.name());
        let of = |section, picks: &[(&str, &str)]| {
            picks.iter().map(|(key, path)| ((*key).to_owned(), quantity(section, path))).collect::<Vec<_>>()
        };
        let finished = part(tooth, side);
        let mut row = of(finished, &FORM);
        for operation in earlier {
            let stock = part(operation, &format!("teeth.{}.{side}", tooth.key));
            row.extend(
                ["smallest", "largest", "mean"]
                    .map(|what| (format!("{}_{what}_stock", operation.key), quantity(stock, what))),
            );
        }
        row.extend(of(finished, &MEASURED));
        (vec![flank.tooth.into(), side.into()], row)
    });
    Table::of_quantities("flanks", "Finished flanks", names, rows).rows_in_file("flanks")
}

/// All teeth.
pub fn teeth(teeth: &[Section]) -> Table {
    let rows = (1_u32..).zip(teeth).map(|(number, tooth)| {
        (vec![number.into()], TOOTH.map(|(key, path)| (key.to_owned(), quantity(tooth, path))).into())
    });
    Table::of_quantities("all_teeth", "Finished teeth", vec![number_of_tooth()], rows).rows_in_file("teeth")
}

fn number_of_tooth() -> TableColumn {
    TableColumn::new("tooth", "1", "number of the tooth, from 1")
}

fn part<'a>(section: &'a Section, path: &str) -> &'a Section {
    section.find(path).expect("every tooth has a section")
}

fn quantity<'a>(section: &'a Section, path: &str) -> &'a Quantity {
    section.quantity(path).expect("what is not defined is there as well")
}
