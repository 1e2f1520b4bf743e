//! Tables as plain CSV, for spreadsheets and scripts.
//!
//! In: tables of the tree of findings, or a table by itself. Out: RFC 4180 files with one header line each, whose names
//! carry their units (`tooth`, `left_AB_mm`).
//!
//! Numbers are written with the fewest digits that read back to the same f64; a number that is not finite becomes an
//! empty cell, which spreadsheets and data frames both take as missing.
//!
//! Road not taken: comment lines with units and run record above the header. Spreadsheets show them as broken rows,
//! and the run record lies beside the table in `run.json`.

use std::io;
use std::path::Path;

use crate::findings::table::table_file;
use crate::findings::{Datum, Findings, Table, TableColumn};
use crate::output::atomic::write_atomically;
use crate::output::folder::OutputFolder;
use gearcut_core::{Error, Result};

/// Writes every table of the tree that has a file, if there is a folder.
///
/// # Errors
/// Files that cannot be written.
pub fn write_tables(findings: &Findings, folder: &OutputFolder) -> Result<()> {
    if folder.is_nowhere() {
        return Ok(());
    }
    let mut tables = Vec::new();
    findings.walk(&mut |_, section| tables.extend(&section.tables));
    for table in tables {
        if let Some(name) = &table.file {
            write_table(&folder.path(table_file(name))?, table)?;
        }
    }
    Ok(())
}

fn text(cell: &Datum) -> String {
    match cell {
        // Debug, not Display: it uses an exponent where that is shorter, and marks whole values as 1.0.
        Datum::Number(value) => format!("{value:?}"),
        other => other.name(),
    }
}

/// Writes a table, completely or not at all.
///
/// # Errors
/// Files that cannot be written.
pub fn write_table(path: &Path, table: &Table) -> Result<()> {
    write_atomically(path, |sink| {
        let mut file = csv::Writer::from_writer(sink);
        file.write_record(table.columns.iter().map(TableColumn::head)).map_err(reason)?;
        for row in table.rows() {
            file.write_record(row.iter().map(text)).map_err(reason)?;
        }
        file.flush()
    })
}

/// A table with the rows of its file below the folder of the results; as it is where its rows are in the tree.
///
/// # Errors
/// No such file; a file with other columns, or with a cell of another type.
pub fn with_rows(table: &Table, folder: &Path) -> Result<Table> {
    let Some(file) = table.file.as_deref().map(table_file).filter(|_| table.rows_in_file && table.is_empty()) else {
        return Ok(table.clone());
    };
    let path = folder.join(file);
    let text = std::fs::read(&path).map_err(Error::reading(&path))?;
    let unreadable = |reason: String| Error::Unreadable { path: path.clone(), reason };
    let mut reader = csv::Reader::from_reader(text.as_slice());
    let heads: Vec<String> = table.columns.iter().map(TableColumn::head).collect();
    let found = reader.headers().map_err(|reason| unreadable(reason.to_string()))?;
    if *found != heads {
        return Err(unreadable("its columns are not those that results.json names".to_owned()));
    }
    let records: Vec<csv::StringRecord> =
        reader.records().collect::<csv::Result<_>>().map_err(|reason| unreadable(reason.to_string()))?;
    let cells = table.cells.iter().enumerate().map(|(column, none)| {
        let full = records.iter().try_fold(none.clone(), |cells, record| cells.and_text(&record[column]));
        full.ok_or_else(|| unreadable(format!("a cell of {} is not of the column's type", heads[column])))
    });
    Ok(Table { cells: cells.collect::<Result<_>>()?, ..table.clone() })
}

/// The system's own reason where there is one: "no storage space" says more than a CSV error around it.
fn reason(failed: csv::Error) -> io::Error {
    io::Error::from(failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::{QuantityRow, TableCells};

    static TOOTH: QuantityRow = QuantityRow::new("tooth", "1", "number");
    static X: QuantityRow = QuantityRow::new("x", "mm", "a length");
    static NOTE: QuantityRow = QuantityRow::new("note", "", "words");

    fn written(table: &Table) -> String {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("table.csv");
        write_table(&path, table).expect("a good table");
        std::fs::read_to_string(path).expect("just written")
    }

    #[test]
    fn header_and_cells_are_plain_csv() {
        let rows = [(7_u32, 0.1, Some("left, upper")), (8, f64::NAN, None)];
        let table: Table = Table::over("made", "Made", rows)
            .column(&TOOTH, |row| row.0)
            .column(X.as_column().keyed("left_AB"), |row| row.1)
            .column(&NOTE, |row| row.2)
            .into();
        assert_eq!(written(&table), "tooth,left_AB_mm,note\n7,0.1,\"left, upper\"\n8,,\n");
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        let values = [0.1 + 0.2, 1e-300, -6.02214076e23, 5e-324, f64::MAX, 1.0, -0.0];
        let text = written(&Table::over("made", "Made", values).column(&X, |x| *x).into());
        let back: Vec<f64> = text.lines().skip(1).map(|line| line.parse().expect("a number")).collect();
        assert_eq!(back.map_bits(), values.map_bits());
    }

    trait Bits {
        fn map_bits(&self) -> Vec<u64>;
    }
    impl<T: AsRef<[f64]>> Bits for T {
        fn map_bits(&self) -> Vec<u64> {
            self.as_ref().iter().map(|x| x.to_bits()).collect()
        }
    }

    #[test]
    fn rows_of_a_file_come_back_and_foreign_ones_are_refused() {
        let folder = tempfile::tempdir().expect("a folder for the test");
        std::fs::create_dir(folder.path().join("tables")).expect("a folder");
        let path = folder.path().join("tables/rolling.csv");
        let rows = [(0.1, "flank"), (0.2, "7")];
        let table = Table::over("positions", "Positions", rows)
            .column(&X, |row| row.0)
            .column(&NOTE, |row| row.1)
            .rows_in_file("rolling");
        write_table(&path, &table).expect("a good table");
        let empty =
            Table { cells: vec![TableCells::Numbers(Vec::new()), TableCells::Words(Vec::new())], ..table.clone() };
        assert_eq!(with_rows(&empty, folder.path()).expect("its own file"), table);
        let refused = |why: &str| {
            let reason = with_rows(&empty, folder.path()).expect_err("a foreign file").to_string();
            assert!(reason.contains("rolling.csv") && reason.contains(why), "{reason}");
        };
        std::fs::write(&path, "x_mm,note\n0.1,flank\nnear,flank\n").expect("a file");
        refused("x_mm is not of the column's type");
        std::fs::write(&path, "x_um,note\n").expect("a file");
        refused("its columns are not those");
    }
}
