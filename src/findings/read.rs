//! From `results.json` back to the tree.
//!
//! In: a document of the current schema version. Out: [`Findings`] equal to those that were written, or the path of
//! what does not fit and the reason.

use serde_json::{Map, Value};

use super::column::TableCells;
use super::datum::Datum;
use super::entry::{Advice, Entry};
use super::json::{CHARTS, LEVELS};
use super::notice::{Notice, Severity};
use super::quantity::Quantity;
use super::row::{Level, title_of};
use super::table::{Table, TableColumn, table_name};
use super::tree::{Findings, Section};

/// What reads a part, or why it cannot.
type Read<T> = Result<T, String>;

impl Findings {
    /// The findings of a document.
    ///
    /// # Errors
    /// In words: what is missing or does not belong there.
    pub fn from_json(document: &Value) -> Read<Self> {
        let all = object(document, "the document")?;
        let text = |key: &str| Ok::<_, String>(field(all, key)?.as_str().ok_or(format!("{key} is a text"))?.to_owned());
        let headline = object(field(all, "headline")?, "headline")?;
        let sections = object(field(all, "sections")?, "sections")?;
        Ok(Self {
            program_version: text("program_version")?,
            process: text("process")?,
            scene: text("scene")?,
            complete: field(all, "complete")?.as_bool().ok_or("complete is true or false")?,
            headline: headline.iter().map(|(key, value)| entry(key, value)).collect::<Read<_>>()?,
            warnings: list(all, "warnings")?.iter().map(warning).collect::<Read<_>>()?,
            sections: sections.iter().map(|(key, value)| section(key, value, key)).collect::<Read<_>>()?,
        })
    }
}

fn object<'a>(value: &'a Value, what: &str) -> Read<&'a Map<String, Value>> {
    value.as_object().ok_or_else(|| format!("{what} is an object"))
}

fn field<'a>(of: &'a Map<String, Value>, key: &str) -> Read<&'a Value> {
    of.get(key).ok_or_else(|| format!("missing field {key}"))
}

fn list<'a>(of: &'a Map<String, Value>, key: &str) -> Read<&'a Vec<Value>> {
    field(of, key)?.as_array().ok_or_else(|| format!("{key} is a list"))
}

fn warning(value: &Value) -> Read<Notice> {
    let all = object(value, "a warning")?;
    let text = |key: &str| field(all, key)?.as_str().ok_or_else(|| format!("a warning's {key} is a text"));
    let name = text("severity")?;
    let severity = Severity::ALL.into_iter().find(|severity| severity.name() == name);
    let severity = severity.ok_or_else(|| format!("there is no severity {name}"))?;
    let section = all.get("section").and_then(Value::as_str).map(str::to_owned);
    Ok(Notice { section, ..Notice::new(text("id")?.to_owned(), severity, text("text")?) })
}

fn entry(key: &str, value: &Value) -> Read<Entry> {
    let text = |key: &str| value.get(key).and_then(Value::as_str);
    let level = match text("level") {
        None => Level::Detail,
        Some(name) => LEVELS.iter().find(|level| level.1 == name).ok_or(format!("{key}: there is no level {name}"))?.0,
    };
    let quantity: Quantity = serde_json::from_value(value.clone()).map_err(|reason| format!("{key}: {reason}"))?;
    let advice = |of: &Value| {
        let (text, change) = of.get("text").and_then(Value::as_str).zip(of.get("change").and_then(Value::as_bool))?;
        Some(Advice { text: text.to_owned(), change })
    };
    Ok(Entry {
        advice: value.get("advice").and_then(advice),
        key: key.to_owned(),
        title: text("title").map_or_else(|| title_of(key), str::to_owned),
        level,
        quantity,
    })
}

/// The section of this key; `path` names it in messages.
fn section(key: &str, value: &Value, path: &str) -> Read<Section> {
    let all = object(value, path)?;
    let title = field(all, "$title").map_err(|reason| format!("{path}: {reason}"))?;
    let mut section = Section::new(key, title.as_str().ok_or(format!("{path}.$title is a text"))?);
    for (key, value) in all.iter().filter(|(key, _)| !key.starts_with('$')) {
        let path = format!("{path}.{key}");
        if value.get("definition").is_some_and(Value::is_string) {
            section.entries.push(entry(key, value).map_err(|reason| format!("{path}: {reason}"))?);
        } else if value.get("columns").is_some_and(Value::is_array) {
            section.tables.push(table(key, value).map_err(|reason| format!("{path}: {reason}"))?);
        } else {
            section.sections.push(self::section(key, value, &path)?);
        }
    }
    Ok(section)
}

fn table(key: &str, value: &Value) -> Read<Table> {
    let all = object(value, key)?;
    let title = field(all, "title")?.as_str().ok_or("title is a text")?;
    let columns: Vec<TableColumn> = list(all, "columns")?.iter().map(column).collect::<Read<_>>()?;
    let rows = list(all, "rows")?.iter().map(|row| {
        let cells = row.as_array().filter(|row| row.len() == columns.len()).ok_or("a row has a cell per column")?;
        cells.iter().map(Datum::from_json).collect::<Read<Vec<_>>>()
    });
    let rows = rows.collect::<Read<Vec<_>>>()?;
    let cells = list(all, "columns")?.iter().enumerate().map(|(index, column)| {
        let none = column.get("type").and_then(Value::as_str).and_then(TableCells::of_type);
        let none = none.ok_or("the type of a column is number, count or word")?;
        let full = rows.iter().try_fold(none, |cells, row| cells.and(&row[index]));
        full.ok_or_else(|| format!("a cell of {} is not of its type", columns[index].key))
    });
    let cells = cells.collect::<Read<_>>()?;
    let mut table = Table { columns, cells, ..Table::new(key, title) };
    table.period_rows = all.get("period_rows").and_then(Value::as_u64).and_then(|rows| rows.try_into().ok());
    let file = all.get("file").and_then(Value::as_str);
    table.file = file.map(|file| table_name(file).to_owned());
    table.rows_in_file = all.get("rows_in_file").and_then(Value::as_bool).unwrap_or(false);
    Ok(table)
}

fn column(value: &Value) -> Read<TableColumn> {
    let all = object(value, "a column")?;
    let text = |key: &str| all.get(key).and_then(Value::as_str).map(str::to_owned);
    let key = text("key").ok_or("a column has a key")?;
    Ok(TableColumn {
        title: text("title").unwrap_or_else(|| title_of(&key)).into(),
        key: key.into(),
        unit: text("unit").map(Into::into),
        definition: text("definition").ok_or("a column has a definition")?.into(),
        why: text("why").map(Into::into),
        chart: CHARTS.iter().find(|(_, name)| all.get("chart").is_some_and(|own| own == name)).map(|(chart, _)| *chart),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::{Place, QuantityRow};

    const NOTHING: &str = "it takes nothing";
    static STOCK: QuantityRow =
        QuantityRow::new("smallest_stock", "mm", "smallest stock").titled("smallest normal stock");
    static BACKEND: QuantityRow = QuantityRow::new("backend", "", "backend").titled("computed by");
    static TOOTH: QuantityRow = QuantityRow::new("tooth", "", "hob tooth");
    static VOLUME: QuantityRow = QuantityRow::new("volume", "mm^3", "volume that it takes").or(&[NOTHING]).bars();
    static STROKE: QuantityRow = QuantityRow::new("stroke", "1", "stroke");
    static STROKES: QuantityRow = QuantityRow::new("strokes", "strokes", "strokes made");
    static IDLE: QuantityRow = QuantityRow::new("idle_time", "s", "time").titled("time without a cut").shown();
    static RATIO: QuantityRow = QuantityRow::new("ratio", "1", "share").or(&[NOTHING]);

    fn findings() -> Findings {
        let teeth = [("B7", 0.25), ("8", f64::NAN)];
        let mut table = Table::over("teeth", "Hob teeth", teeth)
            .column(&TOOTH, |of| of.0)
            .column(&VOLUME, |of| of.1)
            .in_file("teeth");
        table.period_rows = Some(1);
        let many =
            Table::over("chips", "Chips", Vec::<u32>::new()).column(&STROKE, |of| *of).rows_in_file("chips_rough");
        let rough = Section::new("rough", "Rough")
            .entries([STROKES.of(4200_u32), IDLE.of(2.5)])
            .table(table)
            .table(many)
            .part(Section::new("relief", "Relief").entries([RATIO.none(NOTHING)]));
        let headline = [STOCK.of(0.1 + 0.2).at(Place::on_flank(7, "left", 1.5, 12.0)), BACKEND.of("cpu")];
        let warnings = [
            Notice::new("flank.made", Severity::Fault, "made by hand"),
            Notice::new("texture.few_marks", Severity::Note, "few strokes").about("operations.rough"),
        ];
        let sections = vec![Section::new("operations", "Operations").part(rough)];
        let found = Findings::new("shaping", "made_by_hand", true, headline, warnings, sections);
        Findings { program_version: "0.1.0".to_owned(), ..found }
    }

    #[test]
    fn findings_come_back_as_they_were() {
        let findings = findings();
        let text = serde_json::to_string(&findings.to_json()).expect("JSON");
        assert!(text.starts_with(r#"{"schema_version":4,"program":"gearcut","program_version":"0.1.0","process":"#));
        let back = Findings::from_json(&serde_json::from_str(&text).expect("JSON")).expect("its own document");
        assert_eq!(back, findings);
    }

    #[test]
    fn paths_lead_to_sections_and_quantities() {
        let findings = findings();
        let operations = findings.at_path("operations").expect("a section");
        assert_eq!(operations.number("rough.strokes"), Some(4200.0));
        assert_eq!(operations.number("rough.relief.ratio"), None);
        assert!(
            findings.at_path("operations.rough.relief").is_some() && findings.at_path("operations.finish").is_none()
        );
        let teeth = findings.at_path("operations.rough").and_then(|rough| rough.table_at("teeth")).expect("a table");
        assert_eq!(teeth.values(&VOLUME).collect::<Vec<_>>(), [Some(0.25), None]);
        let document = findings.to_json();
        assert_eq!(document["sections"]["operations"]["rough"]["strokes"]["value"], 4200);
        assert_eq!(document["headline"]["smallest_stock"]["place"]["tooth"], 7);
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let findings = findings();
        let mut document = findings.to_json();
        document["sections"]["operations"]["rough"]["idle_time"]["value"] = Value::Null;
        let reason = Findings::from_json(&document).expect_err("null without a reason");
        assert!(reason.contains("operations.rough.idle_time") && reason.contains("why"), "{reason}");
        let mut document = findings.to_json();
        document["sections"]["operations"]["rough"]["teeth"]["rows"][0][1] = "much".into();
        let reason = Findings::from_json(&document).expect_err("a word among numbers");
        assert!(reason.contains("operations.rough.teeth: a cell of volume is not of its type"), "{reason}");
        let mut document = findings.to_json();
        document["warnings"][0]["severity"] = "grave".into();
        let reason = Findings::from_json(&document).expect_err("an unknown severity");
        assert!(reason.contains("there is no severity grave"), "{reason}");
        let reason = Findings::from_json(&serde_json::json!({"headline": {}})).expect_err("not a result");
        assert!(reason.contains("missing field"), "{reason}");
    }
}
