//! The same surface through every format; files of other programs; damaged files.

use super::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
use super::grid::{MapAxis, MapGrid};
use super::*;
use std::path::PathBuf;

const FORMATS: [(Format, &str); 6] = [
    (Format::X3p, "s.x3p"),
    (Format::SdfBinary, "s.sdf"),
    (Format::SdfAscii, "s_ascii.sdf"),
    (Format::Sur, "s.sur"),
    (Format::Npy, "s.npy"),
    (Format::Csv, "s.csv"),
];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Not symmetric in any way, with a hole.
fn sample() -> SurfaceFile {
    let mut heights: Vec<f64> = (0..35).map(|i| 0.1 * f64::from(i * i % 17) - 0.7).collect();
    heights[12] = f64::NAN;
    SurfaceFile {
        surface: Surface::new(7, 5, 2.0, 3.0, heights).expect("a grid"),
        notes: vec![
            ("frame".to_owned(), "x along the tooth, y along the profile; a * and a \"quote\"".to_owned()),
            ("scene".to_owned(), "[gear]\nmodule_mm = 3.0 # \u{b5}m < > &\n".to_owned()),
        ],
    }
}

fn close(a: &Surface, b: &Surface, share: f64) -> bool {
    let same = |p: f64, q: f64| (p.is_nan() && q.is_nan()) || (p - q).abs() <= share * 2.0;
    (a.nx(), a.ny()) == (b.nx(), b.ny())
        && (a.dx_um() - b.dx_um()).abs() <= share * a.dx_um()
        && (a.dy_um() - b.dy_um()).abs() <= share * a.dy_um()
        && a.heights_um().iter().zip(b.heights_um()).all(|(&p, &q)| same(p, q))
}

#[test]
fn every_format_gives_back_what_it_was_given_and_the_same_bytes_again() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let given = sample();
    for (format, name) in FORMATS {
        let path = folder.path().join(name);
        write_surface(&path, format, &given).expect("written");
        let bytes = std::fs::read(&path).expect("there");
        write_surface(&path, format, &given).expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), bytes, "{format:?}");
        let back = read_surface(&path, None).expect("read");
        let share = if format == Format::Sur { 1e-6 } else { 1e-15 };
        assert!(close(&back.surface, &given.surface, share), "{format:?}: {:?}", back.surface);
        if format != Format::Sur {
            assert_eq!(back.notes, given.notes, "{format:?}");
        }
    }
}

/// Heights with a hole, and other channels; the heights alone.
fn sample_map() -> (ExrMap, Vec<f32>) {
    let axis = |name: &str, step_mm: f64, count: usize| MapAxis {
        name: name.into(),
        meaning: name.into(),
        start_mm: 0.5,
        step_mm,
        count,
    };
    let heights: Vec<f32> =
        (0..35_u16).map(|i| if i == 12 { f32::NAN } else { f32::from(i * i % 17) * 1e-3 }).collect();
    let channel = |name: &str, unit: &str, samples| MapChannel {
        name: name.into(),
        unit: unit.into(),
        definition: name.into(),
        samples,
    };
    let map = ExrMap {
        frame: "a flank".into(),
        grid: MapGrid { u: axis("u", 0.003, 5), v: axis("v", 0.002, 7) },
        channels: vec![
            channel("pass_id", "1", Samples::U32((0..35).collect())),
            channel("stock", "mm", Samples::F32(vec![1.0; 35])),
            channel("height_mm", "mm", Samples::F32(heights.clone())),
        ],
        notes: vec![("scene".into(), "[gear]".into())],
    };
    (map, heights)
}

/// Maps have v (x here) along their rows and u (y) from row to row; ids are no heights.
#[test]
fn our_maps_are_surfaces() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("map.exr");
    let (map, heights) = sample_map();
    write_exr_map(&path, &map).expect("written");
    let file = read_surface(&path, None).expect("a surface");
    let expected = heights.iter().map(|z| f64::from(*z) * 1e3).collect();
    assert!(close(&file.surface, &Surface::new(7, 5, 2.0, 3.0, expected).expect("a grid"), 1e-12));
    assert!(
        file.notes.contains(&("scene".into(), "[gear]".into())) && file.notes[0] == ("frame".into(), "a flank".into())
    );
}

#[test]
fn the_reference_files_hold_the_reference_surface() {
    let truth: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(data("formats/truth.json")).expect("a copy")).expect("JSON");
    let heights: Vec<f64> = truth["heights_m"]
        .as_array()
        .expect("rows")
        .iter()
        .flat_map(|row| row.as_array().expect("a row"))
        .map(|z| z.as_f64().expect("a height") * 1e6)
        .collect();
    let surface = Surface::new(5, 3, 2.0, 3.0, heights.clone()).expect("a grid");
    for name in ["tiny_double.x3p", "tiny_int16.x3p", "tiny_double.sdf", "tiny_ascii.sdf", "tiny.sur"] {
        let read = read_surface(&data("formats").join(name), None).expect(name);
        assert!(close(&read.surface, &surface, 1e-7), "{name}: {:?}", read.surface);
    }
    let mut holed = heights;
    holed[7] = f64::NAN;
    let read = read_surface(&data("formats/tiny_nan.x3p"), None).expect("read");
    assert!(close(&read.surface, &Surface::new(5, 3, 2.0, 3.0, holed).expect("a grid"), 1e-7));
}

/// Every byte cut off and many bytes changed: a reason, never a panic.
#[test]
fn damaged_files_are_refused() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (format, name) in FORMATS {
        let path = folder.path().join(name);
        write_surface(&path, format, &sample()).expect("written");
        let bytes = std::fs::read(&path).expect("there");
        for length in (0..bytes.len()).step_by(13) {
            std::fs::write(&path, &bytes[..length]).expect("written");
            let _refused_or_read = read_surface(&path, None);
        }
        for place in (0..bytes.len()).step_by(9) {
            let mut changed = bytes.clone();
            changed[place] ^= 0x5a;
            std::fs::write(&path, &changed).expect("written");
            let _refused_or_read = read_surface(&path, None);
        }
    }
    let path = folder.path().join("map.exr");
    write_exr_map(&path, &sample_map().0).expect("written");
    let bytes = std::fs::read(&path).expect("there");
    for place in (0..bytes.len()).step_by(3) {
        let mut changed = bytes.clone();
        changed[place] ^= 0x5a;
        std::fs::write(&path, &changed).expect("written");
        let _refused_or_read = read_surface(&path, None);
        std::fs::write(&path, &bytes[..place]).expect("written");
        let _refused_or_read = read_surface(&path, None);
    }
    let path = folder.path().join("x.x3p");
    write_surface(&path, Format::X3p, &sample()).expect("written");
    let mut bytes = std::fs::read(&path).expect("there");
    bytes.truncate(bytes.len() / 2);
    std::fs::write(&path, bytes).expect("written");
    assert!(read_surface(&path, None).expect_err("half a zip").to_string().contains("x.x3p"));
}

#[test]
fn spacing_is_needed_once_and_must_not_contradict() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("plain.csv");
    std::fs::write(&path, "1;2;3\n4;;6\n").expect("written");
    let reason = read_surface(&path, None).expect_err("no spacing").to_string();
    assert!(reason.contains("--spacing-um"), "{reason}");
    let read = read_surface(&path, Some([2.0, 4.0])).expect("spacing given");
    assert_eq!((read.surface.nx(), read.surface.ny(), read.surface.holes()), (3, 2, 1));
    let x3p = data("formats/tiny_double.x3p");
    assert!(read_surface(&x3p, Some([2.0, 3.0])).is_ok());
    assert!(read_surface(&x3p, Some([2.0, 2.0])).expect_err("contradicts").to_string().contains("2 x 3 um apart"));
    std::fs::write(&path, "# dx_um = 1\n# dy_um = 1\n1,2\n3,x\n").expect("written");
    assert!(read_surface(&path, None).expect_err("a word").to_string().contains("line 4: `x`"));
}

/// Files that surfalize, SurfaceTopography and x3pio wrote (`tests/interop/run --keep`): the same heights and spacing,
/// holes included.
#[test]
fn files_of_other_programs_hold_the_surface_they_were_given() {
    let folder = data("written_elsewhere");
    let text = std::fs::read_to_string(folder.join("truth.json")).expect("a copy");
    let truth: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let rows = truth["heights_um"].as_array().expect("rows");
    let columns = rows[0].as_array().expect("a row").len();
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let whole: Vec<f64> = rows.iter().flat_map(|row| row.as_array().expect("a row")).map(number).collect();
    let mut holed = whole.clone();
    let hole = [0, 1].map(|k| truth["hole"][k].as_u64().expect("an index") as usize);
    holed[hole[0] * columns + hole[1]] = f64::NAN;
    let spacing = ["dx_um", "dy_um"].map(|name| number(&truth[name]));
    let surface = |heights: &Vec<f64>| {
        Surface::new(columns, rows.len(), spacing[0], spacing[1], heights.clone()).expect("a grid")
    };
    for name in ["surfalize.x3p", "surfalize.sdf", "surfalize.sur", "surfacetopography.x3p", "x3pio.x3p"] {
        for (prefix, heights) in [("", &whole), ("hole_", &holed)] {
            let name = format!("{prefix}{name}");
            let read = read_surface(&folder.join(&name), None).unwrap_or_else(|reason| panic!("{name}: {reason}"));
            assert!(close(&read.surface, &surface(heights), 2e-6), "{name}: {:?}", read.surface);
        }
    }
}
