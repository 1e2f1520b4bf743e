//! DXF of release 2000 in ASCII: polylines with bulges, circles, named layers, units in the head.
//!
//! In: a [`Drawing`], a unit of length. Out: the text of the file.
//!
//! Release 2000 (`AC1015`) is the oldest one with `LWPOLYLINE`, and everything that reads DXF reads it. It wants tables
//! and a dictionary that nobody looks at, each record with a handle of its own and that of its owner. Tolerance, frame
//! and layers are comments (group 999), which readers skip.
//!
//! Road not taken: the crate `dxf`. It brings `image`, `chrono` and `uuid`, and puts the time and a random id into each
//! file: the same scene would no longer give the same bytes.

use super::arcs::ArcPath;
use super::drawing::{Drawing, DrawingLayer};
use super::section::SectionCurve;
use super::unit::{FileUnit, fixed};
use glam::DVec2;
use std::fmt::{Display, Write as _};

/// Digits of a bulge: a chord of 100 mm is then bent to a nanometre.
const BULGE_DIGITS: usize = 11;
/// Red and black of the colour index: centre lines, and all others.
const COLOURS: [u8; 2] = [1, 7];
/// A first handle beyond all that a file has.
const HANDLE_SEED: &str = "FFFFFF";

/// Group codes and values, with handles as they come.
#[derive(Default)]
struct GroupWriter {
    text: String,
    handles: u32,
}

impl GroupWriter {
    fn group(&mut self, code: u16, value: impl Display) {
        let _ = writeln!(self.text, "{code:>3}\n{value}");
    }

    fn groups(&mut self, groups: &[(u16, &str)]) {
        for (code, value) in groups {
            self.group(*code, value);
        }
    }

    fn handle(&mut self) -> String {
        self.handles += 1;
        format!("{:X}", self.handles)
    }

    /// A record of a table or an entity with a new handle, which is given back.
    fn record(&mut self, kind: &str, owner: &str, classes: &[&str]) -> String {
        let handle = self.handle();
        self.groups(&[(0, kind), (if kind == "DIMSTYLE" { 105 } else { 5 }, &handle), (330, owner)]);
        for class in classes {
            self.group(100, class);
        }
        handle
    }

    /// A table and its records, each with a name and what else it says; gives the records' handles.
    fn table(&mut self, name: &str, class: &str, records: &[(String, Vec<(u16, String)>)]) -> Vec<String> {
        let table = self.handle();
        self.groups(&[(0, "TABLE"), (2, name), (5, &table), (330, "0"), (100, "AcDbSymbolTable")]);
        self.group(70, records.len());
        if name == "DIMSTYLE" {
            self.group(100, "AcDbDimStyleTable");
        }
        let mut handles = Vec::new();
        for (entry, more) in records {
            handles.push(self.record(name, &table, &["AcDbSymbolTableRecord", class]));
            self.group(2, entry);
            for (code, value) in more {
                self.group(*code, value);
            }
        }
        self.group(0, "ENDTAB");
        handles
    }

    fn section(&mut self, name: &str, fill: impl FnOnce(&mut Self)) {
        self.groups(&[(0, "SECTION"), (2, name)]);
        fill(self);
        self.group(0, "ENDSEC");
    }
}

/// The drawing as a file.
pub fn dxf(drawing: &Drawing, unit: FileUnit) -> String {
    let mut file = GroupWriter::default();
    let program = format!("gearcut {}", env!("CARGO_PKG_VERSION"));
    let lengths = format!("lengths in {}", unit.word());
    for note in [&program].into_iter().chain(&drawing.notes).chain([&lengths]) {
        file.group(999, ascii(note));
    }
    for layer in &drawing.layers {
        file.group(999, ascii(&format!("layer {}: {}", layer.name, layer.words)));
    }
    file.section("HEADER", |file| header(file, drawing, unit));
    file.section("CLASSES", |_| ());
    let mut model = String::new();
    file.section("TABLES", |file| model = tables(file, drawing, unit));
    file.section("BLOCKS", |file| blocks(file, &model));
    file.section("ENTITIES", |file| {
        for layer in &drawing.layers {
            entity(file, layer, &model, unit);
        }
    });
    file.section("OBJECTS", |file| {
        let root = file.record("DICTIONARY", "0", &["AcDbDictionary"]);
        let groups = format!("{:X}", file.handles + 1);
        file.groups(&[(281, "1"), (3, "ACAD_GROUP"), (350, &groups)]);
        file.record("DICTIONARY", &root, &["AcDbDictionary"]);
        file.group(281, "1");
    });
    file.group(0, "EOF");
    file.text
}

fn header(file: &mut GroupWriter, drawing: &Drawing, unit: FileUnit) {
    let [units, measurement] = match unit {
        FileUnit::Millimetre => ["4", "1"],
        FileUnit::Inch => ["1", "0"],
    };
    let variables = [
        ("$ACADVER", 1, "AC1015"),
        ("$DWGCODEPAGE", 3, "ANSI_1252"),
        ("$HANDSEED", 5, HANDLE_SEED),
        ("$INSUNITS", 70, units),
        ("$MEASUREMENT", 70, measurement),
        ("$LUPREC", 70, "6"),
    ];
    for (name, code, value) in variables {
        file.groups(&[(9, name), (code, value)]);
    }
    for (name, corner) in ["$EXTMIN", "$EXTMAX"].into_iter().zip(drawing.bounds_mm()) {
        file.group(9, name);
        place(file, corner, unit);
        file.group(30, 0);
    }
}

/// Tables that every file must have, with our layers; gives the handle of the model space.
fn tables(file: &mut GroupWriter, drawing: &Drawing, unit: FileUnit) -> String {
    let named = |name: &str, more: &[(u16, &str)]| {
        (name.to_owned(), more.iter().map(|(code, value)| (*code, (*value).to_owned())).collect::<Vec<_>>())
    };
    let [low, high] = drawing.bounds_mm();
    let middle = 0.5 * (low + high);
    let view = [
        (70, "0".to_owned()),
        (12, unit.shown(middle.x)),
        (22, unit.shown(middle.y)),
        (40, unit.shown(1.05 * (high.y - low.y))),
        (41, "1.5".to_owned()),
    ];
    file.table("VPORT", "AcDbViewportTableRecord", &[("*Active".to_owned(), view.to_vec())]);
    let line = |name, words| named(name, &[(70, "0"), (3, words), (72, "65"), (73, "0"), (40, "0")]);
    // Lengths of dashes and gaps, mm: long, gap, short, gap.
    let dashes = [10.0, -2.0, 1.0, -2.0];
    let mut centre = named("CENTER", &[(70, "0"), (3, "____ _ ____ _ ____"), (72, "65"), (73, "4")]);
    centre.1.push((40, unit.shown(dashes.iter().map(|dash: &f64| dash.abs()).sum())));
    centre.1.extend(dashes.iter().flat_map(|&dash| [(49, unit.shown(dash)), (74, "0".to_owned())]));
    let lines = [line("ByBlock", ""), line("ByLayer", ""), line("Continuous", "Solid line"), centre];
    file.table("LTYPE", "AcDbLinetypeTableRecord", &lines);
    let layer = |name: &str, is_centre_line: bool| {
        let colour = COLOURS[usize::from(!is_centre_line)].to_string();
        let line = if is_centre_line { "CENTER" } else { "Continuous" };
        named(name, &[(70, "0"), (62, &colour), (6, line)])
    };
    let own = drawing.layers.iter().map(|of| layer(of.name, of.is_centre_line));
    let layers: Vec<_> = [layer("0", false)].into_iter().chain(own).collect();
    file.table("LAYER", "AcDbLayerTableRecord", &layers);
    let style = [(70, "0"), (40, "0"), (41, "1"), (50, "0"), (71, "0"), (42, "1"), (3, "txt"), (4, "")];
    file.table("STYLE", "AcDbTextStyleTableRecord", &[named("Standard", &style)]);
    file.table("VIEW", "AcDbViewTableRecord", &[]);
    file.table("UCS", "AcDbUCSTableRecord", &[]);
    file.table("APPID", "AcDbRegAppTableRecord", &[named("ACAD", &[(70, "0")])]);
    file.table("DIMSTYLE", "AcDbDimStyleTableRecord", &[named("Standard", &[(70, "0")])]);
    let spaces = ["*Model_Space", "*Paper_Space"].map(|name| named(name, &[]));
    file.table("BLOCK_RECORD", "AcDbBlockTableRecord", &spaces).swap_remove(0)
}

fn blocks(file: &mut GroupWriter, model: &str) {
    // The record of the paper space was written right after that of the model space.
    let paper = format!("{:X}", u32::from_str_radix(model, 16).unwrap_or_default() + 1);
    for (name, owner) in [("*Model_Space", model), ("*Paper_Space", &paper)] {
        file.record("BLOCK", owner, &["AcDbEntity"]);
        file.groups(&[(8, "0"), (100, "AcDbBlockBegin"), (2, name), (70, "0"), (10, "0"), (20, "0"), (30, "0")]);
        file.groups(&[(3, name), (1, "")]);
        file.record("ENDBLK", owner, &["AcDbEntity"]);
        file.groups(&[(8, "0"), (100, "AcDbBlockEnd")]);
    }
}

fn entity(file: &mut GroupWriter, layer: &DrawingLayer, model: &str, unit: FileUnit) {
    let kind = match layer.curve {
        SectionCurve::Circle(_) => "CIRCLE",
        SectionCurve::Path(_) => "LWPOLYLINE",
    };
    file.record(kind, model, &["AcDbEntity"]);
    file.group(8, layer.name);
    match &layer.curve {
        SectionCurve::Circle(radius_mm) => {
            file.groups(&[(100, "AcDbCircle"), (10, "0"), (20, "0"), (30, "0")]);
            file.group(40, unit.shown(*radius_mm));
        }
        SectionCurve::Path(path) => polyline(file, path, unit),
    }
}

fn polyline(file: &mut GroupWriter, path: &ArcPath, unit: FileUnit) {
    file.group(100, "AcDbPolyline");
    file.group(90, path.vertices.len());
    file.group(70, u8::from(path.is_closed));
    for vertex in &path.vertices {
        place(file, vertex.point_mm, unit);
        if vertex.bulge != 0.0 {
            file.group(42, fixed(vertex.bulge, BULGE_DIGITS));
        }
    }
}

fn place(file: &mut GroupWriter, point_mm: DVec2, unit: FileUnit) {
    file.group(10, unit.shown(point_mm.x));
    file.group(20, unit.shown(point_mm.y));
}

/// A line of ASCII: other characters by their number, as readers of this release know them.
fn ascii(text: &str) -> String {
    let one = |c: char| match c {
        ' '..='~' => c.to_string(),
        c if c.is_control() => " ".to_owned(),
        c => format!("\\U+{:04X}", u32::from(c)),
    };
    text.chars().map(one).collect()
}
