//! Tables as plain CSV, for spreadsheets and scripts.
//!
//! In: the tree of findings, or column names that carry their units (`tooth`, `left_AB_mm`) and rows. Out: RFC 4180
//! files with one header line each.
//!
//! Numbers are written with the fewest digits that read back to the same f64; a number that is not finite becomes an
//! empty cell, which spreadsheets and data frames both take as missing.
//!
//! Road not taken: comment lines with units and run record above the header. Spreadsheets show them as broken rows,
//! and the run record lies beside the table in `run.json`.

use std::borrow::Borrow;
use std::io;
use std::path::Path;

use crate::findings::{Datum, Findings, Table, TableColumn};
use crate::output::atomic::write_atomically;
use crate::output::folder::OutputFolder;
use gearcut_core::{Error, Result};

/// Writes every table of the tree that has a file.
///
/// # Errors
/// Files that cannot be written.
pub fn write_tables(findings: &Findings, folder: &OutputFolder) -> Result<()> {
    let mut tables = Vec::new();
    findings.walk(&mut |_, section| tables.extend(&section.tables));
    for table in tables {
        let Some(file) = &table.file else { continue };
        let columns: Vec<String> = table.columns.iter().map(TableColumn::head).collect();
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        write_table(&folder.path(file)?, &columns, &table.rows)?;
    }
    Ok(())
}

fn text(cell: &Datum) -> String {
    match cell {
        // Debug, not Display: it uses an exponent where that is shorter, and marks whole values as 1.0.
        Datum::Number(value) if value.is_finite() => format!("{value:?}"),
        Datum::Count(count) => count.to_string(),
        Datum::Word(word) => word.clone(),
        Datum::Number(_) | Datum::Undefined => String::new(),
    }
}

/// Writes a table, row by row as they come, completely or not at all.
///
/// # Errors
/// A row with more or fewer cells than there are columns, and files that cannot be written.
pub fn write_table<Row>(path: &Path, columns: &[&str], rows: impl IntoIterator<Item = Row>) -> Result<()>
where
    Row: IntoIterator,
    Row::Item: Borrow<Datum>,
{
    write_atomically(path, |sink| {
        let mut table = csv::Writer::from_writer(sink);
        table.write_record(columns).map_err(reason)?;
        for row in rows {
            table.write_record(row.into_iter().map(|cell| text(cell.borrow()))).map_err(reason)?;
        }
        table.flush()
    })
}

/// Rows of a table that stand in its file below the folder of the results; those of the tree where it has no file.
///
/// # Errors
/// No such file; a file whose columns are not those of the table.
pub fn rows(table: &Table, folder: &Path) -> Result<Vec<Vec<Datum>>> {
    let Some(file) = table.file.as_ref().filter(|_| table.rows_in_file && table.rows.is_empty()) else {
        return Ok(table.rows.clone());
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
    let cell = |text: &str| match text.parse() {
        Ok(number) => Datum::Number(number),
        Err(_) if text.is_empty() => Datum::Undefined,
        Err(_) => Datum::Word(text.to_owned()),
    };
    let row = |record: csv::Result<csv::StringRecord>| {
        Ok(record.map_err(|reason| unreadable(reason.to_string()))?.iter().map(cell).collect())
    };
    reader.records().map(row).collect()
}

/// The system's own reason where there is one: "no storage space" says more than a CSV error around it.
fn reason(failed: csv::Error) -> io::Error {
    io::Error::from(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(columns: &[&str], rows: Vec<Vec<Datum>>) -> Result<String> {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("table.csv");
        write_table(&path, columns, rows)?;
        Ok(std::fs::read_to_string(path).expect("just written"))
    }

    #[test]
    fn header_and_cells_are_plain_csv() {
        let rows = vec![
            vec![7_u32.into(), 0.1.into(), "left, upper".into()],
            vec![8_u32.into(), f64::NAN.into(), Datum::Undefined],
        ];
        let text = written(&["tooth", "left_AB_mm", "note"], rows).expect("a good table");
        assert_eq!(text, "tooth,left_AB_mm,note\n7,0.1,\"left, upper\"\n8,,\n");
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        let values = [0.1 + 0.2, 1e-300, -6.02214076e23, 5e-324, f64::MAX, 1.0, -0.0];
        let text = written(&["x_mm"], values.iter().map(|&x| vec![x.into()]).collect()).expect("a good table");
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
        let columns = vec![TableColumn::new("angle", "deg", "angle"), TableColumn::words("touching", "what touches")];
        let rows_made = vec![vec![0.1.into(), "flank".into()], vec![0.2.into(), Datum::Undefined]];
        let table = Table::new("positions", "Positions", columns).with_rows(rows_made.clone()).rows_in_file("rolling");
        let path = folder.path().join("tables/rolling.csv");
        std::fs::create_dir(folder.path().join("tables")).expect("a folder");
        write_table(&path, &["angle_deg", "touching"], &table.rows).expect("a good table");
        let read = Table { rows: Vec::new(), ..table };
        assert_eq!(rows(&read, folder.path()).expect("its own file"), rows_made);
        write_table(&path, &["angle_rad", "touching"], &rows_made).expect("a good table");
        assert!(rows(&read, folder.path()).is_err_and(|reason| reason.to_string().contains("rolling.csv")));
    }

    #[test]
    fn a_row_of_the_wrong_length_is_refused() {
        let outcome = written(&["tooth", "x_mm"], vec![vec![7_u32.into()]]);
        let message = outcome.expect_err("one cell is missing").to_string();
        assert!(message.contains("table.csv") && message.contains("fields"), "{message}");
    }
}
